//! Smooth subdivision of tetrahedra and octahedra (Schaefer, Hakenberg, Warren: "Smooth
//! Subdivision of Tetrahedral Meshes").
//!
//! One level is a linear split (section 2.1: a tetrahedron becomes four tetrahedra and an
//! octahedron, an octahedron becomes six octahedra and eight tetrahedra) and a smoothing pass
//! (section 2.2, figures 4 and 5): every vertex moves to the mean, over all cells that meet
//! there, of a weighted centroid of each cell. Both are linear, so a refined vertex is one mask
//! over the vertices of the level before, and is rounded once.
//!
//! # Which rule a vertex follows
//!
//! An old vertex, by the first that applies:
//!
//! 1. a corner (tagged, or where more than two crease edges meet) stays;
//! 2. on a surface that is [`Boundary::Fixed`] it stays;
//! 3. where exactly two crease edges meet, the cubic B-spline `1/8 6/8 1/8` along the crease;
//! 4. on a surface with a rule ([`Boundary::Surface`]), Loop's vertex rule over the surface's
//!    edges, however many meet there;
//! 5. the paper's interior rule.
//!
//! A vertex with a single crease edge (a crease's end) is smooth. The midpoint of an edge: on a
//! crease `1/2 1/2`; on a fixed surface `1/2 1/2`; on a surface with a rule `3/8 3/8` and `1/4`
//! of the mean of the vertices opposite; else the interior rule. Centroids of octahedra follow
//! the interior rule. Interior vertices see their neighbours on the boundary where the linear
//! split puts them.
//!
//! Edges of three tetrahedra are where the scheme is not smooth (the paper's appendix says so).

pub(in crate::solid) mod masks;
mod points;
mod scratch;
mod split;

pub use super::{Boundary, PointBuffers, VertexState};
pub use points::refine_points;
pub use scratch::Scratch;
pub(crate) use scratch::resize;
pub use split::{split, split_counts};
