//! One step of a scheme by core's own refinement: connectivity, rows, and every face's children.

use crate::forms::error::FormError;
use crate::forms::mesh::ClosedMesh;
use crate::forms::scheme::Row;
use crate::refine::rows::{self, RowBlend, identity};
use crate::surface::{RimRule, SurfaceLevel, SurfaceMesh, SurfaceScheme, SurfaceStep};

/// A closed mesh refined by one step (two of square-root-3, which then splits every triangle into nine).
#[derive(Clone, Debug)]
pub struct Step {
    /// The refined mesh.
    pub mesh: ClosedMesh,
    /// A row over the old vertices for each new one.
    pub rows: Vec<Row<f64>>,
    scheme: SurfaceScheme,
    old_vertices: usize,
    /// The vertex at each old face's middle, for square-root-3.
    centres: Vec<usize>,
    /// The first child of each old face, for the other schemes.
    first_children: Vec<usize>,
}

impl Step {
    /// Refines the mesh of these faces.
    ///
    /// # Errors
    ///
    /// [`FormError::Refused`] if core refuses the mesh.
    pub fn new(
        scheme: SurfaceScheme,
        vertices: usize,
        faces: &[Vec<u32>],
    ) -> Result<Self, FormError> {
        let refused = |error: crate::error::Error| FormError::Refused {
            reason: error.to_string(),
        };
        let level = SurfaceLevel::new(&SurfaceMesh {
            points: vec![[0.0; 3]; vertices],
            faces: faces.to_vec(),
            ..SurfaceMesh::default()
        })
        .map_err(refused)?;
        let mut values = identity(level.vertex_count);
        let mut refine = |level: &SurfaceLevel| {
            let mut step = SurfaceStep::new(level, scheme, RimRule::Spline);
            values = step.values(&mut RowBlend, &values).map_err(refused)?;
            step.split().map_err(refused)
        };
        let mut next = refine(&level)?;
        let mut centres = Vec::new();
        if scheme == SurfaceScheme::Sqrt3 {
            // The triangle at the side from a to b is (b, own centre, centre beyond).
            centres = next
                .faces()
                .step_by(3)
                .map(|face| face[1] as usize)
                .collect();
            next = refine(&next)?;
        }
        let refined = next.faces().map(<[u32]>::to_vec).collect::<Vec<_>>();
        let first_children = faces.iter().scan(0, |first, face| {
            let own = *first;
            *first += match scheme {
                SurfaceScheme::CatmullClark => face.len(),
                _ => 4,
            };
            Some(own)
        });
        Ok(Self {
            mesh: ClosedMesh::new(next.vertex_count as usize, &refined)?,
            rows: values.iter().map(wide).collect(),
            scheme,
            old_vertices: vertices,
            centres,
            first_children: first_children.collect(),
        })
    }

    /// Refines a closed mesh.
    ///
    /// # Errors
    ///
    /// [`FormError::Refused`] if core refuses the mesh.
    pub fn of(scheme: SurfaceScheme, mesh: &ClosedMesh) -> Result<Self, FormError> {
        let name = |vertex: usize| u32::try_from(vertex).expect("meshes fit 32-bit indices");
        let face = |face: usize| mesh.face_vertices(face).map(name).collect();
        let faces = (0..mesh.faces()).map(face).collect::<Vec<_>>();
        Self::new(scheme, mesh.vertices(), &faces)
    }

    /// The faces that an old face was split into: four, as many as it has corners
    /// (Catmull-Clark), or nine (square-root-3).
    #[must_use]
    pub fn children(&self, face: usize) -> Vec<usize> {
        if self.scheme != SurfaceScheme::Sqrt3 {
            let first = self.first_children[face];
            let next = self.first_children.get(face + 1).copied();
            return (first..next.unwrap_or(self.mesh.faces())).collect();
        }
        // Six triangles round the middle; those that point to a corner have the corner's own beyond.
        let mut children = Vec::new();
        for spoke in self.mesh.around(self.centres[face]) {
            children.push(self.mesh.face_of(spoke));
            let beyond = self.mesh.twin(self.mesh.next(spoke));
            if self.mesh.origin(self.mesh.previous(beyond)) < self.old_vertices {
                children.push(self.mesh.face_of(beyond));
            }
        }
        children
    }
}

fn wide(row: &rows::Row) -> Row<f64> {
    let entries = row.iter();
    entries
        .map(|(column, weight)| (*column as usize, *weight))
        .collect()
}
