//! Where the vertices of a control mesh go in the limit.

use crate::blend::{Blend, NeighbourWeight};
use crate::mesh::{ControlMesh, MeshError, SurfaceEdges, index};
use crate::surface::LoopWeights;
use crate::surface::features::{
    PointBuffers, Rim, Rule, classify, crease_limit, gather_creases, gather_ring, prepare,
};
use crate::surface::irrational::irrational;
use crate::surface::split::require_triangles;

/// Computes the limit positions of the vertices.
///
/// A smooth vertex whose neighbours have the weight `beta` in the refinement gives each of them
/// `beta / (3/8 + n beta)` in the limit; a vertex on a crease or spline rim goes to `1/6 4/6 1/6`;
/// corners stay. `points` holds one value for each vertex; the buffers need one element for each
/// vertex and one for each edge. Returns one value for each vertex, rounded once.
///
/// # Scaling and overflow
///
/// As in [`refine_points`](super::refine_points).
///
/// # Errors
///
/// [`MeshError::NotATriangle`] and [`MeshError::ArenaTooSmall`] before anything is written;
/// [`MeshError::OtherNumbering`] if the edges are seen to be of another mesh.
pub fn limit_points<'a, B: Blend>(
    blend: &mut B,
    mesh: &ControlMesh<'_>,
    edges: &SurfaceEdges<'_>,
    weights: LoopWeights,
    rim: Rim,
    points: &[B::Point],
    buffers: PointBuffers<'a, B>,
) -> Result<&'a mut [B::Point], MeshError> {
    require_triangles(mesh)?;
    let old = index(mesh.vertex_count);
    let all = old
        .checked_add(index(edges.count()))
        .ok_or(MeshError::TooLarge)?;
    let PointBuffers { out, sums, states } = prepare(blend, old, all, points, buffers)?;
    classify(mesh, edges, rim, states).ok_or(MeshError::OtherNumbering)?;
    gather_ring(blend, edges, 1, points, sums, states).ok_or(MeshError::OtherNumbering)?;
    gather_creases(blend, edges, points, sums, states).ok_or(MeshError::OtherNumbering)?;
    let sums_and_states = sums.iter_mut().zip(states.iter());
    for ((slot, own), (sum, state)) in out.iter_mut().zip(points).zip(sums_and_states) {
        *slot = match state.rule {
            Rule::Smooth => {
                let weight = limit_weight(weights, state.edges);
                blend.umbrella(own, sum, i64::from(state.edges), weight)
            }
            Rule::Crease => crease_limit(blend, sum, own),
            Rule::Linear => own.clone(),
        };
    }
    Ok(out.get_mut(..old).unwrap_or_default())
}

/// `beta / (3/8 + n beta)`: exact where `beta` is, else the real number rounded to 2^-30.
#[must_use]
pub fn limit_weight(weights: LoopWeights, valence: u32) -> NeighbourWeight {
    match weights.neighbour(valence) {
        NeighbourWeight::Exact {
            numerator,
            denominator,
        } => {
            let ring = i64::from(valence).wrapping_mul(numerator);
            NeighbourWeight::Exact {
                numerator: numerator.wrapping_mul(8),
                denominator: denominator
                    .wrapping_mul(3)
                    .wrapping_add(ring.wrapping_mul(8)),
            }
        }
        NeighbourWeight::Irrational { real, .. } => {
            let (bits, real) = irrational(limit_real(real, valence));
            NeighbourWeight::Irrational { bits, real }
        }
    }
}

#[expect(
    clippy::float_arithmetic,
    reason = "an irrational weight is made in double precision, once for its valence"
)]
fn limit_real(beta: f64, valence: u32) -> f64 {
    beta / (0.375 + f64::from(valence) * beta)
}
