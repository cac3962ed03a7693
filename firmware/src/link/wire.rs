//! Checked frames: a payload, its CRC-32, both in COBS, and a zero byte at the end.
//!
//! COBS (consistent overhead byte stuffing) leaves no zero inside a frame, so a receiver that has lost its place
//! finds it again at the next zero.

use crate::frame::CHECKSUM;

/// Bytes of a payload at most.
pub const PAYLOAD_BYTES: usize = 192;
/// Bytes of the checksum behind a payload.
pub const CHECKSUM_BYTES: usize = 4;
/// Bytes of a frame at most, without its zero: COBS adds one to each 254 begun.
pub const ENCODED_BYTES: usize = PAYLOAD_BYTES + CHECKSUM_BYTES + 1;

/// Why bytes between two zeros are no frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WireError {
    /// The frame ends within a block of COBS, or before its checksum.
    Truncated,
    /// The checksum does not match.
    Checksum,
}

/// Frames a payload into `out` and returns the number of bytes, the zero at the end included. `None` if the payload
/// is longer than [`PAYLOAD_BYTES`].
#[must_use]
pub fn encode(payload: &[u8], out: &mut [u8; ENCODED_BYTES + 1]) -> Option<usize> {
    let mut checked = [0; PAYLOAD_BYTES + CHECKSUM_BYTES];
    let end = payload.len().checked_add(CHECKSUM_BYTES)?;
    checked.get_mut(..payload.len())?.copy_from_slice(payload);
    let checksum = CHECKSUM.checksum(payload).to_le_bytes();
    checked
        .get_mut(payload.len()..end)?
        .copy_from_slice(&checksum);
    let length = cobs::try_encode(checked.get(..end)?, out).ok()?;
    *out.get_mut(length)? = 0;
    length.checked_add(1)
}

/// Takes the payload out of the bytes between two zeros, in place.
///
/// # Errors
///
/// [`WireError`]; the bytes are then spoilt.
pub fn decode(bytes: &mut [u8]) -> Result<&[u8], WireError> {
    let length = cobs::decode_in_place(bytes).map_err(|_| WireError::Truncated)?;
    let decoded = bytes.get(..length).ok_or(WireError::Truncated)?;
    let (payload, checksum) = decoded
        .split_last_chunk::<CHECKSUM_BYTES>()
        .ok_or(WireError::Truncated)?;
    if CHECKSUM.checksum(payload) == u32::from_le_bytes(*checksum) {
        Ok(payload)
    } else {
        Err(WireError::Checksum)
    }
}

/// Takes little-endian numbers off the front of a payload.
pub(super) struct Reader<'a>(pub &'a [u8]);

impl Reader<'_> {
    pub fn array<const N: usize>(&mut self) -> Option<[u8; N]> {
        let (bytes, rest) = self.0.split_first_chunk()?;
        self.0 = rest;
        Some(*bytes)
    }

    pub fn byte(&mut self) -> Option<u8> {
        self.array().map(u8::from_le_bytes)
    }

    pub fn half(&mut self) -> Option<u16> {
        self.array().map(u16::from_le_bytes)
    }

    pub fn word(&mut self) -> Option<u32> {
        self.array().map(u32::from_le_bytes)
    }

    pub fn signed(&mut self) -> Option<i32> {
        self.array().map(i32::from_le_bytes)
    }
}
