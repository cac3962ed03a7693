//! `octruss poses`.

use super::{print_figures, show_notes};
use octruss_bake::bundle::BundleBytes;
use octruss_bake::deform::{format_of, pose_bits, require_cage, write_poses};
use octruss_bake::error::{Result, count};
use octruss_bake::read::motion;
use octruss_bake::{read, write};
use serde::Serialize;
use std::path::PathBuf;

/// Writes a motion as raw bits for firmware
///
/// The file holds, for each frame in order and each control point in order, x, y and z as 32-bit
/// two's complement integers in the bundle's coordinate format, least significant byte first, with
/// nothing before, between or after: 12 bytes for each control point and frame.
#[derive(clap::Args)]
pub struct Arguments {
    /// The cage: Gmsh .msh, VTK .vtu or .vtk, Medit .mesh, TetGen .node with .ele; held against the
    /// bundle
    cage: PathBuf,
    /// The motion: a .csv with the columns frame, point, x, y, z, or a directory of numbered meshes
    #[arg(long, value_name = "MOTION")]
    motion: PathBuf,
    /// The bundle whose coordinate format to write
    #[arg(long, value_name = "BUNDLE")]
    bundle: PathBuf,
    /// The file to write
    #[arg(short, long, value_name = "OUT.poses")]
    output: PathBuf,
    /// Print the figures as one JSON object
    #[arg(long)]
    json: bool,
}

/// What is printed.
#[derive(Serialize)]
struct Figures {
    frames: usize,
    control_points: usize,
    fraction_bits: u32,
    bytes: usize,
}

/// Runs the command.
pub fn run(arguments: &Arguments) -> Result<()> {
    let bytes = BundleBytes::read(&arguments.bundle)?;
    let bundle = bytes
        .open()
        .map_err(|error| error.in_file(&arguments.bundle))?;
    let cage = read::solid(&arguments.cage)?;
    show_notes(&cage.notes);
    require_cage(&bundle, &cage).map_err(|error| error.in_file(&arguments.cage))?;
    let control_points = cage.points.len();
    let frames = motion::read(&arguments.motion, control_points, &|mesh| {
        require_cage(&bundle, mesh)
    })?;
    let bits: Result<Vec<Vec<[i32; 3]>>> = frames
        .iter()
        .map(|frame| pose_bits(&bundle, &frame.points))
        .collect();
    let bits = bits.map_err(|error| error.in_file(&arguments.motion))?;
    write::atomically(&arguments.output, |out| write_poses(&bits, out))?;
    let figures = Figures {
        frames: bits.len(),
        control_points,
        fraction_bits: format_of(&bundle).fraction_bits,
        bytes: bits.len() * control_points * 12,
    };
    print_figures(&figures, arguments.json, || {
        format!(
            "{} of {}, {} fraction bits, {} bytes",
            count(figures.frames, "frame", "frames"),
            count(figures.control_points, "control point", "control points"),
            figures.fraction_bits,
            figures.bytes
        )
    })
}
