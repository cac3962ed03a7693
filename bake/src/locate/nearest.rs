//! The nearest point of a boundary.

use super::patch::Patch;
use crate::geometry::{add_scaled, bounds, dot, length, subtract};
use crate::mesh::{Faces, Point};
use rstar::{AABB, PointDistance, RTree, RTreeObject};

/// The point of the boundary that is nearest to some point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nearest {
    /// The boundary face it lies on: triangles are counted first, then quadrilaterals.
    pub face: usize,
    /// Weights of the face's corners: none negative, their sum one. The fourth of a triangle is 0.
    pub weights: [f64; 4],
    /// How far away it is.
    pub distance: f64,
}

/// The mean of a face's corners, inside their box.
pub(super) fn middle(corners: &[Point]) -> Point {
    let [low, high] = bounds(corners).unwrap_or_default();
    std::array::from_fn(|axis| {
        let sum: f64 = corners.iter().map(|corner| corner[axis]).sum();
        (sum / corners.len() as f64).clamp(low[axis], high[axis])
    })
}

/// A spatial index over boundary faces.
pub(super) struct BoundaryIndex {
    tree: RTree<Face>,
}

/// A face with its number.
struct Face {
    index: usize,
    kind: Kind,
}

enum Kind {
    Triangle(Triangle),
    Quad(Patch),
}

impl Face {
    /// The nearest point's weights and position.
    fn nearest(&self, point: Point) -> ([f64; 4], Point) {
        match &self.kind {
            Kind::Triangle(triangle) => {
                let [a, b, c] = triangle.nearest_weights(point);
                ([a, b, c, 0.0], triangle.at([a, b, c]))
            }
            Kind::Quad(patch) => patch.nearest(point),
        }
    }
}

impl BoundaryIndex {
    pub(super) fn new(surface: &Faces, points: &[Point]) -> Self {
        let position = |corner: u32| points[corner as usize];
        let triangles = surface.triangles.iter().map(|corners| {
            Kind::Triangle(Triangle {
                corners: corners.map(position),
            })
        });
        let quads = surface.quads.iter();
        let quads = quads.map(|corners| Kind::Quad(Patch::new(corners.map(position))));
        let faces = triangles.chain(quads).enumerate();
        let faces = faces.map(|(index, kind)| Face { index, kind });
        Self {
            tree: RTree::bulk_load(faces.collect()),
        }
    }

    pub(super) fn nearest(&self, point: Point) -> Option<Nearest> {
        let face = self.tree.nearest_neighbor(point)?;
        let (weights, nearest) = face.nearest(point);
        Some(Nearest {
            face: face.index,
            weights,
            distance: length(subtract(point, nearest)),
        })
    }
}

/// A triangle in space.
struct Triangle {
    corners: [Point; 3],
}

impl Triangle {
    fn at(&self, weights: [f64; 3]) -> Point {
        self.corners
            .iter()
            .zip(weights)
            .fold([0.0; 3], |sum, (corner, weight)| {
                add_scaled(sum, weight, *corner)
            })
    }

    /// Weights of the corners that give the point of the triangle nearest to `point`: inside if the
    /// foot of the perpendicular is, else on the nearest of the three edges.
    fn nearest_weights(&self, point: Point) -> [f64; 3] {
        let [a, b, c] = self.corners;
        let (ab, ac, ap) = (subtract(b, a), subtract(c, a), subtract(point, a));
        let (bb, bc, cc) = (dot(ab, ab), dot(ab, ac), dot(ac, ac));
        let (pb, pc) = (dot(ap, ab), dot(ap, ac));
        let determinant = bb * cc - bc * bc;
        let (v, w) = (
            (cc * pb - bc * pc) / determinant,
            (bb * pc - bc * pb) / determinant,
        );
        if v >= 0.0 && w >= 0.0 && v + w <= 1.0 {
            return [1.0 - v - w, v, w];
        }
        let on_edge = |from: usize, to: usize| {
            let along = subtract(self.corners[to], self.corners[from]);
            let part = dot(subtract(point, self.corners[from]), along) / dot(along, along);
            let part = if part.is_finite() {
                part.clamp(0.0, 1.0)
            } else {
                0.0
            };
            let mut weights = [0.0; 3];
            weights[from] = 1.0 - part;
            weights[to] = part;
            weights
        };
        let distance = |weights: &[f64; 3]| length(subtract(point, self.at(*weights)));
        let edges = [on_edge(0, 1), on_edge(1, 2), on_edge(2, 0)];
        edges
            .into_iter()
            .min_by(|a, b| distance(a).total_cmp(&distance(b)))
            .unwrap_or([1.0, 0.0, 0.0])
    }
}

impl RTreeObject for Face {
    type Envelope = AABB<Point>;

    fn envelope(&self) -> AABB<Point> {
        let corners: &[Point] = match &self.kind {
            Kind::Triangle(triangle) => &triangle.corners,
            Kind::Quad(patch) => patch.corners(),
        };
        let [low, high] = bounds(corners).unwrap_or_default();
        AABB::from_corners(low, high)
    }
}

impl PointDistance for Face {
    fn distance_2(&self, point: &Point) -> f64 {
        let (_, nearest) = self.nearest(*point);
        let offset = subtract(*point, nearest);
        dot(offset, offset)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Nearest points of the triangle (0,0,0) (4,0,0) (0,4,0), by hand.
    #[test]
    fn nearest_point_of_a_triangle() {
        let surface = Faces {
            triangles: vec![[0, 1, 2]],
            quads: vec![],
        };
        let points = [[0.0; 3], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]];
        let index = BoundaryIndex::new(&surface, &points);
        for (point, weights, distance) in [
            ([1.0, 1.0, 2.0], [0.5, 0.25, 0.25, 0.0], 2.0),
            ([-3.0, -4.0, 0.0], [1.0, 0.0, 0.0, 0.0], 5.0),
            ([1.0, -2.0, 0.0], [0.75, 0.25, 0.0, 0.0], 2.0),
            ([4.0, 4.0, 0.0], [0.0, 0.5, 0.5, 0.0], 8.0_f64.sqrt()),
            ([0.0, 9.0, 0.0], [0.0, 0.0, 1.0, 0.0], 5.0),
        ] {
            let nearest = index.nearest(point).unwrap();
            assert_eq!((nearest.weights, nearest.distance), (weights, distance));
        }
    }
}
