//! The projection of poses to limits and a held volume, and the health of poses, of the finger.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use octruss_bake::dynamics::{Dynamics, Files};
use octruss_bake::error::Error;
use octruss_bake::progress::Silent;
use octruss_bake::read;
use octruss_bake::read::motion;
use octruss_bake::table::{Input, Options, Region, bake};
use rand::RngExt as _;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng as _;

use super::input::Failure;
use super::inverse::Sources;

/// Where the poses that jump come from.
const SEED: u64 = 11;
/// How far control points of those poses stray, in millimetres.
const STRAY: f64 = 20.0;

/// What the page tells of the inputs.
#[derive(Clone, Copy, Debug)]
pub struct Made {
    points: usize,
    cells: usize,
    determinants: usize,
}

/// Bakes `projection.oct` with limits, health and the volume, and writes `poses.bin`: the poses of the motion, then as
/// many whose control points stray.
///
/// # Errors
/// If a file cannot be read or written, or the baker refuses it.
pub fn make(directory: &Path, sources: &Sources) -> Result<Made, Failure> {
    let cage = read::solid_with_features(&sources.cage, None)?;
    let model = read::model(&sources.model)?;
    let limits = sources.folder.join("finger.limits");
    let files = Files {
        limits: Some(&limits),
        ..Files::default()
    };
    let no_pairs = || Err(Error::new("no springs are baked"));
    let mut dynamics = Dynamics::read(files, cage.points.len(), no_pairs)?;
    dynamics.cells = Some(cage.cells.clone());
    let options = Options {
        volumes: vec![Region::Whole],
        dynamics,
        random_poses: 0,
        ..Options::default()
    };
    let input = Input {
        cage: &cage,
        cage_file: &sources.cage,
        model: &model.points,
        model_file: &sources.model,
    };
    let baked = bake(input, &options, &mut Silent)?;
    fs::write(directory.join("projection.oct"), &baked.bundle)?;
    let scale = f64::from(baked.report.fraction_bits).exp2();
    let mut rng = ChaCha8Rng::seed_from_u64(SEED);
    let frames = motion::read(&sources.motion, cage.points.len(), &|_| Ok(()))?;
    let mut bytes = Vec::new();
    for stray in [0.0, STRAY] {
        for coordinate in frames.iter().flat_map(|frame| frame.points.as_flattened()) {
            let strayed = coordinate + stray * rng.random_range(-1.0..=1.0);
            bytes.extend(((strayed * scale).round() as i32).to_le_bytes());
        }
    }
    fs::write(directory.join("poses.bin"), bytes)?;
    let volume = baked.report.volumes.first().ok_or("no volume was baked")?;
    Ok(Made {
        points: cage.points.len(),
        cells: cage.cells.len(),
        determinants: volume.taps,
    })
}

/// The section of the page.
///
/// # Errors
/// If a figure is missing.
pub fn section(made: &Made, figures: &[(String, u64)]) -> Result<String, Failure> {
    let mut text = format!(
        "\n## Projection and health\n\n\
         The nearest pose of the finger's cage ({} control points) that keeps pins, boxes and speeds with the volume held (the\n\
         full form, {} determinants), and the health of that pose ({} cells): instructions on the emulated Cortex-M4, on\n\
         average and at most over all calls. Goals are the poses of the finger's motion, or those with every coordinate\n\
         strayed by up to {STRAY} mm. At 168 MHz and an estimated 1.5 cycles an instruction, the ten calls a second of these\n\
         limits leave 11 200 000 instructions for each.\n\n\
         | goals | what | mean | at most | calls | steps at most | volume missed |\n\
         | --- | --- | --- | --- | --- | --- | --- |\n",
        made.points, made.determinants, made.cells
    );
    let figure = |name: &str| {
        let found = figures.iter().find(|(own, _)| own == name);
        let value = found.map(|(_, value)| *value);
        value.ok_or("the image `projection` does not report all figures")
    };
    for goals in ["motion", "strayed"] {
        let of = |word: &str| figure(&format!("projection {goals} {word}"));
        writeln!(
            text,
            "| {goals} | projection | {} | {} | {} | {} | {} |",
            of("mean")?,
            of("most")?,
            of("calls")?,
            of("steps")?,
            of("missed")?
        )?;
        let of = |word: &str| figure(&format!("health {goals} {word}"));
        let (mean, most, calls) = (of("mean")?, of("most")?, of("calls")?);
        writeln!(text, "| {goals} | health | {mean} | {most} | {calls} | | |")?;
    }
    Ok(text)
}
