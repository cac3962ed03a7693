//! The connectivity of the next level.

use crate::mesh::{ControlMesh, ControlMeshBuffers, Fans, MeshError, Part, Side, index, length};
use crate::surface::split::{SurfaceCounts, cut};

/// What [`split`] will write. `None` where a count does not fit.
#[must_use]
pub fn split_counts(fans: &Fans<'_>) -> Option<SurfaceCounts> {
    let mesh = fans.mesh();
    let quads = fans.edges().iter().filter(|sides| sides.len() == 2).count();
    let (closed, corners) = fans.closed_counts();
    Some(SurfaceCounts {
        vertices: mesh.indices.len(),
        faces: mesh.face_count().checked_add(quads)?.checked_add(closed)?,
        indices: mesh
            .indices
            .len()
            .checked_add(quads.checked_mul(4)?)?
            .checked_add(corners)?,
        creases: 0,
        corners: 0,
    })
}

/// Writes the connectivity of the next level into `buffers`, of which it returns the filled part.
///
/// Vertex `k` of the refined mesh is the one at place `k` of the mesh's `indices`. Faces come in this
/// order: those of faces; quads of edges by ascending ends; those of vertices, ascending.
///
/// # Errors
///
/// [`MeshError::UnsupportedPart`] for creases and corners; [`MeshError::ArenaTooSmall`] before
/// anything is written.
pub fn split<'a>(
    fans: &Fans<'_>,
    buffers: ControlMeshBuffers<'a>,
) -> Result<ControlMesh<'a>, MeshError> {
    let mesh = fans.mesh();
    if !mesh.creases.is_empty() {
        return Err(MeshError::UnsupportedPart { part: Part::Crease });
    }
    if !mesh.corners.is_empty() {
        return Err(MeshError::UnsupportedPart { part: Part::Corner });
    }
    let counts = split_counts(fans).ok_or(MeshError::TooLarge)?;
    let ControlMeshBuffers {
        offsets, indices, ..
    } = cut(&counts, buffers)?;
    let mut writer = Writer {
        offsets: offsets.iter_mut(),
        indices: indices.iter_mut(),
        end: 0,
    };
    writer.mark();
    let mut corner = 0..length(mesh.indices);
    for face in mesh.faces() {
        writer.face(corner.by_ref().take(face.len()));
    }
    for sides in fans.edges().iter() {
        if let [one, other] = sides {
            let quad = [
                Some(one.corner),
                after(mesh, other),
                Some(other.corner),
                after(mesh, one),
            ];
            writer.face(quad.into_iter().flatten());
        }
    }
    for vertex in 0..mesh.vertex_count {
        let mut around = fans.around(vertex).peekable();
        if around.peek().is_some() {
            writer.face(around);
        }
    }
    Ok(ControlMesh {
        vertex_count: length(mesh.indices),
        offsets,
        indices,
        creases: &[],
        corners: &[],
        odd: mesh.odd,
    })
}

/// Fills the lists face by face.
struct Writer<'a> {
    offsets: core::slice::IterMut<'a, u32>,
    indices: core::slice::IterMut<'a, u32>,
    end: u32,
}

impl Writer<'_> {
    fn mark(&mut self) {
        if let Some(slot) = self.offsets.next() {
            *slot = self.end;
        }
    }

    fn face(&mut self, corners: impl Iterator<Item = u32>) {
        // The corners lead, so that no place is lost when they run out.
        for corner in corners {
            if let Some(slot) = self.indices.next() {
                *slot = corner;
            }
            self.end = self.end.wrapping_add(1);
        }
        self.mark();
    }
}

/// The place of the corner where a side leaves its edge.
fn after(mesh: &ControlMesh<'_>, side: &Side) -> Option<u32> {
    let &[first, end, ..] = mesh.offsets.get(index(side.face)..)? else {
        return None;
    };
    let next = side.corner.checked_add(1)?;
    Some(if next == end { first } else { next })
}
