//! What points cannot enter.

use super::length::{Length, length, root, shortened, square};
use super::{FACTOR_BITS, FACTOR_ONE, STATE_BITS};
use crate::coord::{Coordinate, round_div, round_shift};

/// The square of a normal's length may differ from `2^32` by this; rounding changes it by less.
const NORMAL_TOLERANCE: u64 = 1 << 17;

/// What points cannot enter, and how it holds what slides along it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Obstacle<C> {
    /// Its form and place.
    pub shape: Shape<C>,
    /// The part of the velocity along the surface that a point loses in a substep, 16 fraction bits, at
    /// most one.
    pub grip: u32,
}

/// The form and place of an obstacle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Shape<C> {
    /// Everything behind a plane.
    Plane {
        /// A point of the plane.
        point: [C; 3],
        /// The unit vector out of what cannot be entered, with 16 fraction bits.
        normal: [i32; 3],
    },
    /// A ball.
    Sphere {
        /// Its centre.
        centre: [C; 3],
        /// Its radius, raw bits of a coordinate.
        radius: u32,
    },
    /// Everything within a distance of a segment.
    Capsule {
        /// The ends of the segment.
        ends: [[C; 3]; 2],
        /// The distance, raw bits of a coordinate.
        radius: u32,
    },
}

/// How a point is inside an obstacle: it has to go `depth` along `normal` (16 fraction bits).
#[derive(Clone, Copy, Debug)]
pub(super) struct Contact {
    pub normal: [i64; 3],
    pub depth: i64,
}

impl<C: Coordinate> Obstacle<C> {
    pub(super) fn is_sound(&self) -> bool {
        let normal = match self.shape {
            Shape::Plane { normal, .. } => normal,
            Shape::Sphere { .. } | Shape::Capsule { .. } => return self.grip <= FACTOR_ONE,
        };
        let one = 1_u64 << (2 * FACTOR_BITS);
        let fits = normal
            .iter()
            .all(|coordinate| coordinate.unsigned_abs() <= 2 * FACTOR_ONE);
        let length = square(normal.map(i64::from));
        self.grip <= FACTOR_ONE && fits && length.abs_diff(one) <= NORMAL_TOLERANCE
    }

    /// How a point is inside, `None` if it is not.
    pub(super) fn contact(&self, position: [i64; 3]) -> Option<Contact> {
        match self.shape {
            Shape::Plane { point, normal } => {
                let normal = normal.map(i64::from);
                let [x, y, z] = difference(position, state_of(point));
                let [a, b, c] = normal;
                let sum = a
                    .wrapping_mul(x)
                    .wrapping_add(b.wrapping_mul(y))
                    .wrapping_add(c.wrapping_mul(z));
                let depth = round_shift(sum, FACTOR_BITS).wrapping_neg();
                (depth > 0).then_some(Contact { normal, depth })
            }
            Shape::Sphere { centre, radius } => ball(position, state_of(centre), radius),
            Shape::Capsule { ends, radius } => {
                let [first, second] = ends.map(state_of);
                let reach = i64::from(radius).wrapping_shl(STATE_BITS);
                let mut places = position.iter().zip(first.iter().zip(&second));
                let near = places.all(|(&at, (&a, &b))| {
                    at >= a.min(b).wrapping_sub(reach) && at <= a.max(b).wrapping_add(reach)
                });
                if !near {
                    return None;
                }
                ball(position, nearest(position, first, second), radius)
            }
        }
    }
}

fn state_of<C: Coordinate>(point: [C; 3]) -> [i64; 3] {
    point.map(|coordinate| i64::from(coordinate.to_bits()).wrapping_shl(STATE_BITS))
}

pub(super) fn difference(a: [i64; 3], b: [i64; 3]) -> [i64; 3] {
    let ([ax, ay, az], [bx, by, bz]) = (a, b);
    [
        ax.wrapping_sub(bx),
        ay.wrapping_sub(by),
        az.wrapping_sub(bz),
    ]
}

/// A ball of this radius about a centre: the point goes out along the line from the centre, up (along z)
/// from the centre itself.
///
/// The radius is shortened as a vector is, the difference by the same shift.
fn ball(position: [i64; 3], centre: [i64; 3], radius: u32) -> Option<Contact> {
    let radius = i64::from(radius).wrapping_shl(STATE_BITS);
    let from = difference(position, centre);
    let reach = radius.unsigned_abs();
    if from
        .iter()
        .any(|coordinate| coordinate.unsigned_abs() >= reach)
    {
        return None;
    }
    let Length {
        shift,
        length: radius,
        ..
    } = length([radius, 0, 0]);
    let from = shortened(from, shift);
    let distance = root(square(from));
    if distance >= radius {
        return None;
    }
    let normal = if distance == 0 {
        [0, 0, i64::from(FACTOR_ONE)]
    } else {
        from.map(|coordinate| round_div(coordinate.wrapping_shl(FACTOR_BITS), distance))
    };
    let depth = radius.wrapping_sub(distance).wrapping_shl(shift);
    Some(Contact { normal, depth })
}

/// The point of a segment that is nearest to a position. How far along the segment it lies is a multiple of
/// `2^-16`, from sums of products of vectors that are shortened together; their quotient is taken from the
/// upper 46 bits.
fn nearest(position: [i64; 3], first: [i64; 3], second: [i64; 3]) -> [i64; 3] {
    let (along, to) = (difference(second, first), difference(position, first));
    let shift = length(along).shift.max(length(to).shift);
    let (short, [tx, ty, tz]) = (shortened(along, shift), shortened(to, shift));
    let [sx, sy, sz] = short;
    let dot = sx
        .wrapping_mul(tx)
        .wrapping_add(sy.wrapping_mul(ty))
        .wrapping_add(sz.wrapping_mul(tz));
    let whole = square(short).cast_signed();
    if dot <= 0 {
        return first;
    }
    if dot >= whole {
        return second;
    }
    let bits = u64::BITS.wrapping_sub(whole.leading_zeros());
    let excess = bits.saturating_sub(46);
    let (dot, whole) = (dot.wrapping_shr(excess), whole.wrapping_shr(excess));
    let part = round_div(dot.wrapping_shl(FACTOR_BITS), whole);
    let ([x, y, z], [ax, ay, az]) = (along, first);
    let place =
        |a: i64, along: i64| a.wrapping_add(round_shift(along.wrapping_mul(part), FACTOR_BITS));
    [place(ax, x), place(ay, y), place(az, z)]
}
