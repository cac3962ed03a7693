//! Opening bundles: a good one opens, and everything that `apply` relies on is refused when it
//! does not hold. The bytes are laid out here from the documented format, by hand.
#![expect(
    clippy::arithmetic_side_effects,
    clippy::as_conversions,
    clippy::indexing_slicing,
    clippy::unwrap_used,
    reason = "tests fail by panicking"
)]

use fixed::types::{I12F20, I16F16};
use octruss::bundle::{self, ALIGNMENT, Bundle, BundleError, START_LIMIT, checksum};
use octruss::deform::ApplyError;

/// One in the weights' format.
const ONE: i32 = 1 << 30;

/// Bytes that start on a multiple of eight.
#[derive(Clone)]
struct Aligned {
    words: Vec<u64>,
    length: usize,
}

impl Aligned {
    fn new(bytes: &[u8]) -> Self {
        let mut words = vec![0; bytes.len().div_ceil(8)];
        for (place, &byte) in bytes.iter().enumerate() {
            words[place / 8] |= u64::from(byte) << (8 * (place % 8));
        }
        Self {
            words,
            length: bytes.len(),
        }
    }

    fn bytes(&self) -> &[u8] {
        &zerocopy::IntoBytes::as_bytes(self.words.as_slice())[..self.length]
    }
}

/// A section: kind, stage, bytes.
type Section = (u32, u32, Vec<u8>);

/// What a small bundle holds.
#[derive(Clone)]
struct Parts {
    rest_cage: Vec<[i32; 3]>,
    groups: Vec<[u16; 2]>,
    indices: Vec<u16>,
    weights: Vec<i32>,
    starts: Vec<[i64; 3]>,
    model_points: Vec<u16>,
    more: Vec<Section>,
}

fn bytes_of<const N: usize>(numbers: impl IntoIterator<Item = [u8; N]>) -> Vec<u8> {
    numbers.into_iter().flatten().collect()
}

impl Parts {
    /// Two rows over three control points, each a group of its own, in the order opposite to the model's.
    fn sound() -> Self {
        let half = 1 << 29;
        Self {
            rest_cage: vec![[0, 0, 0], [100, 0, 0], [0, 100, 7]],
            groups: vec![[1, 2], [1, 3]],
            indices: vec![0, 1, 0, 1, 2],
            weights: vec![ONE / 2, ONE / 2, ONE / 4, ONE, -ONE / 4],
            starts: vec![[half; 3], [half + (1 << 30), half - (1 << 30), half + 5]],
            model_points: vec![1, 0],
            more: Vec::new(),
        }
    }

    fn sections(&self) -> Vec<Section> {
        let stage = [3, self.starts.len() as u32, 1, 2, 0, 0, 0, 0];
        let mut sections = vec![
            (
                1,
                0,
                bytes_of(self.rest_cage.iter().flatten().map(|x| x.to_le_bytes())),
            ),
            (2, 0, bytes_of(stage.map(u32::to_le_bytes))),
            (
                3,
                0,
                bytes_of(self.groups.iter().flatten().map(|x| x.to_le_bytes())),
            ),
            (4, 0, bytes_of(self.indices.iter().map(|x| x.to_le_bytes()))),
            (5, 0, bytes_of(self.weights.iter().map(|x| x.to_le_bytes()))),
            (
                6,
                0,
                bytes_of(self.starts.iter().flatten().map(|x| x.to_le_bytes())),
            ),
            (
                7,
                0,
                bytes_of(self.model_points.iter().map(|x| x.to_le_bytes())),
            ),
        ];
        sections.extend(self.more.iter().cloned());
        sections
    }

    fn bytes(&self) -> Vec<u8> {
        lay_out(self.rest_cage.len(), self.starts.len(), &self.sections())
    }
}

/// The bytes of a bundle as `docs/bundle.md` has them.
fn lay_out(control_points: usize, rows: usize, sections: &[Section]) -> Vec<u8> {
    let mut bytes = Vec::new();
    bytes.extend(b"octruss\0");
    bytes.extend(1_u32.to_le_bytes());
    bytes.extend([0; 8]); // length and checksum follow below
    bytes.extend(16_u32.to_le_bytes());
    bytes.extend(b"mm\0\0\0\0\0\0\0\0\0\0\0\0\0\0");
    let counts = [control_points, rows, sections.len()].map(|count| count as u32);
    for field in [1, 1, 2].into_iter().chain(counts) {
        bytes.extend(field.to_le_bytes());
    }
    bytes.extend(0x1234_5678_u32.to_le_bytes());
    bytes.extend(0x9abc_def0_u32.to_le_bytes());
    bytes.resize(128, 0);
    let mut end = 128 + 16 * sections.len();
    for (kind, stage, section) in sections {
        let offset = end.next_multiple_of(ALIGNMENT);
        for field in [*kind, *stage, offset as u32, section.len() as u32] {
            bytes.extend(field.to_le_bytes());
        }
        end = offset + section.len();
    }
    for (_, _, section) in sections {
        bytes.resize(bytes.len().next_multiple_of(ALIGNMENT), 0);
        bytes.extend(section);
    }
    bytes.resize(bytes.len().next_multiple_of(ALIGNMENT), 0);
    let length = bytes.len() as u32;
    bytes[12..16].copy_from_slice(&length.to_le_bytes());
    seal(&mut bytes);
    bytes
}

/// Puts the right checksum in.
fn seal(bytes: &mut [u8]) {
    let sum = checksum(bytes);
    bytes[16..20].copy_from_slice(&sum.to_le_bytes());
}

fn open(bytes: &[u8]) -> Result<(), BundleError> {
    Bundle::new_checked(Aligned::new(bytes).bytes()).map(|_| ())
}

/// The error after a change of the parts.
fn error_of(change: impl FnOnce(&mut Parts)) -> BundleError {
    let mut parts = Parts::sound();
    change(&mut parts);
    open(&parts.bytes()).unwrap_err()
}

#[test]
fn a_sound_bundle_opens_and_tells_what_it_holds() {
    let bytes = Aligned::new(&Parts::sound().bytes());
    let bundle = Bundle::new_checked(bytes.bytes()).unwrap();
    assert_eq!(bundle.unit(), "mm");
    assert_eq!(bundle.header().levels.get(), 2);
    assert_eq!(bundle.header().cage_checksum.get(), 0x1234_5678);
    assert_eq!(bundle.header().model_checksum.get(), 0x9abc_def0);
    assert_eq!(bundle.rest_cage()[2], [0, 100, 7]);
    assert_eq!(bundle.model_points().iter().collect::<Vec<_>>(), [1, 0]);
    assert_eq!(bundle.model_points().get(2), None);
    let table = bundle.table::<I16F16>().unwrap();
    assert_eq!(
        (table.rows(), table.control_points(), table.taps()),
        (2, 3, 5)
    );
    let wrong = bundle.table::<I12F20>().unwrap_err();
    assert_eq!(
        wrong,
        BundleError::FractionBits {
            bundle: 16,
            wanted: 20
        }
    );
    assert_eq!(
        bundle.factored_table::<I16F16>().unwrap_err(),
        BundleError::OtherTable
    );
    assert_eq!(
        bundle.compact_table::<I16F16>().unwrap_err(),
        BundleError::OtherTable
    );
}

/// Sums worked out by hand: row 0 is the mean of two points, row 1 is 1/4 + 1 - 1/4.
#[test]
fn rows_are_summed_and_rounded_once() {
    let bytes = Aligned::new(&Parts::sound().bytes());
    let table = Bundle::new_checked(bytes.bytes())
        .unwrap()
        .table::<i32>()
        .unwrap();
    let pose = [[1, -1, 10], [2, -2, 20], [3, 0, 2]];
    let mut out = [[77; 3]; 4];
    assert_eq!(table.apply_absolute(0..2, &pose, &mut out[1..3]), Ok(0));
    // 1.5 -> 2, -1.5 -> -1, 15; then 1/4 + 2 - 3/4 = 1.5 -> 2, -1/4 - 2 = -2.25 -> -2,
    // 2.5 + 20 - 0.5 = 22.
    assert_eq!(out, [[77; 3], [2, -1, 15], [2, -2, 22], [77; 3]]);
    // The residual adds 1, -1 and next to nothing.
    assert_eq!(table.apply(1..2, &pose, &mut out[1..2]), Ok(0));
    assert_eq!(out, [[77; 3], [3, -3, 22], [2, -2, 22], [77; 3]]);
}

#[test]
fn lengths_that_do_not_fit_are_refused_and_nothing_is_written() {
    let bytes = Aligned::new(&Parts::sound().bytes());
    let table = Bundle::new_checked(bytes.bytes())
        .unwrap()
        .table::<i32>()
        .unwrap();
    let pose = [[1; 3]; 3];
    let mut out = [[77; 3]; 2];
    let error = table.apply(0..2, &pose[..2], &mut out).unwrap_err();
    assert_eq!(
        error,
        ApplyError::PoseLength {
            needed: 3,
            given: 2
        }
    );
    let error = table.apply(1..3, &pose, &mut out).unwrap_err();
    assert_eq!(
        error,
        ApplyError::RowRange {
            start: 1,
            end: 3,
            rows: 2
        }
    );
    let error = table
        .apply(core::ops::Range { start: 2, end: 1 }, &pose, &mut out)
        .unwrap_err();
    assert_eq!(
        error,
        ApplyError::RowRange {
            start: 2,
            end: 1,
            rows: 2
        }
    );
    let error = table.apply(0..1, &pose, &mut out).unwrap_err();
    assert_eq!(
        error,
        ApplyError::OutputLength {
            needed: 1,
            given: 2
        }
    );
    assert_eq!(out, [[77; 3]; 2]);
    assert_eq!(table.apply(2..2, &pose, &mut []), Ok(0));
}

#[test]
fn results_out_of_range_saturate_and_are_counted() {
    let mut parts = Parts::sound();
    parts.starts[1] = [START_LIMIT, -START_LIMIT, 0];
    let bytes = Aligned::new(&parts.bytes());
    let table = Bundle::new_checked(bytes.bytes())
        .unwrap()
        .table::<i32>()
        .unwrap();
    let mut out = [[0; 3]];
    let pose = [[i32::MAX, i32::MIN, i32::MAX]; 3];
    assert_eq!(table.apply(1..2, &pose, &mut out), Ok(2));
    assert_eq!(out, [[i32::MAX, i32::MIN, i32::MAX]]);
}

#[test]
fn rows_that_break_the_contract_are_refused() {
    let stage = BundleError::Stage { stage: 0 };
    let misfits: [fn(&mut Parts); 6] = [
        |parts| parts.groups[1] = [1, 4],
        |parts| parts.groups[1] = [2, 3],
        |parts| parts.groups[0] = [0, 2],
        |parts| parts.groups = vec![[1, 2]],
        |parts| parts.indices.push(0),
        |parts| parts.weights.push(0),
    ];
    for (index, misfit) in misfits.into_iter().enumerate() {
        assert_eq!(error_of(misfit), stage, "misfit {index}");
    }
    assert_eq!(
        error_of(|parts| parts.indices[4] = 3),
        BundleError::ControlPoint { row: 1 }
    );
    assert_eq!(
        error_of(|parts| parts.weights[0] += 1),
        BundleError::Weights { row: 0 }
    );
    let above_two = error_of(|parts| {
        parts.weights[3] += ONE / 4 + 1;
        parts.weights[4] -= ONE / 4 + 1;
    });
    assert_eq!(above_two, BundleError::Weights { row: 1 });
    for start in [START_LIMIT + 1, -START_LIMIT - 1, i64::MIN] {
        let start = error_of(|parts| parts.starts[1][2] = start);
        assert_eq!(start, BundleError::Start { row: 1 });
    }
    let point = error_of(|parts| parts.model_points[0] = 2);
    assert_eq!(point, BundleError::ModelPoints);
    let missing = error_of(|parts| parts.model_points.truncate(1));
    assert_eq!(missing, BundleError::ModelPoints);
}

#[test]
fn sections_that_are_not_known_are_skipped_and_known_ones_must_be_single() {
    let mut parts = Parts::sound();
    parts.more = vec![(1000, 0, vec![1, 2, 3]), (7, 9, vec![5])];
    assert_eq!(open(&parts.bytes()), Ok(()));
    parts.more = vec![(5, 0, vec![0; 20])];
    assert_eq!(open(&parts.bytes()), Err(BundleError::Section { index: 7 }));
    let mut sections = Parts::sound().sections();
    sections.remove(4);
    let bytes = lay_out(3, 2, &sections);
    assert_eq!(open(&bytes), Err(BundleError::Stage { stage: 0 }));
}

#[test]
fn sections_in_a_wrong_place_are_refused() {
    let good = Parts::sound().bytes();
    // The offset and the length of section 2: one step farther, one byte longer than all.
    for (place, value) in [(128 + 2 * 16 + 8, 8_u32), (128 + 2 * 16 + 12, u32::MAX)] {
        let mut bad = good.clone();
        let field = u32::from_le_bytes(bad[place..place + 4].try_into().unwrap());
        bad[place..place + 4].copy_from_slice(&field.saturating_add(value).to_le_bytes());
        seal(&mut bad);
        assert_eq!(open(&bad), Err(BundleError::Section { index: 2 }));
    }
}

#[test]
fn magnitudes_of_exactly_two_are_sound() {
    let mut parts = Parts::sound();
    parts.weights[2..].copy_from_slice(&[ONE / 2, ONE, -ONE / 2]);
    assert_eq!(open(&parts.bytes()), Ok(()));
}

#[test]
fn damaged_bytes_are_refused() {
    let good = Parts::sound().bytes();
    assert_eq!(open(&good), Ok(()));
    assert_eq!(
        open(&good[..100]),
        Err(BundleError::Truncated {
            needed: 128,
            given: 100
        })
    );
    let needed = good.len();
    assert_eq!(
        open(&good[..needed - 1]),
        Err(BundleError::Truncated {
            needed,
            given: needed - 1
        })
    );
    let mut longer = good.clone();
    longer.push(0);
    assert_eq!(
        open(&longer),
        Err(BundleError::TrailingBytes {
            needed,
            given: needed + 1
        })
    );
    let mut version = good.clone();
    version[8] = 9;
    seal(&mut version);
    assert_eq!(open(&version), Err(BundleError::Version { found: 9 }));
    for place in [20, 55, 40, 120, needed - 1] {
        // Fraction bits, the unit's padding made bad UTF-8, scheme, reserved bytes, padding.
        let mut bad = good.clone();
        bad[place] = 0xff;
        seal(&mut bad);
        let error = open(&bad).unwrap_err();
        assert!(
            matches!(error, BundleError::Header),
            "byte {place}: {error}"
        );
    }
    let aligned = Aligned::new(&[&[0], good.as_slice()].concat());
    let error = Bundle::new_checked(&aligned.bytes()[1..]).unwrap_err();
    assert_eq!(error, BundleError::Unaligned);
}

#[test]
fn every_single_bit_flip_is_refused() {
    let good = Parts::sound().bytes();
    for bit in 0..good.len() * 8 {
        let mut bad = good.clone();
        bad[bit / 8] ^= 1 << (bit % 8);
        assert!(open(&bad).is_err(), "bit {bit}");
    }
}

#[test]
fn the_header_is_as_long_as_documented() {
    assert_eq!(size_of::<bundle::Header>(), 128);
}
