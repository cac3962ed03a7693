//! Surfaces as Wavefront `.obj`.

use super::failed;
use crate::error::Result;
use crate::mesh::Point;
use std::collections::HashMap;
use std::io::Write;

/// Writes vertices and faces; coordinates have the fewest digits that give the same double back.
/// `normals` holds one for each corner of each face, face by face; equal ones are written once.
pub fn write<'a>(
    points: &[Point],
    normals: Option<&[Point]>,
    faces: impl Iterator<Item = &'a [u32]>,
    out: &mut dyn Write,
) -> Result<()> {
    for [x, y, z] in points {
        writeln!(out, "v {x} {y} {z}").map_err(failed)?;
    }
    let places = match normals {
        Some(normals) => write_normals(normals, out)?,
        None => Vec::new(),
    };
    let mut places = places.into_iter();
    for face in faces {
        write!(out, "f").map_err(failed)?;
        for vertex in face {
            // Wavefront counts from 1.
            write!(out, " {}", u64::from(*vertex) + 1).map_err(failed)?;
            if let Some(place) = places.next() {
                write!(out, "//{place}").map_err(failed)?;
            }
        }
        writeln!(out).map_err(failed)?;
    }
    Ok(())
}

/// Writes every normal once, in the order in which they turn up, and returns where each is, counted from 1.
fn write_normals(normals: &[Point], out: &mut dyn Write) -> Result<Vec<usize>> {
    let mut known = HashMap::new();
    let mut places = Vec::with_capacity(normals.len());
    for normal in normals {
        let next = known.len() + 1;
        let place = *known.entry(normal.map(f64::to_bits)).or_insert(next);
        if place == next {
            let [x, y, z] = normal;
            writeln!(out, "vn {x} {y} {z}").map_err(failed)?;
        }
        places.push(place);
    }
    Ok(places)
}
