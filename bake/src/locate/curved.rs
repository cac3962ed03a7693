//! Prisms and hexahedra, whose quadrilateral faces are curved (bilinear).
//!
//! A prism is the image of a triangle times an interval, a hexahedron that of a cube, under the map
//! that is linear along every edge: the weights of the corners are products of the affine
//! coordinates of the factors. What of a point's weights is wanted here is found by [`super::inverse`].

use super::inverse::{Map, Parameters};
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

/// The parameters are two affine coordinates of the triangle, of the corners 1 and 2, and the
/// height over it.
impl Map<6> for Prism {
    const CORNERS: [Parameters; 6] = [
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, 0.0, 1.0],
        [1.0, 0.0, 1.0],
        [0.0, 1.0, 1.0],
    ];

    fn corners(&self) -> &[Point; 6] {
        &self.corners
    }

    fn weights([r, s, t]: Parameters) -> [f64; 6] {
        let low = [1.0 - r - s, r, s];
        let [a, b, c] = low.map(|weight| weight * (1.0 - t));
        let [d, e, f] = low.map(|weight| weight * t);
        [a, b, c, d, e, f]
    }

    fn derivatives([r, s, t]: Parameters) -> [[f64; 6]; 3] {
        let low = 1.0 - t;
        let first = 1.0 - r - s;
        [
            [-low, low, 0.0, -t, t, 0.0],
            [-low, 0.0, low, -t, 0.0, t],
            [-first, -r, -s, first, r, s],
        ]
    }

    fn clamped([r, s, t]: Parameters) -> Parameters {
        let (r, s, t) = (r.max(0.0), s.max(0.0), t.clamp(0.0, 1.0));
        let over = r + s - 1.0;
        if over <= 0.0 {
            return [r, s, t];
        }
        // The nearest point of the slanted edge.
        let r = (r - over / 2.0).clamp(0.0, 1.0);
        [r, 1.0 - r, t]
    }

    /// Four triangles, each at both heights.
    fn parts(corners: &[Parameters; 6]) -> Vec<[Parameters; 6]> {
        let [a, b, c, d, e, f] = *corners;
        let layers = [
            [a, b, c, middle(a, d), middle(b, e), middle(c, f)],
            [middle(a, d), middle(b, e), middle(c, f), d, e, f],
        ];
        let four = |[a, b, c, d, e, f]: [Parameters; 6]| {
            let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
            let (de, ef, fd) = (middle(d, e), middle(e, f), middle(f, d));
            [
                [a, ab, ca, d, de, fd],
                [ab, b, bc, de, e, ef],
                [ca, bc, c, fd, ef, f],
                [ab, bc, ca, de, ef, fd],
            ]
        };
        layers.into_iter().flat_map(four).collect()
    }
}

/// The parameters are the coordinates in the unit cube whose corners are numbered alike.
impl Map<8> for Hexahedron {
    const CORNERS: [Parameters; 8] = [
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [1.0, 1.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, 0.0, 1.0],
        [1.0, 0.0, 1.0],
        [1.0, 1.0, 1.0],
        [0.0, 1.0, 1.0],
    ];

    fn corners(&self) -> &[Point; 8] {
        &self.corners
    }

    fn weights(at: Parameters) -> [f64; 8] {
        Self::CORNERS.map(|corner| {
            let factors = [0, 1, 2].map(|axis| factor(corner[axis], at[axis]));
            factors.iter().product()
        })
    }

    fn derivatives(at: Parameters) -> [[f64; 8]; 3] {
        [0, 1, 2].map(|along| {
            Self::CORNERS.map(|corner| {
                let factors = [0, 1, 2].map(|axis| match axis == along {
                    true => 2.0 * corner[axis] - 1.0,
                    false => factor(corner[axis], at[axis]),
                });
                factors.iter().product()
            })
        })
    }

    fn clamped(at: Parameters) -> Parameters {
        at.map(|coordinate| coordinate.clamp(0.0, 1.0))
    }

    /// Eight boxes.
    fn parts(corners: &[Parameters; 8]) -> Vec<[Parameters; 8]> {
        let centre = middle(corners[0], corners[6]);
        let eighth = |own: Parameters| {
            Self::CORNERS.map(|corner| {
                [0, 1, 2].map(|axis| {
                    let (low, high) = (own[axis].min(centre[axis]), own[axis].max(centre[axis]));
                    if corner[axis] == 0.0 { low } else { high }
                })
            })
        };
        corners.iter().map(|own| eighth(*own)).collect()
    }
}

/// The affine coordinate of the end 0 or 1 of the unit interval.
fn factor(end: f64, at: f64) -> f64 {
    if end == 0.0 { 1.0 - at } else { at }
}

fn middle(a: Parameters, b: Parameters) -> Parameters {
    [0, 1, 2].map(|axis| f64::midpoint(a[axis], b[axis]))
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
