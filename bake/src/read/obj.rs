//! Wavefront models (`.obj`): positions in double precision, everything else verbatim.
//!
//! A model is read to have its vertices moved: [`Model::write_with`] gives the same file back,
//! byte for byte, with only the coordinates on the `v` lines replaced. Comments, groups, texture
//! coordinates, normals, vertex colours, line ends and the order of all lines stay. (Normals on
//! `vn` lines stay as well and describe the rest shape.) Faces are read for pictures.

use super::words::shown;
use crate::error::{Error, Result};
use crate::mesh::Point;
use std::ops::Range;

/// A model: a text that holds vertices.
#[derive(Clone, Debug, PartialEq)]
pub struct Model {
    /// Positions of the vertices in file order, all finite.
    pub points: Vec<Point>,
    /// Vertices of the faces, counted from 0, each with at least three corners.
    pub faces: Vec<Vec<u32>>,
    text: Vec<u8>,
    /// For each vertex the bytes from the start of its x to the end of its z.
    spans: Vec<Range<usize>>,
}

impl Model {
    /// The file's bytes with these positions in place of its own.
    ///
    /// # Errors
    /// If there are not as many positions as the model has vertices.
    pub fn write_with(&self, points: &[Point], out: &mut dyn std::io::Write) -> Result<()> {
        if points.len() != self.spans.len() {
            return Err(Error::new(format!(
                "the model has {} vertices, but {} positions were given",
                self.spans.len(),
                points.len()
            )));
        }
        let failed = |error: std::io::Error| Error::new(format!("cannot be written: {error}"));
        let mut done = 0;
        for (span, [x, y, z]) in self.spans.iter().zip(points) {
            out.write_all(&self.text[done..span.start])
                .map_err(failed)?;
            write!(out, "{x} {y} {z}").map_err(failed)?;
            done = span.end;
        }
        out.write_all(&self.text[done..]).map_err(failed)
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

/// A word of a line and the bytes it takes in the file.
struct Word<'a> {
    text: &'a [u8],
    span: Range<usize>,
}

impl Word<'_> {
    fn shown(&self) -> String {
        shown(&String::from_utf8_lossy(self.text))
    }

    fn coordinate(&self, line: usize) -> Result<f64> {
        let value: Option<f64> = std::str::from_utf8(self.text)
            .ok()
            .and_then(|word| word.parse().ok());
        value.filter(|value| value.is_finite()).ok_or_else(|| {
            Error::new(format!(
                "expected a finite coordinate, found \"{}\"",
                self.shown()
            ))
            .at_line(line)
        })
    }

    /// The vertex that a corner such as `7`, `7/1`, `7//3` or `-1/2/3` names.
    fn vertex(&self, vertices: usize, line: usize) -> Result<u32> {
        let first = self
            .text
            .split(|byte| *byte == b'/')
            .next()
            .unwrap_or_default();
        let number: Option<i64> = std::str::from_utf8(first)
            .ok()
            .and_then(|word| word.parse().ok());
        let index = number.and_then(|number| match number {
            1.. => usize::try_from(number - 1).ok(),
            _ => usize::try_from(number.unsigned_abs())
                .ok()
                .and_then(|back| vertices.checked_sub(back)),
        });
        match index
            .filter(|index| *index < vertices)
            .and_then(|index| u32::try_from(index).ok())
        {
            Some(index) => Ok(index),
            None => Err(Error::new(format!(
                "expected a vertex from 1 to {vertices} (those listed so far), found \"{}\"",
                self.shown()
            ))
            .at_line(line)),
        }
    }
}

/// Reads a model from the bytes of an `.obj` file.
pub fn read(bytes: &[u8]) -> Result<Model> {
    let mut model = Model {
        points: Vec::new(),
        faces: Vec::new(),
        text: bytes.to_vec(),
        spans: Vec::new(),
    };
    let (mut start, mut line) = (0, 1);
    while start < bytes.len() {
        let (end, physical_lines) = logical_line(bytes, start);
        let words = words(bytes, start..end);
        match words.split_first() {
            Some((keyword, values)) if keyword.text == b"v" => {
                let [x, y, z, ..] = values else {
                    return Err(Error::new(format!(
                        "expected three coordinates of a vertex, found {}",
                        values.len()
                    ))
                    .at_line(line));
                };
                model.points.push([
                    x.coordinate(line)?,
                    y.coordinate(line)?,
                    z.coordinate(line)?,
                ]);
                model.spans.push(x.span.start..z.span.end);
            }
            Some((keyword, corners)) if keyword.text == b"f" => {
                if corners.len() < 3 {
                    return Err(Error::new(format!(
                        "expected at least three corners of a face, found {}",
                        corners.len()
                    ))
                    .at_line(line));
                }
                let vertices = model.points.len();
                let face: Result<Vec<u32>> = corners
                    .iter()
                    .map(|corner| corner.vertex(vertices, line))
                    .collect();
                model.faces.push(face?);
            }
            _ => {}
        }
        start = end;
        line += physical_lines;
    }
    if model.points.is_empty() {
        return Err(
            Error::new("the model has no vertices (lines that start with \"v\")")
                .advise("a model is a Wavefront .obj file"),
        );
    }
    Ok(model)
}

/// End of the line that starts at `start`, and how many lines of the file it takes: a backslash
/// before the line's end joins it to the next.
fn logical_line(bytes: &[u8], start: usize) -> (usize, usize) {
    let (mut end, mut lines) = (start, 0);
    loop {
        let rest = &bytes[end..];
        let length = rest
            .iter()
            .position(|byte| *byte == b'\n')
            .map_or(rest.len(), |at| at + 1);
        end += length;
        lines += 1;
        let content = rest[..length].trim_ascii_end();
        if end == bytes.len() || content.last() != Some(&b'\\') {
            return (end, lines);
        }
    }
}

/// The words of a line up to a comment.
fn words(bytes: &[u8], line: Range<usize>) -> Vec<Word<'_>> {
    let mut words = Vec::new();
    let is_space = |at: usize| {
        let joins = bytes[at] == b'\\' && matches!(bytes.get(at + 1), Some(b'\n' | b'\r'));
        joins || bytes[at].is_ascii_whitespace()
    };
    let mut at = line.start;
    while at < line.end {
        if is_space(at) {
            at += 1;
            continue;
        }
        if bytes[at] == b'#' {
            break;
        }
        let start = at;
        while at < line.end && !is_space(at) {
            at += 1;
        }
        words.push(Word {
            text: &bytes[start..at],
            span: start..at,
        });
    }
    words
}

#[cfg(test)]
mod tests {
    use super::*;

    const ODD: &str = "# a cup\r\nmtllib cup.mtl\r\nv  1 2.50\t-3e0 0.5 0.5 0.5\r\nv 0 0 \\\r\n0\r\nvt 0 1\r\nv 1 0 0 # end\r\n\r\ng x\r\nf 1/1 2//3 -1\r\n";

    #[test]
    fn only_coordinates_change() {
        let model = read(ODD.as_bytes()).unwrap();
        assert_eq!(model.points, [[1.0, 2.5, -3.0], [0.0; 3], [1.0, 0.0, 0.0]]);
        assert_eq!(model.triangles(), [[0, 1, 2]]);
        let mut out = Vec::new();
        model
            .write_with(
                &[[0.1, 2.0, 3.0], [4.0, 5.0, 6.0], [1e-7, 1e21, -0.5]],
                &mut out,
            )
            .unwrap();
        assert_eq!(
            String::from_utf8(out).unwrap(),
            "# a cup\r\nmtllib cup.mtl\r\nv  0.1 2 3 0.5 0.5 0.5\r\nv 4 5 6\r\nvt 0 1\r\nv 0.0000001 1000000000000000000000 -0.5 # end\r\n\r\ng x\r\nf 1/1 2//3 -1\r\n"
        );
    }

    #[test]
    fn errors_name_the_line() {
        for (text, message) in [
            (
                "v 1 2\n",
                "line 1: expected three coordinates of a vertex, found 2",
            ),
            (
                "\nv 1 2 x\n",
                "line 2: expected a finite coordinate, found \"x\"",
            ),
            (
                "v 1 2 nan\n",
                "line 1: expected a finite coordinate, found \"nan\"",
            ),
            (
                "v 1 2 3 \\\n\nv 1 2 3\nf 1 2 3\n",
                "line 4: expected a vertex from 1 to 2 (those listed so far), found \"3\"",
            ),
            (
                "v 1 2 3\nf 1 0 1\n",
                "line 2: expected a vertex from 1 to 1 (those listed so far), found \"0\"",
            ),
            (
                "v 1 2 3\nf 1 1\n",
                "line 2: expected at least three corners of a face, found 2",
            ),
        ] {
            assert_eq!(read(text.as_bytes()).unwrap_err().to_string(), message);
        }
    }
}
