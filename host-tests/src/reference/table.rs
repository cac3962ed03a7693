//! The table's apply: weighted sums of control points with 30 fraction bits.

use std::fmt;

use super::exact::{LimbSum, saturate};

/// Rows of weights in compressed form: row `r` has the taps `offsets[r] .. offsets[r + 1]`.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Table {
    /// Number of rows and one more; starts with 0 and does not descend.
    pub offsets: Vec<u32>,
    /// The control point of each tap.
    pub indices: Vec<u16>,
    /// The weight of each tap, one being 2^30; magnitudes in a row add up to at most 2^31.
    pub weights: Vec<i32>,
}

/// Why a table cannot be applied.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TableError {
    /// The offsets do not start at 0, descend, or do not end at the number of taps.
    Offsets,
    /// There are not as many weights as indices.
    TapCount,
    /// A row, and a control point in it that is not there.
    NoSuchPoint(usize, u16),
    /// The magnitudes of this row's weights add up to more than 2^31.
    WeightsTooGreat(usize),
    /// The number of rest points: control points at rest or rest results do not match.
    RestCount,
}

impl fmt::Display for TableError {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Offsets => write!(
                formatter,
                "the row offsets are not a list of ascending places"
            ),
            Self::TapCount => write!(formatter, "there are not as many weights as indices"),
            Self::NoSuchPoint(row, point) => {
                write!(
                    formatter,
                    "row {row} names control point {point}, which is not there"
                )
            }
            Self::WeightsTooGreat(row) => {
                write!(
                    formatter,
                    "magnitudes of weights in row {row} add up to more than two"
                )
            }
            Self::RestCount => write!(
                formatter,
                "the rest points do not fit the table or the pose"
            ),
        }
    }
}

impl std::error::Error for TableError {}

/// What an apply gives.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Applied<const D: usize> {
    /// One entry for each row.
    pub points: Vec<[i32; D]>,
    /// How many coordinates were outside 32 bits and were clamped.
    pub saturated: usize,
}

impl Table {
    /// Number of rows.
    pub fn row_count(&self) -> usize {
        self.offsets.len().saturating_sub(1)
    }

    /// Index and weight of each tap of a row.
    pub fn row(&self, row: usize) -> impl Iterator<Item = (u16, i32)> {
        let taps = self.offsets[row] as usize..self.offsets[row + 1] as usize;
        let indices = self.indices[taps.clone()].iter().copied();
        indices.zip(self.weights[taps].iter().copied())
    }

    /// Checks all that the sums rely on, for poses of `point_count` control points.
    ///
    /// # Errors
    /// The first fault found.
    pub fn check(&self, point_count: usize) -> Result<(), TableError> {
        if self.indices.len() != self.weights.len() {
            return Err(TableError::TapCount);
        }
        let ascending = self.offsets.windows(2).all(|pair| pair[0] <= pair[1]);
        let ends = (
            self.offsets.first(),
            self.offsets.last().map(|end| *end as usize),
        );
        if !ascending || ends != (Some(&0), Some(self.indices.len())) {
            return Err(TableError::Offsets);
        }
        for row in 0..self.row_count() {
            let mut magnitude = 0_u64;
            for (point, weight) in self.row(row) {
                magnitude += u64::from(weight.unsigned_abs());
                if usize::from(point) >= point_count {
                    return Err(TableError::NoSuchPoint(row, point));
                }
            }
            if magnitude > 1 << 31 {
                return Err(TableError::WeightsTooGreat(row));
            }
        }
        Ok(())
    }
}

/// The absolute form: each row's sum of weight times control point, rounded once.
///
/// # Errors
/// If the table does not fit the pose or a row's weights are too great.
pub fn apply_absolute<const D: usize>(
    table: &Table,
    pose: &[[i32; D]],
) -> Result<Applied<D>, TableError> {
    table.check(pose.len())?;
    let rest = vec![[0; D]; table.row_count()];
    Ok(apply(table, pose, &vec![[0; D]; pose.len()], &rest))
}

/// The displacement form: each row's rest result and the rounded sum of weight times the
/// control point's way from its place at rest.
///
/// # Errors
/// If the table does not fit the pose, the rest pose or the rest results, or a row's weights
/// are too great.
pub fn apply_displacement<const D: usize>(
    table: &Table,
    pose: &[[i32; D]],
    rest_pose: &[[i32; D]],
    rest: &[[i32; D]],
) -> Result<Applied<D>, TableError> {
    table.check(pose.len())?;
    if rest_pose.len() != pose.len() || rest.len() != table.row_count() {
        return Err(TableError::RestCount);
    }
    Ok(apply(table, pose, rest_pose, rest))
}

fn apply<const D: usize>(
    table: &Table,
    pose: &[[i32; D]],
    rest_pose: &[[i32; D]],
    rest: &[[i32; D]],
) -> Applied<D> {
    let mut saturated = 0;
    let mut points = Vec::with_capacity(rest.len());
    for (row, rest) in rest.iter().enumerate() {
        let mut sums = [LimbSum::default(); D];
        for (point, weight) in table.row(row) {
            let moved = pose[usize::from(point)]
                .iter()
                .zip(&rest_pose[usize::from(point)]);
            for (sum, (now, before)) in sums.iter_mut().zip(moved) {
                sum.add(f64::from(weight), f64::from(*now) - f64::from(*before));
            }
        }
        points.push(std::array::from_fn(|channel| {
            // At most 2^31 and 2^33: an exact sum.
            saturate(
                f64::from(rest[channel]) + sums[channel].round(),
                &mut saturated,
            )
        }));
    }
    Applied { points, saturated }
}
