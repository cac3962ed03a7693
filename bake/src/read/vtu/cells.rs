//! The cells of a VTK XML unstructured grid.

use super::arrays::File;
use super::octahedron;
use crate::error::{Error, Result, count};
use crate::mesh::{SolidMesh, Vertex};
use roxmltree::Node;
use std::collections::BTreeMap;

/// The cell types of VTK that have a say here.
const TETRAHEDRON: i64 = 10;
const POLYHEDRON: i64 = 42;

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

/// Where the faces of polyhedra are found, in either layout, as a list of vertex lists.
enum Polyhedra {
    /// One stream for each cell: number of faces, then for each face its size and vertices; and
    /// the end of each cell's stream, -1 for cells that are no polyhedra.
    Stream { faces: Vec<i64>, ends: Vec<i64> },
    /// Faces with their ends, and for each cell a range of a list of faces.
    Shared {
        vertices: Vec<i64>,
        face_ends: Vec<i64>,
        faces: Vec<i64>,
        cell_ends: Vec<i64>,
    },
}

impl Polyhedra {
    fn read<'a, 'input>(file: &File<'a, 'input>, cells: Node<'a, 'input>) -> Result<Self> {
        let required = |name: &str| {
            file.array(cells, name).ok_or_else(|| {
                file.error(
                    cells,
                    format!("there are polyhedra, but no array named {name}"),
                )
            })
        };
        if let Some(node) = file.array(cells, "face_connectivity") {
            return Ok(Self::Shared {
                vertices: file.integers(node)?,
                face_ends: file.integers(required("face_offsets")?)?,
                faces: file.integers(required("polyhedron_to_faces")?)?,
                cell_ends: file.integers(required("polyhedron_offsets")?)?,
            });
        }
        Ok(Self::Stream {
            faces: file.integers(required("faces")?)?,
            ends: file.integers(required("faceoffsets")?)?,
        })
    }

    /// The faces of the cell, or `None` if the arrays do not hold them.
    fn faces_of(&self, cell: usize) -> Option<Vec<Vec<i64>>> {
        match self {
            Self::Stream { faces, ends } => {
                let end = usize::try_from(*ends.get(cell)?).ok()?;
                // Cells that are no polyhedra have -1 and take no room.
                let earlier = ends[..cell].iter().rev().find(|end| **end >= 0);
                let start = earlier.map_or(Some(0), |end| usize::try_from(*end).ok())?;
                let mut stream = faces.get(start..end)?.iter();
                let number = *stream.next()?;
                let mut cell_faces = Vec::new();
                for _ in 0..number {
                    let size = usize::try_from(*stream.next()?).ok()?;
                    let face: Vec<i64> = stream.by_ref().take(size).copied().collect();
                    if face.len() < size {
                        return None;
                    }
                    cell_faces.push(face);
                }
                Some(cell_faces)
            }
            Self::Shared {
                vertices,
                face_ends,
                faces,
                cell_ends,
            } => {
                let own = range(cell_ends, cell).and_then(|range| faces.get(range))?;
                own.iter()
                    .map(|face| {
                        let face = usize::try_from(*face).ok()?;
                        range(face_ends, face)
                            .and_then(|range| vertices.get(range))
                            .map(<[i64]>::to_vec)
                    })
                    .collect()
            }
        }
    }
}

/// The range from the end of the item before to the end of this one.
fn range(ends: &[i64], index: usize) -> Option<std::ops::Range<usize>> {
    let end = usize::try_from(*ends.get(index)?).ok()?;
    let start = match index.checked_sub(1) {
        None => 0,
        Some(before) => usize::try_from(*ends.get(before)?).ok()?,
    };
    Some(start..end)
}

/// The arrays that say which points make each cell.
struct Lists<'a, 'input> {
    node: Node<'a, 'input>,
    connectivity: Vec<i64>,
    offsets: Vec<i64>,
    types: Vec<i64>,
    /// Of grids with polyhedra.
    polyhedra: Option<Polyhedra>,
}

impl<'a, 'input> Lists<'a, 'input> {
    fn read(file: &File<'a, 'input>, piece: Node<'a, 'input>) -> Result<Self> {
        let number = file.count(piece, "NumberOfCells")?;
        let node = file.child(piece, "Cells")?;
        let array = |name: &str| match file.array(node, name) {
            Some(array) => file.integers(array),
            None => Err(file.error(node, format!("expected an array named {name}, found none"))),
        };
        let (connectivity, offsets, types) =
            (array("connectivity")?, array("offsets")?, array("types")?);
        if offsets.len() != number || types.len() != number {
            return Err(file.error(
                node,
                format!(
                    "expected {number} offsets and {number} types, found {} and {}",
                    offsets.len(),
                    types.len()
                ),
            ));
        }
        let polyhedra = match types.contains(&POLYHEDRON) {
            true => Some(Polyhedra::read(file, node)?),
            false => None,
        };
        Ok(Self {
            node,
            connectivity,
            offsets,
            types,
            polyhedra,
        })
    }

    /// The corners as the cell lists them.
    fn corners(&self, cell: usize, vertices: usize) -> Result<Vec<Vertex>> {
        let listed = range(&self.offsets, cell).and_then(|range| self.connectivity.get(range));
        let listed = listed.ok_or_else(|| Error::new("has offsets beyond the connectivity"))?;
        listed
            .iter()
            .map(|vertex| vertex_index(*vertex, vertices))
            .collect()
    }

    /// Reads one cell into `mesh`; false if it is of a type without volume.
    fn read_cell(&self, cell: usize, mesh: &mut SolidMesh) -> Result<bool> {
        let vertices = mesh.points.len();
        match (self.types[cell], &self.polyhedra) {
            (TETRAHEDRON, _) => {
                let corners = self.corners(cell, vertices)?;
                let corners = <[Vertex; 4]>::try_from(corners.as_slice()).map_err(|_| {
                    Error::new(format!("is a tetrahedron with {} corners", corners.len()))
                })?;
                mesh.cells.tetrahedra.push(corners);
            }
            (POLYHEDRON, Some(polyhedra)) => {
                let faces = polyhedra
                    .faces_of(cell)
                    .ok_or_else(|| Error::new("has an incomplete list of faces"))?;
                let corners = octahedron::recognise(&self.corners(cell, vertices)?, &faces)?;
                mesh.cells.octahedra.push(corners);
            }
            (kind, _) if ignored_name(kind).is_some() => return Ok(false),
            (kind, _) => {
                let (message, advice) = refusal(kind);
                return Err(Error::new(message).advise(advice));
            }
        }
        Ok(true)
    }
}

/// Reads the cells of `piece` into `mesh`, whose points are there already.
pub fn read<'a, 'input>(
    file: &File<'a, 'input>,
    piece: Node<'a, 'input>,
    mesh: &mut SolidMesh,
) -> Result<()> {
    let lists = Lists::read(file, piece)?;
    let mut ignored: BTreeMap<i64, usize> = BTreeMap::new();
    for (cell, kind) in lists.types.iter().enumerate() {
        let is_kept = lists.read_cell(cell, mesh).map_err(|error| {
            let message = format!("cell {cell} (counted from 0) {}", error.message());
            let located = file.error(lists.node, message);
            match error.advice() {
                Some(advice) => located.advise(advice),
                None => located,
            }
        })?;
        if !is_kept {
            *ignored.entry(*kind).or_default() += 1;
        }
    }
    if mesh.cells.is_empty() {
        return Err(file.error(lists.node, "the grid has no tetrahedra and no octahedra"));
    }
    note_ignored(&ignored, &mut mesh.notes);
    Ok(())
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
pub fn vertex_index(value: i64, vertices: usize) -> Result<Vertex> {
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
