//! Limits as they lie in a bundle.

use core::mem::size_of;

use zerocopy::byteorder::little_endian::U32;
use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout, Unaligned};

use super::error::ProjectError;
use super::limits::{Limits, LimitsParts};

/// The first 16 bytes of a section of limits. Behind it lie, without a gap, the lower ends (three `i32` for each
/// point), the upper ends, the rates (`u32`) and the mobilities (`u16`).
#[derive(Clone, Copy, Debug, FromBytes, IntoBytes, Immutable, KnownLayout, Unaligned)]
#[repr(C)]
pub struct LimitsRecord {
    /// Control points.
    pub points: U32,
    /// See [`LimitsParts`].
    pub settled: U32,
    /// Zero.
    pub reserved: [U32; 2],
}

impl<'a> Limits<'a> {
    /// Opens a section in place, and proves what [`Limits::new_checked`] proves.
    ///
    /// # Errors
    ///
    /// [`ProjectError::Points`] if they are for another number than `control_points`, [`ProjectError::Layout`] if the
    /// bytes are not as long as their record says, start on an address that is no multiple of 4, or a reserved
    /// field is not zero; else those of [`Limits::new_checked`].
    pub fn from_section(bytes: &'a [u8], control_points: usize) -> Result<Self, ProjectError> {
        let (record, mut rest) =
            LimitsRecord::ref_from_prefix(bytes).map_err(|_| ProjectError::Layout)?;
        let points = usize::try_from(record.points.get()).map_err(|_| ProjectError::Points)?;
        if points != control_points {
            return Err(ProjectError::Points);
        }
        if record.reserved.iter().any(|field| field.get() != 0) {
            return Err(ProjectError::Layout);
        }
        let parts = LimitsParts {
            lower: take(&mut rest, points)?,
            upper: take(&mut rest, points)?,
            rates: take(&mut rest, points)?,
            mobilities: take(&mut rest, points)?,
            settled: record.settled.get(),
        };
        if !rest.is_empty() {
            return Err(ProjectError::Layout);
        }
        Self::new_checked(parts)
    }
}

/// The next elements, which `bytes` then lies behind.
fn take<'a, T: FromBytes + Immutable + KnownLayout>(
    bytes: &mut &'a [u8],
    count: usize,
) -> Result<&'a [T], ProjectError> {
    let length = count
        .checked_mul(size_of::<T>())
        .ok_or(ProjectError::Layout)?;
    let (own, rest) = bytes.split_at_checked(length).ok_or(ProjectError::Layout)?;
    *bytes = rest;
    <[T]>::ref_from_bytes(own).map_err(|_| ProjectError::Layout)
}
