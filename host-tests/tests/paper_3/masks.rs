//! The convolution masks of examples 4.5 to 4.8 and remark 4.6 (figure 4.8), and the half-sided
//! moments (definition 4.2).

use num_rational::BigRational;
use octruss_host_tests::mixed_subject::{ExactRows, Row, clones, masks, ratio};
use octruss_host_tests::reference_mixed::Boundary;

use super::grids::{Grid, Side};

const TOC: usize = 0;
const PRISM: usize = 1;
const CUBE: usize = 2;

/// The clone of the origin for a class, as offsets along b1 and b2 with weights.
fn clone_of_origin(below: Side, above: Side, class: usize) -> Vec<([i32; 2], BigRational)> {
    let grid = Grid::new(below, above, 2, 1);
    let row: &Row = &clones(&grid.mesh)[grid.vertices[&[0, 0, 0]] as usize][class];
    let mut entries: Vec<_> = row
        .iter()
        .map(|(vertex, weight)| {
            let [i, j, k] = grid.indices[*vertex as usize];
            assert_eq!(k, 0, "only the boundary enters");
            ([i, j], weight.clone())
        })
        .collect();
    entries.sort();
    entries
}

/// A mask on the support (2.4.5): the upper row, the middle row, the lower row.
fn mask(upper: [(i64, i64); 2], middle: [(i64, i64); 3], lower: [(i64, i64); 2]) -> Expected {
    let places = [[-1, 1], [0, 1], [-1, 0], [0, 0], [1, 0], [0, -1], [1, -1]];
    let weights = upper.into_iter().chain(middle).chain(lower);
    let mut entries: Vec<_> = places
        .into_iter()
        .zip(weights)
        .map(|(place, (numerator, denominator))| (place, ratio(numerator, denominator)))
        .filter(|(_, weight)| *weight != ratio(0, 1))
        .collect();
    entries.sort();
    entries
}

type Expected = Vec<([i32; 2], BigRational)>;

/// The same mask for the other side: identity minus the deviation from it.
fn other_side(mask: &Expected) -> Expected {
    let opposite = |(place, weight): &([i32; 2], BigRational)| match place {
        [0, 0] => (*place, ratio(2, 1) - weight),
        _ => (*place, -weight),
    };
    mask.iter().map(opposite).collect()
}

fn check(below: Side, above: Side, class_below: usize, class_above: usize, above_mask: &Expected) {
    assert_eq!(clone_of_origin(below, above, class_above), *above_mask);
    let below_mask = other_side(above_mask);
    assert_eq!(clone_of_origin(below, above, class_below), below_mask);
}

#[test]
fn example_4_5_tetrahedra_on_triangles_of_prisms() {
    let side = (1, 216);
    let expected = mask([side; 2], [side, (35, 36), side], [side; 2]);
    check(Side::PrismTriangles, Side::Toc, PRISM, TOC, &expected);
}

#[test]
fn example_4_6_tetrahedra_on_quadrilaterals_of_prisms() {
    let expected = mask(
        [(-1, 27), (5, 108)],
        [(11, 432), (67, 72), (11, 432)],
        [(5, 108), (-1, 27)],
    );
    check(Side::PrismQuads, Side::Toc, PRISM, TOC, &expected);
}

#[test]
fn example_4_7_tetrahedra_on_hexahedra() {
    let side = (5, 108);
    let expected = mask([(-1, 27), side], [side, (8, 9), side], [side, (-1, 27)]);
    check(Side::Cubes, Side::Toc, CUBE, TOC, &expected);
}

#[test]
fn example_4_8_triangles_of_prisms_on_hexahedra() {
    let side = (1, 24);
    let expected = mask([(-1, 24), side], [side, (11, 12), side], [side, (-1, 24)]);
    check(Side::Cubes, Side::PrismTriangles, CUBE, PRISM, &expected);
}

#[test]
fn remark_4_6_quadrilaterals_of_prisms_on_hexahedra() {
    let (none, side) = ((0, 1), (1, 48));
    let expected = mask([none; 2], [side, (23, 24), side], [none; 2]);
    check(Side::Cubes, Side::PrismQuads, CUBE, PRISM, &expected);
}

#[test]
fn half_sided_moments_are_one_eighth_across() {
    for side in [
        Side::Toc,
        Side::PrismTriangles,
        Side::PrismQuads,
        Side::Cubes,
    ] {
        let grid = Grid::new(side, side, 2, 2);
        let (next, rows) = masks(&grid.mesh, Boundary::Interior, &mut ExactRows::default());
        let refined = grid.refined_indices(next.vertex_count);
        for representative in [[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]] {
            let vertex = refined.iter().position(|index| *index == representative);
            let row = &rows[vertex.expect("near the origin")];
            let at = grid.position(representative);
            let mut moment = [ratio(0, 1), ratio(0, 1), ratio(0, 1)];
            for (old, weight) in row {
                let index = grid.indices[*old as usize];
                let share = match index[2] {
                    ..0 => continue,
                    0 => ratio(1, 2),
                    1.. => ratio(1, 1),
                };
                let position = grid.position(index);
                for ((sum, old), new) in moment.iter_mut().zip(&position).zip(&at) {
                    *sum += &share * weight * (old - new / ratio(2, 1));
                }
            }
            let expected = [ratio(0, 1), ratio(0, 1), ratio(1, 8)];
            assert_eq!(moment, expected, "{side:?} at {representative:?}");
        }
    }
}
