//! The same cage and model through every pair of formats: the same bundle, to the byte.
//!
//! Every format holds the coordinates exactly: they are multiples of 1/16. The model's vertices stand
//! in the order in which its triangles name them, which is the order that welding gives an `.stl`.

mod bytes;
mod cages;
#[path = "../common/mod.rs"]
mod common;
mod models;

use cages::Cage;
use common::{Folder, octruss};
use models::Model;
use octruss_bake::mesh::{Cells, Features, Labels, Point, SolidMesh};
use octruss_bake::progress::Silent;
use octruss_bake::read;
use octruss_bake::table::{Input, Options, Outside, bake};
use std::path::PathBuf;

/// Eight cubes in two layers of two materials, each cut into six tetrahedra round its diagonal, with
/// uneven corners; a crease surface between the materials, creases along an edge, a corner.
fn block() -> SolidMesh {
    const SIDE: u32 = 2;
    let vertex = |[x, y, z]: [u32; 3]| (x * (SIDE + 1) + y) * (SIDE + 1) + z;
    let grid = |side: u32| {
        (0..side.pow(3)).map(move |index| [index / side / side, index / side % side, index % side])
    };
    let mut mesh = SolidMesh::default();
    for place in grid(SIDE + 1) {
        let uneven = f64::from((place[0] * 5 + place[1] * 3 + place[2] * 7) % 5) / 16.0;
        mesh.points
            .push(place.map(|coordinate| f64::from(coordinate) * 2.0 + uneven));
    }
    for origin in grid(SIDE) {
        for [first, second, third] in [
            [0, 1, 2],
            [1, 2, 0],
            [2, 0, 1],
            [0, 2, 1],
            [2, 1, 0],
            [1, 0, 2],
        ] {
            let mut place = origin;
            let mut cell = [vertex(place); 4];
            for (corner, axis) in cell[1..].iter_mut().zip([first, second, third]) {
                place[axis] += 1;
                *corner = vertex(place);
            }
            if (first + 1) % 3 != second {
                cell.swap(2, 3);
            }
            mesh.cells.tetrahedra.push(cell);
            mesh.labels.tetrahedra.push(origin[0] as i32 + 1);
        }
    }
    mesh.features = Features {
        creases: vec![
            [vertex([0, 0, 0]), vertex([1, 0, 0])],
            [vertex([1, 0, 0]), vertex([2, 0, 0])],
        ],
        corners: vec![vertex([2, 2, 2])],
        // The square in the middle, which every cube cuts from its least corner to its greatest.
        faces: vec![
            [vertex([1, 0, 0]), vertex([1, 1, 0]), vertex([1, 1, 1])],
            [vertex([1, 0, 0]), vertex([1, 0, 1]), vertex([1, 1, 1])],
        ],
        ..Features::default()
    };
    mesh.features.normalise();
    mesh
}

/// A tetrahedron cut into four and an octahedron, of two materials.
fn with_octahedron() -> SolidMesh {
    let corners = [
        [0.0, 0.25, 0.0],
        [8.0, 0.0, 0.5],
        [0.0, 9.0, 0.0],
        [1.0, 1.0, 7.5],
    ];
    let mut points = corners.to_vec();
    for [a, b] in [[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]] {
        points.push(std::array::from_fn(|axis| {
            (corners[a][axis] + corners[b][axis]) / 2.0
        }));
    }
    SolidMesh {
        points,
        cells: Cells {
            tetrahedra: vec![[0, 4, 5, 6], [4, 1, 7, 8], [5, 7, 2, 9], [6, 8, 9, 3]],
            octahedra: vec![[4, 5, 6, 9, 8, 7]],
            ..Cells::default()
        },
        features: Features {
            creases: vec![[0, 4], [1, 4]],
            corners: vec![3],
            faces: vec![[4, 5, 6]],
            ..Features::default()
        },
        labels: Labels {
            tetrahedra: vec![2, 1, 1, 1],
            octahedra: vec![1],
            ..Labels::default()
        },
        ..SolidMesh::default()
    }
}

/// A strip of triangles on a winding line inside both cages.
fn strip() -> (Vec<Point>, Vec<[u32; 3]>) {
    const POINTS: u32 = 24;
    let point = |index: u32| {
        [index * 5 % 11, index * 3 % 7, index].map(|step| 1.25 + f64::from(step) / 16.0)
    };
    let faces = (2..POINTS).map(|last| [last - 2, last - 1, last]);
    ((0..POINTS).map(point).collect(), faces.collect())
}

/// The files of a cage in the folder, and the one to be named.
fn put(folder: &Folder, cage: &Cage) -> (PathBuf, PathBuf) {
    for (name, content) in &cage.files {
        folder.write(name, content);
    }
    let features = folder.write(&format!("{}-features.txt", cage.name), &cage.features);
    (folder.path(&cage.files[0].0), features)
}

fn check_pairs(expected: &SolidMesh, cages: &[Cage], models: &[Model]) {
    let folder = Folder::new();
    let (points, faces) = strip();
    let models: Vec<(PathBuf, Vec<Point>)> = models
        .iter()
        .map(|(name, content)| {
            let file = folder.write(name, content);
            let model = read::model(&file).unwrap();
            assert_eq!(
                (&model.points, &model.triangles()),
                (&points, &faces),
                "{name}"
            );
            (file, model.points)
        })
        .collect();
    let options = Options {
        levels: 1,
        outside: Outside::Nearest,
        random_poses: 0,
        ..Options::default()
    };
    let mut first: Option<Vec<u8>> = None;
    for cage in cages {
        let (file, features) = put(&folder, cage);
        let mesh = read::solid_with_features(&file, Some(&features)).unwrap();
        assert_eq!(mesh.points, expected.points, "{}", cage.name);
        assert_eq!(mesh.cells, expected.cells, "{}", cage.name);
        assert_eq!(mesh.features, expected.features, "{}", cage.name);
        assert_eq!(mesh.labels, expected.labels, "{}", cage.name);
        for (model_file, model) in &models {
            let input = Input {
                cage: &mesh,
                cage_file: &file,
                model,
                model_file,
            };
            let bundle = bake(input, &options, &mut Silent).unwrap().bundle;
            let first = first.get_or_insert_with(|| bundle.clone());
            assert!(
                *first == bundle,
                "{} with {}",
                cage.name,
                model_file.display()
            );
        }
    }
}

#[test]
fn every_pair_of_formats() {
    let (points, faces) = strip();
    let (cages, models) = (cages::tetrahedra(&block()), models::all(&points, &faces));
    assert_eq!((cages.len(), models.len()), (39, 12));
    check_pairs(&block(), &cages, &models);
}

#[test]
fn every_pair_of_formats_with_octahedra() {
    let (points, faces) = strip();
    let (cages, models) = (
        cages::grids(&with_octahedron()),
        models::all(&points, &faces),
    );
    assert_eq!((cages.len(), models.len()), (30, 12));
    check_pairs(&with_octahedron(), &cages, &models);
}

/// Through the program itself: every cage with one model, every model with one cage.
#[test]
fn the_program_writes_the_same_bundle() {
    let (points, faces) = strip();
    let (cages, models) = (cages::tetrahedra(&block()), models::all(&points, &faces));
    let folder = Folder::new();
    for (name, content) in &models {
        folder.write(name, content);
    }
    let bake = |cage: &Cage, model: &str| {
        let (file, features) = put(&folder, cage);
        octruss()
            .args([
                "bake",
                "--levels",
                "1",
                "--outside",
                "nearest",
                "--random-poses",
                "0",
                "--features",
            ])
            .args([&features, &file])
            .arg("--model")
            .arg(folder.path(model))
            .arg("-o")
            .arg(folder.path("out.oct"))
            .assert()
            .success();
        folder.read("out.oct")
    };
    let expected = bake(&cages[0], &models[0].0);
    for cage in &cages {
        assert!(bake(cage, &models[0].0) == expected, "{}", cage.name);
    }
    for (model, _) in &models {
        assert!(bake(&cages[0], model) == expected, "{model}");
    }
}
