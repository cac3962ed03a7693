//! The triangle/quadrilateral surfaces of Schaefer and Warren, as Hakenberg's example 5.2 has them, on
//! control meshes of triangles and quads.
//!
//! One level has three steps:
//!
//! 1. *Unzip*: every vertex gets two clones, one for its triangles and one for its quads. At a vertex
//!    where `m` edges are shared by a triangle and a quad, the triangles' clone is the vertex moved by
//!    `1/24 (mean of the other ends of these edges - vertex)`, the quads' is moved as far the other
//!    way. At any other vertex, and at those that follow a crease or stay, both are the vertex.
//! 2. *Linear split*: a triangle into four, a quad into four, from the clones of its kind.
//! 3. *Averaging and collapse*: every new face averages its corners (a triangle by `1/4 3/8 3/8`, a
//!    quad evenly), and what the new faces at a vertex say is averaged with the weights 1/6 for
//!    triangles and 1/4 for quads.
//!
//! On triangles alone the scheme is Loop's with `3/(8n)` of each neighbour, at every valence, to the
//! bit; on quads alone `9/16 6/16 1/16` at every valence, which is Catmull-Clark's at valence 4. It is
//! the rule that the boundary of [`solid::mixed`](crate::solid::mixed) follows, to the bit, where the
//! boundary is the surface.
//!
//! * Sharp edges (creases and the rim) and the vertices on them follow the rules of
//!   [`features`](super::features): midpoints `1/2 1/2`, vertices with two sharp edges
//!   `1/8 6/8 1/8`, with more than two they stay, with one (a dart) they are smooth; tagged corners
//!   stay. Vertices on sharp edges, but not darts, and corners are not unzipped, as in a mixed solid:
//!   what lies across a crease would pull this side toward it, and flat faces would not stay flat.
//! * Faces of more than four corners are refused
//!   ([`MeshError::NotATriangleOrQuad`](crate::mesh::MeshError)): the paper says nothing of them.
//!
//! The limit has no mask of its own here: it depends on how triangles and quads alternate round a
//! vertex.
//!
//! # Exactness
//!
//! Clones are rounded to 8 bits below the last place and are the only intermediate that is rounded; a
//! clone without distortion is exact. Everything after them is one exact sum, rounded once.

mod points;
mod split;
mod unzip;

pub use points::{PointBuffers, refine_points};
pub use split::{split, split_counts};
pub use unzip::VertexDistortion;

use crate::mesh::{ControlMesh, MeshError};

/// Refuses a mesh with a face of other than three or four corners.
fn require_triangles_and_quads(mesh: &ControlMesh<'_>) -> Result<(), MeshError> {
    let mut faces = mesh.faces().enumerate();
    match faces.find(|(_, face)| !matches!(face.len(), 3 | 4)) {
        Some((face, corners)) => Err(MeshError::NotATriangleOrQuad {
            face,
            corners: corners.len(),
        }),
        None => Ok(()),
    }
}
