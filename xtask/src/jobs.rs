//! The jobs: each is a list of steps that start cargo or one of this workspace's programs.

use std::path::Path;

use crate::command::{Failure, Program};
use crate::image_check;
use crate::kernel_check;
use crate::setup::{self, Need};
use crate::steps::Steps;
use crate::workspace::{self, CORE_TARGETS, IMAGE_TARGET, IMAGE_TARGET_WITHOUT_DSP};

/// The example that `demo` plays: hexahedra, prisms and tetrahedra.
const CAGE: &str = "models/finger-mixed.msh";
const SCHEME: &str = "mixed";
/// What `bench` measures: the same control points and model, tetrahedra alone.
const BENCH_CAGE: &str = "models/finger.msh";
const MODEL: &str = "models/finger.obj";
const MOTION: &str = "models/finger-motion.csv";
const LEVELS: &str = "2";
/// A surface that `bench` and `verify` move by its table and refine on the device.
const SKIN: &str = "models/glove.obj";
const SKIN_MOTION: &str = "models/glove-motion.csv";
const UNIT: &str = "mm";

/// Random cases of `test` on each subject; `verify` takes more.
const TEST_CASES: u32 = 150;

/// Frames that the running controller must refuse in `demo`; `verify` sends more.
const WRONG_FRAMES: u32 = 500;
const WRONG_FRAMES_OF_PROOF: u32 = 10_000;

/// Bakes the example, bends it on an emulated processor, checks every bit.
pub fn demo() -> Result<(), Failure> {
    setup::ensure(&[Need::Targets, Need::Emulator])?;
    bake_example()?;
    build_images()?;
    play_example()?;
    drive_controller(Build::Debug, WRONG_FRAMES)?;
    blow_palm()
}

/// Runs the tests on the host and on the emulated processors.
pub fn test() -> Result<(), Failure> {
    let mut steps = Steps::default();
    test_steps(&mut steps)?;
    steps.print_times();
    println!("\nAll tests passed.");
    Ok(())
}

fn test_steps(steps: &mut Steps) -> Result<(), Failure> {
    steps.step("set up", || {
        setup::ensure(&[Need::Targets, Need::LlvmTools, Need::Emulator])
    })?;
    steps.step("tests on the host", || {
        Program::cargo().args(["test"]).run()?;
        Program::cargo()
            .args(["test", "--package", "octruss-firmware", "--lib"])
            .run()
    })?;
    steps.step("bake the example", bake_example)?;
    steps.step("build the images", build_images)?;
    steps.step("the emulator's runner", || {
        let test = [
            "test",
            "--package",
            "octruss-host-tests",
            "--test",
            "emulator",
        ];
        with_images(Program::cargo().args(test).args(["--", "--ignored"]))?.run()
    })?;
    steps.step("conformance of the emulated processors", || {
        conformance(Build::Debug, TEST_CASES, 0)
    })?;
    steps.step("the apply path's image", || {
        image_check::run(&workspace::images()?)
    })?;
    steps.step("the kernels' code", kernel_check::run)
}

/// Everything that must hold before a change is accepted.
pub fn ci() -> Result<(), Failure> {
    let mut steps = Steps::default();
    steps.step("set up everything", setup::run)?;
    steps.step("formatting", || {
        Program::cargo().args(["fmt", "--all", "--check"]).run()?;
        no_conflict_markers()
    })?;
    steps.step("core for every target", || {
        CORE_TARGETS.iter().try_for_each(|target| {
            let build = ["build", "--package", "octruss", "--target", target];
            Program::cargo().args(build).run()
        })
    })?;
    test_steps(&mut steps)?;
    steps.step("the demo", play_example)?;
    steps.step("the controller over its serial port", || {
        drive_controller(Build::Debug, WRONG_FRAMES)
    })?;
    steps.step("the palm in the wind", blow_palm)?;
    steps.step("lints", || {
        // The default members are what builds for the host; the firmware's library does too.
        lint(&["--all-targets"])?;
        lint(&[
            "--package",
            "octruss-firmware",
            "--lib",
            "--profile",
            "test",
        ])?;
        with_example(Program::cargo().args([
            "clippy",
            "--package",
            "octruss-firmware",
            "--lib",
            "--bins",
            "--target",
            IMAGE_TARGET,
        ]))?
        .args(["--", "--deny", "warnings"])
        .run()
    })?;
    steps.step("the fuzz targets compile", || {
        let check = ["check", "--manifest-path", "fuzz/Cargo.toml", "--bins"];
        Program::cargo()
            .args(check)
            .env("CARGO_TARGET_DIR", workspace::target()?.join("fuzz"))
            .run()
    })?;
    steps.step("documentation", || {
        // Libraries alone: the baker's program has the name of core's library.
        document(&["octruss", "octruss-bake", "octruss-host-tests"], &[])?;
        document(&["octruss-firmware"], &["--target", IMAGE_TARGET])
    })?;
    steps.print_times();
    println!("\nEverything holds.");
    Ok(())
}

/// A merge that was not finished leaves such lines in texts that no compiler reads.
fn no_conflict_markers() -> Result<(), Failure> {
    let search = ["grep", "--line-number", "-E", "^(<{7}|>{7}) "];
    match Program::new("git").args(search).output() {
        Some(found) => Err(format!("these lines are left of a merge:\n{found}")),
        None => Ok(()),
    }
}

/// The host's tests against the reference, which take more random cases in the long proofs.
const HOST_PROOFS: [(&str, &str); 16] = [
    ("host: tetrahedra and octahedra", "equality"),
    ("host: box splines", "box_spline_equality"),
    ("host: mixed solids", "mixed_equality"),
    ("host: surfaces", "surfaces_exact"),
    ("host: boundaries as surfaces", "tri_quad_boundary"),
    ("host: enclosed volume", "enclosed"),
    ("host: projected poses", "project"),
    ("host: health of poses", "health"),
    ("host: tables", "table"),
    ("host: tables in every format", "tables_exact"),
    ("host: scalars", "scalars"),
    ("host: labels and channels", "data_equality"),
    ("host: rigs", "rig"),
    ("host: springs", "springs"),
    ("host: goals", "control_inverse"),
    ("host: frames", "link"),
];

/// The long proofs.
pub fn verify(cases: u32, seed: u32) -> Result<(), Failure> {
    let mut steps = Steps::default();
    steps.step("set up", || {
        setup::ensure(&[Need::Targets, Need::LlvmTools, Need::Emulator])
    })?;
    steps.step("bake the example", bake_example)?;
    steps.step("build the images", build_images)?;
    steps.step("build the host's proofs", || {
        let tests = HOST_PROOFS.map(|(_, test)| test);
        proof_test(&tests).args(["--no-run"]).run()
    })?;
    steps.step(
        "random cases on the host and the emulated processors",
        || conformance(Build::Release, cases, seed),
    )?;
    steps.step("a surface by its table and refined on the device", || {
        let directory = workspace::target()?.join("skin");
        let files = ["--mesh", SKIN, "--motion", SKIN_MOTION, "--directory"];
        let job = [&["skin"][..], &files, &[path(&directory)?]].concat();
        device(Build::Release, &job)
    })?;
    steps.step("the controller over its serial port", || {
        drive_controller(Build::Release, WRONG_FRAMES_OF_PROOF)
    })?;
    // One in ten of the cases above is damaged; the host's tests compare sound ones alone.
    let sound = (cases - cases / 10).to_string();
    for (name, test) in HOST_PROOFS {
        steps.step(name, || {
            proof_test(&[test])
                .args(["--", "--include-ignored", "--nocapture"])
                .env("OCTRUSS_CASES", &sound)
                .run()
        })?;
    }
    steps.step("volumes against polyhedra of six levels", || {
        let test = ["test", "--profile", "proof", "--package", "octruss-bake"];
        Program::cargo()
            .args(test)
            .args(["--test", "neighbourhood_forms", "--test", "volume"])
            .args(["--", "--ignored"])
            .run()
    })?;
    steps.step("every bit of the demo's bundle", || {
        proof_test(&["bit_flips"])
            .args(["--", "--ignored", "--nocapture"])
            .run()
    })?;
    steps.print_times();
    println!("\nEverything was proved.");
    Ok(())
}

/// The code of the kernels alone.
pub fn kernels() -> Result<(), Failure> {
    setup::ensure(&[Need::Targets, Need::LlvmTools])?;
    for target in [IMAGE_TARGET, IMAGE_TARGET_WITHOUT_DSP] {
        build_images_of(target, &["--bin", "apply"])?;
    }
    kernel_check::run()
}

/// Tests of the host in the build of the long proofs.
fn proof_test(names: &[&str]) -> Program {
    let package = [
        "test",
        "--profile",
        "proof",
        "--package",
        "octruss-host-tests",
    ];
    let names = names.iter().flat_map(|name| ["--test", name]);
    Program::cargo().args(package).args(names)
}

/// Seconds and memory that baking takes, by the size of the model.
pub fn bench_bake() -> Result<(), Failure> {
    let example = [
        "run",
        "--quiet",
        "--profile",
        "proof",
        "--package",
        "octruss-bake",
    ];
    Program::cargo()
        .args(example)
        .args(["--example", "scale"])
        .run()
}

/// Every format beside what one would write instead; makes `docs/performance.md`.
pub fn bench() -> Result<(), Failure> {
    setup::ensure(&[Need::Targets, Need::Emulator, Need::ArmCompiler])?;
    if !Program::new("llvm-mca").args(["--version"]).exists() {
        println!("llvm-mca is not installed (package llvm): estimated cycles are left out.");
    }
    let directory = workspace::target()?.join("rivals");
    compile_rivals(&directory)?;
    compile_host_rivals(&directory);
    let build = [
        "build",
        "--release",
        "--package",
        "octruss-firmware",
        "--features",
        "rivals",
        "--bin",
        "rivals",
        "--bin",
        "refine",
        "--bin",
        "volume",
        "--bin",
        "skin",
        "--bin",
        "inverse",
        "--bin",
        "projection",
    ];
    Program::cargo()
        .args(build)
        .args(["--target", IMAGE_TARGET])
        .env("OCTRUSS_RIVALS_DIR", &directory)
        .run()?;
    let measure = [
        "run",
        "--quiet",
        "--profile",
        "proof",
        "--package",
        "octruss-host-tests",
        "--bin",
        "performance",
        "--",
        "--cage",
        BENCH_CAGE,
        "--model",
        MODEL,
        "--motion",
        MOTION,
        "--skin",
        SKIN,
        "--skin-motion",
        SKIN_MOTION,
        "--output",
        "docs/performance.md",
        "--directory",
    ];
    with_images(Program::cargo().args(measure).args([&directory]))?.run()
}

/// Makes `librivals.a`, and the compiler's assembly beside it.
fn compile_rivals(directory: &Path) -> Result<(), Failure> {
    std::fs::create_dir_all(directory)
        .map_err(|error| format!("cannot make {}: {error}", directory.display()))?;
    let compiler = || {
        let flags =
            "-O3 -mcpu=cortex-m4 -mthumb -mfpu=fpv4-sp-d16 -mfloat-abi=hard -ffp-contract=fast";
        Program::new("arm-none-eabi-gcc")
            .args(flags.split(' '))
            .args(["firmware/rivals/rivals.c", "-o"])
    };
    let object = directory.join("rivals.o");
    compiler()
        .args([directory.join("rivals.s")])
        .args(["-S"])
        .run()?;
    compiler().args([&object]).args(["-c"]).run()?;
    Program::new("arm-none-eabi-ar")
        .args(["rcs"])
        .args([directory.join("librivals.a"), object])
        .run()
}

/// Makes `host_rivals` where there is a C++ compiler, with OpenSubdiv where that is installed.
fn compile_host_rivals(directory: &Path) {
    let compile = |more: &[&str]| {
        let program = Program::new("c++")
            .args([
                "-O3",
                "-std=c++17",
                "host-tests/peers/host_rivals.cpp",
                "-o",
            ])
            .args([directory.join("host_rivals")])
            .args(more);
        program.output().is_some()
    };
    if !compile(&["-losdCPU"]) {
        println!("OpenSubdiv is not installed (Debian: libosd-dev): it is skipped.");
        compile(&["-DWITHOUT_OPENSUBDIV"]);
    }
}

/// How a program of the host is built.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Build {
    Debug,
    Release,
}

/// Bakes the example into the directory that the images take it from.
fn bake_example() -> Result<(), Failure> {
    let directory = workspace::example()?;
    std::fs::create_dir_all(&directory)
        .map_err(|error| format!("cannot make {}: {error}", directory.display()))?;
    let bundle = directory.join("finger.oct");
    let octruss = || {
        let run = [
            "run",
            "--quiet",
            "--package",
            "octruss-bake",
            "--bin",
            "octruss",
            "--",
        ];
        Program::cargo().args(run)
    };
    octruss()
        .args(["bake", CAGE, "--model", MODEL, "--scheme", SCHEME])
        .args(["--levels", LEVELS, "--unit", UNIT, "--output"])
        .args([&bundle])
        .run()?;
    octruss()
        .args(["bake", CAGE, "--model", MODEL, "--scheme", SCHEME])
        .args(["--levels", LEVELS, "--unit", UNIT, "--volume"])
        .args(["--modes", "models/finger-modes.csv"])
        .args(["--actuators", "models/finger-actuators.csv"])
        .args(["--effectors", "models/finger-effectors.csv", "--output"])
        .args([directory.join("controller.oct")])
        .run()?;
    octruss()
        .args(["bake", "models/palm.msh", "--model", "models/palm.obj"])
        .args(["--scheme", SCHEME, "--levels", LEVELS, "--unit", "cm"])
        .args(["--springs", "models/palm.springs", "--output"])
        .args([directory.join("palm.oct")])
        .run()?;
    octruss()
        .args(["poses", CAGE, "--motion", MOTION, "--bundle"])
        .args([&bundle])
        .args(["--output"])
        .args([directory.join("finger.poses")])
        .run()
}

/// Builds all images of the firmware.
fn build_images() -> Result<(), Failure> {
    // What another board needs is kept aside before the images of the usual one take its place.
    let board = [
        "--no-default-features",
        "--features",
        "board-netduinoplus2",
        "--bin",
        "controller",
        "--bin",
        "demo",
        "--bin",
        "faults",
        "--bin",
        "palm",
    ];
    build_images_of(IMAGE_TARGET, &board)?;
    let images = workspace::images()?;
    let aside = images.join("netduinoplus2");
    std::fs::create_dir_all(&aside)
        .map_err(|error| format!("cannot make {}: {error}", aside.display()))?;
    for image in ["controller", "demo", "faults", "palm"] {
        std::fs::copy(images.join(image), aside.join(image))
            .map_err(|error| format!("cannot copy the image {image}: {error}"))?;
    }
    let without_dsp = ["--bin", "conformance", "--bin", "apply"];
    build_images_of(IMAGE_TARGET_WITHOUT_DSP, &without_dsp)?;
    build_images_of(IMAGE_TARGET, &["--bins"])
}

fn build_images_of(target: &str, selection: &[&str]) -> Result<(), Failure> {
    let build = [
        "build",
        "--release",
        "--package",
        "octruss-firmware",
        "--target",
        target,
    ];
    with_example(Program::cargo().args(build).args(selection))?.run()
}

/// Plays the example that has been baked and built.
fn play_example() -> Result<(), Failure> {
    let directory = workspace::example()?;
    let directory = path(&directory)?;
    let files = ["--cage", CAGE, "--model", MODEL];
    let [cage, cage_file, model, model_file] = files;
    device(
        Build::Debug,
        &[
            "demo",
            "--directory",
            directory,
            cage,
            cage_file,
            model,
            model_file,
        ],
    )
}

/// Plays the palm that has been baked and built.
fn blow_palm() -> Result<(), Failure> {
    let directory = workspace::example()?;
    let picture = directory.join("palm.png");
    let job = ["palm", "--directory", path(&directory)?];
    let picture = ["--picture", path(&picture)?];
    device(Build::Debug, &[&job[..], &picture].concat())
}

/// Drives the controller that has been baked and built.
fn drive_controller(build: Build, wrong_frames: u32) -> Result<(), Failure> {
    let directory = workspace::example()?;
    let wrong_frames = wrong_frames.to_string();
    device(
        build,
        &[
            "controller",
            "--directory",
            path(&directory)?,
            "--motion",
            MOTION,
            "--wrong-frames",
            &wrong_frames,
        ],
    )
}

/// Holds random cases on the emulated processors against host and reference.
fn conformance(build: Build, cases: u32, seed: u32) -> Result<(), Failure> {
    let directory = workspace::target()?.join("conformance");
    let (cases, seed) = (cases.to_string(), seed.to_string());
    device(
        build,
        &[
            "conformance",
            "--cases",
            &cases,
            "--seed",
            &seed,
            "--directory",
            path(&directory)?,
        ],
    )
}

/// Runs the host's program that runs images.
fn device(build: Build, arguments: &[&str]) -> Result<(), Failure> {
    let run = [
        "run",
        "--quiet",
        "--package",
        "octruss-host-tests",
        "--bin",
        "device",
    ];
    let mut program = Program::cargo().args(run);
    if build == Build::Release {
        program = program.args(["--profile", "proof"]);
    }
    with_images(program.args(["--"]).args(arguments))?.run()
}

fn lint(selection: &[&str]) -> Result<(), Failure> {
    let program = Program::cargo().args(["clippy"]).args(selection);
    program.args(["--", "--deny", "warnings"]).run()
}

fn document(packages: &[&str], more: &[&str]) -> Result<(), Failure> {
    let packages = packages.iter().flat_map(|package| ["--package", package]);
    let program = Program::cargo()
        .args(["doc", "--no-deps", "--lib"])
        .args(packages);
    with_example(program.args(more).env("RUSTDOCFLAGS", "-D warnings"))?.run()
}

/// Tells a build of the firmware where the example was baked to.
fn with_example(program: Program) -> Result<Program, Failure> {
    Ok(program.env("OCTRUSS_DEMO_DIR", workspace::example()?))
}

/// Tells a program of the host where the images are.
fn with_images(program: Program) -> Result<Program, Failure> {
    Ok(program.env("OCTRUSS_IMAGES", workspace::images()?))
}

fn path(path: &Path) -> Result<&str, Failure> {
    path.to_str()
        .ok_or_else(|| format!("{} is not Unicode", path.display()))
}
