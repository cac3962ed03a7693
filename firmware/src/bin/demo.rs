//! Bends the example finger: a control loop at a fixed tick that moves the cage, deforms every
//! point of the model and streams it over the serial port.
//!
//! The log ends with figures that the host prints. On an emulated processor instructions are
//! counted; where the clock does not follow them (`octruss_firmware::instructions`) the figures
//! are left out.
#![no_std]
#![no_main]

use cortex_m_rt::entry;
use heapless::Vec;
use octruss::bundle::Bundle;
use octruss_firmware::board::Board;
use octruss_firmware::exit::{self, Ending, figure};
use octruss_firmware::include_example;
use octruss_firmware::instructions::{InstructionCounter, InstructionMeter};
use octruss_firmware::player::{Player, ROWS_A_PIECE};
use octruss_firmware::sections::section_bytes;
use octruss_firmware::stack;
use octruss_firmware::tick::Tick;
use zerocopy::FromBytes;

/// The period of the control loop: 50 frames a second.
const PERIOD_US: u32 = 20_000;

/// The most control points that the pose in RAM holds.
const CONTROL_POINTS: usize = 256;

#[entry]
fn main() -> ! {
    static mut PIECE: [[i32; 3]; ROWS_A_PIECE] = [[0; 3]; ROWS_A_PIECE];
    static mut POSE: Vec<[i32; 3], CONTROL_POINTS> = Vec::new();

    let (bundle, poses) = include_example!();
    let bundle = match Bundle::new_checked(bundle) {
        Ok(bundle) => bundle,
        Err(error) => refuse(&error),
    };
    let table = match bundle.table::<i32>() {
        Ok(table) => table,
        Err(error) => refuse(&error),
    };
    let Ok(poses) = <[[i32; 3]]>::ref_from_bytes(poses) else {
        refuse(&"the poses are not made of points")
    };
    let (Some(board), Some(core)) = (Board::take(), cortex_m::Peripherals::take()) else {
        refuse(&"the peripherals have been taken before")
    };
    let counter = InstructionCounter::start(core.SYST);
    if let Err(error) = &counter {
        defmt::warn!("instructions are not counted: {}", error);
    }
    let counter = counter.ok();

    let mut tick = board.tick;
    let mut player = Player::new(table, board.led, board.serial, PIECE);
    let mut missed: u32 = 0;
    let mut busiest = Busiest::default();
    let mut frames: u32 = 0;
    tick.start(PERIOD_US);
    for pose in poses.chunks_exact(table.control_points().max(1)) {
        missed = missed.saturating_add(tick.wait().saturating_sub(1));
        let mut meter = InstructionMeter::new(counter.as_ref());
        let start = counter.as_ref().map(InstructionCounter::mark);
        POSE.clear();
        if POSE.extend_from_slice(pose).is_err() {
            refuse(&"the pose in RAM holds fewer control points than the cage has")
        }
        let saturated = match player.play(frames, POSE, &mut meter) {
            Ok(saturated) => saturated,
            Err(error) => refuse(&error),
        };
        let apply = meter.total();
        let whole = counter
            .as_ref()
            .zip(start)
            .map(|(counter, start)| counter.since(start));
        defmt::info!(
            "frame {=u32}: apply {}, whole tick {} instructions, {=u32} coordinates saturated",
            frames,
            apply,
            whole,
            saturated
        );
        busiest.take(apply, whole);
        frames += 1;
    }
    figure("frames", frames);
    figure("rows", table.rows() as u32);
    figure("control points", table.control_points() as u32);
    figure("stored weights", table.taps() as u32);
    figure("bundle bytes", bundle.header().total_bytes.get());
    figure("period us", PERIOD_US);
    figure("missed ticks", missed);
    busiest.report(counter.as_ref(), table.rows().div_ceil(ROWS_A_PIECE));
    report_memory();
    exit::finish()
}

/// The most instructions that any frame took; `None` while none was counted.
#[derive(Default)]
struct Busiest {
    apply: Option<u32>,
    whole: Option<u32>,
}

impl Busiest {
    fn take(&mut self, apply: Option<u32>, whole: Option<u32>) {
        self.apply = self.apply.max(apply);
        self.whole = self.whole.max(whole);
    }

    /// `pieces` measurements add up to the apply's figure.
    fn report(&self, counter: Option<&InstructionCounter>, pieces: usize) {
        let (Some(counter), Some(apply), Some(whole)) = (counter, self.apply, self.whole) else {
            return;
        };
        let bound = counter.error_bound();
        figure("apply instructions a frame", apply);
        figure("apply error bound", bound.saturating_mul(pieces as u32));
        figure("whole tick instructions", whole);
        figure("whole tick error bound", bound);
    }
}

fn report_memory() {
    let sections = section_bytes();
    figure("stack bytes", stack::bytes_used_at_most() as u32);
    figure("flash bytes", sections.flash as u32);
    figure("static RAM bytes", sections.ram as u32);
}

/// Says why the demo cannot go on and ends it.
fn refuse(reason: &dyn core::fmt::Debug) -> ! {
    defmt::error!("{}", defmt::Debug2Format(&reason));
    exit::stop(Ending::Refused)
}
