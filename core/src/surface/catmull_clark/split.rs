//! The connectivity of the next level.

use crate::mesh::{ControlMesh, ControlMeshBuffers, FaceOrder, MeshError, SurfaceEdges, index};
use crate::surface::split::{
    SurfaceCounts, cut, equal_offsets, first_face_vertex, halve_creases, length_of, same_mesh,
};

/// What [`split`] will write. `None` where a count does not fit.
#[must_use]
pub fn split_counts(mesh: &ControlMesh<'_>, edges: &SurfaceEdges<'_>) -> Option<SurfaceCounts> {
    let vertices = mesh.vertex_count.checked_add(edges.count())?;
    Some(SurfaceCounts {
        vertices: index(vertices).checked_add(mesh.face_count())?,
        faces: mesh.indices.len(),
        indices: mesh.indices.len().checked_mul(4)?,
        creases: mesh.creases.len().checked_mul(2)?,
        corners: mesh.corners.len(),
    })
}

/// Splits every face into quads, one at each of its corners, and writes the connectivity of the next
/// level into `buffers`, of which it returns the filled part.
///
/// The quad at corner `c` is `(c, midpoint to the next corner, face point, midpoint to the corner
/// before)`; quads come in the order of the mesh's `indices`. A crease edge becomes its two halves,
/// corners stay. `edges` and `order` must be of the same mesh.
///
/// # Errors
///
/// [`MeshError::ArenaTooSmall`] before anything is written; [`MeshError::OtherNumbering`] if the
/// numbering is seen to be of another mesh.
pub fn split<'a>(
    mesh: &ControlMesh<'_>,
    edges: &SurfaceEdges<'_>,
    order: &FaceOrder<'_>,
    buffers: ControlMeshBuffers<'a>,
) -> Result<ControlMesh<'a>, MeshError> {
    if !same_mesh(mesh, edges, order.len()) {
        return Err(MeshError::OtherNumbering);
    }
    let counts = split_counts(mesh, edges).ok_or(MeshError::TooLarge)?;
    let ControlMeshBuffers {
        offsets,
        indices,
        creases,
        corners,
    } = cut(&counts, buffers)?;
    equal_offsets(offsets, 4);
    for (face, vertex) in order.iter().zip(first_face_vertex(edges)..) {
        split_face(mesh, edges, face, vertex, indices).ok_or(MeshError::OtherNumbering)?;
    }
    halve_creases(mesh, edges, creases).ok_or(MeshError::OtherNumbering)?;
    corners.copy_from_slice(mesh.corners);
    Ok(ControlMesh {
        vertex_count: length_of(counts.vertices),
        offsets,
        indices,
        creases,
        corners,
        odd: mesh.odd,
    })
}

/// Writes the quads of one face to their place in the list.
fn split_face(
    mesh: &ControlMesh<'_>,
    edges: &SurfaceEdges<'_>,
    face: usize,
    vertex: u32,
    indices: &mut [u32],
) -> Option<()> {
    let corners = mesh.face(face);
    let start = index(*mesh.offsets.get(face)?).checked_mul(4)?;
    let mut before = edges.midpoint(*corners.last()?, *corners.first()?)?;
    let next = corners.iter().cycle().skip(1);
    let quads = indices.get_mut(start..)?.chunks_exact_mut(4);
    for ((&corner, &next), quad) in corners.iter().zip(next).zip(quads) {
        let after = edges.midpoint(corner, next)?;
        quad.copy_from_slice(&[corner, after, vertex, before]);
        before = after;
    }
    Some(())
}
