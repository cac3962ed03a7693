//! Prisms and hexahedra, whose quadrilateral faces are curved (bilinear).
//!
//! A prism is the image of a triangle times an interval, a hexahedron that of a cube, under the map
//! that is linear along every edge: the weights of the corners are products of the affine
//! coordinates of the factors.

use crate::geometry::tetrahedron_volume_6;
use crate::mesh::{Point, Shape};

/// A prism with its corners in space.
pub struct Prism {
    corners: [Point; 6],
}

/// A hexahedron with its corners in space.
pub struct Hexahedron {
    corners: [Point; 8],
}

/// For each corner of a prism its three neighbours, in the sense in which they span a positive
/// tetrahedron with it.
const PRISM_NEIGHBOURS: [[usize; 3]; 6] = [
    [1, 2, 3],
    [2, 0, 4],
    [0, 1, 5],
    [5, 4, 0],
    [3, 5, 1],
    [4, 3, 2],
];

/// The same for a hexahedron.
const HEXAHEDRON_NEIGHBOURS: [[usize; 3]; 8] = [
    [1, 3, 4],
    [2, 0, 5],
    [3, 1, 6],
    [0, 2, 7],
    [7, 5, 0],
    [4, 6, 1],
    [5, 7, 2],
    [6, 4, 3],
];

impl Prism {
    /// With these corners.
    pub fn new(corners: [Point; 6]) -> Self {
        Self { corners }
    }

    /// Twelve times the signed volume that the faces enclose, the quadrilaterals bilinear.
    pub fn volume_12(&self) -> f64 {
        volume_12(Shape::Prism, &self.corners)
    }

    /// True if at every corner the edges span a positive tetrahedron. The signs are exact.
    pub fn is_sound(&self) -> bool {
        is_sound(&self.corners, &PRISM_NEIGHBOURS)
    }
}

impl Hexahedron {
    /// With these corners.
    pub fn new(corners: [Point; 8]) -> Self {
        Self { corners }
    }

    /// Twelve times the signed volume that the faces enclose, the quadrilaterals bilinear.
    pub fn volume_12(&self) -> f64 {
        volume_12(Shape::Hexahedron, &self.corners)
    }

    /// True if at every corner the edges span a positive tetrahedron. The signs are exact.
    pub fn is_sound(&self) -> bool {
        is_sound(&self.corners, &HEXAHEDRON_NEIGHBOURS)
    }
}

/// What a bilinear face and a point enclose is the mean of what the two pairs of triangles enclose
/// into which the face's diagonals cut it.
fn volume_12(shape: Shape, corners: &[Point]) -> f64 {
    let below = |[a, b, c]: [usize; 3]| {
        tetrahedron_volume_6([corners[0], corners[a], corners[b], corners[c]])
    };
    let triangles = shape.triangles().iter();
    let of_triangles: f64 = triangles.map(|face| 2.0 * below(*face)).sum();
    let quads = shape.quads().iter();
    let of_quads = quads.map(|[a, b, c, d]| {
        let halves = [[*a, *b, *c], [*a, *c, *d], [*a, *b, *d], [*b, *c, *d]];
        halves.map(below).iter().sum::<f64>()
    });
    of_triangles + of_quads.sum::<f64>()
}

fn is_sound<const N: usize>(corners: &[Point; N], neighbours: &[[usize; 3]; N]) -> bool {
    let mut at_corners = neighbours.iter().zip(corners);
    at_corners.all(|([a, b, c], own)| {
        tetrahedron_volume_6([*own, corners[*a], corners[*b], corners[*c]]) > 0.0
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const PRISM: [Point; 6] = [
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, 0.0, 1.0],
        [1.0, 0.0, 1.0],
        [0.0, 1.0, 1.0],
    ];

    const CUBE: [Point; 8] = [
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [1.0, 1.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, 0.0, 1.0],
        [1.0, 0.0, 1.0],
        [1.0, 1.0, 1.0],
        [0.0, 1.0, 1.0],
    ];

    /// Half a cube and a cube. With the corner (1, 1, 1) raised to z = 3 the top is the graph of
    /// z = 1 + 2 x y, so that the volume is 1 + 2/4.
    #[test]
    fn volumes_are_those_worked_out_by_hand() {
        assert_eq!(Prism::new(PRISM).volume_12(), 6.0);
        assert_eq!(Hexahedron::new(CUBE).volume_12(), 12.0);
        let mut raised = CUBE;
        raised[6] = [1.0, 1.0, 3.0];
        assert_eq!(Hexahedron::new(raised).volume_12(), 18.0);
        assert!(Prism::new(PRISM).is_sound());
        assert!(Hexahedron::new(raised).is_sound());
    }

    #[test]
    fn mirrored_cells_are_negative_and_a_fold_is_seen() {
        let mirrored = |[x, y, z]: Point| [x, y, -z];
        assert_eq!(Prism::new(PRISM.map(mirrored)).volume_12(), -6.0);
        assert_eq!(Hexahedron::new(CUBE.map(mirrored)).volume_12(), -12.0);
        // A corner pushed through the opposite one of its face: the volume stays positive.
        let mut folded = CUBE;
        folded[6] = [-0.25, -0.25, 1.0];
        let folded = Hexahedron::new(folded);
        assert!(folded.volume_12() > 0.0 && !folded.is_sound());
        // VTK lists a wedge with its triangles the other way round.
        let [a, b, c, d, e, f] = PRISM;
        assert!(!Prism::new([a, c, b, d, f, e]).is_sound());
    }
}
