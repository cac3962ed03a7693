//! Where the vertices of a control mesh go in the limit.

use super::multi_step::{Steps, ring_weight};
use super::numbering::Numbering;
use crate::blend::Blend;
use crate::mesh::{ControlMesh, MeshError, index};
use crate::surface::features::{
    PointBuffers, Rule, crease_limit, gather_creases, gather_ring, prepare,
};

/// Computes the limit positions of the vertices: (7) with infinitely many steps at smooth vertices,
/// `1/6 4/6 1/6` along sharp lines; what stays, stays. The buffers need one element for each vertex.
///
/// # Errors
///
/// [`MeshError::OddBoundary`] for a mesh that is an odd number of steps on and has sharp edges: the
/// rings beside them are not complete; [`MeshError::ArenaTooSmall`];
/// [`MeshError::OtherNumbering`].
pub fn limit_points<'a, B: Blend>(
    blend: &mut B,
    mesh: &ControlMesh<'_>,
    numbering: &Numbering<'_>,
    points: &[B::Point],
    buffers: PointBuffers<'a, B>,
) -> Result<&'a mut [B::Point], MeshError> {
    let old = index(mesh.vertex_count);
    let middles = numbering.states.get(old..).unwrap_or_default();
    if mesh.odd && middles.iter().any(|middle| middle.sharp > 0) {
        return Err(MeshError::OddBoundary);
    }
    let PointBuffers { out, sums, .. } = prepare(blend, old, old, points, buffers)?;
    let gathered = (|| {
        gather_ring(blend, &numbering.edges, 1, points, sums, numbering.states)?;
        gather_creases(blend, &numbering.edges, points, sums, numbering.states)
    })();
    gathered.ok_or(MeshError::OtherNumbering)?;
    let sums_and_states = sums.iter_mut().zip(numbering.states);
    for ((slot, own), (sum, state)) in out.iter_mut().zip(points).zip(sums_and_states) {
        *slot = match state.rule {
            Rule::Smooth => {
                let weight = ring_weight(state.edges, Steps::Limit);
                blend.umbrella(own, sum, i64::from(state.edges), weight)
            }
            Rule::Crease => crease_limit(blend, sum, own),
            Rule::Linear => own.clone(),
        };
    }
    Ok(out)
}
