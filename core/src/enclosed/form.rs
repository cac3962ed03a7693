//! The view of a volume form.

use super::check::check;
use super::error::EnclosedError;
use super::evaluate;
use crate::coord::Coordinate;

/// The magnitudes of all weights of a form add up to at most this: `2^31 - 1`.
pub const WEIGHT_LIMIT: i64 = (1 << 31) - 1;

/// A gradient's greatest magnitude: `2^47 - 1`. Larger ones saturate and are counted.
pub const GRADIENT_LIMIT: i64 = (1 << 47) - 1;

/// The parts of a volume form, as they lie in flash.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct VolumeFormParts<'a> {
    /// Control points of the region, by their index in a pose; the first is the base.
    pub points: &'a [u16],
    /// Pairs `i < j` of the region's other points, ascending: 0 stands for `points[1]`.
    pub pairs: &'a [[u16; 2]],
    /// The first tap of each pair, and the number of taps.
    pub pair_starts: &'a [u32],
    /// The third point `k > j` of each tap, counted as in `pairs`.
    pub thirds: &'a [u16],
    /// The weight of each tap.
    pub weights: &'a [i32],
    /// Differences to the base are rounded by this many bits: 2 to 31.
    pub difference_shift: u32,
    /// The magnitudes of each pair's weights add up to at most `2^pair_bits`: 0 to 31.
    pub pair_bits: u32,
    /// The volume's sum is rounded by this many bits: 1 to 122.
    pub volume_shift: u32,
    /// Bits by which a gradient is finer than `2^31` of its exact unit: 0 to 60.
    pub gradient_bits: u32,
    /// A weight of one stands for `2^weight_bits` of these weights. It enters units only.
    pub weight_bits: i32,
}

/// A volume form that has been proved sound.
#[derive(Clone, Copy, Debug)]
pub struct VolumeForm<'a> {
    parts: VolumeFormParts<'a>,
    control_points: usize,
}

/// A volume, and how many results saturated.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Enclosed {
    /// The volume, in the form's unit.
    pub volume: i64,
    /// How many results (the volume, coordinates of gradients) did not fit and were clamped.
    pub saturated: u32,
}

impl<'a> VolumeForm<'a> {
    /// Proves what the evaluation relies on: shifts within their ranges, points that exist, pairs
    /// and thirds that ascend, weights within [`WEIGHT_LIMIT`] and `2^pair_bits`.
    ///
    /// # Errors
    ///
    /// An [`EnclosedError`] that says which of these does not hold.
    pub fn new_checked(
        parts: VolumeFormParts<'a>,
        control_points: usize,
    ) -> Result<Self, EnclosedError> {
        check(&parts, control_points)?;
        Ok(Self {
            parts,
            control_points,
        })
    }

    /// The parts.
    #[must_use]
    pub const fn parts(&self) -> &VolumeFormParts<'a> {
        &self.parts
    }

    /// The control points of the region: a gradient holds one vector for each, in this order.
    #[must_use]
    pub const fn points(&self) -> &'a [u16] {
        self.parts.points
    }

    /// A volume's unit is `2^` this of cubes of the coordinates' last place.
    #[must_use]
    pub fn volume_exponent(&self) -> i64 {
        let parts = &self.parts;
        let shifts = i64::from(parts.volume_shift)
            .wrapping_add(i64::from(parts.difference_shift).wrapping_mul(3));
        shifts.wrapping_sub(i64::from(parts.weight_bits))
    }

    /// A gradient's unit is `2^` this of squares of the coordinates' last place.
    #[must_use]
    pub fn gradient_exponent(&self) -> i64 {
        let parts = &self.parts;
        let shifts = i64::from(parts.difference_shift)
            .wrapping_mul(2)
            .wrapping_add(31);
        shifts
            .wrapping_sub(i64::from(parts.gradient_bits))
            .wrapping_sub(i64::from(parts.weight_bits))
    }

    /// Length of the workspace: the region's points without its base.
    #[must_use]
    pub const fn workspace_length(&self) -> usize {
        self.parts.points.len().wrapping_sub(1)
    }

    /// The enclosed volume of a pose, which holds the positions of all control points.
    ///
    /// Its unit is `2^(volume_shift + 3 * difference_shift - weight_bits)` cubes of the coordinates'
    /// last place: see [`VolumeForm::volume_exponent`].
    ///
    /// # Scaling and overflow
    ///
    /// For any pose: differences `d` are at most `2^30`, a component of `d_i x d_j` is at most
    /// `2^61`, one of the sum of `weight * d_k` at most `2^31 * 2^30`. Their products are
    /// 128-bit, and with [`WEIGHT_LIMIT`] all of them add up to less than
    /// `3 * 2^61 * 2^30 * 2^31 < 2^124`. The sum is exact, and rounded once; a volume that does not fit 64 bits
    /// saturates and is counted.
    ///
    /// # Errors
    ///
    /// [`EnclosedError::Length`] if a length does not fit.
    pub fn volume<C: Coordinate>(
        &self,
        pose: &[[C; 3]],
        workspace: &mut [[i32; 3]],
    ) -> Result<Enclosed, EnclosedError> {
        length(self.control_points, pose.len())?;
        length(self.workspace_length(), workspace.len())?;
        let doublings = evaluate::differences(&self.parts, pose, workspace);
        let sum = evaluate::volume(&self.parts, workspace);
        Ok(evaluate::finish_volume(&self.parts, sum, doublings))
    }

    /// The enclosed volume of a pose and its derivative by each control point of the region.
    ///
    /// `gradient` holds one vector for each of [`VolumeForm::points`]; they add up to zero. Their
    /// unit is `2^(31 + 2 * difference_shift - gradient_bits - weight_bits)` squares of the
    /// coordinates' last place: see [`VolumeForm::gradient_exponent`].
    ///
    /// # Scaling and overflow
    ///
    /// The volume as in [`VolumeForm::volume`]. Cross products are rounded by `2^31` and weighted
    /// sums by `2^pair_bits`, both to at most `2^30`; a point's sum is at most `2^30` times the
    /// magnitudes of the weights beside it, below `2^61`, and one rounding for each pair and each
    /// weight. Final coordinates saturate at [`GRADIENT_LIMIT`] and are counted, so
    /// that the base's, minus the sum of at most 65 534 others, fits 64 bits.
    ///
    /// # Errors
    ///
    /// [`EnclosedError::Length`] if a length does not fit.
    pub fn volume_and_gradient<C: Coordinate>(
        &self,
        pose: &[[C; 3]],
        workspace: &mut [[i32; 3]],
        gradient: &mut [[i64; 3]],
    ) -> Result<Enclosed, EnclosedError> {
        length(self.control_points, pose.len())?;
        length(self.workspace_length(), workspace.len())?;
        length(self.parts.points.len(), gradient.len())?;
        let Some((base, others)) = gradient.split_first_mut() else {
            return Err(EnclosedError::Points);
        };
        let doublings = evaluate::differences(&self.parts, pose, workspace);
        let sum = evaluate::volume_and_gradient(&self.parts, workspace, others);
        let mut enclosed = evaluate::finish_volume(&self.parts, sum, doublings);
        let bits = self.parts.gradient_bits;
        evaluate::finish_gradient(bits, doublings, base, others, &mut enclosed.saturated);
        Ok(enclosed)
    }
}

const fn length(needed: usize, given: usize) -> Result<(), EnclosedError> {
    if needed == given {
        Ok(())
    } else {
        Err(EnclosedError::Length { needed, given })
    }
}
