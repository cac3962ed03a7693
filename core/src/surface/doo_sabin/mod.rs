//! Doo and Sabin's surfaces (1978), on control meshes of any polygons.
//!
//! Every corner of a face becomes a vertex of its own. In a face of `n` corners the vertex at corner
//! `i` is `sum(w_j p_(i+j))` with `w_0 = 1/4 + 5/(4n)` and `w_j = (3 + 2 cos(2 pi j / n)) / (4n)`.
//! The refined mesh has a face for each face, a quad for each edge of two faces, and a face for each
//! vertex that faces go all round.
//!
//! * **Rim.** An edge of one face gives no quad, and a vertex on the rim no face: the surface ends
//!   where its outermost faces' own corners are, as in CGAL. So it shrinks away from the rim by half
//!   a face in the limit; doubling the rim's vertices (a ring of faces of no width) holds it.
//! * **Creases and corners** have no common definition in this scheme and are refused.
//!
//! Exact fractions for faces of 3, 4 and 6 corners; otherwise each `w_j` with its mirror `w_(n-j)` is
//! rounded to a multiple of 2^-30 and `w_0` is one minus the others.

mod points;
mod split;

pub use points::{limit_points, refine_points};
pub use split::{split, split_counts};
