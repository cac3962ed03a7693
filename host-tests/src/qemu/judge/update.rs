//! Tables updated in part, factored tables, and the normals of their points.

use octruss_bake::pack::Layout;
use octruss_firmware::cases::{SECTION_NORMALS, SECTION_ROWS, UPDATE};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng as _;

use super::{Expected, Judged, bits, word};
use crate::qemu::conformance::Section;
use crate::random_update::UpdateCase;

/// The case of a seed. One of every ten is damaged.
pub(super) fn case(seed: u32) -> Judged {
    let case = UpdateCase::new(seed.into());
    let is_compact = matches!(case.layout, Layout::Compact { .. });
    let form = 2 * u32::from(case.factored) + u32::from(is_compact);
    let lengths = [case.before.len(), case.rows.len(), case.bytes.len()];
    let mut words = vec![form];
    words.extend(lengths.map(word));
    words.extend(case.bytes.chunks(4).map(|chunk| {
        let mut bytes = [0; 4];
        bytes[..chunk.len()].copy_from_slice(chunk);
        u32::from_le_bytes(bytes)
    }));
    words.extend(bits(&case.before));
    words.extend(bits(&case.behind));
    words.extend(case.moved.iter().map(|&moved| u32::from(moved)));
    let judged = Judged::sound(UPDATE, seed, words, expected(&case));
    if seed.is_multiple_of(10) {
        judged.damaged(&mut ChaCha8Rng::seed_from_u64(seed.into()))
    } else {
        judged
    }
}

fn expected(case: &UpdateCase) -> Expected {
    let mut rows = vec![0, case.clamped];
    rows.extend(bits(&case.rows));
    let (vectors, zeros) = &case.normals;
    let mut normals = vec![*zeros];
    let widened: Vec<[i32; 3]> = vectors.iter().map(|vector| vector.map(i32::from)).collect();
    normals.extend(bits(&widened));
    Expected {
        sections: vec![
            Section {
                tag: SECTION_ROWS,
                words: rows,
            },
            Section {
                tag: SECTION_NORMALS,
                words: normals,
            },
        ],
        coordinates: 6 * case.rows.len(),
        saturated: case.at_ends,
        ..Expected::default()
    }
}
