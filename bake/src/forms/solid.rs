//! What encloses a volume in a file: a control mesh of polygons, or the boundary of a cage.
//!
//! A file's vertices that no face uses are left out, and come back where results are named.

use octruss::blend::Blend;
use octruss::mesh::{ControlMesh, ControlMeshBuffers, MeshError, Side, SurfaceEdges};
use octruss::surface::{LoopWeights, PointBuffers, Rim, VertexState, loop_scheme};

use super::control::ControlForm;
use super::error::FormError;
use super::mesh::ClosedMesh;
use super::scheme::Scheme;
use super::surface::LimitSurface;
use crate::error::{Error, Result};
use crate::mesh::Features;
use crate::refine::rows::{Row, RowBlend, identity};

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

/// Levels that a surface with creases is refined to.
const LEVELS: usize = 5;

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

    /// The limit surface, which must have no creases or corners.
    ///
    /// # Errors
    /// If it has, or if the scheme does not take the mesh.
    pub fn limit(&self, scheme: Scheme) -> Result<LimitSurface<f64>> {
        if self.has_features() {
            return Err(
                Error::new("a surface with creases or corners has no exact form")
                    .advise("leave the features out, or ask for the volume alone"),
            );
        }
        LimitSurface::new(scheme, &self.mesh).map_err(of_form)
    }

    /// The volume as one form over the file's vertices, and a second one that it should agree with:
    /// their difference is what it may be wrong by.
    ///
    /// Without creases and corners both are the exact form. With them the volume of the
    /// polyhedra of two successive levels is extrapolated; the second form is from the levels before.
    ///
    /// # Errors
    /// If the scheme does not take the mesh, has no creases, or there are too many control points.
    pub fn control_forms(&self, scheme: Scheme) -> Result<[ControlForm; 2]> {
        if !self.has_features() {
            let form = ControlForm::of_surface(&self.limit(scheme)?).map_err(of_form)?;
            let form = self.in_file(form);
            return Ok([form.clone(), form]);
        }
        let weights = match scheme {
            Scheme::Loop => LoopWeights::Loop,
            Scheme::LoopWarren => LoopWeights::Warren,
            _ => {
                return Err(Error::new("creases are known to Loop's scheme only")
                    .advise("use --scheme loop or loop-warren"));
            }
        };
        scheme.steps(&self.mesh).map_err(of_form)?;
        let mut forms = Vec::new();
        let mut level = Sharp::new(self);
        for step in 0..LEVELS {
            level = level.refined(weights)?;
            if step + 3 >= LEVELS {
                forms.push(level.form()?);
            }
        }
        let [first, second, third] = &forms[..] else {
            return Err(Error::new("a surface is refined at least three times"));
        };
        let before = ControlForm::extrapolated(first, second);
        let last = ControlForm::extrapolated(second, third);
        Ok([self.in_file(last), self.in_file(before)])
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

fn of_mesh(error: MeshError) -> Error {
    Error::new(error.to_string())
}

/// A triangle surface with features at one level, its vertices as rows over the control points.
struct Sharp {
    indices: Vec<u32>,
    features: Features,
    rows: Vec<Row>,
}

impl Sharp {
    fn new(surface: &Enclosure) -> Self {
        let count = u32::try_from(surface.vertices.len()).unwrap_or(u32::MAX);
        Self {
            indices: surface.faces.concat(),
            features: surface.features.clone(),
            rows: identity(count),
        }
    }

    /// Core's own refinement over rows.
    fn refined(&self, weights: LoopWeights) -> Result<Self> {
        let corners = u32::try_from(self.indices.len()).unwrap_or(u32::MAX);
        let offsets = (0..=corners).step_by(3).collect::<Vec<_>>();
        let mesh = ControlMesh {
            vertex_count: u32::try_from(self.rows.len()).unwrap_or(u32::MAX),
            offsets: &offsets,
            indices: &self.indices,
            creases: &self.features.creases,
            corners: &self.features.corners,
            odd: false,
        };
        let mut sides = vec![Side::default(); self.indices.len()];
        let edges = SurfaceEdges::new(&mesh, &mut sides).map_err(of_mesh)?;
        let counts =
            loop_scheme::split_counts(&mesh, &edges).ok_or_else(|| of_mesh(MeshError::TooLarge))?;
        let mut offsets = vec![0; counts.faces + 1];
        let mut next = Self {
            indices: vec![0; counts.indices],
            features: Features {
                creases: vec![[0; 2]; counts.creases],
                corners: vec![0; counts.corners],
                ..Features::default()
            },
            rows: Vec::new(),
        };
        let buffers = ControlMeshBuffers {
            offsets: &mut offsets,
            indices: &mut next.indices,
            creases: &mut next.features.creases,
            corners: &mut next.features.corners,
        };
        let refined = loop_scheme::split(&mesh, &edges, buffers).map_err(of_mesh)?;
        let count = refined.vertex_count as usize;
        let mut blend = RowBlend;
        let zero = blend.zero();
        next.rows = vec![Row::new(); count];
        let buffers = PointBuffers {
            out: &mut next.rows,
            sums: &mut vec![zero; count],
            states: &mut vec![VertexState::default(); count],
        };
        let (rim, rows) = (Rim::Spline, &self.rows);
        loop_scheme::refine_points(&mut blend, &mesh, &edges, weights, rim, rows, buffers)
            .map_err(of_mesh)?;
        Ok(next)
    }

    fn form(&self) -> Result<ControlForm> {
        let triangles = self.indices.as_chunks::<3>().0;
        let wide = |row: &Row| {
            let entries = row.iter();
            entries
                .map(|(point, weight)| (*point as usize, *weight))
                .collect()
        };
        let rows = self.rows.iter().map(wide).collect::<Vec<Vec<_>>>();
        ControlForm::of_triangles(triangles, &rows).map_err(of_form)
    }
}
