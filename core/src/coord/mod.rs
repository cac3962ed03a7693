//! Numbers: coordinate formats, the one rounding rule, saturation.
//!
//! A coordinate is a 32-bit two's complement fixed-point number. The kernels work on its raw
//! bits, so the number of fraction bits is the user's choice; [`Coordinate`] is the door between
//! the typed world ([`fixed::FixedI32`]) and the raw one (`i32`).
//!
//! # The rounding rule
//!
//! Every rounding of octruss is `floor(x + 1/2)`: to the nearest, ties toward plus infinity. It
//! commutes with translations by whole units, so moving all inputs by an integer moves every
//! result by that integer, to the bit; and its half can be the start value of an accumulator, so
//! it is free in a kernel. Mirror images may differ by one unit at exact ties. [`round_div`],
//! [`round_div_wide`] and [`round_shift`] are the only places where octruss rounds.

use fixed::FixedI32;
use fixed::types::extra::LeEqU32;

/// A 32-bit fixed-point coordinate.
///
/// Implemented for [`FixedI32`] with any number of fraction bits, and for `i32`, which stands
/// for raw bits of whatever format.
pub trait Coordinate: Copy + Default + 'static {
    /// Fraction bits of the format; `None` for raw bits, which fit every format.
    const FRACTION_BITS: Option<u32>;

    /// The coordinate with these raw bits.
    fn from_bits(bits: i32) -> Self;

    /// The raw bits: the coordinate in units of its last place.
    fn to_bits(self) -> i32;

    /// The raw bits of points, where they lie.
    fn bits_of(points: &[[Self; 3]]) -> &[[i32; 3]];

    /// The raw bits of points, where they lie, to be written.
    fn bits_of_mut(points: &mut [[Self; 3]]) -> &mut [[i32; 3]];
}

impl Coordinate for i32 {
    const FRACTION_BITS: Option<u32> = None;

    #[inline(always)]
    fn from_bits(bits: i32) -> Self {
        bits
    }

    #[inline(always)]
    fn to_bits(self) -> i32 {
        self
    }

    #[inline(always)]
    fn bits_of(points: &[[Self; 3]]) -> &[[i32; 3]] {
        points
    }

    #[inline(always)]
    fn bits_of_mut(points: &mut [[Self; 3]]) -> &mut [[i32; 3]] {
        points
    }
}

impl<Frac: LeEqU32 + 'static> Coordinate for FixedI32<Frac> {
    const FRACTION_BITS: Option<u32> = Some(Frac::U32);

    #[inline(always)]
    fn from_bits(bits: i32) -> Self {
        FixedI32::from_bits(bits)
    }

    #[inline(always)]
    fn to_bits(self) -> i32 {
        FixedI32::to_bits(self)
    }

    #[inline(always)]
    fn bits_of(points: &[[Self; 3]]) -> &[[i32; 3]] {
        // Never fails: a `FixedI32` is nothing but its bits.
        bytemuck::try_cast_slice(points).unwrap_or_default()
    }

    #[inline(always)]
    fn bits_of_mut(points: &mut [[Self; 3]]) -> &mut [[i32; 3]] {
        bytemuck::try_cast_slice_mut(points).unwrap_or_default()
    }
}

/// `floor(numerator / denominator + 1/2)`.
///
/// # Scaling and overflow
///
/// `denominator` is positive; `numerator + denominator / 2` must fit 64 bits, which every mask
/// of octruss guarantees (see the callers). A denominator that is not positive gives 0, so that
/// no input can stop a controller.
///
/// For an odd denominator the half is not an integer; dropping its fraction is exact, because an
/// integer numerator plus the dropped 1/2 never crosses a multiple of the denominator.
#[must_use]
pub const fn round_div(numerator: i64, denominator: i64) -> i64 {
    if denominator <= 0 {
        return 0;
    }
    match numerator
        .wrapping_add(denominator >> 1)
        .checked_div_euclid(denominator)
    {
        Some(quotient) => quotient,
        None => 0,
    }
}

/// [`round_div`] in 128 bits, for sums of values that carry guard bits.
#[must_use]
pub const fn round_div_wide(numerator: i128, denominator: i128) -> i128 {
    if denominator <= 0 {
        return 0;
    }
    match numerator
        .wrapping_add(denominator >> 1)
        .checked_div_euclid(denominator)
    {
        Some(quotient) => quotient,
        None => 0,
    }
}

/// `floor(value / 2^shift + 1/2)` for a shift of 1 to 62.
///
/// # Scaling and overflow
///
/// `value + 2^(shift - 1)` must fit 64 bits. Kernels start their accumulator with
/// [`rounding_start`] and end with [`floor_shift`]: the same rule, with the half paid for once.
#[must_use]
pub const fn round_shift(value: i64, shift: u32) -> i64 {
    floor_shift(value.wrapping_add(rounding_start(shift)), shift)
}

/// The half that an accumulator starts with: `2^(shift - 1)`.
#[must_use]
#[inline(always)]
pub const fn rounding_start(shift: u32) -> i64 {
    1_i64.wrapping_shl(shift).wrapping_shr(1)
}

/// `floor(value / 2^shift)`, the end of a sum that started with [`rounding_start`].
#[must_use]
#[inline(always)]
pub const fn floor_shift(value: i64, shift: u32) -> i64 {
    value.wrapping_shr(shift)
}

/// Clamps a final coordinate to 32 bits and counts it in `saturated` if it did not fit.
///
/// Only final coordinates saturate; intermediates never overflow. The count stops at its
/// greatest value rather than wrapping.
#[inline(always)]
pub fn saturate(value: i64, saturated: &mut u32) -> i32 {
    match i32::try_from(value) {
        Ok(bits) => bits,
        Err(_) => {
            *saturated = saturated.saturating_add(1);
            if value < 0 { i32::MIN } else { i32::MAX }
        }
    }
}

/// [`saturate`] for a coordinate that comes from a 128-bit sum.
pub fn saturate_wide(value: i128, saturated: &mut u32) -> i32 {
    let bound = if value < 0 { i64::MIN } else { i64::MAX };
    saturate(i64::try_from(value).unwrap_or(bound), saturated)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Ties and their neighbours, worked out by hand from floor(x + 1/2).
    #[test]
    fn division_rounds_to_nearest_with_ties_up() {
        let cases: [(i64, i64, i64); 14] = [
            (5, 2, 3),   // 2.5
            (-5, 2, -2), // -2.5
            (7, 2, 4),
            (-7, 2, -3),
            (1, 3, 0),
            (2, 3, 1),
            (-1, 3, 0),
            (-2, 3, -1),
            (3, 6, 1),   // 1/2
            (-3, 6, 0),  // -1/2
            (-9, 6, -1), // -3/2
            (0, 7, 0),
            (10, 7, 1),
            (11, 7, 2),
        ];
        for (numerator, denominator, want) in cases {
            assert_eq!(
                round_div(numerator, denominator),
                want,
                "{numerator}/{denominator}"
            );
            let wide = round_div_wide(i128::from(numerator), i128::from(denominator));
            assert_eq!(wide, i128::from(want), "{numerator}/{denominator}");
        }
        assert_eq!(round_div(5, 0), 0);
        assert_eq!(round_div(5, -2), 0);
    }

    #[test]
    fn shifts_follow_the_same_rule_as_divisions() {
        for value in -4096..4096_i64 {
            for shift in 1..8 {
                assert_eq!(round_shift(value, shift), round_div(value, 1 << shift));
            }
        }
    }

    #[test]
    fn translation_by_whole_units_commutes_with_rounding() {
        for denominator in 1..30_i64 {
            for numerator in -100..100_i64 {
                assert_eq!(
                    round_div(numerator + 17 * denominator, denominator),
                    round_div(numerator, denominator) + 17
                );
            }
        }
    }

    #[test]
    fn saturation_clamps_and_counts() {
        let mut saturated = 0;
        assert_eq!(saturate(2_147_483_647, &mut saturated), i32::MAX);
        assert_eq!(saturate(-2_147_483_648, &mut saturated), i32::MIN);
        assert_eq!(saturated, 0);
        assert_eq!(saturate(2_147_483_648, &mut saturated), i32::MAX);
        assert_eq!(saturate(-2_147_483_649, &mut saturated), i32::MIN);
        assert_eq!(saturated, 2);
        saturated = u32::MAX;
        assert_eq!(saturate(i64::MAX, &mut saturated), i32::MAX);
        assert_eq!(saturated, u32::MAX);
    }
}
