//! Why a volume form is unsound, or cannot be evaluated.

use core::fmt;

/// Why a volume form is unsound, or cannot be evaluated. Nothing is then written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum EnclosedError {
    /// A shift is outside its range.
    Shift,
    /// The region has no control points, or more than 65 535, or one that does not exist.
    Points,
    /// The parts of the form do not fit one another, or name their points out of order.
    Layout {
        /// The pair of control points where it was found, or the mode's index.
        place: u32,
    },
    /// The magnitudes of all weights, or of those of one pair, add up to more than allowed.
    Weights {
        /// The pair, or the number of pairs if it is the sum of all.
        place: u32,
    },
    /// A volume that is not above zero: the solid has no centroid.
    Volume,
    /// A slice has another length than the form needs.
    Length {
        /// Length needed.
        needed: usize,
        /// Length given.
        given: usize,
    },
}

impl fmt::Display for EnclosedError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Shift => f.write_str("a shift of the volume form is outside its range"),
            Self::Points => f.write_str(
                "the volume form's region names a control point that does not exist, or none",
            ),
            Self::Layout { place } => {
                write!(
                    f,
                    "the volume form's parts do not fit one another at {place}"
                )
            }
            Self::Weights { place } => {
                write!(f, "the volume form's weights are too large at {place}")
            }
            Self::Volume => f.write_str("the volume is not above zero: there is no centroid"),
            Self::Length { needed, given } => {
                write!(
                    f,
                    "a slice of {needed} elements is needed, {given} were given"
                )
            }
        }
    }
}

impl core::error::Error for EnclosedError {}
