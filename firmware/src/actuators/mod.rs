//! Where set-points leave: drivers of real parts over the traits of `embedded_hal`.
//!
//! A controller writes the set-points of a tick at the start of the next one, all at once, so outputs change at a fixed
//! phase and never hold a part of one pose and a part of another.

mod pca9685;
mod pwm;
mod registers;

pub use pca9685::{Pca9685, Pulse, PulseError};
pub use pwm::PwmActuators;
pub use registers::Pca9685Registers;
