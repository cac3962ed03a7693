//! A solver as it lies in a bundle.

use core::mem::size_of;

use zerocopy::byteorder::little_endian::{I32, U32};
use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout, Unaligned};

use super::config::{Inverse, InverseParts, MOST_ACTUATORS, MOST_EFFECTORS};
use super::error::InverseError;

/// The first 16 bytes of a solver's section. Behind it lie, all `i32`, `H`, the reciprocals, the gains, the effectors at
/// rest (x, y, z each), the lower bounds, the upper bounds and the rates.
#[derive(Clone, Copy, Debug, FromBytes, IntoBytes, Immutable, KnownLayout, Unaligned)]
#[repr(C)]
pub struct InverseRecord {
    /// Actuators.
    pub actuators: U32,
    /// Effectors.
    pub effectors: U32,
    /// See [`InverseParts`].
    pub difference_shift: U32,
    /// See [`InverseParts`].
    pub gain_shift: I32,
}

impl<'a> Inverse<'a> {
    /// Opens a section in place, and proves what [`Inverse::new_checked`] proves.
    ///
    /// # Errors
    ///
    /// [`InverseError::Layout`] if the bytes are not as long as their record says or start on an address that is no
    /// multiple of 4; else those of [`Inverse::new_checked`].
    pub fn from_section(bytes: &'a [u8]) -> Result<Self, InverseError> {
        let (record, rest) =
            InverseRecord::ref_from_prefix(bytes).map_err(|_| InverseError::Layout)?;
        let count = |field: U32, most: usize| {
            let count = usize::try_from(field.get()).unwrap_or(usize::MAX);
            if (1..=most).contains(&count) {
                Ok(count)
            } else {
                Err(InverseError::Counts)
            }
        };
        let actuators = count(record.actuators, MOST_ACTUATORS)?;
        let effectors = count(record.effectors, MOST_EFFECTORS)?;
        // At most 16 * 96, so no product wraps.
        let square = actuators.wrapping_mul(actuators);
        let gains = actuators.wrapping_mul(effectors).wrapping_mul(3);
        let mut rest = rest;
        let parts = InverseParts {
            hessian: take(&mut rest, square)?,
            reciprocals: take(&mut rest, actuators)?,
            gains: take(&mut rest, gains)?,
            rest: take(&mut rest, effectors)?,
            lower: take(&mut rest, actuators)?,
            upper: take(&mut rest, actuators)?,
            rates: take(&mut rest, actuators)?,
            difference_shift: record.difference_shift.get(),
            gain_shift: record.gain_shift.get(),
        };
        if !rest.is_empty() {
            return Err(InverseError::Layout);
        }
        Self::new_checked(parts)
    }
}

/// The next elements, which `bytes` then lies behind.
fn take<'a, T: FromBytes + Immutable + KnownLayout>(
    bytes: &mut &'a [u8],
    count: usize,
) -> Result<&'a [T], InverseError> {
    let length = count.wrapping_mul(size_of::<T>());
    let (own, rest) = bytes.split_at_checked(length).ok_or(InverseError::Layout)?;
    *bytes = rest;
    <[T]>::ref_from_bytes(own).map_err(|_| InverseError::Layout)
}
