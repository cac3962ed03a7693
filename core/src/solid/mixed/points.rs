//! Values of the refined vertices.
//!
//! Values are gathered into one exact sum for each refined vertex, part by part (cells, surface,
//! creases), and every sum is divided once at the end. So the order of cells does not matter to
//! any bit. Only the clones of the unzip are rounded before, to 8 more bits than are stored.

use super::Boundary;
use super::classify::{Rule, VertexState, classify, index};
use super::gather::{Gather, all_edges};
use super::masks::{COLLAPSE, COMMON_DENOMINATOR};
use super::unzip::{Unzip, VertexDistortion};
use crate::blend::GuardedBlend;
use crate::mesh::{Arena, MeshError, MixedNumbering, Solid, require};
use crate::surface::tri_quad_weights as tri_quad;

/// Where refined values and the scratch to compute them are written.
///
/// `out`, `sums` and `states` each need one element for every vertex of the refined mesh,
/// `distortions` one for every vertex of the mesh that is refined.
#[derive(Debug)]
pub struct PointBuffers<'a, B: GuardedBlend> {
    /// The refined values, in the order of [`MixedNumbering`].
    pub out: &'a mut [B::Point],
    /// Scratch: one sum for each refined vertex.
    pub sums: &'a mut [B::GuardedSum],
    /// Scratch: one state for each refined vertex.
    pub states: &'a mut [VertexState],
    /// Scratch: the distortions of each old vertex.
    pub distortions: &'a mut [VertexDistortion<B::Sum>],
}

/// Computes the values of the refined vertices from the values of the old ones.
///
/// `solid` and `numbering` belong together; `points` holds one value for each old vertex. Returns
/// the filled part of `buffers.out`. The rules are those of the
/// [module documentation](super).
///
/// # Scaling and overflow
///
/// See [`GuardedBlend`]: clones in units of 2^-8 of the last place, rounded once; sums of integer
/// weights times clones, exact in 128 bits; one rounding at the end.
///
/// # Errors
///
/// [`MeshError::ArenaTooSmall`] before anything is written; [`MeshError::OtherNumbering`] if the
/// numbering is seen to be of another solid.
pub fn refine_points<'a, B: GuardedBlend>(
    blend: &mut B,
    solid: &Solid<'_>,
    numbering: &MixedNumbering<'_>,
    boundary: Boundary,
    points: &[B::Point],
    buffers: PointBuffers<'a, B>,
) -> Result<&'a mut [B::Point], MeshError> {
    let old = index(solid.vertex_count);
    let new = index(numbering.vertex_count());
    require(Arena::InputPoints, old, points.len())?;
    require(Arena::OutputPoints, new, buffers.out.len())?;
    require(Arena::Sums, new, buffers.sums.len())?;
    require(Arena::States, new, buffers.states.len())?;
    require(Arena::Distortions, old, buffers.distortions.len())?;
    let out = buffers.out.get_mut(..new).unwrap_or_default();
    let sums = buffers.sums.get_mut(..new).unwrap_or_default();
    let states = buffers.states.get_mut(..new).unwrap_or_default();
    let distortions = buffers.distortions.get_mut(..old).unwrap_or_default();
    let points = points.get(..old).unwrap_or_default();

    sums.fill(blend.guarded_zero());
    states.fill(VertexState::default());
    classify(solid, numbering, boundary, states).ok_or(MeshError::OtherNumbering)?;
    let mut gather = Gather {
        blend: &*blend,
        points,
        sums,
        states,
    };
    gather_all(&mut gather, solid, numbering, distortions).ok_or(MeshError::OtherNumbering)?;

    let mut finish = Finish { blend, points };
    finish
        .all(numbering, sums, states, out)
        .ok_or(MeshError::OtherNumbering)?;
    Ok(out)
}

fn gather_all<B: GuardedBlend>(
    gather: &mut Gather<'_, B>,
    solid: &Solid<'_>,
    numbering: &MixedNumbering<'_>,
    distortions: &mut [VertexDistortion<B::Sum>],
) -> Option<()> {
    let blend = gather.blend;
    let mut unzip = Unzip::new(blend, gather.points, distortions);
    unzip.cells(blend, solid, numbering)?;
    gather.cells(solid, numbering, &unzip)?;

    // The surface has an unzip of its own, from the original vertices. Vertices of creases and corners
    // have no part in it: it would pull one side of a crease toward the other.
    let mut unzip = Unzip::new(blend, gather.points, distortions);
    for ([a, b], middle) in all_edges(numbering) {
        if gather.states.get(index(middle))?.is_mixed_edge() {
            for ends in [[a, b], [b, a]] {
                let [own, _] = ends;
                if gather.states.get(index(own))?.is_smooth() {
                    unzip.surface_edge(blend, ends)?;
                }
            }
        }
    }
    gather.surface(solid, numbering, &unzip)?;
    gather.creases(solid, numbering)
}

/// The divisions at the end, one for each refined vertex.
struct Finish<'a, B: GuardedBlend> {
    blend: &'a mut B,
    points: &'a [B::Point],
}

impl<B: GuardedBlend> Finish<'_, B> {
    fn all(
        &mut self,
        numbering: &MixedNumbering<'_>,
        sums: &mut [B::GuardedSum],
        states: &[VertexState],
        out: &mut [B::Point],
    ) -> Option<()> {
        let old = index(numbering.old_count());
        let edges = numbering.edges().len();
        let quads = index(numbering.quad_vertices());
        let (out_old, out) = out.split_at_mut_checked(old)?;
        let (out_edges, out) = out.split_at_mut_checked(edges)?;
        let (out_quads, out_cells) = out.split_at_mut_checked(quads)?;
        let mut given = sums.iter_mut().zip(states);

        let points = self.points;
        for ((slot, own), (sum, state)) in out_old.iter_mut().zip(points).zip(given.by_ref()) {
            *slot = self.vertex(own, sum, state);
        }
        for ((slot, ends), (sum, state)) in out_edges
            .iter_mut()
            .zip(numbering.edges())
            .zip(given.by_ref())
        {
            *slot = self.middle(ends, sum, state)?;
        }
        // Faces stand in the order of their vertices, but some share one: the first has it.
        let mut faces = numbering.quads().all().iter();
        let vertices = numbering.first_quad()..;
        for ((slot, vertex), (sum, state)) in out_quads.iter_mut().zip(vertices).zip(given.by_ref())
        {
            let face = faces.by_ref().find(|face| face.vertex() == vertex)?;
            *slot = match face.covered_diagonal() {
                Some(ends) => self.middle(&ends, sum, state)?,
                None => self.middle(&face.corners(), sum, state)?,
            };
        }
        for (slot, (sum, state)) in out_cells.iter_mut().zip(given) {
            *slot = self.interior(sum, state);
        }
        Some(())
    }

    /// An old vertex.
    fn vertex(&mut self, own: &B::Point, sum: &mut B::GuardedSum, state: &VertexState) -> B::Point {
        if state.counts == [0; 3] {
            // A vertex without a cell has nothing to be averaged with.
            return own.clone();
        }
        let [count, ..] = state.counts.map(i64::from);
        match state.rule {
            Rule::Linear => own.clone(),
            Rule::Interior => self.interior(sum, state),
            Rule::Surface => self.surface(sum, state),
            Rule::TriangleVertex => {
                // 5/8 of the vertex and 3/8 of the mean of its neighbours. Without an edge to a
                // quadrilateral the vertex is its own clone.
                let mut total = self.blend.guarded_zero();
                self.blend.add_guarded_sum(&mut total, 3, sum);
                let own = self.blend.guard(own);
                self.blend
                    .add_guarded(&mut total, count.wrapping_mul(5), &own);
                self.blend.divide_guarded(&total, count.wrapping_mul(8))
            }
            Rule::Crease => {
                let own = self.blend.guard(own);
                self.blend.add_guarded(sum, 6, &own);
                self.blend.divide_guarded(sum, 8)
            }
        }
    }

    /// The middle of an edge or of a quadrilateral face with these corners.
    fn middle(
        &mut self,
        corners: &[u32],
        sum: &B::GuardedSum,
        state: &VertexState,
    ) -> Option<B::Point> {
        Some(match state.rule {
            Rule::Interior if state.counts != [0; 3] => self.interior(sum, state),
            Rule::Surface => self.surface(sum, state),
            // Sheets that follow no surface rule are split linearly.
            Rule::Linear | Rule::Crease | Rule::Interior | Rule::TriangleVertex => {
                let mut total = self.blend.zero();
                for &corner in corners {
                    self.blend
                        .add(&mut total, 1, self.points.get(index(corner))?);
                }
                let count = i64::try_from(corners.len()).unwrap_or(i64::MAX);
                self.blend.divide(&total, count)
            }
        })
    }

    /// The collapse of (5.3.2).
    fn interior(&mut self, sum: &B::GuardedSum, state: &VertexState) -> B::Point {
        let weight = weighted(&state.counts, &COLLAPSE);
        self.blend
            .divide_guarded(sum, weight.wrapping_mul(COMMON_DENOMINATOR))
    }

    /// The collapse of the surface's faces.
    fn surface(&mut self, sum: &B::GuardedSum, state: &VertexState) -> B::Point {
        let weight = weighted(&state.counts, &tri_quad::COLLAPSE);
        self.blend
            .divide_guarded(sum, weight.wrapping_mul(tri_quad::DENOMINATOR))
    }
}

/// The sum of counts times weights.
fn weighted(counts: &[u32], weights: &[i64]) -> i64 {
    counts
        .iter()
        .zip(weights)
        .fold(0, |sum: i64, (&count, weight)| {
            sum.wrapping_add(weight.wrapping_mul(i64::from(count)))
        })
}
