//! Scalar channels through tables in bundles.

use octruss_firmware::cases::{APPLY_SCALARS, SECTION_SCALARS};
use rand::RngExt as _;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng as _;

use super::apply::{bundle_words, rows_of};
use super::{Expected, Judged, bits, word};
use crate::qemu::conformance::Section;
use crate::random_bundle::{BundleCase, layout};
use crate::random_mesh::random_points;
use crate::reference::apply_absolute;

/// The case of a seed: one, two or three channels. One of every ten is damaged.
pub(super) fn case(seed: u32) -> Judged {
    match seed % 3 {
        0 => case_of::<1>(seed),
        1 => case_of::<2>(seed),
        _ => case_of::<3>(seed),
    }
}

fn case_of<const D: usize>(seed: u32) -> Judged {
    const ROWS: usize = 16;
    const POINTS: u16 = 48;
    let bundle = BundleCase::new(u64::from(seed), ROWS, POINTS, layout(u64::from(seed / 10)));
    let mut rng = ChaCha8Rng::seed_from_u64(u64::from(seed));
    let start = rng.random_range(0..=bundle.order.len());
    let end = rng.random_range(start..=bundle.order.len());
    let values: Vec<[i32; D]> = random_points(&mut rng, bundle.case.pose.len());
    let numbers = [D, start, end, end - start, values.len(), bundle.bytes.len()];
    let mut words: Vec<u32> = numbers.map(word).to_vec();
    words.extend(bundle_words(&bundle.bytes));
    words.extend(bits(&values));
    let judged = Judged::sound(
        APPLY_SCALARS,
        seed,
        words,
        applied(&bundle, start, end, &values),
    );
    if seed.is_multiple_of(10) {
        judged.damaged(&mut rng)
    } else {
        judged
    }
}

/// These rows alone, for only they may count what saturates.
fn applied<const D: usize>(
    bundle: &BundleCase,
    start: usize,
    end: usize,
    values: &[[i32; D]],
) -> Expected {
    let part = rows_of(bundle, start, end);
    let applied = apply_absolute(&part.case.table, values).expect("a sound table");
    let mut words = vec![word(applied.saturated)];
    words.extend(bits(&applied.points));
    Expected {
        sections: vec![Section {
            tag: SECTION_SCALARS,
            words,
        }],
        coordinates: D * applied.points.len(),
        saturated: applied.saturated,
        ..Expected::default()
    }
}
