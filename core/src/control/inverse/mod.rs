//! Which actuation brings the effectors nearest to their goals?
//!
//! *Actuators* are modes: each is a displacement of all control points at amplitude one (a cable, a
//! bellows, a joint), with bounds and a rate. *Effectors* are points of the model with weights. A tick of
//! [`Inverse`] takes a goal for each effector and finds amplitudes `q` that minimise
//!
//! ```text
//! sum over effectors of weight * |rest + J q - goal|^2  +  damping * |q|^2
//! ```
//!
//! within the bounds and at most a rate away from the amplitudes before, while the enclosed volume, a
//! cubic polynomial of the amplitudes ([`VolumeModes`](crate::enclosed::VolumeModes)), is held at a target or
//! in a band. *Sensors* are the same the other way: goals are measured points, amplitudes what they tell of.
//!
//! # How
//!
//! With `H = J'WJ + damping` and `A = J'W`, both baked, a tick
//!
//! 1. forms `b = A (goal - rest)` and the box: bounds, cut with the rate;
//! 2. takes the volume's value and gradient `g` at the amplitudes before, once;
//! 3. descends coordinate by coordinate, each to the exact minimum of its parabola cut to the box: at most
//!    [`SWEEPS`] sweeps, or [`SWEEPS_WITHOUT_VOLUME`]. Beside the amplitudes the same rows of `H` refine `y`, the free amplitudes' answer to the
//!    volume's multiplier (`H y = g`), so that after every sweep one Newton step sets the multiplier to where
//!    the linearised volume reaches its target;
//! 4. takes as much of this step as the pace says, evaluates the volume, and goes along `y` by the secant method until
//!    it is right: at most [`EVALUATIONS`] evaluations;
//! 5. stays where it was, and takes a quarter of the pace from then on, if the volume would be further off than
//!    [`TOLERANCE_BITS`] allow and than it was before; otherwise the pace becomes what the volume's curvature along the
//!    step asks for, so that steps do not swing about the goal where the volume curves more than the objective.
//!
//! Amplitudes, `y`, the multiplier and the pace are kept from tick to tick ([`InverseState`]), so ticks with the same
//! goals converge to a point that satisfies the optimality conditions of the whole problem.
//!
//! # The smallest controller
//!
//! ```
//! use octruss::bundle::Bundle;
//! use octruss::control::inverse::{Inverse, InverseState, VolumeGoal};
//! use octruss::enclosed::VolumeModes;
//!
//! # fn main() { let _ = (open, tick); }
//! /// Opened once, in flash: what was baked with `--actuators`, `--effectors` and `--volume`.
//! fn open(flash: &'static [u8]) -> Option<(Inverse<'static>, VolumeModes<'static>)> {
//!     let bundle = Bundle::new_checked(flash).ok()?;
//!     Some((bundle.inverse::<i32>().ok()??, bundle.volume_modes::<i32>(0).ok()??))
//! }
//!
//! /// On every tick: goals in, amplitudes in `state`; whether the volume is right.
//! fn tick(
//!     solver: &Inverse,
//!     modes: &VolumeModes,
//!     volume: i64,
//!     goals: &[[i32; 3]],
//!     state: &mut InverseState,
//! ) -> bool {
//!     use octruss::control::inverse::GaveUp;
//!     let hold = Some((modes, VolumeGoal::Hold(volume)));
//!     match solver.tick(goals, hold, state) {
//!         Ok(report) => !report.gave_up.contains(GaveUp::VOLUME_MISSED),
//!         Err(_) => false, // a slice of the wrong length, or modes of another solver
//!     }
//! }
//! ```
//!
//! # The number format
//!
//! Amplitudes are 32-bit with 30 fraction bits. `H` is scaled so that the magnitudes of a row add up to at most
//! `2^30`; products of `H` and amplitudes are the unit of forces (64 bits), in which `b` and the multiplier's force
//! are given too. Sums are exact; what is rounded stands in `docs/numerics.md`.

mod config;
mod descent;
mod error;
mod hold;
mod pace;
mod report;
mod section;
mod state;
mod tick;

pub use config::{
    FORCE_LIMIT, GAIN_LIMIT, HESSIAN_LIMIT, Inverse, InverseParts, LEAST_CURVATURE, MOST_ACTUATORS,
    MOST_EFFECTORS, reciprocal,
};
pub use error::InverseError;
pub use report::{GaveUp, InverseReport, VolumeGoal};
pub use section::InverseRecord;
pub use state::InverseState;
pub use tick::{EVALUATIONS, SWEEPS, SWEEPS_WITHOUT_VOLUME, TOLERANCE_BITS};

#[cfg(test)]
mod tests;
