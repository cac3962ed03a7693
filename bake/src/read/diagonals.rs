//! Files of major diagonals for box-spline solids: a number for each cell.
//!
//! Numbers 0, 1 or 2, separated by white space: first for the tetrahedra in the order of the mesh
//! file, then for the octahedra. In a tetrahedron 0 is the pair of opposite edges 01 23, 1 is 02 13,
//! 2 is 03 12; in an octahedron the pair of opposite corners 03, 14, 25. Everything after `#` is
//! skipped.

use super::words::shown;
use crate::error::{Error, Result, count};
use crate::mesh::Cells;
use crate::refine::DiagonalLists;
use std::io::Write;

/// Reads the diagonals of these cells.
pub fn read(bytes: &[u8], cells: &Cells) -> Result<DiagonalLists> {
    let text = std::str::from_utf8(bytes).map_err(|error| {
        Error::new("found bytes that are not text").at_byte(error.valid_up_to())
    })?;
    let mut diagonals = Vec::with_capacity(cells.len());
    for (index, line) in text.lines().enumerate() {
        let content = line.split('#').next().unwrap_or("");
        for word in content.split_ascii_whitespace() {
            let diagonal = match word {
                "0" => 0,
                "1" => 1,
                "2" => 2,
                _ => {
                    let found = shown(word);
                    return Err(Error::new(format!(
                        "expected a major diagonal, found \"{found}\""
                    ))
                    .advise("a major diagonal is 0, 1 or 2")
                    .at_line(index + 1));
                }
            };
            diagonals.push(diagonal);
        }
    }
    if diagonals.len() != cells.len() {
        return Err(Error::new(format!(
            "expected a major diagonal for each of {} and {}, found {}",
            count(cells.tetrahedra.len(), "tetrahedron", "tetrahedra"),
            count(cells.octahedra.len(), "octahedron", "octahedra"),
            diagonals.len()
        ))
        .advise("give one number for each cell, tetrahedra first"));
    }
    let octahedra = diagonals.split_off(cells.tetrahedra.len());
    Ok(DiagonalLists {
        tetrahedra: diagonals,
        octahedra,
    })
}

/// Writes diagonals as [`read`] takes them, a line each.
pub fn write(diagonals: &DiagonalLists, out: &mut dyn Write) -> Result<()> {
    let all = diagonals.tetrahedra.iter().chain(&diagonals.octahedra);
    for diagonal in all {
        writeln!(out, "{diagonal}")
            .map_err(|error| Error::new(format!("cannot be written: {error}")))?;
    }
    Ok(())
}
