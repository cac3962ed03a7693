//! The kind [`PROJECT`](super::PROJECT): the nearest pose under limits and volumes.
//!
//! | words | what |
//! | --- | --- |
//! | 1 | number of control points |
//! | 1 | bytes of the limits' section, as it lies in a bundle |
//! | | the section, filled up with zeros to a multiple of 4 bytes |
//! | 1 | number of regions |
//! | 1 | for each region the bytes of its form's section |
//! | | the section, filled up in the same way |
//! | 4 | the least and the greatest volume, signed numbers of 64 bits, the low word first |
//! | 3 each | the goal, raw bits, signed |
//! | 3 each | the pose before |
//!
//! The result is what was given up, the regions that were missed (a bit each), steps, the volume of each region
//! that a call can hold (the low word first), then the pose.

use heapless::Vec;
use octruss::control::project::{
    Limits, MOST_REGIONS, ProjectReport, ProjectScratch, RegionGoal, ScratchLengths,
};
use octruss::enclosed::VolumeForm;
use octruss::mesh::Arena;
use zerocopy::IntoBytes;

use super::results::{Results, Sink, Status};
use super::space::Space;
use super::volume::wide;
use super::{SECTION_PROJECT, Words};

/// Regions of a case at most: one more than a call takes, so that the refusal is seen too.
const REGIONS: usize = MOST_REGIONS + 1;

/// A region's form and its least and greatest volume.
type Region<'a> = (VolumeForm<'a>, [i64; 2]);

/// Runs a case.
pub(super) fn run<S: Sink>(
    words: &[u32],
    mut space: Space<'_>,
    results: &mut Results<'_, S>,
) -> Result<(), Status> {
    let mut words = Words(words);
    let points = words.length()?;
    let limits = Limits::from_section(section(&mut words)?, points).map_err(Status::Project)?;
    let forms = regions(&mut words, points)?;
    let goals: Vec<RegionGoal<'_>, REGIONS> = forms
        .iter()
        .map(|(form, [least, greatest])| RegionGoal {
            form,
            least: *least,
            greatest: *greatest,
        })
        .collect();
    let goal = words.points(points)?;
    let before = words.points(points)?;
    words.finish()?;

    let pose = space.slice(Arena::OutputPoints, points, [0; 3])?;
    pose.copy_from_slice(before);
    let lengths = ScratchLengths::of(&goals);
    let scratch = scratch(&mut space, points, lengths)?;
    let report = limits
        .project(goal, &goals, scratch, pose)
        .map_err(Status::Project)?;
    space.check()?;
    let head = head(&report);
    let length = pose.len().saturating_mul(3).saturating_add(head.len());
    results.begin_section(SECTION_PROJECT, length);
    results.words(&head);
    for coordinate in pose.as_flattened() {
        results.words(&[coordinate.cast_unsigned()]);
    }
    Ok(())
}

/// The bytes of a section that tells its length before it.
fn section<'a>(words: &mut Words<'a>) -> Result<&'a [u8], Status> {
    let length = words.length()?;
    let bytes = words.elements::<1>(length.div_ceil(4))?.as_bytes();
    bytes.get(..length).ok_or(Status::Malformed)
}

fn regions<'a>(words: &mut Words<'a>, points: usize) -> Result<Vec<Region<'a>, REGIONS>, Status> {
    let mut regions = Vec::new();
    for _ in 0..words.length()? {
        let section = section(words)?;
        let form = VolumeForm::from_section(section, points).map_err(Status::Enclosed)?;
        let band = [words.number()?, words.number()?];
        regions.push((form, band)).map_err(|_| Status::Malformed)?;
    }
    Ok(regions)
}

/// Buffers of exactly the lengths that are asked for.
fn scratch<'a>(
    space: &mut Space<'a>,
    points: usize,
    lengths: ScratchLengths,
) -> Result<ProjectScratch<'a>, Status> {
    Ok(ProjectScratch {
        lower: space.slice(Arena::InputPoints, points, [0; 3])?,
        upper: space.slice(Arena::InputPoints, points, [0; 3])?,
        current: space.slice(Arena::InputPoints, points, [0; 3])?,
        candidate: space.slice(Arena::InputPoints, points, [0; 3])?,
        forces: space.slice(Arena::Sums, points, [0; 3])?,
        gradients: space.slice(Arena::Sums, lengths.gradients, [0; 3])?,
        form_workspace: space.slice(Arena::Sums, lengths.form, [0; 3])?,
        form_gradient: space.slice(Arena::Sums, lengths.form, [0; 3])?,
    })
}

/// The words of a report.
#[must_use]
pub fn head(report: &ProjectReport) -> [u32; 3 + 2 * MOST_REGIONS] {
    let mut head = [0; 3 + 2 * MOST_REGIONS];
    let said = [report.gave_up.bits(), report.missed, report.steps];
    let volumes = report.volumes.into_iter().flat_map(wide);
    for (own, word) in head.iter_mut().zip(said.into_iter().chain(volumes)) {
        *own = word;
    }
    head
}
