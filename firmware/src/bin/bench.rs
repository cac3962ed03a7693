//! Instructions a tap of core's apply, beside loops in floating point on the same rows.
//!
//! Counted with SysTick under `-icount shift=7` (see `octruss_firmware::instructions`): exact, and
//! the same on every run. What the counting itself takes is measured on an empty piece of work and
//! subtracted; what a call, its checks, rounding and storing take is part of the figure.
//!
//! The table and the pose pass through `black_box`: a table that the compiler can see is folded
//! into the code.
#![no_std]
#![no_main]

use core::arch::naked_asm;
use core::hint::black_box;

use cortex_m_rt::entry;
use heapless::Vec;
use octruss::bundle::Bundle;
use octruss::deform::Table;
use octruss_firmware::exit::{self, Ending, figure};
use octruss_firmware::include_example;
use octruss_firmware::instructions::InstructionCounter;

/// Taps whose weights fit in RAM as floats. The rows measured are the first that stay below.
const TAPS: usize = 10_240;
/// Rows measured at most.
const ROWS: usize = 1_024;
/// Control points at most.
const CONTROL_POINTS: usize = 256;

/// The table of the rows measured, in floating point: compressed sparse rows.
struct FloatTable {
    starts: Vec<u32, { ROWS + 1 }>,
    weights: Vec<f32, TAPS>,
    indices: Vec<u16, TAPS>,
    pose: Vec<[f32; 3], CONTROL_POINTS>,
}

#[entry]
fn main() -> ! {
    static mut FLOAT: FloatTable = FloatTable {
        starts: Vec::new(),
        weights: Vec::new(),
        indices: Vec::new(),
        pose: Vec::new(),
    };
    static mut OUT: [[i32; 3]; ROWS] = [[0; 3]; ROWS];
    static mut FLOAT_OUT: [[f32; 3]; ROWS] = [[0.0; 3]; ROWS];

    let (bundle, _) = include_example!();
    let Ok(bundle) = Bundle::new_checked(black_box(bundle)) else {
        refuse("the bundle does not open")
    };
    let Ok(table) = bundle.table::<i32>() else {
        refuse("the bundle has no table")
    };
    let Some(core) = cortex_m::Peripherals::take() else {
        refuse("the peripherals have been taken before")
    };
    let mut counter = match InstructionCounter::start(core.SYST) {
        Ok(counter) => counter,
        Err(error) => {
            defmt::error!("{}", error);
            refuse("the clock does not follow the instructions: run with -icount shift=7")
        }
    };
    let Some((rows, taps)) = fill(FLOAT, &table, bundle.rest_cage()) else {
        refuse("the cage has more control points than this image holds")
    };
    figure("instruction error bound", counter.error_bound());
    figure("counting overhead", counter.overhead());
    figure("rows", rows as u32);
    figure("taps", taps as u32);

    let pose = black_box(bundle.rest_cage());
    let report = |name, instructions| {
        figure(name, instructions);
        let thousandths = u64::from(instructions) * 1000 / taps.max(1) as u64;
        defmt::info!("{=str}: {=u64}/1000 instructions a tap", name, thousandths);
    };
    let out = black_box(&mut OUT[..rows]);
    let (result, instructions) = counter.count(|| table.apply(0..rows, pose, out));
    expect_ok(result.is_ok());
    report("displacement form", instructions);
    let (result, instructions) = counter.count(|| table.apply_absolute(0..rows, pose, out));
    expect_ok(result.is_ok());
    report("absolute form", instructions);

    let float = black_box(&*FLOAT);
    let out = black_box(&mut FLOAT_OUT[..rows]);
    let (_, instructions) = counter.count(|| float_rows(float, out, plain_row));
    report("float in Rust", instructions);
    let (_, instructions) = counter.count(|| float_rows(float, out, fused_row));
    report("float by hand, fused", instructions);
    black_box((&OUT[..], &FLOAT_OUT[..]));
    exit::finish()
}

/// Fills the table in floating point with the first rows of the bundle; returns how many rows and
/// taps these are. `None` if the pose does not fit.
fn fill(
    float: &mut FloatTable,
    table: &Table<'_, i32>,
    pose: &[[i32; 3]],
) -> Option<(usize, usize)> {
    let last_place = 1.0 / (1_u32 << table.weight_bits()) as f32;
    float.starts.push(0).ok()?;
    for row in 0..table.rows().min(ROWS) {
        let taps = table.row(row)?;
        if float.weights.len() + table.row(row)?.count() > TAPS {
            break;
        }
        for (point, weight) in taps {
            float.weights.push(weight as f32 * last_place).ok()?;
            float.indices.push(u16::try_from(point).ok()?).ok()?;
        }
        float.starts.push(float.weights.len() as u32).ok()?;
    }
    for point in pose {
        float.pose.push(point.map(|bits| bits as f32)).ok()?;
    }
    Some((float.starts.len() - 1, float.weights.len()))
}

/// One row of a rival: the sum of weight times control point.
type FloatRow = fn(weights: &[f32], indices: &[u16], pose: &[[f32; 3]]) -> [f32; 3];

/// All rows of a rival.
#[inline(always)]
fn float_rows(table: &FloatTable, out: &mut [[f32; 3]], row: FloatRow) {
    for (point, range) in out.iter_mut().zip(table.starts.windows(2)) {
        let &[start, end] = range else { return };
        let taps = start as usize..end as usize;
        let (Some(weights), Some(indices)) =
            (table.weights.get(taps.clone()), table.indices.get(taps))
        else {
            return;
        };
        *point = row(weights, indices, &table.pose);
    }
}

/// The rival as one writes it: the compiler may not fuse a multiplication and an addition.
fn plain_row(weights: &[f32], indices: &[u16], pose: &[[f32; 3]]) -> [f32; 3] {
    let (mut x, mut y, mut z) = (0.0, 0.0, 0.0);
    for (&weight, &index) in weights.iter().zip(indices) {
        let Some(&[px, py, pz]) = pose.get(usize::from(index)) else {
            break;
        };
        x += weight * px;
        y += weight * py;
        z += weight * pz;
    }
    [x, y, z]
}

/// The rival at its best: by hand, with the fused instruction that Rust without its standard
/// library has no name for, and without a check of any index.
fn fused_row(weights: &[f32], indices: &[u16], pose: &[[f32; 3]]) -> [f32; 3] {
    let mut sums = [0.0; 3];
    if !weights.is_empty() {
        let (weights, taps) = (weights.as_ptr(), weights.len());
        // SAFETY: there are `taps` weights and as many indices, at least one, and the bundle was
        // opened, so every index names a control point of the pose.
        unsafe { sum_fused(weights, indices.as_ptr(), taps, pose.as_ptr(), &mut sums) };
    }
    sums
}

/// Sums `taps` taps, at least one, into `sums`.
///
/// # Safety
///
/// `weights` and `indices` point to `taps` elements each, and every index to an element of `pose`.
#[unsafe(naked)]
unsafe extern "C" fn sum_fused(
    weights: *const f32,
    indices: *const u16,
    taps: usize,
    pose: *const [f32; 3],
    sums: &mut [f32; 3],
) {
    // r0 weights, r1 indices, r2 taps, r3 pose, and `sums` on the stack; s0 to s2 the sums.
    naked_asm!(
        "vldr s0, 3f",
        "vmov.f32 s1, s0",
        "vmov.f32 s2, s0",
        "2:",
        "ldrh r12, [r1], #2",
        "add r12, r12, r12, lsl #1",
        "add r12, r3, r12, lsl #2",
        "vldmia r0!, {{s3}}",
        "vldmia r12, {{s4-s6}}",
        "vfma.f32 s0, s3, s4",
        "vfma.f32 s1, s3, s5",
        "vfma.f32 s2, s3, s6",
        "subs r2, r2, #1",
        "bne 2b",
        "ldr r12, [sp]",
        "vstmia r12, {{s0-s2}}",
        "bx lr",
        ".p2align 2",
        "3:",
        ".word 0"
    )
}

fn expect_ok(is_ok: bool) {
    if !is_ok {
        refuse("the table refuses the pose")
    }
}

/// Says why nothing can be measured and ends the image.
fn refuse(reason: &str) -> ! {
    defmt::error!("{=str}", reason);
    exit::stop(Ending::Refused)
}
