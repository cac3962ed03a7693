//! The finger follows goals of its effectors, once with its volume held and once without.
//!
//! `inverse.oct` and `frames.bin` (the goals of each frame) come from the host; `held.bin` goes back: for each frame and
//! first with the volume held, then without, the amplitudes, the bits of what was given up, and the volume by modes (the low word
//! first). Each frame gives the solver [`TICKS`] ticks.
#![no_std]
#![no_main]

use core::slice;

use cortex_m_rt::entry;
use octruss::bundle::Bundle;
use octruss::control::inverse::{InverseState, MOST_ACTUATORS, VolumeGoal};
use octruss_firmware::exit::{self, Ending};
use octruss_firmware::files::{Input, Output};
use zerocopy::{FromBytes, IntoBytes};

/// The boards' memory beyond what the linker knows of.
const LARGE_MEMORY: usize = 0x2100_0000;
/// What is used of it for each file.
const LENGTH: usize = 4 << 20;
/// Ticks of a frame.
const TICKS: u32 = 8;

#[entry]
fn main() -> ! {
    // SAFETY: the boards that this image runs on have 16 MiB there, which nothing else uses; the two parts do not
    // overlap.
    let (bundle, goals) = unsafe {
        (
            slice::from_raw_parts_mut(LARGE_MEMORY as *mut u8, LENGTH),
            slice::from_raw_parts_mut((LARGE_MEMORY + LENGTH) as *mut u8, LENGTH),
        )
    };
    let length = Input::open(c"inverse.oct").read(bundle);
    let Ok(bundle) = Bundle::new_checked(bundle.get(..length).unwrap_or_default()) else {
        refuse("inverse.oct does not open")
    };
    let (Ok(Some(solver)), Ok(Some(modes))) =
        (bundle.inverse::<i32>(), bundle.volume_modes::<i32>(0))
    else {
        refuse("inverse.oct holds no solver or no volume by modes")
    };
    let length = Input::open(c"frames.bin").read(goals);
    let goals = goals.get(..length).unwrap_or_default();
    let Ok(goals) = <[[i32; 3]]>::ref_from_bytes(goals) else {
        refuse("frames.bin holds no goals")
    };
    let Ok(target) = modes.volume(&[0; MOST_ACTUATORS][..solver.actuators()]) else {
        refuse("the volume has other modes than the solver")
    };
    let mut output = Output::create(c"held.bin");
    let mut states = [InverseState::new(&solver); 2];
    let holds = [Some((&modes, VolumeGoal::Hold(target))), None];
    for goals in goals.chunks_exact(solver.effectors()) {
        for (state, volume) in states.iter_mut().zip(holds) {
            let mut gave_up = 0;
            for _ in 0..TICKS {
                match solver.tick(goals, volume, state) {
                    Ok(report) => gave_up = report.gave_up.bits(),
                    Err(_) => refuse("a tick is refused"),
                }
            }
            let amplitudes = state.amplitudes();
            let volume = modes.volume(&amplitudes[..solver.actuators()]);
            output.write(amplitudes.as_bytes());
            output.write(gave_up.as_bytes());
            output.write(volume.unwrap_or_default().as_bytes());
        }
    }
    exit::finish()
}

/// Says why nothing can be done and ends the image.
fn refuse(reason: &str) -> ! {
    defmt::error!("{=str}", reason);
    exit::stop(Ending::Refused)
}
