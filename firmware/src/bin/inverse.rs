//! Instructions of the goals' solver: ticks towards goals that move smoothly and towards goals that jump, with the
//! volume held, in a band, and without one.
//!
//! The bundle `inverse.oct` and the goals of all ticks, `goals.bin` (first the smooth half, then the half that jumps),
//! come from the host into the board's large memory (16 MiB that only the emulated boards have). Figures are
//! those of whole ticks, counted by `octruss_firmware::instructions`, exactly.
#![no_std]
#![no_main]

use core::hint::black_box;
use core::slice;

use cortex_m_rt::entry;
use octruss::bundle::Bundle;
use octruss::control::inverse::{GaveUp, Inverse, InverseState, VolumeGoal};
use octruss::enclosed::VolumeModes;
use octruss_firmware::exit::{self, Ending, figure};
use octruss_firmware::files::Input;
use octruss_firmware::instructions::InstructionCounter;
use zerocopy::FromBytes;

/// The boards' memory beyond what the linker knows of.
const LARGE_MEMORY: usize = 0x2100_0000;
/// What is used of it for each file.
const LENGTH: usize = 4 << 20;

/// What the volume shall be.
#[derive(Clone, Copy)]
enum Hold {
    /// That at rest.
    Rest,
    /// Within a fiftieth of that at rest.
    Band,
    /// Anything.
    Free,
}

#[entry]
fn main() -> ! {
    let Some(core) = cortex_m::Peripherals::take() else {
        refuse("the peripherals have been taken before")
    };
    let Ok(mut counter) = InstructionCounter::start(core.SYST) else {
        refuse("the clock does not follow the instructions: run with -icount shift=7")
    };
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
    let length = Input::open(c"goals.bin").read(goals);
    let goals = goals.get(..length).unwrap_or_default();
    let Ok(goals) = <[[i32; 3]]>::ref_from_bytes(goals) else {
        refuse("goals.bin holds no goals")
    };
    let (smooth, jumping) = goals.split_at(goals.len() / 2);
    let mut bench = Bench {
        counter: &mut counter,
        solver: &solver,
        modes: &modes,
    };
    let names = ["inverse smooth", "inverse jumps"];
    for (name, goals) in names.into_iter().zip([smooth, jumping]) {
        for hold in [Hold::Rest, Hold::Band, Hold::Free] {
            bench.run(name, goals, hold);
        }
    }
    exit::finish()
}

struct Bench<'a, 'b> {
    counter: &'a mut InstructionCounter,
    solver: &'a Inverse<'b>,
    modes: &'a VolumeModes<'b>,
}

impl Bench<'_, '_> {
    /// Runs all ticks and logs mean and greatest count, and how many ticks missed the volume.
    fn run(&mut self, name: &str, goals: &[[i32; 3]], hold: Hold) {
        let Ok(rest) = self.modes.volume(&[0; 16][..self.modes.modes().min(16)]) else {
            refuse("the volume has more than 16 modes")
        };
        let band = rest / 50;
        let (what, goal) = match hold {
            Hold::Rest => ("held", Some(VolumeGoal::Hold(rest))),
            Hold::Band => ("band", Some(VolumeGoal::Band(rest - band, rest + band))),
            Hold::Free => ("free", None),
        };
        let mut state = InverseState::new(self.solver);
        let (mut sum, mut most, mut ticks, mut missed, mut refused) = (0_u32, 0, 0_u32, 0, 0);
        for goals in goals.chunks_exact(self.solver.effectors()) {
            let goals = black_box(goals);
            let (solver, modes) = (self.solver, self.modes);
            let volume = goal.map(|goal| (modes, goal));
            let (report, counted) = self
                .counter
                .count(|| solver.tick(goals, volume, &mut state));
            let Ok(report) = report else {
                refuse("a tick is refused")
            };
            sum = sum.saturating_add(counted);
            most = counted.max(most);
            ticks = ticks.saturating_add(1);
            missed += u32::from(report.gave_up.contains(GaveUp::VOLUME_MISSED));
            refused += u32::from(report.gave_up.contains(GaveUp::STEP_REFUSED));
        }
        let mean = sum / ticks.max(1);
        log(name, what, [mean, most, ticks, missed, refused]);
    }
}

/// One figure for each number.
fn log(name: &str, what: &str, numbers: [u32; 5]) {
    let words = ["mean", "most", "ticks", "missed", "refused"];
    for (word, number) in words.into_iter().zip(numbers) {
        let mut text = heapless::String::<64>::new();
        let parts = [name, what, word];
        for part in parts {
            // Names are shorter than the text.
            let _ = text.push_str(part);
            let _ = text.push(' ');
        }
        figure(text.trim_end(), number);
    }
}

/// Says why nothing can be measured and ends the image.
fn refuse(reason: &str) -> ! {
    defmt::error!("{=str}", reason);
    exit::stop(Ending::Refused)
}
