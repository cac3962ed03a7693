//! `octruss refine` of surfaces.

use super::refine::{Arguments, Numeric};
use super::{print_figures, progress::Bars, show_notes};
use octruss::blend::FixedBlend;
use octruss_bake::error::{Result, count};
use octruss_bake::mesh::Point;
use octruss_bake::progress::Progress;
use octruss_bake::refine::RealBlend;
use octruss_bake::surface::{SurfaceLevel, SurfaceMesh, SurfaceScheme, SurfaceStep};
use octruss_bake::table::format::Format;
use octruss_bake::{read, write};
use serde::Serialize;

/// What is printed.
#[derive(Serialize)]
struct Figures {
    levels: u32,
    vertices: usize,
    faces: usize,
    crease_edges: usize,
    corners: usize,
    /// Of `--numeric fixed`.
    fraction_bits: Option<u32>,
    saturated_coordinates: usize,
}

/// Runs the command.
pub fn run(scheme: SurfaceScheme, arguments: &Arguments) -> Result<()> {
    let extension = read::extension(&arguments.output);
    write::require_surface_extension(&arguments.output)?;
    let mesh = read::surface_with_features(&arguments.mesh, arguments.features.as_deref())?;
    show_notes(&mesh.notes);
    let (points, level, figures) =
        refine(&mesh, scheme, arguments).map_err(|error| error.in_file(&arguments.mesh))?;
    let faces: Vec<&[u32]> = level.faces().collect();
    write::atomically(&arguments.output, |out| {
        write::surface(&extension, &points, &faces, out)
    })?;
    if figures.saturated_coordinates > 0 {
        eprintln!(
            "warning: {} out of range and clamped",
            count(figures.saturated_coordinates, "coordinate", "coordinates")
        );
    }
    print_figures(&figures, arguments.json, || {
        let mut text = format!("{} vertices, {} faces", figures.vertices, figures.faces);
        if let Some(bits) = figures.fraction_bits {
            text += &format!(", {bits} fraction bits");
        }
        text
    })
}

fn refine(
    mesh: &SurfaceMesh,
    scheme: SurfaceScheme,
    arguments: &Arguments,
) -> Result<(Vec<Point>, SurfaceLevel, Figures)> {
    let mut level = SurfaceLevel::new(mesh)?;
    let format = match arguments.fraction_bits {
        Some(fraction_bits) => Format { fraction_bits },
        None => Format::with_headroom(&mesh.points),
    };
    let is_fixed = arguments.numeric == Numeric::Fixed;
    let mut bits = if is_fixed {
        format.bits_of(&mesh.points, "vertex")?
    } else {
        Vec::new()
    };
    let mut points = mesh.points.clone();
    let mut fixed = FixedBlend::<i32, 3>::new();
    let mut progress = Bars::default();
    progress.stage("refining", arguments.levels as usize);
    for _ in 0..arguments.levels {
        let mut step = SurfaceStep::new(&level, scheme, arguments.rim);
        if is_fixed {
            bits = step.values(&mut fixed, &bits)?;
        } else {
            points = step.values(&mut RealBlend, &points)?;
        }
        let next = step.split()?;
        level = next;
        progress.step();
    }
    if arguments.limit {
        let mut step = SurfaceStep::new(&level, scheme, arguments.rim);
        if is_fixed {
            bits = step.limit(&mut fixed, &bits)?;
        } else {
            points = step.limit(&mut RealBlend, &points)?;
        }
    }
    progress.finish();
    if is_fixed {
        points = format.points_of(&bits);
    }
    let figures = Figures {
        levels: arguments.levels,
        vertices: points.len(),
        faces: level.mesh().face_count(),
        crease_edges: level.creases.len(),
        corners: level.corners.len(),
        fraction_bits: is_fixed.then_some(format.fraction_bits),
        saturated_coordinates: fixed.saturated() as usize,
    };
    Ok((points, level, figures))
}
