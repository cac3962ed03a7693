//! Where the sections lie.

use core::mem::size_of;
use core::ops::Range;

use crc::{CRC_32_ISO_HDLC, Crc};

use super::header::Header;

/// The address of a bundle is a multiple of this many bytes.
pub const ALIGNMENT: usize = 8;

/// The greatest magnitude of a residual: `2^62 - 2^30`. Added to a row's sum, which is at most
/// `2^62`, and to the half of the rounding rule it fits 64 bits.
pub const RESIDUAL_LIMIT: i64 = (1 << 62) - (1 << 30);

/// The bytes of each section.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Sections {
    /// Three `i64` for each row.
    pub residuals: Range<usize>,
    /// Three `i32` for each control point.
    pub rest_cage: Range<usize>,
    /// One `u32` for each row, and one more.
    pub row_starts: Range<usize>,
    /// One `i32` for each tap.
    pub weights: Range<usize>,
    /// One `u16` for each tap.
    pub indices: Range<usize>,
    /// Bytes of the whole bundle, padding included.
    pub total: usize,
}

impl Sections {
    /// The sections of a bundle of this size; `None` if it would be longer than memory.
    #[must_use]
    pub fn new(control_points: usize, rows: usize, taps: usize) -> Option<Self> {
        let residuals = section(size_of::<Header>(), rows, 24)?;
        let rest_cage = section(residuals.end, control_points, 12)?;
        let row_starts = section(rest_cage.end, rows.checked_add(1)?, 4)?;
        let weights = section(row_starts.end, taps, 4)?;
        let indices = section(weights.end, taps, 2)?;
        let total = indices.end.checked_next_multiple_of(ALIGNMENT)?;
        Some(Self {
            residuals,
            rest_cage,
            row_starts,
            weights,
            indices,
            total,
        })
    }
}

fn section(start: usize, elements: usize, each: usize) -> Option<Range<usize>> {
    Some(start..start.checked_add(elements.checked_mul(each)?)?)
}

/// CRC-32 (ISO 3309) with its table of 256 words.
const CRC_32: Crc<u32> = Crc::<u32>::new(&CRC_32_ISO_HDLC);

/// The checksum of some bytes, as the header's fields for cage and model hold it.
#[must_use]
pub fn checksum_of(bytes: &[u8]) -> u32 {
    CRC_32.checksum(bytes)
}

/// The checksum of a whole bundle, as its header holds it: of all bytes, those of the checksum
/// itself taken as zero.
#[must_use]
pub fn checksum(bundle: &[u8]) -> u32 {
    /// Place of [`Header::checksum`].
    const FIELD: usize = core::mem::offset_of!(Header, checksum);
    const AFTER: usize = FIELD + size_of::<u32>();
    let mut digest = CRC_32.digest();
    digest.update(bundle.get(..FIELD).unwrap_or_default());
    digest.update(&[0; 4]);
    digest.update(bundle.get(AFTER..).unwrap_or_default());
    digest.finalize()
}
