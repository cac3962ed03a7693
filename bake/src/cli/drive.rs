//! `octruss drive`.

use super::print_figures;
use indicatif::{ProgressBar, ProgressStyle};
use octruss::bundle::Bundle;
use octruss_bake::bundle::BundleBytes;
use octruss_bake::drive::goals;
use octruss_bake::drive::mirror::{Mirror, MirrorMemory};
use octruss_bake::drive::port::{self, Port};
use octruss_bake::drive::record::{self, Line};
use octruss_bake::drive::report::{Collector, Report};
use octruss_bake::drive::run::{self, Plan};
use octruss_bake::drive::session::Session;
use octruss_bake::error::{Error, Result};
use octruss_firmware::link::Telemetry;
use std::path::PathBuf;
use std::time::{SystemTime, UNIX_EPOCH};

/// Drives a running controller
///
/// Restarts the controller that runs the image `controller`, sends effectors' goals tick by tick, and shows volume,
/// effectors' error and timing while it moves. The controller's code runs on this machine too: every checksum, volume
/// and output that the device reports is compared. A recorded run replays to the same bits; without a device
/// (neither --tcp nor --port) a replay is held against this machine alone.
#[derive(clap::Args)]
pub struct Arguments {
    /// The bundle that the device runs, baked with --modes, --actuators and --effectors
    #[arg(long, value_name = "BUNDLE")]
    bundle: PathBuf,
    /// The device's serial port behind TCP, as an emulator offers it: HOST:PORT
    #[arg(long, value_name = "HOST:PORT", conflicts_with = "port")]
    tcp: Option<String>,
    /// The device's serial port
    #[arg(long, value_name = "PORT")]
    port: Option<String>,
    /// The rate of the serial port
    #[arg(long, default_value_t = 1_000_000)]
    baud: u32,
    /// Goals of the effectors: a .csv with the columns frame, point, x, y, z; points are effectors, counted from 0 in
    /// the order of baking
    #[arg(long, value_name = "GOALS.csv")]
    goals: Option<PathBuf>,
    /// A motion of all control points; the goals are where it takes the effectors
    #[arg(long, value_name = "MOTION", conflicts_with = "goals")]
    motion: Option<PathBuf>,
    /// A recorded run to repeat
    #[arg(long, value_name = "RUN.csv", conflicts_with_all = ["goals", "motion"])]
    replay: Option<PathBuf>,
    /// Where to record the run
    #[arg(long, value_name = "RUN.csv")]
    record: Option<PathBuf>,
    /// Ticks from a frame of goals to the next
    #[arg(long, default_value_t = 8, value_parser = clap::value_parser!(u32).range(1..=10_000))]
    ticks_a_frame: u32,
    /// Ticks from one set of goals that is sent to the next; a line of 1 000 000 baud does 1, an emulator's about 4
    #[arg(long, default_value_t = 4, value_parser = clap::value_parser!(u32).range(1..=10_000))]
    every: u32,
    /// Ticks to stay at the last goals
    #[arg(long, default_value_t = 50, value_parser = clap::value_parser!(u32).range(..=1_000_000))]
    rest: u32,
    /// Ticks of silence after which the device holds the pose; 0 for never
    #[arg(long, default_value_t = 50)]
    silence: u32,
    /// Print the figures as one JSON object
    #[arg(long)]
    json: bool,
}

/// Runs the command.
pub fn run(arguments: &Arguments) -> Result<()> {
    let bytes = BundleBytes::read(&arguments.bundle)?;
    let bundle = bytes
        .open()
        .map_err(|error| error.in_file(&arguments.bundle))?;
    let mut memory = MirrorMemory::of(&bundle);
    let mut mirror =
        Mirror::new(&bundle, &mut memory).map_err(|error| error.in_file(&arguments.bundle))?;
    let recorded = match &arguments.replay {
        Some(file) => Some(record::read(file, &bundle)?),
        None => None,
    };
    let plan = plan(arguments, &bundle, &mirror, recorded.as_deref())?;
    let bits = bundle.header().fraction_bits.get();
    let mut collector = Collector::new(mirror.parts(), bits);
    let line = open(arguments)?;
    let (lines, is_on_device) = match (line, &recorded) {
        (Some(port), _) => {
            let mut session = Session::new(port, first_sequence());
            let lines = shown(&mut session, &mut mirror, plan, &mut collector, &bundle)?;
            (lines, true)
        }
        (None, Some(recorded)) => (repeat(recorded, &mut mirror, &mut collector), false),
        (None, None) => {
            return Err(Error::new("no device is named").advise(
                "give --tcp HOST:PORT, or --port with the serial port that the board is at",
            ));
        }
    };
    if is_on_device && let Some(recorded) = &recorded {
        let pairs = recorded.iter().zip(&lines);
        let differing = pairs.filter(|(was, is)| was != is).count();
        let missing = recorded.len().abs_diff(lines.len());
        (0..differing + missing).for_each(|_| collector.not_as_recorded());
    }
    if let Some(file) = &arguments.record {
        record::write(file, &bundle, &lines)?;
    }
    finish(&collector.finish(&mirror), arguments, &bundle)
}

/// Prints the figures; a device that does otherwise than this machine is an error.
fn finish(report: &Report, arguments: &Arguments, bundle: &Bundle<'_>) -> Result<()> {
    print_figures(report, arguments.json, || report.words(bundle.unit()))?;
    if report.agrees() {
        return Ok(());
    }
    let late = report.faults.get("rejected").copied().unwrap_or(0);
    let advice = if late == 0 {
        "is the device's bundle this one, and its image of this version?"
    } else {
        "commands came after their tick: this machine or the line was too slow, try again"
    };
    Err(Error::new("the device did not do what this machine says").advise(advice))
}

/// What is to be done.
fn plan(
    arguments: &Arguments,
    bundle: &Bundle<'_>,
    mirror: &Mirror<'_, '_>,
    recorded: Option<&[Line]>,
) -> Result<Plan> {
    if let Some(recorded) = recorded {
        return Plan::replay(recorded);
    }
    let frames = match (&arguments.goals, &arguments.motion) {
        (Some(file), _) => goals::from_effectors(file, bundle, mirror.parts())?,
        (None, Some(file)) => goals::from_motion(file, bundle, mirror.parts())?,
        (None, None) => {
            return Err(Error::new("there is nothing to do")
                .advise("give --goals, --motion or --replay with a file"));
        }
    };
    let all = goals::between(&frames, arguments.ticks_a_frame);
    Ok(Plan::follow(
        &all,
        arguments.every,
        arguments.rest,
        arguments.silence,
    ))
}

fn open(arguments: &Arguments) -> Result<Option<Port>> {
    match (&arguments.tcp, &arguments.port) {
        (Some(address), _) => port::tcp(address).map(Some),
        (None, Some(path)) => port::serial(path, arguments.baud).map(Some),
        (None, None) => Ok(None),
    }
}

/// A number that the last program on the line hardly had last: a restart with that number would count as repeated.
fn first_sequence() -> u16 {
    let now = SystemTime::now().duration_since(UNIX_EPOCH);
    // Any number does.
    now.map_or(0, |now| now.subsec_micros() as u16)
}

/// Runs with a line of figures on standard error, if that is a terminal.
fn shown(
    session: &mut Session,
    mirror: &mut Mirror<'_, '_>,
    plan: Plan,
    collector: &mut Collector,
    bundle: &Bundle<'_>,
) -> Result<Vec<Line>> {
    let bar = ProgressBar::new(u64::from(plan.last));
    let style = ProgressStyle::with_template("[{bar:20}] tick {pos}/{len}  {wide_msg}");
    if let Ok(style) = style {
        bar.set_style(style.progress_chars("=> "));
    }
    let unit = bundle.unit();
    let lines = run::run(
        session,
        mirror,
        plan,
        collector,
        &mut |record, collector, _| {
            bar.set_position(u64::from(record.tick));
            bar.set_message(figures(record, collector, unit));
            Ok(())
        },
    );
    bar.finish_and_clear();
    lines
}

/// The figures of one tick on one line.
fn figures(record: &Telemetry, collector: &Collector, unit: &str) -> String {
    let volume = match collector.volume_error(record.volume) {
        Some(off) => format!("volume {off:+.1e}  "),
        None => String::new(),
    };
    let is = |flag, words| if record.flags & flag == 0 { "" } else { words };
    format!(
        "{volume}effectors {:.3} {unit}  busy {} us  missed {}  refused {}{}{}",
        collector.length(record.effector_error),
        record.busy_us,
        record.missed,
        record.faults.refused(),
        is(Telemetry::HELD, "  held"),
        is(Telemetry::SILENT, " (host silent)"),
    )
}

/// Repeats a run on this machine.
fn repeat(recorded: &[Line], mirror: &mut Mirror<'_, '_>, collector: &mut Collector) -> Vec<Line> {
    let mut lines = Vec::new();
    for line in recorded {
        let moved = mirror.advance(&line.commands);
        if !line.is_like(&moved) {
            collector.not_as_recorded();
        }
        let flags = if moved.is_held { Telemetry::HELD } else { 0 };
        collector.take(&Telemetry {
            tick: line.tick,
            flags,
            volume: moved.volume,
            effector_error: moved.effector_error,
            ..Telemetry::default()
        });
        lines.push(Line {
            tick: line.tick,
            commands: line.commands.clone(),
            pose: moved.pose_hash,
            model: moved.skin_hash,
            volume: moved.volume,
        });
    }
    lines
}
