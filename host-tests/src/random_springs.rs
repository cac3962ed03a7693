//! Random springs, states, pushes and obstacles, from a seed.

use rand::RngExt as _;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng as _;

use crate::reference_springs::{ObstacleData, SpringData, SpringsData, rest_length};

/// A factor of one.
const ONE: u32 = 1 << 16;

/// One random case.
#[derive(Clone, Debug)]
pub struct SpringsCase {
    /// The springs.
    pub data: SpringsData,
    /// The goals.
    pub goals: Vec<[i32; 3]>,
    /// Position and velocity of each point.
    pub state: Vec<[[i64; 3]; 2]>,
    /// What points cannot enter.
    pub obstacles: Vec<ObstacleData>,
    /// The pushes of each tick.
    pub pushes: Vec<Vec<[i32; 3]>>,
}

impl SpringsCase {
    /// The case of a seed with at most so many points and ticks.
    pub fn new(seed: u64, points: usize, ticks: usize) -> Self {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let count = rng.random_range(1..=points);
        // From a few units to the whole range.
        let reach = i32::MAX >> rng.random_range(0..28);
        let place = |rng: &mut ChaCha8Rng| match rng.random_range(0..40) {
            0 => [i32::MIN, i32::MAX, 0],
            _ => [0; 3].map(|_: i32| rng.random_range(-reach..=reach)),
        };
        let goals: Vec<[i32; 3]> = (0..count).map(|_| place(&mut rng)).collect();
        let rest: Vec<[i32; 3]> = if rng.random() {
            goals.clone()
        } else {
            (0..count).map(|_| place(&mut rng)).collect()
        };
        let data = springs(&mut rng, &rest);
        let wide = |place: [i32; 3]| place.map(|value| i64::from(value) << 12);
        let state = (0..count).map(|point| match rng.random_range(0..4) {
            0 => [wide(goals[point]), [0; 3]],
            1 if point > 0 => [wide(goals[point - 1]), [0; 3]],
            _ => {
                let fine = wide(place(&mut rng)).map(|value| value + rng.random_range(0..4096_i64));
                let greatest = i64::from(i32::MAX) << 12;
                let speed = i64::MAX >> rng.random_range(20..60);
                let velocity = [0; 3].map(|_: i64| rng.random_range(-speed..=speed));
                [fine.map(|value| value.min(greatest)), velocity]
            }
        });
        let state = state.collect();
        let obstacles = (0..rng.random_range(0..5)).map(|_| obstacle(&mut rng, &place, reach));
        let obstacles = obstacles.collect();
        let tick = |rng: &mut ChaCha8Rng| (0..count).map(|_| place(rng)).collect();
        let pushes = (0..rng.random_range(1..=ticks))
            .map(|_| tick(&mut rng))
            .collect();
        Self {
            data,
            goals,
            state,
            obstacles,
            pushes,
        }
    }
}

fn factor(rng: &mut ChaCha8Rng) -> u32 {
    match rng.random_range(0..6) {
        0 => 0,
        1 => ONE,
        2 => rng.random_range(0..100),
        _ => rng.random_range(0..=ONE),
    }
}

fn springs(rng: &mut ChaCha8Rng, rest: &[[i32; 3]]) -> SpringsData {
    let count = rest.len();
    let points: Vec<[u32; 2]> = (0..count).map(|_| [factor(rng), factor(rng)]).collect();
    let mut springs = Vec::new();
    for _ in 0..rng.random_range(0..=2 * count) {
        let ends = [0; 2].map(|_: usize| rng.random_range(0..count));
        let share = match ends.map(|end| points[end][0]) {
            [0, 0] => continue,
            [0, _] => 0,
            [_, 0] => ONE,
            _ => factor(rng),
        };
        if ends[0] == ends[1] {
            continue;
        }
        let stretch = factor(rng);
        let shape = if stretch == ONE {
            0
        } else {
            rng.random_range(0..=ONE - stretch)
        };
        let [a, b] = ends.map(|end| rest[end]);
        let (length, shift) = rest_length(a, b);
        springs.push(SpringData {
            ends,
            length,
            shift,
            factors: [share, stretch, shape],
        });
    }
    let limit = 1_i64 << rng.random_range(0..=43);
    SpringsData {
        points,
        springs,
        substeps: rng.random_range(1..=5),
        drag: factor(rng),
        damping: factor(rng),
        push_shift: rng.random_range(0..=12),
        gravity: [0; 3].map(|_: i64| rng.random_range(-limit..=limit)),
    }
}

fn obstacle(
    rng: &mut ChaCha8Rng,
    place: &impl Fn(&mut ChaCha8Rng) -> [i32; 3],
    reach: i32,
) -> ObstacleData {
    let grip = factor(rng);
    let radius = match rng.random_range(0..10) {
        0 => u32::MAX,
        1 => 0,
        _ => rng.random_range(0..=reach.unsigned_abs()),
    };
    match rng.random_range(0..3) {
        0 => ObstacleData::Plane(place(rng), normal(rng), grip),
        1 => ObstacleData::Sphere(place(rng), radius, grip),
        _ => {
            let first = place(rng);
            let second = if rng.random_range(0..8) == 0 {
                first
            } else {
                place(rng)
            };
            ObstacleData::Capsule([first, second], radius, grip)
        }
    }
}

/// A unit vector with 16 fraction bits.
fn normal(rng: &mut ChaCha8Rng) -> [i32; 3] {
    loop {
        let vector = [0.0; 3].map(|_: f64| rng.random_range(-1.0..1.0_f64));
        let length = vector.iter().map(|x| x * x).sum::<f64>().sqrt();
        if length > 0.1 {
            return vector.map(|x| (x / length * 65_536.0).round() as i32);
        }
    }
}
