//! The multiplier of one region, while those of the others stay.

use super::limits::LimitsParts;
use crate::coord::{round_div_wide, round_shift};

/// A multiplier's greatest magnitude: `2^38`, with 8 bits behind the point.
pub const MULTIPLIER_LIMIT: i64 = 1 << 38;

/// Trials of a search at most.
pub const TRIALS: u32 = 24;

/// Bits behind the point of a multiplier.
const MULTIPLIER_BITS: u32 = 8;

/// Every so many trials the bounds are halved, whatever Newton's method says.
const HALVE_EVERY: u32 = 4;

/// The linearised problem, but for the multipliers.
pub(super) struct Problem<'a> {
    pub limits: &'a LimitsParts<'a>,
    pub goal: &'a [[i32; 3]],
    pub lower: &'a [[i32; 3]],
    pub upper: &'a [[i32; 3]],
    pub current: &'a [[i32; 3]],
    /// Bits of the reduced gradients: at most 22.
    pub bits: u32,
}

/// A region's part of the linearised problem.
pub(super) struct Slope<'a> {
    pub points: &'a [u16],
    pub gradient: &'a [[i32; 3]],
    /// What the linear volume shall change by, at least and at most, in units of the reduced gradient: at most
    /// `2^61` in magnitude.
    pub least: i64,
    pub greatest: i64,
}

/// `round(mobility * gradient / 2^15)`.
fn direction(mobility: u16, gradient: i32) -> i64 {
    round_shift(i64::from(mobility).wrapping_mul(i64::from(gradient)), 15)
}

impl Problem<'_> {
    /// Where the forces move a coordinate to, before it is clamped.
    pub(super) fn moved(&self, goal: i32, force: i64) -> i64 {
        let shift = self.bits.wrapping_add(MULTIPLIER_BITS);
        i64::from(goal).wrapping_add(round_shift(force, shift))
    }

    /// Adds `change` of a region's multiplier to the forces.
    pub(super) fn push(&self, slope: &Slope<'_>, change: i64, forces: &mut [[i64; 3]]) {
        for (&point, &gradient) in slope.points.iter().zip(slope.gradient) {
            let point = usize::from(point);
            let (Some(force), Some(&mobility)) =
                (forces.get_mut(point), self.limits.mobilities.get(point))
            else {
                break;
            };
            for (force, gradient) in force.iter_mut().zip(gradient) {
                let direction = direction(mobility, gradient);
                *force = force.wrapping_add(change.wrapping_mul(direction));
            }
        }
    }

    /// How the linear volume changes if the multiplier changes, and its derivative by the multiplier in units of
    /// `2^(bits + 8)`.
    fn change(&self, slope: &Slope<'_>, change: i64, forces: &[[i64; 3]]) -> (i64, i64) {
        let (mut value, mut rise) = (0_i64, 0_i64);
        for (&point, &gradient) in slope.points.iter().zip(slope.gradient) {
            let point = usize::from(point);
            let (Some(force), Some(&mobility), Some(goal), Some(lower), Some(upper), Some(current)) = (
                forces.get(point),
                self.limits.mobilities.get(point),
                self.goal.get(point),
                self.lower.get(point),
                self.upper.get(point),
                self.current.get(point),
            ) else {
                break;
            };
            let axes = force
                .iter()
                .zip(gradient)
                .zip(goal)
                .zip(lower.iter().zip(upper))
                .zip(current);
            for ((((&force, gradient), &goal), (&lower, &upper)), &current) in axes {
                let direction = direction(mobility, gradient);
                let force = force.wrapping_add(change.wrapping_mul(direction));
                let free = self.moved(goal, force);
                let (lower, upper) = (i64::from(lower), i64::from(upper));
                let position = free.min(upper).max(lower);
                let gradient = i64::from(gradient);
                let difference = position.wrapping_sub(i64::from(current));
                value = value.wrapping_add(gradient.wrapping_mul(difference));
                if lower < free && free < upper {
                    rise = rise.wrapping_add(gradient.wrapping_mul(direction));
                }
            }
        }
        (value, rise)
    }

    /// The multiplier of a region, from the one before, whose part the forces hold.
    pub(super) fn multiplier(&self, slope: &Slope<'_>, before: i64, forces: &[[i64; 3]]) -> i64 {
        let at = |multiplier: i64| self.change(slope, multiplier.wrapping_sub(before), forces);
        let (without, rise) = at(0);
        let (target, mut lower, mut upper) = if without < slope.least {
            (slope.least, 0, MULTIPLIER_LIMIT)
        } else if without > slope.greatest {
            (slope.greatest, MULTIPLIER_LIMIT.wrapping_neg(), 0)
        } else {
            return 0;
        };
        let mut best = Trial {
            multiplier: 0,
            residual: target.wrapping_sub(without),
        };
        let mut next = if lower < before && before < upper {
            before
        } else {
            self.newton(0, best.residual, rise)
        };
        for trial in 0..TRIALS {
            if next <= lower || next >= upper || trial % HALVE_EVERY == HALVE_EVERY - 1 {
                next = middle(lower, upper);
            }
            if next <= lower || next >= upper {
                break;
            }
            let (value, rise) = at(next);
            let residual = target.wrapping_sub(value);
            if residual.unsigned_abs() < best.residual.unsigned_abs() {
                best = Trial {
                    multiplier: next,
                    residual,
                };
            }
            if residual == 0 {
                break;
            }
            if residual > 0 {
                lower = next;
            } else {
                upper = next;
            }
            let newton = self.newton(next, residual, rise);
            if rise > 0 && newton == next {
                break;
            }
            next = newton;
        }
        best.multiplier
    }

    /// Newton's next multiplier; one that lies in no bounds if there is no slope.
    fn newton(&self, multiplier: i64, residual: i64, rise: i64) -> i64 {
        if rise <= 0 {
            return i64::MAX;
        }
        let shift = self.bits.wrapping_add(MULTIPLIER_BITS);
        let numerator = i128::from(residual).wrapping_shl(shift);
        let step = round_div_wide(numerator, i128::from(rise));
        let next = i128::from(multiplier).wrapping_add(step);
        i64::try_from(next).unwrap_or(i64::MAX)
    }
}

/// A multiplier and how much of the linear volume's change it lacks.
struct Trial {
    multiplier: i64,
    residual: i64,
}

/// A multiplier between bounds that are of one sign or zero: a power of two about half way between their logarithms while
/// they are far apart, else their middle. One of the bounds if there is none between.
fn middle(lower: i64, upper: i64) -> i64 {
    let (a, b) = (lower.unsigned_abs(), upper.unsigned_abs());
    let (near, far) = (a.min(b), a.max(b));
    let bits = |magnitude: u64| u64::BITS.wrapping_sub(magnitude.leading_zeros());
    let (near_bits, far_bits) = (bits(near), bits(far));
    if far_bits > near_bits.wrapping_add(2) {
        let between = 1_i64.wrapping_shl(near_bits.wrapping_add(far_bits).wrapping_shr(1));
        return if upper > 0 {
            between
        } else {
            between.wrapping_neg()
        };
    }
    lower.wrapping_add(upper.wrapping_sub(lower).wrapping_shr(1))
}
