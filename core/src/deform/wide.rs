//! Rows over 32-bit coordinates, group by group.

use core::ops::Range;

use super::groups::{Groups, Position};
use super::kernel::{self, MOST_TAPS, Start};
use super::moved::{Moved, Updated};
use crate::coord::{floor_shift, saturate};

/// A weight of 16 or 32 bits, and the kernel that takes it.
pub(super) trait Weight: Copy + Into<i64> + 'static {
    /// Fraction bits.
    const BITS: u32;

    /// The kernel.
    fn rows<S: Start>(points: &[[i32; 3]], weights: &[Self], starts: &[S], out: &mut [[i32; 3]]);
}

impl Weight for i16 {
    const BITS: u32 = 14;

    #[inline(always)]
    fn rows<S: Start>(points: &[[i32; 3]], weights: &[i16], starts: &[S], out: &mut [[i32; 3]]) {
        kernel::wide_q14(points, weights, starts, out);
    }
}

impl Weight for i32 {
    const BITS: u32 = 30;

    #[inline(always)]
    fn rows<S: Start>(points: &[[i32; 3]], weights: &[i32], starts: &[S], out: &mut [[i32; 3]]) {
        kernel::wide_q30(points, weights, starts, out);
    }
}

/// Computes a range of rows, of which `moved` may leave some out; returns how many there were and how many
/// coordinates saturated.
///
/// `may_saturate` is false if no result can leave 32 bits, which lets the kernels leave out that check.
/// Lengths were checked by the caller: `starts` holds a value for each row of the table, and `out` a point
/// for each row of the range.
#[inline(never)]
pub(super) fn apply<W: Weight, S: Start>(
    groups: Groups<'_>,
    weights: &[W],
    starts: &[S],
    rows: Range<usize>,
    (pose, mut out): (&[[i32; 3]], &mut [[i32; 3]]),
    moved: Moved<'_>,
    may_saturate: bool,
) -> Updated {
    let mut updated = Updated::default();
    let mut scratch = [[0_i32; 3]; MOST_TAPS];
    let Some((position, mut starts)) = groups.find(rows.start).zip(starts.get(rows)) else {
        return updated;
    };
    let Position {
        mut first_row,
        groups,
        mut indices,
        weights_before,
    } = position;
    let mut weights = weights.get(weights_before..).unwrap_or_default();
    for &[group_rows, taps] in groups {
        if out.is_empty() {
            break;
        }
        let (group_rows, taps) = (usize::from(group_rows), usize::from(taps));
        let skipped = core::mem::take(&mut first_row);
        let count = group_rows.wrapping_sub(skipped).min(out.len());
        let (Some((group_indices, more_indices)), Some((group_weights, more_weights))) = (
            indices.split_at_checked(taps),
            weights.split_at_checked(taps.wrapping_mul(group_rows)),
        ) else {
            break;
        };
        let group_weights = group_weights
            .get(taps.wrapping_mul(skipped)..)
            .and_then(|weights| weights.get(..taps.wrapping_mul(count)))
            .unwrap_or_default();
        let (Some((group_starts, more_starts)), Some((group_out, more_out))) = (
            starts.split_at_checked(count),
            core::mem::take(&mut out).split_at_mut_checked(count),
        ) else {
            break;
        };
        (indices, weights, starts, out) = (more_indices, more_weights, more_starts, more_out);
        if !moved.any_of(group_indices) {
            continue;
        }
        updated.rows = updated.rows.wrapping_add(count);
        match scratch.get_mut(..taps) {
            Some(points) if !may_saturate => {
                for (point, &index) in points.iter_mut().zip(group_indices) {
                    if let Some(&control_point) = pose.get(usize::from(index)) {
                        *point = control_point;
                    }
                }
                W::rows(points, group_weights, group_starts, group_out);
            }
            _ => {
                let rows = group_weights.chunks_exact(taps.max(1)).zip(group_starts);
                for (slot, (row, start)) in group_out.iter_mut().zip(rows) {
                    *slot = checked_row(
                        row,
                        group_indices,
                        start.sums(),
                        pose,
                        &mut updated.saturated,
                    );
                }
            }
        }
    }
    updated
}

/// One row whose result may leave 32 bits.
fn checked_row<W: Weight>(
    weights: &[W],
    indices: &[u16],
    [mut x, mut y, mut z]: [i64; 3],
    pose: &[[i32; 3]],
    saturated: &mut u32,
) -> [i32; 3] {
    for (&weight, &index) in weights.iter().zip(indices) {
        // Never another length: the bundle's indices and the pose's length were checked.
        let Some(&[px, py, pz]) = pose.get(usize::from(index)) else {
            break;
        };
        let weight: i64 = weight.into();
        x = x.wrapping_add(weight.wrapping_mul(i64::from(px)));
        y = y.wrapping_add(weight.wrapping_mul(i64::from(py)));
        z = z.wrapping_add(weight.wrapping_mul(i64::from(pz)));
    }
    [x, y, z].map(|sum| saturate(floor_shift(sum, W::BITS), saturated))
}
