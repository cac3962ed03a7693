//! `octruss bake` of surfaces.

use super::bake::{Arguments, modes, regions, write_sources};
use super::{print_figures, progress::Bars, show_notes};
use octruss_bake::dynamics::Dynamics;
use octruss_bake::dynamics::springs::Pairs;
use octruss_bake::error::{Error, Result};
use octruss_bake::read;
use octruss_bake::surface::{SurfaceLevel, SurfaceScheme};
use octruss_bake::table::Request;
use octruss_bake::table::surface::{SurfaceOptions, bake_surface};
use octruss_bake::write::{self, Prepared};

/// Runs the command.
pub fn run(scheme: SurfaceScheme, arguments: &Arguments) -> Result<()> {
    if arguments.model.is_some() {
        return Err(Error::new(
            "--model is for cages of cells: a surface's model is the refined surface",
        )
        .advise("leave it out; --skin writes the refined surface"));
    }
    if arguments.actuators.is_some() {
        return Err(Error::new("--actuators is for cages of cells"));
    }
    if arguments.health {
        return Err(Error::new(
            "--health is for cages of cells; a control mesh has none",
        ));
    }
    if let Some(skin) = &arguments.skin {
        write::require_surface_extension(skin)?;
    }
    let mesh = read::surface_with_features(&arguments.cage, arguments.features.as_deref())?;
    show_notes(&mesh.notes);
    let options = SurfaceOptions {
        scheme,
        rim: arguments.rim,
        levels: arguments.levels,
        limit: arguments.limit,
        fraction_bits: arguments.fraction_bits,
        unit: arguments.unit.clone(),
        volumes: regions(arguments),
        centroid: arguments.centroid,
        modes: modes(arguments, mesh.points.len(), &|_| {
            Err(Error::new("the modes of a surface are read from a .csv"))
        })?,
        normals: arguments.normals,
        dynamics: Dynamics::read(arguments.dynamics(), mesh.points.len(), || {
            Ok(Pairs::of_faces(SurfaceLevel::new(&mesh)?.faces()))
        })?,
        request: Request {
            format: arguments.format,
            max_error: arguments.max_error,
            max_displacement: arguments.max_displacement,
            keep_order: arguments.keep_order,
            survey: true,
        },
        random_poses: arguments.random_poses,
        seed: arguments.seed,
    };
    let baked = bake_surface(&mesh, &options, &mut Bars::default())
        .map_err(|error| error.in_file(&arguments.cage))?;
    let skin = match &arguments.skin {
        None => None,
        Some(skin) => {
            let extension = read::extension(skin);
            let faces: Vec<&[u32]> = baked.level.faces().collect();
            Some(Prepared::new(skin, |out| {
                write::surface(&extension, &baked.points, &faces, out)
            })?)
        }
    };
    write_sources(&baked.bundle, arguments)?;
    skin.map_or(Ok(()), Prepared::publish)?;
    print_figures(&baked.report, arguments.json, || baked.report.to_string())
}
