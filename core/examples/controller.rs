//! The smallest complete controller: goals of a few points in, a deformed skin out, the volume held.
//!
//! ```sh
//! octruss bake models/finger.msh --model models/finger.obj --unit mm --volume --modes models/finger-modes.csv \
//!     --actuators models/finger-actuators.csv --effectors models/finger-effectors.csv -o finger.oct
//! cargo run --release -p octruss --example controller finger.oct
//! ```
//!
//! [`Controller`] is what a firmware engineer links: no allocation, no float, no panic. The rest of this file gives
//! it goals on a computer.

#![allow(
    clippy::float_arithmetic,
    clippy::arithmetic_side_effects,
    clippy::indexing_slicing,
    reason = "an example that prints on a computer"
)]

use octruss::bundle::{Bundle, BundleError};
use octruss::control::inverse::{Inverse, InverseReport, InverseState, VolumeGoal};
use octruss::enclosed::VolumeModes;

/// Configuration in flash, borrowed from the bundle, and what is remembered.
struct Controller<'a> {
    solver: Inverse<'a>,
    modes: VolumeModes<'a>,
    volume: VolumeGoal,
    state: InverseState,
}

impl<'a> Controller<'a> {
    /// Opened once. `None` if the bundle was baked without `--actuators` and `--volume`.
    fn new(bundle: &Bundle<'a>) -> Result<Option<Self>, BundleError> {
        let (Some(solver), Some(modes)) =
            (bundle.inverse::<i32>()?, bundle.volume_modes::<i32>(0)?)
        else {
            return Ok(None);
        };
        let state = InverseState::new(&solver);
        let at_rest = state.amplitudes().get(..modes.modes());
        let volume = at_rest.and_then(|at_rest| modes.volume(at_rest).ok());
        Ok(volume.map(|volume| Self {
            solver,
            modes,
            volume: VolumeGoal::Hold(volume),
            state,
        }))
    }

    /// On every tick: one goal for each effector in, the amplitudes for the actuators are in the state.
    fn tick(&mut self, goals: &[[i32; 3]]) -> Option<InverseReport> {
        let volume = Some((&self.modes, self.volume));
        self.solver.tick(goals, volume, &mut self.state).ok()
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let file = std::env::args().nth(1).ok_or("name a bundle")?;
    let bytes = std::fs::read(file)?;
    // A bundle lies on a multiple of 8; on a device `include_bundle!` sees to it.
    let mut words = vec![0_u64; bytes.len().div_ceil(8)];
    let aligned: &mut [u8] = bytemuck::cast_slice_mut(&mut words);
    let aligned = aligned.get_mut(..bytes.len()).ok_or("no bytes")?;
    aligned.copy_from_slice(&bytes);
    let bundle = Bundle::new_checked(aligned)?;
    let mut controller = Controller::new(&bundle)?.ok_or("bake with --actuators and --volume")?;

    // Every effector is asked to go two units along x, step by step.
    let unit = 1_i32.wrapping_shl(bundle.header().fraction_bits.get());
    let mut goals = controller.solver.parts().rest.to_vec();
    for tick in 1..=16 {
        for [x, _, _] in &mut goals {
            *x = x.saturating_add(unit / 8);
        }
        let report = controller
            .tick(&goals)
            .ok_or("goals do not fit the solver")?;
        println!(
            "tick {tick}: volume {}, {} sweeps, gave up {:#x}, amplitudes {:?}",
            report.volume,
            report.sweeps,
            report.gave_up.bits(),
            controller.state.amplitudes()
        );
    }
    Ok(())
}
