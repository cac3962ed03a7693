//! The weights of the modified scheme around a vertex.

use crate::blend::IrrationalWeight;
use crate::surface::irrational::{cosine, irrational};

/// Denominator of the exact stencils: a common one for the valences 2, 3 and 4.
pub(super) const EXACT_DENOMINATOR: i64 = 24;

/// The exact weight of a ring vertex `place` edges away from the edge (with its mirror image), in
/// 24ths.
pub(super) const fn exact(valence: u32, place: u32) -> Option<i64> {
    match (valence, place) {
        (2, 0) => Some(21),
        (2, _) => Some(-3),
        (3, 0) => Some(10),
        (3, _) => Some(-2),
        (4, 0) => Some(9),
        (4, 2) => Some(-3),
        (4, _) => Some(0),
        _ => None,
    }
}

/// The weight in units of 2^-30.
#[expect(
    clippy::float_arithmetic,
    clippy::as_conversions,
    clippy::cast_precision_loss,
    reason = "an irrational weight is made in double precision, once for its place; exact ones are \
              small integers"
)]
pub(super) fn rounded(valence: u32, place: u32) -> IrrationalWeight {
    let real = match exact(valence, place) {
        Some(weight) => weight as f64 / EXACT_DENOMINATOR as f64,
        None => {
            let twice = place.wrapping_mul(2);
            (0.25 + cosine(place, valence) + 0.5 * cosine(twice, valence)) / f64::from(valence)
        }
    };
    let (bits, real) = irrational(real);
    IrrationalWeight { bits, real }
}

/// `one - other`.
#[expect(
    clippy::float_arithmetic,
    reason = "a weight in double precision, for value types of real numbers"
)]
pub(super) fn less(one: IrrationalWeight, other: IrrationalWeight) -> IrrationalWeight {
    IrrationalWeight {
        bits: one.bits.wrapping_sub(other.bits),
        real: one.real - other.real,
    }
}
