//! What a host asks of a controller.

use heapless::Vec;

use super::wire::{PAYLOAD_BYTES, Reader};

/// Goals in one frame at most.
pub const MOST_GOALS: usize = 12;
/// Actuators' targets in one frame at most.
pub const MOST_TARGETS: usize = 16;

/// Where an effector is to go.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Goal {
    /// The effector, counted from 0 in the order of the bundle's solver.
    pub effector: u16,
    /// The place, raw bits of the bundle's fixed-point format.
    pub place: [i32; 3],
}

/// Where an actuator is to go: within its rate, and no further than its bounds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Target {
    /// The channel, counted from 0.
    pub channel: u8,
    /// The amplitude of the channel's mode, 30 fraction bits.
    pub amplitude: i32,
}

/// A command.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Command {
    /// Effectors' goals; the others keep theirs.
    Goals(Vec<Goal, MOST_GOALS>),
    /// Actuators' targets; the others keep theirs.
    Actuators(Vec<Target, MOST_TARGETS>),
    /// Stay where you are.
    Hold,
    /// Nothing but a sign of life; telemetry answers, as it does on every tick.
    Query,
    /// The host's clock, which telemetry sends back, and after how many ticks of silence the pose is held; 0 for
    /// never.
    Watch {
        /// The host's clock in microseconds, modulo 2^32.
        host_clock_us: u32,
        /// Ticks of silence.
        silence_ticks: u32,
    },
    /// Back to rest at once, with this tick counted as 0; what waits is forgotten, and its header's tick must be 0. The
    /// one command that is accepted with any sequence number but the last one's: with it a host that has come back
    /// begins anew.
    Restart,
}

/// What every command starts with.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Header {
    /// Counts the host's frames, modulo 2^16.
    pub sequence: u16,
    /// The tick at whose start the command is to take effect; 0 for the next one.
    pub due: u32,
}

/// Why a sound payload is no command.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CommandError;

impl Command {
    const GOALS: u8 = 1;
    const ACTUATORS: u8 = 2;
    const HOLD: u8 = 3;
    const QUERY: u8 = 4;
    const WATCH: u8 = 5;
    const RESTART: u8 = 6;

    /// Reads a payload.
    ///
    /// # Errors
    ///
    /// [`CommandError`] if the command is unknown or its body is not as long as it must be.
    pub fn read(payload: &[u8]) -> Result<(Header, Command), CommandError> {
        let mut reader = Reader(payload);
        Self::parse(&mut reader)
            .filter(|_| reader.0.is_empty())
            .ok_or(CommandError)
    }

    fn parse(reader: &mut Reader<'_>) -> Option<(Header, Command)> {
        let header = Header {
            sequence: reader.half()?,
            due: reader.word()?,
        };
        let command = match reader.byte()? {
            Self::GOALS => {
                let mut goals = Vec::new();
                for _ in 0..reader.byte()? {
                    let effector = reader.half()?;
                    let place = [reader.signed()?, reader.signed()?, reader.signed()?];
                    goals.push(Goal { effector, place }).ok()?;
                }
                Command::Goals(goals)
            }
            Self::ACTUATORS => {
                let mut targets = Vec::new();
                for _ in 0..reader.byte()? {
                    let (channel, amplitude) = (reader.byte()?, reader.signed()?);
                    let target = Target { channel, amplitude };
                    targets.push(target).ok()?;
                }
                Command::Actuators(targets)
            }
            Self::HOLD => Command::Hold,
            Self::QUERY => Command::Query,
            Self::WATCH => Command::Watch {
                host_clock_us: reader.word()?,
                silence_ticks: reader.word()?,
            },
            Self::RESTART => Command::Restart,
            _ => return None,
        };
        Some((header, command))
    }

    /// The payload of the command.
    #[must_use]
    pub fn payload(&self, header: Header) -> Vec<u8, PAYLOAD_BYTES> {
        let mut out = Vec::new();
        // The longest command fits: the test below writes it.
        let mut put = |bytes: &[u8]| {
            let _ = out.extend_from_slice(bytes);
        };
        put(&header.sequence.to_le_bytes());
        put(&header.due.to_le_bytes());
        match self {
            Command::Goals(goals) => {
                put(&[Self::GOALS, goals.len() as u8]);
                for goal in goals {
                    put(&goal.effector.to_le_bytes());
                    goal.place.iter().for_each(|bits| put(&bits.to_le_bytes()));
                }
            }
            Command::Actuators(targets) => {
                put(&[Self::ACTUATORS, targets.len() as u8]);
                for target in targets {
                    put(&[target.channel]);
                    put(&target.amplitude.to_le_bytes());
                }
            }
            Command::Hold => put(&[Self::HOLD]),
            Command::Query => put(&[Self::QUERY]),
            Command::Watch {
                host_clock_us,
                silence_ticks,
            } => {
                put(&[Self::WATCH]);
                put(&host_clock_us.to_le_bytes());
                put(&silence_ticks.to_le_bytes());
            }
            Command::Restart => put(&[Self::RESTART]),
        }
        out
    }
}
