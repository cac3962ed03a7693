//! `octruss slice`.

use super::{print_figures, progress::Bars, scheme, show_notes};
use octruss_bake::error::{Error, Result, count};
use octruss_bake::mesh::{Point, SolidMesh};
use octruss_bake::progress::Progress;
use octruss_bake::refine::{BoundaryRule, Level, Scheme};
use octruss_bake::slice::{Field, Picture, Plane, Profile, central_differences, draw};
use octruss_bake::{check, read, write};
use serde::Serialize;
use std::path::PathBuf;

/// Draws a cross-section of a refined cage and of values that belong to its vertices
///
/// The picture shows, side by side, the values on a plane (dark to bright), lines of equal value,
/// and with --line the values along a line beside their linear interpolation in the cells of the
/// cage. Values are refined by the masks that refine positions.
#[derive(clap::Args)]
pub struct Arguments {
    /// The cage: Gmsh .msh, VTK .vtu or .vtk, Medit .mesh, TetGen .node with .ele
    mesh: PathBuf,
    /// The plane a x + b y + c z = d: four numbers parted by commas
    #[arg(long, value_name = "A,B,C,D", value_parser = numbers::<4>, allow_hyphen_values = true)]
    plane: [f64; 4],
    /// File with a value for each vertex of the cage, in file order
    #[arg(long, value_name = "FILE", required_unless_present = "basis")]
    channel: Option<PathBuf>,
    /// Instead of a file: the basis function of a vertex, one there and zero at all others
    #[arg(long, value_name = "VERTEX", conflicts_with = "channel")]
    basis: Option<usize>,
    /// The subdivision scheme
    #[arg(long, value_enum, default_value_t)]
    scheme: Scheme,
    /// File with the major diagonals of the cells, for `box-spline`: 0, 1 or 2 for each
    /// tetrahedron, then each octahedron, in file order; by default they are chosen
    #[arg(long, value_name = "FILE")]
    diagonals: Option<PathBuf>,
    /// How many times to refine
    #[arg(long, value_name = "K", default_value_t = 3)]
    levels: u32,
    /// What the boundary follows
    #[arg(long, value_enum, default_value_t)]
    boundary: BoundaryRule,
    /// File with features: a line each, `crease A B`, `crease-face A B C` or `corner A`
    #[arg(long, value_name = "FILE")]
    features: Option<PathBuf>,
    /// How many lines of equal value to draw
    #[arg(long, value_name = "NUMBER", default_value_t = 12)]
    isolines: usize,
    /// Also plot the values along the line from one point to another: six numbers parted by commas
    #[arg(long, value_name = "X,Y,Z,X,Y,Z", value_parser = numbers::<6>, allow_hyphen_values = true)]
    line: Option<[f64; 6]>,
    /// How many points to look at along the line, both ends included
    #[arg(long, value_name = "NUMBER", default_value_t = 257, value_parser = clap::value_parser!(u32).range(2..=100_000))]
    samples: u32,
    /// With --line: also plot the derivative along the line, by central differences of the samples
    #[arg(long, requires = "line")]
    derivative: bool,
    /// Width and height of each panel in pixels
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
    /// Least and greatest value on the cut.
    least: f64,
    greatest: f64,
    grid_points_inside: usize,
    /// Values along the line, `null` outside the solid.
    #[serde(skip_serializing_if = "Option::is_none")]
    line: Option<LineFigures>,
}

#[derive(Serialize)]
struct LineFigures {
    refined: Vec<Option<f64>>,
    linear: Vec<Option<f64>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    derivative: Option<Vec<Option<f64>>>,
}

/// Runs the command.
pub fn run(arguments: &Arguments) -> Result<()> {
    if read::extension(&arguments.output) != "png" {
        return Err(Error::new("a cross-section is drawn as .png")
            .advise("name the output with -o OUT.png")
            .in_file(&arguments.output));
    }
    let plane = Plane::new(arguments.plane)?;
    let mesh = read::solid_with_features(&arguments.mesh, arguments.features.as_deref())?;
    show_notes(&mesh.notes);
    let values = values(arguments, &mesh)?;
    let diagonals = scheme::diagonals(arguments.scheme, arguments.diagonals.as_deref(), &mesh)?;
    let of_mesh = |error: Error| error.in_file(&arguments.mesh);
    check::require_sound_connectivity(&mesh).map_err(of_mesh)?;
    scheme::warn_of_improper_faces(&mesh, arguments.scheme, diagonals.as_ref()).map_err(of_mesh)?;
    let level = Level::of_scheme(&mesh, arguments.scheme, diagonals.as_ref()).map_err(of_mesh)?;

    let mut progress = Bars::default();
    let cage = Field::new(&mesh, level, values).map_err(of_mesh)?;
    let refined = cage
        .refined(arguments.levels, arguments.boundary, &mut progress)
        .map_err(of_mesh)?;
    let cut = refined
        .cut(plane, arguments.size as usize, &mut progress)
        .map_err(of_mesh)?;
    progress.finish();
    let profile = profile(arguments, &cage, &refined);
    let picture = Picture {
        cut: &cut,
        isolines: arguments.isolines,
        profile,
        size: arguments.size,
    };
    let png = draw(&picture).map_err(of_mesh)?;
    write::atomically(&arguments.output, |out| {
        out.write_all(&png)
            .map_err(|error| Error::new(format!("cannot be written: {error}")))
    })?;
    let [least, greatest] = cut.range().unwrap_or_default();
    let figures = Figures {
        levels: arguments.levels,
        least,
        greatest,
        grid_points_inside: cut.inside(),
        line: picture.profile.map(|profile| LineFigures {
            refined: profile.refined,
            linear: profile.linear,
            derivative: profile.derivative,
        }),
    };
    print_figures(&figures, arguments.json, || {
        format!(
            "values from {least} to {greatest} at {}",
            count(figures.grid_points_inside, "grid point", "grid points")
        )
    })
}

/// So many numbers parted by commas.
fn numbers<const N: usize>(text: &str) -> std::result::Result<[f64; N], String> {
    let words = text.split(',').map(|word| word.trim().parse::<f64>());
    let numbers: Vec<f64> = words
        .collect::<std::result::Result<_, _>>()
        .map_err(|error| error.to_string())?;
    if !numbers.iter().all(|number| number.is_finite()) {
        return Err("not all of the numbers are finite".to_owned());
    }
    let given = numbers.len();
    numbers
        .try_into()
        .map_err(|_| format!("expected {N} numbers parted by commas, found {given}"))
}

fn values(arguments: &Arguments, mesh: &SolidMesh) -> Result<Vec<f64>> {
    if let Some(file) = &arguments.channel {
        return read::channel::read(&read::bytes(file)?, mesh.points.len())
            .map_err(|error| error.in_file(file));
    }
    let mut values = vec![0.0; mesh.points.len()];
    let vertex = arguments.basis.unwrap_or_default();
    match values.get_mut(vertex) {
        Some(value) => *value = 1.0,
        None => {
            return Err(Error::new(format!(
                "there is no vertex {vertex}; the mesh has {}",
                values.len()
            ))
            .advise("vertices are counted from 0 in the order of the mesh file")
            .in_file(&arguments.mesh));
        }
    }
    Ok(values)
}

fn profile(arguments: &Arguments, cage: &Field, refined: &Field) -> Option<Profile> {
    let [a, b, c, d, e, f] = arguments.line?;
    let (from, to): (Point, Point) = ([a, b, c], [d, e, f]);
    let squares = (0..3).map(|k| (to[k] - from[k]).powi(2));
    let length = squares.sum::<f64>().sqrt();
    let count = arguments.samples as usize;
    let along = refined.along([from, to], count);
    Some(Profile {
        length,
        derivative: arguments
            .derivative
            .then(|| central_differences(&along, length / (count - 1) as f64)),
        linear: cage.along([from, to], count),
        refined: along,
    })
}
