//! Solids as legacy VTK files (`.vtk`), version 3.0, ASCII.
//!
//! Octahedra are polyhedra (type 42). Coordinates have the fewest digits that give the same double
//! back.

use super::failed;
use super::vtu::{cell_type, elements, labels};
use crate::error::Result;
use crate::mesh::SolidMesh;
use octruss::mesh::OCTAHEDRON_FACES;
use std::io::Write;

/// The entry of a tetrahedron in CELLS: its length, then the corners.
const TETRAHEDRON_ENTRY: usize = 1 + 4;
/// The entry of an octahedron: its length, the number of faces, and the length and corners of each.
const OCTAHEDRON_ENTRY: usize = 2 + 8 * 4;
/// The entry of a triangle of a sheet.
const SHEET_ENTRY: usize = 1 + 3;

/// Writes points and cells: all tetrahedra, then all octahedra, then the triangles of sheets; labels
/// as the data `label` of the cells (0 on sheets), channels as data of the points. Other features are
/// not part of the format.
pub fn write(mesh: &SolidMesh, out: &mut dyn Write) -> Result<()> {
    write_grid(mesh, out).map_err(failed)
}

fn write_grid(mesh: &SolidMesh, out: &mut dyn Write) -> std::io::Result<()> {
    let cells = &mesh.cells;
    writeln!(
        out,
        "# vtk DataFile Version 3.0\noctruss\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS {} double",
        mesh.points.len()
    )?;
    for [x, y, z] in &mesh.points {
        writeln!(out, "{x} {y} {z}")?;
    }
    let sheets = &mesh.features.sheets;
    let count = cells.len() + sheets.len();
    let size = TETRAHEDRON_ENTRY * cells.tetrahedra.len()
        + OCTAHEDRON_ENTRY * cells.octahedra.len()
        + SHEET_ENTRY * sheets.len();
    writeln!(out, "CELLS {count} {size}")?;
    for [a, b, c, d] in &cells.tetrahedra {
        writeln!(out, "4 {a} {b} {c} {d}")?;
    }
    for octahedron in &cells.octahedra {
        write!(out, "{} 8", OCTAHEDRON_ENTRY - 1)?;
        // A reader knows the corners by the order in which the faces name them. With the face
        // (0, 1, 5) first, our own finds them in the order they have here.
        let from_second = OCTAHEDRON_FACES.iter().cycle().skip(1);
        for face in from_second.take(OCTAHEDRON_FACES.len()) {
            let [a, b, c] = face.map(|corner| octahedron[corner]);
            write!(out, " 3 {a} {b} {c}")?;
        }
        writeln!(out)?;
    }
    for [a, b, c] in sheets {
        writeln!(out, "3 {a} {b} {c}")?;
    }
    writeln!(out, "CELL_TYPES {count}")?;
    for element in elements(mesh) {
        writeln!(out, "{}", cell_type(element.len()))?;
    }
    data(mesh, out)
}

/// Labels and channels.
fn data(mesh: &SolidMesh, out: &mut dyn Write) -> std::io::Result<()> {
    if !mesh.labels.is_empty() {
        writeln!(
            out,
            "CELL_DATA {}\nSCALARS label int 1\nLOOKUP_TABLE default",
            elements(mesh).count()
        )?;
        for label in labels(mesh) {
            writeln!(out, "{label}")?;
        }
    }
    if !mesh.channels.is_empty() {
        writeln!(out, "POINT_DATA {}", mesh.points.len())?;
    }
    for channel in &mesh.channels {
        // A name is one word in this format.
        let name: Vec<&str> = channel.name.split_whitespace().collect();
        let name = name.join("_");
        writeln!(out, "SCALARS {name} double 1\nLOOKUP_TABLE default")?;
        for value in &channel.values {
            writeln!(out, "{value}")?;
        }
    }
    Ok(())
}
