//! The volume for poses that are combinations of a few modes.

use super::error::EnclosedError;
use crate::coord::round_shift;

/// The magnitudes of all coefficients add up to at most this: `2^30 - 1`.
pub const MODE_WEIGHT_LIMIT: i64 = (1 << 30) - 1;

/// An amplitude of one: amplitudes have 30 fraction bits.
const ONE: i32 = 1 << 30;

/// Products are rounded by this many bits.
const SHIFT: u32 = 31;

/// The enclosed volume of `rest + sum of amplitude_a * mode_a`, a cubic polynomial in the
/// amplitudes `q`: with `q_0 = 1` the sum over `a <= b <= c` of `k_abc q_a q_b q_c`.
#[derive(Clone, Copy, Debug)]
pub struct VolumeModes<'a> {
    modes: usize,
    coefficients: &'a [i32],
    exponent: i32,
}

impl<'a> VolumeModes<'a> {
    /// Proves that there are `(modes + 3 choose 3)` coefficients, `k_000, k_001, ... k_mmm` in
    /// ascending order, and that their magnitudes add up to at most [`MODE_WEIGHT_LIMIT`].
    ///
    /// # Errors
    ///
    /// [`EnclosedError::Length`] or [`EnclosedError::Weights`].
    pub fn new_checked(modes: u16, coefficients: &'a [i32]) -> Result<Self, EnclosedError> {
        let count = u64::from(modes);
        let product = count
            .wrapping_add(1)
            .wrapping_mul(count.wrapping_add(2))
            .wrapping_mul(count.wrapping_add(3));
        // Below 2^49 for any 16-bit number of modes.
        let needed = usize::try_from(product.wrapping_div(6)).unwrap_or(usize::MAX);
        if coefficients.len() != needed {
            return Err(EnclosedError::Length {
                needed,
                given: coefficients.len(),
            });
        }
        let magnitude = |&weight: &i32| i64::from(weight.unsigned_abs());
        let total = coefficients
            .iter()
            .map(magnitude)
            .fold(0, i64::saturating_add);
        if total > MODE_WEIGHT_LIMIT {
            return Err(EnclosedError::Weights {
                place: u32::from(modes),
            });
        }
        Ok(Self {
            modes: usize::from(modes),
            coefficients,
            exponent: 0,
        })
    }

    /// The same polynomial with coefficients that count `2^exponent` cubes of the coordinates' last
    /// place. It enters units only.
    #[must_use]
    pub const fn with_exponent(self, exponent: i32) -> Self {
        Self { exponent, ..self }
    }

    /// A volume's unit is `2^` this of cubes of the coordinates' last place.
    #[must_use]
    pub fn volume_exponent(&self) -> i64 {
        i64::from(self.exponent).wrapping_sub(28)
    }

    /// The unit of a derivative by an amplitude is `2^` this of cubes of the coordinates' last place.
    #[must_use]
    pub fn gradient_exponent(&self) -> i64 {
        i64::from(self.exponent).wrapping_sub(29)
    }

    /// Number of modes.
    #[must_use]
    pub const fn modes(&self) -> usize {
        self.modes
    }

    /// The volume, in units of `2^-28` of a coefficient's.
    ///
    /// `amplitudes` holds one amplitude for each mode, with 30 fraction bits: from -2 to 2.
    ///
    /// # Scaling and overflow
    ///
    /// The sum over `c` of coefficient times amplitude is at most `2^30 * 2^31`, and at most `2^30`
    /// after a rounding by `2^31`. The sum over `b` of these times amplitudes likewise, and the
    /// result, the sum over `a`, is below `2^62`, for any amplitudes and any number of modes that
    /// fits memory.
    ///
    /// # Errors
    ///
    /// [`EnclosedError::Length`] if the number of amplitudes does not fit.
    pub fn volume(&self, amplitudes: &[i32]) -> Result<i64, EnclosedError> {
        self.check_length(amplitudes.len())?;
        let mut coefficients = self.coefficients;
        let mut total = 0_i64;
        for first in 0..=self.modes {
            let mut plane = 0_i64;
            for second in first..=self.modes {
                let row = self.take_row(&mut coefficients, second);
                let line = line(row, second, amplitudes);
                plane = plane.wrapping_add(product(line, amplitude(amplitudes, second)));
            }
            total = total.wrapping_add(product(narrow(plane), amplitude(amplitudes, first)));
        }
        Ok(total)
    }

    /// The volume, and its derivative by each amplitude, in units of `2^-29` of a coefficient's.
    ///
    /// # Scaling and overflow
    ///
    /// As [`VolumeModes::volume`]. A coefficient enters a derivative at most three times, each time
    /// with at most `2^31`: below `3 * 2^61`, and one rounding for each pair.
    ///
    /// # Errors
    ///
    /// [`EnclosedError::Length`] if a length does not fit.
    pub fn volume_and_gradient(
        &self,
        amplitudes: &[i32],
        gradient: &mut [i64],
    ) -> Result<i64, EnclosedError> {
        self.check_length(amplitudes.len())?;
        self.check_length(gradient.len())?;
        gradient.fill(0);
        let mut coefficients = self.coefficients;
        let mut total = 0_i64;
        for first in 0..=self.modes {
            let a = amplitude(amplitudes, first);
            let mut plane = 0_i64;
            for second in first..=self.modes {
                let b = amplitude(amplitudes, second);
                let row = self.take_row(&mut coefficients, second);
                let line = line(row, second, amplitudes);
                spread(row, second, round_shift(product(a, b), SHIFT), gradient);
                add(gradient, second, product(line, a));
                add(gradient, first, product(line, b));
                plane = plane.wrapping_add(product(line, b));
            }
            total = total.wrapping_add(product(narrow(plane), a));
        }
        Ok(total)
    }

    /// The coefficients of one pair: those of every `c` from `second` on.
    fn take_row(&self, coefficients: &mut &'a [i32], second: usize) -> &'a [i32] {
        let length = self.modes.wrapping_sub(second).wrapping_add(1);
        let (row, more) = coefficients.split_at_checked(length).unwrap_or_default();
        *coefficients = more;
        row
    }

    const fn check_length(&self, given: usize) -> Result<(), EnclosedError> {
        if self.modes == given {
            return Ok(());
        }
        Err(EnclosedError::Length {
            needed: self.modes,
            given,
        })
    }
}

/// The amplitude of an index: one for index 0, then the modes'.
#[inline(always)]
pub(super) fn amplitude(amplitudes: &[i32], index: usize) -> i32 {
    match index.checked_sub(1) {
        None => ONE,
        Some(mode) => amplitudes.get(mode).copied().unwrap_or_default(),
    }
}

/// A row without its coefficient of index 0, if it has one, and the amplitudes that go with it.
#[inline(always)]
fn without_constant<A>(
    row: &[i32],
    second: usize,
    values: A,
    from: impl Fn(A, usize) -> A,
) -> (i32, &[i32], A) {
    match (second.checked_sub(1), row.split_first()) {
        (None, Some((&constant, rest))) => (constant, rest, values),
        (first, _) => (0, row, from(values, first.unwrap_or_default())),
    }
}

/// The sum over `c` of coefficient times amplitude, rounded.
#[inline(never)]
pub(super) fn line(row: &[i32], second: usize, amplitudes: &[i32]) -> i32 {
    let (constant, row, amplitudes) = without_constant(row, second, amplitudes, |all, first| {
        all.get(first..).unwrap_or_default()
    });
    let mut sum = product(constant, ONE);
    for (&coefficient, &amplitude) in row.iter().zip(amplitudes) {
        sum = sum.wrapping_add(product(coefficient, amplitude));
    }
    narrow(sum)
}

/// Adds `coefficient * weight` to the derivative of every `c`.
#[inline(never)]
fn spread(row: &[i32], second: usize, weight: i64, gradient: &mut [i64]) {
    let (_, row, gradient) = without_constant(row, second, gradient, |all, first| {
        all.get_mut(first..).unwrap_or_default()
    });
    for (&coefficient, derivative) in row.iter().zip(gradient) {
        *derivative = derivative.wrapping_add(i64::from(coefficient).wrapping_mul(weight));
    }
}

fn add(gradient: &mut [i64], index: usize, value: i64) {
    let mode = index.checked_sub(1);
    if let Some(derivative) = mode.and_then(|mode| gradient.get_mut(mode)) {
        *derivative = derivative.wrapping_add(value);
    }
}

#[inline(always)]
pub(super) fn product(a: i32, b: i32) -> i64 {
    i64::from(a).wrapping_mul(i64::from(b))
}

/// A sum rounded by `2^31`: it fits 32 bits because the coefficients' magnitudes add up to
/// less than `2^30`.
pub(super) fn narrow(sum: i64) -> i32 {
    i32::try_from(round_shift(sum, SHIFT)).unwrap_or_default()
}
