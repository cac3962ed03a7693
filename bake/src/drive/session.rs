//! Frames both ways.

use super::port::{Port, is_timeout};
use crate::error::{Error, Result};
use octruss_firmware::link::wire::{self, ENCODED_BYTES};
use octruss_firmware::link::{Command, Header, Telemetry};
use std::collections::VecDeque;
use std::io::{Read, Write};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::thread;
use std::time::Duration;

/// Commands that are remembered after they were sent: more than wait on a device, in the ring and on the line together.
const REMEMBERED: usize = 4096;
/// How long a controller may say nothing.
const PATIENCE: Duration = Duration::from_secs(10);

/// One end of the link.
pub struct Session {
    output: Box<dyn Write + Send>,
    records: Receiver<Heard>,
    stop: Arc<AtomicBool>,
    sequence: u16,
    sent: VecDeque<(u16, Command)>,
    spoilt: u64,
}

/// What came over the line.
enum Heard {
    Record(Box<Telemetry>),
    /// A frame that is none.
    Spoilt,
    /// The line has ended.
    End(String),
}

impl Session {
    /// Listens to a port. The first command will have the number behind `sequence`.
    #[must_use]
    pub fn new(port: Port, sequence: u16) -> Self {
        let (sender, records) = channel();
        let stop = Arc::new(AtomicBool::new(false));
        let stopped = Arc::clone(&stop);
        let input = port.input;
        thread::spawn(move || listen(input, &sender, &stopped));
        Session {
            output: port.output,
            records,
            stop,
            sequence,
            sent: VecDeque::new(),
            spoilt: 0,
        }
    }

    /// Sends a command, to take effect at the start of tick `due`, or of the next one if that is 0.
    ///
    /// # Errors
    /// If the line is broken.
    pub fn send(&mut self, command: Command, due: u32) -> Result<usize> {
        self.sequence = self.sequence.wrapping_add(1);
        let header = Header {
            sequence: self.sequence,
            due,
        };
        let bytes = frame(&command.payload(header));
        self.sent.push_back((self.sequence, command));
        if self.sent.len() > REMEMBERED {
            self.sent.pop_front();
        }
        self.send_bytes(&bytes)?;
        Ok(bytes.len())
    }

    /// Sends bytes as they are, right or wrong.
    ///
    /// # Errors
    /// If the line is broken.
    pub fn send_bytes(&mut self, bytes: &[u8]) -> Result<()> {
        self.output
            .write_all(bytes)
            .and_then(|()| self.output.flush())
            .map_err(|error| Error::new(format!("the controller cannot be reached: {error}")))
    }

    /// The last sequence number that was sent.
    #[must_use]
    pub fn sequence(&self) -> u16 {
        self.sequence
    }

    /// Frames that came and were not telemetry.
    #[must_use]
    pub fn spoilt(&self) -> u64 {
        self.spoilt
    }

    /// The command that was last sent with a sequence number.
    #[must_use]
    pub fn command(&self, sequence: u16) -> Option<&Command> {
        let found = self.sent.iter().rev().find(|(own, _)| *own == sequence);
        found.map(|(_, command)| command)
    }

    /// The next record of telemetry.
    ///
    /// # Errors
    /// If none comes for ten seconds, or the line ends.
    pub fn receive(&mut self) -> Result<Telemetry> {
        loop {
            match self.records.recv_timeout(PATIENCE) {
                Ok(Heard::Record(record)) => return Ok(*record),
                Ok(Heard::Spoilt) => self.spoilt += 1,
                Ok(Heard::End(why)) => {
                    return Err(Error::new(format!(
                        "the line to the controller has ended: {why}"
                    )));
                }
                Err(RecvTimeoutError::Timeout) => {
                    return Err(
                        Error::new("the controller has said nothing for ten seconds")
                            .advise("is it the right port, and does the image `controller` run?"),
                    );
                }
                Err(RecvTimeoutError::Disconnected) => {
                    return Err(Error::new("the line to the controller has ended"));
                }
            }
        }
    }
}

impl Drop for Session {
    fn drop(&mut self) {
        self.stop.store(true, Ordering::Relaxed);
    }
}

/// A payload as it goes over the line, the zero behind it included.
#[must_use]
pub fn frame(payload: &[u8]) -> Vec<u8> {
    let mut bytes = [0; ENCODED_BYTES + 1];
    // Commands fit: the link's tests write the longest.
    let length = wire::encode(payload, &mut bytes).unwrap_or(0);
    bytes[..length].to_vec()
}

/// Reads until the line ends or nobody wants to know.
fn listen(mut input: Box<dyn Read + Send>, sender: &Sender<Heard>, stop: &AtomicBool) {
    let mut bytes = [0; 4096];
    let mut open = Vec::new();
    // What comes before the first zero may be half a frame.
    let mut is_in_step = false;
    while !stop.load(Ordering::Relaxed) {
        let count = match input.read(&mut bytes) {
            Ok(0) => {
                let _ = sender.send(Heard::End("the other side has closed it".to_owned()));
                return;
            }
            Ok(count) => count,
            Err(error) if is_timeout(&error) => continue,
            Err(error) => {
                let _ = sender.send(Heard::End(error.to_string()));
                return;
            }
        };
        for byte in &bytes[..count] {
            if *byte != 0 {
                open.push(*byte);
                continue;
            }
            let record = wire::decode(&mut open).ok().and_then(Telemetry::read);
            let heard = match record {
                Some(record) => Heard::Record(Box::new(record)),
                None => Heard::Spoilt,
            };
            open.clear();
            let is_wanted = is_in_step || matches!(heard, Heard::Record(_));
            is_in_step = true;
            if is_wanted && sender.send(heard).is_err() {
                return;
            }
        }
    }
}
