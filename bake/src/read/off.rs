//! Models and control meshes as Geomview's Object File Format (`.off`), ASCII.
//!
//! The file comes back byte for byte with only the coordinates of its vertices replaced: colours,
//! normals, comments and line ends stay. Numbers behind a vertex's coordinates and behind a face's
//! corners are skipped.

use super::lines::{Word, span_of, words};
use super::models::Model;
use crate::error::{Error, Result};

/// The lines of a file that hold words.
struct Lines<'a> {
    bytes: &'a [u8],
    start: usize,
    number: usize,
}

impl<'a> Lines<'a> {
    /// The words of the next line that has any, and its number.
    fn next(&mut self, expected: &str) -> Result<(Vec<Word<'a>>, usize)> {
        while self.start < self.bytes.len() {
            let rest = &self.bytes[self.start..];
            let length = rest.iter().position(|byte| *byte == b'\n');
            let end = self.start + length.map_or(rest.len(), |length| length + 1);
            let found = words(self.bytes, self.start..end);
            self.start = end;
            self.number += 1;
            if !found.is_empty() {
                return Ok((found, self.number));
            }
        }
        Err(
            Error::new(format!("expected {expected}, found the end of the file"))
                .at_line(self.number)
                .advise("the file seems to be cut off; write it again"),
        )
    }
}

/// Reads a model, or the points and polygons of a control mesh, from the bytes of an `.off` file.
pub fn read(bytes: &[u8]) -> Result<Model> {
    let mut lines = Lines {
        bytes,
        start: 0,
        number: 0,
    };
    let [vertices, faces] = header(&mut lines)?;
    let mut model = Model::new(bytes);
    for vertex in 0..vertices {
        let (words, line) =
            lines.next(&format!("vertex {vertex} (counted from 0) of {vertices}"))?;
        let [x, y, z, ..] = words.as_slice() else {
            return Err(Error::new(format!(
                "expected three coordinates of a vertex, found {}",
                words.len()
            ))
            .at_line(line));
        };
        let point = [
            x.coordinate(line)?,
            y.coordinate(line)?,
            z.coordinate(line)?,
        ];
        model.add_point(point, span_of(&words[..3]));
    }
    for face in 0..faces {
        let (words, line) = lines.next(&format!("face {face} (counted from 0) of {faces}"))?;
        let corners = corners(&words, vertices).map_err(|error| error.at_line(line))?;
        model.faces.push(corners);
    }
    if model.points.is_empty() {
        return Err(Error::new("the model has no vertices"));
    }
    Ok(model)
}

/// The numbers of vertices and faces.
fn header(lines: &mut Lines<'_>) -> Result<[usize; 2]> {
    let expected = "OFF and the numbers of vertices, faces and edges";
    let (first, line) = lines.next(expected)?;
    let (keyword, rest) = first.split_at(1);
    let wrong = |word: &Word<'_>, line: usize| {
        Error::new(format!("expected {expected}, found \"{}\"", word.shown())).at_line(line)
    };
    if !matches!(
        keyword[0].text,
        b"OFF" | b"COFF" | b"NOFF" | b"CNOFF" | b"STOFF"
    ) {
        return Err(wrong(&keyword[0], line).advise("this is no .off file of points in space"));
    }
    if rest.first().is_some_and(|word| word.text == b"BINARY") {
        return Err(Error::new("the model is binary; ASCII is read").at_line(line));
    }
    let (counts, line) = if rest.is_empty() {
        lines.next(expected)?
    } else {
        (words(lines.bytes, span_of(rest)), line)
    };
    let number = |place: usize| -> Result<usize> {
        let word = counts.get(place).ok_or_else(|| {
            Error::new(format!(
                "expected {expected}, found {} numbers",
                counts.len()
            ))
            .at_line(line)
        })?;
        let text = std::str::from_utf8(word.text).ok();
        text.and_then(|text| text.parse().ok())
            .ok_or_else(|| wrong(word, line))
    };
    Ok([number(0)?, number(1)?])
}

fn corners(words: &[Word<'_>], vertices: usize) -> Result<Vec<u32>> {
    let number =
        |word: &Word<'_>| -> Option<usize> { std::str::from_utf8(word.text).ok()?.parse().ok() };
    let listed = words.first().and_then(number).unwrap_or(0);
    let Some(corners) = words.get(1..).and_then(|rest| rest.get(..listed)) else {
        return Err(Error::new(format!(
            "expected {listed} corners of a face, found {}",
            words.len() - 1
        )));
    };
    if corners.len() < 3 {
        return Err(Error::new(format!(
            "expected at least three corners of a face, found {}",
            corners.len()
        )));
    }
    let vertex = |word: &Word<'_>| {
        let index = number(word).filter(|index| *index < vertices);
        index
            .and_then(|index| u32::try_from(index).ok())
            .ok_or_else(|| {
                Error::new(format!(
                    "expected a vertex from 0 to {}, found \"{}\"",
                    vertices.saturating_sub(1),
                    word.shown()
                ))
            })
    };
    corners.iter().map(vertex).collect()
}
