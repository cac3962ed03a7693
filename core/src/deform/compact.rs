//! The table for 16-bit displacements.

use core::marker::PhantomData;
use core::ops::Range;

use super::groups::{Groups, Position};
use super::kernel::{
    self, EXCLUDED_DISPLACEMENT_SHIFT, MOST_DISPLACEMENT_SHIFT, MOST_TAPS, Pair, TAPS_A_STEP,
    scaled,
};
use super::moved::{Moved, Updated};
use super::scalars::{self, InPairs};
use super::table::ApplyError;
use crate::coord::{Coordinate, rounding_start, saturate};

/// A control point's displacement from its rest position, in 16 bits a coordinate.
///
/// [`CompactTable::displacements`] makes it. It takes 8 bytes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Displacement {
    /// x in the lower half, y in the upper.
    xy: u32,
    /// z in the lower half.
    z: u32,
}

impl Displacement {
    /// x, y and z, in units of `2^shift` of a coordinate's last place.
    #[must_use]
    #[expect(
        clippy::as_conversions,
        reason = "truncation to a half is what is meant"
    )]
    pub const fn bits(self) -> [i16; 3] {
        [self.xy as i16, (self.xy >> 16) as i16, self.z as i16]
    }

    #[expect(
        clippy::as_conversions,
        reason = "two's complement halves are what is meant"
    )]
    const fn new([x, y, z]: [i16; 3]) -> Self {
        Self {
            xy: x as u16 as u32 | (y as u16 as u32) << 16,
            z: z as u16 as u32,
        }
    }

    /// The x, the y and the z of two displacements, side by side.
    #[inline(always)]
    const fn pairs(first: Self, second: Self) -> [Pair; 3] {
        const LOW: u32 = 0xffff;
        [
            Pair((first.xy & LOW) | (second.xy << 16)),
            Pair((first.xy >> 16) | (second.xy & !LOW)),
            Pair((first.z & LOW) | (second.z << 16)),
        ]
    }
}

/// The displacements of all control points, ready for [`CompactTable::apply`].
#[derive(Clone, Copy, Debug)]
pub struct Displacements<'a> {
    displacements: &'a [Displacement],
    /// The greatest magnitude among them.
    greatest: u32,
    /// How many coordinates were out of the displacements' range.
    saturated: u32,
}

impl<'a> Displacements<'a> {
    /// How many coordinates of control points were too far from rest for 16 bits and were clamped.
    #[must_use]
    pub const fn saturated(&self) -> u32 {
        self.saturated
    }

    /// One for each control point.
    #[must_use]
    pub const fn as_slice(&self) -> &'a [Displacement] {
        self.displacements
    }
}

/// A table for 16-bit displacements: the fastest, where their resolution suffices.
///
/// A displacement is a control point's position less its rest position in units of `2^shift` of a
/// coordinate's last place, rounded to the nearest; a row adds the weighted sum of displacements to the
/// rest position of its model point. At rest it gives the rest model to the bit.
#[derive(Clone, Copy, Debug)]
pub struct CompactTable<'a, C> {
    groups: Groups<'a>,
    weights: &'a [i16],
    rest: &'a [[i32; 3]],
    rest_cage: &'a [[i32; 3]],
    shift: u32,
    greatest_rest: u32,
    format: PhantomData<C>,
}

impl<'a, C: Coordinate> CompactTable<'a, C> {
    /// Only a bundle makes tables: it has proved that the parts fit one another.
    pub(crate) const fn new(
        groups: Groups<'a>,
        weights: &'a [i16],
        rest: &'a [[i32; 3]],
        rest_cage: &'a [[i32; 3]],
        shift: u32,
        greatest_rest: u32,
    ) -> Self {
        Self {
            groups,
            weights,
            rest,
            rest_cage,
            shift,
            greatest_rest,
            format: PhantomData,
        }
    }

    /// Number of rows: points of the model.
    #[must_use]
    pub const fn rows(&self) -> usize {
        self.rest.len()
    }

    /// Number of control points that a pose has.
    #[must_use]
    pub const fn control_points(&self) -> usize {
        self.rest_cage.len()
    }

    /// Number of weights stored, those included that only fill a group.
    #[must_use]
    pub const fn taps(&self) -> usize {
        self.weights.len()
    }

    /// A displacement's unit is `2^shift` units in the last place of a coordinate.
    #[must_use]
    pub const fn shift(&self) -> u32 {
        self.shift
    }

    /// Forms the displacements of all control points, once a tick, in the caller's memory.
    ///
    /// `pose` and `memory` have one element for each control point.
    ///
    /// # Scaling and overflow
    ///
    /// The difference of two 32-bit coordinates is formed in 64 bits, divided by `2^shift`, rounded
    /// as [`crate::coord`] says, and clamped to 16 bits; [`Displacements::saturated`] counts the clamped.
    ///
    /// # Errors
    ///
    /// [`ApplyError::PoseLength`] or [`ApplyError::MemoryLength`]; nothing is then written.
    pub fn displacements<'m>(
        &self,
        pose: &[[C; 3]],
        memory: &'m mut [Displacement],
    ) -> Result<Displacements<'m>, ApplyError> {
        let needed = self.rest_cage.len();
        if pose.len() != needed {
            let given = pose.len();
            return Err(ApplyError::PoseLength { needed, given });
        }
        if memory.len() != needed {
            let given = memory.len();
            return Err(ApplyError::MemoryLength { needed, given });
        }
        let (mut saturated, mut greatest) = (0_u32, 0_u32);
        let half = rounding_start(self.shift);
        let points = C::bits_of(pose).iter().zip(self.rest_cage);
        for (slot, (&[x, y, z], &[rest_x, rest_y, rest_z])) in memory.iter_mut().zip(points) {
            let mut one = |at: i32, rest: i32| {
                let moved = i64::from(at).wrapping_sub(i64::from(rest));
                let rounded = moved.wrapping_add(half).wrapping_shr(self.shift);
                let clamped = clamp(rounded, &mut saturated);
                greatest = greatest.max(u32::from(clamped.unsigned_abs()));
                clamped
            };
            *slot = Displacement::new([one(x, rest_x), one(y, rest_y), one(z, rest_z)]);
        }
        Ok(Displacements {
            displacements: memory,
            greatest,
            saturated,
        })
    }

    /// Computes the points of a range of rows, and returns how many coordinates were out of range and
    /// saturated.
    ///
    /// `out` holds one point for each row of the range. A range that starts and ends with a group, or
    /// at an even distance from its start, costs least.
    ///
    /// # Scaling and overflow
    ///
    /// Weights have 14 fraction bits and 16 bits, displacements 16 bits. A row's magnitudes add up to
    /// at most `2^15`, so every partial sum is at most `2^30` and is kept in 32 bits without loss. It is
    /// scaled by `2^(shift - 14)`, rounded once and added to the rest position. A coordinate that then does
    /// not fit 32 bits saturates and is counted; whether that can happen is known before the first row
    /// from the greatest displacement and the greatest rest position.
    ///
    /// # Errors
    ///
    /// An [`ApplyError`] if a length does not fit; nothing is then written.
    pub fn apply(
        &self,
        rows: Range<usize>,
        displacements: &Displacements<'_>,
        out: &mut [[C; 3]],
    ) -> Result<u32, ApplyError> {
        self.run(rows, displacements, out, Moved::All)
            .map(|updated| updated.saturated)
    }

    /// Computes only rows that a moved control point has a part in.
    ///
    /// `out` holds a point for each row of the table, as the pose before gave them; `moved` says for each
    /// control point whether its displacement is another now. The result is then what
    /// [`CompactTable::apply`] gives for all rows, to the bit. Rows are taken by groups: a group is
    /// computed if one of its control points has moved.
    ///
    /// # Errors
    ///
    /// An [`ApplyError`] if a length does not fit; nothing is then written.
    pub fn apply_moved(
        &self,
        moved: &[bool],
        displacements: &Displacements<'_>,
        out: &mut [[C; 3]],
    ) -> Result<Updated, ApplyError> {
        let (needed, given) = (self.rest_cage.len(), moved.len());
        if needed != given {
            return Err(ApplyError::MarksLength { needed, given });
        }
        self.run(0..self.rows(), displacements, out, Moved::Marked(moved))
    }

    /// Carries scalar channels from the control points to a range of rows by the weights that carry
    /// displacements, and returns how many values were out of range and saturated.
    ///
    /// Values are 32-bit and are not made smaller: the result is that of
    /// [`Table::apply_scalars`](super::Table::apply_scalars) with weights of 14 fraction bits. `values`
    /// holds `D` channels for each control point, `out` as many for each row of the range.
    ///
    /// # Scaling and overflow
    ///
    /// Products and sums are 64-bit. A row's magnitudes add up to at most `2^15`, so its sum is at most
    /// `2^46`, for any values. It is rounded once, as [`crate::coord`] says. A value that then does not
    /// fit 32 bits saturates and is counted.
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
        let shape = (self.rest_cage.len(), self.rows());
        let weights = InPairs(self.weights);
        scalars::apply(self.groups, shape, weights, rows, values, out)
    }

    /// Marks the rows that [`CompactTable::apply_moved`] computes for these moved control points: see
    /// [`Table::mark_moved`](super::Table::mark_moved).
    ///
    /// # Errors
    ///
    /// [`ApplyError::MarksLength`] or [`ApplyError::OutputLength`]; nothing is then written.
    pub fn mark_moved(&self, moved: &[bool], rows: &mut [bool]) -> Result<(), ApplyError> {
        let sizes = (self.rest_cage.len(), self.rest.len());
        self.groups.mark_moved(moved, sizes, rows)
    }

    fn run(
        &self,
        rows: Range<usize>,
        displacements: &Displacements<'_>,
        out: &mut [[C; 3]],
        moved: Moved<'_>,
    ) -> Result<Updated, ApplyError> {
        let (needed, given) = (self.rest_cage.len(), displacements.displacements.len());
        if needed != given {
            return Err(ApplyError::PoseLength { needed, given });
        }
        let range = ApplyError::row_range(&rows, self.rows());
        let rest = self.rest.get(rows.clone()).ok_or(range)?;
        if rest.len() != out.len() {
            let (needed, given) = (rest.len(), out.len());
            return Err(ApplyError::OutputLength { needed, given });
        }
        // |rest| + 2 * greatest * 2^shift + 1 for the rounding.
        let reach = u64::from(displacements.greatest)
            .wrapping_shl(self.shift.wrapping_add(1))
            .wrapping_add(u64::from(self.greatest_rest))
            .wrapping_add(1);
        let may_saturate = reach > u64::from(i32::MAX.unsigned_abs());
        let displacements = displacements.displacements;
        let out = C::bits_of_mut(out);
        Ok(self.apply_rows((rows.start, rest), displacements, out, moved, may_saturate))
    }

    /// The rows from `start` on that belong to `rest`.
    fn apply_rows(
        &self,
        (start, mut rest): (usize, &[[i32; 3]]),
        displacements: &[Displacement],
        mut out: &mut [[i32; 3]],
        moved: Moved<'_>,
        may_saturate: bool,
    ) -> Updated {
        let mut updated = Updated::default();
        let mut scratch = [[Pair::default(); 3]; MOST_TAPS / TAPS_A_STEP];
        let Some(Position {
            mut first_row,
            groups,
            mut indices,
            weights_before,
        }) = self.groups.find(start)
        else {
            return updated;
        };
        let mut weights = self.weights.get(weights_before..).unwrap_or_default();
        for &[group_rows, taps] in groups {
            if out.is_empty() {
                break;
            }
            let (group_rows, taps) = (usize::from(group_rows), usize::from(taps));
            let skipped = core::mem::take(&mut first_row);
            let count = group_rows.wrapping_sub(skipped).min(out.len());
            let (Some((group_indices, more_indices)), Some((group_weights, more_weights))) = (
                indices.split_at_checked(taps),
                weights.split_at_checked(taps.wrapping_mul(group_rows)),
            ) else {
                break;
            };
            let (Some((group_rest, more_rest)), Some((group_out, more_out))) = (
                rest.split_at_checked(count),
                core::mem::take(&mut out).split_at_mut_checked(count),
            ) else {
                break;
            };
            (indices, weights, rest, out) = (more_indices, more_weights, more_rest, more_out);
            if !moved.any_of(group_indices) {
                continue;
            }
            updated.rows = updated.rows.wrapping_add(count);
            let group = Group {
                indices: group_indices,
                weights: group_weights,
                rows: group_rows,
                skipped,
                rest: group_rest,
            };
            let quick = !may_saturate && skipped.is_multiple_of(2);
            match scratch.get_mut(..taps.wrapping_shr(1)) {
                Some(points) if quick => {
                    group.apply_quick(points, displacements, self.shift, group_out);
                }
                _ => {
                    updated.saturated =
                        group.apply_checked(displacements, self.shift, group_out, updated.saturated)
                }
            }
        }
        updated
    }
}

/// What of a group is wanted.
struct Group<'a> {
    indices: &'a [u16],
    /// The weights of the whole group.
    weights: &'a [i16],
    /// The rows of the whole group.
    rows: usize,
    /// Rows before the first that is wanted.
    skipped: usize,
    /// Rest positions of the wanted rows.
    rest: &'a [[i32; 3]],
}

impl Group<'_> {
    /// Pairs of rows by the kernel, what is left one by one. `skipped` is even.
    fn apply_quick(
        &self,
        points: &mut [[Pair; 3]],
        displacements: &[Displacement],
        shift: u32,
        out: &mut [[i32; 3]],
    ) {
        let (index_pairs, _) = self.indices.as_chunks::<2>();
        for (point, &[first, second]) in points.iter_mut().zip(index_pairs) {
            if let (Some(&first), Some(&second)) = (
                displacements.get(usize::from(first)),
                displacements.get(usize::from(second)),
            ) {
                *point = Displacement::pairs(first, second);
            }
        }
        let taps = self.indices.len();
        let paired = out.len() & !1;
        let start = taps.wrapping_mul(self.skipped);
        let weights = self
            .weights
            .get(start..)
            .and_then(|weights| weights.get(..taps.wrapping_mul(paired)));
        let (Some(weights), Some((rest, _)), Some((paired_out, single))) = (
            weights,
            self.rest.split_at_checked(paired),
            out.split_at_mut_checked(paired),
        ) else {
            return;
        };
        if paired != 0 {
            kernel::narrow_pairs(points, weights, rest, shift, paired_out);
        }
        let last = self.skipped.wrapping_add(paired);
        for (slot, &rest) in single
            .iter_mut()
            .zip(self.rest.get(paired..).unwrap_or_default())
        {
            if last.wrapping_add(1) == self.rows {
                let weights = self
                    .weights
                    .get(taps.wrapping_mul(last)..)
                    .unwrap_or_default();
                *slot = kernel::narrow_single(points, weights, rest, shift);
            } else {
                let half_of_pair = Group {
                    skipped: last,
                    rest: &[rest],
                    ..*self
                };
                half_of_pair.apply_checked(displacements, shift, core::slice::from_mut(slot), 0);
            }
        }
    }

    /// Row by row, every result checked; returns `saturated` plus how many saturated here.
    fn apply_checked(
        &self,
        displacements: &[Displacement],
        shift: u32,
        out: &mut [[i32; 3]],
        mut saturated: u32,
    ) -> u32 {
        for ((slot, rest), row) in out.iter_mut().zip(self.rest).zip(self.skipped..) {
            let mut sums = [0_i32; 3];
            for (place, &index) in self.indices.iter().enumerate() {
                let weight = i32::from(self.weight(row, place));
                let point = displacements.get(usize::from(index)).copied();
                for (sum, coordinate) in sums.iter_mut().zip(point.unwrap_or_default().bits()) {
                    *sum = sum.wrapping_add(weight.wrapping_mul(i32::from(coordinate)));
                }
            }
            for ((slot, &rest), sum) in slot.iter_mut().zip(rest).zip(sums) {
                *slot = saturate(
                    i64::from(rest).wrapping_add(scaled(sum, shift)),
                    &mut saturated,
                );
            }
        }
        saturated
    }

    /// The weight of a tap of a row, both counted from the group's first.
    fn weight(&self, row: usize, tap: usize) -> i16 {
        let place = weight_place(self.rows, self.indices.len(), row, tap);
        self.weights.get(place).copied().unwrap_or_default()
    }
}

/// Where the weight of a tap of a row lies among those of its group: two rows share a block, in which two
/// taps of the first row alternate with two of the second; a last row without a partner stands alone.
#[must_use]
pub(crate) const fn weight_place(rows: usize, taps: usize, row: usize, tap: usize) -> usize {
    let block = taps.wrapping_mul(row & !1);
    let alone = row & 1 == 0 && row.wrapping_add(1) == rows;
    let within = if alone {
        tap
    } else {
        ((tap & !1) << 1)
            .wrapping_add((row & 1) << 1)
            .wrapping_add(tap & 1)
    };
    block.wrapping_add(within)
}

/// The least shift with which 16-bit displacements hold `greatest` units of a coordinate's last place;
/// `None` if none does.
#[must_use]
pub const fn displacement_shift(greatest: u64) -> Option<u32> {
    let mut shift = 0;
    while shift <= MOST_DISPLACEMENT_SHIFT {
        // Half a unit of rounding is covered by the last whole unit.
        let fits = greatest <= 0x7fff_u64.wrapping_shl(shift);
        if fits && shift != EXCLUDED_DISPLACEMENT_SHIFT {
            return Some(shift);
        }
        shift = shift.wrapping_add(1);
    }
    None
}

/// Clamps a displacement to 16 bits and counts it if it did not fit.
fn clamp(value: i64, saturated: &mut u32) -> i16 {
    match i16::try_from(value) {
        Ok(bits) => bits,
        Err(_) => {
            *saturated = saturated.saturating_add(1);
            if value < 0 { i16::MIN } else { i16::MAX }
        }
    }
}
