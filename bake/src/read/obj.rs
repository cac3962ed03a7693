//! Wavefront models (`.obj`): positions in double precision, everything else verbatim.
//!
//! The file comes back byte for byte with only the coordinates on the `v` lines replaced. Comments, groups, texture
//! coordinates, normals, vertex colours, line ends and the order of all lines stay. (Normals on
//! `vn` lines stay as well and describe the rest shape.) Faces are read for pictures.

use super::lines::{Word, span_of, words};
pub use super::models::Model;
use crate::error::{Error, Result};

/// The vertex that a corner such as `7`, `7/1`, `7//3` or `-1/2/3` names.
fn vertex(word: &Word<'_>, vertices: usize, line: usize) -> Result<u32> {
    let first = word
        .text
        .split(|byte| *byte == b'/')
        .next()
        .unwrap_or_default();
    let number: Option<i64> = std::str::from_utf8(first)
        .ok()
        .and_then(|number| number.parse().ok());
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
            word.shown()
        ))
        .at_line(line)),
    }
}

/// Reads a model from the bytes of an `.obj` file.
pub fn read(bytes: &[u8]) -> Result<Model> {
    let mut model = Model::new(bytes);
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
                let point = [
                    x.coordinate(line)?,
                    y.coordinate(line)?,
                    z.coordinate(line)?,
                ];
                model.add_point(point, span_of(&values[..3]));
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
                    .map(|corner| vertex(corner, vertices, line))
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
