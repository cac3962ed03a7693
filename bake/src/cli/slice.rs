//! `octruss slice`.

use super::{print_figures, progress::Bars, scheme, show_notes};
use octruss_bake::error::{Error, Result, count};
use octruss_bake::mesh::{Point, SolidMesh};
use octruss_bake::progress::Progress;
use octruss_bake::refine::{BoundaryRule, Level, Scheme};
use octruss_bake::slice::{
    Cut, Field, Moment, Panel, Picture, Places, Plane, Profile, central_differences, draw,
    over_time,
};
use octruss_bake::table::Options;
use octruss_bake::{check, read, write};
use serde::Serialize;
use std::path::{Path, PathBuf};

/// Draws a cross-section of a refined cage and of values that belong to its vertices
///
/// The picture shows, side by side, the values on a plane (dark to bright), lines of equal value
/// (of a channel over time, the values at each moment instead), and with --line the values along a line beside their linear interpolation in the cells of the
/// cage. Values are refined by the masks that refine positions.
#[derive(clap::Args)]
pub struct Arguments {
    /// The cage: Gmsh .msh, VTK .vtu or .vtk, Medit .mesh, TetGen .node with .ele
    mesh: PathBuf,
    /// The plane a x + b y + c z = d: four numbers parted by commas
    #[arg(long, value_name = "A,B,C,D", value_parser = numbers::<4>, allow_hyphen_values = true)]
    plane: [f64; 4],
    /// The values: the name of a channel in the cage's file, or a file with a value for each vertex of
    /// the cage, in file order. Given several times, one for each moment, they are a channel over
    /// time: a table is baked for the picture and carries all moments with the device's own code
    #[arg(long, value_name = "NAME|FILE", required_unless_present = "basis")]
    channel: Vec<PathBuf>,
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
    /// What the boundary follows: loop by default, with --scheme mixed tri-quad
    #[arg(long, value_enum)]
    boundary: Option<BoundaryRule>,
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
    /// Least and greatest value on the cut, at all moments.
    least: f64,
    greatest: f64,
    grid_points_inside: usize,
    /// Values along the line, `null` outside the solid; of the last moment.
    #[serde(skip_serializing_if = "Option::is_none")]
    line: Option<LineFigures>,
    /// Of a channel over time: what each moment gave.
    #[serde(skip_serializing_if = "Option::is_none")]
    moments: Option<Vec<MomentFigures>>,
}

#[derive(Serialize)]
struct LineFigures {
    refined: Vec<Option<f64>>,
    linear: Vec<Option<f64>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    derivative: Option<Vec<Option<f64>>>,
}

#[derive(Serialize)]
struct MomentFigures {
    channel: String,
    least: f64,
    greatest: f64,
    saturated_values: u32,
}

/// A name and a value for each vertex.
type Named = (String, Vec<f64>);

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
    let boundary = arguments.scheme.boundary(arguments.boundary)?;
    let channels = channels(arguments, &mesh)?;
    let diagonals = scheme::diagonals(arguments.scheme, arguments.diagonals.as_deref(), &mesh)?;
    let of_mesh = |error: Error| error.in_file(&arguments.mesh);
    check::require_sound_connectivity(&mesh).map_err(of_mesh)?;
    scheme::warn_of_improper_faces(&mesh, arguments.scheme, diagonals.as_ref()).map_err(of_mesh)?;
    let level = Level::of_scheme(&mesh, arguments.scheme, diagonals.as_ref()).map_err(of_mesh)?;

    let mut progress = Bars::default();
    let (_, last) = channels.last().cloned().unwrap_or_default();
    let cage = Field::new(&mesh, level, last).map_err(of_mesh)?;
    let refined = cage
        .refined(arguments.levels, boundary, &mut progress)
        .map_err(of_mesh)?;
    let cut = refined
        .cut(plane, arguments.size as usize, &mut progress)
        .map_err(of_mesh)?;
    let moments = if channels.len() > 1 {
        let options = Options {
            scheme: arguments.scheme,
            diagonals,
            boundary,
            levels: arguments.levels,
            ..Options::default()
        };
        moments(arguments, &mesh, &options, (&refined, &cut), &channels)?
    } else {
        Vec::new()
    };
    progress.finish();
    let along = match moments.last() {
        Some(moment) => Some(moment.along.clone()),
        None => line(arguments).map(|(ends, count)| refined.along(ends, count)),
    };
    let profiled = line(arguments).zip(along);
    let profile = profiled.map(|((ends, count), along)| {
        profile(cage.along(ends, count), along, ends, arguments.derivative)
    });
    let figures = figures(arguments, &cut, &channels, &moments, profile.as_ref());
    let picture = Picture {
        panels: panels(arguments.isolines, &cut, &channels, &moments, profile),
        size: arguments.size,
    };
    let png = draw(&picture).map_err(of_mesh)?;
    write::atomically(&arguments.output, |out| {
        out.write_all(&png)
            .map_err(|error| Error::new(format!("cannot be written: {error}")))
    })?;
    print_figures(&figures, arguments.json, || words(&figures))
}

fn words(figures: &Figures) -> String {
    let (least, greatest) = (figures.least, figures.greatest);
    let points = count(figures.grid_points_inside, "grid point", "grid points");
    match &figures.moments {
        None => format!("values from {least} to {greatest} at {points}"),
        Some(moments) => format!(
            "values from {least} to {greatest} at {points} and {} moments, carried by one table",
            moments.len()
        ),
    }
}

/// Carries every channel to the places of the picture by one table.
fn moments(
    arguments: &Arguments,
    mesh: &SolidMesh,
    options: &Options,
    (refined, cut): (&Field, &Cut),
    channels: &[Named],
) -> Result<Vec<Moment>> {
    let places = Places {
        cut,
        line: line(arguments),
    };
    let values: Vec<Vec<f64>> = channels.iter().map(|(_, values)| values.clone()).collect();
    let input = (mesh, arguments.mesh.as_path());
    over_time(
        input,
        options,
        refined,
        places,
        &values,
        &mut Bars::default(),
    )
}

fn panels<'a>(
    isolines: usize,
    cut: &'a Cut,
    channels: &[Named],
    moments: &'a [Moment],
    profile: Option<Profile>,
) -> Vec<Panel<'a>> {
    let mut panels: Vec<Panel<'a>> = if moments.is_empty() {
        vec![
            Panel::Density(String::new(), cut),
            Panel::Isolines(isolines, cut),
        ]
    } else {
        let titled = channels.iter().zip(moments);
        titled
            .map(|((name, _), moment)| Panel::Density(format!("{name}: "), &moment.cut))
            .collect()
    };
    panels.extend(profile.map(Panel::Plot));
    panels
}

fn figures(
    arguments: &Arguments,
    cut: &Cut,
    channels: &[Named],
    moments: &[Moment],
    profile: Option<&Profile>,
) -> Figures {
    let of_moment = |((name, _), moment): (&Named, &Moment)| {
        let [least, greatest] = moment.cut.range().unwrap_or_default();
        MomentFigures {
            channel: name.clone(),
            least,
            greatest,
            saturated_values: moment.saturated,
        }
    };
    let of_moments: Vec<MomentFigures> = channels.iter().zip(moments).map(of_moment).collect();
    let [least, greatest] = if of_moments.is_empty() {
        cut.range().unwrap_or_default()
    } else {
        let ranges = of_moments
            .iter()
            .map(|moment| [moment.least, moment.greatest]);
        ranges.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], [a, b]| {
            [low.min(a), high.max(b)]
        })
    };
    Figures {
        levels: arguments.levels,
        least,
        greatest,
        grid_points_inside: cut.inside(),
        line: profile.map(|profile| LineFigures {
            refined: profile.refined.clone(),
            linear: profile.linear.clone(),
            derivative: profile.derivative.clone(),
        }),
        moments: (!of_moments.is_empty()).then_some(of_moments),
    }
}

/// So many numbers parted by commas.
pub(super) fn numbers<const N: usize>(text: &str) -> std::result::Result<[f64; N], String> {
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

/// The channels that are asked for: of the mesh by their names, else of files.
fn channels(arguments: &Arguments, mesh: &SolidMesh) -> Result<Vec<Named>> {
    if let Some(vertex) = arguments.basis {
        let name = format!("vertex {vertex}");
        return Ok(vec![(name, basis(vertex, mesh, &arguments.mesh)?)]);
    }
    let read = |file: &PathBuf| {
        let mut own = mesh.channels.iter();
        if let Some(channel) = own.find(|channel| file.as_os_str() == channel.name.as_str()) {
            return Ok((channel.name.clone(), channel.values.clone()));
        }
        let values = read::channel::read(&read::bytes(file)?, mesh.points.len())
            .map_err(|error| error.in_file(file))?;
        let stem = file.file_stem().unwrap_or_default();
        Ok((stem.to_string_lossy().into_owned(), values))
    };
    arguments.channel.iter().map(read).collect()
}

/// One at a vertex, zero at all others.
fn basis(vertex: usize, mesh: &SolidMesh, file: &Path) -> Result<Vec<f64>> {
    let mut values = vec![0.0; mesh.points.len()];
    let length = values.len();
    match values.get_mut(vertex) {
        Some(value) => *value = 1.0,
        None => {
            return Err(Error::new(format!(
                "there is no vertex {vertex}; the mesh has {length}"
            ))
            .advise("vertices are counted from 0 in the order of the mesh file")
            .in_file(file));
        }
    }
    Ok(values)
}

/// Ends of the line, and how many points to look at.
fn line(arguments: &Arguments) -> Option<([Point; 2], usize)> {
    let [a, b, c, d, e, f] = arguments.line?;
    Some(([[a, b, c], [d, e, f]], arguments.samples as usize))
}

fn profile(
    linear: Vec<Option<f64>>,
    refined: Vec<Option<f64>>,
    [from, to]: [Point; 2],
    with_derivative: bool,
) -> Profile {
    let squares = (0..3).map(|k| (to[k] - from[k]).powi(2));
    let length = squares.sum::<f64>().sqrt();
    let step = length / (refined.len() - 1) as f64;
    Profile {
        length,
        derivative: with_derivative.then(|| central_differences(&refined, step)),
        linear,
        refined,
    }
}
