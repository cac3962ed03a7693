//! Where things are.

use std::env;
use std::path::{Path, PathBuf};

use crate::command::{Failure, Program};

/// The target of the firmware images.
pub const IMAGE_TARGET: &str = "thumbv7em-none-eabihf";
/// The target of the images for a processor without instructions for signal processing, Cortex-M3.
pub const IMAGE_TARGET_WITHOUT_DSP: &str = "thumbv7m-none-eabi";
/// The targets that `core` must build for: Cortex-M4 and M7, Cortex-M3, Cortex-M0, RISC-V.
pub const CORE_TARGETS: [&str; 4] = [
    IMAGE_TARGET,
    IMAGE_TARGET_WITHOUT_DSP,
    "thumbv6m-none-eabi",
    "riscv32imac-unknown-none-elf",
];

/// The root of the workspace: where this package's folder is. Cargo says so when it runs us; else
/// it is the current directory.
pub fn root() -> PathBuf {
    env::var_os("CARGO_MANIFEST_DIR")
        .and_then(|package| Path::new(&package).parent().map(Path::to_path_buf))
        .unwrap_or_else(|| PathBuf::from("."))
}

/// The directory that cargo builds in, wherever the user has put it.
pub fn target() -> Result<PathBuf, Failure> {
    let metadata = Program::cargo()
        .args([
            "metadata",
            "--format-version",
            "1",
            "--no-deps",
            "--offline",
        ])
        .output()
        .ok_or("`cargo metadata` failed: is this a checkout of octruss?")?;
    let key = "\"target_directory\":\"";
    let path = metadata
        .split_once(key)
        .and_then(|(_, rest)| rest.split_once('"'))
        .ok_or("`cargo metadata` does not name its target directory")?;
    Ok(PathBuf::from(path.0.replace("\\\\", "\\")))
}

/// The directory of the firmware images.
pub fn images() -> Result<PathBuf, Failure> {
    Ok(target()?.join(IMAGE_TARGET).join("release"))
}

/// The directory that the example is baked to and played from.
pub fn example() -> Result<PathBuf, Failure> {
    Ok(target()?.join("demo"))
}

/// A folder of the Rust toolchain for the target `name`, where rustup keeps what belongs to it.
pub fn toolchain_folder(name: &str) -> Result<PathBuf, Failure> {
    let sysroot = Program::new("rustc")
        .args(["--print", "sysroot"])
        .output()
        .ok_or("rustc does not run: install Rust from https://rustup.rs")?;
    Ok(Path::new(sysroot.trim())
        .join("lib")
        .join("rustlib")
        .join(name))
}

/// A program of rustup's component `llvm-tools`.
pub fn llvm_tool(name: &str) -> Result<PathBuf, Failure> {
    let host = Program::new("rustc")
        .args(["--print", "host-tuple"])
        .output()
        .ok_or("rustc does not run: install Rust from https://rustup.rs")?;
    let folder = toolchain_folder(host.trim())?;
    Ok(folder
        .join("bin")
        .join(format!("{name}{}", env::consts::EXE_SUFFIX)))
}
