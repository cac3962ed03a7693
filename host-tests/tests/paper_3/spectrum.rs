//! The largest eigenvalue of Y (section 4.5): what is left of the subdivision matrix at a point of
//! the boundary when the ten eigenvalues of quadratics (1, three times 1/2, six times 1/4) are taken
//! away.
//!
//! The matrix is that of the least set of grid points around the origin that depends on itself
//! alone: refined point k on the points that its mask has, by the same indices. The thesis prints
//! four digits; the six here come from a program that was written apart from this one.

use std::collections::{BTreeMap, BTreeSet};

use nalgebra::linalg::Schur;
use nalgebra::{Complex, DMatrix};
use octruss_host_tests::blend_f64::FloatRows;
use octruss_host_tests::mixed_subject::refine_with;
use octruss_host_tests::reference_mixed::Boundary;

use super::grids::{Grid, Index, Side};

/// The magnitudes of the eigenvalues at the origin, greatest first.
fn eigenvalues(below: Side, above: Side) -> Vec<f64> {
    let grid = Grid::new(below, above, 4, 2);
    let points: Vec<_> = (0..grid.mesh.vertex_count)
        .map(|vertex| BTreeMap::from([(vertex, 1.0)]))
        .collect();
    let (next, rows) =
        refine_with(&mut FloatRows, &grid.mesh, Boundary::Interior, &points).expect("a sound mesh");
    let refined: BTreeMap<Index, usize> = grid
        .refined_indices(next.vertex_count)
        .into_iter()
        .zip(0..)
        .collect();
    let mask = |index: &Index| {
        let entries = rows[refined[index]].iter();
        entries.map(|(old, weight)| (grid.indices[*old as usize], *weight))
    };
    let mut points = BTreeSet::from([[0, 0, 0]]);
    let mut pending = vec![[0, 0, 0]];
    while let Some(index) = pending.pop() {
        for (other, _) in mask(&index) {
            if points.insert(other) {
                pending.push(other);
            }
        }
    }
    let reach = points.iter().flatten().map(|coordinate| coordinate.abs());
    assert!(
        reach.max() < Some(4),
        "the piece has rules of its own at its ends"
    );
    let places: BTreeMap<Index, usize> = points.iter().copied().zip(0..).collect();
    let mut matrix = DMatrix::<f64>::zeros(places.len(), places.len());
    for (index, row) in &places {
        for (other, weight) in mask(index) {
            matrix[(*row, places[&other])] += weight;
        }
    }
    let schur = Schur::try_new(matrix, 1e-13, 100_000).expect("convergence");
    let mut magnitudes: Vec<f64> = schur
        .complex_eigenvalues()
        .iter()
        .map(|value: &Complex<f64>| value.re.hypot(value.im))
        .collect();
    magnitudes.sort_by(|one, other| other.total_cmp(one));
    magnitudes
}

fn check(below: Side, above: Side, largest: f64) {
    let magnitudes = eigenvalues(below, above);
    let quadratics = [1.0, 0.5, 0.5, 0.5, 0.25, 0.25, 0.25, 0.25, 0.25, 0.25];
    for (got, want) in magnitudes.iter().zip(quadratics) {
        assert!((got - want).abs() < 1e-6, "{magnitudes:?}");
    }
    let got = magnitudes[10];
    assert!((got - largest).abs() < 1e-6, "{got}, not {largest}");
}

#[test]
fn example_4_5() {
    check(Side::PrismTriangles, Side::Toc, 0.135_878);
}

#[test]
fn example_4_6() {
    check(Side::PrismQuads, Side::Toc, 0.135_082);
}

#[test]
fn example_4_7() {
    check(Side::Cubes, Side::Toc, 0.135_910);
}

#[test]
fn example_4_8() {
    check(Side::Cubes, Side::PrismTriangles, 0.125);
}
