//! Why the health of a pose cannot be told.

use core::fmt;

use crate::mesh::MeshError;

/// Why the health of a pose cannot be told.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum HealthError {
    /// A cell is unsound.
    Mesh(MeshError),
    /// Rest or pose have another number of points than the cells name.
    Length {
        /// Points needed.
        needed: usize,
        /// Points given.
        given: usize,
    },
    /// The bytes of the cells do not fit their record, or start on an address that is no multiple of 4.
    Layout,
}

impl fmt::Display for HealthError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Mesh(error) => write!(f, "a cell is unsound: {error}"),
            Self::Length { needed, given } => {
                write!(f, "{given} points were given, the cells have {needed}")
            }
            Self::Layout => f.write_str("the bytes of the cells do not fit their record"),
        }
    }
}

impl core::error::Error for HealthError {}
