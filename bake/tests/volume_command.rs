//! `octruss volume` and `octruss forms` as a user runs them.

use assert_cmd::Command;
use octruss_bake::bundle::BundleBytes;
use predicates::str::contains;
use std::fs;
use std::path::Path;
use tempfile::tempdir;

const CUBE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n\
                    v 9 9 9\n\
                    f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";

fn octruss(directory: &Path, arguments: &str) -> Command {
    let mut command = Command::cargo_bin("octruss").expect("the binary is built");
    command.current_dir(directory).args(arguments.split(' '));
    command
}

fn number(json: &[u8], key: &str) -> f64 {
    let value: serde_json::Value = serde_json::from_slice(json).expect("one JSON object");
    value[key].as_f64().expect("a number")
}

/// 6241/9920 is the paper's figure; a target is reached; the picture is a PNG file.
#[test]
fn a_cube_from_a_file() {
    let directory = tempdir().expect("a directory");
    fs::write(directory.path().join("cube.obj"), CUBE).expect("a file");
    let run = |arguments: &str| {
        let command = &mut octruss(directory.path(), arguments);
        command.assert().success().get_output().stdout.clone()
    };
    let out = run("volume cube.obj --scheme doo-sabin --json --moments --picture cube.png");
    assert!((number(&out, "volume") - 6241.0 / 9920.0).abs() < 1e-15);
    let text = String::from_utf8(out).expect("text");
    assert!(text.contains("\"centroid\"") && text.contains("\"inertia\""));
    let png = fs::read(directory.path().join("cube.png")).expect("a picture");
    assert_eq!(png[..4], *b"\x89PNG");
    run("volume cube.obj --scheme catmull-clark --target 2 -o large.obj");
    let out = run("volume large.obj --scheme catmull-clark --json");
    assert!((number(&out, "volume") - 2.0).abs() < 1e-11);
    let out = run("volume cube.obj --scheme catmull-clark --device");
    assert!(
        String::from_utf8(out)
            .expect("text")
            .contains("8 control points")
    );
}

#[test]
fn errors_name_file_and_edge_and_write_nothing() {
    let directory = tempdir().expect("a directory");
    let file = |name: &str| directory.path().join(name);
    let open = CUBE.rsplit_once("f ").expect("faces").0;
    fs::write(file("open.obj"), open).expect("a file");
    fs::write(file("cube.obj"), CUBE).expect("a file");
    octruss(
        directory.path(),
        "volume open.obj --scheme doo-sabin --target 1 -o out.obj",
    )
    .assert()
    .failure()
    .stderr(contains("open.obj"))
    .stderr(contains(
        "the edge of vertices 0 and 3 belongs to one face only",
    ));
    octruss(directory.path(), "volume cube.obj --scheme loop")
        .assert()
        .failure()
        .stderr(contains("takes triangles only"));
    octruss(
        directory.path(),
        "volume cube.obj --scheme doo-sabin --target NaN -o out.obj",
    )
    .assert()
    .failure();
    assert!(!file("out.obj").exists());
    octruss(directory.path(), "forms --scheme loop --valence 7 --exact")
        .assert()
        .failure()
        .stderr(contains("valence 7"));
}

/// The finger's volume goes through the bundle's bytes to core's own code.
#[test]
fn a_baked_volume_is_what_the_command_prints() {
    let directory = tempdir().expect("a directory");
    let models = Path::new(env!("CARGO_MANIFEST_DIR")).join("../models");
    let finger = models.join("finger.msh");
    let bundle = directory.path().join("finger.oct");
    let mut bake = Command::cargo_bin("octruss").expect("the binary is built");
    bake.args([
        "bake",
        "--volume",
        "--levels",
        "1",
        "--random-poses",
        "1",
        "--json",
    ]);
    bake.args(["--outside", "nearest", "--model"])
        .arg(models.join("finger.obj"));
    bake.arg(&finger).arg("-o").arg(&bundle);
    bake.assert()
        .success()
        .stdout(contains("\"error_estimate\""));
    let mut volume = Command::cargo_bin("octruss").expect("the binary is built");
    volume
        .args(["volume", "--scheme", "loop", "--json"])
        .arg(&finger);
    let out = volume.assert().success().get_output().stdout.clone();
    let want = number(&out, "volume");

    let bytes = BundleBytes::read(&bundle).expect("a file");
    let bundle = bytes.open().expect("a bundle");
    let form = bundle
        .volume_form::<i32>(0)
        .expect("a sound form")
        .expect("a form");
    assert!(bundle.volume_form::<i32>(1).expect("no error").is_none());
    let mut workspace = vec![[0; 3]; form.workspace_length()];
    let enclosed = form
        .volume(bundle.rest_cage(), &mut workspace)
        .expect("fitting lengths");
    let fraction_bits = i64::from(bundle.header().fraction_bits.get());
    let exponent = form.volume_exponent() - 3 * fraction_bits;
    #[expect(clippy::cast_precision_loss, reason = "about 56 bits")]
    let got = enclosed.volume as f64 * 2.0_f64.powi(i32::try_from(exponent).expect("small"));
    assert!((got / want - 1.0).abs() < 1e-6, "{got} {want}");
}

/// The paper's Y-hat(8, 7, 2) of Doo-Sabin at valence 3: 3324559/2891332800; sorted, the sign of an
/// odd permutation.
#[test]
fn forms_are_printed() {
    let directory = tempdir().expect("a directory");
    octruss(
        directory.path(),
        "forms --scheme doo-sabin --valence 3 --exact",
    )
    .assert()
    .success()
    .stdout(contains("1 6 7 -3324559/2891332800\n"));
    octruss(
        directory.path(),
        "forms --scheme catmull-clark --valence 5 --json",
    )
    .assert()
    .success()
    .stdout(contains("\"control_points\": 18"));
}
