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

#[cfg(test)]
mod tests {
    use super::*;
    use flate2::Compression;
    use flate2::write::ZlibEncoder;
    use std::io::Write;

    fn header(numbers: &[usize], layout: Layout) -> Vec<u8> {
        let bytes = |number: &usize| {
            let wide = (*number as u64).to_le_bytes();
            let mut bytes = wide[..if layout.wide_header { 8 } else { 4 }].to_vec();
            if layout.big_endian {
                bytes.reverse();
            }
            bytes
        };
        numbers.iter().flat_map(bytes).collect()
    }

    /// The array in zlib blocks of 7 bytes, header and blocks.
    fn compressed(content: &[u8], layout: Layout) -> (Vec<u8>, Vec<u8>) {
        let blocks: Vec<Vec<u8>> = content
            .chunks(7)
            .map(|block| {
                let mut encoder = ZlibEncoder::new(Vec::new(), Compression::default());
                encoder.write_all(block).unwrap();
                encoder.finish().unwrap()
            })
            .collect();
        let mut numbers = vec![blocks.len(), 7, content.len() % 7];
        numbers.extend(blocks.iter().map(Vec::len));
        (header(&numbers, layout), blocks.concat())
    }

    #[test]
    fn many_blocks_with_a_full_or_a_short_last_one() {
        for length in [0, 1, 6, 7, 8, 14, 20] {
            let content: Vec<u8> = (0..length).collect();
            for (big_endian, wide_header) in
                [(false, false), (true, false), (false, true), (true, true)]
            {
                let layout = Layout {
                    big_endian,
                    wide_header,
                    compressed: true,
                };
                let (header, blocks) = compressed(&content, layout);
                let raw = [header.clone(), blocks.clone()].concat();
                assert_eq!(layout.read(&mut Raw::new(&raw)).unwrap(), content);
                let together = STANDARD.encode(&raw);
                let apart = STANDARD.encode(&header) + &STANDARD.encode(&blocks);
                for text in [together, apart] {
                    assert_eq!(
                        layout.read(&mut Base64::new(text.as_bytes())).unwrap(),
                        content
                    );
                }
            }
        }
    }

    #[test]
    fn plain_bytes_with_header_encoded_together_or_apart() {
        let content: Vec<u8> = (0..50).collect();
        for wide_header in [false, true] {
            let layout = Layout {
                wide_header,
                ..Layout::default()
            };
            let header = header(&[content.len()], layout);
            let together = STANDARD.encode([header.clone(), content.clone()].concat());
            let apart = STANDARD.encode(&header) + &STANDARD.encode(&content);
            for text in [together, apart] {
                // What follows belongs to the next array.
                let text = text + "AAAA";
                assert_eq!(
                    layout.read(&mut Base64::new(text.as_bytes())).unwrap(),
                    content
                );
            }
        }
    }

    #[test]
    fn lengths_that_lie_are_errors() {
        let layout = Layout {
            wide_header: true,
            ..Layout::default()
        };
        for bytes in [
            &[][..],
            &[1, 0, 0],
            &[255; 8],
            &[9, 0, 0, 0, 0, 0, 0, 0, 1, 2],
        ] {
            assert!(layout.read(&mut Raw::new(bytes)).is_err());
            let text = STANDARD.encode(bytes);
            assert!(layout.read(&mut Base64::new(text.as_bytes())).is_err());
        }
        let layout = Layout {
            compressed: true,
            ..Layout::default()
        };
        let (header, mut blocks) = compressed(&[1, 2, 3], layout);
        blocks[2] ^= 0xff;
        assert!(
            layout
                .read(&mut Raw::new(&[header, blocks].concat()))
                .is_err()
        );
    }
}
