//! The smoothing pass of figure 5, cell by cell, on linearly split positions.

use super::solid::Solid;
use super::split::LinearSplit;

/// 48 times the paper's 4 x 4 matrix. (The text of the paper drops the sign of 1/16; its figure
/// and the matrix itself have it.)
pub const TETRAHEDRON_TIMES_48: [[f64; 4]; 4] = [
    [-3.0, 17.0, 17.0, 17.0],
    [17.0, -3.0, 17.0, 17.0],
    [17.0, 17.0, -3.0, 17.0],
    [17.0, 17.0, 17.0, -3.0],
];

/// 48 times the paper's 6 x 6 matrix.
pub const OCTAHEDRON_TIMES_48: [[f64; 6]; 6] = [
    [18.0, 4.0, 4.0, 14.0, 4.0, 4.0],
    [4.0, 18.0, 4.0, 4.0, 14.0, 4.0],
    [4.0, 4.0, 18.0, 4.0, 4.0, 14.0],
    [14.0, 4.0, 4.0, 18.0, 4.0, 4.0],
    [4.0, 14.0, 4.0, 4.0, 18.0, 4.0],
    [4.0, 4.0, 14.0, 4.0, 4.0, 18.0],
];

/// What linearly split positions are multiplied by to be integers.
const LINEAR_SCALE: f64 = 6.0;

/// What the matrices are multiplied by to be integers.
const MATRIX_SCALE: f64 = 48.0;

/// Six times the linearly split position of every vertex.
fn linear_times_6<const D: usize>(linear: &LinearSplit, points: &[[f64; D]]) -> Vec<[f64; D]> {
    let mut positions: Vec<_> = points
        .iter()
        .map(|point| point.map(|x| LINEAR_SCALE * x))
        .collect();
    positions.reserve_exact(linear.edges.len() + linear.octahedra.len());
    positions.extend(
        linear
            .edges
            .iter()
            .map(|parents| sum_of(parents, points).map(|x| 3.0 * x)),
    );
    positions.extend(
        linear
            .octahedra
            .iter()
            .map(|(parents, _)| sum_of(parents, points)),
    );
    positions
}

fn sum_of<const D: usize>(parents: &[u32], points: &[[f64; D]]) -> [f64; D] {
    let mut sum = [0.0; D];
    for parent in parents {
        add_product(&mut sum, 1.0, &points[*parent as usize]);
    }
    sum
}

fn add_product<const D: usize>(sum: &mut [f64; D], weight: f64, point: &[f64; D]) {
    for (sum, x) in sum.iter_mut().zip(point) {
        *sum += weight * x;
    }
}

/// `newP[T] += M . p[T]` for one cell.
fn add_cell<const D: usize, const C: usize>(
    cell: &[u32; C],
    matrix: &[[f64; C]; C],
    positions: &[[f64; D]],
    smoothed: &mut [[f64; D]],
) {
    for (corner, row) in cell.iter().zip(matrix) {
        let sum = &mut smoothed[*corner as usize];
        for (weight, other) in row.iter().zip(cell) {
            add_product(sum, *weight, &positions[*other as usize]);
        }
    }
}

/// Numerators and denominators of the smoothed position of every vertex of a split.
///
/// `newP / val` is `numerators[v] / denominators[v]`. A vertex that no cell uses stays where
/// the split puts it.
pub(super) fn smooth<const D: usize>(
    linear: &LinearSplit,
    points: &[[f64; D]],
) -> (Vec<[f64; D]>, Vec<f64>) {
    let positions = linear_times_6(linear, points);
    let refined: &Solid = &linear.solid;
    let mut numerators = vec![[0.0; D]; refined.vertex_count];
    for cell in &refined.tetrahedra {
        add_cell(cell, &TETRAHEDRON_TIMES_48, &positions, &mut numerators);
    }
    for cell in &refined.octahedra {
        add_cell(cell, &OCTAHEDRON_TIMES_48, &positions, &mut numerators);
    }
    let mut denominators = Vec::with_capacity(refined.vertex_count);
    for (vertex, count) in refined.cells_at_vertices().into_iter().enumerate() {
        if count == 0 {
            numerators[vertex] = positions[vertex];
            denominators.push(LINEAR_SCALE);
        } else {
            denominators.push(LINEAR_SCALE * MATRIX_SCALE * count as f64);
        }
    }
    (numerators, denominators)
}
