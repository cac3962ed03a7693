//! Measures the apply beside its rivals and writes `docs/performance.md`. `cargo xtask bench` calls it; it
//! expects the image `rivals` to be built.

use std::fs;
use std::hint::black_box;
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::{Duration, Instant};

use clap::Parser;
use octruss_bake::bundle::BundleBytes;
use octruss_host_tests::performance::cycles::{Loop, c_loop, cycles_a_tap, kernels};
use octruss_host_tests::performance::input::{Failure, Inputs, make};
use octruss_host_tests::performance::page::{Line, Measured, page};
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
    let first = figures(arguments)?;
    let is_repeatable = figures(arguments)? == first;
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
        });
    }
    let measured = Measured {
        host: host(&inputs)?,
        inputs: &inputs,
        lines,
        is_repeatable,
    };
    let text = page(&measured);
    println!("{text}");
    fs::write(&arguments.output, text)?;
    Ok(is_repeatable)
}

/// The figures of one run of the image on the emulated Cortex-M4.
fn figures(arguments: &Arguments) -> Result<Vec<(String, u64)>, Failure> {
    let outcome = Run::new(Machine::Mps2An386, image("rivals"))
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

/// Rows a second on this machine: core with 30-bit weights, and the real rows in floating point.
fn host(inputs: &Inputs) -> Result<[f64; 2], Failure> {
    let bytes = BundleBytes::new(&inputs.q30);
    let bundle = bytes.open()?;
    let table = bundle.table::<i32>()?;
    let pose = bundle.rest_cage().to_vec();
    let mut out = vec![[0; 3]; table.rows()];
    let core = rows_a_second(inputs.rows, || {
        let applied = table.apply(0..table.rows(), black_box(&pose), &mut out);
        black_box(applied.is_ok());
    });
    let pose: Vec<[f32; 3]> = pose
        .iter()
        .map(|point| point.map(|bits| bits as f32))
        .collect();
    let rows: Vec<Vec<(usize, f32)>> = inputs
        .real
        .iter()
        .map(|row| {
            row.iter()
                .map(|&(point, weight)| (point as usize, weight as f32))
                .collect()
        })
        .collect();
    let mut out = vec![[0.0_f32; 3]; rows.len()];
    let float = rows_a_second(inputs.rows, || {
        for (slot, row) in out.iter_mut().zip(black_box(&rows)) {
            let mut sum = [0.0; 3];
            for &(point, weight) in row {
                for (sum, coordinate) in sum.iter_mut().zip(pose[point]) {
                    *sum += weight * coordinate;
                }
            }
            *slot = sum;
        }
        black_box(&out);
    });
    Ok([core, float])
}

/// The best of some runs.
fn rows_a_second(rows: usize, mut work: impl FnMut()) -> f64 {
    const RUNS: usize = 30;
    let times = (0..RUNS).map(|_| {
        let start = Instant::now();
        work();
        start.elapsed()
    });
    let best = times.min().unwrap_or_default().as_secs_f64();
    rows as f64 / best.max(1e-9)
}
