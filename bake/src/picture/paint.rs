//! One tile: triangles and cage edges from far to near.

use super::view::{Camera, Projected};
use super::{Frame, Scene};
use crate::geometry::{add_scaled, cross, dot, normalised, subtract};
use crate::mesh::Point;
use tiny_skia::{Color, FillRule, IntSize, Paint, PathBuilder, Pixmap, Stroke, Transform};

/// A warm white.
pub const BACKGROUND: [u8; 3] = [250, 248, 244];

const MODEL: [f64; 3] = [0.93, 0.52, 0.36];
const CAGE: [u8; 3] = [38, 64, 110];

/// How much larger a tile is painted than it is shown.
const SUPERSAMPLING: u32 = 3;

/// Width of a cage edge in pixels of the finished tile.
const LINE_WIDTH: f32 = 1.0;

/// A cage edge is cut into pieces of at most this many pixels, so that each is sorted by a depth of
/// its own.
const PIECE: f64 = 6.0;

/// Something to be painted.
enum Item {
    Triangle([Projected; 3], Color),
    Piece(Projected, Projected),
}

/// Paints tiles of one size.
pub struct Painter {
    large: Pixmap,
    tile: [u32; 2],
}

impl Painter {
    /// `None` if the tile is empty or too large.
    pub fn new(tile: [u32; 2]) -> Option<Self> {
        let large = |size: u32| size.checked_mul(SUPERSAMPLING);
        Some(Self {
            large: Pixmap::new(large(tile[0])?, large(tile[1])?)?,
            tile,
        })
    }

    /// The finished tile of a frame.
    pub fn tile(
        &mut self,
        scene: &Scene<'_>,
        colours: &[[f64; 3]],
        frame: &Frame,
        camera: &Camera,
    ) -> Option<Pixmap> {
        let [r, g, b] = BACKGROUND;
        self.large.fill(Color::from_rgba8(r, g, b, 255));
        let mut items = triangles(scene, colours, frame, camera);
        items.extend(pieces(scene, frame, camera));
        items.sort_by(|(a, _), (b, _)| a.total_cmp(b));
        for (_, item) in &items {
            match item {
                Item::Triangle(corners, colour) => self.triangle(*corners, *colour),
                Item::Piece(from, to) => self.line(*from, *to, 215),
            }
        }
        for [a, b] in scene.cage_edges {
            let ends = [a, b].map(|end| camera.project(frame.cage[*end as usize]));
            self.line(ends[0], ends[1], 40);
        }
        averaged_down(&self.large, self.tile)
    }

    fn triangle(&mut self, corners: [Projected; 3], colour: Color) {
        let [a, b, c] = corners.map(place);
        let mut path = PathBuilder::new();
        path.move_to(a.0, a.1);
        path.line_to(b.0, b.1);
        path.line_to(c.0, c.1);
        path.close();
        let Some(path) = path.finish() else { return };
        let mut paint = Paint {
            anti_alias: false,
            ..Paint::default()
        };
        paint.set_color(colour);
        self.large.fill_path(
            &path,
            &paint,
            FillRule::Winding,
            Transform::identity(),
            None,
        );
    }

    fn line(&mut self, from: Projected, to: Projected, opacity: u8) {
        let (from, to) = (place(from), place(to));
        let mut path = PathBuilder::new();
        path.move_to(from.0, from.1);
        path.line_to(to.0, to.1);
        let Some(path) = path.finish() else { return };
        let mut paint = Paint {
            anti_alias: true,
            ..Paint::default()
        };
        let [r, g, b] = CAGE;
        paint.set_color_rgba8(r, g, b, opacity);
        let stroke = Stroke {
            width: LINE_WIDTH * SUPERSAMPLING as f32,
            ..Stroke::default()
        };
        self.large
            .stroke_path(&path, &paint, &stroke, Transform::identity(), None);
    }
}

fn place(point: Projected) -> (f32, f32) {
    let scale = f64::from(SUPERSAMPLING);
    ((point.x * scale) as f32, (point.y * scale) as f32)
}

/// The model's triangles with their depths and colours.
fn triangles(
    scene: &Scene<'_>,
    colours: &[[f64; 3]],
    frame: &Frame,
    camera: &Camera,
) -> Vec<(f64, Item)> {
    let normals = vertex_normals(scene.triangles, &frame.model);
    let lights = Lights::new(camera);
    let colours = colours.iter().chain(std::iter::repeat(&MODEL));
    let item = |(triangle, colour): (&[u32; 3], &[f64; 3])| {
        let corners = triangle.map(|vertex| camera.project(frame.model[vertex as usize]));
        let normal = triangle.iter().fold([0.0; 3], |sum, vertex| {
            add_scaled(sum, 1.0, normals[*vertex as usize])
        });
        let depth = corners.iter().map(|corner| corner.near).sum::<f64>() / 3.0;
        (
            depth,
            Item::Triangle(corners, lights.shade(normalised(normal), *colour)),
        )
    };
    scene.triangles.iter().zip(colours).map(item).collect()
}

/// The cage's edges in pieces with their depths.
fn pieces(scene: &Scene<'_>, frame: &Frame, camera: &Camera) -> Vec<(f64, Item)> {
    let mut pieces = Vec::new();
    for [a, b] in scene.cage_edges {
        let ends = [a, b].map(|end| camera.project(frame.cage[*end as usize]));
        let length = (ends[1].x - ends[0].x).hypot(ends[1].y - ends[0].y);
        // A cage that is far out of the tile would have no end of pieces.
        let number = (length / PIECE).ceil().clamp(1.0, 500.0) as u32;
        let at = |index: u32| {
            let part = f64::from(index) / f64::from(number);
            let mixed = |from: f64, to: f64| from + part * (to - from);
            Projected {
                x: mixed(ends[0].x, ends[1].x),
                y: mixed(ends[0].y, ends[1].y),
                near: mixed(ends[0].near, ends[1].near),
            }
        };
        for index in 0..number {
            let (from, to) = (at(index), at(index + 1));
            pieces.push((f64::midpoint(from.near, to.near), Item::Piece(from, to)));
        }
    }
    pieces
}

/// Sums of the normals of the triangles at each vertex, larger triangles counting for more.
fn vertex_normals(triangles: &[[u32; 3]], points: &[Point]) -> Vec<Point> {
    let mut normals = vec![[0.0; 3]; points.len()];
    for triangle in triangles {
        let [a, b, c] = triangle.map(|vertex| points[vertex as usize]);
        let normal = cross(subtract(b, a), subtract(c, a));
        for vertex in triangle {
            let sum = &mut normals[*vertex as usize];
            *sum = add_scaled(*sum, 1.0, normal);
        }
    }
    normals.into_iter().map(normalised).collect()
}

/// A strong light from the upper left, a weak one from the right, and a brightness all round that
/// is greater from above.
struct Lights {
    key: Point,
    fill: Point,
    above: Point,
    half_way: Point,
    toward_viewer: Point,
}

impl Lights {
    fn new(camera: &Camera) -> Self {
        let key = camera.direction([-0.55, 0.7, 0.75]);
        let toward_viewer = camera.toward_viewer;
        Self {
            key,
            fill: camera.direction([0.9, -0.1, 0.4]),
            above: camera.direction([0.0, 1.0, 0.0]),
            half_way: normalised(add_scaled(key, 1.0, toward_viewer)),
            toward_viewer,
        }
    }

    fn shade(&self, normal: Point, colour: [f64; 3]) -> Color {
        // A surface seen from behind is lit as if it faced the viewer.
        let side = if dot(normal, self.toward_viewer) < 0.0 {
            -1.0
        } else {
            1.0
        };
        let facing = |light: Point| (side * dot(normal, light)).max(0.0);
        let round = 0.42 + 0.12 * side * dot(normal, self.above);
        let diffuse = round + 0.58 * facing(self.key) + 0.16 * facing(self.fill);
        let gloss = 0.22 * facing(self.half_way).powi(24);
        let [r, g, b] = colour.map(|part| (part * diffuse + gloss).clamp(0.0, 1.0) as f32);
        Color::from_rgba(r, g, b, 1.0).unwrap_or(Color::BLACK)
    }
}

/// Each pixel the mean of a square of the large tile.
fn averaged_down(large: &Pixmap, tile: [u32; 2]) -> Option<Pixmap> {
    let factor = SUPERSAMPLING as usize;
    let stride = large.width() as usize * 4;
    let data = large.data();
    let mut small = Vec::with_capacity(tile[0] as usize * tile[1] as usize * 4);
    for row in 0..tile[1] as usize {
        for column in 0..tile[0] as usize {
            for channel in 0..4 {
                let mut sum = 0_u32;
                for y in 0..factor {
                    let start = (row * factor + y) * stride + column * factor * 4 + channel;
                    sum += (0..factor)
                        .map(|x| u32::from(data[start + 4 * x]))
                        .sum::<u32>();
                }
                let samples = SUPERSAMPLING * SUPERSAMPLING;
                small.push(((sum + samples / 2) / samples) as u8);
            }
        }
    }
    Pixmap::from_vec(small, IntSize::from_wh(tile[0], tile[1])?)
}
