//! The cells that a pose folds over.

use octruss_firmware::cases::{HEALTH, SECTION_HEALTH};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng as _;

use super::{Expected, Judged, bits, word};
use crate::qemu::conformance::Section;
use crate::random_health::HealthCase;
use crate::reference_health::health;

/// Most cells.
const CELLS: usize = 24;
/// Cells that a report names.
const NAMED: usize = 8;

/// The case of a seed. One of every ten is damaged.
pub(super) fn case(seed: u32) -> Judged {
    let case = HealthCase::new(u64::from(seed), CELLS);
    let section = case.section();
    let mut words = vec![word(case.rest.len()), word(section.len())];
    words.extend(section);
    words.extend(bits(&case.rest));
    words.extend(bits(&case.pose));
    let judged = Judged::sound(HEALTH, seed, words, expected(&case));
    if seed.is_multiple_of(10) {
        judged.damaged(&mut ChaCha8Rng::seed_from_u64(u64::from(seed)))
    } else {
        judged
    }
}

fn expected(case: &HealthCase) -> Expected {
    let told = health(&case.mesh, &case.rest, &case.pose);
    let mut words = vec![
        word(told.folded.len()),
        told.least_ratio.cast_unsigned(),
        told.without_ratio,
    ];
    words.extend(told.least.unwrap_or([4, 0]));
    words.extend(told.folded.iter().take(NAMED).flatten());
    Expected {
        coordinates: words.len(),
        sections: vec![Section {
            tag: SECTION_HEALTH,
            words,
        }],
        ..Expected::default()
    }
}
