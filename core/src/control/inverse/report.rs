//! What is asked of a tick beside the goals, and what it says.

use core::ops::BitOr;

/// What the enclosed volume shall be, in units of [`VolumeModes::volume`](crate::enclosed::VolumeModes::volume).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum VolumeGoal {
    /// This volume.
    Hold(i64),
    /// Any from the first to the second.
    Band(i64, i64),
}

/// What a tick had to give up.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct GaveUp(u32);

impl GaveUp {
    /// Nothing.
    pub const NOTHING: Self = Self(0);
    /// A goal lies further from the effector's rest position than the solver's numbers reach, and was cut.
    pub const GOAL_OUT_OF_RANGE: Self = Self(1);
    /// Bounds or rates hold back actuators that would bring the effectors nearer to their goals.
    pub const HELD_BACK: Self = Self(1 << 1);
    /// The amplitudes before lay further outside the bounds than a tick's rate: they go back at that rate.
    pub const OUTSIDE_BOUNDS: Self = Self(1 << 2);
    /// The volume is further off than [`TOLERANCE_BITS`](super::TOLERANCE_BITS) allow.
    pub const VOLUME_MISSED: Self = Self(1 << 3);
    /// No actuator changes the volume here, so it was left out.
    pub const ZERO_GRADIENT: Self = Self(1 << 4);
    /// The band of volumes is empty; its middle was aimed at.
    pub const BAND_EMPTY: Self = Self(1 << 5);
    /// The sweeps ran out before the amplitudes had settled; the next tick goes on.
    pub const UNSETTLED: Self = Self(1 << 6);
    /// The volume would have been lost, so the amplitudes stay as they were; the next tick tries a smaller step.
    pub const STEP_REFUSED: Self = Self(1 << 7);

    /// Whether all of `other` was given up.
    #[must_use]
    pub const fn contains(self, other: Self) -> bool {
        self.0 & other.0 == other.0
    }

    /// As bits, in the order of the constants.
    #[must_use]
    pub const fn bits(self) -> u32 {
        self.0
    }

    pub(super) fn set(&mut self, other: Self, happened: bool) {
        if happened {
            *self = *self | other;
        }
    }
}

impl BitOr for GaveUp {
    type Output = Self;

    fn bitor(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }
}

/// What a tick says of its result.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct InverseReport {
    /// What it had to give up.
    pub gave_up: GaveUp,
    /// The actuators that bounds or rates hold back, a bit each, the first lowest.
    pub held_back: u16,
    /// Sweeps over the actuators.
    pub sweeps: u32,
    /// Evaluations of the volume, without the one that also gives its gradient.
    pub evaluations: u32,
    /// The volume at the amplitudes; 0 if no volume was asked for.
    pub volume: i64,
}
