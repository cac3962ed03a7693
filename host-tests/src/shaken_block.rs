//! A block on springs that is shaken: what the long runs of the springs are about.
//!
//! A lattice of points, 40 mm apart in I10F22, with a spring along every edge and every diagonal of a face. Its
//! lowest layer is pinned; a ball and a plane stand beside it.

use octruss_firmware::cases::springs::Shakes;

use crate::random_springs::SpringsCase;
use crate::reference_springs::{ObstacleData, SpringData, SpringsData, rest_length};

/// Ticks of a second.
pub const SECOND: u32 = 50;
/// Seconds from one shake to the next.
pub const SECONDS_A_SHAKE: u32 = 10;

/// A millimetre in I10F22.
const MILLIMETRE: i32 = 1 << 22;
/// The distance of neighbours.
const STEP: i32 = 40 * MILLIMETRE;
/// A factor of one.
const ONE: u32 = 1 << 16;

/// A block of so many points along x, y and z, at rest.
#[must_use]
pub fn block(counts: [i32; 3]) -> SpringsCase {
    let [width, depth, height] = counts;
    let mut goals = Vec::new();
    for z in 0..height {
        for y in 0..depth {
            for x in 0..width {
                goals.push([x, y, z].map(|place| (place - 1) * STEP));
            }
        }
    }
    let is_pinned = |point: [i32; 3]| point[2] == -STEP;
    let mut springs = Vec::new();
    for (second, &b) in goals.iter().enumerate() {
        for (first, &a) in goals.iter().enumerate().take(second) {
            let steps: Vec<i32> = (0..3)
                .map(|axis| (a[axis] - b[axis]).abs() / STEP)
                .collect();
            let are_near = steps.iter().all(|&steps| steps <= 1) && steps.iter().sum::<i32>() <= 2;
            if !are_near || (is_pinned(a) && is_pinned(b)) {
                continue;
            }
            let share = match [is_pinned(a), is_pinned(b)] {
                [true, _] => 0,
                [_, true] => ONE,
                _ => ONE / 2,
            };
            let (length, shift) = rest_length(a, b);
            springs.push(SpringData {
                ends: [first, second],
                length,
                shift,
                factors: [share, ONE / 2, ONE / 20],
            });
        }
    }
    let mobility = |&point: &[i32; 3]| [if is_pinned(point) { 0 } else { ONE }, 0];
    let data = SpringsData {
        points: goals.iter().map(mobility).collect(),
        springs,
        substeps: 4,
        drag: ONE / 100,
        damping: ONE / 20,
        push_shift: 12,
        gravity: [0; 3],
    };
    let wide = |place: [i32; 3]| place.map(|value| i64::from(value) << 12);
    SpringsCase {
        state: goals.iter().map(|&goal| [wide(goal), [0; 3]]).collect(),
        data,
        goals,
        obstacles: vec![
            ObstacleData::Sphere([3 * STEP, 0, STEP], (STEP / 2).unsigned_abs(), ONE / 8),
            ObstacleData::Plane([0, -3 * STEP, 0], [0, 1 << 16, 0], ONE / 2),
        ],
        pushes: Vec::new(),
    }
}

/// So many seconds of it: a second of shaking, then calm.
#[must_use]
pub fn shakes(seconds: u32) -> Shakes {
    Shakes {
        seed: 0x0c7_2055,
        ticks: seconds * SECOND,
        period: SECONDS_A_SHAKE * SECOND,
        shaken: SECOND,
        // Up to 2^23 units in the last place, 2 mm, a substep: some 400 m/s^2.
        shift: 8,
        axes: 7,
        held: 3,
    }
}
