//! `octruss volume` and `octruss forms` as a user runs them.

use assert_cmd::Command;
use octruss_bake::bundle::BundleBytes;
use predicates::prelude::PredicateBooleanExt as _;
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

/// The paper's A-hat(5, 1, 6) of Catmull-Clark, 61595/877879296, is half of the coefficient of quadrilaterals
/// alone; the faces say which point is which.
#[test]
fn forms_of_neighbourhoods_are_printed() {
    let directory = tempdir().expect("a directory");
    let forms = |arguments: &str| {
        let command = &mut octruss(directory.path(), &format!("forms --scheme {arguments}"));
        command.assert()
    };
    let out = forms("tri-quad --around 4,4,4,4").success();
    let out = String::from_utf8(out.get_output().stdout.clone()).expect("text");
    let line = out.lines().find_map(|line| line.strip_prefix("0 5 6 "));
    let got: f64 = line.expect("a line").parse().expect("a number");
    let want = 2.0 * 61_595.0 / 877_879_296.0;
    assert!((got / want - 1.0).abs() < 1e-13, "{got} {want}");
    let out = forms("butterfly-modified --valence 5 --json").success();
    let out: serde_json::Value =
        serde_json::from_slice(&out.get_output().stdout).expect("one JSON object");
    assert_eq!(out["faces"][0], serde_json::json!([0, 1, 2]));
    assert_eq!(out["valence"], 5);
    for (arguments, complaint) in [
        ("sqrt3 --valence 5 --exact", "leave --exact out"),
        ("sqrt3 --around 3,3,4", "takes no face of 4 corners"),
        ("tri-quad --around 3,3,5", "takes no face of 5 corners"),
        ("butterfly --valence 2", "from 3 to 64"),
        ("loop --around 3,3,3", "give --valence"),
        ("tri-quad", "--valence"),
    ] {
        forms(arguments).failure().stderr(contains(complaint));
    }
}

/// A surface with exact forms in a bundle: the report's volume is the command's, with no estimate of an error.
#[test]
fn exact_volumes_of_neighbourhoods_are_baked() {
    let directory = tempdir().expect("a directory");
    fs::write(directory.path().join("octahedron.obj"), OCTAHEDRON).expect("a file");
    let run = |arguments: &str| {
        let command = &mut octruss(directory.path(), arguments);
        command.assert().success().get_output().stdout.clone()
    };
    for scheme in ["sqrt3", "butterfly", "butterfly-modified", "tri-quad"] {
        let out = run(&format!(
            "volume octahedron.obj --scheme {scheme} --json --picture {scheme}.png"
        ));
        let volume = number(&out, "volume");
        assert!(directory.path().join(format!("{scheme}.png")).exists());
        run(&format!(
            "volume octahedron.obj --scheme {scheme} --target 2 -o large.obj"
        ));
        let large = run(&format!("volume large.obj --scheme {scheme} --json"));
        assert!((number(&large, "volume") - 2.0).abs() < 1e-11, "{scheme}");
        let out = run(&format!(
            "bake octahedron.obj --scheme {scheme} --levels 2 --volume --json -o out.oct"
        ));
        let out: serde_json::Value = serde_json::from_slice(&out).expect("one JSON object");
        let baked = &out["volumes"][0];
        assert_eq!(baked["error_estimate"].as_f64(), Some(0.0), "{scheme}");
        let got = baked["volume"].as_f64().expect("a number");
        assert!(
            (got / volume - 1.0).abs() < 1e-12,
            "{scheme}: {got} {volume}"
        );
    }
}

const OCTAHEDRON: &str = "v 1 0 0\nv -1 0 0\nv 0 1.2 0\nv 0 -1 0.1\nv 0 0 1\nv 0.1 0 -1\n\
                          f 1 3 5\nf 3 2 5\nf 2 4 5\nf 4 1 5\nf 3 1 6\nf 2 3 6\nf 4 2 6\nf 1 4 6\n";

/// Two tetrahedra that are mirror images, with labels 1 and -2, between them the plane z = 0: each has
/// half of the exact volume of the whole. Regions are extrapolated, so they are as exact as the
/// report estimates. Modes are the cage stretched along x, y and z.
#[test]
fn regions_and_modes_are_baked() {
    let directory = tempdir().expect("a directory");
    let file = |name: &str, text: &str| {
        let path = directory.path().join(name);
        std::fs::write(&path, text).expect("written");
        path
    };
    let cage = file(
        "two.mesh",
        "MeshVersionFormatted 2\nDimension 3\nVertices\n5\n0 0 0 0\n2 0 0 0\n0 2 0 0\n\
         0.5 0.5 2 0\n0.5 0.5 -2 0\nTetrahedra\n2\n1 2 3 4 1\n1 3 2 5 -2\nEnd\n",
    );
    let model = file("point.obj", "v 0.7 0.7 0.1\n");
    let points = [
        [0.0, 0.0, 0.0],
        [2.0, 0.0, 0.0],
        [0.0, 2.0, 0.0],
        [0.5, 0.5, 2.0],
        [0.5, 0.5, -2.0],
    ];
    let mut motion = String::new();
    for axis in 0..3 {
        for (vertex, point) in points.iter().enumerate() {
            let mut point: [f64; 3] = *point;
            point[axis] *= 1.5;
            let [x, y, z] = point;
            motion += &format!("{axis},{vertex},{x},{y},{z}\n");
        }
    }
    let modes = file("modes.csv", &motion);
    let bundle = directory.path().join("two.oct");
    let mut bake = Command::cargo_bin("octruss").expect("the binary is built");
    bake.args(["bake", "--volume", "--volume=1", "--volume=-2", "--json"]);
    bake.arg("--modes").arg(modes).arg("--model").arg(&model);
    bake.arg(&cage).arg("-o").arg(&bundle);
    let out = bake.assert().success().get_output().stdout.clone();
    let report: serde_json::Value = serde_json::from_slice(&out).expect("JSON");
    let volumes = report["volumes"].as_array().expect("a list");
    let of = |place: usize, key: &str| volumes[place][key].as_f64().expect("a number");
    assert_eq!(volumes.len(), 3);
    assert!(volumes[0]["label"].is_null());
    assert_eq!(
        (&volumes[1]["label"], &volumes[2]["label"]),
        (&1.into(), &(-2).into())
    );
    for place in [1, 2] {
        let estimate = of(place, "error_estimate");
        let gap = (of(place, "volume") - of(0, "volume") / 2.0).abs();
        assert!(
            gap <= estimate && estimate < 1e-3 * of(0, "volume"),
            "{gap} {estimate}"
        );
        assert_eq!(volumes[place]["modes"]["coefficients"], 20);
    }

    // On the device: at rest form and polynomial agree within their bounds, and doubling the width,
    // twice a mode, doubles the volume.
    let bytes = BundleBytes::read(&bundle).expect("a file");
    let bundle = bytes.open().expect("a bundle");
    let cube = 0.5_f64.powi(3 * i32::try_from(bundle.header().fraction_bits.get()).expect("few"));
    for (place, region) in [0, 1, (-2_i32).cast_unsigned()].into_iter().enumerate() {
        let form = bundle
            .volume_form::<i32>(region)
            .expect("sound")
            .expect("a form");
        let mut workspace = vec![[0; 3]; form.workspace_length()];
        let volume = form
            .volume(bundle.rest_cage(), &mut workspace)
            .expect("fitting")
            .volume;
        let unit = |exponent: i64| 2.0_f64.powi(i32::try_from(exponent).expect("small")) * cube;
        let volume = volume as f64 * unit(form.volume_exponent());
        assert!((volume - of(place, "volume")).abs() <= of(place, "error_bound"));
        let modes = bundle
            .volume_modes::<i32>(region)
            .expect("sound")
            .expect("modes");
        let bound = volumes[place]["modes"]["error_bound"]
            .as_f64()
            .expect("a number");
        let at = |amplitudes: [i32; 3]| {
            modes.volume(&amplitudes).expect("three") as f64 * unit(modes.volume_exponent())
        };
        assert!((at([0; 3]) - of(place, "volume")).abs() <= bound);
        // 1.5 at amplitude 1, so 2 at amplitude 2: amplitudes to 2 have eight times the bound.
        let doubled = at([i32::MAX, 0, 0]);
        assert!((doubled - 2.0 * of(place, "volume")).abs() <= 8.0 * bound);
    }
    assert!(bundle.volume_modes::<i32>(7).expect("no error").is_none());

    // A fixed boundary is the double pyramid: a base of area 2, heights of 2 above and below. Without a
    // rule of its own it shrinks.
    let with_boundary = |rule: &str| {
        let mut bake = Command::cargo_bin("octruss").expect("the binary is built");
        bake.args([
            "bake",
            "--volume",
            "--json",
            "--outside",
            "nearest",
            "--boundary",
            rule,
        ]);
        bake.arg("--model").arg(&model).arg(&cage);
        bake.arg("-o").arg(directory.path().join("rule.oct"));
        let out = bake.assert().success().get_output().stdout.clone();
        let report: serde_json::Value = serde_json::from_slice(&out).expect("JSON");
        let figure = |key: &str| report["volumes"][0][key].as_f64().expect("a number");
        [figure("volume"), figure("error_estimate")]
    };
    let [fixed, error] = with_boundary("fixed");
    assert!(
        (fixed - 8.0 / 3.0).abs() < 1e-14 && error == 0.0,
        "{fixed} {error}"
    );
    let [interior, error] = with_boundary("interior");
    assert!(
        interior > 0.0 && interior + error < fixed,
        "{interior} {error}"
    );

    let mut bake = Command::cargo_bin("octruss").expect("the binary is built");
    bake.args(["bake", "--volume=3", "--model"]).arg(&model);
    bake.arg(&cage)
        .arg("-o")
        .arg(directory.path().join("none.oct"));
    let message = "two.mesh: no cell has the label 3";
    bake.assert().code(1).stderr(contains(message));
    assert!(!directory.path().join("none.oct").exists());
}

/// The bundle of a surface holds its volume too: the paper's 6241/9920 of Doo and Sabin's unit cube.
#[test]
fn surfaces_are_baked_with_their_volume() {
    let directory = tempdir().expect("a directory");
    let cube = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n\
                f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
    std::fs::write(directory.path().join("cube.obj"), cube).expect("written");
    let mut bake = octruss(
        directory.path(),
        "bake cube.obj --scheme doo-sabin --volume --json -o cube.oct",
    );
    let out = bake.assert().success().get_output().stdout.clone();
    let report: serde_json::Value = serde_json::from_slice(&out).expect("JSON");
    let volume = report["volumes"][0]["volume"].as_f64().expect("a number");
    assert!((volume - 6241.0 / 9920.0).abs() < 1e-12, "{volume}");
    octruss(
        directory.path(),
        "bake cube.obj --scheme doo-sabin --volume=4 -o none.oct",
    )
    .assert()
    .code(1)
    .stderr(contains("a surface has no labelled regions"));
}

/// A crease is the same whether the control mesh brings it as a tag or a feature file names it, and it is no smooth edge.
#[test]
fn crease_tags_are_heeded() {
    let directory = tempdir().expect("a directory");
    let file = |name: &str| directory.path().join(name);
    let plain = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n";
    fs::write(file("plain.obj"), plain).expect("a file");
    let tagged = format!("{plain}t crease 2/1/0 0 1 10\n");
    fs::write(file("tagged.obj"), tagged).expect("a file");
    fs::write(file("features.txt"), "crease 0 1\n").expect("a file");
    fs::write(file("faces.txt"), "crease-face 0 1 2\n").expect("a file");
    let volume = |arguments: &str| {
        let command = &mut octruss(directory.path(), &format!("volume {arguments} --json"));
        let out = command.assert().success().get_output().stdout.clone();
        number(&out, "volume")
    };
    let smooth = volume("plain.obj --scheme loop");
    let named = volume("plain.obj --scheme loop --features features.txt");
    let own = volume("tagged.obj --scheme loop");
    assert!(named > 1.2 * smooth, "{named} {smooth}");
    assert_eq!(own.to_bits(), named.to_bits());
    octruss(
        directory.path(),
        "volume plain.obj --scheme loop --features faces.txt",
    )
    .assert()
    .failure()
    .stderr(contains("for solids"));
}

/// Every format of control meshes is read; the mesh that reaches a target is written as `.obj` and as nothing else.
#[test]
fn control_meshes_come_in_every_format() {
    let directory = tempdir().expect("a directory");
    let file = |name: &str| directory.path().join(name);
    let off = "OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n";
    fs::write(file("mesh.off"), off).expect("a file");
    let out = octruss(directory.path(), "volume mesh.off --scheme loop --json")
        .assert()
        .success()
        .get_output()
        .stdout
        .clone();
    // Half of the paper's figure for the regular tetrahedron with edges of sqrt 2, which encloses 1/3: an affine map
    // takes it to this one, which encloses 1/6.
    let volume = number(&out, "volume");
    let want = 88_384_859_027_710_202.0 / 6_865_302_375_425_894_400.0 / 2.0;
    assert!((volume - want).abs() < 1e-16, "{volume} {want}");
    octruss(
        directory.path(),
        "volume mesh.off --scheme loop --target 1 -o out.off",
    )
    .assert()
    .failure()
    .stderr(contains(".obj"));
    assert!(!file("out.off").exists());
}

#[test]
fn a_valence_without_a_form_is_named_with_the_limits() {
    let directory = tempdir().expect("a directory");
    let count = 70;
    let mut text = String::from("v 0 0 1\nv 0 0 -1\n");
    for k in 0..count {
        let angle = std::f64::consts::TAU * f64::from(k) / f64::from(count);
        text += &format!("v {} {} 0\n", angle.cos(), angle.sin());
    }
    for k in 0..count {
        let (a, b) = (3 + k, 3 + (k + 1) % count);
        text += &format!("f 1 {a} {b}\nf 2 {b} {a}\n");
    }
    fs::write(directory.path().join("wheel.obj"), text).expect("a file");
    octruss(directory.path(), "volume wheel.obj --scheme loop")
        .assert()
        .failure()
        .stderr(
            contains("wheel.obj")
                .and(contains("valence 70"))
                .and(contains("3 to 64")),
        );
}
