//! `octruss`: the command line of the host tools.

mod cli;

use std::process::ExitCode;

fn main() -> ExitCode {
    cli::run()
}
