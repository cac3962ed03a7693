//! Why a rig is unsound, or cannot be posed.

use core::fmt;

/// Why a rig is unsound, or cannot be posed. Nothing is then written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum RigError {
    /// There is no joint, or more than [`JOINTS_AT_MOST`](super::JOINTS_AT_MOST).
    Joints,
    /// A joint does not stand behind its parent.
    Parent {
        /// The joint.
        joint: u32,
    },
    /// A joint's axis has not unit length.
    Axis {
        /// The joint.
        joint: u32,
    },
    /// The parts of the rig do not fit one another.
    Layout,
    /// A control point names a joint that does not exist, or its joints out of order.
    Influence {
        /// The control point.
        point: u32,
    },
    /// The weights of a control point do not add up to one, or one of them is zero.
    Weights {
        /// The control point.
        point: u32,
    },
    /// A slice has another length than the rig needs.
    Length {
        /// Length needed.
        needed: usize,
        /// Length given.
        given: usize,
    },
}

impl fmt::Display for RigError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Joints => write!(f, "a rig has 1 to {} joints", super::JOINTS_AT_MOST),
            Self::Parent { joint } => write!(f, "joint {joint} does not stand behind its parent"),
            Self::Axis { joint } => write!(f, "the axis of joint {joint} has not unit length"),
            Self::Layout => f.write_str("the rig's parts do not fit one another"),
            Self::Influence { point } => write!(
                f,
                "control point {point} names a joint that does not exist, or its joints out of order"
            ),
            Self::Weights { point } => {
                write!(
                    f,
                    "the weights of control point {point} do not add up to one"
                )
            }
            Self::Length { needed, given } => {
                write!(
                    f,
                    "a slice of {needed} elements is needed, {given} were given"
                )
            }
        }
    }
}

impl core::error::Error for RigError {}
