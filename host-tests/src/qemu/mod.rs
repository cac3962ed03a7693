//! Runs a firmware image in QEMU and brings back what it said.
//!
//! A run passes only if the image logged its end marker last *and* exited with code 0 within
//! the time limit. An emulator that dies by a signal, hangs, or an image that stops half-way is
//! an [`Error`] that holds the end of the log.
//!
//! The image has three ways out: its log (`defmt` over semihosting, decoded here), files in the
//! run's directory (semihosting), and the board's first serial port.
//!
//! ```no_run
//! use octruss_host_tests::qemu::{Machine, Run};
//!
//! let outcome = Run::new(Machine::Mps2An386, "target/thumbv7em-none-eabihf/release/bench")
//!     .instruction_shift(6)
//!     .run()?;
//! for message in &outcome.log.messages {
//!     println!("{:5} {}", message.level, message.text);
//! }
//! # Ok::<(), octruss_host_tests::qemu::Error>(())
//! ```

pub mod conformance;
pub mod controller;
pub mod demo;
mod error;
pub mod holding;
pub mod judge;
mod log;
pub mod palm;

use std::ffi::{OsStr, OsString};
use std::io::{ErrorKind, Read};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

pub use error::{Error, LogTail};
pub use log::{Log, Message};

/// The emulated boards that the images run on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Machine {
    /// Cortex-M3, no floating point unit, no instructions for signal processing.
    Mps2An385,
    /// Cortex-M4 with a floating point unit for single precision.
    Mps2An386,
    /// Cortex-M7 with a floating point unit.
    Mps2An500,
    /// An STM32F405, Cortex-M4. Unlike the others it faults at memory that is not there. It has
    /// none of the other boards' peripherals.
    Netduinoplus2,
}

impl Machine {
    /// The emulator's name of the board.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Machine::Mps2An385 => "mps2-an385",
            Machine::Mps2An386 => "mps2-an386",
            Machine::Mps2An500 => "mps2-an500",
            Machine::Netduinoplus2 => "netduinoplus2",
        }
    }

    /// The board's processor, for people.
    #[must_use]
    pub fn processor(self) -> &'static str {
        match self {
            Machine::Mps2An385 => "Cortex-M3",
            Machine::Mps2An386 | Machine::Netduinoplus2 => "Cortex-M4",
            Machine::Mps2An500 => "Cortex-M7",
        }
    }
}

impl Machine {
    /// Where `cargo xtask` leaves the image `name` for this machine: see [`image`]. A processor without
    /// instructions for signal processing has images of another target, and a board with other
    /// peripherals has images of its own.
    #[must_use]
    pub fn image(self, name: &str) -> PathBuf {
        let common = image(name);
        let up = |levels| common.ancestors().nth(levels).unwrap_or(Path::new("."));
        match self {
            Machine::Mps2An386 | Machine::Mps2An500 => common,
            Machine::Mps2An385 => up(3)
                .join(IMAGE_TARGET_WITHOUT_DSP)
                .join("release")
                .join(name),
            Machine::Netduinoplus2 => up(1).join("netduinoplus2").join(name),
        }
    }
}

/// What a run that passed has left.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// All messages.
    pub log: Log,
    /// What the image sent over the first serial port, if [`Run::capture_serial`] was chosen.
    pub serial: Vec<u8>,
    /// How long it took on this machine.
    pub wall_time: Duration,
}

/// Called with each message as it arrives.
type OnMessage<'a> = Box<dyn FnMut(&Message) + 'a>;

/// A run to be started: the image, the board and the limits.
pub struct Run<'a> {
    emulator: OsString,
    machine: Machine,
    image: PathBuf,
    directory: Option<PathBuf>,
    shift: Option<u8>,
    time_limit: Duration,
    serial_file: Option<PathBuf>,
    serial_tcp: Option<u16>,
    capture_serial: bool,
    on_message: OnMessage<'a>,
}

impl<'a> Run<'a> {
    /// The file in the run's directory that holds the serial port's bytes while they are captured.
    const SERIAL_FILE: &'static str = "serial.bin";

    /// A run of `image` (an ELF file) on `machine`, limited to 60 seconds, in the current
    /// directory, as fast as the emulator goes, its serial port leading nowhere.
    pub fn new(machine: Machine, image: impl Into<PathBuf>) -> Self {
        Run {
            emulator: "qemu-system-arm".into(),
            machine,
            image: image.into(),
            directory: None,
            shift: None,
            time_limit: Duration::from_secs(60),
            serial_file: None,
            serial_tcp: None,
            capture_serial: false,
            on_message: Box::new(|_| {}),
        }
    }

    /// Another program than `qemu-system-arm` from the search path.
    #[must_use]
    pub fn emulator(mut self, program: impl Into<OsString>) -> Self {
        self.emulator = program.into();
        self
    }

    /// Where the files that the image opens through semihosting are.
    #[must_use]
    pub fn directory(mut self, directory: impl Into<PathBuf>) -> Self {
        self.directory = Some(directory.into());
        self
    }

    /// Makes time follow the executed instructions: each takes 2^`shift` nanoseconds, so every
    /// run of the image is the same to the last instruction. 0 to 10.
    #[must_use]
    pub fn instruction_shift(mut self, shift: u8) -> Self {
        self.shift = Some(shift);
        self
    }

    /// The time after which the emulator is stopped.
    #[must_use]
    pub fn time_limit(mut self, limit: Duration) -> Self {
        self.time_limit = limit;
        self
    }

    /// Writes the bytes of the first serial port to `file`.
    #[must_use]
    pub fn serial_to(mut self, file: impl Into<PathBuf>) -> Self {
        self.serial_file = Some(file.into());
        self
    }

    /// Hands the bytes of the first serial port back in [`Outcome::serial`]. They pass through
    /// the file `serial.bin` in the run's directory unless [`Run::serial_to`] names another.
    #[must_use]
    pub fn capture_serial(mut self) -> Self {
        self.capture_serial = true;
        self
    }

    /// Calls `on_message` with each message as it arrives.
    #[must_use]
    pub fn on_message(mut self, on_message: impl FnMut(&Message) + 'a) -> Self {
        self.on_message = Box::new(on_message);
        self
    }

    /// The first serial port is a TCP port of this machine; the emulator waits until somebody connects to it.
    #[must_use]
    pub fn serial_tcp(mut self, port: u16) -> Self {
        self.serial_tcp = Some(port);
        self
    }

    /// The emulator's clock: nothing, or one that follows the instructions. `keeps_pace` lets time pass while the processor
    /// waits, so that a second there is never shorter than one here.
    fn clock(&self, keeps_pace: bool) -> Vec<OsString> {
        let Some(shift) = self.shift else {
            return Vec::new();
        };
        let waits = if keeps_pace { "" } else { ",sleep=off" };
        vec!["-icount".into(), format!("shift={shift}{waits}").into()]
    }

    /// Starts an image that has no end, its first serial port at [`Run::serial_tcp`].
    ///
    /// # Errors
    ///
    /// If the emulator cannot be started.
    pub fn start(mut self) -> Result<Running, Error> {
        let directory = self.directory.take().unwrap_or_else(|| PathBuf::from("."));
        let image = absolute(&self.image)?;
        let table = log::read_table(&image)?;
        let mut port = OsString::from("null");
        if let Some(number) = self.serial_tcp {
            port = format!("tcp:127.0.0.1:{number},server=on,wait=on").into();
        }
        let emulator = Emulator::start(
            &self.emulator,
            &arguments(self.machine, &image, &self.clock(true), &port),
            &directory,
        )?;
        Ok(Running { emulator, table })
    }

    /// Runs the image to its end.
    ///
    /// # Errors
    ///
    /// Everything that is no full success; see [`Error`].
    pub fn run(mut self) -> Result<Outcome, Error> {
        let directory = self.directory.take().unwrap_or_else(|| PathBuf::from("."));
        let image = absolute(&self.image)?;
        let serial = match (self.serial_file.take(), self.capture_serial) {
            (Some(file), _) => Some(absolute(&file)?),
            (None, true) => Some(absolute(&directory.join(Self::SERIAL_FILE))?),
            (None, false) => None,
        };
        let table = log::read_table(&image)?;

        let started = Instant::now();
        let mut emulator = Emulator::start(
            &self.emulator,
            &arguments(
                self.machine,
                &image,
                &self.clock(false),
                &file_port(serial.as_deref()),
            ),
            &directory,
        )?;
        let mut decoder = log::Decoder::new(&table);
        let deadline = started + self.time_limit;
        let listened = emulator.listen(deadline, |bytes| {
            decoder.receive(bytes, &mut self.on_message)
        });
        let log = decoder.log;
        match listened {
            Ok(Heard::Everything) => {}
            Ok(Heard::TimeLimit) => {
                return Err(Error::TimedOut {
                    limit: self.time_limit,
                    log: log.tail(),
                });
            }
            Err(error) => return Err(error),
        }
        let Some((status, printed)) = emulator.wait(deadline)? else {
            return Err(Error::TimedOut {
                limit: self.time_limit,
                log: log.tail(),
            });
        };
        judge(status, printed, &log)?;
        let serial = match serial {
            Some(file) if self.capture_serial => read(&file)?,
            _ => Vec::new(),
        };
        Ok(Outcome {
            log,
            serial,
            wall_time: started.elapsed(),
        })
    }
}

/// An image that runs until it is stopped. Dropping it stops it.
pub struct Running {
    emulator: Emulator,
    table: defmt_decoder::Table,
}

impl Running {
    /// Stops the image and returns what it said.
    ///
    /// # Errors
    ///
    /// If it has ended by itself.
    pub fn stop(mut self) -> Result<Log, Error> {
        let ended = self.emulator.child.try_wait().map_err(Error::NotStarted)?;
        if ended.is_none() {
            self.emulator.child.kill().map_err(Error::NotStarted)?;
        }
        let mut decoder = log::Decoder::new(&self.table);
        let deadline = Instant::now() + Duration::from_secs(10);
        let listened = self.emulator.listen(deadline, |bytes| {
            decoder.receive(bytes, &mut |_: &Message| {})
        });
        let log = decoder.log;
        let Some(status) = ended else {
            // The kill may have cut a message.
            return Ok(log);
        };
        listened?;
        judge(status, String::new(), &log)?;
        Err(Error::NoEndMarker {
            emulator: "the image was to run on and has ended".to_owned(),
            log: log.tail(),
        })
    }
}

/// Decides whether a run that has ended has passed.
fn judge(status: ExitStatus, emulator: String, log: &Log) -> Result<(), Error> {
    match status.code() {
        None => Err(Error::Killed {
            signal: signal_of(status),
            emulator,
            log: log.tail(),
        }),
        Some(0) if log.has_ended() => Ok(()),
        Some(0) => Err(Error::NoEndMarker {
            emulator,
            log: log.tail(),
        }),
        Some(code) => Err(Error::Failed {
            code,
            emulator,
            log: log.tail(),
        }),
    }
}

#[cfg(unix)]
fn signal_of(status: ExitStatus) -> Option<i32> {
    std::os::unix::process::ExitStatusExt::signal(&status)
}

#[cfg(not(unix))]
fn signal_of(_status: ExitStatus) -> Option<i32> {
    None
}

/// The emulator's command line.
fn arguments(machine: Machine, image: &Path, clock: &[OsString], port: &OsStr) -> Vec<OsString> {
    let mut arguments: Vec<OsString> = [
        "-machine",
        machine.name(),
        "-display",
        "none",
        "-monitor",
        "none",
        "-no-reboot",
        // What the image prints goes to the standard output, apart from the emulator's own words.
        "-chardev",
        "stdio,id=console,signal=off",
        "-semihosting-config",
        "enable=on,target=native,chardev=console",
    ]
    .map(OsString::from)
    .to_vec();
    // While the processor waits for an interrupt, time jumps instead of passing, unless the clock keeps pace.
    arguments.extend_from_slice(clock);
    arguments.extend([
        "-serial".into(),
        port.into(),
        "-kernel".into(),
        image.into(),
    ]);
    arguments
}

/// A serial port that goes to a file, or nowhere.
fn file_port(file: Option<&Path>) -> OsString {
    let Some(file) = file else {
        return "null".into();
    };
    let mut port = OsString::from("file:");
    port.push(file);
    port
}

/// The emulator's process, its output read by threads. Dropping it stops it.
struct Emulator {
    child: Child,
    output: Receiver<Vec<u8>>,
    words: Option<JoinHandle<String>>,
}

/// How far the emulator was heard.
enum Heard {
    /// To the end of its output.
    Everything,
    /// To the time limit; it has not ended.
    TimeLimit,
}

impl Emulator {
    fn start(program: &OsStr, arguments: &[OsString], directory: &Path) -> Result<Self, Error> {
        let mut child = Command::new(program)
            .args(arguments)
            .current_dir(directory)
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .map_err(|error| match error.kind() {
                ErrorKind::NotFound if directory.is_dir() => Error::EmulatorMissing,
                _ => Error::NotStarted(error),
            })?;
        let (sender, output) = channel();
        if let Some(mut pipe) = child.stdout.take() {
            thread::spawn(move || {
                let mut buffer = vec![0; 1 << 16];
                while let Ok(count) = pipe.read(&mut buffer) {
                    if count == 0 || sender.send(buffer[..count].to_vec()).is_err() {
                        break;
                    }
                }
            });
        }
        let words = child.stderr.take().map(|mut pipe| {
            thread::spawn(move || {
                let mut bytes = Vec::new();
                // A read that fails keeps what came before it.
                let _ = pipe.read_to_end(&mut bytes);
                String::from_utf8_lossy(&bytes).into_owned()
            })
        });
        Ok(Emulator {
            child,
            output,
            words,
        })
    }

    /// Hands all output to `receive` until the emulator closes it or `deadline` passes.
    fn listen(
        &self,
        deadline: Instant,
        mut receive: impl FnMut(&[u8]) -> Result<(), Error>,
    ) -> Result<Heard, Error> {
        loop {
            let left = deadline.saturating_duration_since(Instant::now());
            match self.output.recv_timeout(left) {
                Ok(bytes) => receive(&bytes)?,
                Err(RecvTimeoutError::Disconnected) => return Ok(Heard::Everything),
                Err(RecvTimeoutError::Timeout) => return Ok(Heard::TimeLimit),
            }
        }
    }

    /// Waits until the process has ended; `None` if `deadline` passes first.
    fn wait(&mut self, deadline: Instant) -> Result<Option<(ExitStatus, String)>, Error> {
        loop {
            if let Some(status) = self.child.try_wait().map_err(Error::NotStarted)? {
                let words = self.words.take().map(JoinHandle::join);
                return Ok(Some((
                    status,
                    words.and_then(Result::ok).unwrap_or_default(),
                )));
            }
            if Instant::now() >= deadline {
                return Ok(None);
            }
            thread::sleep(Duration::from_millis(2));
        }
    }
}

impl Drop for Emulator {
    fn drop(&mut self) {
        // Both fail only if the process has ended already, which is what they are for.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// The target that the images are built for.
pub const IMAGE_TARGET: &str = "thumbv7em-none-eabihf";

/// The target of the images for processors without instructions for signal processing.
pub const IMAGE_TARGET_WITHOUT_DSP: &str = "thumbv7m-none-eabi";

/// Where `cargo xtask` leaves the image `name`: the directory that the variable `OCTRUSS_IMAGES`
/// names, or else that of a release build in this workspace.
#[must_use]
pub fn image(name: &str) -> PathBuf {
    let directory = std::env::var_os("OCTRUSS_IMAGES").map_or_else(
        || {
            // Cargo sets this for what it runs; without it the current directory is the root.
            let package = std::env::var_os("CARGO_MANIFEST_DIR");
            let root =
                package.map_or_else(|| PathBuf::from("."), |at| PathBuf::from(at).join(".."));
            root.join("target").join(IMAGE_TARGET).join("release")
        },
        PathBuf::from,
    );
    directory.join(name)
}

fn absolute(path: &Path) -> Result<PathBuf, Error> {
    std::path::absolute(path).map_err(|source| Error::File {
        action: "find",
        path: path.to_path_buf(),
        source,
    })
}

fn read(path: &Path) -> Result<Vec<u8>, Error> {
    std::fs::read(path).map_err(|source| Error::File {
        action: "read",
        path: path.to_path_buf(),
        source,
    })
}
