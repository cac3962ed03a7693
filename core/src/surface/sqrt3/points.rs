//! Values of the refined vertices.

use super::numbering::Numbering;
use super::weights::Weights;
use crate::blend::Blend;
use crate::mesh::{ControlMesh, MeshError, index};
use crate::surface::features::{PointBuffers, Rule, gather_creases, gather_ring, prepare};

/// Computes the values of the refined vertices, in the order of `numbering`, which belongs to `mesh`.
///
/// `points` holds one value for each old vertex. Returns the filled part of `buffers.out`, each the
/// exact value of its mask, rounded once.
///
/// # Scaling and overflow
///
/// All weights are positive or zero and add up to the denominator (3, 27, `9 n` or 2^30), so sums of
/// 32-bit coordinates stay below 2^62.
///
/// # Errors
///
/// [`MeshError::ArenaTooSmall`] before anything is written; [`MeshError::OtherNumbering`] if the
/// numbering is seen to be of another mesh.
pub fn refine_points<'a, B: Blend>(
    blend: &mut B,
    mesh: &ControlMesh<'_>,
    numbering: &Numbering<'_>,
    points: &[B::Point],
    buffers: PointBuffers<'a, B>,
) -> Result<&'a mut [B::Point], MeshError> {
    let old = index(mesh.vertex_count);
    let new = index(numbering.vertex_count());
    let PointBuffers { out, sums, .. } = prepare(blend, old, new, points, buffers)?;
    let gathered = (|| {
        gather_ring(blend, &numbering.edges, 1, points, sums, numbering.states)?;
        gather_creases(blend, &numbering.edges, points, sums, numbering.states)
    })();
    gathered.ok_or(MeshError::OtherNumbering)?;
    old_vertices(blend, mesh.odd, numbering, points, sums, out);
    if mesh.odd {
        thirds(blend, numbering, points, sums, out).ok_or(MeshError::OtherNumbering)?;
    }
    centres(blend, mesh, numbering, points, out).ok_or(MeshError::OtherNumbering)?;
    Ok(out)
}

fn old_vertices<B: Blend>(
    blend: &mut B,
    odd: bool,
    numbering: &Numbering<'_>,
    points: &[B::Point],
    sums: &[B::Sum],
    out: &mut [B::Point],
) {
    let mut weights = Weights::new();
    let sums_and_states = sums.iter().zip(numbering.states);
    for ((slot, own), (sum, state)) in out.iter_mut().zip(points).zip(sums_and_states) {
        *slot = match state.rule {
            Rule::Smooth => {
                let weight = weights.neighbour(state.edges);
                blend.umbrella(own, sum, i64::from(state.edges), weight)
            }
            Rule::Crease if odd => {
                let mut total = blend.zero();
                blend.add_sum(&mut total, 4, sum);
                blend.add(&mut total, 19, own);
                blend.divide(&total, 27)
            }
            Rule::Crease | Rule::Linear => own.clone(),
        };
    }
}

/// The two vertices on every sharp edge: `(1, 16, 10) / 27` of the neighbour before, the near end
/// and the far end. The near end's sum holds the neighbour before and the far end.
fn thirds<B: Blend>(
    blend: &mut B,
    numbering: &Numbering<'_>,
    points: &[B::Point],
    sums: &[B::Sum],
    out: &mut [B::Point],
) -> Option<()> {
    for [a, b] in numbering.edges.ends() {
        for (near, far) in [(a, b), (b, a)] {
            let Some(vertex) = numbering.third(near, far) else {
                continue;
            };
            let mut total = blend.zero();
            blend.add_sum(&mut total, 1, sums.get(index(near))?);
            blend.add(&mut total, 16, points.get(index(near))?);
            blend.add(&mut total, 9, points.get(index(far))?);
            *out.get_mut(index(vertex))? = blend.divide(&total, 27);
        }
    }
    Some(())
}

fn centres<B: Blend>(
    blend: &mut B,
    mesh: &ControlMesh<'_>,
    numbering: &Numbering<'_>,
    points: &[B::Point],
    out: &mut [B::Point],
) -> Option<()> {
    for (face, corners) in mesh.faces().enumerate() {
        let Some(vertex) = numbering.centre(face) else {
            continue;
        };
        let mut total = blend.zero();
        for &corner in corners {
            blend.add(&mut total, 1, points.get(index(corner))?);
        }
        *out.get_mut(index(vertex))? = blend.divide(&total, 3);
    }
    Some(())
}
