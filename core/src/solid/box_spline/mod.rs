//! Box-spline solids (Chang, Qin: "Spline-based Solid Subdivision Schemes over Arbitrary
//! Tetrahedral Meshes").
//!
//! Cells split as those of [`tet_oct`](super::tet_oct) do (the same [`split`], numbering and child
//! order); the values differ. On the regular lattice of tetrahedra and octahedra the scheme is
//! subdivision of the trivariate box spline with the directions (1,0,0), (0,1,0), (0,0,1) and
//! (1,1,1), each taken twice: twice continuously differentiable.
//!
//! # Major diagonals
//!
//! That spline has a direction that the lattice does not have: one diagonal of each octahedron.
//! So every cell carries a number from 0 to 2 (two bits): in an octahedron the pair of opposite
//! corners `(0, 3)`, `(1, 4)` or `(2, 5)`, in a tetrahedron the pair of opposite edges
//! `01 23`, `02 13` or `03 12`, which says where the diagonal of its middle octahedron will be.
//! Children keep the direction ([`split_diagonals`]). The numbers come from [`choose_diagonals`] (the paper's Algorithm 2
//! made deterministic) or from the caller, and [`improper_faces`] lists the faces where
//! they clash. **They depend on the order of the cells and of their corners**: the same
//! tetrahedra listed in another order can get other diagonals and so another solid. Keep the
//! file's order, or keep the diagonals.
//!
//! [`Scheme::Averaged`] is the paper's appendix A, which needs no diagonals: the mean of the
//! three schemes, no longer with a favoured direction.
//!
//! # Masks
//!
//! The neighbours of a vertex are the other ends of its edges and of major diagonals (`k` of
//! them, 14 where regular). The neighbours of an edge are counted in cells that contain the edge:
//! in a tetrahedron the other two corners; in an octahedron the two corners next to both
//! ends, and the opposite of an end that lies on the major diagonal. Each is counted once. With
//! `S` the sum of the neighbours:
//!
//! | vertex | major diagonals | averaged |
//! | --- | --- | --- |
//! | old vertex | 9/16 own + 7/(16 k) S | 9/16 own + 7/16 of the mean weighted 3 : 1 |
//! | edge, 4 neighbours | 1/4 1/4 + S/8 | 7/24 7/24 + 5/12 of the mean weighted 4 : 1 |
//! | edge, k neighbours | 5/16 5/16 + 3/(8 k) S | the same |
//! | centroid | 1/8 each, 1/4 on the diagonal | 1/6 each |
//!
//! The averaged scheme weighs edge neighbours 3 (and corners next to both ends 4) against 1 for
//! the opposites in octahedra. The paper gives its masks on the regular lattice only; this way off
//! the lattice is this library's own, and reduces to the paper's masks on it.
//!
//! Surfaces, creases and corners follow the rules of [`tet_oct`](super::tet_oct), in the same
//! order of precedence; interior rules use their neighbours on the boundary as they are. Surface
//! triangles that no cell has (sheets: hybrid solids) follow the surface rule too; cells that
//! hang on a sheet see nothing of it beyond the vertices that they share. The open border of a
//! sheet needs a crease, or it shrinks.

mod choice;
mod diagonals;
mod faces;
mod improper;
mod neighbours;
mod points;
mod scratch;

pub use super::tet_oct::{split, split_counts};
pub use super::{Boundary, PointBuffers, VertexState};
pub use choice::{DiagonalBuffers, choose_diagonals};
pub use diagonals::{Diagonals, split_diagonals};
pub use faces::Face;
pub use improper::improper_faces;
pub use neighbours::{Neighbours, neighbour_capacity};
pub use points::refine_points;
pub use scratch::{DiagonalArena, Scratch};

/// Which of the paper's two schemes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scheme<'a> {
    /// The box spline along these major diagonals.
    MajorDiagonals(Diagonals<'a>),
    /// The mean over the three directions (appendix A).
    Averaged,
}
