//! `octruss drive` as a user runs it, without a device: what it refuses, and runs that are repeated on this machine.
//!
//! Runs on devices are driven by the emulator's tests (`cargo xtask demo`).

mod common;

use common::{Folder, model, octruss};
use octruss_bake::bundle::BundleBytes;
use octruss_bake::drive::mirror::{Mirror, MirrorMemory};
use octruss_bake::drive::record::{self, Line};
use octruss_firmware::link::{Command, Goal};
use predicates::prelude::PredicateBooleanExt as _;
use predicates::str::contains;
use std::fs;
use std::path::Path;

/// Bakes the finger's controller, or its table alone.
fn bake(file: &Path, with_solver: bool) {
    let mut command = octruss();
    command
        .args(["bake", "--unit", "mm"])
        .arg(model("finger.msh"));
    command.arg("--model").arg(model("finger.obj"));
    if with_solver {
        command.args(["--volume", "--modes"]);
        command.arg(model("finger-modes.csv"));
        command
            .arg("--actuators")
            .arg(model("finger-actuators.csv"));
        command
            .arg("--effectors")
            .arg(model("finger-effectors.csv"));
    }
    command.arg("-o").arg(file).assert().success();
}

/// A run of a few ticks, made by the controller's code: a goal, a hold.
fn record_run(bundle: &Path, file: &Path) {
    let bytes = BundleBytes::read(bundle).unwrap();
    let bundle = bytes.open().unwrap();
    let mut memory = MirrorMemory::of(&bundle);
    let mut mirror = Mirror::new(&bundle, &mut memory).unwrap();
    let place = mirror.parts().solver.parts().rest[3].map(|own| own + (1 << 20));
    let goal = Goal { effector: 3, place };
    let mut lines = Vec::new();
    for tick in 0..12 {
        let commands = match tick {
            0 => vec![Command::Restart],
            2 => vec![Command::Goals([goal].into_iter().collect())],
            9 => vec![Command::Query, Command::Hold],
            _ => Vec::new(),
        };
        let moved = mirror.advance(&commands);
        lines.push(Line {
            tick,
            commands,
            pose: moved.pose_hash,
            model: moved.skin_hash,
            volume: moved.volume,
        });
    }
    assert_ne!(lines[1].pose, lines[8].pose);
    assert_eq!(lines[8].pose, lines[11].pose, "the pose is held");
    record::write(file, &bundle, &lines).unwrap();
}

#[test]
fn runs_are_repeated_and_bad_input_is_named() {
    let folder = Folder::new();
    let [whole, bare, run] = ["whole.oct", "bare.oct", "run.csv"].map(|name| folder.path(name));
    bake(&whole, true);
    bake(&bare, false);
    record_run(&whole, &run);
    let drive = |bundle: &Path, arguments: &[&str]| {
        let mut command = octruss();
        command.arg("drive").arg("--bundle").arg(bundle);
        command.args(arguments).assert()
    };
    let run_text = run.to_str().unwrap();
    drive(&whole, &["--replay", run_text, "--json"])
        .success()
        .stdout(contains("\"ticks\": 11").and(contains("\"not_as_recorded\": 0")));

    // A digit of a checksum, a line left out, another bundle, and what is no record.
    let text = fs::read_to_string(&run).unwrap();
    let last = text.lines().last().unwrap();
    let (front, volume) = last.rsplit_once(',').unwrap();
    let flipped = if front.ends_with('0') { "1" } else { "0" };
    let changed = format!("{}{flipped},{volume}", &front[..front.len() - 1]);
    let wrong = folder.path("wrong.csv");
    let wrong_text = wrong.to_str().unwrap();
    fs::write(&wrong, text.replace(last, &changed)).unwrap();
    drive(&whole, &["--replay", wrong_text])
        .failure()
        .stdout(contains("1 ticks are not as recorded"));
    let fourth = text.lines().nth(4).unwrap();
    fs::write(&wrong, text.replace(&format!("{fourth}\n"), "")).unwrap();
    drive(&whole, &["--replay", wrong_text])
        .failure()
        .stderr(contains("wrong.csv, line 5").and(contains("tick 2 is expected")));
    let title = text.lines().next().unwrap();
    fs::write(
        &wrong,
        text.replace(title, "# octruss run, bundle 00000000"),
    )
    .unwrap();
    drive(&whole, &["--replay", wrong_text])
        .failure()
        .stderr(contains("another bundle"));
    fs::write(&wrong, "frame,point,x,y,z\n").unwrap();
    drive(&whole, &["--replay", wrong_text])
        .failure()
        .stderr(contains("no recorded run"));

    // A bundle without a controller; nothing to do; no device; an effector too few.
    drive(&bare, &["--replay", run_text])
        .failure()
        .stderr(contains("bare.oct").and(contains("--effectors")));
    drive(&whole, &["--tcp", "127.0.0.1:1"])
        .failure()
        .stderr(contains("--goals"));
    fs::write(&wrong, "frame,point,x,y,z\n0,0,1,2,3\n").unwrap();
    drive(&whole, &["--goals", wrong_text])
        .failure()
        .stderr(contains("wrong.csv"));
    let motion = model("finger-motion.csv");
    drive(&whole, &["--motion", motion.to_str().unwrap()])
        .failure()
        .stderr(contains("--tcp").and(contains("--port")));
}
