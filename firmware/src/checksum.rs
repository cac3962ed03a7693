//! Checksums of poses and of deformed models: what device and host compare on every tick.

use crc::{CRC_32_ISO_HDLC, Crc};
use octruss::deform::{ApplyError, Table};
use zerocopy::IntoBytes;

use crate::player::ROWS_A_PIECE;

/// CRC-32/ISO-HDLC with tables for sixteen bytes at once: a whole model is summed up on every tick.
static SUM: Crc<u32, crc::Table<16>> = Crc::<u32, crc::Table<16>>::new(&CRC_32_ISO_HDLC);

/// The checksum of points, raw bits, least significant byte first.
#[must_use]
pub fn of_points(points: &[[i32; 3]]) -> u32 {
    SUM.checksum(points.as_bytes())
}

/// Deforms the model with `pose`, a piece after the other, and returns the checksum of its rows and how many coordinates
/// saturated.
///
/// # Errors
///
/// [`ApplyError`] if the pose is not that of the table.
pub fn of_model(
    table: &Table<'_, i32>,
    pose: &[[i32; 3]],
    piece: &mut [[i32; 3]; ROWS_A_PIECE],
) -> Result<(u32, u32), ApplyError> {
    let mut digest = SUM.digest();
    let mut saturated = 0_u32;
    for start in (0..table.rows()).step_by(ROWS_A_PIECE) {
        let end = table.rows().min(start + ROWS_A_PIECE);
        let piece = piece.get_mut(..end - start).unwrap_or_default();
        saturated = saturated.saturating_add(table.apply(start..end, pose, piece)?);
        digest.update(piece.as_bytes());
    }
    Ok((digest.finalize(), saturated))
}
