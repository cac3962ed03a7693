//! Where the vertices of a control mesh go in the limit.

use crate::blend::Blend;
use crate::mesh::{ControlMesh, MeshError, SurfaceEdges, index};
use crate::surface::features::{
    PointBuffers, Rim, Rule, VertexState, classify, crease_limit, gather_creases, gather_ring,
    prepare,
};

/// Computes the limit positions of the vertices of a mesh of quads (every mesh that
/// [`split`](super::split) wrote is one).
///
/// A smooth vertex of valence `n` with neighbours `e` and vertices `f` across its faces goes to
/// `(n^2 p + 4 sum(e) + sum(f)) / (n (n + 5))`; a vertex on a crease or spline rim to
/// `1/6 4/6 1/6`; corners stay. `points` holds one value for each vertex; the buffers need one
/// element for each vertex and one for each edge. Returns one value for each vertex.
///
/// # Scaling and overflow
///
/// Weights are positive and add up to `n (n + 5)`: sums stay below 2^63 for valences up to 32 000.
///
/// # Errors
///
/// [`MeshError::NotAQuad`]; [`MeshError::ArenaTooSmall`] before anything is written;
/// [`MeshError::OtherNumbering`] if the edges are seen to be of another mesh.
pub fn limit_points<'a, B: Blend>(
    blend: &mut B,
    mesh: &ControlMesh<'_>,
    edges: &SurfaceEdges<'_>,
    rim: Rim,
    points: &[B::Point],
    buffers: PointBuffers<'a, B>,
) -> Result<&'a mut [B::Point], MeshError> {
    if let Some((face, corners)) = mesh.faces().enumerate().find(|(_, face)| face.len() != 4) {
        return Err(MeshError::NotAQuad {
            face,
            corners: corners.len(),
        });
    }
    let old = index(mesh.vertex_count);
    let all = old
        .checked_add(index(edges.count()))
        .ok_or(MeshError::TooLarge)?;
    let PointBuffers { out, sums, states } = prepare(blend, old, all, points, buffers)?;
    classify(mesh, edges, rim, states).ok_or(MeshError::OtherNumbering)?;
    gather_ring(blend, edges, 4, points, sums, states).ok_or(MeshError::OtherNumbering)?;
    gather_across(blend, mesh, points, sums, states).ok_or(MeshError::OtherNumbering)?;
    gather_creases(blend, edges, points, sums, states).ok_or(MeshError::OtherNumbering)?;

    let sums_and_states = sums.iter_mut().zip(states.iter());
    for ((slot, own), (sum, state)) in out.iter_mut().zip(points).zip(sums_and_states) {
        let valence = i64::from(state.edges);
        *slot = match state.rule {
            Rule::Smooth => {
                blend.add(sum, valence.wrapping_mul(valence), own);
                blend.divide(sum, valence.wrapping_mul(valence.wrapping_add(5)))
            }
            Rule::Crease => crease_limit(blend, sum, own),
            Rule::Linear => own.clone(),
        };
    }
    Ok(out.get_mut(..old).unwrap_or_default())
}

/// Adds to every smooth vertex the vertices across its quads.
fn gather_across<B: Blend>(
    blend: &B,
    mesh: &ControlMesh<'_>,
    points: &[B::Point],
    sums: &mut [B::Sum],
    states: &[VertexState],
) -> Option<()> {
    for face in mesh.faces() {
        for (&corner, &across) in face.iter().zip(face.iter().cycle().skip(2)) {
            if states.get(index(corner))?.rule == Rule::Smooth {
                let sum = sums.get_mut(index(corner))?;
                blend.add(sum, 1, points.get(index(across))?);
            }
        }
    }
    Some(())
}
