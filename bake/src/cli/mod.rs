//! The commands: each reads files, calls the library, and writes files or prints figures.

mod any_scheme;
mod bake;
mod bake_surface;
mod checkerboard;
mod deform;
mod drive;
mod forms;
mod info;
mod locate;
mod poses;
mod progress;
mod refine;
mod refine_surface;
mod scheme;
mod slice;
mod source;
mod volume;

use clap::{Parser, Subcommand};
use octruss_bake::error::{Error, Result};
use serde::Serialize;
use std::process::ExitCode;

/// Bakes smooth volumetric deformations for microcontrollers.
///
/// A cage (a coarse mesh of tetrahedra, octahedra, prisms and hexahedra) and a model go in; a table of integer
/// weights comes out, which a device applies to the positions of the cage's vertices, the control
/// points, to move the model. All coordinates are in the unit of the files, whatever that is;
/// nothing is converted. Vertices, cells, points and frames are counted from 0. Results go to
/// standard output or the file named with -o; notes, warnings and errors go to standard error. The
/// exit status is 0 only on success.
#[derive(Parser)]
#[command(name = "octruss", version, max_term_width = 100)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    Info(info::Arguments),
    Refine(refine::Arguments),
    Bake(Box<bake::Arguments>),
    Deform(deform::Arguments),
    Locate(locate::Arguments),
    Slice(slice::Arguments),
    Checkerboard(checkerboard::Arguments),
    Poses(poses::Arguments),
    Drive(drive::Arguments),
    Volume(volume::Arguments),
    Forms(forms::Arguments),
}

/// Runs the command that the process was started with.
pub fn run() -> ExitCode {
    let outcome = match Arguments::parse().command {
        Command::Info(arguments) => info::run(&arguments),
        Command::Refine(arguments) => refine::run(&arguments),
        Command::Bake(arguments) => bake::run(&arguments),
        Command::Deform(arguments) => deform::run(&arguments),
        Command::Locate(arguments) => locate::run(&arguments),
        Command::Slice(arguments) => slice::run(&arguments),
        Command::Checkerboard(arguments) => checkerboard::run(&arguments),
        Command::Poses(arguments) => poses::run(&arguments),
        Command::Drive(arguments) => drive::run(&arguments),
        Command::Volume(arguments) => volume::run(&arguments),
        Command::Forms(arguments) => forms::run(&arguments),
    };
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

/// Tells the user what a reader left out.
fn show_notes(notes: &[String]) {
    for note in notes {
        eprintln!("note: {note}");
    }
}

/// Prints to standard output; a reader that has gone away is an error, not a crash.
fn print(text: &str) -> Result<()> {
    use std::io::Write;
    let mut out = std::io::stdout().lock();
    writeln!(out, "{text}")
        .and_then(|()| out.flush())
        .map_err(|error| Error::new(format!("cannot write to standard output: {error}")))
}

/// Prints figures as one JSON object, or in the words that `otherwise` gives.
fn print_figures(
    figures: &impl Serialize,
    json: bool,
    otherwise: impl FnOnce() -> String,
) -> Result<()> {
    if !json {
        return print(&otherwise());
    }
    let text = serde_json::to_string_pretty(figures)
        .map_err(|error| Error::new(format!("the figures cannot be written as JSON: {error}")))?;
    print(&text)
}
