//! The hot loops for Cortex-M processors with the DSP extension (Cortex-M4 and M7).
//!
//! The only unsafe code of this crate. Each function does for a group of rows, bit for bit, what its
//! namesake in [`portable`](super::portable) does, which a test holds it to.
//!
//! # How the loops are made
//!
//! * A row is a straight line of code without a branch: the loop over taps is unrolled
//!   [`MOST_TAPS`] times, and a row of `n` taps enters it `n` steps before its end. The
//!   address of that entry is the same for all rows of a group.
//! * A control point comes with one load of three registers; weights are loaded in the order in which
//!   they lie.
//! * Nothing is spilled in the line: what a row needs once (where its line starts, where the weights
//!   end) lies in a small frame that is touched between rows only.
//! * In 16 bits two taps are one instruction (two products, one sum of 32 bits), two rows share every
//!   load of control points, and one instruction scales, rounds and adds the rest position.

use core::arch::naked_asm;

use super::{MOST_TAPS, Pair, Start, StartKind};

/// What the functions for 32-bit coordinates take. The order is that of the loads in the assembly.
#[repr(C)]
struct WideCall {
    points: *const [i32; 3],
    weights: *const (),
    weights_end: *const (),
    starts: *const (),
    out: *mut [i32; 3],
    taps: usize,
    kind: StartKind,
}

/// Rows of 16-bit weights (14 fraction bits) over 32-bit coordinates.
///
/// The contract is that of [`portable::wide_q14`](super::portable::wide_q14). Lengths that do not fit leave
/// `out` as it is.
#[inline]
pub(in super::super) fn wide_q14<S: Start>(
    points: &[[i32; 3]],
    weights: &[i16],
    starts: &[S],
    out: &mut [[i32; 3]],
) {
    if fits(points.len(), weights.len(), starts.len(), out.len()) {
        let call = wide_call(points, weights, starts, out);
        // SAFETY: `fits` has checked that there are `taps` points, as many starts as rows, and `taps`
        // weights for each row, at least one and at most `MOST_TAPS` taps, and at least one row. The
        // function reads these and writes `out`, no further, as its comments show.
        unsafe { wide_q14_rows(&call) }
    }
}

/// Rows of 32-bit weights (30 fraction bits) over 32-bit coordinates.
///
/// The contract is that of [`portable::wide_q30`](super::portable::wide_q30). Lengths that do not fit leave
/// `out` as it is.
#[inline]
pub(in super::super) fn wide_q30<S: Start>(
    points: &[[i32; 3]],
    weights: &[i32],
    starts: &[S],
    out: &mut [[i32; 3]],
) {
    if fits(points.len(), weights.len(), starts.len(), out.len()) {
        let call = wide_call(points, weights, starts, out);
        // SAFETY: as in `wide_q14`.
        unsafe { wide_q30_rows(&call) }
    }
}

/// Whether the lengths are those of a group that the straight lines can take.
fn fits(taps: usize, weights: usize, starts: usize, rows: usize) -> bool {
    (1..=MOST_TAPS).contains(&taps)
        && rows != 0
        && starts == rows
        && taps.checked_mul(rows) == Some(weights)
}

fn wide_call<W, S: Start>(
    points: &[[i32; 3]],
    weights: &[W],
    starts: &[S],
    out: &mut [[i32; 3]],
) -> WideCall {
    let weights = weights.as_ptr_range();
    WideCall {
        points: points.as_ptr(),
        weights: weights.start.cast(),
        weights_end: weights.end.cast(),
        starts: S::first(starts),
        out: out.as_mut_ptr(),
        taps: points.len(),
        kind: S::KIND,
    }
}

/// The code around the straight line of the wide kernels, which differ in the load of a weight and in
/// the shift.
///
/// Registers: r0-r2 a control point, r3 its weight, r4:r5 r6:r7 r8:r9 the three sums, r10 weights,
/// r11 points, r12 output, lr starts. Frame: points, entry of the line, end of the weights, start of
/// a row. A step is 20 bytes. Stack: 56 bytes.
macro_rules! wide_rows {
    ($name:ident, $load:literal, $shift:literal, $complement:literal) => {
        #[unsafe(naked)]
        unsafe extern "C" fn $name(call: &WideCall) {
            naked_asm!(
                "push {{r4-r11, lr}}",
                "sub sp, #20",
                "ldm r0, {{r1-r7}}",
                "mov r10, r2",
                "mov lr, r4",
                "mov r12, r5",
                // The line's entry: `taps` steps before its end.
                "adr.w r8, 5f",
                "mov r9, #20",
                "mls r8, r6, r9, r8",
                "orr r8, r8, #1",
                // The start of a row, by the kind of its start value.
                "adr.w r9, 2f",
                "cmp r7, #1",
                "it eq",
                "addeq r9, r9, #(3f - 2f)",
                "it hi",
                "addhi r9, r9, #(4f - 2f)",
                "orr r9, r9, #1",
                "str r1, [sp]",
                "str r8, [sp, #4]",
                "str r3, [sp, #8]",
                "str r9, [sp, #12]",
                "bx r9",
                ".p2align 2",
                // Starts of 32 bits.
                "2:",
                "ldm lr!, {{r4, r6, r8}}",
                "asr r5, r4, #31",
                "asr r7, r6, #31",
                "asr r9, r8, #31",
                "ldr r11, [sp]",
                "ldr pc, [sp, #4]",
                ".p2align 2",
                // Starts of 64 bits.
                "3:",
                "ldm lr!, {{r4-r9}}",
                "ldr r11, [sp]",
                "ldr pc, [sp, #4]",
                ".p2align 2",
                // One start for all rows.
                "4:",
                "ldm lr, {{r4-r9}}",
                "ldr r11, [sp]",
                "ldr pc, [sp, #4]",
                ".p2align 2",
                ".rept {most}",
                "ldm.w r11!, {{r0-r2}}",
                $load,
                "smlal r4, r5, r0, r3",
                "smlal r6, r7, r1, r3",
                "smlal r8, r9, r2, r3",
                ".endr",
                "5:",
                concat!("lsr r4, r4, #", $shift),
                concat!("lsr r6, r6, #", $shift),
                concat!("lsr r8, r8, #", $shift),
                concat!("orr r4, r4, r5, lsl #", $complement),
                concat!("orr r6, r6, r7, lsl #", $complement),
                concat!("orr r8, r8, r9, lsl #", $complement),
                "ldr r3, [sp, #8]",
                "stm r12!, {{r4, r6, r8}}",
                "cmp r10, r3",
                "it ne",
                "ldrne pc, [sp, #12]",
                "add sp, #20",
                "pop {{r4-r11, pc}}",
                most = const MOST_TAPS,
            )
        }
    };
}

wide_rows!(wide_q14_rows, "ldrsh r3, [r10], #2", "14", "18");
wide_rows!(wide_q30_rows, "ldr r3, [r10], #4", "30", "2");

/// What the function for 16-bit displacements takes.
#[repr(C)]
struct NarrowCall {
    points: *const [Pair; 3],
    weights: *const i16,
    weights_end: *const i16,
    rest: *const [i32; 3],
    out: *mut [i32; 3],
    steps: usize,
    scale: i32,
    shift: u32,
}

/// Pairs of rows of 16-bit weights over 16-bit displacements.
///
/// The contract is that of [`portable::narrow_pairs`](super::portable::narrow_pairs). Lengths that do not
/// fit leave `out` as it is.
#[inline]
pub(in super::super) fn narrow_pairs(
    points: &[[Pair; 3]],
    weights: &[i16],
    rest: &[[i32; 3]],
    displacement_shift: u32,
    out: &mut [[i32; 3]],
) {
    let taps = points.len().saturating_mul(2);
    let rows = out.len();
    if fits(taps, weights.len(), rest.len(), rows)
        && rows.is_multiple_of(2)
        && displacement_shift <= super::MOST_DISPLACEMENT_SHIFT
    {
        let weights = weights.as_ptr_range();
        let call = NarrowCall {
            points: points.as_ptr(),
            weights: weights.start,
            weights_end: weights.end,
            rest: rest.as_ptr(),
            out: out.as_mut_ptr(),
            steps: points.len(),
            scale: 1_i32.wrapping_shl(displacement_shift.wrapping_add(18)),
            shift: displacement_shift.wrapping_sub(14),
        };
        // SAFETY: the conditions above say that there are two displacements in each pair of a step, two
        // weights for each step and row, a rest position for each row, at least one and at most
        // MOST_TAPS / 2 steps and an even number of rows, not none. The functions read these and write
        // `out`, no further, as their comments show.
        unsafe {
            if displacement_shift < 13 {
                narrow_scaled_rows(&call);
            } else {
                narrow_shifted_rows(&call);
            }
        }
    }
}

/// The code around the straight line of the narrow kernels, which differ in how a sum becomes a
/// coordinate.
///
/// Registers: r0-r2 two displacements by coordinate, r3 and r12 the weights of the two rows, r4-r6 and
/// r7-r9 their sums, r10 weights, r11 points, lr the scale or shift. Frame: points, entry of the line,
/// end of the weights, rest, output. A step is 32 bytes; the first step of a row, which starts the
/// sums, stands before the line. Stack: 56 bytes.
macro_rules! narrow_rows {
    ($name:ident, $parameter:literal, [$($first:literal),*], [$($second:literal),*]) => {
        #[unsafe(naked)]
        unsafe extern "C" fn $name(call: &NarrowCall) {
            naked_asm!(
                "push {{r4-r11, lr}}",
                "sub sp, #20",
                "ldm r0, {{r1-r6}}",
                concat!("ldr lr, [r0, #", $parameter, "]"),
                "mov r10, r2",
                "adr.w r8, 5f",
                "sub r6, #1",
                "sub r8, r8, r6, lsl #5",
                "orr r8, r8, #1",
                "str r1, [sp]",
                "str r8, [sp, #4]",
                "str r3, [sp, #8]",
                "strd r4, r5, [sp, #12]",
                ".p2align 2",
                "2:",
                "ldr r11, [sp]",
                "ldm.w r11!, {{r0-r2}}",
                "ldm.w r10!, {{r3, r12}}",
                "smuad r4, r0, r3",
                "smuad r5, r1, r3",
                "smuad r6, r2, r3",
                "smuad r7, r0, r12",
                "smuad r8, r1, r12",
                "smuad r9, r2, r12",
                "ldr pc, [sp, #4]",
                ".p2align 2",
                ".rept {most} / 2 - 1",
                "ldm.w r11!, {{r0-r2}}",
                "ldm.w r10!, {{r3, r12}}",
                "smlad r4, r0, r3, r4",
                "smlad r5, r1, r3, r5",
                "smlad r6, r2, r3, r6",
                "smlad r7, r0, r12, r7",
                "smlad r8, r1, r12, r8",
                "smlad r9, r2, r12, r9",
                ".endr",
                "5:",
                "ldrd r3, r12, [sp, #12]",
                "ldm r3!, {{r0-r2}}",
                $($first,)*
                "stm r12!, {{r0-r2}}",
                "ldm r3!, {{r0-r2}}",
                $($second,)*
                "stm r12!, {{r0-r2}}",
                "strd r3, r12, [sp, #12]",
                "ldr r3, [sp, #8]",
                "cmp r10, r3",
                "bne.w 2b",
                "add sp, #20",
                "pop {{r4-r11, pc}}",
                most = const MOST_TAPS,
            )
        }
    };
}

// Displacements of fewer than 13 bits' shift: the sum times 2^(18 + shift), of which the upper 32 bits are
// rounded and added to the rest position, all in one instruction.
narrow_rows!(
    narrow_scaled_rows,
    "24",
    [
        "smmlar r0, r4, lr, r0",
        "smmlar r1, r5, lr, r1",
        "smmlar r2, r6, lr, r2"
    ],
    [
        "smmlar r0, r7, lr, r0",
        "smmlar r1, r8, lr, r1",
        "smmlar r2, r9, lr, r2"
    ]
);

// Shifts from 14 on: a whole number of units, nothing to round.
narrow_rows!(
    narrow_shifted_rows,
    "28",
    [
        "lsl r4, r4, lr",
        "lsl r5, r5, lr",
        "lsl r6, r6, lr",
        "add r0, r0, r4",
        "add r1, r1, r5",
        "add r2, r2, r6"
    ],
    [
        "lsl r7, r7, lr",
        "lsl r8, r8, lr",
        "lsl r9, r9, lr",
        "add r0, r0, r7",
        "add r1, r1, r8",
        "add r2, r2, r9"
    ]
);
