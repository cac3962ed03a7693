//! The facet at one extraordinary vertex in otherwise regular surroundings.

use super::kinds::forms;
use super::patch::{Neighbourhood, Patch};
use super::step::Step;
use crate::forms::error::FormError;
use crate::forms::form::TrilinearForm;
use crate::forms::local::MAX_VALENCE;
use crate::surface::SurfaceScheme;

/// The form of a facet at a vertex, with the patch that its control points are counted in.
#[derive(Clone, Debug)]
pub struct VertexFacet {
    /// The faces around the facet, the facet first; vertex 0 is the extraordinary one. Vertices are numbered
    /// outward as in [`Patch`].
    pub patch: Patch,
    /// The patch's vertices that the form is over, ascending.
    pub places: Vec<usize>,
    /// The form over them, in this order.
    pub form: TrilinearForm<f64>,
    /// See [`LocalForm::residual`](super::LocalForm::residual).
    pub residual: f64,
}

/// Refinements after which the surroundings of the vertex alone reach as far as any patch.
const STEPS: usize = 3;

impl VertexFacet {
    /// The facet at a vertex round which faces of these numbers of corners lie, counter-clockwise; the facet
    /// is in the first. All other vertices of the patch are as a step makes them.
    ///
    /// # Errors
    ///
    /// [`FormError::Valence`] if there are fewer than three faces or more than [`MAX_VALENCE`], and those of
    /// [`require`](super::require) for what the scheme does not take.
    pub fn new(scheme: SurfaceScheme, corners: &[usize]) -> Result<Self, FormError> {
        if !(3..=MAX_VALENCE).contains(&corners.len()) {
            return Err(FormError::Valence {
                valence: corners.len(),
            });
        }
        let (vertices, faces) = wheel(corners)?.closed();
        let mut step = Step::new(scheme, vertices, &faces)?;
        let mut face = Self::child(&step, 0);
        for _ in 1..STEPS {
            step = Step::of(scheme, &step.mesh)?;
            face = Self::child(&step, face);
        }
        let own = Neighbourhood::new(scheme, &step.mesh, face);
        let mut starts = step.mesh.face(face);
        let first = starts.find(|&start| step.mesh.origin(start) == 0);
        let first = first.ok_or(FormError::Face { face })?;
        let numbered = Neighbourhood::beginning(scheme, &step.mesh, first);
        let local = forms(scheme, &[own.patch])?.remove(0);
        let place = |vertex: usize| numbered.points.iter().position(|&own| own == vertex);
        let renamed = local.places.iter().map(|&at| place(own.points[at]));
        let renamed = renamed.collect::<Option<Vec<_>>>();
        let renamed = renamed.ok_or(FormError::Face { face })?;
        let mut places = renamed.clone();
        places.sort_unstable();
        let order =
            { renamed.iter() }.map(|at| vec![(places.partition_point(|own| own < at), 1.0)]);
        let form = local
            .form
            .pull_back(&order.collect::<Vec<_>>(), places.len());
        Ok(Self {
            patch: numbered.patch,
            places,
            form,
            residual: local.residual,
        })
    }

    /// The child at vertex 0.
    fn child(step: &Step, face: usize) -> usize {
        let children = step.children(face);
        let mut at_vertex = children
            .iter()
            .filter(|&&child| step.mesh.face_vertices(child).any(|vertex| vertex == 0));
        *at_vertex.next().unwrap_or(&children[0])
    }
}

/// Faces round vertex 0.
fn wheel(corners: &[usize]) -> Result<Patch, FormError> {
    let mut starts = vec![1_u32];
    for (face, &sides) in corners.iter().enumerate() {
        let sides = u32::try_from(sides).ok().filter(|sides| *sides >= 3);
        let sides = sides.ok_or(FormError::Face { face })?;
        starts.push(starts[face] + sides - 2);
    }
    let rim = starts[corners.len()] - 1;
    let face = |ends: &[u32]| {
        let around = (ends[0]..=ends[1]).map(|place| (place - 1) % rim + 1);
        std::iter::once(0).chain(around).collect()
    };
    Ok(Patch {
        vertices: rim as usize + 1,
        faces: starts.windows(2).map(face).collect(),
    })
}
