//! A surface from its few control points: by the baked table, and refined on the device.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;
use std::time::Duration;

use octruss_bake::dynamics::Dynamics;
use octruss_bake::mesh::Point;
use octruss_bake::progress::Silent;
use octruss_bake::read;
use octruss_bake::read::motion;
use octruss_bake::surface::{RimRule, SurfaceMesh, SurfaceScheme};
use octruss_bake::table::surface::{SurfaceOptions, SurfaceReport, bake_surface};
use octruss_bake::table::{Request, TableFormat};

use super::input::Failure;
use crate::qemu::{Machine, Run, image};

/// How often the control mesh is refined.
const LEVELS: u32 = 2;
/// Fraction bits of the coordinates.
const FRACTION_BITS: u32 = 22;
/// The shift of the instruction clock at which counts are exact.
const EXACT_SHIFT: u8 = 7;

/// What was made for the image, and what is to be said of it.
pub struct Skin {
    report: SurfaceReport,
    /// Bytes of the control mesh as the image reads it: counts, starts and corners of faces.
    mesh_bytes: usize,
    faces: usize,
    /// How far a coordinate of the two ways can be apart, in units of the last place.
    bound: f64,
}

/// Figures by name.
pub type Figures = Vec<(String, u64)>;

/// Bakes the surface and writes the files of the image `skin` into the directory.
///
/// # Errors
/// If a file cannot be read or written, the baker refuses the mesh, or a control point lies between the
/// places of the coordinates' grid.
pub fn make(directory: &Path, mesh_file: &Path, motion_file: &Path) -> Result<Skin, Failure> {
    fs::create_dir_all(directory)?;
    let mesh = read::surface(mesh_file)?;
    let frames = motion::read(motion_file, mesh.points.len(), &|_| Ok(()))?;
    let options = SurfaceOptions {
        scheme: SurfaceScheme::CatmullClark,
        rim: RimRule::Spline,
        levels: LEVELS,
        limit: false,
        fraction_bits: Some(FRACTION_BITS),
        unit: "mm".to_owned(),
        volumes: Vec::new(),
        modes: Vec::new(),
        centroid: false,
        normals: false,
        dynamics: Dynamics::default(),
        request: Request {
            format: Some(TableFormat::Q30),
            keep_order: true,
            ..Request::default()
        },
        random_poses: 0,
        seed: 0,
    };
    let baked = bake_surface(&mesh, &options, &mut Silent)?;
    fs::write(directory.join("skin.oct"), &baked.bundle)?;
    let bytes = mesh_bytes(&mesh);
    fs::write(directory.join("skin.bin"), &bytes)?;
    bits(&mesh.points)?;
    let poses: Result<Vec<Vec<u8>>, Failure> =
        frames.iter().map(|frame| bits(&frame.points)).collect();
    fs::write(directory.join("skin.poses"), poses?.concat())?;
    let taken = baked.report.formats.first();
    let proved = taken.ok_or("no format was baked")?.proved;
    Ok(Skin {
        mesh_bytes: bytes.len(),
        faces: mesh.faces.len(),
        bound: proved + REST + ROUNDING_A_LEVEL * f64::from(LEVELS),
        report: baked.report,
    })
}

/// What refining rounds at each level. No mask of the scheme has a negative weight, so none magnifies
/// what the levels before have rounded.
const ROUNDING_A_LEVEL: f64 = 0.5;
/// The rounding of the rest position that a table moves. The control points at rest lie on the grid.
const REST: f64 = 0.5;

/// The control mesh as the image reads it.
fn mesh_bytes(mesh: &SurfaceMesh) -> Vec<u8> {
    let corners = mesh.faces.concat();
    let ends = mesh.faces.iter().scan(0, |end, face| {
        *end += face.len() as u32;
        Some(*end)
    });
    let counts = [mesh.points.len(), mesh.faces.len(), corners.len()];
    let counts = counts.map(|count| count as u32).into_iter();
    let words = counts.chain([LEVELS, 0]).chain(ends).chain(corners);
    words.flat_map(u32::to_le_bytes).collect()
}

/// The raw bits of points that lie on the grid.
fn bits(points: &[Point]) -> Result<Vec<u8>, Failure> {
    let scale = 2.0_f64.powi(FRACTION_BITS as i32);
    let mut bytes = Vec::new();
    for value in points.as_flattened() {
        let raw = value * scale;
        if raw != raw.round() || raw.abs() >= f64::from(i32::MAX) {
            return Err(
                format!("{value} is no coordinate with {FRACTION_BITS} fraction bits").into(),
            );
        }
        bytes.extend((raw as i32).to_le_bytes());
    }
    Ok(bytes)
}

/// The figures of a run of the image.
///
/// # Errors
/// Those of the runner.
pub fn figures(directory: &Path) -> Result<Figures, Failure> {
    let outcome = Run::new(Machine::Mps2An386, image("skin"))
        .directory(directory)
        .instruction_shift(EXACT_SHIFT)
        .time_limit(Duration::from_secs(300))
        .run()?;
    let messages = outcome.log.messages.iter();
    let figures = messages.filter_map(|message| {
        let (name, value) = octruss_firmware::exit::parse_figure(&message.text)?;
        Some((name.to_owned(), value))
    });
    Ok(figures.collect())
}

/// The section of the page.
///
/// # Errors
/// If the image did not report a figure, or the two ways are farther apart than they can be.
pub fn section(skin: &Skin, figures: &[(String, u64)]) -> Result<String, Failure> {
    let figure = |name: &str| {
        let found = figures.iter().find(|(found, _)| found == name);
        let found = found.ok_or_else(|| format!("the image `skin` does not report `{name}`"))?;
        Ok::<u64, Failure>(found.1)
    };
    let (greatest, frames) = (figure("skin greatest difference")?, figure("skin frames")?);
    let bound = skin.bound;
    if greatest as f64 > bound || frames == 0 {
        return Err(format!(
            "the table and the refined surface are {greatest} units apart in {frames} frames, and the \
             bound is {bound:.2}"
        )
        .into());
    }
    let report = &skin.report;
    let (points, rows) = (report.control_points, report.rows);
    let pose = 12 * points as u64;
    let levels: Result<Vec<u64>, Failure> = (1..=LEVELS)
        .map(|level| figure(&format!("skin points {level}")))
        .collect();
    let refined: u64 = levels?.iter().sum();
    let memory = figure("skin arenas")? + figure("skin scratch")? + pose;
    let mut text = format!(
        "\n## A skin from few control points\n\n\
         The Catmull-Clark surface of `models/glove.obj` ({points} control points, {faces} quads), refined {LEVELS}\n\
         times to {rows} points, over the {frames} frames of its motion on the emulated Cortex-M4: by a table\n\
         (Q30), and refined on the device, which makes the connectivity once. Flash is the bundle, or the\n\
         control mesh; RAM is the pose, the points and all that lies between.\n\n\
         | way | instructions once | a frame | flash bytes | RAM bytes |\n| --- | --- | --- | --- | --- |\n",
        faces = skin.faces,
    );
    writeln!(
        text,
        "| table | | {} | {} | {} |",
        figure("skin table")?,
        report.bytes,
        figure("skin table memory")?
    )?;
    writeln!(
        text,
        "| refined | {} | {refined} | {} | {memory} |",
        figure("skin connectivity")?,
        skin.mesh_bytes
    )?;
    write!(
        text,
        "\nOf {} coordinates {} differ, by at most {greatest} in the last place. They cannot differ by more\n\
         than {bound:.2}: half a unit for the rounding of each level (no weight of a mask is negative, so none\n\
         magnifies what was rounded before), half a unit for that of the rest position, and {:.2} that the\n\
         baker proves for the table.\n",
        3 * rows as u64 * frames,
        figure("skin unequal coordinates")?,
        bound - REST - ROUNDING_A_LEVEL * f64::from(LEVELS),
    )?;
    Ok(text)
}
