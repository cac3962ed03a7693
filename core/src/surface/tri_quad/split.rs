//! The connectivity of the next level.

use crate::mesh::{ControlMesh, ControlMeshBuffers, FaceOrder, MeshError, SurfaceEdges, index};
use crate::surface::split::{
    SurfaceCounts, cut, first_face_vertex, halve_creases, length_of, same_mesh,
};

/// What [`split`] will write. `None` where a count does not fit.
#[must_use]
pub fn split_counts(mesh: &ControlMesh<'_>, edges: &SurfaceEdges<'_>) -> Option<SurfaceCounts> {
    let quads = mesh.faces().filter(|face| face.len() == 4).count();
    let vertices = mesh.vertex_count.checked_add(edges.count())?;
    Some(SurfaceCounts {
        vertices: index(vertices).checked_add(quads)?,
        faces: mesh.face_count().checked_mul(4)?,
        indices: mesh.indices.len().checked_mul(4)?,
        creases: mesh.creases.len().checked_mul(2)?,
        corners: mesh.corners.len(),
    })
}

/// Splits every face into four of its kind and writes the connectivity of the next level into
/// `buffers`, of which it returns the filled part.
///
/// A triangle `(a, b, c)` becomes `(a, ab, ca) (ab, b, bc) (ca, bc, c) (ab, bc, ca)`, a quad one quad
/// at each of its corners, `(corner, midpoint to the next, middle, midpoint to the one before)`; the
/// faces' order stays. New vertices are the edges' midpoints, then the middles of the quads in
/// `order`. A crease edge becomes its two halves, corners stay. `edges` and `order` must be of the
/// same mesh.
///
/// # Errors
///
/// [`MeshError::NotATriangleOrQuad`] and [`MeshError::ArenaTooSmall`] before anything is written;
/// [`MeshError::OtherNumbering`] if the numbering is seen to be of another mesh.
pub fn split<'a>(
    mesh: &ControlMesh<'_>,
    edges: &SurfaceEdges<'_>,
    order: &FaceOrder<'_>,
    buffers: ControlMeshBuffers<'a>,
) -> Result<ControlMesh<'a>, MeshError> {
    super::require_triangles_and_quads(mesh)?;
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
    write_offsets(mesh, offsets);
    split_triangles(mesh, edges, indices).ok_or(MeshError::OtherNumbering)?;
    for (face, middle) in quads(mesh, order).zip(first_face_vertex(edges)..) {
        split_quad(mesh, edges, face, middle, indices).ok_or(MeshError::OtherNumbering)?;
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

/// The quads in the order of their middles.
pub(super) fn quads<'a>(
    mesh: &ControlMesh<'a>,
    order: &FaceOrder<'a>,
) -> impl Iterator<Item = usize> + use<'a> {
    let mesh = *mesh;
    order.iter().filter(move |&face| mesh.face(face).len() == 4)
}

/// Four faces of its own number of corners for each face.
fn write_offsets(mesh: &ControlMesh<'_>, offsets: &mut [u32]) {
    let mut next = 0_u32;
    let children = mesh.faces().flat_map(|face| [length_of(face.len()); 4]);
    // The last start has no face: it is the end.
    for (slot, corners) in offsets.iter_mut().zip(children.chain([0])) {
        *slot = next;
        next = next.wrapping_add(corners);
    }
}

/// Writes the triangles of every triangle to their places in the list.
fn split_triangles(
    mesh: &ControlMesh<'_>,
    edges: &SurfaceEdges<'_>,
    indices: &mut [u32],
) -> Option<()> {
    for (face, &start) in mesh.faces().zip(mesh.offsets) {
        let &[a, b, c] = face else { continue };
        let [ab, bc, ca] = [
            edges.midpoint(a, b)?,
            edges.midpoint(b, c)?,
            edges.midpoint(c, a)?,
        ];
        let start = index(start).checked_mul(4)?;
        let children = indices.get_mut(start..start.checked_add(12)?)?;
        children.copy_from_slice(&[a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca]);
    }
    Some(())
}

/// Writes the quads of one quad to their place in the list.
fn split_quad(
    mesh: &ControlMesh<'_>,
    edges: &SurfaceEdges<'_>,
    face: usize,
    middle: u32,
    indices: &mut [u32],
) -> Option<()> {
    let &[a, b, c, d] = mesh.face(face) else {
        return None;
    };
    let [ab, bc, cd, da] = [
        edges.midpoint(a, b)?,
        edges.midpoint(b, c)?,
        edges.midpoint(c, d)?,
        edges.midpoint(d, a)?,
    ];
    let start = index(*mesh.offsets.get(face)?).checked_mul(4)?;
    let children = indices.get_mut(start..start.checked_add(16)?)?;
    let quads = [
        [a, ab, middle, da],
        [b, bc, middle, ab],
        [c, cd, middle, bc],
        [d, da, middle, cd],
    ];
    children.copy_from_slice(quads.as_flattened());
    Some(())
}
