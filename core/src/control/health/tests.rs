//! Cells whose ratios follow from geometry.

#![allow(
    clippy::unwrap_used,
    clippy::indexing_slicing,
    clippy::arithmetic_side_effects,
    clippy::integer_division,
    reason = "tests"
)]

use super::*;

const SIDE: i32 = 1 << 20;

/// A unit cube whose bottom is a quadrilateral, in the order of a hexahedron.
fn cube() -> [[i32; 3]; 8] {
    let s = SIDE;
    [
        [0, 0, 0],
        [s, 0, 0],
        [s, s, 0],
        [0, s, 0],
        [0, 0, s],
        [s, 0, s],
        [s, s, s],
        [0, s, s],
    ]
}

fn hexahedron(pose: &[[i32; 3]]) -> HealthReport {
    let cells = Solid {
        vertex_count: 8,
        hexahedra: &[[0, 1, 2, 3, 4, 5, 6, 7]],
        ..Solid::default()
    };
    Health::new_checked(cells, &cube())
        .unwrap()
        .of(pose)
        .unwrap()
}

/// At rest every ratio is one; turned, moved and stretched by three it is 3; mirrored it is -1.
#[test]
fn a_cube_keeps_its_ratio_by_what_keeps_its_volume() {
    let of = |change: fn([i32; 3]) -> [i32; 3]| hexahedron(&cube().map(change));
    type Change = fn([i32; 3]) -> [i32; 3];
    let cases: [(Change, i32, u32); 4] = [
        (|point| point, RATIO_ONE, 0),
        (|[x, y, z]| [5 - y, x + 7, z - 9], RATIO_ONE, 0),
        (|[x, y, z]| [x, 3 * y, z + x], 3 * RATIO_ONE, 0),
        (|[x, y, z]| [y, x, z], -RATIO_ONE, 1),
    ];
    for (change, ratio, folded) in cases {
        let report = of(change);
        assert_eq!((report.least_ratio, report.folded), (ratio, folded));
        assert_eq!(report.without_ratio, 0);
    }
}

/// Every corner of a cube pushed towards the opposite one along the diagonal: its own tetrahedron is `1 - 3 t` of the
/// rest's, so it is flat at a third of the way and upside down beyond.
#[test]
fn a_pushed_corner_folds_at_a_third_of_the_diagonal() {
    for corner in 0..8 {
        let opposite = cube()[[6, 7, 4, 5, 2, 3, 0, 1][corner]];
        let pushed = |part: i32| {
            let mut pose = cube();
            let own = pose[corner];
            pose[corner] =
                [0, 1, 2].map(|axis| own[axis] + (opposite[axis] - own[axis]) / 16 * part);
            hexahedron(&pose)
        };
        let named = Cell {
            shape: Shape::Hexahedron,
            index: 0,
        };
        let report = pushed(4);
        assert_eq!((report.least_ratio, report.folded), (RATIO_ONE / 4, 0));
        assert_eq!(report.least, Some(named));
        let report = pushed(8);
        assert_eq!((report.least_ratio, report.folded), (-RATIO_ONE / 2, 1));
        assert_eq!(report.first.as_slice(), [named]);
    }
}

/// Lifting a corner of the top by `t` of the height multiplies its own corner by `1 + t` and leaves the other five.
#[test]
fn corners_of_a_prism_are_its_own() {
    let s = SIDE;
    let rest = [
        [0, 0, 0],
        [s, 0, 0],
        [0, s, 0],
        [0, 0, s],
        [s, 0, s],
        [0, s, s],
    ];
    let cells = Solid {
        vertex_count: 6,
        prisms: &[[0, 1, 2, 3, 4, 5]],
        ..Solid::default()
    };
    let health = Health::new_checked(cells, &rest).unwrap();
    assert_eq!(health.of(&rest).unwrap().least_ratio, RATIO_ONE);
    for corner in 0..6 {
        let mut pose = rest;
        // Through the opposite triangle and as far again.
        pose[corner][2] = if corner < 3 { 2 * s } else { -s };
        let report = health.of(&pose).unwrap();
        assert_eq!(
            (report.least_ratio, report.folded),
            (-RATIO_ONE, 1),
            "{corner}"
        );
    }
}

/// The centroid follows a corner by a sixth. Faces at a corner moved by `t` of the way to the opposite corner: their
/// height over the centroid becomes `1 - t` in all.
#[test]
fn an_octahedron_folds_where_a_corner_passes_the_middle() {
    let s = SIDE;
    let rest = [
        [s, 0, 0],
        [0, s, 0],
        [0, 0, s],
        [-s, 0, 0],
        [0, -s, 0],
        [0, 0, -s],
    ];
    // x, z, y: faces are then counter-clockwise from outside.
    let list = [[0, 2, 1, 3, 5, 4]];
    let cells = Solid {
        vertex_count: 6,
        octahedra: &list,
        ..Solid::default()
    };
    let health = Health::new_checked(cells, &rest).unwrap();
    let mut pose = rest;
    pose[0][0] = s / 4;
    let report = health.of(&pose).unwrap();
    // 1/4 less the centroid's 1/6 (1/4 - 1) = -1/8, over one.
    assert_eq!((report.least_ratio, report.folded), (RATIO_ONE / 8 * 3, 0));
    pose[0][0] = -2 * s;
    assert_eq!(health.of(&pose).unwrap().folded, 1);
}

#[test]
fn more_folds_than_names_are_counted() {
    let cells = [[0, 1, 2, 3]; 20];
    let cells = Solid {
        vertex_count: 4,
        tetrahedra: &cells,
        ..Solid::default()
    };
    let rest = [[0; 3], [SIDE, 0, 0], [0, SIDE, 0], [0, 0, SIDE]];
    let health = Health::new_checked(cells, &rest).unwrap();
    let mut pose = rest;
    pose[3][2] = 0;
    let report = health.of(&pose).unwrap();
    assert_eq!((report.folded, report.first.len()), (20, MOST_NAMED));
    assert_eq!(report.least_ratio, 0);
    let upside_down = [rest[0], rest[2], rest[1], rest[3]];
    let report = Health::new_checked(cells, &upside_down)
        .unwrap()
        .of(&rest)
        .unwrap();
    assert_eq!(
        (report.folded, report.without_ratio, report.least),
        (0, 20, None)
    );
}
