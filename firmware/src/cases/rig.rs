//! The kinds [`RIG`](super::RIG) and [`TURN`](super::TURN): a skeleton and the control points that it
//! carries.
//!
//! # A rig
//!
//! | words | what |
//! | --- | --- |
//! | 1 | number of control points |
//! | 1 | number of joints |
//! | 1 | bytes of the rig's section, as it lies in a bundle |
//! | | the section |
//! | 3 each | the control points at rest, raw bits, signed |
//! | 1 each | the angles, signed |
//! | 3 | the base |
//! | 3 each | the pose before |
//!
//! The result is how many coordinates were clamped, then rotation (9 words) and pivot (6 words) of each
//! joint, then the pose.
//!
//! # Sines and cosines
//!
//! The words are angles; the result is the sine and cosine of each.

use octruss::control::rig::{Frame, Rig, turn};
use octruss::mesh::Arena;
use zerocopy::IntoBytes;

use super::results::{Results, Sink, Status};
use super::space::Space;
use super::volume::wide;
use super::{SECTION_RIG, Words};

/// Words of a joint among the results.
const FRAME_WORDS: usize = 15;

/// Runs a case of a rig.
pub(super) fn run<S: Sink>(
    words: &[u32],
    mut space: Space<'_>,
    results: &mut Results<'_, S>,
) -> Result<(), Status> {
    let mut words = Words(words);
    let points = words.length()?;
    let joints = words.length()?;
    let section_bytes = words.length()?;
    let section = words.elements::<1>(section_bytes.div_ceil(4))?.as_bytes();
    let section = section.get(..section_bytes).ok_or(Status::Malformed)?;
    let rest = words.points(points)?;
    let angles = words.numbers(joints)?;
    let [base] = *words.points(1)? else {
        return Err(Status::Malformed);
    };
    let before = words.points(points)?;
    words.finish()?;

    let rig = Rig::from_section(section, rest).map_err(Status::Rig)?;
    let frames = space.slice(Arena::InputPoints, rig.joints(), Frame::default())?;
    let pose = space.slice(Arena::OutputPoints, points, [0; 3])?;
    pose.copy_from_slice(before);
    let saturated = rig.carry(angles, base, frames, pose).map_err(Status::Rig)?;
    space.check()?;
    let length = frames
        .len()
        .saturating_mul(FRAME_WORDS)
        .saturating_add(points.saturating_mul(3));
    results.begin_section(SECTION_RIG, length.saturating_add(1));
    results.words(&[saturated]);
    for frame in frames.iter() {
        for entry in frame.rotation.as_flattened() {
            results.words(&[entry.cast_unsigned()]);
        }
        for coordinate in frame.pivot {
            results.words(&wide(coordinate));
        }
    }
    for coordinate in pose.as_flattened() {
        results.words(&[coordinate.cast_unsigned()]);
    }
    Ok(())
}

/// Runs a case of angles.
pub(super) fn run_turn<S: Sink>(words: &[u32], results: &mut Results<'_, S>) -> Result<(), Status> {
    results.begin_section(SECTION_RIG, words.len().saturating_mul(2));
    for angle in words {
        let (sine, cosine) = turn(angle.cast_signed());
        results.words(&[sine.cast_unsigned(), cosine.cast_unsigned()]);
    }
    Ok(())
}
