//! Surfaces as Wavefront `.obj`.

use super::failed;
use crate::error::Result;
use crate::mesh::Point;
use std::io::Write;

/// Writes vertices and faces; coordinates have the fewest digits that give the same double back.
pub fn write<'a>(
    points: &[Point],
    faces: impl Iterator<Item = &'a [u32]>,
    out: &mut dyn Write,
) -> Result<()> {
    for [x, y, z] in points {
        writeln!(out, "v {x} {y} {z}").map_err(failed)?;
    }
    for face in faces {
        write!(out, "f").map_err(failed)?;
        for vertex in face {
            // Wavefront counts from 1.
            write!(out, " {}", u64::from(*vertex) + 1).map_err(failed)?;
        }
        writeln!(out).map_err(failed)?;
    }
    Ok(())
}
