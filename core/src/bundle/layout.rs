//! Where the sections lie.

use core::mem::size_of;

use crc::{CRC_32_ISO_HDLC, Crc, Table};

use super::error::BundleError;
use super::header::{Header, Section};

/// The address of a bundle is a multiple of this many bytes, and so is the offset of every section.
pub const ALIGNMENT: usize = 8;

/// The greatest magnitude of a 64-bit start value: `2^62 - 2^29`. Added to a row's sum, which is at most
/// `2^62`, it fits 64 bits.
pub const START_LIMIT: i64 = (1 << 62) - (1 << 29);

/// The bytes of a bundle and its section table, both checked.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sections<'a> {
    bytes: &'a [u8],
    table: &'a [Section],
}

impl<'a> Sections<'a> {
    /// Checks that the sections follow one another within the bytes, in order, each at the first multiple
    /// of [`ALIGNMENT`] behind the one before, with zeros between and after them.
    pub(super) fn new(bytes: &'a [u8], table: &'a [Section]) -> Result<Self, BundleError> {
        let entries = size_of::<Section>().wrapping_mul(table.len());
        let mut end = size_of::<Header>().wrapping_add(entries);
        for (section, index) in table.iter().zip(0_u32..) {
            let error = BundleError::Section { index };
            let offset = size(section.offset.get()).ok_or(error)?;
            let length = size(section.bytes.get()).ok_or(error)?;
            let next = offset.checked_add(length).ok_or(error)?;
            let padding = bytes.get(end..offset).ok_or(error)?;
            let in_order = end.checked_next_multiple_of(ALIGNMENT) == Some(offset);
            if !in_order || next > bytes.len() || padding.iter().any(|&byte| byte != 0) {
                return Err(error);
            }
            end = next;
        }
        let padding = bytes.get(end..).ok_or(BundleError::Header)?;
        if padding.len() >= ALIGNMENT || padding.iter().any(|&byte| byte != 0) {
            return Err(BundleError::Header);
        }
        Ok(Self { bytes, table })
    }

    /// The bytes of the section of this kind and stage; `None` if there is none.
    ///
    /// # Errors
    ///
    /// [`BundleError::Section`] if there are two.
    pub(super) fn find(&self, kind: u32, stage: u32) -> Result<Option<&'a [u8]>, BundleError> {
        let mut found = None;
        for (section, index) in self.table.iter().zip(0_u32..) {
            if section.kind.get() != kind || section.stage.get() != stage {
                continue;
            }
            let error = BundleError::Section { index };
            let offset = size(section.offset.get()).ok_or(error)?;
            let length = size(section.bytes.get()).ok_or(error)?;
            let bytes = self.bytes.get(offset..).and_then(|rest| rest.get(..length));
            if found.replace(bytes.ok_or(error)?).is_some() {
                return Err(error);
            }
        }
        Ok(found)
    }
}

/// A 32-bit count as a size of memory.
pub(super) fn size(count: u32) -> Option<usize> {
    usize::try_from(count).ok()
}

/// How many bytes a step of the checksum takes, with a table of 256 words for each: one on a device, where
/// a table takes flash, sixteen on a computer, where opening a large bundle takes time.
#[cfg(target_pointer_width = "64")]
type Steps = Table<16>;
#[cfg(not(target_pointer_width = "64"))]
type Steps = Table<1>;

/// CRC-32 (ISO 3309).
static CRC_32: Crc<u32, Steps> = Crc::<u32, Steps>::new(&CRC_32_ISO_HDLC);

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
