//! Random rigs and commands, from a seed.

use rand::RngExt as _;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng as _;

use crate::reference_rig::{JointData, RigData};

/// The weights of a point add up to this.
const WEIGHT_ONE: u16 = 1 << 14;

/// One random case of a rig.
#[derive(Clone, Debug)]
pub struct RigCase {
    /// The rig.
    pub rig: RigData,
    /// An angle for each joint.
    pub angles: Vec<i32>,
    /// How far it is moved.
    pub base: [i32; 3],
    /// What the pose held before.
    pub pose: Vec<[i32; 3]>,
}

impl RigCase {
    /// The case of a seed with at most so many joints and control points.
    pub fn new(seed: u64, joints: usize, points: usize) -> Self {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let joint_count = rng.random_range(1..=joints);
        let point_count = rng.random_range(0..=points);
        // From the size of a few units to the whole range, where results saturate.
        let reach = i32::MAX >> rng.random_range(0..28);
        let place = |rng: &mut ChaCha8Rng| match rng.random_range(0..40) {
            0 => [i32::MIN, i32::MAX, 0],
            _ => [0; 3].map(|_: i32| rng.random_range(-reach..=reach)),
        };
        let mut rig = RigData::default();
        for joint in 0..joint_count {
            let parent = match rng.random_range(0..10) {
                0 => None,
                1..5 => joint.checked_sub(1),
                _ => joint.checked_sub(1).map(|last| rng.random_range(0..=last)),
            };
            rig.joints.push(JointData {
                parent,
                pivot: place(&mut rng),
                axis: axis(&mut rng),
            });
        }
        for _ in 0..point_count {
            rig.rest.push(place(&mut rng));
            rig.influences.push(influences(&mut rng, joint_count));
        }
        let angle = |rng: &mut ChaCha8Rng| match rng.random_range(0..8) {
            0 => rng.random_range(-4_i32..4).wrapping_shl(29),
            1 => rng.random_range(-100..100),
            _ => rng.random(),
        };
        Self {
            angles: (0..joint_count).map(|_| angle(&mut rng)).collect(),
            base: if rng.random() {
                [0; 3]
            } else {
                place(&mut rng)
            },
            pose: (0..point_count).map(|_| place(&mut rng)).collect(),
            rig,
        }
    }
}

/// A unit vector with 30 fraction bits, or none.
fn axis(rng: &mut ChaCha8Rng) -> [i32; 3] {
    const ONE: f64 = 1_073_741_824.0;
    match rng.random_range(0..6) {
        0 => [0; 3],
        1 => [0, 0, if rng.random() { 1 << 30 } else { -(1 << 30) }],
        _ => loop {
            let vector = [0.0; 3].map(|_: f64| rng.random_range(-1.0..1.0_f64));
            let length = vector.iter().map(|x| x * x).sum::<f64>().sqrt();
            if length > 0.1 {
                break vector.map(|x| (x / length * ONE).round() as i32);
            }
        },
    }
}

fn influences(rng: &mut ChaCha8Rng, joints: usize) -> Vec<(u16, u16)> {
    let count = rng.random_range(0..=joints.min(4));
    let mut chosen: Vec<u16> = (0..count)
        .map(|_| rng.random_range(0..joints) as u16)
        .collect();
    chosen.sort_unstable();
    chosen.dedup();
    let Some(last) = chosen.len().checked_sub(1) else {
        return Vec::new();
    };
    let mut left = WEIGHT_ONE;
    let mut weight = |place: usize| {
        let others = (last - place) as u16;
        let own = if others == 0 {
            left
        } else {
            rng.random_range(1..=left - others)
        };
        left -= own;
        own
    };
    (0..chosen.len())
        .map(|place| (chosen[place], weight(place)))
        .collect()
}
