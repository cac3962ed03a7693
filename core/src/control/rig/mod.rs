//! A skeleton that carries control points (Hakenberg's thesis moves 204 control points by 31 joints so).
//!
//! A [`Joint`] turns about an axis through its pivot, and with it everything that its children carry. A
//! control point follows one joint, or several with weights that add up to one. A ball joint is three
//! joints with one pivot. An angle is a 32-bit number, `2^32` to a full turn, so that every value is an
//! angle and an encoder that wraps needs no care.
//!
//! # The contract
//!
//! 1. Sine and cosine of an angle are those of [`turn`], multiples of `2^-30`.
//! 2. The rotation of a joint by the angle with cosine `c` and sine `s` about the axis `a` has the entries
//!    `c [i = j] + t_i a_j + s [a]_ij`, exact and rounded once to `2^-30`, where `t_i = (1 - c) a_i` is
//!    rounded to `2^-30` and `[a]` is the matrix of the cross product by `a`. A fixed joint has none.
//! 3. In space its rotation is its parent's times its own, each entry exact and rounded once to `2^-30`.
//! 4. Its pivot is its parent's pivot plus the parent's rotation of the difference of both pivots at rest;
//!    that product is exact and rounded once to `2^-8` of a coordinate's last place. A joint without a
//!    parent stands where it stood at rest, plus the base.
//! 5. A control point is the sum, over its joints, of weight times (pivot plus rotation of the point's
//!    place at rest less the pivot at rest, rounded to `2^-8`), exact, rounded once to the last place.
//!
//! So angles of zero give the rest cage to the bit. All rotations are made from the angles on every tick:
//! nothing is carried over, nothing drifts. Only differences of rest positions are rotated, so moving the
//! base, or the whole rig at rest, by whole units moves every control point by these units, to the bit.
//!
//! # Example
//!
//! A shoulder and an elbow that turn about z carry a hand; bundles hold such a rig ready-made
//! ([`Bundle::rig`](crate::bundle::Bundle::rig)).
//!
//! ```
//! use octruss::control::rig::{
//!     Frame, Influence, Joint, NO_PARENT, QUARTER_TURN, Rig, RigError, RigParts, WEIGHT_ONE,
//! };
//!
//! # fn main() -> Result<(), RigError> {
//! let axis = [0, 0, 1 << 30];
//! let joints = [
//!     Joint { parent: NO_PARENT, pivot: [0, 0, 0], axis },
//!     Joint { parent: 0, pivot: [100, 0, 0], axis },
//! ];
//! let rig = Rig::new_checked(RigParts {
//!     joints: &joints,
//!     rest: &[[150, 0, 0]],
//!     starts: &[0, 1],
//!     influences: &[Influence { joint: 1, weight: WEIGHT_ONE }],
//! })?;
//! let (mut frames, mut pose) = ([Frame::default(); 2], [[0_i32; 3]]);
//! rig.carry(&[QUARTER_TURN, -QUARTER_TURN], [0, 0, 7], &mut frames, &mut pose)?;
//! assert_eq!(pose, [[50, 100, 7]]);
//! # Ok(())
//! # }
//! ```
//!
//! # Scaling and overflow
//!
//! An axis has unit length within `2^-30`, so a joint's own rotation is a rotation within `2^-26` (in the
//! operator norm: the axis contributes at most `2^-28`, sine and cosine `2^-29`, rounding the entries
//! `2^-29`). A product of [`JOINTS_AT_MOST`] of them, rounded at every step, has a norm below `1 + 2^-17`,
//! which bounds its rows, columns and entries. A sum of three products of entries is at most
//! `2^60 (1 + 2^-17)^2` by Cauchy and Schwarz; a rotated difference of two 32-bit points, which is shorter
//! than `3^(1/2) 2^32`, is below `2^62.8` before its rounding and `2^40.8` after. A pivot and what is
//! carried by it are therefore below `(255 * 3^(1/2) + 1) 2^40 (1 + 2^-17) < 2^48.8`, and the weighted
//! sum below `2^62.8`, with the half below `2^63`.

mod error;
mod section;
mod turn;

pub use error::RigError;
pub use section::RigRecord;
pub use turn::{QUARTER_TURN, turn};

use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout};

use crate::coord::{Coordinate, round_shift, saturate};

/// A rig has at most this many joints.
pub const JOINTS_AT_MOST: usize = 255;

/// [`Joint::parent`] of a joint that has none.
pub const NO_PARENT: u32 = u32::MAX;

/// The weights of a control point add up to this: they have 14 fraction bits.
pub const WEIGHT_ONE: u16 = 1 << WEIGHT_BITS;

/// The square of an axis' length may differ from `2^60` by this. Rounding a unit vector's coordinates
/// to multiples of `2^-30` changes it by less.
pub const AXIS_TOLERANCE: u64 = 1 << 31;

const WEIGHT_BITS: u32 = 14;
const ROTATION_BITS: u32 = 30;
/// Guard bits of pivots, and of what each joint makes of a control point.
const GUARD_BITS: u32 = 8;
/// One, as an entry of a rotation.
const ONE: i32 = 1 << ROTATION_BITS;

/// A joint: 28 bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, FromBytes, IntoBytes, Immutable, KnownLayout)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(C)]
pub struct Joint {
    /// The joint that carries it, which stands before it, or [`NO_PARENT`].
    pub parent: u32,
    /// Where it stands at rest, raw bits of a coordinate.
    pub pivot: [i32; 3],
    /// The unit vector about which it turns, by the right-hand rule, in space at rest, with 30 fraction
    /// bits. Zero for a joint that never turns, whatever its angle.
    pub axis: [i32; 3],
}

/// How much of a control point a joint carries: 4 bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, FromBytes, IntoBytes, Immutable, KnownLayout)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(C)]
pub struct Influence {
    /// The joint.
    pub joint: u16,
    /// The weight, with 14 fraction bits: at least 1, at most [`WEIGHT_ONE`].
    pub weight: u16,
}

/// What a rig is made of.
#[derive(Clone, Copy, Debug)]
pub struct RigParts<'a> {
    /// The joints, each behind its parent.
    pub joints: &'a [Joint],
    /// The control points at rest, raw bits.
    pub rest: &'a [[i32; 3]],
    /// Where the influences of each control point start, and the number of all of them at the end.
    pub starts: &'a [u32],
    /// The influences. A control point without any is not moved.
    pub influences: &'a [Influence],
}

/// Where a joint is on a tick.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Frame {
    /// Rows of its rotation in space, with 30 fraction bits.
    pub rotation: [[i32; 3]; 3],
    /// Where its pivot is, in units of `2^-8` of a coordinate's last place.
    pub pivot: [i64; 3],
}

/// A skeleton that has been proved sound.
#[derive(Clone, Copy, Debug)]
pub struct Rig<'a> {
    parts: RigParts<'a>,
}

impl<'a> Rig<'a> {
    /// Proves that there are 1 to [`JOINTS_AT_MOST`] joints, each behind its parent, with an axis of unit
    /// length ([`AXIS_TOLERANCE`]) or none; that every control point has its influences, by joints that
    /// exist, in ascending order; and that the weights of each point add up to one.
    ///
    /// # Errors
    ///
    /// A [`RigError`] that says which of these does not hold, and where.
    pub fn new_checked(parts: RigParts<'a>) -> Result<Self, RigError> {
        if parts.joints.is_empty() || parts.joints.len() > JOINTS_AT_MOST {
            return Err(RigError::Joints);
        }
        for (joint, place) in parts.joints.iter().zip(0_u32..) {
            if joint.parent != NO_PARENT && joint.parent >= place {
                return Err(RigError::Parent { joint: place });
            }
            if !is_axis(joint.axis) {
                return Err(RigError::Axis { joint: place });
            }
        }
        check_influences(&parts)?;
        Ok(Self { parts })
    }

    /// Number of joints: of angles and frames.
    #[must_use]
    pub const fn joints(&self) -> usize {
        self.parts.joints.len()
    }

    /// What it is made of.
    #[must_use]
    pub const fn parts(&self) -> RigParts<'a> {
        self.parts
    }

    /// Number of control points of the pose, those that no joint carries included.
    #[must_use]
    pub const fn control_points(&self) -> usize {
        self.parts.rest.len()
    }

    /// Turns every joint by its angle and carries the control points. Returns how many coordinates did
    /// not fit and were clamped.
    ///
    /// `angles` has `2^32` to a full turn; `base` is how far the whole rig is moved from its place at
    /// rest. `frames` receives where each joint is; `pose` the control points that a joint carries, the
    /// others stay as they are. The time depends on no value. See the [module](self) for rounding and
    /// overflow.
    ///
    /// # Errors
    ///
    /// [`RigError::Length`] if a slice is not as long as the rig needs; nothing is then written.
    pub fn carry<C: Coordinate>(
        &self,
        angles: &[i32],
        base: [C; 3],
        frames: &mut [Frame],
        pose: &mut [[C; 3]],
    ) -> Result<u32, RigError> {
        check_length(self.joints(), angles.len())?;
        check_length(self.joints(), frames.len())?;
        check_length(self.control_points(), pose.len())?;
        self.turn_joints(angles, base.map(Coordinate::to_bits), frames);
        let mut saturated = 0;
        let bounds = self.parts.starts.windows(2);
        let points = self.parts.rest.iter().zip(C::bits_of_mut(pose));
        for ((rest, out), bounds) in points.zip(bounds) {
            let influences = influences_of(&self.parts, bounds);
            if influences.is_empty() {
                continue;
            }
            let sum = self.carried(*rest, influences, frames);
            *out = sum.map(|sum| {
                saturate(
                    round_shift(sum, GUARD_BITS.wrapping_add(WEIGHT_BITS)),
                    &mut saturated,
                )
            });
        }
        Ok(saturated)
    }

    fn turn_joints(&self, angles: &[i32], base: [i32; 3], frames: &mut [Frame]) {
        for (place, (joint, &angle)) in self.parts.joints.iter().zip(angles).enumerate() {
            let own = rotation(joint.axis, angle);
            let parent = usize::try_from(joint.parent).unwrap_or(usize::MAX);
            let carrier = frames.get(parent).zip(self.parts.joints.get(parent));
            let frame = match carrier {
                Some((frame, carrier)) => Frame {
                    rotation: product(&frame.rotation, &own),
                    pivot: moved(frame, carrier.pivot, joint.pivot),
                },
                None => {
                    let guarded = |value: i32| i64::from(value).wrapping_shl(GUARD_BITS);
                    let [x, y, z] = joint.pivot.map(guarded);
                    let [dx, dy, dz] = base.map(guarded);
                    Frame {
                        rotation: own,
                        pivot: [x.wrapping_add(dx), y.wrapping_add(dy), z.wrapping_add(dz)],
                    }
                }
            };
            if let Some(slot) = frames.get_mut(place) {
                *slot = frame;
            }
        }
    }

    /// The weighted sum of where the joints of a control point put it.
    fn carried(&self, rest: [i32; 3], influences: &[Influence], frames: &[Frame]) -> [i64; 3] {
        let [mut x, mut y, mut z] = [0_i64; 3];
        for influence in influences {
            let joint = usize::from(influence.joint);
            // Never missing: the influences were checked.
            let (Some(frame), Some(joint)) = (frames.get(joint), self.parts.joints.get(joint))
            else {
                continue;
            };
            let [px, py, pz] = moved(frame, joint.pivot, rest);
            let weight = i64::from(influence.weight);
            x = x.wrapping_add(px.wrapping_mul(weight));
            y = y.wrapping_add(py.wrapping_mul(weight));
            z = z.wrapping_add(pz.wrapping_mul(weight));
        }
        [x, y, z]
    }
}

/// The influences between two starts. Never other than these: the starts were checked.
fn influences_of<'a>(parts: &RigParts<'a>, bounds: &[u32]) -> &'a [Influence] {
    let &[first, last] = bounds else { return &[] };
    let range = usize::try_from(first).ok().zip(usize::try_from(last).ok());
    let range = range.and_then(|(first, last)| parts.influences.get(first..last));
    range.unwrap_or_default()
}

fn check_influences(parts: &RigParts<'_>) -> Result<(), RigError> {
    let points = parts.rest.len();
    if points.checked_add(1) != Some(parts.starts.len())
        || parts.starts.first() != Some(&0)
        || parts.starts.last().copied() != u32::try_from(parts.influences.len()).ok()
    {
        return Err(RigError::Layout);
    }
    for (bounds, point) in parts.starts.windows(2).zip(0_u32..) {
        let &[first, last] = bounds else { continue };
        let influences = influences_of(parts, bounds);
        if first > last || (influences.is_empty() && first != last) {
            return Err(RigError::Layout);
        }
        let mut sum = 0_u32;
        let mut next = 0;
        for influence in influences {
            let joint = usize::from(influence.joint);
            if joint >= parts.joints.len() || joint < next {
                return Err(RigError::Influence { point });
            }
            if influence.weight == 0 {
                return Err(RigError::Weights { point });
            }
            next = joint.wrapping_add(1);
            // At most 255 of them.
            sum = sum.wrapping_add(u32::from(influence.weight));
        }
        if !influences.is_empty() && sum != u32::from(WEIGHT_ONE) {
            return Err(RigError::Weights { point });
        }
    }
    Ok(())
}

fn check_length(needed: usize, given: usize) -> Result<(), RigError> {
    if needed == given {
        Ok(())
    } else {
        Err(RigError::Length { needed, given })
    }
}

/// Whether a vector has unit length, or none at all.
fn is_axis(axis: [i32; 3]) -> bool {
    let square =
        |value: i32| u64::from(value.unsigned_abs()).saturating_mul(value.unsigned_abs().into());
    let [x, y, z] = axis.map(square);
    let sum = x.saturating_add(y).saturating_add(z);
    sum == 0 || sum.abs_diff(1 << (2 * ROTATION_BITS)) <= AXIS_TOLERANCE
}

fn long(a: i32, b: i32) -> i64 {
    i64::from(a).wrapping_mul(i64::from(b))
}

/// What fits 32 bits by the proof of the module.
#[expect(clippy::as_conversions, reason = "the value fits")]
const fn narrow(value: i64) -> i32 {
    value as i32
}

/// A joint's own rotation.
fn rotation(axis: [i32; 3], angle: i32) -> [[i32; 3]; 3] {
    if axis == [0; 3] {
        return [[ONE, 0, 0], [0, ONE, 0], [0, 0, ONE]];
    }
    let (sine, cosine) = turn(angle);
    let [x, y, z] = axis;
    // At most 2 in magnitude, so this takes 33 bits.
    let rest = i64::from(ONE).wrapping_sub(i64::from(cosine));
    let [tx, ty, tz] = axis.map(|a| round_shift(rest.wrapping_mul(i64::from(a)), ROTATION_BITS));
    let diagonal = i64::from(cosine).wrapping_shl(ROTATION_BITS);
    let entry = |first: i64, t: i64, a: i32| {
        let sum = first.wrapping_add(t.wrapping_mul(i64::from(a)));
        narrow(round_shift(sum, ROTATION_BITS))
    };
    let [sx, sy, sz] = axis.map(|a| long(sine, a));
    [
        [
            entry(diagonal, tx, x),
            entry(sz.wrapping_neg(), tx, y),
            entry(sy, tx, z),
        ],
        [
            entry(sz, ty, x),
            entry(diagonal, ty, y),
            entry(sx.wrapping_neg(), ty, z),
        ],
        [
            entry(sy.wrapping_neg(), tz, x),
            entry(sx, tz, y),
            entry(diagonal, tz, z),
        ],
    ]
}

fn product(a: &[[i32; 3]; 3], b: &[[i32; 3]; 3]) -> [[i32; 3]; 3] {
    let &[[b00, b01, b02], [b10, b11, b12], [b20, b21, b22]] = b;
    let columns = [[b00, b10, b20], [b01, b11, b21], [b02, b12, b22]];
    a.map(|[x, y, z]| {
        columns.map(|[p, q, r]| {
            let sum = long(x, p).wrapping_add(long(y, q)).wrapping_add(long(z, r));
            narrow(round_shift(sum, ROTATION_BITS))
        })
    })
}

/// Where a frame takes what was at `place` at rest, when its pivot was at `pivot`, with guard bits.
fn moved(frame: &Frame, pivot: [i32; 3], place: [i32; 3]) -> [i64; 3] {
    let ([px, py, pz], [qx, qy, qz]) = (pivot, place);
    let difference = |q: i32, p: i32| i64::from(q).wrapping_sub(i64::from(p));
    let [x, y, z] = [difference(qx, px), difference(qy, py), difference(qz, pz)];
    let rotated = |row: [i32; 3]| {
        let [a, b, c] = row.map(i64::from);
        let sum = a
            .wrapping_mul(x)
            .wrapping_add(b.wrapping_mul(y))
            .wrapping_add(c.wrapping_mul(z));
        round_shift(sum, ROTATION_BITS.wrapping_sub(GUARD_BITS))
    };
    let ([first, second, third], [ox, oy, oz]) = (frame.rotation, frame.pivot);
    [
        ox.wrapping_add(rotated(first)),
        oy.wrapping_add(rotated(second)),
        oz.wrapping_add(rotated(third)),
    ]
}

#[cfg(test)]
mod tests;
