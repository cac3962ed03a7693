//! The registers of a PCA9685 where there is no chip: what a driver writes can be read back.

use core::convert::Infallible;

use embedded_hal::i2c::{ErrorType, I2c, Operation};

use crate::link::CHANNELS;

const REGISTERS: usize = 256;
const FIRST_CHANNEL: usize = 0x06;
/// The register that no transfer goes beyond by itself.
const LAST: usize = 0x45;
const WHOLE: u8 = 1 << 4;

/// The memory of a chip that takes what is written to any address. Telemetry carries what it holds, so that the bytes
/// that a driver sent are checked where no pulse can be measured.
pub struct Pca9685Registers {
    registers: [u8; REGISTERS],
    at: u8,
}

impl Default for Pca9685Registers {
    fn default() -> Self {
        Self::new()
    }
}

impl Pca9685Registers {
    /// All zero.
    #[must_use]
    pub const fn new() -> Self {
        Pca9685Registers {
            registers: [0; REGISTERS],
            at: 0,
        }
    }

    /// For how many of 4096 counts each channel is on.
    #[must_use]
    pub fn counts(&self) -> [u16; CHANNELS] {
        let mut counts = [0; CHANNELS];
        let channels = self.registers.get(FIRST_CHANNEL..).unwrap_or_default();
        let (channels, _) = channels.as_chunks::<4>();
        for (count, &[on_low, on_high, off_low, off_high]) in counts.iter_mut().zip(channels) {
            let on = u16::from_le_bytes([on_low, on_high & 15]);
            let off = u16::from_le_bytes([off_low, off_high & 15]);
            *count = if off_high & WHOLE != 0 {
                0
            } else if on_high & WHOLE != 0 {
                4096
            } else {
                off.saturating_sub(on)
            };
        }
        counts
    }

    fn next(&mut self) -> Option<&mut u8> {
        let at = usize::from(self.at);
        // From the last channel's last register the address goes back to the first register.
        self.at = if at == LAST {
            0
        } else {
            self.at.wrapping_add(1)
        };
        self.registers.get_mut(at)
    }
}

impl ErrorType for Pca9685Registers {
    type Error = Infallible;
}

impl I2c for Pca9685Registers {
    fn transaction(
        &mut self,
        _address: u8,
        operations: &mut [Operation<'_>],
    ) -> Result<(), Infallible> {
        for operation in operations {
            match operation {
                Operation::Write(bytes) => {
                    let Some((at, values)) = bytes.split_first() else {
                        continue;
                    };
                    self.at = *at;
                    for value in values {
                        if let Some(register) = self.next() {
                            *register = *value;
                        }
                    }
                }
                Operation::Read(bytes) => {
                    for byte in bytes.iter_mut() {
                        *byte = self.next().map_or(0, |register| *register);
                    }
                }
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Pca9685, Pulse};
    use super::Pca9685Registers;

    #[test]
    fn what_the_driver_writes_is_read_back() {
        let bus = Pca9685Registers::new();
        let pulse = Pulse::new(0, 4095).unwrap();
        let mut chip = Pca9685::start(bus, 0x40, pulse, 50).unwrap();
        assert_eq!(chip.bus().counts(), [0; 16]);
        let mut set_points = [0; 16];
        for (channel, own) in (0..).zip(&mut set_points) {
            *own = 273 * channel;
        }
        chip.set(&set_points).unwrap();
        assert_eq!(chip.bus().counts(), set_points);
        let chip = Pca9685::start(chip.release(), 0x40, Pulse::WHOLE, 50);
        let mut chip = chip.unwrap();
        chip.set(&[4095; 16]).unwrap();
        assert_eq!(chip.release().counts(), [4096; 16]);
    }
}
