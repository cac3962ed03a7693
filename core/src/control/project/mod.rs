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
//!
//! # A tetrahedron that keeps its volume
//!
//! Three corners are pinned. The fourth is to go twice as high and half way to the side; with its volume held it may
//! only go to the side.
//!
//! ```
//! use fixed::types::I12F20;
//! use octruss::control::project::{
//!     GaveUp, Limits, LimitsParts, MOBILITY_ONE, ProjectScratch, RegionGoal,
//! };
//! use octruss::enclosed::{VolumeForm, VolumeFormParts};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! // The form of a linear tetrahedron: one determinant of three differences. Bakers write such forms.
//! let form = VolumeForm::new_checked(
//!     VolumeFormParts {
//!         points: &[0, 1, 2, 3],
//!         pairs: &[[0, 1]],
//!         pair_starts: &[0, 1],
//!         thirds: &[2],
//!         weights: &[1 << 20],
//!         difference_shift: 4,
//!         pair_bits: 20,
//!         volume_shift: 28,
//!         gradient_bits: 20,
//!         weight_bits: 20,
//!     },
//!     4,
//! )?;
//! let place = |x: f64, y: f64, z: f64| [x, y, z].map(I12F20::from_num);
//! let rest = [place(0.0, 0.0, 0.0), place(1.0, 0.0, 0.0), place(0.0, 1.0, 0.0), place(0.0, 0.0, 1.0)];
//! let mut lower = rest.map(|point| point.map(I12F20::to_bits));
//! let mut upper = lower; // a pin is a box of one value
//! (lower[3], upper[3]) = ([i32::MIN; 3], [i32::MAX; 3]);
//! let limits = Limits::new_checked(LimitsParts {
//!     lower: &lower,
//!     upper: &upper,
//!     rates: &[u32::MAX; 4],
//!     mobilities: &[MOBILITY_ONE; 4],
//!     settled: 16,
//! })?;
//!
//! let mut goal = rest;
//! goal[3] = place(0.5, 0.0, 2.0);
//! let volume = form.volume(&rest, &mut [[0; 3]; 3])?.volume;
//! let mut pose = rest;
//! let scratch = ProjectScratch {
//!     lower: &mut [[0; 3]; 4],
//!     upper: &mut [[0; 3]; 4],
//!     current: &mut [[0; 3]; 4],
//!     candidate: &mut [[0; 3]; 4],
//!     forces: &mut [[0; 3]; 4],
//!     gradients: &mut [[0; 3]; 4],
//!     form_workspace: &mut [[0; 3]; 4],
//!     form_gradient: &mut [[0; 3]; 4],
//! };
//! let report = limits.project(&goal, &[RegionGoal::hold(&form, volume)], scratch, &mut pose)?;
//! assert_eq!(report.gave_up, GaveUp::NOTHING);
//! assert_eq!(pose[..3], rest[..3]);
//! assert_eq!(pose[3], place(0.5, 0.0, 1.0));
//! # Ok(())
//! # }
//! ```

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
