//! The connectivity of the next step.

use super::numbering::Numbering;
use crate::mesh::{ControlMesh, ControlMeshBuffers, MeshError, index};
use crate::surface::split::{SurfaceCounts, cut, equal_offsets, length_of};

/// What [`split`] will write. `None` where a count does not fit.
#[must_use]
pub fn split_counts(mesh: &ControlMesh<'_>, numbering: &Numbering<'_>) -> Option<SurfaceCounts> {
    let pieces = if mesh.odd { 3 } else { 1 };
    Some(SurfaceCounts {
        vertices: index(numbering.vertex_count()),
        faces: mesh.indices.len(),
        indices: mesh.indices.len().checked_mul(3)?,
        creases: mesh.creases.len().checked_mul(pieces)?,
        corners: mesh.corners.len(),
    })
}

/// Writes the connectivity of the next step into `buffers`, of which it returns the filled part.
///
/// Every side of a triangle gives one new triangle, in the order of the mesh's `indices`. For the
/// side from `a` to `b` with the new vertex `l` of its triangle and `r` of the triangle beyond: the
/// flipped `(b, l, r)`; on a sharp edge `(l, a, b)`, and when it is trisected `(opposite corner,
/// third by a, third by b)`. A crease edge stays in an even step and becomes its three parts in an
/// odd one. `numbering` must be of the same mesh.
///
/// # Errors
///
/// [`MeshError::ArenaTooSmall`] before anything is written; [`MeshError::OtherNumbering`] if the
/// numbering is seen to be of another mesh.
pub fn split<'a>(
    mesh: &ControlMesh<'_>,
    numbering: &Numbering<'_>,
    buffers: ControlMeshBuffers<'a>,
) -> Result<ControlMesh<'a>, MeshError> {
    let counts = split_counts(mesh, numbering).ok_or(MeshError::TooLarge)?;
    let ControlMeshBuffers {
        offsets,
        indices,
        creases,
        corners,
    } = cut(&counts, buffers)?;
    equal_offsets(offsets, 3);
    let triangles = indices.chunks_exact_mut(9);
    for ((face, corners), children) in mesh.faces().enumerate().zip(triangles) {
        split_face(mesh, numbering, face, corners, children).ok_or(MeshError::OtherNumbering)?;
    }
    if mesh.odd {
        trisect_creases(mesh, numbering, creases).ok_or(MeshError::OtherNumbering)?;
    } else {
        creases.copy_from_slice(mesh.creases);
    }
    corners.copy_from_slice(mesh.corners);
    Ok(ControlMesh {
        vertex_count: length_of(counts.vertices),
        offsets,
        indices,
        creases,
        corners,
        odd: !mesh.odd,
    })
}

fn split_face(
    mesh: &ControlMesh<'_>,
    numbering: &Numbering<'_>,
    face: usize,
    corners: &[u32],
    children: &mut [u32],
) -> Option<()> {
    let &[a, b, c] = corners else { return None };
    let sides = [(a, b, c), (b, c, a), (c, a, b)];
    for ((from, to, opposite), child) in sides.into_iter().zip(children.chunks_exact_mut(3)) {
        let triangle = if numbering.is_sharp([from, to]) {
            match numbering.centre(face) {
                Some(centre) => [centre, from, to],
                None => [
                    opposite,
                    numbering.third(from, to)?,
                    numbering.third(to, from)?,
                ],
            }
        } else {
            let beyond = numbering
                .sides(from, to)
                .iter()
                .map(|side| index(side.face))
                .find(|&other| other != face)?;
            let left = apex(mesh, numbering, face, from, to)?;
            [to, left, apex(mesh, numbering, beyond, from, to)?]
        };
        child.copy_from_slice(&triangle);
    }
    Some(())
}

/// The new vertex that the part of a triangle at its side from `a` to `b` points to: its own, or the
/// nearest third of its trisected side.
fn apex(
    mesh: &ControlMesh<'_>,
    numbering: &Numbering<'_>,
    face: usize,
    a: u32,
    b: u32,
) -> Option<u32> {
    if let Some(centre) = numbering.centre(face) {
        return Some(centre);
    }
    let opposite = *mesh
        .face(face)
        .iter()
        .find(|&&corner| corner != a && corner != b)?;
    numbering
        .third(a, opposite)
        .or_else(|| numbering.third(b, opposite))
}

fn trisect_creases(
    mesh: &ControlMesh<'_>,
    numbering: &Numbering<'_>,
    creases: &mut [[u32; 2]],
) -> Option<()> {
    for (&[a, b], parts) in mesh.creases.iter().zip(creases.chunks_exact_mut(3)) {
        let (by_a, by_b) = (numbering.third(a, b)?, numbering.third(b, a)?);
        parts.copy_from_slice(&[[a, by_a], [by_a, by_b], [by_b, b]]);
    }
    Some(())
}
