//! Descends coordinate by coordinate within a box, and steers the linearised volume by one multiplier.

use super::config::{FORCE_LIMIT, Inverse, MOST_ACTUATORS};
use crate::coord::{floor_shift, round_div, round_shift};

/// Fraction bits of `y` beside those of the amplitudes.
pub(super) const ANSWER_BITS: u32 = 20;
/// The multiplier's magnitude is at most this.
pub(super) const MULTIPLIER_LIMIT: i64 = 1 << 35;
/// The magnitudes of the volume's rounded gradient are at most `2^` this.
pub(super) const SLOPE_BITS: i32 = 26;

/// A number for each actuator.
pub(super) type Amplitudes = [i32; MOST_ACTUATORS];

/// What the linearised volume must be.
#[derive(Clone, Copy)]
pub(super) struct Need {
    /// The products of slope and amplitude at the start, added up.
    pub start: i64,
    /// How much these must grow at least.
    pub low: i64,
    /// And at most.
    pub high: i64,
}

/// The problem of a tick: a parabola in a box, with a slab if a volume is asked for.
pub(super) struct Problem<'p, 'a> {
    pub inverse: &'p Inverse<'a>,
    /// `b`, in units of products of `H` and amplitudes.
    pub forces: [i64; MOST_ACTUATORS],
    pub low: Amplitudes,
    pub high: Amplitudes,
    /// The volume's gradient, rounded to at most `2^26`.
    pub slope: Amplitudes,
    pub need: Option<Need>,
}

/// What a sweep did.
#[derive(Clone, Copy, Default)]
pub(super) struct Swept {
    /// The greatest change of an amplitude.
    pub greatest: u32,
    /// The actuators that the box holds back, a bit each.
    pub held: u16,
}

/// What moves from sweep to sweep.
pub(super) struct Point {
    pub amplitudes: Amplitudes,
    pub answer: Amplitudes,
    pub multiplier: i64,
}

impl Problem<'_, '_> {
    /// One sweep over the actuators, and one step of the multiplier.
    pub fn sweep(&self, point: &mut Point) -> Swept {
        let mut swept = Swept::default();
        let parts = &self.inverse.parts;
        let actuators = parts.reciprocals.iter().zip(&self.forces).zip(&self.slope);
        for (((&reciprocal, &force), &slope), place) in actuators.zip(0_usize..) {
            let row = self.inverse.row(place);
            let (Some(&diagonal), Some(&low), Some(&high)) =
                (row.get(place), self.low.get(place), self.high.get(place))
            else {
                break;
            };
            let by_amplitudes = product(row, &point.amplitudes);
            let Some(amplitude) = point.amplitudes.get_mut(place) else {
                break;
            };
            let force = force
                .wrapping_add(point.multiplier.wrapping_mul(i64::from(slope)))
                .wrapping_sub(by_amplitudes);
            let curve = Curve {
                diagonal,
                reciprocal,
            };
            let wanted = i64::from(*amplitude).wrapping_add(curve.divide(force));
            let new = clamp(wanted, low, high);
            // An amplitude on its bound is held by it, however little the force presses.
            let is_free = low < new && new < high;
            swept.greatest = swept.greatest.max(new.abs_diff(*amplitude));
            *amplitude = new;
            if !is_free {
                swept.held |= bit(place);
            }
            let answer = if is_free && self.need.is_some() {
                let force = answered(slope).wrapping_sub(product(row, &point.answer));
                let before = point.answer.get(place).copied().unwrap_or_default();
                let wanted = i64::from(before).wrapping_add(curve.divide(force));
                clamp(wanted, -i32::MAX, i32::MAX)
            } else {
                0
            };
            if let Some(own) = point.answer.get_mut(place) {
                *own = answer;
            }
        }
        if let Some(need) = &self.need {
            let moved = self.steer(need, point);
            swept.greatest = swept.greatest.max(moved);
        }
        swept
    }

    /// Sets the multiplier to where the linearised volume is what it must be, as far as `y` tells, moves the free
    /// amplitudes along, and returns the greatest change.
    fn steer(&self, need: &Need, point: &mut Point) -> u32 {
        let along = self.along(&point.answer);
        let rise = if along > 0 {
            along
        } else {
            // Nothing free to move: only the multiplier grows until an actuator leaves its bound.
            self.along(&self.steepest())
        };
        if rise <= 0 {
            return 0;
        }
        let grown = product(&self.slope, &point.amplitudes).wrapping_sub(need.start);
        let reaching = |edge: i64| {
            let steps = round_div(edge.wrapping_sub(grown), rise);
            point.multiplier.saturating_add(steps)
        };
        let to_low = reaching(need.low);
        let to_high = if need.low == need.high {
            to_low
        } else {
            reaching(need.high)
        };
        // The multiplier pushes only at an edge: up at the lower, down at the upper.
        let target = 0.max(to_low).min(to_high);
        let target = target.clamp(-MULTIPLIER_LIMIT, MULTIPLIER_LIMIT);
        let most = i64::from(i32::MAX);
        let step = target
            .wrapping_sub(point.multiplier)
            .clamp(most.wrapping_neg(), most);
        point.multiplier = point.multiplier.wrapping_add(step);
        let mut greatest = 0;
        let before = point.amplitudes;
        point.amplitudes = self.moved(&before, &point.answer, step);
        for (old, new) in before.iter().zip(&point.amplitudes) {
            greatest = greatest.max(new.abs_diff(*old));
        }
        greatest
    }

    /// How much the linearised volume grows along a direction, for each unit of the multiplier.
    pub fn along(&self, direction: &Amplitudes) -> i64 {
        round_shift(product(&self.slope, direction), ANSWER_BITS)
    }

    /// The answer of each actuator alone.
    pub fn steepest(&self) -> Amplitudes {
        let mut direction = [0; MOST_ACTUATORS];
        let parts = &self.inverse.parts;
        let actuators = parts.reciprocals.iter().zip(&self.slope);
        for ((own, (&reciprocal, &slope)), place) in direction.iter_mut().zip(actuators).zip(0..) {
            let diagonal = self.inverse.row(place).get(place);
            let curve = Curve {
                diagonal: diagonal.copied().unwrap_or_default(),
                reciprocal,
            };
            *own = clamp(curve.divide(answered(slope)), -i32::MAX, i32::MAX);
        }
        direction
    }

    /// The amplitudes, `step` units of the multiplier along a direction, cut to the box.
    pub fn moved(&self, from: &Amplitudes, direction: &Amplitudes, step: i64) -> Amplitudes {
        let mut moved = *from;
        let limits = self.low.iter().zip(&self.high);
        for ((own, &answer), (&low, &high)) in moved.iter_mut().zip(direction).zip(limits) {
            let change = round_shift(step.wrapping_mul(i64::from(answer)), ANSWER_BITS);
            *own = clamp(i64::from(*own).wrapping_add(change), low, high);
        }
        moved
    }
}

/// A diagonal element of `H` with its reciprocal.
struct Curve {
    diagonal: i32,
    reciprocal: i32,
}

impl Curve {
    /// A force divided by the diagonal element, in amplitudes' last places.
    ///
    /// With `2^e <= diagonal < 2^(e+1)` the force is cut to `2^(e+32)`, which is more than twice the range of
    /// amplitudes, and rounded by `2^(e+2)` to at most `2^30`; its product with the reciprocal is at most `2^60`.
    #[inline(always)]
    fn divide(&self, force: i64) -> i64 {
        let exponent = 31_u32.wrapping_sub(self.diagonal.leading_zeros());
        let edge = 1_i32.wrapping_shl(exponent);
        let (high, _) = words(force);
        let short = if high >= edge {
            1 << 30
        } else if high < edge.wrapping_neg() {
            -1 << 30
        } else {
            // In steps whose words are easily shifted: by two, then by the exponent, which is 8 to 30. What is left has
            // 31 bits.
            let half = i64::from(1_u32.wrapping_shl(exponent.wrapping_add(1)));
            let (high, low) = words(floor_shift(force.wrapping_add(half), 2));
            let upper = high.wrapping_shl(32_u32.wrapping_sub(exponent));
            upper | low.wrapping_shr(exponent).cast_signed()
        };
        round_shift(
            i64::from(short).wrapping_mul(i64::from(self.reciprocal)),
            28,
        )
    }
}

/// The high and the low word.
#[inline(always)]
fn words(value: i64) -> (i32, u32) {
    let [a, b, c, d, e, f, g, h] = value.to_le_bytes();
    (
        i32::from_le_bytes([e, f, g, h]),
        u32::from_le_bytes([a, b, c, d]),
    )
}

/// The slope as a force on `y`.
#[inline(always)]
fn answered(slope: i32) -> i64 {
    i64::from(slope).wrapping_shl(ANSWER_BITS)
}

/// The sum of products of a row with amplitudes.
#[inline(never)]
pub(super) fn product(row: &[i32], amplitudes: &[i32]) -> i64 {
    // Of the most actuators, without a loop.
    if let (Ok(row), Ok(amplitudes)) = (
        <&Amplitudes>::try_from(row),
        <&Amplitudes>::try_from(amplitudes),
    ) {
        return sum_of_products(row, amplitudes);
    }
    sum_of_products(row, amplitudes)
}

#[inline(always)]
fn sum_of_products(row: &[i32], amplitudes: &[i32]) -> i64 {
    let mut sum = 0_i64;
    for (&element, &amplitude) in row.iter().zip(amplitudes) {
        sum = sum.wrapping_add(i64::from(element).wrapping_mul(i64::from(amplitude)));
    }
    sum
}

/// A value cut to a range, which then fits 32 bits.
#[inline(always)]
pub(super) fn clamp(value: i64, low: i32, high: i32) -> i32 {
    match i32::try_from(value) {
        Ok(value) => value.max(low).min(high),
        Err(_) if value < 0 => low,
        Err(_) => high,
    }
}

/// A value times `2^shift`, rounded if the shift is negative, and cut to [`FORCE_LIMIT`]. The shift is from -62 to 62.
pub(super) fn scaled(value: i64, shift: i32) -> i64 {
    let places = shift.unsigned_abs();
    if shift > 0 {
        let limit = FORCE_LIMIT.wrapping_shr(places);
        return value
            .clamp(limit.wrapping_neg(), limit)
            .wrapping_shl(places);
    }
    let value = value.clamp(FORCE_LIMIT.wrapping_mul(-2), FORCE_LIMIT.wrapping_mul(2));
    let value = match places {
        0 => value,
        _ => round_shift(value, places),
    };
    value.clamp(-FORCE_LIMIT, FORCE_LIMIT)
}

fn bit(place: usize) -> u16 {
    1_u16.wrapping_shl(u32::try_from(place).unwrap_or_default())
}
