//! Control points on springs.

use crc::{CRC_32_ISO_HDLC, Crc};
use num_traits::ToPrimitive as _;
use octruss_firmware::cases::springs::Shakes;
use octruss_firmware::cases::volume::wide;
use octruss_firmware::cases::{SECTION_SPRINGS, SHAKES, SPRINGS};
use rand::RngExt as _;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng as _;

use super::{Expected, Judged, bits, word};
use crate::qemu::conformance::{Case, Section};
use crate::random_springs::SpringsCase;
use crate::reference_springs::{Moving, ObstacleData, SpringsData};

/// Control points and ticks of a case at most.
const POINTS: usize = 16;
const TICKS: usize = 6;

/// Ticks of a case of shakes, and of each of its hashes.
const SHAKEN_TICKS: u32 = 40;
const TICKS_A_HASH: u32 = 10;

/// A case of single ticks of a seed. One of every ten is damaged.
pub(super) fn case(seed: u32) -> Judged {
    let case = SpringsCase::new(u64::from(seed), POINTS, TICKS);
    let mut words = opening(&case);
    words.extend(case.pushes.iter().flat_map(|pushes| bits(pushes)));
    let mut state = moving(&case);
    let mut sections = Vec::new();
    let mut saturated = 0;
    for pushes in &case.pushes {
        let clamped = case
            .data
            .tick(&case.goals, pushes, &case.obstacles, &mut state);
        let pose: Vec<[i32; 3]> = state.iter().map(Moving::place).collect();
        sections.push(std::iter::once(clamped).chain(bits(&pose)).collect());
        saturated += clamped as usize;
    }
    sections.push(numbers(&state).flat_map(wide).collect());
    judged(SPRINGS, seed, words, sections, saturated)
}

/// A case of shakes of a seed. One of every ten is damaged.
pub(super) fn shakes(seed: u32) -> Judged {
    let case = SpringsCase::new(u64::from(seed) + (1 << 32), POINTS, 1);
    let mut rng = ChaCha8Rng::seed_from_u64(u64::from(seed));
    let shakes = Shakes {
        seed: rng.random_range(1..=u32::MAX),
        ticks: SHAKEN_TICKS,
        period: rng.random_range(5..20),
        shaken: rng.random_range(1..10),
        shift: rng.random_range(0..31),
        axes: rng.random_range(1..8),
        held: rng.random_range(1..4),
    };
    let words = shaken_words(&case, shakes, TICKS_A_HASH);
    let sections = shaken(&case, shakes, TICKS_A_HASH);
    judged(SHAKES, seed, words, sections, 0)
}

/// The case of a number of ticks of shakes, for a run of its own.
#[must_use]
pub fn shaken_case(case: &SpringsCase, shakes: Shakes, ticks_a_hash: u32) -> Case {
    Case {
        kind: SHAKES,
        number: 0,
        words: shaken_words(case, shakes, ticks_a_hash),
    }
}

fn shaken_words(case: &SpringsCase, shakes: Shakes, ticks_a_hash: u32) -> Vec<u32> {
    let mut words = opening(case);
    words.extend([
        shakes.seed,
        shakes.ticks,
        shakes.period,
        shakes.shaken,
        shakes.shift,
        shakes.axes,
        shakes.held,
        ticks_a_hash,
    ]);
    words
}

/// What the reference makes of shakes: a hash and how often was clamped, for each so many ticks.
#[must_use]
pub fn shaken(case: &SpringsCase, mut shakes: Shakes, ticks_a_hash: u32) -> Vec<Vec<u32>> {
    let mut state = moving(case);
    let mut pushes = vec![[0; 3]; case.goals.len()];
    let mut sections = Vec::new();
    let mut clamped = 0_u32;
    for tick in 0..shakes.ticks {
        shakes.shake(tick, &mut pushes);
        let count = case
            .data
            .tick(&case.goals, &pushes, &case.obstacles, &mut state);
        clamped = clamped.saturating_add(count);
        if tick % ticks_a_hash == ticks_a_hash - 1 {
            sections.push(vec![hash(&state), clamped]);
        }
    }
    sections
}

fn hash(state: &[Moving]) -> u32 {
    let bytes: Vec<u8> = numbers(state).flat_map(i64::to_le_bytes).collect();
    Crc::<u32>::new(&CRC_32_ISO_HDLC).checksum(&bytes)
}

/// Position and velocity of every point.
fn numbers(state: &[Moving]) -> impl Iterator<Item = i64> {
    let vectors = state
        .iter()
        .flat_map(|moving| [&moving.position, &moving.velocity]);
    vectors
        .flatten()
        .map(|value| value.to_i64().unwrap_or_default())
}

fn moving(case: &SpringsCase) -> Vec<Moving> {
    let state = case.state.iter();
    state
        .map(|&[position, velocity]| Moving::new(position, velocity))
        .collect()
}

fn judged(
    kind: u32,
    seed: u32,
    words: Vec<u32>,
    sections: Vec<Vec<u32>>,
    saturated: usize,
) -> Judged {
    let section = |words| Section {
        tag: SECTION_SPRINGS,
        words,
    };
    let expected = Expected {
        coordinates: sections.iter().map(Vec::len).sum(),
        saturated,
        sections: sections.into_iter().map(section).collect(),
        ..Expected::default()
    };
    let judged = Judged::sound(kind, seed, words, expected);
    if seed.is_multiple_of(10) {
        judged.damaged(&mut ChaCha8Rng::seed_from_u64(u64::from(seed)))
    } else {
        judged
    }
}

/// What both kinds begin with.
fn opening(case: &SpringsCase) -> Vec<u32> {
    let section = section(&case.data);
    let mut words = vec![
        word(case.goals.len()),
        word(case.obstacles.len()),
        word(4 * section.len()),
    ];
    words.extend(section);
    words.extend(bits(&case.goals));
    for obstacle in &case.obstacles {
        let (grip, kind, radius, places) = match *obstacle {
            ObstacleData::Plane(point, normal, grip) => (grip, 0, 0, [point, normal]),
            ObstacleData::Sphere(centre, radius, grip) => (grip, 1, radius, [centre, [0; 3]]),
            ObstacleData::Capsule(ends, radius, grip) => (grip, 2, radius, ends),
        };
        words.extend([grip, kind, radius]);
        words.extend(bits(&places));
    }
    let state = case.state.as_flattened().as_flattened();
    words.extend(state.iter().flat_map(|&number| wide(number)));
    words
}

/// The springs as they lie in a bundle: the layout of `octruss::control::springs::SpringsRecord`.
fn section(data: &SpringsData) -> Vec<u32> {
    let mut words = vec![
        word(data.points.len()),
        word(data.springs.len()),
        data.substeps,
        data.drag,
        data.damping,
        data.push_shift,
        0,
        0,
    ];
    words.extend(data.gravity.into_iter().flat_map(wide));
    words.extend(data.points.as_flattened());
    for spring in &data.springs {
        let [first, second] = spring.ends.map(word);
        words.extend([first | second << 16, spring.length, spring.shift]);
        words.extend(spring.factors);
    }
    words
}
