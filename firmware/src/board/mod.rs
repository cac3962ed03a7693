//! The boards that the images run on: one file each, chosen by a feature.
//!
//! A board file gives the images what they need from hardware, as traits:
//!
//! - `Board::take()`: everything below, once;
//! - `Board::led`: an `embedded_hal::digital::OutputPin`;
//! - `Board::serial`: an `embedded_io::Write` and `embedded_io::Read`;
//! - `Board::delay`: an `embedded_hal::delay::DelayNs`;
//! - `Board::tick`: a [`Tick`](crate::tick::Tick), the fixed period of the control loop;
//! - `Board::serial.listen(filler)`: from then on an interrupt puts the bytes that arrive into a ring;
//! - `on_interrupt(number)`: handles one of the board's own interrupts, false if it is not one.

mod received;

#[cfg(feature = "board-mps2")]
mod mps2;
#[cfg(feature = "board-mps2")]
pub use mps2::Board;
#[cfg(feature = "board-mps2")]
pub(crate) use mps2::on_interrupt;

#[cfg(feature = "board-netduinoplus2")]
mod netduinoplus2;
#[cfg(feature = "board-netduinoplus2")]
pub use netduinoplus2::Board;
#[cfg(feature = "board-netduinoplus2")]
pub(crate) use netduinoplus2::on_interrupt;

#[cfg(not(any(feature = "board-mps2", feature = "board-netduinoplus2")))]
compile_error!("choose a board: a feature whose name starts with `board-`");

#[cfg(all(feature = "board-mps2", feature = "board-netduinoplus2"))]
compile_error!(
    "choose one board: `--no-default-features` takes away the one that is chosen otherwise"
);
