//! Cells that share space are found, and only these.

mod common;

use common::{Folder, model, octruss};
use octruss_bake::mesh::{Cells, Point, SolidMesh};
use octruss_bake::overlap::{overlapping_cells, require_none};
use octruss_bake::read;
use octruss_bake::refine::{BoundaryRule, Level, Refinement};
use predicates::prelude::PredicateBooleanExt;
use predicates::str::contains;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// Two tetrahedra with eight vertices of their own.
fn pair(a: [Point; 4], b: [Point; 4]) -> SolidMesh {
    SolidMesh {
        points: [a, b].concat(),
        cells: Cells {
            tetrahedra: vec![[0, 1, 2, 3], [4, 5, 6, 7]],
            octahedra: vec![],
            ..Cells::default()
        },
        ..SolidMesh::default()
    }
}

fn share_space(mesh: &SolidMesh) -> bool {
    let found = overlapping_cells(&mesh.cells, &mesh.points);
    assert!(found.is_empty() || found == [[0, 1]], "{found:?}");
    !found.is_empty()
}

const UNIT: [Point; 4] = [
    [0.0, 0.0, 0.0],
    [1.0, 0.0, 0.0],
    [0.0, 1.0, 0.0],
    [0.0, 0.0, 1.0],
];

/// The cases that go wrong when only some kinds of contact are thought of.
#[test]
fn contacts_of_every_kind() {
    for (what, other, expected) in [
        ("the same place", UNIT, true),
        (
            "a common face, on the other side",
            [[0.0; 3], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, -1.0]],
            false,
        ),
        (
            "a common face, on the same side",
            [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 1.0]],
            true,
        ),
        (
            "a common edge, beside it",
            [
                [0.0; 3],
                [1.0, 0.0, 0.0],
                [0.0, -1.0, 0.0],
                [0.0, -1.0, 1.0],
            ],
            false,
        ),
        (
            "a common edge, within the angle",
            [[0.0; 3], [1.0, 0.0, 0.0], [0.5, 1.0, 0.5], [0.5, 0.5, 1.0]],
            true,
        ),
        (
            "a common vertex, opposite",
            [
                [0.0; 3],
                [-1.0, 0.0, 0.0],
                [0.0, 0.0, -1.0],
                [0.0, -1.0, 0.0],
            ],
            false,
        ),
        (
            "a common vertex, within",
            [[0.0; 3], [0.5, 0.1, 0.1], [0.1, 0.5, 0.1], [0.1, 0.1, 0.5]],
            true,
        ),
        (
            "a vertex on the slanted face",
            [
                [0.25, 0.25, 0.5],
                [2.0, 0.0, 2.0],
                [2.0, 2.0, 2.0],
                [0.0, 2.0, 2.0],
            ],
            false,
        ),
        (
            "a vertex one rounding below that face",
            [
                [0.25, 0.25, 0.5 - f64::EPSILON],
                [2.0, 0.0, 2.0],
                [2.0, 2.0, 2.0],
                [0.0, 2.0, 2.0],
            ],
            true,
        ),
        (
            "an edge through two faces, no corner inside",
            [
                [-1.0, 0.25, 0.25],
                [2.0, 0.25, 0.25],
                [2.0, 3.0, -3.0],
                [2.0, 3.0, 3.0],
            ],
            true,
        ),
        (
            "boxes that share space, cells that do not",
            [[1.0; 3], [1.0, 0.5, 0.5], [0.5, 1.0, 0.5], [0.5, 0.5, 1.0]],
            false,
        ),
        ("far away", UNIT.map(|[x, y, z]| [x + 9.0, y, z]), false),
    ] {
        assert_eq!(share_space(&pair(UNIT, other)), expected, "{what}");
        assert_eq!(
            share_space(&pair(other, UNIT)),
            expected,
            "{what}, exchanged"
        );
    }
    // Only a plane along an edge of each lies between these: none of a face does.
    let crossed = |gap: f64| {
        pair(
            [
                [-1.0, 0.0, 0.0],
                [1.0, 0.0, 0.0],
                [0.0, -1.0, -1.0],
                [0.0, 1.0, -1.0],
            ],
            [
                [0.0, -1.0, gap],
                [0.0, 1.0, gap],
                [-1.0, 0.0, 1.0],
                [1.0, 0.0, 1.0],
            ],
        )
    };
    assert!(!share_space(&crossed(0.125)));
    assert!(!share_space(&crossed(0.0)));
    assert!(share_space(&crossed(-0.125)));
}

type Corners = [[i64; 3]; 4];

fn minus(a: [i64; 3], b: [i64; 3]) -> [i64; 3] {
    std::array::from_fn(|axis| a[axis] - b[axis])
}

fn cross(a: [i64; 3], b: [i64; 3]) -> [i64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

fn dot(a: [i64; 3], b: [i64; 3]) -> i64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The separating axis theorem in whole numbers: two convex solids share no space if and only if
/// along a normal of a face, or along the cross product of an edge of each, they lie one behind the
/// other.
fn share_space_by_axes(a: &Corners, b: &Corners) -> bool {
    let edges = |t: &Corners| {
        let pairs = [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)];
        pairs.map(|(p, q)| minus(t[q], t[p]))
    };
    let normals = |t: &Corners| {
        let faces = [[0, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3]];
        faces.map(|[p, q, r]| cross(minus(t[q], t[p]), minus(t[r], t[p])))
    };
    let mut axes = [normals(a), normals(b)].concat();
    for p in edges(a) {
        axes.extend(edges(b).map(|q| cross(p, q)));
    }
    let extent = |t: &Corners, axis: [i64; 3]| {
        let along = t.map(|corner| dot(corner, axis));
        (along.iter().copied().min(), along.iter().copied().max())
    };
    axes.into_iter().filter(|axis| *axis != [0; 3]).all(|axis| {
        let ((low, high), (other_low, other_high)) = (extent(a, axis), extent(b, axis));
        high > other_low && other_high > low
    })
}

/// Tetrahedra with corners on a small lattice touch in every way there is.
#[test]
fn random_tetrahedra_agree_with_the_separating_axis_theorem() {
    let mut rng = ChaCha8Rng::seed_from_u64(3);
    let (mut sharing, mut apart) = (0, 0);
    while sharing + apart < 20_000 {
        let [a, b]: [Corners; 2] = std::array::from_fn(|_| {
            std::array::from_fn(|_| std::array::from_fn(|_| rng.random_range(-2..=2)))
        });
        let volume = |t: &Corners| {
            dot(
                cross(minus(t[1], t[0]), minus(t[2], t[0])),
                minus(t[3], t[0]),
            )
        };
        if volume(&a) == 0 || volume(&b) == 0 {
            continue;
        }
        let real = |t: &Corners| t.map(|corner| corner.map(|coordinate| coordinate as f64));
        let expected = share_space_by_axes(&a, &b);
        assert_eq!(
            share_space(&pair(real(&a), real(&b))),
            expected,
            "{a:?} {b:?}"
        );
        if expected {
            sharing += 1;
        } else {
            apart += 1;
        }
    }
    assert!(sharing > 2_000 && apart > 2_000, "{sharing} {apart}");
}

/// Cubes in a row, a column and a stack, each cut into six tetrahedra round its diagonal (Kuhn).
fn block(side: u32) -> SolidMesh {
    let corners = side + 1;
    let vertex = |[x, y, z]: [u32; 3]| (x * corners + y) * corners + z;
    let mut mesh = SolidMesh::default();
    for index in 0..corners.pow(3) {
        let place = [
            index / corners / corners,
            index / corners % corners,
            index % corners,
        ];
        mesh.points.push(place.map(f64::from));
    }
    for index in 0..side.pow(3) {
        let origin = [index / side / side, index / side % side, index % side];
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
        }
    }
    mesh
}

#[test]
fn sound_meshes_have_none() {
    for mesh in [read::solid(&model("finger.msh")).unwrap(), block(12)] {
        require_none(&mesh).unwrap();
        let level = Level::new(&mesh).unwrap();
        let mut step = Refinement::new(&level, BoundaryRule::Fixed.to_core()).unwrap();
        let (points, next) = (step.points(&mesh.points).unwrap(), step.split().unwrap());
        assert!(!next.cells.octahedra.is_empty());
        assert!(overlapping_cells(&next.cells, &points).is_empty());
    }
}

/// A cube, beside it a prism on its side, and a cube that stands with a corner in the first one.
#[test]
fn prisms_and_hexahedra_with_plane_faces() {
    let cube = |low: f64| {
        let corners = [[0, 0], [1, 0], [1, 1], [0, 1]];
        [0, 1].map(|z| corners.map(|[x, y]| [x, y, z].map(|step| low + f64::from(step))))
    };
    let mut mesh = SolidMesh {
        points: [cube(0.0), cube(0.75)].concat().concat(),
        cells: Cells {
            prisms: vec![[1, 16, 2, 5, 17, 6]],
            hexahedra: vec![[0, 1, 2, 3, 4, 5, 6, 7], [8, 9, 10, 11, 12, 13, 14, 15]],
            ..Cells::default()
        },
        ..SolidMesh::default()
    };
    mesh.points.extend([[1.5, 0.0, 0.0], [1.5, 0.0, 1.0]]);
    // The prism ends at x + y/2 = 1.5, beyond the second cube's corner (0.75, 0.75).
    assert_eq!(
        overlapping_cells(&mesh.cells, &mesh.points),
        [[0, 2], [1, 2]]
    );
    let message = require_none(&mesh).unwrap_err().to_string();
    assert!(
        message.starts_with("2 pairs of cells share space, first prism 0 and hexahedron 1"),
        "{message}"
    );
    mesh.cells.hexahedra.pop();
    require_none(&mesh).unwrap();
}

/// Two blocks of cubes of which the second stands with one corner in the middle of the first's last
/// cube: that cube's six tetrahedra against the first cube's six of the other.
#[test]
fn blocks_that_run_into_each_other() {
    let (mut mesh, other) = (block(2), block(2));
    let first = mesh.points.len() as u32;
    let moved = |point: &Point| point.map(|coordinate| coordinate + 1.5);
    mesh.points.extend(other.points.iter().map(moved));
    let renumbered = |cell: &[u32; 4]| cell.map(|vertex| vertex + first);
    mesh.cells
        .tetrahedra
        .extend(other.cells.tetrahedra.iter().map(renumbered));
    let pairs = overlapping_cells(&mesh.cells, &mesh.points);
    let cubes = pairs.iter().map(|[a, b]| [a / 6, b / 6]);
    // The last of the first eight cubes, and the first of the others.
    assert!(cubes.clone().all(|cubes| cubes == [7, 8]), "{pairs:?}");
    // Both halves of the shared small cube are cut by the same three planes x = y, y = z, z = x, so
    // each tetrahedron there meets the one of its own order of axes, and no other.
    assert_eq!(
        pairs,
        [0, 1, 2, 3, 4, 5].map(|order| [42 + order, 48 + order])
    );
    let folder = Folder::new();
    let mut text = Vec::new();
    octruss_bake::write::vtu::write(&mesh, &mut text).unwrap();
    let cage = folder.write("blocks.vtu", text);
    octruss().arg("info").arg(&cage).assert().success().stdout(
        contains("cells that share space      6: tetrahedron 42 with tetrahedron 48, ").and(
            contains("warning: cells that share space are refused by `octruss bake`"),
        ),
    );
    let skin = folder.write("point.obj", "v 0.5 0.5 0.5\n");
    octruss()
        .arg("bake")
        .arg(&cage)
        .arg("--model")
        .arg(&skin)
        .arg("-o")
        .arg(folder.path("out.oct"))
        .assert()
        .code(1)
        .stderr(contains("blocks.vtu: 6 pairs of cells share space, first tetrahedron 42 and tetrahedron 48 (counted from 0 in file order)\n  help: a point there would belong to both cells"));
    assert_eq!(folder.names(), ["blocks.vtu", "point.obj"]);
}
