//! A pose's health: the cells that it folds over, and how far it is from that.
//!
//! A cell is looked at through the volumes of small tetrahedra in it, six times each, as determinants of differences of
//! control points:
//!
//! | cell | tetrahedra |
//! | --- | --- |
//! | tetrahedron | itself |
//! | octahedron | eight, from its centroid to its faces (taken six times as large, so that the centroid is a sum) |
//! | prism | six, a corner and its three neighbours each |
//! | hexahedron | eight, a corner and its three neighbours each |
//!
//! A tetrahedron that is positive at rest *folds* where it is not positive in the pose. Its *ratio* is its volume in the
//! pose over that at rest: 1 at rest, 0 where it folds, and the least of all says how far the pose is from folding. One
//! that is not positive at rest has no ratio; how many there are is told.
//!
//! A prism or a hexahedron whose faces bend can fold inside while all its corners are positive, so a healthy report is a
//! statement about corners; a folded one is always true.
//!
//! Determinants are exact. The rest's are computed on every call again: a call needs no memory but for its report, and
//! the bundle none but for the cells ([`Bundle::health`](crate::bundle::Bundle::health)).
//!
//! ```
//! use octruss::control::health::{Health, RATIO_ONE};
//! use octruss::mesh::Solid;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let cells = Solid { vertex_count: 4, tetrahedra: &[[0, 1, 2, 3]], ..Solid::default() };
//! let rest = [[0, 0, 0], [100, 0, 0], [0, 100, 0], [0, 0, 100]];
//! let health = Health::new_checked(cells, &rest)?;
//! let mut pose = rest;
//! pose[3] = [0, 0, 25];
//! let report = health.of(&pose)?;
//! assert_eq!((report.folded, report.least_ratio), (0, RATIO_ONE / 4));
//! pose[3] = [7, 7, -1];
//! assert_eq!(health.of(&pose)?.folded, 1);
//! # Ok(())
//! # }
//! ```

mod corners;
mod error;
mod section;
#[cfg(test)]
mod tests;

use heapless::Vec;

use crate::coord::Coordinate;
use crate::mesh::Solid;

pub use error::HealthError;
pub use section::CellsRecord;

/// A ratio of one: ratios have 16 fraction bits.
pub const RATIO_ONE: i32 = 1 << 16;

/// Ratios are told up to four.
pub const RATIO_LIMIT: i32 = RATIO_ONE << 2;

/// Folded cells that a report names at most; all are counted.
pub const MOST_NAMED: usize = 8;

/// A kind of cells.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Shape {
    /// Tetrahedra.
    Tetrahedron,
    /// Octahedra.
    Octahedron,
    /// Prisms.
    Prism,
    /// Hexahedra.
    Hexahedron,
}

/// A cell by its shape and its place among the cells of that shape, counted from 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Cell {
    /// The shape.
    pub shape: Shape,
    /// The place.
    pub index: u32,
}

/// What is told of a pose.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct HealthReport {
    /// How many cells fold over.
    pub folded: u32,
    /// The first of them: tetrahedra, octahedra, prisms, hexahedra, each in order.
    pub first: Vec<Cell, MOST_NAMED>,
    /// The least ratio, 16 fraction bits, rounded; at most [`RATIO_LIMIT`]. A ratio below `-2^15` is told as `-2^31`.
    pub least_ratio: i32,
    /// The first cell with the least ratio; `None` if no ratio is below [`RATIO_LIMIT`].
    pub least: Option<Cell>,
    /// Tetrahedra of the table above that are not positive at rest.
    pub without_ratio: u32,
}

/// The cells of a cage and their rest.
#[derive(Clone, Copy, Debug)]
pub struct Health<'a> {
    cells: Solid<'a>,
    rest: &'a [[i32; 3]],
}

impl<'a> Health<'a> {
    /// Takes cells (surfaces, creases and corners do not matter) and the control points at rest, raw bits.
    ///
    /// # Errors
    ///
    /// [`HealthError::Mesh`] if a cell names a vertex that is not there, or one twice; [`HealthError::Length`] if the rest
    /// has another number of points.
    pub fn new_checked(cells: Solid<'a>, rest: &'a [[i32; 3]]) -> Result<Self, HealthError> {
        cells.check().map_err(HealthError::Mesh)?;
        let needed = usize::try_from(cells.vertex_count).unwrap_or(usize::MAX);
        let given = rest.len();
        if needed != given {
            return Err(HealthError::Length { needed, given });
        }
        Ok(Self { cells, rest })
    }

    /// The cells.
    #[must_use]
    pub const fn cells(&self) -> &Solid<'a> {
        &self.cells
    }

    /// Looks at a pose.
    ///
    /// # Scaling and overflow
    ///
    /// Edges are below `2^32`, those of an octahedron's tetrahedra are six points less the sum of six: below `6 * 2^32`.
    /// A determinant adds up six products of three, below `6^4 * 2^96 < 2^107`. Ratios are compared without a
    /// division, as `2^17` times one determinant against at most `2^19` times another: below `2^126`, in 128 bits.
    ///
    /// # Errors
    ///
    /// [`HealthError::Length`] if the pose has another number of points.
    pub fn of<C: Coordinate>(&self, pose: &[[C; 3]]) -> Result<HealthReport, HealthError> {
        let (needed, given) = (self.rest.len(), pose.len());
        if needed != given {
            return Err(HealthError::Length { needed, given });
        }
        Ok(corners::report(&self.cells, self.rest, C::bits_of(pose)))
    }
}
