//! Values of the refined vertices: the interior masks, and the shared rules for the rest.

use super::masks::{Contribution, DENOMINATOR, OCTAHEDRON, TETRAHEDRON};
use super::split::{octahedron_vertices, tetrahedron_vertices};
use super::{Boundary, PointBuffers};
use crate::blend::Blend;
use crate::mesh::{MeshError, Numbering, Solid};
use crate::solid::rules::{self, Gather, Interior};

/// Computes the values of the refined vertices from the values of the old ones.
///
/// `solid` and `numbering` belong together; `points` holds one value for each old vertex. Returns
/// the filled part of `buffers.out`. The rules are those of the
/// [module documentation](super); each result is the exact value of its mask on `points`, divided
/// (and, for fixed-point types, rounded) once.
///
/// # Scaling and overflow
///
/// See [`FixedBlend`](crate::blend::FixedBlend): sums of integer weights times 32-bit
/// coordinates, exact in 64 bits.
///
/// # Errors
///
/// [`MeshError::ArenaTooSmall`] before anything is written; [`MeshError::OtherNumbering`] if the
/// numbering is seen to be of another solid.
pub fn refine_points<'a, B: Blend>(
    blend: &mut B,
    solid: &Solid<'_>,
    numbering: &Numbering<'_>,
    boundary: Boundary,
    points: &[B::Point],
    buffers: PointBuffers<'a, B>,
) -> Result<&'a mut [B::Point], MeshError> {
    rules::refine_points(
        blend,
        &SmoothedCells,
        solid,
        numbering,
        boundary,
        points,
        buffers,
    )
}

/// The interior rule: the mean of the smoothed cells.
struct SmoothedCells;

impl<B: Blend> Interior<B> for SmoothedCells {
    fn gather(
        &self,
        gather: &mut Gather<'_, B>,
        solid: &Solid<'_>,
        numbering: &Numbering<'_>,
    ) -> Option<()> {
        for cell in solid.tetrahedra {
            let vertices = tetrahedron_vertices(cell, numbering)?;
            add_cell(gather, cell, &vertices, &TETRAHEDRON)?;
        }
        for (place, centroid) in numbering.centroids() {
            let cell = solid.octahedra.get(place)?;
            let vertices = octahedron_vertices(cell, centroid, numbering)?;
            add_cell(gather, cell, &vertices, &OCTAHEDRON)?;
        }
        Some(())
    }

    fn vertex(&self, blend: &mut B, _own: &B::Point, sum: &B::Sum, count: i64) -> B::Point {
        blend.divide(sum, count.wrapping_mul(DENOMINATOR))
    }

    fn midpoint(&self, blend: &mut B, _ends: &B::Sum, sum: &B::Sum, count: i64) -> B::Point {
        blend.divide(sum, count.wrapping_mul(DENOMINATOR))
    }

    fn centroid(&self, blend: &mut B, sum: &B::Sum, count: i64) -> B::Point {
        blend.divide(sum, count.wrapping_mul(DENOMINATOR))
    }
}

/// What a cell gives to its refined vertices.
fn add_cell<B: Blend, const CORNERS: usize>(
    gather: &mut Gather<'_, B>,
    cell: &[u32; CORNERS],
    vertices: &[u32],
    contributions: &[Contribution<CORNERS>],
) -> Option<()> {
    for (&vertex, contribution) in vertices.iter().zip(contributions) {
        let weighted = contribution
            .weights
            .iter()
            .copied()
            .zip(cell.iter().copied());
        gather.interior(vertex, contribution.cells, weighted)?;
    }
    Some(())
}
