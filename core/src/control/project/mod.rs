//! The nearest pose that the limits allow.
//!
//! A goal is a position for every control point. [`Limits::project`] finds the pose that minimises
//!
//! ```text
//! sum over coordinates of (position - goal)^2 / mobility
//! ```
//!
//! in a box for every coordinate (a pin is a box of one value), at most a rate away from the pose before,
//! while regions of the solid enclose a volume, or one within a band. Boxes and rates are *hard*: no pose
//! breaks them. Where the pose before lies outside a box, it goes back at the rate. Volumes are met within
//! `1/16384` of the target ([`TOLERANCE_BITS`]) where the hard limits and the bounded steps allow it.
//!
//! # How
//!
//! The metric is diagonal and the hard limits are separable, so for volumes that are linear in the pose, with
//! gradients `g` and multipliers `m`, the answer is known but for the multipliers:
//!
//! ```text
//! position = clamp(goal + mobility * sum of m g)
//! ```
//!
//! and each volume rises with its own multiplier. A call repeats, at most [`STEPS`] times:
//!
//! 1. volumes and gradients at the pose so far, exact as in [`enclosed`](crate::enclosed);
//! 2. multiplier by multiplier, at most [`SWEEPS`] times round, a search by Newton's method between bounds that
//!    close in, of at most [`TRIALS`] trials;
//! 3. the pose of these multipliers; as long as its volumes are further off than before and off at all, half
//!    the way to it, at most [`HALVINGS`] times.
//!
//! It ends early once the volumes are right and no coordinate moves by more than the configuration calls
//! settled, which is a pose that satisfies the conditions of optimality.
//!
//! # The number format
//!
//! A region's gradient is brought to `B` bits, `B = 30 - (bits of three times the points of the largest region)`, at
//! most 22, over the coordinates that may move. Multipliers have 8 bits behind the point and are at most
//! `2^38`; all else is exact. What is rounded stands in `docs/numerics.md`.

mod error;
mod limits;
mod report;
mod scratch;
mod search;
mod section;
mod solve;

pub use error::ProjectError;
pub use limits::{Limits, LimitsParts, MOBILITY_ONE};
pub use report::{GaveUp, ProjectReport, RegionGoal};
pub use scratch::{ProjectScratch, ScratchLengths};
pub use search::{MULTIPLIER_LIMIT, TRIALS};
pub use section::LimitsRecord;
pub use solve::{HALVINGS, STEPS, SWEEPS, TOLERANCE_BITS};

/// Regions whose volumes a call holds at most.
pub const MOST_REGIONS: usize = 4;

#[cfg(test)]
mod tests;
