//! The apply kernel.

use crate::blend::WEIGHT_BITS;
use crate::coord::{Coordinate, floor_shift, rounding_start, saturate};

/// The parts of a table that belong to a range of rows.
#[derive(Clone, Copy)]
pub(super) struct Rows<'a> {
    /// First tap of each row and the end of the last, counted in the whole table.
    pub starts: &'a [u32],
    /// Weights from the range's first tap on.
    pub weights: &'a [i32],
    /// Control points from the range's first tap on.
    pub indices: &'a [u16],
    /// Residuals of the range.
    pub residuals: &'a [[i64; 3]],
}

/// Computes every row of the range; returns how many coordinates saturated.
///
/// `RESIDUAL` starts the sums from the residuals (the displacement form) instead of from zero.
///
/// # Scaling and overflow
///
/// See [`Table::apply`](super::Table::apply). The sums wrap in the sense of the language only:
/// [`Bundle::new_checked`](crate::bundle::Bundle::new_checked) has proved that they fit.
pub(super) fn apply_rows<C: Coordinate, const RESIDUAL: bool>(
    rows: Rows<'_>,
    pose: &[[C; 3]],
    out: &mut [[C; 3]],
) -> u32 {
    let half = rounding_start(WEIGHT_BITS);
    let mut saturated = 0;
    let (mut weights, mut indices) = (rows.weights, rows.indices);
    let ranges = rows.starts.windows(2).zip(rows.residuals);
    for (point, (range, residual)) in out.iter_mut().zip(ranges) {
        let &[start, end] = range else { break };
        let taps = usize::try_from(end.wrapping_sub(start)).unwrap_or_default();
        let (Some((row_weights, more_weights)), Some((row_indices, more_indices))) = (
            weights.split_at_checked(taps),
            indices.split_at_checked(taps),
        ) else {
            break;
        };
        (weights, indices) = (more_weights, more_indices);
        let start = if RESIDUAL {
            residual.map(|coordinate| coordinate.wrapping_add(half))
        } else {
            [half; 3]
        };
        let sum = row(row_weights, row_indices, pose, start);
        *point =
            sum.map(|sum| C::from_bits(saturate(floor_shift(sum, WEIGHT_BITS), &mut saturated)));
    }
    saturated
}

/// One row: a 32-bit by 32-bit multiplication with 64-bit accumulation for each coordinate of
/// each tap. Three named sums stay in registers where an array would be spilled.
#[inline(never)]
fn row<C: Coordinate>(
    weights: &[i32],
    indices: &[u16],
    pose: &[[C; 3]],
    [mut x, mut y, mut z]: [i64; 3],
) -> [i64; 3] {
    for (&weight, &index) in weights.iter().zip(indices) {
        // Never another length: the bundle's indices and the pose's length were checked.
        let Some(&[px, py, pz]) = pose.get(usize::from(index)) else {
            break;
        };
        let weight = i64::from(weight);
        x = x.wrapping_add(weight.wrapping_mul(i64::from(px.to_bits())));
        y = y.wrapping_add(weight.wrapping_mul(i64::from(py.to_bits())));
        z = z.wrapping_add(weight.wrapping_mul(i64::from(pz.to_bits())));
    }
    [x, y, z]
}
