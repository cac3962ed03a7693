//! Why a solver's configuration is unsound, or a call does not fit it.

use core::fmt;

/// Why a solver's configuration is unsound, or a call does not fit it. Nothing is then changed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum InverseError {
    /// No actuators or effectors, or more than 16 and 32.
    Counts,
    /// The lengths of the lists do not fit the numbers of actuators and effectors.
    Layout,
    /// A shift is outside its range.
    Shift,
    /// `H` is not symmetric, or a row's magnitudes add up to more than allowed, or its diagonal is too small.
    Hessian {
        /// The actuator, counted from 0.
        actuator: u32,
    },
    /// The baked reciprocal of a diagonal element is not what the element gives.
    Reciprocal {
        /// The actuator, counted from 0.
        actuator: u32,
    },
    /// The magnitudes of an actuator's gains add up to more than allowed.
    Gains {
        /// The actuator, counted from 0.
        actuator: u32,
    },
    /// The lower bound lies above the upper, or the rate is negative.
    Bounds {
        /// The actuator, counted from 0.
        actuator: u32,
    },
    /// The volume's polynomial has another number of modes than there are actuators.
    Modes {
        /// Actuators.
        needed: usize,
        /// Modes of the polynomial.
        given: usize,
    },
    /// A slice has another length than the solver needs.
    Length {
        /// Length needed.
        needed: usize,
        /// Length given.
        given: usize,
    },
}

impl fmt::Display for InverseError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Counts => f.write_str("a solver takes 1 to 16 actuators and 1 to 32 effectors"),
            Self::Layout => f.write_str("the parts of the solver do not fit one another"),
            Self::Shift => f.write_str("a shift of the solver is outside its range"),
            Self::Hessian { actuator } => write!(
                f,
                "the row of actuator {actuator} is not symmetric, too large, or has too small a diagonal"
            ),
            Self::Reciprocal { actuator } => {
                write!(f, "the reciprocal of actuator {actuator} is wrong")
            }
            Self::Gains { actuator } => {
                write!(f, "the gains of actuator {actuator} are too large")
            }
            Self::Bounds { actuator } => write!(
                f,
                "the bounds of actuator {actuator} are empty, or its rate is negative"
            ),
            Self::Modes { needed, given } => write!(
                f,
                "the volume is baked for {given} modes, the solver for {needed} actuators"
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

impl core::error::Error for InverseError {}
