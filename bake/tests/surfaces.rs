//! `refine` of surfaces end to end.

mod common;

use common::{Folder, octruss};
use octruss_bake::read;
use predicates::str::contains;

/// The unit cube as six quads, with one crease tag as OpenSubdiv writes it.
const CUBE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n\
    f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";

/// Catmull and Clark's rules by hand: a corner of the cube goes to (n - 2)/n of itself and 1/9 of
/// its three neighbours and three face points each: from 0 to (3 * 1/9 * ... ) = 2/9; an edge point
/// of the edge along x at y = z = 0 to (1/2, 1/8, 1/8).
#[test]
fn catmull_clark_of_a_cube() {
    let folder = Folder::new();
    let cube = folder.write("cube.obj", CUBE);
    octruss()
        .args(["refine", "--scheme", "catmull-clark", "-o"])
        .arg(folder.path("fine.obj"))
        .arg(&cube)
        .assert()
        .success()
        .stdout("26 vertices, 24 faces\n");
    let fine = read::surface(&folder.path("fine.obj")).unwrap();
    // 1/3 own + (1 neighbour + 1/2 + 1/2 of two face points) / 9 along each axis.
    let corner = fine.points[0];
    assert!(
        corner.iter().all(|x| (x - 2.0 / 9.0).abs() < 1e-15),
        "{corner:?}"
    );
    assert_eq!(fine.points[8], [0.5, 0.125, 0.125]);
    assert!(fine.faces.iter().all(|face| face.len() == 4));
}

/// Limits by hand: the limit of a cube's corner after one level, from the mask
/// (n^2 p + 4 sum(e) + sum(f)) / (n (n + 5)) with p = 2/9, e = (1/2, 1/8, 1/8), f = (1/2, 1/2, 0):
/// (2 + 4 * 3/4 + 1) / 24 = 1/4.
#[test]
fn limits_ask_for_quads() {
    let folder = Folder::new();
    let cube = folder.write("cube.obj", CUBE);
    octruss()
        .args(["refine", "--scheme", "catmull-clark", "--limit", "-o"])
        .arg(folder.path("fine.off"))
        .arg(&cube)
        .assert()
        .success();
    let fine = read::surface(&folder.path("fine.off")).unwrap();
    assert!(fine.points[0].iter().all(|x| (x - 0.25).abs() < 1e-15));
    let pyramid = folder.write(
        "pyramid.off",
        "OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n",
    );
    octruss()
        .args(["refine", "--scheme", "catmull-clark", "--levels", "0"])
        .args(["--limit", "-o"])
        .arg(folder.path("none.off"))
        .arg(&pyramid)
        .assert()
        .failure()
        .stderr(contains("pyramid.off"))
        .stderr(contains("refine once first"));
    assert!(!folder.path("none.off").exists());
}

/// A cube's symmetry: the limit's normal at a corner looks along the diagonal, at a face's centre along an axis. A
/// .ply has one for each vertex, an .obj one for each corner of a face.
#[test]
fn limits_have_normals() {
    let folder = Folder::new();
    let cube = folder.write("cube.obj", CUBE);
    for (numeric, bound) in [("f64", 1e-15), ("fixed", 1e-4)] {
        for extension in ["ply", "obj"] {
            octruss()
                .args(["refine", "--scheme", "catmull-clark", "--limit"])
                .args(["--numeric", numeric, "-o"])
                .arg(folder.path(&format!("fine.{extension}")))
                .arg(&cube)
                .assert()
                .success();
        }
        let text = std::fs::read_to_string(folder.path("fine.ply")).unwrap();
        let (header, body) = text.split_once("end_header\n").unwrap();
        assert!(header.contains("property double nz"));
        let line = |place: usize| -> Vec<f64> {
            let words = body.lines().nth(place).unwrap().split(' ');
            words.map(|word| word.parse().unwrap()).collect()
        };
        let diagonal = -(1.0_f64 / 3.0).sqrt();
        for (vertex, normal) in [(0, [diagonal; 3]), (20, [0.0, 0.0, -1.0])] {
            let found = &line(vertex)[3..];
            for (got, want) in found.iter().zip(normal) {
                assert!((got - want).abs() < bound, "{numeric}, {vertex}: {found:?}");
            }
        }
        let text = std::fs::read_to_string(folder.path("fine.obj")).unwrap();
        // 26 vertices, no crease: as many normals, and every corner names one.
        let count = |start: &str| text.lines().filter(|line| line.starts_with(start)).count();
        assert_eq!(count("vn "), 26, "{numeric}");
        let mut corners = text.lines().filter(|line| line.starts_with("f "));
        assert!(corners.all(|face| face.matches("//").count() == 4));
    }
}

/// The limit of a Doo-Sabin surface: the dual mesh. A cube's dual is an octahedron, a vertex in the middle of
/// each face and its normal along an axis.
#[test]
fn doo_sabin_limits_are_the_dual_mesh() {
    let folder = Folder::new();
    let cube = folder.write("cube.obj", CUBE);
    octruss()
        .args([
            "refine",
            "--scheme",
            "doo-sabin",
            "--levels",
            "0",
            "--limit",
            "-o",
        ])
        .arg(folder.path("dual.ply"))
        .arg(&cube)
        .assert()
        .success()
        .stdout("6 vertices, 8 faces\n");
    let text = std::fs::read_to_string(folder.path("dual.ply")).unwrap();
    let (_, body) = text.split_once("end_header\n").unwrap();
    assert_eq!(body.lines().next(), Some("0.5 0.5 0 0 0 -1"));
    let dual = read::surface(&folder.path("dual.ply")).unwrap();
    assert!(dual.faces.iter().all(|face| face.len() == 3));
    // Counter-clockwise from outside: the signed volume is the octahedron's, 1/6.
    let volume: f64 = dual
        .faces
        .iter()
        .map(|face| {
            let [a, b, c] = [0, 1, 2].map(|i| dual.points[face[i] as usize].map(|x| x - 0.5));
            (a[0] * (b[1] * c[2] - b[2] * c[1])
                + a[1] * (b[2] * c[0] - b[0] * c[2])
                + a[2] * (b[0] * c[1] - b[1] * c[0]))
                / 6.0
        })
        .sum();
    assert!((volume - 1.0 / 6.0).abs() < 1e-15, "{volume}");
}

/// A crease tag keeps an edge straight: its midpoint lies halfway.
#[test]
fn crease_tags_are_read() {
    let folder = Folder::new();
    let cube = folder.write("cube.obj", format!("{CUBE}t crease 2/1/0 0 1 10\n"));
    octruss()
        .args(["refine", "--scheme", "catmull-clark", "--numeric", "fixed"])
        .args(["--fraction-bits", "20", "-o"])
        .arg(folder.path("fine.obj"))
        .arg(&cube)
        .assert()
        .success()
        .stdout(contains("20 fraction bits"));
    let fine = read::surface(&folder.path("fine.obj")).unwrap();
    assert_eq!(fine.points[8], [0.5, 0.0, 0.0]);
}

#[test]
fn every_scheme_is_reachable_and_refuses_what_it_does_not_take() {
    let folder = Folder::new();
    let cube = folder.write("cube.obj", CUBE);
    let tetrahedron = folder.write(
        "tetrahedron.off",
        "OFF 4 4 6\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n",
    );
    for (scheme, figures) in [
        ("loop", "10 vertices, 16 faces\n"),
        ("loop-warren", "10 vertices, 16 faces\n"),
        ("sqrt3", "8 vertices, 12 faces\n"),
        ("butterfly", "10 vertices, 16 faces\n"),
        ("butterfly-modified", "10 vertices, 16 faces\n"),
        ("doo-sabin", "12 vertices, 14 faces\n"),
        ("catmull-clark", "14 vertices, 12 faces\n"),
        ("tri-quad", "10 vertices, 16 faces\n"),
    ] {
        octruss()
            .args(["refine", "--scheme", scheme, "-o"])
            .arg(folder.path("out.off"))
            .arg(&tetrahedron)
            .assert()
            .success()
            .stdout(figures);
    }
    for scheme in [
        "loop",
        "loop-warren",
        "sqrt3",
        "butterfly",
        "butterfly-modified",
    ] {
        octruss()
            .args(["refine", "--scheme", scheme, "-o"])
            .arg(folder.path("none.off"))
            .arg(&cube)
            .assert()
            .failure()
            .stderr(contains("triangulate the mesh"));
    }
}

/// A table and the same surface refined on the device agree within their roundings: the device's
/// refinement rounds once a level (half a unit each, never magnified by masks of positive weights),
/// the table and its rest once more, and its weights are off by at most 2^-31 a tap.
#[test]
fn a_baked_surface_moves_as_the_refined_one() {
    let folder = Folder::new();
    let cube = folder.write("cube.obj", CUBE);
    let posed = folder.write("posed.obj", CUBE.replacen("v 1 1 1", "v 1.75 1.5 2.25", 1));
    let (bundle, skin) = (folder.path("skin.oct"), folder.path("skin.obj"));
    octruss()
        .args(["bake", "--scheme", "catmull-clark", "--levels", "3"])
        .args(["--fraction-bits", "20", "--skin"])
        .arg(&skin)
        .arg("-o")
        .arg(&bundle)
        .arg(&cube)
        .assert()
        .success()
        .stdout(contains("8 control points; 386 vertices"));
    octruss()
        .arg("deform")
        .arg(&bundle)
        .arg("--pose")
        .arg(&posed)
        .arg("--model")
        .arg(&skin)
        .arg("-o")
        .arg(folder.path("moved.obj"))
        .assert()
        .success();
    octruss()
        .args(["refine", "--scheme", "catmull-clark", "--levels", "3"])
        .args(["--numeric", "fixed", "--fraction-bits", "20", "-o"])
        .arg(folder.path("refined.obj"))
        .arg(&posed)
        .assert()
        .success();
    let moved = read::surface(&folder.path("moved.obj")).unwrap();
    let refined = read::surface(&folder.path("refined.obj")).unwrap();
    assert_eq!(moved.faces, refined.faces);
    let unit = 2.0_f64.powi(-20);
    for (one, other) in moved.points.iter().zip(&refined.points) {
        for (a, b) in one.iter().zip(other) {
            assert!((a - b).abs() <= (3.0 * 0.5 + 1.0 + 0.5) * unit, "{a} {b}");
        }
    }
    octruss()
        .arg("deform")
        .arg(&bundle)
        .arg("--pose")
        .arg(&skin)
        .arg("--model")
        .arg(&skin)
        .arg("-o")
        .arg(folder.path("none.obj"))
        .assert()
        .failure()
        .stderr(contains("has not the connectivity of the control mesh"));
}

/// A square pyramid: a quad and four triangles.
const PYRAMID: &str = "v 1 1 0\nv -1 1 0\nv -1 -1 0\nv 1 -1 0\nv 0 0 1\n\
    f 4 3 2 1\nf 1 2 5\nf 2 3 5\nf 3 4 5\nf 4 1 5\n";

/// Example 5.2 by hand. Both other ends of the mixed edges at a corner of the base have the mean 0, so
/// that its clones are 23/24 of it for triangles and 25/24 for the quad.
///
/// * The apex, triangles alone: 5/8 of it and 3/8 of the mean of the base, 0.
/// * The corner (1, 1, 0), two triangles at 1/6 and the quad at 1/4, that is 2, 2 and 3 of 7: x is
///   `(4 * 10/16 * 23/24 + 3 * 25/24 * (9/16 - 1/16)) / 7 = 95/168`, z is `4 * 3/16 / 7 = 3/28`.
/// * The middle between (1, 1, 0) and (-1, 1, 0), both faces alike: y is
///   `(23/24 * 3/8 * 2 + 25/24 * (3/8 - 1/8) * 2) / 2 = 119/192`, z is `1/4 / 2`.
#[test]
fn tri_quad_of_a_pyramid() {
    let folder = Folder::new();
    let pyramid = folder.write("pyramid.obj", PYRAMID);
    octruss()
        .args(["refine", "--scheme", "tri-quad", "-o"])
        .arg(folder.path("fine.obj"))
        .arg(&pyramid)
        .assert()
        .success()
        .stdout("14 vertices, 20 faces\n");
    let fine = read::surface(&folder.path("fine.obj")).unwrap();
    let near = |vertex: usize, want: [f64; 3]| {
        let pairs = fine.points[vertex].iter().zip(&want);
        let is_near = pairs.clone().all(|(got, want)| (got - want).abs() < 1e-15);
        assert!(is_near, "{vertex}: {:?}, not {want:?}", fine.points[vertex]);
    };
    near(0, [95.0 / 168.0, 95.0 / 168.0, 3.0 / 28.0]);
    near(4, [0.0, 0.0, 5.0 / 8.0]);
    near(5, [0.0, 119.0 / 192.0, 1.0 / 8.0]);
    near(13, [0.0, 0.0, 0.0]);
    assert_eq!(fine.faces.iter().filter(|f| f.len() == 4).count(), 4);
}

/// What the scheme does not take or has not got is said, and nothing is written.
#[test]
fn tri_quad_refuses_polygons_and_limits() {
    let folder = Folder::new();
    let pyramid = folder.write("pyramid.obj", PYRAMID);
    let pentagon = folder.write(
        "pentagon.obj",
        "v 0 0 0\nv 2 0 0\nv 3 1 0\nv 1 2 0\nv -1 1 0\nv 0 -1 0\nf 1 2 3 4 5\nf 2 1 6\n",
    );
    let out = folder.path("none.obj");
    let refuses = |command: &[&str], mesh: &std::path::Path, words: &str| {
        octruss()
            .args(command)
            .args(["--scheme", "tri-quad", "-o"])
            .arg(&out)
            .arg(mesh)
            .assert()
            .failure()
            .stderr(contains(words));
        assert!(!out.exists());
    };
    let five = "face 0 has 5 corners, but the scheme is for triangles and quads";
    refuses(&["refine"], &pentagon, five);
    refuses(&["bake"], &pentagon, five);
    refuses(&["refine", "--limit"], &pyramid, "have no limit masks");
    refuses(&["bake", "--limit"], &pyramid, "have no limit masks");
}

/// As for Catmull-Clark above: the clones are rounded besides, to 2^-8 of a unit, so that a level is
/// off by half a unit and half of 2^-8 more. The masks over the vertices of these levels have weights of
/// either sign, with magnitudes that add up to at most 13/12 (a clone is at most that).
#[test]
fn a_baked_tri_quad_surface_moves_as_the_refined_one() {
    let folder = Folder::new();
    let pyramid = folder.write("pyramid.obj", PYRAMID);
    let posed = folder.write(
        "posed.obj",
        PYRAMID.replacen("v 1 1 0", "v 1.5 1.25 -0.75", 1),
    );
    let (bundle, skin) = (folder.path("skin.oct"), folder.path("skin.obj"));
    octruss()
        .args(["bake", "--scheme", "tri-quad", "--levels", "3"])
        .args(["--fraction-bits", "20", "--skin"])
        .arg(&skin)
        .arg("-o")
        .arg(&bundle)
        .arg(&pyramid)
        .assert()
        .success()
        .stdout(contains("5 control points; 194 vertices"));
    let header = std::fs::read(&bundle).unwrap();
    assert_eq!(header[40..44], [23, 0, 0, 0], "the scheme's number");
    octruss()
        .arg("deform")
        .arg(&bundle)
        .arg("--pose")
        .arg(&posed)
        .arg("--model")
        .arg(&skin)
        .arg("-o")
        .arg(folder.path("moved.obj"))
        .assert()
        .success();
    octruss()
        .args(["refine", "--scheme", "tri-quad", "--levels", "3"])
        .args(["--numeric", "fixed", "--fraction-bits", "20", "-o"])
        .arg(folder.path("refined.obj"))
        .arg(&posed)
        .assert()
        .success();
    let moved = read::surface(&folder.path("moved.obj")).unwrap();
    let refined = read::surface(&folder.path("refined.obj")).unwrap();
    assert_eq!(moved.faces, refined.faces);
    let unit = 2.0_f64.powi(-20);
    let a_level = 0.5 + 0.5 / 256.0;
    let growth = 13.0 / 12.0;
    let refining = a_level * (1.0 + growth + growth * growth);
    for (one, other) in moved.points.iter().zip(&refined.points) {
        for (a, b) in one.iter().zip(other) {
            assert!((a - b).abs() <= (refining + 1.0 + 0.5) * unit, "{a} {b}");
        }
    }
}
