//! Binary arrays of a VTK XML file: a header, then the bytes, plain or in zlib blocks.

use crate::error::{Error, Result};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use flate2::read::ZlibDecoder;
use std::io::Read;

/// Gives the bytes of an array from its start, in order.
pub trait Source {
    /// The next `number` bytes, or an error if there are fewer.
    fn take(&mut self, number: usize) -> Result<Vec<u8>>;
}

/// How binary arrays are laid out in one file.
#[derive(Clone, Copy, Debug, Default)]
pub struct Layout {
    /// Numbers start with their most significant byte.
    pub big_endian: bool,
    /// Header numbers have 64 bits instead of 32.
    pub wide_header: bool,
    /// The bytes are in zlib blocks.
    pub compressed: bool,
}

impl Layout {
    /// The bytes of the array that starts at `source`.
    pub fn read(&self, source: &mut dyn Source) -> Result<Vec<u8>> {
        if self.compressed {
            return self.read_compressed(source);
        }
        let length = self.header(source)?;
        source.take(length)
    }

    fn header(&self, source: &mut dyn Source) -> Result<usize> {
        let width = if self.wide_header { 8 } else { 4 };
        let bytes = source.take(width)?;
        let accumulate = |value: u64, byte: &u8| (value << 8) | u64::from(*byte);
        let value = if self.big_endian {
            bytes.iter().fold(0, accumulate)
        } else {
            bytes.iter().rev().fold(0, accumulate)
        };
        usize::try_from(value).map_err(|_| too_long())
    }

    /// The header names the number of blocks, the bytes of a full block and of the last one (0 if
    /// that is full too), and the compressed bytes of each block.
    fn read_compressed(&self, source: &mut dyn Source) -> Result<Vec<u8>> {
        let blocks = self.header(source)?;
        let full = self.header(source)?;
        let last = self.header(source)?;
        let mut lengths = Vec::new();
        for _ in 0..blocks {
            lengths.push(self.header(source)?);
        }
        let mut bytes = Vec::new();
        for (index, length) in lengths.iter().enumerate() {
            let is_last = index + 1 == blocks;
            let expected = if is_last && last > 0 { last } else { full };
            let compressed = source.take(*length)?;
            let before = bytes.len();
            let limit = u64::try_from(expected)
                .unwrap_or(u64::MAX)
                .saturating_add(1);
            ZlibDecoder::new(compressed.as_slice())
                .take(limit)
                .read_to_end(&mut bytes)
                .map_err(|error| {
                    Error::new(format!(
                        "a compressed block of the array is damaged: {error}"
                    ))
                })?;
            if bytes.len() - before != expected {
                return Err(Error::new(format!(
                    "a compressed block of the array holds {} bytes instead of {expected}",
                    bytes.len() - before
                )));
            }
        }
        Ok(bytes)
    }
}

fn too_long() -> Error {
    Error::new("the array's data are shorter than its header says")
        .advise("the file seems to be cut off, or header_type or byte_order is wrong")
}

/// Bytes as they are.
pub struct Raw<'a> {
    bytes: &'a [u8],
}

impl<'a> Raw<'a> {
    /// Starts at the first byte.
    pub fn new(bytes: &'a [u8]) -> Self {
        Self { bytes }
    }
}

impl Source for Raw<'_> {
    fn take(&mut self, number: usize) -> Result<Vec<u8>> {
        let (taken, rest) = self.bytes.split_at_checked(number).ok_or_else(too_long)?;
        self.bytes = rest;
        Ok(taken.to_vec())
    }
}

/// Bytes in base64. Writers encode header and data in one piece or each for itself, so that padding
/// may stand in the middle: every run that ends in padding is decoded separately.
pub struct Base64<'a> {
    text: &'a [u8],
    /// Decoded, but not yet taken.
    ready: Vec<u8>,
}

impl<'a> Base64<'a> {
    /// Starts at the first character; there must be no white space.
    pub fn new(text: &'a [u8]) -> Self {
        Self {
            text,
            ready: Vec::new(),
        }
    }

    /// Decodes up to `wanted` more bytes, but never beyond padding.
    fn decode(&mut self, wanted: usize) -> Result<()> {
        const CHARACTERS: usize = 4;
        const BYTES: usize = 3;
        let most = wanted
            .div_ceil(BYTES)
            .saturating_mul(CHARACTERS)
            .min(self.text.len());
        let run = match self.text[..most]
            .iter()
            .position(|character| *character == b'=')
        {
            Some(padding) => (padding / CHARACTERS + 1) * CHARACTERS,
            None => most,
        };
        let (run, rest) = self.text.split_at_checked(run).ok_or_else(too_long)?;
        if run.is_empty() {
            return Err(too_long());
        }
        let decoded = STANDARD
            .decode(run)
            .map_err(|error| Error::new(format!("the array is no valid base64: {error}")))?;
        self.ready.extend(decoded);
        self.text = rest;
        Ok(())
    }
}

impl Source for Base64<'_> {
    fn take(&mut self, number: usize) -> Result<Vec<u8>> {
        while self.ready.len() < number {
            self.decode(number - self.ready.len())?;
        }
        let rest = self.ready.split_off(number);
        Ok(std::mem::replace(&mut self.ready, rest))
    }
}
