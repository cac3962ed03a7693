//! The control points as masses, the edges of the control mesh as damped springs toward a goal shape: a
//! palm bends in the wind, hits things, and comes back (Hakenberg's thesis, section 5.5).
//!
//! The method is position based with small steps (Macklin and others 2019, one pass over the constraints
//! in each of a fixed number of substeps): whatever the stiffness, a spring moves its ends no farther than
//! to where it is satisfied, so no stiffness and no tick is unstable.
//!
//! # The contract
//!
//! Positions and velocities are whole numbers of `2^-12` of a coordinate's last place, a velocity's for
//! each substep. Factors have 16 fraction bits and are at most one. Every product below is exact and rounded once
//! to that unit. Wherever a position is changed, it is clamped to the range of coordinates, and the
//! velocity changes by as much as the position did; velocities are clamped to 2^43. A **substep** does,
//! each in the order of the points or springs:
//!
//! 1. *Move.* A pinned point goes the way to its goal divided by the number of substeps that are left.
//!    Another loses `drag` of each coordinate of its velocity, at least one unit if there is one; gains
//!    gravity, and its push times its mobility; and moves by its velocity.
//! 2. *Springs.* With `d` the difference of the ends, `r` that of their goals, `l` the length of `d`, `L`
//!    the length at rest and `f = min(L / l, 2)`: the change of `d` is
//!    `-(stretch (1 - f) d + shape (d - r))`, of which `share` falls to the first end and the rest to the
//!    second. Where `l` is zero, `-(stretch + shape) (d - r)`. So `d` becomes a mean of
//!    itself, of the vector of length `L` (or `2 l`) along itself, and of `r`.
//! 3. *Anchors.* A point moves by `anchor` of its way to its goal.
//! 4. *Contacts.* A point inside an [`Obstacle`] moves out along the normal, by how deep it is; of its
//!    velocity along the surface it loses `grip`.
//! 5. *Damping.* The velocities of a spring's ends lose `damping` of their difference, shared as above.
//!
//! At the goal shape of rest, without gravity, every change is zero: rest is a fixed point, to the bit. The
//! least loss of step 1 ends every motion that nothing drives.
//!
//! # Lengths
//!
//! `d` is divided by `2^s`, the least power for which its coordinates are at most `2^30`, and rounded; `l`
//! is the square root of the sum of its squares to the nearest whole number, `f` a multiple of `2^-30`.
//! `L` is stored as such a length with its `s`, so that it is `l`, to the bit, at rest.
//!
//! # Example
//!
//! A mass hangs by a spring from a pinned point and is pushed against a wall; bundles hold springs
//! ready-made ([`Bundle::springs`](crate::bundle::Bundle::springs)).
//!
//! ```
//! use octruss::control::springs::{
//!     Drive, FACTOR_ONE, Obstacle, PointData, PointState, Shape, Spring, Springs, SpringsError,
//!     SpringsParts,
//! };
//!
//! # fn main() -> Result<(), SpringsError> {
//! let springs = Springs::new_checked(SpringsParts {
//!     points: &[
//!         PointData { mobility: 0, anchor: 0 },
//!         PointData { mobility: FACTOR_ONE, anchor: 0 },
//!     ],
//!     springs: &[Spring {
//!         points: [0, 1],
//!         length: 1000 << 12,
//!         length_shift: 0,
//!         share: 0,
//!         stretch: FACTOR_ONE / 2,
//!         shape: FACTOR_ONE / 50,
//!     }],
//!     substeps: 4,
//!     drag: FACTOR_ONE / 50,
//!     damping: 0,
//!     push_shift: 12,
//!     gravity: [0, 0, 0],
//! })?;
//! let rest = [[0, 0, 0], [0, 0, -1000]];
//! let wall = Shape::Plane { point: [300, 0, 0], normal: [-(1 << 16), 0, 0] };
//! let obstacles = [Obstacle { shape: wall, grip: 0 }];
//! let (mut state, mut pose) = ([PointState::default(); 2], rest);
//! springs.start(&rest, &mut state)?;
//! let mut drive = Drive { goals: &rest, pushes: &[[0, 0, 0], [40, 0, 0]], obstacles: &obstacles };
//! for _ in 0..50 {
//!     springs.tick(&drive, &mut state, &mut pose)?;
//! }
//! assert_eq!((pose[0], pose[1][0]), ([0, 0, 0], 300)); // held by the wall
//! drive.pushes = &[];
//! for _ in 0..500 {
//!     springs.tick(&drive, &mut state, &mut pose)?;
//! }
//! assert_eq!(pose, rest); // back at rest, to the bit
//! # Ok(())
//! # }
//! ```
//!
//! # Scaling and overflow
//!
//! Positions are within `2^43`, differences within `2^44`, a spring's change within `2^45` (its factors
//! add up to at most one) before a factor of `2^16` makes it `2^61`. Squares add up to at most
//! `3 * 2^60`, and a numerator of a quotient is at most `2^62`. A normal has length one within `2^-15`, so
//! its product with a difference is below `2^61`. A push is at most `2^43` before its factor.

mod error;
mod length;
mod obstacle;
mod section;
mod state;
mod tick;

pub use error::SpringsError;
pub use length::{Length, length};
pub use obstacle::{Obstacle, Shape};
pub use section::SpringsRecord;
pub use state::{PointState, VELOCITY_LIMIT};

use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout};

use crate::coord::Coordinate;

/// Fraction bits of the state: its unit is `2^-12` of a coordinate's last place.
pub const STATE_BITS: u32 = 12;
/// Fraction bits of factors.
pub const FACTOR_BITS: u32 = 16;
/// A factor of one.
pub const FACTOR_ONE: u32 = 1 << FACTOR_BITS;
/// A tick has at most this many substeps.
pub const SUBSTEPS_AT_MOST: u32 = 64;

/// A spring: 24 bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, FromBytes, IntoBytes, Immutable, KnownLayout)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(C)]
pub struct Spring {
    /// The two control points.
    pub points: [u16; 2],
    /// The length at rest, in units of `2^length_shift` of the state's, at most `2^31`.
    pub length: u32,
    /// 0 to 15.
    pub length_shift: u32,
    /// How much of a change falls to the first point, at most one: its mobility divided by both.
    pub share: u32,
    /// How much of a change of length is taken back in a substep.
    pub stretch: u32,
    /// How much of a change of length and direction is taken back; with `stretch` at most one.
    pub shape: u32,
}

/// A control point: 8 bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, FromBytes, IntoBytes, Immutable, KnownLayout)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(C)]
pub struct PointData {
    /// How easily it is moved, at most one: its inverse mass in units of the lightest point's. A point
    /// with mobility 0 is pinned to its goal.
    pub mobility: u32,
    /// How much of its way to its goal is taken back in a substep, at most one.
    pub anchor: u32,
}

/// What springs are made of.
#[derive(Clone, Copy, Debug)]
pub struct SpringsParts<'a> {
    /// Every control point of the cage.
    pub points: &'a [PointData],
    /// The springs, in the order in which they are satisfied.
    pub springs: &'a [Spring],
    /// Substeps of a tick, 1 to [`SUBSTEPS_AT_MOST`].
    pub substeps: u32,
    /// The part of a velocity that is lost in a substep, at most one.
    pub drag: u32,
    /// The part of a difference of velocities that a spring takes away in a substep, at most one.
    pub damping: u32,
    /// A push of one stands for `2^push_shift` of the state's units, a substep; at most 12.
    pub push_shift: u32,
    /// What every point that is not pinned gains of velocity in a substep, at most [`VELOCITY_LIMIT`].
    pub gravity: [i64; 3],
}

/// Springs that have been proved sound.
#[derive(Clone, Copy, Debug)]
pub struct Springs<'a> {
    parts: SpringsParts<'a>,
}

/// What moves the points on a tick.
#[derive(Clone, Copy, Debug)]
pub struct Drive<'a, C> {
    /// The shape that the springs strive for, all control points: the rest cage, or what a rig makes.
    pub goals: &'a [[C; 3]],
    /// A force on each control point that lasts the tick (an impulse is one that lasts one tick), in
    /// units of `2^push_shift`; empty if there are none.
    pub pushes: &'a [[i32; 3]],
    /// What the points cannot enter, in the order in which they are pushed out.
    pub obstacles: &'a [Obstacle<C>],
}

impl<'a> Springs<'a> {
    /// Proves that factors are at most one, that every spring has two points that exist and differ, with
    /// a share of the change that leaves pinned points where they are, and that numbers are within the
    /// ranges of [`SpringsParts`].
    ///
    /// # Errors
    ///
    /// A [`SpringsError`] that says which of these does not hold, and where.
    pub fn new_checked(parts: SpringsParts<'a>) -> Result<Self, SpringsError> {
        let settings = (1..=SUBSTEPS_AT_MOST).contains(&parts.substeps)
            && parts.drag <= FACTOR_ONE
            && parts.damping <= FACTOR_ONE
            && parts.push_shift <= STATE_BITS
            && parts
                .gravity
                .iter()
                .all(|gravity| gravity.unsigned_abs() <= VELOCITY_LIMIT.unsigned_abs());
        if !settings {
            return Err(SpringsError::Settings);
        }
        for (data, point) in parts.points.iter().zip(0_u32..) {
            if data.mobility > FACTOR_ONE || data.anchor > FACTOR_ONE {
                return Err(SpringsError::Point { point });
            }
        }
        for (spring, place) in parts.springs.iter().zip(0_u32..) {
            if !is_sound(spring, parts.points) {
                return Err(SpringsError::Spring { spring: place });
            }
        }
        Ok(Self { parts })
    }

    /// What they are made of.
    #[must_use]
    pub const fn parts(&self) -> SpringsParts<'a> {
        self.parts
    }

    /// Number of control points: of goals, states and points of the pose.
    #[must_use]
    pub const fn control_points(&self) -> usize {
        self.parts.points.len()
    }

    /// Puts every point to rest at its goal.
    ///
    /// # Errors
    ///
    /// [`SpringsError::Length`] if a slice is not as long as there are control points.
    pub fn start<C: Coordinate>(
        &self,
        goals: &[[C; 3]],
        state: &mut [PointState],
    ) -> Result<(), SpringsError> {
        check_length(self.control_points(), goals.len())?;
        check_length(self.control_points(), state.len())?;
        for (state, goal) in state.iter_mut().zip(C::bits_of(goals)) {
            *state = PointState::at(*goal);
        }
        Ok(())
    }

    /// Moves every point on by a tick and writes where it is, rounded to the last place, to `pose`.
    /// Returns how often a coordinate of a position had to be clamped.
    ///
    /// The time is bounded by points, springs, obstacles and substeps. See the [module](self) for what is
    /// done, rounding and overflow.
    ///
    /// # Errors
    ///
    /// [`SpringsError::Length`] if a slice is not as long as there are control points,
    /// [`SpringsError::Obstacle`] if an obstacle is unsound; nothing is then written.
    pub fn tick<C: Coordinate>(
        &self,
        drive: &Drive<'_, C>,
        state: &mut [PointState],
        pose: &mut [[C; 3]],
    ) -> Result<u32, SpringsError> {
        let points = self.control_points();
        check_length(points, drive.goals.len())?;
        if !drive.pushes.is_empty() {
            check_length(points, drive.pushes.len())?;
        }
        check_length(points, state.len())?;
        check_length(points, pose.len())?;
        for (obstacle, place) in drive.obstacles.iter().zip(0_u32..) {
            if !obstacle.is_sound() {
                return Err(SpringsError::Obstacle { obstacle: place });
            }
        }
        let clamped = tick::run(&self.parts, drive, state);
        for (out, state) in C::bits_of_mut(pose).iter_mut().zip(&*state) {
            *out = state.coordinates();
        }
        Ok(clamped)
    }
}

fn is_sound(spring: &Spring, points: &[PointData]) -> bool {
    let [first, second] = spring.points;
    let data = |point: u16| points.get(usize::from(point));
    let (Some(first_data), Some(second_data)) = (data(first), data(second)) else {
        return false;
    };
    let shared = match (first_data.mobility, second_data.mobility) {
        (0, 0) => false,
        (0, _) => spring.share == 0,
        (_, 0) => spring.share == FACTOR_ONE,
        _ => spring.share <= FACTOR_ONE,
    };
    first != second
        && shared
        && spring.length <= 1 << 31
        && spring.length_shift <= 15
        && spring.stretch.saturating_add(spring.shape) <= FACTOR_ONE
}

fn check_length(needed: usize, given: usize) -> Result<(), SpringsError> {
    if needed == given {
        Ok(())
    } else {
        Err(SpringsError::Length { needed, given })
    }
}

#[cfg(test)]
mod tests;
