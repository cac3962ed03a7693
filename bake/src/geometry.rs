//! Vectors of three doubles, and the exact question on which side of a plane a point lies.

use crate::mesh::Point;
use robust::{Coord3D, orient3d};

/// `a - b`.
pub fn subtract(a: Point, b: Point) -> Point {
    std::array::from_fn(|axis| a[axis] - b[axis])
}

/// `a + factor * b`.
pub fn add_scaled(a: Point, factor: f64, b: Point) -> Point {
    std::array::from_fn(|axis| a[axis] + factor * b[axis])
}

/// The scalar product.
pub fn dot(a: Point, b: Point) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The vector product.
pub fn cross(a: Point, b: Point) -> Point {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

/// The Euclidean length.
pub fn length(a: Point) -> f64 {
    dot(a, a).sqrt()
}

/// The vector of length one in the same direction; the zero vector stays.
pub fn normalised(a: Point) -> Point {
    let length = length(a);
    if length > 0.0 {
        a.map(|coordinate| coordinate / length)
    } else {
        a
    }
}

/// Positive if `point` lies on the inner side of the plane through a face whose corners run
/// counter-clockwise from outside, negative on the outer side, zero on it. The sign is exact.
pub fn inside_of_face(face: [Point; 3], point: Point) -> f64 {
    let coordinates = |[x, y, z]: Point| Coord3D { x, y, z };
    orient3d(
        coordinates(face[0]),
        coordinates(face[1]),
        coordinates(face[2]),
        coordinates(point),
    )
}

/// Six times the signed volume of a tetrahedron. The sign is exact.
pub fn tetrahedron_volume_6([a, b, c, d]: [Point; 4]) -> f64 {
    -inside_of_face([a, b, c], d)
}

/// The least and the greatest coordinates of some points; `None` if there are none.
pub fn bounds<'a>(points: impl IntoIterator<Item = &'a Point>) -> Option<[Point; 2]> {
    points.into_iter().fold(None, |bounds, point| {
        let [low, high] = bounds.unwrap_or([*point; 2]);
        Some([
            std::array::from_fn(|axis| low[axis].min(point[axis])),
            std::array::from_fn(|axis| high[axis].max(point[axis])),
        ])
    })
}
