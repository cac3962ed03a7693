//! The memory that a projection works in.

use super::error::ProjectError;
use super::report::RegionGoal;

/// The memory that a projection works in, lent by the caller. Contents before and after mean nothing; longer
/// slices than needed do.
#[derive(Debug)]
pub struct ProjectScratch<'a> {
    /// Lower ends of the boxes of this call: an element for each control point.
    pub lower: &'a mut [[i32; 3]],
    /// Upper ends.
    pub upper: &'a mut [[i32; 3]],
    /// The pose so far.
    pub current: &'a mut [[i32; 3]],
    /// The pose that is tried.
    pub candidate: &'a mut [[i32; 3]],
    /// What the multipliers add to each coordinate.
    pub forces: &'a mut [[i64; 3]],
    /// Reduced gradients: [`ScratchLengths::gradients`] elements.
    pub gradients: &'a mut [[i32; 3]],
    /// Differences of a form: [`ScratchLengths::form`] elements.
    pub form_workspace: &'a mut [[i32; 3]],
    /// The gradient of a form: [`ScratchLengths::form`] elements.
    pub form_gradient: &'a mut [[i64; 3]],
}

/// Elements that a scratch needs beside one for each control point.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ScratchLengths {
    /// The points of all regions together.
    pub gradients: usize,
    /// The points of the largest region.
    pub form: usize,
}

impl ScratchLengths {
    /// For these regions.
    #[must_use]
    pub fn of(regions: &[RegionGoal<'_>]) -> Self {
        let mut lengths = Self::default();
        for region in regions {
            let points = region.form.points().len();
            lengths.gradients = lengths.gradients.saturating_add(points);
            lengths.form = lengths.form.max(points);
        }
        lengths
    }
}

impl<'a> ProjectScratch<'a> {
    /// Cuts every slice to what is needed.
    pub(super) fn cut(self, points: usize, lengths: ScratchLengths) -> Result<Self, ProjectError> {
        Ok(Self {
            lower: first(self.lower, points)?,
            upper: first(self.upper, points)?,
            current: first(self.current, points)?,
            candidate: first(self.candidate, points)?,
            forces: first(self.forces, points)?,
            gradients: first(self.gradients, lengths.gradients)?,
            form_workspace: first(self.form_workspace, lengths.form)?,
            form_gradient: first(self.form_gradient, lengths.form)?,
        })
    }
}

fn first<T>(slice: &mut [T], needed: usize) -> Result<&mut [T], ProjectError> {
    let given = slice.len();
    slice
        .get_mut(..needed)
        .ok_or(ProjectError::Length { needed, given })
}
