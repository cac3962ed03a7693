//! Amplitudes for goals, with and without a volume to hold.

use octruss_firmware::cases::volume::wide;
use octruss_firmware::cases::{CASE_WORDS_AT_MOST, INVERSE, SECTION_INVERSE, SENSORS};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng as _;

use super::{Expected, Judged, bits, word};
use crate::qemu::conformance::Section;
use crate::random_inverse::InverseCase;

/// The case of a seed, with or without a volume. One of every ten is damaged.
pub(super) fn case(seed: u32, with_volume: bool) -> Judged {
    // Of a solver that is too large for a case another is drawn.
    let draws = (0..).map(|draw| InverseCase::any(u64::from(seed) + (draw << 32), with_volume));
    let mut sized = draws.map(|case| (words(&case), case));
    let (words, case) = sized
        .find(|(words, _)| words.len() <= CASE_WORDS_AT_MOST)
        .expect("small solvers are drawn too");
    let kind = if with_volume { INVERSE } else { SENSORS };
    let expected = expected(&case);
    let judged = Judged::sound(kind, seed, words, expected);
    if seed.is_multiple_of(10) {
        judged.damaged(&mut ChaCha8Rng::seed_from_u64(u64::from(seed)))
    } else {
        judged
    }
}

fn words(case: &InverseCase) -> Vec<u32> {
    let section = case.section();
    let (section, _) = section.as_chunks();
    let mut words = vec![word(section.len())];
    words.extend(section.iter().map(|bytes| u32::from_le_bytes(*bytes)));
    if let Some(wanted) = &case.wanted {
        words.push(word(wanted.coefficients.len()));
        words.extend(wanted.coefficients.iter().map(|own| own.cast_unsigned()));
        words.extend([wanted.low, wanted.high].into_iter().flat_map(wide));
    }
    let start = case.start.as_deref().unwrap_or_default();
    words.push(word(start.len()));
    words.extend(start.iter().map(|own| own.cast_unsigned()));
    words.push(word(case.goals.len()));
    words.extend(case.goals.iter().flat_map(|goals| bits(goals)));
    words
}

fn expected(case: &InverseCase) -> Expected {
    let mut memory = case.table.memory();
    if let Some(start) = &case.start {
        memory.start_from(start);
    }
    let mut expected = Expected::default();
    for goals in &case.goals {
        let said = case.table.tick(goals, case.wanted.as_ref(), &mut memory);
        let mut words = vec![said.gave_up, said.held, said.sweeps, said.evaluations];
        words.extend(wide(said.volume));
        let amplitudes = memory.amplitudes.iter();
        words.extend(amplitudes.map(|own| i32::try_from(*own).map_or(0, i32::cast_unsigned)));
        expected.coordinates += memory.amplitudes.len() + 1;
        expected.sections.push(Section {
            tag: SECTION_INVERSE,
            words,
        });
    }
    expected
}
