//! Why actuators are unsound, or a call does not fit them.

use core::fmt;

/// Why actuators are unsound, or a call does not fit them. Nothing is then changed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum ActuationError {
    /// No actuators, or more than 16, or more than 32 effectors.
    Counts,
    /// The bytes do not fit their record, or the lists the number of control points.
    Layout,
    /// The magnitudes of a coordinate's displacements add up to more than
    /// [`DISPLACEMENT_LIMIT`](super::DISPLACEMENT_LIMIT).
    Displacement {
        /// The control point, counted from 0.
        point: u32,
    },
    /// An effector is none of the table's rows.
    Row {
        /// The effector, counted from 0.
        effector: u32,
    },
    /// A slice has another length than is needed.
    Length {
        /// Length needed.
        needed: usize,
        /// Length given.
        given: usize,
    },
}

impl fmt::Display for ActuationError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Counts => f.write_str("there are 1 to 16 actuators and up to 32 effectors"),
            Self::Layout => f.write_str("the parts of the actuators do not fit one another"),
            Self::Displacement { point } => write!(
                f,
                "control point {point} is displaced too far for the device's sums"
            ),
            Self::Row { effector } => {
                write!(f, "effector {effector} is none of the table's rows")
            }
            Self::Length { needed, given } => {
                write!(f, "a slice has {given} elements, {needed} are needed")
            }
        }
    }
}

impl core::error::Error for ActuationError {}
