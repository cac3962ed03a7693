//! Solids with sheets: triangles of no cell that follow the surface rule ("Spline-based Solid
//! Subdivision Schemes over Arbitrary Tetrahedral Meshes", figure 29). Expected positions are
//! computed by hand from Loop's masks; all are exact.

mod common;

use common::{Folder, octruss};
use octruss_bake::mesh::{Cells, Features, Labels, Point, SolidMesh};
use octruss_bake::read;
use octruss_bake::refine::{BoundaryRule, Level, Refinement, Scheme};
use octruss_bake::table::{Input, Options, bake};
use predicates::str::contains;
use std::path::Path;

const SCHEMES: [Scheme; 3] = [Scheme::TetOct, Scheme::BoxSpline, Scheme::BoxSplineAveraged];

/// A tetrahedron far away, and a hexagon of six triangles round a raised vertex.
fn hexagon() -> SolidMesh {
    let ring = [[16, 0], [0, 16], [-16, 16], [-16, 0], [0, -16], [16, -16]];
    let mut points = vec![
        [100.0, 100.0, 100.0],
        [108.0, 100.0, 100.0],
        [100.0, 108.0, 100.0],
        [100.0, 100.0, 108.0],
        [0.0, 0.0, 64.0],
    ];
    points.extend(ring.map(|[x, y]| [f64::from(x), f64::from(y), 0.0]));
    SolidMesh {
        points,
        cells: Cells {
            tetrahedra: vec![[0, 1, 2, 3]],
            octahedra: vec![],
            ..Cells::default()
        },
        features: Features {
            sheets: (0..6).map(|k| [4, 5 + k, 5 + (k + 1) % 6]).collect(),
            ..Features::default()
        },
        labels: Labels {
            tetrahedra: vec![7],
            octahedra: vec![],
            ..Labels::default()
        },
        ..SolidMesh::default()
    }
}

/// A tetrahedron with a fin: one triangle that hangs on the edge between vertices 0 and 1.
fn fin() -> SolidMesh {
    SolidMesh {
        points: vec![
            [0.0, 0.0, 0.0],
            [48.0, 0.0, 0.0],
            [0.0, 48.0, 0.0],
            [0.0, 0.0, 48.0],
            [24.0, -48.0, -24.0],
        ],
        cells: Cells {
            tetrahedra: vec![[0, 1, 2, 3]],
            octahedra: vec![],
            ..Cells::default()
        },
        features: Features {
            sheets: vec![[1, 0, 4]],
            ..Features::default()
        },
        ..SolidMesh::default()
    }
}

fn refined(mesh: &SolidMesh, scheme: Scheme) -> (Vec<Point>, Level) {
    let level = Level::of_scheme(mesh, scheme, None).unwrap();
    let mut step = Refinement::new(&level, BoundaryRule::Loop.to_core()).unwrap();
    (step.points(&mesh.points).unwrap(), step.split().unwrap())
}

/// Inside the hexagon Loop's masks 5/8, 1/16 and 3/8, 1/8; on its open edge the cubic B-spline, for
/// which nobody has to ask.
#[test]
fn a_sheet_follows_the_surface_rule_and_keeps_its_rim() {
    for scheme in SCHEMES {
        let (points, level) = refined(&hexagon(), scheme);
        assert_eq!(level.sheets().len(), 24);
        assert_eq!(level.creases.len(), 12);
        assert_eq!(points[4], [0.0, 0.0, 40.0]);
        // (16, 0) between (16, -16) and (0, 16): 1/8 6/8 1/8.
        assert_eq!(points[5], [14.0, 0.0, 0.0]);
        let has = |point: Point| points[11..].contains(&point);
        // The middle of the spoke to (16, 0), and of the rim from there to (0, 16).
        assert!(has([8.0, 0.0, 24.0]) && has([8.0, 8.0, 0.0]));
    }
}

/// The edge between a fin and the boundary has three triangles: 3/8 of each end and 1/12 of each
/// opposite corner.
#[test]
fn a_seam_takes_the_mean_of_all_opposite_corners() {
    for scheme in SCHEMES {
        let (points, level) = refined(&fin(), scheme);
        assert_eq!((level.boundary().len(), level.sheets().len()), (16, 4));
        // 3/8 (48, 0, 0) + 1/12 ((0, 48, 0) + (0, 0, 48) + (24, -48, -24)).
        assert!(points.contains(&[20.0, 0.0, 2.0]));
    }
}

#[test]
fn sheets_are_written_with_the_solid() {
    let folder = Folder::new();
    let cage = folder.write("fin.msh", GMSH);
    for (output, parts) in [
        (
            "out.vtu",
            vec!["NumberOfCells=\"9\"", "5\n5\n5\n5\n</DataArray>"],
        ),
        (
            "out.vtk",
            vec![
                "CELLS 9 70",
                "CELL_TYPES 9\n10\n10\n10\n10\n42\n5\n5\n5\n5\n",
            ],
        ),
        ("out.obj", vec!["f 1 "]),
    ] {
        octruss()
            .args(["refine", "--scheme", "box-spline", "-o"])
            .arg(folder.path(output))
            .arg(&cage)
            .assert()
            .success()
            .stdout(contains("16 boundary triangles, 4 triangles of sheets"));
        let text = String::from_utf8(folder.read(output)).unwrap();
        for part in parts {
            assert!(text.contains(part), "{output} lacks {part:?}:\n{text}");
        }
        if output == "out.obj" {
            assert_eq!(
                text.lines().filter(|line| line.starts_with("f ")).count(),
                20
            );
        }
    }
}

/// A model's point on a fin moves with it: the seam's ends and the fin's tip carry it.
#[test]
fn points_on_a_sheet_are_baked() {
    let (cage, file) = (fin(), Path::new("fin"));
    let tip = [24.0, -48.0, -24.0];
    let input = Input {
        cage: &cage,
        cage_file: file,
        model: &[tip, [24.0, -24.0, -12.0]],
        model_file: file,
    };
    let options = Options {
        levels: 0,
        ..Options::default()
    };
    let baked = bake(input, &options, &mut octruss_bake::progress::Silent).unwrap();
    assert_eq!(
        baked.rows,
        [vec![(4, 1.0)], vec![(0, 0.25), (1, 0.25), (4, 0.5)]]
    );
}

#[test]
fn gmsh_names_sheets_and_mistakes_are_answered() {
    let folder = Folder::new();
    let cage = folder.write("fin.msh", GMSH);
    assert_eq!(read::solid(&cage).unwrap().features, fin().features);

    let face = folder.write("face.txt", "sheet 2 1 0\n");
    octruss()
        .args(["info", "--features"])
        .args([&face, &cage])
        .assert()
        .code(1)
        .stderr(contains(
            "the sheet's triangle of vertices 0, 1 and 2 (counted from 0) is a face of a cell",
        ));
    octruss()
        .args(["volume", "--scheme", "loop"])
        .arg(&cage)
        .assert()
        .code(1)
        .stderr(contains("a sheet hangs on the boundary at vertex 1"));
}

/// [`fin`] as Gmsh writes it, with a name for the fin.
const GMSH: &str = "$MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
2
2 2 \"sheet fin\"
3 1 \"body\"
$EndPhysicalNames
$Nodes
5
1 0 0 0
2 48 0 0
3 0 48 0
4 0 0 48
5 24 -48 -24
$EndNodes
$Elements
2
1 2 2 2 1 2 1 5
2 4 2 1 1 1 2 3 4
$EndElements
";
