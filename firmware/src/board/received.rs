//! What arrives on the serial port: the way from its interrupt to the ring.

use core::cell::RefCell;

use cortex_m::interrupt::Mutex;

use crate::link::Filler;

/// The end of the ring that the interrupt fills, once somebody listens.
static FILLER: Mutex<RefCell<Option<Filler<'static>>>> = Mutex::new(RefCell::new(None));

/// From here on bytes go to `filler`.
pub(super) fn listen(filler: Filler<'static>) {
    cortex_m::interrupt::free(|section| FILLER.borrow(section).replace(Some(filler)));
}

/// Takes all bytes that the port has, and loses them if nobody listens.
pub(super) fn take_all(mut next: impl FnMut() -> Option<u8>) {
    cortex_m::interrupt::free(|section| {
        let mut filler = FILLER.borrow(section).borrow_mut();
        while let Some(byte) = next() {
            if let Some(filler) = filler.as_mut() {
                filler.put(byte);
            }
        }
    });
}
