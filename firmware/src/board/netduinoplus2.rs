//! Netduino Plus 2: an STM32F405RG, Cortex-M4 with 1 MiB of flash and 128 KiB of RAM.
//!
//! Registers are those of ST's reference manual RM0090. The clocks stay as they are after a reset. The
//! serial port is USART1 on the pins PB6 and PB7, the LED is the board's blue one on PA10, and the timers
//! are TIM2 and TIM5, which have 32 bits.

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

/// The clock of the processor and of the serial port after a reset, in hertz.
const CLOCK_HZ: u32 = 16_000_000;

/// The clock of the timers, in hertz: the emulator's. The part's own after a reset is [`CLOCK_HZ`], so that
/// there a period is 62.5 times as long until the clocks are set up.
const TIMER_CLOCK_HZ: u32 = 1_000_000_000;
const TIMER_CLOCKS_A_MICROSECOND: u32 = TIMER_CLOCK_HZ / 1_000_000;
const NANOSECONDS_A_TIMER_CLOCK: u32 = 1_000_000_000 / TIMER_CLOCK_HZ;

const TIM2: usize = 0x4000_0000;
const TIM5: usize = 0x4000_0c00;
const USART1: usize = 0x4001_1000;
const GPIOA: usize = 0x4002_0000;
const GPIOB: usize = 0x4002_0400;
const RCC: usize = 0x4002_3800;

/// The interrupt of USART1.
const USART1_INTERRUPT: i16 = 37;

/// The interrupt of TIM2.
const TIM2_INTERRUPT: i16 = 28;

/// Set once the peripherals have been handed out.
static TAKEN: AtomicBool = AtomicBool::new(false);
/// The count of TIM2 when its last tick was served.
static COUNT: AtomicU32 = AtomicU32::new(0);
/// Ticks of TIM2 since the start.
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

    /// Sets the bits of `mask` to those of `value`.
    fn change(&mut self, mask: u32, value: u32) {
        let others = self.read() & !mask;
        self.write(others | value);
    }
}

/// What the images use of the board.
pub struct Board {
    /// The blue LED.
    pub led: Led,
    /// USART1.
    pub serial: Serial,
    /// Waits on TIM5.
    pub delay: Delay,
    /// The control loop's period on TIM2.
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
        supply_clocks();
        Some(Board {
            led: Led::start(),
            serial: Serial::start(),
            delay: Delay {
                timer: Timer::new(TIM5),
            },
            tick: PeriodicTimer {
                timer: Timer::new(TIM2),
                seen: 0,
            },
        })
    }
}

/// Switches on the clocks of the peripherals of this file.
fn supply_clocks() {
    const PORTS_A_AND_B: u32 = 0b11;
    const TIM2_AND_TIM5: u32 = 0b1001;
    const USART1_CLOCK: u32 = 1 << 4;
    for (offset, clocks) in [
        (0x30, PORTS_A_AND_B),
        (0x40, TIM2_AND_TIM5),
        (0x44, USART1_CLOCK),
    ] {
        Register::new(RCC, offset).change(clocks, clocks);
    }
}

/// Handles the interrupts of this file. False if `number` is not one of them.
pub(crate) fn on_interrupt(number: i16) -> bool {
    match number {
        TIM2_INTERRUPT => {
            let mut timer = Timer::new(TIM2);
            timer.clear_interrupt();
            COUNT.store(timer.count.read(), Ordering::Relaxed);
            TICKS.fetch_add(1, Ordering::Relaxed);
        }
        USART1_INTERRUPT => receive(),
        _ => return false,
    }
    true
}

/// Takes the bytes that have arrived. Reading the data clears the interrupt, an overrun's too.
fn receive() {
    let mut serial = Serial::at();
    received::take_all(|| serial.take());
}

/// An LED.
pub struct Led {
    set_and_reset: Register,
}

impl Led {
    const PIN: u32 = 10;

    fn start() -> Self {
        const OUTPUT: u32 = 0b01;
        Register::new(GPIOA, 0x00).change(0b11 << (2 * Self::PIN), OUTPUT << (2 * Self::PIN));
        Led {
            set_and_reset: Register::new(GPIOA, 0x18),
        }
    }
}

impl PinErrorType for Led {
    type Error = Infallible;
}

impl OutputPin for Led {
    fn set_low(&mut self) -> Result<(), Infallible> {
        self.set_and_reset.write(1 << (Self::PIN + 16));
        Ok(())
    }

    fn set_high(&mut self) -> Result<(), Infallible> {
        self.set_and_reset.write(1 << Self::PIN);
        Ok(())
    }
}

/// A serial port that waits for each byte: 8 data bits, no parity, one stop bit.
pub struct Serial {
    state: Register,
    data: Register,
}

impl Serial {
    /// The rate of the line: the greatest that 16 MHz give.
    const BAUD_HZ: u32 = 1_000_000;
    const RECEIVED: u32 = 1 << 5;
    const SENT: u32 = 1 << 6;
    const TRANSMIT_EMPTY: u32 = 1 << 7;
    const RECEIVE_ENABLE: u32 = 1 << 2;
    const TRANSMIT_ENABLE: u32 = 1 << 3;
    const ENABLE: u32 = 1 << 13;

    const RECEIVE_INTERRUPT_ENABLE: u32 = 1 << 5;

    const fn at() -> Self {
        Serial {
            state: Register::new(USART1, 0x00),
            data: Register::new(USART1, 0x04),
        }
    }

    fn take(&mut self) -> Option<u8> {
        // Bits 9 to 31 read as zero, and bit 8 too with eight data bits.
        (self.state.read() & Self::RECEIVED != 0).then(|| self.data.read() as u8)
    }

    /// From here on an interrupt puts the bytes that arrive into `filler`; they can no longer be read from here.
    pub fn listen(&mut self, filler: Filler<'static>) {
        received::listen(filler);
        let enable = Self::RECEIVE_INTERRUPT_ENABLE;
        Register::new(USART1, 0x0c).change(enable, enable);
        // SAFETY: no critical section relies on this interrupt being masked.
        unsafe { NVIC::unmask(ReceiveInterrupt) };
        // A byte that came before has raised no interrupt, and the next ones wait behind it.
        receive();
    }

    fn start() -> Self {
        // PB6 and PB7 in their seventh alternate function.
        const ALTERNATE: u32 = 0b1010;
        Register::new(GPIOB, 0x00).change(0b1111 << 12, ALTERNATE << 12);
        Register::new(GPIOB, 0x20).change(0xff << 24, 0x77 << 24);
        Register::new(USART1, 0x08).write(CLOCK_HZ / Self::BAUD_HZ);
        let control = Self::ENABLE | Self::TRANSMIT_ENABLE | Self::RECEIVE_ENABLE;
        Register::new(USART1, 0x0c).write(control);
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
            while self.state.read() & Self::TRANSMIT_EMPTY == 0 {}
            self.data.write(u32::from(byte));
        }
        Ok(bytes.len())
    }

    /// Returns when the last byte has left.
    fn flush(&mut self) -> Result<(), Infallible> {
        while self.state.read() & Self::SENT == 0 {}
        Ok(())
    }
}

impl Read for Serial {
    /// Waits for the first byte and returns it with those that have arrived by then.
    fn read(&mut self, bytes: &mut [u8]) -> Result<usize, Infallible> {
        if bytes.is_empty() {
            return Ok(0);
        }
        while self.state.read() & Self::RECEIVED == 0 {}
        let mut count = 0;
        for byte in bytes {
            let Some(received) = self.take() else { break };
            *byte = received;
            count += 1;
        }
        Ok(count)
    }
}

/// A timer of 32 bits that counts up to a value, then starts again.
struct Timer {
    control: Register,
    interrupts: Register,
    state: Register,
    events: Register,
    count: Register,
    prescaler: Register,
    reload: Register,
}

impl Timer {
    const ENABLE: u32 = 1;
    const UPDATE: u32 = 1;

    const fn new(base: usize) -> Self {
        Timer {
            control: Register::new(base, 0x00),
            interrupts: Register::new(base, 0x0c),
            state: Register::new(base, 0x10),
            events: Register::new(base, 0x14),
            count: Register::new(base, 0x24),
            prescaler: Register::new(base, 0x28),
            reload: Register::new(base, 0x2c),
        }
    }

    fn start(&mut self, clocks: u32) {
        self.stop();
        self.prescaler.write(0);
        // A period of n clocks is a reload value of n - 1, because zero takes a clock too.
        self.reload.write(clocks.saturating_sub(1));
        // Starts the count anew with these values, which itself counts as an update.
        self.events.write(Self::UPDATE);
        self.clear_interrupt();
        self.interrupts.write(Self::UPDATE);
        self.control.write(Self::ENABLE);
    }

    fn stop(&mut self) {
        self.control.write(0);
        self.interrupts.write(0);
    }

    fn clear_interrupt(&mut self) {
        self.state.write(0);
    }

    fn has_expired(&self) -> bool {
        self.state.read() & Self::UPDATE != 0
    }
}

/// Busy waits.
pub struct Delay {
    timer: Timer,
}

impl DelayNs for Delay {
    fn delay_ns(&mut self, nanoseconds: u32) {
        // The timer does not run with a reload value of zero; two clocks are no longer than the
        // call itself.
        let clocks = nanoseconds.div_ceil(NANOSECONDS_A_TIMER_CLOCK);
        self.timer.start(clocks.max(2));
        while !self.timer.has_expired() {}
        self.timer.stop();
    }
}

/// The fixed period of a control loop.
pub struct PeriodicTimer {
    timer: Timer,
    seen: u32,
}

impl Tick for PeriodicTimer {
    fn start(&mut self, period_us: u32) {
        self.seen = TICKS.load(Ordering::Relaxed);
        let clocks = period_us.max(1).saturating_mul(TIMER_CLOCKS_A_MICROSECOND);
        self.timer.start(clocks);
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
        // The emulator's count goes on where the part's begins again.
        let since = self
            .timer
            .count
            .read()
            .wrapping_sub(COUNT.load(Ordering::Relaxed));
        since / TIMER_CLOCKS_A_MICROSECOND
    }
}

/// The interrupt of USART1 as the interrupt controller wants it named.
#[derive(Clone, Copy)]
struct ReceiveInterrupt;

// SAFETY: always the same number, which is that of USART1.
unsafe impl cortex_m::interrupt::InterruptNumber for ReceiveInterrupt {
    fn number(self) -> u16 {
        USART1_INTERRUPT as u16
    }
}

/// The interrupt of TIM2 as the interrupt controller wants it named.
#[derive(Clone, Copy)]
struct TimerInterrupt;

// SAFETY: always the same number, which is that of TIM2.
unsafe impl cortex_m::interrupt::InterruptNumber for TimerInterrupt {
    fn number(self) -> u16 {
        TIM2_INTERRUPT as u16
    }
}
