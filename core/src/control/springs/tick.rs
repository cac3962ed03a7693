//! One tick: what the module's contract says, step by step.

use super::length::{Length, length};
use super::obstacle::difference;
use super::state::{PointState, limited};
use super::{Drive, FACTOR_BITS, FACTOR_ONE, STATE_BITS, Spring, SpringsParts};
use crate::coord::{Coordinate, round_div, round_shift};

/// Fraction bits of a quotient of lengths.
const QUOTIENT_BITS: u32 = 30;
const QUOTIENT_ONE: i64 = 1 << QUOTIENT_BITS;

/// All substeps. Returns how many coordinates of positions were clamped.
pub(super) fn run<C: Coordinate>(
    parts: &SpringsParts<'_>,
    drive: &Drive<'_, C>,
    state: &mut [PointState],
) -> u32 {
    let goals = C::bits_of(drive.goals);
    let mut clamped = 0_u32;
    for left in (1..=parts.substeps).rev() {
        let counts = [
            advance(parts, goals, drive.pushes, i64::from(left), state),
            satisfy(parts.springs, goals, state),
            hold(parts, goals, state),
            touch(parts, drive, state),
        ];
        for count in counts {
            clamped = clamped.saturating_add(count);
        }
        damp(parts, state);
    }
    clamped
}

/// A factor of a vector, rounded.
fn part_of(vector: [i64; 3], factor: u32) -> [i64; 3] {
    let factor = i64::from(factor);
    vector.map(|coordinate| round_shift(coordinate.wrapping_mul(factor), FACTOR_BITS))
}

fn negated(vector: [i64; 3]) -> [i64; 3] {
    vector.map(i64::wrapping_neg)
}

fn place_of(goal: [i32; 3]) -> [i64; 3] {
    goal.map(|coordinate| i64::from(coordinate).wrapping_shl(STATE_BITS))
}

/// Moves the points.
fn advance(
    parts: &SpringsParts<'_>,
    goals: &[[i32; 3]],
    pushes: &[[i32; 3]],
    left: i64,
    state: &mut [PointState],
) -> u32 {
    let mut clamped = 0_u32;
    let mut pushes = pushes.iter();
    for ((point, data), goal) in state.iter_mut().zip(parts.points).zip(goals) {
        let push = pushes.next().copied().unwrap_or_default();
        if data.mobility == 0 {
            let way = difference(place_of(*goal), point.position);
            point.velocity = [0; 3];
            clamped = clamped.wrapping_add(point.shift(way.map(|way| round_div(way, left))));
            continue;
        }
        let velocity = point.velocity.map(|velocity| slowed(velocity, parts.drag));
        point.velocity = [0; 3];
        let push = part_of(
            push.map(|push| i64::from(push).wrapping_shl(parts.push_shift)),
            data.mobility,
        );
        let mut change = [0; 3];
        let gains = velocity.iter().zip(parts.gravity.iter().zip(&push));
        for (slot, (velocity, (gravity, push))) in change.iter_mut().zip(gains) {
            *slot = limited(velocity.wrapping_add(*gravity).wrapping_add(*push));
        }
        clamped = clamped.wrapping_add(point.shift(change));
    }
    clamped
}

/// A velocity less what drag takes, at least one unit of what there is.
fn slowed(velocity: i64, drag: u32) -> i64 {
    let magnitude = velocity.wrapping_abs();
    let loss = round_shift(magnitude.wrapping_mul(i64::from(drag)), FACTOR_BITS);
    let kept = magnitude.wrapping_sub(loss.max(1)).max(0);
    kept.wrapping_mul(velocity.signum())
}

/// The springs, one after the other.
fn satisfy(springs: &[Spring], goals: &[[i32; 3]], state: &mut [PointState]) -> u32 {
    let mut clamped = 0_u32;
    for spring in springs {
        let [first, second] = spring.points.map(usize::from);
        // Never missing: springs and lengths were checked.
        let (Some(a), Some(b)) = (state.get(first), state.get(second)) else {
            continue;
        };
        let (Some(goal_a), Some(goal_b)) = (goals.get(first), goals.get(second)) else {
            continue;
        };
        let apart = difference(a.position, b.position);
        let goal = difference(place_of(*goal_a), place_of(*goal_b));
        let change = excess(spring, apart, difference(apart, goal));
        let own = part_of(change, spring.share);
        if let Some(point) = state.get_mut(first) {
            clamped = clamped.wrapping_add(point.shift(negated(own)));
        }
        if let Some(point) = state.get_mut(second) {
            clamped = clamped.wrapping_add(point.shift(difference(change, own)));
        }
    }
    clamped
}

/// What the difference of a spring's ends has to lose: `apart` is that difference, `off` how far it is
/// from its goal.
fn excess(spring: &Spring, apart: [i64; 3], off: [i64; 3]) -> [i64; 3] {
    let Length {
        shift,
        vector,
        length,
    } = length(apart);
    if length == 0 {
        return part_of(off, spring.stretch.wrapping_add(spring.shape));
    }
    let rest = i64::from(spring.length);
    let rest = match shift.checked_sub(spring.length_shift) {
        Some(0) => rest,
        Some(more) => round_shift(rest, more),
        None => rest.wrapping_shl(spring.length_shift.wrapping_sub(shift)),
    };
    let twice = length.wrapping_mul(2);
    let quotient = if rest >= twice {
        2 * QUOTIENT_ONE
    } else {
        round_div(rest.wrapping_shl(QUOTIENT_BITS), length)
    };
    let too_long = QUOTIENT_ONE.wrapping_sub(quotient);
    let (stretch, shape) = (i64::from(spring.stretch), i64::from(spring.shape));
    let mut change = [0; 3];
    for (slot, (along, off)) in change.iter_mut().zip(vector.iter().zip(off)) {
        // The shift is at most 15.
        let along = round_shift(
            along.wrapping_mul(too_long),
            QUOTIENT_BITS.wrapping_sub(shift),
        );
        let sum = stretch
            .wrapping_mul(along)
            .wrapping_add(shape.wrapping_mul(off));
        *slot = round_shift(sum, FACTOR_BITS);
    }
    change
}

/// The anchors.
fn hold(parts: &SpringsParts<'_>, goals: &[[i32; 3]], state: &mut [PointState]) -> u32 {
    let mut clamped = 0_u32;
    for ((point, data), goal) in state.iter_mut().zip(parts.points).zip(goals) {
        if data.anchor != 0 && data.mobility != 0 {
            let way = difference(place_of(*goal), point.position);
            clamped = clamped.wrapping_add(point.shift(part_of(way, data.anchor)));
        }
    }
    clamped
}

/// The contacts.
fn touch<C: Coordinate>(
    parts: &SpringsParts<'_>,
    drive: &Drive<'_, C>,
    state: &mut [PointState],
) -> u32 {
    let mut clamped = 0_u32;
    for (point, data) in state.iter_mut().zip(parts.points) {
        if data.mobility == 0 {
            continue;
        }
        for obstacle in drive.obstacles {
            let Some(contact) = obstacle.contact(point.position) else {
                continue;
            };
            let along = |amount: i64| {
                contact
                    .normal
                    .map(|normal| round_shift(normal.wrapping_mul(amount), FACTOR_BITS))
            };
            clamped = clamped.wrapping_add(point.shift(along(contact.depth)));
            let ([a, b, c], [x, y, z]) = (contact.normal, point.velocity);
            let sum = a
                .wrapping_mul(x)
                .wrapping_add(b.wrapping_mul(y))
                .wrapping_add(c.wrapping_mul(z));
            let across = along(round_shift(sum, FACTOR_BITS));
            let sliding = difference(point.velocity, across);
            clamped = clamped.wrapping_add(point.shift(negated(part_of(sliding, obstacle.grip))));
        }
    }
    clamped
}

/// The damping.
fn damp(parts: &SpringsParts<'_>, state: &mut [PointState]) {
    if parts.damping == 0 {
        return;
    }
    for spring in parts.springs {
        let [first, second] = spring.points.map(usize::from);
        let (Some(a), Some(b)) = (state.get(first), state.get(second)) else {
            continue;
        };
        let change = part_of(difference(a.velocity, b.velocity), parts.damping);
        let own = part_of(change, spring.share);
        if let Some(point) = state.get_mut(first) {
            point.hurry(negated(own));
        }
        if let Some(point) = state.get_mut(second) {
            point.hurry(difference(change, own));
        }
    }
}

const _: () = assert!(
    FACTOR_ONE == 1 << 16,
    "the proof of the module takes 16 bits"
);
