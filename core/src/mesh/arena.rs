//! A solid in memory of a fixed size, for devices.

use heapless::Vec;

use super::boundary::{boundary_triangles, face_capacity};
use super::counts::Counts;
use super::error::{Arena, MeshError};
use super::numbering::require;
use super::view::{Solid, SolidBuffers};

/// Owns a solid of at most `T` tetrahedra, `O` octahedra, `S` surface triangles, `C` crease edges
/// and `K` corners.
#[derive(Clone, Debug, Default)]
pub struct SolidArena<
    const T: usize,
    const O: usize,
    const S: usize,
    const C: usize,
    const K: usize,
> {
    vertex_count: u32,
    tetrahedra: Vec<[u32; 4], T>,
    octahedra: Vec<[u32; 6], O>,
    surface: Vec<[u32; 3], S>,
    creases: Vec<[u32; 2], C>,
    corners: Vec<u32, K>,
}

impl<const T: usize, const O: usize, const S: usize, const C: usize, const K: usize>
    SolidArena<T, O, S, C, K>
{
    /// The empty solid.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            vertex_count: 0,
            tetrahedra: Vec::new(),
            octahedra: Vec::new(),
            surface: Vec::new(),
            creases: Vec::new(),
            corners: Vec::new(),
        }
    }

    /// The view that refinement takes.
    #[must_use]
    pub fn solid(&self) -> Solid<'_> {
        Solid {
            vertex_count: self.vertex_count,
            tetrahedra: &self.tetrahedra,
            octahedra: &self.octahedra,
            surface: &self.surface,
            creases: &self.creases,
            corners: &self.corners,
            ..Solid::default()
        }
    }

    /// Copies a solid.
    ///
    /// # Errors
    ///
    /// [`MeshError::ArenaTooSmall`], and [`MeshError::UnsupportedPart`] if the solid has other
    /// cells than tetrahedra and octahedra; this solid is then as it was.
    pub fn assign(&mut self, solid: &Solid<'_>) -> Result<(), MeshError> {
        solid.require_tetrahedral()?;
        let counts = Counts {
            tetrahedra: solid.tetrahedra.len(),
            octahedra: solid.octahedra.len(),
            surface: solid.surface.len(),
            creases: solid.creases.len(),
            corners: solid.corners.len(),
            ..Counts::default()
        };
        self.fill(counts, |buffers| {
            buffers.tetrahedra.copy_from_slice(solid.tetrahedra);
            buffers.octahedra.copy_from_slice(solid.octahedra);
            buffers.surface.copy_from_slice(solid.surface);
            buffers.creases.copy_from_slice(solid.creases);
            buffers.corners.copy_from_slice(solid.corners);
            Ok(solid.vertex_count)
        })
    }

    /// Finds the boundary of the cells and takes it as the surface, in place of what was there.
    ///
    /// `faces` is scratch: see [`face_capacity`].
    ///
    /// # Errors
    ///
    /// Those of [`boundary_triangles`], and [`MeshError::ArenaTooSmall`] for the surface.
    pub fn find_boundary(&mut self, faces: &mut [[u32; 3]]) -> Result<(), MeshError> {
        let cells = Solid {
            vertex_count: self.vertex_count,
            tetrahedra: &self.tetrahedra,
            octahedra: &self.octahedra,
            ..Solid::default()
        };
        let needed = face_capacity(&cells).ok_or(MeshError::TooLarge)?;
        require(Arena::Faces, needed, faces.len())?;
        let boundary = boundary_triangles(&cells, faces)?;
        require(Arena::SurfaceTriangles, boundary.len(), S)?;
        self.surface.clear();
        self.surface.extend(boundary.iter().copied());
        Ok(())
    }

    /// Makes the lists as long as `counts` says and lets `write` fill them; it returns the number
    /// of vertices.
    pub(crate) fn fill(
        &mut self,
        counts: Counts,
        write: impl FnOnce(SolidBuffers<'_>) -> Result<u32, MeshError>,
    ) -> Result<(), MeshError> {
        require(Arena::Tetrahedra, counts.tetrahedra, T)?;
        require(Arena::Octahedra, counts.octahedra, O)?;
        require(Arena::SurfaceTriangles, counts.surface, S)?;
        require(Arena::Creases, counts.creases, C)?;
        require(Arena::Corners, counts.corners, K)?;
        // The lengths were checked above, so that none of these can be refused.
        let _ = self.tetrahedra.resize(counts.tetrahedra, [0; 4]);
        let _ = self.octahedra.resize(counts.octahedra, [0; 6]);
        let _ = self.surface.resize(counts.surface, [0; 3]);
        let _ = self.creases.resize(counts.creases, [0; 2]);
        let _ = self.corners.resize(counts.corners, 0);
        self.vertex_count = write(SolidBuffers {
            tetrahedra: &mut self.tetrahedra,
            octahedra: &mut self.octahedra,
            surface: &mut self.surface,
            creases: &mut self.creases,
            corners: &mut self.corners,
        })?;
        Ok(())
    }
}
