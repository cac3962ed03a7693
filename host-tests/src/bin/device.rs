//! Runs the firmware's images on emulated processors and draws what the documentation shows. `cargo xtask` calls
//! it; it expects the images to be built.

use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;

use clap::{Parser, Subcommand, ValueEnum as _};
use octruss_host_tests::adaptive_count::loop_rule::Green;
use octruss_host_tests::adaptive_count::{self, picture};
use octruss_host_tests::performance::inverse::{self, Sources};
use octruss_host_tests::performance::projection;
use octruss_host_tests::performance::skin;
use octruss_host_tests::qemu::controller;
use octruss_host_tests::qemu::demo::{self, Example, Summary};
use octruss_host_tests::qemu::holding;
use octruss_host_tests::qemu::judge::{Subject, judge};
use octruss_host_tests::qemu::palm;
use octruss_host_tests::qemu::{Machine, Run, image};

/// The processors whose instructions are counted.
const COUNTED: [Machine; 2] = [Machine::Mps2An386, Machine::Mps2An500];

/// The processors that core is held to the reference on: one without instructions for signal processing
/// too, where the kernels are the portable ones.
const JUDGED: [Machine; 3] = [Machine::Mps2An386, Machine::Mps2An500, Machine::Mps2An385];

/// The boards that the demo runs on; the figures are those of the first. The last has the memory of a
/// real part and none more.
const PLAYED: [Machine; 3] = [
    Machine::Mps2An386,
    Machine::Mps2An500,
    Machine::Netduinoplus2,
];

/// The shift of the instruction clock at which counts are exact.
const EXACT_SHIFT: u8 = 7;

/// Runs the firmware's images on emulated processors
#[derive(Parser)]
struct Arguments {
    #[command(subcommand)]
    job: Job,
}

#[derive(Subcommand)]
enum Job {
    /// Holds core on the processors, core on the host and the reference against one another
    Conformance {
        /// What the cases are about; everything if it is left out
        #[arg(long, value_delimiter = ',')]
        subjects: Vec<Subject>,
        /// How many random cases of each subject
        #[arg(long, default_value_t = 200)]
        cases: u32,
        /// The first seed; the others follow
        #[arg(long, default_value_t = 0)]
        seed: u32,
        /// Where the case files go
        #[arg(long)]
        directory: PathBuf,
    },
    /// Plays the demo, checks every coordinate and draws the picture
    Demo {
        /// Where finger.oct and finger.poses are, and where the picture goes
        #[arg(long)]
        directory: PathBuf,
        /// The cage
        #[arg(long)]
        cage: PathBuf,
        /// The model
        #[arg(long)]
        model: PathBuf,
    },
    /// Drives the interactive controller through a motion with disturbances, silence, a host that goes away, wrong
    /// frames, and replays it on another processor
    Controller {
        /// Where controller.oct is, and where the recorded run goes
        #[arg(long)]
        directory: PathBuf,
        /// The motion that the effectors follow
        #[arg(long)]
        motion: PathBuf,
        /// How many frames are sent that must be refused
        #[arg(long, default_value_t = 500)]
        wrong_frames: u32,
    },
    /// Lets the finger follow goals with its volume held and without, and draws both
    Holding {
        /// Where the files of the run and the pictures go
        #[arg(long)]
        directory: PathBuf,
        /// The folder with the example's cage, model, motion and what its controller is baked from
        #[arg(long, default_value = "models")]
        models: PathBuf,
    },
    /// Counts the triangles of adaptive square-root-3 and Loop meshes over tolerances, and draws them; runs on the host
    Adaptive {
        /// The folder with the example's control meshes
        #[arg(long, default_value = "models")]
        models: PathBuf,
        /// The picture
        #[arg(long, default_value = "docs/adaptive-triangles.png")]
        output: PathBuf,
    },
    /// Plays a minute of wind in a palm's leaves, holds every second against host and reference, and draws it
    Palm {
        /// Where palm.oct is
        #[arg(long)]
        directory: PathBuf,
        /// The palm's cage
        #[arg(long, default_value = "models/palm.msh")]
        cage: PathBuf,
        /// The palm's model
        #[arg(long, default_value = "models/palm.obj")]
        model: PathBuf,
        /// The picture
        #[arg(long)]
        picture: PathBuf,
        /// For how many seconds the reference is asked too
        #[arg(long, default_value_t = 8)]
        reference_seconds: u32,
    },
    /// Counts the instructions of ticks of the goals' solver
    Goals {
        /// Where the files of the run go
        #[arg(long)]
        directory: PathBuf,
        /// The folder with the example's cage, model, motion and what its controller is baked from
        #[arg(long, default_value = "models")]
        models: PathBuf,
    },
    /// Prints instructions a tap
    Bench,
    /// Moves a surface by its table and refines it on the device, frame by frame: how far the two are
    /// apart, against the bound, and what each costs
    Skin {
        /// Where the files of the run go
        #[arg(long)]
        directory: PathBuf,
        /// The control mesh
        #[arg(long)]
        mesh: PathBuf,
        /// A motion of its control points
        #[arg(long)]
        motion: PathBuf,
    },
}

fn main() -> ExitCode {
    let passed = match Arguments::parse().job {
        Job::Conformance {
            subjects,
            cases,
            seed,
            directory,
        } if subjects.is_empty() => conformance(Subject::value_variants(), cases, seed, &directory),
        Job::Conformance {
            subjects,
            cases,
            seed,
            directory,
        } => conformance(&subjects, cases, seed, &directory),
        Job::Demo {
            directory,
            cage,
            model,
        } => play(directory, cage, model),
        Job::Controller {
            directory,
            motion,
            wrong_frames,
        } => drive(&directory, &motion, wrong_frames),
        Job::Palm {
            directory,
            cage,
            model,
            picture,
            reference_seconds,
        } => blow(&directory, &cage, &model, &picture, reference_seconds),
        Job::Holding { directory, models } => hold(&directory, models),
        Job::Adaptive { models, output } => compare_adaptive(&models, &output),
        Job::Goals { directory, models } => goals(&directory, models),
        Job::Bench => bench(),
        Job::Skin {
            directory,
            mesh,
            motion,
        } => compare_skins(&directory, &mesh, &motion),
    };
    match passed {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

fn conformance(
    subjects: &[Subject],
    cases: u32,
    seed: u32,
    directory: &Path,
) -> Result<bool, demo::Failure> {
    let mut is_equal = true;
    println!("{cases} random cases of each subject, seeds from {seed}");
    for &subject in subjects {
        let started = Instant::now();
        let found = judge(subject, &JUDGED, directory, seed, cases)?;
        println!("{subject} ({:.1} s)", started.elapsed().as_secs_f32());
        println!("  host: {}", found.host);
        for (machine, verdict) in &found.machines {
            println!("  {} ({}): {verdict}", machine.processor(), machine.name());
        }
        is_equal &= found.is_equal();
    }
    Ok(is_equal)
}

fn play(directory: PathBuf, cage: PathBuf, model: PathBuf) -> Result<bool, demo::Failure> {
    let example = Example::read(&directory)?;
    let picture = directory.join("finger.png");
    let animations = ["finger.glb", "finger.pvd"].map(|name| directory.join(name));
    let mut played = Vec::new();
    for machine in PLAYED {
        let processor = machine.processor();
        println!(
            "The demo runs on an emulated {processor} ({}).",
            machine.name()
        );
        // The first run's log is shown; the others say the same.
        let is_first = played.is_empty();
        let run = demo::play(
            &example,
            machine,
            &machine.image("demo"),
            &directory,
            |message| {
                if is_first {
                    println!("  {:5} {}", message.level, message.text);
                }
            },
        )?;
        if is_first {
            demo::draw(&example, &run, &cage, &model, &picture)?;
            demo::animate(&example, &run, &model, &animations)?;
        }
        played.push(run);
    }
    let summary = Summary {
        cells: demo::cells(&cage)?,
        taps: example.taps(),
        played: &played,
        picture,
        animations: animations.to_vec(),
    };
    println!("\n{summary}");
    Ok(summary.mismatches() == 0)
}

/// Plays the palm on every board.
fn blow(
    directory: &Path,
    cage: &Path,
    model: &Path,
    picture: &Path,
    reference_seconds: u32,
) -> Result<bool, demo::Failure> {
    println!("A palm in the wind, for a minute of simulated time.");
    let minute = palm::minute(directory, reference_seconds)?;
    let count = minute.reference_seconds;
    let differing = minute.not_reference;
    println!("  reference: {differing} of {count} seconds differ from the host's");
    let mut holds = differing == 0 && minute.clamped == 0;
    for machine in PLAYED {
        let found = palm::play(machine, directory, &minute)?;
        println!(
            "  {} ({}): {} of {} hashes differ, {} ticks missed, {} coordinates clamped, at most {} us a tick",
            machine.processor(),
            machine.name(),
            found.differing,
            found.hashes,
            found.missed,
            found.clamped,
            found.busy_us
        );
        holds &= found.differing == 0 && found.missed == 0 && found.clamped == 0;
    }
    palm::draw(directory, cage, model, picture)?;
    println!("  picture: {}", picture.display());
    Ok(holds)
}

/// Prints what every run came to.
fn drive(directory: &Path, motion: &Path, wrong_frames: u32) -> Result<bool, demo::Failure> {
    println!("The controller is driven over the serial port.");
    let mut runs = Vec::new();
    controller::play(directory, motion, wrong_frames, &mut |run| {
        println!("\n{}\n", run.title);
        for line in run.report.words("mm").lines() {
            println!("  {line}");
        }
        let count = run.not_reference;
        println!("  reference   {count} records differ from the reference");
        for words in run.first.iter().chain(&run.failures) {
            println!("  FAILED      {words}");
        }
        runs.push(run);
    })?;
    let holds = runs.iter().all(controller::Driven::holds);
    let count: u64 = runs.iter().map(|run| run.report.compared).sum();
    let mismatches: u64 = runs
        .iter()
        .map(|run| run.report.mismatches + run.not_reference)
        .sum();
    let missed = runs.iter().map(|run| run.missed).max().unwrap_or(0);
    println!("\n{count} ticks, {mismatches} mismatches, {missed} ticks missed\n");
    Ok(holds)
}

fn compare_skins(directory: &Path, mesh: &Path, motion: &Path) -> Result<bool, demo::Failure> {
    let made = skin::make(directory, mesh, motion)?;
    let figures = skin::figures(directory)?;
    println!("{}", skin::section(&made, &figures)?);
    Ok(true)
}

fn compare_adaptive(models: &Path, output: &Path) -> Result<bool, demo::Failure> {
    let mut meshes = Vec::new();
    for mesh in adaptive_count::meshes::all(models)? {
        let counts = adaptive_count::counts(&mesh, Green::Halves);
        meshes.push((mesh, counts));
    }
    print!("{}", picture::table(&meshes));
    std::fs::write(output, picture::draw(&meshes)?)?;
    Ok(true)
}

/// The volume may be off by this part in a frame.
const VOLUME_LIMIT: f64 = 1e-4;

fn sources(models: PathBuf) -> Sources {
    Sources {
        cage: models.join("finger.msh"),
        model: models.join("finger.obj"),
        motion: models.join("finger-motion.csv"),
        folder: models,
    }
}

fn goals(directory: &Path, models: PathBuf) -> Result<bool, demo::Failure> {
    std::fs::create_dir_all(directory)?;
    let made = inverse::make(directory, &sources(models.clone()))?;
    let figures = inverse::figures(directory, "inverse")?;
    println!("{}", inverse::section(&made, &figures)?);
    let made = projection::make(directory, &sources(models))?;
    let figures = inverse::figures(directory, "projection")?;
    println!("{}", projection::section(&made, &figures)?);
    Ok(true)
}

fn hold(directory: &Path, models: PathBuf) -> Result<bool, demo::Failure> {
    let sources = sources(models);
    let runs = holding::play(directory, &sources)?;
    print!("{}", holding::draw(directory, &sources, &runs)?);
    let [held, free] = runs.map(|run| run.iter().map(|own| own.error.abs()).fold(0.0, f64::max));
    println!("greatest error of the volume: {held:.2e} held, {free:.2e} free");
    Ok(held <= VOLUME_LIMIT)
}

fn bench() -> Result<bool, demo::Failure> {
    for machine in COUNTED {
        println!(
            "{} ({}), instructions, exact:",
            machine.processor(),
            machine.name()
        );
        let run = Run::new(machine, image("bench")).instruction_shift(EXACT_SHIFT);
        run.on_message(|message| println!("  {}", message.text))
            .run()?;
    }
    Ok(true)
}
