//! The view of a table and the calls that apply it.

use core::fmt;
use core::marker::PhantomData;
use core::ops::Range;

use super::groups::Groups;
use super::kernel::{Half, Start};
use super::moved::{Moved, Updated};
use super::scalars;
use super::wide::{self, Weight};
use crate::bundle::BundleError;
use crate::coord::Coordinate;

/// The weights of a table.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Weights<'a> {
    /// 30 fraction bits.
    Q30(&'a [i32]),
    /// 14 fraction bits.
    Q14(&'a [i16]),
}

/// What the sums of the displacement form start from.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Starts<'a> {
    /// The table has the absolute form only.
    None,
    /// 32 bits a coordinate.
    Narrow(&'a [[i32; 3]]),
    /// 64 bits a coordinate.
    Wide(&'a [[i64; 3]]),
}

impl Starts<'_> {
    /// Number of rows that they are for; `None` if there are none.
    pub(crate) const fn len(&self) -> Option<usize> {
        match self {
            Self::None => None,
            Self::Narrow(starts) => Some(starts.len()),
            Self::Wide(starts) => Some(starts.len()),
        }
    }

    /// The greatest magnitude.
    ///
    /// # Errors
    ///
    /// The first row whose magnitudes are not all at most `limit`.
    pub(crate) fn greatest(&self, limit: u64) -> Result<u64, BundleError> {
        match self {
            Self::None => Ok(0),
            Self::Narrow(starts) => {
                greatest_of(starts.iter().map(|start| start.map(i64::from)), limit)
            }
            Self::Wide(starts) => greatest_of(starts.iter().copied(), limit),
        }
    }
}

fn greatest_of(starts: impl Iterator<Item = [i64; 3]>, limit: u64) -> Result<u64, BundleError> {
    let mut greatest = 0;
    for (start, row) in starts.zip(0_u32..) {
        for magnitude in start.map(i64::unsigned_abs) {
            if magnitude > limit {
                return Err(BundleError::Start { row });
            }
            greatest = greatest.max(magnitude);
        }
    }
    Ok(greatest)
}

/// A deformation table in flash, for coordinates of the type `C`.
///
/// It is immutable and small: copy it freely; one table serves many poses. Its rows come in an order
/// of the baker's choice, in which rows that share control points are neighbours:
/// [`Bundle::model_points`](crate::bundle::Bundle::model_points) says which point of the model each row is.
#[derive(Clone, Copy, Debug)]
pub struct Table<'a, C> {
    inputs: usize,
    rows: usize,
    groups: Groups<'a>,
    weights: Weights<'a>,
    starts: Starts<'a>,
    /// The greatest magnitude of a start value, in whole units of a coordinate's last place, rounded up.
    greatest_start: u32,
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
    /// The memory for displacements has another length than the cage has control points.
    MemoryLength {
        /// Control points of the cage.
        needed: usize,
        /// Length of the memory.
        given: usize,
    },
    /// There are more or fewer marks of moved control points than control points.
    MarksLength {
        /// Control points of the cage.
        needed: usize,
        /// Marks given.
        given: usize,
    },
    /// There are more or fewer values of scalar channels than control points.
    ValuesLength {
        /// Control points of the cage.
        needed: usize,
        /// Control points that values were given for.
        given: usize,
    },
    /// The points are not as many as the model has.
    PointsLength {
        /// Points of the model: rows of the table.
        needed: usize,
        /// Points given.
        given: usize,
    },
    /// The table has the absolute form only: it was baked without rest positions.
    NoRestPositions,
    /// The output's length is not the number of rows asked for.
    OutputLength {
        /// Rows asked for.
        needed: usize,
        /// Length of the output.
        given: usize,
    },
}

impl ApplyError {
    pub(super) const fn row_range(asked: &Range<usize>, rows: usize) -> Self {
        Self::RowRange {
            start: asked.start,
            end: asked.end,
            rows,
        }
    }
}

impl<'a, C: Coordinate> Table<'a, C> {
    /// Only a bundle makes tables: it has proved that the parts fit one another.
    pub(crate) const fn new(
        (inputs, rows): (usize, usize),
        groups: Groups<'a>,
        weights: Weights<'a>,
        starts: Starts<'a>,
        greatest_start: u32,
    ) -> Self {
        Self {
            inputs,
            rows,
            groups,
            weights,
            starts,
            greatest_start,
            format: PhantomData,
        }
    }

    /// Number of rows: points of the model.
    #[must_use]
    pub const fn rows(&self) -> usize {
        self.rows
    }

    /// Number of control points that a pose has.
    #[must_use]
    pub const fn control_points(&self) -> usize {
        self.inputs
    }

    /// Number of weights stored, those included that only fill a group.
    #[must_use]
    pub const fn taps(&self) -> usize {
        match self.weights {
            Weights::Q30(weights) => weights.len(),
            Weights::Q14(weights) => weights.len(),
        }
    }

    /// Fraction bits of the weights: 30 or 14.
    #[must_use]
    pub const fn weight_bits(&self) -> u32 {
        match self.weights {
            Weights::Q30(_) => 30,
            Weights::Q14(_) => 14,
        }
    }

    /// The taps of a row: control points, ascending, and weights, none of them zero; `None` if there is no
    /// such row.
    ///
    /// For looking at a table; [`Table::apply`] is the way to use it.
    pub fn row(&self, row: usize) -> Option<impl Iterator<Item = (usize, i32)> + use<'a, C>> {
        let position = self.groups.find(row)?;
        let &[_, taps] = position.groups.first()?;
        let taps = usize::from(taps);
        let first = taps
            .wrapping_mul(position.first_row)
            .wrapping_add(position.weights_before);
        let weights = self.weights;
        let indices = position.indices.get(..taps)?;
        Some(
            indices
                .iter()
                .zip(first..)
                .filter_map(move |(&index, place)| {
                    let weight = match weights {
                        Weights::Q30(weights) => *weights.get(place)?,
                        Weights::Q14(weights) => i32::from(*weights.get(place)?),
                    };
                    (weight != 0).then_some((usize::from(index), weight))
                }),
        )
    }

    /// What the sums of a row of the displacement form start from, in units of `2^-weight_bits`: the rest
    /// position less what the weights make of the control points at rest, and the half of the rounding
    /// rule. `None` if there is no such row, or the table has no rest positions.
    #[must_use]
    pub fn start(&self, row: usize) -> Option<[i64; 3]> {
        match self.starts {
            Starts::None => None,
            Starts::Narrow(starts) => starts.get(row).map(|start| start.map(i64::from)),
            Starts::Wide(starts) => starts.get(row).copied(),
        }
    }

    /// Computes the points of a range of rows in the displacement form, and returns how many
    /// coordinates were out of range and saturated.
    ///
    /// `pose` holds the positions of all control points, `out` one point for each row of the
    /// range. Whole groups cost least; finding the first row takes a few instructions for each group
    /// before it.
    ///
    /// # Scaling and overflow
    ///
    /// Coordinates are 32-bit in any format; weights have `q` = 30 or 14 fraction bits; products and
    /// sums are 64-bit. A row's magnitudes add up to at most 2, so its sum is at most
    /// `2^32 * 2^q`; the start value (residual and half) is at most `2^62 - 2^29`: the accumulator
    /// stays below `2^63` for any coordinates. It is rounded once, as [`crate::coord`] says. A
    /// coordinate that then does not fit 32 bits saturates and is counted. Whether that can happen is
    /// known before the first row: no result is larger than twice the greatest coordinate of the pose
    /// plus the greatest start value.
    ///
    /// # Errors
    ///
    /// An [`ApplyError`] if a length does not fit or the table has no rest positions; nothing is then
    /// written.
    pub fn apply(
        &self,
        rows: Range<usize>,
        pose: &[[C; 3]],
        out: &mut [[C; 3]],
    ) -> Result<u32, ApplyError> {
        self.check(&rows, pose, out)?;
        match self.starts {
            Starts::None => Err(ApplyError::NoRestPositions),
            Starts::Narrow(starts) => Ok(self.run(starts, rows, pose, out, Moved::All).saturated),
            Starts::Wide(starts) => Ok(self.run(starts, rows, pose, out, Moved::All).saturated),
        }
    }

    /// Computes only rows that a moved control point has a part in, in the displacement form.
    ///
    /// `out` holds a point for each row of the table, as the pose before gave them; `moved` says for
    /// each control point whether `pose` has it elsewhere. The result is then what [`Table::apply`] gives
    /// for all rows, to the bit. Rows are taken by groups: a group is computed if one of its control points
    /// has moved.
    ///
    /// # Errors
    ///
    /// An [`ApplyError`] if a length does not fit or the table has no rest positions; nothing is then
    /// written.
    pub fn apply_moved(
        &self,
        moved: &[bool],
        pose: &[[C; 3]],
        out: &mut [[C; 3]],
    ) -> Result<Updated, ApplyError> {
        let rows = 0..self.rows;
        self.check(&rows, pose, out)?;
        let (needed, given) = (self.inputs, moved.len());
        if needed != given {
            return Err(ApplyError::MarksLength { needed, given });
        }
        let moved = Moved::Marked(moved);
        match self.starts {
            Starts::None => Err(ApplyError::NoRestPositions),
            Starts::Narrow(starts) => Ok(self.run(starts, rows, pose, out, moved)),
            Starts::Wide(starts) => Ok(self.run(starts, rows, pose, out, moved)),
        }
    }

    /// Marks the rows that [`Table::apply_moved`] computes for these moved control points, one mark for each
    /// row, and clears the other marks.
    ///
    /// The rows of the first table of a factored one are the pose of the second: their marks are what
    /// moved there.
    ///
    /// # Errors
    ///
    /// [`ApplyError::MarksLength`] or [`ApplyError::OutputLength`]; nothing is then written.
    pub fn mark_moved(&self, moved: &[bool], rows: &mut [bool]) -> Result<(), ApplyError> {
        self.groups
            .mark_moved(moved, (self.inputs, self.rows), rows)
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
        /// As many as a table can have rows, and no bytes.
        const HALVES_30: &[Half<30>] = &[Half; usize::MAX];
        const HALVES_14: &[Half<14>] = &[Half; usize::MAX];
        self.check(&rows, pose, out)?;
        Ok(match self.weights {
            Weights::Q30(weights) => self.run_with(weights, HALVES_30, rows, pose, out, Moved::All),
            Weights::Q14(weights) => self.run_with(weights, HALVES_14, rows, pose, out, Moved::All),
        }
        .saturated)
    }

    /// Carries scalar channels (a temperature, a density, texture coordinates) from the control points
    /// to a range of rows by the weights that carry positions, and returns how many values were out
    /// of range and saturated.
    ///
    /// `values` holds `D` channels for each control point, `out` as many for each row of the range. A
    /// channel's format `V` is its own and need not be that of the coordinates; channels of several
    /// formats go together as raw bits (`i32`). Channels have no rest values: the result is the weighted
    /// sum itself, as [`Table::apply_absolute`] gives it of positions. As a row's weights add up to
    /// exactly one, a channel that is the same at all control points is the same at all rows, to the
    /// bit.
    ///
    /// # Scaling and overflow
    ///
    /// Values are 32-bit in any format; weights have `q` = 30 or 14 fraction bits; products and sums are
    /// 64-bit. A row's magnitudes add up to at most 2, so its sum is at most `2^32 * 2^q`, with the half
    /// of the rounding rule at most `2^62 + 2^29`, for any values. It is rounded once, as
    /// [`crate::coord`] says. A value that then does not fit 32 bits saturates and is counted.
    ///
    /// # Errors
    ///
    /// An [`ApplyError`] if a length does not fit; nothing is then written.
    pub fn apply_scalars<V: Coordinate, const D: usize>(
        &self,
        rows: Range<usize>,
        values: &[[V; D]],
        out: &mut [[V; D]],
    ) -> Result<u32, ApplyError> {
        let shape = (self.inputs, self.rows);
        match self.weights {
            Weights::Q30(weights) => scalars::apply(self.groups, shape, weights, rows, values, out),
            Weights::Q14(weights) => scalars::apply(self.groups, shape, weights, rows, values, out),
        }
    }

    fn run<S: Start>(
        &self,
        starts: &[S],
        rows: Range<usize>,
        pose: &[[C; 3]],
        out: &mut [[C; 3]],
        moved: Moved<'_>,
    ) -> Updated {
        match self.weights {
            Weights::Q30(weights) => self.run_with(weights, starts, rows, pose, out, moved),
            Weights::Q14(weights) => self.run_with(weights, starts, rows, pose, out, moved),
        }
    }

    fn run_with<W: Weight, S: Start>(
        &self,
        weights: &[W],
        starts: &[S],
        rows: Range<usize>,
        pose: &[[C; 3]],
        out: &mut [[C; 3]],
        moved: Moved<'_>,
    ) -> Updated {
        let (pose, out) = (C::bits_of(pose), C::bits_of_mut(out));
        let reach = u64::from(greatest_magnitude(pose))
            .wrapping_mul(2)
            .wrapping_add(self.greatest_start.into());
        let may_saturate = reach > u64::from(i32::MAX.unsigned_abs());
        wide::apply(
            self.groups,
            weights,
            starts,
            rows,
            (pose, out),
            moved,
            may_saturate,
        )
    }

    fn check(
        &self,
        rows: &Range<usize>,
        pose: &[[C; 3]],
        out: &[[C; 3]],
    ) -> Result<(), ApplyError> {
        if pose.len() != self.inputs {
            return Err(ApplyError::PoseLength {
                needed: self.inputs,
                given: pose.len(),
            });
        }
        let needed = rows.end.checked_sub(rows.start);
        let needed = needed.filter(|_| rows.end <= self.rows);
        let needed = needed.ok_or(ApplyError::row_range(rows, self.rows))?;
        let given = out.len();
        if needed == given {
            Ok(())
        } else {
            Err(ApplyError::OutputLength { needed, given })
        }
    }
}

/// The greatest magnitude among all coordinates.
fn greatest_magnitude(points: &[[i32; 3]]) -> u32 {
    let mut greatest = 0;
    for point in points {
        for &coordinate in point {
            greatest = greatest.max(coordinate.unsigned_abs());
        }
    }
    greatest
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
            Self::MemoryLength { needed, given } => {
                write!(
                    f,
                    "the memory holds {given} displacements, the table's cage has {needed} control points"
                )
            }
            Self::MarksLength { needed, given } => {
                write!(
                    f,
                    "{given} control points are marked or not, the table's cage has {needed}"
                )
            }
            Self::ValuesLength { needed, given } => {
                write!(
                    f,
                    "{given} control points have values, the table's cage has {needed}"
                )
            }
            Self::PointsLength { needed, given } => {
                write!(f, "{given} points were given, the model has {needed}")
            }
            Self::NoRestPositions => f.write_str(
                "the table has no rest positions: apply its absolute form, or bake it with them",
            ),
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
