//! Bundles of random tables, written from the documented layout alone.

use octruss::bundle::{
    ALIGNMENT, BOUNDARY_LOOP, Header, MAGIC, SCHEME_TET_OCT, START_LIMIT, VERSION, checksum,
};
use zerocopy::IntoBytes as _;
use zerocopy::byteorder::little_endian::U32;

use crate::random_table::ApplyCase;

/// A bundle's bytes at an address that is a multiple of eight.
#[derive(Clone, Debug)]
pub struct BundleBytes {
    words: Vec<u64>,
}

impl BundleBytes {
    /// The bundle of a case, for coordinates with this many fraction bits.
    pub fn new(case: &ApplyCase<3>, fraction_bits: u32) -> Self {
        let sections = sections(case);
        let mut table = Vec::new();
        let mut bytes = Vec::new();
        let start = size_of::<Header>() + 16 * sections.len();
        for (kind, section) in &sections {
            bytes.resize((start + bytes.len()).next_multiple_of(ALIGNMENT) - start, 0);
            let offset = u32::try_from(start + bytes.len()).expect("a small bundle");
            let length = u32::try_from(section.len()).expect("a small bundle");
            table.extend([*kind, 0, offset, length].map(u32::to_le_bytes));
            bytes.extend(section);
        }
        let end = (start + bytes.len()).next_multiple_of(ALIGNMENT);
        bytes.resize(end - start, 0);
        let bytes = [table.as_flattened(), &bytes].concat();
        let count = |list: usize| U32::new(u32::try_from(list).expect("fewer than 2^32"));
        let header = Header {
            magic: MAGIC,
            version: VERSION.into(),
            total_bytes: count(size_of::<Header>() + bytes.len()),
            checksum: 0.into(),
            fraction_bits: fraction_bits.into(),
            unit: *b"mm\0\0\0\0\0\0\0\0\0\0\0\0\0\0",
            scheme: SCHEME_TET_OCT.into(),
            boundary: BOUNDARY_LOOP.into(),
            levels: 1.into(),
            control_points: count(case.rest_pose.len()),
            rows: count(case.table.row_count()),
            sections: count(sections.len()),
            cage_checksum: 0.into(),
            model_checksum: 0.into(),
            reserved: [0; 56],
        };
        let mut bundle = Self::aligned(&[header.as_bytes(), &bytes].concat());
        bundle.seal();
        bundle
    }

    fn aligned(bytes: &[u8]) -> Self {
        let words = bytes.chunks(ALIGNMENT).map(|chunk| {
            let mut word = [0; ALIGNMENT];
            word[..chunk.len()].copy_from_slice(chunk);
            u64::from_ne_bytes(word)
        });
        Self {
            words: words.collect(),
        }
    }

    /// The bytes.
    pub fn bytes(&self) -> &[u8] {
        self.words.as_bytes()
    }

    /// The bytes, to damage; see [`BundleBytes::seal`].
    pub fn bytes_mut(&mut self) -> &mut [u8] {
        self.words.as_mut_bytes()
    }

    /// Writes the checksum of the bytes as they are.
    pub fn seal(&mut self) {
        let place = std::mem::offset_of!(Header, checksum);
        let sum = checksum(self.bytes());
        self.bytes_mut()[place..place + 4].copy_from_slice(&sum.to_le_bytes());
    }
}

/// The sections of a case by their kinds: every row a group of its own, weights of 30 fraction bits, start
/// values of 64 bits.
fn sections(case: &ApplyCase<3>) -> [(u32, Vec<u8>); 6] {
    let table = &case.table;
    let rows = u32::try_from(table.row_count()).expect("fewer than 2^32");
    let points = u32::try_from(case.rest_pose.len()).expect("fewer than 2^32");
    let half = 1 << 29;
    let starts = residuals(case)
        .into_iter()
        .flatten()
        .map(|residual| residual + half);
    let groups = table.offsets.windows(2).map(|ends| {
        let taps = u16::try_from(ends[1] - ends[0]).expect("short rows");
        [1, taps]
    });
    let bytes_of_4 = |words: &[i32]| words.iter().flat_map(|word| word.to_le_bytes()).collect();
    let bytes_of_2 = |words: &[u16]| words.iter().flat_map(|word| word.to_le_bytes()).collect();
    let stage = [points, rows, 1, 2, 0, 0, 0, 0];
    [
        (1, bytes_of_4(case.rest_pose.as_flattened())),
        (2, stage.into_iter().flat_map(u32::to_le_bytes).collect()),
        (3, bytes_of_2(groups.collect::<Vec<_>>().as_flattened())),
        (4, bytes_of_2(&table.indices)),
        (5, bytes_of_4(&table.weights)),
        (6, starts.flat_map(i64::to_le_bytes).collect()),
    ]
}

/// `rest * 2^30 - sum(weight * rest cage)` for each row and channel.
pub fn residuals(case: &ApplyCase<3>) -> Vec<[i64; 3]> {
    let residual = |row: usize, channel: usize| {
        let mut residual = i128::from(case.rest[row][channel]) << 30;
        for (point, weight) in case.table.row(row) {
            let at_rest = case.rest_pose[usize::from(point)][channel];
            residual -= i128::from(weight) * i128::from(at_rest);
        }
        i64::try_from(residual).expect("at most 3 * 2^61")
    };
    let rows = 0..case.table.row_count();
    rows.map(|row| [0, 1, 2].map(|channel| residual(row, channel)))
        .collect()
}

/// The first row with a start value that a bundle may not hold.
pub fn row_with_a_great_residual(case: &ApplyCase<3>) -> Option<u32> {
    let is_great = |row: &[i64; 3]| {
        row.iter()
            .any(|residual| (residual + (1 << 29)).abs() > START_LIMIT)
    };
    let place = residuals(case).iter().position(is_great)?;
    u32::try_from(place).ok()
}
