//! Sine and cosine.

use crate::coord::round_shift;

/// A quarter of a turn as an angle.
pub const QUARTER_TURN: i32 = 1 << 30;

/// Taylor's coefficients of the sine of an eighth of a turn, each to the nearest multiple of a power of a
/// half, with that power.
const SINE: [(i64, u32); 6] = [
    (3_373_259_426, 32),
    (-1_387_197_337, 34),
    (684_554_447, 38),
    (-643_455_389, 44),
    (352_813_896, 50),
    (-126_623_039, 56),
];

/// The same of the cosine.
const COSINE: [(i64, u32); 7] = [
    (1_073_741_824, 30),
    (-1_324_675_879, 32),
    (1_089_502_240, 36),
    (-716_863_740, 41),
    (505_368_681, 47),
    (-443_359_018, 54),
    (132_599_337, 60),
];

/// Sine and cosine of an angle, `2^32` to a full turn, with 30 fraction bits.
///
/// The angle is brought to within an eighth of a turn of the nearest multiple of a quarter. What is left,
/// `r` in units of an eighth, has its square rounded to `2^-30`; both polynomials are evaluated from the
/// last coefficient down, every step exact and rounded once to the next coefficient's unit, the sine's
/// once more when it is multiplied by `r`. Both are within one unit of the real number, and exact at
/// multiples of a quarter turn.
///
/// # Scaling and overflow
///
/// Coefficients and steps are below `2^32`, the square is at most `2^30`, and `r` at most `2^29`: every
/// product is below `2^62`.
#[must_use]
pub fn turn(angle: i32) -> (i32, i32) {
    const EIGHTH: i32 = 1 << 29;
    let quarter = angle.wrapping_add(EIGHTH) >> 30;
    let left = i64::from(angle.wrapping_sub(quarter.wrapping_shl(30)));
    let square = round_shift(left.wrapping_mul(left), 28);
    let (slope, bits) = polynomial(&SINE, square);
    // Below 2^31 in magnitude, as a sine with 30 fraction bits is.
    let sine = narrow(round_shift(
        slope.wrapping_mul(left),
        bits.wrapping_add(29).wrapping_sub(30),
    ));
    let (cosine, _) = polynomial(&COSINE, square);
    let cosine = narrow(cosine);
    match quarter & 3 {
        0 => (sine, cosine),
        1 => (cosine, sine.wrapping_neg()),
        2 => (sine.wrapping_neg(), cosine.wrapping_neg()),
        _ => (cosine.wrapping_neg(), sine),
    }
}

/// A polynomial's value, with the fraction bits of its first coefficient.
fn polynomial(coefficients: &[(i64, u32)], square: i64) -> (i64, u32) {
    let mut later = coefficients.iter().rev();
    let Some(&(mut value, mut bits)) = later.next() else {
        return (0, 0);
    };
    for &(coefficient, fewer) in later {
        let shift = bits.wrapping_add(30).wrapping_sub(fewer);
        value = coefficient.wrapping_add(round_shift(value.wrapping_mul(square), shift));
        bits = fewer;
    }
    (value, bits)
}

#[expect(clippy::as_conversions, reason = "sines and cosines fit")]
const fn narrow(value: i64) -> i32 {
    value as i32
}
