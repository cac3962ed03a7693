//! The serial link between a host and a running controller: commands one way, telemetry the other.
//!
//! ```text
//!   bytes -> Ring -> Receiver -> Command        on every tick, a bounded number of each
//!                       |
//!                     Faults                    whatever is refused is counted
//!
//!   Telemetry -> wire::encode -> bytes          once a tick
//! ```
//!
//! The bytes are those of `docs/protocol.md`. Everything here runs on the device and on the host alike: no
//! allocation, no panic, a time that is bounded by [`BYTES_A_TICK`] and [`FRAMES_A_TICK`].

mod command;
mod faults;
mod receive;
mod ring;
mod telemetry;
pub mod wire;

pub use command::{Command, CommandError, Goal, Header, MOST_GOALS, MOST_TARGETS, Target};
pub use faults::Faults;
pub use receive::{BYTES_A_TICK, COMMANDS_A_TICK, FRAMES_A_TICK, Receiver};
pub use ring::{Drain, Filler, RING_BYTES, Ring};
pub use telemetry::{CHANNELS, TELEMETRY_BYTES, Telemetry};
