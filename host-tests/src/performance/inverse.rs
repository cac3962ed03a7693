//! The goals' solver: sixteen actuators, 32 effectors, with the volume held, in a band, and without one.

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::Duration;

use octruss_bake::bundle::BundleBytes;
use octruss_bake::progress::Silent;
use octruss_bake::read;
use octruss_bake::read::motion;
use octruss_bake::table::inverse::Solvers;
use octruss_bake::table::{Input, Options, Region, Report, bake};
use rand::RngExt as _;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng as _;

use super::input::Failure;
use crate::qemu::{Machine, Run, image};

/// Ticks between two frames of the motion.
const STEPS: usize = 8;
/// Where the goals that jump come from.
const SEED: u64 = 9;

/// What is baked, from the folder of the example.
#[derive(Clone, Debug)]
pub struct Sources {
    /// The cage of tetrahedra.
    pub cage: PathBuf,
    /// The skin.
    pub model: PathBuf,
    /// The motion that the goals follow.
    pub motion: PathBuf,
    /// The folder with the files of actuators, effectors and modes.
    pub folder: PathBuf,
}

/// Bakes the solver and its volume and writes `inverse.oct`.
///
/// # Errors
/// If a file cannot be read or written, or the baker refuses it.
pub fn bake_solver(directory: &Path, sources: &Sources) -> Result<Report, Failure> {
    let cage = read::solid_with_features(&sources.cage, None)?;
    let model = read::model(&sources.model)?;
    let file = |name: &str| sources.folder.join(name);
    let modes = motion::read(&file("finger-modes.csv"), cage.points.len(), &|_| Ok(()))?;
    let points = model.points.len();
    let options = Options {
        volumes: vec![Region::Whole],
        solvers: Solvers {
            actuators: read::control::actuators(&file("finger-actuators.csv"), modes.len())?,
            effectors: read::control::effectors(&file("finger-effectors.csv"), points)?,
            sensors: read::control::effectors(&file("finger-sensors.csv"), points)?,
            damping: 1e-4,
        },
        modes: modes.into_iter().map(|frame| frame.points).collect(),
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
    fs::write(directory.join("inverse.oct"), &baked.bundle)?;
    Ok(baked.report)
}

/// Where the effectors go in every frame of the motion, as the table deforms them.
///
/// # Errors
/// If a file cannot be read.
pub fn goals_of_motion(directory: &Path, sources: &Sources) -> Result<Vec<Vec<[i32; 3]>>, Failure> {
    let bytes = BundleBytes::read(&directory.join("inverse.oct"))?;
    let bundle = bytes.open()?;
    let fraction_bits = bundle.header().fraction_bits.get();
    let rest = bundle.rest_cage();
    let model = read::model(&sources.model)?;
    let effectors = read::control::effectors(
        &sources.folder.join("finger-effectors.csv"),
        model.points.len(),
    )?;
    let table = bundle.table::<i32>()?;
    let mut row_of = vec![0; table.rows()];
    for (row, point) in bundle.model_points().iter().enumerate() {
        row_of[point] = row;
    }
    let scale = f64::from(fraction_bits).exp2();
    let frames = motion::read(&sources.motion, rest.len(), &|_| Ok(()))?;
    let mut all = Vec::new();
    for frame in frames {
        let bits = |point: &[f64; 3]| point.map(|own| (own * scale).round() as i32);
        let pose: Vec<[i32; 3]> = frame.points.iter().map(bits).collect();
        let mut points = vec![[0; 3]; table.rows()];
        table.apply(0..table.rows(), &pose, &mut points)?;
        all.push(
            effectors
                .iter()
                .map(|own| points[row_of[own.point]])
                .collect(),
        );
    }
    Ok(all)
}

/// Writes `goals.bin`: ticks that follow the motion, then as many that jump by up to a third of the finger.
///
/// # Errors
/// If a file cannot be read or written.
pub fn make(directory: &Path, sources: &Sources) -> Result<Report, Failure> {
    let report = bake_solver(directory, sources)?;
    let frames = goals_of_motion(directory, sources)?;
    let mut ticks: Vec<Vec<[i32; 3]>> = Vec::new();
    for pair in frames.windows(2) {
        for step in 0..STEPS {
            let part = step as f64 / STEPS as f64;
            let between = |(a, b): (&[i32; 3], &[i32; 3])| {
                [0, 1, 2].map(|k| a[k] + ((f64::from(b[k]) - f64::from(a[k])) * part) as i32)
            };
            ticks.push(pair[0].iter().zip(&pair[1]).map(between).collect());
        }
    }
    let mut rng = ChaCha8Rng::seed_from_u64(SEED);
    let far = (f64::from(report.fraction_bits).exp2() * 33.0) as i32;
    let count = ticks.len();
    for tick in 0..count {
        let mut goals = frames[tick % frames.len()].clone();
        let whole = [0; 3].map(|_: i32| rng.random_range(-far..=far));
        for goal in &mut goals {
            for (own, whole) in goal.iter_mut().zip(whole) {
                *own = own
                    .saturating_add(whole)
                    .saturating_add(rng.random_range(-far..=far) / 4);
            }
        }
        ticks.push(goals);
    }
    let bytes: Vec<u8> = ticks
        .concat()
        .into_iter()
        .flatten()
        .flat_map(i32::to_le_bytes)
        .collect();
    fs::write(directory.join("goals.bin"), bytes)?;
    Ok(report)
}

/// The shift of the instruction clock at which counts are exact.
const EXACT_SHIFT: u8 = 7;

/// The figures of an image such as `inverse`.
///
/// # Errors
/// If it does not run to its end.
pub fn figures(directory: &Path, name: &str) -> Result<Vec<(String, u64)>, Failure> {
    let outcome = Run::new(Machine::Mps2An386, image(name))
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
/// If the image did not report a figure.
pub fn section(report: &Report, figures: &[(String, u64)]) -> Result<String, Failure> {
    let solver = report.solvers.first().ok_or("no solver was baked")?;
    let mut text = format!(
        "\n## Goals\n\n\
         A tick of the goals' solver, {} actuators and {} effectors of the finger ({} bytes of flash), instructions on the\n\
         emulated Cortex-M4: on average and at most over all ticks. Goals follow the finger's motion, or jump by a third of\n\
         the finger in every tick. A tick at 1 kHz of a processor with 168 MHz has about 110 000 instructions, at an estimated\n\
         1.5 cycles each. A volume counts as missed if it is off by more than 6.1e-5 of its target.\n\n\
         | goals | volume | mean | at most | ticks | volume missed | steps refused |\n\
         | --- | --- | --- | --- | --- | --- | --- |\n",
        solver.actuators, solver.points, solver.bytes
    );
    for (name, goals) in [("inverse smooth", "smooth"), ("inverse jumps", "jumping")] {
        for (what, volume) in [
            ("held", "held"),
            ("band", "within 2 % of rest"),
            ("free", "free"),
        ] {
            let figure = |word: &str| {
                let name = format!("{name} {what} {word}");
                let found = figures.iter().find(|(own, _)| *own == name);
                found
                    .map(|(_, value)| *value)
                    .ok_or("the image `inverse` does not report all figures")
            };
            writeln!(
                text,
                "| {goals} | {volume} | {} | {} | {} | {} | {} |",
                figure("mean")?,
                figure("most")?,
                figure("ticks")?,
                figure("missed")?,
                figure("refused")?
            )?;
        }
    }
    Ok(text)
}
