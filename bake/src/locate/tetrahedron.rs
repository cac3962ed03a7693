//! Affine coordinates in a tetrahedron.

use crate::geometry::{add_scaled, cross, dot, subtract, tetrahedron_volume_6};
use crate::mesh::Point;
use octruss::mesh::TETRAHEDRON_FACES;

/// True if the point lies in the closed tetrahedron, decided exactly. A tetrahedron without volume
/// contains nothing; one that is turned inside out contains what its faces enclose.
pub fn contains(corners: &[Point; 4], point: Point) -> bool {
    if tetrahedron_volume_6(*corners) == 0.0 {
        return false;
    }
    let sides = TETRAHEDRON_FACES
        .map(|face| crate::geometry::inside_of_face(face.map(|i| corners[i]), point));
    sides.iter().all(|side| *side >= 0.0) || sides.iter().all(|side| *side <= 0.0)
}

/// The affine coordinates of a point anywhere in space; `None` if the tetrahedron has no volume.
///
/// They sum to one, and the corners so weighted give the point back to within a few roundings of
/// its coordinates' magnitude, however flat the tetrahedron is.
pub fn coordinates(corners: &[Point; 4], point: Point) -> Option<[f64; 4]> {
    let offset = subtract(point, corners[0]);
    let mut weights = moving(corners, offset)?;
    weights[0] += 1.0;
    // What a flat tetrahedron lost is found again in the point that the weights give.
    let missing = subtract(point, combine(corners, &weights));
    for (weight, change) in weights.iter_mut().zip(moving(corners, missing)?) {
        *weight += change;
    }
    Some(weights)
}

/// The change of coordinates that moves the point they describe by `offset`; sums to zero.
pub fn moving(corners: &[Point; 4], offset: Point) -> Option<[f64; 4]> {
    let [a, b, c] = [1, 2, 3].map(|corner| subtract(corners[corner], corners[0]));
    let volume = dot(a, cross(b, c));
    let weights = [
        dot(offset, cross(b, c)),
        dot(offset, cross(c, a)),
        dot(offset, cross(a, b)),
    ]
    .map(|part| part / volume);
    let [x, y, z] = weights;
    weights
        .iter()
        .all(|weight| weight.is_finite())
        .then_some([-(x + y + z), x, y, z])
}

/// The corners so weighted.
pub fn combine<const N: usize>(corners: &[Point; N], weights: &[f64; N]) -> Point {
    corners
        .iter()
        .zip(weights)
        .fold([0.0; 3], |sum, (corner, weight)| {
            add_scaled(sum, *weight, *corner)
        })
}
