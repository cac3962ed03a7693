//! TetGen meshes: vertices in a `.node` file, tetrahedra in an `.ele` file of the same name.
//!
//! Vertices are counted from 0 or 1, as the first one is. Attributes of vertices are scalar
//! channels, named `attribute 0` and so on; the first attribute of a tetrahedron is its label.
//! Boundary markers have no names, so they make neither creases nor corners; `.face` and
//! `.edge` files are not looked at. Empty lines and what follows a `#` are skipped.

use super::words::shown;
use crate::error::{Error, Result, count};
use crate::mesh::{Channel, Point, SolidMesh, Vertex};
use std::path::Path;

/// Reads a mesh from the bytes of a `.node` and an `.ele` file; their names are for errors.
pub fn read(node: (&Path, &[u8]), ele: (&Path, &[u8])) -> Result<SolidMesh> {
    let mut mesh = SolidMesh::default();
    let first = vertices(node.1, &mut mesh).map_err(|error| error.in_file(node.0))?;
    tetrahedra(ele.1, first, &mut mesh).map_err(|error| error.in_file(ele.0))?;
    mesh.labels.drop_if_zero();
    Ok(mesh)
}

/// The lines of a file that hold something, each with its number and its words.
struct Lines<'a> {
    lines: std::iter::Enumerate<std::str::Lines<'a>>,
    /// Number of the line that was looked at last.
    last: usize,
}

struct Line<'a> {
    number: usize,
    words: std::str::SplitAsciiWhitespace<'a>,
}

impl<'a> Lines<'a> {
    fn new(bytes: &'a [u8]) -> Result<Self> {
        let text = std::str::from_utf8(bytes).map_err(|error| {
            Error::new("found bytes that are not text").at_byte(error.valid_up_to())
        })?;
        Ok(Self {
            lines: text.lines().enumerate(),
            last: 1,
        })
    }

    fn next(&mut self, expected: &str) -> Result<Line<'a>> {
        for (index, line) in self.lines.by_ref() {
            self.last = index + 1;
            let content = line.split('#').next().unwrap_or("");
            if !content.trim().is_empty() {
                return Ok(Line {
                    number: index + 1,
                    words: content.split_ascii_whitespace(),
                });
            }
        }
        Err(
            Error::new(format!("expected {expected}, found the end of the file"))
                .at_line(self.last)
                .advise("the file seems to be cut off; write it again"),
        )
    }
}

impl Line<'_> {
    fn error(&self, message: String) -> Error {
        Error::new(message).at_line(self.number)
    }

    fn number<T: std::str::FromStr>(&mut self, expected: &str) -> Result<T> {
        match self.words.next() {
            None => Err(self.error(format!("expected {expected}, found the end of the line"))),
            Some(word) => word
                .parse()
                .map_err(|_| self.error(format!("expected {expected}, found \"{}\"", shown(word)))),
        }
    }

    fn finite(&mut self, expected: &str) -> Result<f64> {
        let value: f64 = self.number(expected)?;
        if value.is_finite() {
            return Ok(value);
        }
        Err(self.error(format!(
            "expected {expected}, found {value}, which is no finite number"
        )))
    }
}

/// Reads the vertices; gives the index of the first.
fn vertices(bytes: &[u8], mesh: &mut SolidMesh) -> Result<i64> {
    let mut lines = Lines::new(bytes)?;
    let mut header = lines.next("the number of vertices")?;
    let number: Vertex = header.number("the number of vertices")?;
    let dimension: u32 = header.number("the dimension, 3")?;
    if dimension != 3 {
        return Err(header
            .error(format!("expected the dimension, 3, found \"{dimension}\""))
            .advise("a cage is a mesh of tetrahedra in space"));
    }
    // Both numbers may be left out.
    let attributes: usize = header.number("the number of attributes").unwrap_or(0);
    let mut channels: Vec<Channel> = Vec::new();
    let mut first = 0;
    for vertex in 0..i64::from(number) {
        let mut line = lines.next(&format!("vertex {vertex} (counted from 0) of {number}"))?;
        let index: i64 = line.number("the index of a vertex")?;
        if vertex == 0 {
            first = index;
        }
        if index.checked_sub(vertex) != Some(first) || !(0..=1).contains(&first) {
            return Err(line
                .error(format!("expected the index of a vertex, found \"{index}\""))
                .advise("vertices are counted from 0 or 1 without gaps"));
        }
        let point: Point = [
            line.finite("the x coordinate of a vertex")?,
            line.finite("the y coordinate of a vertex")?,
            line.finite("the z coordinate of a vertex")?,
        ];
        mesh.points.push(point);
        for attribute in 0..attributes {
            let value = line.finite("an attribute of a vertex")?;
            if vertex == 0 {
                channels.push(Channel {
                    name: format!("attribute {attribute}"),
                    values: Vec::new(),
                });
            }
            if let Some(channel) = channels.get_mut(attribute) {
                channel.values.push(value);
            }
        }
    }
    mesh.channels = channels;
    Ok(first)
}

fn tetrahedra(bytes: &[u8], first: i64, mesh: &mut SolidMesh) -> Result<()> {
    let mut lines = Lines::new(bytes)?;
    let mut header = lines.next("the number of tetrahedra")?;
    let number: u64 = header.number("the number of tetrahedra")?;
    let corners: u32 = header.number("the number of a tetrahedron's vertices, 4")?;
    if corners == 10 {
        return Err(header
            .error(format!("the mesh has {} of second order (10 vertices each); a cage consists of tetrahedra, octahedra, prisms and hexahedra with straight edges", count(usize::try_from(number).unwrap_or(usize::MAX), "tetrahedron", "tetrahedra")))
            .advise("run TetGen without -o2"));
    }
    if corners != 4 {
        return Err(header.error(format!(
            "expected the number of a tetrahedron's vertices, 4, found \"{corners}\""
        )));
    }
    if number == 0 {
        return Err(header.error("the mesh has no tetrahedra".to_owned()));
    }
    let attributes: usize = header.number("the number of attributes").unwrap_or(0);
    for cell in 0..number {
        let mut line = lines.next(&format!("tetrahedron {cell} (counted from 0) of {number}"))?;
        line.number::<i64>("the index of a tetrahedron")?;
        let mut corners = [0; 4];
        for corner in &mut corners {
            *corner = vertex(&mut line, first, mesh.points.len())?;
        }
        mesh.cells.tetrahedra.push(corners);
        let label = if attributes > 0 { label(&mut line)? } else { 0 };
        mesh.labels.tetrahedra.push(label);
    }
    Ok(())
}

fn vertex(line: &mut Line<'_>, first: i64, vertices: usize) -> Result<Vertex> {
    let listed: i64 = line.number("a vertex of a tetrahedron")?;
    let index = listed
        .checked_sub(first)
        .and_then(|index| Vertex::try_from(index).ok());
    let in_range = index.filter(|index| usize::try_from(*index).is_ok_and(|i| i < vertices));
    in_range.ok_or_else(|| {
        line.error(format!(
            "names vertex {listed}, but the .node file has {vertices} vertices counted from {first}"
        ))
    })
}

/// TetGen writes attributes as real numbers.
fn label(line: &mut Line<'_>) -> Result<i32> {
    let value = line.finite("the attribute of a tetrahedron")?;
    let label = value as i32;
    if f64::from(label) == value {
        return Ok(label);
    }
    Err(line.error(format!(
        "expected a whole number of 32 bits as the attribute of a tetrahedron, found {value}"
    )))
}
