//! The kind [`UPDATE`](super::UPDATE): apply a table to a pose, move some control points, compute only what
//! they move, then the normals of the points.
//!
//! | words | what |
//! | --- | --- |
//! | 1 | table: 0 for 32-bit coordinates, 1 for 16-bit displacements, 2 and 3 the same, factored |
//! | 1 | number of points of the poses |
//! | 1 | number of rows of the table |
//! | 1 | bytes of the bundle |
//! | | the bundle, filled up with zeros to a multiple of 4 bytes |
//! | 3 each | the pose before, raw bits, signed |
//! | 3 each | the pose behind |
//! | 1 each | for each point of the pose whether it is marked as moved |
//!
//! The bundle starts on a multiple of 8 bytes where the case's words do. The results are the rows after the update, and, if the bundle has faces, their normals.

use octruss::bundle::Bundle;
use octruss::deform::{ApplyError, CompactTable, Displacement, Table};
use octruss::mesh::Arena;
use zerocopy::IntoBytes;

use super::results::{Results, Sink, Status};
use super::space::Space;
use super::{SECTION_NORMALS, SECTION_ROWS, Words};

/// The poses and what moved between them.
struct Change<'a> {
    before: &'a [[i32; 3]],
    behind: &'a [[i32; 3]],
    moved: &'a [bool],
}

/// Runs a case.
pub(super) fn run<S: Sink>(
    words: &[u32],
    mut space: Space<'_>,
    results: &mut Results<'_, S>,
) -> Result<(), Status> {
    let mut words = Words(words);
    let form = words.word()?;
    let points = words.length()?;
    let rows = words.length()?;
    let bundle_bytes = words.length()?;
    let bundle = words.elements::<1>(bundle_bytes.div_ceil(4))?.as_bytes();
    let bundle = bundle.get(..bundle_bytes).ok_or(Status::Malformed)?;
    let (before, behind) = (words.points(points)?, words.points(points)?);
    let marks = words.elements::<1>(points)?;
    words.finish()?;
    let moved = space.slice(Arena::InputPoints, points, false)?;
    for (moved, &[mark]) in moved.iter_mut().zip(marks) {
        *moved = mark != 0;
    }
    let change = Change {
        before,
        behind,
        moved,
    };

    let bundle = Bundle::new_checked(bundle).map_err(Status::Bundle)?;
    let out = space.slice(Arena::OutputPoints, rows, [0; 3])?;
    let clamped = match form {
        0 => wide(&bundle, &change, out)?,
        1 => compact(&bundle, &change, &mut space, out)?,
        2 => wide_factored(&bundle, &change, &mut space, out)?,
        3 => compact_factored(&bundle, &change, &mut space, out)?,
        _ => return Err(Status::Malformed),
    };
    results.section(SECTION_ROWS, &[0, clamped], out);
    if let Some(normals) = bundle.normals().map_err(Status::Bundle)? {
        let vectors = space.slice(Arena::OutputPoints, rows, [0_i16; 3])?;
        let zeros = normals
            .apply(0..rows, out, vectors)
            .map_err(Status::Apply)?;
        let widened = space.slice(Arena::OutputPoints, rows, [0_i32; 3])?;
        for (wide, vector) in widened.iter_mut().zip(vectors.iter()) {
            *wide = vector.map(i32::from);
        }
        results.section(SECTION_NORMALS, &[zeros], widened);
    }
    space.check()
}

fn wide(bundle: &Bundle<'_>, change: &Change<'_>, out: &mut [[i32; 3]]) -> Result<u32, Status> {
    let table = bundle.table::<i32>().map_err(Status::Bundle)?;
    let done = table
        .apply(0..table.rows(), change.before, out)
        .and_then(|_| table.apply_moved(change.moved, change.behind, out));
    done.map(|_| 0).map_err(Status::Apply)
}

fn compact(
    bundle: &Bundle<'_>,
    change: &Change<'_>,
    space: &mut Space<'_>,
    out: &mut [[i32; 3]],
) -> Result<u32, Status> {
    let table = bundle.compact_table::<i32>().map_err(Status::Bundle)?;
    let needed = table.control_points();
    let memory = space.slice(Arena::InputPoints, needed, Displacement::default())?;
    apply_all(&table, change.before, memory, out).map_err(Status::Apply)?;
    apply_moved(&table, (change.moved, change.behind), memory, out).map_err(Status::Apply)
}

fn wide_factored(
    bundle: &Bundle<'_>,
    change: &Change<'_>,
    space: &mut Space<'_>,
    out: &mut [[i32; 3]],
) -> Result<u32, Status> {
    let [first, second] = bundle.factored_table::<i32>().map_err(Status::Bundle)?;
    let refined = space.slice(Arena::InputPoints, first.rows(), [0; 3])?;
    let moved = space.slice(Arena::InputPoints, first.rows(), false)?;
    let all = |table: &Table<'_, i32>, pose: &[[i32; 3]], out: &mut [[i32; 3]]| {
        table.apply(0..table.rows(), pose, out).map(|_| ())
    };
    all(&first, change.before, refined)
        .and_then(|()| all(&second, refined, out))
        .and_then(|()| first.apply_moved(change.moved, change.behind, refined))
        .and_then(|_| first.mark_moved(change.moved, moved))
        .and_then(|()| second.apply_moved(moved, refined, out))
        .map(|_| 0)
        .map_err(Status::Apply)
}

fn compact_factored(
    bundle: &Bundle<'_>,
    change: &Change<'_>,
    space: &mut Space<'_>,
    out: &mut [[i32; 3]],
) -> Result<u32, Status> {
    let tables = bundle.compact_factored_table::<i32>();
    let [first, second] = tables.map_err(Status::Bundle)?;
    let refined = space.slice(Arena::InputPoints, first.rows(), [0; 3])?;
    let moved = space.slice(Arena::InputPoints, first.rows(), false)?;
    let (needed, vertices) = (first.control_points(), second.control_points());
    let memory = space.slice(Arena::InputPoints, needed, Displacement::default())?;
    let second_memory = space.slice(Arena::InputPoints, vertices, Displacement::default())?;
    let mut run = || {
        apply_all(&first, change.before, memory, refined)?;
        apply_all(&second, refined, second_memory, out)?;
        let clamped = apply_moved(&first, (change.moved, change.behind), memory, refined)?;
        first.mark_moved(change.moved, moved)?;
        let more = apply_moved(&second, (moved, refined), second_memory, out)?;
        Ok(clamped.saturating_add(more))
    };
    run().map_err(Status::Apply)
}

/// All rows of a pose; returns how many displacements were clamped.
fn apply_all(
    table: &CompactTable<'_, i32>,
    pose: &[[i32; 3]],
    memory: &mut [Displacement],
    out: &mut [[i32; 3]],
) -> Result<u32, ApplyError> {
    let displacements = table.displacements(pose, memory)?;
    table.apply(0..table.rows(), &displacements, out)?;
    Ok(displacements.saturated())
}

/// The rows that moved points have a part in; returns how many displacements were clamped.
fn apply_moved(
    table: &CompactTable<'_, i32>,
    (moved, pose): (&[bool], &[[i32; 3]]),
    memory: &mut [Displacement],
    out: &mut [[i32; 3]],
) -> Result<u32, ApplyError> {
    let displacements = table.displacements(pose, memory)?;
    table.apply_moved(moved, &displacements, out)?;
    Ok(displacements.saturated())
}
