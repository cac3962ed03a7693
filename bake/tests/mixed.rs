//! Cages with prisms and hexahedra: what is read, refined, located and baked.

mod common;

use common::{Folder, model, octruss};
use octruss_bake::check::Volumes;
use octruss_bake::locate::Locator;
use octruss_bake::locate::inverse::reach;
use octruss_bake::mesh::{Cells, Point, Shape, SolidMesh};
use octruss_bake::progress::Silent;
use octruss_bake::read::{gmsh, medit, vtk, vtu};
use octruss_bake::refine::{BoundaryRule, Level, Refinement, Scheme};
use octruss_bake::table::{Input, Options, bake};
use octruss_bake::write;
use predicates::str::contains;
use rand::rngs::StdRng;
use rand::{RngExt as _, SeedableRng as _};
use std::path::Path;

/// A cube, on its top a pyramid of two tetrahedra, on its right a prism, and on that another whose
/// triangle lies on half of the first one's... none touch but by whole faces, save the tetrahedra.
///
/// Vertices: 0 to 7 the cube [0, 2]^3, 8 the apex above it, 9 and 10 the far edge of the prism.
fn house() -> SolidMesh {
    SolidMesh {
        points: vec![
            [0.0, 0.0, 0.0],
            [2.0, 0.0, 0.0],
            [2.0, 2.0, 0.0],
            [0.0, 2.0, 0.0],
            [0.0, 0.0, 2.0],
            [2.0, 0.0, 2.0],
            [2.0, 2.0, 2.0],
            [0.0, 2.0, 2.0],
            [1.0, 1.0, 3.0],
            [4.0, 0.0, 0.0],
            [4.0, 2.0, 0.0],
        ],
        cells: Cells {
            tetrahedra: vec![[4, 5, 6, 8], [4, 6, 7, 8]],
            octahedra: vec![],
            // The triangles 1 9 5 and 2 10 6.
            prisms: vec![[1, 5, 9, 2, 6, 10]],
            hexahedra: vec![[0, 1, 2, 3, 4, 5, 6, 7]],
        },
        ..SolidMesh::default()
    }
}

fn refined(mesh: &SolidMesh, levels: u32, boundary: BoundaryRule) -> (Level, Vec<Point>) {
    let mut level = Level::of_scheme(mesh, Scheme::Mixed, None).unwrap();
    let mut points = mesh.points.clone();
    for _ in 0..levels {
        let mut step = Refinement::new(&level, boundary.to_core()).unwrap();
        points = step.points(&points).unwrap();
        level = step.split().unwrap();
    }
    (level, points)
}

#[test]
fn the_house_is_sound() {
    let mesh = house();
    assert_eq!(Volumes::of(&mesh.cells, &mesh.points), Volumes::default());
}

/// What is written is read back, positive: the wedge of VTK is turned on both ways.
#[test]
fn vtk_takes_and_gives_all_shapes() {
    let mesh = house();
    for extension in ["vtu", "vtk"] {
        let mut bytes = Vec::new();
        write::solid(extension, &mesh, &mut bytes).unwrap();
        let again = match extension {
            "vtu" => vtu::read(&bytes),
            _ => vtk::read(&bytes),
        };
        let again = again.unwrap();
        assert_eq!(again.cells, mesh.cells, "{extension}");
        assert_eq!(again.points, mesh.points, "{extension}");
        assert!(again.notes.is_empty());
    }
}

/// The wedge as VTK's documentation has it, its triangles turned against Gmsh's, and as other
/// programs write it; a voxel; a pyramid; cell by cell.
#[test]
fn the_shapes_of_vtk() {
    let file = |cells: &str, kinds: &str, number: usize| {
        let length = cells.split_whitespace().count();
        format!(
            "# vtk DataFile Version 3.0\n\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 9 double\n\
             0 0 0 1 0 0 0 1 0 1 1 0 0 0 1 1 0 1 0 1 1 1 1 1 0.5 0.5 2\n\
             CELLS {number} {length}\n{cells}\nCELL_TYPES {number}\n{kinds}\n"
        )
    };
    // Points: x runs fastest, then y, then z, as a voxel lists them; the last is an apex.
    let voxel = vtk::read(file("8 0 1 2 3 4 5 6 7", "11", 1).as_bytes()).unwrap();
    assert_eq!(voxel.cells.hexahedra, [[0, 1, 3, 2, 4, 5, 7, 6]]);
    assert_eq!(Volumes::of(&voxel.cells, &voxel.points), Volumes::default());
    // A positive wedge has the corner 3 on the other side of (0, 1, 2) than its normal.
    let wedge = vtk::read(file("6 0 2 1 4 6 5", "13", 1).as_bytes()).unwrap();
    assert_eq!(wedge.cells.prisms, [[0, 1, 2, 4, 5, 6]]);
    assert!(wedge.notes.is_empty());
    let turned = vtk::read(file("6 0 1 2 4 5 6", "13", 1).as_bytes()).unwrap();
    assert_eq!(turned.cells.prisms, [[0, 1, 2, 4, 5, 6]]);
    assert_eq!(
        turned.notes,
        ["every wedge has negative volume in VTK's order of its corners: they are taken in Gmsh's"]
    );
    let pyramid = vtk::read(file("5 4 5 7 6 8", "14", 1).as_bytes()).unwrap();
    assert_eq!(pyramid.cells.tetrahedra, [[4, 5, 7, 8], [4, 7, 6, 8]]);
    assert_eq!(pyramid.notes, ["1 pyramid is cut into two tetrahedra each"]);
}

/// MSH 2.2 as Gmsh writes it: a hexahedron (type 5), a prism (6) and a pyramid (7) with physical
/// groups. The pyramid's base is cut along the diagonal of its least vertex.
#[test]
fn gmsh_takes_all_shapes() {
    let text = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n11\n1 0 0 0\n2 2 0 0\n3 2 2 0\n4 0 2 0\n\
                5 0 0 2\n6 2 0 2\n7 2 2 2\n8 0 2 2\n9 1 1 3\n10 4 0 0\n11 4 2 0\n$EndNodes\n\
                $Elements\n3\n1 7 2 3 1 6 7 8 5 9\n2 6 2 4 1 2 6 10 3 7 11\n3 5 2 5 1 1 2 3 4 5 6 7 8\n\
                $EndElements\n";
    let mesh = gmsh::read(text.as_bytes()).unwrap();
    let want = house();
    // The base 5 6 7 4 has its least vertex, 4, last.
    assert_eq!(mesh.cells.tetrahedra, [[6, 7, 4, 8], [6, 4, 5, 8]]);
    assert_eq!(mesh.cells.prisms, want.cells.prisms);
    assert_eq!(mesh.cells.hexahedra, want.cells.hexahedra);
    assert_eq!(mesh.points, want.points);
    let labels: Vec<i32> = mesh.labels.iter().collect();
    assert_eq!(labels, [3, 3, 4, 5]);
    assert_eq!(Volumes::of(&mesh.cells, &mesh.points), Volumes::default());
}

#[test]
fn medit_takes_all_shapes() {
    let points = "MeshVersionFormatted 2\nDimension 3\nVertices 11\n0 0 0 0\n2 0 0 0\n2 2 0 0\n0 2 0 0\n\
                  0 0 2 0\n2 0 2 0\n2 2 2 0\n0 2 2 0\n1 1 3 0\n4 0 0 0\n4 2 0 0\n";
    let cells =
        "Hexahedra 1\n1 2 3 4 5 6 7 8 5\nPrisms 1\n2 6 10 3 7 11 4\nPyramids 1\n5 6 7 8 9 3\nEnd\n";
    let mesh = medit::read(format!("{points}{cells}").as_bytes()).unwrap();
    let want = house();
    assert_eq!(mesh.cells, want.cells);
    let labels: Vec<i32> = mesh.labels.iter().collect();
    assert_eq!(labels, [3, 3, 4, 5]);
}

/// Two pyramids on one base choose the same diagonal, whichever way round they list it; and a
/// tetrahedron that lies on the base has chosen already.
#[test]
fn pyramids_are_cut_alike() {
    let read = |cells: &str, number: usize, kinds: &str| {
        let length = cells.split_whitespace().count();
        let text = format!(
            "# vtk DataFile Version 3.0\n\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 6 double\n\
             1 0 0 1 1 0 0 1 0 0 0 0 0.5 0.5 1 0.5 0.5 -1\n\
             CELLS {number} {length}\n{cells}\nCELL_TYPES {number}\n{kinds}\n"
        );
        vtk::read(text.as_bytes()).unwrap().cells.tetrahedra
    };
    let both = read("5 0 1 2 3 4 5 2 1 0 3 5", 2, "14 14");
    assert_eq!(both[..2], [[0, 1, 2, 4], [0, 2, 3, 4]]);
    // The second one's base starts elsewhere and turns the other way: again from 0 to 2.
    assert_eq!(both[2..], [[2, 1, 0, 5], [2, 0, 3, 5]]);
    // A tetrahedron below, on the half 1 2 3: the diagonal from 1 to 3.
    let decided = read("4 1 3 2 5 5 0 1 2 3 4", 2, "10 14");
    assert_eq!(decided, [[1, 3, 2, 5], [1, 2, 3, 4], [1, 3, 0, 4]]);
}

/// Random cells with corners moved by up to a quarter of their edges.
fn distorted(rng: &mut StdRng, corners: &[Point]) -> Vec<Point> {
    let moved = |corner: &Point| corner.map(|x| x + rng.random_range(-0.25..0.25));
    corners.iter().map(moved).collect()
}

fn one_cell(shape: Shape, points: Vec<Point>) -> SolidMesh {
    let mut cells = Cells::default();
    match shape {
        Shape::Prism => cells.prisms.push([0, 1, 2, 3, 4, 5]),
        _ => cells.hexahedra.push([0, 1, 2, 3, 4, 5, 6, 7]),
    }
    SolidMesh {
        points,
        cells,
        ..SolidMesh::default()
    }
}

/// Points with given weights in a distorted cell are found in it, in its interior, on faces, edges
/// and corners, and the weights found give them back to within the stated distance. A cell of a
/// thousandth of its height is searched as well.
#[test]
fn points_of_distorted_cells_are_found() {
    let mut rng = StdRng::seed_from_u64(5);
    let cube: Vec<Point> = [[0, 0], [1, 0], [1, 1], [0, 1]]
        .iter()
        .map(|[x, y]| [f64::from(*x), f64::from(*y), 0.0])
        .collect();
    let lifted = |flat: &[Point]| {
        [
            flat,
            &flat
                .iter()
                .map(|[x, y, _]| [*x, *y, 1.0])
                .collect::<Vec<_>>(),
        ]
        .concat()
    };
    let prism = lifted(&[[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
    let cube = lifted(&cube);
    for round in 0..400 {
        for (shape, corners) in [(Shape::Prism, &prism), (Shape::Hexahedron, &cube)] {
            let mut points = distorted(&mut rng, corners);
            if round % 4 == 3 {
                for point in &mut points {
                    point[2] /= 1000.0;
                }
            }
            let mesh = one_cell(shape, points);
            let boundary = Level::new(&mesh).unwrap().boundary_faces();
            let locator = Locator::new(&mesh.cells, &boundary, &mesh.points);
            for _ in 0..10 {
                // Every third parameter lies at an end.
                let [r, s, t]: [f64; 3] = std::array::from_fn(|_| match rng.random_range(0..6) {
                    0 => 0.0,
                    1 => 1.0,
                    _ => rng.random(),
                });
                let weights: Vec<f64> = match shape {
                    Shape::Prism => {
                        let (r, s) = if r + s > 1.0 {
                            (1.0 - r, 1.0 - s)
                        } else {
                            (r, s)
                        };
                        let low = [1.0 - r - s, r, s];
                        [low.map(|w| w * (1.0 - t)), low.map(|w| w * t)].concat()
                    }
                    _ => {
                        let low = [(1.0 - r) * (1.0 - s), r * (1.0 - s), r * s, (1.0 - r) * s];
                        [low.map(|w| w * (1.0 - t)), low.map(|w| w * t)].concat()
                    }
                };
                let weighted = |weights: &mut dyn Iterator<Item = (usize, f64)>| {
                    let mut sum = [0.0; 3];
                    for (corner, weight) in weights {
                        for (axis, total) in sum.iter_mut().enumerate() {
                            *total += weight * mesh.points[corner][axis];
                        }
                    }
                    sum
                };
                let point = weighted(&mut weights.iter().copied().enumerate());
                let found = locator
                    .inside(point)
                    .unwrap_or_else(|| panic!("{shape:?} {round} {point:?}"));
                let again = weighted(&mut found.iter().map(|(v, w)| (*v as usize, *w)));
                let bound = reach(&mesh.points);
                for axis in 0..3 {
                    assert!(
                        (again[axis] - point[axis]).abs() <= bound,
                        "{shape:?} {round}"
                    );
                }
                let sum: f64 = found.iter().map(|(_, weight)| weight).sum();
                assert!((sum - 1.0).abs() <= 8.0 * f64::EPSILON);
            }
        }
    }
}

/// Nothing is lost between cells: every point of a refined solid's cells is found, with all of its
/// quadrilaterals covered by triangles and not; and the weights are continuous through the lens
/// between a curved quadrilateral and the triangles on it.
#[test]
fn nothing_is_lost_between_cells() {
    let mut mesh = house();
    // A warped top: the tetrahedra's triangles do not lie on the hexahedron's bilinear face.
    mesh.points[6] = [2.25, 2.0, 2.5];
    mesh.points[4] = [0.0, -0.25, 1.75];
    for levels in 0..3 {
        let (level, points) = refined(&mesh, levels, BoundaryRule::TriQuad);
        let boundary = level.boundary_faces();
        let locator = Locator::new(&level.cells, &boundary, &points);
        let mut rng = StdRng::seed_from_u64(u64::from(levels));
        let cells: Vec<&[u32]> = level.cells.corners().collect();
        for _ in 0..4000 {
            // A point between corners of a cell or of two that share one.
            let cell = cells[rng.random_range(0..cells.len())];
            let mut weights: Vec<f64> = cell.iter().map(|_| rng.random::<f64>()).collect();
            for weight in &mut weights {
                if rng.random_range(0..3) == 0 {
                    *weight = 0.0;
                }
            }
            let sum: f64 = weights.iter().sum();
            if sum == 0.0 || weights.iter().filter(|w| **w > 0.0).count() < 4 {
                continue;
            }
            let mut point = [0.0; 3];
            for (vertex, weight) in cell.iter().zip(&weights) {
                for (axis, total) in point.iter_mut().enumerate() {
                    *total += weight / sum * points[*vertex as usize][axis];
                }
            }
            // The hull of a cell may stick out of the solid where a boundary face is hollow; inside the
            // solid it must be found.
            if let Some(found) = locator.inside(point) {
                let mut again = [0.0; 3];
                for (vertex, weight) in found {
                    for (axis, total) in again.iter_mut().enumerate() {
                        *total += weight * points[vertex as usize][axis];
                    }
                }
                for axis in 0..3 {
                    assert!((again[axis] - point[axis]).abs() <= 1e-7);
                }
            } else {
                let nearest = locator.nearest(point).unwrap();
                assert!(nearest.distance < 0.2, "lost by {}", nearest.distance);
            }
        }
    }
}

/// Along a line that crosses the lens between a hexahedron and the tetrahedra on it weights change
/// no faster than with the point where the lens is in no cell. Where it is in two, tetrahedra have
/// it, and weights jump at their triangle: by a quarter at most between affine and bilinear ones (the
/// greatest of min(u, v) - u v), and by the lens's depth of at most an eighth over the cell's height of 2.
#[test]
fn weights_are_continuous_through_a_lens() {
    for (lift, most_at_once) in [(0.5, 0.0), (-0.5, 0.25 + 0.0625)] {
        let mut mesh = house();
        mesh.points[6][2] += lift;
        let boundary = Level::new(&mesh).unwrap().boundary_faces();
        let locator = Locator::new(&mesh.cells, &boundary, &mesh.points);
        for [x, y] in [[1.25, 0.5], [0.5, 1.25], [1.5, 1.25], [1.0, 1.0]] {
            let mut before: Option<Vec<f64>> = None;
            const STEPS: u32 = 2000;
            for step in 0..=STEPS {
                let z = 1.0 + f64::from(step) * 1.25 / f64::from(STEPS);
                let found = locator
                    .inside([x, y, z])
                    .unwrap_or_else(|| panic!("{lift} {x} {y} {z}"));
                let mut weights = vec![0.0; mesh.points.len()];
                for (vertex, weight) in found {
                    weights[vertex as usize] += weight;
                }
                if let Some(before) = &before {
                    for (weight, before) in weights.iter().zip(before) {
                        let jump = (weight - before).abs();
                        // Edges are no shorter than 1.5; 8 is more than any weight's slope here.
                        assert!(
                            jump <= most_at_once + 8.0 * 1.25 / f64::from(STEPS),
                            "{lift} {x} {y} {z}: {jump}"
                        );
                    }
                }
                before = Some(weights);
            }
        }
    }
}

/// A cage of tetrahedra alone refines and bakes to the same bits with the scheme tet-oct, if its
/// boundary follows the same rule.
#[test]
fn tetrahedra_alone_are_the_scheme_tet_oct() {
    let folder = Folder::new();
    let cage = Path::new(env!("CARGO_MANIFEST_DIR")).join("../models/finger.msh");
    let model = Path::new(env!("CARGO_MANIFEST_DIR")).join("../models/finger.obj");
    for (scheme, name) in [("mixed", "mixed.vtu"), ("tet-oct", "tet-oct.vtu")] {
        octruss()
            .args(["refine", cage.to_str().unwrap(), "--scheme", scheme])
            .args([
                "--boundary",
                "tri-quad",
                "--numeric",
                "fixed",
                "--levels",
                "2",
            ])
            .arg("-o")
            .arg(folder.path(name))
            .assert()
            .success();
    }
    let bytes = |name: &str| std::fs::read(folder.path(name)).unwrap();
    assert!(bytes("mixed.vtu") == bytes("tet-oct.vtu"));
    let rows = |scheme: Scheme| {
        let (cage_mesh, model_mesh) = (
            octruss_bake::read::solid(&cage).unwrap(),
            octruss_bake::read::model(&model).unwrap(),
        );
        let points: Vec<Point> = model_mesh.points.iter().step_by(7).copied().collect();
        let input = Input {
            cage: &cage_mesh,
            cage_file: &cage,
            model: &points,
            model_file: &model,
        };
        let options = Options {
            scheme,
            boundary: BoundaryRule::TriQuad,
            random_poses: 0,
            ..Options::default()
        };
        let mut bundle = bake(input, &options, &mut Silent).unwrap().bundle;
        // The header's checksum and scheme differ and nothing else.
        assert_eq!(bundle[40], u8::try_from(scheme.code()).unwrap());
        bundle[40] = 0;
        bundle[16..20].fill(0);
        bundle
    };
    let (mixed, tet_oct) = (rows(Scheme::Mixed), rows(Scheme::TetOct));
    let differing: Vec<usize> = (0..mixed.len())
        .filter(|k| mixed[*k] != tet_oct[*k])
        .collect();
    assert!(
        mixed.len() == tet_oct.len() && differing.is_empty(),
        "bytes {differing:?}"
    );
}

#[test]
fn other_schemes_refuse_prisms_and_hexahedra() {
    let folder = Folder::new();
    let mut bytes = Vec::new();
    write::solid("vtu", &house(), &mut bytes).unwrap();
    let cage = folder.path("house.vtu");
    std::fs::write(&cage, bytes).unwrap();
    let run = |extra: &[&str]| {
        let mut command = octruss();
        command.arg("refine").arg(&cage).args(extra);
        command.arg("-o").arg(folder.path("out.vtu")).assert()
    };
    for scheme in ["tet-oct", "box-spline", "box-spline-averaged"] {
        run(&["--scheme", scheme]).failure().stderr(contains(format!(
            "the mesh has 1 prism and 1 hexahedron; a cage of the scheme {scheme} consists of tetrahedra and octahedra\n  help: add --scheme mixed"
        )));
    }
    run(&["--scheme", "mixed", "--boundary", "loop"])
        .failure()
        .stderr(contains("Loop's scheme has no rule for the quadrilaterals"));
    run(&["--scheme", "mixed"]).success();
    octruss()
        .arg("info")
        .arg(&cage)
        .assert()
        .success()
        .stdout(contains("2 tetrahedra, 0 octahedra, 1 prisms, 1 hexahedra"));
}

/// The mixed finger as Gmsh 4.1 and 2.2, which list its creases, and as `.vtu`, which cannot: beside a file
/// of the same features all three give the same bundle, to the byte.
#[test]
fn the_finger_is_the_same_in_every_format() {
    let folder = Folder::new();
    let mesh = octruss_bake::read::solid(&model("finger-mixed.msh")).unwrap();
    let mut features = String::new();
    for [a, b] in &mesh.features.creases {
        features += &format!("crease {a} {b}\n");
    }
    for corner in &mesh.features.corners {
        features += &format!("corner {corner}\n");
    }
    assert!(mesh.features.creases.len() > 8 && mesh.features.corners.len() == 4);
    let features = folder.write("features.txt", features);
    let vtu = folder.path("finger.vtu");
    octruss()
        .args(["refine", "--scheme", "mixed", "--levels", "0", "-o"])
        .arg(&vtu)
        .arg(model("finger-mixed.msh"))
        .assert()
        .success();
    let bundle = |cage: &std::path::Path, name: &str, features: Option<&std::path::Path>| {
        let mut command = octruss();
        command
            .args(["bake", "--scheme", "mixed", "--levels", "1", "-o"])
            .arg(folder.path(name))
            .arg("--model")
            .arg(model("finger.obj"))
            .arg(cage);
        if let Some(features) = features {
            command.arg("--features").arg(features);
        }
        command.assert().success();
        folder.read(name)
    };
    let new = bundle(&model("finger-mixed.msh"), "new.oct", None);
    assert!(bundle(&model("finger-mixed-22.msh"), "old.oct", None) == new);
    assert!(bundle(&vtu, "vtu.oct", Some(&features)) == new);
}

/// A block of all shapes whose edges are creases and whose corners are kept stays a box: what is on a side
/// stays on it, exactly, since weights add up to one and coordinates are small whole numbers.
#[test]
fn flat_sides_with_sharp_edges_stay_flat() {
    let features = model("slices/block-features.txt");
    let cage = model("slices/block.msh");
    let mesh = octruss_bake::read::solid_with_features(&cage, Some(&features)).unwrap();
    let (level, points) = refined(&mesh, 2, BoundaryRule::TriQuad);
    let size = [4.0, 2.0, 4.0];
    for point in &points {
        for (coordinate, size) in point.iter().zip(size) {
            assert!((-1e-12..=size + 1e-12).contains(coordinate), "{point:?}");
        }
    }
    let boundary = level.boundary().as_flattened().iter();
    let mut boundary: Vec<u32> = boundary
        .chain(level.boundary_quads().as_flattened())
        .copied()
        .collect();
    boundary.sort_unstable();
    boundary.dedup();
    // A grid of 16 by 8 by 16 cells has that many vertices outside.
    assert_eq!(boundary.len(), 17 * 9 * 17 - 15 * 7 * 15);
    for vertex in boundary {
        let point = points[vertex as usize];
        let is_on = |k: usize| point[k].abs() < 1e-12 || (point[k] - size[k]).abs() < 1e-12;
        assert!((0..3).any(is_on), "{point:?}");
    }
}
