//! Exact masks: sparse rows of rational numbers, and core driven over them.

use std::collections::BTreeMap;

use num_bigint::BigInt;
pub use num_rational::BigRational;
use num_traits::{One as _, Zero as _};
use octruss::blend::Blend;

/// A weighted sum of control points: the weight of each that has one other than zero.
pub type Row = BTreeMap<u32, BigRational>;

/// The fraction `numerator / denominator`.
pub fn ratio(numerator: i64, denominator: i64) -> BigRational {
    BigRational::new(numerator.into(), denominator.into())
}

/// The row that is a control point itself.
pub fn unit_row(point: u32) -> Row {
    Row::from([(point, BigRational::one())])
}

/// `row += factor * other`, dropping weights that become zero.
pub fn add_scaled(row: &mut Row, factor: &BigRational, other: &Row) {
    for (point, weight) in other {
        let sum = row.entry(*point).or_insert_with(BigRational::zero);
        *sum += factor * weight;
        if sum.is_zero() {
            row.remove(point);
        }
    }
}

/// The masks of two levels, one after the other, as masks over what `first` is over.
pub fn compose(second: &[Row], first: &[Row]) -> Vec<Row> {
    let over_first = |row: &Row| {
        let mut composed = Row::new();
        for (vertex, weight) in row {
            add_scaled(&mut composed, weight, &first[*vertex as usize]);
        }
        composed
    };
    second.iter().map(over_first).collect()
}

/// Sparse rows of rational numbers as a value type of core: what comes out is core's own mask.
#[derive(Clone, Copy, Debug, Default)]
pub struct RowBlend;

impl Blend for RowBlend {
    type Point = Row;
    type Sum = Row;

    fn zero(&self) -> Row {
        Row::new()
    }

    fn add(&self, sum: &mut Row, weight: i64, point: &Row) {
        add_scaled(sum, &BigRational::from(BigInt::from(weight)), point);
    }

    fn add_sum(&self, sum: &mut Row, weight: i64, other: &Row) {
        self.add(sum, weight, other);
    }

    fn divide(&mut self, sum: &Row, denominator: i64) -> Row {
        let mut row = Row::new();
        add_scaled(&mut row, &ratio(1, denominator), sum);
        row
    }
}

/// A basis of the vectors that every row maps to zero, by exact elimination.
///
/// `rows` are those of a matrix with `columns` columns.
pub fn null_space(mut rows: Vec<Vec<BigRational>>, columns: usize) -> Vec<Vec<BigRational>> {
    let mut pivots = Vec::new();
    for column in 0..columns {
        let done = pivots.len();
        let Some(found) = (done..rows.len()).find(|row| !rows[*row][column].is_zero()) else {
            continue;
        };
        rows.swap(done, found);
        let scale = rows[done][column].recip();
        let pivot: Vec<_> = rows[done].iter().map(|entry| entry * &scale).collect();
        for (place, row) in rows.iter_mut().enumerate() {
            if place != done && !row[column].is_zero() {
                let factor = row[column].clone();
                for (entry, of_pivot) in row.iter_mut().zip(&pivot) {
                    if !of_pivot.is_zero() {
                        *entry -= &factor * of_pivot;
                    }
                }
            }
        }
        rows[done] = pivot;
        pivots.push(column);
    }
    let free = (0..columns).filter(|column| !pivots.contains(column));
    free.map(|column| {
        let mut vector = vec![BigRational::zero(); columns];
        vector[column] = BigRational::one();
        for (row, pivot) in rows.iter().zip(&pivots) {
            vector[*pivot] = -row[column].clone();
        }
        vector
    })
    .collect()
}

#[cfg(test)]
mod tests {
    use super::{null_space, ratio};

    /// x + 2y + 3z = 0 and x + 2y + 4z = 0: the line (-2, 1, 0).
    #[test]
    fn null_space_of_a_plain_system() {
        let rows = [[1, 2, 3], [1, 2, 4]].map(|row| row.map(|entry| ratio(entry, 1)).to_vec());
        let expected = [-2, 1, 0].map(|entry| ratio(entry, 1)).to_vec();
        assert_eq!(null_space(rows.to_vec(), 3), vec![expected]);
    }
}
