//! Values of the refined vertices.

use crate::blend::Blend;
use crate::mesh::{ControlMesh, FaceOrder, MeshError, SurfaceEdges, index};
use crate::surface::features::{
    PointBuffers, Rim, Rule, VertexState, classify, crease_vertex, gather_creases, halfway, prepare,
};
use crate::surface::split::{first_face_vertex, same_mesh};

/// Greatest denominator of a mask.
const DENOMINATOR_MAXIMUM: u64 = 1 << 30;

/// Computes the values of the refined vertices: old vertices, then edge points, then face points.
///
/// `edges` and `order` belong to `mesh`; `points` holds one value for each old vertex. Returns the
/// filled part of `buffers.out`. The rules are those of the [module documentation](super).
///
/// # Scaling and overflow
///
/// All weights of a mask are positive or zero and add up to its denominator, which is at most 2^30,
/// so the sums of 32-bit coordinates stay below 2^61.
///
/// # Errors
///
/// [`MeshError::ArenaTooSmall`] before anything is written; [`MeshError::MaskTooLarge`];
/// [`MeshError::OtherNumbering`] if the numbering is seen to be of another mesh.
pub fn refine_points<'a, B: Blend>(
    blend: &mut B,
    mesh: &ControlMesh<'_>,
    edges: &SurfaceEdges<'_>,
    order: &FaceOrder<'_>,
    rim: Rim,
    points: &[B::Point],
    buffers: PointBuffers<'a, B>,
) -> Result<&'a mut [B::Point], MeshError> {
    if !same_mesh(mesh, edges, order.len()) {
        return Err(MeshError::OtherNumbering);
    }
    let new = super::split_counts(mesh, edges)
        .ok_or(MeshError::TooLarge)?
        .vertices;
    let PointBuffers { out, sums, states } =
        prepare(blend, index(mesh.vertex_count), new, points, buffers)?;
    classify(mesh, edges, rim, states).ok_or(MeshError::OtherNumbering)?;
    common_multiples(mesh, edges, states)?;
    gather_faces(blend, mesh, edges, order, points, sums, states, out)
        .ok_or(MeshError::OtherNumbering)?;
    gather_edges(blend, edges, points, sums, states).ok_or(MeshError::OtherNumbering)?;
    gather_creases(blend, edges, points, sums, states).ok_or(MeshError::OtherNumbering)?;
    finish_vertices(blend, points, sums, states, out);
    finish_edges(blend, edges, points, sums, states, out).ok_or(MeshError::OtherNumbering)?;
    Ok(out)
}

/// Finds, for every vertex and edge, the least common multiple of the numbers of corners of its
/// faces, and refuses masks whose denominator is too great.
fn common_multiples(
    mesh: &ControlMesh<'_>,
    edges: &SurfaceEdges<'_>,
    states: &mut [VertexState],
) -> Result<(), MeshError> {
    for face in mesh.faces() {
        let next = face.iter().cycle().skip(1);
        for (&corner, &next) in face.iter().zip(next) {
            let middle = edges
                .midpoint(corner, next)
                .ok_or(MeshError::OtherNumbering)?;
            for vertex in [corner, middle] {
                let state = states
                    .get_mut(index(vertex))
                    .ok_or(MeshError::OtherNumbering)?;
                if state.rule == Rule::Smooth {
                    state.common = common_multiple(state.common.max(1), face.len())
                        .filter(|&common| denominator(state.edges.max(2), common).is_some())
                        .ok_or(MeshError::MaskTooLarge { vertex: corner })?;
                }
            }
        }
    }
    Ok(())
}

/// The denominator of a mask with `valence` edges, an edge's mask counting as two.
fn denominator(valence: u32, common: u32) -> Option<i64> {
    let valence = u64::from(valence);
    valence
        .checked_mul(valence)?
        .checked_mul(u64::from(common))
        .filter(|&denominator| denominator <= DENOMINATOR_MAXIMUM)
        .and_then(|denominator| i64::try_from(denominator).ok())
}

/// The least common multiple of two positive numbers.
fn common_multiple(one: u32, other: usize) -> Option<u32> {
    let other = u32::try_from(other).ok()?;
    let (mut a, mut b) = (one, other);
    while b != 0 {
        (a, b) = (b, a.checked_rem(b)?);
    }
    one.checked_div(a)?.checked_mul(other)
}

/// Face points, and what every face gives to its corners and edges.
#[expect(
    clippy::too_many_arguments,
    reason = "the mesh, its numbering and the four lists that belong together"
)]
fn gather_faces<B: Blend>(
    blend: &mut B,
    mesh: &ControlMesh<'_>,
    edges: &SurfaceEdges<'_>,
    order: &FaceOrder<'_>,
    points: &[B::Point],
    sums: &mut [B::Sum],
    states: &[VertexState],
    out: &mut [B::Point],
) -> Option<()> {
    let first = index(first_face_vertex(edges));
    for (face, slot) in order.iter().zip(out.get_mut(first..)?) {
        let corners = mesh.face(face);
        let count = i64::try_from(corners.len()).ok()?;
        let mut whole = blend.zero();
        for &corner in corners {
            blend.add(&mut whole, 1, points.get(index(corner))?);
        }
        *slot = blend.divide(&whole, count);
        let next = corners.iter().cycle().skip(1);
        for (&corner, &next) in corners.iter().zip(next) {
            for vertex in [corner, edges.midpoint(corner, next)?] {
                let state = states.get(index(vertex))?;
                if state.rule == Rule::Smooth {
                    let weight = i64::from(state.common).checked_div(count)?;
                    blend.add_sum(sums.get_mut(index(vertex))?, weight, &whole);
                }
            }
        }
    }
    Some(())
}

/// The neighbours of smooth vertices.
fn gather_edges<B: Blend>(
    blend: &B,
    edges: &SurfaceEdges<'_>,
    points: &[B::Point],
    sums: &mut [B::Sum],
    states: &[VertexState],
) -> Option<()> {
    for [a, b] in edges.ends() {
        for (vertex, neighbour) in [(a, b), (b, a)] {
            let state = states.get(index(vertex))?;
            if state.rule == Rule::Smooth {
                let sum = sums.get_mut(index(vertex))?;
                blend.add(sum, i64::from(state.common), points.get(index(neighbour))?);
            }
        }
    }
    Some(())
}

/// Old vertices. With valence `n` and the sums `E` of neighbours and `F` of face points,
/// `(F/n + 2 (p + E/n)/2 + (n - 3) p) / n = (n (n - 2) p + E + F) / n^2`.
fn finish_vertices<B: Blend>(
    blend: &mut B,
    points: &[B::Point],
    sums: &mut [B::Sum],
    states: &[VertexState],
    out: &mut [B::Point],
) {
    let sums_and_states = sums.iter_mut().zip(states);
    for ((slot, own), (sum, state)) in out.iter_mut().zip(points).zip(sums_and_states) {
        *slot = match (state.rule, denominator(state.edges, state.common)) {
            (Rule::Smooth, Some(divisor)) => {
                let valence = i64::from(state.edges);
                let own_weight = valence
                    .wrapping_mul(valence.wrapping_sub(2))
                    .wrapping_mul(i64::from(state.common));
                blend.add(sum, own_weight, own);
                blend.divide(sum, divisor)
            }
            (Rule::Crease, _) => crease_vertex(blend, sum, own),
            (Rule::Linear, _) | (Rule::Smooth, None) => own.clone(),
        };
    }
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
            let common = i64::from(state.common);
            for end in ends {
                blend.add(sum, common, points.get(index(end))?);
            }
            blend.divide(sum, common.wrapping_mul(4))
        } else {
            halfway(blend, ends, points)?
        };
    }
    Some(())
}
