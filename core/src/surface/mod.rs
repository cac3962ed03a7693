//! Surfaces: subdivision of control meshes, and the rules that a solid's boundary follows.
//!
//! Each scheme is a folder with two operations: a *split*, which makes the connectivity of the next
//! level, and a *refinement of points*, which computes values for its vertices over any
//! [`Blend`](crate::blend::Blend). They are apart so that any number of values can be refined over
//! one numbering, and so that the last level can do without its faces.
//!
//! * [`catmull_clark`]: any polygons, quads from the first level on.
//! * [`loop_scheme`]: triangles, with the weight families of [`loop_weights`], which the boundary
//!   of a solid shares.
//! * [`doo_sabin`]: any polygons, a face for each face, edge and vertex.
//! * [`butterfly`]: triangles, through all vertices; the stencil of 1990 and the modified one.
//! * [`sqrt3`]: triangles, three for each, the square root of 3 a step; uniform and adaptive.
//! * [`tri_quad`]: triangles and quads together, with an unzip where they meet; also the rule of the
//!   boundary of [`solid::mixed`](crate::solid::mixed).
//! * [`limit_normals`]: normals of Loop's, Catmull-Clark and Doo-Sabin surfaces in the limit.
//!
//! [`features`] says what boundaries, creases and corners follow.

pub mod butterfly;
pub mod catmull_clark;
pub mod doo_sabin;
pub mod features;
mod irrational;
pub mod limit_normals;
pub mod loop_scheme;
pub mod loop_weights;
mod split;
pub mod sqrt3;
pub mod tri_quad;
pub(crate) mod tri_quad_weights;

pub use features::{PointBuffers, Rim, VertexState};
pub use loop_weights::LoopWeights;
pub use split::SurfaceCounts;
