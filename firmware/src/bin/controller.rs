//! The interactive controller: commands of a host arrive on the serial port, effectors follow their goals at a fixed
//! tick, set-points leave through a driver, and a record of every tick goes back.
//!
//! It runs until it is switched off. `docs/protocol.md` has the bytes; `octruss drive` speaks them. The bytes of
//! commands are taken by the serial port's interrupt, everything else happens on the tick:
//!
//! 1. the outputs change to the set-points of the tick before;
//! 2. commands that are due take effect, the amplitudes move, the model is deformed;
//! 3. telemetry leaves.
//!
//! The emulated boards have no chip for the outputs, so the driver writes into a copy of the chip's registers, and
//! telemetry carries what these hold.
#![no_std]
#![no_main]

use cortex_m_rt::entry;
use embedded_hal::digital::{OutputPin, PinState};
use embedded_io::Write;
use octruss::bundle::Bundle;
use octruss_firmware::actuators::{Pca9685, Pca9685Registers, Pulse};
use octruss_firmware::board::Board;
use octruss_firmware::controller::{
    BoardState, Controller, Memory, Motion, Parts, Queue, SET_POINT_MOST,
};
use octruss_firmware::exit::{self, Ending, figure};
use octruss_firmware::include_baked;
use octruss_firmware::link::wire::{self, ENCODED_BYTES};
use octruss_firmware::link::{CHANNELS, Ring};
use octruss_firmware::player::ROWS_A_PIECE;
use octruss_firmware::sections::section_bytes;
use octruss_firmware::tick::Tick;

/// The period of the control loop: 50 ticks a second.
const PERIOD_US: u32 = 20_000;
/// Periods of the outputs a second.
const OUTPUT_HZ: u32 = 50;
/// The most control points that the pose in RAM holds.
const CONTROL_POINTS: usize = 256;

#[entry]
fn main() -> ! {
    static mut QUEUE: Queue = Queue::new();
    static mut RING: Ring = Ring::new();
    static mut PIECE: [[i32; 3]; ROWS_A_PIECE] = [[0; 3]; ROWS_A_PIECE];
    static mut POSE: [[i32; 3]; CONTROL_POINTS] = [[0; 3]; CONTROL_POINTS];

    let bundle = match Bundle::new_checked(include_baked!("/controller.oct")) {
        Ok(bundle) => bundle,
        Err(error) => refuse(&error),
    };
    let parts = match Parts::open(&bundle) {
        Ok(parts) => parts,
        Err(error) => refuse(&error),
    };
    let Some(pose) = POSE.get_mut(..parts.actuation.control_points()) else {
        refuse(&"the pose in RAM holds fewer control points than the cage has")
    };
    let Some(motion) = Motion::new(parts, Memory { pose, piece: PIECE }) else {
        refuse(&"the pose in RAM is not that of the cage")
    };
    let Some(mut board) = Board::take() else {
        refuse(&"the peripherals have been taken before")
    };
    let pulse = Pulse::new(0, SET_POINT_MOST).unwrap_or(Pulse::WHOLE);
    let bus = Pca9685Registers::new();
    let address = Pca9685::<Pca9685Registers>::ADDRESS;
    let Ok(mut outputs) = Pca9685::start(bus, address, pulse, OUTPUT_HZ);
    report(&parts);

    let (filler, mut received) = RING.split();
    board.serial.listen(filler);
    let mut controller = Controller::new(motion, QUEUE);
    let mut state = BoardState::default();
    let mut set_points = [0; CHANNELS];
    board.tick.start(PERIOD_US);
    loop {
        let passed = board.tick.wait();
        state.missed = state.missed.saturating_add(passed.saturating_sub(1));
        let Ok(()) = outputs.set(&set_points);
        state.outputs = outputs.bus().counts();
        state.lost_bytes = received.lost();
        let telemetry = controller.tick(|| received.take(), state);
        set_points = controller.set_points();
        let light = PinState::from(telemetry.tick % 2 == 1);
        let Ok(()) = board.led.set_state(light);
        let mut frame = [0; ENCODED_BYTES + 1];
        // The record fits a frame: the link's tests write it.
        let length = wire::encode(&telemetry.payload(), &mut frame).unwrap_or(0);
        let Ok(()) = board
            .serial
            .write_all(frame.get(..length).unwrap_or_default());
        state.busy_us = board.tick.elapsed_us();
    }
}

/// Says what runs.
fn report(parts: &Parts<'_>) {
    figure("rows", parts.table.rows() as u32);
    figure("control points", parts.actuation.control_points() as u32);
    figure("actuators", parts.solver.actuators() as u32);
    figure("effectors", parts.solver.effectors() as u32);
    figure("period us", PERIOD_US);
    let sections = section_bytes();
    figure("flash bytes", sections.flash as u32);
    figure("static RAM bytes", sections.ram as u32);
}

/// Says why the controller cannot run and ends it.
fn refuse(reason: &dyn core::fmt::Debug) -> ! {
    defmt::error!("{}", defmt::Debug2Format(&reason));
    exit::stop(Ending::Refused)
}
