//! Values of the refined vertices: rules (3.3) to (3.8) and those of appendix A.

use super::neighbours::Neighbours;
use super::{Boundary, PointBuffers, Scheme};
use crate::blend::Blend;
use crate::mesh::{MeshError, Numbering, Solid};
use crate::solid::rules::{self, Gather, Interior};

/// Computes the values of the refined vertices from the values of the old ones.
///
/// `solid`, `numbering` and `neighbours` belong together; `points` holds one value for each old
/// vertex. Returns the filled part of `buffers.out`. The rules are those of the
/// [module documentation](super); each result is the exact value of its mask on `points`, divided
/// (and, for fixed-point types, rounded) once.
///
/// # Scaling and overflow
///
/// Every weight is positive and a mask adds up to one, so a sum over the denominator `d` is
/// below `2^31 d`. `d` is at most `16 k` at a vertex or an edge with `k` neighbours, and `72 k` and
/// `96 k` in the averaged scheme, whose neighbours weigh up to 3 and 4: 64 bits hold it for
/// any mesh with 32-bit indices. No result lies outside the range of its inputs, so refinement
/// never saturates.
///
/// # Errors
///
/// [`MeshError::ArenaTooSmall`] before anything is written; [`MeshError::OtherNumbering`] if the
/// numbering or the neighbours are seen to be of another solid.
pub fn refine_points<'a, B: Blend>(
    blend: &mut B,
    solid: &Solid<'_>,
    numbering: &Numbering<'_>,
    neighbours: &Neighbours<'_>,
    boundary: Boundary,
    points: &[B::Point],
    buffers: PointBuffers<'a, B>,
) -> Result<&'a mut [B::Point], MeshError> {
    rules::refine_points(
        blend, neighbours, solid, numbering, boundary, points, buffers,
    )
}

/// Weight of a neighbour across an octahedron.
const ACROSS: u32 = 1;

impl Scheme<'_> {
    /// Weight of a neighbour at the other end of an edge, against [`ACROSS`].
    fn along_edge(&self) -> u32 {
        match self {
            Self::MajorDiagonals(_) => 1,
            Self::Averaged => 3,
        }
    }

    /// Weight of a neighbour that is next to both ends of an edge, against [`ACROSS`].
    fn beside_edge(&self) -> u32 {
        match self {
            Self::MajorDiagonals(_) => 1,
            Self::Averaged => 4,
        }
    }
}

impl<B: Blend> Interior<B> for Neighbours<'_> {
    fn gather(
        &self,
        gather: &mut Gather<'_, B>,
        solid: &Solid<'_>,
        numbering: &Numbering<'_>,
    ) -> Option<()> {
        self.beside_edges(gather, numbering)?;
        self.along_edges(gather, numbering)?;
        self.across_octahedra(gather, numbering)?;
        self.centroids(gather, solid, numbering)
    }

    fn vertex(&self, blend: &mut B, own: &B::Point, sum: &B::Sum, count: i64) -> B::Point {
        let mut total = blend.zero();
        blend.add(&mut total, count.wrapping_mul(9), own);
        blend.add_sum(&mut total, 7, sum);
        blend.divide(&total, count.wrapping_mul(16))
    }

    fn midpoint(&self, blend: &mut B, ends: &B::Sum, sum: &B::Sum, count: i64) -> B::Point {
        let (end, neighbour, denominator) = match (self.scheme, count) {
            (Scheme::MajorDiagonals(_), 4) => (2, 1, 8),
            (Scheme::MajorDiagonals(_), k) => (k.wrapping_mul(5), 6, k.wrapping_mul(16)),
            (Scheme::Averaged, weights) => (weights.wrapping_mul(7), 10, weights.wrapping_mul(24)),
        };
        let mut total = blend.zero();
        blend.add_sum(&mut total, end, ends);
        blend.add_sum(&mut total, neighbour, sum);
        blend.divide(&total, denominator)
    }

    fn centroid(&self, blend: &mut B, sum: &B::Sum, count: i64) -> B::Point {
        blend.divide(sum, count)
    }
}

impl Neighbours<'_> {
    /// The third corners of triangles, to the midpoints of their edges.
    fn beside_edges<B: Blend>(
        &self,
        gather: &mut Gather<'_, B>,
        numbering: &Numbering<'_>,
    ) -> Option<()> {
        let weight = self.scheme.beside_edge();
        for &[a, b, c] in self.triangles {
            for (from, to, third) in [(a, b, c), (b, c, a), (c, a, b)] {
                let middle = numbering.midpoint(from, to)?;
                gather.mark_cell_edge(middle)?;
                gather.interior(middle, weight, [(i64::from(weight), third)])?;
            }
        }
        Some(())
    }

    /// The other ends of cells' edges, to old vertices.
    fn along_edges<B: Blend>(
        &self,
        gather: &mut Gather<'_, B>,
        numbering: &Numbering<'_>,
    ) -> Option<()> {
        let weight = self.scheme.along_edge();
        for (&[a, b], middle) in numbering.edges().iter().zip(numbering.old_count()..) {
            if gather.is_cell_edge(middle)? {
                gather.interior(a, weight, [(i64::from(weight), b)])?;
                gather.interior(b, weight, [(i64::from(weight), a)])?;
            }
        }
        Some(())
    }

    /// The far ends of diagonals, to old vertices and to midpoints of edges beside them.
    fn across_octahedra<B: Blend>(
        &self,
        gather: &mut Gather<'_, B>,
        numbering: &Numbering<'_>,
    ) -> Option<()> {
        for [p, q] in self.diagonals() {
            let is_edge = match numbering.midpoint(p, q) {
                Some(middle) => gather.is_cell_edge(middle)?,
                None => false,
            };
            if !is_edge {
                gather.interior(p, ACROSS, [(i64::from(ACROSS), q)])?;
                gather.interior(q, ACROSS, [(i64::from(ACROSS), p)])?;
            }
        }
        for ([end, corner], far) in self.across() {
            let middle = numbering.midpoint(end, corner)?;
            gather.interior(middle, ACROSS, [(i64::from(ACROSS), far)])?;
        }
        Some(())
    }

    /// An octahedron's corners, those of its major diagonal twice, to its centroid.
    fn centroids<B: Blend>(
        &self,
        gather: &mut Gather<'_, B>,
        solid: &Solid<'_>,
        numbering: &Numbering<'_>,
    ) -> Option<()> {
        for (place, centroid) in numbering.centroids() {
            let corners = solid.octahedra.get(place)?;
            let once = corners.iter().map(|&corner| (1, corner));
            gather.interior(centroid, 6, once)?;
            if let Scheme::MajorDiagonals(diagonals) = self.scheme {
                let pair = usize::from(*diagonals.octahedra.get(place)?);
                let ends = corners.iter().skip(pair).step_by(3).take(2);
                gather.interior(centroid, 2, ends.map(|&end| (1, end)))?;
            }
        }
        Some(())
    }
}
