//! `octruss bake`.

use super::scheme as schemes;
use super::{
    any_scheme::AnyScheme, bake_surface, print_figures, progress::Bars, show_notes, source,
};
use octruss_bake::dynamics::springs::Pairs;
use octruss_bake::dynamics::{self, Dynamics};
use octruss_bake::error::{Error, Result, count};
use octruss_bake::inspect::{interior_edges_of_valence_3, irregular_boundary_edges};
use octruss_bake::mesh::{Point, SolidMesh};
use octruss_bake::read::motion;
use octruss_bake::refine::{BoundaryRule, Scheme};
use octruss_bake::surface::RimRule;
use octruss_bake::table::format::MOST_FRACTION_BITS;
use octruss_bake::table::inverse::{SolverReport, Solvers};
use octruss_bake::table::{Input, Options, Outside, Region, Request, TableFormat, bake};
use octruss_bake::write::Prepared;
use octruss_bake::{check, read};
use std::path::PathBuf;

/// Bakes a deformation table and writes it as a bundle
///
/// The cage at rest is refined, every point of the model is located in a refined cell, and its
/// weights there are carried back to the cage's vertices. The bundle holds the weights as integers
/// that sum to one, the cage and the model at rest, and what is needed to know that it fits. The
/// report says how large it is and how far its results can be from the smooth map. Of a surface the
/// table moves every vertex of the refined control mesh.
#[derive(clap::Args)]
pub struct Arguments {
    /// The cage at rest: Gmsh .msh, VTK .vtu or .vtk, Medit .mesh, TetGen .node with .ele; a surface's
    /// control mesh: .obj, .ply, .stl or .off
    pub cage: PathBuf,
    /// The model at rest, in the cage's unit: .obj, .ply, .stl or .off; not for surfaces, whose model is
    /// the refined surface
    #[arg(long, value_name = "MODEL")]
    pub model: Option<PathBuf>,
    /// The subdivision scheme: of solids (tet-oct and so on) or of surfaces
    #[arg(long, value_enum, default_value_t)]
    scheme: AnyScheme,
    /// What the rim of an open surface follows
    #[arg(long, value_enum, default_value_t)]
    pub rim: RimRule,
    /// Surfaces: bake where the vertices of the last level go in the limit
    #[arg(long)]
    pub limit: bool,
    /// Surfaces: also write the refined surface at rest, the model of `octruss deform`: .obj,
    /// .ply or .off
    #[arg(long, value_name = "OUT")]
    pub skin: Option<PathBuf>,
    /// File with the major diagonals of the cage's cells, for `box-spline`: 0, 1 or 2 for each
    /// tetrahedron, then each octahedron, in file order; by default they are chosen
    #[arg(long, value_name = "FILE")]
    diagonals: Option<PathBuf>,
    /// How many times to refine the cage
    #[arg(long, value_name = "K", default_value_t = 2)]
    pub levels: u32,
    /// What the boundary of a solid follows: loop by default, with --scheme mixed tri-quad
    #[arg(long, value_enum)]
    boundary: Option<BoundaryRule>,
    /// Bits after the point of the 32-bit coordinates, 0 to 32; by default as many as leave two
    /// bits of headroom over the largest coordinate of cage and model
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(0..=i64::from(MOST_FRACTION_BITS)))]
    pub fraction_bits: Option<u32>,
    /// Name of the unit of all coordinates, such as mm; at most 16 bytes; it is recorded, nothing
    /// is converted
    #[arg(long, value_name = "UNIT", default_value = "")]
    pub unit: String,
    /// File with features of the cage: a line each, `crease A B`, `crease-face A B C` (solids) or
    /// `corner A`
    #[arg(long, value_name = "FILE")]
    pub features: Option<PathBuf>,
    /// How the table is stored: see the report for what each format costs; by default q30, or what
    /// --max-error chooses
    #[arg(long, value_enum, value_name = "FORMAT")]
    pub format: Option<TableFormat>,
    /// Take the cheapest format whose proved error is at most this, in the model's unit
    #[arg(long, value_name = "ERROR")]
    pub max_error: Option<f64>,
    /// The farthest that a control point moves along an axis, in the cage's unit: what errors are proved
    /// for, and what 16-bit displacements must hold; by default the cage's largest extent
    #[arg(long, value_name = "DISTANCE")]
    pub max_displacement: Option<f64>,
    /// Keep the rows in the order of the model's points, which costs time and flash
    #[arg(long)]
    pub keep_order: bool,
    /// What to do with model points outside the refined cage
    #[arg(long, value_enum, default_value_t)]
    outside: Outside,
    /// Also bake the volume that the cage's smooth boundary encloses, as one form over its control
    /// points, exact or extrapolated; or with --volume=LABEL that of the cells with a label.
    /// May be given several times
    #[arg(long, value_name = "LABEL", num_args = 0..=1, require_equals = true, default_missing_value = "0", allow_hyphen_values = true)]
    volume: Vec<i32>,
    /// With --volume: also bake the volumes as polynomials of the amplitudes of modes; with --actuators: the
    /// modes that actuators drive; a .csv or a folder like that of a motion, in which every frame is the pose of one
    /// mode at amplitude one
    #[arg(long, value_name = "MODES")]
    modes: Option<PathBuf>,
    /// With --modes: also bake the centroids of those volumes, for at most 16 modes
    #[arg(long, requires = "modes")]
    pub centroid: bool,
    /// With --modes: also bake a solver that brings points to their goals by these amplitudes; a .csv with the columns
    /// actuator (the mode, counted from 0), lower, upper (bounds), rate (a tick's greatest step, or inf)
    #[arg(long, value_name = "ACTUATORS.csv", requires = "modes")]
    pub actuators: Option<PathBuf>,
    /// The points of the model that have goals: a .csv with the columns point (counted from 0) and weight
    #[arg(long, value_name = "EFFECTORS.csv", requires = "actuators")]
    effectors: Option<PathBuf>,
    /// The points of the model that are measured, for a solver that tells the amplitudes from them: a .csv like that of
    /// --effectors
    #[arg(long, value_name = "SENSORS.csv", requires = "actuators")]
    sensors: Option<PathBuf>,
    /// What the square of an amplitude costs, as a part of what the square of the strongest mode's displacement does
    #[arg(
        long,
        value_name = "PART",
        default_value_t = 1e-4,
        requires = "actuators"
    )]
    damping: f64,
    /// Also bake a skeleton that carries the control points: a file of joints, axes and weights
    #[arg(long, value_name = "FILE")]
    pub rig: Option<PathBuf>,
    /// Also bake damped springs between the control points: a file of stiffness, masses and pinned vertices
    #[arg(long, value_name = "FILE")]
    pub springs: Option<PathBuf>,
    /// Also bake limits of poses, which a projection keeps: a file of pins, boxes, speeds and mobilities
    #[arg(long, value_name = "FILE")]
    pub limits: Option<PathBuf>,
    /// Also bake the cage's cells, from which a device tells whether a pose folds over them
    #[arg(long)]
    pub health: bool,
    /// Also bake the model's faces, from which a device forms the normals of the deformed points
    #[arg(long)]
    pub normals: bool,
    /// Where the random poses start from on which the error is measured
    #[arg(long, value_name = "NUMBER", default_value_t = 0)]
    pub seed: u64,
    /// How many random poses to measure the error on
    #[arg(long, value_name = "NUMBER", default_value_t = 4)]
    pub random_poses: u32,
    /// The bundle to write
    #[arg(short, long, value_name = "OUT.oct")]
    output: PathBuf,
    /// Also write Rust source that holds the bundle, to include in firmware
    #[arg(long, value_name = "OUT.rs")]
    rust: Option<PathBuf>,
    /// Also write C source that holds the bundle, to include in firmware
    #[arg(long, value_name = "OUT.c")]
    c: Option<PathBuf>,
    /// Print the report as one JSON object
    #[arg(long)]
    pub json: bool,
}

/// Runs the command.
pub fn run(arguments: &Arguments) -> Result<()> {
    match arguments.scheme {
        AnyScheme::Surface(scheme) => bake_surface::run(scheme, arguments),
        AnyScheme::Solid(scheme) => bake_solid(scheme, arguments),
    }
}

fn bake_solid(scheme: Scheme, arguments: &Arguments) -> Result<()> {
    if arguments.limit || arguments.skin.is_some() {
        return Err(Error::new("--limit and --skin are for schemes of surfaces"));
    }
    let Some(model_file) = &arguments.model else {
        return Err(Error::new("--model <MODEL> is missing")
            .advise("name the model that the cage shall move; only surfaces have their own"));
    };
    let cage = read::solid_with_features(&arguments.cage, arguments.features.as_deref())?;
    show_notes(&cage.notes);
    warn_of_cage(&cage, scheme).map_err(|error| error.in_file(&arguments.cage))?;
    let model = read::model(model_file)?;
    let diagonals = schemes::diagonals(scheme, arguments.diagonals.as_deref(), &cage)?;
    schemes::warn_of_improper_faces(&cage, scheme, diagonals.as_ref())
        .map_err(|error| error.in_file(&arguments.cage))?;
    let options = Options {
        scheme,
        diagonals,
        boundary: scheme.boundary(arguments.boundary)?,
        levels: arguments.levels,
        fraction_bits: arguments.fraction_bits,
        unit: arguments.unit.clone(),
        outside: arguments.outside,
        volumes: regions(arguments),
        centroid: arguments.centroid,
        modes: modes(arguments, cage.points.len(), &|mesh| {
            require_same_cells(&cage, mesh)
        })?,
        faces: arguments.normals.then(|| model.faces.clone()),
        solvers: Solvers::default(),
        dynamics: Dynamics {
            cells: arguments.health.then(|| cage.cells.clone()),
            ..Dynamics::read(arguments.dynamics(), cage.points.len(), || {
                Ok(Pairs::of_cells(&cage.cells))
            })?
        },
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
    let input = Input {
        cage: &cage,
        cage_file: &arguments.cage,
        model: &model.points,
        model_file,
    };
    let options = Options {
        solvers: solvers(arguments, model.points.len(), options.modes.len())?,
        ..options
    };
    let baked = bake(input, &options, &mut Bars::default())?;
    warn_of_dependent_modes(&baked.report.solvers);
    write_sources(&baked.bundle, arguments)?;
    if baked.report.refined_cells_without_volume > 0 {
        eprintln!(
            "warning: {} of the cage at rest without positive volume: the map folds there",
            count(
                baked.report.refined_cells_without_volume,
                "refined cell",
                "refined cells"
            )
        );
    }
    print_figures(&baked.report, arguments.json, || baked.report.to_string())
}

impl Arguments {
    /// The files of what moves the control points.
    pub fn dynamics(&self) -> dynamics::Files<'_> {
        dynamics::Files {
            rig: self.rig.as_deref(),
            springs: self.springs.as_deref(),
            limits: self.limits.as_deref(),
        }
    }
}

/// The regions whose volumes are asked for.
pub fn regions(arguments: &Arguments) -> Vec<Region> {
    let region = |label: &i32| match label {
        0 => Region::Whole,
        label => Region::Label(*label),
    };
    arguments.volume.iter().map(region).collect()
}

/// The poses of modes at amplitude one.
pub fn modes(
    arguments: &Arguments,
    control_points: usize,
    check: &dyn Fn(&SolidMesh) -> Result<()>,
) -> Result<Vec<Vec<Point>>> {
    let Some(file) = &arguments.modes else {
        return Ok(Vec::new());
    };
    if arguments.volume.is_empty() && arguments.actuators.is_none() {
        return Err(
            Error::new("--modes is given, but nothing to bake for the modes")
                .advise("give --volume, --actuators or both"),
        );
    }
    let frames = motion::read(file, control_points, check)?;
    Ok(frames.into_iter().map(|frame| frame.points).collect())
}

/// The solvers that are asked for.
fn solvers(arguments: &Arguments, points: usize, modes: usize) -> Result<Solvers> {
    let Some(file) = &arguments.actuators else {
        return Ok(Solvers::default());
    };
    if arguments.effectors.is_none() && arguments.sensors.is_none() {
        return Err(Error::new("--actuators needs points to solve for")
            .advise("give --effectors, --sensors or both"));
    }
    if !(0.0..1.0).contains(&arguments.damping) {
        return Err(
            Error::new(format!("--damping {} is no part", arguments.damping))
                .advise("take a number from 0 to below 1, such as 1e-4"),
        );
    }
    let of = |file: &Option<PathBuf>| match file {
        None => Ok(Vec::new()),
        Some(file) => read::control::effectors(file, points),
    };
    Ok(Solvers {
        actuators: read::control::actuators(file, modes)?,
        effectors: of(&arguments.effectors)?,
        sensors: of(&arguments.sensors)?,
        damping: arguments.damping,
    })
}

fn warn_of_dependent_modes(reports: &[SolverReport]) {
    for report in reports.iter().filter(|report| report.is_dependent()) {
        let what = if report.sensors {
            "sensors"
        } else {
            "effectors"
        };
        eprintln!(
            "warning: mode {} (counted from 0) moves the {what} almost as the modes before it do: only --damping decides between them",
            report.most_dependent
        );
    }
}

fn require_same_cells(cage: &SolidMesh, pose: &SolidMesh) -> Result<()> {
    if pose.points.len() == cage.points.len() && pose.cells == cage.cells {
        return Ok(());
    }
    Err(
        Error::new("the pose of a mode has another connectivity than the cage")
            .advise("a mode is the cage with its vertices moved"),
    )
}

/// Warns of what a map can be built on, but had better not. Error if the connectivity is none of a
/// solid.
fn warn_of_cage(cage: &SolidMesh, scheme: Scheme) -> Result<()> {
    check::require_sound_connectivity(cage)?;
    let unused = check::unused_vertices(cage);
    if let Some(first) = unused.first() {
        eprintln!(
            "warning: {} of the cage in no cell, which {} nothing, first vertex {first}",
            count(unused.len(), "vertex", "vertices"),
            if unused.len() == 1 { "moves" } else { "move" }
        );
    }
    let edges = match scheme {
        Scheme::TetOct => interior_edges_of_valence_3(cage)?,
        _ => Vec::new(),
    };
    if !edges.is_empty() {
        eprintln!(
            "warning: {} of three cells, along which the map is not smooth; `octruss info` names them",
            count(edges.len(), "interior edge", "interior edges")
        );
    }
    let touching = irregular_boundary_edges(cage)?;
    if let Some([a, b]) = touching.first() {
        eprintln!(
            "warning: the boundary touches itself at {}, first from vertex {a} to vertex {b} (counted from 0): other than two boundary faces meet there",
            count(touching.len(), "edge", "edges")
        );
    }
    Ok(())
}

/// Writes the bundle, and the sources that hold it.
pub fn write_sources(bundle: &[u8], arguments: &Arguments) -> Result<()> {
    // All or none: old sources beside a new bundle would be another table.
    let mut prepared = Vec::new();
    if let Some(file) = &arguments.rust {
        prepared.push(Prepared::new(file, |out| {
            source::rust(bundle, &arguments.output, out)
        })?);
    }
    if let Some(file) = &arguments.c {
        prepared.push(Prepared::new(file, |out| {
            source::c(bundle, &arguments.output, out)
        })?);
    }
    prepared.push(Prepared::new(&arguments.output, |out| {
        out.write_all(bundle)
            .map_err(|error| Error::new(format!("cannot be written: {error}")))
    })?);
    prepared.into_iter().try_for_each(Prepared::publish)
}
