//! Forms of facets whose surroundings are of many kinds: `tri-quad`, `sqrt3` and the butterflies.
//!
//! A facet of these schemes is a face. Its limit surface depends on the vertices some rings around it and
//! on how the faces there are joined, its *kind* ([`Patch`]). A step (two of square-root-3) splits it
//! into children, each with a kind of its own, and the volumes of the cones over them add up: the
//! form `w` of a kind is the sum of `P' w' P` over the children, where `P` gives a child's
//! vertices over the parent's and `w'` is the form of the child's kind.
//!
//! * [`step`]: core's own refinement over sparse rows, and the children of each face.
//! * [`patch`]: the kind of a facet, in an order of its own.
//! * [`kinds`]: all kinds that descend from some, found one from another.
//! * [`solve`]: their forms, by iteration from the forms of the polyhedra.
//! * [`template`]: the form at one extraordinary vertex, for people.
//!
//! Nothing here is a table of a scheme: masks and connectivity come from core, and the schemes
//! that have forms of their own ([`Scheme`](super::Scheme)) come out as those to rounding.

pub mod kinds;
pub mod patch;
pub mod solve;
pub mod step;
pub mod template;

pub use kinds::{LocalForm, forms};
pub use patch::{Neighbourhood, Patch};
pub use step::Step;
pub use template::VertexFacet;

use super::error::FormError;
use super::mesh::ClosedMesh;
use crate::surface::SurfaceScheme;

/// How often a mesh is refined before it is cut into facets: until hardly any facet has two
/// extraordinary vertices among the rings that matter, so that there are few kinds. A count of
/// [`Step`]s.
#[must_use]
pub fn steps(scheme: SurfaceScheme) -> usize {
    match scheme {
        SurfaceScheme::Loop
        | SurfaceScheme::LoopWarren
        | SurfaceScheme::CatmullClark
        | SurfaceScheme::DooSabin
        | SurfaceScheme::Sqrt3 => 1,
        SurfaceScheme::Butterfly | SurfaceScheme::ButterflyModified | SurfaceScheme::TriQuad => 2,
    }
}

/// Makes sure that a scheme takes the faces of a mesh and that its valences are ordinary ones.
///
/// # Errors
///
/// [`FormError::NotTriangles`] or [`FormError::NotTrianglesAndQuads`] for the first face that it does not
/// take, [`FormError::Valence`] for a vertex of fewer than three edges or more than
/// [`MAX_VALENCE`](super::MAX_VALENCE).
pub fn require(scheme: SurfaceScheme, mesh: &ClosedMesh) -> Result<(), FormError> {
    let with_corners = |taken: &[usize]| {
        let mut faces = 0..mesh.faces();
        faces.find(|&face| !taken.contains(&mesh.face(face).len()))
    };
    match scheme {
        SurfaceScheme::TriQuad => {
            if let Some(face) = with_corners(&[3, 4]) {
                return Err(FormError::NotTrianglesAndQuads { face });
            }
        }
        SurfaceScheme::CatmullClark | SurfaceScheme::DooSabin => {}
        _ => {
            if let Some(face) = with_corners(&[3]) {
                return Err(FormError::NotTriangles { face });
            }
        }
    }
    let valences = (0..mesh.vertices()).map(|vertex| mesh.valence(vertex));
    match { valences }.find(|valence| !(3..=super::MAX_VALENCE).contains(valence)) {
        Some(valence) => Err(FormError::Valence { valence }),
        None => Ok(()),
    }
}
