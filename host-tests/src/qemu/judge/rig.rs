//! Skeletons and the control points that they carry.

use std::sync::LazyLock;

use num_bigint::BigInt;
use num_traits::ToPrimitive as _;
use octruss_firmware::cases::volume::wide;
use octruss_firmware::cases::{RIG, SECTION_RIG, TURN};
use rand::RngExt as _;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng as _;

use super::{Expected, Judged, bits, word};
use crate::qemu::conformance::Section;
use crate::random_rig::RigCase;
use crate::reference_rig::{RigData, Turns};

/// Joints and control points at most: a case fits 2048 words.
const JOINTS: usize = 31;
const POINTS: usize = 100;
/// Angles of a case.
const ANGLES: usize = 500;

static TURNS: LazyLock<Turns> = LazyLock::new(Turns::new);

/// A rig's case of a seed. One of every ten is damaged.
pub(super) fn case(seed: u32) -> Judged {
    let case = RigCase::new(u64::from(seed), JOINTS, POINTS);
    let section = section(&case.rig);
    let mut words = vec![
        word(case.rig.rest.len()),
        word(case.rig.joints.len()),
        word(4 * section.len()),
    ];
    words.extend(section);
    words.extend(bits(&case.rig.rest));
    words.extend(case.angles.iter().map(|angle| angle.cast_unsigned()));
    words.extend(bits(&[case.base]));
    words.extend(bits(&case.pose));
    let placed = case.rig.frames(&TURNS, &case.angles, case.base);
    let (pose, clamped) = case.rig.carry(&placed, &case.pose);
    let mut numbers = vec![clamped];
    for frame in &placed {
        numbers.extend(frame.rotation.as_flattened().iter().map(narrow));
        let pivot = frame.pivot.iter();
        numbers.extend(pivot.flat_map(|value| wide(value.to_i64().unwrap_or_default())));
    }
    numbers.extend(bits(&pose));
    judged(RIG, seed, words, numbers, clamped as usize)
}

/// Angles of a seed. One case of every ten is damaged, which is one of other angles here.
pub(super) fn turn(seed: u32) -> Judged {
    let mut rng = ChaCha8Rng::seed_from_u64(u64::from(seed));
    let angles: Vec<i32> = (0..ANGLES).map(|_| rng.random()).collect();
    let words = angles.iter().map(|angle| angle.cast_unsigned());
    let pairs = angles.iter().flat_map(|&angle| TURNS.of(angle));
    let numbers = pairs.map(|value| narrow(&value)).collect();
    judged(TURN, seed, words.collect(), numbers, 0)
}

fn judged(kind: u32, seed: u32, words: Vec<u32>, numbers: Vec<u32>, saturated: usize) -> Judged {
    let expected = Expected {
        coordinates: numbers.len(),
        saturated,
        sections: vec![Section {
            tag: SECTION_RIG,
            words: numbers,
        }],
        ..Expected::default()
    };
    let judged = Judged::sound(kind, seed, words, expected);
    if seed.is_multiple_of(10) {
        judged.damaged(&mut ChaCha8Rng::seed_from_u64(u64::from(seed)))
    } else {
        judged
    }
}

fn narrow(value: &BigInt) -> u32 {
    value.to_i32().unwrap_or_default().cast_unsigned()
}

/// The rig as it lies in a bundle: the layout of `octruss::control::rig::RigRecord`.
fn section(rig: &RigData) -> Vec<u32> {
    let influences: usize = rig.influences.iter().map(Vec::len).sum();
    let mut words = vec![
        word(rig.joints.len()),
        word(rig.rest.len()),
        word(influences),
        0,
    ];
    for joint in &rig.joints {
        words.push(joint.parent.map_or(u32::MAX, word));
        words.extend(bits(&[joint.pivot, joint.axis]));
    }
    let mut start = 0;
    words.push(start);
    for influences in &rig.influences {
        start += word(influences.len());
        words.push(start);
    }
    let pairs = rig.influences.iter().flatten();
    words.extend(pairs.map(|&(joint, weight)| u32::from(joint) | u32::from(weight) << 16));
    words
}
