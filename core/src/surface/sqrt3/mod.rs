//! The square-root-3 scheme (Kobbelt, "sqrt(3)-Subdivision") on control meshes of triangles.
//!
//! One step puts a vertex into every triangle and flips every old edge; two steps cut every edge in
//! three. A mesh knows the parity of its steps ([`ControlMesh::odd`]).
//!
//! * Rule (1): the new vertex of a triangle is the mean of its corners.
//! * Rule (2): a smooth vertex of valence `n` becomes `(1 - alpha_n) p + alpha_n / n * sum(ring)`,
//!   `alpha_n = (4 - 2 cos(2 pi / n)) / 9`.
//! * Rule (9), sharp edges (the rim, creases seen from both sides, seams of three sheets): the first
//!   step leaves them and their vertices as they are and does not flip them; the second step cuts
//!   each in three by the cubic B-spline `(10, 16, 1) (4, 19, 4) (1, 16, 10)` over 27. A triangle on
//!   a sharp edge then gets no vertex of its own: it becomes a fan to the three parts, and its other
//!   edges are flipped like all old ones.
//! * The paper defines neither ends and crossings of creases nor corners. Such vertices stay; a
//!   sharp edge that ends in one cannot be trisected
//!   ([`MeshError::NotTrisectable`](crate::mesh::MeshError)).
//!
//! [`multi_step`] has a vertex's position any number of steps on, and in the limit, as one mask
//! ((7) and (8)); [`adaptive`] refines only where a caller wants it.

pub mod adaptive;
mod limit;
pub mod multi_step;
mod numbering;
mod points;
mod split;
mod weights;

pub use limit::limit_points;
pub use numbering::{Numbering, NumberingBuffers};
pub use points::refine_points;
pub use split::{split, split_counts};
pub use weights::neighbour_weight;

#[cfg(doc)]
use crate::mesh::ControlMesh;
