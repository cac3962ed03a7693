//! Arm's MPS2 and MPS2+ boards with the images AN385 (Cortex-M3), AN386 (Cortex-M4) and AN500
//! (Cortex-M7): one serial port, one LED, two timers.
//!
//! Registers are those of the Cortex-M System Design Kit (Arm DDI 0479) and of the application
//! notes' memory maps. Everything runs from the one 25 MHz clock.

use core::convert::Infallible;
use core::ptr;
use core::sync::atomic::{AtomicBool, AtomicU32, Ordering};

use cortex_m::peripheral::NVIC;
use embedded_hal::delay::DelayNs;
use embedded_hal::digital::{ErrorType as PinErrorType, OutputPin};
use embedded_io::{ErrorType, Read, Write};

use super::received;
use crate::link::Filler;
use crate::tick::Tick;

/// The clock of processor, timers and serial port, in hertz.
const CLOCK_HZ: u32 = 25_000_000;
const CLOCKS_A_MICROSECOND: u32 = CLOCK_HZ / 1_000_000;
const NANOSECONDS_A_CLOCK: u32 = 1_000_000_000 / CLOCK_HZ;

const TIMER0: usize = 0x4000_0000;
const TIMER1: usize = 0x4000_1000;
const UART0: usize = 0x4000_4000;
const FPGA_IO: usize = 0x4002_8000;

/// The interrupt of serial port 0 that says that a byte has arrived.
const RECEIVE_INTERRUPT: i16 = 0;

/// The interrupt of timer 0.
const TIMER0_INTERRUPT: i16 = 8;

/// Set once the peripherals have been handed out.
static TAKEN: AtomicBool = AtomicBool::new(false);
/// Ticks of timer 0 since the start.
static TICKS: AtomicU32 = AtomicU32::new(0);

/// One memory-mapped register.
struct Register(*mut u32);

impl Register {
    /// The register at `offset` bytes in the peripheral at `base`.
    const fn new(base: usize, offset: usize) -> Self {
        Register(ptr::with_exposed_provenance_mut(base + offset))
    }

    fn read(&self) -> u32 {
        // SAFETY: every register in this file is a word of a peripheral that the board has, and
        // reading one has no effect on memory.
        unsafe { ptr::read_volatile(self.0) }
    }

    fn write(&mut self, value: u32) {
        // SAFETY: as for `read`; none of these peripherals writes to memory by itself.
        unsafe { ptr::write_volatile(self.0, value) }
    }
}

/// What the images use of the board.
pub struct Board {
    /// The first of the board's user LEDs.
    pub led: Led,
    /// The first serial port.
    pub serial: Serial,
    /// Waits on timer 1.
    pub delay: Delay,
    /// The control loop's period on timer 0.
    pub tick: PeriodicTimer,
}

impl Board {
    /// Hands out the peripherals, the first time it is called.
    #[must_use]
    pub fn take() -> Option<Board> {
        // One core, and no interrupt takes the board: a load and a store are enough.
        if TAKEN.load(Ordering::Relaxed) {
            return None;
        }
        TAKEN.store(true, Ordering::Relaxed);
        Some(Board {
            led: Led {
                lights: Register::new(FPGA_IO, 0),
            },
            serial: Serial::start(),
            delay: Delay {
                timer: Timer::new(TIMER1),
            },
            tick: PeriodicTimer {
                timer: Timer::new(TIMER0),
                seen: 0,
            },
        })
    }
}

/// Handles the interrupts of this file. False if `number` is not one of them.
pub(crate) fn on_interrupt(number: i16) -> bool {
    match number {
        TIMER0_INTERRUPT => {
            Timer::new(TIMER0).clear_interrupt();
            TICKS.fetch_add(1, Ordering::Relaxed);
        }
        RECEIVE_INTERRUPT => receive(),
        _ => return false,
    }
    true
}

/// Takes the bytes that have arrived.
fn receive() {
    Register::new(UART0, 0x0c).write(Serial::RECEIVED_INTERRUPT);
    let mut serial = Serial::at();
    received::take_all(|| serial.take());
}

/// An LED.
pub struct Led {
    lights: Register,
}

impl Led {
    const FIRST: u32 = 1;
}

impl PinErrorType for Led {
    type Error = Infallible;
}

impl OutputPin for Led {
    fn set_low(&mut self) -> Result<(), Infallible> {
        let lights = self.lights.read();
        self.lights.write(lights & !Self::FIRST);
        Ok(())
    }

    fn set_high(&mut self) -> Result<(), Infallible> {
        let lights = self.lights.read();
        self.lights.write(lights | Self::FIRST);
        Ok(())
    }
}

/// A serial port that waits for each byte: 8 data bits, no parity, one stop bit.
pub struct Serial {
    data: Register,
    state: Register,
}

impl Serial {
    /// The rate of the line. The divider's least value, 16, would give 1 562 500.
    const BAUD_HZ: u32 = 1_000_000;
    const TRANSMIT_FULL: u32 = 1 << 0;
    const RECEIVE_FULL: u32 = 1 << 1;
    const TRANSMIT_ENABLE: u32 = 1 << 0;
    const RECEIVE_ENABLE: u32 = 1 << 1;

    const RECEIVE_INTERRUPT_ENABLE: u32 = 1 << 3;
    const RECEIVED_INTERRUPT: u32 = 1 << 1;

    const fn at() -> Self {
        Serial {
            data: Register::new(UART0, 0x00),
            state: Register::new(UART0, 0x04),
        }
    }

    fn take(&mut self) -> Option<u8> {
        // Bits 8 to 31 read as zero.
        (self.state.read() & Self::RECEIVE_FULL != 0).then(|| self.data.read() as u8)
    }

    /// From here on an interrupt puts the bytes that arrive into `filler`; they can no longer be read from here.
    pub fn listen(&mut self, filler: Filler<'static>) {
        received::listen(filler);
        let enabled = Self::TRANSMIT_ENABLE | Self::RECEIVE_ENABLE | Self::RECEIVE_INTERRUPT_ENABLE;
        Register::new(UART0, 0x08).write(enabled);
        // SAFETY: no critical section relies on this interrupt being masked.
        unsafe { NVIC::unmask(ReceiveInterrupt) };
        // A byte that came before has raised no interrupt, and the next ones wait behind it.
        receive();
    }

    fn start() -> Self {
        Register::new(UART0, 0x10).write(CLOCK_HZ / Self::BAUD_HZ);
        Register::new(UART0, 0x08).write(Self::TRANSMIT_ENABLE | Self::RECEIVE_ENABLE);
        Self::at()
    }
}

impl ErrorType for Serial {
    type Error = Infallible;
}

impl Write for Serial {
    /// Sends all of `bytes`, waiting while the transmitter is full.
    fn write(&mut self, bytes: &[u8]) -> Result<usize, Infallible> {
        for &byte in bytes {
            while self.state.read() & Self::TRANSMIT_FULL != 0 {}
            self.data.write(u32::from(byte));
        }
        Ok(bytes.len())
    }

    /// Returns when the transmitter's buffer is empty; the last byte may still be on the line.
    fn flush(&mut self) -> Result<(), Infallible> {
        while self.state.read() & Self::TRANSMIT_FULL != 0 {}
        Ok(())
    }
}

impl Read for Serial {
    /// Waits for the first byte and returns it with those that have arrived by then.
    fn read(&mut self, bytes: &mut [u8]) -> Result<usize, Infallible> {
        if bytes.is_empty() {
            return Ok(0);
        }
        while self.state.read() & Self::RECEIVE_FULL == 0 {}
        let mut count = 0;
        for byte in bytes {
            let Some(received) = self.take() else { break };
            *byte = received;
            count += 1;
        }
        Ok(count)
    }
}

/// One of the two timers: counts down from a value, then starts again.
struct Timer {
    control: Register,
    value: Register,
    reload: Register,
    interrupt: Register,
}

impl Timer {
    const ENABLE: u32 = 1 << 0;
    const INTERRUPT_ENABLE: u32 = 1 << 3;

    const fn new(base: usize) -> Self {
        Timer {
            control: Register::new(base, 0x00),
            value: Register::new(base, 0x04),
            reload: Register::new(base, 0x08),
            interrupt: Register::new(base, 0x0c),
        }
    }

    fn start(&mut self, clocks: u32, control: u32) {
        self.control.write(0);
        // A period of n clocks is a reload value of n - 1, because zero takes a clock too.
        self.reload.write(clocks.saturating_sub(1));
        self.value.write(clocks.saturating_sub(1));
        self.clear_interrupt();
        self.control.write(control);
    }

    fn clear_interrupt(&mut self) {
        self.interrupt.write(1);
    }

    fn has_expired(&self) -> bool {
        self.interrupt.read() & 1 != 0
    }
}

/// Busy waits.
pub struct Delay {
    timer: Timer,
}

impl DelayNs for Delay {
    fn delay_ns(&mut self, nanoseconds: u32) {
        let clocks = nanoseconds.div_ceil(NANOSECONDS_A_CLOCK);
        // The timer does not run with a reload value of zero; two clocks are no longer than the
        // call itself.
        let control = Timer::ENABLE | Timer::INTERRUPT_ENABLE;
        self.timer.start(clocks.max(2), control);
        while !self.timer.has_expired() {}
        self.timer.control.write(0);
    }
}

/// The fixed period of a control loop.
pub struct PeriodicTimer {
    timer: Timer,
    seen: u32,
}

impl Tick for PeriodicTimer {
    fn start(&mut self, period_us: u32) {
        let clocks = period_us.max(1).saturating_mul(CLOCKS_A_MICROSECOND);
        self.seen = TICKS.load(Ordering::Relaxed);
        self.timer
            .start(clocks, Timer::ENABLE | Timer::INTERRUPT_ENABLE);
        // SAFETY: no critical section relies on this interrupt being masked.
        unsafe { NVIC::unmask(TimerInterrupt) };
    }

    fn wait(&mut self) -> u32 {
        loop {
            // With interrupts masked none can slip in between the look and the sleep; a pending
            // one ends the sleep all the same and is served right after.
            let passed = cortex_m::interrupt::free(|_| {
                let passed = TICKS.load(Ordering::Relaxed).wrapping_sub(self.seen);
                if passed == 0 {
                    cortex_m::asm::wfi();
                }
                passed
            });
            if passed != 0 {
                self.seen = self.seen.wrapping_add(passed);
                return passed;
            }
        }
    }

    fn elapsed_us(&self) -> u32 {
        let (reload, value) = (self.timer.reload.read(), self.timer.value.read());
        reload.saturating_sub(value) / CLOCKS_A_MICROSECOND
    }
}

/// The interrupt of received bytes as the interrupt controller wants it named.
#[derive(Clone, Copy)]
struct ReceiveInterrupt;

// SAFETY: always the same number, which is that of serial port 0's receiver.
unsafe impl cortex_m::interrupt::InterruptNumber for ReceiveInterrupt {
    fn number(self) -> u16 {
        RECEIVE_INTERRUPT as u16
    }
}

/// The interrupt of timer 0 as the interrupt controller wants it named.
#[derive(Clone, Copy)]
struct TimerInterrupt;

// SAFETY: always the same number, which is that of timer 0.
unsafe impl cortex_m::interrupt::InterruptNumber for TimerInterrupt {
    fn number(self) -> u16 {
        TIMER0_INTERRUPT as u16
    }
}
