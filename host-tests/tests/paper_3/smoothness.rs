//! The joint spectral radius test across the boundary of two grids (section 4.5): below a quarter,
//! every limit function is twice differentiable.
//!
//! A patch is the unit parallelogram of the boundary; the next level has four like it, each a shift
//! of the first by one of the patch's corners. The thesis shows the support of its matrices in a
//! picture only. The one here is the smallest set of grid points that contains the patch's corners
//! and, for each of the four shifts, all that the shifted points of the next level depend on. The
//! matrices map the values of quadratics' quasi-interpolants to one another; `Y` is what they do to
//! the orthogonal complement of those values. In the spectral norm, which the thesis takes, products
//! of ten are needed, a million of them; an ellipsoid's norm shows the same with products of two.
//! Any norm bounds the joint spectral radius from above, so how the ellipsoid was found needs no proof.

use std::collections::{BTreeMap, BTreeSet};

use nalgebra::DMatrix;
use num_rational::BigRational;
use num_traits::ToPrimitive as _;
use octruss_host_tests::blend_f64::FloatRows;
use octruss_host_tests::mixed_subject::{ratio, refine_with};
use octruss_host_tests::reference_mixed::Boundary;
use octruss_host_tests::spectrum::{
    in_contracting_norm, joint_spectral_bound, orthogonal_complement,
};

use super::grids::{Grid, Index, Side};
use super::precision::{MONOMIALS, operator, values};

/// The corners of the patch, which are also the shifts to the next level's four patches.
const PATCH: [Index; 4] = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]];

/// Farther out than any mask of the support reaches.
const REACH: i32 = 6;

/// What the scheme does around the origin of two grids.
struct Interface {
    grid: Grid,
    /// The weights of every refined point, by its index on the grid of half the spacing.
    masks: BTreeMap<Index, BTreeMap<Index, f64>>,
    support: Vec<Index>,
}

impl Interface {
    fn new(below: Side, above: Side) -> Self {
        let grid = Grid::new(below, above, REACH, 3);
        let points: Vec<_> = (0..grid.mesh.vertex_count)
            .map(|vertex| BTreeMap::from([(vertex, 1.0)]))
            .collect();
        let (next, rows) =
            refine_with(&mut FloatRows, &grid.mesh, Boundary::Interior, &points).expect("sound");
        let by_index = |row: BTreeMap<u32, f64>| {
            let entries = row.into_iter();
            entries
                .map(|(old, weight)| (grid.indices[old as usize], weight))
                .collect()
        };
        let masks: BTreeMap<_, BTreeMap<_, _>> = grid
            .refined_indices(next.vertex_count)
            .into_iter()
            .zip(rows.into_iter().map(by_index))
            .collect();
        let support = closure(&masks);
        let farthest = support.iter().flatten().map(|coordinate| coordinate.abs());
        assert!(
            farthest.max() <= Some(4),
            "the piece has rules of its own at its ends"
        );
        Self {
            grid,
            masks,
            support,
        }
    }

    /// The matrix from the support to its image at the next level shifted by a corner.
    fn matrix(&self, shift: &Index) -> DMatrix<f64> {
        let size = self.support.len();
        DMatrix::from_fn(size, size, |row, column| {
            let mask = &self.masks[&sum(shift, &self.support[row])];
            mask.get(&self.support[column]).copied().unwrap_or(0.0)
        })
    }

    /// Values of the quasi-interpolants of the ten monomials at the points of the support.
    fn quadratics(&self) -> DMatrix<f64> {
        let at = |index: &Index| {
            let operator: [BigRational; 4] = operator(&self.grid, index[2]);
            values(&self.grid.position(*index), &operator, &ratio(1, 1))
        };
        let rows: Vec<_> = self.support.iter().map(at).collect();
        DMatrix::from_fn(rows.len(), MONOMIALS.len(), |row, column| {
            let value = rows[row].get(&(column as u32));
            value.map_or(0.0, |value| value.to_f64().expect("a finite number"))
        })
    }
}

fn sum(one: &Index, other: &Index) -> Index {
    [0, 1, 2].map(|axis| one[axis] + other[axis])
}

/// The smallest set with the patch that depends on nothing but itself under all four shifts.
fn closure(masks: &BTreeMap<Index, BTreeMap<Index, f64>>) -> Vec<Index> {
    let mut set = BTreeSet::new();
    let mut pending = PATCH.to_vec();
    while let Some(index) = pending.pop() {
        if set.insert(index) {
            for shift in &PATCH {
                pending.extend(masks[&sum(shift, &index)].keys());
            }
        }
    }
    set.into_iter().collect()
}

/// Bounds the joint spectral radius of the four Y from all products of three, on a support of so
/// many points.
fn check(below: Side, above: Side, points: usize) {
    let interface = Interface::new(below, above);
    assert_eq!(interface.support.len(), points);
    let quadratics = interface.quadratics();
    let complement = orthogonal_complement(&quadratics);
    let matrices = PATCH.map(|shift| interface.matrix(&shift));
    for matrix in &matrices {
        let left_over = complement.transpose() * matrix * &quadratics;
        assert!(left_over.amax() < 1e-12, "quadratics leave their space");
    }
    let left = matrices.map(|matrix| complement.transpose() * matrix * &complement);
    let left = in_contracting_norm(&left, 0.28);
    let bound = joint_spectral_bound(&left, 3);
    println!("{below:?} {above:?}: joint spectral radius at most {bound:.6}");
    assert!(bound < 0.25, "{bound}");
}

#[test]
fn example_4_5() {
    check(Side::PrismTriangles, Side::Toc, 111);
}

#[test]
fn example_4_6() {
    check(Side::PrismQuads, Side::Toc, 125);
}

#[test]
fn example_4_7() {
    check(Side::Cubes, Side::Toc, 131);
}

#[test]
fn example_4_8() {
    check(Side::Cubes, Side::PrismTriangles, 132);
}

#[test]
fn remark_after_example_4_6() {
    check(Side::Cubes, Side::PrismQuads, 76);
}
