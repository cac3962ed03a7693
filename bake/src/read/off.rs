//! Object File Format (`.off`), ASCII: vertices and polygons.

use super::words::shown;
use crate::error::{Error, Result};
use crate::surface::SurfaceMesh;

/// Reads a control mesh. Colours after a face's corners are skipped.
pub fn read(bytes: &[u8]) -> Result<SurfaceMesh> {
    let text = std::str::from_utf8(bytes).map_err(|error| {
        Error::new("found bytes that are not text").at_byte(error.valid_up_to())
    })?;
    let lines = text.lines().zip(1..).map(|(line, number)| {
        let content = line.split('#').next().unwrap_or("");
        (content.split_ascii_whitespace().collect::<Vec<_>>(), number)
    });
    let mut lines = lines.filter(|(words, _)| !words.is_empty());
    let end = || Error::new("the file ends before its counts are filled");
    let (header, line) = lines.next().ok_or_else(end)?;
    if header[0] != "OFF" {
        return Err(
            Error::new(format!("expected \"OFF\", found \"{}\"", shown(header[0])))
                .advise("only the plain variant without normals or colours per vertex is read")
                .at_line(line),
        );
    }
    let (counts, line) = match header.len() {
        1 => lines.next().ok_or_else(end)?,
        _ => (header[1..].to_vec(), line),
    };
    let [vertices, faces, ..] = counts.as_slice() else {
        return Err(Error::new("expected the numbers of vertices and faces").at_line(line));
    };
    let (vertices, faces) = (number(vertices, line)?, number(faces, line)?);
    let mut mesh = SurfaceMesh::default();
    for _ in 0..vertices {
        let (words, line) = lines.next().ok_or_else(end)?;
        let [x, y, z, ..] = words.as_slice() else {
            return Err(Error::new("expected three coordinates").at_line(line));
        };
        let coordinate = |word: &str| match word.parse::<f64>() {
            Ok(value) if value.is_finite() => Ok(value),
            _ => Err(Error::new(format!(
                "expected a finite coordinate, found \"{}\"",
                shown(word)
            ))
            .at_line(line)),
        };
        mesh.points
            .push([coordinate(x)?, coordinate(y)?, coordinate(z)?]);
    }
    for _ in 0..faces {
        let (words, line) = lines.next().ok_or_else(end)?;
        let count = number(words[0], line)?;
        let corners = words.get(1..).and_then(|rest| rest.get(..count));
        let Some(corners) = corners.filter(|corners| corners.len() >= 3) else {
            return Err(Error::new(
                "expected a face's number of corners, at least 3, and as many vertices",
            )
            .at_line(line));
        };
        let vertex = |word: &&str| match number(word, line)? {
            index if index < vertices => u32::try_from(index)
                .map_err(|_| Error::new("more than 2^32 vertices").at_line(line)),
            index => Err(Error::new(format!(
                "there is no vertex {index}; the mesh has {vertices}, counted from 0"
            ))
            .at_line(line)),
        };
        mesh.faces
            .push(corners.iter().map(vertex).collect::<Result<_>>()?);
    }
    Ok(mesh)
}

fn number(word: &str, line: usize) -> Result<usize> {
    word.parse().map_err(|_| {
        Error::new(format!(
            "expected a whole number, found \"{}\"",
            shown(word)
        ))
        .at_line(line)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reads_polygons_and_says_where_it_fails() {
        let text = b"OFF\n# a pyramid\n5 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n0.5 0.5 1\n\n4 3 2 1 0\n3 0 1 4 255 0 0\n";
        let mesh = read(text).unwrap();
        assert_eq!(mesh.points[4], [0.5, 0.5, 1.0]);
        assert_eq!(mesh.faces, [vec![3, 2, 1, 0], vec![0, 1, 4]]);
        for (text, message) in [
            ("COFF\n", "line 1: expected \"OFF\", found \"COFF\""),
            (
                "OFF 1 0 0\n0 0 x\n",
                "line 2: expected a finite coordinate, found \"x\"",
            ),
            (
                "OFF 1 1 0\n0 0 0\n3 0 0 1\n",
                "line 3: there is no vertex 1; the mesh has 1, counted from 0",
            ),
            (
                "OFF 2 0 0\n0 0 0\n",
                "the file ends before its counts are filled",
            ),
        ] {
            let error = read(text.as_bytes()).unwrap_err().to_string();
            assert!(error.starts_with(message), "{error}");
        }
    }
}
