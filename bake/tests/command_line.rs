//! The commands end to end: files in, files and figures out, errors in words.

mod common;

use common::{Folder, TWO_TETRAHEDRA_2, TWO_TETRAHEDRA_4, model, octruss};
use octruss::bundle::Header;
use octruss_bake::bundle::BundleBytes;
use octruss_bake::read;
use predicates::prelude::PredicateBooleanExt;
use predicates::str::{contains, is_empty, starts_with};
use serde_json::Value;
use std::path::Path;

fn json(command: &mut assert_cmd::Command) -> Value {
    let output = command
        .arg("--json")
        .assert()
        .success()
        .get_output()
        .stdout
        .clone();
    serde_json::from_slice(&output).unwrap()
}

/// Bakes the finger into `folder` and gives the bundle's path.
fn baked_finger(folder: &Folder) -> std::path::PathBuf {
    let bundle = folder.path("finger.oct");
    octruss()
        .args(["bake", "--unit", "mm", "--levels", "1"])
        .arg(model("finger.msh"))
        .arg("--model")
        .arg(model("finger.obj"))
        .arg("-o")
        .arg(&bundle)
        .assert()
        .success()
        .stderr(is_empty());
    bundle
}

#[test]
fn help_is_complete() {
    for command in ["info", "refine", "bake", "deform", "poses"] {
        octruss()
            .args([command, "--help"])
            .assert()
            .success()
            .stdout(contains("Usage: octruss"));
    }
    octruss().arg("bake").assert().failure().code(2);
    octruss()
        .args(["info", "nowhere.msh"])
        .assert()
        .code(1)
        .stdout(is_empty())
        .stderr(starts_with("error: nowhere.msh: cannot be read: "));
}

/// The finger's figures stand in models/README.md; by Euler's formula for a solid ball, vertices -
/// edges + faces - cells = 1.
#[test]
fn info_counts_the_finger() {
    let info = json(octruss().arg("info").arg(model("finger.msh")));
    let number = |key: &str| info[key].as_i64().unwrap();
    assert_eq!(
        (
            number("vertices"),
            number("tetrahedra"),
            number("octahedra")
        ),
        (72, 168, 0)
    );
    assert_eq!(
        number("vertices") - number("edges") + number("faces") - number("tetrahedra"),
        1
    );
    let interior: Vec<&String> = info["interior_edge_valences"]
        .as_object()
        .unwrap()
        .keys()
        .collect();
    assert_eq!(interior, ["4", "6", "8"]);
    assert_eq!(
        info["interior_vertex_valences"],
        serde_json::json!({ "32": 6 })
    );
    // A closed surface of 66 vertices: 2 * 66 - 4 triangles.
    assert_eq!(
        (number("boundary_triangles"), number("boundary_edges")),
        (128, 192)
    );
    assert_eq!((number("creases"), number("corners")), (16, 4));
    for key in [
        "inverted_cells",
        "flat_cells",
        "unused_vertices",
        "interior_edges_of_valence_3",
        "notes",
    ] {
        assert_eq!(info[key], serde_json::json!([]), "{key}");
    }
    octruss()
        .arg("info")
        .arg(model("finger.msh"))
        .assert()
        .success()
        .stdout(contains("168 tetrahedra, 0 octahedra").and(contains("16 edges")));
}

/// The capacities that `info` predicts are those of the refined meshes.
#[test]
fn info_predicts_what_refinement_needs() {
    let info = json(
        octruss()
            .args(["info", "--levels", "2"])
            .arg(model("finger.msh")),
    );
    let folder = Folder::new();
    for level in 0..=2_u32 {
        let predicted = &info["capacities"][level as usize];
        let path = folder.path("level.vtu");
        octruss()
            .args(["refine", "--levels", &level.to_string(), "-o"])
            .arg(&path)
            .arg(model("finger.msh"))
            .assert()
            .success();
        let mesh = read::solid(&path).unwrap();
        let solid = octruss_bake::refine::Level::new(&mesh).unwrap();
        let needed = octruss::mesh::edge_capacity(&solid.solid()).unwrap();
        let faces = octruss::mesh::face_capacity(&solid.solid()).unwrap();
        let number = |key: &str| predicted[key].as_u64().unwrap() as usize;
        assert_eq!(number("vertices"), mesh.points.len());
        assert_eq!(number("tetrahedra"), mesh.cells.tetrahedra.len());
        assert_eq!(number("octahedra"), mesh.cells.octahedra.len());
        assert_eq!(number("surface"), solid.surface.len());
        assert_eq!(number("creases"), 16 << level);
        assert_eq!(number("scratch_edges"), needed);
        assert_eq!(number("faces_to_find_boundary"), faces);
        if level < 2 {
            let next = &info["capacities"][level as usize + 1];
            assert_eq!(predicted["scratch_vertices"], next["vertices"]);
        }
    }
}

/// An edge with three tetrahedra round it, a vertex of no cell and a cell listed in the other
/// order.
#[test]
fn info_warns() {
    let folder = Folder::new();
    let text = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n6\n1 0 0 -1\n2 0 0 1\n3 1 0 0\n4 -1 1 0\n5 -1 -1 0\n6 9 9 9\n$EndNodes\n$Elements\n3\n1 4 0 1 2 3 4\n2 4 0 1 2 4 5\n3 4 0 2 1 5 3\n$EndElements\n";
    let path = folder.write("three.msh", text);
    octruss().arg("info").arg(&path).assert().success().stdout(
        contains(
            "warning: interior edges of three cells, along which the scheme is not smooth: 1: 0-1",
        )
        .and(contains(
            "warning: vertices of no cell, control points that move nothing: 1: 5",
        ))
        .and(contains("inverted cells              1: tetrahedron 2"))
        .and(contains("refused by `octruss bake`")),
    );
}

#[test]
fn features_come_from_a_file_too() {
    let folder = Folder::new();
    let mesh = folder.write("two.msh", TWO_TETRAHEDRA_2);
    let features = folder.write("two.txt", "crease 1 2\ncorner 4\ncrease 2 3\n");
    let info = json(
        octruss()
            .arg("info")
            .arg(&mesh)
            .arg("--features")
            .arg(&features),
    );
    assert_eq!(
        (info["creases"].as_i64(), info["corners"].as_i64()),
        (Some(3), Some(2))
    );
    let features = folder.write("bad.txt", "crease 1 2\ncorner 5\n");
    octruss()
        .arg("info")
        .arg(&mesh)
        .arg("--features")
        .arg(&features)
        .assert()
        .code(1)
        .stderr(contains(
            "bad.txt, line 2: there is no vertex 5; the mesh has 5",
        ));
    // A crease between the two far corners, which no cell joins.
    let features = folder.write("far.txt", "crease 3 4\n");
    octruss()
        .arg("info")
        .arg(&mesh)
        .arg("--features")
        .arg(&features)
        .assert()
        .code(1)
        .stderr(contains(
            "two.msh: the crease from vertex 3 to vertex 4 (counted from 0) is no edge of a cell",
        ));
}

#[test]
fn both_gmsh_versions_give_the_same_bundle() {
    let folder = Folder::new();
    let bake = |cage: &Path, model: &Path, name: &str| {
        octruss()
            .args(["bake", "--levels", "1", "--boundary", "fixed", "-o"])
            .arg(folder.path(name))
            .arg(cage)
            .arg("--model")
            .arg(model)
            .assert()
            .success();
        folder.read(name)
    };
    let point = folder.write(
        "point.obj",
        "v 0.5 0.5 0.25\nv 0.5 0.5 -0.25\nv 0.75 0.5 0\n",
    );
    let two = bake(&folder.write("2.msh", TWO_TETRAHEDRA_2), &point, "2.oct");
    assert_eq!(
        two,
        bake(&folder.write("4.msh", TWO_TETRAHEDRA_4), &point, "4.oct")
    );
    let finger = bake(&model("finger.msh"), &model("finger.obj"), "finger.oct");
    assert_eq!(
        finger,
        bake(
            &model("finger-22.msh"),
            &model("finger.obj"),
            "finger-22.oct"
        )
    );
    // A .vtu of the same cage differs by nothing but its missing features, which `fixed` ignores.
    let cage = folder.path("finger.vtu");
    octruss()
        .args(["refine", "--levels", "0", "-o"])
        .arg(&cage)
        .arg(model("finger.msh"))
        .assert()
        .success();
    assert_eq!(finger, bake(&cage, &model("finger.obj"), "finger-vtu.oct"));
}

#[test]
fn refined_bits_are_those_of_core() {
    let folder = Folder::new();
    let path = folder.path("fixed.vtu");
    let figures = json(
        octruss()
            .args([
                "refine",
                "--numeric",
                "fixed",
                "--fraction-bits",
                "8",
                "--levels",
                "2",
                "-o",
            ])
            .arg(&path)
            .arg(model("finger.msh")),
    );
    assert_eq!(figures["saturated_coordinates"], 0);
    let refined = read::solid(&path).unwrap();
    assert_eq!(figures["vertices"], refined.points.len());
    // Every coordinate lies on the grid of the format, and near the real-number refinement: two
    // roundings of at most half a unit, the first of which enters with weights that sum to one.
    let real = folder.path("real.vtu");
    octruss()
        .args(["refine", "--levels", "2", "-o"])
        .arg(&real)
        .arg(model("finger.msh"))
        .assert()
        .success();
    let real = read::solid(&real).unwrap();
    assert_eq!(real.cells, refined.cells);
    for (fixed, real) in refined
        .points
        .iter()
        .flatten()
        .zip(real.points.iter().flatten())
    {
        assert_eq!((fixed * 256.0).fract(), 0.0);
        assert!((fixed - real).abs() * 256.0 <= 1.0 + 1e-6, "{fixed} {real}");
    }
}

#[test]
fn refine_writes_the_boundary_as_obj() {
    let folder = Folder::new();
    let path = folder.path("skin.obj");
    octruss()
        .args(["refine", "--levels", "1", "-o"])
        .arg(&path)
        .arg(model("finger.msh"))
        .assert()
        .success();
    let skin = read::model(&path).unwrap();
    // 128 triangles, four each; a closed surface of n triangles has n / 2 + 2 vertices.
    assert_eq!((skin.faces.len(), skin.points.len()), (512, 258));
    octruss()
        .args(["refine", "-o", "skin.stl"])
        .arg(model("finger.msh"))
        .assert()
        .code(1)
        .stderr(contains("skin.stl: no writer for \".stl\" files"));
}

#[test]
fn levels_beyond_all_memory_are_refused() {
    for levels in ["9", "4000000000"] {
        octruss()
            .args(["refine", "-o", "out.vtu", "--levels", levels])
            .arg(model("finger.msh"))
            .assert()
            .code(1)
            .stderr(
                contains("finger.msh: level 8 of").and(contains("more than 134217728 vertices")),
            );
    }
}

#[test]
fn bake_reports_and_writes_sources() {
    let folder = Folder::new();
    let report = json(
        octruss()
            .args(["bake", "--unit", "mm", "--levels", "1", "--seed", "7", "-o"])
            .arg(folder.path("finger.oct"))
            .arg("--rust")
            .arg(folder.path("finger.rs"))
            .arg("--c")
            .arg(folder.path("finger.c"))
            .arg(model("finger.msh"))
            .arg("--model")
            .arg(model("finger.obj")),
    );
    assert_eq!(
        (report["rows"].as_u64(), report["unit"].as_str()),
        (Some(5522), Some("mm"))
    );
    assert_eq!(report["precision"]["seed"], 7);
    assert_eq!(report["boundary"], "loop");
    let bundle = folder.read("finger.oct");
    for name in ["finger.rs", "finger.c"] {
        let source = String::from_utf8(folder.read(name)).unwrap();
        let bytes: Vec<u8> = source
            .split([',', '\n', ' '])
            .filter_map(|word| u8::from_str_radix(word.strip_prefix("0x")?, 16).ok())
            .collect();
        assert_eq!(bytes, bundle, "{name}");
    }
    assert_eq!(folder.names(), ["finger.c", "finger.oct", "finger.rs"]);
}

#[test]
fn a_failed_bake_leaves_what_was_there() {
    let folder = Folder::new();
    let old = folder.write("finger.oct", "old");
    let far = folder.write("far.obj", "v 0 0 50\nv 500 0 50\n");
    octruss()
        .arg("bake")
        .arg(model("finger.msh"))
        .arg("--model")
        .arg(&far)
        .arg("-o")
        .arg(&old)
        .assert()
        .code(1)
        .stdout(is_empty())
        .stderr(contains("far.obj: 1 of 2 points lie outside the refined cage; the farthest, point 1 (counted from 0), by 48"));
    assert_eq!(folder.read("finger.oct"), b"old");
    assert_eq!(folder.names(), ["far.obj", "finger.oct"]);
    octruss()
        .arg("bake")
        .arg(model("finger.msh"))
        .arg("--model")
        .arg(model("finger.obj"))
        .arg("-o")
        .arg(folder.path("nowhere/finger.oct"))
        .assert()
        .code(1)
        .stderr(contains("nowhere/finger.oct: cannot be written: "));
}

/// The first frame of the finger's motion is the cage at rest: the model comes back on the grid of
/// the format, and every line but those of its vertices as it was.
#[test]
fn deform_writes_the_motion() {
    let folder = Folder::new();
    let bundle = baked_finger(&folder);
    let figures = json(
        octruss()
            .arg("deform")
            .arg(&bundle)
            .arg("--pose")
            .arg(model("finger-motion.csv"))
            .arg("--model")
            .arg(model("finger.obj"))
            .arg("-o")
            .arg(folder.path("frames")),
    );
    assert_eq!(
        figures,
        serde_json::json!({ "frames": 32, "points": 5522, "saturated_coordinates": 0 })
    );
    let rest = std::fs::read_to_string(model("finger.obj")).unwrap();
    let first = std::fs::read_to_string(folder.path("frames/finger-0000.obj")).unwrap();
    assert_eq!(rest.lines().count(), first.lines().count());
    let bytes = BundleBytes::read(&bundle).unwrap();
    let unit = octruss_bake::deform::format_of(&bytes.open().unwrap()).unit();
    for (rest, first) in rest.lines().zip(first.lines()) {
        let Some(rest) = rest.strip_prefix("v ") else {
            assert_eq!(rest, first);
            continue;
        };
        let first = first.strip_prefix("v ").unwrap();
        for (rest, first) in rest.split(' ').zip(first.split(' ')) {
            let rest: f64 = rest.parse().unwrap();
            assert_eq!(first.parse(), Ok((rest / unit + 0.5).floor() * unit));
        }
    }
    // The last frame is the rest pose again (models/README.md).
    let last = std::fs::read_to_string(folder.path("frames/finger-0031.obj")).unwrap();
    assert!(last == first);
}

/// A pose as a mesh, a directory of them and a pattern, and the same frame from the .csv.
#[test]
fn poses_are_meshes_directories_or_tables() {
    let folder = Folder::new();
    let cage = folder.write("two.msh", TWO_TETRAHEDRA_2);
    let posed = TWO_TETRAHEDRA_2.replace("40 0.5 0.25 2", "40 0.75 0.5 3");
    let pose = folder.write("pose.msh", &posed);
    let points = "v 0.5 0.5 0.25\nv 0.5 0.5 -0.25\n";
    let object = folder.write("two.obj", points);
    let bundle = folder.path("two.oct");
    octruss()
        .args(["bake", "--levels", "0", "-o"])
        .arg(&bundle)
        .arg(&cage)
        .arg("--model")
        .arg(&object)
        .assert()
        .success()
        .stderr(starts_with("note: left out: 1 line, 1 triangle"));
    let deform = |pose: &Path, out: &Path| {
        let mut command = octruss();
        command
            .arg("deform")
            .arg(&bundle)
            .arg("--pose")
            .arg(pose)
            .arg("--model")
            .arg(&object);
        command.arg("-o").arg(out).assert()
    };
    deform(&pose, &folder.path("mesh.obj")).success();
    // The point at a height of 1/4 of 2 moves by 1/8 of what corner 3 moves; the other not at all.
    assert_eq!(
        folder.read("mesh.obj"),
        b"v 0.53125 0.53125 0.375\nv 0.5 0.5 -0.25\n"
    );

    std::fs::create_dir(folder.path("poses")).unwrap();
    folder.write("poses/pose-7.msh", TWO_TETRAHEDRA_2);
    folder.write("poses/pose-12.msh", &posed);
    folder.write("poses/readme.txt", "not a pose");
    deform(&folder.path("poses"), &folder.path("from-folder-%03d.obj")).success();
    assert_eq!(folder.read("from-folder-007.obj"), points.as_bytes());
    assert_eq!(folder.read("from-folder-012.obj"), folder.read("mesh.obj"));

    let table = folder.write(
        "motion.csv",
        "frame,point,x,y,z\n3,0,0,0,0\n3,1,2,0,0\n3,2,0,2,0\n3,3,0.75,0.5,3\n3,4,0.5,0.5,-2\n",
    );
    deform(&table, &folder.path("from-table")).success();
    assert_eq!(
        folder.read("from-table/two-0003.obj"),
        folder.read("mesh.obj")
    );
    deform(&table, &folder.path("one.obj")).code(1).stderr(contains(
        "one.obj: a motion has many frames, but this names one file\n  help: name a directory, or a pattern such as out/frame-%04d.obj",
    ));

    let raw = folder.path("two.poses");
    let figures = json(
        octruss()
            .arg("poses")
            .arg(&cage)
            .arg("--motion")
            .arg(&table)
            .arg("--bundle")
            .arg(&bundle)
            .arg("-o")
            .arg(&raw),
    );
    assert_eq!(
        (figures["frames"].as_u64(), figures["bytes"].as_u64()),
        (Some(1), Some(60))
    );
    let scale = 2.0_f64.powi(figures["fraction_bits"].as_i64().unwrap() as i32);
    let (words, rest) = folder.read("two.poses").as_chunks::<4>().into_owned();
    assert!(rest.is_empty());
    let coordinates: Vec<f64> = words
        .iter()
        .map(|word| f64::from(i32::from_le_bytes(*word)) / scale)
        .collect();
    assert_eq!(
        coordinates,
        [
            0.0, 0.0, 0.0, 2.0, 0.0, 0.0, 0.0, 2.0, 0.0, 0.75, 0.5, 3.0, 0.5, 0.5, -2.0
        ]
    );
}

/// Slices of bytes as owned lists.
trait IntoOwned {
    fn into_owned(self) -> (Vec<[u8; 4]>, Vec<u8>);
}

impl IntoOwned for (&[[u8; 4]], &[u8]) {
    fn into_owned(self) -> (Vec<[u8; 4]>, Vec<u8>) {
        (self.0.to_vec(), self.1.to_vec())
    }
}

#[test]
fn deform_refuses_what_does_not_fit() {
    let folder = Folder::new();
    let bundle = baked_finger(&folder);
    let deform = |bundle: &Path, pose: &Path, object: &Path| {
        let mut command = octruss();
        command
            .arg("deform")
            .arg(bundle)
            .arg("--pose")
            .arg(pose)
            .arg("--model")
            .arg(object);
        command
            .arg("-o")
            .arg(folder.path("out.obj"))
            .assert()
            .code(1)
    };
    let two = folder.write("two.msh", TWO_TETRAHEDRA_2);
    deform(&bundle, &two, &model("finger.obj")).stderr(contains(
        "two.msh: the mesh (5 vertices, 2 cells) has not the connectivity of the cage that the bundle was baked from (72 vertices)",
    ));
    let moved = folder.write(
        "moved.obj",
        std::fs::read_to_string(model("finger.obj"))
            .unwrap()
            .replacen("-11.3335", "-11.3334", 1),
    );
    deform(&bundle, &model("finger.msh"), &moved).stderr(contains(
        "moved.obj: this is not the model that the bundle was baked for: its 5522 vertices stand elsewhere",
    ));
    let other = folder.write("other.obj", "v 0 0 0\n");
    deform(&bundle, &model("finger.msh"), &other)
        .stderr(contains("it has 1 vertex, the bundle has 5522 rows"));
    let far = folder.write(
        "far.csv",
        (0..72)
            .map(|point| format!("5,{point},0,0,1e9\n"))
            .collect::<String>(),
    );
    let mut command = octruss();
    command
        .arg("deform")
        .arg(&bundle)
        .arg("--pose")
        .arg(&far)
        .arg("--model")
        .arg(model("finger.obj"));
    command
        .arg("-o")
        .arg(folder.path("out"))
        .assert()
        .code(1)
        .stderr(contains(
            "far.csv: frame 5: point 0 (counted from 0) has z = 1000000000, but with",
        ));
    let mut damaged = folder.read("finger.oct");
    let middle = damaged.len() / 2;
    damaged[middle] ^= 1;
    let damaged = folder.write("damaged.oct", damaged);
    deform(&damaged, &model("finger.msh"), &model("finger.obj")).stderr(contains(
        "damaged.oct: the bundle is damaged: its checksum is",
    ));
    let text = folder.write("text.oct", [b'x'; size_of::<Header>()]);
    deform(&text, &model("finger.msh"), &model("finger.obj"))
        .stderr(contains("text.oct: these bytes are no octruss bundle"));
}

#[test]
fn deform_counts_saturated_coordinates() {
    let folder = Folder::new();
    let cage = folder.write("two.msh", TWO_TETRAHEDRA_2);
    // Outside by a third of its height: extrapolated, it overshoots the control points.
    let object = folder.write("two.obj", "v 0.5 0.25 2.5\n");
    let bundle = folder.path("two.oct");
    octruss()
        .args([
            "bake",
            "--levels",
            "0",
            "--outside",
            "extrapolate",
            "--fraction-bits",
            "28",
            "-o",
        ])
        .arg(&bundle)
        .arg(&cage)
        .arg("--model")
        .arg(&object)
        .assert()
        .success()
        .stdout(contains(
            "outside     1 point, extrapolated; the farthest is point 0",
        ));
    let pose = folder.write(
        "pose.msh",
        TWO_TETRAHEDRA_2.replace("40 0.5 0.25 2", "40 0.5 0.25 7.5"),
    );
    octruss()
        .arg("deform")
        .arg(&bundle)
        .arg("--pose")
        .arg(&pose)
        .arg("--model")
        .arg(&object)
        .arg("-o")
        .arg(folder.path("out.obj"))
        .assert()
        .success()
        .stdout(contains("1 frame of 1 point, 1 coordinate saturated"))
        .stderr(contains("warning: 1 coordinate out of range and clamped"));
    // 2^31 - 1 units of 2^-28.
    assert_eq!(
        folder.read("out.obj"),
        format!("v 0.5 0.25 {}\n", 8.0 - 2.0_f64.powi(-28)).as_bytes()
    );
}

#[test]
fn a_picture_shows_model_and_cage() {
    let folder = Folder::new();
    let bundle = baked_finger(&folder);
    let path = folder.path("finger.png");
    octruss()
        .arg("deform")
        .arg(&bundle)
        .arg("--pose")
        .arg(model("finger-motion.csv"))
        .arg("--model")
        .arg(model("finger.obj"))
        .arg("--cage")
        .arg(model("finger.msh"))
        .args(["--frames", "2", "--picture"])
        .arg(&path)
        .assert()
        .success();
    let picture = tiny_skia::Pixmap::load_png(&path).unwrap();
    // Two tiles of 300 by 360 with captions of 26, and a margin of 12 all round.
    assert_eq!(
        (picture.width(), picture.height()),
        (2 * 300 + 24, 360 + 26 + 24)
    );
    let (mut orange, mut blue, mut paper) = (0, 0, 0);
    for pixel in picture.pixels() {
        let (red, green, blueness) = (pixel.red(), pixel.green(), pixel.blue());
        orange += usize::from(red > 150 && blueness < 130);
        blue += usize::from(blueness > red.saturating_add(20));
        paper += usize::from((red, green, blueness) == (250, 248, 244));
    }
    assert!(
        orange > 8_000 && blue > 2_000 && paper > 100_000,
        "{orange} {blue} {paper}"
    );
}
