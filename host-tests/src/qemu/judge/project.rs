//! The nearest pose under limits and volumes.

use octruss_firmware::cases::volume::wide;
use octruss_firmware::cases::{CASE_WORDS_AT_MOST, PROJECT, SECTION_PROJECT};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng as _;

use super::{Expected, Judged, bits, word};
use crate::qemu::conformance::Section;
use crate::random_project::ProjectCase;
use crate::reference_project::project;
use crate::sections;

/// Control points of a region.
const POINTS: u16 = 16;
/// Regions whose volumes a report has room for.
const VOLUMES: usize = 4;

/// The case of a seed. One of every ten is damaged.
pub(super) fn case(seed: u32) -> Judged {
    // Of a problem that is too large for a case another is drawn.
    let draws = (0..).map(|draw| ProjectCase::new(u64::from(seed) + (draw << 32), POINTS));
    let mut sized = draws.map(|case| (words(&case), case));
    let (words, case) = sized
        .find(|(words, _)| words.len() <= CASE_WORDS_AT_MOST)
        .expect("small problems are drawn too");
    if seed.is_multiple_of(10) {
        let mut rng = ChaCha8Rng::seed_from_u64(u64::from(seed));
        return Judged::sound(PROJECT, seed, words, Expected::default()).damaged(&mut rng);
    }
    let expected = expected(&case);
    Judged::sound(PROJECT, seed, words, expected)
}

fn words(case: &ProjectCase) -> Vec<u32> {
    let mut words = vec![word(case.goal.len())];
    words.extend(section(&sections::limits(&case.limits)));
    words.push(word(case.regions.len()));
    for region in &case.regions {
        words.extend(section(&sections::volume_form(&region.form)));
        words.extend([region.least, region.greatest].into_iter().flat_map(wide));
    }
    words.extend(bits(&case.goal));
    words.extend(bits(&case.before));
    words
}

/// Its length in bytes, then the bytes, filled up with zeros.
fn section(bytes: &[u8]) -> Vec<u32> {
    let padded = bytes.chunks(4).map(|chunk| {
        let mut word = [0; 4];
        word[..chunk.len()].copy_from_slice(chunk);
        u32::from_le_bytes(word)
    });
    std::iter::once(word(bytes.len())).chain(padded).collect()
}

fn expected(case: &ProjectCase) -> Expected {
    let want = project(&case.limits, &case.regions, &case.goal, &case.before);
    // The reasons in the order of their bits.
    let reasons = want.gave_up.iter().zip(0..);
    let gave_up = reasons.fold(0, |bits, (&is_set, place)| {
        bits | (u32::from(is_set) << place)
    });
    let mut words = vec![gave_up, want.missed, want.steps];
    let volumes = want.volumes.iter().copied().chain(std::iter::repeat(0));
    words.extend(volumes.take(VOLUMES).flat_map(wide));
    words.extend(bits(&want.pose));
    Expected {
        coordinates: 3 * want.pose.len() + want.volumes.len(),
        sections: vec![Section {
            tag: SECTION_PROJECT,
            words,
        }],
        ..Expected::default()
    }
}
