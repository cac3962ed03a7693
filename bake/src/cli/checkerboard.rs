//! `octruss checkerboard`.

use super::{print_figures, progress::Bars, show_notes};
use octruss_bake::bundle::cage_checksum;
use octruss_bake::error::{Error, Result, count};
use octruss_bake::mesh::{Point, SolidMesh};
use octruss_bake::progress::Progress;
use octruss_bake::read::motion;
use octruss_bake::refine::{BoundaryRule, Level, Scheme};
use octruss_bake::slice::{Deformed, Panel, Picture, Plane, draw};
use octruss_bake::{check, read, write};
use serde::Serialize;
use std::path::PathBuf;

/// Draws a cross-section of a posed cage, filled at rest with columns of two colours
///
/// The columns are square and stand on the plane. The left half shows the smooth map, of the cage refined so many times; the right one the map that
/// is linear in the tetrahedra, and bilinear or trilinear in the other cells, of the cage itself. Where a
/// map is smooth, so are the edges of the squares; where it is not, they have corners.
#[derive(clap::Args)]
pub struct Arguments {
    /// The cage at rest: Gmsh .msh, VTK .vtu or .vtk, Medit .mesh, TetGen .node with .ele
    cage: PathBuf,
    /// The pose: a mesh with the cage's connectivity; or a motion, of which --frame is drawn: a .csv
    /// with the columns frame, point, x, y, z, or a directory of numbered meshes
    #[arg(long, visible_alias = "motion", value_name = "POSE")]
    pose: PathBuf,
    /// The frame of a motion
    #[arg(long, value_name = "NUMBER", default_value_t = 0)]
    frame: u64,
    /// The plane a x + b y + c z = d through the posed solid: four numbers parted by commas
    #[arg(long, value_name = "A,B,C,D", value_parser = super::slice::numbers::<4>, allow_hyphen_values = true)]
    plane: [f64; 4],
    /// Width of a column, in the cage's unit; by default a sixteenth of the cut's width or height
    #[arg(long, value_name = "LENGTH")]
    square: Option<f64>,
    /// The subdivision scheme
    #[arg(long, value_enum, default_value_t)]
    scheme: Scheme,
    /// How many times to refine
    #[arg(long, value_name = "K", default_value_t = 3)]
    levels: u32,
    /// What the boundary follows: loop by default, with --scheme mixed tri-quad
    #[arg(long, value_enum)]
    boundary: Option<BoundaryRule>,
    /// File with features: a line each, `crease A B`, `crease-face A B C` or `corner A`
    #[arg(long, value_name = "FILE")]
    features: Option<PathBuf>,
    /// Width and height of each half in pixels
    #[arg(long, value_name = "PIXELS", default_value_t = 560, value_parser = clap::value_parser!(u32).range(200..=4000))]
    size: u32,
    /// The picture to write: .png
    #[arg(short, long, value_name = "OUT.png")]
    output: PathBuf,
    /// Print the figures as one JSON object
    #[arg(long)]
    json: bool,
}

/// What is printed.
#[derive(Serialize)]
struct Figures {
    levels: u32,
    square: f64,
    /// Places of the grid inside the smooth and inside the linear solid.
    smooth_places_inside: usize,
    linear_places_inside: usize,
}

/// Runs the command.
pub fn run(arguments: &Arguments) -> Result<()> {
    if read::extension(&arguments.output) != "png" {
        return Err(Error::new("a cross-section is drawn as .png")
            .advise("name the output with -o OUT.png")
            .in_file(&arguments.output));
    }
    let plane = Plane::new(arguments.plane)?;
    let mesh = read::solid_with_features(&arguments.cage, arguments.features.as_deref())?;
    show_notes(&mesh.notes);
    let boundary = arguments.scheme.boundary(arguments.boundary)?;
    let of_mesh = |error: Error| error.in_file(&arguments.cage);
    check::require_sound_connectivity(&mesh).map_err(of_mesh)?;
    let level = Level::of_scheme(&mesh, arguments.scheme, None).map_err(of_mesh)?;
    let posed = pose(arguments, &mesh)?;

    let mut progress = Bars::default();
    let linear = Deformed::new(&mesh, level, posed).map_err(of_mesh)?;
    let smooth = linear
        .refined(arguments.levels, boundary, &mut progress)
        .map_err(of_mesh)?;
    // The refined solid lies within the cage, or near it: one window for both halves.
    let window = linear.window(plane).map_err(of_mesh)?;
    let square = arguments.square.unwrap_or(window.side / 16.0);
    if !(square.is_finite() && square > 0.0) {
        return Err(Error::new("the length of a square is above zero")
            .advise("leave --square out for one that suits the cage"));
    }
    let grid = (arguments.size as usize, square);
    let smooth = smooth.checkerboard(plane, window, grid, &mut progress);
    let linear = linear.checkerboard(plane, window, grid, &mut progress);
    progress.finish();
    let picture = Picture {
        panels: vec![
            Panel::Checkerboard(
                format!("{}, level {}", arguments.scheme.name(), arguments.levels),
                &smooth,
            ),
            Panel::Checkerboard("linear in the cells of the cage".to_owned(), &linear),
        ],
        size: arguments.size,
    };
    let png = draw(&picture).map_err(of_mesh)?;
    write::atomically(&arguments.output, |out| {
        out.write_all(&png)
            .map_err(|error| Error::new(format!("cannot be written: {error}")))
    })?;
    let figures = Figures {
        levels: arguments.levels,
        square,
        smooth_places_inside: smooth.inside(),
        linear_places_inside: linear.inside(),
    };
    print_figures(&figures, arguments.json, || {
        let places = count(figures.smooth_places_inside, "place", "places");
        format!("squares of {square}, {places} inside the smooth solid")
    })
}

/// Where the control points are moved to.
fn pose(arguments: &Arguments, mesh: &SolidMesh) -> Result<Vec<Point>> {
    let checksum = |mesh: &SolidMesh| cage_checksum(mesh.points.len(), &mesh.cells);
    let require_cage = |pose: &SolidMesh| {
        if checksum(pose) == checksum(mesh) {
            return Ok(());
        }
        Err(
            Error::new("the mesh has not the connectivity of the cage").advise(
                "a pose is the cage itself with its vertices moved: same vertices, same cells, same order",
            ),
        )
    };
    let file = &arguments.pose;
    if !file.is_dir() && read::extension(file) != "csv" {
        let pose = read::solid(file)?;
        require_cage(&pose).map_err(|error| error.in_file(file))?;
        return Ok(pose.points);
    }
    let frames = motion::read(file, mesh.points.len(), &require_cage)?;
    let numbers = frames.iter().map(|frame| frame.number);
    let (first, last) = (numbers.clone().min(), numbers.max());
    let mut frames = frames.into_iter();
    let found = frames.find(|frame| frame.number == arguments.frame);
    found.map(|frame| frame.points).ok_or_else(|| {
        Error::new(format!("the motion has no frame {}", arguments.frame))
            .advise(format!(
                "its frames are numbered from {} to {}",
                first.unwrap_or_default(),
                last.unwrap_or_default()
            ))
            .in_file(file)
    })
}
