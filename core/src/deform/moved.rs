//! Partial updates: only rows that a moved control point has a part in.

/// What a partial update did.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Updated {
    /// Rows that were computed; the others were left as they were.
    pub rows: usize,
    /// Coordinates of these that were out of range and saturated.
    pub saturated: u32,
}

/// Which control points have moved.
#[derive(Clone, Copy, Debug)]
pub(super) enum Moved<'a> {
    /// Any may have.
    All,
    /// Those marked, one mark for each control point.
    Marked(&'a [bool]),
}

impl Moved<'_> {
    /// Whether a control point of this group has moved.
    #[inline(always)]
    pub(super) fn any_of(self, indices: &[u16]) -> bool {
        match self {
            Self::All => true,
            Self::Marked(marks) => indices
                .iter()
                .any(|&index| marks.get(usize::from(index)).copied().unwrap_or(true)),
        }
    }
}
