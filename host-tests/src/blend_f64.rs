//! Rows of double-precision numbers as a value type, where figures are real numbers anyway.

use std::collections::BTreeMap;

use octruss::blend::{Blend, Distortion, GuardedBlend};

/// Sparse rows over control points, in double precision.
#[derive(Clone, Copy, Debug, Default)]
pub struct FloatRows;

/// A weighted sum of control points.
pub type FloatRow = BTreeMap<u32, f64>;

fn add_scaled(row: &mut FloatRow, factor: f64, other: &FloatRow) {
    for (point, weight) in other {
        *row.entry(*point).or_insert(0.0) += factor * weight;
    }
}

impl Blend for FloatRows {
    type Point = FloatRow;
    type Sum = FloatRow;

    fn zero(&self) -> FloatRow {
        FloatRow::new()
    }

    fn add(&self, sum: &mut FloatRow, weight: i64, point: &FloatRow) {
        add_scaled(sum, weight as f64, point);
    }

    fn add_sum(&self, sum: &mut FloatRow, weight: i64, other: &FloatRow) {
        add_scaled(sum, weight as f64, other);
    }

    fn divide(&mut self, sum: &FloatRow, denominator: i64) -> FloatRow {
        let divided = sum
            .iter()
            .map(|(point, weight)| (*point, weight / denominator as f64));
        divided.collect()
    }
}

impl GuardedBlend for FloatRows {
    type Guarded = FloatRow;
    type GuardedSum = FloatRow;

    fn guard(&self, point: &FloatRow) -> FloatRow {
        point.clone()
    }

    fn distort(
        &self,
        own: &FloatRow,
        parts: &[Distortion<'_, FloatRow>],
        denominator: u32,
    ) -> FloatRow {
        let mut row = own.clone();
        for part in parts.iter().filter(|part| part.count != 0) {
            let sign = if part.is_negative { -1.0 } else { 1.0 };
            let divisor = f64::from(part.count) * f64::from(denominator);
            add_scaled(&mut row, sign / divisor, part.sum);
        }
        row
    }

    fn guarded_zero(&self) -> FloatRow {
        FloatRow::new()
    }

    fn add_guarded(&self, sum: &mut FloatRow, weight: i64, value: &FloatRow) {
        add_scaled(sum, weight as f64, value);
    }

    fn add_guarded_sum(&self, sum: &mut FloatRow, weight: i64, other: &FloatRow) {
        add_scaled(sum, weight as f64, other);
    }

    fn divide_guarded(&mut self, sum: &FloatRow, denominator: i64) -> FloatRow {
        self.divide(sum, denominator)
    }
}
