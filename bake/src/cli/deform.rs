//! `octruss deform`.

use super::{print_figures, progress::Bars, show_notes};
use octruss::bundle::Bundle;
use octruss_bake::animation::{self, Animation};
use octruss_bake::bundle::BundleBytes;
use octruss_bake::deform::{
    Form, deform, format_of, is_of_surface, pose_bits, require_cage, require_control_mesh,
    require_model,
};
use octruss_bake::error::{Error, Result, count};
use octruss_bake::mesh::{Point, SolidMesh};
use octruss_bake::picture::{self, Scene, Sheet, View, contact_sheet, edges_of};
use octruss_bake::progress::Progress;
use octruss_bake::read::motion::{self, Frame};
use octruss_bake::read::obj::Model;
use octruss_bake::refine::Level;
use octruss_bake::{read, write};
use serde::Serialize;
use std::path::{Path, PathBuf};

/// Deforms a model with a bundle, with the device's own code
///
/// The result has the device's bits, written with all digits. It is the model's file with only the
/// vertices' coordinates replaced (normals stay those of the rest shape). A pose is a mesh with
/// the cage's connectivity; a motion is a directory of such meshes, numbered at the end of their
/// names, or a .csv with the columns frame, point, x, y, z. For a motion, OUT is a directory
/// (files are named after the model and the frame), a pattern such as out/frame-%04d.obj, or one file
/// with the whole motion: an animated .glb, or a .pvd for ParaView with a .vtu for each frame beside it.
#[derive(clap::Args)]
pub struct Arguments {
    /// The bundle, as `octruss bake` wrote it
    bundle: PathBuf,
    /// The pose or motion, in the cage's unit
    #[arg(long, visible_alias = "motion", value_name = "POSE")]
    pose: PathBuf,
    /// The model that was baked, at rest: Wavefront .obj
    #[arg(long, value_name = "MODEL")]
    model: PathBuf,
    /// The file to write: the model's format, .glb or .pvd; or for a motion a directory or a pattern
    #[arg(short, long, value_name = "OUT", required_unless_present = "picture")]
    output: Option<PathBuf>,
    /// Which form of the table to apply
    #[arg(long, value_enum, default_value_t)]
    form: Form,
    /// Also draw a contact sheet of the deformed model: a .png
    #[arg(long, value_name = "OUT.png")]
    picture: Option<PathBuf>,
    /// The cage, to draw it over the model; not needed if poses are meshes
    #[arg(long, value_name = "CAGE", requires = "picture")]
    cage: Option<PathBuf>,
    /// At most so many frames in the picture, evenly spread over the motion
    #[arg(
        long,
        value_name = "NUMBER",
        default_value_t = 12,
        requires = "picture"
    )]
    frames: usize,
    /// Direction from the model toward the viewer of the picture
    #[arg(long, value_name = "X,Y,Z", value_parser = direction, allow_hyphen_values = true, requires = "picture")]
    view: Option<Point>,
    /// Direction that points upward in the picture or the .glb; z by default
    #[arg(long, value_name = "X,Y,Z", value_parser = direction, allow_hyphen_values = true)]
    up: Option<Point>,
    /// Frames a second of a .glb or .pvd, positive
    #[arg(long, value_name = "RATE", value_parser = frame_rate, default_value_t = 25.0)]
    frame_rate: f64,
    /// Print the figures as one JSON object
    #[arg(long)]
    json: bool,
}

/// What is printed.
#[derive(Serialize)]
struct Figures {
    frames: usize,
    points: usize,
    saturated_coordinates: usize,
}

/// Runs the command.
pub fn run(arguments: &Arguments) -> Result<()> {
    let bytes = BundleBytes::read(&arguments.bundle)?;
    let bundle = bytes
        .open()
        .map_err(|error| error.in_file(&arguments.bundle))?;
    let model = read::model(&arguments.model)?;
    require_model(&bundle, &model).map_err(|error| error.in_file(&arguments.model))?;
    let (frames, mesh) = poses(&bundle, arguments)?;
    let is_motion = arguments.pose.is_dir() || read::extension(&arguments.pose) == "csv";
    // All frames before the first file: no motion is left half written by a pose that does not fit.
    let bits = bits_of(&bundle, &frames, &arguments.pose)?;
    let animation = arguments
        .output
        .as_ref()
        .filter(|output| animation::EXTENSIONS.contains(&read::extension(output).as_str()));
    let targets = match animation {
        Some(_) => Vec::new(),
        None => targets(arguments, &frames, is_motion)?,
    };

    let mut progress = Bars::default();
    progress.stage("deforming", frames.len());
    let (mut saturated, mut deformed) = (0, Vec::new());
    for (index, bits) in bits.iter().enumerate() {
        let result = deform(&bundle, bits, arguments.form)?;
        saturated += result.saturated as usize;
        let points = format_of(&bundle).points_of(&result.bits);
        if let Some(target) = targets.get(index) {
            write::atomically(target, |out| model.write_with(&points, out))?;
        }
        deformed.push(points);
        progress.step();
    }
    progress.finish();
    if let Some(file) = animation {
        animate(file, arguments, &bundle, &model, &frames, &deformed)?;
    }
    if let Some(file) = &arguments.picture {
        draw(file, arguments, &bundle, &model, &frames, deformed, mesh)?;
    }
    if saturated > 0 {
        eprintln!(
            "warning: {} out of range and clamped; bake with fewer --fraction-bits",
            count(saturated, "coordinate", "coordinates")
        );
    }
    let figures = Figures {
        frames: frames.len(),
        points: model.points.len(),
        saturated_coordinates: saturated,
    };
    print_figures(&figures, arguments.json, || {
        format!(
            "{} of {}, {} saturated",
            count(figures.frames, "frame", "frames"),
            count(figures.points, "point", "points"),
            count(figures.saturated_coordinates, "coordinate", "coordinates")
        )
    })
}

/// The frames in the bundle's format.
fn bits_of(bundle: &Bundle<'_>, frames: &[Frame], file: &Path) -> Result<Vec<Vec<[i32; 3]>>> {
    let bits = |frame: &Frame| {
        pose_bits(bundle, &frame.points).map_err(|error| {
            let message = format!("frame {}: {}", frame.number, error.message());
            error.with_message(message).in_file(file)
        })
    };
    frames.iter().map(bits).collect()
}

/// The frames; and for a single pose the mesh that it was.
fn poses(bundle: &Bundle<'_>, arguments: &Arguments) -> Result<(Vec<Frame>, Option<SolidMesh>)> {
    let pose = &arguments.pose;
    if pose.is_dir() || read::extension(pose) == "csv" {
        let points = bundle.rest_cage().len();
        let frames = motion::read(pose, points, &|mesh| require_cage(bundle, mesh))?;
        return Ok((frames, None));
    }
    if is_of_surface(bundle) {
        let mesh = read::surface(pose)?;
        show_notes(&mesh.notes);
        require_control_mesh(bundle, &mesh).map_err(|error| error.in_file(pose))?;
        return Ok((
            vec![Frame {
                number: 0,
                points: mesh.points,
            }],
            None,
        ));
    }
    let mesh = read::solid(pose)?;
    show_notes(&mesh.notes);
    require_cage(bundle, &mesh).map_err(|error| error.in_file(pose))?;
    Ok((
        vec![Frame {
            number: 0,
            points: mesh.points.clone(),
        }],
        Some(mesh),
    ))
}

/// The files to write, one for each frame, or none.
fn targets(arguments: &Arguments, frames: &[Frame], is_motion: bool) -> Result<Vec<PathBuf>> {
    let Some(output) = &arguments.output else {
        return Ok(Vec::new());
    };
    let wanted = read::extension(&arguments.model);
    let check = |target: PathBuf| {
        if read::extension(&target) == wanted {
            return Ok(target);
        }
        Err(Error::new(format!(
            "expected a name that ends in .{wanted}, as the model's does"
        ))
        .in_file(&target))
    };
    if !is_motion {
        return Ok(vec![check(output.clone())?]);
    }
    if let Some(pattern) = Pattern::parse(output) {
        return frames
            .iter()
            .map(|frame| check(pattern.name(frame.number)))
            .collect();
    }
    if read::extension(output) == wanted {
        return Err(
            Error::new("a motion has many frames, but this names one file")
                .advise("name a directory, or a pattern such as out/frame-%04d.obj")
                .in_file(output),
        );
    }
    std::fs::create_dir_all(output)
        .map_err(|error| Error::new(format!("cannot be made: {error}")).in_file(output))?;
    let stem = arguments
        .model
        .file_stem()
        .unwrap_or_default()
        .to_string_lossy();
    let name = |frame: &Frame| output.join(format!("{stem}-{:04}.{wanted}", frame.number));
    Ok(frames.iter().map(name).collect())
}

/// A file name with a place for a number, such as `%d` or `%04d`.
struct Pattern {
    before: String,
    width: usize,
    after: String,
}

impl Pattern {
    fn parse(path: &Path) -> Option<Self> {
        let (before, rest) = path.to_str()?.split_once('%')?;
        let (width, after) = rest.split_once('d')?;
        let width = if width.is_empty() {
            0
        } else {
            width.parse().ok()?
        };
        const WIDEST: usize = 20;
        (width <= WIDEST).then(|| Self {
            before: before.to_owned(),
            width,
            after: after.to_owned(),
        })
    }

    fn name(&self, number: u64) -> PathBuf {
        PathBuf::from(format!(
            "{}{number:0width$}{}",
            self.before,
            self.after,
            width = self.width
        ))
    }
}

/// Writes the whole motion as one animation.
fn animate(
    file: &Path,
    arguments: &Arguments,
    bundle: &Bundle<'_>,
    model: &Model,
    frames: &[Frame],
    deformed: &[Vec<Point>],
) -> Result<()> {
    let name = arguments.model.file_stem().unwrap_or_default();
    let frames: Vec<animation::Frame<'_>> = frames
        .iter()
        .zip(deformed)
        .map(|(frame, points)| animation::Frame {
            number: frame.number,
            points,
        })
        .collect();
    let animation = Animation {
        name: &name.to_string_lossy(),
        rest: &model.points,
        faces: &model.faces,
        frames: &frames,
        frame_rate: arguments.frame_rate,
        unit: bundle.unit(),
        up: arguments.up.unwrap_or(View::default().up),
    };
    animation::write(&animation, file)
}

fn draw(
    file: &Path,
    arguments: &Arguments,
    bundle: &Bundle<'_>,
    model: &Model,
    frames: &[Frame],
    deformed: Vec<Vec<Point>>,
    mesh: Option<SolidMesh>,
) -> Result<()> {
    let is_single = mesh.is_some();
    let cage = match (&arguments.cage, mesh) {
        (Some(cage), _) => {
            let mesh = read::solid(cage)?;
            require_cage(bundle, &mesh).map_err(|error| error.in_file(cage))?;
            Some(mesh)
        }
        (None, Some(mesh)) => Some(mesh),
        (None, None) if arguments.pose.is_dir() => {
            let meshes = motion::numbered_meshes(&arguments.pose)?;
            meshes
                .first()
                .map(|(_, mesh)| read::solid(mesh))
                .transpose()?
        }
        (None, None) => None,
    };
    let number = frames.len();
    let shown = arguments.frames.clamp(1, number);
    // From the first frame to the last in equal steps.
    let picked = |tile: usize| {
        if shown == 1 {
            0
        } else {
            tile * (number - 1) / (shown - 1)
        }
    };
    let tile = |index: usize| picture::Frame {
        caption: match arguments.pose.file_stem() {
            Some(stem) if is_single => stem.to_string_lossy().into_owned(),
            _ => format!("frame {}", frames[index].number),
        },
        model: deformed[index].clone(),
        cage: frames[index].points.clone(),
    };
    let tiles: Vec<picture::Frame> = (0..shown).map(picked).map(tile).collect();
    let default = View::default();
    let view = View {
        toward_viewer: arguments.view.unwrap_or(default.toward_viewer),
        up: arguments.up.unwrap_or(default.up),
    };
    let cage_edges = match cage {
        Some(cage) => edges_of(&Level::new(&cage)?.skin()),
        None => Vec::new(),
    };
    let scene = Scene {
        triangles: &model.triangles(),
        cage_edges: &cage_edges,
    };
    let png = contact_sheet(
        &scene,
        &tiles,
        &Sheet {
            view,
            ..Sheet::default()
        },
    )?;
    write::atomically(file, |out| {
        out.write_all(&png)
            .map_err(|error| Error::new(format!("cannot be written: {error}")))
    })
}

/// Parses a positive number.
fn frame_rate(text: &str) -> std::result::Result<f64, String> {
    match text.parse() {
        Ok(rate) if rate > 0.0 && f64::is_finite(rate) => Ok(rate),
        _ => Err("expected a positive number".to_owned()),
    }
}

/// Parses "1,0,0.5".
fn direction(text: &str) -> std::result::Result<Point, String> {
    let numbers: Vec<f64> = text
        .split(',')
        .map(|word| {
            word.trim()
                .parse()
                .map_err(|_| format!("\"{word}\" is no number"))
        })
        .collect::<std::result::Result<_, _>>()?;
    match numbers.as_slice() {
        &[x, y, z] if [x, y, z].iter().all(|c| c.is_finite()) && [x, y, z] != [0.0; 3] => {
            Ok([x, y, z])
        }
        _ => Err("expected three numbers that are not all zero, such as 1,0,0.5".to_owned()),
    }
}
