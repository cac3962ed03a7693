//! Writers: one for each file format, and the one way a file comes into being.
//!
//! An output file is written under a temporary name in its own directory and renamed when it is
//! complete, so that nobody ever sees half of it and a failure leaves what was there before.

pub mod obj;
pub mod off;
pub mod ply;
pub mod vtk;
pub mod vtu;

use crate::error::{Error, Result};
use crate::mesh::{Point, SolidMesh};
use std::io::{BufWriter, Write};
use std::path::Path;

/// The extensions of the formats that [`solid`] writes.
pub const SOLID_EXTENSIONS: [&str; 2] = ["vtu", "vtk"];

/// The extensions of the formats that [`surface`] writes.
pub const SURFACE_EXTENSIONS: [&str; 3] = ["obj", "ply", "off"];

/// Writes a solid in the format that the extension names.
///
/// # Errors
/// If writing fails or the format is none of [`SOLID_EXTENSIONS`].
pub fn solid(extension: &str, mesh: &SolidMesh, out: &mut dyn Write) -> Result<()> {
    match extension {
        "vtu" => vtu::write(mesh, out),
        "vtk" => vtk::write(mesh, out),
        other => Err(no_writer(other)),
    }
}

/// Writes a surface of polygons in the format that the extension names, all vertices in order.
///
/// # Errors
/// If writing fails or the format is none of [`SURFACE_EXTENSIONS`].
pub fn surface(
    extension: &str,
    points: &[Point],
    faces: &[&[u32]],
    out: &mut dyn Write,
) -> Result<()> {
    match extension {
        "obj" => obj::write(points, faces.iter().copied(), out),
        "ply" => ply::write(points, faces, out),
        "off" => off::write(points, faces.iter().copied(), out),
        other => Err(no_writer(other)),
    }
}

/// Error unless [`surface`] writes the format that the file's extension names.
pub fn require_surface_extension(file: &Path) -> Result<()> {
    let extension = crate::read::extension(file);
    if SURFACE_EXTENSIONS.contains(&extension.as_str()) {
        return Ok(());
    }
    Err(no_writer(&extension)
        .advise("a refined surface is written as .obj, .ply or .off")
        .in_file(file))
}

/// Writes triangles and only those vertices that they use, in their order.
///
/// # Errors
/// As [`surface`].
pub fn boundary(
    extension: &str,
    points: &[Point],
    triangles: &[[u32; 3]],
    out: &mut dyn Write,
) -> Result<()> {
    let mut used = vec![false; points.len()];
    for vertex in triangles.iter().flatten() {
        used[*vertex as usize] = true;
    }
    let mut kept = Vec::new();
    let mut new_index = vec![0_u32; points.len()];
    for (vertex, point) in points.iter().enumerate() {
        if used[vertex] {
            new_index[vertex] = kept.len() as u32;
            kept.push(*point);
        }
    }
    let renumbered: Vec<[u32; 3]> = triangles
        .iter()
        .map(|triangle| triangle.map(|vertex| new_index[vertex as usize]))
        .collect();
    let faces: Vec<&[u32]> = renumbered.iter().map(<[u32; 3]>::as_slice).collect();
    surface(extension, &kept, &faces, out)
}

fn no_writer(extension: &str) -> Error {
    Error::new(format!("no writer for \".{extension}\" files"))
}

/// Faces as lines of their number of corners and the corners, counted from 0.
fn write_faces(faces: &[&[u32]], out: &mut dyn Write) -> std::io::Result<()> {
    for face in faces {
        write!(out, "{}", face.len())?;
        for vertex in *face {
            write!(out, " {vertex}")?;
        }
        writeln!(out)?;
    }
    Ok(())
}

/// Creates or replaces `file` with what `content` writes, all or nothing.
pub fn atomically(file: &Path, content: impl FnOnce(&mut dyn Write) -> Result<()>) -> Result<()> {
    let cannot =
        |error: std::io::Error| Error::new(format!("cannot be written: {error}")).in_file(file);
    let directory = match file.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    };
    let mut builder = tempfile::Builder::new();
    builder.prefix(".octruss-");
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        // As for any new file: the user's mask takes away what others may not do.
        builder.permissions(std::fs::Permissions::from_mode(0o666));
    }
    let temporary = builder.tempfile_in(directory).map_err(cannot)?;
    let mut writer = BufWriter::new(temporary);
    content(&mut writer).map_err(|error| error.in_file(file))?;
    let temporary = writer
        .into_inner()
        .map_err(|error| cannot(error.into_error()))?;
    temporary
        .persist(file)
        .map_err(|error| cannot(error.error))?;
    Ok(())
}

/// The error of a failed write, to be given a file name by [`atomically`].
pub(crate) fn failed(error: std::io::Error) -> Error {
    Error::new(format!("cannot be written: {error}"))
}
