//! What happens when an image goes wrong: say where, then exit with failure.

use core::arch::naked_asm;
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

/// Where every hard fault arrives.
///
/// A stack that has left its space would fault again with the first thing that is put on it, and the
/// processor would lock up: it gets a new stack before anything is said.
///
/// # Safety
///
/// Only the processor calls it.
#[unsafe(naked)]
#[unsafe(no_mangle)]
unsafe extern "C" fn HardFault() -> ! {
    naked_asm!(
        "movw r0, #:lower16:_stack_end",
        "movt r0, #:upper16:_stack_end",
        "mrs r1, msp",
        "cmp r1, r0",
        "blo 2f",
        "mov r0, r1",
        "b {say_where}",
        "2:",
        "movw r0, #:lower16:_stack_start",
        "movt r0, #:upper16:_stack_start",
        "mov sp, r0",
        "b {say_overflow}",
        say_where = sym report_fault,
        say_overflow = sym report_overflow,
    )
}

/// The stack has left its space.
extern "C" fn report_overflow() -> ! {
    if first_report() {
        defmt::error!("the stack overflowed, which faulted");
    }
    exit::stop(Ending::StackOverflowed)
}

extern "C" fn report_fault(frame: &ExceptionFrame) -> ! {
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
