//! Paper 2 (box-spline solids) once more, in double precision that is exact.
//!
//! Written from the paper's definitions with sets and maps, from the readings where the paper
//! is unclear, and from the numeric contract; it does not look at, call or share a line with
//! the crate that it judges. Neighbours are sets as definition 3.3 says, Algorithm 2 is the
//! printed queue with its visited flags, the boundary is found anew at every level.
//!
//! # Why the arithmetic is exact
//!
//! An `f64` holds every integer of magnitude up to 2^53. Coordinates are integers up to 2^31, and
//! every mask has positive integer weights over a denominator `d` to which they add up, so
//! all partial sums are integers of magnitude at most `d 2^31`. The denominators are 8, 16 k at a
//! vertex or edge with k neighbours, at most 72 k and 96 k in the averaged scheme, 6 and 8 for
//! centroids, and those of Loop's rules: all below 2^21 while no vertex or edge has more than
//! [`NEIGHBOURS_MAXIMUM`] neighbours; a mesh with more is refused. With half the denominator added
//! for the rounding this stays within 2^53. Loop's irrational weights use the limbs of
//! [`LimbSum`](crate::reference::exact::LimbSum).

mod choice;
mod neighbours;
mod refine;
mod solid;
mod surface;

pub use choice::{choose, improper};
pub use refine::{Refined, refine};
pub use solid::{Cells, NEIGHBOURS_MAXIMUM, Scheme};
