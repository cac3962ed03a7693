//! Integer arithmetic on `f64`, exact while magnitudes stay within 2^53.

/// The greatest magnitude up to which every integer is an `f64`: 2^53.
pub const EXACT_MAXIMUM: f64 = 9_007_199_254_740_992.0;

/// `floor(numerator / denominator)` of two integers, exactly.
///
/// Both must be integers, the denominator positive and `|numerator| + denominator` at most 2^53.
/// Rounding a quotient is monotone and keeps integers, so the floor of the rounded quotient is
/// the true floor or one more; its product with the denominator is an integer within 2^53, and
/// a negative remainder tells the two apart.
///
/// ```
/// use octruss_host_tests::reference::exact::floor_quotient;
/// assert_eq!(floor_quotient(-7.0, 2.0), -4.0);
/// assert_eq!(floor_quotient(9_007_199_254_740_989.0, 3.0), 3_002_399_751_580_329.0);
/// ```
pub fn floor_quotient(numerator: f64, denominator: f64) -> f64 {
    let estimate = (numerator / denominator).floor();
    if numerator - estimate * denominator < 0.0 {
        estimate - 1.0
    } else {
        estimate
    }
}

/// `floor(numerator / denominator + 1/2)` of two integers, exactly.
///
/// The denominator must be positive and even, and `|numerator| + 3/2 denominator` at most 2^53.
pub fn round_quotient(numerator: f64, denominator: f64) -> f64 {
    floor_quotient(numerator + denominator / 2.0, denominator)
}

/// A sum of products of integer weights and integer coordinates, over 2^30.
///
/// Coordinates enter as a low limb of 16 bits and a high limb; see the module
/// documentation of [`crate::reference`] for the bounds that keep both sums exact.
#[derive(Clone, Copy, Debug, Default)]
pub struct LimbSum {
    high: f64,
    low: f64,
}

/// One in 16 bits: the weight of the high limb.
const LIMB: f64 = 65_536.0;

impl LimbSum {
    /// Adds `weight * value`; both are integers, `|value| <= 2^32`, and the magnitudes of all
    /// weights of one sum add up to at most 2^31.
    pub fn add(&mut self, weight: f64, value: f64) {
        let high = (value / LIMB).floor();
        let low = value - high * LIMB;
        self.high += weight * high;
        self.low += weight * low;
    }

    /// `floor(sum / 2^30 + 1/2)`, exactly.
    ///
    /// The low sum's carry goes to the high sum; what is left of it, below 2^16, cannot change a
    /// floor over 2^30 of an integer multiple of 2^16.
    pub fn round(self) -> f64 {
        let half = 536_870_912.0; // 2^29
        let carry = ((self.low + half) / LIMB).floor();
        floor_quotient(self.high + carry, 16_384.0) // 2^30 / 2^16
    }
}

/// Clamps an integer to the range of `i32`; `saturated` goes up by one if that changed it.
pub fn saturate(value: f64, saturated: &mut usize) -> i32 {
    let clamped = value.clamp(f64::from(i32::MIN), f64::from(i32::MAX));
    if clamped != value {
        *saturated += 1;
    }
    clamped as i32
}

#[cfg(test)]
mod tests {
    use super::{EXACT_MAXIMUM, LimbSum, floor_quotient, round_quotient, saturate};

    /// Against 128-bit integer division.
    #[test]
    fn floor_quotient_is_the_floor() {
        let numerators = [
            0.0,
            1.0,
            -1.0,
            287.0,
            288.0,
            -288.0,
            -289.0,
            324.0 * 2_147_483_648.0,
        ];
        let room = EXACT_MAXIMUM - 3_455_712.0;
        let near_limit = [room, room - 1.0, 1.0 - room, -room];
        for numerator in numerators.into_iter().chain(near_limit) {
            for denominator in [1.0, 2.0, 3.0, 7.0, 288.0, 864.0, 3_455_712.0] {
                let expected = (numerator as i128).div_euclid(denominator as i128);
                assert_eq!(floor_quotient(numerator, denominator) as i128, expected);
            }
        }
    }

    #[test]
    fn ties_go_toward_plus_infinity() {
        assert_eq!(round_quotient(1.0, 2.0), 1.0);
        assert_eq!(round_quotient(-1.0, 2.0), 0.0);
        assert_eq!(round_quotient(-3.0, 2.0), -1.0);
        assert_eq!(round_quotient(143.0, 288.0), 0.0);
        assert_eq!(round_quotient(144.0, 288.0), 1.0);
        assert_eq!(round_quotient(-144.0, 288.0), 0.0);
        assert_eq!(round_quotient(-145.0, 288.0), -1.0);
    }

    /// Against 128-bit integers, at the ends of what may enter.
    #[test]
    fn limb_sums_are_exact() {
        let extremes = [
            i64::from(i32::MIN),
            i64::from(i32::MAX),
            -1,
            0,
            1,
            -4_294_967_295,
            4_294_967_295,
        ];
        for first in extremes {
            for second in extremes {
                for weight in [-(1_i64 << 30), -1, 1, 3, (1 << 29) + 1, 1 << 30] {
                    let other = (1_i64 << 31) - weight.abs();
                    let mut sum = LimbSum::default();
                    sum.add(weight as f64, first as f64);
                    sum.add(other as f64, second as f64);
                    let exact = i128::from(weight) * i128::from(first)
                        + i128::from(other) * i128::from(second);
                    assert_eq!(sum.round() as i128, (exact + (1 << 29)).div_euclid(1 << 30));
                }
            }
        }
    }

    #[test]
    fn saturation_is_counted() {
        let mut saturated = 0;
        assert_eq!(saturate(2_147_483_647.0, &mut saturated), i32::MAX);
        assert_eq!(saturate(-2_147_483_648.0, &mut saturated), i32::MIN);
        assert_eq!(saturated, 0);
        assert_eq!(saturate(2_147_483_648.0, &mut saturated), i32::MAX);
        assert_eq!(saturate(-2_147_483_649.0, &mut saturated), i32::MIN);
        assert_eq!(saturated, 2);
    }
}
