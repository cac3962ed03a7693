//! Feature files: creases, crease faces and corners for any mesh, one a line.
//!
//! `crease A B` makes the edge between two vertices a crease, `crease-face A B C` or `crease-face A B C D` makes a face of a
//! cell part of a crease surface inside the solid, `corner A` keeps a vertex in its place, `sheet A B C`
//! adds a triangle that no cell has; vertices are counted from 0 in the mesh's file order. Empty
//! lines and everything after `#` are skipped.

use super::words::shown;
use crate::error::{Error, Result, count};
use crate::mesh::{Features, Vertex};

/// Reads a feature file for a mesh of so many vertices.
pub fn read(bytes: &[u8], vertices: usize) -> Result<Features> {
    let text = std::str::from_utf8(bytes).map_err(|error| {
        Error::new("found bytes that are not text").at_byte(error.valid_up_to())
    })?;
    let mut features = Features::default();
    for (index, line) in text.lines().enumerate() {
        let content = line.split('#').next().unwrap_or("");
        let words: Vec<&str> = content.split_ascii_whitespace().collect();
        let located = |error: Error| error.at_line(index + 1);
        let vertex = |word: &str| vertex(word, vertices).map_err(located);
        match words.as_slice() {
            [] => {}
            ["crease", a, b] => {
                let edge = [vertex(a)?, vertex(b)?];
                if edge[0] == edge[1] {
                    return Err(located(Error::new(format!(
                        "both ends of the crease are vertex {a}"
                    ))));
                }
                features.creases.push(edge);
            }
            ["corner", a] => features.corners.push(vertex(a)?),
            ["crease-face", a, b, c] => {
                features.faces.push(
                    distinct([vertex(a)?, vertex(b)?, vertex(c)?], "crease face")
                        .map_err(located)?,
                );
            }
            ["sheet", a, b, c] => {
                features.sheets.push(
                    distinct([vertex(a)?, vertex(b)?, vertex(c)?], "sheet's triangle")
                        .map_err(located)?,
                );
            }
            ["crease-face", a, b, c, d] => {
                features.quads.push(
                    distinct(
                        [vertex(a)?, vertex(b)?, vertex(c)?, vertex(d)?],
                        "crease face",
                    )
                    .map_err(located)?,
                );
            }
            [word, ..] => {
                return Err(located(Error::new(format!(
                    "expected `crease A B`, `crease-face A B C`, `sheet A B C` or `corner A`, found \"{}\" with {} after it",
                    shown(word),
                    count(words.len() - 1, "word", "words")
                ))));
            }
        }
    }
    features.normalise();
    Ok(features)
}

/// The corners, unless one is named twice.
fn distinct<const N: usize>(corners: [Vertex; N], what: &str) -> Result<[Vertex; N]> {
    let is_repeated = |place: usize| corners[..place].contains(&corners[place]);
    if (1..N).any(is_repeated) {
        return Err(Error::new(format!("the {what} names a vertex twice")));
    }
    Ok(corners)
}

fn vertex(word: &str, vertices: usize) -> Result<Vertex> {
    let index: Vertex = word
        .parse()
        .map_err(|_| Error::new(format!("expected a vertex, found \"{}\"", shown(word))))?;
    if usize::try_from(index).is_ok_and(|index| index < vertices) {
        return Ok(index);
    }
    Err(Error::new(format!(
        "there is no vertex {index}; the mesh has {vertices}"
    ))
    .advise("vertices are counted from 0 in the order of the mesh file"))
}
