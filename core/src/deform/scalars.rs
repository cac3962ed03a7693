//! Scalar channels through the rows of a table.

use core::ops::Range;

use super::groups::Groups;
use super::table::ApplyError;
use crate::coord::{Coordinate, floor_shift, rounding_start, saturate};

/// The weights of a table in the order of their format.
pub(super) trait StoredWeights: Copy {
    /// Fraction bits.
    const BITS: u32;

    /// The weights of a row, tap by tap. The row is counted from the first of its group, which has
    /// `rows` rows of `taps` taps and whose weights start at `first`.
    fn row(self, first: usize, rows: usize, taps: usize, row: usize) -> impl Iterator<Item = i32>;
}

/// Row by row, tap by tap: weights of 16 bits have 14 fraction bits, those of 32 bits have 30.
impl StoredWeights for &[i16] {
    const BITS: u32 = 14;

    #[inline(always)]
    fn row(self, first: usize, _: usize, taps: usize, row: usize) -> impl Iterator<Item = i32> {
        row_of(self, first, taps, row)
            .iter()
            .copied()
            .map(i32::from)
    }
}

impl StoredWeights for &[i32] {
    const BITS: u32 = 30;

    #[inline(always)]
    fn row(self, first: usize, _: usize, taps: usize, row: usize) -> impl Iterator<Item = i32> {
        row_of(self, first, taps, row).iter().copied()
    }
}

fn row_of<W>(weights: &[W], first: usize, taps: usize, row: usize) -> &[W] {
    let start = first.wrapping_add(taps.wrapping_mul(row));
    weights
        .get(start..)
        .and_then(|weights| weights.get(..taps))
        .unwrap_or_default()
}

/// Pairs of rows, of which two taps of the one alternate with two of the other.
#[derive(Clone, Copy)]
pub(super) struct InPairs<'a>(pub &'a [i16]);

impl StoredWeights for InPairs<'_> {
    const BITS: u32 = 14;

    #[inline(always)]
    fn row(self, first: usize, rows: usize, taps: usize, row: usize) -> impl Iterator<Item = i32> {
        let (parity, before) = (row & 1, row & !1);
        let is_alone = parity == 0 && row.wrapping_add(1) == rows;
        let block = first.wrapping_add(taps.wrapping_mul(before));
        let (steps, _) = self.0.get(block..).unwrap_or_default().as_chunks::<2>();
        let every = if is_alone { 1 } else { 2 };
        let steps = steps.iter().skip(parity).step_by(every).flatten();
        steps.copied().map(i32::from)
    }
}

/// Computes a range of rows, of which there are as many as `out` has elements and which the table has;
/// returns how many values saturated.
///
/// # Errors
///
/// [`ApplyError`] if a length does not fit; nothing is then written.
pub(super) fn apply<W: StoredWeights, V: Coordinate, const D: usize>(
    groups: Groups<'_>,
    (inputs, table_rows): (usize, usize),
    weights: W,
    rows: Range<usize>,
    values: &[[V; D]],
    out: &mut [[V; D]],
) -> Result<u32, ApplyError> {
    let (needed, given) = (inputs, values.len());
    if needed != given {
        return Err(ApplyError::ValuesLength { needed, given });
    }
    let needed = rows.end.checked_sub(rows.start);
    let needed = needed.filter(|_| rows.end <= table_rows);
    let needed = needed.ok_or(ApplyError::row_range(&rows, table_rows))?;
    let given = out.len();
    if needed != given {
        return Err(ApplyError::OutputLength { needed, given });
    }
    let (mut saturated, mut out) = (0, out);
    for part in groups.parts(rows) {
        let (part_out, more) = core::mem::take(&mut out)
            .split_at_mut_checked(part.count)
            .unwrap_or_default();
        out = more;
        for (slot, row) in part_out.iter_mut().zip(part.skipped..) {
            let taps = part.indices.len();
            let weights = weights.row(part.first_weight, part.rows, taps, row);
            *slot = one_row(weights.zip(part.indices), W::BITS, values, &mut saturated);
        }
    }
    Ok(saturated)
}

/// The values of one row.
#[inline(always)]
fn one_row<'a, V: Coordinate, const D: usize>(
    taps: impl Iterator<Item = (i32, &'a u16)>,
    weight_bits: u32,
    values: &[[V; D]],
    saturated: &mut u32,
) -> [V; D] {
    let mut sums = [rounding_start(weight_bits); D];
    for (weight, &index) in taps {
        // Always there: the bundle's indices and the number of values were checked.
        let Some(value) = values.get(usize::from(index)) else {
            break;
        };
        for (sum, channel) in sums.iter_mut().zip(value) {
            let product = i64::from(weight).wrapping_mul(i64::from(channel.to_bits()));
            *sum = sum.wrapping_add(product);
        }
    }
    sums.map(|sum| V::from_bits(saturate(floor_shift(sum, weight_bits), saturated)))
}
