//! The cells of VTK's grids, whichever file they come from.

use super::octahedron;
use crate::error::{Error, Result, count};
use crate::mesh::{SolidMesh, Vertex};
use std::collections::BTreeMap;

/// VTK's number of the tetrahedron.
pub const TETRAHEDRON: i64 = 10;
/// VTK's number of the polyhedron.
pub const POLYHEDRON: i64 = 42;

/// Name of a cell type without volume, which is counted and left out.
fn ignored_name(kind: i64) -> Option<(&'static str, &'static str)> {
    Some(match kind {
        0 => ("empty cell", "empty cells"),
        1 | 2 => ("vertex cell", "vertex cells"),
        3 | 4 => ("line", "lines"),
        5 | 6 => ("triangle", "triangles"),
        7..=9 => ("polygon", "polygons"),
        _ => return None,
    })
}

/// Why a cell type with volume is refused, and what to do.
fn refusal(kind: i64) -> (String, &'static str) {
    let name = match kind {
        11 => "a voxel",
        12 => "a hexahedron",
        13 => "a wedge (prism)",
        14 => "a pyramid",
        15 | 16 => "a prism with more than four sides",
        21..=37 | 60..=81 => {
            return (
                format!(
                    "has cell type {kind}, which is of second or higher order; a cage has cells with straight edges"
                ),
                "write the mesh at first order",
            );
        }
        _ => {
            return (
                format!("has cell type {kind}, which is not known"),
                "a cage consists of tetrahedra (type 10) and octahedra (polyhedra, type 42)",
            );
        }
    };
    (
        format!("is {name}; a cage of the scheme tet-oct consists of tetrahedra and octahedra"),
        "mesh the volume with tetrahedra, or split these cells first (ParaView: filter \"Tetrahedralize\")",
    )
}

/// A cell as a file lists it.
pub struct Cell {
    /// VTK's number of its type.
    pub kind: i64,
    /// The points that make it.
    pub points: Vec<i64>,
    /// The faces of a polyhedron; else empty.
    pub faces: Vec<Vec<i64>>,
}

/// Where a cell of a file went.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kept {
    /// The mesh has it as a tetrahedron.
    Tetrahedron,
    /// The mesh has it as an octahedron.
    Octahedron,
    /// It has no volume and was left out.
    LeftOut,
}

/// Adds a file's cells to `mesh`, whose points are there already; says where each went.
pub fn add_all(
    cells: impl Iterator<Item = Result<Cell>>,
    mesh: &mut SolidMesh,
) -> Result<Vec<Kept>> {
    let mut ignored: BTreeMap<i64, usize> = BTreeMap::new();
    let mut kept = Vec::new();
    for (index, cell) in cells.enumerate() {
        let of_cell = |error: Error| {
            let message = format!("cell {index} (counted from 0) {}", error.message());
            error.with_message(message)
        };
        let cell = cell.map_err(of_cell)?;
        let place = add(&cell, mesh).map_err(of_cell)?;
        if place == Kept::LeftOut {
            *ignored.entry(cell.kind).or_default() += 1;
        }
        kept.push(place);
    }
    if mesh.cells.is_empty() {
        return Err(Error::new("the grid has no tetrahedra and no octahedra"));
    }
    note_ignored(&ignored, &mut mesh.notes);
    Ok(kept)
}

fn add(cell: &Cell, mesh: &mut SolidMesh) -> Result<Kept> {
    let vertices = mesh.points.len();
    let corners = || -> Result<Vec<Vertex>> {
        let index = |vertex: &i64| vertex_index(*vertex, vertices);
        cell.points.iter().map(index).collect()
    };
    match cell.kind {
        TETRAHEDRON => {
            let corners = corners()?;
            let corners = <[Vertex; 4]>::try_from(corners.as_slice()).map_err(|_| {
                Error::new(format!("is a tetrahedron with {} corners", corners.len()))
            })?;
            mesh.cells.tetrahedra.push(corners);
            Ok(Kept::Tetrahedron)
        }
        POLYHEDRON => {
            let corners = octahedron::recognise(&corners()?, &cell.faces)?;
            mesh.cells.octahedra.push(corners);
            Ok(Kept::Octahedron)
        }
        kind if ignored_name(kind).is_some() => Ok(Kept::LeftOut),
        kind => {
            let (message, advice) = refusal(kind);
            Err(Error::new(message).advise(advice))
        }
    }
}

fn note_ignored(ignored: &BTreeMap<i64, usize>, notes: &mut Vec<String>) {
    let named: Vec<String> = ignored
        .iter()
        .filter_map(|(kind, number)| {
            ignored_name(*kind).map(|(singular, plural)| count(*number, singular, plural))
        })
        .collect();
    if !named.is_empty() {
        notes.push(format!(
            "left out, for want of volume: {}",
            named.join(", ")
        ));
    }
}

/// A vertex index as the mesh holds it, or an error.
fn vertex_index(value: i64, vertices: usize) -> Result<Vertex> {
    let index = usize::try_from(value)
        .ok()
        .filter(|index| *index < vertices);
    match index.and_then(|index| Vertex::try_from(index).ok()) {
        Some(index) => Ok(index),
        None => Err(Error::new(format!(
            "names vertex {value}, but there are {vertices} vertices"
        ))),
    }
}
