//! The numbers of a Gmsh file, as words or as bytes.

use crate::error::{Error, Place, Result};
use crate::read::words::Words;

/// A cursor over the numbers of a file, in either of its two modes.
pub struct Numbers<'w, 'a> {
    words: &'w mut Words<'a>,
    mode: Mode,
}

/// How a file holds its numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mode {
    /// As words.
    Ascii,
    /// As bytes, the least significant first.
    LittleEndian,
    /// As bytes, the most significant first.
    BigEndian,
}

impl<'w, 'a> Numbers<'w, 'a> {
    /// Goes on where `words` stands: in a binary file behind the end of the line.
    pub fn new(words: &'w mut Words<'a>, mode: Mode) -> Result<Self> {
        if mode != Mode::Ascii {
            words.skip_line_end()?;
        }
        Ok(Self { words, mode })
    }

    /// Where the number stands that was read last.
    pub fn place(&self) -> Place {
        self.words.place()
    }

    /// A number that has 32 bits in a binary file; `expected` names it in the error.
    pub fn int(&mut self, expected: &str) -> Result<i64> {
        match self.mode {
            Mode::Ascii => self.words.number(expected),
            Mode::LittleEndian => Ok(i32::from_le_bytes(self.words.take_array(expected)?).into()),
            Mode::BigEndian => Ok(i32::from_be_bytes(self.words.take_array(expected)?).into()),
        }
    }

    /// A number of 32 bits that is not negative.
    pub fn count<T: TryFrom<i64>>(&mut self, expected: &str) -> Result<T> {
        let value = self.int(expected)?;
        T::try_from(value)
            .map_err(|_| self.error(format!("expected {expected}, found \"{value}\"")))
    }

    /// A number that has 64 bits in a binary file and no sign.
    pub fn size(&mut self, expected: &str) -> Result<u64> {
        match self.mode {
            Mode::Ascii => self.words.number(expected),
            Mode::LittleEndian => Ok(u64::from_le_bytes(self.words.take_array(expected)?)),
            Mode::BigEndian => Ok(u64::from_be_bytes(self.words.take_array(expected)?)),
        }
    }

    /// A number in double precision, whatever it is.
    pub fn real(&mut self, expected: &str) -> Result<f64> {
        match self.mode {
            Mode::Ascii => self.words.number(expected),
            Mode::LittleEndian => Ok(f64::from_le_bytes(self.words.take_array(expected)?)),
            Mode::BigEndian => Ok(f64::from_be_bytes(self.words.take_array(expected)?)),
        }
    }

    /// A finite coordinate.
    pub fn coordinate(&mut self, expected: &str) -> Result<f64> {
        let value = self.real(expected)?;
        if value.is_finite() {
            return Ok(value);
        }
        Err(self.error(format!(
            "expected {expected}, found {value}, which is no finite number"
        )))
    }

    /// The position of a node.
    pub fn position(&mut self) -> Result<[f64; 3]> {
        Ok([
            self.coordinate("the x coordinate of a node")?,
            self.coordinate("the y coordinate of a node")?,
            self.coordinate("the z coordinate of a node")?,
        ])
    }

    /// An error at the number that was read last.
    pub fn error(&self, message: impl Into<String>) -> Error {
        self.words.error(message)
    }
}
