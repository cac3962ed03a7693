//! The space between a curved quadrilateral and the flat triangles on it.
//!
//! Where triangles of other cells lie on a quadrilateral face with corners a, b, c, d along the
//! diagonal a c, the face itself is the bilinear patch, but the triangles are a b c and a c d. Where
//! the triangles bulge out of the cell, a lens between them and the patch is in no cell. A point of it
//! gets its affine coordinates in the tetrahedron a b c d: on the triangles these are the triangles'
//! own, on the patch the bilinear weights (both are affine combinations of four corners that give the
//! point, and there is only one), so that coordinates are continuous through the lens.
//!
//! Where the triangles bulge into the cell, the lens is in two cells. The lower one has it, which is the
//! one with the triangles; weights then jump at the triangles: by the lens's thickness over the cell's
//! height, and among the quadrilateral's corners by up to a quarter with alternating signs. A posed
//! point jumps by no more than about the warp of the quadrilateral, at rest and posed, which falls by
//! four a level.
//!
//! The patch is where the weights of a and c have the product of those of b and d.

use super::tetrahedron;
use crate::check::FaceUses;
use crate::geometry::{bounds, cross, dot, length, subtract, tetrahedron_volume_6};
use crate::mesh::{Cells, Point, Vertex};
use rstar::RTree;
use rstar::primitives::{GeomWithData, Rectangle};

/// The box of a quadrilateral, with its place.
type LensBox = GeomWithData<Rectangle<Point>, usize>;

/// A lens thinner than this part of its quadrilateral's diagonals is taken as flat: weights in its
/// tetrahedron would lose as many digits as it is thin. Half of the digits are kept either way.
const THINNEST: f64 = 1e-8;

/// The lenses of a solid.
pub(super) struct Lenses {
    /// Corners counter-clockwise from outside of the cell whose face it is, the first and the third on
    /// the diagonal; and that cell.
    quads: Vec<([Vertex; 4], usize)>,
    tree: RTree<LensBox>,
}

impl Lenses {
    /// Finds the quadrilaterals that triangles cover.
    pub fn new(cells: &Cells, points: &[Point]) -> Self {
        let mut quads = Vec::new();
        if !cells.is_tetrahedral() {
            let uses = FaceUses::of(cells);
            for (cell, (shape, corners)) in cells.iter().enumerate() {
                for face in shape.quads() {
                    let face = face.map(|place| corners[place]);
                    quads.extend(along_diagonal(&uses, face).map(|face| (face, cell)));
                }
            }
        }
        let boxes = quads.iter().enumerate().filter_map(|(place, (face, _))| {
            let corners = face.map(|vertex| points[vertex as usize]);
            // The sign is exact. Of a plane quadrilateral it is zero, and positive where the triangles
            // bulge into the cell.
            if tetrahedron_volume_6(corners) >= 0.0 {
                return None;
            }
            let [low, high] = bounds(&corners)?;
            Some(LensBox::new(Rectangle::from_corners(low, high), place))
        });
        let tree = RTree::bulk_load(boxes.collect());
        Self { quads, tree }
    }

    /// The quadrilateral in whose lens the point lies, the cell whose face that is, and weights of its
    /// corners; of several the first.
    pub fn find(&self, points: &[Point], point: Point) -> Option<(usize, [(Vertex, f64); 4])> {
        let candidates = self.tree.locate_all_at_point(point);
        let mut places: Vec<usize> = candidates.map(|candidate| candidate.data).collect();
        places.sort_unstable();
        places.into_iter().find_map(|place| {
            let (face, cell) = self.quads[place];
            let corners = face.map(|vertex| points[vertex as usize]);
            let weights = in_lens(&corners, point)?;
            Some((cell, [0, 1, 2, 3].map(|k| (face[k], weights[k]))))
        })
    }
}

/// The face turned so that its first and third corners are on the diagonal along which triangles
/// cover it, if any do.
fn along_diagonal(uses: &FaceUses, face: [Vertex; 4]) -> Option<[Vertex; 4]> {
    let is_covered = |left_out: usize| uses.on_half(&face, left_out) > 0;
    if is_covered(1) || is_covered(3) {
        return Some(face);
    }
    let [a, b, c, d] = face;
    (is_covered(0) || is_covered(2)).then_some([b, c, d, a])
}

/// The weights of a point between the patch and the triangles along the first diagonal.
fn in_lens(corners: &[Point; 4], point: Point) -> Option<[f64; 4]> {
    if !tetrahedron::contains(corners, point) {
        return None;
    }
    let [a, b, c, d] = *corners;
    let (first, second) = (subtract(c, a), subtract(d, b));
    let normal = cross(first, second);
    let thickness = dot(subtract(b, a), normal).abs() / length(normal);
    if thickness <= THINNEST * length(first).max(length(second)) {
        return Some(in_plane(corners, normal, point));
    }
    let weights = tetrahedron::coordinates(corners, point)?;
    let [of_a, of_b, of_c, of_d] = weights;
    (of_a * of_c >= of_b * of_d).then_some(weights)
}

/// The affine coordinates in the triangle a b c or a c d over which the point lies, seen along
/// `normal`.
fn in_plane([a, b, c, d]: &[Point; 4], normal: Point, point: Point) -> [f64; 4] {
    let area = |p: Point, q: Point, r: Point| dot(cross(subtract(q, p), subtract(r, p)), normal);
    let [of_a, of_third, of_c] = if area(*a, *c, point) <= 0.0 {
        let whole = area(*a, *b, *c);
        [
            area(*b, *c, point),
            area(*c, *a, point),
            area(*a, *b, point),
        ]
        .map(|part| part / whole)
    } else {
        let whole = area(*a, *c, *d);
        [
            area(*c, *d, point),
            area(*a, *c, point),
            area(*d, *a, point),
        ]
        .map(|part| part / whole)
    };
    if area(*a, *c, point) <= 0.0 {
        [of_a, of_third, of_c, 0.0]
    } else {
        [of_a, 0.0, of_c, of_third]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Over the unit square the patch z = x y / 4 is bilinear with corners at (0,0,0), (1,0,0),
    /// (1,1,1/4) and (0,1,0). The triangles along the diagonal from the first to the third corner lie
    /// on z = min(x, y) / 4, above the patch. At (1/2, 1/4) the patch has z = 1/32 and the triangle 1/16.
    /// At z = 3/64 between them the affine weight of c is 4 z =
    /// 3/16, that of b x - 3/16 = 5/16, that of d y - 3/16 = 1/16, that of a the rest, 7/16.
    #[test]
    fn a_point_of_the_lens_has_its_affine_weights() {
        let corners = [
            [0.0, 0.0, 0.0],
            [1.0, 0.0, 0.0],
            [1.0, 1.0, 0.25],
            [0.0, 1.0, 0.0],
        ];
        let inside = in_lens(&corners, [0.5, 0.25, 3.0 / 64.0]);
        assert_eq!(inside, Some([0.4375, 0.3125, 0.1875, 0.0625]));
        // Below the patch, and above the triangle.
        assert_eq!(in_lens(&corners, [0.5, 0.25, 1.0 / 64.0]), None);
        assert_eq!(in_lens(&corners, [0.5, 0.25, 5.0 / 64.0]), None);
        // On the patch the weights are bilinear, on the triangle affine.
        let patch = in_lens(&corners, [0.5, 0.25, 1.0 / 32.0]);
        assert_eq!(patch, Some([0.375, 0.375, 0.125, 0.125]));
        let triangle = in_lens(&corners, [0.5, 0.25, 1.0 / 16.0]);
        assert_eq!(triangle, Some([0.5, 0.25, 0.25, 0.0]));
    }

    /// A nearly plane one, seen from above: the triangles' weights.
    #[test]
    fn a_thin_lens_is_flat() {
        let corners = [
            [0.0, 0.0, 0.0],
            [1.0, 0.0, 0.0],
            [1.0, 1.0, 1e-12],
            [0.0, 1.0, 0.0],
        ];
        let weights = in_lens(&corners, [0.5, 0.25, 0.2e-12]).expect("in the lens");
        for (weight, want) in weights.into_iter().zip([0.5, 0.25, 0.25, 0.0]) {
            assert!((weight - want).abs() < 1e-11, "{weights:?}");
        }
        let weights = in_lens(&corners, [0.25, 0.5, 0.2e-12]).expect("in the lens");
        for (weight, want) in weights.into_iter().zip([0.5, 0.0, 0.25, 0.25]) {
            assert!((weight - want).abs() < 1e-11, "{weights:?}");
        }
    }
}
