//! S Q p = Q sigma p for every quadratic p, on every pair of sides, exactly (corollary 2.1), and its
//! failure without the unzip.

use num_rational::BigRational;
use octruss_host_tests::mixed_subject::{ExactRows, Row, ratio, refine_with};
use octruss_host_tests::reference_mixed::Boundary;

use super::grids::{Grid, PAIRS, Position, Side};

/// The monomials of degree up to 2 by their exponents.
pub const MONOMIALS: [[usize; 3]; 10] = [
    [0, 0, 0],
    [1, 0, 0],
    [0, 1, 0],
    [0, 0, 1],
    [2, 0, 0],
    [1, 1, 0],
    [0, 2, 0],
    [1, 0, 1],
    [0, 1, 1],
    [0, 0, 2],
];

/// div H grad of a monomial: twice H's entry where both derivatives are of it.
fn correction(monomial: [usize; 3], [xx, xy, yy, zz]: &[BigRational; 4]) -> BigRational {
    let twice = |entry: &BigRational| entry * ratio(2, 1);
    match monomial {
        [2, 0, 0] => twice(xx),
        [1, 1, 0] => twice(xy),
        [0, 2, 0] => twice(yy),
        [0, 0, 2] => twice(zz),
        _ => ratio(0, 1),
    }
}

/// H below, on and above the boundary, where it is the mean of both.
pub fn operator(grid: &Grid, layer: i32) -> [BigRational; 4] {
    let (below, above) = (
        grid.below.quasi_interpolant(),
        grid.above.quasi_interpolant(),
    );
    match layer {
        ..0 => below,
        0 => std::array::from_fn(|i| (&below[i] + &above[i]) / ratio(2, 1)),
        1.. => above,
    }
}

/// The values of all monomials' quasi-interpolants at a point; on the grid of half the spacing the
/// derivatives of p(x/2) are a quarter.
pub fn values(position: &Position, operator: &[BigRational; 4], spacing: &BigRational) -> Row {
    let mut row = Row::new();
    for (place, monomial) in (0..).zip(MONOMIALS) {
        let mut value = ratio(1, 1);
        for (coordinate, exponent) in position.iter().zip(monomial) {
            for _ in 0..exponent {
                value *= coordinate * spacing;
            }
        }
        value -= correction(monomial, operator) * spacing * spacing;
        if value != ratio(0, 1) {
            row.insert(place, value);
        }
    }
    row
}

/// How many refined vertices near the origin were compared, and how many differ.
fn compare(below: Side, above: Side, without_unzip: bool) -> (usize, usize) {
    let grid = Grid::new(below, above, 3, 2);
    let points: Vec<Row> = grid
        .indices
        .iter()
        .map(|index| {
            values(
                &grid.position(*index),
                &operator(&grid, index[2]),
                &ratio(1, 1),
            )
        })
        .collect();
    let mut blend = ExactRows { without_unzip };
    let (next, refined) =
        refine_with(&mut blend, &grid.mesh, Boundary::Interior, &points).expect("a sound mesh");
    let (mut compared, mut wrong) = (0, 0);
    for (index, value) in grid.refined_indices(next.vertex_count).iter().zip(&refined) {
        // Away from the ends of the piece.
        if index[0].abs() > 2 || index[1].abs() > 2 || index[2].abs() > 2 {
            continue;
        }
        let operator = operator(&grid, index[2]);
        let want = values(&grid.position(*index), &operator, &ratio(1, 2));
        compared += 1;
        wrong += usize::from(*value != want);
    }
    (compared, wrong)
}

#[test]
fn quadratics_are_reproduced_on_every_pair() {
    for (name, below, above) in PAIRS {
        assert_eq!(compare(below, above, false), (125, 0), "example {name}");
    }
}

#[test]
fn quadratics_are_reproduced_on_uniform_grids() {
    for side in [
        Side::Toc,
        Side::PrismTriangles,
        Side::PrismQuads,
        Side::Cubes,
    ] {
        assert_eq!(compare(side, side, false), (125, 0), "{side:?}");
    }
}

#[test]
fn without_the_unzip_they_are_not() {
    for (name, below, above) in PAIRS {
        let (_, wrong) = compare(below, above, true);
        assert!(wrong > 0, "example {name}");
    }
}
