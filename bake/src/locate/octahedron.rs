//! Coordinates in an octahedron.
//!
//! Inside a convex octahedron these are the coordinates of Warren ("Barycentric coordinates for
//! convex polytopes", 1996), which come from the polar dual: smooth, positive inside, affine on
//! every face, exact for linear functions. A corner's weight at `x` is the sum, over the triangles
//! into which the corner's dual face is cut, of `det(n1, n2, n3)` times the product of the
//! distances of `x` from all faces but these three. Written so, nothing is divided until the
//! weights are made to sum to one, and the normals need not have length one.
//!
//! Where that does not work (the octahedron is not convex, or all weights vanish, as they do at a
//! corner) the octahedron is four tetrahedra round a diagonal, with affine coordinates in each.

use super::tetrahedron;
use crate::geometry::{cross, dot, inside_of_face, subtract, tetrahedron_volume_6};
use crate::mesh::Point;
use octruss::mesh::OCTAHEDRON_FACES;

/// For each corner its four faces, as places in [`OCTAHEDRON_FACES`], in cyclic order: as seen from
/// outside, so that determinants of three inward normals in this order are positive.
const FACES_AT: [[usize; 4]; 6] = [
    [0, 2, 3, 1],
    [0, 1, 5, 4],
    [0, 4, 6, 2],
    [4, 5, 7, 6],
    [2, 6, 7, 3],
    [1, 3, 7, 5],
];

/// An octahedron with what its shape says about it.
pub struct Octahedron {
    corners: [Point; 6],
    /// Every corner lies on the inner side of every face (or on the outer, if it is inside out).
    is_convex: bool,
    /// Corners of the four tetrahedra round the chosen diagonal.
    parts: [[usize; 4]; 4],
}

impl Octahedron {
    /// Looks at the shape: convex or not, and round which diagonal to cut. The first diagonal whose
    /// four tetrahedra are all positive is taken, or else the first.
    pub fn new(corners: [Point; 6]) -> Self {
        let sides = || {
            OCTAHEDRON_FACES.iter().flat_map(|face| {
                let others = (0..6).filter(|corner| !face.contains(corner));
                others
                    .map(|other| inside_of_face(face.map(|corner| corners[corner]), corners[other]))
            })
        };
        let is_turned = |side: f64| side < 0.0;
        let is_convex = sides().all(|side| side >= 0.0) || sides().all(|side| side <= 0.0);
        let all_turned = is_convex && sides().any(is_turned);
        let is_sound = |parts: &[[usize; 4]; 4]| {
            parts.iter().all(|part| {
                let volume = tetrahedron_volume_6(part.map(|corner| corners[corner]));
                if all_turned {
                    volume < 0.0
                } else {
                    volume > 0.0
                }
            })
        };
        let cuts = [0, 1, 2].map(parts_round);
        let parts = cuts.into_iter().find(is_sound).unwrap_or(cuts[0]);
        Self {
            corners,
            is_convex,
            parts,
        }
    }

    /// True if the point lies in the closed octahedron, decided exactly.
    pub fn contains(&self, point: Point) -> bool {
        if !self.is_convex {
            return self.part_with(point).is_some();
        }
        if self.volume_6() == 0.0 {
            return false;
        }
        let mut sides = OCTAHEDRON_FACES
            .map(|face| inside_of_face(face.map(|corner| self.corners[corner]), point))
            .into_iter();
        let first = sides.clone().find(|side| *side != 0.0).unwrap_or(0.0);
        sides.all(|side| side * first.signum() >= 0.0)
    }

    /// The four tetrahedra round the chosen diagonal, which cut the octahedron up, by its corners.
    pub fn parts(&self) -> &[[usize; 4]; 4] {
        &self.parts
    }

    /// True if the four tetrahedra round the chosen diagonal are all positive.
    pub fn is_sound(&self) -> bool {
        self.parts
            .iter()
            .all(|part| tetrahedron_volume_6(part.map(|i| self.corners[i])) > 0.0)
    }

    /// Six times the signed volume.
    pub fn volume_6(&self) -> f64 {
        self.parts
            .iter()
            .map(|part| tetrahedron_volume_6(part.map(|i| self.corners[i])))
            .sum()
    }

    /// Coordinates of a point that the octahedron contains: they sum to one and give the point
    /// back. `None` only if it has no volume.
    pub fn coordinates(&self, point: Point) -> Option<[f64; 6]> {
        if let Some(corner) = self.corners.iter().position(|corner| *corner == point) {
            return Some(std::array::from_fn(
                |other| if other == corner { 1.0 } else { 0.0 },
            ));
        }
        self.smooth_coordinates(point).or_else(|| {
            let part = self.part_with(point).unwrap_or(self.parts[0]);
            self.in_part(part, point)
        })
    }

    /// Affine coordinates of a point outside, in the part of the octahedron behind a face that has
    /// these three corners.
    pub fn coordinates_behind(&self, face: [usize; 3], point: Point) -> Option<[f64; 6]> {
        let part = self
            .parts
            .iter()
            .find(|part| face.iter().all(|corner| part.contains(corner)));
        self.in_part(*part?, point)
    }

    fn in_part(&self, part: [usize; 4], point: Point) -> Option<[f64; 6]> {
        let affine = tetrahedron::coordinates(&part.map(|corner| self.corners[corner]), point)?;
        let mut weights = [0.0; 6];
        for (corner, weight) in part.into_iter().zip(affine) {
            weights[corner] = weight;
        }
        Some(weights)
    }

    fn part_with(&self, point: Point) -> Option<[usize; 4]> {
        let contains = |part: &&[usize; 4]| {
            tetrahedron::contains(&part.map(|corner| self.corners[corner]), point)
        };
        self.parts.iter().find(contains).copied()
    }

    /// Warren's coordinates, if the octahedron is convex and the weights do not vanish.
    fn smooth_coordinates(&self, point: Point) -> Option<[f64; 6]> {
        if !self.is_convex {
            return None;
        }
        // The weights are products of 21 lengths: a unit scale keeps them away from underflow.
        let size = self
            .corners
            .iter()
            .flat_map(|corner| subtract(*corner, self.corners[0]))
            .fold(0.0, |size: f64, coordinate| size.max(coordinate.abs()));
        let local = self
            .corners
            .map(|corner| subtract(corner, self.corners[0]).map(|c| c / size));
        let mut weights =
            polar_dual_weights(&local, subtract(point, self.corners[0]).map(|c| c / size));
        let sum: f64 = weights.iter().sum();
        weights = weights.map(|weight| weight / sum);
        // Near a corner the weights are small differences; beside it they mean nothing.
        if !weights
            .iter()
            .all(|weight| weight.is_finite() && *weight >= -1e-6)
        {
            return None;
        }
        self.corrected(weights, point)
    }

    /// Removes what roundings left of the difference between the weighted corners and the point.
    fn corrected(&self, mut weights: [f64; 6], point: Point) -> Option<[f64; 6]> {
        let missing = subtract(point, tetrahedron::combine(&self.corners, &weights));
        let volume = |part: &[usize; 4]| tetrahedron_volume_6(part.map(|i| self.corners[i])).abs();
        let part = self
            .parts
            .iter()
            .max_by(|a, b| volume(a).total_cmp(&volume(b)))?;
        let change = tetrahedron::moving(&part.map(|corner| self.corners[corner]), missing)?;
        for (corner, change) in part.iter().zip(change) {
            weights[*corner] += change;
        }
        Some(weights)
    }
}

/// The four tetrahedra round the diagonal from corner `top` to the one opposite, positive if the
/// octahedron is.
fn parts_round(top: usize) -> [[usize; 4]; 4] {
    FACES_AT[top].map(|face| {
        let [a, b, c] = OCTAHEDRON_FACES[face];
        [a, c, b, top + 3]
    })
}

/// The weights of Warren's coordinates, not yet made to sum to one.
fn polar_dual_weights(corners: &[Point; 6], point: Point) -> [f64; 6] {
    // Inward normals, so that determinants and distances of a positive octahedron are positive.
    let normals = OCTAHEDRON_FACES.map(|[a, b, c]| {
        cross(
            subtract(corners[c], corners[a]),
            subtract(corners[b], corners[a]),
        )
    });
    let distances: [f64; 8] = std::array::from_fn(|face| {
        dot(
            normals[face],
            subtract(point, corners[OCTAHEDRON_FACES[face][0]]),
        )
    });
    FACES_AT.map(|[a, b, c, d]| {
        // The dual face has a corner for each face here; it is cut along one diagonal.
        let term = |triangle: [usize; 3]| {
            let [n1, n2, n3] = triangle.map(|face| normals[face]);
            let others = (0..8).filter(|face| !triangle.contains(face));
            dot(n1, cross(n2, n3)) * others.map(|face| distances[face]).product::<f64>()
        };
        term([a, b, c]) + term([a, c, d])
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::add_scaled;

    const REGULAR: [Point; 6] = [
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, 0.0, -1.0],
        [-1.0, 0.0, 0.0],
        [0.0, -1.0, 0.0],
        [0.0, 0.0, 1.0],
    ];

    /// Convex, but nothing in it is equal or parallel.
    const SKEW: [Point; 6] = [
        [1.5, 0.125, -0.25],
        [0.25, 1.0, 0.0],
        [0.0, 0.25, -2.0],
        [-1.0, 0.0, 0.125],
        [-0.125, -0.75, 0.25],
        [0.0625, 0.125, 1.0],
    ];

    /// The corner 5 pushed down through the plane of its four neighbours.
    const DENTED: [Point; 6] = [
        REGULAR[0],
        REGULAR[1],
        REGULAR[2],
        REGULAR[3],
        REGULAR[4],
        [0.0, 0.0, -0.5],
    ];

    fn assert_reproduces(octahedron: &[Point; 6], point: Point, weights: [f64; 6]) {
        // Linear precision to a few roundings at the scale of the corners.
        const BOUND: f64 = 8.0 * f64::EPSILON;
        let sum: f64 = weights.iter().sum();
        assert!((sum - 1.0).abs() <= BOUND, "sum {sum}");
        let again = tetrahedron::combine(octahedron, &weights);
        for axis in 0..3 {
            let error = (again[axis] - point[axis]).abs();
            assert!(error <= BOUND, "{point:?} came back as {again:?}");
        }
    }

    #[test]
    fn the_centre_of_a_regular_octahedron_weighs_all_corners_alike() {
        let weights = Octahedron::new(REGULAR).coordinates([0.0; 3]).unwrap();
        for weight in weights {
            assert!((weight - 1.0 / 6.0).abs() <= f64::EPSILON);
        }
    }

    /// On the axis to corner 0 of a regular octahedron the eight distances are (1 - t) four times
    /// and (1 + t) four times, so with a = 1 - t, b = 1 + t the weights are proportional to 2 a
    /// b^4 (corner 0), 2 a^4 b (corner 3) and a^2 b^2 (a + b) for the others: with t = 1/2, 81, 3
    /// and 18 of 156.
    #[test]
    fn weights_on_an_axis_are_those_worked_out_by_hand() {
        let weights = Octahedron::new(REGULAR)
            .coordinates([0.5, 0.0, 0.0])
            .unwrap();
        let expected = [81.0, 18.0, 18.0, 3.0, 18.0, 18.0].map(|weight| weight / 156.0);
        for (weight, expected) in weights.into_iter().zip(expected) {
            assert!(
                (weight - expected).abs() <= 2.0 * f64::EPSILON,
                "{weight} {expected}"
            );
        }
    }

    #[test]
    fn every_point_inside_comes_back() {
        for corners in [REGULAR, SKEW, DENTED] {
            let octahedron = Octahedron::new(corners);
            let middle = tetrahedron::combine(&corners, &[1.0 / 6.0; 6]);
            for steps in 0..6_u32.pow(3) {
                let offset: Point = std::array::from_fn(|axis| {
                    f64::from(steps / 6_u32.pow(axis as u32) % 6) / 5.0 - 0.5
                });
                let point = add_scaled(middle, 1.0, offset);
                if octahedron.contains(point) {
                    assert_reproduces(&corners, point, octahedron.coordinates(point).unwrap());
                }
            }
        }
    }

    #[test]
    fn corners_edges_and_faces_belong_to_the_octahedron() {
        for corners in [REGULAR, SKEW] {
            let octahedron = Octahedron::new(corners);
            assert!(octahedron.is_convex && octahedron.is_sound());
            for (corner, position) in corners.into_iter().enumerate() {
                assert!(octahedron.contains(position));
                let weights = octahedron.coordinates(position).unwrap();
                for (other, weight) in weights.into_iter().enumerate() {
                    assert_eq!(weight, if other == corner { 1.0 } else { 0.0 });
                }
            }
            for [a, b, c] in OCTAHEDRON_FACES {
                let [a, b, c] = [a, b, c].map(|corner| corners[corner]);
                let middle = add_scaled(a, 0.5, subtract(b, a));
                assert_reproduces(&corners, middle, octahedron.coordinates(middle).unwrap());
                let inside = add_scaled(middle, 0.25, subtract(c, middle));
                assert_reproduces(&corners, inside, octahedron.coordinates(inside).unwrap());
            }
        }
    }

    /// Two cells that share a face give a point on it the same weights, for they are affine there.
    #[test]
    fn on_a_face_the_coordinates_are_affine() {
        let octahedron = Octahedron::new(SKEW);
        for face in OCTAHEDRON_FACES {
            let mut expected = [0.0; 6];
            for (corner, weight) in face.into_iter().zip([0.5, 0.125, 0.375]) {
                expected[corner] = weight;
            }
            let point = tetrahedron::combine(&SKEW, &expected);
            for (weight, expected) in octahedron
                .coordinates(point)
                .unwrap()
                .into_iter()
                .zip(expected)
            {
                assert!(
                    (weight - expected).abs() <= 16.0 * f64::EPSILON,
                    "{weight} {expected}"
                );
            }
        }
    }

    #[test]
    fn a_dent_does_not_belong_to_the_octahedron() {
        let octahedron = Octahedron::new(DENTED);
        assert!(!octahedron.is_convex && octahedron.is_sound());
        assert!(!octahedron.contains([0.0, 0.0, -0.25]));
        assert!(octahedron.contains([0.0, 0.0, -0.75]));
        assert!(octahedron.contains([0.0, 0.0, -0.5]));
    }

    #[test]
    fn inside_out_is_convex_with_negative_volume() {
        let mirrored = REGULAR.map(|[x, y, z]| [x, y, -z]);
        let octahedron = Octahedron::new(mirrored);
        assert!(octahedron.is_convex && !octahedron.is_sound());
        // Six times the volume 4/3 of the regular octahedron.
        assert_eq!(octahedron.volume_6(), -8.0);
        assert!(octahedron.contains([0.25, 0.25, 0.25]) && !octahedron.contains([0.5, 0.5, 0.5]));
        let weights = octahedron.coordinates([0.25, 0.125, 0.0]).unwrap();
        assert_reproduces(&mirrored, [0.25, 0.125, 0.0], weights);
    }
}
