//! Butterfly surfaces on control meshes of triangles: old vertices stay, so the surface goes through
//! all of them.
//!
//! * **Original** (Dyn, Levin, Gregory 1990): the midpoint of the edge from `a` to `b` takes
//!   `1/2 1/2` of its ends, `1/8 1/8` of the vertices opposite and `-1/16` of each of the four
//!   vertices across the other edges of its two triangles (tension `w = 1/16`).
//! * **Modified** (Zorin, Schroeder, Sweldens 1996): an edge at a vertex of valence `K` other than 6
//!   takes `3/4` of that vertex and `s_j` of its ring, counted from the edge's other end:
//!   `s_j = (1/4 + cos(2 pi j / K) + cos(4 pi j / K) / 2) / K` for `K >= 5`, `5/12 -1/12 -1/12` at 3,
//!   `3/8 0 -1/8 0` at 4; at two such vertices the mean of both.
//! * **Sharp edges** (creases and the rim) follow the four-point rule `-1/16 9/16 9/16 -1/16` along
//!   their line. Where the line ends, crosses or has a corner, its continuation is the mirror image
//!   `2 a - b`. On a [`Rim::Fixed`](super::Rim) rim, midpoints lie halfway.
//! * **Beside sharp edges** a vertex across a sharp edge `a c` is replaced by the fourth corner
//!   `a + c - b` of the parallelogram on this side, so that no side sees the other. Vertices with a
//!   sharp edge count as regular in the modified scheme.
//!
//! The parallelogram and the mirror image are this library's choice: the papers leave the boundary
//! open, and Zorin's tables agree with them on regular meshes.
//!
//! # Exactness
//!
//! All weights are exact fractions but the `s_j` of valences from 5 on (other than 6), which are
//! rounded to multiples of 2^-30, mirror images alike, the vertex's own weight being one minus the
//! others. In a mean of an exact and an irrational stencil both are taken in units of 2^-30.

mod points;
mod stencil;

pub use points::refine_points;

use super::split::{SurfaceCounts, quadrisect, quadrisect_counts};
use crate::mesh::{ControlMesh, ControlMeshBuffers, MeshError, SurfaceEdges};

/// Which butterfly.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Variant {
    /// The stencil of 1990 everywhere. Not smooth at vertices of valence 3 and above 7.
    #[default]
    Original,
    /// The stencils of 1996 at vertices of valence other than 6.
    Modified,
}

/// What [`split`] will write. `None` where a count does not fit.
#[must_use]
pub fn split_counts(mesh: &ControlMesh<'_>, edges: &SurfaceEdges<'_>) -> Option<SurfaceCounts> {
    quadrisect_counts(mesh, edges)
}

/// Splits every triangle `(a, b, c)` into `(a, ab, ca) (ab, b, bc) (ca, bc, c) (ab, bc, ca)` and
/// writes the connectivity of the next level into `buffers`, of which it returns the filled part.
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
