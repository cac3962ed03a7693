//! Values with guard bits, for schemes that must round in between.

use super::{Blend, FixedBlend};
use crate::coord::{Coordinate, round_div_wide, saturate_wide};

/// Fraction bits that a guarded value has below a coordinate's last place.
pub const GUARD_BITS: u32 = 8;

/// A part of a distortion: `sign * sum / count`.
#[derive(Clone, Copy, Debug)]
pub struct Distortion<'a, S> {
    /// A sum of integer weights that add up to zero.
    pub sum: &'a S,
    /// By what it is divided; nothing is added where it is 0.
    pub count: u32,
    /// Taken away instead of added.
    pub is_negative: bool,
}

/// A value type of schemes whose masks are not one sum over the stored values.
///
/// The *clones* of an unzip are such intermediates: a vertex plus several means of its neighbours.
/// They are formed by [`GuardedBlend::distort`], where a type that rounds may round once, to
/// [`GUARD_BITS`] more bits than it stores; everything after that is one exact sum. A type that
/// does not round (real numbers, rows, rationals) takes its own sum for both associated types and
/// is exact throughout.
pub trait GuardedBlend: Blend {
    /// A value with guard bits.
    type Guarded: Clone;
    /// A sum of guarded values before its division. It must hold every sum of a mask exactly.
    type GuardedSum: Clone;

    /// The value itself, exactly.
    fn guard(&self, point: &Self::Point) -> Self::Guarded;

    /// `own + (sum of all parts) / denominator`, rounded once at most, and exactly `own` where every
    /// part has a count of 0.
    fn distort(
        &self,
        own: &Self::Point,
        parts: &[Distortion<'_, Self::Sum>],
        denominator: u32,
    ) -> Self::Guarded;

    /// The empty sum.
    fn guarded_zero(&self) -> Self::GuardedSum;

    /// `sum += weight * value`.
    fn add_guarded(&self, sum: &mut Self::GuardedSum, weight: i64, value: &Self::Guarded);

    /// `sum += weight * other`.
    fn add_guarded_sum(&self, sum: &mut Self::GuardedSum, weight: i64, other: &Self::GuardedSum);

    /// `sum / denominator`, rounded if the value type rounds. `denominator` is positive.
    fn divide_guarded(&mut self, sum: &Self::GuardedSum, denominator: i64) -> Self::Point;
}

/// Guarded values are 64-bit integers in units of `2^-8` of the last place, sums of them 128-bit.
///
/// # Scaling and overflow
///
/// A part's sum has weights of magnitudes up to 80 for each of its `count` contributions, over
/// 32-bit coordinates: below `2^38 count`. Four parts over their common denominator, with the guard
/// bits, stay below `2^(38 + 2 + 8)` times the product of the counts, so that 128 bits hold them for
/// counts up to `2^19` each. A guarded value is at most `2^8 (2^31 + 4 * 2^38 / 144)`, below
/// `2^42`.
///
/// A mask's weights have magnitudes that add up to at most 9/8 of its denominator, and every
/// denominator is a small number (at most 4032) for each cell or face at the vertex, which are
/// fewer than `2^32`: a sum is below `2^42 * 2^44 * 9/8`, far inside 128 bits. (64 bits would hold
/// it only up to about 500 cells at a vertex.) The quotient is rounded once, ties toward plus
/// infinity, and saturates.
impl<C: Coordinate, const D: usize> GuardedBlend for FixedBlend<C, D> {
    type Guarded = [i64; D];
    type GuardedSum = [i128; D];

    #[inline]
    fn guard(&self, point: &[C; D]) -> [i64; D] {
        point.map(|coordinate| i64::from(coordinate.to_bits()).wrapping_shl(GUARD_BITS))
    }

    fn distort(
        &self,
        own: &[C; D],
        parts: &[Distortion<'_, [i64; D]>],
        denominator: u32,
    ) -> [i64; D] {
        let mut guarded = self.guard(own);
        let counts = parts
            .iter()
            .map(|part| part.count)
            .filter(|&count| count != 0);
        let common = counts.fold(1_i128, |product, count| {
            product.wrapping_mul(i128::from(count))
        });
        let divisor = common.wrapping_mul(i128::from(denominator));
        for (axis, value) in guarded.iter_mut().enumerate() {
            let mut numerator = 0_i128;
            for part in parts {
                let sum = part.sum.get(axis).copied().unwrap_or_default();
                let others = common.checked_div(i128::from(part.count)).unwrap_or(0);
                let term = i128::from(sum).wrapping_mul(others);
                numerator = if part.is_negative {
                    numerator.wrapping_sub(term)
                } else {
                    numerator.wrapping_add(term)
                };
            }
            let rounded = round_div_wide(numerator.wrapping_shl(GUARD_BITS), divisor);
            *value = value.wrapping_add(i64::try_from(rounded).unwrap_or_default());
        }
        guarded
    }

    #[inline]
    fn guarded_zero(&self) -> [i128; D] {
        [0; D]
    }

    #[inline]
    fn add_guarded(&self, sum: &mut [i128; D], weight: i64, value: &[i64; D]) {
        for (total, value) in sum.iter_mut().zip(value) {
            let product = i128::from(weight).wrapping_mul(i128::from(*value));
            *total = total.wrapping_add(product);
        }
    }

    #[inline]
    fn add_guarded_sum(&self, sum: &mut [i128; D], weight: i64, other: &[i128; D]) {
        for (total, value) in sum.iter_mut().zip(other) {
            *total = total.wrapping_add(i128::from(weight).wrapping_mul(*value));
        }
    }

    fn divide_guarded(&mut self, sum: &[i128; D], denominator: i64) -> [C; D] {
        let denominator = i128::from(denominator).wrapping_shl(GUARD_BITS);
        sum.map(|total| {
            let rounded = round_div_wide(total, denominator);
            C::from_bits(saturate_wide(rounded, self.saturation_count()))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::{Distortion, FixedBlend, GuardedBlend};

    fn part(sum: &[i64; 1], count: u32, is_negative: bool) -> Distortion<'_, [i64; 1]> {
        Distortion {
            sum,
            count,
            is_negative,
        }
    }

    /// 10 + (7/2 - 5/3) / 144 = 10 + 11/864; 256 * 11/864 = 3.26 rounds to 3.
    #[test]
    fn distortions_are_rounded_once_together() {
        let blend = FixedBlend::<i32, 1>::new();
        let parts = [
            part(&[7], 2, false),
            part(&[5], 3, true),
            part(&[9], 0, false),
        ];
        assert_eq!(blend.distort(&[10], &parts, 144), [10 * 256 + 3]);
        assert_eq!(blend.distort(&[-10], &parts[2..], 144), [-2560]);
        // Half a unit of 2^-8 goes up: 1/512.
        assert_eq!(blend.distort(&[0], &[part(&[1], 1, false)], 512), [1]);
        assert_eq!(blend.distort(&[0], &[part(&[1], 1, true)], 512), [0]);
    }

    #[test]
    fn guarded_sums_are_exact_and_saturate() {
        let mut blend = FixedBlend::<i32, 1>::new();
        let mut sum = blend.guarded_zero();
        blend.add_guarded(&mut sum, 3, &blend.guard(&[i32::MAX]));
        assert_eq!(blend.divide_guarded(&sum, 3), [i32::MAX]);
        assert_eq!(blend.saturated(), 0);
        assert_eq!(blend.divide_guarded(&sum, 1), [i32::MAX]);
        assert_eq!(blend.saturated(), 1);
        // 128/256 of a unit is a tie, and goes up.
        assert_eq!(blend.divide_guarded(&[128], 1), [1]);
        assert_eq!(blend.divide_guarded(&[-128], 1), [0]);
    }
}
