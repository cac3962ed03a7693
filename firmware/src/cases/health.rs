//! The kind [`HEALTH`](super::HEALTH): the cells that a pose folds over.
//!
//! | words | what |
//! | --- | --- |
//! | 1 | number of control points |
//! | 1 | words of the cells' section, as it lies in a bundle |
//! | | the section |
//! | 3 each | the control points at rest, raw bits, signed |
//! | 3 each | the pose |
//!
//! The result is how many cells fold, the least ratio, the tetrahedra without one, shape and place of the cell with the least
//! ratio (shape 4 for none), then shape and place of each cell that is named.

use octruss::control::health::{Cell, Health, HealthReport};

use super::results::{Results, Sink, Status};
use super::{SECTION_HEALTH, Words};
use zerocopy::IntoBytes;

/// Runs a case.
pub(super) fn run<S: Sink>(words: &[u32], results: &mut Results<'_, S>) -> Result<(), Status> {
    let mut words = Words(words);
    let points = words.length()?;
    let section = words.length()?;
    let section = words.elements::<1>(section)?.as_bytes();
    let rest = words.points(points)?;
    let pose = words.points(points)?;
    words.finish()?;
    let health = Health::from_section(section, rest).map_err(Status::Health)?;
    let report = health.of(pose).map_err(Status::Health)?;
    let head = head(&report);
    let length = report.first.len().saturating_mul(2);
    results.begin_section(SECTION_HEALTH, length.saturating_add(head.len()));
    results.words(&head);
    for cell in &report.first {
        results.words(&named(*cell));
    }
    Ok(())
}

fn head(report: &HealthReport) -> [u32; 5] {
    let [shape, index] = report.least.map_or([4, 0], named);
    let ratio = report.least_ratio.cast_unsigned();
    [report.folded, ratio, report.without_ratio, shape, index]
}

fn named(cell: Cell) -> [u32; 2] {
    [cell.shape as u32, cell.index]
}
