//! Surfaces as Object File Format (`.off`).

use super::failed;
use crate::error::Result;
use crate::mesh::Point;
use std::io::Write;

/// Writes vertices and polygons; coordinates have the fewest digits that give the same double back.
pub fn write<'a>(
    points: &[Point],
    faces: impl ExactSizeIterator<Item = &'a [u32]>,
    out: &mut dyn Write,
) -> Result<()> {
    writeln!(out, "OFF\n{} {} 0", points.len(), faces.len()).map_err(failed)?;
    for [x, y, z] in points {
        writeln!(out, "{x} {y} {z}").map_err(failed)?;
    }
    for face in faces {
        write!(out, "{}", face.len()).map_err(failed)?;
        for vertex in face {
            write!(out, " {vertex}").map_err(failed)?;
        }
        writeln!(out).map_err(failed)?;
    }
    Ok(())
}
