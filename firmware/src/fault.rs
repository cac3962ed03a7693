//! What happens when an image goes wrong: say where, then exit with failure.

use core::panic::PanicInfo;
use core::sync::atomic::{AtomicBool, Ordering};

use cortex_m::peripheral::SCB;
use cortex_m_rt::{ExceptionFrame, exception};

use crate::exit::{self, Ending};

/// Set once a failure is being reported. A failure while reporting (a panic in the logger, say)
/// must not start over for ever.
static REPORTING: AtomicBool = AtomicBool::new(false);

/// True for the first caller only. The processors here have one core, and a fault cannot be
/// interrupted by a panic, so a load and a store are enough.
fn first_report() -> bool {
    let first = !REPORTING.load(Ordering::Relaxed);
    REPORTING.store(true, Ordering::Relaxed);
    first
}

#[panic_handler]
fn panic(info: &PanicInfo) -> ! {
    cortex_m::interrupt::disable();
    if first_report() {
        let message = defmt::Display2Format(info);
        defmt::error!("{}", message);
    }
    exit::stop(Ending::Panicked)
}

// SAFETY: the handler reads the stacked registers and never returns, so it cannot break what it
// interrupted.
#[exception]
unsafe fn HardFault(frame: &ExceptionFrame) -> ! {
    if first_report() {
        // SAFETY: reading the status registers of the system control block has no side effect.
        let status = unsafe { &*SCB::PTR };
        defmt::error!(
            "hard fault at pc {=u32:#010x}, called from lr {=u32:#010x}, hfsr {=u32:#010x}, cfsr {=u32:#010x}, bfar {=u32:#010x}",
            frame.pc(),
            frame.lr(),
            status.hfsr.read(),
            status.cfsr.read(),
            status.bfar.read()
        );
    }
    exit::stop(Ending::Faulted)
}

/// Every interrupt arrives here, because the images use no device crate with a vector table of
/// its own: the board's own go to the board, any other ends the image.
// SAFETY: the handler touches atomics and the board's interrupt flags only.
#[exception]
unsafe fn DefaultHandler(number: i16) {
    if crate::board::on_interrupt(number) {
        return;
    }
    if first_report() {
        defmt::error!("nobody handles interrupt {=i16}", number);
    }
    exit::stop(Ending::Faulted)
}
