//! Opens a bundle and applies its table, and nothing else: no logger, no semihosting, no board.
//!
//! The image shows what the apply path brings along. `cargo xtask test` looks into it: it has no
//! symbol of a panic and no floating-point instruction. It is linked, not run.
#![no_std]
#![no_main]

use core::hint::black_box;
use core::panic::PanicInfo;

use cortex_m_rt::entry;
use octruss::bundle::Bundle;
use octruss::deform::Displacement;

/// Bytes of the place where a bundle would be flashed.
const BUNDLE_BYTES: usize = 4096;
/// Control points and rows that this image has room for.
const POINTS: usize = 64;

/// A bundle's place in flash, aligned as bundles are.
#[repr(align(8))]
struct Flash([u8; BUNDLE_BYTES]);

/// Nothing is known of its bytes: `black_box` keeps the compiler from looking.
static FLASH: Flash = Flash([0xff; BUNDLE_BYTES]);

#[entry]
fn main() -> ! {
    static mut POSE: Points = [[0; 3]; POINTS];
    static mut OUT: Points = [[0; 3]; POINTS];

    loop {
        let flash = black_box(FLASH.0.as_slice());
        if let Ok(bundle) = Bundle::new_checked(flash) {
            black_box(apply(&bundle, black_box(POSE), black_box(OUT)));
            black_box(apply_compact(&bundle, black_box(POSE), black_box(OUT)));
            black_box(normals(&bundle, black_box(OUT)));
        }
    }
}

/// A pose or an output of this image.
type Points = [[i32; 3]; POINTS];

/// All that there is for 32-bit coordinates.
#[inline(never)]
fn apply(bundle: &Bundle<'_>, pose: &Points, out: &mut Points) -> Option<u32> {
    let table = bundle.table::<i32>().ok()?;
    let rows = black_box(0..POINTS);
    let displaced = table.apply(rows.clone(), pose, out).ok()?;
    black_box(&out);
    let absolute = table.apply_absolute(rows, pose, out).ok()?;
    black_box(&out);
    let scalars = table.apply_scalars(black_box(0..POINTS), pose, out).ok()?;
    black_box(&out);
    let updated = table
        .apply_moved(&black_box([true; POINTS]), pose, out)
        .ok()?;
    let mut marks = [false; POINTS];
    table
        .mark_moved(&black_box([true; POINTS]), &mut marks)
        .ok()?;
    black_box(&marks);
    Some(
        displaced
            .wrapping_add(absolute)
            .wrapping_add(scalars)
            .wrapping_add(updated.saturated),
    )
}

/// All that there is for 16-bit displacements.
#[inline(never)]
fn apply_compact(bundle: &Bundle<'_>, pose: &Points, out: &mut Points) -> Option<u32> {
    let table = bundle.compact_table::<i32>().ok()?;
    let mut memory = [Displacement::default(); POINTS];
    let displacements = table.displacements(pose, &mut memory).ok()?;
    let applied = table
        .apply(black_box(0..POINTS), &displacements, out)
        .ok()?;
    black_box(&out);
    let scalars = table.apply_scalars(black_box(0..POINTS), pose, out).ok()?;
    black_box(&out);
    let moved = black_box([true; POINTS]);
    let updated = table.apply_moved(&moved, &displacements, out).ok()?;
    Some(
        applied
            .wrapping_add(scalars)
            .wrapping_add(updated.saturated),
    )
}

/// The normals of the points.
#[inline(never)]
fn normals(bundle: &Bundle<'_>, points: &Points) -> Option<u32> {
    let normals = bundle.normals().ok()??;
    let mut out = [[0; 3]; POINTS];
    let zeros = normals.apply(black_box(0..POINTS), points, &mut out).ok()?;
    black_box(&out);
    Some(zeros)
}

/// Never linked, as nothing panics; the language wants it to be there.
#[panic_handler]
fn panic(_: &PanicInfo) -> ! {
    cortex_m::asm::udf()
}
