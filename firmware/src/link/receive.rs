//! Bytes in, commands out, faults counted.

use super::command::{Command, Header};
use super::faults::{Faults, count};
use super::wire::{self, ENCODED_BYTES, WireError};

/// Bytes that are looked at in one tick.
pub const BYTES_A_TICK: usize = 2048;
/// Commands that arrive in one tick; more are refused as a flood. A host that sends ahead of time may have been late
/// for a few ticks and then send what belongs to all of them.
pub const FRAMES_A_TICK: usize = 32;
/// Commands that take effect on one tick.
pub const COMMANDS_A_TICK: usize = 8;

/// The receiving end of the link.
pub struct Receiver {
    bytes: [u8; ENCODED_BYTES],
    length: usize,
    is_oversize: bool,
    last: Option<u16>,
    faults: Faults,
}

impl Default for Receiver {
    fn default() -> Self {
        Self::new()
    }
}

impl Receiver {
    /// Has heard nothing yet, and takes whatever sequence number comes first.
    #[must_use]
    pub const fn new() -> Self {
        Receiver {
            bytes: [0; ENCODED_BYTES],
            length: 0,
            is_oversize: false,
            last: None,
            faults: Faults {
                truncated: 0,
                checksum: 0,
                oversize: 0,
                unknown: 0,
                repeated: 0,
                out_of_order: 0,
                skipped: 0,
                flood: 0,
                overrun: 0,
                rejected: 0,
                silence: 0,
            },
        }
    }

    /// What was refused so far.
    #[must_use]
    pub fn faults(&self) -> &Faults {
        &self.faults
    }

    /// Looks at what has arrived: at most [`BYTES_A_TICK`] bytes out of `next`, at most [`FRAMES_A_TICK`] commands
    /// handed to `accept`. `accept` returns false for a command that it has no room for, which counts as a flood.
    pub fn tick(
        &mut self,
        mut next: impl FnMut() -> Option<u8>,
        mut accept: impl FnMut(Header, Command) -> bool,
    ) {
        let mut room = FRAMES_A_TICK;
        for _ in 0..BYTES_A_TICK {
            let Some(byte) = next() else { break };
            if byte != 0 {
                self.keep(byte);
                continue;
            }
            let Some((header, command)) = self.end_of_frame() else {
                continue;
            };
            if room > 0 && accept(header, command) {
                room -= 1;
            } else {
                count(&mut self.faults.flood);
            }
        }
    }

    fn keep(&mut self, byte: u8) {
        match self.bytes.get_mut(self.length) {
            Some(place) => {
                *place = byte;
                self.length += 1;
            }
            None => self.is_oversize = true,
        }
    }

    /// A zero has come: judges what lies before it. Nothing between two zeros is no fault.
    fn end_of_frame(&mut self) -> Option<(Header, Command)> {
        let length = core::mem::take(&mut self.length);
        if core::mem::take(&mut self.is_oversize) {
            count(&mut self.faults.oversize);
            return None;
        }
        if length == 0 {
            return None;
        }
        let payload = match wire::decode(self.bytes.get_mut(..length)?) {
            Ok(payload) => payload,
            Err(WireError::Truncated) => {
                count(&mut self.faults.truncated);
                return None;
            }
            Err(WireError::Checksum) => {
                count(&mut self.faults.checksum);
                return None;
            }
        };
        let Ok((header, command)) = Command::read(payload) else {
            count(&mut self.faults.unknown);
            return None;
        };
        self.is_next(header.sequence, &command)
            .then_some((header, command))
    }

    /// Whether a sequence number follows the last one; half of all numbers lie ahead, half have passed.
    fn is_next(&mut self, sequence: u16, command: &Command) -> bool {
        const HALF: u16 = 1 << 15;
        if let Some(last) = self.last {
            let ahead = sequence.wrapping_sub(last);
            if ahead == 0 {
                count(&mut self.faults.repeated);
                return false;
            }
            if *command != Command::Restart {
                if ahead >= HALF {
                    count(&mut self.faults.out_of_order);
                    return false;
                }
                let skipped = u32::from(ahead - 1);
                self.faults.skipped = self.faults.skipped.saturating_add(skipped);
            }
        }
        self.last = Some(sequence);
        true
    }
}
