//! How far the quantised table can be from the map it stands for, proved and measured.
//!
//! The unquantised map is `f(p) = sum of d_i p_i` with the real weights `d_i`, in double
//! precision; the table has `q_i = d_i + e_i`, rounded weights with the same sum. So for any `c`
//!
//! `sum of q_i p_i - f(p) = sum of e_i (p_i - c)`,
//!
//! and if all `p_i` of a coordinate lie within `R` of some `c`, the table is off by at most
//! `R * sum of |e_i|`, plus 1/2 for the one rounding at the end. The displacement form is held
//! against `rest + sum of d_i (p_i - p_rest_i)` in the same way, with displacements in place of
//! positions. All errors are in units of the last place of a coordinate.

use super::quantise::{ONE, QuantisedRow, total_change};
use crate::refine::rows::Row;
use octruss::blend::WEIGHT_BITS;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use serde::Serialize;

/// Half the width of the range of 32-bit coordinates: they lie within this of -1/2.
const HALF_RANGE: f64 = 2_147_483_647.5;

/// The rounding at the end of a row.
const ROUNDING: f64 = 0.5;

/// Errors of one form of the table, in units of the last place of a coordinate.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct FormPrecision {
    /// No pose with 32-bit coordinates gives a greater error (before a result saturates).
    pub proved_any_pose: f64,
    /// No pose of the size of the cage at rest, wherever it lies, gives a greater one; for the
    /// displacement form, no pose whose displacements differ by no more than the cage's size.
    pub proved_rest_size: f64,
    /// The greatest error on random poses over the whole range, and on the pose that is worst for
    /// the row with the greatest bound.
    pub measured: f64,
}

/// Errors of both forms.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Precision {
    /// The absolute form.
    pub absolute: FormPrecision,
    /// The displacement form.
    pub displacement: FormPrecision,
    /// Bound of what composing the rows in double precision may have added to a row, as the sum of
    /// the magnitudes of its weights' errors; it is part of the bounds above.
    pub composition: f64,
    /// Random poses that were measured.
    pub random_poses: u32,
    /// What the random numbers started from.
    pub seed: u64,
}

/// What the errors are computed from.
pub struct Table<'a> {
    /// Real weights.
    pub rows: &'a [Row],
    /// The weights of the table.
    pub quantised: &'a [QuantisedRow],
    /// The bits of the cage at rest.
    pub rest_cage: &'a [[i32; 3]],
    /// A bound of the composition's errors: see [`crate::refine::rows::composition_error`].
    pub composition: f64,
}

impl Table<'_> {
    /// Proves and measures. Every random pose costs as much as applying the table thrice.
    pub fn precision(&self, random_poses: u32, seed: u64) -> Precision {
        let changes = self
            .rows
            .iter()
            .zip(self.quantised)
            .map(|(row, q)| total_change(row, q));
        let (worst_row, change) = changes.enumerate().fold((0, 0.0), |worst, (row, change)| {
            if change > worst.1 {
                (row, change)
            } else {
                worst
            }
        });
        let weight_error = change + self.composition;
        let half_size = self.rest_half_size();
        let bound = |reach: f64| weight_error * reach + ROUNDING;
        let (absolute, displacement) = self.measure(random_poses, seed, worst_row);
        Precision {
            absolute: FormPrecision {
                proved_any_pose: bound(HALF_RANGE),
                proved_rest_size: bound(half_size),
                measured: absolute,
            },
            displacement: FormPrecision {
                proved_any_pose: bound(HALF_RANGE + half_size),
                proved_rest_size: bound(half_size),
                measured: displacement,
            },
            composition: self.composition,
            random_poses,
            seed,
        }
    }

    /// Half the cage's largest extent along an axis.
    fn rest_half_size(&self) -> f64 {
        let half_size = |axis: usize| {
            let bits = || self.rest_cage.iter().map(|point| point[axis]);
            let (low, high) = (bits().min().unwrap_or(0), bits().max().unwrap_or(0));
            (f64::from(high) - f64::from(low)) / 2.0
        };
        (0..3).map(half_size).fold(0.0, f64::max)
    }

    fn measure(&self, random_poses: u32, seed: u64, worst_row: usize) -> (f64, f64) {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let mut worst = (0.0_f64, 0.0_f64);
        let mut take = |pose: &[[i32; 3]]| {
            let (absolute, displacement) = self.errors_of(pose);
            worst = (worst.0.max(absolute), worst.1.max(displacement));
        };
        for _ in 0..random_poses {
            let pose: Vec<[i32; 3]> = self
                .rest_cage
                .iter()
                .map(|_| std::array::from_fn(|_| random.next_u32().cast_signed()))
                .collect();
            take(&pose);
        }
        if !self.rows.is_empty() {
            take(&self.worst_pose(worst_row));
        }
        worst
    }

    /// The pose whose coordinates stand at the end of the range that each weight's error favours.
    fn worst_pose(&self, row: usize) -> Vec<[i32; 3]> {
        let mut pose = vec![[0; 3]; self.rest_cage.len()];
        let kept = |column: u32| {
            let taps = &self.quantised[row].taps;
            taps.iter()
                .find(|(tap, _)| *tap == column)
                .map_or(0, |(_, weight)| *weight)
        };
        for (column, weight) in &self.rows[row] {
            let is_more = f64::from(kept(*column)) > weight * ONE as f64;
            pose[*column as usize] = [if is_more { i32::MAX } else { i32::MIN }; 3];
        }
        pose
    }

    /// The greatest error of each form over all rows of one pose, computed in 128-bit integers.
    fn errors_of(&self, pose: &[[i32; 3]]) -> (f64, f64) {
        let mut worst = (0.0_f64, 0.0_f64);
        for (row, quantised) in self.rows.iter().zip(self.quantised) {
            for axis in [0, 1, 2] {
                let position = |point: u32| i128::from(pose[point as usize][axis]);
                let displacement =
                    |point: u32| position(point) - i128::from(self.rest_cage[point as usize][axis]);
                worst.0 = worst.0.max(row_error(row, quantised, position));
                worst.1 = worst.1.max(row_error(row, quantised, displacement));
            }
        }
        worst
    }
}

/// The difference between a row's rounded result and the unquantised one.
fn row_error(row: &Row, quantised: &QuantisedRow, value: impl Fn(u32) -> i128) -> f64 {
    // Doubles as multiples of 2^-80: with 33-bit values and sums of magnitudes of at most two
    // everything stays far below 2^127, and what is cut off is below 2^-40 units.
    const REAL_BITS: i32 = 80;
    let scale = 2.0_f64.powi(REAL_BITS);
    let real: i128 = row
        .iter()
        .map(|(point, weight)| (weight * scale) as i128 * value(*point))
        .sum();
    let half = 1_i128 << (WEIGHT_BITS - 1);
    let sum: i128 = quantised
        .taps
        .iter()
        .map(|(point, weight)| i128::from(*weight) * value(*point))
        .sum();
    let result = (sum + half) >> WEIGHT_BITS;
    ((result << REAL_BITS) - real).abs() as f64 / scale
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Halves are exact as integers, so that only the rounding is left: it is off by exactly half
    /// a unit whenever the two coordinates differ by an odd number, which some random ones do.
    #[test]
    fn exact_weights_leave_half_a_unit() {
        let rows = [vec![(0, 0.5), (1, 0.5)]];
        let quantised = [QuantisedRow {
            taps: vec![(0, 1 << 29), (1, 1 << 29)],
        }];
        let table = Table {
            rows: &rows,
            quantised: &quantised,
            rest_cage: &[[0; 3], [7; 3]],
            composition: 0.0,
        };
        let precision = table.precision(4, 1);
        for form in [precision.absolute, precision.displacement] {
            assert_eq!(
                (form.proved_any_pose, form.proved_rest_size, form.measured),
                (0.5, 0.5, 0.5)
            );
        }
    }

    /// One unit of 2^-30 moved from one weight to the other, by hand: over the whole range the two
    /// coordinates differ by at most 2^32 - 1, so the sum by at most (2^32 - 1) / 2^30 = 4 -
    /// 2^-30; over a cage of 2^20 units by 2^-10.
    #[test]
    fn a_moved_unit_is_bounded_by_the_range() {
        let rows = [vec![(0, 0.5), (1, 0.5)]];
        let quantised = [QuantisedRow {
            taps: vec![(0, (1 << 29) + 1), (1, (1 << 29) - 1)],
        }];
        let rest_cage = [[0; 3], [1 << 20, 0, 0]];
        let table = Table {
            rows: &rows,
            quantised: &quantised,
            rest_cage: &rest_cage,
            composition: 0.0,
        };
        let precision = table.precision(1, 1);
        let moved = 4.0 - 2.0_f64.powi(-30);
        assert_eq!(precision.absolute.proved_any_pose, moved + 0.5);
        assert_eq!(precision.absolute.proved_rest_size, 2.0_f64.powi(-10) + 0.5);
        assert_eq!(
            precision.displacement.proved_any_pose,
            moved + 2.0_f64.powi(-10) + 0.5
        );
        // At the ends of the range: the exact sum is -1/2 + 4 - 2^-30, and rounds to 3 and not to
        // 4; the unquantised one is -1/2.
        assert_eq!(precision.absolute.measured, 3.5);
    }
}
