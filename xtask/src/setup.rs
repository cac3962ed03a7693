//! Installs what the jobs need and the machine lacks.
//!
//! Rust's own parts come through rustup; the emulator comes through the system's package manager.
//! What cannot be installed is said in a sentence that tells what to do by hand.

use crate::command::{Failure, Program};
use crate::workspace::{self, CORE_TARGETS};

/// What a job needs beyond cargo and a host compiler.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Need {
    /// The Rust targets of the firmware and of core.
    Targets,
    /// rustup's component `llvm-tools`, to look into images.
    LlvmTools,
    /// `cargo fmt`.
    Rustfmt,
    /// `cargo clippy`.
    Clippy,
    /// `qemu-system-arm`.
    Emulator,
    /// `arm-none-eabi-gcc` and `llvm-mca`, for the rivals of the benchmark alone.
    ArmCompiler,
    /// `cargo fuzz`, for the fuzz targets alone.
    Fuzzer,
}

/// Everything that any job needs.
const ALL: [Need; 5] = [
    Need::Targets,
    Need::LlvmTools,
    Need::Rustfmt,
    Need::Clippy,
    Need::Emulator,
];

/// Installs everything that any job needs.
pub fn run() -> Result<(), Failure> {
    ensure(&ALL)?;
    println!("Everything that octruss needs is here.");
    Ok(())
}

/// Installs those of `needs` that are missing.
pub fn ensure(needs: &[Need]) -> Result<(), Failure> {
    needs.iter().try_for_each(|need| match need {
        Need::Targets => CORE_TARGETS
            .iter()
            .try_for_each(|target| ensure_target(target)),
        Need::LlvmTools => ensure_component("llvm-tools", || {
            Ok(workspace::llvm_tool("llvm-objdump")?.is_file())
        }),
        Need::Rustfmt => ensure_component("rustfmt", || Ok(cargo_has("fmt"))),
        Need::Clippy => ensure_component("clippy", || Ok(cargo_has("clippy"))),
        Need::Emulator => ensure_emulator(),
        Need::ArmCompiler => ensure_arm_compiler(),
        Need::Fuzzer => ensure_fuzzer(),
    })
}

fn ensure_target(target: &str) -> Result<(), Failure> {
    if workspace::toolchain_folder(target)?.join("lib").is_dir() {
        return Ok(());
    }
    println!("The Rust target {target} is missing; rustup installs it.");
    rustup(&["target", "add", target])
}

fn ensure_component(
    component: &str,
    is_there: impl Fn() -> Result<bool, Failure>,
) -> Result<(), Failure> {
    if is_there()? {
        return Ok(());
    }
    println!("The Rust component {component} is missing; rustup installs it.");
    rustup(&["component", "add", component])?;
    if is_there()? {
        return Ok(());
    }
    Err(format!(
        "rustup installed {component}, but it still does not run"
    ))
}

fn ensure_fuzzer() -> Result<(), Failure> {
    if cargo_has("fuzz") {
        return Ok(());
    }
    println!("cargo-fuzz is missing; cargo installs it.");
    Program::cargo()
        .args(["install", "--locked", "cargo-fuzz"])
        .run()
}

/// Whether cargo knows the subcommand. A rustup proxy without its component fails too.
fn cargo_has(subcommand: &str) -> bool {
    Program::cargo()
        .args([subcommand, "--version"])
        .output()
        .is_some()
}

fn rustup(arguments: &[&str]) -> Result<(), Failure> {
    if !Program::new("rustup").args(["--version"]).exists() {
        return Err(format!(
            "rustup is not installed, so `rustup {}` cannot be run. Install Rust from \
             https://rustup.rs, or add the part through the system that brought your Rust.",
            arguments.join(" ")
        ));
    }
    Program::new("rustup").args(arguments).run()
}

/// A package manager and how it installs the emulator for Arm boards.
struct PackageManager {
    program: &'static str,
    /// Fetches the current list of packages, where that is a step of its own.
    refresh: Option<&'static [&'static str]>,
    install: &'static [&'static str],
    /// The packages of the C compiler for Cortex-M and of `llvm-mca`.
    arm_compiler: &'static [&'static str],
    needs_root: bool,
}

const PACKAGE_MANAGERS: [PackageManager; 6] = [
    PackageManager {
        program: "apt-get",
        refresh: Some(&["update"]),
        install: &[
            "install",
            "--yes",
            "--no-install-recommends",
            "qemu-system-arm",
        ],
        arm_compiler: &["gcc-arm-none-eabi", "llvm"],
        needs_root: true,
    },
    PackageManager {
        program: "dnf",
        refresh: None,
        install: &["install", "--assumeyes", "qemu-system-arm"],
        arm_compiler: &["arm-none-eabi-gcc-cs", "llvm"],
        needs_root: true,
    },
    PackageManager {
        program: "pacman",
        refresh: None,
        install: &[
            "--sync",
            "--refresh",
            "--needed",
            "--noconfirm",
            "qemu-system-arm",
        ],
        arm_compiler: &["arm-none-eabi-gcc", "llvm"],
        needs_root: true,
    },
    PackageManager {
        program: "zypper",
        refresh: Some(&["--non-interactive", "refresh"]),
        install: &["--non-interactive", "install", "qemu-arm"],
        arm_compiler: &["cross-arm-none-gcc14", "llvm"],
        needs_root: true,
    },
    PackageManager {
        program: "apk",
        refresh: Some(&["update"]),
        install: &["add", "qemu-system-arm"],
        arm_compiler: &["gcc-arm-none-eabi", "llvm"],
        needs_root: true,
    },
    PackageManager {
        program: "brew",
        refresh: None,
        install: &["install", "qemu"],
        arm_compiler: &["arm-none-eabi-gcc", "llvm"],
        needs_root: false,
    },
];

fn emulator_is_there() -> bool {
    Program::new("qemu-system-arm")
        .args(["--version"])
        .output()
        .is_some()
}

fn ensure_emulator() -> Result<(), Failure> {
    if emulator_is_there() {
        return Ok(());
    }
    let Some(manager) = PACKAGE_MANAGERS
        .iter()
        .find(|manager| Program::new(manager.program).args(["--version"]).exists())
    else {
        return Err(
            "qemu-system-arm is missing and no package manager that this program knows is \
             there (apt-get, dnf, pacman, zypper, apk, brew). Install QEMU for Arm system \
             emulation, version 7 or later, so that `qemu-system-arm --version` runs: \
             https://www.qemu.org/download/"
                .to_owned(),
        );
    };
    println!(
        "The emulator qemu-system-arm is missing; {} installs it.",
        manager.program
    );
    if let Some(refresh) = manager.refresh
        && let Err(failure) = as_root(manager, refresh)?.run()
    {
        // One broken source among many makes this fail and need not matter.
        println!("{failure}; going on with the list of packages that is there.");
    }
    as_root(manager, manager.install)?
        .run()
        .map_err(|failure| {
            format!("{failure}: install QEMU for Arm system emulation by hand, then try again")
        })?;
    if emulator_is_there() {
        return Ok(());
    }
    Err("the package was installed, but `qemu-system-arm --version` still does not run".to_owned())
}

/// Installs `arm-none-eabi-gcc`, and `llvm-mca` beside it, which the benchmark can do without.
fn ensure_arm_compiler() -> Result<(), Failure> {
    let compiler = "arm-none-eabi-gcc";
    let is_there = |program: &str| Program::new(program).args(["--version"]).exists();
    if is_there(compiler) && is_there("llvm-mca") {
        return Ok(());
    }
    let by_hand = "install arm-none-eabi-gcc (https://developer.arm.com, GNU toolchain) by hand";
    let Some(manager) = PACKAGE_MANAGERS
        .iter()
        .find(|manager| is_there(manager.program))
    else {
        let missing = format!("{compiler} is missing and no package manager was found: {by_hand}");
        return if is_there(compiler) {
            Ok(())
        } else {
            Err(missing)
        };
    };
    println!(
        "{compiler} or llvm-mca is missing; {} installs them.",
        manager.program
    );
    if let Some(refresh) = manager.refresh
        && let Err(failure) = as_root(manager, refresh)?.run()
    {
        println!("{failure}; going on with the list of packages that is there.");
    }
    // The last word of the command names the emulator's package.
    let command = manager
        .install
        .split_last()
        .map_or(&[][..], |(_, command)| command);
    let install = [command, manager.arm_compiler].concat();
    if let Err(failure) = as_root(manager, &install)?.run() {
        println!("{failure}");
    }
    if is_there(compiler) {
        Ok(())
    } else {
        Err(format!("{compiler} is still missing: {by_hand}"))
    }
}

/// The package manager's command, through sudo where it needs more rights than we have.
fn as_root(manager: &PackageManager, arguments: &[&str]) -> Result<Program, Failure> {
    let user = Program::new("id").args(["-u"]).output();
    let is_root = user.is_some_and(|user| user.trim() == "0");
    if is_root || !manager.needs_root {
        let program = Program::new(manager.program).args(arguments);
        return Ok(program.env("DEBIAN_FRONTEND", "noninteractive"));
    }
    if !Program::new("sudo").args(["--version"]).exists() {
        return Err(format!(
            "{} needs root's rights and sudo is not installed: run `{} {}` as root, then try again",
            manager.program,
            manager.program,
            arguments.join(" ")
        ));
    }
    let program = Program::new("sudo").args(["env", "DEBIAN_FRONTEND=noninteractive"]);
    Ok(program.args([manager.program]).args(arguments))
}
