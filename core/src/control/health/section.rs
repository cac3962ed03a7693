//! Cells as they lie in a bundle.

use core::mem::size_of;

use zerocopy::byteorder::little_endian::U32;
use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout, Unaligned};

use super::{Health, HealthError};
use crate::mesh::Solid;

/// The first 16 bytes of a section of cells: how many of each shape. Behind it lie, without a gap, the corners of the
/// tetrahedra, octahedra, prisms and hexahedra, in the orders of [`Solid`], a `u32` each.
#[derive(Clone, Copy, Debug, FromBytes, IntoBytes, Immutable, KnownLayout, Unaligned)]
#[repr(C)]
pub struct CellsRecord {
    /// Tetrahedra.
    pub tetrahedra: U32,
    /// Octahedra.
    pub octahedra: U32,
    /// Prisms.
    pub prisms: U32,
    /// Hexahedra.
    pub hexahedra: U32,
}

impl<'a> Health<'a> {
    /// Opens a section in place, and proves what [`Health::new_checked`] proves.
    ///
    /// # Errors
    ///
    /// [`HealthError::Layout`] if the bytes are not as long as their record says or start on an address that is no
    /// multiple of 4; else those of [`Health::new_checked`].
    pub fn from_section(bytes: &'a [u8], rest: &'a [[i32; 3]]) -> Result<Self, HealthError> {
        let (record, mut bytes) =
            CellsRecord::ref_from_prefix(bytes).map_err(|_| HealthError::Layout)?;
        let cells = Solid {
            vertex_count: u32::try_from(rest.len()).map_err(|_| HealthError::Layout)?,
            tetrahedra: take(&mut bytes, record.tetrahedra)?,
            octahedra: take(&mut bytes, record.octahedra)?,
            prisms: take(&mut bytes, record.prisms)?,
            hexahedra: take(&mut bytes, record.hexahedra)?,
            ..Solid::default()
        };
        if !bytes.is_empty() {
            return Err(HealthError::Layout);
        }
        Self::new_checked(cells, rest)
    }
}

/// The next elements, which `bytes` then lies behind.
fn take<'a, T: FromBytes + Immutable + KnownLayout>(
    bytes: &mut &'a [u8],
    count: U32,
) -> Result<&'a [T], HealthError> {
    let count = usize::try_from(count.get()).map_err(|_| HealthError::Layout)?;
    let length = count
        .checked_mul(size_of::<T>())
        .ok_or(HealthError::Layout)?;
    let (own, rest) = bytes.split_at_checked(length).ok_or(HealthError::Layout)?;
    *bytes = rest;
    <[T]>::ref_from_bytes(own).map_err(|_| HealthError::Layout)
}
