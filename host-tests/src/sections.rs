//! Forms and limits as they lie in a bundle, written from the documented layout.

use crate::reference_project::LimitsTable;
use crate::reference_volume::VolumeTable;

/// A volume form: the layout of `octruss::enclosed::VolumeRecord`.
pub fn volume_form(table: &VolumeTable) -> Vec<u8> {
    let mut pairs = table.empty_pairs.clone();
    let mut starts = vec![0; pairs.len()];
    for (place, ([i, j, _], _)) in table.taps.iter().enumerate() {
        if pairs.last() != Some(&[*i, *j]) {
            pairs.push([*i, *j]);
            starts.push(word(place));
        }
    }
    starts.push(word(table.taps.len()));
    let record = [
        word(table.points.len()),
        word(pairs.len()),
        word(table.taps.len()),
        table.difference_shift,
        table.pair_bits,
        table.volume_shift,
        table.gradient_bits,
        0,
    ];
    let weights = table.taps.iter().map(|(_, weight)| weight.cast_unsigned());
    let wide = record.into_iter().chain(weights).chain(starts);
    let thirds = table.taps.iter().map(|([_, _, third], _)| *third);
    let narrow = pairs.into_iter().flatten();
    let narrow = narrow.chain(table.points.iter().copied()).chain(thirds);
    wide.flat_map(u32::to_le_bytes)
        .chain(narrow.flat_map(u16::to_le_bytes))
        .collect()
}

/// Limits: the layout of `octruss::control::project::LimitsRecord`.
pub fn limits(table: &LimitsTable) -> Vec<u8> {
    let record = [word(table.lower.len()), table.settled, 0, 0];
    let ends = table.lower.iter().chain(&table.upper).flatten();
    let wide = record
        .into_iter()
        .chain(ends.map(|end| end.cast_unsigned()));
    let wide = wide.chain(table.rates.iter().copied());
    let narrow = table.mobilities.iter().copied();
    wide.flat_map(u32::to_le_bytes)
        .chain(narrow.flat_map(u16::to_le_bytes))
        .collect()
}

fn word(length: usize) -> u32 {
    u32::try_from(length).expect("a length of a case")
}
