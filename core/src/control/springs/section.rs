//! Springs as they lie in a bundle.

use core::mem::size_of;

use zerocopy::byteorder::little_endian::{I64, U32};
use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout, Unaligned};

use super::error::SpringsError;
use super::{PointData, Spring, Springs, SpringsParts};

/// The first 56 bytes of a section of springs. Behind it lie, without a gap, the points ([`PointData`])
/// and the springs ([`Spring`]).
#[derive(Clone, Copy, Debug, FromBytes, IntoBytes, Immutable, KnownLayout, Unaligned)]
#[repr(C)]
pub struct SpringsRecord {
    /// Control points of the cage.
    pub points: U32,
    /// Springs.
    pub springs: U32,
    /// See [`SpringsParts`].
    pub substeps: U32,
    /// See [`SpringsParts`].
    pub drag: U32,
    /// See [`SpringsParts`].
    pub damping: U32,
    /// See [`SpringsParts`].
    pub push_shift: U32,
    /// Zero.
    pub reserved: [U32; 2],
    /// See [`SpringsParts`].
    pub gravity: [I64; 3],
}

impl<'a> Springs<'a> {
    /// Opens a section in place, and proves what [`Springs::new_checked`] proves.
    ///
    /// # Errors
    ///
    /// [`SpringsError::Layout`] if the bytes are not as long as their record says, start on an address
    /// that is no multiple of 4, or belong to another number of control points; else those of
    /// [`Springs::new_checked`].
    pub fn from_section(bytes: &'a [u8], control_points: usize) -> Result<Self, SpringsError> {
        let layout = SpringsError::Layout;
        let (record, bytes) = SpringsRecord::ref_from_prefix(bytes).map_err(|_| layout)?;
        let count = |field: U32| usize::try_from(field.get()).map_err(|_| layout);
        let (points, springs) = (count(record.points)?, count(record.springs)?);
        let is_reserved = record.reserved.iter().any(|field| field.get() != 0);
        if points != control_points || is_reserved {
            return Err(layout);
        }
        let (points, bytes) = take::<PointData>(bytes, points)?;
        let (springs, bytes) = take::<Spring>(bytes, springs)?;
        if !bytes.is_empty() {
            return Err(layout);
        }
        Self::new_checked(SpringsParts {
            points,
            springs,
            substeps: record.substeps.get(),
            drag: record.drag.get(),
            damping: record.damping.get(),
            push_shift: record.push_shift.get(),
            gravity: record.gravity.map(I64::get),
        })
    }
}

/// The next elements, and what lies behind them.
fn take<T: FromBytes + Immutable + KnownLayout>(
    bytes: &[u8],
    count: usize,
) -> Result<(&[T], &[u8]), SpringsError> {
    let layout = SpringsError::Layout;
    let length = count.checked_mul(size_of::<T>()).ok_or(layout)?;
    let (own, rest) = bytes.split_at_checked(length).ok_or(layout)?;
    let elements = <[T]>::ref_from_bytes(own).map_err(|_| layout)?;
    Ok((elements, rest))
}
