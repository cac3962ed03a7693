//! Deformation: the table and its apply kernel, what a controller pays for on every tick.
//!
//! A [`Table`] has a row for each model point and a tap for each control point that moves it:
//! equation (1) of "Smooth Subdivision of Tetrahedral Meshes", `f(x) = sum of a_i p_i`, with the
//! `a_i` baked once. It comes out of a [`Bundle`](crate::bundle::Bundle), which has proved all
//! that the kernel relies on. Nothing here floats, allocates, panics or takes a time that depends
//! on values.
//!
//! # Two forms
//!
//! * The **absolute** form is the sum of weight times control point.
//! * The **displacement** form is the rest position plus the sum of weight times displacement of
//!   the control point from its rest position. At rest it gives the rest model to the bit, which
//!   the quantised weights alone cannot.
//!
//! Written out, the displacement form is `rest + floor(sum(w (p - p_rest)) / 2^30 + 1/2)`.
//! Integers move in and out of the floor, so it equals
//! `floor((residual + sum(w p)) / 2^30 + 1/2)` with the baked
//! `residual = rest * 2^30 - sum(w p_rest)`: the same multiplications as the absolute form, from
//! another start value.
//!
//! # Channels
//!
//! Whatever else the control points have, a number each, follows the same map:
//! [`Table::apply_scalars`] and [`CompactTable::apply_scalars`] carry any number of scalar channels
//! through the same rows, as the absolute form carries positions.

mod compact;
mod groups;
mod kernel;
mod moved;
mod normals;
mod scalars;
mod table;
mod wide;

pub(crate) use compact::weight_place;
pub use compact::{CompactTable, Displacement, Displacements, displacement_shift};
pub(crate) use groups::Groups;
pub(crate) use kernel::{EXCLUDED_DISPLACEMENT_SHIFT, MOST_DISPLACEMENT_SHIFT};
pub use moved::Updated;
pub(crate) use normals::unit as unit_vector;
pub use normals::{MOST_CORNERS, MOST_EDGE_SHIFT, NORMAL_BITS, Normals};
pub use table::{ApplyError, Table};
pub(crate) use table::{Starts, Weights};
