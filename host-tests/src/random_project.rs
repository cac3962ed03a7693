//! Random problems of the projection of poses, from a seed.

use rand::RngExt as _;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng as _;

use crate::random_volume::VolumeCase;
use crate::reference_project::{LimitsTable, RegionTable};

/// One random problem.
#[derive(Clone, Debug)]
pub struct ProjectCase {
    /// Limits.
    pub limits: LimitsTable,
    /// Regions, up to four.
    pub regions: Vec<RegionTable>,
    /// The goal.
    pub goal: Vec<[i32; 3]>,
    /// The pose before.
    pub before: Vec<[i32; 3]>,
}

impl ProjectCase {
    /// The problem of a seed, with regions of at most `points` control points.
    pub fn new(seed: u64, points: u16) -> Self {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let regions = rng.random_range(0..=4);
        let volumes: Vec<VolumeCase> = (0..regions.max(1))
            .map(|_| VolumeCase::new(rng.random(), points))
            .collect();
        // The goal is the greatest pose; the forms name some of its points.
        let most = volumes.iter().max_by_key(|case| case.pose.len());
        let goal = most.map(|case| case.pose.clone()).unwrap_or_default();
        let before = jittered(&mut rng, &goal);
        let limits = random_limits(&mut rng, &goal);
        let regions = volumes.into_iter().take(regions).map(|case| {
            let volume = case.table.evaluate(&goal).volume;
            let [least, greatest] = random_band(&mut rng, volume);
            RegionTable {
                form: case.table,
                least,
                greatest,
            }
        });
        Self {
            regions: regions.collect(),
            limits,
            goal,
            before,
        }
    }
}

/// Another pose: the same, a little or far away.
fn jittered(rng: &mut ChaCha8Rng, pose: &[[i32; 3]]) -> Vec<[i32; 3]> {
    let bits = rng.random_range(0..=32);
    let reach = (1_i64 << bits) - 1;
    let mut moved = |&coordinate: &i32| {
        let moved = i64::from(coordinate) + rng.random_range(-reach..=reach);
        let inside = moved.clamp(i64::from(i32::MIN), i64::from(i32::MAX));
        i32::try_from(inside).expect("clamped")
    };
    pose.iter()
        .map(|point| [0, 1, 2].map(|axis| moved(&point[axis])))
        .collect()
}

/// Boxes round the goal, free or pinned coordinates, rates of any size.
fn random_limits(rng: &mut ChaCha8Rng, goal: &[[i32; 3]]) -> LimitsTable {
    let mut limits = LimitsTable {
        settled: if rng.random_bool(0.5) {
            0
        } else {
            1 << rng.random_range(0..8)
        },
        ..LimitsTable::default()
    };
    let [one, other] = [0, 1].map(|_| jittered(rng, goal));
    let style = rng.random_range(0..4);
    for (one, other) in one.iter().zip(&other) {
        let mut ends = [[0; 3]; 2];
        for axis in 0..3 {
            let [a, b] = [one[axis], other[axis]];
            let [lower, upper] = match (style, rng.random_range(0..4)) {
                (0, _) | (1, 0) => [i32::MIN, i32::MAX],
                (1, 1) => [a, a],
                _ => [a.min(b), a.max(b)],
            };
            ends[0][axis] = lower;
            ends[1][axis] = upper;
        }
        limits.lower.push(ends[0]);
        limits.upper.push(ends[1]);
        let rate = match rng.random_range(0..4) {
            0 => rng.random::<u32>() >> rng.random_range(0..32),
            _ => u32::MAX,
        };
        limits.rates.push(rate);
        limits.mobilities.push(match rng.random_range(0..6) {
            0 => rng.random_range(0..=1 << 15),
            1 => 0,
            _ => 1 << 15,
        });
    }
    limits
}

/// A volume near that of the goal, a band, an empty band, or anything.
fn random_band(rng: &mut ChaCha8Rng, volume: i64) -> [i64; 2] {
    let near = |rng: &mut ChaCha8Rng| {
        let part = i128::from(volume) * rng.random_range(-400..=400) / 1000;
        let near = (i128::from(volume) + part).clamp(i64::MIN.into(), i64::MAX.into());
        i64::try_from(near).expect("clamped")
    };
    match rng.random_range(0..8) {
        0 => [near(rng), near(rng)],
        1 => [rng.random(), rng.random()],
        2 => [i64::MIN, i64::MAX],
        3 => [volume; 2],
        _ => [near(rng); 2],
    }
}
