//! What solids carry beside their shape: scalar channels, labels of cells, and crease surfaces between
//! materials.

use octruss_firmware::cases::data::CHANNELS;
use octruss_firmware::cases::{REFINE_DATA, SECTION_CHANNELS, SECTION_LABELS};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng as _;

use super::tet_oct::{boundary_word, push_solid};
use super::{Expected, Judged, bits, word};
use crate::qemu::conformance::Section;
use crate::random_data::DataCase;
use crate::random_mesh::Limits;
use crate::reference::{refine, split, split_labels};

/// The case of a seed. One of every ten is damaged.
pub(super) fn case(seed: u32) -> Judged {
    // Boundary choices take turns by fives and damage by tens: see the division in `tet_oct`.
    let random = DataCase::new(u64::from(seed) + u64::from(seed) / 10, &Limits::default());
    let mut words = vec![boundary_word(random.boundary), random.levels];
    let unused = vec![[0; 3]; random.solid.vertex_count];
    push_solid(&mut words, &random.solid, &unused);
    words.extend(bits(&random.channels));
    words.extend(&random.labels);
    let judged = Judged::sound(REFINE_DATA, seed, words, refined(random));
    if seed.is_multiple_of(10) {
        judged.damaged(&mut ChaCha8Rng::seed_from_u64(u64::from(seed)))
    } else {
        judged
    }
}

fn refined(case: DataCase<CHANNELS>) -> Expected {
    let (mut solid, mut channels, mut labels) = (case.solid, case.channels, case.labels);
    let mut expected = Expected::default();
    for level in 1..=case.levels {
        labels = split_labels(&solid, &split(&solid), &labels);
        let refined = match refine(&solid, &channels, case.boundary) {
            Ok(refined) => refined,
            // A case that the reference refuses is no sound one, and nothing will match.
            Err(_) => return Expected::default(),
        };
        (solid, channels) = (refined.solid, refined.points);
        expected.saturated += refined.saturated;
        expected.coordinates += CHANNELS * channels.len();
        let mut words = vec![level, word(expected.saturated)];
        words.extend(bits(&channels));
        expected.push(SECTION_CHANNELS, words);
        let (tetrahedra, octahedra) = labels.split_at(solid.tetrahedra.len());
        for labels in [tetrahedra, octahedra] {
            expected.push(SECTION_LABELS, [&[level], labels].concat());
        }
    }
    expected
}

impl Expected {
    fn push(&mut self, tag: u32, words: Vec<u32>) {
        self.sections.push(Section { tag, words });
    }
}
