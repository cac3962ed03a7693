//! A picture of the facets, coloured by their share of the volume.

use super::error::FormError;
use super::mesh::ClosedMesh;
use super::neighbourhood::Step;
use super::scheme::{Row, Scheme, apply};
use super::surface::{LimitSurface, centred};
use crate::surface::SurfaceScheme;

/// A refined surface with a colour for each triangle.
#[derive(Clone, Debug, Default)]
pub struct Portrait {
    /// Positions.
    pub points: Vec<[f64; 3]>,
    /// Triangles, counter-clockwise from outside.
    pub triangles: Vec<[u32; 3]>,
    /// A colour for each triangle: red, green, blue, from 0 to 1.
    pub colours: Vec<[f64; 3]>,
}

/// Refinements beyond those that part the facets.
const STEPS: usize = 2;

/// The least share has the first colour and the greatest the last: blue over white to red if there
/// are shares of both signs (the cone over such a facet is outside).
const COLOURS: [[f64; 3]; 3] = [[0.16, 0.34, 0.66], [0.94, 0.92, 0.87], [0.80, 0.24, 0.16]];

impl LimitSurface<f64> {
    /// The facets, refined a little further, coloured by the volume of the cones over them from
    /// the middle of the mesh.
    ///
    /// # Errors
    ///
    /// [`FormError::Points`] if the number of control points is not that of the mesh.
    pub fn portrait(&self, points: &[[f64; 3]]) -> Result<Portrait, FormError> {
        let (moved, _) = centred(points);
        let colours = colours(&self.shares(&moved)?);
        let scheme = self.scheme();
        let mut mesh = self.refined().clone();
        let mut points = self.refined_points(points)?;
        // The facet of each face, or of each vertex for Doo-Sabin.
        let mut facets = (0..self.facets().len()).collect::<Vec<_>>();
        for _ in 0..STEPS {
            let fine = match Scheme::of_surface(scheme) {
                Some(scheme) => Finer::new(scheme, &mesh, &facets)?,
                None => Finer::by_core(scheme, &mesh, &facets)?,
            };
            points = apply(&fine.rows, &points);
            (mesh, facets) = (fine.mesh, fine.facets);
        }
        let mut portrait = Portrait::default();
        if scheme == SurfaceScheme::DooSabin {
            // A facet is the quadrilateral of the middles of the faces at its vertex.
            for face in 0..mesh.faces() {
                let corners = mesh
                    .face_vertices(face)
                    .map(|v| points[v])
                    .collect::<Vec<_>>();
                portrait.points.push(mean(&corners));
            }
            for (vertex, facet) in facets.iter().enumerate() {
                let around = mesh.around(vertex).into_iter();
                let middles = around.map(|side| mesh.face_of(side)).collect::<Vec<_>>();
                portrait.push(&middles, colours[*facet]);
            }
        } else {
            portrait.points = points;
            for (face, facet) in facets.iter().enumerate() {
                let corners = mesh.face_vertices(face).collect::<Vec<_>>();
                portrait.push(&corners, colours[*facet]);
            }
        }
        Ok(portrait)
    }
}

/// A refined mesh, and the facet of each face (of each vertex for Doo-Sabin).
struct Finer {
    mesh: ClosedMesh,
    rows: Vec<Row<f64>>,
    facets: Vec<usize>,
}

impl Finer {
    fn new(scheme: Scheme, mesh: &ClosedMesh, facets: &[usize]) -> Result<Self, FormError> {
        let fine = scheme.refine(mesh);
        let facets = match scheme {
            Scheme::DooSabin => (0..fine.vertices())
                .map(|v| facets[mesh.origin(v)])
                .collect(),
            _ => (0..fine.faces()).map(|face| facets[face / 4]).collect(),
        };
        Ok(Self {
            rows: scheme.rows(mesh, &fine)?,
            mesh: fine,
            facets,
        })
    }

    fn by_core(
        scheme: SurfaceScheme,
        mesh: &ClosedMesh,
        facets: &[usize],
    ) -> Result<Self, FormError> {
        let step = Step::of(scheme, mesh)?;
        let mut fine = vec![0; step.mesh.faces()];
        for (face, facet) in facets.iter().enumerate() {
            for child in step.children(face) {
                fine[child] = *facet;
            }
        }
        Ok(Self {
            mesh: step.mesh,
            rows: step.rows,
            facets: fine,
        })
    }
}

impl Portrait {
    fn push(&mut self, corners: &[usize], colour: [f64; 3]) {
        let name = |vertex: usize| u32::try_from(vertex).unwrap_or(u32::MAX);
        for pair in corners[1..].windows(2) {
            self.triangles
                .push([corners[0], pair[0], pair[1]].map(name));
            self.colours.push(colour);
        }
    }
}

fn mean(points: &[[f64; 3]]) -> [f64; 3] {
    let share = 1.0 / f64::from(u32::try_from(points.len()).unwrap_or(u32::MAX));
    [0, 1, 2].map(|axis| points.iter().map(|point| point[axis]).sum::<f64>() * share)
}

fn colours(shares: &[f64]) -> Vec<[f64; 3]> {
    let (low, high) = shares
        .iter()
        .fold((0.0_f64, 0.0_f64), |(low, high), &share| {
            (low.min(share), high.max(share))
        });
    let size = high.max(-low).max(f64::MIN_POSITIVE);
    let [negative, none, positive] = COLOURS;
    let colour = |share: &f64| {
        let (end, part) = if *share < 0.0 {
            (negative, -share / size)
        } else {
            (positive, share / size)
        };
        [0, 1, 2].map(|channel| none[channel] + part * (end[channel] - none[channel]))
    };
    shares.iter().map(colour).collect()
}
