//! The box-spline schemes end to end.

mod common;

use common::{Folder, model, octruss};
use octruss::bundle::{SCHEME_BOX_SPLINE, SCHEME_BOX_SPLINE_AVERAGED};
use octruss_bake::bundle::BundleBytes;
use octruss_bake::read;
use octruss_bake::refine::{Level, Scheme};
use predicates::prelude::PredicateBooleanExt;
use predicates::str::{contains, is_empty, starts_with};

fn refined(folder: &Folder, name: &str, more: &[&str]) -> Vec<u8> {
    let out = folder.path(name);
    octruss()
        .args(["refine", "--levels", "2", "--numeric", "fixed"])
        .args(more)
        .arg(model("finger.msh"))
        .arg("-o")
        .arg(&out)
        .assert()
        .success();
    std::fs::read(out).unwrap()
}

/// Diagonals that `info` wrote are read back, and give what was chosen; others do not.
#[test]
fn written_diagonals_give_the_same_solid() {
    let folder = Folder::new();
    let file = folder.path("diagonals.txt");
    octruss()
        .args(["info", "--scheme", "box-spline", "--write-diagonals"])
        .arg(&file)
        .arg(model("finger.msh"))
        .assert()
        .success()
        .stdout(contains("faces where they clash"));
    let file = file.to_str().unwrap().to_owned();
    let chosen = refined(&folder, "chosen.vtu", &["--scheme", "box-spline"]);
    let given = ["--scheme", "box-spline", "--diagonals", &file];
    assert_eq!(refined(&folder, "given.vtu", &given), chosen);

    let text = std::fs::read_to_string(&file).unwrap();
    let other = text.replace('0', "3").replace('1', "0").replace('3', "1");
    std::fs::write(&file, other).unwrap();
    assert_ne!(refined(&folder, "other.vtu", &given), chosen);

    let averaged = refined(
        &folder,
        "averaged.vtu",
        &["--scheme", "box-spline-averaged"],
    );
    let tet_oct = refined(&folder, "tet-oct.vtu", &[]);
    assert!(averaged != chosen && averaged != tet_oct && chosen != tet_oct);
}

#[test]
fn mistakes_in_diagonal_files_are_named() {
    let folder = Folder::new();
    let refine = |text: &str, scheme: &str| {
        let file = folder.path("diagonals.txt");
        std::fs::write(&file, text).unwrap();
        octruss()
            .args(["refine", "--scheme", scheme, "--diagonals"])
            .arg(&file)
            .arg(model("finger.msh"))
            .arg("-o")
            .arg(folder.path("out.vtu"))
            .assert()
            .code(1)
            .stdout(is_empty())
    };
    refine("0 1 # first\n2\n7\n", "box-spline").stderr(contains(
        "diagonals.txt, line 3: expected a major diagonal, found \"7\"",
    ));
    refine("0 1 2", "box-spline").stderr(contains("expected a major diagonal for each of "));
    refine("0 1 2", "tet-oct").stderr(contains(
        "major diagonals are of use to the scheme box-spline only",
    ));
    assert!(!folder.path("out.vtu").exists());
    octruss()
        .args(["info", "--write-diagonals"])
        .arg(folder.path("none.txt"))
        .arg(model("finger.msh"))
        .assert()
        .code(1)
        .stderr(starts_with("error: ").and(contains("only the scheme box-spline")));
}

/// A bundle records the scheme, and core opens it.
#[test]
fn bundles_record_the_scheme() {
    let folder = Folder::new();
    for (scheme, code) in [
        ("box-spline", SCHEME_BOX_SPLINE),
        ("box-spline-averaged", SCHEME_BOX_SPLINE_AVERAGED),
    ] {
        let bundle = folder.path(scheme);
        octruss()
            .args([
                "bake",
                "--levels",
                "1",
                "--outside",
                "nearest",
                "--scheme",
                scheme,
            ])
            .arg(model("finger.msh"))
            .arg("--model")
            .arg(model("finger.obj"))
            .arg("-o")
            .arg(&bundle)
            .assert()
            .success();
        BundleBytes::read(&bundle).unwrap().open().unwrap();
        // docs/bundle.md: the scheme stands at byte 40.
        let bytes = folder.read(scheme);
        assert_eq!(bytes[40..44], code.to_le_bytes());
    }
}

/// Masks are convex, so every refined point lies within the extent of the cage.
#[test]
fn the_finger_stays_within_its_cage() {
    let mesh = read::solid(&model("finger.msh")).unwrap();
    let level = Level::of_scheme(&mesh, Scheme::BoxSpline, None).unwrap();
    let mut step = octruss_bake::refine::Refinement::new(
        &level,
        octruss_bake::refine::BoundaryRule::Loop.to_core(),
    )
    .unwrap();
    let points = step.points(&mesh.points).unwrap();
    for axis in 0..3 {
        let along = || mesh.points.iter().map(|point| point[axis]);
        let low = along().fold(f64::INFINITY, f64::min);
        let high = along().fold(f64::NEG_INFINITY, f64::max);
        assert!(
            points
                .iter()
                .all(|point| (low..=high).contains(&point[axis]))
        );
    }
}
