//! The enclosed volume and its gradient.

use octruss_firmware::cases::volume::wide;
use octruss_firmware::cases::{CENTROID_MODES, SECTION_VOLUME, VOLUME, VOLUME_MODES};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng as _;

use super::{Expected, Judged, bits, word};
use crate::qemu::conformance::Section;
use crate::random_volume::{CentroidCase, ModesCase, VolumeCase};
use crate::reference_volume::{self, modes};
use crate::sections;

/// Control points of a region.
const POINTS: u16 = 24;

/// A form's case of a seed. One of every ten is damaged.
pub(super) fn form(seed: u32) -> Judged {
    let VolumeCase { table, pose } = VolumeCase::new(u64::from(seed), POINTS);
    let section = sections::volume_form(&table);
    let mut words = vec![word(pose.len()), word(section.len())];
    words.extend(section.chunks(4).map(|chunk| {
        let mut bytes = [0; 4];
        bytes[..chunk.len()].copy_from_slice(chunk);
        u32::from_le_bytes(bytes)
    }));
    words.extend(bits(&pose));
    let want = table.evaluate(&pose);
    let mut numbers = wide(want.volume).to_vec();
    numbers.push(want.volume_saturated);
    numbers.extend(wide(want.volume));
    numbers.push(want.saturated);
    let gradient = want.gradient.as_flattened();
    numbers.extend(gradient.iter().flat_map(|&coordinate| wide(coordinate)));
    let expected = Expected {
        sections: vec![Section {
            tag: SECTION_VOLUME,
            words: numbers,
        }],
        coordinates: 2 + gradient.len(),
        saturated: want.saturated as usize,
        ..Expected::default()
    };
    judged(VOLUME, seed, words, expected)
}

/// A polynomial's case of a seed. One of every ten is damaged.
pub(super) fn polynomial(seed: u32) -> Judged {
    let ModesCase {
        coefficients,
        amplitudes,
    } = ModesCase::new(u64::from(seed));
    let mut words = vec![word(amplitudes.len()), word(coefficients.len())];
    words.extend(coefficients.iter().map(|number| number.cast_unsigned()));
    words.extend(amplitudes.iter().map(|number| number.cast_unsigned()));
    let (volume, derivatives) = modes(amplitudes.len(), &coefficients, &amplitudes);
    let numbers = [volume, volume].into_iter().chain(derivatives);
    let words_expected: Vec<u32> = numbers.flat_map(wide).collect();
    let expected = Expected {
        coordinates: words_expected.len() / 2,
        sections: vec![Section {
            tag: SECTION_VOLUME,
            words: words_expected,
        }],
        ..Expected::default()
    };
    judged(VOLUME_MODES, seed, words, expected)
}

/// A centroid's case of a seed. One of every ten is damaged.
pub(super) fn centroid(seed: u32) -> Judged {
    let case = CentroidCase::new(u64::from(seed));
    let (coefficients, amplitudes) = (&case.coefficients, &case.amplitudes);
    let mut words = vec![word(amplitudes.len()), word(coefficients.len())];
    words.push(case.shift.cast_unsigned());
    words.extend(wide(case.volume));
    words.extend(coefficients.iter().map(|number| number.cast_unsigned()));
    words.extend(amplitudes.iter().map(|number| number.cast_unsigned()));
    if case.volume <= 0 {
        // Refused: what comes of it is for core on the host to say.
        let mut refused = Judged::sound(CENTROID_MODES, seed, words, Expected::default());
        refused.expected = None;
        return refused;
    }
    let (offset, saturated) =
        reference_volume::centroid(coefficients, amplitudes, case.volume, case.shift);
    let expected = Expected {
        coordinates: offset.len(),
        sections: vec![Section {
            tag: SECTION_VOLUME,
            words: offset
                .map(i32::cast_unsigned)
                .into_iter()
                .chain([saturated])
                .collect(),
        }],
        saturated: saturated as usize,
        ..Expected::default()
    };
    judged(CENTROID_MODES, seed, words, expected)
}

fn judged(kind: u32, seed: u32, words: Vec<u32>, expected: Expected) -> Judged {
    let judged = Judged::sound(kind, seed, words, expected);
    if seed.is_multiple_of(10) {
        judged.damaged(&mut ChaCha8Rng::seed_from_u64(u64::from(seed)))
    } else {
        judged
    }
}
