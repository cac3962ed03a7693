//! How much of a step is taken where the volume curves.
//!
//! A tick knows the volume's value and slope, and takes it for straight. Along a step `s` the Lagrangian function, the
//! objective less the multiplier times the volume, curves as `s'Hs - 2 m c`, where `c` is how much more the volume
//! changed than its slope told. Where that is more than twice `s'Hs`, whole steps would go past the goal, further
//! each time. So the part that reaches the minimum, `s'Hs / (s'Hs - 2 m c)`, is what the next tick takes.

use super::config::MOST_ACTUATORS;
use super::descent::{Amplitudes, Problem, clamp, product, scaled};
use super::hold::{Held, Linear, error_shift};
use crate::coord::{round_div, round_shift};

/// Fraction bits of a pace.
const PACE_BITS: u32 = 16;
/// Shorter steps tell nothing of the curvature: it is lost in the rounding of the volume.
const TELLING: u32 = 1 << 17;
/// Bits to which the two sides of the quotient are cut.
const QUOTIENT_BITS: u32 = 46;

/// The part of a step that is taken, with 16 fraction bits: from `2^-12` to 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub(super) struct Pace(u32);

impl Pace {
    /// The whole step.
    pub const WHOLE: Self = Self(1 << PACE_BITS);
    const LEAST: Self = Self(1 << 4);

    /// Shortens the step from `start` to `amplitudes`, and returns how long it was.
    pub fn shorten(self, amplitudes: &mut Amplitudes, start: &Amplitudes) -> u32 {
        let mut longest = 0;
        for (own, &before) in amplitudes.iter_mut().zip(start) {
            longest = longest.max(own.abs_diff(before));
            if self != Self::WHOLE {
                let step = i64::from(*own).wrapping_sub(i64::from(before));
                let short = round_shift(step.wrapping_mul(i64::from(self.0)), PACE_BITS);
                *own = clamp(i64::from(before).wrapping_add(short), -i32::MAX, i32::MAX);
            }
        }
        longest
    }

    /// A quarter: after a step that would have lost the volume.
    pub fn quarter(self) -> Self {
        Self(self.0.wrapping_shr(2).max(Self::LEAST.0))
    }

    /// What the next tick takes after this step, which would have been `longest` long if it had been whole: what the
    /// curvature asks for, but at least half as much and at most twice as much as now.
    ///
    /// # Scaling and overflow
    ///
    /// Products of `H` and the step are at most `2^61`, steps `2^31`: `s'Hs` is at most `2^96`. The multiplier is at
    /// most `2^35`, changes of the volume, in products of slope and amplitude, `2^62`. Both fit 128 bits.
    pub fn next(
        self,
        problem: &Problem<'_, '_>,
        linear: &Linear,
        start: &Amplitudes,
        held: &Held,
        multiplier: i64,
        longest: u32,
    ) -> Self {
        if longest < TELLING {
            return self;
        }
        let mut step = [0; MOST_ACTUATORS];
        let mut greatest = 0;
        for ((own, &now), &before) in step.iter_mut().zip(&held.amplitudes).zip(start) {
            let difference = i64::from(now).wrapping_sub(i64::from(before));
            *own = clamp(difference, -i32::MAX, i32::MAX);
            greatest = greatest.max(own.unsigned_abs());
        }
        let asked = if greatest < TELLING {
            Self::WHOLE.0
        } else {
            let volume = scaled(
                held.volume.wrapping_sub(linear.volume),
                error_shift(linear.shift),
            );
            let more = volume.wrapping_sub(product(&linear.slope, &step));
            let bent = i128::from(multiplier).wrapping_mul(i128::from(more));
            part(curve(problem, &step), bent)
        };
        let most = self.0.wrapping_shl(1).min(Self::WHOLE.0);
        let least = self.0.wrapping_shr(1).max(Self::LEAST.0);
        Self(asked.min(most).max(least))
    }
}

/// `s'Hs`.
fn curve(problem: &Problem<'_, '_>, step: &Amplitudes) -> i128 {
    let mut sum = 0_i128;
    for (place, &own) in (0..problem.inverse.actuators()).zip(step) {
        let force = product(problem.inverse.row(place), step);
        sum = sum.wrapping_add(i128::from(force).wrapping_mul(i128::from(own)));
    }
    sum
}

/// The part of a step that reaches the minimum, with 16 fraction bits, at most 1.
fn part(straight: i128, bent: i128) -> u32 {
    if straight <= 0 || bent >= 0 {
        return Pace::WHOLE.0;
    }
    let whole = straight.wrapping_sub(bent.wrapping_mul(2));
    let bits = 128_u32.wrapping_sub(whole.leading_zeros());
    let shift = bits.saturating_sub(QUOTIENT_BITS);
    let short = |value: i128| i64::try_from(value.wrapping_shr(shift)).unwrap_or_default();
    let part = round_div(short(straight).wrapping_shl(PACE_BITS), short(whole));
    u32::try_from(part).unwrap_or_default()
}
