//! The controller's own code on the host.

use super::session::Session;
use crate::error::{Error, Result};
use octruss::bundle::Bundle;
use octruss_firmware::controller::{Memory, Motion, Moved, Parts};
use octruss_firmware::link::{CHANNELS, Command, Telemetry};
use octruss_firmware::player::ROWS_A_PIECE;

/// The memory that a [`Mirror`] works in.
pub struct MirrorMemory {
    pose: Vec<[i32; 3]>,
    piece: Box<[[i32; 3]; ROWS_A_PIECE]>,
}

impl MirrorMemory {
    /// Memory for the cage of a bundle.
    #[must_use]
    pub fn of(bundle: &Bundle<'_>) -> Self {
        MirrorMemory {
            pose: vec![[0; 3]; bundle.rest_cage().len()],
            piece: Box::new([[0; 3]; ROWS_A_PIECE]),
        }
    }
}

/// What the device must answer, tick by tick.
pub struct Mirror<'a, 'm> {
    motion: Motion<'a, 'm>,
    outputs: Option<[u16; CHANNELS]>,
    tick: u32,
    compared: u64,
    mismatches: u64,
    first: Option<String>,
}

impl<'a, 'm> Mirror<'a, 'm> {
    /// The controller of a bundle, at rest.
    ///
    /// # Errors
    /// If the bundle has not what a controller needs.
    pub fn new(bundle: &Bundle<'a>, memory: &'m mut MirrorMemory) -> Result<Self> {
        let parts = Parts::open(bundle).map_err(|error| Error::new(error.to_string()))?;
        let MirrorMemory { pose, piece } = memory;
        let motion = Motion::new(parts, Memory { pose, piece })
            .ok_or_else(|| Error::new("the memory is that of another bundle"))?;
        Ok(Mirror {
            motion,
            outputs: None,
            tick: 0,
            compared: 0,
            mismatches: 0,
            first: None,
        })
    }

    /// What it runs on.
    #[must_use]
    pub fn parts(&self) -> &Parts<'a> {
        self.motion.parts()
    }

    /// Records that were compared.
    #[must_use]
    pub fn compared(&self) -> u64 {
        self.compared
    }

    /// Values that were not the host's.
    #[must_use]
    pub fn mismatches(&self) -> u64 {
        self.mismatches
    }

    /// The first value that was not the host's.
    #[must_use]
    pub fn first_mismatch(&self) -> Option<&str> {
        self.first.as_deref()
    }

    /// Lets commands take effect and moves on by a tick.
    pub fn advance<'c>(&mut self, commands: impl IntoIterator<Item = &'c Command>) -> Moved {
        for command in commands {
            if *command == Command::Restart {
                self.tick = 0;
            }
            self.motion.take(command);
        }
        let moved = self.motion.advance();
        self.tick = self.tick.wrapping_add(1);
        moved
    }

    /// Takes the commands that a record says took effect, moves on and compares. Ticks whose records were lost are made
    /// up for, as long as no command took effect on them. Returns the commands.
    ///
    /// # Errors
    /// If the record names commands that were not sent, or lies in the past.
    pub fn follow(&mut self, record: &Telemetry, session: &Session) -> Result<Vec<Command>> {
        let count = usize::from(record.accepted).min(record.sequences.len());
        let mut commands = Vec::new();
        for sequence in &record.sequences[..count] {
            let command = session.command(*sequence).ok_or_else(|| {
                Error::new(format!(
                    "on tick {} the command {sequence} took effect, which was not sent from here",
                    record.tick
                ))
                .advise("only one program may drive a controller")
            })?;
            commands.push(command.clone());
        }
        if commands.first() == Some(&Command::Restart) {
            self.tick = record.tick;
        }
        if record.tick < self.tick {
            return Err(Error::new(format!(
                "tick {} came after tick {}: the controller was started anew",
                record.tick,
                self.tick.wrapping_sub(1)
            )));
        }
        while self.tick < record.tick {
            self.outputs = Some(self.advance([]).set_points);
        }
        let moved = self.advance(&commands);
        self.compare(record, &moved);
        self.outputs = Some(moved.set_points);
        Ok(commands)
    }

    fn compare(&mut self, record: &Telemetry, moved: &Moved) {
        self.compared += 1;
        let outputs = self.outputs.unwrap_or(record.outputs);
        let own_flags = record.flags >> Telemetry::GAVE_UP_SHIFT;
        let is = |flag| u64::from(record.flags & flag != 0);
        let pairs = [
            (
                "the pose's checksum",
                u64::from(record.pose_hash),
                u64::from(moved.pose_hash),
            ),
            (
                "the model's checksum",
                u64::from(record.skin_hash),
                u64::from(moved.skin_hash),
            ),
            (
                "the volume",
                record.volume.cast_unsigned(),
                moved.volume.cast_unsigned(),
            ),
            (
                "the effectors' error",
                u64::from(record.effector_error),
                u64::from(moved.effector_error),
            ),
            (
                "what was given up",
                u64::from(own_flags),
                u64::from(moved.gave_up),
            ),
            (
                "whether the pose is held",
                is(Telemetry::HELD),
                u64::from(moved.is_held),
            ),
            (
                "whether the host is silent",
                is(Telemetry::SILENT),
                u64::from(moved.is_silent),
            ),
            (
                "whether coordinates were clamped",
                is(Telemetry::SATURATED),
                u64::from(moved.saturated != 0),
            ),
        ];
        let differing = pairs.iter().filter(|(_, device, host)| device != host);
        for (what, device, host) in differing {
            self.mismatches += 1;
            self.first.get_or_insert_with(|| {
                format!(
                    "on tick {} {what} is {device} on the device and {host} here",
                    record.tick
                )
            });
        }
        for (channel, (device, host)) in record.outputs.iter().zip(outputs).enumerate() {
            if *device != host {
                self.mismatches += 1;
                self.first.get_or_insert_with(|| {
                    format!(
                        "on tick {} the output of channel {channel} is {device} on the device and {host} here",
                        record.tick
                    )
                });
            }
        }
    }
}
