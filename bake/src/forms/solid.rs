//! What encloses a volume in a file: a control mesh of polygons, or the boundary of a cage.
//!
//! A file's vertices that no face uses are left out, and come back where results are named.

use super::control::ControlForm;
use super::error::FormError;
use super::mesh::ClosedMesh;
use super::moments::Moments;
use super::neighbourhood;
use super::polyhedra;
use super::scheme::Scheme;
use super::surface::LimitSurface;
use crate::error::{Error, Result};
use crate::mesh::{Features, Point};
use crate::refine::Level;
use crate::surface::{SurfaceMesh, SurfaceScheme};

/// A closed surface of a file, with the creases and corners that lie on it.
#[derive(Clone, Debug)]
pub struct Enclosure {
    /// The file's vertices that the surface has, ascending.
    pub vertices: Vec<u32>,
    /// The connectivity over them.
    pub mesh: ClosedMesh,
    faces: Vec<Vec<u32>>,
    features: Features,
}

impl Enclosure {
    /// The surface of these faces, corners counter-clockwise from outside, and those of the
    /// features that lie on it.
    ///
    /// # Errors
    /// If the surface is open, not a manifold or not consistently oriented; an edge is named.
    pub fn new(faces: &[Vec<u32>], features: &Features) -> Result<Self> {
        let mut vertices = faces.concat();
        vertices.sort_unstable();
        vertices.dedup();
        let place = |vertex: &u32| vertices.binary_search(vertex).ok();
        let local = |vertex: &u32| place(vertex).and_then(|place| u32::try_from(place).ok());
        let faces = faces
            .iter()
            .map(|face| face.iter().filter_map(local).collect())
            .collect::<Vec<Vec<u32>>>();
        let name = |vertex: usize| vertices.get(vertex).map_or(vertex, |&name| name as usize);
        let mesh = ClosedMesh::new(vertices.len(), &faces)
            .map_err(|error| Error::new(error.named(name).to_string()))?;
        let edges = (0..mesh.half_edges()).map(|side| [mesh.origin(side), mesh.end(side)]);
        let edges = edges.collect::<std::collections::BTreeSet<_>>();
        let creases = features.creases.iter().filter_map(|[a, b]| {
            let (place_a, place_b) = (place(a)?, place(b)?);
            (edges.contains(&[place_a, place_b])).then_some([local(a)?, local(b)?])
        });
        let features = Features {
            creases: creases.collect(),
            corners: features.corners.iter().filter_map(local).collect(),
            ..Features::default()
        };
        Ok(Self {
            vertices,
            mesh,
            faces,
            features,
        })
    }

    /// The boundary of a cage.
    ///
    /// # Errors
    /// Those of [`Enclosure::new`], and if sheets hang on the boundary.
    pub fn of_cage(level: &Level, features: &Features) -> Result<Self> {
        level.require_bare_boundary()?;
        let triangles = level.boundary().iter().map(|face| face.to_vec());
        let quads = level.boundary_quads().iter().map(|face| face.to_vec());
        Self::new(&triangles.chain(quads).collect::<Vec<_>>(), features)
    }

    /// The surface's own points, out of those of the file.
    pub fn own<P: Copy>(&self, points: &[P]) -> Vec<P> {
        let own = self.vertices.iter();
        own.filter_map(|&vertex| points.get(vertex as usize).copied())
            .collect()
    }

    /// True if creases or corners lie on the surface, so that it has no exact form.
    pub fn has_features(&self) -> bool {
        !self.features.creases.is_empty() || !self.features.corners.is_empty()
    }

    /// True if the facets have forms of the volume: with creases or corners they have none, nor, in the
    /// schemes that have them by neighbourhoods, beside vertices of two edges or very many.
    pub fn has_forms(&self, scheme: SurfaceScheme) -> bool {
        let is_ordinary = || {
            let fits = neighbourhood::require(scheme, &self.mesh);
            !matches!(fits, Err(FormError::Valence { .. }))
        };
        !self.has_features() && (Scheme::of_surface(scheme).is_some() || is_ordinary())
    }

    /// True if the facets' moments have an exact rule, too.
    pub fn has_moments(&self, scheme: SurfaceScheme) -> bool {
        !self.has_features() && Scheme::of_surface(scheme).is_some()
    }

    /// The limit surface, cut into facets with forms of the volume.
    ///
    /// # Errors
    /// If the surface has none, or if the scheme does not take the mesh.
    pub fn limit(&self, scheme: SurfaceScheme) -> Result<LimitSurface<f64>> {
        if self.has_features() {
            return Err(
                Error::new("a surface with creases or corners has no exact form")
                    .advise("leave the features out, or ask for the volume and moments alone"),
            );
        }
        match Scheme::of_surface(scheme) {
            Some(exact) => LimitSurface::new(exact, &self.mesh),
            None => LimitSurface::by_neighbourhoods(scheme, &self.mesh),
        }
        .map_err(of_form)
    }

    /// The volume as one form over the file's vertices, and a second one that it should agree with:
    /// their difference is what it may be wrong by.
    ///
    /// Where facets have forms ([`Enclosure::has_forms`]) both are the exact form. Otherwise the
    /// volume of the polyhedra of two successive levels is extrapolated; the second form is from the
    /// levels before.
    ///
    /// # Errors
    /// If the scheme does not take the mesh or there are too many control points.
    pub fn control_forms(&self, scheme: SurfaceScheme) -> Result<[ControlForm; 2]> {
        if self.has_forms(scheme) {
            let form = ControlForm::of_surface(&self.limit(scheme)?).map_err(of_form)?;
            let form = self.in_file(form);
            return Ok([form.clone(), form]);
        }
        let origin = vec![[0.0; 3]; self.vertices.len()];
        let forms = polyhedra::forms(&self.surface_mesh(origin), scheme)?;
        Ok(forms.map(|form| self.in_file(form)))
    }

    /// The volume of the control polyhedron itself, exactly, as one form over the file's vertices.
    ///
    /// # Errors
    /// If there are too many control points.
    pub fn polyhedron(&self) -> Result<ControlForm> {
        let rows = (0..self.vertices.len()).map(|vertex| vec![(vertex, 1.0)]);
        let faces = self.faces.iter().map(Vec::as_slice);
        let form = ControlForm::of_faces(faces, &rows.collect::<Vec<_>>()).map_err(of_form)?;
        Ok(self.in_file(form))
    }

    /// Volume, centroid and inertia by extrapolation, where there is no exact form, and those from the
    /// levels before, for the surface's own points.
    ///
    /// # Errors
    /// If the scheme does not take the mesh.
    pub fn extrapolated_moments(
        &self,
        scheme: SurfaceScheme,
        own: &[Point],
    ) -> Result<[Moments; 2]> {
        polyhedra::moments(&self.surface_mesh(own.to_vec()), scheme)
    }

    fn surface_mesh(&self, points: Vec<Point>) -> SurfaceMesh {
        SurfaceMesh {
            points,
            faces: self.faces.clone(),
            features: self.features.clone(),
            notes: Vec::new(),
        }
    }

    fn in_file(&self, mut form: ControlForm) -> ControlForm {
        for point in &mut form.points {
            *point = self.vertices[*point] as usize;
        }
        form
    }
}

fn of_form(error: FormError) -> Error {
    Error::new(error.to_string())
}
