//! The square-root-3 scheme's (7) and (8): a vertex any number of steps on, as one mask.
//!
//! Weights of rational `alpha_n` are powers of exact fractions, reduced; where the reduced
//! denominator is above 2^30, and where `alpha_n` is irrational, one ring vertex's weight (or the
//! vertex's own beside its limit) is rounded to a multiple of 2^-30.

use num_bigint::BigInt;
use num_rational::BigRational;
use num_traits::{One as _, ToPrimitive as _};

use super::row::{Row, WEIGHT_UNIT};

/// `alpha_n` where it is rational.
fn rational_alpha(valence: u32) -> Option<BigRational> {
    // 4 - 2 cos(2 pi / n) is 2, 6, 5, 4 and 3.
    let ninths = match valence {
        1 => 2,
        2 => 6,
        3 => 5,
        4 => 4,
        6 => 3,
        _ => return None,
    };
    Some(BigRational::new(ninths.into(), 9.into()))
}

fn real_alpha(valence: u32) -> f64 {
    (4.0 - 2.0 * (std::f64::consts::TAU / f64::from(valence)).cos()) / 9.0
}

/// A weight as numerator and denominator, both integers.
type Weight = (f64, f64);

fn rational_weight(weight: &BigRational) -> Weight {
    let unit = BigInt::from(1 << 30);
    let number = |integer: &BigInt| integer.to_f64().unwrap_or(f64::NAN);
    if *weight.denom() <= unit {
        return (number(weight.numer()), number(weight.denom()));
    }
    let half = BigRational::new(1.into(), 2.into());
    let rounded = (weight * BigRational::from(unit) + half).floor();
    (number(rounded.numer()), WEIGHT_UNIT)
}

fn real_weight(weight: f64) -> Weight {
    ((weight * WEIGHT_UNIT + 0.5).floor(), WEIGHT_UNIT)
}

/// (7): the mask of a vertex, 0, over itself and its ring, 1 to `valence`; `steps` on, or in the
/// limit.
pub fn after_steps(valence: u32, steps: Option<u32>) -> Row {
    if valence == 0 {
        return Row::vertex(0);
    }
    let (numerator, denominator) = match rational_alpha(valence) {
        Some(alpha) => {
            let three = BigRational::from(BigInt::from(3)) * &alpha;
            let rest = match steps {
                Some(steps) => shrink(&alpha, steps),
                None => BigRational::from(BigInt::from(0)),
            };
            let one = BigRational::one();
            let beta = &three * (&one - rest) / (&one + &three);
            rational_weight(&(beta / BigRational::from(BigInt::from(valence))))
        }
        None => {
            let alpha = real_alpha(valence);
            let rest = steps.map_or(0.0, |steps| real_shrink(alpha, steps));
            let beta = 3.0 * alpha * (1.0 - rest) / (1.0 + 3.0 * alpha);
            real_weight(beta / f64::from(valence))
        }
    };
    let own = denominator - f64::from(valence) * numerator;
    let ring = (1..=valence).map(|vertex| (vertex, numerator));
    Row {
        entries: std::iter::once((0, own)).chain(ring).collect(),
        denominator,
    }
}

/// (8): the mask of a vertex, 0, over itself and its limit, 1.
pub fn beside_limit(valence: u32, steps: u32) -> Row {
    let (own, denominator) = match rational_alpha(valence) {
        Some(alpha) => rational_weight(&shrink(&alpha, steps)),
        None => real_weight(real_shrink(real_alpha(valence), steps)),
    };
    Row {
        entries: [(0, own), (1, denominator - own)].into(),
        denominator,
    }
}

/// `(2/3 - alpha)^steps`.
fn shrink(alpha: &BigRational, steps: u32) -> BigRational {
    let base = BigRational::new(2.into(), 3.into()) - alpha;
    let steps = i32::try_from(steps).expect("a modest number of steps");
    base.pow(steps)
}

fn real_shrink(alpha: f64, steps: u32) -> f64 {
    (2.0 / 3.0 - alpha).powf(f64::from(steps))
}
