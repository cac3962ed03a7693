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

/// Writes only the vertices that the triangles use, in their order.
pub fn write_used(points: &[Point], triangles: &[[u32; 3]], out: &mut dyn Write) -> Result<()> {
    let mut used = vec![false; points.len()];
    for vertex in triangles.iter().flatten() {
        used[*vertex as usize] = true;
    }
    let mut kept = Vec::new();
    let mut new_index = vec![0_u32; points.len()];
    for (vertex, point) in points
        .iter()
        .enumerate()
        .filter(|(vertex, _)| used[*vertex])
    {
        new_index[vertex] = kept.len() as u32;
        kept.push(*point);
    }
    let renumbered: Vec<[u32; 3]> = triangles
        .iter()
        .map(|triangle| triangle.map(|vertex| new_index[vertex as usize]))
        .collect();
    write(&kept, renumbered.iter().map(<[u32; 3]>::as_slice), out)
}
