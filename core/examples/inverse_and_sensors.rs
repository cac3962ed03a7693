//! Goals to amplitudes, and measured points back to amplitudes, without a file: two actuators move one effector.
//!
//! ```sh
//! cargo run -p octruss --example inverse_and_sensors
//! ```

#![allow(
    clippy::float_arithmetic,
    clippy::arithmetic_side_effects,
    clippy::indexing_slicing,
    reason = "an example that prints on a computer"
)]

use octruss::control::inverse::{GaveUp, Inverse, InverseError, InverseParts, InverseState};

/// An amplitude of one.
const ONE: i32 = 1 << 30;
/// A coordinate of one.
const UNIT: i32 = 1 << 20;

/// The first actuator moves the effector by one along x, the second along y; they do not couple. A baker makes these
/// numbers from a cage, its modes and points of the model: see `octruss bake --actuators`.
fn parts() -> InverseParts<'static> {
    InverseParts {
        hessian: &[1 << 28, 0, 0, 1 << 28],
        reciprocals: &[1 << 30; 2],
        gains: &[1 << 28, 0, 0, 0, 1 << 28, 0],
        rest: &[[0; 3]],
        lower: &[-ONE; 2],
        upper: &[ONE; 2],
        rates: &[ONE / 4; 2],
        difference_shift: 0,
        gain_shift: 10,
    }
}

fn main() -> Result<(), InverseError> {
    let solver = Inverse::new_checked(parts())?;

    // Actuators: the goal jumps, the amplitudes follow at their rate and stop at their bound.
    let mut state = InverseState::new(&solver);
    for tick in 1..=5 {
        let report = solver.tick(&[[2 * UNIT, UNIT / 2, 0]], None, &mut state)?;
        println!(
            "tick {tick}: amplitudes {:.3} {:.3}, held back {:#b}",
            real(state.amplitudes()[0]),
            real(state.amplitudes()[1]),
            report.held_back
        );
        assert!(report.gave_up.contains(GaveUp::HELD_BACK));
    }

    // Sensors: the same solver with measured points for goals, and rates of no limit.
    let free = InverseParts {
        rates: &[i32::MAX; 2],
        ..parts()
    };
    let sensors = Inverse::new_checked(free)?;
    let mut pose = InverseState::new(&sensors);
    sensors.tick(&[[UNIT / 3, -UNIT / 5, 0]], None, &mut pose)?;
    println!(
        "measured (0.333, -0.200): amplitudes {:.3} {:.3}",
        real(pose.amplitudes()[0]),
        real(pose.amplitudes()[1])
    );
    Ok(())
}

/// An amplitude as a real number, to be printed.
fn real(amplitude: i32) -> f64 {
    f64::from(amplitude) / f64::from(ONE)
}
