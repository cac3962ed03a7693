//! What is asked of a projection beside the goal, and what it says.

use core::ops::BitOr;

use super::MOST_REGIONS;
use crate::enclosed::VolumeForm;

/// A region of the solid and the volume that it shall enclose.
#[derive(Clone, Copy, Debug)]
pub struct RegionGoal<'a> {
    /// The form of its volume.
    pub form: &'a VolumeForm<'a>,
    /// The least volume, in the form's unit.
    pub least: i64,
    /// The greatest volume; the same as the least holds one volume.
    pub greatest: i64,
}

impl<'a> RegionGoal<'a> {
    /// This volume and no other.
    #[must_use]
    pub const fn hold(form: &'a VolumeForm<'a>, volume: i64) -> Self {
        Self {
            form,
            least: volume,
            greatest: volume,
        }
    }
}

/// What a projection had to give up.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct GaveUp(u32);

impl GaveUp {
    /// Nothing.
    pub const NOTHING: Self = Self(0);
    /// The goal lies outside the hard limits somewhere, and was cut to them.
    pub const GOAL_CUT: Self = Self(1);
    /// The pose before lay further outside a box than the rate: it goes back at that rate.
    pub const OUTSIDE_BOX: Self = Self(1 << 1);
    /// A volume is further off than [`TOLERANCE_BITS`](super::TOLERANCE_BITS) allow.
    pub const VOLUME_MISSED: Self = Self(1 << 2);
    /// No coordinate that may move changes a region's volume; the region was left out.
    pub const ZERO_GRADIENT: Self = Self(1 << 3);
    /// A band of volumes is empty; its middle was aimed at.
    pub const BAND_EMPTY: Self = Self(1 << 4);
    /// The steps ran out before the pose had settled.
    pub const NOT_SETTLED: Self = Self(1 << 5);
    /// A volume or a gradient left the range of its format and was clamped.
    pub const SATURATED: Self = Self(1 << 6);

    /// Whether all of `other` was given up.
    #[must_use]
    pub const fn contains(self, other: Self) -> bool {
        self.0 & other.0 == other.0
    }

    /// A bit for each reason, in the order of the constants.
    #[must_use]
    pub const fn bits(self) -> u32 {
        self.0
    }
}

impl BitOr for GaveUp {
    type Output = Self;

    fn bitor(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }
}

/// What a projection says.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct ProjectReport {
    /// The volumes of the new pose, in the order of the regions; zero behind them.
    pub volumes: [i64; MOST_REGIONS],
    /// A bit for each region whose volume was missed: 1 for the first.
    pub missed: u32,
    /// Steps that were taken.
    pub steps: u32,
    /// What was given up.
    pub gave_up: GaveUp,
}
