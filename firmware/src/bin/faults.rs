//! Goes wrong on purpose, so that the tests can see that nothing of it passes for success.
//!
//! The file `fault.txt` says how: `nothing`, `panic`, `bad-address`, `interrupt`, `overflow`,
//! `leave-memory`, `hang`, `silence` (exit code 0 without the end marker), `corrupt-log`, `lock-up`.
#![no_std]
#![no_main]

use core::hint::black_box;
use core::str;

use cortex_m::peripheral::{NVIC, SCB};
use cortex_m_rt::entry;
use octruss_firmware::exit::{self, Ending};
use octruss_firmware::files::Input;
use octruss_firmware::stack;

/// An interrupt that the board has and no image uses.
#[derive(Clone, Copy)]
struct Unused;

// SAFETY: always the same number, within those of the processors used here.
unsafe impl cortex_m::interrupt::InterruptNumber for Unused {
    fn number(self) -> u16 {
        31
    }
}

#[entry]
fn main() -> ! {
    let mut text = [0; 32];
    let count = Input::open(c"fault.txt").read(&mut text);
    let fault = str::from_utf8(text.get(..count).unwrap_or_default()).unwrap_or_default();
    defmt::info!("told to: {=str}", fault);
    match fault.trim() {
        "nothing" => {}
        "panic" => panic!("a panic on purpose, number {}", black_box(7)),
        "bad-address" => read_bad_address(),
        "interrupt" => raise_unhandled_interrupt(),
        "overflow" => {
            let depth = descend(0);
            defmt::info!("came back from depth {=u32}", depth);
        }
        "leave-memory" => leave_memory(0),
        "hang" => loop {
            cortex_m::asm::nop();
        },
        "silence" => exit::stop(Ending::Finished),
        "corrupt-log" => corrupt_log(),
        "lock-up" => lock_up(),
        _ => exit::stop(Ending::Refused),
    }
    exit::finish()
}

/// Reads where no board has memory, not even one that answers for memory it lacks.
fn read_bad_address() {
    let address = black_box(0xffff_fff0_usize as *const u32);
    // SAFETY: not sound on purpose: this address faults, and the fault is what is wanted. Nothing
    // is made of what it might return.
    let word = unsafe { core::ptr::read_volatile(address) };
    defmt::info!("read {=u32}", word);
}

fn raise_unhandled_interrupt() {
    // SAFETY: no critical section relies on this interrupt being masked.
    unsafe { NVIC::unmask(Unused) };
    NVIC::pend(Unused);
}

/// Calls itself until the stack has reached the end of its space.
fn descend(depth: u32) -> u32 {
    let frame = black_box([depth; 16]);
    if stack::bytes_never_used() < stack::RED_ZONE_BYTES {
        return depth;
    }
    let reached = descend(depth + 1);
    black_box(frame);
    reached
}

/// Calls itself until nothing is left of the stack, and no further only because that faults.
fn leave_memory(depth: u32) {
    let frame = black_box([depth; 16]);
    if black_box(true) {
        leave_memory(depth + 1);
    }
    black_box(frame);
}

/// Prints through semihosting beside the logger.
fn corrupt_log() {
    use semihosting::fs::OpenOptions;
    use semihosting::io::Write;
    let console = OpenOptions::new()
        .write(true)
        .create(true)
        .truncate(true)
        .open(c":tt");
    if let Ok(mut console) = console {
        // A frame ends at a zero byte: this one has an index that no message has.
        let _ = console.write_all(&[0xff, 0xff, 0xff, 0x01, 0x02, 0x00]);
    }
}

/// Takes the vector table away and faults: the processor has nowhere to go.
fn lock_up() {
    // SAFETY: not sound on purpose: no vectors are at that address, and that is what is wanted.
    unsafe { (*SCB::PTR).vtor.write(0xffff_ff00) };
    read_bad_address();
}
