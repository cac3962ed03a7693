//! What can go wrong while an image runs in the emulator, in words that say what to do.

use std::fmt;
use std::io;
use std::path::PathBuf;
use std::time::Duration;

use octruss_firmware::exit::Ending;

/// Why a run did not pass. Each holds what is needed to find the cause without running again.
#[derive(Debug)]
pub enum Error {
    /// `qemu-system-arm` is not installed or not on the search path.
    EmulatorMissing,
    /// The emulator is there and did not start.
    NotStarted(io::Error),
    /// A file of the run cannot be read or written.
    File {
        /// What was to be done with it.
        action: &'static str,
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: io::Error,
    },
    /// The file is no image whose log can be decoded.
    NotAnImage {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        reason: String,
    },
    /// The emulator was stopped because the time limit had passed.
    TimedOut {
        /// The limit.
        limit: Duration,
        /// The end of the log.
        log: LogTail,
    },
    /// A signal ended the emulator: it crashed, or somebody stopped it.
    Killed {
        /// The signal's number, where the system has signals.
        signal: Option<i32>,
        /// What the emulator itself printed.
        emulator: String,
        /// The end of the log.
        log: LogTail,
    },
    /// The image, or the emulator, ended with an exit code that means failure.
    Failed {
        /// The code.
        code: i32,
        /// What the emulator itself printed.
        emulator: String,
        /// The end of the log.
        log: LogTail,
    },
    /// The image ended with exit code 0 but its last message was not the end marker.
    NoEndMarker {
        /// What the emulator itself printed.
        emulator: String,
        /// The end of the log.
        log: LogTail,
    },
    /// The image wrote to the log what is no `defmt` message of this very image.
    LogCorrupt {
        /// The end of the log before that place.
        log: LogTail,
    },
}

/// The last messages of a log, kept for an error.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct LogTail(pub Vec<String>);

impl LogTail {
    /// How many messages an error keeps.
    pub const LINES: usize = 20;
}

impl fmt::Display for LogTail {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.0.is_empty() {
            return write!(f, "The image logged nothing.");
        }
        write!(f, "The end of its log:")?;
        self.0.iter().try_for_each(|line| write!(f, "\n  {line}"))
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Error::EmulatorMissing => {
                write!(f, "qemu-system-arm is missing: run `cargo xtask setup`")
            }
            Error::NotStarted(source) => write!(f, "qemu-system-arm does not start: {source}"),
            Error::File {
                action,
                path,
                source,
            } => write!(f, "cannot {action} {}: {source}", path.display()),
            Error::NotAnImage { path, reason } => {
                write!(f, "{} is no image to run: {reason}", path.display())
            }
            Error::TimedOut { limit, log } => write!(
                f,
                "the image did not end within {} s and was stopped. {log}",
                limit.as_secs_f32()
            ),
            Error::Killed {
                signal,
                emulator,
                log,
            } => {
                match signal {
                    Some(signal) => write!(f, "signal {signal} ended qemu-system-arm.")?,
                    None => write!(f, "qemu-system-arm ended without an exit code.")?,
                }
                write!(f, "{} {log}", said(emulator))
            }
            Error::Failed {
                code,
                emulator,
                log,
            } => {
                match Ending::from_code(*code) {
                    Some(ending) => write!(f, "{} (exit code {code}).", ending.describe())?,
                    None => write!(f, "qemu-system-arm ended with exit code {code}.")?,
                }
                write!(f, "{} {log}", said(emulator))
            }
            Error::NoEndMarker { emulator, log } => write!(
                f,
                "the image ended without its end marker, so not all of it ran.{} {log}",
                said(emulator)
            ),
            Error::LogCorrupt { log } => write!(
                f,
                "the log holds bytes that are no message of this image: something else printed \
                 through semihosting, or the file changed while it ran. {log}"
            ),
        }
    }
}

/// The emulator's own words as a sentence, or nothing if it said nothing.
fn said(emulator: &str) -> String {
    match emulator.trim() {
        "" => String::new(),
        words => format!(" It printed:\n{words}\n"),
    }
}

impl std::error::Error for Error {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            Error::NotStarted(source) | Error::File { source, .. } => Some(source),
            _ => None,
        }
    }
}
