//! The nearest point of a boundary.

use crate::geometry::{add_scaled, bounds, dot, length, subtract};
use crate::mesh::Point;
use rstar::{AABB, PointDistance, RTree, RTreeObject};

/// The point of the boundary that is nearest to some point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nearest {
    /// The boundary triangle it lies on.
    pub triangle: usize,
    /// Weights of the triangle's corners: none negative, their sum one.
    pub weights: [f64; 3],
    /// How far away it is.
    pub distance: f64,
}

impl Nearest {
    /// The middle of the triangle.
    pub(super) fn middle(&self, [a, b, c]: [Point; 3]) -> Point {
        std::array::from_fn(|axis| {
            let sum = a[axis] + b[axis] + c[axis];
            let (low, high) = (
                a[axis].min(b[axis]).min(c[axis]),
                a[axis].max(b[axis]).max(c[axis]),
            );
            (sum / 3.0).clamp(low, high)
        })
    }
}

/// A spatial index over boundary triangles.
pub(super) struct BoundaryIndex {
    tree: RTree<Triangle>,
}

impl BoundaryIndex {
    pub(super) fn new(surface: &[[u32; 3]], points: &[Point]) -> Self {
        let triangle = |(index, corners): (usize, &[u32; 3])| Triangle {
            index,
            corners: corners.map(|corner| points[corner as usize]),
        };
        Self {
            tree: RTree::bulk_load(surface.iter().enumerate().map(triangle).collect()),
        }
    }

    pub(super) fn nearest(&self, point: Point) -> Option<Nearest> {
        let triangle = self.tree.nearest_neighbor(point)?;
        let weights = triangle.nearest_weights(point);
        Some(Nearest {
            triangle: triangle.index,
            weights,
            distance: length(subtract(point, triangle.at(weights))),
        })
    }
}

/// A triangle in space.
struct Triangle {
    index: usize,
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

impl RTreeObject for Triangle {
    type Envelope = AABB<Point>;

    fn envelope(&self) -> AABB<Point> {
        let [low, high] = bounds(&self.corners).unwrap_or_default();
        AABB::from_corners(low, high)
    }
}

impl PointDistance for Triangle {
    fn distance_2(&self, point: &Point) -> f64 {
        let offset = subtract(*point, self.at(self.nearest_weights(*point)));
        dot(offset, offset)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Nearest points of the triangle (0,0,0) (4,0,0) (0,4,0), by hand.
    #[test]
    fn nearest_point_of_a_triangle() {
        let surface = [[0, 1, 2]];
        let points = [[0.0; 3], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]];
        let index = BoundaryIndex::new(&surface, &points);
        for (point, weights, distance) in [
            ([1.0, 1.0, 2.0], [0.5, 0.25, 0.25], 2.0),
            ([-3.0, -4.0, 0.0], [1.0, 0.0, 0.0], 5.0),
            ([1.0, -2.0, 0.0], [0.75, 0.25, 0.0], 2.0),
            ([4.0, 4.0, 0.0], [0.0, 0.5, 0.5], 8.0_f64.sqrt()),
            ([0.0, 9.0, 0.0], [0.0, 0.0, 1.0], 5.0),
        ] {
            let nearest = index.nearest(point).unwrap();
            assert_eq!((nearest.weights, nearest.distance), (weights, distance));
        }
    }
}
