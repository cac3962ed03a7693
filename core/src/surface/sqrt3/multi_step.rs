//! A vertex's position any number of steps on, from its ring, as one mask: the paper's (7) and (8).
//!
//! A smooth vertex `p` of valence `n` with the ring mean `q` is, `m` steps on,
//! `(1 - beta_n(m)) p + beta_n(m) q` with
//! `beta_n(m) = (3 alpha - 3 alpha (2/3 - alpha)^m) / (1 + 3 alpha)`, and in the limit
//! `beta_n = 3 alpha / (1 + 3 alpha)`; or, from the stored `p` and limit `l`,
//! `gamma_n(m) p + (1 - gamma_n(m)) l` with `gamma_n(m) = (2/3 - alpha)^m`.
//!
//! # How far this is from level by level
//!
//! These kernels round once where level by level rounds at each of the `m` steps. All weights of
//! both are positive and add up to one, so an error of a step is never magnified: level by level
//! is within `m / 2` units of the exact value of its weights, the kernel within `1/2`. Rounding an
//! irrational `alpha_n / n` to 2^-30 moves a step by at most `n 2^-31` times the greatest distance
//! `d` between two of the vertex and its ring, and `beta` and `gamma` likewise. So the results of
//! [`ring_position`] and of `m` steps differ by at most
//! `(m + 1) (1/2 + n 2^-31 (d + 1))` units for each coordinate. [`between`] starts from a limit that
//! was itself rounded, which adds at most another half and another `n 2^-31 (d + 1)`.

use super::weights::{alpha, ninths};
use crate::blend::{Blend, NeighbourWeight};
use crate::surface::irrational::irrational;

/// How far on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Steps {
    /// A number of steps.
    Count(u32),
    /// Infinitely many.
    Limit,
}

/// Greatest denominator of a weight that stays an exact fraction.
const EXACT_MAXIMUM: i64 = 1 << 30;

/// The weight of each ring vertex in (7), `beta_n(m) / n`: exact if `alpha_n` is rational and the
/// reduced denominator is at most 2^30, else the real number rounded to a multiple of 2^-30. A
/// valence of 0 gives weight 0.
#[must_use]
pub fn ring_weight(valence: u32, steps: Steps) -> NeighbourWeight {
    if valence == 0 {
        return NeighbourWeight::Exact {
            numerator: 0,
            denominator: 1,
        };
    }
    exact_ring_weight(valence, steps).unwrap_or_else(|| real_ring_weight(valence, steps))
}

/// With `a = 9 alpha`: `beta = a (9^m - (6 - a)^m) / ((3 + a) 9^m)`.
fn exact_ring_weight(valence: u32, steps: Steps) -> Option<NeighbourWeight> {
    let a = ninths(valence)?;
    let (numerator, power) = match steps {
        // At valence 2 the base of the powers is zero: one step reaches the limit, and no power of
        // 9 may stand in the way of that short fraction.
        Steps::Count(count) if count == 0 || a != 6 => {
            let power = 9_i64.checked_pow(count)?;
            let rest = 6_i64.checked_sub(a)?.checked_pow(count)?;
            (a.checked_mul(power.checked_sub(rest)?)?, power)
        }
        Steps::Count(_) | Steps::Limit => (a, 1),
    };
    let denominator = a
        .checked_add(3)?
        .checked_mul(power)?
        .checked_mul(i64::from(valence))?;
    exact(numerator, denominator)
}

/// The reduced fraction, if its denominator is small enough.
fn exact(numerator: i64, denominator: i64) -> Option<NeighbourWeight> {
    let (mut a, mut b) = (denominator, numerator);
    while b != 0 {
        (a, b) = (b, a.checked_rem(b)?);
    }
    let denominator = denominator.checked_div(a)?;
    (denominator <= EXACT_MAXIMUM).then_some(NeighbourWeight::Exact {
        numerator: numerator.checked_div(a)?,
        denominator,
    })
}

#[expect(
    clippy::float_arithmetic,
    reason = "an irrational weight is made in double precision, once for its valence and level"
)]
fn real_ring_weight(valence: u32, steps: Steps) -> NeighbourWeight {
    let alpha = alpha(valence);
    let rest = match steps {
        Steps::Count(count) => power(2.0 / 3.0 - alpha, count),
        Steps::Limit => 0.0,
    };
    let beta = 3.0 * alpha * (1.0 - rest) / (1.0 + 3.0 * alpha);
    let (bits, real) = irrational(beta / f64::from(valence));
    NeighbourWeight::Irrational { bits, real }
}

/// `gamma_n(m)`, the weight of the vertex itself beside its limit in (8).
#[must_use]
#[expect(
    clippy::float_arithmetic,
    reason = "an irrational weight is made in double precision, once for its valence and level"
)]
pub fn own_weight(valence: u32, steps: u32) -> NeighbourWeight {
    let fraction = || {
        let rest = 6_i64.checked_sub(ninths(valence)?)?.checked_pow(steps)?;
        exact(rest, 9_i64.checked_pow(steps)?)
    };
    fraction().unwrap_or_else(|| {
        let (bits, real) = irrational(power(2.0 / 3.0 - alpha(valence), steps));
        NeighbourWeight::Irrational { bits, real }
    })
}

/// A power of a number below 1 by repeated squaring, the same on every machine.
#[expect(
    clippy::float_arithmetic,
    reason = "an irrational weight is made in double precision, once for its valence and level"
)]
fn power(base: f64, exponent: u32) -> f64 {
    let (mut result, mut square, mut rest) = (1.0, base, exponent);
    while rest > 0 {
        if rest & 1 == 1 {
            result *= square;
        }
        square *= square;
        rest >>= 1;
    }
    result
}

/// (7): the vertex `own` with this ring, `steps` on, rounded once. A vertex without a ring stays.
pub fn ring_position<B: Blend>(
    blend: &mut B,
    own: &B::Point,
    ring: &[B::Point],
    steps: Steps,
) -> B::Point {
    let mut sum = blend.zero();
    for point in ring {
        blend.add(&mut sum, 1, point);
    }
    let valence = u32::try_from(ring.len()).unwrap_or(u32::MAX);
    blend.umbrella(own, &sum, i64::from(valence), ring_weight(valence, steps))
}

/// (8): the vertex `own` of this valence with its limit, `steps` on, rounded once.
pub fn between<B: Blend>(
    blend: &mut B,
    own: &B::Point,
    limit: &B::Point,
    valence: u32,
    steps: u32,
) -> B::Point {
    let mut sum = blend.zero();
    blend.add(&mut sum, 1, own);
    blend.umbrella(limit, &sum, 1, own_weight(valence, steps))
}
