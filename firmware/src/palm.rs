//! A palm in the wind: springs between the control points, gusts that push them, a ball that swings through the leaves.
//!
//! The wind and the ball are functions of the tick alone, in whole numbers, so the same minute is played everywhere.

use octruss::bundle::{Bundle, BundleError};
use octruss::control::springs::{
    Drive, FACTOR_ONE, Obstacle, PointState, STATE_BITS, Shape, Springs,
};
use octruss::deform::Table;

use crate::cases::springs::hash;

/// Ticks a second.
pub const TICKS_A_SECOND: u32 = 50;
/// Seconds that are played.
pub const SECONDS: u32 = 60;

/// Ticks from one gust to the next.
const GUST_TICKS: u32 = 300;
/// Ticks of a gust: it grows for a half of them and falls for the other.
const BLOW_TICKS: u32 = 150;
/// Ticks for which the wind's restlessness is the same.
const FLUTTER_TICKS: u32 = 8;
/// Directions of the gusts, x and y, in 256ths.
const DIRECTIONS: [[i64; 2]; 4] = [[256, 0], [-181, 181], [78, -244], [-128, -222]];
/// The strongest wind: what it adds to the velocity of the lightest point in a substep, in 2^-20 of the unit of lengths.
/// 0.08 cm in a hundredth of a second are 800 cm/s in a second.
const STRONGEST: i64 = 83_886;
/// The ball's radius, how high its centre is, and how far from the trunk's foot it passes, in units of length.
const BALL_RADIUS: i64 = 5;
const BALL_HEIGHT: i64 = 44;
const BALL_ASIDE: i64 = 14;
/// It goes this far to both sides, there and back in this time.
const BALL_WAY: i64 = 45;
const BALL_TICKS: u32 = 500;
/// What a leaf that slides along the ball loses of its velocity in a substep.
const GRIP: u32 = FACTOR_ONE / 16;

/// What a minute of wind takes of a bundle.
pub struct Palm<'a> {
    /// Deforms the model.
    pub table: Table<'a, i32>,
    springs: Springs<'a>,
    rest: &'a [[i32; 3]],
    fraction_bits: u32,
}

/// Memory of one palm, each as long as the cage has control points.
pub struct PalmMemory<'m> {
    /// Positions and velocities.
    pub state: &'m mut [PointState],
    /// The control points.
    pub pose: &'m mut [[i32; 3]],
    /// The wind on each.
    pub pushes: &'m mut [[i32; 3]],
}

/// Why there is no palm.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(target_os = "none", derive(defmt::Format))]
pub enum PalmError {
    /// The bundle is not sound.
    Bundle(BundleError),
    /// The bundle has no springs, or too few or many fraction bits for the wind and the ball: 12 to 25 do.
    NoSprings,
    /// The memory is not as long as the cage.
    Memory,
}

impl core::fmt::Display for PalmError {
    fn fmt(&self, out: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            PalmError::Bundle(error) => core::fmt::Display::fmt(error, out),
            PalmError::NoSprings => {
                out.write_str("the bundle has no springs, or not 12 to 25 fraction bits")
            }
            PalmError::Memory => out.write_str("the memory is not as long as the cage"),
        }
    }
}

impl core::error::Error for PalmError {}

impl<'a> Palm<'a> {
    /// Takes the parts out of a bundle.
    ///
    /// # Errors
    ///
    /// [`PalmError::Bundle`], [`PalmError::NoSprings`].
    pub fn open(bundle: &Bundle<'a>) -> Result<Self, PalmError> {
        let table = bundle.table::<i32>().map_err(PalmError::Bundle)?;
        let springs = bundle.springs::<i32>().map_err(PalmError::Bundle)?;
        let fraction_bits = bundle.header().fraction_bits.get();
        let springs = springs.filter(|_| (12..=25).contains(&fraction_bits));
        Ok(Palm {
            table,
            springs: springs.ok_or(PalmError::NoSprings)?,
            rest: bundle.rest_cage(),
            fraction_bits,
        })
    }

    /// Puts the palm to rest.
    ///
    /// # Errors
    ///
    /// [`PalmError::Memory`].
    pub fn start(&self, memory: &mut PalmMemory<'_>) -> Result<(), PalmError> {
        let points = self.rest.len();
        if memory.pose.len() != points || memory.pushes.len() != points {
            return Err(PalmError::Memory);
        }
        memory.pose.copy_from_slice(self.rest);
        self.springs
            .start(self.rest, memory.state)
            .map_err(|_| PalmError::Memory)
    }

    /// Moves on by a tick and returns how often a coordinate was clamped.
    ///
    /// # Errors
    ///
    /// [`PalmError::Memory`].
    pub fn tick(&self, tick: u32, memory: &mut PalmMemory<'_>) -> Result<u32, PalmError> {
        self.blow(tick, memory.pushes);
        let drive = Drive {
            goals: self.rest,
            pushes: memory.pushes,
            obstacles: &[self.ball(tick)],
        };
        self.springs
            .tick(&drive, memory.state, memory.pose)
            .map_err(|_| PalmError::Memory)
    }

    /// The checksum of positions and velocities.
    #[must_use]
    pub fn state_hash(memory: &PalmMemory<'_>) -> u32 {
        hash(memory.state)
    }

    /// The wind of a tick. It grows and falls on straight lines, and every point gets three quarters to five quarters
    /// of it; heavy points take less of a push by themselves.
    pub fn blow(&self, tick: u32, pushes: &mut [[i32; 3]]) {
        let within = tick % GUST_TICKS;
        if within >= BLOW_TICKS {
            pushes.fill([0; 3]);
            return;
        }
        let half = BLOW_TICKS / 2;
        let strength = i64::from(half.abs_diff(within.abs_diff(half)));
        let gust = (tick / GUST_TICKS) as usize % DIRECTIONS.len();
        let [x, y] = DIRECTIONS.get(gust).copied().unwrap_or_default();
        // From 2^-20 of the unit to pushes of 2^push_shift of the state's.
        let bits =
            (self.fraction_bits + STATE_BITS) as i32 - 20 - self.springs.parts().push_shift as i32;
        for (point, push) in (0_u32..).zip(pushes) {
            let flutter = i64::from(192 + (flutter(point, tick / FLUTTER_TICKS) & 127));
            let along = |way: i64| {
                let exact = STRONGEST * strength * flutter * way / i64::from(half) / (256 * 256);
                let scaled = if bits < 0 {
                    exact >> -bits
                } else {
                    exact << bits
                };
                scaled.clamp(i64::from(i32::MIN), i64::from(i32::MAX)) as i32
            };
            *push = [along(x), along(y), 0];
        }
    }

    /// The ball of a tick: back and forth on a straight line through the leaves.
    #[must_use]
    pub fn ball(&self, tick: u32) -> Obstacle<i32> {
        let half = i64::from(BALL_TICKS / 2);
        let within = i64::from(tick % BALL_TICKS);
        // From -half to half and back.
        let way = half - 2 * (within - half).abs();
        // At most 45 units of at most 2^25.
        let bits = |length: i64| (length << self.fraction_bits) as i32;
        Obstacle {
            shape: Shape::Sphere {
                centre: [
                    ((BALL_WAY << self.fraction_bits) * way / half) as i32,
                    bits(BALL_ASIDE),
                    bits(BALL_HEIGHT),
                ],
                radius: bits(BALL_RADIUS).unsigned_abs(),
            },
            grip: GRIP,
        }
    }
}

/// A number that tells points and times apart: two rounds of Marsaglia's generator.
fn flutter(point: u32, time: u32) -> u32 {
    let mut number = point.wrapping_mul(2_654_435_761).wrapping_add(1) ^ time.wrapping_mul(40_503);
    for _ in 0..2 {
        number ^= number << 13;
        number ^= number >> 17;
        number ^= number << 5;
    }
    number
}
