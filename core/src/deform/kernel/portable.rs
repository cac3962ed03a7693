//! The kernels in plain Rust, for every processor; what the instructions of `cortex_m` are held to.

use super::{Pair, Start, TAPS_A_STEP};
use crate::coord::floor_shift;

/// Rows of 16-bit weights over 32-bit coordinates.
///
/// `points` are the control points of the group, in the order of the taps; `weights` holds one weight for
/// each of them for the first row, then for the second and so on; `starts` has the sums' start value for
/// each row, the half of the rounding rule in it. Each row becomes `floor(sum / 2^14)`.
///
/// # Scaling and overflow
///
/// A row's magnitudes add up to at most `2^15`: with 32-bit coordinates a sum is at most `2^46`, a start at
/// most `2^62`. The caller has made sure that the result fits 32 bits; only these are kept.
pub(in super::super) fn wide_q14<S: Start>(
    points: &[[i32; 3]],
    weights: &[i16],
    starts: &[S],
    out: &mut [[i32; 3]],
) {
    wide::<i16, S, 14>(points, weights, starts, out);
}

/// Rows of 32-bit weights over 32-bit coordinates: as [`wide_q14`], with 30 fraction bits.
///
/// # Scaling and overflow
///
/// A row's magnitudes add up to at most `2^31`: with 32-bit coordinates a sum is at most `2^62`, a start at
/// most `2^62 - 2^29`. The caller has made sure that the result fits 32 bits; only these are kept.
pub(in super::super) fn wide_q30<S: Start>(
    points: &[[i32; 3]],
    weights: &[i32],
    starts: &[S],
    out: &mut [[i32; 3]],
) {
    wide::<i32, S, 30>(points, weights, starts, out);
}

/// A function of its own: inlined, its loop would share registers with what stands around it.
#[inline(never)]
fn wide<W: Copy + Into<i64>, S: Start, const BITS: u32>(
    points: &[[i32; 3]],
    weights: &[W],
    starts: &[S],
    out: &mut [[i32; 3]],
) {
    if points.is_empty() {
        return;
    }
    let rows = weights.chunks_exact(points.len()).zip(starts);
    for (slot, (row, start)) in out.iter_mut().zip(rows) {
        let [mut x, mut y, mut z] = start.sums();
        for (&weight, &[px, py, pz]) in row.iter().zip(points) {
            let weight: i64 = weight.into();
            x = x.wrapping_add(weight.wrapping_mul(i64::from(px)));
            y = y.wrapping_add(weight.wrapping_mul(i64::from(py)));
            z = z.wrapping_add(weight.wrapping_mul(i64::from(pz)));
            keep_rolled();
        }
        *slot = [x, y, z].map(|sum| low_bits(floor_shift(sum, BITS)));
    }
}

/// Keeps a loop from being unrolled on Arm's small processors, where four steps at a time need more registers
/// than there are.
#[inline(always)]
fn keep_rolled() {
    #[cfg(target_arch = "arm")]
    core::hint::black_box(());
}

/// The lower 32 bits of a number that fits them.
#[expect(clippy::as_conversions, reason = "truncation is what is meant")]
fn low_bits(value: i64) -> i32 {
    value as i32
}

/// Pairs of rows of 16-bit weights over 16-bit displacements.
///
/// `points` holds, for each two taps, the x of both displacements, then y, then z; `weights` holds for each
/// two rows, for each two taps, the first row's two weights and then the second row's two. Each row
/// becomes `rest + floor(sum * 2^displacement_shift / 2^14 + 1/2)`.
///
/// # Scaling and overflow
///
/// A row's magnitudes add up to at most `2^15` and displacements are at most `2^15`: every partial sum is
/// at most `2^30` and is kept in 32 bits. The shift is at most 12, or 14 to 16. The caller has made sure
/// that the result fits 32 bits.
pub(in super::super) fn narrow_pairs(
    points: &[[Pair; 3]],
    weights: &[i16],
    rest: &[[i32; 3]],
    displacement_shift: u32,
    out: &mut [[i32; 3]],
) {
    let (rest, _) = rest.as_chunks::<2>();
    let (out, _) = out.as_chunks_mut::<2>();
    let (steps, _) = weights.as_chunks::<4>();
    if points.is_empty() {
        return;
    }
    let pairs = steps.chunks_exact(points.len()).zip(rest);
    for ([slot_a, slot_b], (steps, &[rest_a, rest_b])) in out.iter_mut().zip(pairs) {
        // One row behind the other: the sums of both at once need more registers than there are.
        let first = sums(steps.iter().map(|&[a0, a1, _, _]| [a0, a1]), points);
        *slot_a = narrow_point(rest_a, first, displacement_shift);
        let second = sums(steps.iter().map(|&[_, _, b0, b1]| [b0, b1]), points);
        *slot_b = narrow_point(rest_b, second, displacement_shift);
    }
}

/// The sums of one row: two weights for each two displacements.
#[inline(never)]
fn sums(weights: impl Iterator<Item = [i16; TAPS_A_STEP]>, points: &[[Pair; 3]]) -> [i32; 3] {
    let mut sums = [0; 3];
    for (weights, point) in weights.zip(points) {
        sums = multiply_add(sums, weights, point);
        keep_rolled();
    }
    sums
}

#[inline(always)]
fn multiply_add(sums: [i32; 3], [w0, w1]: [i16; TAPS_A_STEP], point: &[Pair; 3]) -> [i32; 3] {
    let [x, y, z] = sums;
    let [px, py, pz] = *point;
    let both = |sum: i32, pair: Pair| {
        let (d0, d1) = pair.halves();
        sum.wrapping_add(i32::from(w0).wrapping_mul(i32::from(d0)))
            .wrapping_add(i32::from(w1).wrapping_mul(i32::from(d1)))
    };
    [both(x, px), both(y, py), both(z, pz)]
}

/// One row of 16-bit weights over 16-bit displacements: as [`narrow_pairs`], the weights in the order of the
/// taps.
pub(in super::super) fn narrow_single(
    points: &[[Pair; 3]],
    weights: &[i16],
    rest: [i32; 3],
    displacement_shift: u32,
) -> [i32; 3] {
    let (steps, _) = weights.as_chunks::<TAPS_A_STEP>();
    let sums = sums(steps.iter().copied(), points);
    narrow_point(rest, sums, displacement_shift)
}

/// The rest position plus the scaled sum, rounded once.
fn narrow_point(rest: [i32; 3], sums: [i32; 3], displacement_shift: u32) -> [i32; 3] {
    let [rx, ry, rz] = rest;
    let [x, y, z] = sums;
    let one = |rest: i32, sum: i32| {
        low_bits(i64::from(rest).wrapping_add(super::scaled(sum, displacement_shift)))
    };
    [one(rx, x), one(ry, y), one(rz, z)]
}
