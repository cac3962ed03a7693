//! The line to a controller.

use crate::error::{Error, Result};
use std::io::{ErrorKind, Read, Write};
use std::net::{TcpStream, ToSocketAddrs};
use std::thread;
use std::time::{Duration, Instant};

/// How long a read waits before the reader looks up.
const READ_TIMEOUT: Duration = Duration::from_millis(50);
/// How long a connection is tried.
const CONNECT_TIME: Duration = Duration::from_secs(10);

/// Both directions of a line.
pub struct Port {
    /// Bytes that come.
    pub input: Box<dyn Read + Send>,
    /// Bytes that go.
    pub output: Box<dyn Write + Send>,
}

/// Connects to `address` (host and port), such as an emulator's serial port. It is tried for ten seconds, because an
/// emulator that was just started may not listen yet.
///
/// # Errors
/// If the address is none or nobody listens there.
pub fn tcp(address: &str) -> Result<Port> {
    let failed = |what: &dyn std::fmt::Display| {
        Error::new(format!("cannot connect to {address}: {what}"))
            .advise("give HOST:PORT, and start the emulator with -serial tcp:HOST:PORT,server=on")
    };
    let places: Vec<_> = address
        .to_socket_addrs()
        .map_err(|error| failed(&error))?
        .collect();
    let begun = Instant::now();
    loop {
        match TcpStream::connect(&places[..]) {
            Ok(stream) => return of_stream(&stream).map_err(|error| failed(&error)),
            Err(error) if begun.elapsed() > CONNECT_TIME => return Err(failed(&error)),
            Err(_) => thread::sleep(Duration::from_millis(20)),
        }
    }
}

fn of_stream(stream: &TcpStream) -> std::io::Result<Port> {
    // Commands are small and must not wait for one another.
    stream.set_nodelay(true)?;
    stream.set_read_timeout(Some(READ_TIMEOUT))?;
    Ok(Port {
        input: Box::new(stream.try_clone()?),
        output: Box::new(stream.try_clone()?),
    })
}

/// Opens a serial port, with 8 data bits, no parity and one stop bit.
///
/// # Errors
/// If the port is not there or does not do the rate.
pub fn serial(path: &str, baud: u32) -> Result<Port> {
    let failed = |error: serialport::Error| {
        Error::new(format!("cannot open the port {path}: {error}"))
            .advise("give the port that the board is at, such as /dev/ttyACM0 or COM3")
    };
    let port = serialport::new(path, baud)
        .timeout(READ_TIMEOUT)
        .open()
        .map_err(failed)?;
    Ok(Port {
        input: Box::new(port.try_clone().map_err(failed)?),
        output: port,
    })
}

/// Whether a read has only waited long enough.
#[must_use]
pub fn is_timeout(error: &std::io::Error) -> bool {
    matches!(
        error.kind(),
        ErrorKind::WouldBlock | ErrorKind::TimedOut | ErrorKind::Interrupted
    )
}
