//! Groups: rows that share their control points.

use super::moved::Moved;
use super::table::ApplyError;
use core::ops::Range;

/// The groups of a table and the control points that each of them names.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Groups<'a> {
    /// For each group its rows and its taps.
    pub groups: &'a [[u16; 2]],
    /// The control points of the first group, then of the second, and so on.
    pub indices: &'a [u16],
}

/// The wanted rows of one group.
pub(super) struct Part<'a> {
    /// The control points of the group.
    pub indices: &'a [u16],
    /// The place of the group's first weight among those of the table.
    pub first_weight: usize,
    /// Rows of the whole group.
    pub rows: usize,
    /// Rows of the group before the first that is wanted.
    pub skipped: usize,
    /// Rows of the group that are wanted.
    pub count: usize,
}

/// Where a row lies.
pub(super) struct Position<'a> {
    /// The row, counted from the first of its group.
    pub first_row: usize,
    /// The row's group and those behind it.
    pub groups: &'a [[u16; 2]],
    /// The control points of these groups.
    pub indices: &'a [u16],
    /// Weights of all groups before.
    pub weights_before: usize,
}

impl<'a> Groups<'a> {
    /// Marks the rows of groups with a moved control point and clears the marks of the others. `inputs` and
    /// `rows` are the numbers of control points and rows.
    pub(super) fn mark_moved(
        &self,
        moved: &[bool],
        (inputs, rows): (usize, usize),
        marks: &mut [bool],
    ) -> Result<(), ApplyError> {
        if moved.len() != inputs {
            let (needed, given) = (inputs, moved.len());
            return Err(ApplyError::MarksLength { needed, given });
        }
        if marks.len() != rows {
            let (needed, given) = (rows, marks.len());
            return Err(ApplyError::OutputLength { needed, given });
        }
        let (mut indices, mut marks) = (self.indices, marks);
        for &[group_rows, taps] in self.groups {
            let (Some((own, more)), Some((group_marks, more_marks))) = (
                indices.split_at_checked(taps.into()),
                core::mem::take(&mut marks).split_at_mut_checked(group_rows.into()),
            ) else {
                break;
            };
            group_marks.fill(Moved::Marked(moved).any_of(own));
            (indices, marks) = (more, more_marks);
        }
        Ok(())
    }

    /// Finds the group of a row; `None` if there is no such row.
    ///
    /// Takes a few instructions for each group before it.
    pub(super) fn find(&self, row: usize) -> Option<Position<'a>> {
        let (mut groups, mut indices, mut weights_before) = (self.groups, self.indices, 0_usize);
        let mut first_row = row;
        while let Some((&[rows, taps], more)) = groups.split_first() {
            let (rows, taps) = (usize::from(rows), usize::from(taps));
            if first_row < rows {
                return Some(Position {
                    first_row,
                    groups,
                    indices,
                    weights_before,
                });
            }
            first_row = first_row.wrapping_sub(rows);
            groups = more;
            indices = indices.get(taps..)?;
            weights_before = weights_before.wrapping_add(rows.wrapping_mul(taps));
        }
        None
    }

    /// The groups that have rows of a range, with what of them is wanted.
    pub(super) fn parts(&self, rows: Range<usize>) -> impl Iterator<Item = Part<'a>> + use<'a> {
        let mut wanted = rows.end.saturating_sub(rows.start);
        let mut position = self.find(rows.start);
        core::iter::from_fn(move || {
            let position = position.as_mut().filter(|_| wanted != 0)?;
            let (&[rows, taps], groups) = position.groups.split_first()?;
            let (rows, taps) = (usize::from(rows), usize::from(taps));
            let (indices, more_indices) = position.indices.split_at_checked(taps)?;
            let skipped = core::mem::take(&mut position.first_row);
            let part = Part {
                indices,
                first_weight: position.weights_before,
                rows,
                skipped,
                count: rows.wrapping_sub(skipped).min(wanted),
            };
            wanted = wanted.wrapping_sub(part.count);
            position.groups = groups;
            position.indices = more_indices;
            position.weights_before = part.first_weight.wrapping_add(rows.wrapping_mul(taps));
            Some(part)
        })
    }
}
