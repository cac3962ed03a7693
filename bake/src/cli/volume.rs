//! `octruss volume`.

use super::{print_figures, show_notes};
use octruss_bake::error::{Error, Result};
use octruss_bake::forms::solid::Enclosure;
use octruss_bake::forms::surface::centred;
use octruss_bake::forms::{DeviceForm, FormError, Moments};
use octruss_bake::mesh::Point;
use octruss_bake::picture::{Frame, Scene, Sheet, coloured_sheet};
use octruss_bake::read::{self, obj::Model};
use octruss_bake::refine::Level;
use octruss_bake::surface::SurfaceScheme;
use octruss_bake::table::format::{Format, MOST_FRACTION_BITS};
use octruss_bake::write;
use serde::Serialize;
use std::fmt::Write;
use std::path::{Path, PathBuf};

/// Prints the exact volume that a smooth surface encloses
///
/// The mesh is the control mesh of a subdivision surface (.obj with its crease tags, .off, .ply, .stl), of any genus, or a cage (.msh,
/// .vtu), whose boundary is meant. It must be closed, a manifold, and consistently oriented; the volume is
/// positive if faces run counter-clockwise seen from outside. Where no exact form is known (creases and
/// corners) the volume of refined polyhedra is extrapolated, and an error estimate is printed; so are
/// centroid and inertia of the schemes tri-quad, sqrt3 and the butterflies, whose volume is exact.
#[derive(clap::Args)]
pub struct Arguments {
    /// The control mesh (.obj, .off, .ply, .stl) or cage (Gmsh .msh, VTK .vtu)
    mesh: PathBuf,
    /// The subdivision scheme; for a cage loop, loop-warren, or tri-quad (mixed cages)
    #[arg(long, value_enum)]
    scheme: SurfaceScheme,
    /// Also print the centroid, and the inertia tensor about it at unit density
    #[arg(long)]
    moments: bool,
    /// Write the nearest control mesh that encloses this volume (see -o)
    #[arg(
        long,
        value_name = "V",
        requires = "output",
        allow_negative_numbers = true
    )]
    target: Option<f64>,
    /// The control mesh to write with --target: .obj
    #[arg(short, long, value_name = "OUT", requires = "target")]
    output: Option<PathBuf>,
    /// Draw the facets, coloured by their share of the volume: .png
    #[arg(long, value_name = "OUT.png")]
    picture: Option<PathBuf>,
    /// File with creases and corners: a line each, `crease A B` or `corner A`
    #[arg(long, value_name = "FILE")]
    features: Option<PathBuf>,
    /// Also print how large the volume's form is on a device, and the bound of its error
    #[arg(long)]
    device: bool,
    /// With --device: bits after the point of the 32-bit coordinates; by default as many as leave two
    /// bits of headroom
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(0..=i64::from(MOST_FRACTION_BITS)))]
    fraction_bits: Option<u32>,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
}

#[derive(Default, Serialize)]
struct Figures {
    volume: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    error_estimate: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    centroid: Option<Point>,
    #[serde(skip_serializing_if = "Option::is_none")]
    inertia: Option<[Point; 3]>,
    /// Of a coordinate of the centroid.
    #[serde(skip_serializing_if = "Option::is_none")]
    centroid_error_estimate: Option<f64>,
    /// Of an entry of the inertia tensor.
    #[serde(skip_serializing_if = "Option::is_none")]
    inertia_error_estimate: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    device: Option<DeviceFigures>,
}

#[derive(Serialize)]
struct DeviceFigures {
    fraction_bits: u32,
    control_points: usize,
    taps: usize,
    bytes: usize,
    /// The device's result at rest, in cubes of the unit.
    volume: f64,
    /// For poses no larger than the mesh at rest.
    error_bound: f64,
}

/// What a file holds.
struct Input {
    points: Vec<Point>,
    surface: Enclosure,
    model: Option<Model>,
}

/// Runs the command.
pub fn run(arguments: &Arguments) -> Result<()> {
    let of_mesh = |error: Error| error.in_file(&arguments.mesh);
    let input = read_input(arguments)?;
    let figures = figures(arguments, &input).map_err(of_mesh)?;
    if let Some(file) = &arguments.picture {
        draw(arguments, &input, file).map_err(of_mesh)?;
    }
    if let (Some(target), Some(output)) = (arguments.target, &arguments.output) {
        reach(arguments, &input, target, output).map_err(of_mesh)?;
    }
    print_figures(&figures, arguments.json, || words(&figures))
}

/// The formats of control meshes; others are those of cages.
const SURFACES: [&str; 4] = ["obj", "off", "ply", "stl"];

fn read_input(arguments: &Arguments) -> Result<Input> {
    let of_mesh = |error: Error| error.in_file(&arguments.mesh);
    if SURFACES.contains(&read::extension(&arguments.mesh).as_str()) {
        let mesh = read::surface_with_features(&arguments.mesh, arguments.features.as_deref())?;
        show_notes(&mesh.notes);
        return Ok(Input {
            surface: Enclosure::new(&mesh.faces, &mesh.features).map_err(of_mesh)?,
            points: mesh.points,
            model: Some(read::model(&arguments.mesh)?),
        });
    }
    let mesh = read::solid_with_features(&arguments.mesh, arguments.features.as_deref())?;
    show_notes(&mesh.notes);
    let level = Level::new(&mesh).map_err(of_mesh)?;
    Ok(Input {
        surface: Enclosure::of_cage(&level, &mesh.features).map_err(of_mesh)?,
        points: mesh.points,
        model: None,
    })
}

fn of_form(error: FormError) -> Error {
    Error::new(error.to_string())
}

fn figures(arguments: &Arguments, input: &Input) -> Result<Figures> {
    let own = input.surface.own(&input.points);
    let scheme = arguments.scheme;
    let mut figures = Figures::default();
    if !input.surface.has_moments(scheme) && (arguments.moments || !input.surface.has_forms(scheme))
    {
        let [last, before] = input.surface.extrapolated_moments(scheme, &own)?;
        figures = extrapolated(arguments, last, before);
    }
    if input.surface.has_forms(scheme) {
        exact(arguments, input, &own, &mut figures)?;
    }
    if arguments.device {
        let [form, _] = input.surface.control_forms(arguments.scheme)?;
        let format = match arguments.fraction_bits {
            Some(fraction_bits) => Format { fraction_bits },
            None => Format::with_headroom(&input.points),
        };
        let bits = format.bits_of(&input.points, "the mesh's vertex")?;
        figures.device = Some(device(&form, format.fraction_bits, &bits)?);
    }
    Ok(figures)
}

/// Puts the exact figures in: the volume, and moments where there are such.
fn exact(arguments: &Arguments, input: &Input, own: &[Point], figures: &mut Figures) -> Result<()> {
    let (moved, _) = centred(own);
    let limit = input.surface.limit(arguments.scheme)?;
    figures.volume = limit.volume(&moved).map_err(of_form)?;
    figures.error_estimate = None;
    if arguments.moments && input.surface.has_moments(arguments.scheme) {
        let moments = limit.moments(own).map_err(of_form)?;
        figures.centroid = Some(moments.centroid);
        figures.inertia = Some(moments.inertia);
    }
    Ok(())
}

fn extrapolated(arguments: &Arguments, last: Moments, before: Moments) -> Figures {
    let mut figures = Figures {
        volume: last.volume,
        error_estimate: Some((last.volume - before.volume).abs()),
        ..Figures::default()
    };
    if arguments.moments {
        let apart = |a: &[f64], b: &[f64]| {
            let pairs = a.iter().zip(b);
            pairs.fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()))
        };
        let inertia = [last.inertia.as_flattened(), before.inertia.as_flattened()];
        figures.centroid_error_estimate = Some(apart(&last.centroid, &before.centroid));
        figures.inertia_error_estimate = Some(apart(inertia[0], inertia[1]));
        figures.centroid = Some(last.centroid);
        figures.inertia = Some(last.inertia);
    }
    figures
}

/// Rounds the form and runs core's own code on it.
fn device(
    form: &octruss_bake::forms::ControlForm,
    fraction_bits: u32,
    bits: &[[i32; 3]],
) -> Result<DeviceFigures> {
    let device = DeviceForm::new(form, bits).map_err(of_form)?;
    let failed = |error: octruss::enclosed::EnclosedError| Error::new(error.to_string());
    let view = octruss::enclosed::VolumeForm::new_checked(device.parts(), bits.len());
    let view = view.map_err(failed)?;
    let mut workspace = vec![[0; 3]; view.workspace_length()];
    let enclosed = view.volume(bits, &mut workspace).map_err(failed)?;
    let cube = 0.5_f64.powi(3 * i32::try_from(fraction_bits).unwrap_or_default());
    Ok(DeviceFigures {
        fraction_bits,
        control_points: device.points.len(),
        taps: device.weights.len(),
        bytes: device.bytes(),
        volume: enclosed.volume as f64 * device.volume_unit() * cube,
        error_bound: device.volume_bound(device.reach(bits)) * cube,
    })
}

fn draw(arguments: &Arguments, input: &Input, file: &Path) -> Result<()> {
    let own = input.surface.own(&input.points);
    let portrait = input.surface.limit(arguments.scheme)?;
    let portrait = portrait.portrait(&own).map_err(of_form)?;
    let scene = Scene {
        triangles: &portrait.triangles,
        cage_edges: &[],
    };
    let frame = Frame {
        caption: format!("{}, shares of the volume", scheme_name(arguments.scheme)),
        model: portrait.points,
        cage: Vec::new(),
    };
    let sheet = Sheet {
        tile: [640, 640],
        ..Sheet::default()
    };
    let png = coloured_sheet(&scene, &portrait.colours, &[frame], &sheet)?;
    write::atomically(file, |out| {
        out.write_all(&png)
            .map_err(|error| Error::new(format!("cannot be written: {error}")))
    })
}

fn scheme_name(scheme: SurfaceScheme) -> String {
    let value = clap::ValueEnum::to_possible_value(&scheme);
    value.map_or_else(String::new, |value| value.get_name().to_owned())
}

fn reach(arguments: &Arguments, input: &Input, target: f64, output: &Path) -> Result<()> {
    let Some(model) = &input.model else {
        return Err(
            Error::new("--target moves a control mesh, and this is a cage")
                .advise("give the control mesh as .obj, .off, .ply or .stl"),
        );
    };
    if read::extension(output) != "obj" {
        return Err(Error::new(format!("{} is no .obj file", output.display()))
            .advise("the control mesh is written as .obj"));
    }
    let limit = input.surface.limit(arguments.scheme)?;
    let own = input.surface.own(&input.points);
    let reached = limit.enclosing(&own, target).map_err(of_form)?;
    let mut points = input.points.clone();
    for (&vertex, point) in input.surface.vertices.iter().zip(reached) {
        points[vertex as usize] = point;
    }
    write::atomically(output, |out| model.write_with(&points, out))
}

/// The figures as text. Writing to a string cannot fail.
fn words(figures: &Figures) -> String {
    let mut text = format!("volume {}", figures.volume);
    if let Some(error) = figures.error_estimate {
        let _ = write!(text, " +- {error:.2e}");
    }
    if let Some([x, y, z]) = figures.centroid {
        let _ = write!(text, "\ncentroid {x} {y} {z}");
    }
    if let Some(error) = figures.centroid_error_estimate {
        let _ = write!(text, " +- {error:.2e}");
    }
    for [x, y, z] in figures.inertia.iter().flatten() {
        let _ = write!(text, "\ninertia {x} {y} {z}");
    }
    if let Some(error) = figures.inertia_error_estimate {
        let _ = write!(text, " +- {error:.2e}");
    }
    if let Some(device) = &figures.device {
        let _ = write!(
            text,
            "\non a device: {} control points, {} taps, {} bytes, {} fraction bits, volume {} +- {:.2e}",
            device.control_points,
            device.taps,
            device.bytes,
            device.fraction_bits,
            device.volume,
            device.error_bound
        );
    }
    text
}
