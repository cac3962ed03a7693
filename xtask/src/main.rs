//! Sets a machine up for octruss and runs its jobs: `cargo xtask --help`.
//!
//! This program compiles in seconds and only starts others (cargo, rustup, the system's package
//! manager); what computes lives in the packages that it builds and runs.

mod command;
mod fuzz;
mod image_check;
mod jobs;
mod kernel_check;
mod setup;
mod steps;
mod workspace;

use std::process::ExitCode;

use clap::{Parser, Subcommand};

/// The jobs of octruss. Each installs first what it needs and says so.
#[derive(Parser)]
#[command(name = "cargo xtask", bin_name = "cargo xtask", version)]
struct Arguments {
    #[command(subcommand)]
    job: Job,
}

#[derive(Subcommand)]
enum Job {
    /// Installs what is missing: Rust targets and components, the emulator
    Setup,
    /// Bakes the examples, bends the finger, drives the controller and blows at the palm on emulated boards, and checks
    /// every bit
    Demo,
    /// Runs the tests: on the host, then on emulated Cortex-M4 and Cortex-M7 processors
    Test,
    /// Everything that must hold before a change is accepted
    Ci,
    /// The long proofs: many random cases on the host and on the emulated processors
    Verify {
        /// How many random cases of each subject; one in ten is damaged on purpose
        #[arg(long, default_value_t = 12_000)]
        cases: u32,
        /// The seed of the first case; the others follow
        #[arg(long, default_value_t = 0)]
        seed: u32,
    },
    /// Looks into the code that the compiler made of the kernels
    Kernels,
    /// Every format beside what one would write instead: bytes, instructions, estimated cycles; remakes docs/performance.md
    Bench,
    /// Seconds, microseconds a point and memory that baking takes, by the size of the model
    BenchBake,
    /// Feeds every reader, and the opening and applying of bundles, with made-up bytes
    Fuzz {
        /// The targets; all of them if none is named
        targets: Vec<String>,
        /// How many inputs each target gets
        #[arg(long, default_value_t = 1_000_000)]
        runs: u64,
    },
}

fn main() -> ExitCode {
    let done = match Arguments::parse().job {
        Job::Setup => setup::run(),
        Job::Demo => jobs::demo(),
        Job::Test => jobs::test(),
        Job::Ci => jobs::ci(),
        Job::Verify { cases, seed } => jobs::verify(cases, seed),
        Job::Kernels => jobs::kernels(),
        Job::Bench => jobs::bench(),
        Job::BenchBake => jobs::bench_bake(),
        Job::Fuzz { targets, runs } => fuzz::run(&targets, runs),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}
