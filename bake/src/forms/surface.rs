//! The limit surface of a control mesh, cut into facets.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use std::sync::Arc;

use super::cache::FormField;
use super::error::FormError;
use super::form::TrilinearForm;
use super::mesh::ClosedMesh;
use super::neighbourhood::{self, Neighbourhood, Step};
use super::scheme::{Row, Scheme, apply};
use crate::surface::SurfaceScheme;

/// What a facet's form depends on, besides the scheme.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum FacetKind {
    /// Edges (corners of the face, for Doo-Sabin) at the one irregular place.
    Valence(usize),
    /// Its place among the kinds of neighbourhoods of this surface.
    Neighbourhood(usize),
}

/// A facet: its kind and its control points.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Facet {
    /// What its form depends on.
    pub kind: FacetKind,
    /// Control points among the refined mesh's vertices, in the form's order.
    pub points: Vec<usize>,
}

/// The limit surface of a control mesh: refined until every facet has at most one irregular place,
/// with the form of each facet.
#[derive(Clone, Debug)]
pub struct LimitSurface<F> {
    scheme: SurfaceScheme,
    control_points: usize,
    refinements: Vec<Vec<Row<F>>>,
    refined: ClosedMesh,
    facets: Vec<Facet>,
    forms: BTreeMap<FacetKind, Arc<TrilinearForm<F>>>,
}

impl<F: FormField> LimitSurface<F> {
    /// The limit surface of a mesh of any genus.
    ///
    /// # Errors
    ///
    /// A [`FormError`] if the scheme does not take the mesh, if a valence is above
    /// [`MAX_VALENCE`](super::MAX_VALENCE), or if the weights do not lie in the field.
    pub fn new(scheme: Scheme, mesh: &ClosedMesh) -> Result<Self, FormError> {
        let mut refined = mesh.clone();
        let mut refinements = Vec::new();
        let mut valences = Vec::new();
        for _ in 0..scheme.steps(mesh)? {
            valences.extend(scheme.weight_valences(&refined));
            let next = scheme.refine(&refined);
            refinements.push(scheme.rows(&refined, &next)?);
            refined = next;
        }
        let facet = |half_edge| Facet {
            kind: FacetKind::Valence(scheme.valence(&refined, half_edge)),
            points: scheme.control_points(&refined, half_edge),
        };
        let facets = scheme
            .facets(&refined)
            .into_iter()
            .map(facet)
            .collect::<Vec<_>>();
        let mut forms = BTreeMap::new();
        for facet in &facets {
            let FacetKind::Valence(valence) = facet.kind else {
                continue;
            };
            valences.push(valence);
            if let Entry::Vacant(entry) = forms.entry(facet.kind) {
                entry.insert(F::form(scheme, valence)?);
            }
        }
        F::require(scheme, &valences)?;
        Ok(Self {
            scheme: scheme.surface(),
            control_points: mesh.vertices(),
            refinements,
            refined,
            facets,
            forms,
        })
    }

    /// The scheme.
    #[must_use]
    pub fn scheme(&self) -> SurfaceScheme {
        self.scheme
    }

    /// The facets.
    #[must_use]
    pub fn facets(&self) -> &[Facet] {
        &self.facets
    }

    /// The connectivity of the refined mesh.
    #[must_use]
    pub fn refined(&self) -> &ClosedMesh {
        &self.refined
    }

    /// The refinement steps, each a row for every new vertex.
    #[must_use]
    pub fn refinements(&self) -> &[Vec<Row<F>>] {
        &self.refinements
    }

    /// The vertices of the refined mesh.
    ///
    /// # Errors
    ///
    /// [`FormError::Points`] if the number of control points is not that of the mesh.
    pub fn refined_points(&self, points: &[[F; 3]]) -> Result<Vec<[F; 3]>, FormError> {
        if points.len() != self.control_points {
            return Err(FormError::Points {
                vertices: self.control_points,
                given: points.len(),
            });
        }
        let refine = |points: Vec<[F; 3]>, rows: &Vec<Row<F>>| apply(rows, &points);
        Ok(self.refinements.iter().fold(points.to_vec(), refine))
    }

    /// The volume that the limit surface encloses: positive if its faces run counter-clockwise seen
    /// from outside.
    ///
    /// # Errors
    ///
    /// [`FormError::Points`] if the number of control points is not that of the mesh.
    pub fn volume(&self, points: &[[F; 3]]) -> Result<F, FormError> {
        let points = self.refined_points(points)?;
        let shares = self.shares_of_refined(&points);
        Ok(shares.fold(F::zero(), |sum, share| sum.plus(&share)))
    }

    /// The volume of the cone from the origin over each facet. They depend on the origin; their sum
    /// does not.
    ///
    /// # Errors
    ///
    /// [`FormError::Points`] if the number of control points is not that of the mesh.
    pub fn shares(&self, points: &[[F; 3]]) -> Result<Vec<F>, FormError> {
        let points = self.refined_points(points)?;
        Ok(self.shares_of_refined(&points).collect())
    }

    fn shares_of_refined(&self, points: &[[F; 3]]) -> impl Iterator<Item = F> {
        self.facets.iter().map(|facet| {
            let own = gather(facet, points);
            self.form_of(facet).value(&own)
        })
    }

    /// The form of a facet.
    #[must_use]
    pub fn form_of(&self, facet: &Facet) -> &TrilinearForm<F> {
        &self.forms[&facet.kind]
    }
}

impl LimitSurface<f64> {
    /// The limit surface of a scheme whose facets lie in surroundings of many kinds; the schemes that have
    /// forms of their own, but Doo-Sabin, may be taken too.
    ///
    /// # Errors
    ///
    /// Those of [`neighbourhood::require`], and [`FormError::Refused`] if core refuses the mesh.
    pub fn by_neighbourhoods(scheme: SurfaceScheme, mesh: &ClosedMesh) -> Result<Self, FormError> {
        neighbourhood::require(scheme, mesh)?;
        let mut refined = mesh.clone();
        let mut refinements = Vec::new();
        for _ in 0..neighbourhood::steps(scheme) {
            let step = Step::of(scheme, &refined)?;
            refinements.push(step.rows);
            refined = step.mesh;
        }
        let faces = 0..refined.faces();
        let mut kinds = BTreeMap::new();
        let facets = faces.map(|face| {
            let own = Neighbourhood::new(scheme, &refined, face);
            let next = kinds.len();
            (*kinds.entry(own.patch).or_insert(next), own.points)
        });
        let facets = facets.collect::<Vec<_>>();
        let mut patches = kinds.into_iter().collect::<Vec<_>>();
        patches.sort_unstable_by_key(|(_, kind)| *kind);
        let patches = patches.into_iter().map(|(patch, _)| patch);
        let local = neighbourhood::forms(scheme, &patches.collect::<Vec<_>>())?;
        let facets = facets.into_iter().map(|(kind, points)| Facet {
            kind: FacetKind::Neighbourhood(kind),
            points: local[kind].places.iter().map(|&at| points[at]).collect(),
        });
        let kinds = (0..).map(FacetKind::Neighbourhood);
        let forms = local.iter().map(|form| Arc::clone(&form.form));
        Ok(Self {
            scheme,
            control_points: mesh.vertices(),
            refinements,
            refined,
            facets: facets.collect(),
            forms: kinds.zip(forms).collect(),
        })
    }

    /// The volume, and its derivative by every control point.
    ///
    /// # Errors
    ///
    /// [`FormError::Points`] if the number of control points is not that of the mesh.
    pub fn gradient(&self, points: &[[f64; 3]]) -> Result<Vec<[f64; 3]>, FormError> {
        let refined = self.refined_points(points)?;
        let mut gradient = vec![[0.0; 3]; refined.len()];
        for facet in &self.facets {
            let own = gather(facet, &refined);
            let mut by_own = vec![[0.0; 3]; own.len()];
            self.form_of(facet).add_gradient(&own, &mut by_own);
            for (&vertex, share) in facet.points.iter().zip(by_own) {
                add(&mut gradient[vertex], 1.0, share);
            }
        }
        for (level, rows) in self.refinements.iter().enumerate().rev() {
            let size = match level {
                0 => self.control_points,
                _ => self.refinements[level - 1].len(),
            };
            let mut coarser = vec![[0.0; 3]; size];
            for (row, share) in rows.iter().zip(&gradient) {
                for (vertex, weight) in row {
                    add(&mut coarser[*vertex], *weight, *share);
                }
            }
            gradient = coarser;
        }
        Ok(gradient)
    }
}

fn add(sum: &mut [f64; 3], weight: f64, value: [f64; 3]) {
    for (axis, coordinate) in sum.iter_mut().zip(value) {
        *axis += weight * coordinate;
    }
}

/// The control points of a facet.
pub(crate) fn gather<P: Clone>(facet: &Facet, points: &[P]) -> Vec<P> {
    let own = facet.points.iter();
    own.map(|&vertex| points[vertex].clone()).collect()
}

/// The points moved so that the middle of their bounding box is the origin, and that middle.
/// Volumes do not change, and lose fewer digits near the origin.
#[must_use]
pub fn centred(points: &[[f64; 3]]) -> (Vec<[f64; 3]>, [f64; 3]) {
    let middle = [0, 1, 2].map(|axis| {
        let coordinates = points.iter().map(|point| point[axis]);
        let (low, high) = coordinates.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), c| {
            (low.min(c), high.max(c))
        });
        if low.is_finite() && high.is_finite() {
            low + (high - low) / 2.0
        } else {
            0.0
        }
    });
    let moved = points
        .iter()
        .map(|point| [0, 1, 2].map(|axis| point[axis] - middle[axis]))
        .collect();
    (moved, middle)
}
