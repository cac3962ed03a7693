//! The cells of VTK's grids, whichever file they come from.

use super::octahedron;
use crate::error::{Error, Result, count, listed};
use crate::locate::curved::Prism;
use crate::mesh::{SolidMesh, Vertex};
use crate::read::pyramids::{self, Pyramid};
use std::collections::BTreeMap;

/// VTK's number of the tetrahedron.
pub const TETRAHEDRON: i64 = 10;
/// VTK's number of the polyhedron.
pub const POLYHEDRON: i64 = 42;
/// VTK's numbers of the voxel, the hexahedron, the wedge and the pyramid.
const VOXEL: i64 = 11;
const HEXAHEDRON: i64 = 12;
const WEDGE: i64 = 13;
const PYRAMID: i64 = 14;

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

/// Whether a cell type is of second or higher order.
fn is_curved(kind: i64) -> bool {
    matches!(kind, 21..=37 | 60..=81)
}

/// So many cells of a type that a cage cannot hold, for messages.
fn foreign_counted(kind: i64, number: usize) -> String {
    let (singular, plural) = match kind {
        15 | 16 => (
            "prism with more than four sides",
            "prisms with more than four sides",
        ),
        _ => {
            let cells = count(number, "cell", "cells");
            return match is_curved(kind) {
                true => format!("{cells} of second or higher order (type {kind})"),
                false => format!("{cells} of an unknown type (type {kind})"),
            };
        }
    };
    count(number, singular, plural)
}

/// The error for cells that a cage cannot hold: their types, how many of each, and the first.
fn refused(foreign: &BTreeMap<i64, (usize, usize)>) -> Option<Error> {
    let first = foreign.values().map(|(_, first)| first).min()?;
    let counted: Vec<String> = foreign
        .iter()
        .map(|(kind, (number, _))| foreign_counted(*kind, *number))
        .collect();
    let advice = if foreign.keys().any(|kind| is_curved(*kind)) {
        "write the mesh at first order"
    } else if foreign.keys().all(|kind| matches!(kind, 15 | 16)) {
        "mesh the volume with tetrahedra, or split these cells first (ParaView: filter \"Tetrahedralize\")"
    } else {
        "a cage consists of tetrahedra (type 10), wedges (13), hexahedra (12), pyramids (14) and octahedra (polyhedra, type 42)"
    };
    Some(
        Error::new(format!(
            "the grid has {}, first cell {first} (counted from 0); a cage consists of tetrahedra, octahedra, prisms and hexahedra with straight edges",
            listed(&counted)
        ))
        .advise(advice),
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
    /// The mesh has it as a prism.
    Prism,
    /// The mesh has it as a hexahedron.
    Hexahedron,
    /// The mesh has it as two tetrahedra behind all others.
    Pyramid,
    /// It has no volume and was left out.
    LeftOut,
}

/// Adds a file's cells to `mesh`, whose points are there already; says where each went.
pub fn add_all(
    cells: impl Iterator<Item = Result<Cell>>,
    mesh: &mut SolidMesh,
) -> Result<Vec<Kept>> {
    let mut ignored: BTreeMap<i64, usize> = BTreeMap::new();
    // How many of each type, and the first.
    let mut foreign: BTreeMap<i64, (usize, usize)> = BTreeMap::new();
    let (mut kept, mut pyramids) = (Vec::new(), Vec::new());
    for (index, cell) in cells.enumerate() {
        let of_cell = |error: Error| {
            let message = format!("cell {index} (counted from 0) {}", error.message());
            error.with_message(message)
        };
        let cell = cell.map_err(of_cell)?;
        let is_read = matches!(cell.kind, TETRAHEDRON..=PYRAMID | POLYHEDRON);
        if !is_read && ignored_name(cell.kind).is_none() {
            foreign.entry(cell.kind).or_insert((0, index)).0 += 1;
            continue;
        }
        let place = add(&cell, mesh, &mut pyramids).map_err(of_cell)?;
        if place == Kept::LeftOut {
            *ignored.entry(cell.kind).or_default() += 1;
        }
        kept.push(place);
    }
    if let Some(error) = refused(&foreign) {
        return Err(error);
    }
    turn_wedges(mesh);
    pyramids::add(&pyramids, false, mesh);
    if mesh.cells.is_empty() {
        return Err(Error::new("the grid has no tetrahedra and no octahedra"));
    }
    note_ignored(&ignored, &mut mesh.notes);
    Ok(kept)
}

/// Wedges of VTK have their triangles turned against Gmsh's prisms, but several programs write them
/// unturned. If every wedge of a file has negative volume they are taken so, with a note.
fn turn_wedges(mesh: &mut SolidMesh) {
    let volume = |corners: &[Vertex; 6]| {
        let corners = corners.map(|vertex| mesh.points[vertex as usize]);
        Prism::new(corners).volume_12()
    };
    let prisms = &mesh.cells.prisms;
    if prisms.is_empty() || !prisms.iter().all(|corners| volume(corners) < 0.0) {
        return;
    }
    for [a, b, c, d, e, f] in &mut mesh.cells.prisms {
        (*a, *b, *c, *d, *e, *f) = (*a, *c, *b, *d, *f, *e);
    }
    mesh.notes.push(
        "every wedge has negative volume in VTK's order of its corners: they are taken in Gmsh's"
            .to_owned(),
    );
}

fn add(cell: &Cell, mesh: &mut SolidMesh, pyramids: &mut Vec<Pyramid>) -> Result<Kept> {
    let vertices = mesh.points.len();
    let corners = || -> Result<Vec<Vertex>> {
        let index = |vertex: &i64| vertex_index(*vertex, vertices);
        cell.points.iter().map(index).collect()
    };
    match cell.kind {
        TETRAHEDRON => {
            let corners = exactly(&corners()?, "a tetrahedron")?;
            mesh.cells.tetrahedra.push(corners);
            Ok(Kept::Tetrahedron)
        }
        WEDGE => {
            let [a, b, c, d, e, f] = exactly(&corners()?, "a wedge")?;
            mesh.cells.prisms.push([a, c, b, d, f, e]);
            Ok(Kept::Prism)
        }
        HEXAHEDRON => {
            let corners = exactly(&corners()?, "a hexahedron")?;
            mesh.cells.hexahedra.push(corners);
            Ok(Kept::Hexahedron)
        }
        VOXEL => {
            let [a, b, c, d, e, f, g, h] = exactly(&corners()?, "a voxel")?;
            mesh.cells.hexahedra.push([a, b, d, c, e, f, h, g]);
            Ok(Kept::Hexahedron)
        }
        PYRAMID => {
            let corners = exactly(&corners()?, "a pyramid")?;
            pyramids.push(Pyramid { corners, label: 0 });
            Ok(Kept::Pyramid)
        }
        POLYHEDRON => {
            let corners = octahedron::recognise(&corners()?, &cell.faces)?;
            mesh.cells.octahedra.push(corners);
            Ok(Kept::Octahedron)
        }
        _ => Ok(Kept::LeftOut),
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

/// So many corners as a cell of a type has, or an error.
fn exactly<const N: usize>(corners: &[Vertex], name: &str) -> Result<[Vertex; N]> {
    <[Vertex; N]>::try_from(corners)
        .map_err(|_| Error::new(format!("is {name} with {} corners", corners.len())))
}
