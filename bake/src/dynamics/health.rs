//! The cells of a cage, as a device looks at them.

use super::rig::aligned;
use crate::error::{Error, Result};
use crate::mesh::Cells;
use crate::pack::writer::Section;
use octruss::bundle::SECTION_CELLS;
use octruss::control::health::{CellsRecord, Health};
use zerocopy::IntoBytes;

/// The section of a cage's cells, proved sound by core.
///
/// # Errors
/// If a cell is unsound.
pub fn section(cells: &Cells, rest: &[[i32; 3]]) -> Result<Section> {
    let count = |cells: usize| (cells as u32).into();
    let record = CellsRecord {
        tetrahedra: count(cells.tetrahedra.len()),
        octahedra: count(cells.octahedra.len()),
        prisms: count(cells.prisms.len()),
        hexahedra: count(cells.hexahedra.len()),
    };
    let corners: Vec<u32> = cells
        .tetrahedra
        .as_flattened()
        .iter()
        .chain(cells.octahedra.as_flattened())
        .chain(cells.prisms.as_flattened())
        .chain(cells.hexahedra.as_flattened())
        .copied()
        .collect();
    let bytes = [record.as_bytes(), corners.as_bytes()].concat();
    let words = aligned(&bytes);
    Health::from_section(&words.as_bytes()[..bytes.len()], rest)
        .map_err(|error| Error::new(error.to_string()))?;
    Ok(Section {
        kind: SECTION_CELLS,
        stage: 0,
        bytes,
    })
}
