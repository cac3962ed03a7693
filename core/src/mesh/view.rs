//! The view of a solid and the buffers that a refined one is written to.

use super::error::{MeshError, Part};

/// Connectivity of a solid: a view of lists that somebody else owns.
///
/// `Default` is the empty solid, so a caller names only the lists that it has.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Solid<'a> {
    /// Number of vertices; indices below run from 0 to one less.
    pub vertex_count: u32,
    /// Tetrahedra.
    pub tetrahedra: &'a [[u32; 4]],
    /// Octahedra, opposite corners `(0, 3) (1, 4) (2, 5)`.
    pub octahedra: &'a [[u32; 6]],
    /// Triangular prisms, in the order of Gmsh: triangles `(0, 1, 2)` and `(3, 4, 5)`, joined by
    /// the edges `(0, 3) (1, 4) (2, 5)`.
    pub prisms: &'a [[u32; 6]],
    /// Hexahedra, in the order of Gmsh and VTK: quadrilaterals `(0, 1, 2, 3)` and `(4, 5, 6, 7)`,
    /// joined by the edges `(0, 4) (1, 5) (2, 6) (3, 7)`.
    pub hexahedra: &'a [[u32; 8]],
    /// Triangles that follow the surface rule: the boundary, as
    /// [`boundary_triangles`](super::boundary_triangles) finds it, interior surfaces that are to
    /// show as creases, and sheets: triangles that no cell has, which hang on the solid or stand
    /// alone. A split hands them on.
    pub surface: &'a [[u32; 3]],
    /// Quadrilaterals that follow the surface rule, corners in cyclic order.
    pub surface_quads: &'a [[u32; 4]],
    /// Crease edges, on the boundary or inside.
    pub creases: &'a [[u32; 2]],
    /// Vertices that stay where they are.
    pub corners: &'a [u32],
}

/// Where a refined solid's lists are written.
#[derive(Debug, Default)]
pub struct SolidBuffers<'a> {
    /// Tetrahedra.
    pub tetrahedra: &'a mut [[u32; 4]],
    /// Octahedra.
    pub octahedra: &'a mut [[u32; 6]],
    /// Surface triangles.
    pub surface: &'a mut [[u32; 3]],
    /// Crease edges.
    pub creases: &'a mut [[u32; 2]],
    /// Corners.
    pub corners: &'a mut [u32],
}

impl Solid<'_> {
    /// Checks that every index names a vertex and that no element names a vertex twice.
    ///
    /// # Errors
    ///
    /// [`MeshError::VertexOutOfRange`] or [`MeshError::RepeatedVertex`] for the first element
    /// that is wrong.
    pub fn check(&self) -> Result<(), MeshError> {
        self.check_part(Part::Tetrahedron, self.tetrahedra)?;
        self.check_part(Part::Octahedron, self.octahedra)?;
        self.check_part(Part::Prism, self.prisms)?;
        self.check_part(Part::Hexahedron, self.hexahedra)?;
        self.check_part(Part::SurfaceTriangle, self.surface)?;
        self.check_part(Part::SurfaceQuad, self.surface_quads)?;
        self.check_part(Part::Crease, self.creases)?;
        for (index, &vertex) in self.corners.iter().enumerate() {
            if vertex >= self.vertex_count {
                return Err(MeshError::VertexOutOfRange {
                    part: Part::Corner,
                    index,
                    vertex,
                });
            }
        }
        Ok(())
    }

    /// Refuses what the tetrahedral schemes do not know: prisms, hexahedra, surface quadrilaterals.
    pub(crate) fn require_tetrahedral(&self) -> Result<(), MeshError> {
        let foreign = [
            (Part::Prism, self.prisms.is_empty()),
            (Part::Hexahedron, self.hexahedra.is_empty()),
            (Part::SurfaceQuad, self.surface_quads.is_empty()),
        ];
        match foreign.iter().find(|(_, is_empty)| !is_empty) {
            Some(&(part, _)) => Err(MeshError::UnsupportedPart { part }),
            None => Ok(()),
        }
    }

    fn check_part<const N: usize>(
        &self,
        part: Part,
        elements: &[[u32; N]],
    ) -> Result<(), MeshError> {
        for (index, element) in elements.iter().enumerate() {
            let mut rest = element.as_slice();
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
        }
        Ok(())
    }
}
