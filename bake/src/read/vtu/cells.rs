//! The cells of a VTK XML unstructured grid.

use super::arrays::File;
use crate::error::{Error, Result};
use crate::mesh::SolidMesh;
use crate::read::vtk::cell::{self, Cell, POLYHEDRON};
use crate::read::vtk::data::{self, DataArray};
use roxmltree::Node;

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
                let mut cell_faces = Vec::new();
                // A file that names one long face again and again must not fill the memory.
                let mut room = vertices.len();
                for face in own {
                    let face = usize::try_from(*face).ok()?;
                    let corners = range(face_ends, face).and_then(|range| vertices.get(range))?;
                    room = room.checked_sub(corners.len())?;
                    cell_faces.push(corners.to_vec());
                }
                Some(cell_faces)
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

    /// The points of a cell, and its faces if it is a polyhedron.
    fn cell(&self, cell: usize) -> Result<Cell> {
        let listed = range(&self.offsets, cell).and_then(|range| self.connectivity.get(range));
        let points = listed
            .ok_or_else(|| Error::new("has offsets beyond the connectivity"))?
            .to_vec();
        let faces = match (self.types[cell], &self.polyhedra) {
            (POLYHEDRON, Some(polyhedra)) => polyhedra
                .faces_of(cell)
                .ok_or_else(|| Error::new("has an incomplete list of faces"))?,
            _ => Vec::new(),
        };
        Ok(Cell {
            kind: self.types[cell],
            points,
            faces,
        })
    }
}

/// Reads the cells of `piece` into `mesh`, whose points are there already, and what data the file
/// has on points and cells.
pub fn read<'a, 'input>(
    file: &File<'a, 'input>,
    piece: Node<'a, 'input>,
    mesh: &mut SolidMesh,
) -> Result<()> {
    let lists = Lists::read(file, piece)?;
    let cells = (0..lists.types.len()).map(|index| lists.cell(index));
    let kept = cell::add_all(cells, mesh).map_err(|error| located(file, lists.node, error))?;
    for (element, add) in [
        ("CellData", data::add_labels as data::Add),
        ("PointData", data::add_channels as data::Add),
    ] {
        let Some(node) = piece.children().find(|node| node.has_tag_name(element)) else {
            continue;
        };
        let arrays = node
            .children()
            .filter(|node| node.has_tag_name("DataArray"));
        let arrays = arrays.filter_map(|array| data_array(file, array).transpose());
        let arrays: Vec<DataArray> = arrays.collect::<Result<_>>()?;
        add(&arrays, &kept, mesh).map_err(|error| located(file, node, error))?;
    }
    Ok(())
}

fn located(file: &File<'_, '_>, node: Node<'_, '_>, error: Error) -> Error {
    error.at(file.error(node, "").place())
}

/// One array of data; `None` for arrays of text.
fn data_array(file: &File<'_, '_>, node: Node<'_, '_>) -> Result<Option<DataArray>> {
    if node.attribute("type") == Some("String") {
        return Ok(None);
    }
    let components = match node.attribute("NumberOfComponents") {
        None => 1,
        Some(_) => file.count(node, "NumberOfComponents")?,
    };
    Ok(Some(DataArray {
        name: node.attribute("Name").unwrap_or("").to_owned(),
        components,
        values: file.values(node)?,
    }))
}
