//! `octruss refine`.

use super::scheme as schemes;
use super::{any_scheme::AnyScheme, print_figures, progress::Bars, refine_surface, show_notes};
use octruss_bake::check::{self, Volumes};
use octruss_bake::error::{Error, Result, count};
use octruss_bake::mesh::{Cells, Features, SolidMesh};
use octruss_bake::progress::Progress;
use octruss_bake::refine::{BoundaryRule, Channels, DiagonalLists, Level, Refinement, Scheme};
use octruss_bake::surface::RimRule;
use octruss_bake::table::format::{Format, MOST_FRACTION_BITS};
use octruss_bake::{read, write};
use serde::Serialize;
use std::path::PathBuf;

/// The numbers that a refinement is computed with.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Numeric {
    /// Double precision, not held to any grid
    F64,
    /// The device's fixed-point numbers, to the bit
    Fixed,
}

/// Refines a mesh and writes the refined one
///
/// The output is a solid as .vtu or .vtk (octahedra as polyhedra, all vertices in the refined order,
/// with the labels of cells and the scalar channels of vertices), or its boundary as .obj, .ply or
/// .off (triangles, quadrilaterals and their vertices, in the refined order). None holds creases and corners:
/// refine once with all the levels wanted. A surface is written with all its polygons as .obj, .ply
/// or .off; crease tags of .obj files are read as OpenSubdiv writes them.
#[derive(clap::Args)]
pub struct Arguments {
    /// The mesh: Gmsh .msh, VTK .vtu or .vtk, Medit .mesh, TetGen .node with .ele; a surface's
    /// control mesh: .obj, .ply, .stl or .off
    pub mesh: PathBuf,
    /// The subdivision scheme: of solids (tet-oct and so on) or of surfaces
    #[arg(long, value_enum, default_value_t)]
    scheme: AnyScheme,
    /// File with the major diagonals of the cells, for `box-spline`: 0, 1 or 2 for each
    /// tetrahedron, then each octahedron, in file order; by default they are chosen
    #[arg(long, value_name = "FILE")]
    diagonals: Option<PathBuf>,
    /// How many times to refine; a level has about eight times the cells of the one before
    #[arg(long, value_name = "K", default_value_t = 1)]
    pub levels: u32,
    /// What the boundary of a solid follows: loop by default, with --scheme mixed tri-quad
    #[arg(long, value_enum)]
    boundary: Option<BoundaryRule>,
    /// What the rim of an open surface follows
    #[arg(long, value_enum, default_value_t)]
    pub rim: RimRule,
    /// Surfaces: move the vertices of the last level to where they go in the limit, and write the limit's normals
    /// there: in an .obj for every corner of a face (a crease has two sides), in a .ply for every vertex; not for
    /// sqrt3 and the butterflies. Of doo-sabin the faces' centres are written, as the dual mesh
    #[arg(long)]
    pub limit: bool,
    /// The numbers to compute with
    #[arg(long, value_enum, default_value = "f64")]
    pub numeric: Numeric,
    /// With --numeric fixed: bits after the point of the 32-bit coordinates, 0 to 32; by default as
    /// many as leave two bits of headroom over the mesh's largest coordinate
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(0..=i64::from(MOST_FRACTION_BITS)))]
    pub fraction_bits: Option<u32>,
    /// File with features: a line each, `crease A B`, `crease-face A B C` or `corner A`
    #[arg(long, value_name = "FILE")]
    pub features: Option<PathBuf>,
    /// The file to write: .vtu, .vtk, .obj, .ply or .off; for surfaces .obj, .ply or .off
    #[arg(short, long, value_name = "OUT")]
    pub output: PathBuf,
    /// Print the figures as one JSON object
    #[arg(long)]
    pub json: bool,
}

/// What is printed.
#[derive(Serialize)]
struct Figures {
    levels: u32,
    vertices: usize,
    tetrahedra: usize,
    octahedra: usize,
    prisms: usize,
    hexahedra: usize,
    boundary_triangles: usize,
    boundary_quadrilaterals: usize,
    sheet_triangles: usize,
    cells_without_volume: usize,
    /// Of `--numeric fixed`.
    fraction_bits: Option<u32>,
    saturated_coordinates: usize,
}

/// Runs the command.
pub fn run(arguments: &Arguments) -> Result<()> {
    match arguments.scheme {
        AnyScheme::Surface(scheme) => refine_surface::run(scheme, arguments),
        AnyScheme::Solid(scheme) => refine_solid(scheme, arguments),
    }
}

fn refine_solid(scheme: Scheme, arguments: &Arguments) -> Result<()> {
    if arguments.limit {
        return Err(Error::new("--limit is for schemes of surfaces"));
    }
    let extension = read::extension(&arguments.output);
    let is_solid = write::SOLID_EXTENSIONS.contains(&extension.as_str());
    if !is_solid && !write::SURFACE_EXTENSIONS.contains(&extension.as_str()) {
        return Err(Error::new(format!("no writer for \".{extension}\" files"))
            .advise(
                "a refined solid is written as .vtu or .vtk, its boundary as .obj, .ply or .off",
            )
            .in_file(&arguments.output));
    }
    let mesh = read::solid_with_features(&arguments.mesh, arguments.features.as_deref())?;
    show_notes(&mesh.notes);
    let diagonals = schemes::diagonals(scheme, arguments.diagonals.as_deref(), &mesh)?;
    schemes::warn_of_improper_faces(&mesh, scheme, diagonals.as_ref())
        .map_err(|error| error.in_file(&arguments.mesh))?;
    let (refined, level, figures) = refine(mesh, scheme, diagonals.as_ref(), arguments)
        .map_err(|error| error.in_file(&arguments.mesh))?;
    write::atomically(&arguments.output, |out| {
        if is_solid {
            write::solid(&extension, &refined, out)
        } else {
            write::boundary(&extension, &refined.points, &level.skin(), out)
        }
    })?;
    if figures.cells_without_volume > 0 {
        eprintln!(
            "warning: {} refined cells have no positive volume",
            figures.cells_without_volume
        );
    }
    if figures.saturated_coordinates > 0 {
        eprintln!(
            "warning: {} out of range and clamped",
            count(figures.saturated_coordinates, "coordinate", "coordinates")
        );
    }
    print_figures(&figures, arguments.json, || words(&figures, &refined.cells))
}

fn refine(
    mesh: SolidMesh,
    scheme: Scheme,
    diagonals: Option<&DiagonalLists>,
    arguments: &Arguments,
) -> Result<(SolidMesh, Level, Figures)> {
    check::require_sound_connectivity(&mesh)?;
    let boundary = scheme.boundary(arguments.boundary)?.to_core();
    let mut level = Level::of_scheme(&mesh, scheme, diagonals)?;
    level.require_levels(arguments.levels)?;
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
    let mut channels = if is_fixed {
        Channels::fixed(&mesh.channels)?
    } else {
        Channels::real(&mesh.channels)
    };
    let (mut points, mut saturated, mut labels) = (mesh.points, 0, mesh.labels);
    let mut progress = Bars::default();
    progress.stage("refining", arguments.levels as usize);
    for _ in 0..arguments.levels {
        let mut step = Refinement::new(&level, boundary)?;
        if is_fixed {
            bits = step.bits(&bits, &mut saturated)?;
        } else {
            points = step.points(&points)?;
        }
        channels.refine(&mut step, &mut saturated)?;
        labels = labels.refined();
        level = step.split()?;
        progress.step();
    }
    progress.finish();
    if is_fixed {
        points = format.points_of(&bits);
    }
    let refined = SolidMesh {
        points,
        cells: level.cells.clone(),
        features: Features {
            creases: level.creases.clone(),
            corners: level.corners.clone(),
            faces: level.crease_faces().to_vec(),
            sheets: level.sheets().to_vec(),
            quads: level.crease_quads().to_vec(),
        },
        labels,
        channels: channels.values(),
        notes: Vec::new(),
    };
    let volumes = Volumes::of(&refined.cells, &refined.points);
    let figures = Figures {
        levels: arguments.levels,
        vertices: refined.points.len(),
        tetrahedra: level.cells.tetrahedra.len(),
        octahedra: level.cells.octahedra.len(),
        prisms: level.cells.prisms.len(),
        hexahedra: level.cells.hexahedra.len(),
        boundary_triangles: level.boundary().len(),
        boundary_quadrilaterals: level.boundary_quads().len(),
        sheet_triangles: level.sheets().len(),
        cells_without_volume: volumes.inverted.len() + volumes.flat.len() + volumes.folded.len(),
        fraction_bits: is_fixed.then_some(format.fraction_bits),
        saturated_coordinates: saturated,
    };
    Ok((refined, level, figures))
}

fn words(figures: &Figures, cells: &Cells) -> String {
    let mut text = format!(
        "{} vertices, {}, {} boundary triangles",
        figures.vertices,
        cells.words(),
        figures.boundary_triangles
    );
    if figures.boundary_quadrilaterals > 0 {
        text += &format!(
            ", {} boundary quadrilaterals",
            figures.boundary_quadrilaterals
        );
    }
    if figures.sheet_triangles > 0 {
        text += &format!(", {} triangles of sheets", figures.sheet_triangles);
    }
    if let Some(bits) = figures.fraction_bits {
        text += &format!(", {bits} fraction bits");
    }
    text
}
