//! The validated view of a bundle's bytes.

use core::mem::size_of;

use zerocopy::{FromBytes, Immutable, KnownLayout};

use super::error::BundleError;
use super::header::{
    BOUNDARY_FIXED, BOUNDARY_LOOP, Header, MAGIC, SCHEME_BOX_SPLINE_AVERAGED, SCHEME_TET_OCT,
    VERSION,
};
use super::layout::{ALIGNMENT, RESIDUAL_LIMIT, Sections, checksum};
use crate::blend::WEIGHT_BITS;
use crate::coord::Coordinate;
use crate::deform::Table;

/// A bundle that has been proved sound, still where it lay.
#[derive(Clone, Copy, Debug)]
pub struct Bundle<'a> {
    header: &'a Header,
    residuals: &'a [[i64; 3]],
    rest_cage: &'a [[i32; 3]],
    row_starts: &'a [u32],
    weights: &'a [i32],
    indices: &'a [u16],
}

impl<'a> Bundle<'a> {
    /// Opens a bundle in place and proves that
    ///
    /// * it is aligned, complete, of a known version, and its checksum is right;
    /// * every section lies within the bytes, and the padding is zero;
    /// * the rows' taps follow one another without a gap and end with the last tap;
    /// * every tap names a control point that exists;
    /// * the weights of every row add up to exactly one and their magnitudes to at most two;
    /// * no residual is larger than [`RESIDUAL_LIMIT`].
    ///
    /// The time is proportional to the bundle's bytes.
    ///
    /// # Errors
    ///
    /// A [`BundleError`] that says which of these does not hold.
    pub fn new_checked(bytes: &'a [u8]) -> Result<Self, BundleError> {
        if cfg!(target_endian = "big") {
            return Err(BundleError::ByteOrder);
        }
        if bytes.as_ptr().align_offset(ALIGNMENT) != 0 {
            return Err(BundleError::Unaligned);
        }
        let needed = size_of::<Header>();
        let truncated = |needed| BundleError::Truncated {
            needed,
            given: bytes.len(),
        };
        let (header, _) = Header::ref_from_prefix(bytes).map_err(|_| truncated(needed))?;
        let sections = check_header(header, bytes)?;
        let bundle = Self {
            header,
            residuals: cast(bytes, &sections.residuals)?,
            rest_cage: cast(bytes, &sections.rest_cage)?,
            row_starts: cast(bytes, &sections.row_starts)?,
            weights: cast(bytes, &sections.weights)?,
            indices: cast(bytes, &sections.indices)?,
        };
        let padding = bytes.get(sections.indices.end..).unwrap_or_default();
        if padding.iter().any(|&byte| byte != 0) {
            return Err(BundleError::Header);
        }
        bundle.check_rows()?;
        Ok(bundle)
    }

    /// Proves what the kernels rely on, row by row.
    fn check_rows(&self) -> Result<(), BundleError> {
        let (mut weights, mut indices) = (self.weights, self.indices);
        let mut end_above = 0;
        let pairs = self.row_starts.windows(2).zip(self.residuals);
        for ((starts, residual), row) in pairs.zip(0_u32..) {
            let &[start, end] = starts else {
                return Err(BundleError::RowStart { row });
            };
            let taps = end
                .checked_sub(start)
                .and_then(|taps| usize::try_from(taps).ok());
            let (Some(taps), true) = (taps, start == end_above) else {
                return Err(BundleError::RowStart { row });
            };
            end_above = end;
            let (Some((row_weights, more_weights)), Some((row_indices, more_indices))) = (
                weights.split_at_checked(taps),
                indices.split_at_checked(taps),
            ) else {
                return Err(BundleError::RowStart { row });
            };
            (weights, indices) = (more_weights, more_indices);
            if row_indices
                .iter()
                .any(|&index| usize::from(index) >= self.rest_cage.len())
            {
                return Err(BundleError::ControlPoint { row });
            }
            if !weights_are_sound(row_weights) {
                return Err(BundleError::Weights { row });
            }
            let limit = RESIDUAL_LIMIT.unsigned_abs();
            if residual
                .iter()
                .any(|coordinate| coordinate.unsigned_abs() > limit)
            {
                return Err(BundleError::Residual { row });
            }
        }
        if weights.is_empty() {
            Ok(())
        } else {
            Err(BundleError::Header)
        }
    }

    /// The header.
    #[must_use]
    pub fn header(&self) -> &'a Header {
        self.header
    }

    /// The unit's name, such as "mm"; empty if none was given.
    #[must_use]
    pub fn unit(&self) -> &'a str {
        let end = self.header.unit.iter().position(|&byte| byte == 0);
        let name = match end {
            Some(end) => self.header.unit.get(..end).unwrap_or_default(),
            None => &self.header.unit,
        };
        core::str::from_utf8(name).unwrap_or_default()
    }

    /// The bits of the cage's control points at rest.
    #[must_use]
    pub fn rest_cage(&self) -> &'a [[i32; 3]] {
        self.rest_cage
    }

    /// The first tap of every row, and the number of taps.
    #[must_use]
    pub fn row_starts(&self) -> &'a [u32] {
        self.row_starts
    }

    /// The weights of all taps, in units of 2^-30.
    #[must_use]
    pub fn weights(&self) -> &'a [i32] {
        self.weights
    }

    /// The control points of all taps.
    #[must_use]
    pub fn indices(&self) -> &'a [u16] {
        self.indices
    }

    /// The residuals of all rows.
    #[must_use]
    pub fn residuals(&self) -> &'a [[i64; 3]] {
        self.residuals
    }

    /// The table, for coordinates of the type `C`.
    ///
    /// # Errors
    ///
    /// [`BundleError::FractionBits`] if the bundle was baked for another format.
    pub fn table<C: Coordinate>(&self) -> Result<Table<'a, C>, BundleError> {
        let bundle = self.header.fraction_bits.get();
        match C::FRACTION_BITS {
            Some(wanted) if wanted != bundle => Err(BundleError::FractionBits { bundle, wanted }),
            _ => Ok(Table::new(
                self.rest_cage.len(),
                self.row_starts,
                self.weights,
                self.indices,
                self.residuals,
            )),
        }
    }
}

/// Checks the header against the bytes and gives the sections.
fn check_header(header: &Header, bytes: &[u8]) -> Result<Sections, BundleError> {
    if header.magic != MAGIC {
        return Err(BundleError::Magic);
    }
    let found = header.version.get();
    if found != VERSION {
        return Err(BundleError::Version { found });
    }
    let given = bytes.len();
    let needed = size(header.total_bytes.get())?;
    if given < needed {
        return Err(BundleError::Truncated { needed, given });
    }
    if given > needed {
        return Err(BundleError::TrailingBytes { needed, given });
    }
    let (stored, computed) = (header.checksum.get(), checksum(bytes));
    if stored != computed {
        return Err(BundleError::Checksum { stored, computed });
    }
    let sections = Sections::new(
        size(header.control_points.get())?,
        size(header.rows.get())?,
        size(header.taps.get())?,
    );
    let sections = sections.ok_or(BundleError::Header)?;
    let unit_is_text = core::str::from_utf8(&header.unit).is_ok();
    let known = (SCHEME_TET_OCT..=SCHEME_BOX_SPLINE_AVERAGED).contains(&header.scheme.get())
        && (BOUNDARY_LOOP..=BOUNDARY_FIXED).contains(&header.boundary.get())
        && header.fraction_bits.get() <= i32::BITS
        && header.reserved.iter().all(|&byte| byte == 0)
        && unit_is_text
        && sections.total == needed;
    if known {
        Ok(sections)
    } else {
        Err(BundleError::Header)
    }
}

fn size(count: u32) -> Result<usize, BundleError> {
    usize::try_from(count).map_err(|_| BundleError::Header)
}

/// Sees a section as what it holds. The header was checked against the length, and every section
/// is aligned because the ones before it are whole multiples of its type.
fn cast<'a, T: FromBytes + Immutable + KnownLayout>(
    bytes: &'a [u8],
    section: &core::ops::Range<usize>,
) -> Result<&'a [T], BundleError> {
    let truncated = BundleError::Truncated {
        needed: section.end,
        given: bytes.len(),
    };
    let section = bytes.get(section.clone()).ok_or(truncated)?;
    <[T]>::ref_from_bytes(section).map_err(|_| BundleError::Unaligned)
}

/// The weights add up to one, and their magnitudes to at most two.
///
/// At most `2^32` taps of at most `2^31` each fit 64 bits.
fn weights_are_sound(weights: &[i32]) -> bool {
    let mut sum = 0_i64;
    let mut magnitude = 0_i64;
    for &weight in weights {
        let weight = i64::from(weight);
        sum = sum.wrapping_add(weight);
        magnitude = magnitude.saturating_add(weight.wrapping_abs());
    }
    let one = 1_i64 << WEIGHT_BITS;
    sum == one && magnitude <= one.wrapping_mul(2)
}
