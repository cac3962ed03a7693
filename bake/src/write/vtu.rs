//! Solids as VTK XML unstructured grids (`.vtu`), ASCII.
//!
//! Prisms are wedges (type 13), whose triangles VTK turns the other way, and hexahedra have type 12.
//! Octahedra are polyhedra (type 42) with the arrays `faces` and `faceoffsets`, which every version
//! of VTK since 5.10 reads. Coordinates have the fewest digits that give the same double back.

use super::failed;
use super::vtk_cells::{Element, elements, labels};
use crate::error::Result;
use crate::mesh::{Point, SolidMesh};
use octruss::mesh::OCTAHEDRON_FACES;
use std::fmt::Display;
use std::io::Write;

/// Writes points and cells in the order of [`crate::mesh::Cells::iter`], then the triangles of sheets;
/// labels as the data `label` of the cells (0 on sheets), channels as data of the points. Other
/// features are not part of the format.
pub fn write(mesh: &SolidMesh, out: &mut dyn Write) -> Result<()> {
    write_grid(mesh, out).map_err(failed)
}

fn write_grid(mesh: &SolidMesh, out: &mut dyn Write) -> std::io::Result<()> {
    let grid = Grid {
        points: &mesh.points,
        elements: || elements(mesh),
    };
    let polyhedra = |out: &mut dyn Write| match mesh.cells.octahedra.is_empty() {
        true => Ok(()),
        false => polyhedra(mesh, out),
    };
    grid.write(|out| data(mesh, out), polyhedra, out)
}

/// A grid: points, and elements by their corners.
pub(super) struct Grid<'a, Elements> {
    pub points: &'a [Point],
    /// Goes through the elements from the first on.
    pub elements: Elements,
}

impl<Elements: Fn() -> Iter, Iter: Iterator<Item = Element>> Grid<'_, Elements> {
    /// Writes the file; `data` writes what belongs to points and elements, `more` what there is to say of
    /// the elements beside their corners.
    pub fn write(
        &self,
        data: impl FnOnce(&mut dyn Write) -> std::io::Result<()>,
        more: impl FnOnce(&mut dyn Write) -> std::io::Result<()>,
        out: &mut dyn Write,
    ) -> std::io::Result<()> {
        writeln!(out, "<?xml version=\"1.0\"?>")?;
        writeln!(
            out,
            "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">"
        )?;
        writeln!(out, "<UnstructuredGrid>")?;
        writeln!(
            out,
            "<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">",
            self.points.len(),
            (self.elements)().count()
        )?;
        data(out)?;
        writeln!(out, "<Points>")?;
        vectors(out, "Points", self.points.iter())?;
        writeln!(out, "</Points>\n<Cells>")?;
        let corners = (self.elements)().map(|element| element.corners);
        array(out, "type=\"Int64\" Name=\"connectivity\"", corners)?;
        let ends = (self.elements)().scan(0_usize, |end, element| {
            *end += element.corners.len();
            Some([*end])
        });
        array(out, "type=\"Int64\" Name=\"offsets\"", ends)?;
        let types = (self.elements)().map(|element| [element.kind]);
        array(out, "type=\"UInt8\" Name=\"types\"", types)?;
        more(out)?;
        writeln!(out, "</Cells>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>")
    }
}

/// Channels and labels.
fn data(mesh: &SolidMesh, out: &mut dyn Write) -> std::io::Result<()> {
    if !mesh.channels.is_empty() {
        writeln!(out, "<PointData>")?;
        for channel in &mesh.channels {
            let attributes = format!("type=\"Float64\" Name=\"{}\"", escaped(&channel.name));
            array(
                out,
                &attributes,
                channel.values.iter().map(|value| [*value]),
            )?;
        }
        writeln!(out, "</PointData>")?;
    }
    if !mesh.labels.is_empty() {
        writeln!(out, "<CellData>")?;
        let labels = labels(mesh).map(|label| [label]);
        array(out, "type=\"Int32\" Name=\"label\"", labels)?;
        writeln!(out, "</CellData>")?;
    }
    Ok(())
}

/// A name as it may stand in an attribute.
pub(super) fn escaped(name: &str) -> String {
    let replaced = |character: char| match character {
        '&' => "&amp;".to_owned(),
        '<' => "&lt;".to_owned(),
        '"' => "&quot;".to_owned(),
        other => other.to_string(),
    };
    name.chars().map(replaced).collect()
}

fn polyhedra(mesh: &SolidMesh, out: &mut dyn Write) -> std::io::Result<()> {
    // The number of faces, then for each face its number of corners and the corners.
    const STREAM: usize = 1 + 8 * 4;
    let stream = mesh.cells.octahedra.iter().map(|octahedron| {
        let mut stream = [0_u32; STREAM];
        stream[0] = 8;
        for (entry, face) in stream[1..].chunks_exact_mut(4).zip(OCTAHEDRON_FACES) {
            let corners = face.map(|corner| octahedron[corner]);
            entry.copy_from_slice(&[3, corners[0], corners[1], corners[2]]);
        }
        stream
    });
    array(out, "type=\"Int64\" Name=\"faces\"", stream)?;
    let no_polyhedra = mesh.cells.tetrahedra.iter().map(|_| [-1_i64]);
    let ends = (1..=mesh.cells.octahedra.len()).map(|number| [(number * STREAM) as i64]);
    let others = elements(mesh)
        .skip(mesh.cells.tetrahedra.len() + mesh.cells.octahedra.len())
        .map(|_| [-1_i64]);
    array(
        out,
        "type=\"Int64\" Name=\"faceoffsets\"",
        no_polyhedra.chain(ends).chain(others),
    )
}

/// One array of three numbers a point.
pub(super) fn vectors(
    out: &mut dyn Write,
    name: &str,
    vectors: impl Iterator<Item = impl AsRef<[f64]>>,
) -> std::io::Result<()> {
    let attributes = format!("type=\"Float64\" Name=\"{name}\" NumberOfComponents=\"3\"");
    array(out, &attributes, vectors)
}

/// One array, a line for each item.
fn array<N: Display>(
    out: &mut dyn Write,
    attributes: &str,
    items: impl Iterator<Item = impl AsRef<[N]>>,
) -> std::io::Result<()> {
    writeln!(out, "<DataArray {attributes} format=\"ascii\">")?;
    for item in items {
        let mut separator = "";
        for number in item.as_ref() {
            write!(out, "{separator}{number}")?;
            separator = " ";
        }
        writeln!(out)?;
    }
    writeln!(out, "</DataArray>")
}
