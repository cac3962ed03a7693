//! Measures the apply beside its rivals and writes `docs/performance.md`. `cargo xtask bench` calls it; it
//! expects the images `rivals`, `refine`, `volume`, `skin` and `inverse` to be built.

use std::fs;
use std::hint::black_box;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};
use std::time::{Duration, Instant};

use clap::Parser;
use octruss::deform::Displacement;
use octruss_bake::bundle::BundleBytes;
use octruss_host_tests::performance::cycles::{
    Loop, c_loop, cycles_a_tap, cycles_by_manual, kernels,
};
use octruss_host_tests::performance::input::{Failure, Inputs, make};
use octruss_host_tests::performance::page::{Line, Measured, page};
use octruss_host_tests::performance::{inverse, projection, skin, volume};
use octruss_host_tests::qemu::{Machine, Run, image};

/// The shift of the instruction clock at which counts are exact.
const EXACT_SHIFT: u8 = 7;

/// The rival that ratios are to.
const RIVAL: &str = "float csr in C";

/// Measures the apply beside its rivals
#[derive(Parser)]
struct Arguments {
    /// Where the files of the run go; rivals.s, the compiler's assembly of the rivals, lies there
    #[arg(long)]
    directory: PathBuf,
    /// The cage
    #[arg(long)]
    cage: PathBuf,
    /// The model
    #[arg(long)]
    model: PathBuf,
    /// A motion of its control points, whose frames are the modes of the enclosed volume
    #[arg(long)]
    motion: PathBuf,
    /// The control mesh of a surface
    #[arg(long)]
    skin: PathBuf,
    /// A motion of its control points
    #[arg(long)]
    skin_motion: PathBuf,
    /// The page to write
    #[arg(long)]
    output: PathBuf,
}

fn main() -> ExitCode {
    match measure(&Arguments::parse()) {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

fn measure(arguments: &Arguments) -> Result<bool, Failure> {
    let inputs = make(&arguments.directory, &arguments.cage, &arguments.model)?;
    let enclosed = volume::make(
        &arguments.directory,
        &arguments.cage,
        &arguments.model,
        &arguments.motion,
    )?;
    let surface = skin::make(
        &arguments.directory,
        &arguments.skin,
        &arguments.skin_motion,
    )?;
    let folder = arguments.cage.parent().unwrap_or(Path::new(""));
    let sources = inverse::Sources {
        cage: arguments.cage.clone(),
        model: arguments.model.clone(),
        motion: arguments.motion.clone(),
        folder: folder.to_owned(),
    };
    let controlled = inverse::make(&arguments.directory, &sources)?;
    let limited = projection::make(&arguments.directory, &sources)?;
    let run = || -> Result<Figures, Failure> {
        let images = [
            "rivals",
            "refine",
            "volume",
            "skin",
            "inverse",
            "projection",
        ];
        let all: Result<Vec<_>, _> = images
            .map(|name| figures(arguments, name))
            .into_iter()
            .collect();
        Ok(all?.concat())
    };
    let first = run()?;
    let is_repeatable = run()? == first;
    let assembly = fs::read_to_string(arguments.directory.join("rivals.s"))?;
    let mut loops = kernels()?;
    loops.push(c_loop(&assembly, "rival_csr")?);
    let named = |name: &str| first.iter().find(|(found, _)| found == name);
    let names = [
        RIVAL,
        "float csr in Rust",
        "float grouped in C",
        "dense q31 in C",
        "q30",
        "q30 absolute",
        "q14",
        "q14 absolute",
        "compact",
        "q30-factored",
        "q14-factored",
        "compact-factored",
    ];
    let mut lines = Vec::new();
    for name in names {
        let (_, instructions) = named(name).ok_or("the image does not report all loops")?;
        let code = loops.iter().find(|code| code.name == name);
        let cycles = |processor| code.and_then(|code: &Loop| cycles_a_tap(code, processor));
        lines.push(Line {
            name: name.to_owned(),
            instructions: *instructions,
            cycles: [cycles("cortex-m4"), cycles("cortex-m7")],
            by_manual: code.map(cycles_by_manual),
        });
    }
    let measured = Measured {
        host: host(&inputs, &arguments.directory)?,
        inputs: &inputs,
        lines,
        others: first.clone(),
        is_repeatable,
    };
    let mut text = page(&measured);
    text += &volume::section(&enclosed, &first)?;
    text += &skin::section(&surface, &first)?;
    text += &inverse::section(&controlled, &first)?;
    text += &projection::section(&limited, &first)?;
    println!("{text}");
    fs::write(&arguments.output, text)?;
    Ok(is_repeatable)
}

/// Figures by name.
type Figures = Vec<(String, u64)>;

/// The figures of one run of an image on the emulated Cortex-M4.
fn figures(arguments: &Arguments, name: &str) -> Result<Figures, Failure> {
    let outcome = Run::new(Machine::Mps2An386, image(name))
        .directory(&arguments.directory)
        .instruction_shift(EXACT_SHIFT)
        .time_limit(Duration::from_secs(300))
        .run()?;
    let messages = outcome.log.messages.iter();
    let figure = |text: &str| {
        let (name, value) = octruss_firmware::exit::parse_figure(text)?;
        Some((name.to_owned(), value))
    };
    Ok(messages
        .filter_map(|message| figure(&message.text))
        .collect())
}

/// Rows a second on this machine, one thread: core in every format, and the rivals.
fn host(inputs: &Inputs, directory: &Path) -> Result<Vec<(String, f64)>, Failure> {
    let mut lines = Vec::new();
    for (name, file) in [("q30", "q30.oct"), ("q14", "q14.oct")] {
        let bytes = BundleBytes::read(&directory.join(file))?;
        let bundle = bytes.open()?;
        let table = bundle.table::<i32>()?;
        let pose = bundle.rest_cage();
        let mut out = vec![[0; 3]; table.rows()];
        let rows = rows_a_second(inputs.rows, || {
            let applied = table.apply(0..table.rows(), black_box(pose), &mut out);
            black_box(applied.is_ok());
        });
        lines.push((name.to_owned(), rows));
    }
    let bytes = BundleBytes::read(&directory.join("compact.oct"))?;
    let bundle = bytes.open()?;
    let table = bundle.compact_table::<i32>()?;
    let pose = bundle.rest_cage();
    let mut out = vec![[0; 3]; table.rows()];
    let mut memory = vec![Displacement::default(); pose.len()];
    let rows = rows_a_second(inputs.rows, || {
        let moved = table.displacements(black_box(pose), &mut memory);
        let applied = moved.and_then(|moved| table.apply(0..table.rows(), &moved, &mut out));
        black_box(applied.is_ok());
    });
    lines.push(("compact".to_owned(), rows));
    lines.extend(peers(directory)?);
    Ok(lines)
}

/// What the program `host_rivals` prints: a name, an equals sign and rows a second in each line. Nothing if
/// it was not built.
fn peers(directory: &Path) -> Result<Vec<(String, f64)>, Failure> {
    let program = directory.join("host_rivals");
    if !program.is_file() {
        println!("The rivals on the host are left out: there is no C++ compiler.");
        return Ok(Vec::new());
    }
    let output = Command::new(program)
        .arg(directory.join("rivals.bin"))
        .output()?;
    let text = String::from_utf8(output.stdout)?;
    let line = |line: &str| {
        let (name, value) = line.split_once('=')?;
        Some((name.to_owned(), value.parse().ok()?))
    };
    let lines: Option<Vec<(String, f64)>> = text.lines().map(line).collect();
    Ok(lines.ok_or("host_rivals prints something else than figures")?)
}

/// The best of some runs.
fn rows_a_second(rows: usize, mut work: impl FnMut()) -> f64 {
    const RUNS: usize = 300;
    let times = (0..RUNS).map(|_| {
        let start = Instant::now();
        work();
        start.elapsed()
    });
    let best = times.min().unwrap_or_default().as_secs_f64();
    rows as f64 / best.max(1e-9)
}
