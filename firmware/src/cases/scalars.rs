//! The kind [`APPLY_SCALARS`](super::APPLY_SCALARS): open a bundle and carry scalar channels through a
//! range of its table's rows.
//!
//! | words | what |
//! | --- | --- |
//! | 1 | number of channels, 1 to 3 |
//! | 1 | first row |
//! | 1 | the row behind the last |
//! | 1 | length of the output in rows: the number of rows, unless a wrong length is to be refused |
//! | 1 | number of control points that values are given for |
//! | 1 | bytes of the bundle |
//! | | the bundle, filled up with zeros to a multiple of 4 bytes |
//! | | for each control point its value in every channel, raw bits, signed |
//!
//! The bundle may hold a table for 32-bit coordinates or for 16-bit displacements.

use octruss::bundle::{Bundle, BundleError};
use octruss::mesh::Arena;
use zerocopy::IntoBytes;

use super::results::{Results, Sink, Status};
use super::space::Space;
use super::{SECTION_SCALARS, Words};

/// Runs a case.
pub(super) fn run<S: Sink>(
    words: &[u32],
    space: Space<'_>,
    results: &mut Results<'_, S>,
) -> Result<(), Status> {
    let mut words = Words(words);
    match words.word()? {
        1 => run_with::<1, S>(words, space, results),
        2 => run_with::<2, S>(words, space, results),
        3 => run_with::<3, S>(words, space, results),
        _ => Err(Status::Malformed),
    }
}

fn run_with<const D: usize, S: Sink>(
    mut words: Words<'_>,
    mut space: Space<'_>,
    results: &mut Results<'_, S>,
) -> Result<(), Status> {
    let rows = words.length()?..words.length()?;
    let output_length = words.length()?;
    let value_count = words.length()?;
    let bundle_bytes = words.length()?;
    let bundle = words.elements::<1>(bundle_bytes.div_ceil(4))?.as_bytes();
    let bundle = bundle.get(..bundle_bytes).ok_or(Status::Malformed)?;
    let values = words.values::<D>(value_count)?;
    words.finish()?;

    let bundle = Bundle::new_checked(bundle).map_err(Status::Bundle)?;
    let out = space.slice(Arena::OutputPoints, output_length, [0; D])?;
    let applied = match bundle.table::<i32>() {
        Ok(table) => table.apply_scalars(rows, values, out),
        Err(BundleError::OtherTable) => {
            let table = bundle.compact_table::<i32>().map_err(Status::Bundle)?;
            table.apply_scalars(rows, values, out)
        }
        Err(error) => return Err(Status::Bundle(error)),
    };
    let saturated = applied.map_err(Status::Apply)?;
    space.check()?;
    results.section_of(SECTION_SCALARS, &[saturated], out);
    Ok(())
}
