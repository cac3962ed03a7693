//! `octruss refine` of surfaces.

use super::refine::{Arguments, Numeric};
use super::{print_figures, progress::Bars, show_notes};
use octruss::blend::FixedBlend;
use octruss::deform::NORMAL_BITS;
use octruss::surface::limit_normals::FixedTangents;
use octruss_bake::error::{Result, count};
use octruss_bake::mesh::Point;
use octruss_bake::progress::Progress;
use octruss_bake::refine::RealBlend;
use octruss_bake::surface::{RealTangents, SurfaceLevel, SurfaceMesh, SurfaceScheme, SurfaceStep};
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
    /// Of `--limit`, where the scheme has normals.
    corners_without_normal: Option<usize>,
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
    let refined =
        refine(&mesh, scheme, arguments).map_err(|error| error.in_file(&arguments.mesh))?;
    let figures = refined.figures;
    let faces: Vec<&[u32]> = refined.level.faces().collect();
    write::atomically(&arguments.output, |out| {
        let normals = refined.normals.as_deref();
        write::surface_with_normals(&extension, &refined.points, normals, &faces, out)
    })?;
    if let Some(zeros) = figures.corners_without_normal.filter(|zeros| *zeros > 0) {
        eprintln!(
            "warning: {} without a normal: the surface has no tangent plane there",
            count(zeros, "corner of a face is", "corners of faces are")
        );
    }
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

/// What is written and printed.
struct Refined {
    points: Vec<Point>,
    /// One for each corner of each face.
    normals: Option<Vec<Point>>,
    level: SurfaceLevel,
    figures: Figures,
}

/// The numbers that a refinement is computed with, and its values.
enum Values {
    Real(Vec<Point>),
    Fixed {
        bits: Vec<[i32; 3]>,
        format: Format,
        blend: FixedBlend<i32, 3>,
    },
}

impl Values {
    fn new(mesh: &SurfaceMesh, arguments: &Arguments) -> Result<Self> {
        if arguments.numeric != Numeric::Fixed {
            return Ok(Self::Real(mesh.points.clone()));
        }
        let format = match arguments.fraction_bits {
            Some(fraction_bits) => Format { fraction_bits },
            None => Format::with_headroom(&mesh.points),
        };
        Ok(Self::Fixed {
            bits: format.bits_of(&mesh.points, "vertex")?,
            format,
            blend: FixedBlend::new(),
        })
    }

    /// Goes one level on.
    fn refine(&mut self, step: &mut SurfaceStep<'_>) -> Result<()> {
        match self {
            Self::Real(points) => *points = step.values(&mut RealBlend, points)?,
            Self::Fixed { bits, blend, .. } => *bits = step.values(blend, bits)?,
        }
        Ok(())
    }

    /// Goes to the limit, at vertices or, of Doo-Sabin surfaces, at faces.
    fn move_to_limit(&mut self, step: &mut SurfaceStep<'_>, of_faces: bool) -> Result<()> {
        match self {
            Self::Real(points) if of_faces => *points = step.face_limit(&mut RealBlend, points)?,
            Self::Real(points) => *points = step.limit(&mut RealBlend, points)?,
            Self::Fixed { bits, blend, .. } if of_faces => *bits = step.face_limit(blend, bits)?,
            Self::Fixed { bits, blend, .. } => *bits = step.limit(blend, bits)?,
        }
        Ok(())
    }

    /// Limit normals, where the scheme has such.
    fn normals(&self, step: &mut SurfaceStep<'_>) -> Result<Option<Vec<Point>>> {
        let one = f64::from(1 << NORMAL_BITS);
        Ok(match self {
            Self::Real(points) => step.normals(&mut RealTangents, points)?,
            Self::Fixed { bits, .. } => {
                step.normals(&mut FixedTangents::<i32>::new(), bits)?
                    .map(|normals| {
                        let real = |normal: [i16; 3]| normal.map(|x| f64::from(x) / one);
                        normals.into_iter().map(real).collect()
                    })
            }
        })
    }
}

fn refine(mesh: &SurfaceMesh, scheme: SurfaceScheme, arguments: &Arguments) -> Result<Refined> {
    let mut level = SurfaceLevel::new(mesh)?;
    let mut values = Values::new(mesh, arguments)?;
    let mut progress = Bars::default();
    progress.stage("refining", arguments.levels as usize);
    for _ in 0..arguments.levels {
        let mut step = SurfaceStep::new(&level, scheme, arguments.rim);
        values.refine(&mut step)?;
        let next = step.split()?;
        level = next;
        progress.step();
    }
    let mut normals = None;
    if arguments.limit {
        let mut step = SurfaceStep::new(&level, scheme, arguments.rim);
        normals = values.normals(&mut step)?;
        let of_faces = scheme == SurfaceScheme::DooSabin;
        values.move_to_limit(&mut step, of_faces)?;
        if of_faces {
            // Limit positions are the faces' centres: vertices of the dual mesh.
            let dual = level.dual();
            normals = normals.map(|of_faces| {
                let corners = dual.faces().flatten();
                corners.map(|face| of_faces[*face as usize]).collect()
            });
            level = dual;
        }
    }
    progress.finish();
    let (points, fraction_bits, saturated) = match values {
        Values::Real(points) => (points, None, 0),
        Values::Fixed {
            bits,
            format,
            blend,
        } => (
            format.points_of(&bits),
            Some(format.fraction_bits),
            blend.saturated() as usize,
        ),
    };
    let zero = |normal: &&Point| **normal == [0.0; 3];
    let figures = Figures {
        levels: arguments.levels,
        vertices: points.len(),
        faces: level.mesh().face_count(),
        crease_edges: level.creases.len(),
        corners: level.corners.len(),
        corners_without_normal: normals.as_ref().map(|all| all.iter().filter(zero).count()),
        fraction_bits,
        saturated_coordinates: saturated,
    };
    Ok(Refined {
        points,
        normals,
        level,
        figures,
    })
}
