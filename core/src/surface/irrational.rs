//! Irrational weights on the device's grid.

use crate::blend::WEIGHT_BITS;

/// A real weight in units of 2^-30, rounded to the nearest, and itself. Masks of positions have magnitudes
/// below 2, those of tangents across a crease of `k` faces below `k`.
///
/// Double precision gives the weights of this library to better than 2^-50, so its rounding to
/// 2^-30 can differ from the real number's only within 2^-20 units of a tie; the test suite shows
/// that no valence up to 4096 comes near one.
#[expect(
    clippy::float_arithmetic,
    clippy::as_conversions,
    clippy::cast_possible_truncation,
    reason = "an irrational weight is made in double precision, once for its valence; it is below \
              2^32, so 2^30 times it fits 64 bits"
)]
pub(super) fn irrational(real: f64) -> (i64, f64) {
    let bits = libm::floor(real * f64::from(1_u32 << WEIGHT_BITS) + 0.5) as i64;
    (bits, real)
}
/// `cos(2 pi step / count)`.
#[expect(
    clippy::float_arithmetic,
    reason = "the cosine of an irrational weight"
)]
pub(super) fn cosine(step: u32, count: u32) -> f64 {
    libm::cos(2.0 * core::f64::consts::PI * f64::from(step) / f64::from(count))
}
