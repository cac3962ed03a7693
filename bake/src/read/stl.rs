//! Models as `.stl`, ASCII and binary.
//!
//! An STL file lists every triangle by itself. Corners at the same place are one vertex: vertices
//! are numbered in the order in which their places turn up. Nothing else is merged, not even
//! places that differ in the last digit. The file comes back with the corners moved and the normals
//! computed anew; a binary file holds single precision, so written positions are rounded to that.

use super::models::{Content, Model};
use super::words::{Words, shown};
use crate::error::{Error, Result};
use crate::mesh::Point;
use std::collections::HashMap;

const HEADER_BYTES: usize = 80;
const TRIANGLE_BYTES: usize = 50;
const POINT_BYTES: usize = 12;

/// Reads a model from the bytes of an `.stl` file.
pub fn read(bytes: &[u8]) -> Result<Model> {
    let expected = binary_length(bytes);
    let model = if expected == Some(bytes.len()) {
        binary(bytes)?
    } else if bytes.trim_ascii_start().starts_with(b"solid") {
        ascii(bytes)?
    } else {
        let message = match expected {
            None => format!(
                "expected \"solid\" or 84 bytes and more, found {} bytes",
                bytes.len()
            ),
            Some(expected) => format!(
                "expected {expected} bytes, as the number of triangles says, found {}",
                bytes.len()
            ),
        };
        return Err(Error::new(message)
            .at_byte(bytes.len().min(HEADER_BYTES))
            .advise("the file seems to be cut off, or it is no STL file"));
    };
    if model.points.is_empty() {
        return Err(Error::new("the model has no triangles"));
    }
    Ok(model)
}

/// How long a binary file would be that starts like this.
fn binary_length(bytes: &[u8]) -> Option<usize> {
    let count = bytes.get(HEADER_BYTES..HEADER_BYTES + 4)?;
    let count = u32::from_le_bytes([count[0], count[1], count[2], count[3]]);
    let triangles = usize::try_from(count).ok()?.checked_mul(TRIANGLE_BYTES)?;
    triangles.checked_add(HEADER_BYTES + 4)
}

/// The vertices so far, by place.
#[derive(Default)]
struct Weld {
    vertices: HashMap<[u64; 3], u32>,
}

impl Weld {
    fn vertex(&mut self, point: Point, model: &mut Model) -> u32 {
        // Adding zero turns -0 into 0: they are the same place.
        let key = point.map(|coordinate| (coordinate + 0.0).to_bits());
        *self.vertices.entry(key).or_insert_with(|| {
            model.points.push(point);
            (model.points.len() - 1) as u32
        })
    }
}

fn binary(bytes: &[u8]) -> Result<Model> {
    let (mut model, mut weld) = (Model::new(bytes), Weld::default());
    let start = HEADER_BYTES + 4;
    for (index, triangle) in bytes[start..].chunks_exact(TRIANGLE_BYTES).enumerate() {
        let at = start + index * TRIANGLE_BYTES;
        model.add_slot(at..at + POINT_BYTES, Content::NormalSingles(index));
        let mut face = Vec::new();
        for corner in 1..=3 {
            let offset = corner * POINT_BYTES;
            let (words, _) = triangle[offset..offset + POINT_BYTES].as_chunks::<4>();
            let coordinate = |axis: usize| f64::from(f32::from_le_bytes(words[axis]));
            let point = [coordinate(0), coordinate(1), coordinate(2)];
            if point.iter().any(|coordinate| !coordinate.is_finite()) {
                return Err(Error::new(format!(
                    "triangle {index} (counted from 0) has a coordinate that is no finite number"
                ))
                .at_byte(at + offset));
            }
            let vertex = weld.vertex(point, &mut model);
            let place = at + offset;
            model.add_slot(place..place + POINT_BYTES, Content::Singles(vertex));
            face.push(vertex);
        }
        model.faces.push(face);
    }
    Ok(model)
}

fn ascii(bytes: &[u8]) -> Result<Model> {
    let (mut model, mut weld) = (Model::new(bytes), Weld::default());
    let mut words = Words::new(bytes);
    words.word("solid")?;
    words.line()?;
    loop {
        match words.word("facet or endsolid")? {
            "facet" => facet(&mut words, &mut model, &mut weld)?,
            "endsolid" => {
                words.line()?;
                // A file may hold several solids.
                if !words.is_next("solid") {
                    return Ok(model);
                }
                words.word("solid")?;
                words.line()?;
            }
            other => {
                return Err(words.error(format!(
                    "expected facet or endsolid, found \"{}\"",
                    shown(other)
                )));
            }
        }
    }
}

fn facet(words: &mut Words<'_>, model: &mut Model, weld: &mut Weld) -> Result<()> {
    expect(words, &["normal"])?;
    let (_, span) = point(words, false, "a coordinate of a normal")?;
    model.add_slot(span, Content::Normal(model.faces.len()));
    expect(words, &["outer", "loop"])?;
    let mut face = Vec::new();
    for _ in 0..3 {
        expect(words, &["vertex"])?;
        let (point, span) = point(words, true, "a coordinate of a corner")?;
        let vertex = weld.vertex(point, model);
        model.add_slot(span, Content::Position(vertex));
        face.push(vertex);
    }
    model.faces.push(face);
    expect(words, &["endloop", "endfacet"])
}

fn expect(words: &mut Words<'_>, wanted: &[&str]) -> Result<()> {
    for wanted in wanted {
        let found = words.word(wanted)?;
        if found != *wanted {
            return Err(words.error(format!("expected {wanted}, found \"{}\"", shown(found))));
        }
    }
    Ok(())
}

fn point(
    words: &mut Words<'_>,
    must_be_finite: bool,
    expected: &str,
) -> Result<(Point, std::ops::Range<usize>)> {
    let (mut point, mut span) = ([0.0; 3], 0..0);
    for (axis, coordinate) in point.iter_mut().enumerate() {
        // Normals are computed anew; some programs write "nan" for triangles without area.
        *coordinate = if must_be_finite {
            words.coordinate(expected)?
        } else {
            words.number(expected)?
        };
        if axis == 0 {
            span.start = words.span().start;
        }
    }
    span.end = words.span().end;
    Ok((point, span))
}
