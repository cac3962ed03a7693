//! A palm in the wind, for a minute: springs move the control points, the table every point of the model, fifty times a
//! second.
//!
//! Every second the log tells the checksums of the springs' state and of the deformed model.
#![no_std]
#![no_main]

use core::fmt::Write;

use cortex_m_rt::entry;
use heapless::{String, Vec};
use octruss::bundle::Bundle;
use octruss::control::springs::PointState;
use octruss_firmware::board::Board;
use octruss_firmware::checksum;
use octruss_firmware::exit::{self, Ending, figure};
use octruss_firmware::include_baked;
use octruss_firmware::palm::{Palm, PalmMemory, SECONDS, TICKS_A_SECOND};
use octruss_firmware::player::ROWS_A_PIECE;
use octruss_firmware::sections::section_bytes;
use octruss_firmware::tick::Tick;

/// The most control points that the memory holds.
const CONTROL_POINTS: usize = 256;

#[entry]
fn main() -> ! {
    static mut PIECE: [[i32; 3]; ROWS_A_PIECE] = [[0; 3]; ROWS_A_PIECE];
    static mut POSE: [[i32; 3]; CONTROL_POINTS] = [[0; 3]; CONTROL_POINTS];
    static mut PUSHES: [[i32; 3]; CONTROL_POINTS] = [[0; 3]; CONTROL_POINTS];
    static mut STATE: Vec<PointState, CONTROL_POINTS> = Vec::new();

    let bundle = match Bundle::new_checked(include_baked!("/palm.oct")) {
        Ok(bundle) => bundle,
        Err(error) => refuse(&error),
    };
    let palm = match Palm::open(&bundle) {
        Ok(palm) => palm,
        Err(error) => refuse(&error),
    };
    let points = bundle.rest_cage().len();
    if STATE.resize_default(points).is_err() {
        refuse(&"the memory holds fewer control points than the cage has")
    }
    let mut memory = PalmMemory {
        state: STATE,
        pose: POSE.get_mut(..points).unwrap_or_default(),
        pushes: PUSHES.get_mut(..points).unwrap_or_default(),
    };
    if let Err(error) = palm.start(&mut memory) {
        refuse(&error)
    }
    let Some(mut board) = Board::take() else {
        refuse(&"the peripherals have been taken before")
    };
    let (mut missed, mut clamped, mut busy) = (0_u32, 0_u32, 0);
    board.tick.start(1_000_000 / TICKS_A_SECOND);
    for tick in 0..SECONDS * TICKS_A_SECOND {
        missed = missed.saturating_add(board.tick.wait().saturating_sub(1));
        let moved = palm.tick(tick, &mut memory);
        let model = checksum::of_model(&palm.table, memory.pose, PIECE);
        let (Ok(more), Ok(model)) = (moved, model) else {
            refuse(&"the memory is not that of the palm")
        };
        clamped = clamped.saturating_add(more);
        busy = board.tick.elapsed_us().max(busy);
        if tick % TICKS_A_SECOND == TICKS_A_SECOND - 1 {
            let second = tick / TICKS_A_SECOND;
            tell(second, "state", Palm::state_hash(&memory));
            tell(second, "model", model.0);
            clamped = clamped.saturating_add(model.1);
        }
    }
    figure("missed ticks", missed);
    figure("clamped coordinates", clamped);
    figure("busy us", busy);
    figure("flash bytes", section_bytes().flash as u32);
    exit::finish()
}

/// One checksum of a second.
fn tell(second: u32, what: &str, checksum: u32) {
    let mut name = String::<32>::new();
    // At most 23 letters.
    let _ = write!(name, "second {second} {what}");
    figure(&name, checksum);
}

/// Says why there is no palm and ends the image.
fn refuse(reason: &dyn core::fmt::Debug) -> ! {
    defmt::error!("{}", defmt::Debug2Format(&reason));
    exit::stop(Ending::Refused)
}
