//! A volume form, and a volume and a centroid by modes, as they lie in a bundle.

use core::mem::size_of;

use zerocopy::byteorder::little_endian::{I32, U32};
use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout, Unaligned};

use super::centroid::CentroidModes;
use super::error::EnclosedError;
use super::form::{VolumeForm, VolumeFormParts};
use super::modes::VolumeModes;

/// The first 32 bytes of a volume form's section. Behind it lie, without a gap, the weights (`i32`
/// for each tap), the first tap of each pair and the number of taps (`u32`), the pairs (two
/// `u16`), the points (`u16`) and the third points of the taps (`u16`).
#[derive(Clone, Copy, Debug, FromBytes, IntoBytes, Immutable, KnownLayout, Unaligned)]
#[repr(C)]
pub struct VolumeRecord {
    /// Control points of the region.
    pub points: U32,
    /// Pairs of points.
    pub pairs: U32,
    /// Taps.
    pub taps: U32,
    /// See [`VolumeFormParts`].
    pub difference_shift: U32,
    /// See [`VolumeFormParts`].
    pub pair_bits: U32,
    /// See [`VolumeFormParts`].
    pub volume_shift: U32,
    /// See [`VolumeFormParts`].
    pub gradient_bits: U32,
    /// See [`VolumeFormParts`].
    pub weight_bits: I32,
}

impl<'a> VolumeForm<'a> {
    /// Opens a section in place, and proves what [`VolumeForm::new_checked`] proves.
    ///
    /// # Errors
    ///
    /// [`EnclosedError::Layout`] if the bytes are not as long as their record says or start on an
    /// address that is no multiple of 4; else those of [`VolumeForm::new_checked`].
    pub fn from_section(bytes: &'a [u8], control_points: usize) -> Result<Self, EnclosedError> {
        let layout = EnclosedError::Layout { place: 0 };
        let (record, rest) = VolumeRecord::ref_from_prefix(bytes).map_err(|_| layout)?;
        let count = |field: U32| usize::try_from(field.get()).map_err(|_| layout);
        let (points, pairs, taps) = (
            count(record.points)?,
            count(record.pairs)?,
            count(record.taps)?,
        );
        let starts = pairs.checked_add(1).ok_or(layout)?;
        let (weights, rest) = take::<i32>(rest, taps)?;
        let (pair_starts, rest) = take::<u32>(rest, starts)?;
        let (pairs, rest) = take::<[u16; 2]>(rest, pairs)?;
        let (points, rest) = take::<u16>(rest, points)?;
        let (thirds, rest) = take::<u16>(rest, taps)?;
        if !rest.is_empty() {
            return Err(layout);
        }
        let parts = VolumeFormParts {
            points,
            pairs,
            pair_starts,
            thirds,
            weights,
            difference_shift: record.difference_shift.get(),
            pair_bits: record.pair_bits.get(),
            volume_shift: record.volume_shift.get(),
            gradient_bits: record.gradient_bits.get(),
            weight_bits: record.weight_bits.get(),
        };
        Self::new_checked(parts, control_points)
    }
}

/// The first 16 bytes of a section of a volume by modes. Behind it lie the coefficients (`i32`).
#[derive(Clone, Copy, Debug, FromBytes, IntoBytes, Immutable, KnownLayout, Unaligned)]
#[repr(C)]
pub struct VolumeModesRecord {
    /// Modes, at most 65 535.
    pub modes: U32,
    /// A coefficient of one stands for `2^` this of cubes of the coordinates' last place.
    pub exponent: I32,
    /// Zero.
    pub reserved: [U32; 2],
}

impl<'a> VolumeModes<'a> {
    /// Opens a section in place, and proves what [`VolumeModes::new_checked`] proves.
    ///
    /// # Errors
    ///
    /// [`EnclosedError::Layout`] if the bytes are not as long as their record says, start on an address
    /// that is no multiple of 4, or the record's reserved field is not zero; else those of
    /// [`VolumeModes::new_checked`].
    pub fn from_section(bytes: &'a [u8]) -> Result<Self, EnclosedError> {
        let layout = EnclosedError::Layout { place: 0 };
        let (record, rest) = VolumeModesRecord::ref_from_prefix(bytes).map_err(|_| layout)?;
        let modes = u16::try_from(record.modes.get()).map_err(|_| layout)?;
        if record.reserved.iter().any(|field| field.get() != 0) {
            return Err(layout);
        }
        let coefficients = <[i32]>::ref_from_bytes(rest).map_err(|_| layout)?;
        Self::new_checked(modes, coefficients)
            .map(|modes| modes.with_exponent(record.exponent.get()))
    }
}

/// The first 16 bytes of a section of a centroid by modes. Behind it lie the coefficients (`i32`) of x,
/// y and z.
#[derive(Clone, Copy, Debug, FromBytes, IntoBytes, Immutable, KnownLayout, Unaligned)]
#[repr(C)]
pub struct CentroidModesRecord {
    /// Modes, at most 65 535.
    pub modes: U32,
    /// See [`CentroidModes::new_checked`].
    pub shift: I32,
    /// The control point that offsets are counted from.
    pub base: U32,
    /// Zero.
    pub reserved: U32,
}

impl<'a> CentroidModes<'a> {
    /// Opens a section in place, and proves what [`CentroidModes::new_checked`] proves.
    ///
    /// # Errors
    ///
    /// [`EnclosedError::Layout`] if the bytes are not as long as their record says, start on an address
    /// that is no multiple of 4, or the record's reserved field is not zero; [`EnclosedError::Points`] if
    /// the base is not among so many control points; else those of [`CentroidModes::new_checked`].
    pub fn from_section(bytes: &'a [u8], control_points: usize) -> Result<Self, EnclosedError> {
        let layout = EnclosedError::Layout { place: 0 };
        let (record, rest) = CentroidModesRecord::ref_from_prefix(bytes).map_err(|_| layout)?;
        let modes = u16::try_from(record.modes.get()).map_err(|_| layout)?;
        if record.reserved.get() != 0 {
            return Err(layout);
        }
        let base = u16::try_from(record.base.get()).map_err(|_| EnclosedError::Points)?;
        if usize::from(base) >= control_points {
            return Err(EnclosedError::Points);
        }
        let coefficients = <[i32]>::ref_from_bytes(rest).map_err(|_| layout)?;
        Self::new_checked(modes, base, record.shift.get(), coefficients)
    }
}

/// The next elements, and what lies behind them.
fn take<T: FromBytes + Immutable + KnownLayout>(
    bytes: &[u8],
    count: usize,
) -> Result<(&[T], &[u8]), EnclosedError> {
    let layout = EnclosedError::Layout { place: 0 };
    let length = count.checked_mul(size_of::<T>()).ok_or(layout)?;
    let (own, rest) = bytes.split_at_checked(length).ok_or(layout)?;
    let elements = <[T]>::ref_from_bytes(own).map_err(|_| layout)?;
    Ok((elements, rest))
}
