//! `octruss slice` end to end.

mod common;

use common::{Folder, model, octruss};
use predicates::str::{contains, is_empty};

fn slice(folder: &Folder) -> assert_cmd::Command {
    let mut command = octruss();
    command
        .args(["slice", "--levels", "1", "--size", "200", "-o"])
        .arg(folder.path("out.png"))
        .arg(model("slices/cylinder.msh"));
    command
}

/// Masks add up to one, so a value that is the same everywhere stays what it is, with every scheme.
#[test]
fn a_constant_stays_constant() {
    let folder = Folder::new();
    let channel = folder.write("channel.txt", "2.5 # all of them\n".repeat(7 * 21));
    for scheme in ["tet-oct", "box-spline", "box-spline-averaged"] {
        let output = slice(&folder)
            .args([
                "--plane",
                "0,0,1,1.3",
                "--line=-0.5,0,1,0.5,0,1",
                "--samples",
                "9",
            ])
            .args(["--derivative", "--json", "--scheme", scheme, "--channel"])
            .arg(&channel)
            .output()
            .unwrap();
        let figures: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
        let is_close =
            |value: &serde_json::Value, want: f64| (value.as_f64().unwrap() - want).abs() < 1e-12;
        assert!(is_close(&figures["least"], 2.5) && is_close(&figures["greatest"], 2.5));
        let line = figures["line"]["refined"].as_array().unwrap();
        assert!(line.len() == 9 && line.iter().all(|value| is_close(value, 2.5)));
        let slopes = figures["line"]["derivative"].as_array().unwrap();
        assert!(slopes[0].is_null() && slopes[1..8].iter().all(|value| is_close(value, 0.0)));
        // A PNG of three panels: its header gives width and height.
        let png = folder.read("out.png");
        assert_eq!(png[..8], *b"\x89PNG\r\n\x1a\n");
        assert_eq!(png[16..24], [0, 0, 2, 88, 0, 0, 0, 200]);
    }
}

/// One table carries a channel through time. Against the refinement of one moment in real numbers: a
/// row has at most 64 weights here, each within 2^-31 of its real one, values are at most 1 and end in
/// 29 bits, so the two differ by at most 64 * 2^-31 + 2 * 2^-30 < 2^-24.
#[test]
fn moments_are_carried_by_a_table() {
    const BOUND: f64 = 1.0 / 16_777_216.0;
    let folder = Folder::new();
    let draw = |moments: &[u32]| -> serde_json::Value {
        let mut command = octruss();
        command
            .args(["slice", "--levels", "1", "--size", "200", "--json"])
            .args(["--scheme", "box-spline", "--plane", "0,0,1,0.125"])
            .args(["--line", "0.02,1.1,0.125,3.98,1.1,0.125", "-o"])
            .arg(folder.path("out.png"))
            .arg(model("slices/panel.msh"));
        for moment in moments {
            let file = model(&format!("slices/panel-tension-{moment}.txt"));
            command.arg("--channel").arg(file);
        }
        serde_json::from_slice(&command.output().unwrap().stdout).unwrap()
    };
    let all = draw(&[0, 1, 2, 3]);
    // A PNG of two rows: three moments, then the fourth and the plot.
    assert_eq!(folder.read("out.png")[16..24], [0, 0, 2, 88, 0, 0, 1, 144]);
    let moments = all["moments"].as_array().unwrap();
    assert_eq!(moments.len(), 4);
    for (moment, carried) in (0..).zip(moments) {
        assert_eq!(carried["channel"], format!("panel-tension-{moment}"));
        assert_eq!(carried["saturated_values"], 0);
        let alone = draw(&[moment]);
        for end in ["least", "greatest"] {
            let gap = carried[end].as_f64().unwrap() - alone[end].as_f64().unwrap();
            assert!(gap.abs() <= BOUND, "{end} at {moment}: {gap}");
        }
    }
    let last = draw(&[3]);
    let line = |figures: &serde_json::Value| -> Vec<Option<f64>> {
        let values = figures["line"]["refined"].as_array().unwrap();
        values.iter().map(serde_json::Value::as_f64).collect()
    };
    let (carried, alone) = (line(&all), line(&last));
    assert_eq!(carried.len(), 257);
    for pair in carried.into_iter().zip(alone) {
        match pair {
            (Some(carried), Some(alone)) => assert!((carried - alone).abs() <= BOUND),
            (carried, alone) => assert_eq!(carried, alone),
        }
    }
}

#[test]
fn mistakes_are_answered() {
    let folder = Folder::new();
    let short = folder.write("short.txt", "1 2 3");
    let words = folder.write("words.txt", "1\nmany");
    for (arguments, message) in [
        (
            ["--plane", "0,0,1,9", "--basis", "0"],
            "the plane misses the refined solid",
        ),
        (
            ["--plane", "0,0,0,1", "--basis", "0"],
            "a, b and c of a plane are not all zero",
        ),
        (
            ["--plane", "0,0,1,1", "--basis", "147"],
            "there is no vertex 147; the mesh has 147",
        ),
        (
            ["--plane", "0,0,1,1", "--channel", short.to_str().unwrap()],
            "short.txt: expected a value for each of 147 vertices, found 3",
        ),
        (
            ["--plane", "0,0,1,1", "--channel", words.to_str().unwrap()],
            "words.txt, line 2: expected a finite number, found \"many\"",
        ),
    ] {
        slice(&folder)
            .args(arguments)
            .assert()
            .code(1)
            .stdout(is_empty())
            .stderr(contains(message));
    }
    slice(&folder)
        .args(["--plane", "0,0,1", "--basis", "0"])
        .assert()
        .code(2)
        .stderr(contains("expected 4 numbers parted by commas, found 3"));
    assert!(!folder.path("out.png").exists());
}
