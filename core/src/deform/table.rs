//! The view of a table and the calls that apply it.

use core::fmt;
use core::marker::PhantomData;
use core::ops::Range;

use super::apply::{Rows, apply_rows};
use crate::coord::Coordinate;

/// A deformation table in flash, for coordinates of the type `C`.
///
/// It is immutable and small: copy it freely; one table serves many poses.
#[derive(Clone, Copy, Debug)]
pub struct Table<'a, C> {
    control_points: usize,
    row_starts: &'a [u32],
    weights: &'a [i32],
    indices: &'a [u16],
    residuals: &'a [[i64; 3]],
    format: PhantomData<C>,
}

/// Why rows were not computed. The output is then as it was.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum ApplyError {
    /// The pose has another number of control points than the cage.
    PoseLength {
        /// Control points of the cage.
        needed: usize,
        /// Control points of the pose.
        given: usize,
    },
    /// The range ends past the last row, or before it starts.
    RowRange {
        /// First row asked for.
        start: usize,
        /// One past the last row asked for.
        end: usize,
        /// Rows of the table.
        rows: usize,
    },
    /// The output's length is not the number of rows asked for.
    OutputLength {
        /// Rows asked for.
        needed: usize,
        /// Length of the output.
        given: usize,
    },
}

impl<'a, C: Coordinate> Table<'a, C> {
    /// Only a bundle makes tables: it has proved that the parts fit one another.
    pub(crate) const fn new(
        control_points: usize,
        row_starts: &'a [u32],
        weights: &'a [i32],
        indices: &'a [u16],
        residuals: &'a [[i64; 3]],
    ) -> Self {
        Self {
            control_points,
            row_starts,
            weights,
            indices,
            residuals,
            format: PhantomData,
        }
    }

    /// Number of rows: points of the model.
    #[must_use]
    pub const fn rows(&self) -> usize {
        self.residuals.len()
    }

    /// Number of control points that a pose has.
    #[must_use]
    pub const fn control_points(&self) -> usize {
        self.control_points
    }

    /// Number of taps of all rows.
    #[must_use]
    pub const fn taps(&self) -> usize {
        self.weights.len()
    }

    /// Computes the points of a range of rows in the displacement form, and returns how many
    /// coordinates were out of range and saturated.
    ///
    /// `pose` holds the positions of all control points, `out` one point for each row of the
    /// range.
    ///
    /// # Scaling and overflow
    ///
    /// Coordinates are 32-bit in any format, weights have 30 fraction bits, products and sums
    /// are 64-bit. A row's magnitudes add up to at most 2, so its sum is at most `2^62`; the
    /// residual is at most `2^62 - 2^30` and the half `2^29`: the accumulator stays below `2^63`
    /// for any coordinates. It is rounded once, as [`crate::coord`] says. A coordinate that then
    /// does not fit 32 bits saturates and is counted.
    ///
    /// # Errors
    ///
    /// An [`ApplyError`] if a length does not fit; nothing is then written.
    pub fn apply(
        &self,
        rows: Range<usize>,
        pose: &[[C; 3]],
        out: &mut [[C; 3]],
    ) -> Result<u32, ApplyError> {
        let rows = self.select(rows, pose, out)?;
        Ok(apply_rows::<C, true>(rows, pose, out))
    }

    /// Computes the points of a range of rows in the absolute form, and returns how many
    /// coordinates were out of range and saturated.
    ///
    /// It differs from [`Table::apply`] by at most what the quantised weights miss of the rest
    /// model, which the baker reports. The arguments, the scaling and the errors are the same;
    /// the accumulator stays below `2^62 + 2^29`.
    ///
    /// # Errors
    ///
    /// An [`ApplyError`] if a length does not fit; nothing is then written.
    pub fn apply_absolute(
        &self,
        rows: Range<usize>,
        pose: &[[C; 3]],
        out: &mut [[C; 3]],
    ) -> Result<u32, ApplyError> {
        let rows = self.select(rows, pose, out)?;
        Ok(apply_rows::<C, false>(rows, pose, out))
    }

    /// The parts of the table that belong to a range of rows.
    fn select(
        &self,
        rows: Range<usize>,
        pose: &[[C; 3]],
        out: &[[C; 3]],
    ) -> Result<Rows<'a>, ApplyError> {
        if pose.len() != self.control_points {
            return Err(ApplyError::PoseLength {
                needed: self.control_points,
                given: pose.len(),
            });
        }
        let range = ApplyError::RowRange {
            start: rows.start,
            end: rows.end,
            rows: self.rows(),
        };
        let residuals = self.residuals.get(rows.clone()).ok_or(range)?;
        if residuals.len() != out.len() {
            let (needed, given) = (residuals.len(), out.len());
            return Err(ApplyError::OutputLength { needed, given });
        }
        let starts = self.row_starts.get(rows.start..=rows.end).ok_or(range)?;
        let first = starts
            .first()
            .and_then(|&first| usize::try_from(first).ok())
            .ok_or(range)?;
        Ok(Rows {
            starts,
            weights: self.weights.get(first..).ok_or(range)?,
            indices: self.indices.get(first..).ok_or(range)?,
            residuals,
        })
    }
}

impl fmt::Display for ApplyError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::PoseLength { needed, given } => {
                write!(
                    f,
                    "the pose has {given} control points, the table's cage {needed}"
                )
            }
            Self::RowRange { start, end, rows } => {
                write!(
                    f,
                    "rows {start} to {end} were asked for of a table with {rows}"
                )
            }
            Self::OutputLength { needed, given } => {
                write!(
                    f,
                    "the output holds {given} points, {needed} rows were asked for"
                )
            }
        }
    }
}

impl core::error::Error for ApplyError {}
