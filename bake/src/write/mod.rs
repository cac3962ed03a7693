//! Writers: one for each file format, and the one way a file comes into being.
//!
//! An output file is written under a temporary name in its own directory and renamed when it is
//! complete, so that nobody ever sees half of it and a failure leaves what was there before. What is no
//! regular file (a pipe, a device) is written to in place, for it has no name to change.

pub mod glb;
pub mod obj;
pub mod off;
pub mod ply;
pub mod pvd;
pub mod vtk;
mod vtk_cells;
pub mod vtu;

use crate::error::{Error, Result};
use crate::mesh::{Faces, Point, SolidMesh};
use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};
use tempfile::NamedTempFile;

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
    surface_with_normals(extension, points, None, faces, out)
}

/// Writes a surface with a normal for each corner of each face, face by face. An `.obj` keeps them all, so that a
/// crease has both sides' normals; a `.ply` has one for each vertex, the mean of those of its corners brought to
/// unit length; an `.off` has none.
///
/// # Errors
/// As [`surface`].
pub fn surface_with_normals(
    extension: &str,
    points: &[Point],
    normals: Option<&[Point]>,
    faces: &[&[u32]],
    out: &mut dyn Write,
) -> Result<()> {
    match extension {
        "obj" => obj::write(points, normals, faces.iter().copied(), out),
        "ply" => {
            let means = normals.map(|normals| vertex_means(points.len(), normals, faces));
            ply::write(points, means.as_deref(), faces, out)
        }
        "off" => off::write(points, faces.iter().copied(), out),
        other => Err(no_writer(other)),
    }
}

/// The mean of the normals of each vertex's corners, brought to unit length; zero for none.
fn vertex_means(vertices: usize, normals: &[Point], faces: &[&[u32]]) -> Vec<Point> {
    let mut sums = vec![[0.0; 3]; vertices];
    for (vertex, normal) in faces.iter().copied().flatten().zip(normals) {
        for (total, coordinate) in sums[*vertex as usize].iter_mut().zip(normal) {
            *total += coordinate;
        }
    }
    for sum in &mut sums {
        let length = sum.iter().map(|x| x * x).sum::<f64>().sqrt();
        if length > 0.0 {
            *sum = sum.map(|coordinate| coordinate / length);
        }
    }
    sums
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

/// Writes triangles, then quadrilaterals, and only those vertices that they use, in their order.
///
/// # Errors
/// As [`surface`].
pub fn boundary(
    extension: &str,
    points: &[Point],
    faces: &Faces,
    out: &mut dyn Write,
) -> Result<()> {
    let mut used = vec![false; points.len()];
    let (triangles, quads) = (&faces.triangles, &faces.quads);
    for vertex in triangles.as_flattened().iter().chain(quads.as_flattened()) {
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
    let renumber = |face: &[u32]| -> Vec<u32> {
        let vertices = face.iter();
        vertices.map(|vertex| new_index[*vertex as usize]).collect()
    };
    let triangles = triangles.iter().map(|face| renumber(face));
    let renumbered: Vec<Vec<u32>> = triangles
        .chain(quads.iter().map(|face| renumber(face)))
        .collect();
    let faces: Vec<&[u32]> = renumbered.iter().map(Vec::as_slice).collect();
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
///
/// # Errors
/// If `content` fails or the file cannot be written. What was there before is then still there.
pub fn atomically(file: &Path, content: impl FnOnce(&mut dyn Write) -> Result<()>) -> Result<()> {
    Prepared::new(file, content)?.publish()
}

/// A file that is complete under a temporary name. Dropped, it vanishes.
///
/// Of several files that belong together all are prepared before the first is published.
pub struct Prepared {
    /// What was asked for, for errors.
    file: PathBuf,
    /// Where that leads, if it is a link.
    target: PathBuf,
    /// `None` of what is no regular file, such as a pipe: it has its content already.
    temporary: Option<NamedTempFile>,
}

impl Prepared {
    /// Writes what `content` writes beside `file`, down to the disk.
    ///
    /// # Errors
    /// If `content` fails or there is no place to write.
    pub fn new(file: &Path, content: impl FnOnce(&mut dyn Write) -> Result<()>) -> Result<Self> {
        let cannot = |error: std::io::Error| failed(error).in_file(file);
        // A link stays, and what it leads to is replaced.
        let target = std::fs::canonicalize(file).unwrap_or_else(|_| file.to_path_buf());
        let temporary = match std::fs::metadata(&target) {
            Ok(found) if found.is_dir() => {
                return Err(Error::new("cannot be written: it is a folder").in_file(file));
            }
            Ok(found) if !found.is_file() => {
                let device = File::options().write(true).open(&target).map_err(cannot)?;
                fill(device, content).map_err(|error| error.in_file(file))?;
                None
            }
            _ => {
                let temporary = temporary_beside(&target).map_err(cannot)?;
                let temporary = fill(temporary, content).map_err(|error| error.in_file(file))?;
                // Some file systems tell only now that the disk is full.
                temporary.as_file().sync_all().map_err(cannot)?;
                Some(temporary)
            }
        };
        Ok(Self {
            file: file.to_path_buf(),
            target,
            temporary,
        })
    }

    /// Gives the file its name, in place of what had it before.
    ///
    /// # Errors
    /// If the name cannot be given.
    pub fn publish(self) -> Result<()> {
        match self
            .temporary
            .map(|temporary| temporary.persist(&self.target))
        {
            None | Some(Ok(_)) => Ok(()),
            Some(Err(error)) => Err(failed(error.error).in_file(&self.file)),
        }
    }
}

/// Gives back the file with all content in it.
fn fill<W: Write>(file: W, content: impl FnOnce(&mut dyn Write) -> Result<()>) -> Result<W> {
    let mut writer = BufWriter::new(file);
    content(&mut writer)?;
    writer
        .into_inner()
        .map_err(|error| failed(error.into_error()))
}

fn temporary_beside(target: &Path) -> std::io::Result<NamedTempFile> {
    let directory = match target.parent() {
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
    builder.tempfile_in(directory)
}

/// The error of a failed write, to be given a file name by [`Prepared`].
pub(crate) fn failed(error: std::io::Error) -> Error {
    Error::new(format!("cannot be written: {error}"))
}
