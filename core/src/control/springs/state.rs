//! The state of a control point.

use super::STATE_BITS;
use crate::coord::round_shift;

/// A velocity's coordinates are at most this in magnitude: half the range of positions, in a substep.
pub const VELOCITY_LIMIT: i64 = 1 << 43;

/// The least and the greatest coordinate of a position.
const LEAST: i64 = -(1 << 43);
const GREATEST: i64 = (1 << 43) - (1 << STATE_BITS);

/// Where a control point is and how it moves, in units of `2^-12` of a coordinate's last place.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct PointState {
    pub(super) position: [i64; 3],
    pub(super) velocity: [i64; 3],
}

impl PointState {
    /// At rest at a place, raw bits of a coordinate.
    #[must_use]
    pub fn at(place: [i32; 3]) -> Self {
        Self {
            position: place.map(|coordinate| i64::from(coordinate).wrapping_shl(STATE_BITS)),
            velocity: [0; 3],
        }
    }

    /// A state that was kept; positions and velocities are clamped to their ranges.
    #[must_use]
    pub fn new(position: [i64; 3], velocity: [i64; 3]) -> Self {
        Self {
            position: position.map(|coordinate| coordinate.clamp(LEAST, GREATEST)),
            velocity: velocity.map(limited),
        }
    }

    /// Where it is.
    #[must_use]
    pub const fn position(&self) -> [i64; 3] {
        self.position
    }

    /// How far it moved in the last substep, as far as that is remembered.
    #[must_use]
    pub const fn velocity(&self) -> [i64; 3] {
        self.velocity
    }

    /// Where it is, rounded to a coordinate's last place: it always fits.
    pub(super) fn coordinates(&self) -> [i32; 3] {
        self.position
            .map(|position| narrow(round_shift(position, STATE_BITS)))
    }

    /// Changes the position, and the velocity by as much. Returns how many coordinates were clamped.
    pub(super) fn shift(&mut self, change: [i64; 3]) -> u32 {
        let mut clamped = 0_u32;
        let places = self.position.iter_mut().zip(&mut self.velocity);
        for ((position, velocity), change) in places.zip(change) {
            let wanted = position.wrapping_add(change);
            let place = wanted.clamp(LEAST, GREATEST);
            clamped = clamped.wrapping_add(u32::from(place != wanted));
            *velocity = limited(velocity.wrapping_add(place.wrapping_sub(*position)));
            *position = place;
        }
        clamped
    }

    /// Changes the velocity alone.
    pub(super) fn hurry(&mut self, change: [i64; 3]) {
        for (velocity, change) in self.velocity.iter_mut().zip(change) {
            *velocity = limited(velocity.wrapping_add(change));
        }
    }
}

/// A velocity's coordinate within its range.
pub(super) fn limited(velocity: i64) -> i64 {
    velocity.clamp(VELOCITY_LIMIT.wrapping_neg(), VELOCITY_LIMIT)
}

#[expect(
    clippy::as_conversions,
    reason = "positions are within the range of coordinates"
)]
const fn narrow(value: i64) -> i32 {
    value as i32
}
