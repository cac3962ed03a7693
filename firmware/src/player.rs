//! Plays a motion: applies the table to one pose after the other and streams the deformed rows.
//!
//! Everything here is generic over the board: an LED is an `embedded_hal` pin, the serial port an
//! `embedded_io` writer, and what counts instructions is a [`Meter`].

use embedded_hal::digital::{OutputPin, PinState};
use embedded_io::Write;
use octruss::deform::{ApplyError, Table};

use crate::frame::{FrameWriter, WriteError};

/// Rows that are computed before they are sent. Fewer take less memory, more make fewer calls.
pub const ROWS_A_PIECE: usize = 256;

/// Measures what lies between a start and a stop, such as executed instructions.
pub trait Meter {
    /// A measurement begins.
    fn start(&mut self);
    /// The measurement ends; it adds to those before.
    fn stop(&mut self);
}

/// Measures nothing.
impl Meter for () {
    fn start(&mut self) {}
    fn stop(&mut self) {}
}

/// Why a frame was not played.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(target_os = "none", derive(defmt::Format))]
pub enum PlayError<PortError> {
    /// The table cannot be applied to the pose.
    Apply(ApplyError),
    /// The frame cannot be sent.
    Send(WriteError<PortError>),
    /// The LED's pin reports an error.
    Led,
    /// The table has more rows than a frame can say.
    TooManyRows,
}

/// Plays frames of one table.
pub struct Player<'a, Led, Port> {
    table: Table<'a, i32>,
    led: Led,
    port: Port,
    piece: &'a mut [[i32; 3]; ROWS_A_PIECE],
}

impl<'a, Led: OutputPin, Port: Write> Player<'a, Led, Port> {
    /// A player for `table`, with an LED that changes with every frame, the port that frames go
    /// to, and memory for a piece of a frame.
    pub fn new(
        table: Table<'a, i32>,
        led: Led,
        port: Port,
        piece: &'a mut [[i32; 3]; ROWS_A_PIECE],
    ) -> Self {
        Player {
            table,
            led,
            port,
            piece,
        }
    }

    /// Deforms the model with `pose` (raw bits of every control point), sends it as frame
    /// `number` and returns how many coordinates saturated. `meter` runs while the table is
    /// applied, and rests while rows are sent.
    ///
    /// # Errors
    ///
    /// A [`PlayError`]. The frame may have been sent in part.
    pub fn play(
        &mut self,
        number: u32,
        pose: &[[i32; 3]],
        meter: &mut impl Meter,
    ) -> Result<u32, PlayError<Port::Error>> {
        let light = PinState::from(number % 2 == 1);
        self.led.set_state(light).map_err(|_| PlayError::Led)?;

        let rows = self.table.rows();
        let row_count = u32::try_from(rows).map_err(|_| PlayError::TooManyRows)?;
        let mut frame =
            FrameWriter::begin(&mut self.port, number, row_count).map_err(PlayError::Send)?;
        let mut saturated: u32 = 0;
        for start in (0..rows).step_by(ROWS_A_PIECE) {
            let end = rows.min(start + ROWS_A_PIECE);
            let piece = self.piece.get_mut(..end - start).unwrap_or_default();
            meter.start();
            let applied = self.table.apply(start..end, pose, piece);
            meter.stop();
            saturated = saturated.saturating_add(applied.map_err(PlayError::Apply)?);
            frame.rows(piece).map_err(PlayError::Send)?;
        }
        frame.end(saturated).map_err(PlayError::Send)?;
        Ok(saturated)
    }
}
