//! Bilinear patches: the quadrilaterals of a boundary.

use super::tetrahedron::combine;
use crate::geometry::{dot, subtract};
use crate::mesh::Point;

/// A quadrilateral with its corners in cyclic order, as the image of the unit square.
pub(super) struct Patch {
    corners: [Point; 4],
}

impl Patch {
    pub fn new(corners: [Point; 4]) -> Self {
        Self { corners }
    }

    pub fn corners(&self) -> &[Point; 4] {
        &self.corners
    }

    /// Weights of the corners that give the point of the patch nearest to `point`, and that point.
    ///
    /// From the best of a grid, by steps of Gauss and Newton that stay in the square, and where these do
    /// not lead nearer by the exact best place along each parameter in turn, until nothing leads
    /// nearer: the result is a place from which no small step does.
    pub fn nearest(&self, point: Point) -> ([f64; 4], Point) {
        const GRID: u32 = 4;
        const STEPS: usize = 64;
        let grid = (0..(GRID + 1).pow(2)).map(|place| {
            [place / (GRID + 1), place % (GRID + 1)].map(|k| f64::from(k) / f64::from(GRID))
        });
        let distance = |at: &[f64; 2]| {
            let offset = subtract(point, self.at(*at));
            dot(offset, offset)
        };
        let mut best = grid
            .min_by(|a, b| distance(a).total_cmp(&distance(b)))
            .unwrap_or_default();
        for _ in 0..STEPS {
            let tried = [self.gauss_newton(best, point), self.in_turn(best, point)];
            let better = tried.into_iter().find(|at| distance(at) < distance(&best));
            match better {
                Some(at) => best = at,
                None => break,
            }
        }
        (weights(best), self.at(best))
    }

    fn at(&self, at: [f64; 2]) -> Point {
        combine(&self.corners, &weights(at))
    }

    /// Derivatives along both parameters.
    fn derivatives(&self, [u, v]: [f64; 2]) -> [Point; 2] {
        [
            combine(&self.corners, &[v - 1.0, 1.0 - v, v, -v]),
            combine(&self.corners, &[u - 1.0, -u, u, 1.0 - u]),
        ]
    }

    fn gauss_newton(&self, at: [f64; 2], point: Point) -> [f64; 2] {
        let [along_u, along_v] = self.derivatives(at);
        let offset = subtract(point, self.at(at));
        let (uu, uv, vv) = (
            dot(along_u, along_u),
            dot(along_u, along_v),
            dot(along_v, along_v),
        );
        let (right_u, right_v) = (dot(offset, along_u), dot(offset, along_v));
        let determinant = uu * vv - uv * uv;
        let step = [
            (right_u * vv - right_v * uv) / determinant,
            (right_v * uu - right_u * uv) / determinant,
        ];
        clamped([at[0] + step[0], at[1] + step[1]], at)
    }

    /// The patch is linear in each parameter, so the best place along it is known.
    fn in_turn(&self, at: [f64; 2], point: Point) -> [f64; 2] {
        let mut at = at;
        for axis in 0..2 {
            let along = self.derivatives(at)[axis];
            let offset = subtract(point, self.at(at));
            let mut next = at;
            next[axis] += dot(offset, along) / dot(along, along);
            at = clamped(next, at);
        }
        at
    }
}

/// Inside the unit square; `otherwise` where a step is no number.
fn clamped(at: [f64; 2], otherwise: [f64; 2]) -> [f64; 2] {
    [0, 1].map(|axis| match at[axis].is_finite() {
        true => at[axis].clamp(0.0, 1.0),
        false => otherwise[axis],
    })
}

/// The bilinear weights of the corners.
fn weights([u, v]: [f64; 2]) -> [f64; 4] {
    [(1.0 - u) * (1.0 - v), u * (1.0 - v), u * v, (1.0 - u) * v]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of the saddle z = x y over [-1, 1]^2: above the middle at z = 1/2 the nearest point is the
    /// middle (the distance along the line x = y = t is least at t = 0 while z < 1), at z = 2 it is
    /// (t, t, t^2) with 2 t + 2 t (t^2 - 2) = 0, t = 1: a corner. Beside the square the edge is nearest.
    #[test]
    fn nearest_points_of_a_saddle() {
        let patch = Patch::new([
            [-1.0, -1.0, 1.0],
            [1.0, -1.0, -1.0],
            [1.0, 1.0, 1.0],
            [-1.0, 1.0, -1.0],
        ]);
        let (weights, nearest) = patch.nearest([0.0, 0.0, 0.5]);
        assert_eq!((weights, nearest), ([0.25; 4], [0.0; 3]));
        let (_, nearest) = patch.nearest([3.0, 0.25, 0.25]);
        for (coordinate, want) in nearest.into_iter().zip([1.0, 0.25, 0.25]) {
            assert!((coordinate - want).abs() < 1e-12, "{nearest:?}");
        }
        let (_, nearest) = patch.nearest([2.0, 2.0, 1.5]);
        assert_eq!(nearest, [1.0, 1.0, 1.0]);
    }
}
