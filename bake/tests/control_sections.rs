//! What moves and limits the control points, from text files through the command line to core: files in, a bundle
//! out, opened and used as a device does.

mod common;

use common::{Folder, model, octruss};
use fixed::types::I22F10;
use octruss::control::health::RATIO_ONE;
use octruss::control::project::{GaveUp, ProjectScratch, RegionGoal, ScratchLengths};
use octruss_bake::bundle::BundleBytes;
use predicates::str::contains;
use std::path::PathBuf;

const RIG: &str = "joint root - at 0 0 0 fixed\ncarry 0-71 root\n";
const SPRINGS: &str = "pin 0-3\nedges 0.5 0.1\n";
const LIMITS: &str = "rate 100\npin 0-3\nreach 4-71 3 3 3\nspeed 4-71 200\n";

/// Bakes the finger with everything and its volume.
fn baked(folder: &Folder) -> PathBuf {
    let bundle = folder.path("finger.oct");
    octruss()
        .args([
            "bake",
            "--unit",
            "mm",
            "--levels",
            "1",
            "--fraction-bits",
            "10",
            "--volume",
            "--health",
        ])
        .arg(model("finger.msh"))
        .arg("--model")
        .arg(model("finger.obj"))
        .arg("--rig")
        .arg(folder.write("finger.rig", RIG))
        .arg("--springs")
        .arg(folder.write("finger.springs", SPRINGS))
        .arg("--limits")
        .arg(folder.write("finger.limits", LIMITS))
        .arg("-o")
        .arg(&bundle)
        .assert()
        .success();
    bundle
}

/// Every third point is asked to go further than it may; the volume is to stay.
#[test]
fn a_baked_bundle_holds_a_projection() {
    let folder = Folder::new();
    let bytes = BundleBytes::read(&baked(&folder)).unwrap();
    let bundle = bytes.open().unwrap();
    assert!(bundle.rig::<I22F10>().unwrap().is_some());
    assert!(bundle.springs::<I22F10>().unwrap().is_some());
    let health = bundle.health::<I22F10>().unwrap().unwrap();
    let limits = bundle.limits::<I22F10>().unwrap().unwrap();
    let form = bundle.volume_form::<I22F10>(0).unwrap().unwrap();

    let rest: Vec<[I22F10; 3]> = bundle
        .rest_cage()
        .iter()
        .map(|point| point.map(I22F10::from_bits))
        .collect();
    let points = rest.len();
    let workspace = &mut vec![[0; 3]; form.workspace_length()];
    let volume = form.volume(&rest, workspace).unwrap().volume;
    let mut goal = rest.clone();
    for point in goal.iter_mut().step_by(3) {
        point[2] += I22F10::from_num(5);
    }
    let regions = [RegionGoal::hold(&form, volume)];
    let lengths = ScratchLengths::of(&regions);
    let mut pose = rest.clone();
    let mut narrow = [
        points,
        points,
        points,
        points,
        lengths.gradients,
        lengths.form,
    ]
    .map(|length| vec![[0; 3]; length]);
    let [lower, upper, current, candidate, gradients, form_workspace] = &mut narrow;
    let scratch = ProjectScratch {
        lower,
        upper,
        current,
        candidate,
        gradients,
        form_workspace,
        forces: &mut vec![[0; 3]; points],
        form_gradient: &mut vec![[0; 3]; lengths.form],
    };
    let report = limits.project(&goal, &regions, scratch, &mut pose).unwrap();

    // At rest all ratios are one; two millimetres fold none of the finger's cells.
    let at_rest = health.of(&rest).unwrap();
    assert_eq!((at_rest.folded, at_rest.least_ratio), (0, RATIO_ONE));
    assert_eq!(health.of(&pose).unwrap().folded, 0);
    assert!(report.gave_up.contains(GaveUp::GOAL_CUT));
    assert!(
        !report.gave_up.contains(GaveUp::VOLUME_MISSED),
        "{report:?}"
    );
    let off = report.volumes[0].abs_diff(volume);
    assert!(off <= volume.unsigned_abs() >> 14, "{off} of {volume}");
    assert_eq!(pose[..4], rest[..4], "pinned");
    // 200 mm a second at 100 calls a second are 2 mm a call, and the reach is 3 mm.
    let most = I22F10::from_num(2);
    let mut moved = pose[4..]
        .iter()
        .zip(&rest[4..])
        .flat_map(|(new, old)| [0, 1, 2].map(|axis| (new[axis] - old[axis]).abs()));
    assert_eq!(moved.clone().max(), Some(most));
    assert!(moved.all(|way| way <= most));
}

#[test]
fn a_mistake_in_a_file_is_named_with_its_line() {
    let folder = Folder::new();
    let cases = [
        (
            "--limits",
            "pin 0-3\npin 99\n",
            ", line 2: there is no vertex 99; the cage has 72",
        ),
        (
            "--springs",
            "edges 2 0\n",
            ", line 1: expected a number from 0 to 1",
        ),
        ("--rig", "carry 0 nobody\n", ", line 1: "),
    ];
    for (option, text, want) in cases {
        let out = folder.path("out.oct");
        octruss()
            .args(["bake", "--unit", "mm", "--levels", "1"])
            .arg(model("finger.msh"))
            .arg("--model")
            .arg(model("finger.obj"))
            .arg(option)
            .arg(folder.write("wrong.txt", text))
            .arg("-o")
            .arg(&out)
            .assert()
            .code(1)
            .stderr(contains(format!("wrong.txt{want}")));
        assert!(!out.exists());
    }
}
