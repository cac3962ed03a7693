//! Groups: rows that share their control points.

/// The groups of a table and the control points that each of them names.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Groups<'a> {
    /// For each group its rows and its taps.
    pub groups: &'a [[u16; 2]],
    /// The control points of the first group, then of the second, and so on.
    pub indices: &'a [u16],
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
}
