//! Animations as a ParaView collection (`.pvd`): a file that lists a `.vtu` for each frame, with its
//! time in seconds.
//!
//! The frames lie in a folder beside the list that has its name without the extension. Each holds the
//! model's points in double precision, its polygons, and the vector `displacement` from rest to
//! colour it by.

use super::failed;
use super::vtk_cells::Element;
use super::vtu::{Grid, escaped, vectors};
use crate::animation::{Animation, Frame};
use crate::error::{Error, Result};
use crate::geometry::subtract;
use std::io::Write;
use std::path::Path;

/// Writes the frames, each all or nothing, and the list when they are all there.
///
/// # Errors
/// If the folder cannot be made or a file cannot be written.
pub fn write(animation: &Animation<'_>, file: &Path) -> Result<()> {
    let stem = file.file_stem().unwrap_or_default();
    let folder = file.with_file_name(stem);
    std::fs::create_dir_all(&folder)
        .map_err(|error| Error::new(format!("cannot be made: {error}")).in_file(&folder))?;
    let mut entries = Vec::new();
    for frame in animation.frames {
        let name = format!("frame-{:04}.vtu", frame.number);
        super::atomically(&folder.join(&name), |out| {
            write_frame(animation, frame, out).map_err(failed)
        })?;
        entries.push((animation.seconds(frame), name));
    }
    let folder = escaped(&stem.to_string_lossy());
    super::atomically(file, |out| {
        write_list(&folder, &entries, out).map_err(failed)
    })
}

fn write_list(folder: &str, entries: &[(f64, String)], out: &mut dyn Write) -> std::io::Result<()> {
    writeln!(out, "<?xml version=\"1.0\"?>")?;
    writeln!(
        out,
        "<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n<Collection>"
    )?;
    for (seconds, name) in entries {
        writeln!(
            out,
            "<DataSet timestep=\"{seconds}\" group=\"\" part=\"0\" file=\"{folder}/{name}\"/>"
        )?;
    }
    writeln!(out, "</Collection>\n</VTKFile>")
}

fn write_frame(
    animation: &Animation<'_>,
    frame: &Frame<'_>,
    out: &mut dyn Write,
) -> std::io::Result<()> {
    let displacement = |out: &mut dyn Write| {
        let pairs = frame.points.iter().zip(animation.rest);
        let ways = pairs.map(|(point, rest)| subtract(*point, *rest));
        writeln!(out, "<PointData Vectors=\"displacement\">")?;
        vectors(out, "displacement", ways)?;
        writeln!(out, "</PointData>")
    };
    let grid = Grid {
        points: frame.points,
        elements: || animation.faces.iter().map(|face| Element::of_polygon(face)),
    };
    grid.write(displacement, |_| Ok(()), out)
}
