//! Bundles of random tables, written from the documented layout alone.

use octruss::bundle::{
    ALIGNMENT, BOUNDARY_LOOP, Header, MAGIC, RESIDUAL_LIMIT, SCHEME_TET_OCT, VERSION, checksum,
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
        let table = &case.table;
        let mut bytes = Vec::new();
        for residual in residuals(case).as_flattened() {
            bytes.extend(residual.to_le_bytes());
        }
        for coordinate in case.rest_pose.as_flattened() {
            bytes.extend(coordinate.to_le_bytes());
        }
        for start in &table.offsets {
            bytes.extend(start.to_le_bytes());
        }
        for weight in &table.weights {
            bytes.extend(weight.to_le_bytes());
        }
        for index in &table.indices {
            bytes.extend(index.to_le_bytes());
        }
        bytes.resize(bytes.len().next_multiple_of(ALIGNMENT), 0);
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
            rows: count(table.row_count()),
            taps: count(table.weights.len()),
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

/// The first row with a residual that a bundle may not hold.
pub fn row_with_a_great_residual(case: &ApplyCase<3>) -> Option<u32> {
    let is_great = |row: &[i64; 3]| row.iter().any(|residual| residual.abs() > RESIDUAL_LIMIT);
    let place = residuals(case).iter().position(is_great)?;
    u32::try_from(place).ok()
}
