//! Catmull and Clark's surfaces (1978), on control meshes of any polygons.
//!
//! * A face's point is the mean of its corners.
//! * The point of a smooth edge is the mean of its two ends and the points of its two faces.
//! * A smooth vertex of valence `n` becomes `(F + 2 R + (n - 3) p) / n`, where `F` is the mean of
//!   the points of its faces and `R` the mean of the midpoints of its edges.
//! * Sharp edges (creases and the rim) and the vertices on them follow the rules of
//!   [`features`](super::features): midpoints `1/2 1/2`, vertices with two sharp edges
//!   `1/8 6/8 1/8`, with more than two they stay, with one (a dart) they are smooth; tagged corners
//!   stay. Infinitely sharp creases of OpenSubdiv follow the same rules.
//!
//! Every face of the refined mesh is a quad.
//!
//! # Exactness
//!
//! Face points of polygons enter edges and vertices unrounded: the sum of a vertex is formed over
//! the least common multiple `L` of the numbers of corners of its faces, with the denominator
//! `n^2 L` (`4 L` for an edge), so each refined vertex is one exact sum, rounded once. A
//! denominator above 2^30 is refused ([`MeshError::MaskTooLarge`](crate::mesh::MeshError)); it
//! takes, say, faces of 3, 4, 5, 7, 11, 13 and 17 corners at one vertex.

mod limit;
mod points;
mod split;

pub use limit::limit_points;
pub use points::refine_points;
pub use split::{split, split_counts};
