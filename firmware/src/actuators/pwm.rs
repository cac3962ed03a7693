//! Outputs of timers, one for each channel.

use embedded_hal::pwm::SetDutyCycle;

use crate::controller::SET_POINT_MOST;

/// Outputs of timers, the first for the first channel. Channels beyond the outputs lead nowhere.
pub struct PwmActuators<Output, const N: usize> {
    outputs: [Output; N],
}

impl<Output: SetDutyCycle, const N: usize> PwmActuators<Output, N> {
    /// Takes the outputs. They stay as they are until they are [set](Self::set).
    pub const fn new(outputs: [Output; N]) -> Self {
        PwmActuators { outputs }
    }

    /// Sets the outputs, from never on at 0 to always on at the greatest set-point.
    ///
    /// # Errors
    ///
    /// That of the first output that cannot be set; those behind it stay as they were.
    pub fn set(&mut self, set_points: &[u16]) -> Result<(), Output::Error> {
        for (output, set_point) in self.outputs.iter_mut().zip(set_points) {
            let part = (*set_point).min(SET_POINT_MOST);
            output.set_duty_cycle_fraction(part, SET_POINT_MOST)?;
        }
        Ok(())
    }

    /// Gives the outputs back.
    pub fn release(self) -> [Output; N] {
        self.outputs
    }
}
