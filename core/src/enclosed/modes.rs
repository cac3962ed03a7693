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

    /// The coefficients, in the order of [`VolumeModes::new_checked`].
    #[must_use]
    pub const fn coefficients(&self) -> &'a [i32] {
        self.coefficients
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
        let (constant, mut coefficients) = self.coefficients.split_first().unwrap_or((&0, &[]));
        let (first_row, more) = split(coefficients, amplitudes.len());
        coefficients = more;
        let start = product(*constant, ONE);
        let first_line = narrow(start.wrapping_add(dot(first_row, amplitudes)));
        let constants = product(first_line, ONE);
        let mut total = plane(&mut coefficients, amplitudes);
        total = product(narrow(total.wrapping_add(constants)), ONE);
        let mut rest = amplitudes;
        while let Some((&amplitude, others)) = rest.split_first() {
            let plane = plane(&mut coefficients, rest);
            total = total.wrapping_add(product(narrow(plane), amplitude));
            rest = others;
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
        let (constant, mut coefficients) = self.coefficients.split_first().unwrap_or((&0, &[]));
        let (first_row, more) = split(coefficients, amplitudes.len());
        coefficients = more;
        let start = product(*constant, ONE);
        let sum = dot_and_spread(first_row, amplitudes, gradient, HALF);
        let constants = product(narrow(start.wrapping_add(sum)), ONE);
        let total = plane_and_gradient(&mut coefficients, amplitudes, gradient, ONE);
        let mut total = product(narrow(total.wrapping_add(constants)), ONE);
        let (mut rest, mut derivatives) = (amplitudes, gradient);
        while let Some((&amplitude, others)) = rest.split_first() {
            let plane = plane_and_gradient(&mut coefficients, rest, derivatives, amplitude);
            total = total.wrapping_add(product(narrow(plane), amplitude));
            let Some((own, more)) = derivatives.split_first_mut() else {
                break;
            };
            *own = own.wrapping_add(plane);
            (rest, derivatives) = (others, more);
        }
        Ok(total)
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

/// The product of two amplitudes of one, rounded by [`SHIFT`].
const HALF: i32 = 1 << 29;

/// The coefficients of one pair, those of every `c` from `b` on, and what lies behind them.
#[inline(always)]
fn split(coefficients: &[i32], length: usize) -> (&[i32], &[i32]) {
    coefficients.split_at_checked(length).unwrap_or_default()
}

/// Planes of up to this many amplitudes have straight code for each of their lines.
///
/// Lines are short: loops, and calls too, would cost more than what is in them.
const UNROLLED: usize = 16;

/// Calls a generic function for lines of 16 down to one amplitude; it passes over those that are longer than its plane.
macro_rules! each_length {
    ($line:ident($($argument:expr),*)) => {
        each_length!(@ $line ($($argument),*) 16 15 14 13 12 11 10 9 8 7 6 5 4 3 2 1)
    };
    (@ $line:ident $arguments:tt $($length:literal)*) => {
        $(each_length!(# $line::<$length> $arguments);)*
    };
    (# $line:ident::<$length:literal> ($($argument:expr),*)) => {
        $line::<$length>($($argument),*)
    };
}

/// The sum over `b` from the first of these amplitudes on, of amplitude times the rounded sum over `c`.
#[inline(never)]
fn plane(coefficients: &mut &[i32], amplitudes: &[i32]) -> i64 {
    let (mut left, mut rest) = (*coefficients, amplitudes);
    let mut plane = 0_i64;
    while let Some((&amplitude, others)) = rest.split_first()
        && rest.len() > UNROLLED
    {
        let (row, more) = split(left, rest.len());
        plane = plane.wrapping_add(product(narrow(dot(row, rest)), amplitude));
        (left, rest) = (more, others);
    }
    each_length!(line(&mut left, rest, &mut plane));
    *coefficients = left;
    plane
}

/// The line of the last `N` amplitudes, if there are so many.
#[inline(always)]
fn line<const N: usize>(left: &mut &[i32], amplitudes: &[i32], plane: &mut i64) {
    let (Some(own @ [amplitude, ..]), Some((row, more))) = (
        amplitudes.last_chunk::<N>().map(<[i32; N]>::as_slice),
        left.split_first_chunk::<N>(),
    ) else {
        return;
    };
    *plane = plane.wrapping_add(product(narrow(dot(row, own)), *amplitude));
    *left = more;
}

/// The same, while every derivative gets what it has from the sums over `b` and `c`.
#[inline(never)]
fn plane_and_gradient(
    coefficients: &mut &[i32],
    amplitudes: &[i32],
    gradient: &mut [i64],
    first: i32,
) -> i64 {
    let (mut left, mut rest, mut derivatives) = (*coefficients, amplitudes, gradient);
    let mut plane = 0_i64;
    // A weight of two amplitudes of -2 has 33 bits, which straight code does without.
    let is_wide = first == i32::MIN;
    while rest.len() > if is_wide { 0 } else { UNROLLED } {
        let (row, more) = split(left, rest.len());
        plane = plane.wrapping_add(line_and_spread(row, rest, derivatives, first));
        let (Some((_, others)), Some((_, later))) = (
            rest.split_first(),
            core::mem::take(&mut derivatives).split_first_mut(),
        ) else {
            break;
        };
        (left, rest, derivatives) = (more, others, later);
    }
    each_length!(fixed_line_and_spread(
        &mut left,
        rest,
        derivatives,
        first,
        &mut plane
    ));
    *coefficients = left;
    plane
}

/// The line of the last `N` amplitudes, if there are so many.
#[inline(always)]
fn fixed_line_and_spread<const N: usize>(
    left: &mut &[i32],
    amplitudes: &[i32],
    gradient: &mut [i64],
    first: i32,
    plane: &mut i64,
) {
    let (Some(own @ [amplitude, ..]), Some(derivatives), Some((row, more))) = (
        amplitudes.last_chunk::<N>().map(<[i32; N]>::as_slice),
        gradient.last_chunk_mut::<N>(),
        left.split_first_chunk::<N>(),
    ) else {
        return;
    };
    let weight = low_word(round_shift(product(first, *amplitude), SHIFT));
    let line = narrow(dot_and_spread(row, own, derivatives, weight));
    *plane = plane.wrapping_add(product(line, *amplitude));
    if let Some(own) = derivatives.first_mut() {
        *own = own.wrapping_add(product(line, first));
    }
    *left = more;
}

/// A line times its first amplitude. The derivatives by its amplitudes get their parts: the first `line * first` beside
/// `coefficient * weight`, which all get, where the weight is the rounded product of both amplitudes.
#[inline(always)]
fn line_and_spread(row: &[i32], amplitudes: &[i32], gradient: &mut [i64], first: i32) -> i64 {
    let Some(&amplitude) = amplitudes.first() else {
        return 0;
    };
    let weight = round_shift(product(first, amplitude), SHIFT);
    let sum = match i32::try_from(weight) {
        Ok(weight) => dot_and_spread(row, amplitudes, gradient, weight),
        // Both amplitudes are -2: the product is 2^31.
        Err(_) => {
            spread_wide(row, gradient, weight);
            dot(row, amplitudes)
        }
    };
    let line = narrow(sum);
    if let Some(own) = gradient.first_mut() {
        *own = own.wrapping_add(product(line, first));
    }
    product(line, amplitude)
}

/// The sum over `c` of coefficient times amplitude.
#[inline(always)]
fn dot(row: &[i32], amplitudes: &[i32]) -> i64 {
    let mut sum = 0_i64;
    for (&coefficient, &amplitude) in row.iter().zip(amplitudes) {
        sum = sum.wrapping_add(product(coefficient, amplitude));
    }
    sum
}

/// The same, while `coefficient * weight` goes to the derivative of every `c`.
#[inline(always)]
fn dot_and_spread(row: &[i32], amplitudes: &[i32], gradient: &mut [i64], weight: i32) -> i64 {
    let mut sum = 0_i64;
    for ((&coefficient, &amplitude), derivative) in row.iter().zip(amplitudes).zip(gradient) {
        sum = sum.wrapping_add(product(coefficient, amplitude));
        *derivative = derivative.wrapping_add(product(coefficient, weight));
    }
    sum
}

/// `coefficient * weight` for a weight of 33 bits.
#[cold]
fn spread_wide(row: &[i32], gradient: &mut [i64], weight: i64) {
    for (&coefficient, derivative) in row.iter().zip(gradient) {
        *derivative = derivative.wrapping_add(i64::from(coefficient).wrapping_mul(weight));
    }
}

#[inline(always)]
pub(super) fn product(a: i32, b: i32) -> i64 {
    i64::from(a).wrapping_mul(i64::from(b))
}

/// A sum rounded by `2^31`: it fits 32 bits because the coefficients' magnitudes add up to
/// less than `2^30`.
pub(super) fn narrow(sum: i64) -> i32 {
    low_word(round_shift(sum, SHIFT))
}

/// A number that fits 32 bits.
#[inline(always)]
fn low_word(value: i64) -> i32 {
    let [a, b, c, d, ..] = value.to_le_bytes();
    i32::from_le_bytes([a, b, c, d])
}
