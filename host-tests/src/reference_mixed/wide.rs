//! Integers that are too great for an `f64`, as three limbs that are not.

/// One in 16 bits: the weight of a limb against the one below it.
const LIMB: f64 = 65_536.0;

/// The integer `low + 2^16 middle + 2^32 high`; limbs may have any sign and size up to 2^53.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Wide {
    pub(super) limbs: [f64; 3],
}

impl Wide {
    /// An integer of magnitude up to 2^53.
    pub fn from_integer(value: f64) -> Self {
        let upper = (value / LIMB).floor();
        let high = (upper / LIMB).floor();
        Self {
            limbs: [value - upper * LIMB, upper - high * LIMB, high],
        }
    }

    /// Adds `weight` times another; all products and sums of limbs must stay within 2^53.
    pub fn add(&mut self, weight: f64, other: &Self) {
        for (limb, more) in self.limbs.iter_mut().zip(other.limbs) {
            *limb += weight * more;
            debug_assert!(limb.abs() < 9_007_199_254_740_992.0);
        }
    }

    /// `floor(self / denominator + 1/2)` for an even denominator from 2 to 2^36.
    ///
    /// # Panics
    /// If the denominator is not such a one.
    pub fn round_quotient(self, denominator: f64) -> f64 {
        assert!(denominator % 2.0 == 0.0 && (2.0..=68_719_476_736.0).contains(&denominator));
        let [low, middle, high] = self.limbs;
        let low = low + denominator / 2.0;
        // Carries, so that the lower limbs are from 0 to 2^16 - 1.
        let carry = (low / LIMB).floor();
        let (low, middle) = (low - carry * LIMB, middle + carry);
        let carry = (middle / LIMB).floor();
        let (middle, high) = (middle - carry * LIMB, high + carry);
        // Long division, limb by limb; a remainder is below 2^36, so 2^16 of it fit.
        let mut quotient = 0.0;
        let mut rest = 0.0;
        for limb in [high, middle, low] {
            let dividend = rest * LIMB + limb;
            let digit = floor_quotient(dividend, denominator);
            rest = dividend - digit * denominator;
            quotient = quotient * LIMB + digit;
        }
        quotient
    }
}

/// `floor(numerator / denominator)` of integers, the denominator positive. The rounded quotient's
/// floor is right or one too great, and the remainder tells.
fn floor_quotient(numerator: f64, denominator: f64) -> f64 {
    let estimate = (numerator / denominator).floor();
    if numerator - estimate * denominator < 0.0 {
        estimate - 1.0
    } else {
        estimate
    }
}

#[cfg(test)]
mod tests {
    use super::Wide;

    /// Against 128-bit integers.
    #[test]
    fn quotients_are_rounded_as_integers_are() {
        let values = [
            0_i64,
            1,
            -1,
            65_535,
            -65_536,
            (1 << 42) - 1,
            -(1 << 42),
            123_456_789_012,
            -987_654_321_098,
        ];
        for first in values {
            for second in values {
                for weight in [1_i64, -3, 4_097, 3_628_800] {
                    let mut wide = Wide::from_integer(first as f64);
                    wide.add(weight as f64, &Wide::from_integer(second as f64));
                    let exact = i128::from(first) + i128::from(weight) * i128::from(second);
                    for denominator in [2_i64, 144, 864, 294_912 * 168, 1 << 36] {
                        let half = i128::from(denominator / 2);
                        let expected = (exact + half).div_euclid(i128::from(denominator));
                        if expected.abs() < 1 << 53 {
                            let got = wide.round_quotient(denominator as f64);
                            assert_eq!(got as i128, expected, "{exact} / {denominator}");
                        }
                    }
                }
            }
        }
    }
}
