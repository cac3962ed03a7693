//! On one shape alone the scheme is one that is known: P1's on tetrahedra and octahedra (to the bit,
//! in tests/mixed_equality.rs), the tricubic B-spline on hexahedra, Loop times the cubic B-spline on
//! prisms.

use std::collections::BTreeMap;

use num_rational::BigRational;
use octruss_host_tests::mixed_subject::{ExactRows, masks, ratio};
use octruss_host_tests::reference_mixed::Boundary;

use super::grids::{Grid, Index, Side};

type Mask<const N: usize> = BTreeMap<[i32; N], BigRational>;

/// The cubic B-spline at an index of the finer grid: 1/8 6/8 1/8 and 1/2 1/2 (example 2.1).
fn spline(index: i32) -> Mask<1> {
    let half = index.div_euclid(2);
    match index.rem_euclid(2) {
        0 => [(half - 1, 1), (half, 6), (half + 1, 1)]
            .into_iter()
            .map(|(place, weight)| ([place], ratio(weight, 8)))
            .collect(),
        _ => [half, half + 1].map(|place| ([place], ratio(1, 2))).into(),
    }
}

/// Loop's regular mask on the lattice with the edges b1, b2 and b1 - b2 (example 2.2): 5/8 and
/// 1/16, or 3/8 3/8 1/8 1/8.
fn triangles(index: [i32; 2]) -> Mask<2> {
    let half = index.map(|coordinate| coordinate.div_euclid(2));
    let entries: &[([i32; 2], i64)] = match index.map(|coordinate| coordinate.rem_euclid(2)) {
        [0, 0] => &[
            ([0, 0], 10),
            ([1, 0], 1),
            ([0, 1], 1),
            ([-1, 1], 1),
            ([-1, 0], 1),
            ([0, -1], 1),
            ([1, -1], 1),
        ],
        [1, 0] => &[([0, 0], 6), ([1, 0], 6), ([0, 1], 2), ([1, -1], 2)],
        [0, _] => &[([0, 0], 6), ([0, 1], 6), ([1, 0], 2), ([-1, 1], 2)],
        _ => &[([1, 0], 6), ([0, 1], 6), ([0, 0], 2), ([1, 1], 2)],
    };
    entries
        .iter()
        .map(|([x, y], weight)| ([half[0] + x, half[1] + y], ratio(*weight, 16)))
        .collect()
}

/// Compares all masks near the origin with a formula.
fn compare(side: Side, formula: impl Fn(Index) -> Mask<3>) {
    let grid = Grid::new(side, side, 2, 2);
    let (next, rows) = masks(&grid.mesh, Boundary::Interior, &mut ExactRows::default());
    let mut compared = 0;
    for (index, row) in grid.refined_indices(next.vertex_count).iter().zip(&rows) {
        if index.iter().any(|coordinate| coordinate.abs() > 1) {
            continue;
        }
        let mask: Mask<3> = row
            .iter()
            .map(|(vertex, weight)| (grid.indices[*vertex as usize], weight.clone()))
            .collect();
        assert_eq!(mask, formula(*index), "{side:?} at {index:?}");
        compared += 1;
    }
    assert_eq!(compared, 27);
}

#[test]
fn hexahedra_are_tricubic() {
    compare(Side::Cubes, |index| {
        let [x, y, z] = index.map(spline);
        let mut mask = Mask::new();
        for ([i], a) in &x {
            for ([j], b) in &y {
                for ([k], c) in &z {
                    mask.insert([*i, *j, *k], a * b * c);
                }
            }
        }
        mask
    });
}

#[test]
fn prisms_are_loop_times_cubic() {
    compare(Side::PrismTriangles, |[i, j, k]| {
        let mut mask = Mask::new();
        for ([x, y], weight) in &triangles([i, j]) {
            for ([z], across) in &spline(k) {
                mask.insert([*x, *y, *z], weight * across);
            }
        }
        mask
    });
}
