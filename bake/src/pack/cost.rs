//! What a group of rows costs on a Cortex-M4, in instructions.
//!
//! The figures come from the kernels' code (`core/src/deform/kernel/cortex_m.rs`) and from counting around
//! them; they decide what is worth merging and which form of a table is taken, not any result.

use super::Layout;

/// Instructions of a group, of each of its control points, of each row, and of each tap of a row.
#[derive(Clone, Copy, Debug)]
pub struct Cost {
    group: f64,
    point: f64,
    row: f64,
    tap: f64,
    /// A row without a partner, in formats that take rows in pairs.
    single_row: f64,
    single_tap: f64,
    paired: bool,
}

impl Cost {
    /// The cost of a layout.
    pub fn of(layout: Layout) -> Self {
        match layout {
            Layout::Q30 | Layout::Q14 => Self {
                group: 150.0,
                point: 10.0,
                row: 17.0,
                tap: 5.0,
                single_row: 17.0,
                single_tap: 5.0,
                paired: false,
            },
            Layout::Compact { .. } => Self {
                group: 160.0,
                point: 9.0,
                row: 8.5,
                tap: 2.0,
                single_row: 60.0,
                single_tap: 6.0,
                paired: true,
            },
        }
    }

    /// Taps of a group that names so many points.
    pub fn taps(&self, points: usize) -> usize {
        if self.paired {
            points.next_multiple_of(2)
        } else {
            points
        }
    }

    /// Instructions of a row with so many taps, in whatever group it may be: no fewer.
    pub fn row_at_least(&self, taps: usize) -> f64 {
        self.row + self.tap * taps as f64
    }

    /// Instructions of a group.
    pub fn group(&self, rows: usize, points: usize) -> f64 {
        let taps = self.taps(points) as f64;
        let singles = if self.paired { rows % 2 } else { 0 };
        let others = (rows - singles) as f64;
        self.group
            + self.point * taps
            + others * (self.row + self.tap * taps)
            + singles as f64 * (self.single_row + self.single_tap * taps)
    }
}
