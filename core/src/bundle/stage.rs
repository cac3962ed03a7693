//! A stage of the table: its parts, and the proof that the kernels may trust them.

use zerocopy::{FromBytes, Immutable, KnownLayout};

use super::error::BundleError;
use super::header::{
    FORMAT_COMPACT, FORMAT_Q14, FORMAT_Q30, SECTION_GROUPS, SECTION_INDICES, SECTION_STAGE,
    SECTION_STARTS, SECTION_WEIGHTS, STARTS_NARROW, STARTS_NONE, STARTS_REST, STARTS_WIDE, Stage,
};
use super::layout::{START_LIMIT, Sections, size};
use crate::deform::{
    EXCLUDED_DISPLACEMENT_SHIFT, Groups, MOST_DISPLACEMENT_SHIFT, Starts, Weights, weight_place,
};

/// The parts of a stage.
#[derive(Clone, Copy, Debug)]
pub(super) struct StageParts<'a> {
    /// Points that the rows are sums of.
    pub inputs: usize,
    /// Rows.
    pub rows: usize,
    /// Which rows share which inputs.
    pub groups: Groups<'a>,
    /// Weights and what the sums start from.
    pub body: Body<'a>,
}

/// What depends on the format.
#[derive(Clone, Copy, Debug)]
pub(super) enum Body<'a> {
    /// 32-bit coordinates.
    Wide {
        /// Weights.
        weights: Weights<'a>,
        /// What the sums start from.
        starts: Starts<'a>,
        /// Greatest magnitude of a start value in whole units, rounded up.
        greatest_start: u32,
    },
    /// 16-bit displacements.
    Compact {
        /// Weights, in pairs of rows.
        weights: &'a [i16],
        /// Rest positions.
        rest: &'a [[i32; 3]],
        /// Shift of the displacements.
        shift: u32,
        /// Greatest magnitude of a rest coordinate.
        greatest_rest: u32,
    },
}

impl<'a> StageParts<'a> {
    /// Opens stage `number`, whose inputs are `inputs` points, and proves what the kernels rely on. `None` if
    /// the bundle has no such stage.
    pub(super) fn new(
        sections: &Sections<'a>,
        number: u32,
        inputs: usize,
    ) -> Result<Option<Self>, BundleError> {
        let Some(record) = sections.find(SECTION_STAGE, number)? else {
            return Ok(None);
        };
        let error = BundleError::Stage { stage: number };
        let stage = Stage::ref_from_bytes(record).map_err(|_| error)?;
        let sane = size(stage.inputs.get()) == Some(inputs)
            && stage.reserved.iter().all(|&byte| byte == 0);
        let rows = size(stage.rows.get()).filter(|_| sane).ok_or(error)?;
        let part = |kind| sections.find(kind, number)?.ok_or(error);
        let groups = Groups {
            groups: cast(part(SECTION_GROUPS)?, error)?,
            indices: cast(part(SECTION_INDICES)?, error)?,
        };
        let starts = sections.find(SECTION_STARTS, number)?.unwrap_or_default();
        let body = body(stage, part(SECTION_WEIGHTS)?, starts, error)?;
        let parts = Self {
            inputs,
            rows,
            groups,
            body,
        };
        parts.check(number)?;
        Ok(Some(parts))
    }

    /// Proves that the parts fit one another and every row is sound.
    fn check(&self, number: u32) -> Result<(), BundleError> {
        let error = BundleError::Stage { stage: number };
        let (weights, starts) = match self.body {
            Body::Wide {
                weights: Weights::Q30(weights),
                starts,
                ..
            } => (weights.len(), starts.len()),
            Body::Wide {
                weights: Weights::Q14(weights),
                starts,
                ..
            } => (weights.len(), starts.len()),
            Body::Compact { weights, rest, .. } => (weights.len(), Some(rest.len())),
        };
        let (mut row, mut first_weight, mut first_index) = (0_usize, 0_usize, 0_usize);
        for &[rows, taps] in self.groups.groups {
            let (rows, taps) = (usize::from(rows), usize::from(taps));
            let last_index = first_index.checked_add(taps).ok_or(error)?;
            let indices = self
                .groups
                .indices
                .get(first_index..last_index)
                .ok_or(error)?;
            let last_weight = rows
                .checked_mul(taps)
                .and_then(|count| first_weight.checked_add(count))
                .filter(|&last| rows != 0 && taps != 0 && last <= weights)
                .ok_or(error)?;
            let row_error = |row: usize| u32::try_from(row).unwrap_or(u32::MAX);
            if indices
                .iter()
                .any(|&index| usize::from(index) >= self.inputs)
            {
                return Err(BundleError::ControlPoint {
                    row: row_error(row),
                });
            }
            for within in 0..rows {
                if !self.row_is_sound(first_weight, (rows, taps), within) {
                    let row = row_error(row.wrapping_add(within));
                    return Err(BundleError::Weights { row });
                }
            }
            (first_weight, first_index) = (last_weight, last_index);
            row = row.checked_add(rows).ok_or(error)?;
        }
        let complete = row == self.rows
            && first_weight == weights
            && first_index == self.groups.indices.len()
            && starts.is_none_or(|starts| starts == self.rows);
        if complete { Ok(()) } else { Err(error) }
    }

    /// The weights of a row of a group add up to one, and their magnitudes to at most two.
    ///
    /// At most `2^16` taps of at most `2^31` each fit 64 bits.
    fn row_is_sound(&self, first_weight: usize, (rows, taps): (usize, usize), row: usize) -> bool {
        let (mut sum, mut magnitude) = (0_i64, 0_i64);
        let mut add = |weight: i64| {
            sum = sum.wrapping_add(weight);
            magnitude = magnitude.wrapping_add(weight.wrapping_abs());
        };
        let in_order = first_weight.wrapping_add(row.wrapping_mul(taps));
        let row_of = in_order..in_order.wrapping_add(taps);
        let bits = match self.body {
            Body::Wide {
                weights: Weights::Q30(weights),
                ..
            } => {
                let row = weights.get(row_of).unwrap_or_default();
                row.iter().for_each(|&weight| add(weight.into()));
                30
            }
            Body::Wide {
                weights: Weights::Q14(weights),
                ..
            } => {
                let row = weights.get(row_of).unwrap_or_default();
                row.iter().for_each(|&weight| add(weight.into()));
                14
            }
            Body::Compact { weights, .. } => {
                for tap in 0..taps {
                    let place = first_weight.wrapping_add(weight_place(rows, taps, row, tap));
                    add(weights.get(place).copied().unwrap_or_default().into());
                }
                if !taps.is_multiple_of(2) {
                    return false;
                }
                14
            }
        };
        let one = 1_i64.wrapping_shl(bits);
        sum == one && magnitude <= one.wrapping_mul(2)
    }
}

/// The weights and starts of a stage, by its format.
fn body<'a>(
    stage: &Stage,
    weights: &'a [u8],
    starts: &'a [u8],
    error: BundleError,
) -> Result<Body<'a>, BundleError> {
    let shift = stage.displacement_shift.get();
    let (weights, fraction_bits) = match stage.format.get() {
        FORMAT_Q30 => (Weights::Q30(cast(weights, error)?), 30),
        FORMAT_Q14 => (Weights::Q14(cast(weights, error)?), 14),
        FORMAT_COMPACT
            if stage.starts.get() == STARTS_REST
                && shift <= MOST_DISPLACEMENT_SHIFT
                && shift != EXCLUDED_DISPLACEMENT_SHIFT =>
        {
            let rest: &[[i32; 3]] = cast(starts, error)?;
            let magnitudes = rest.iter().flatten().map(|bits| bits.unsigned_abs());
            return Ok(Body::Compact {
                weights: cast(weights, error)?,
                rest,
                shift,
                greatest_rest: magnitudes.max().unwrap_or_default(),
            });
        }
        _ => return Err(error),
    };
    let starts = match stage.starts.get() {
        STARTS_NONE if starts.is_empty() => Starts::None,
        STARTS_NARROW => Starts::Narrow(cast(starts, error)?),
        STARTS_WIDE => Starts::Wide(cast(starts, error)?),
        _ => return Err(error),
    };
    if shift != 0 {
        return Err(error);
    }
    let greatest = starts.greatest(START_LIMIT.unsigned_abs())?;
    // At most 2^48: a start value whose results never fit makes the kernels check every result.
    let units = greatest.wrapping_shr(fraction_bits).wrapping_add(1);
    Ok(Body::Wide {
        weights,
        starts,
        greatest_start: u32::try_from(units).unwrap_or(u32::MAX),
    })
}

/// Sees a section as what it holds. Every section is aligned; only its length can be wrong.
pub(super) fn cast<T: FromBytes + Immutable + KnownLayout>(
    bytes: &[u8],
    error: BundleError,
) -> Result<&[T], BundleError> {
    <[T]>::ref_from_bytes(bytes).map_err(|_| error)
}
