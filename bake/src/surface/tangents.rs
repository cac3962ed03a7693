//! Tangents and normals in double precision, not held to any grid.

use crate::mesh::Point;
use octruss::blend::IrrationalWeight;
use octruss::surface::limit_normals::TangentBlend;

/// Tangents of real numbers, with weights in double precision.
#[derive(Clone, Copy, Debug, Default)]
pub struct RealTangents;

fn cross(one: &Point, other: &Point) -> Point {
    let [ax, ay, az] = one;
    let [bx, by, bz] = other;
    [ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx]
}

fn dot(one: &Point, other: &Point) -> f64 {
    one.iter().zip(other).map(|(a, b)| a * b).sum()
}

/// Along a vector; zero for zero.
fn unit(vector: Point) -> Point {
    // Squares of small numbers underflow.
    let [x, y, z] = vector;
    let length = x.hypot(y).hypot(z);
    if length > 0.0 {
        vector.map(|coordinate| coordinate / length)
    } else {
        [0.0; 3]
    }
}

impl TangentBlend for RealTangents {
    type Point = Point;
    type Sum = Point;
    type Normal = Point;

    fn zero(&self) -> Point {
        [0.0; 3]
    }

    fn add(&self, sum: &mut Point, weight: IrrationalWeight, point: &Point, own: &Point) {
        for ((total, to), from) in sum.iter_mut().zip(point).zip(own) {
            *total += weight.real * (to - from);
        }
    }

    fn normal(&mut self, one: &Point, other: &Point) -> Point {
        // Of unit vectors, so that nothing underflows.
        unit(cross(&unit(*one), &unit(*other)))
    }

    fn corner_normal(&mut self, [first, last]: &[Point; 2], crease: &[Point; 2]) -> Point {
        let [along, across] = crease;
        let guide = self.normal(along, across);
        let plane = self.normal(first, last);
        if plane == [0.0; 3] {
            guide
        } else if dot(&plane, &guide) < 0.0 {
            plane.map(|coordinate| -coordinate)
        } else {
            plane
        }
    }

    fn no_normal(&mut self) -> Point {
        [0.0; 3]
    }
}

#[cfg(test)]
mod tests {
    use super::{RealTangents, TangentBlend};

    #[test]
    fn normals_by_hand() {
        let mut blend = RealTangents;
        assert_eq!(
            blend.normal(&[1e-200, 0.0, 0.0], &[0.0, 1e-200, 0.0]),
            [0.0, 0.0, 1.0]
        );
        assert_eq!(blend.normal(&[1.0, 1.0, 0.0], &[2.0, 2.0, 0.0]), [0.0; 3]);
        let across = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        // A concave corner: the edges turn the other way.
        let edges = [[1.0, 0.0, 0.0], [0.0, -1.0, 0.0]];
        assert_eq!(blend.corner_normal(&edges, &across), [0.0, 0.0, 1.0]);
    }
}
