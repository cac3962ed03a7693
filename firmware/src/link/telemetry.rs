//! What a controller says of itself on every tick.

use heapless::Vec;

use super::faults::Faults;
use super::receive::COMMANDS_A_TICK;
use super::wire::Reader;

/// Actuator channels.
pub const CHANNELS: usize = 16;
/// Bytes of a record.
pub const TELEMETRY_BYTES: usize = 44 + 4 * Faults::COUNT + 2 * COMMANDS_A_TICK + 2 * CHANNELS;

/// One tick's record.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Telemetry {
    /// Ticks since the start or the last restart.
    pub tick: u32,
    /// The host's clock, as it was last told.
    pub host_clock_us: u32,
    /// Bit 0: the pose is held. Bit 1: because the host is silent. Bit 2: the bundle has a volume. Bit 3: a coordinate
    /// did not fit. From bit 8: what the solver gave up.
    pub flags: u32,
    /// CRC-32 of the pose's raw bits, little-endian.
    pub pose_hash: u32,
    /// CRC-32 of the deformed points' raw bits, little-endian.
    pub skin_hash: u32,
    /// The enclosed volume in the unit of the bundle's form.
    pub volume: i64,
    /// The greatest distance of a coordinate from its goal, raw bits.
    pub effector_error: u32,
    /// Microseconds that the last tick took, or 0 if nothing measures them.
    pub busy_us: u32,
    /// Ticks that the loop has missed.
    pub missed: u32,
    /// What was refused.
    pub faults: Faults,
    /// How many commands took effect on this tick.
    pub accepted: u16,
    /// Their sequence numbers, in order; the rest is zero.
    pub sequences: [u16; COMMANDS_A_TICK],
    /// The set-points that the outputs hold in this tick, 12 bits each: those of the tick before, because outputs
    /// change at the start of a tick.
    pub outputs: [u16; CHANNELS],
}

impl Telemetry {
    /// Bit of [`flags`](Telemetry::flags): the pose is held.
    pub const HELD: u32 = 1;
    /// Bit of [`flags`](Telemetry::flags): the host is silent.
    pub const SILENT: u32 = 2;
    /// Bit of [`flags`](Telemetry::flags): the volume is one.
    pub const HAS_VOLUME: u32 = 4;
    /// Bit of [`flags`](Telemetry::flags): a coordinate of a control point or of the model did not fit and was clamped.
    pub const SATURATED: u32 = 8;
    /// The lowest bit of [`flags`](Telemetry::flags) that tells what the solver gave up: the bits of
    /// `octruss::control::inverse::GaveUp` from here.
    pub const GAVE_UP_SHIFT: u32 = 8;

    /// The payload of the record.
    #[must_use]
    pub fn payload(&self) -> Vec<u8, TELEMETRY_BYTES> {
        let mut out = Vec::new();
        // The record is as long as the vector.
        let mut put = |bytes: &[u8]| {
            let _ = out.extend_from_slice(bytes);
        };
        for word in [
            self.tick,
            self.host_clock_us,
            self.flags,
            self.pose_hash,
            self.skin_hash,
        ] {
            put(&word.to_le_bytes());
        }
        put(&self.volume.to_le_bytes());
        for word in [self.effector_error, self.busy_us, self.missed] {
            put(&word.to_le_bytes());
        }
        for word in self.faults.values() {
            put(&word.to_le_bytes());
        }
        put(&u32::from(self.accepted).to_le_bytes());
        for half in self.sequences.iter().chain(&self.outputs) {
            put(&half.to_le_bytes());
        }
        out
    }

    /// Reads a payload. `None` if it has another length.
    #[must_use]
    pub fn read(payload: &[u8]) -> Option<Self> {
        let mut reader = Reader(payload);
        let mut telemetry = Telemetry {
            tick: reader.word()?,
            host_clock_us: reader.word()?,
            flags: reader.word()?,
            pose_hash: reader.word()?,
            skin_hash: reader.word()?,
            volume: reader.array().map(i64::from_le_bytes)?,
            effector_error: reader.word()?,
            busy_us: reader.word()?,
            missed: reader.word()?,
            ..Telemetry::default()
        };
        let mut values = [0; Faults::COUNT];
        for value in &mut values {
            *value = reader.word()?;
        }
        telemetry.faults = Faults::from_values(values);
        telemetry.accepted = u16::try_from(reader.word()?).ok()?;
        let Telemetry {
            sequences, outputs, ..
        } = &mut telemetry;
        for half in sequences.iter_mut().chain(outputs) {
            *half = reader.half()?;
        }
        reader.0.is_empty().then_some(telemetry)
    }
}
