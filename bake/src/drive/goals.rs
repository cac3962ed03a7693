//! Where effectors shall go, tick by tick.

use crate::deform::{format_of, pose_bits};
use crate::error::{Error, Result};
use crate::read::{self, motion};
use octruss::bundle::Bundle;
use octruss_firmware::controller::Parts;
use octruss_firmware::link::{Command, Goal, MOST_GOALS};
use std::path::Path;

/// Goals of one tick: a place for each effector, raw bits.
pub type Goals = Vec<[i32; 3]>;

/// Reads goals of effectors: a `.csv` file with the columns `frame`, `point`, `x`, `y`, `z`, where points are the
/// effectors, counted from 0 in the order in which they were baked.
///
/// # Errors
/// If the file cannot be read, an effector is missing in a frame, or a place does not fit the bundle's format.
pub fn from_effectors(file: &Path, bundle: &Bundle<'_>, parts: &Parts<'_>) -> Result<Vec<Goals>> {
    let text = read::bytes(file)?;
    let frames =
        motion::read_csv(&text, parts.solver.effectors()).map_err(|error| error.in_file(file))?;
    let format = format_of(bundle);
    frames
        .iter()
        .map(|frame| format.bits_of(&frame.points, "effector"))
        .collect::<Result<_>>()
        .map_err(|error| error.in_file(file))
}

/// Goals that follow a motion of all control points: in each frame the places to which the table takes the effectors.
///
/// # Errors
/// If the motion cannot be read, or is that of another cage.
pub fn from_motion(file: &Path, bundle: &Bundle<'_>, parts: &Parts<'_>) -> Result<Vec<Goals>> {
    let frames = motion::read(file, bundle.rest_cage().len(), &|mesh| {
        crate::deform::require_cage(bundle, mesh)
    })?;
    let table = &parts.table;
    let mut all = Vec::new();
    for frame in frames {
        let pose = pose_bits(bundle, &frame.points).map_err(|error| error.in_file(file))?;
        let mut points = vec![[0; 3]; table.rows()];
        table
            .apply(0..table.rows(), &pose, &mut points)
            .map_err(|error| Error::new(error.to_string()))?;
        let rows = parts.actuation.effector_rows().iter();
        all.push(rows.map(|row| points[*row as usize]).collect());
    }
    Ok(all)
}

/// Goals for every tick: `ticks` from each frame to the next on straight lines, rounded down to whole bits, and the last
/// frame at the end.
#[must_use]
pub fn between(frames: &[Goals], ticks: u32) -> Vec<Goals> {
    let ticks = i64::from(ticks.max(1));
    let mut all = Vec::new();
    for pair in frames.windows(2) {
        for tick in 0..ticks {
            let place = |(from, to): (&[i32; 3], &[i32; 3])| {
                [0, 1, 2].map(|axis| {
                    let (from, to) = (i64::from(from[axis]), i64::from(to[axis]));
                    // Between two numbers of 32 bits.
                    (from + ((to - from) * tick).div_euclid(ticks)) as i32
                })
            };
            all.push(pair[0].iter().zip(&pair[1]).map(place).collect());
        }
    }
    all.extend(frames.last().cloned());
    all
}

/// The commands that set the goals of one tick.
pub fn commands(goals: &[[i32; 3]]) -> impl Iterator<Item = Command> + '_ {
    goals.chunks(MOST_GOALS).enumerate().map(|(part, places)| {
        let goal = |(index, place): (usize, &[i32; 3])| Goal {
            // A solver has at most 32 effectors.
            effector: (part * MOST_GOALS + index) as u16,
            place: *place,
        };
        Command::Goals(places.iter().enumerate().map(goal).collect())
    })
}

#[cfg(test)]
mod tests {
    use super::{between, commands};
    use octruss_firmware::link::Command;

    #[test]
    fn ticks_lie_on_straight_lines() {
        let frames = [vec![[0, 8, i32::MIN]], vec![[4, -3, i32::MAX]]];
        let ticks = between(&frames, 2);
        // (8 + -3) / 2 rounded down is 2; the sum of both ends of the range over two is -1.
        assert_eq!(
            ticks,
            [
                vec![[0, 8, i32::MIN]],
                vec![[2, 2, -1]],
                vec![[4, -3, i32::MAX]]
            ]
        );
        assert_eq!(between(&frames[..1], 5).len(), 1);
        assert!(between(&[], 5).is_empty());
    }

    #[test]
    fn twelve_goals_go_into_a_command() {
        let goals = [[1, 2, 3]; 32];
        let counts: Vec<_> = commands(&goals)
            .map(|command| match command {
                Command::Goals(goals) => (goals.len(), goals[0].effector),
                _ => (0, 0),
            })
            .collect();
        assert_eq!(counts, [(12, 0), (12, 12), (8, 24)]);
    }
}
