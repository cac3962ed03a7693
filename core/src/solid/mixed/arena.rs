//! A mixed solid in memory of a fixed size, for devices.

use heapless::Vec;

use super::split::{MixedBuffers, MixedCounts};
use crate::mesh::{Arena, MeshError, Solid, require};
use crate::solid::tet_oct::resize;

/// Owns a mixed solid of at most `T` tetrahedra, `O` octahedra, `P` prisms, `H` hexahedra, `S`
/// surface triangles, `Q` surface quadrilaterals, `C` crease edges and `K` corners.
#[derive(Clone, Debug, Default)]
pub struct MixedArena<
    const T: usize,
    const O: usize,
    const P: usize,
    const H: usize,
    const S: usize,
    const Q: usize,
    const C: usize,
    const K: usize,
> {
    vertex_count: u32,
    tetrahedra: Vec<[u32; 4], T>,
    octahedra: Vec<[u32; 6], O>,
    prisms: Vec<[u32; 6], P>,
    hexahedra: Vec<[u32; 8], H>,
    surface: Vec<[u32; 3], S>,
    surface_quads: Vec<[u32; 4], Q>,
    creases: Vec<[u32; 2], C>,
    corners: Vec<u32, K>,
}

impl<
    const T: usize,
    const O: usize,
    const P: usize,
    const H: usize,
    const S: usize,
    const Q: usize,
    const C: usize,
    const K: usize,
> MixedArena<T, O, P, H, S, Q, C, K>
{
    /// The empty solid.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            vertex_count: 0,
            tetrahedra: Vec::new(),
            octahedra: Vec::new(),
            prisms: Vec::new(),
            hexahedra: Vec::new(),
            surface: Vec::new(),
            surface_quads: Vec::new(),
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
            prisms: &self.prisms,
            hexahedra: &self.hexahedra,
            surface: &self.surface,
            surface_quads: &self.surface_quads,
            creases: &self.creases,
            corners: &self.corners,
        }
    }

    /// Copies a solid.
    ///
    /// # Errors
    ///
    /// [`MeshError::ArenaTooSmall`]; this solid is then as it was.
    pub fn assign(&mut self, solid: &Solid<'_>) -> Result<(), MeshError> {
        self.fill(&MixedCounts::of(solid), |buffers| {
            buffers.tetrahedra.copy_from_slice(solid.tetrahedra);
            buffers.octahedra.copy_from_slice(solid.octahedra);
            buffers.prisms.copy_from_slice(solid.prisms);
            buffers.hexahedra.copy_from_slice(solid.hexahedra);
            buffers.surface.copy_from_slice(solid.surface);
            buffers.surface_quads.copy_from_slice(solid.surface_quads);
            buffers.creases.copy_from_slice(solid.creases);
            buffers.corners.copy_from_slice(solid.corners);
            Ok(solid.vertex_count)
        })
    }

    /// Makes the lists as long as `counts` says and lets `write` fill them; it returns the number
    /// of vertices.
    pub(super) fn fill(
        &mut self,
        counts: &MixedCounts,
        write: impl FnOnce(MixedBuffers<'_>) -> Result<u32, MeshError>,
    ) -> Result<(), MeshError> {
        let capacities = [
            (Arena::Tetrahedra, counts.tetrahedra, T),
            (Arena::Octahedra, counts.octahedra, O),
            (Arena::Prisms, counts.prisms, P),
            (Arena::Hexahedra, counts.hexahedra, H),
            (Arena::SurfaceTriangles, counts.surface, S),
            (Arena::SurfaceQuads, counts.surface_quads, Q),
            (Arena::Creases, counts.creases, C),
            (Arena::Corners, counts.corners, K),
        ];
        for (arena, needed, given) in capacities {
            require(arena, needed, given)?;
        }
        resize(
            &mut self.tetrahedra,
            counts.tetrahedra,
            [0; 4],
            Arena::Tetrahedra,
        )?;
        resize(
            &mut self.octahedra,
            counts.octahedra,
            [0; 6],
            Arena::Octahedra,
        )?;
        resize(&mut self.prisms, counts.prisms, [0; 6], Arena::Prisms)?;
        resize(
            &mut self.hexahedra,
            counts.hexahedra,
            [0; 8],
            Arena::Hexahedra,
        )?;
        resize(
            &mut self.surface,
            counts.surface,
            [0; 3],
            Arena::SurfaceTriangles,
        )?;
        let quads = counts.surface_quads;
        resize(&mut self.surface_quads, quads, [0; 4], Arena::SurfaceQuads)?;
        resize(&mut self.creases, counts.creases, [0; 2], Arena::Creases)?;
        resize(&mut self.corners, counts.corners, 0, Arena::Corners)?;
        self.vertex_count = write(MixedBuffers {
            tetrahedra: &mut self.tetrahedra,
            octahedra: &mut self.octahedra,
            prisms: &mut self.prisms,
            hexahedra: &mut self.hexahedra,
            surface: &mut self.surface,
            surface_quads: &mut self.surface_quads,
            creases: &mut self.creases,
            corners: &mut self.corners,
        })?;
        Ok(())
    }
}
