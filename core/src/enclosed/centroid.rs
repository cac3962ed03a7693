//! The centroid for poses that are combinations of a few modes.

use super::error::EnclosedError;
use super::modes::{MODE_WEIGHT_LIMIT, narrow, product};

/// Moments are divided by volumes after a shift by at most so many bits.
const SHIFT_LIMIT: i32 = 60;

/// The first moments of the enclosed solid, for poses `rest + sum of amplitude_a * mode_a`.
///
/// They are taken about one control point of the pose, the *base*, wherever the pose has it. So they are
/// quartic polynomials in the amplitudes `q`: with `q_0 = 1` the sum over `a <= b <= c <= d` of `k_abcd
/// q_a q_b q_c q_d`, one for each axis. Divided by the volume they are the way from the base to the
/// centroid.
///
/// A motion of the whole pose moves the base and changes no difference to it, and so no moment: the
/// centroid moves by the same, to the bit.
#[derive(Clone, Copy, Debug)]
pub struct CentroidModes<'a> {
    modes: usize,
    base: u16,
    shift: i32,
    axes: [&'a [i32]; 3],
}

/// Where the centroid of an enclosed solid lies.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Centroid {
    /// The centroid minus the base's position, in units in the last place of a coordinate.
    pub offset: [i32; 3],
    /// How many of the three were clamped to 32 bits.
    pub saturated: u32,
}

impl<'a> CentroidModes<'a> {
    /// Proves that each axis has `(modes + 4 choose 4)` coefficients, `k_0000, k_0001, ... k_mmmm` in
    /// ascending order, whose magnitudes add up to at most [`MODE_WEIGHT_LIMIT`].
    ///
    /// `coefficients` holds those of x, of y and of z, one after the other. `base` is the index of a
    /// control point. A moment's unit over the volume's, those of [`VolumeModes::volume`](super::VolumeModes::volume), is `2^shift` units in
    /// the last place of a coordinate; `shift` is from -60 to 60.
    ///
    /// # Errors
    ///
    /// [`EnclosedError::Shift`], [`EnclosedError::Length`], or [`EnclosedError::Weights`] with the axis.
    pub fn new_checked(
        modes: u16,
        base: u16,
        shift: i32,
        coefficients: &'a [i32],
    ) -> Result<Self, EnclosedError> {
        if !(-SHIFT_LIMIT..=SHIFT_LIMIT).contains(&shift) {
            return Err(EnclosedError::Shift);
        }
        let each = count(modes);
        let length = EnclosedError::Length {
            needed: each.saturating_mul(3),
            given: coefficients.len(),
        };
        let (x, rest) = coefficients.split_at_checked(each).ok_or(length)?;
        let (y, z) = rest.split_at_checked(each).ok_or(length)?;
        if z.len() != each {
            return Err(length);
        }
        for (axis, place) in [x, y, z].into_iter().zip(0_u32..) {
            let magnitude = |&weight: &i32| i64::from(weight.unsigned_abs());
            let total = axis.iter().map(magnitude).fold(0, i64::saturating_add);
            if total > MODE_WEIGHT_LIMIT {
                return Err(EnclosedError::Weights { place });
            }
        }
        Ok(Self {
            modes: usize::from(modes),
            base,
            shift,
            axes: [x, y, z],
        })
    }

    /// Number of modes.
    #[must_use]
    pub const fn modes(&self) -> usize {
        self.modes
    }

    /// The control point that offsets are counted from.
    #[must_use]
    pub fn base(&self) -> usize {
        usize::from(self.base)
    }

    /// The way from the base to the centroid.
    ///
    /// `amplitudes` holds one amplitude for each mode, with 30 fraction bits: from -2 to 2. `volume` is
    /// what [`VolumeModes::volume`](super::VolumeModes::volume) says of the same amplitudes, with the polynomial that was baked
    /// beside this one.
    ///
    /// # Scaling and overflow
    ///
    /// The sum over `d` of coefficient times amplitude is at most `2^30 * 2^31`, and at most `2^30` after a
    /// rounding by `2^31`; so are those over `c` and `b`, and the moment, the sum over `a`, is below
    /// `2^61`, as for the volume. It counts `2^-27` of a coefficient. Moment and volume are shifted exactly in 128
    /// bits, and their quotient is rounded once, `floor(x + 1/2)`.
    ///
    /// # Errors
    ///
    /// [`EnclosedError::Length`] if the number of amplitudes does not fit, [`EnclosedError::Volume`] if
    /// the volume is not above zero.
    pub fn offset(&self, amplitudes: &[i32], volume: i64) -> Result<Centroid, EnclosedError> {
        if self.modes != amplitudes.len() {
            return Err(EnclosedError::Length {
                needed: self.modes,
                given: amplitudes.len(),
            });
        }
        if volume <= 0 {
            return Err(EnclosedError::Volume);
        }
        let mut centroid = Centroid::default();
        for (offset, coefficients) in centroid.offset.iter_mut().zip(self.axes) {
            let exact = quotient(self.moment(coefficients, amplitudes), volume, self.shift);
            let clamped = exact.clamp(i128::from(i32::MIN), i128::from(i32::MAX));
            let lost = u32::from(clamped != exact);
            centroid.saturated = centroid.saturated.wrapping_add(lost);
            *offset = i32::try_from(clamped).unwrap_or_default();
        }
        Ok(centroid)
    }

    /// One axis' moment, in units of `2^-27` of a coefficient's.
    fn moment(&self, mut coefficients: &[i32], amplitudes: &[i32]) -> i64 {
        let mut total = 0_i64;
        for first in 0..=self.modes {
            let mut space = 0_i64;
            for second in first..=self.modes {
                let mut plane = 0_i64;
                for third in second..=self.modes {
                    let length = self.modes.wrapping_sub(third).wrapping_add(1);
                    let parts = coefficients.split_at_checked(length);
                    let (row, more) = parts.unwrap_or_default();
                    coefficients = more;
                    let sum = line(row, third, amplitudes);
                    plane = plane.wrapping_add(product(sum, amplitude(amplitudes, third)));
                }
                let plane = narrow(plane);
                space = space.wrapping_add(product(plane, amplitude(amplitudes, second)));
            }
            let space = narrow(space);
            total = total.wrapping_add(product(space, amplitude(amplitudes, first)));
        }
        total
    }
}

/// The amplitude of an index: one for index 0, then the modes'.
fn amplitude(amplitudes: &[i32], index: usize) -> i32 {
    match index.checked_sub(1) {
        None => 1 << 30,
        Some(mode) => amplitudes.get(mode).copied().unwrap_or_default(),
    }
}

/// The sum of coefficient times amplitude over all indices from `first` on, rounded.
#[inline(never)]
fn line(row: &[i32], first: usize, amplitudes: &[i32]) -> i32 {
    let (constant, row, from) = match (first.checked_sub(1), row.split_first()) {
        (None, Some((&constant, rest))) => (constant, rest, 0),
        (from, _) => (0, row, from.unwrap_or_default()),
    };
    let mut sum = product(constant, 1 << 30);
    for (&coefficient, &amplitude) in row.iter().zip(amplitudes.get(from..).unwrap_or_default()) {
        sum = sum.wrapping_add(product(coefficient, amplitude));
    }
    narrow(sum)
}

/// `(modes + 4 choose 4)`, which is below `2^60` for any 16-bit number of modes.
fn count(modes: u16) -> usize {
    // Each product of successive numbers is divided by what it is a multiple of.
    let step = |total: u64, k: u64| {
        total
            .wrapping_mul(u64::from(modes).wrapping_add(k))
            .checked_div(k)
            .unwrap_or_default()
    };
    usize::try_from((1..=4).fold(1, step)).unwrap_or(usize::MAX)
}

/// `moment * 2^shift / volume`, rounded: `floor(x + 1/2)`. The volume is above zero.
fn quotient(moment: i64, volume: i64, shift: i32) -> i128 {
    let up = shift.max(0).unsigned_abs();
    let down = shift.min(0).unsigned_abs();
    // Below 2^62 * 2^60 and 2^63 * 2^60: twice either fits.
    let moment = i128::from(moment).wrapping_shl(up);
    let volume = i128::from(volume).wrapping_shl(down);
    let doubled = moment.wrapping_mul(2).wrapping_add(volume);
    doubled
        .checked_div_euclid(volume.wrapping_mul(2))
        .unwrap_or_default()
}
