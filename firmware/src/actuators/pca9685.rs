//! PCA9685 of NXP: sixteen channels of pulses of 12 bits, over I2C.
//!
//! Registers are those of the data sheet (revision 4). The chip takes over what was written when the transfer stops
//! (bit OCH of MODE2 is 0 after a reset), so one transfer changes all channels together.

use embedded_hal::i2c::I2c;

use crate::controller::SET_POINT_MOST;
use crate::link::CHANNELS;

const MODE1: u8 = 0x00;
const LED0_ON_L: u8 = 0x06;
const PRE_SCALE: u8 = 0xfe;
/// MODE1: the register's address goes up by itself.
const AUTO_INCREMENT: u8 = 1 << 5;
/// MODE1: the oscillator stands; the only state in which the prescaler can be set.
const SLEEP: u8 = 1 << 4;
/// Bit 4 of a channel's high bytes: all on, or all off.
const WHOLE: u8 = 1 << 4;
/// Counts of a period.
const PERIOD: u16 = 4096;
/// The chip's oscillator in hertz.
const OSCILLATOR_HZ: u32 = 25_000_000;
/// The register's address and four bytes a channel.
const TRANSFER_BYTES: usize = 1 + 4 * CHANNELS;

/// Which part of a period the output is on for, in 4096ths: `low` at set-point 0, `high` at the greatest.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Pulse {
    low: u16,
    high: u16,
}

/// A pulse that is no pulse: it ends beyond the period, or its low end lies above its high one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PulseError;

impl Pulse {
    /// From never on to always on, as valves and heaters take it.
    pub const WHOLE: Pulse = Pulse {
        low: 0,
        high: PERIOD,
    };
    /// 1 to 2 ms of a period of 20 ms, as servos take it (with a rate of 50 Hz): 204.8 and 409.6 counts, rounded.
    pub const SERVO: Pulse = Pulse {
        low: 205,
        high: 410,
    };

    /// A pulse of `low` to `high` counts, of 4096 in a period.
    ///
    /// # Errors
    ///
    /// [`PulseError`].
    pub const fn new(low: u16, high: u16) -> Result<Pulse, PulseError> {
        if low > high || high > PERIOD {
            return Err(PulseError);
        }
        Ok(Pulse { low, high })
    }

    /// `low + floor((high - low) * set_point / 4095 + 1/2)`.
    fn counts(self, set_point: u16) -> u16 {
        let most = u32::from(SET_POINT_MOST);
        let way = u32::from(self.high - self.low) * u32::from(set_point.min(SET_POINT_MOST));
        // At most `high`.
        self.low + ((2 * way + most) / (2 * most)) as u16
    }
}

/// The chip.
pub struct Pca9685<Bus> {
    bus: Bus,
    address: u8,
    pulse: Pulse,
}

impl<Bus: I2c> Pca9685<Bus> {
    /// The address with all address pins low.
    pub const ADDRESS: u8 = 0x40;

    /// Starts the chip at `address` (7 bits) with `rate_hz` periods a second; the chip does 24 to 1526, and what lies
    /// outside is cut to that. All channels are off until they are [set](Self::set).
    ///
    /// # Errors
    ///
    /// The bus's own; the chip may be asleep then.
    pub fn start(bus: Bus, address: u8, pulse: Pulse, rate_hz: u32) -> Result<Self, Bus::Error> {
        let mut chip = Pca9685 {
            bus,
            address,
            pulse,
        };
        // round(oscillator / (4096 * rate)) - 1, from 3 to 255.
        let divisor = u32::from(PERIOD).saturating_mul(rate_hz.max(1));
        let prescale = (OSCILLATOR_HZ.saturating_add(divisor / 2) / divisor)
            .saturating_sub(1)
            .clamp(3, 255) as u8;
        chip.write(&[MODE1, AUTO_INCREMENT | SLEEP])?;
        chip.write(&[PRE_SCALE, prescale])?;
        chip.write_counts([0; CHANNELS])?;
        // The oscillator needs 500 us; until then the outputs stay off, which they are.
        chip.write(&[MODE1, AUTO_INCREMENT])?;
        Ok(chip)
    }

    /// Sets all channels together.
    ///
    /// # Errors
    ///
    /// The bus's own; the outputs are then what they were.
    pub fn set(&mut self, set_points: &[u16; CHANNELS]) -> Result<(), Bus::Error> {
        let pulse = self.pulse;
        self.write_counts(set_points.map(|set_point| pulse.counts(set_point)))
    }

    /// Gives the bus back; the chip goes on.
    pub fn release(self) -> Bus {
        self.bus
    }

    /// The bus, for what the chip does not do by itself.
    pub fn bus(&self) -> &Bus {
        &self.bus
    }

    fn write_counts(&mut self, counts: [u16; CHANNELS]) -> Result<(), Bus::Error> {
        let mut bytes = [0; TRANSFER_BYTES];
        if let Some((address, channels)) = bytes.split_first_mut() {
            *address = LED0_ON_L;
            let (channels, _) = channels.as_chunks_mut::<4>();
            for (own, count) in channels.iter_mut().zip(counts) {
                let [low, high] = count.to_le_bytes();
                // On from the start of the period; the whole-bits win over the counts.
                *own = match count {
                    0 => [0, 0, 0, WHOLE],
                    PERIOD.. => [0, WHOLE, 0, 0],
                    _ => [0, 0, low, high],
                };
            }
        }
        self.write(&bytes)
    }

    fn write(&mut self, bytes: &[u8]) -> Result<(), Bus::Error> {
        self.bus.write(self.address, bytes)
    }
}
