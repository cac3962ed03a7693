//! A controller: commands in, a pose on every tick, telemetry out.
//!
//! ```text
//!   bytes -> link::Receiver -> Queue (until their tick) -> Motion -> set-points -> actuators
//!                                                            |
//!                                                        Telemetry -> bytes
//! ```
//!
//! [`Motion`] is a function of the commands and of the ticks before which they took effect, so a run whose commands
//! are recorded with their ticks replays to the same bits, here and on a host. [`Controller`] puts the serial link and
//! its faults around it. Neither allocates, and the time of a tick is bounded.

mod motion;
mod parts;
mod set_point;
mod waiting;

pub use motion::{Memory, Motion, Moved};
pub use parts::{OpenError, Parts};
pub use set_point::{SET_POINT_MOST, set_point};
pub use waiting::{Queue, WAITING_COMMANDS};

use crate::link::{CHANNELS, COMMANDS_A_TICK, Command, Faults, Header, Receiver, Telemetry};

/// What only the board knows.
#[derive(Clone, Copy, Debug, Default)]
pub struct BoardState {
    /// Bytes that the receive ring has lost since the start.
    pub lost_bytes: u32,
    /// Microseconds that the last tick took.
    pub busy_us: u32,
    /// Ticks that the loop has missed since the start.
    pub missed: u32,
    /// The set-points that the outputs hold in this tick: those of the tick before.
    pub outputs: [u16; CHANNELS],
}

/// The controller of one bundle.
pub struct Controller<'a, 'm> {
    motion: Motion<'a, 'm>,
    receiver: Receiver,
    waiting: &'m mut Queue,
    tick: u32,
    rejected: u32,
    silence: u32,
    set_points: [u16; CHANNELS],
}

/// The commands of one tick.
#[derive(Default)]
struct Taken {
    count: u16,
    sequences: [u16; COMMANDS_A_TICK],
}

impl Taken {
    fn note(&mut self, sequence: u16) {
        if let Some(place) = self.sequences.get_mut(usize::from(self.count)) {
            *place = sequence;
            self.count += 1;
        }
    }
}

impl<'a, 'm> Controller<'a, 'm> {
    /// A controller at rest. What waits in `waiting` is forgotten.
    #[must_use]
    pub fn new(motion: Motion<'a, 'm>, waiting: &'m mut Queue) -> Self {
        waiting.clear();
        Controller {
            motion,
            receiver: Receiver::new(),
            waiting,
            tick: 0,
            rejected: 0,
            silence: 0,
            set_points: [0; CHANNELS],
        }
    }

    /// The actuators' set-points after the last tick, for the outputs at the start of the next one.
    #[must_use]
    pub const fn set_points(&self) -> [u16; CHANNELS] {
        self.set_points
    }

    /// One tick: looks at the bytes that have arrived, lets the commands that are due take effect, moves, and says so.
    pub fn tick(&mut self, next: impl FnMut() -> Option<u8>, board: BoardState) -> Telemetry {
        let mut taken = Taken::default();
        self.receive(next, &mut taken);
        let Self {
            waiting, motion, ..
        } = self;
        waiting.take(self.tick, |sequence, command| {
            motion.take(command);
            taken.note(sequence);
        });
        let moved = self.motion.advance();
        self.set_points = moved.set_points;
        let begins = u32::from(moved.silence_begins);
        self.silence = self.silence.saturating_add(begins);
        let telemetry = self.telemetry(&moved, &taken, board);
        self.tick = self.tick.wrapping_add(1);
        telemetry
    }

    fn receive(&mut self, next: impl FnMut() -> Option<u8>, taken: &mut Taken) {
        let Self {
            motion,
            receiver,
            waiting,
            tick,
            rejected,
            ..
        } = self;
        receiver.tick(next, |Header { sequence, due }, command| {
            let is_restart = command == Command::Restart;
            let has_passed = due != 0 && (due < *tick || is_restart);
            if has_passed || !motion.knows(&command) {
                *rejected = rejected.saturating_add(1);
                return true;
            }
            if is_restart {
                // What waits was meant for ticks that no longer come.
                waiting.clear();
                motion.take(&command);
                *tick = 0;
                *taken = Taken::default();
                taken.note(sequence);
                return true;
            }
            let due = due.max(*tick);
            // A restart on this tick is one of its commands, all of which telemetry names.
            let noted = if due == *tick { taken.count } else { 0 };
            let most = COMMANDS_A_TICK.saturating_sub(usize::from(noted));
            waiting.put(due, sequence, command, most)
        });
    }

    fn telemetry(&self, moved: &Moved, taken: &Taken, board: BoardState) -> Telemetry {
        let mut flags = moved.gave_up << Telemetry::GAVE_UP_SHIFT;
        for (flag, is_set) in [
            (Telemetry::HELD, moved.is_held),
            (Telemetry::SILENT, moved.is_silent),
            (Telemetry::HAS_VOLUME, self.motion.parts().volume.is_some()),
            (Telemetry::SATURATED, moved.saturated != 0),
        ] {
            flags |= if is_set { flag } else { 0 };
        }
        Telemetry {
            tick: self.tick,
            host_clock_us: self.motion.host_clock_us(),
            flags,
            pose_hash: moved.pose_hash,
            skin_hash: moved.skin_hash,
            volume: moved.volume,
            effector_error: moved.effector_error,
            busy_us: board.busy_us,
            missed: board.missed,
            faults: Faults {
                overrun: board.lost_bytes,
                rejected: self.rejected,
                silence: self.silence,
                ..*self.receiver.faults()
            },
            accepted: taken.count,
            sequences: taken.sequences,
            outputs: board.outputs,
        }
    }
}
