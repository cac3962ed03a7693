//! Actuators as they lie in a bundle.

use zerocopy::byteorder::little_endian::U32;
use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout, Unaligned};

use super::{Actuation, ActuationError, ActuationParts};

/// The first 16 bytes of a section of actuators. Behind it lie the displacements, `i32` each, in the order of
/// [`ActuationParts::displacements`], then the effectors' rows, `u32` each.
#[derive(Clone, Copy, Debug, FromBytes, IntoBytes, Immutable, KnownLayout, Unaligned)]
#[repr(C)]
pub struct ActuationRecord {
    /// Control points.
    pub control_points: U32,
    /// Actuators.
    pub actuators: U32,
    /// Effectors.
    pub effectors: U32,
    /// Zero.
    pub reserved: [u8; 4],
}

impl<'a> Actuation<'a> {
    /// Opens a section in place, and proves what [`Actuation::new_checked`] proves.
    ///
    /// # Errors
    ///
    /// [`ActuationError::Layout`] if the bytes are not as long as their record says or start on an address that is no
    /// multiple of 4; else those of [`Actuation::new_checked`].
    pub fn from_section(
        bytes: &'a [u8],
        rest: &'a [[i32; 3]],
        rows: usize,
    ) -> Result<Self, ActuationError> {
        let (record, bytes) =
            ActuationRecord::ref_from_prefix(bytes).map_err(|_| ActuationError::Layout)?;
        let size = |field: U32| usize::try_from(field.get()).map_err(|_| ActuationError::Layout);
        let (points, actuators) = (size(record.control_points)?, size(record.actuators)?);
        let displacements = points
            .checked_mul(3)
            .and_then(|axes| axes.checked_mul(actuators))
            .and_then(|words| words.checked_mul(4))
            .and_then(|length| bytes.split_at_checked(length));
        let (displacements, effector_rows) = displacements.ok_or(ActuationError::Layout)?;
        let effector_rows =
            <[u32]>::ref_from_bytes(effector_rows).map_err(|_| ActuationError::Layout)?;
        let fits = points == rest.len()
            && effector_rows.len() == size(record.effectors)?
            && record.reserved == [0; 4];
        if !fits {
            return Err(ActuationError::Layout);
        }
        let parts = ActuationParts {
            actuators,
            displacements: <[i32]>::ref_from_bytes(displacements)
                .map_err(|_| ActuationError::Layout)?,
            effector_rows,
        };
        Self::new_checked(parts, rest, rows)
    }
}
