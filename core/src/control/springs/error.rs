//! Why springs are unsound, or cannot be moved.

use core::fmt;

/// Why springs are unsound, or cannot be moved. Nothing is then written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum SpringsError {
    /// The parts of the springs do not fit one another.
    Layout,
    /// Substeps, drag, damping, the shift of pushes or gravity are outside their ranges.
    Settings,
    /// A factor of a control point is greater than one.
    Point {
        /// The control point.
        point: u32,
    },
    /// A spring names a point that does not exist, or twice the same, or two pinned ones, or one of its
    /// numbers is outside its range.
    Spring {
        /// The spring.
        spring: u32,
    },
    /// An obstacle's normal has not unit length, or its grip is greater than one.
    Obstacle {
        /// The obstacle.
        obstacle: u32,
    },
    /// A slice has another length than there are control points.
    Length {
        /// Length needed.
        needed: usize,
        /// Length given.
        given: usize,
    },
}

impl fmt::Display for SpringsError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Layout => f.write_str("the springs' parts do not fit one another"),
            Self::Settings => f.write_str(
                "substeps, drag, damping, the shift of pushes or gravity are outside their ranges",
            ),
            Self::Point { point } => {
                write!(f, "a factor of control point {point} is greater than one")
            }
            Self::Spring { spring } => write!(
                f,
                "spring {spring} has no two control points that it can move, or a number outside its range"
            ),
            Self::Obstacle { obstacle } => write!(
                f,
                "the normal of obstacle {obstacle} has not unit length, or its grip is greater than one"
            ),
            Self::Length { needed, given } => {
                write!(
                    f,
                    "a slice of {needed} elements is needed, {given} were given"
                )
            }
        }
    }
}

impl core::error::Error for SpringsError {}
