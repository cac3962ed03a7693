//! A model: a file that holds points, which are to be moved.
//!
//! [`Model::write_with`] gives the file back byte for byte but for what depends on the points. So a
//! reader says which bytes these are: its slots.

use crate::error::{Error, Result};
use crate::geometry::{cross, normalised, subtract};
use crate::mesh::Point;
use std::io::Write;
use std::ops::Range;

/// A model: a file that holds vertices.
#[derive(Clone, Debug, PartialEq)]
pub struct Model {
    /// Positions of the vertices in file order, all finite.
    pub points: Vec<Point>,
    /// Vertices of the faces, counted from 0, each with at least three corners.
    pub faces: Vec<Vec<u32>>,
    bytes: Vec<u8>,
    /// Ascending, none over another.
    slots: Vec<Slot>,
}

/// Bytes of the file in whose place others are written.
#[derive(Clone, Debug, PartialEq)]
struct Slot {
    bytes: Range<usize>,
    content: Content,
}

/// What is written in the place of a file's bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Content {
    /// The coordinates of a vertex, as words.
    Position(u32),
    /// One coordinate of a vertex, as a word.
    Word(u32, usize),
    /// One coordinate of a vertex in double precision, the least significant byte first.
    LittleEndian(u32, usize),
    /// One coordinate of a vertex in double precision, the most significant byte first.
    BigEndian(u32, usize),
    /// The coordinates of a vertex in single precision, the least significant byte first.
    Singles(u32),
    /// The unit normal of a triangle, as words.
    Normal(usize),
    /// The unit normal of a triangle in single precision, the least significant byte first.
    NormalSingles(usize),
    /// This text.
    Text(&'static str),
}

impl Model {
    /// A file of which nothing is known yet.
    pub(super) fn new(bytes: &[u8]) -> Self {
        Self {
            points: Vec::new(),
            faces: Vec::new(),
            bytes: bytes.to_vec(),
            slots: Vec::new(),
        }
    }

    /// Adds a vertex whose coordinates stand in these bytes as words.
    pub(super) fn add_point(&mut self, point: Point, bytes: Range<usize>) {
        // More than 2^32 vertices do not come out of a file that fits into memory as text.
        let vertex = self.points.len() as u32;
        self.points.push(point);
        self.add_slot(bytes, Content::Position(vertex));
    }

    /// Says what goes in the place of these bytes, which come behind those of the slot before.
    pub(super) fn add_slot(&mut self, bytes: Range<usize>, content: Content) {
        self.slots.push(Slot { bytes, content });
    }

    /// The file's bytes with these positions in place of its own.
    ///
    /// # Errors
    /// If there are not as many positions as the model has vertices.
    pub fn write_with(&self, points: &[Point], out: &mut dyn Write) -> Result<()> {
        if points.len() != self.points.len() {
            return Err(Error::new(format!(
                "the model has {} vertices, but {} positions were given",
                self.points.len(),
                points.len()
            )));
        }
        self.write_slots(points, out).map_err(crate::write::failed)
    }

    fn write_slots(&self, points: &[Point], out: &mut dyn Write) -> std::io::Result<()> {
        let mut done = 0;
        for slot in &self.slots {
            out.write_all(&self.bytes[done..slot.bytes.start])?;
            self.write_content(slot.content, points, out)?;
            done = slot.bytes.end;
        }
        out.write_all(&self.bytes[done..])
    }

    fn write_content(
        &self,
        content: Content,
        points: &[Point],
        out: &mut dyn Write,
    ) -> std::io::Result<()> {
        let point = |vertex: u32| points[vertex as usize];
        let singles = |out: &mut dyn Write, values: Point| {
            values
                .iter()
                .try_for_each(|value| out.write_all(&(*value as f32).to_le_bytes()))
        };
        match content {
            Content::Position(vertex) => {
                let [x, y, z] = point(vertex);
                write!(out, "{x} {y} {z}")
            }
            Content::Word(vertex, axis) => write!(out, "{}", point(vertex)[axis]),
            Content::LittleEndian(vertex, axis) => {
                out.write_all(&point(vertex)[axis].to_le_bytes())
            }
            Content::BigEndian(vertex, axis) => out.write_all(&point(vertex)[axis].to_be_bytes()),
            Content::Singles(vertex) => singles(out, point(vertex)),
            Content::Normal(face) => {
                let [x, y, z] = self.normal(face, points);
                write!(out, "{x} {y} {z}")
            }
            Content::NormalSingles(face) => singles(out, self.normal(face, points)),
            Content::Text(text) => out.write_all(text.as_bytes()),
        }
    }

    /// The unit normal of a triangle; zero if it has no area.
    fn normal(&self, face: usize, points: &[Point]) -> Point {
        let &[a, b, c, ..] = self.faces[face].as_slice() else {
            return [0.0; 3];
        };
        let [a, b, c] = [a, b, c].map(|vertex| points[vertex as usize]);
        // Adding zero turns -0 into 0.
        normalised(cross(subtract(b, a), subtract(c, a))).map(|coordinate| coordinate + 0.0)
    }

    /// The faces cut into triangles, each fan starting at the face's first corner.
    pub fn triangles(&self) -> Vec<[u32; 3]> {
        let fan = |face: &Vec<u32>| -> Vec<[u32; 3]> {
            face[1..]
                .windows(2)
                .map(|pair| [face[0], pair[0], pair[1]])
                .collect()
        };
        self.faces.iter().flat_map(fan).collect()
    }
}
