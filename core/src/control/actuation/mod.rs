//! The pose that actuators make, and where the effectors lie in the deformed model.
//!
//! A solver ([`super::inverse`]) knows amplitudes, a table ([`crate::deform`]) knows control points. [`Actuation`] is
//! what lies between: each actuator is a displacement of every control point at amplitude one, and
//!
//! ```text
//! pose = rest + sum over actuators of amplitude * displacement
//! ```
//!
//! with one rounding for each coordinate, and coordinates that do not fit clamped and counted. It also names the row
//! of the table that each effector is, so that a controller sees how far effectors are from their goals.

mod error;
mod section;

pub use error::ActuationError;
pub use section::ActuationRecord;

use super::inverse::{MOST_ACTUATORS, MOST_EFFECTORS};
use crate::coord::{round_shift, saturate};

/// Fraction bits of an amplitude.
pub const AMPLITUDE_BITS: u32 = 30;
/// The magnitudes of a coordinate's displacements add up to at most this: with amplitudes of at most `2^31` every sum
/// is at most `2^62`.
pub const DISPLACEMENT_LIMIT: i64 = 1 << 31;

/// What a baker knows of actuators. See [`Actuation::new_checked`] for what must hold.
#[derive(Clone, Copy, Debug)]
pub struct ActuationParts<'a> {
    /// How many actuators there are.
    pub actuators: usize,
    /// Raw bits at amplitude one: for each control point x of every actuator, then y, then z.
    pub displacements: &'a [i32],
    /// The table's row of each effector.
    pub effector_rows: &'a [u32],
}

/// Actuators that have been proved sound.
#[derive(Clone, Copy, Debug)]
pub struct Actuation<'a> {
    parts: ActuationParts<'a>,
    rest: &'a [[i32; 3]],
}

impl<'a> Actuation<'a> {
    /// Proves that there are 1 to [`MOST_ACTUATORS`] actuators and at most [`MOST_EFFECTORS`] effectors, that every
    /// control point of `rest` (raw bits) has its displacements and none is left over, that a coordinate's magnitudes
    /// add up to at most [`DISPLACEMENT_LIMIT`], and that effectors are among the table's `rows`.
    ///
    /// # Errors
    ///
    /// The [`ActuationError`] of the first that does not hold.
    pub fn new_checked(
        parts: ActuationParts<'a>,
        rest: &'a [[i32; 3]],
        rows: usize,
    ) -> Result<Self, ActuationError> {
        let actuators = parts.actuators;
        if !(1..=MOST_ACTUATORS).contains(&actuators) || parts.effector_rows.len() > MOST_EFFECTORS
        {
            return Err(ActuationError::Counts);
        }
        let each = actuators.wrapping_mul(3);
        if rest.len().checked_mul(each) != Some(parts.displacements.len()) {
            return Err(ActuationError::Layout);
        }
        for (own, point) in parts.displacements.chunks_exact(each).zip(0_u32..) {
            for axis in own.chunks_exact(actuators) {
                // At most 16 numbers of at most 2^31.
                let magnitude = |&way: &i32| i64::from(way.unsigned_abs());
                let sum = axis.iter().map(magnitude).fold(0, i64::wrapping_add);
                if sum > DISPLACEMENT_LIMIT {
                    return Err(ActuationError::Displacement { point });
                }
            }
        }
        for (&row, effector) in parts.effector_rows.iter().zip(0_u32..) {
            if usize::try_from(row).map_or(true, |row| row >= rows) {
                return Err(ActuationError::Row { effector });
            }
        }
        Ok(Self { parts, rest })
    }

    /// Number of actuators.
    #[must_use]
    pub const fn actuators(&self) -> usize {
        self.parts.actuators
    }

    /// Number of control points.
    #[must_use]
    pub const fn control_points(&self) -> usize {
        self.rest.len()
    }

    /// The table's row of each effector.
    #[must_use]
    pub const fn effector_rows(&self) -> &'a [u32] {
        self.parts.effector_rows
    }

    /// What it is made of.
    #[must_use]
    pub const fn parts(&self) -> &ActuationParts<'a> {
        &self.parts
    }

    /// Writes the pose of `amplitudes` (30 fraction bits, the first [`actuators`](Self::actuators) of them) to `pose`,
    /// raw bits: a coordinate is `rest + floor(sum / 2^30 + 1/2)`, clamped to 32 bits. Returns how many coordinates did
    /// not fit. The sums are exact, and the time does not depend on any value.
    ///
    /// # Errors
    ///
    /// [`ActuationError::Length`] for too few amplitudes or another number of control points; nothing is written.
    pub fn pose(&self, amplitudes: &[i32], pose: &mut [[i32; 3]]) -> Result<u32, ActuationError> {
        let length = |needed: usize, given: usize| ActuationError::Length { needed, given };
        let actuators = self.parts.actuators;
        let given = amplitudes.len();
        let amplitudes = amplitudes
            .get(..actuators)
            .ok_or(length(actuators, given))?;
        if pose.len() != self.rest.len() {
            return Err(length(self.rest.len(), pose.len()));
        }
        let mut saturated = 0_u32;
        let axes = self.parts.displacements.chunks_exact(actuators);
        let to = pose.as_flattened_mut().iter_mut();
        for ((own, &rest), axis) in to.zip(self.rest.as_flattened()).zip(axes) {
            let products = axis.iter().zip(amplitudes);
            // Within 2^62 by DISPLACEMENT_LIMIT.
            let sum = products.fold(0_i64, |sum, (&way, &part)| {
                sum.wrapping_add(i64::from(way).wrapping_mul(i64::from(part)))
            });
            let way = round_shift(sum, AMPLITUDE_BITS);
            *own = saturate(i64::from(rest).wrapping_add(way), &mut saturated);
        }
        Ok(saturated)
    }
}

#[cfg(test)]
mod tests;
