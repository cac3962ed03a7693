//! Why limits are unsound, or a call does not fit them.

use core::fmt;

use crate::enclosed::EnclosedError;

/// Why limits are unsound, or a call does not fit them. Nothing is then changed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum ProjectError {
    /// There are no control points, or more than 65 535.
    Points,
    /// The lists of the limits do not fit one another or the bytes that they lie in.
    Layout,
    /// A box is empty: its lower end lies above its upper.
    Box {
        /// The control point, counted from 0.
        point: u32,
    },
    /// A mobility is more than [`MOBILITY_ONE`](super::MOBILITY_ONE).
    Mobility {
        /// The control point, counted from 0.
        point: u32,
    },
    /// More regions than [`MOST_REGIONS`](super::MOST_REGIONS).
    Regions {
        /// Regions given.
        given: usize,
    },
    /// A region names a control point twice.
    RepeatedPoint {
        /// The control point, counted from 0.
        point: u32,
    },
    /// A slice has another length than the limits need, or a scratch is shorter.
    Length {
        /// Length needed.
        needed: usize,
        /// Length given.
        given: usize,
    },
    /// The form of a region's volume does not fit the pose.
    Enclosed(EnclosedError),
}

impl fmt::Display for ProjectError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Points => f.write_str("limits are for 1 to 65535 control points"),
            Self::Layout => f.write_str("the parts of the limits do not fit one another"),
            Self::Box { point } => write!(f, "the box of control point {point} is empty"),
            Self::Mobility { point } => {
                write!(f, "the mobility of control point {point} is more than one")
            }
            Self::Regions { given } => write!(f, "{given} regions were given, at most 4 are held"),
            Self::RepeatedPoint { point } => {
                write!(f, "a region names control point {point} twice")
            }
            Self::Length { needed, given } => {
                write!(
                    f,
                    "a slice of {needed} elements is needed, {given} were given"
                )
            }
            Self::Enclosed(error) => write!(f, "a region's volume does not fit: {error}"),
        }
    }
}

impl core::error::Error for ProjectError {}
