//! Instructions of core's apply in every format, beside what one would write instead, on the same rows.
//!
//! One run, one input: the bundles `q30.oct`, `q14.oct` and `compact.oct`, and `rivals.bin` with the same
//! rows in floating point, come from the host into the board's large memory (16 MiB that only the emulated
//! boards have). Figures are those of whole calls, with their checks, rounding and storing; they are counted
//! by `octruss_firmware::instructions`, exactly, and are the same on every run. Built by `cargo xtask bench`.
#![no_std]
#![no_main]

use core::hint::black_box;
use core::slice;

use cortex_m_rt::entry;
use octruss::bundle::Bundle;
use octruss::deform::{Displacement, Table};
use octruss_firmware::exit::{self, Ending, figure};
use octruss_firmware::files::Input;
use octruss_firmware::instructions::InstructionCounter;

/// The boards' 16 MiB of memory beyond what the linker knows of.
const LARGE_MEMORY: usize = 0x2100_0000;
/// What each file and each output may take of it.
const PIECE: usize = 5 << 18;
/// Control points at most.
const CONTROL_POINTS: usize = 256;
/// Rows of a dense product that are counted at a time: longer would not fit the counter.
const DENSE_ROWS: usize = 500;

#[link(name = "rivals", kind = "static")]
unsafe extern "C" {
    fn rival_csr(
        starts: *const u32,
        indices: *const u16,
        weights: *const f32,
        pose: *const [f32; 3],
        out: *mut [f32; 3],
        rows: u32,
    );
    fn rival_grouped(
        groups: *const [u16; 2],
        count: u32,
        indices: *const u16,
        weights: *const f32,
        pose: *const [f32; 3],
        out: *mut [f32; 3],
    );
    fn rival_dense_q31(
        weights: *const i32,
        pose: *const [i32; 3],
        out: *mut [i32; 3],
        rows: u32,
        points: u32,
    );
}

/// The rows in floating point.
struct Rows<'a> {
    starts: &'a [u32],
    weights: &'a [f32],
    indices: &'a [u16],
    groups: &'a [[u16; 2]],
    group_weights: &'a [f32],
    group_indices: &'a [u16],
}

#[entry]
fn main() -> ! {
    let Some(core) = cortex_m::Peripherals::take() else {
        refuse("the peripherals have been taken before")
    };
    let Ok(mut counter) = InstructionCounter::start(core.SYST) else {
        refuse("the clock does not follow the instructions: run with -icount shift=7")
    };
    figure("instruction error bound", counter.error_bound());
    let q30 = load(0, c"q30.oct");
    let q14 = load(1, c"q14.oct");
    let compact = load(2, c"compact.oct");
    let Some(rows) = rows(load(3, c"rivals.bin")) else {
        refuse("rivals.bin is cut short")
    };
    let Ok(bundle) = Bundle::new_checked(q30) else {
        refuse("q30.oct does not open")
    };
    let points = bundle.rest_cage().len();
    let (mut pose, mut real) = ([[0_i32; 3]; CONTROL_POINTS], [[0.0_f32; 3]; CONTROL_POINTS]);
    let mut state = 1_u32;
    for ((pose, real), rest) in pose.iter_mut().zip(&mut real).zip(bundle.rest_cage()) {
        for ((pose, real), rest) in pose.iter_mut().zip(real).zip(rest) {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            *pose = rest.wrapping_add(state.cast_signed() >> 6);
            *real = *pose as f32;
        }
    }
    let (Some(pose), Some(real)) = (pose.get(..points), real.get(..points)) else {
        refuse("the cage has more control points than this image holds")
    };
    figure("rows", (rows.starts.len() - 1) as u32);
    figure("taps", rows.weights.len() as u32);
    rivals(&mut counter, &rows, pose, real);
    for (name, absolute, bytes) in [("q30", "q30 absolute", q30), ("q14", "q14 absolute", q14)] {
        wide(&mut counter, (name, absolute), bytes, pose);
    }
    narrow(&mut counter, compact, pose);
    normals(&mut counter, q30);
    let q30 = load(0, c"q30-factored.oct");
    let q14 = load(1, c"q14-factored.oct");
    let compact = load(2, c"compact-factored.oct");
    wide_factored(&mut counter, "q30-factored", q30, pose);
    wide_factored(&mut counter, "q14-factored", q14, pose);
    narrow_factored(&mut counter, compact, pose);
    exit::finish()
}

/// Memory of `T` in one of the pieces.
fn piece<T>(number: usize) -> &'static mut [T] {
    let first = (LARGE_MEMORY + number * PIECE) as *mut T;
    // SAFETY: the boards that this image runs on have 16 MiB there, twelve pieces, which nothing else uses;
    // no piece is used for two things at a time, and all types used here are sound with any bits.
    unsafe { slice::from_raw_parts_mut(first, PIECE / size_of::<T>()) }
}

/// Reads a file into a piece.
fn load(number: usize, name: &'static core::ffi::CStr) -> &'static [u8] {
    let memory = piece::<u8>(number);
    let length = Input::open(name).read(memory);
    memory.get(..length).unwrap_or_default()
}

/// Takes `rivals.bin` apart: rows, taps, groups, grouped taps and grouped points as words; then starts,
/// weights and grouped weights; then groups, indices and grouped points.
fn rows(bytes: &'static [u8]) -> Option<Rows<'static>> {
    use zerocopy::FromBytes;
    let (counts, rest) = <[u32]>::ref_from_prefix_with_elems(bytes, 5).ok()?;
    let &[rows, taps, groups, group_taps, group_points] = counts else {
        return None;
    };
    let (starts, rest) = <[u32]>::ref_from_prefix_with_elems(rest, rows as usize + 1).ok()?;
    let (weights, rest) = <[f32]>::ref_from_prefix_with_elems(rest, taps as usize).ok()?;
    let (group_weights, rest) =
        <[f32]>::ref_from_prefix_with_elems(rest, group_taps as usize).ok()?;
    let (groups, rest) = <[[u16; 2]]>::ref_from_prefix_with_elems(rest, groups as usize).ok()?;
    let (indices, rest) = <[u16]>::ref_from_prefix_with_elems(rest, taps as usize).ok()?;
    let (group_indices, _) =
        <[u16]>::ref_from_prefix_with_elems(rest, group_points as usize).ok()?;
    Some(Rows {
        starts,
        weights,
        indices,
        groups,
        group_weights,
        group_indices,
    })
}

fn rivals(counter: &mut InstructionCounter, rows: &Rows<'_>, pose: &[[i32; 3]], real: &[[f32; 3]]) {
    let count = rows.starts.len() - 1;
    let out = piece::<[f32; 3]>(4).as_mut_ptr();
    let rows = black_box(rows);
    // SAFETY: the host has written starts that ascend to the number of taps and indices of control points
    // that exist; the output holds more points than there are rows.
    report(counter, "float csr in C", || unsafe {
        let (starts, indices) = (rows.starts.as_ptr(), rows.indices.as_ptr());
        let weights = rows.weights.as_ptr();
        rival_csr(starts, indices, weights, real.as_ptr(), out, count as u32);
    });
    // SAFETY: as above; groups add up to the rows, and none has more than 64 points.
    report(counter, "float grouped in C", || unsafe {
        let (groups, indices) = (rows.groups.as_ptr(), rows.group_indices.as_ptr());
        let weights = rows.group_weights.as_ptr();
        let length = rows.groups.len() as u32;
        rival_grouped(groups, length, indices, weights, real.as_ptr(), out);
    });
    let out = piece::<[f32; 3]>(5);
    report(counter, "float csr in Rust", || rust_csr(rows, real, out));
    dense(counter, rows, pose);
}

/// The rival in Rust: the language may not fuse multiplication and addition.
#[inline(never)]
fn rust_csr(rows: &Rows<'_>, pose: &[[f32; 3]], out: &mut [[f32; 3]]) {
    for (slot, ends) in out.iter_mut().zip(rows.starts.windows(2)) {
        let &[start, end] = ends else { return };
        let taps = start as usize..end as usize;
        let (Some(weights), Some(indices)) =
            (rows.weights.get(taps.clone()), rows.indices.get(taps))
        else {
            return;
        };
        let (mut x, mut y, mut z) = (0.0, 0.0, 0.0);
        for (&weight, &index) in weights.iter().zip(indices) {
            let Some(&[px, py, pz]) = pose.get(usize::from(index)) else {
                return;
            };
            x += weight * px;
            y += weight * py;
            z += weight * pz;
        }
        *slot = [x, y, z];
    }
}

/// The dense product, some rows at a time.
fn dense(counter: &mut InstructionCounter, rows: &Rows<'_>, pose: &[[i32; 3]]) {
    let count = rows.starts.len() - 1;
    let weights = piece::<i32>(6);
    let out = piece::<[i32; 3]>(7).as_mut_ptr();
    let mut total = 0;
    let mut first = 0;
    while first < count {
        let some = DENSE_ROWS.min(count - first);
        weights.fill(0);
        for row in 0..some {
            let ends = rows.starts.get(first + row..).unwrap_or_default();
            let &[start, end, ..] = ends else { break };
            for tap in start as usize..end as usize {
                let (Some(&weight), Some(&index)) = (rows.weights.get(tap), rows.indices.get(tap))
                else {
                    break;
                };
                if let Some(slot) = weights.get_mut(row * pose.len() + usize::from(index)) {
                    *slot = (weight * 2_147_483_648.0) as i32;
                }
            }
        }
        let weights = black_box(weights.as_ptr());
        // SAFETY: `some * pose.len()` weights were filled in, and `some` points fit the output.
        let ((), counted) = counter.count(|| unsafe {
            rival_dense_q31(weights, pose.as_ptr(), out, some as u32, pose.len() as u32);
        });
        total += counted;
        first += some;
    }
    figure("dense q31 in C", total);
}

fn wide(
    counter: &mut InstructionCounter,
    (name, absolute): (&str, &str),
    bytes: &[u8],
    pose: &[[i32; 3]],
) {
    let table = Bundle::new_checked(black_box(bytes)).and_then(|bundle| bundle.table::<i32>());
    let Ok(table): Result<Table<'_, i32>, _> = table else {
        refuse("a bundle for 32-bit coordinates does not open")
    };
    let rows = 0..table.rows();
    let pose = black_box(pose);
    let Some(out) = piece::<[i32; 3]>(4).get_mut(rows.clone()) else {
        refuse("the table has too many rows")
    };
    report(counter, name, || {
        black_box(table.apply(rows.clone(), pose, out))
    });
    report(counter, absolute, || {
        black_box(table.apply_absolute(rows.clone(), pose, out))
    });
}

fn narrow(counter: &mut InstructionCounter, bytes: &[u8], pose: &[[i32; 3]]) {
    let bundle = Bundle::new_checked(black_box(bytes));
    let Ok(table) = bundle.and_then(|bundle| bundle.compact_table::<i32>()) else {
        refuse("the bundle for 16-bit displacements does not open")
    };
    let mut memory = [Displacement::default(); CONTROL_POINTS];
    let (Some(memory), Some(out)) = (
        memory.get_mut(..pose.len()),
        piece::<[i32; 3]>(4).get_mut(..table.rows()),
    ) else {
        refuse("the table is too large")
    };
    let pose = black_box(pose);
    report(counter, "compact", || {
        let displacements = table.displacements(pose, memory);
        black_box(displacements.and_then(|moved| table.apply(0..table.rows(), &moved, out)))
    });
}

/// Normals of the rows that were computed last.
fn normals(counter: &mut InstructionCounter, bytes: &[u8]) {
    let bundle = Bundle::new_checked(black_box(bytes));
    let Ok(Some(normals)) = bundle.and_then(|bundle| bundle.normals()) else {
        refuse("the bundle has no normals")
    };
    let rows = normals.rows();
    let (Some(points), Some(out)) = (
        piece::<[i32; 3]>(4).get(..rows),
        piece::<[i16; 3]>(5).get_mut(..rows),
    ) else {
        refuse("the table has too many rows")
    };
    report(counter, "normals", || {
        black_box(normals.apply(0..rows, points, out))
    });
}

/// Both stages of a factored table.
fn wide_factored(counter: &mut InstructionCounter, name: &str, bytes: &[u8], pose: &[[i32; 3]]) {
    let bundle = Bundle::new_checked(black_box(bytes));
    let Ok([first, second]) = bundle.and_then(|bundle| bundle.factored_table::<i32>()) else {
        refuse("a factored bundle for 32-bit coordinates does not open")
    };
    let (Some(refined), Some(out)) = (
        piece::<[i32; 3]>(5).get_mut(..first.rows()),
        piece::<[i32; 3]>(4).get_mut(..second.rows()),
    ) else {
        refuse("the table is too large")
    };
    let pose = black_box(pose);
    report(counter, name, || {
        let refine = first.apply(0..first.rows(), pose, refined);
        black_box(refine.and_then(|_| second.apply(0..second.rows(), refined, out)))
    });
}

fn narrow_factored(counter: &mut InstructionCounter, bytes: &[u8], pose: &[[i32; 3]]) {
    let bundle = Bundle::new_checked(black_box(bytes));
    let tables = bundle.and_then(|bundle| bundle.compact_factored_table::<i32>());
    let Ok([first, second]) = tables else {
        refuse("a factored bundle for 16-bit displacements does not open")
    };
    let (Some(refined), Some(memory), Some(out)) = (
        piece::<[i32; 3]>(5).get_mut(..first.rows()),
        piece::<Displacement>(6).get_mut(..first.rows().max(pose.len())),
        piece::<[i32; 3]>(4).get_mut(..second.rows()),
    ) else {
        refuse("the table is too large")
    };
    let pose = black_box(pose);
    report(counter, "compact-factored", || {
        let (cage, vertices) = (pose.len(), refined.len());
        let moved = first.displacements(pose, memory.get_mut(..cage).unwrap_or_default());
        let refine = moved.and_then(|moved| first.apply(0..vertices, &moved, refined));
        let moved = refine.and_then(|_| {
            second.displacements(refined, memory.get_mut(..vertices).unwrap_or_default())
        });
        black_box(moved.and_then(|moved| second.apply(0..second.rows(), &moved, out)))
    });
}

fn report<Result_>(counter: &mut InstructionCounter, name: &str, work: impl FnOnce() -> Result_) {
    figure(name, counter.count(work).1);
}

/// Says why nothing can be measured and ends the image.
fn refuse(reason: &str) -> ! {
    defmt::error!("{=str}", reason);
    exit::stop(Ending::Refused)
}
