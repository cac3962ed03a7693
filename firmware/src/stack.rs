//! How much of the stack an image has used.
//!
//! The start-up code of `cortex-m-rt` (its feature `paint-stack`) fills the whole stack with one
//! value before `main` runs. What still holds that value has never been used.

use core::ptr;

use cortex_m_rt::STACK_PAINT_VALUE;

unsafe extern "C" {
    /// The lowest address of the stack, right behind the statics; from the linker script.
    static _stack_end: u32;
    /// The address right behind the stack, where it starts to grow down; from the linker script.
    static _stack_start: u32;
}

/// Bytes at the far end of the stack that no image may touch: a stack that came this near to its
/// end counts as overflowed, because boards without memory protection notice nothing themselves.
pub const RED_ZONE_BYTES: usize = 256;

/// Bytes of the stack's space, from the end of the statics to the end of the memory.
#[must_use]
pub fn bytes() -> usize {
    top().saturating_sub(bottom())
}

/// Bytes at the far end of the stack that have never been written since the start.
///
/// The stack is the largest thing in memory, so this takes a few instructions for each word that
/// was never used: call it at the end, not in a control loop.
#[must_use]
pub fn bytes_never_used() -> usize {
    bytes_never_used_within(top())
}

/// The same of the stack's end up to an address.
fn bytes_never_used_within(end: usize) -> usize {
    let mut address = bottom();
    while address < end {
        // SAFETY: the address is a word of the stack's space, which the linker script keeps in
        // memory that exists and aligns to words. The read is volatile because the stack belongs
        // to nobody whom the compiler knows.
        let word = unsafe { ptr::read_volatile(address as *const u32) };
        if word != STACK_PAINT_VALUE {
            break;
        }
        address += size_of::<u32>();
    }
    address - bottom()
}

/// Whether the stack has stayed out of the red zone at its end. Takes a few hundred instructions.
#[must_use]
pub fn is_sound() -> bool {
    bytes_never_used_within(bottom() + RED_ZONE_BYTES) >= RED_ZONE_BYTES
}

/// The most bytes of the stack that were in use at one time (its high-water mark).
#[must_use]
pub fn bytes_used_at_most() -> usize {
    bytes().saturating_sub(bytes_never_used())
}

fn bottom() -> usize {
    &raw const _stack_end as usize
}

fn top() -> usize {
    &raw const _stack_start as usize
}
