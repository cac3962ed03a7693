//! `octruss locate`: cells, coordinates and labels worked out by hand, and held against `refine`.

mod common;

use common::{Folder, model, octruss};
use octruss_bake::read;
use predicates::prelude::PredicateBooleanExt;
use predicates::str::{contains, is_empty};
use serde_json::{Value, json};

/// Two tetrahedra on the face 0, 1, 2, with labels.
const CAGE: &str = "MeshVersionFormatted 2\nDimension 3\nVertices 5\n0 0 0 0\n2 0 0 0\n0 2 0 0\n0.5 0.25 2 0\n0.5 0.5 -2 0\nTetrahedra 2\n1 2 3 4 11\n1 3 2 5 -4\nEnd\n";

fn located(arguments: &[&str], cage: &std::path::Path, points: &std::path::Path) -> Value {
    let output = octruss()
        .args(["locate", "--json"])
        .args(arguments)
        .arg(cage)
        .arg("--points")
        .arg(points)
        .assert()
        .success()
        .stderr(is_empty())
        .get_output()
        .stdout
        .clone();
    serde_json::from_slice(&output).unwrap()
}

/// With a fixed boundary nothing moves, for every vertex is on it: vertices 5 to 13 are the midpoints
/// of the edges 01 02 03 04 12 13 14 23 24. Corner `k` of child `i` is the midpoint of corners `i` and
/// `k`, and a tetrahedron's octahedron is (m01, m02, m03, m23, m13, m12).
#[test]
fn cells_and_coordinates_worked_out_by_hand() {
    let folder = Folder::new();
    let cage = folder.write("two.mesh", CAGE);
    // The middle of the first child; the top; the middle of the second child of the lower
    // tetrahedron, whose corners are 2, the midpoints of 02, 21 and 24; beyond the top.
    let points = folder.write(
        "points.csv",
        "x,y,z\n0.3125,0.28125,0.25\n0.5,0.25,2\n0.3125,1.3125,-0.25\n0.5,0.25,3\n",
    );
    let arguments = ["--levels", "1", "--boundary", "fixed"];
    let cell = |index: u32| json!({ "shape": "tetrahedron", "index": index });
    let found = located(&arguments, &cage, &points);
    assert_eq!(
        found,
        json!({
            "levels": 1,
            "points": [
                { "cell": cell(0), "cage_cell": cell(0), "label": 11, "vertices": [0, 5, 6, 7],
                  "coordinates": [0.25, 0.25, 0.25, 0.25], "distance_outside": 0.0 },
                { "cell": cell(3), "cage_cell": cell(0), "label": 11, "vertices": [7, 10, 12, 3],
                  "coordinates": [0.0, 0.0, 0.0, 1.0], "distance_outside": 0.0 },
                { "cell": cell(5), "cage_cell": cell(1), "label": -4, "vertices": [6, 2, 9, 13],
                  "coordinates": [0.25, 0.25, 0.25, 0.25], "distance_outside": 0.0 },
                { "cell": cell(3), "cage_cell": cell(0), "label": 11, "vertices": [7, 10, 12, 3],
                  "coordinates": [0.0, 0.0, 0.0, 1.0], "distance_outside": 1.0 },
            ],
            "points_outside": 1,
        })
    );
    // One above the top: twice the top less once a point of the opposite face.
    let found = located(
        &[&arguments[..], &["--outside", "extrapolate"]].concat(),
        &cage,
        &points,
    );
    assert_eq!(
        found["points"][3]["coordinates"],
        json!([-0.625, -0.25, -0.125, 2.0])
    );
    assert_eq!(found["points"][3]["distance_outside"], 1.0);
    octruss()
        .arg("locate")
        .args(arguments)
        .arg(&cage)
        .arg("--points")
        .arg(&points)
        .assert()
        .success()
        .stdout(contains("point 3: tetrahedron 3 of the cage's tetrahedron 0, label 11, outside by 1: 0 of vertex 7, 0 of vertex 10, 0 of vertex 12, 1 of vertex 3\n4 points, 1 outside\n"));
    octruss()
        .arg("locate")
        .args(arguments)
        .args(["--outside", "error"])
        .arg(&cage)
        .arg("--points")
        .arg(&points)
        .assert()
        .code(1)
        .stdout(is_empty())
        .stderr(contains("points.csv: 1 of 4 points lie outside the refined cage; the farthest, point 3 (counted from 0), by 1\n"));
}

/// The middle of a tetrahedron is the middle of its octahedron, where all corners weigh alike.
#[test]
fn the_middle_of_an_octahedron() {
    let folder = Folder::new();
    let cage = folder.write("two.mesh", CAGE);
    let points = folder.write("middle.obj", "v 0.625 0.5625 0.5\n");
    let found = located(&["--levels", "1", "--boundary", "fixed"], &cage, &points);
    let point = &found["points"][0];
    assert_eq!(point["cell"], json!({ "shape": "octahedron", "index": 0 }));
    assert_eq!(point["vertices"], json!([5, 6, 7, 12, 10, 9]));
    for weight in point["coordinates"].as_array().unwrap() {
        assert!((weight.as_f64().unwrap() - 1.0 / 6.0).abs() <= 2.0 * f64::EPSILON);
    }
}

/// Cells, corners and vertices are those of the file that `refine` writes, and the weighted corners
/// give the point back to within a few roundings of its coordinates, which are below 128.
#[test]
fn the_finger_is_found_in_what_refine_writes() {
    const BOUND: f64 = 16.0 * 128.0 * f64::EPSILON;
    let folder = Folder::new();
    octruss()
        .args(["refine", "--levels", "1", "-o"])
        .arg(folder.path("refined.vtu"))
        .arg(model("finger.msh"))
        .assert()
        .success();
    let refined = read::solid(&folder.path("refined.vtu")).unwrap();
    let found = located(
        &["--levels", "1"],
        &model("finger.msh"),
        &model("finger.obj"),
    );
    let expected = read::model(&model("finger.obj")).unwrap().points;
    let points = found["points"].as_array().unwrap();
    assert_eq!(points.len(), expected.len());
    let mut octahedra = 0;
    for (point, expected) in points.iter().zip(expected) {
        let index = point["cell"]["index"].as_u64().unwrap() as usize;
        let corners = match point["cell"]["shape"].as_str().unwrap() {
            "tetrahedron" => refined.cells.tetrahedra[index].to_vec(),
            _ => {
                octahedra += 1;
                refined.cells.octahedra[index].to_vec()
            }
        };
        assert_eq!(point["vertices"], json!(corners));
        assert_eq!(point["distance_outside"], 0.0);
        let mut sum = [0.0; 3];
        for (corner, weight) in corners.iter().zip(point["coordinates"].as_array().unwrap()) {
            for (axis, sum) in sum.iter_mut().enumerate() {
                *sum += weight.as_f64().unwrap() * refined.points[*corner as usize][axis];
            }
        }
        for axis in 0..3 {
            assert!(
                (sum[axis] - expected[axis]).abs() <= BOUND,
                "{sum:?} {expected:?}"
            );
        }
    }
    assert!(octahedra > 0);
}

#[test]
fn mistakes_are_answered() {
    let folder = Folder::new();
    let cage = folder.write("two.mesh", CAGE);
    let text = folder.write("points.txt", "0 0 0\n");
    let short = folder.write("short.csv", "x,y,z\n1,2,3\n1,2\n");
    for (points, message) in [
        (
            &text,
            "points.txt: no reader of points for \".txt\" files\n  help: points are read from .csv (columns x, y, z), .obj, .ply, .stl and .off",
        ),
        (
            &short,
            "short.csv, line 3: expected the columns x, y, z, found 2 columns",
        ),
    ] {
        octruss()
            .arg("locate")
            .arg(&cage)
            .arg("--points")
            .arg(points)
            .assert()
            .code(1)
            .stderr(contains(message).and(contains("panicked").not()));
    }
}
