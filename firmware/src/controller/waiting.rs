//! Commands that wait for their tick.

use heapless::Vec;

use crate::link::Command;

/// Commands that wait at most: enough for a host that sends 16 ticks ahead, with goals of all effectors on each.
pub const WAITING_COMMANDS: usize = 64;

/// A command that has been accepted.
#[derive(Clone, Debug)]
struct Waiting {
    due: u32,
    sequence: u16,
    command: Command,
}

/// Commands that wait for their tick, in the order in which they came. It takes 14 KiB, so it has a place of its own and
/// not one on the stack.
#[derive(Default)]
pub struct Queue(Vec<Waiting, WAITING_COMMANDS>);

impl Queue {
    /// Nothing waits.
    #[must_use]
    pub const fn new() -> Self {
        Queue(Vec::new())
    }

    /// Puts a command in. False if there is no room, or if `most` wait for its tick.
    pub(super) fn put(&mut self, due: u32, sequence: u16, command: Command, most: usize) -> bool {
        let on_the_same_tick = self.0.iter().filter(|waiting| waiting.due == due).count();
        let waiting = Waiting {
            due,
            sequence,
            command,
        };
        on_the_same_tick < most && self.0.push(waiting).is_ok()
    }

    /// Hands the commands of `tick` to `take`, the first that came first, and forgets them.
    pub(super) fn take(&mut self, tick: u32, mut take: impl FnMut(u16, &Command)) {
        self.0.retain(|waiting| {
            if waiting.due == tick {
                take(waiting.sequence, &waiting.command);
            }
            waiting.due != tick
        });
    }

    pub(super) fn clear(&mut self) {
        self.0.clear();
    }
}
