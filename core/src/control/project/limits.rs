//! The limits of a cage's control points.

use super::error::ProjectError;
use super::report::{ProjectReport, RegionGoal};
use super::scratch::ProjectScratch;
use super::solve;
use crate::coord::Coordinate;

/// The mobility of a control point that is as cheap to move as any: `2^15`.
pub const MOBILITY_ONE: u16 = 1 << 15;

/// The parts of the limits, as they lie in flash: an element for each control point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LimitsParts<'a> {
    /// The lower ends of the boxes, in raw bits; `i32::MIN` leaves a coordinate free.
    pub lower: &'a [[i32; 3]],
    /// The upper ends, at or above the lower ones; the same value is a pin.
    pub upper: &'a [[i32; 3]],
    /// How far each coordinate of a point moves in a call at most, in raw bits; `u32::MAX` leaves it free.
    pub rates: &'a [u32],
    /// How cheap a point is to move, in units of `1 / MOBILITY_ONE`: the objective is divided by it. A point of
    /// mobility 0 follows its goal as the hard limits allow, and no volume moves it.
    pub mobilities: &'a [u16],
    /// A call has settled when no coordinate moves by more than this in a step, in raw bits.
    pub settled: u32,
}

/// Limits that have been proved sound.
#[derive(Clone, Copy, Debug)]
pub struct Limits<'a> {
    parts: LimitsParts<'a>,
}

impl<'a> Limits<'a> {
    /// Proves what a projection relies on: lists of one length, boxes that are not empty, mobilities of at most
    /// [`MOBILITY_ONE`].
    ///
    /// # Errors
    ///
    /// A [`ProjectError`] that says which of these does not hold.
    pub fn new_checked(parts: LimitsParts<'a>) -> Result<Self, ProjectError> {
        let points = parts.lower.len();
        if points == 0 || u16::try_from(points).is_err() {
            return Err(ProjectError::Points);
        }
        let lengths = [parts.upper.len(), parts.rates.len(), parts.mobilities.len()];
        if lengths != [points; 3] {
            return Err(ProjectError::Layout);
        }
        for ((lower, upper), point) in parts.lower.iter().zip(parts.upper).zip(0_u32..) {
            if lower.iter().zip(upper).any(|(lower, upper)| lower > upper) {
                return Err(ProjectError::Box { point });
            }
        }
        for (&mobility, point) in parts.mobilities.iter().zip(0_u32..) {
            if mobility > MOBILITY_ONE {
                return Err(ProjectError::Mobility { point });
            }
        }
        Ok(Self { parts })
    }

    /// The parts.
    #[must_use]
    pub const fn parts(&self) -> &LimitsParts<'a> {
        &self.parts
    }

    /// Control points.
    #[must_use]
    pub const fn points(&self) -> usize {
        self.parts.lower.len()
    }

    /// Moves `pose`, which holds the pose before, to the nearest pose to `goal` that the limits allow and that
    /// encloses the volumes of `regions`, and says what it gave up.
    ///
    /// Any pose and any goal are taken. At most [`MOST_REGIONS`](super::MOST_REGIONS) regions are held.
    ///
    /// # Scaling and overflow
    ///
    /// Reduced gradients `G` and directions `D = round(mobility * G / 2^15)` are at most `2^B`, `B <= 22`. Four
    /// multipliers of at most `2^38` times directions add up to at most `2^62`; divided by `2^(B + 8)` they move a
    /// coordinate by at most `2^32`, in 64 bits, before it is clamped to its box. A linear volume is a sum
    /// of at most `3 n` products of `G` and a difference below `2^32`, at most `2^62` because `3 n 2^B <= 2^30`;
    /// what it shall be is clamped to `2^61`. A slope is at most `3 n 2^(2 B) <= 2^52`. Newton's quotient has 128 bits.
    ///
    /// # Errors
    ///
    /// A [`ProjectError`] if a length does not fit, or a region names a control point twice. The pose is then
    /// as it was.
    pub fn project<C: Coordinate>(
        &self,
        goal: &[[C; 3]],
        regions: &[RegionGoal<'_>],
        scratch: ProjectScratch<'_>,
        pose: &mut [[C; 3]],
    ) -> Result<ProjectReport, ProjectError> {
        solve::project(
            &self.parts,
            C::bits_of(goal),
            regions,
            scratch,
            C::bits_of_mut(pose),
        )
    }
}
