//! What splits of control meshes have in common: the lists they hand on.

use crate::mesh::{
    Arena, ControlMesh, ControlMeshBuffers, MeshError, SurfaceEdges, index, length, require,
};

/// Numbers of elements of a control mesh, for arenas.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct SurfaceCounts {
    /// Vertices.
    pub vertices: usize,
    /// Faces; a mesh has one offset more.
    pub faces: usize,
    /// Corners of all faces together.
    pub indices: usize,
    /// Crease edges.
    pub creases: usize,
    /// Corner vertices.
    pub corners: usize,
}

/// Cuts the buffers to the counts of the refined mesh.
pub(super) fn cut<'a>(
    counts: &SurfaceCounts,
    buffers: ControlMeshBuffers<'a>,
) -> Result<ControlMeshBuffers<'a>, MeshError> {
    let offsets = counts.faces.checked_add(1).ok_or(MeshError::TooLarge)?;
    u32::try_from(counts.indices).map_err(|_| MeshError::TooLarge)?;
    u32::try_from(counts.vertices).map_err(|_| MeshError::TooLarge)?;
    require(Arena::FaceOffsets, offsets, buffers.offsets.len())?;
    require(Arena::FaceCorners, counts.indices, buffers.indices.len())?;
    require(Arena::Creases, counts.creases, buffers.creases.len())?;
    require(Arena::Corners, counts.corners, buffers.corners.len())?;
    Ok(ControlMeshBuffers {
        offsets: buffers.offsets.get_mut(..offsets).unwrap_or_default(),
        indices: buffers
            .indices
            .get_mut(..counts.indices)
            .unwrap_or_default(),
        creases: buffers
            .creases
            .get_mut(..counts.creases)
            .unwrap_or_default(),
        corners: buffers
            .corners
            .get_mut(..counts.corners)
            .unwrap_or_default(),
    })
}

/// Offsets of faces that all have `corners` corners.
pub(super) fn equal_offsets(offsets: &mut [u32], corners: u32) {
    let mut next = 0_u32;
    for slot in offsets {
        *slot = next;
        next = next.wrapping_add(corners);
    }
}

/// Each crease edge as its two halves, in the order of the list.
pub(super) fn halve_creases(
    mesh: &ControlMesh<'_>,
    edges: &SurfaceEdges<'_>,
    creases: &mut [[u32; 2]],
) -> Option<()> {
    for (&[a, b], halves) in mesh.creases.iter().zip(creases.chunks_exact_mut(2)) {
        let middle = edges.midpoint(a, b)?;
        halves.copy_from_slice(&[[a, middle], [middle, b]]);
    }
    Some(())
}

/// Refuses a mesh with a face that is not a triangle.
pub(super) fn require_triangles(mesh: &ControlMesh<'_>) -> Result<(), MeshError> {
    match mesh.faces().enumerate().find(|(_, face)| face.len() != 3) {
        Some((face, corners)) => Err(MeshError::NotATriangle {
            face,
            corners: corners.len(),
        }),
        None => Ok(()),
    }
}

/// The counts after every triangle became four.
pub(super) fn quadrisect_counts(
    mesh: &ControlMesh<'_>,
    edges: &SurfaceEdges<'_>,
) -> Option<SurfaceCounts> {
    Some(SurfaceCounts {
        vertices: index(mesh.vertex_count.checked_add(edges.count())?),
        faces: mesh.face_count().checked_mul(4)?,
        indices: mesh.indices.len().checked_mul(4)?,
        creases: mesh.creases.len().checked_mul(2)?,
        corners: mesh.corners.len(),
    })
}

/// Splits every triangle `(a, b, c)` into `(a, ab, ca) (ab, b, bc) (ca, bc, c) (ab, bc, ca)`.
pub(super) fn quadrisect<'a>(
    mesh: &ControlMesh<'_>,
    edges: &SurfaceEdges<'_>,
    buffers: ControlMeshBuffers<'a>,
) -> Result<ControlMesh<'a>, MeshError> {
    require_triangles(mesh)?;
    let counts = quadrisect_counts(mesh, edges).ok_or(MeshError::TooLarge)?;
    let ControlMeshBuffers {
        offsets,
        indices,
        creases,
        corners,
    } = cut(&counts, buffers)?;
    equal_offsets(offsets, 3);
    let middle = |a, b| edges.midpoint(a, b).ok_or(MeshError::OtherNumbering);
    for (face, children) in mesh.faces().zip(indices.chunks_exact_mut(12)) {
        let &[a, b, c] = face else { continue };
        let (ab, bc, ca) = (middle(a, b)?, middle(b, c)?, middle(c, a)?);
        children.copy_from_slice(&[a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca]);
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

/// A count that [`cut`] checked to fit 32 bits.
pub(super) fn length_of(count: usize) -> u32 {
    u32::try_from(count).unwrap_or(u32::MAX)
}

/// The first face vertex of a scheme that numbers old vertices, then edges, then faces.
pub(super) fn first_face_vertex(edges: &SurfaceEdges<'_>) -> u32 {
    edges.old_count().wrapping_add(edges.count())
}

/// True if a numbering can be that of `mesh`.
pub(super) fn same_mesh(mesh: &ControlMesh<'_>, edges: &SurfaceEdges<'_>, faces: usize) -> bool {
    edges.old_count() == mesh.vertex_count
        && faces == mesh.face_count()
        && edges.side_count() == length(mesh.indices)
}
