//! The view of a surface's control mesh and the buffers that a refined one is written to.

use super::error::{MeshError, Part};

/// Connectivity of a control mesh of triangles, quads and polygons: a view of lists that somebody
/// else owns.
///
/// `Default` is the empty mesh, so a caller names only the lists that it has.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ControlMesh<'a> {
    /// Number of vertices; indices below run from 0 to one less.
    pub vertex_count: u32,
    /// Where each face's corners start in `indices`, ascending from 0, and the length of
    /// `indices` at the end: one more entry than there are faces (or none for no face).
    pub offsets: &'a [u32],
    /// Corners of the faces, one face after the other, counter-clockwise from outside.
    pub indices: &'a [u32],
    /// Crease edges.
    pub creases: &'a [[u32; 2]],
    /// Vertices that stay where they are.
    pub corners: &'a [u32],
    /// True after an odd number of square-root-3 steps, when the boundary waits for its
    /// trisection. Only that scheme reads and changes it; other schemes hand it on.
    pub odd: bool,
}

/// Where a refined control mesh's lists are written.
#[derive(Debug, Default)]
pub struct ControlMeshBuffers<'a> {
    /// Starts of the faces, one more than there are faces.
    pub offsets: &'a mut [u32],
    /// Corners of the faces.
    pub indices: &'a mut [u32],
    /// Crease edges.
    pub creases: &'a mut [[u32; 2]],
    /// Corners.
    pub corners: &'a mut [u32],
}

impl<'a> ControlMesh<'a> {
    /// Number of faces.
    #[must_use]
    pub fn face_count(&self) -> usize {
        self.offsets.len().saturating_sub(1)
    }

    /// The corners of a face; empty if there is no such face.
    #[must_use]
    pub fn face(&self, face: usize) -> &'a [u32] {
        match self.offsets.get(face..) {
            Some(&[start, end, ..]) => self.slice(start, end),
            _ => &[],
        }
    }

    /// The corners of every face, in the order of the list.
    pub fn faces(&self) -> impl Iterator<Item = &'a [u32]> + use<'a> {
        let mesh = *self;
        self.offsets.windows(2).map(move |window| match *window {
            [start, end] => mesh.slice(start, end),
            _ => &[],
        })
    }

    fn slice(&self, start: u32, end: u32) -> &'a [u32] {
        self.indices
            .get(index(start)..index(end))
            .unwrap_or_default()
    }

    /// Checks that the offsets bound faces of three corners or more, that every index names a
    /// vertex and that no face or crease names a vertex twice.
    ///
    /// # Errors
    ///
    /// [`MeshError::Offsets`], [`MeshError::FaceTooShort`], [`MeshError::VertexOutOfRange`] or
    /// [`MeshError::RepeatedVertex`] for the first element that is wrong.
    pub fn check(&self) -> Result<(), MeshError> {
        self.check_offsets()?;
        for (place, face) in self.faces().enumerate() {
            if face.len() < 3 {
                return Err(MeshError::FaceTooShort {
                    face: place,
                    corners: face.len(),
                });
            }
            self.check_element(Part::Face, place, face)?;
        }
        for (place, crease) in self.creases.iter().enumerate() {
            self.check_element(Part::Crease, place, crease)?;
        }
        for (place, corner) in self.corners.iter().enumerate() {
            self.check_element(Part::Corner, place, core::slice::from_ref(corner))?;
        }
        Ok(())
    }

    fn check_offsets(&self) -> Result<(), MeshError> {
        u32::try_from(self.indices.len()).map_err(|_| MeshError::TooLarge)?;
        let first = self.offsets.first().copied().unwrap_or_default();
        let last = self.offsets.last().copied().unwrap_or_default();
        if first != 0 {
            return Err(MeshError::Offsets { face: 0 });
        }
        for (face, window) in self.offsets.windows(2).enumerate() {
            if !window.is_sorted() {
                return Err(MeshError::Offsets { face });
            }
        }
        if index(last) != self.indices.len() {
            return Err(MeshError::Offsets {
                face: self.face_count().saturating_sub(1),
            });
        }
        Ok(())
    }

    fn check_element(&self, part: Part, index: usize, element: &[u32]) -> Result<(), MeshError> {
        let mut rest = element;
        while let Some((&vertex, others)) = rest.split_first() {
            if vertex >= self.vertex_count {
                return Err(MeshError::VertexOutOfRange {
                    part,
                    index,
                    vertex,
                });
            }
            if others.contains(&vertex) {
                return Err(MeshError::RepeatedVertex {
                    part,
                    index,
                    vertex,
                });
            }
            rest = others;
        }
        Ok(())
    }
}

/// An index of a mesh as an index of a slice. On the targets of this library `usize` holds every
/// `u32`.
pub(crate) fn index(vertex: u32) -> usize {
    usize::try_from(vertex).unwrap_or(usize::MAX)
}

/// The length of a list that was checked to fit 32 bits.
pub(crate) fn length<T>(list: &[T]) -> u32 {
    u32::try_from(list.len()).unwrap_or(u32::MAX)
}
