//! Solids as legacy VTK files (`.vtk`), version 3.0, ASCII.
//!
//! Prisms are wedges (type 13), whose triangles VTK turns the other way, hexahedra have type 12, and
//! octahedra are polyhedra (type 42). Coordinates have the fewest digits that give the same double
//! back.

use super::failed;
use super::vtk_cells::{Element, POLYHEDRON, elements, labels};
use crate::error::Result;
use crate::mesh::SolidMesh;
use octruss::mesh::OCTAHEDRON_FACES;
use std::io::Write;

/// The entry of an octahedron in CELLS: its length, the number of faces, and the length and corners
/// of each. That of another cell: its length, then the corners.
const OCTAHEDRON_ENTRY: usize = 2 + 8 * 4;

/// Writes points and cells in the order of [`crate::mesh::Cells::iter`], then the triangles of sheets;
/// labels as the data `label` of the cells (0 on sheets), channels as data of the points. Other
/// features are not part of the format.
pub fn write(mesh: &SolidMesh, out: &mut dyn Write) -> Result<()> {
    write_grid(mesh, out).map_err(failed)
}

fn write_grid(mesh: &SolidMesh, out: &mut dyn Write) -> std::io::Result<()> {
    writeln!(
        out,
        "# vtk DataFile Version 3.0\noctruss\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS {} double",
        mesh.points.len()
    )?;
    for [x, y, z] in &mesh.points {
        writeln!(out, "{x} {y} {z}")?;
    }
    let entry = |element: &Element| match element.kind {
        POLYHEDRON => OCTAHEDRON_ENTRY,
        _ => 1 + element.corners.len(),
    };
    let count = elements(mesh).count();
    let size: usize = elements(mesh).map(|element| entry(&element)).sum();
    writeln!(out, "CELLS {count} {size}")?;
    for element in elements(mesh) {
        if element.kind == POLYHEDRON {
            polyhedron(&element.corners, out)?;
            continue;
        }
        write!(out, "{}", element.corners.len())?;
        for vertex in element.corners {
            write!(out, " {vertex}")?;
        }
        writeln!(out)?;
    }
    writeln!(out, "CELL_TYPES {count}")?;
    for element in elements(mesh) {
        writeln!(out, "{}", element.kind)?;
    }
    data(mesh, out)
}

fn polyhedron(octahedron: &[u32], out: &mut dyn Write) -> std::io::Result<()> {
    write!(out, "{} 8", OCTAHEDRON_ENTRY - 1)?;
    // A reader knows the corners by the order in which the faces name them. With the face
    // (0, 1, 5) first, our own finds them in the order they have here.
    let from_second = OCTAHEDRON_FACES.iter().cycle().skip(1);
    for face in from_second.take(OCTAHEDRON_FACES.len()) {
        let [a, b, c] = face.map(|corner| octahedron[corner]);
        write!(out, " 3 {a} {b} {c}")?;
    }
    writeln!(out)
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
