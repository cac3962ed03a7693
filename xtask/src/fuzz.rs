//! Feeds the readers and the opening of bundles with what a fuzzer makes up: see `fuzz/README.md`.

use crate::command::{Failure, Program};
use crate::setup::{self, Need};
use crate::workspace;

/// Runs the named targets, or all of them, each on so many inputs.
pub fn run(names: &[String], runs: u64) -> Result<(), Failure> {
    setup::ensure(&[Need::Fuzzer])?;
    let listed = fuzz("list").output().ok_or("`cargo fuzz list` failed")?;
    let targets: Vec<&str> = listed.split_whitespace().collect();
    if let Some(unknown) = names.iter().find(|name| !targets.contains(&name.as_str())) {
        return Err(format!(
            "there is no fuzz target {unknown}; there are {}",
            targets.join(", ")
        ));
    }
    let is_asked = |target: &&&str| names.is_empty() || names.iter().any(|name| name == *target);
    for target in targets.iter().filter(is_asked) {
        run_target(target, runs)?;
    }
    Ok(())
}

fn run_target(target: &str, runs: u64) -> Result<(), Failure> {
    // The first folder is read and written, the second, which is kept, only read.
    let found = workspace::target()?
        .join("fuzz")
        .join("corpus")
        .join(target);
    std::fs::create_dir_all(&found)
        .map_err(|error| format!("cannot make {}: {error}", found.display()))?;
    let runs = format!("-runs={runs}");
    fuzz("run")
        .args(["--sanitizer", "none", target])
        .args([found])
        .args([workspace::root().join("fuzz").join("corpus").join(target)])
        .args(["--", &runs, "-max_len=4096", "-timeout=10"])
        .args(["-rss_limit_mb=1024", "-print_final_stats=1", "-verbosity=0"])
        .env("CARGO_TARGET_DIR", workspace::target()?.join("fuzz"))
        .run()
}

/// A command of cargo-fuzz.
fn fuzz(command: &str) -> Program {
    Program::cargo().args(["fuzz", command])
}
