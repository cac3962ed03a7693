//! Surfaces as Stanford `.ply`, ASCII, in double precision.

use super::failed;
use crate::error::Result;
use crate::mesh::Point;
use std::io::Write;

/// Writes vertices and faces; coordinates have the fewest digits that give the same double back.
pub fn write(points: &[Point], faces: &[&[u32]], out: &mut dyn Write) -> Result<()> {
    write_file(points, faces, out).map_err(failed)
}

fn write_file(points: &[Point], faces: &[&[u32]], out: &mut dyn Write) -> std::io::Result<()> {
    write!(
        out,
        "ply\nformat ascii 1.0\nelement vertex {}\nproperty double x\nproperty double y\nproperty double z\nelement face {}\nproperty list int int vertex_indices\nend_header\n",
        points.len(),
        faces.len()
    )?;
    for [x, y, z] in points {
        writeln!(out, "{x} {y} {z}")?;
    }
    super::write_faces(faces, out)
}
