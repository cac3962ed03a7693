//! Counts executed instructions with SysTick, exactly, under QEMU's `-icount`.
//!
//! With `-icount shift=S` the emulator lets 2^S nanoseconds pass for each instruction, whatever
//! the instruction. SysTick counts a 25 MHz clock down, 40 ns a step, so
//!
//! ```text
//! instructions = steps * 40 / 2^S
//! ```
//!
//! with an error of less than 40 / 2^S instructions, because both ends of a measurement fall
//! anywhere within a step. At S = 7 that is 5/16 of an instruction, and rounding to the nearest
//! gives the exact number, every time the same; likewise at 8 to 10. At S = 6 the error reaches
//! 5/8, so a single figure can be off by one. At S = 3, which leaves a control loop enough
//! instructions a millisecond, a figure is within 5.
//!
//! The counter does not need to be told S: it times a loop of a known number of instructions
//! when it starts. Where the clock does not follow the instructions (the emulator without
//! `-icount`, a real processor with wait states) that loop shows it, and counting is refused
//! rather than made up. Instructions are not cycles.
//!
//! SysTick has 24 bits. Its exception counts how often it went round, so a measurement may be
//! long; each round costs the few instructions of that exception. [`InstructionCounter::count`]
//! starts a round anew, and 5.2 million instructions at S = 7 fit one.

use core::arch::asm;
use core::hint::black_box;
use core::sync::atomic::{AtomicU32, Ordering, compiler_fence};

use cortex_m::peripheral::SYST;
use cortex_m::peripheral::syst::SystClkSource;
use cortex_m_rt::exception;

use crate::player::Meter;

/// Nanoseconds of one step of SysTick: 25 MHz on the boards that QEMU emulates.
const NANOSECONDS_A_STEP: u64 = 40;
/// SysTick starts again from here; all of its 24 bits.
const RELOAD: u32 = 0x00ff_ffff;
/// Turns of the loop that finds S, two instructions each: long enough that the few instructions
/// around it and the ends within a step change nothing after rounding to a power of two.
const CALIBRATION_TURNS: u32 = 2_000;
/// The greatest S that the emulator knows.
const GREATEST_SHIFT: u32 = 10;

/// How often SysTick has gone round.
static ROUNDS: AtomicU32 = AtomicU32::new(0);

#[exception]
fn SysTick() {
    ROUNDS.fetch_add(1, Ordering::Relaxed);
}

/// The clock does not follow the executed instructions.
#[derive(Clone, Copy, Debug, PartialEq, Eq, defmt::Format)]
pub struct NoInstructionClock {
    /// Instructions that were executed.
    pub instructions: u32,
    /// SysTick's steps meanwhile.
    pub steps: u32,
}

/// A moment to measure from: SysTick's steps since it was started.
#[derive(Clone, Copy, Debug)]
pub struct Mark(u64);

/// Counts instructions; owns SysTick.
pub struct InstructionCounter {
    systick: SYST,
    shift: u32,
    overhead: u32,
}

impl InstructionCounter {
    /// Starts SysTick and finds out how its clock follows the instructions.
    ///
    /// # Errors
    ///
    /// [`NoInstructionClock`] if it does not.
    pub fn start(mut systick: SYST) -> Result<Self, NoInstructionClock> {
        systick.set_clock_source(SystClkSource::Core);
        systick.set_reload(RELOAD);
        systick.clear_current();
        systick.enable_interrupt();
        systick.enable_counter();
        let before = steps();
        spin(CALIBRATION_TURNS);
        let steps = steps() - before;
        let instructions = 2 * CALIBRATION_TURNS;
        let follows = |shift: &u32| {
            // Within one part in 64 of what that shift means.
            let expected = (u64::from(instructions) << *shift) / NANOSECONDS_A_STEP;
            steps.abs_diff(expected) <= expected / 64
        };
        let shift = (0..=GREATEST_SHIFT).find(follows);
        let mut counter = InstructionCounter {
            systick,
            shift: shift.ok_or(NoInstructionClock {
                instructions,
                steps: u32::try_from(steps).unwrap_or(u32::MAX),
            })?,
            overhead: 0,
        };
        counter.overhead = counter.count(|| ()).1;
        Ok(counter)
    }

    /// How far a count can be off, in instructions: 0 means exact.
    #[must_use]
    pub fn error_bound(&self) -> u32 {
        // Less than 40 / 2^S, then rounded to the nearest.
        ((NANOSECONDS_A_STEP as u32) + (1 << self.shift) / 2) >> self.shift
    }

    /// What counting an empty piece of work gives. It is subtracted from every count.
    #[must_use]
    pub fn overhead(&self) -> u32 {
        self.overhead
    }

    /// The moment of the call.
    #[must_use]
    pub fn mark(&self) -> Mark {
        let mark = Mark(steps());
        compiler_fence(Ordering::SeqCst);
        mark
    }

    /// Instructions since `mark`, those of the two calls among them.
    #[must_use]
    pub fn since(&self, mark: Mark) -> u32 {
        compiler_fence(Ordering::SeqCst);
        let nanoseconds = (steps() - mark.0) * NANOSECONDS_A_STEP;
        let half = (1 << self.shift) / 2;
        u32::try_from((nanoseconds + half) >> self.shift).unwrap_or(u32::MAX)
    }

    /// Runs `work` and counts its instructions alone. Marks that were made before become void.
    #[inline(never)]
    pub fn count<Output>(&mut self, work: impl FnOnce() -> Output) -> (Output, u32) {
        self.systick.clear_current();
        let mark = self.mark();
        let output = black_box(work());
        let counted = self.since(mark);
        (output, counted.saturating_sub(self.overhead))
    }
}

/// SysTick's steps since it was started.
fn steps() -> u64 {
    loop {
        let rounds = ROUNDS.load(Ordering::Relaxed);
        let current = SYST::get_current();
        // The exception strikes at once, so a round that ended in between has been counted.
        if rounds == ROUNDS.load(Ordering::Relaxed) {
            // A round begins at 0, where it also starts, and goes on from the reload value down.
            let in_round = (RELOAD + 1 - current) & RELOAD;
            return u64::from(rounds) * u64::from(RELOAD + 1) + u64::from(in_round);
        }
    }
}

/// Adds up the instructions of several pieces of work. Without a counter it measures nothing.
pub struct InstructionMeter<'a> {
    counter: Option<&'a InstructionCounter>,
    started: Option<Mark>,
    total: Option<u32>,
}

impl<'a> InstructionMeter<'a> {
    /// A meter that has measured nothing yet.
    #[must_use]
    pub fn new(counter: Option<&'a InstructionCounter>) -> Self {
        InstructionMeter {
            counter,
            started: None,
            total: counter.map(|_| 0),
        }
    }

    /// The instructions of all pieces; `None` without a counter.
    #[must_use]
    pub fn total(&self) -> Option<u32> {
        self.total
    }
}

impl Meter for InstructionMeter<'_> {
    fn start(&mut self) {
        self.started = self.counter.map(InstructionCounter::mark);
    }

    fn stop(&mut self) {
        if let (Some(counter), Some(mark), Some(total)) =
            (self.counter, self.started.take(), &mut self.total)
        {
            let piece = counter.since(mark).saturating_sub(counter.overhead);
            *total = total.saturating_add(piece);
        }
    }
}

/// Executes two instructions a turn, `turns` times.
#[inline(never)]
fn spin(turns: u32) {
    // SAFETY: counts a register of its own down to zero; no memory, no stack, flags declared as
    // changed by default.
    unsafe {
        asm!(
            "2:",
            "subs {turns}, {turns}, #1",
            "bne 2b",
            turns = inout(reg) turns => _,
            options(nomem, nostack)
        );
    }
}
