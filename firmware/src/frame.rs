//! Deformed frames on a serial line: how they are written and how they are read.
//!
//! A stream is frames one behind the other, with nothing between them. All numbers are
//! little-endian:
//!
//! | bytes | what |
//! | --- | --- |
//! | 4 | the letters `OCTF` |
//! | 4 | number of the frame, unsigned, counted from 0 |
//! | 4 | number of rows n, unsigned |
//! | 12 n | the rows in the bundle's order: x, y and z of a model point each, signed 32-bit raw bits of the bundle's fixed-point format |
//! | 4 | how many of these coordinates saturated, unsigned |
//! | 4 | CRC-32 of all bytes before it (the polynomial of Ethernet and ZIP, CRC-32/ISO-HDLC) |
//!
//! The count of saturated coordinates follows the rows because it is known only when they are:
//! a device sends rows while it computes the next ones and needs no memory for a whole frame.

use crc::{CRC_32_ISO_HDLC, Crc, Digest};
use embedded_io::Write;

/// The four bytes that every frame starts with.
pub const MAGIC: [u8; 4] = *b"OCTF";
/// Bytes before the rows.
pub const HEADER_BYTES: usize = 12;
/// Bytes of one row.
pub const ROW_BYTES: usize = 12;
/// Bytes behind the rows.
pub const TRAILER_BYTES: usize = 8;

/// A `static`, so that the table it looks up lies in flash once.
pub(crate) static CHECKSUM: Crc<u32> = Crc::<u32>::new(&CRC_32_ISO_HDLC);

/// Writes one frame.
///
/// Call [`begin`](FrameWriter::begin), then [`rows`](FrameWriter::rows) as often as needed, then
/// [`end`](FrameWriter::end).
pub struct FrameWriter<'a, Port: Write> {
    port: &'a mut Port,
    checksum: Digest<'static, u32>,
    rows_left: u32,
}

/// Why a frame was not written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(target_os = "none", derive(defmt::Format))]
pub enum WriteError<E> {
    /// The serial port reports an error.
    Port(E),
    /// The rows handed over are not as many as announced.
    RowCount,
}

impl<'a, Port: Write> FrameWriter<'a, Port> {
    /// Sends the start of frame `number`, which will have `rows` rows.
    ///
    /// # Errors
    ///
    /// The port's own.
    pub fn begin(
        port: &'a mut Port,
        number: u32,
        rows: u32,
    ) -> Result<Self, WriteError<Port::Error>> {
        let mut writer = FrameWriter {
            port,
            checksum: CHECKSUM.digest(),
            rows_left: rows,
        };
        writer.send(&MAGIC)?;
        writer.send(&number.to_le_bytes())?;
        writer.send(&rows.to_le_bytes())?;
        Ok(writer)
    }

    /// Sends the next rows.
    ///
    /// # Errors
    ///
    /// The port's own; [`WriteError::RowCount`] if they are more than announced.
    pub fn rows(&mut self, rows: &[[i32; 3]]) -> Result<(), WriteError<Port::Error>> {
        let count = u32::try_from(rows.len()).map_err(|_| WriteError::RowCount)?;
        self.rows_left = self
            .rows_left
            .checked_sub(count)
            .ok_or(WriteError::RowCount)?;
        for row in rows {
            let mut bytes = [0; ROW_BYTES];
            for (place, coordinate) in bytes.chunks_exact_mut(4).zip(row) {
                place.copy_from_slice(&coordinate.to_le_bytes());
            }
            self.send(&bytes)?;
        }
        Ok(())
    }

    /// Sends the end of the frame.
    ///
    /// # Errors
    ///
    /// The port's own; [`WriteError::RowCount`] if rows are missing.
    pub fn end(mut self, saturated: u32) -> Result<(), WriteError<Port::Error>> {
        if self.rows_left != 0 {
            return Err(WriteError::RowCount);
        }
        self.send(&saturated.to_le_bytes())?;
        let checksum = self.checksum.finalize();
        let port = self.port;
        port.write_all(&checksum.to_le_bytes())
            .map_err(WriteError::Port)?;
        port.flush().map_err(WriteError::Port)
    }

    fn send(&mut self, bytes: &[u8]) -> Result<(), WriteError<Port::Error>> {
        self.checksum.update(bytes);
        self.port.write_all(bytes).map_err(WriteError::Port)
    }
}

/// One frame as it was read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Frame<'a> {
    /// The frame's number, counted from 0.
    pub number: u32,
    /// How many coordinates saturated.
    pub saturated: u32,
    rows: &'a [u8],
}

impl<'a> Frame<'a> {
    /// How many rows the frame has.
    #[must_use]
    pub fn row_count(&self) -> usize {
        self.rows.len() / ROW_BYTES
    }

    /// The rows: raw bits of x, y and z.
    pub fn rows(&self) -> impl Iterator<Item = [i32; 3]> + use<'a> {
        let (rows, _) = self.rows.as_chunks::<ROW_BYTES>();
        rows.iter().map(|row| {
            let [a, b, c, d, e, f, g, h, i, j, k, l] = *row;
            [
                i32::from_le_bytes([a, b, c, d]),
                i32::from_le_bytes([e, f, g, h]),
                i32::from_le_bytes([i, j, k, l]),
            ]
        })
    }
}

/// Why a stream cannot be read on, and the byte where the frame at fault starts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ReadError {
    /// There is no frame at this byte.
    NoFrame {
        /// Bytes from the start of the stream.
        offset: usize,
    },
    /// The stream ends within the frame.
    CutShort {
        /// Bytes from the start of the stream.
        offset: usize,
    },
    /// The checksum does not match: bytes were lost or changed on the line.
    Checksum {
        /// Bytes from the start of the stream.
        offset: usize,
    },
}

impl core::fmt::Display for ReadError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            ReadError::NoFrame { offset } => write!(f, "no frame starts at byte {offset}"),
            ReadError::CutShort { offset } => {
                write!(f, "the stream ends within the frame at byte {offset}")
            }
            ReadError::Checksum { offset } => {
                write!(
                    f,
                    "the checksum of the frame at byte {offset} does not match"
                )
            }
        }
    }
}

impl core::error::Error for ReadError {}

/// Reads the frames of a stream one by one. After an error there are no more.
pub struct FrameReader<'a> {
    stream: &'a [u8],
    offset: usize,
}

impl<'a> FrameReader<'a> {
    /// Starts at the first byte of `stream`.
    #[must_use]
    pub fn new(stream: &'a [u8]) -> Self {
        FrameReader { stream, offset: 0 }
    }

    fn read(&self) -> Result<(Frame<'a>, usize), ReadError> {
        let offset = self.offset;
        let cut_short = ReadError::CutShort { offset };
        let bytes = self.stream.get(offset..).unwrap_or_default();
        // A stream cut within the letters is cut short; anything else there is no frame.
        let mut letters = bytes.iter().zip(MAGIC);
        if letters.any(|(&found, expected)| found != expected) {
            return Err(ReadError::NoFrame { offset });
        }
        let number = word(bytes, 4).ok_or(cut_short)?;
        let row_bytes = word(bytes, 8)
            .and_then(|rows| usize::try_from(rows).ok())
            .and_then(|rows| rows.checked_mul(ROW_BYTES))
            .ok_or(cut_short)?;
        let rows_end = HEADER_BYTES.checked_add(row_bytes).ok_or(cut_short)?;
        let rows = bytes.get(HEADER_BYTES..rows_end).ok_or(cut_short)?;
        let saturated = word(bytes, rows_end).ok_or(cut_short)?;
        let checksum = word(bytes, rows_end + 4).ok_or(cut_short)?;
        let checked = bytes.get(..rows_end + 4).ok_or(cut_short)?;
        if CHECKSUM.checksum(checked) != checksum {
            return Err(ReadError::Checksum { offset });
        }
        let frame = Frame {
            number,
            saturated,
            rows,
        };
        Ok((frame, rows_end + TRAILER_BYTES))
    }
}

impl<'a> Iterator for FrameReader<'a> {
    type Item = Result<Frame<'a>, ReadError>;

    fn next(&mut self) -> Option<Self::Item> {
        if self.offset >= self.stream.len() {
            return None;
        }
        match self.read() {
            Ok((frame, length)) => {
                self.offset += length;
                Some(Ok(frame))
            }
            Err(error) => {
                self.offset = self.stream.len();
                Some(Err(error))
            }
        }
    }
}

/// The little-endian word at `offset`, if it is there.
fn word(bytes: &[u8], offset: usize) -> Option<u32> {
    let (word, _) = bytes.get(offset..)?.split_first_chunk()?;
    Some(u32::from_le_bytes(*word))
}

#[cfg(test)]
mod tests {
    use super::{Frame, FrameReader, FrameWriter, ReadError, WriteError};

    /// Two frames of two rows and none, as the module's table lays them out. The checksums are
    /// those of Python's `zlib.crc32`.
    fn stream() -> ([u8; 128], usize) {
        let mut buffer = [0; 128];
        let mut port = &mut buffer[..];
        let mut frame = FrameWriter::begin(&mut port, 7, 2).unwrap();
        frame.rows(&[[1, -1, i32::MAX]]).unwrap();
        frame.rows(&[[i32::MIN, 0, 258]]).unwrap();
        frame.end(3).unwrap();
        FrameWriter::begin(&mut port, 8, 0).unwrap().end(0).unwrap();
        let left = port.len();
        (buffer, 128 - left)
    }

    #[test]
    fn the_bytes_are_those_of_the_table() {
        let (bytes, length) = stream();
        let expected = [
            b"OCTF".as_slice(),
            &[7, 0, 0, 0, 2, 0, 0, 0],
            &[1, 0, 0, 0, 255, 255, 255, 255, 255, 255, 255, 127],
            &[0, 0, 0, 128, 0, 0, 0, 0, 2, 1, 0, 0],
            &[3, 0, 0, 0],
            &CRC_OF_FIRST.to_le_bytes(),
            b"OCTF",
            &[8, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0],
            &CRC_OF_SECOND.to_le_bytes(),
        ];
        assert!(bytes[..length].iter().eq(expected.into_iter().flatten()));
    }

    const CRC_OF_FIRST: u32 = 0x8650e0f0;
    const CRC_OF_SECOND: u32 = 0xb26ab79f;

    #[test]
    fn frames_are_read_back() {
        let (bytes, length) = stream();
        let mut reader = FrameReader::new(&bytes[..length]);
        let first = reader.next().unwrap().unwrap();
        assert_eq!(
            (first.number, first.saturated, first.row_count()),
            (7, 3, 2)
        );
        assert!(first.rows().eq([[1, -1, i32::MAX], [i32::MIN, 0, 258]]));
        let second = reader.next().unwrap().unwrap();
        assert_eq!(
            second,
            Frame {
                number: 8,
                saturated: 0,
                rows: &[]
            }
        );
        assert_eq!(reader.next(), None);
    }

    #[test]
    fn every_changed_bit_is_found() {
        let (bytes, length) = stream();
        for bit in 0..length * 8 {
            let mut changed = bytes;
            changed[bit / 8] ^= 1 << (bit % 8);
            let errors = FrameReader::new(&changed[..length]).filter(Result::is_err);
            assert_eq!(errors.count(), 1, "bit {bit}");
        }
    }

    #[test]
    fn every_cut_is_found_or_falls_between_frames() {
        let (bytes, length) = stream();
        for cut in 0..length {
            let last = FrameReader::new(&bytes[..cut]).last();
            let offset = if cut < 44 { 0 } else { 44 };
            match cut {
                0 => assert_eq!(last, None),
                44 => assert!(matches!(last, Some(Ok(_)))),
                _ => assert_eq!(last, Some(Err(ReadError::CutShort { offset })), "cut {cut}"),
            }
        }
    }

    #[test]
    fn a_wrong_number_of_rows_is_refused() {
        let mut buffer = [0; 64];
        let mut port = &mut buffer[..];
        let mut frame = FrameWriter::begin(&mut port, 0, 1).unwrap();
        assert_eq!(frame.rows(&[[0; 3]; 2]), Err(WriteError::RowCount));
        let frame = FrameWriter::begin(&mut port, 0, 1).unwrap();
        assert_eq!(frame.end(0), Err(WriteError::RowCount));
    }
}
