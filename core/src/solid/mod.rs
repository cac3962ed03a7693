//! Subdivision of solids.
//!
//! Each scheme is a file with two operations: a *split*, which makes the connectivity of the next
//! level, and a *refinement of points*, which computes values for its vertices. They are apart so
//! that any number of values (coordinates, material channels, sparse rows) can be refined over
//! one numbering, and so that the last level can do without its cells. Labels of cells are handed on
//! by [`split_labels`].

pub mod box_spline;
pub mod mixed;
pub mod tet_oct;

mod boundary;
mod labels;
mod rules;

pub use boundary::Boundary;
pub use labels::{CellLabels, LabelBuffers, split_labels};
pub use rules::{PointBuffers, VertexState};
