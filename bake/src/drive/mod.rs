//! The host's end of a running controller: sends commands, reads telemetry, and knows on every tick what the device
//! must answer.
//!
//! * [`port`]: the line, a TCP connection (an emulator's serial port) or a serial port.
//! * [`session`]: frames both ways, sequence numbers, what was sent.
//! * [`mirror`]: the controller's own code on the host, fed with the commands that telemetry says took effect; every
//!   hash, volume and set-point is compared.
//! * [`goals`]: where effectors shall go, tick by tick.
//! * [`record`]: runs as files, to be replayed to the same bits.
//! * [`run`](mod@run): one run from the restart to the last tick.
//! * [`report`]: what it came to.

pub mod goals;
pub mod mirror;
pub mod port;
pub mod record;
pub mod report;
pub mod run;
pub mod session;
