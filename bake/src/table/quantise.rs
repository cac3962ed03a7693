//! Weights as integers that sum to one exactly.

use crate::error::{Error, Result};
use crate::refine::rows::Row;
use octruss::blend::WEIGHT_BITS;

/// One, as a weight of the table.
pub const ONE: i64 = 1 << WEIGHT_BITS;

/// A row of the table: control points in ascending order, with weights in units of 2^-30.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct QuantisedRow {
    /// Control point and weight of each tap. No weight is zero, and their sum is 2^30.
    pub taps: Vec<(u32, i32)>,
}

impl QuantisedRow {
    /// The sum of the magnitudes of the weights, as a real number.
    pub fn magnitude(&self) -> f64 {
        let magnitudes = self.taps.iter().map(|(_, weight)| i64::from(*weight).abs());
        magnitudes.sum::<i64>() as f64 / ONE as f64
    }
}

/// Rounds every weight to the nearest multiple of 2^-30: see [`quantise_to`].
///
/// # Errors
/// Those of [`quantise_to`].
pub fn quantise(row: &Row) -> Result<QuantisedRow> {
    quantise_to(row, WEIGHT_BITS)
}

/// Rounds every weight to the nearest multiple of 2^-bits (`bits` at most 30; the result is in units of 2^-30
/// nevertheless) and then moves as few weights as possible
/// by one unit so that the sum is one: those first whose remainder speaks for it most (the largest
/// remainder; the lower control point on ties). Weights that become zero are dropped.
///
/// # Errors
/// If the magnitudes would add up to more than two, which only an extrapolated point far outside
/// can bring about.
pub fn quantise_to(row: &Row, bits: u32) -> Result<QuantisedRow> {
    let one = 1_i64 << bits;
    // The product with a power of two and the difference of neighbours in size are exact.
    let scaled = |weight: f64| weight * one as f64;
    let mut taps: Vec<(u32, i64)> = row
        .iter()
        .map(|(column, weight)| (*column, scaled(*weight).round() as i64))
        .collect();
    let missing = one - taps.iter().map(|(_, weight)| weight).sum::<i64>();
    let mut order: Vec<usize> = (0..taps.len()).collect();
    let remainder = |place: usize| scaled(row[place].1) - taps[place].1 as f64;
    let toward = if missing < 0 { -1.0 } else { 1.0 };
    order.sort_by(|a, b| (toward * remainder(*b)).total_cmp(&(toward * remainder(*a))));
    let number = missing.unsigned_abs() as usize;
    if number > taps.len() {
        return Err(Error::new(format!(
            "its weights sum to {} instead of one",
            row.iter().map(|(_, weight)| weight).sum::<f64>()
        )));
    }
    for place in order.into_iter().take(number) {
        taps[place].1 += missing.signum();
    }
    let magnitude: i64 = taps.iter().map(|(_, weight)| weight.abs()).sum();
    if magnitude > 2 * one {
        return Err(Error::new(format!(
            "the magnitudes of its weights add up to {:.3}, more than two",
            magnitude as f64 / one as f64
        ))
        .advise("the point lies too far outside the cage to be extrapolated; use --outside nearest, or enlarge the cage"));
    }
    // A magnitude of at most two and a sum of one leave every weight within 32 bits.
    let taps = taps.into_iter().filter(|(_, weight)| *weight != 0);
    Ok(QuantisedRow {
        taps: taps
            .map(|(column, weight)| (column, (weight << (WEIGHT_BITS - bits)) as i32))
            .collect(),
    })
}

/// The sum of the magnitudes of what quantisation changed.
pub fn total_change(row: &Row, quantised: &QuantisedRow) -> f64 {
    let mut taps = quantised.taps.iter().peekable();
    let mut total = 0.0;
    for (column, weight) in row {
        let kept = taps
            .next_if(|(tap, _)| tap == column)
            .map_or(0, |(_, weight)| *weight);
        total += (weight * ONE as f64 - f64::from(kept)).abs();
    }
    total / ONE as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    const UNIT: f64 = 1.0 / ONE as f64;

    #[test]
    fn the_largest_remainders_make_up_what_is_missing() {
        // In units of 2^-30: 0.4 + 0.3 + 0.3 over whole numbers; one unit is missing, and 0.4 has
        // the largest remainder.
        let third = (ONE / 4) as f64;
        let row = vec![
            (3, (third + 0.3) * UNIT),
            (5, (third + 0.4) * UNIT),
            (9, (2.0 * third - 1.0 + 0.3) * UNIT),
        ];
        let quarter = (ONE / 4) as i32;
        let quantised = quantise(&row).unwrap();
        assert_eq!(
            quantised.taps,
            [(3, quarter), (5, quarter + 1), (9, 2 * quarter - 1)]
        );
        assert!((total_change(&row, &quantised) / UNIT - 1.2).abs() < 1e-6);
    }

    /// In units of 2^-30: 0.6, 0.7 and 0.7 over whole numbers round up and make one unit too many,
    /// which the weight gives back that was rounded up furthest.
    #[test]
    fn what_is_too_much_is_taken_where_rounding_added_most() {
        let quarter = (ONE / 4) as f64;
        let row = vec![
            (3, (quarter + 0.7) * UNIT),
            (5, (quarter - 2.0 + 0.6) * UNIT),
            (9, (2.0 * quarter + 0.7) * UNIT),
        ];
        let quarter = (ONE / 4) as i32;
        let expected = [(3, quarter + 1), (5, quarter - 2), (9, 2 * quarter + 1)];
        assert_eq!(quantise(&row).unwrap().taps, expected);
    }

    #[test]
    fn ties_go_to_the_lower_control_point_and_zeros_are_dropped() {
        // 1/3 each: 2^30 = 3 * 357913941 + 1.
        let row = vec![
            (0, 1.0 / 3.0),
            (1, 1.0 / 3.0),
            (2, 0.2 * UNIT),
            (7, 1.0 / 3.0),
        ];
        assert_eq!(
            quantise(&row).unwrap().taps,
            [(0, 357_913_942), (1, 357_913_941), (7, 357_913_941)]
        );
    }

    #[test]
    fn magnitudes_above_two_are_refused() {
        assert!(quantise(&vec![(0, 1.5), (1, -0.5)]).is_ok());
        let error = quantise(&vec![(0, 1.75), (1, -0.75)]).unwrap_err();
        assert_eq!(
            error.message(),
            "the magnitudes of its weights add up to 2.500, more than two"
        );
    }
}
