//! Control meshes, every scheme uniformly.

use octruss_firmware::cases::{
    LIMIT_NORMALS, SECTION_FACES, SECTION_LIMIT, SECTION_LIMIT_NORMALS, SURFACE, summary,
};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng as _;

use super::{Expected, Judged, bits, word};
use crate::qemu::conformance::Section;
use crate::random_surface::{Shape, SurfaceCase, Wishes};
use crate::reference_surface::{
    Border, Family, Grid, Polygons, Row, apply, butterfly, catmull_clark, catmull_clark_limit,
    count_saturated, doo_sabin, face_normals, limit_normals, loop_limit, loop_rule, sqrt3,
    sqrt3_limit, tri_quad,
};

/// A scheme, as cases number them.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Scheme {
    Loop = 1,
    LoopWarren = 2,
    TriQuad = 3,
    CatmullClark = 4,
    DooSabin = 5,
    Sqrt3 = 6,
    Butterfly = 7,
    ButterflyModified = 8,
    TriQuadSurface = 9,
}

/// Corners of all faces that the image's memory holds in a refined mesh.
const CORNERS_AT_MOST: usize = 2_000;
/// The same where sums take 128 bits.
const CORNERS_OF_WIDE_SUMS: usize = 1_500;
/// The same where limit positions follow, which take a sum for every edge too.
const CORNERS_BEFORE_LIMIT: usize = 750;

/// The case of a seed. One of every ten is damaged.
pub(super) fn case(scheme: Scheme, seed: u32) -> Judged {
    let (mut mesh, points) = control_mesh(scheme, seed);
    // Rims take turns by threes and damage by tens, so the rest is dealt by quotients.
    let border = [Border::Spline, Border::SplineWithCorners, Border::Fixed][seed as usize % 3];
    let levels = 1 + seed / 3 % 4;
    let mut walk = Walk {
        scheme,
        border,
        points: points.clone(),
        expected: Expected::default(),
    };
    let mut words = vec![scheme as u32, seed % 3 + 1, 0, 0];
    push_mesh(&mut words, &mesh, &points);
    let wants_limit = scheme.has_limit() && (seed / 12).is_multiple_of(2);
    let most = match scheme {
        _ if wants_limit => CORNERS_BEFORE_LIMIT,
        Scheme::TriQuadSurface => CORNERS_OF_WIDE_SUMS,
        _ => CORNERS_AT_MOST,
    };
    let mut done = 0;
    while done < levels && scheme.takes(&mesh) {
        let refined = scheme.refine(&mesh, border, &walk.points);
        if corners(&refined.mesh) > most {
            break;
        }
        done += 1;
        mesh = walk.step(done, refined);
    }
    words[2] = done;
    if wants_limit && scheme.has_limit_on(&mesh) {
        words[3] = 1;
        walk.limit(done, &mesh);
    }
    let judged = Judged::sound(SURFACE, seed, words, walk.expected);
    if seed.is_multiple_of(10) {
        judged.damaged(&mut ChaCha8Rng::seed_from_u64(u64::from(seed)))
    } else {
        judged
    }
}

/// The case of limit normals of a seed: the schemes take turns, and so do levels from none on. One of every ten is
/// damaged.
pub(super) fn normals(seed: u32) -> Judged {
    const SCHEMES: [Scheme; 5] = [
        Scheme::Loop,
        Scheme::CatmullClark,
        Scheme::DooSabin,
        Scheme::LoopWarren,
        Scheme::CatmullClark,
    ];
    let scheme = SCHEMES[(seed / 30 % 5) as usize];
    let (mut mesh, points) = control_mesh(scheme, seed);
    let border = [Border::Spline, Border::SplineWithCorners, Border::Fixed][seed as usize % 3];
    let mut walk = Walk {
        scheme,
        border,
        points: points.clone(),
        expected: Expected::default(),
    };
    let mut words = vec![scheme as u32, seed % 3 + 1, 0, 0];
    push_mesh(&mut words, &mesh, &points);
    // Catmull-Clark masks want quads, which the first level brings.
    let levels = u32::from(scheme == Scheme::CatmullClark) + seed / 3 % 2;
    for level in 1..=levels {
        if !scheme.takes(&mesh) {
            break;
        }
        let refined = scheme.refine(&mesh, border, &walk.points);
        if level > 1 && corners(&refined.mesh) > CORNERS_BEFORE_LIMIT {
            break;
        }
        mesh = walk.step(level, refined);
        words[2] = level;
    }
    // A fin may run the wrong way along its edge; what comes of that is for core on the host to say.
    let is_refused = scheme != Scheme::DooSabin && mesh.has_turned_faces();
    if !is_refused {
        walk.normals(words[2], &mesh);
    }
    let mut judged = Judged::sound(LIMIT_NORMALS, seed, words, walk.expected);
    if is_refused {
        judged.expected = None;
    }
    if seed.is_multiple_of(10) {
        judged.damaged(&mut ChaCha8Rng::seed_from_u64(u64::from(seed)))
    } else {
        judged
    }
}

/// A mesh that the scheme takes.
fn control_mesh(scheme: Scheme, seed: u32) -> (Polygons, Vec<[i32; 3]>) {
    let shape = match scheme {
        Scheme::CatmullClark | Scheme::DooSabin => Shape::Polygons,
        Scheme::TriQuadSurface => Shape::TrianglesAndQuads,
        _ => Shape::Triangles,
    };
    let wishes = Wishes {
        shape,
        open: true,
        features: match scheme {
            Scheme::DooSabin => false,
            // Lines that end or cross stop it at the second step.
            Scheme::Sqrt3 => seed % 4 == 1,
            _ => true,
        },
        tangled: matches!(
            scheme,
            Scheme::Loop
                | Scheme::LoopWarren
                | Scheme::TriQuad
                | Scheme::CatmullClark
                | Scheme::TriQuadSurface
        ),
    };
    let mut case = SurfaceCase::new(u64::from(seed), wishes);
    if scheme == Scheme::TriQuadSurface && seed.is_multiple_of(7) {
        case = case.at_the_ends();
    }
    let SurfaceCase { mesh, points } = case;
    if scheme.takes(&mesh) {
        return (mesh, points);
    }
    let closed = Wishes {
        open: false,
        ..wishes
    };
    let SurfaceCase { mesh, points } = SurfaceCase::new(u64::from(seed), closed);
    (mesh, points)
}

impl Scheme {
    /// Whether a step is defined on a mesh of the right polygons.
    fn takes(self, mesh: &Polygons) -> bool {
        match self {
            // Taking faces out can leave two fans that touch.
            Scheme::DooSabin => !(0..mesh.vertex_count).any(|vertex| mesh.has_two_fans(vertex)),
            Scheme::Sqrt3 => !mesh.odd || lines_run_on(mesh),
            _ => true,
        }
    }

    fn has_limit(self) -> bool {
        !matches!(
            self,
            Scheme::Butterfly | Scheme::ButterflyModified | Scheme::TriQuadSurface
        )
    }

    fn has_limit_on(self, mesh: &Polygons) -> bool {
        match self {
            Scheme::CatmullClark => mesh.faces.iter().all(|face| face.len() == 4),
            Scheme::Sqrt3 => !mesh.odd || mesh.sharp_edges().is_empty(),
            _ => corners(mesh) <= CORNERS_BEFORE_LIMIT,
        }
    }

    fn family(self) -> Family {
        match self {
            Scheme::LoopWarren => Family::Warren,
            Scheme::TriQuad => Family::TriQuad,
            _ => Family::Loop,
        }
    }

    /// One level of a mesh and its points.
    fn refine(self, mesh: &Polygons, border: Border, points: &[[i32; 3]]) -> Step {
        let refined = match self {
            Scheme::TriQuadSurface => {
                let refined = tri_quad(mesh, border);
                return Step {
                    points: refined.points(points),
                    saturated: refined.count_saturated(points),
                    mesh: refined.mesh,
                };
            }
            Scheme::Loop | Scheme::LoopWarren | Scheme::TriQuad => {
                loop_rule(mesh, self.family(), border, Grid::Device)
            }
            Scheme::CatmullClark => catmull_clark(mesh, border),
            Scheme::DooSabin => doo_sabin(mesh, Grid::Device),
            Scheme::Sqrt3 => sqrt3(mesh, Grid::Device),
            Scheme::Butterfly => butterfly(mesh, false, border, Grid::Device),
            Scheme::ButterflyModified => butterfly(mesh, true, border, Grid::Device),
        };
        Step {
            points: refined.points(points),
            saturated: count_saturated(&refined.rows, points),
            mesh: refined.mesh,
        }
    }

    fn limit(self, mesh: &Polygons, border: Border) -> Vec<Row> {
        match self {
            Scheme::Loop | Scheme::LoopWarren | Scheme::TriQuad => {
                loop_limit(mesh, self.family(), border, Grid::Device)
            }
            Scheme::CatmullClark => catmull_clark_limit(mesh, border),
            Scheme::DooSabin => mesh.faces.iter().map(|face| Row::mean(face)).collect(),
            Scheme::Sqrt3 => sqrt3_limit(mesh, Grid::Device),
            Scheme::Butterfly | Scheme::ButterflyModified | Scheme::TriQuadSurface => Vec::new(),
        }
    }
}

/// What one level comes to.
struct Step {
    mesh: Polygons,
    points: Vec<[i32; 3]>,
    /// Coordinates that do not fit.
    saturated: usize,
}

/// Whether no sharp line ends or crosses another.
fn lines_run_on(mesh: &Polygons) -> bool {
    let lines = mesh.sharp_edges();
    !lines.iter().flatten().any(|vertex| mesh.is_end(*vertex))
}

/// A refinement on its way.
struct Walk {
    scheme: Scheme,
    border: Border,
    points: Vec<[i32; 3]>,
    expected: Expected,
}

impl Walk {
    /// Goes one level on.
    fn step(&mut self, level: u32, refined: Step) -> Polygons {
        self.points = refined.points;
        self.expected.sections.push(faces(level, &refined.mesh));
        self.expected
            .push_points(level, &self.points, refined.saturated);
        refined.mesh
    }

    fn limit(&mut self, level: u32, mesh: &Polygons) {
        let rows = self.scheme.limit(mesh, self.border);
        let limit = apply(&rows, &self.points);
        self.expected.coordinates += 3 * limit.len();
        let mut words = vec![level, word(self.expected.saturated)];
        words.extend(bits(&limit));
        self.expected.sections.push(Section {
            tag: SECTION_LIMIT,
            words,
        });
    }
}

impl Walk {
    fn normals(&mut self, level: u32, mesh: &Polygons) {
        let (normals, zeros) = match self.scheme {
            Scheme::DooSabin => face_normals(mesh, &self.points),
            scheme => {
                let are_quads = scheme == Scheme::CatmullClark;
                limit_normals(mesh, are_quads, self.border, &self.points)
            }
        };
        self.expected.coordinates += 3 * normals.len();
        let coordinates = normals.as_flattened().iter();
        let mut words = vec![level, zeros];
        words.extend(coordinates.map(|bits| i32::from(*bits).cast_unsigned()));
        self.expected.sections.push(Section {
            tag: SECTION_LIMIT_NORMALS,
            words,
        });
    }
}

fn corners(mesh: &Polygons) -> usize {
    mesh.faces.iter().map(Vec::len).sum()
}

/// Where each face starts in the list of corners, and where the last one ends.
fn offsets(mesh: &Polygons) -> Vec<u32> {
    let ends = mesh.faces.iter().scan(0, |end, face| {
        *end += word(face.len());
        Some(*end)
    });
    std::iter::once(0).chain(ends).collect()
}

/// The mesh as a case tells it.
pub(super) fn push_mesh(words: &mut Vec<u32>, mesh: &Polygons, points: &[[i32; 3]]) {
    let counts = [
        mesh.faces.len(),
        corners(mesh),
        mesh.creases.len(),
        mesh.corners.len(),
    ];
    words.push(mesh.vertex_count);
    words.extend(counts.map(word));
    words.extend(offsets(mesh));
    words.extend(mesh.faces.iter().flatten());
    words.extend(mesh.creases.as_flattened());
    words.extend(&mesh.corners);
    words.extend(bits(points));
}

/// The section about a level's faces.
fn faces(level: u32, mesh: &Polygons) -> Section {
    let indices: Vec<u32> = mesh.faces.concat();
    let mut words = vec![level, mesh.vertex_count];
    words.extend(summary(&offsets(mesh)));
    words.extend(summary(&indices));
    words.extend(summary(&mesh.creases));
    words.extend(summary(&mesh.corners));
    words.push(u32::from(mesh.odd));
    Section {
        tag: SECTION_FACES,
        words,
    }
}
