//! Lengths of vectors.

use crate::coord::round_shift;

/// Bits that a shortened coordinate has at most.
const SHORT_BITS: u32 = 30;

/// A vector that was shortened so that its squares fit, and its length.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Length {
    /// How far it was shifted.
    pub shift: u32,
    /// Its coordinates divided by `2^shift` and rounded: at most `2^30` in magnitude.
    pub vector: [i64; 3],
    /// Their length, to the nearest whole number: below `2^31`.
    pub length: i64,
}

/// Shortens a vector by the least shift for which its greatest coordinate has at most 30 bits, and
/// measures it.
///
/// # Scaling and overflow
///
/// Coordinates are at most `2^60` in magnitude, so that rounding them fits 64 bits. Shortened ones are at
/// most `2^30` (a rounding may reach it), so their squares add up to at most `3 * 2^60`.
#[must_use]
pub fn length(vector: [i64; 3]) -> Length {
    let mut greatest = 0_u64;
    for coordinate in vector {
        greatest = greatest.max(coordinate.unsigned_abs());
    }
    let bits = u64::BITS.wrapping_sub(greatest.leading_zeros());
    let shift = bits.saturating_sub(SHORT_BITS);
    let vector = shortened(vector, shift);
    Length {
        shift,
        vector,
        length: root(square(vector)),
    }
}

/// A vector divided by `2^shift` and rounded.
pub(super) fn shortened(vector: [i64; 3], shift: u32) -> [i64; 3] {
    if shift == 0 {
        return vector;
    }
    vector.map(|coordinate| round_shift(coordinate, shift))
}

/// The sum of the squares of coordinates that are at most `2^30`.
pub(super) fn square(vector: [i64; 3]) -> u64 {
    let mut sum = 0_u64;
    for coordinate in vector {
        let magnitude = coordinate.unsigned_abs();
        sum = sum.wrapping_add(magnitude.wrapping_mul(magnitude));
    }
    sum
}

/// `floor(sqrt(square) + 1/2)` of a number below `2^62`.
///
/// `(root + 1/2)^2` is `root^2 + root + 1/4`, so the rest decides.
pub(super) fn root(square: u64) -> i64 {
    let root = square.isqrt();
    let rest = square.wrapping_sub(root.wrapping_mul(root));
    root.wrapping_add(u64::from(rest > root)).cast_signed()
}
