//! Surfaces as Stanford `.ply`, ASCII, in double precision.

use super::failed;
use crate::error::Result;
use crate::mesh::Point;
use std::io::Write;

/// Writes vertices, with their normals if there are such, and faces; numbers have the fewest digits that give the
/// same double back.
pub fn write(
    points: &[Point],
    normals: Option<&[Point]>,
    faces: &[&[u32]],
    out: &mut dyn Write,
) -> Result<()> {
    write_file(points, normals, faces, out).map_err(failed)
}

fn write_file(
    points: &[Point],
    normals: Option<&[Point]>,
    faces: &[&[u32]],
    out: &mut dyn Write,
) -> std::io::Result<()> {
    let of_normals = match normals {
        Some(_) => "property double nx\nproperty double ny\nproperty double nz\n",
        None => "",
    };
    write!(
        out,
        "ply\nformat ascii 1.0\nelement vertex {}\nproperty double x\nproperty double y\nproperty double z\n{of_normals}element face {}\nproperty list int int vertex_indices\nend_header\n",
        points.len(),
        faces.len()
    )?;
    let mut normals = normals.unwrap_or_default().iter();
    for [x, y, z] in points {
        write!(out, "{x} {y} {z}")?;
        if let Some([x, y, z]) = normals.next() {
            write!(out, " {x} {y} {z}")?;
        }
        writeln!(out)?;
    }
    super::write_faces(faces, out)
}
