//! The kinds [`INVERSE`](super::INVERSE) and [`SENSORS`](super::SENSORS): amplitudes for goals, with and without
//! a volume to hold.
//!
//! | words | what |
//! | --- | --- |
//! | 1 | words of the solver's section, as it lies in a bundle |
//! | 1 each | the section |
//! | 1 | only of [`INVERSE`](super::INVERSE): number of the volume's coefficients |
//! | 1 each | the coefficients, signed |
//! | 4 | only of [`INVERSE`](super::INVERSE): the least and the greatest volume, signed numbers of 64 bits, the low word first |
//! | 1 | number of amplitudes to start from; none is rest |
//! | 1 each | the amplitudes, signed |
//! | 1 | number of ticks |
//! | 3 each | for each tick the goals, raw bits, signed |
//!
//! The result of each tick is what was given up, the actuators that are held back, sweeps, evaluations, the volume (the low
//! word first), and the amplitudes.

use octruss::control::inverse::{Inverse, InverseReport, InverseState, VolumeGoal};
use octruss::enclosed::VolumeModes;
use zerocopy::IntoBytes;

use super::results::{Results, Sink, Status};
use super::volume::wide;
use super::{SECTION_INVERSE, Words};

/// Runs a case with a volume.
pub(super) fn run<S: Sink>(words: &[u32], results: &mut Results<'_, S>) -> Result<(), Status> {
    let mut words = Words(words);
    let solver = solver(&mut words)?;
    let coefficients = words.length()?;
    let coefficients = words.numbers(coefficients)?;
    let goal = match (words.number()?, words.number()?) {
        (low, high) if low == high => VolumeGoal::Hold(low),
        (low, high) => VolumeGoal::Band(low, high),
    };
    let modes = u16::try_from(solver.actuators()).map_err(|_| Status::Malformed)?;
    let modes = VolumeModes::new_checked(modes, coefficients).map_err(Status::Enclosed)?;
    ticks(words, &solver, Some((&modes, goal)), results)
}

/// Runs a case without one.
pub(super) fn run_sensors<S: Sink>(
    words: &[u32],
    results: &mut Results<'_, S>,
) -> Result<(), Status> {
    let mut words = Words(words);
    let solver = solver(&mut words)?;
    ticks(words, &solver, None, results)
}

fn solver<'a>(words: &mut Words<'a>) -> Result<Inverse<'a>, Status> {
    let section = words.length()?;
    let section = words.elements::<1>(section)?;
    Inverse::from_section(section.as_bytes()).map_err(Status::Inverse)
}

fn ticks<S: Sink>(
    mut words: Words<'_>,
    solver: &Inverse<'_>,
    volume: Option<(&VolumeModes<'_>, VolumeGoal)>,
    results: &mut Results<'_, S>,
) -> Result<(), Status> {
    let mut state = InverseState::new(solver);
    let start = words.length()?;
    let start = words.numbers(start)?;
    if !start.is_empty() {
        state.set_amplitudes(start);
    }
    for _ in 0..words.length()? {
        let goals = words.points(solver.effectors())?;
        let report = solver
            .tick(goals, volume, &mut state)
            .map_err(Status::Inverse)?;
        let amplitudes = state.amplitudes().get(..solver.actuators());
        let head = head(&report);
        results.begin_section(
            SECTION_INVERSE,
            head.len().saturating_add(solver.actuators()),
        );
        results.words(&head);
        for amplitude in amplitudes.unwrap_or_default() {
            results.words(&[amplitude.cast_unsigned()]);
        }
    }
    words.finish()
}

/// The words of a report.
#[must_use]
pub fn head(report: &InverseReport) -> [u32; 6] {
    let [low, high] = wide(report.volume);
    [
        report.gave_up.bits(),
        u32::from(report.held_back),
        report.sweeps,
        report.evaluations,
        low,
        high,
    ]
}
