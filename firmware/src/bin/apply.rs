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
    static mut POSE: [[i32; 3]; POINTS] = [[0; 3]; POINTS];
    static mut OUT: [[i32; 3]; POINTS] = [[0; 3]; POINTS];

    loop {
        let flash = black_box(FLASH.0.as_slice());
        let Ok(bundle) = Bundle::new_checked(flash) else {
            continue;
        };
        let Ok(table) = bundle.table::<i32>() else {
            continue;
        };
        let rows = black_box(0..POINTS);
        let pose = black_box(POSE.as_slice());
        let saturated = table.apply(rows.clone(), pose, black_box(&mut OUT[..]));
        black_box((&OUT[..], saturated.ok()));
        let saturated = table.apply_absolute(rows, pose, black_box(&mut OUT[..]));
        black_box((&OUT[..], saturated.ok()));
    }
}

/// Never linked, as nothing panics; the language wants it to be there.
#[panic_handler]
fn panic(_: &PanicInfo) -> ! {
    cortex_m::asm::udf()
}
