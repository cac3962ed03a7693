//! Loop's surfaces (1987) on control meshes of triangles, with either weight family of
//! [`LoopWeights`].
//!
//! * The midpoint of a smooth edge takes `3/8 3/8` of its ends and `1/8 1/8` of the vertices
//!   opposite.
//! * A smooth vertex of valence `n` moves to `own + weight(n) * sum(neighbour - own)`.
//! * Sharp edges (creases and the rim) and the vertices on them follow the rules of
//!   [`features`](super::features), as in OpenSubdiv with infinitely sharp creases.
//!
//! A triangle `(a, b, c)` splits into `(a, ab, ca) (ab, b, bc) (ca, bc, c) (ab, bc, ca)`.

mod limit;
mod points;

pub use limit::limit_points;
pub use points::refine_points;

#[cfg(doc)]
use super::LoopWeights;
use super::split::{SurfaceCounts, quadrisect, quadrisect_counts};
use crate::mesh::{ControlMesh, ControlMeshBuffers, MeshError, SurfaceEdges};

/// What [`split`] will write. `None` where a count does not fit.
#[must_use]
pub fn split_counts(mesh: &ControlMesh<'_>, edges: &SurfaceEdges<'_>) -> Option<SurfaceCounts> {
    quadrisect_counts(mesh, edges)
}

/// Splits every triangle into four and writes the connectivity of the next level into `buffers`, of
/// which it returns the filled part. Children come in the order of their parents; a crease edge
/// becomes its two halves, corners stay.
///
/// # Errors
///
/// [`MeshError::NotATriangle`] and [`MeshError::ArenaTooSmall`] before anything is written;
/// [`MeshError::OtherNumbering`] if the edges are seen to be of another mesh.
pub fn split<'a>(
    mesh: &ControlMesh<'_>,
    edges: &SurfaceEdges<'_>,
    buffers: ControlMeshBuffers<'a>,
) -> Result<ControlMesh<'a>, MeshError> {
    quadrisect(mesh, edges, buffers)
}
