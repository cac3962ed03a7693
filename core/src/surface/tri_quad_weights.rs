//! The triangle/quadrilateral scheme of Schaefer and Warren, as Hakenberg's example 5.2 has it.
//!
//! Unzip: where triangles and quadrilaterals share edges at a vertex, triangles see it moved by
//! `1/24 (mean of the other ends - vertex)` over those edges, quadrilaterals moved the other way
//! (5.3.3). Then both are split linearly, every new face averages its corners (a triangle by
//! `1/4 3/8 3/8`, a quadrilateral evenly), and what new faces say of the same vertex is averaged
//! with the weights 1/6 for triangles and 1/4 for quadrilaterals.
//!
//! This module has the weights, for each old face and each of its refined vertices: what the
//! corners give to the sum over the new faces that meet there. All sums are in sixteenths for each
//! new face.
//!
//! On triangles alone a vertex with `n` neighbours gets `3/(8n)` of each
//! ([`LoopWeights::TriQuad`](super::LoopWeights)); on quadrilaterals alone the scheme is
//! Catmull-Clark's at valence 4.

/// An even denominator of every sum, for each new face.
pub(crate) const DENOMINATOR: i64 = 16;

/// The denominator of the distortion.
pub(crate) const UNZIP_DENOMINATOR: u32 = 24;

/// How a new triangle and a new quadrilateral count against each other where they meet: as 1/6 to
/// 1/4.
pub(crate) const COLLAPSE: [i64; 2] = [2, 3];

/// A triangle and its corner: the corner, then the others; one new face.
pub(crate) const TRIANGLE_CORNER: [i64; 3] = [10, 3, 3];

/// A triangle and the midpoint of an edge: the ends, then the corner opposite.
pub(crate) const TRIANGLE_EDGE: [i64; 3] = [18, 18, 12];

/// New triangles of a triangle that meet at the midpoint of an edge.
pub(crate) const TRIANGLE_EDGE_FACES: u32 = 3;

/// A quadrilateral and its corner: the corner, its neighbour, the corner opposite, its other
/// neighbour; one new face.
pub(crate) const QUAD_CORNER: [i64; 4] = [9, 3, 1, 3];

/// A quadrilateral and the midpoint of an edge: the ends, then the other two corners.
pub(crate) const QUAD_EDGE: [i64; 4] = [12, 12, 4, 4];

/// New quadrilaterals of a quadrilateral that meet at the midpoint of an edge.
pub(crate) const QUAD_EDGE_FACES: u32 = 2;

/// A quadrilateral and its middle.
pub(crate) const QUAD_MIDDLE: [i64; 4] = [16; 4];

/// New quadrilaterals of a quadrilateral that meet in its middle.
pub(crate) const QUAD_MIDDLE_FACES: u32 = 4;

#[cfg(test)]
#[expect(
    clippy::indexing_slicing,
    clippy::as_conversions,
    reason = "small numbers and places of short rows"
)]
mod tests {
    use super::*;

    /// The weights again, from the split and the averaging matrices of example 5.2: positions of
    /// the refined vertices as rows over the corners in quarters, averaged over the new faces.
    #[test]
    fn weights_follow_from_split_and_averaging() {
        let middle = |a: [i64; 3], b: [i64; 3]| [0, 1, 2].map(|k| (a[k] + b[k]) / 2);
        let [a, b, c] = [[4, 0, 0], [0, 4, 0], [0, 0, 4]];
        let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
        // 1/4 own + 3/8 others, in thirty-seconds.
        let smooth = |own: [i64; 3], one: [i64; 3], two: [i64; 3]| {
            [0, 1, 2].map(|k| 2 * own[k] + 3 * one[k] + 3 * two[k])
        };
        assert_eq!(smooth(a, ab, ca), TRIANGLE_CORNER.map(|weight| 2 * weight));
        let at_edge = [smooth(ab, a, ca), smooth(ab, b, bc), smooth(ab, bc, ca)];
        let sum = [0, 1, 2].map(|k| at_edge.iter().map(|row| row[k]).sum::<i64>());
        assert_eq!(sum, TRIANGLE_EDGE.map(|weight| 2 * weight));

        let corner = |k: usize| [0, 1, 2, 3].map(|j| if j == k { 4 } else { 0 });
        let mean = |rows: &[[i64; 4]]| {
            [0, 1, 2, 3].map(|k| rows.iter().map(|row| row[k]).sum::<i64>() / rows.len() as i64)
        };
        let middle = mean(&[corner(0), corner(1), corner(2), corner(3)]);
        let edge = |k: usize| mean(&[corner(k), corner((k + 1) % 4)]);
        // A new face's even average, in sixteenths.
        let face = |k: usize| {
            let rows = [corner(k), edge(k), middle, edge((k + 3) % 4)];
            [0, 1, 2, 3].map(|j| rows.iter().map(|row| row[j]).sum::<i64>())
        };
        assert_eq!(face(0), QUAD_CORNER);
        let two = [0, 1, 2, 3].map(|j| face(0)[j] + face(1)[j]);
        assert_eq!(two, QUAD_EDGE);
        let four = [0, 1, 2, 3].map(|j| (0..4).map(|k| face(k)[j]).sum::<i64>());
        assert_eq!(four, QUAD_MIDDLE);
    }
}
