//! A rig as it lies in a bundle.

use core::mem::size_of;

use zerocopy::byteorder::little_endian::U32;
use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout, Unaligned};

use super::error::RigError;
use super::{Influence, Joint, Rig, RigParts};

/// The first 16 bytes of a rig's section. Behind it lie, without a gap, the joints ([`Joint`]), the first
/// influence of each control point and the number of influences (`u32`), and the influences
/// ([`Influence`]).
#[derive(Clone, Copy, Debug, FromBytes, IntoBytes, Immutable, KnownLayout, Unaligned)]
#[repr(C)]
pub struct RigRecord {
    /// Joints, at most 255.
    pub joints: U32,
    /// Control points of the cage.
    pub points: U32,
    /// Influences.
    pub influences: U32,
    /// Zero.
    pub reserved: U32,
}

impl<'a> Rig<'a> {
    /// Opens a section in place, and proves what [`Rig::new_checked`] proves. `rest` is the rest cage.
    ///
    /// # Errors
    ///
    /// [`RigError::Layout`] if the bytes are not as long as their record says, start on an address that
    /// is no multiple of 4, or belong to another number of control points; else those of
    /// [`Rig::new_checked`].
    pub fn from_section(bytes: &'a [u8], rest: &'a [[i32; 3]]) -> Result<Self, RigError> {
        let layout = RigError::Layout;
        let (record, bytes) = RigRecord::ref_from_prefix(bytes).map_err(|_| layout)?;
        let count = |field: U32| usize::try_from(field.get()).map_err(|_| layout);
        let points = count(record.points)?;
        if record.reserved.get() != 0 || points != rest.len() {
            return Err(layout);
        }
        let (joints, bytes) = take::<Joint>(bytes, count(record.joints)?)?;
        let (starts, bytes) = take::<u32>(bytes, points.checked_add(1).ok_or(layout)?)?;
        let (influences, bytes) = take::<Influence>(bytes, count(record.influences)?)?;
        if !bytes.is_empty() {
            return Err(layout);
        }
        Self::new_checked(RigParts {
            joints,
            rest,
            starts,
            influences,
        })
    }
}

/// The next elements, and what lies behind them.
fn take<T: FromBytes + Immutable + KnownLayout>(
    bytes: &[u8],
    count: usize,
) -> Result<(&[T], &[u8]), RigError> {
    let length = count.checked_mul(size_of::<T>()).ok_or(RigError::Layout)?;
    let (own, rest) = bytes.split_at_checked(length).ok_or(RigError::Layout)?;
    let elements = <[T]>::ref_from_bytes(own).map_err(|_| RigError::Layout)?;
    Ok((elements, rest))
}
