//! Values of the refined vertices.

use crate::blend::Blend;
use crate::mesh::{ControlMesh, MeshError, SurfaceEdges, index};
use crate::surface::LoopWeights;
use crate::surface::features::{
    PointBuffers, Rim, Rule, VertexState, classify, crease_vertex, gather_creases, gather_ring,
    halfway, prepare,
};
use crate::surface::loop_weights::WeightCache;
use crate::surface::split::{require_triangles, same_mesh};

/// Computes the values of the refined vertices: old vertices, then edge midpoints.
///
/// `edges` belongs to `mesh`; `points` holds one value for each old vertex. Returns the filled part
/// of `buffers.out`. The rules are those of the [module documentation](super); each result is the
/// exact value of its mask, rounded once.
///
/// # Scaling and overflow
///
/// Weights are positive or zero and add up to the denominator (8, 8 for an edge, at most
/// `8 n` or 2^30 for a vertex), so sums of 32-bit coordinates stay below 2^61.
///
/// # Errors
///
/// [`MeshError::NotATriangle`] and [`MeshError::ArenaTooSmall`] before anything is written;
/// [`MeshError::OtherNumbering`] if the edges are seen to be of another mesh.
pub fn refine_points<'a, B: Blend>(
    blend: &mut B,
    mesh: &ControlMesh<'_>,
    edges: &SurfaceEdges<'_>,
    weights: LoopWeights,
    rim: Rim,
    points: &[B::Point],
    buffers: PointBuffers<'a, B>,
) -> Result<&'a mut [B::Point], MeshError> {
    require_triangles(mesh)?;
    if !same_mesh(mesh, edges, mesh.face_count()) {
        return Err(MeshError::OtherNumbering);
    }
    let old = index(mesh.vertex_count);
    let new = old
        .checked_add(index(edges.count()))
        .ok_or(MeshError::TooLarge)?;
    let PointBuffers { out, sums, states } = prepare(blend, old, new, points, buffers)?;
    classify(mesh, edges, rim, states).ok_or(MeshError::OtherNumbering)?;
    gather_opposite(blend, mesh, edges, points, sums, states).ok_or(MeshError::OtherNumbering)?;
    gather_ring(blend, edges, 1, points, sums, states).ok_or(MeshError::OtherNumbering)?;
    gather_creases(blend, edges, points, sums, states).ok_or(MeshError::OtherNumbering)?;

    let mut weights = WeightCache::new(weights);
    let sums_and_states = sums.iter_mut().zip(states.iter());
    for ((slot, own), (sum, state)) in out.iter_mut().zip(points).zip(sums_and_states) {
        *slot = match state.rule {
            Rule::Smooth => {
                let weight = weights.neighbour(state.edges);
                blend.umbrella(own, sum, i64::from(state.edges), weight)
            }
            Rule::Crease => crease_vertex(blend, sum, own),
            Rule::Linear => own.clone(),
        };
    }
    finish_edges(blend, edges, points, sums, states, out).ok_or(MeshError::OtherNumbering)?;
    Ok(out)
}

/// Adds to every smooth edge the vertices opposite.
fn gather_opposite<B: Blend>(
    blend: &B,
    mesh: &ControlMesh<'_>,
    edges: &SurfaceEdges<'_>,
    points: &[B::Point],
    sums: &mut [B::Sum],
    states: &[VertexState],
) -> Option<()> {
    for face in mesh.faces() {
        let &[a, b, c] = face else { continue };
        for (from, to, opposite) in [(a, b, c), (b, c, a), (c, a, b)] {
            let middle = index(edges.midpoint(from, to)?);
            if states.get(middle)?.rule == Rule::Smooth {
                blend.add(sums.get_mut(middle)?, 1, points.get(index(opposite))?);
            }
        }
    }
    Some(())
}

fn finish_edges<B: Blend>(
    blend: &mut B,
    edges: &SurfaceEdges<'_>,
    points: &[B::Point],
    sums: &mut [B::Sum],
    states: &[VertexState],
    out: &mut [B::Point],
) -> Option<()> {
    let old = index(edges.old_count());
    let sums_and_states = sums.get_mut(old..)?.iter_mut().zip(states.get(old..)?);
    let slots = out.get_mut(old..)?.iter_mut().zip(edges.ends());
    for ((slot, ends), (sum, state)) in slots.zip(sums_and_states) {
        *slot = if state.rule == Rule::Smooth {
            for end in ends {
                blend.add(sum, 3, points.get(index(end))?);
            }
            blend.divide(sum, 8)
        } else {
            halfway(blend, ends, points)?
        };
    }
    Some(())
}
