//! The kinds [`SPRINGS`](super::SPRINGS) and [`SHAKES`](super::SHAKES): control points on springs.
//!
//! Both begin with
//!
//! | words | what |
//! | --- | --- |
//! | 1 | number of control points |
//! | 1 | number of obstacles |
//! | 1 | bytes of the section of springs, as it lies in a bundle |
//! | | the section |
//! | 3 each | the goals, raw bits, signed |
//! | 9 each | obstacles: grip; 0 for a plane, 1 for a sphere, 2 for a capsule; its radius; point and normal, centre and zeros, or both ends |
//! | 12 each | position and velocity of every point, 64 bits each, the low word first |
//!
//! # Single ticks
//!
//! Behind that, for each tick, 3 words for each point: the pushes. The result of each tick is how often a coordinate
//! was clamped, then the pose; of the last also position and velocity of every point.
//!
//! # Shakes
//!
//! Behind that the seven words of [`Shakes`] and the number of ticks a hash. The result is, for each so many ticks, the CRC-32
//! of positions and velocities, and how often a coordinate was clamped so far.

use octruss::control::springs::{Drive, Obstacle, PointState, Shape, Springs};
use octruss::mesh::Arena;
use zerocopy::IntoBytes;

use super::results::{Results, Sink, Status};
use super::space::Space;
use super::volume::wide;
use super::{CHECKSUM, SECTION_SPRINGS, Words};

/// Words of an obstacle.
const OBSTACLE_WORDS: usize = 9;
/// Words of a point's state.
const STATE_WORDS: usize = 12;

/// Random shakes: every `period` ticks every point is pushed at random for `shaken` ticks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shakes {
    /// Not zero.
    pub seed: u32,
    /// Ticks in all.
    pub ticks: u32,
    /// Ticks from one shake to the next, at least 1.
    pub period: u32,
    /// Ticks of a shake.
    pub shaken: u32,
    /// A push's coordinates are random numbers of 32 bits, shifted right by this.
    pub shift: u32,
    /// Of a push's coordinates only these bits, 1 for x, 2 for y, 4 for z, are not zero.
    pub axes: u32,
    /// Pushes are for this many ticks the same.
    pub held: u32,
}

impl Shakes {
    /// Makes the pushes of a tick of those of the one before.
    pub fn shake(&mut self, tick: u32, pushes: &mut [[i32; 3]]) {
        let within = tick.checked_rem(self.period).unwrap_or_default();
        if within >= self.shaken {
            pushes.fill([0; 3]);
            return;
        }
        if within.checked_rem(self.held) != Some(0) {
            return;
        }
        for push in pushes {
            for (axis, coordinate) in (0_u32..).zip(push) {
                // Marsaglia's generator.
                self.seed ^= self.seed << 13;
                self.seed ^= self.seed >> 17;
                self.seed ^= self.seed << 5;
                let is_pushed = self.axes.wrapping_shr(axis) & 1 != 0;
                let random = self.seed.cast_signed().wrapping_shr(self.shift);
                *coordinate = if is_pushed { random } else { 0 };
            }
        }
    }
}

/// The CRC-32 of positions and velocities.
#[must_use]
pub fn hash(state: &[PointState]) -> u32 {
    let mut digest = CHECKSUM.digest();
    for point in state {
        for coordinate in point.position().into_iter().chain(point.velocity()) {
            digest.update(&coordinate.to_le_bytes());
        }
    }
    digest.finalize()
}

/// What both kinds begin with, opened.
struct Given<'a> {
    springs: Springs<'a>,
    goals: &'a [[i32; 3]],
    obstacles: &'a [Obstacle<i32>],
    state: &'a mut [PointState],
    pose: &'a mut [[i32; 3]],
    pushes: &'a mut [[i32; 3]],
}

impl<'a> Given<'a> {
    fn new(words: &mut Words<'a>, space: &mut Space<'a>) -> Result<Self, Status> {
        let points = words.length()?;
        let obstacle_count = words.length()?;
        let section_bytes = words.length()?;
        let section = words.elements::<1>(section_bytes.div_ceil(4))?.as_bytes();
        let section = section.get(..section_bytes).ok_or(Status::Malformed)?;
        let goals = words.points(points)?;
        let given = words.values::<OBSTACLE_WORDS>(obstacle_count)?;
        let before = words.elements::<STATE_WORDS>(points)?;
        let none = Obstacle {
            shape: Shape::Sphere {
                centre: [0; 3],
                radius: 0,
            },
            grip: 0,
        };
        let obstacles = space.slice(Arena::InputPoints, obstacle_count, none)?;
        for (slot, given) in obstacles.iter_mut().zip(given) {
            *slot = obstacle(given)?;
        }
        let state = space.slice(Arena::Sums, points, PointState::default())?;
        for (slot, words) in state.iter_mut().zip(before) {
            *slot = state_of(words);
        }
        Ok(Given {
            springs: Springs::from_section(section, points).map_err(Status::Springs)?,
            goals,
            obstacles,
            state,
            pose: space.slice(Arena::OutputPoints, points, [0; 3])?,
            pushes: space.slice(Arena::OutputPoints, points, [0; 3])?,
        })
    }

    /// A tick with these pushes.
    fn tick(&mut self, pushes: &[[i32; 3]]) -> Result<u32, Status> {
        let drive = Drive {
            goals: self.goals,
            pushes,
            obstacles: self.obstacles,
        };
        self.springs
            .tick(&drive, self.state, self.pose)
            .map_err(Status::Springs)
    }
}

/// Runs a case of single ticks.
pub(super) fn run<'a, S: Sink>(
    words: &'a [u32],
    mut space: Space<'a>,
    results: &mut Results<'_, S>,
) -> Result<(), Status> {
    let mut words = Words(words);
    let mut given = Given::new(&mut words, &mut space)?;
    let points = given.pose.len();
    while !words.0.is_empty() && points != 0 {
        let pushes = words.points(points)?;
        let clamped = given.tick(pushes)?;
        results.begin_section(SECTION_SPRINGS, points.saturating_mul(3).saturating_add(1));
        results.words(&[clamped]);
        for coordinate in given.pose.as_flattened() {
            results.words(&[coordinate.cast_unsigned()]);
        }
    }
    words.finish()?;
    space.check()?;
    results.begin_section(SECTION_SPRINGS, points.saturating_mul(STATE_WORDS));
    for point in &*given.state {
        for coordinate in point.position().into_iter().chain(point.velocity()) {
            results.words(&wide(coordinate));
        }
    }
    Ok(())
}

/// Ticks of a case of shakes at most, so that a damaged one ends.
const TICKS_AT_MOST: u32 = 100_000;

/// Runs a case of shakes.
pub(super) fn run_shakes<'a, S: Sink>(
    words: &'a [u32],
    mut space: Space<'a>,
    results: &mut Results<'_, S>,
) -> Result<(), Status> {
    let mut words = Words(words);
    let mut given = Given::new(&mut words, &mut space)?;
    let [[seed, ticks, period, shaken, shift, axes, held, ticks_a_hash]] = *words.elements(1)?
    else {
        return Err(Status::Malformed);
    };
    words.finish()?;
    let mut shakes = Shakes {
        seed,
        ticks,
        period,
        shaken,
        shift,
        axes,
        held,
    };
    if ticks > TICKS_AT_MOST || period == 0 || held == 0 || ticks_a_hash == 0 {
        return Err(Status::Malformed);
    }
    let mut clamped = 0_u32;
    let pushes = core::mem::take(&mut given.pushes);
    for tick in 0..ticks {
        shakes.shake(tick, pushes);
        clamped = clamped.saturating_add(given.tick(pushes)?);
        if tick % ticks_a_hash == ticks_a_hash - 1 {
            results.begin_section(SECTION_SPRINGS, 2);
            results.words(&[hash(given.state), clamped]);
        }
    }
    space.check()
}

/// An obstacle of its words.
fn obstacle(words: &[i32; OBSTACLE_WORDS]) -> Result<Obstacle<i32>, Status> {
    let &[grip, kind, radius, a, b, c, d, e, f] = words;
    let radius = radius.cast_unsigned();
    let (first, second) = ([a, b, c], [d, e, f]);
    let shape = match kind {
        0 => Shape::Plane {
            point: first,
            normal: second,
        },
        1 => Shape::Sphere {
            centre: first,
            radius,
        },
        2 => Shape::Capsule {
            ends: [first, second],
            radius,
        },
        _ => return Err(Status::Malformed),
    };
    Ok(Obstacle {
        shape,
        grip: grip.cast_unsigned(),
    })
}

fn state_of(words: &[u32; STATE_WORDS]) -> PointState {
    let mut numbers = words
        .as_chunks::<2>()
        .0
        .iter()
        .map(|&[low, high]| (u64::from(high) << 32 | u64::from(low)).cast_signed());
    let mut three = || [0; 3].map(|_: i64| numbers.next().unwrap_or_default());
    let position = three();
    PointState::new(position, three())
}
