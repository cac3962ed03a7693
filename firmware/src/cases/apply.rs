//! The kind [`APPLY`](super::APPLY): open a bundle and apply a range of its table's rows to a pose.
//!
//! | words | what |
//! | --- | --- |
//! | 1 | form: 0 displacement, 1 absolute, 2 displacement in 16 bits |
//! | 1 | first row |
//! | 1 | the row behind the last |
//! | 1 | length of the output in points: the number of rows, unless a wrong length is to be refused |
//! | 1 | number of points of the pose |
//! | 1 | bytes of the bundle |
//! | | the bundle, filled up with zeros to a multiple of 4 bytes |
//! | 3 each | the pose, raw bits, signed |
//!
//! The bundle starts on a multiple of 8 bytes where the case's words do. Rows are in the order of the
//! table, which need not be that of the model.

use octruss::bundle::Bundle;
use octruss::deform::{Displacement, Table};
use octruss::mesh::Arena;
use zerocopy::IntoBytes;

use super::results::{Results, Sink, Status};
use super::space::Space;
use super::{SECTION_ROWS, Words};

/// What is done with the table.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Form {
    Displacement,
    Absolute,
    Compact,
}

/// Runs a case.
pub(super) fn run<S: Sink>(
    words: &[u32],
    mut space: Space<'_>,
    results: &mut Results<'_, S>,
) -> Result<(), Status> {
    let mut words = Words(words);
    let form = match words.word()? {
        0 => Form::Displacement,
        1 => Form::Absolute,
        2 => Form::Compact,
        _ => return Err(Status::Malformed),
    };
    let rows = words.length()?..words.length()?;
    let output_length = words.length()?;
    let pose_length = words.length()?;
    let bundle_bytes = words.length()?;
    let bundle = words.elements::<1>(bundle_bytes.div_ceil(4))?.as_bytes();
    let bundle = bundle.get(..bundle_bytes).ok_or(Status::Malformed)?;
    let pose = words.points(pose_length)?;
    words.finish()?;

    let bundle = Bundle::new_checked(bundle).map_err(Status::Bundle)?;
    let out = space.slice(Arena::OutputPoints, output_length, [0; 3])?;
    let (saturated, clamped) = match form {
        Form::Displacement | Form::Absolute => {
            let table = bundle.table::<i32>().map_err(Status::Bundle)?;
            let apply = match form {
                Form::Absolute => Table::apply_absolute,
                _ => Table::apply,
            };
            (apply(&table, rows, pose, out).map_err(Status::Apply)?, 0)
        }
        Form::Compact => {
            let table = bundle.compact_table::<i32>().map_err(Status::Bundle)?;
            let needed = table.control_points();
            let memory = space.slice(Arena::InputPoints, needed, Displacement::default())?;
            let displacements = table.displacements(pose, memory).map_err(Status::Apply)?;
            let applied = table.apply(rows, &displacements, out);
            (applied.map_err(Status::Apply)?, displacements.saturated())
        }
    };
    space.check()?;
    results.section(SECTION_ROWS, &[saturated, clamped], out);
    Ok(())
}
