//! VTK XML unstructured grids (`.vtu`).
//!
//! Read are tetrahedra (type 10) and octahedra as polyhedra (type 42) in both layouts that VTK has
//! had for polyhedra: `faces`/`faceoffsets`, and since 9.4 `face_connectivity`, `face_offsets`,
//! `polyhedron_to_faces`, `polyhedron_offsets`. Arrays may be ASCII, inline base64 or appended
//! (raw or base64), plain or compressed with zlib, with either header type and byte order.
//! Vertices, lines, triangles and quadrangles are counted and left out; other volume cells and
//! cells of second order are errors. A file has one piece. Labels and channels are chosen as
//! [`super::vtk::data`] says. The format holds no features; give them with a feature file.

mod arrays;
mod blocks;
mod cells;

use crate::error::{Error, Result};
use crate::mesh::{Point, SolidMesh, Vertex};
use arrays::File;
use roxmltree::{Document, Node};

/// Reads a mesh from the bytes of a `.vtu` file.
pub fn read(bytes: &[u8]) -> Result<SolidMesh> {
    if bytes.starts_with(b"# vtk DataFile") {
        return Err(Error::new("expected XML, found a legacy VTK file")
            .at_line(1)
            .advise("files of the legacy format are named .vtk"));
    }
    let (xml, appended) = split_appended(bytes)?;
    let document = Document::parse(&xml).map_err(|error| {
        let line = match error {
            // The parser names the file's start; the user looks for what is missing at its end.
            roxmltree::Error::UnclosedRootNode => xml.lines().count(),
            _ => line_number(error.pos().row),
        };
        Error::new(format!("the file is no valid XML: {error}"))
            .at_line(line)
            .advise("the file seems to be cut off or damaged; write it again")
    })?;
    let file = File::new(&document, appended)?;
    let piece = only_piece(&file)?;
    let mut mesh = SolidMesh {
        points: points(&file, piece)?,
        ..SolidMesh::default()
    };
    cells::read(&file, piece, &mut mesh)?;
    Ok(mesh)
}

/// A line as [`Error::at_line`] takes it.
fn line_number(row: u32) -> usize {
    usize::try_from(row).unwrap_or(usize::MAX)
}

/// The XML without its appended data, and those data. Appended raw
/// data are no text, so they must go before the rest can be parsed.
fn split_appended(bytes: &[u8]) -> Result<(String, Option<&[u8]>)> {
    const START: &[u8] = b"<AppendedData";
    const END: &[u8] = b"</AppendedData>";
    let text = |part: &[u8], offset: usize| match std::str::from_utf8(part) {
        Ok(text) => Ok(text.to_owned()),
        Err(error) => Err(Error::new("found bytes that are not text")
            .at_byte(offset + error.valid_up_to())
            .advise("the file is damaged, or it is no VTK XML file")),
    };
    let Some(start) = find(bytes, START) else {
        return Ok((text(bytes, 0)?, None));
    };
    let cut_off = || {
        Error::new("the appended data are cut off")
            .at_byte(start)
            .advise("write the file again")
    };
    let tag_end = start + find(&bytes[start..], b">").ok_or_else(cut_off)? + 1;
    let mark = tag_end + find(&bytes[tag_end..], b"_").ok_or_else(cut_off)? + 1;
    let end = find_last(bytes, END)
        .filter(|end| *end >= mark)
        .ok_or_else(cut_off)?;
    let xml = text(&bytes[..tag_end], 0)? + &text(&bytes[end..], end)?;
    Ok((xml, Some(&bytes[mark..end])))
}

fn find(bytes: &[u8], pattern: &[u8]) -> Option<usize> {
    bytes
        .windows(pattern.len())
        .position(|window| window == pattern)
}

fn find_last(bytes: &[u8], pattern: &[u8]) -> Option<usize> {
    bytes
        .windows(pattern.len())
        .rposition(|window| window == pattern)
}

fn only_piece<'a, 'input>(file: &File<'a, 'input>) -> Result<Node<'a, 'input>> {
    let grid = file.child(file.root(), "UnstructuredGrid")?;
    let mut pieces = grid.children().filter(|node| node.has_tag_name("Piece"));
    match (pieces.next(), pieces.next()) {
        (Some(piece), None) => Ok(piece),
        (None, _) => Err(file.error(grid, "the grid has no piece")),
        (Some(_), Some(second)) => Err(file
            .error(second, "the grid has more than one piece")
            .advise("join the pieces first, for example with ParaView's filter \"Merge Blocks\"")),
    }
}

fn points(file: &File<'_, '_>, piece: Node<'_, '_>) -> Result<Vec<Point>> {
    let number = file.count(piece, "NumberOfPoints")?;
    let node = file.child(file.child(piece, "Points")?, "DataArray")?;
    if node.attribute("NumberOfComponents") != Some("3") {
        return Err(file.error(node, "expected NumberOfComponents=\"3\" for the points"));
    }
    let values = file.floats(node)?;
    if number.checked_mul(3) != Some(values.len()) {
        return Err(file.error(
            node,
            format!(
                "expected {number} points of 3 coordinates, found {} numbers",
                values.len()
            ),
        ));
    }
    if Vertex::try_from(number).is_err() {
        return Err(file.error(node, "there are more than 2^32 points"));
    }
    let (points, _) = values.as_chunks::<3>();
    if let Some(bad) = points
        .iter()
        .position(|point| point.iter().any(|c| !c.is_finite()))
    {
        return Err(file.error(
            node,
            format!("point {bad} (counted from 0) has a coordinate that is no finite number"),
        ));
    }
    Ok(points.to_vec())
}
