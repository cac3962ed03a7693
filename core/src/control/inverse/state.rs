//! What a solver remembers from tick to tick.

use super::config::{Inverse, MOST_ACTUATORS};
use super::pace::Pace;

/// What a solver remembers from tick to tick, in the caller's memory. One configuration serves many states.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct InverseState {
    /// Amplitudes with 30 fraction bits; those beyond the actuators are 0.
    pub(super) amplitudes: [i32; MOST_ACTUATORS],
    /// `y`: how the free amplitudes answer to the multiplier, in units of `2^-20` amplitudes' last places.
    pub(super) answer: [i32; MOST_ACTUATORS],
    /// The volume's multiplier.
    pub(super) multiplier: i64,
    /// Bits by which the volume's gradient was rounded when the multiplier and `y` were found.
    pub(super) gradient_shift: i32,
    /// How much of a step is taken.
    pub(super) pace: Pace,
}

impl InverseState {
    /// At rest: every amplitude is zero, or its nearest bound.
    #[must_use]
    pub fn new(inverse: &Inverse<'_>) -> Self {
        let mut state = Self {
            amplitudes: [0; MOST_ACTUATORS],
            answer: [0; MOST_ACTUATORS],
            multiplier: 0,
            gradient_shift: 0,
            pace: Pace::WHOLE,
        };
        let bounds = inverse.parts.lower.iter().zip(inverse.parts.upper);
        for (amplitude, (&lower, &upper)) in state.amplitudes.iter_mut().zip(bounds) {
            *amplitude = 0.max(lower).min(upper);
        }
        state
    }

    /// The amplitudes, one for each actuator, with 30 fraction bits. Those beyond the actuators are 0.
    #[must_use]
    pub const fn amplitudes(&self) -> &[i32; MOST_ACTUATORS] {
        &self.amplitudes
    }

    /// Sets where the actuators are, such as what was measured of them. The next tick starts from there, and if it
    /// lies outside the bounds it goes back towards them at the greatest rate. Amplitudes that are missing stay.
    pub fn set_amplitudes(&mut self, amplitudes: &[i32]) {
        for (own, &new) in self.amplitudes.iter_mut().zip(amplitudes) {
            *own = new.max(-i32::MAX);
        }
        self.pace = Pace::WHOLE;
    }
}
