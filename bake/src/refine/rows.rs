//! Refinement as sparse matrices: which vertices of the level before make a refined vertex.
//!
//! One level's matrix comes out of core's own rules, run over rows instead of points. A product
//! of matrices is formed only for the rows that somebody needs ([`compose`]).

use super::real::{WEIGHT_ONE, distortion_divisor, real_weight};
use octruss::blend::{Blend, Distortion, GuardedBlend, IrrationalWeight, NeighbourWeight};

/// A linear combination: columns with their weights. Columns of a finished row ascend.
pub type Row = Vec<(u32, f64)>;

/// Blends rows in double precision.
///
/// Sums of integer weights stay integers below 2^53 and are exact; a row entry is rounded once, by
/// its division, or a few times where an irrational surface weight enters.
#[derive(Clone, Copy, Debug, Default)]
pub struct RowBlend;

impl Blend for RowBlend {
    type Point = Row;
    type Sum = Row;

    fn zero(&self) -> Row {
        Row::new()
    }

    fn add(&self, sum: &mut Row, weight: i64, point: &Row) {
        add_scaled(sum, weight as f64, point);
    }

    fn add_sum(&self, sum: &mut Row, weight: i64, other: &Row) {
        add_scaled(sum, weight as f64, other);
    }

    fn add_irrational(&self, sum: &mut Row, weight: IrrationalWeight, point: &Row) {
        add_scaled(sum, weight.real * WEIGHT_ONE, point);
    }

    fn divide(&mut self, sum: &Row, denominator: i64) -> Row {
        finished(
            sum.iter()
                .map(|(column, weight)| (*column, weight / denominator as f64))
                .collect(),
        )
    }

    fn umbrella(&mut self, own: &Row, ring: &Row, valence: i64, weight: NeighbourWeight) -> Row {
        let weight = real_weight(weight);
        let mut row = Row::new();
        add_scaled(&mut row, 1.0 - valence as f64 * weight, own);
        add_scaled(&mut row, weight, ring);
        finished(row)
    }
}

/// Weights have no grid, so a guarded row is the row.
impl GuardedBlend for RowBlend {
    type Guarded = Row;
    type GuardedSum = Row;

    fn guard(&self, point: &Row) -> Row {
        point.clone()
    }

    fn distort(&self, own: &Row, parts: &[Distortion<'_, Row>], denominator: u32) -> Row {
        let mut row = own.clone();
        for part in parts.iter().filter(|part| part.count != 0) {
            add_scaled(
                &mut row,
                1.0 / distortion_divisor(part, denominator),
                part.sum,
            );
        }
        row
    }

    fn guarded_zero(&self) -> Row {
        self.zero()
    }

    fn add_guarded(&self, sum: &mut Row, weight: i64, value: &Row) {
        self.add(sum, weight, value);
    }

    fn add_guarded_sum(&self, sum: &mut Row, weight: i64, other: &Row) {
        self.add_sum(sum, weight, other);
    }

    fn divide_guarded(&mut self, sum: &Row, denominator: i64) -> Row {
        self.divide(sum, denominator)
    }
}

/// Rows are short, so a search along them is the quickest way to find a column.
fn add_scaled(sum: &mut Row, factor: f64, row: &Row) {
    for (column, weight) in row {
        match sum.iter_mut().find(|(present, _)| present == column) {
            Some((_, total)) => *total += factor * weight,
            None => sum.push((*column, factor * weight)),
        }
    }
}

fn finished(mut row: Row) -> Row {
    row.retain(|(_, weight)| *weight != 0.0);
    row.sort_unstable_by_key(|(column, _)| *column);
    row.shrink_to_fit();
    row
}

/// The identity of so many columns.
pub fn identity(columns: u32) -> Vec<Row> {
    (0..columns).map(|column| vec![(column, 1.0)]).collect()
}

/// Multiplies rows by a chain of matrices, the one that acts last first: `rows * S_K * ... * S_1`.
///
/// Only those rows of the inner products are formed that the rows after them need. `matrices`
/// starts with `S_1`.
pub fn compose(rows: &[Row], matrices: &[Vec<Row>], columns: u32) -> Vec<Row> {
    let mut needed: Vec<Vec<bool>> = Vec::new();
    for (index, matrix) in matrices.iter().enumerate().rev() {
        let mut here = vec![false; matrix.len()];
        match needed.last() {
            None => mark(rows.iter(), &mut here),
            Some(above) => {
                let above = matrices[index + 1]
                    .iter()
                    .zip(above)
                    .filter(|(_, needed)| **needed);
                mark(above.map(|(row, _)| row), &mut here);
            }
        }
        needed.push(here);
    }
    let mut accumulator = Accumulator::new(columns);
    let mut product = identity(columns);
    for (matrix, needed) in matrices.iter().zip(needed.iter().rev()) {
        let form = |(row, needed): (&Row, &bool)| match needed {
            true => accumulator.multiply(row, &product),
            false => Row::new(),
        };
        product = matrix.iter().zip(needed).map(form).collect();
    }
    rows.iter()
        .map(|row| accumulator.multiply(row, &product))
        .collect()
}

fn mark<'a>(rows: impl Iterator<Item = &'a Row>, needed: &mut [bool]) {
    for (column, _) in rows.flatten() {
        needed[*column as usize] = true;
    }
}

/// A bound of the sum of the magnitudes of a composed row's errors.
///
/// A product's entry is a sum of as many products as the row is long, so each level multiplies
/// relative errors by at most `1 + (length + 20) 2^-53`, where 20 stands for the entry's own
/// roundings (its division, or the cosine in an irrational surface weight); magnitudes grow by the
/// rows' sums of magnitudes. Where the scheme mixed makes a row of rows that are not whole numbers
/// (clones), each of up to `terms` terms of an entry is rounded, and clones and masks make their
/// magnitudes less than four times as large as the row's.
pub fn composition_error(rows: &[Row], matrices: &[Vec<Row>], terms: usize) -> f64 {
    let entry_roundings = 20.0 + 4.0 * terms as f64;
    let (mut roundings, mut magnitude) = (0.0, 1.0);
    for matrix in matrices.iter().map(Vec::as_slice).chain([rows]) {
        let longest = matrix.iter().map(Vec::len).max().unwrap_or(0);
        let largest = matrix
            .iter()
            .map(|row| row.iter().map(|(_, weight)| weight.abs()).sum::<f64>())
            .fold(0.0, f64::max);
        roundings += longest as f64 + entry_roundings;
        magnitude *= largest;
    }
    // 2^-52 instead of 2^-53 covers the terms of second order and this function's own roundings.
    roundings * magnitude * f64::EPSILON
}

/// A dense row with the list of its non-zero columns.
struct Accumulator {
    weights: Vec<f64>,
    is_touched: Vec<bool>,
    touched: Vec<u32>,
}

impl Accumulator {
    fn new(columns: u32) -> Self {
        let columns = columns as usize;
        Self {
            weights: vec![0.0; columns],
            is_touched: vec![false; columns],
            touched: Vec::new(),
        }
    }

    /// One row times a matrix.
    fn multiply(&mut self, row: &Row, matrix: &[Row]) -> Row {
        for (inner, factor) in row {
            for (column, weight) in &matrix[*inner as usize] {
                let place = *column as usize;
                if !std::mem::replace(&mut self.is_touched[place], true) {
                    self.touched.push(*column);
                }
                self.weights[place] += factor * weight;
            }
        }
        self.touched.sort_unstable();
        let mut product = Row::with_capacity(self.touched.len());
        for column in self.touched.drain(..) {
            let place = column as usize;
            self.is_touched[place] = false;
            product.push((column, std::mem::take(&mut self.weights[place])));
        }
        product
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_product_of_matrices_is_formed_only_where_needed() {
        // (1/2 1/2) * [[1, 0], [1/2, 1/2], [0, 1]] * [[1/4, 3/4], [1, 0]], by hand.
        let first = vec![vec![(0, 0.25), (1, 0.75)], vec![(0, 1.0)]];
        let second = vec![vec![(0, 1.0)], vec![(0, 0.5), (1, 0.5)], vec![(1, 1.0)]];
        let product = compose(&[vec![(0, 0.5), (1, 0.5)]], &[first, second], 2);
        assert_eq!(product, [vec![(0, 0.4375), (1, 0.5625)]]);
    }

    #[test]
    fn without_matrices_the_rows_stay() {
        assert_eq!(compose(&[vec![(1, 1.0)]], &[], 3), [vec![(1, 1.0)]]);
    }
}
