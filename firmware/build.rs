//! Hands the linker its scripts (`memory.x` of the workspace root with the board's memory from
//! `memory/`, `link.x` of `cortex-m-rt` and, for the images that log, `defmt.x` of `defmt`), and tells
//! the images that hold the example where it was baked to.
//!
//! The flags belong to this package's Cortex-M images alone, so nothing that is built for the
//! host, and no other package, sees them.

use std::env;
use std::fs;
use std::path::{Path, PathBuf};

/// The images that log through `defmt`. `apply` does not: it holds the apply path alone.
const LOGGING_IMAGES: [&str; 11] = [
    "bench",
    "conformance",
    "controller",
    "demo",
    "faults",
    "holding",
    "inverse",
    "palm",
    "projection",
    "skin",
    "volume",
];

/// Where the C library of the image `rivals` is.
const RIVALS_DIRECTORY: &str = "OCTRUSS_RIVALS_DIR";

/// The directory of the baked example; `target/demo` in the workspace if it is not set.
const DEMO_DIRECTORY: &str = "OCTRUSS_DEMO_DIR";

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rustc-check-cfg=cfg(demo_is_baked)");
    if env::var("CARGO_CFG_TARGET_OS").as_deref() != Ok("none") {
        return;
    }
    let package = PathBuf::from(variable("CARGO_MANIFEST_DIR"));
    let workspace = package.parent().unwrap_or(&package);
    link(workspace);
    find_demo(workspace);
    if env::var_os("CARGO_FEATURE_RIVALS").is_some() {
        println!("cargo::rerun-if-env-changed={RIVALS_DIRECTORY}");
        println!("cargo::rustc-link-search={}", variable(RIVALS_DIRECTORY));
        println!("cargo::rustc-link-arg-bin=rivals=-Tdefmt.x");
        println!("cargo::rustc-link-arg-bin=refine=-Tdefmt.x");
    }
}

fn link(workspace: &Path) {
    let out = PathBuf::from(variable("OUT_DIR"));
    let board = match env::var_os("CARGO_FEATURE_BOARD_NETDUINOPLUS2") {
        Some(_) => "netduinoplus2",
        None => "mps2",
    };
    let boards = Path::new(&variable("CARGO_MANIFEST_DIR")).join("memory");
    copy(&workspace.join("memory.x"), &out.join("memory.x"));
    copy(
        &boards.join(format!("{board}.x")),
        &out.join("board-memory.x"),
    );
    println!("cargo::rustc-link-search={}", out.display());

    // The start of flash must not share a page with the file's headers.
    println!("cargo::rustc-link-arg-bins=--nmagic");
    println!("cargo::rustc-link-arg-bins=-Tlink.x");
    for image in LOGGING_IMAGES {
        println!("cargo::rustc-link-arg-bin={image}=-Tdefmt.x");
    }
}

/// Copies a linker script to where the linker looks.
fn copy(from: &Path, to: &Path) {
    println!("cargo::rerun-if-changed={}", from.display());
    if let Err(error) = fs::copy(from, to) {
        panic!(
            "cannot copy {} to {}: {error}",
            from.display(),
            to.display()
        );
    }
}

/// Says where the baked example is, if it is there. The images that need it say what to do if it
/// is not; the others build without it.
fn find_demo(workspace: &Path) {
    println!("cargo::rerun-if-env-changed={DEMO_DIRECTORY}");
    let directory = env::var_os(DEMO_DIRECTORY).map_or_else(
        || workspace.join("target").join("demo"),
        |directory| workspace.join(directory),
    );
    let files = ["finger.oct", "finger.poses", "controller.oct", "palm.oct"]
        .map(|name| directory.join(name));
    for file in &files {
        println!("cargo::rerun-if-changed={}", file.display());
    }
    if files.iter().all(|file| file.is_file()) {
        println!("cargo::rustc-cfg=demo_is_baked");
        println!("cargo::rustc-env={DEMO_DIRECTORY}={}", directory.display());
    }
}

/// A variable that cargo always sets for a build script.
fn variable(name: &str) -> String {
    env::var(name).unwrap_or_else(|error| panic!("{name} is not set: {error}"))
}
