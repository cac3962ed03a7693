//! The numbers of a legacy VTK file, as words or as bytes.

use super::data::Values;
use crate::error::Result;
use crate::read::words::{Words, shown};

/// A type of numbers, by its name in the file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NumberType {
    /// So many bytes, with a sign.
    Signed(usize),
    /// So many bytes, without a sign.
    Unsigned(usize),
    /// So many bytes, 4 or 8.
    Real(usize),
}

impl NumberType {
    /// The type that the next word names.
    pub fn read(words: &mut Words<'_>) -> Result<Self> {
        let name = words.word("a type of numbers, such as double")?;
        Ok(match name.to_ascii_lowercase().as_str() {
            "char" | "vtktypeint8" => Self::Signed(1),
            "short" | "vtktypeint16" => Self::Signed(2),
            "int" | "vtkidtype" | "vtktypeint32" => Self::Signed(4),
            "long" | "vtktypeint64" => Self::Signed(8),
            "unsigned_char" | "vtktypeuint8" => Self::Unsigned(1),
            "unsigned_short" | "vtktypeuint16" => Self::Unsigned(2),
            "unsigned_int" | "vtktypeuint32" => Self::Unsigned(4),
            "unsigned_long" | "vtktypeuint64" => Self::Unsigned(8),
            "float" => Self::Real(4),
            "double" => Self::Real(8),
            _ => {
                return Err(words.error(format!(
                    "expected a type of numbers, such as double, found \"{}\"",
                    shown(name)
                )));
            }
        })
    }

    fn bytes(self) -> usize {
        match self {
            Self::Signed(bytes) | Self::Unsigned(bytes) | Self::Real(bytes) => bytes,
        }
    }
}

/// Reads so many numbers; in a binary file they start behind the end of the line.
pub fn values(
    words: &mut Words<'_>,
    is_binary: bool,
    kind: NumberType,
    number: usize,
    expected: &str,
) -> Result<Values> {
    if !is_binary {
        return ascii(words, kind, number, expected);
    }
    words.skip_line_end()?;
    // A number of bytes beyond all bounds is beyond the end of the file too.
    let length = number.saturating_mul(kind.bytes());
    let bytes = words.take(length, &format!("{number} numbers ({expected})"))?;
    let wide = |word: &[u8]| {
        word.iter()
            .fold(0_u64, |value, byte| (value << 8) | u64::from(*byte))
    };
    let chunks = bytes.chunks_exact(kind.bytes());
    Ok(match kind {
        NumberType::Real(4) => {
            let real = |word: &[u8]| f64::from(f32::from_bits(wide(word) as u32));
            Values::Reals(chunks.map(real).collect())
        }
        NumberType::Real(_) => {
            Values::Reals(chunks.map(|word| f64::from_bits(wide(word))).collect())
        }
        NumberType::Signed(bytes) => {
            let unused_bits = 64 - 8 * bytes;
            let signed = |word: &[u8]| (wide(word) << unused_bits).cast_signed() >> unused_bits;
            Values::Integers(chunks.map(signed).collect())
        }
        NumberType::Unsigned(_) => {
            let signed = |word: &[u8]| i64::try_from(wide(word));
            let values: std::result::Result<Vec<i64>, _> = chunks.map(signed).collect();
            Values::Integers(values.map_err(|_| words.error("a number exceeds 2^63 - 1"))?)
        }
    })
}

fn ascii(words: &mut Words<'_>, kind: NumberType, number: usize, expected: &str) -> Result<Values> {
    if matches!(kind, NumberType::Real(_)) {
        let values = (0..number).map(|_| words.number(expected));
        return values.collect::<Result<_>>().map(Values::Reals);
    }
    let values = (0..number).map(|_| words.number(expected));
    values.collect::<Result<_>>().map(Values::Integers)
}

/// Reads so many integers.
pub fn integers(
    words: &mut Words<'_>,
    is_binary: bool,
    kind: NumberType,
    number: usize,
    expected: &str,
) -> Result<Vec<i64>> {
    match values(words, is_binary, kind, number, expected)? {
        Values::Integers(values) => Ok(values),
        Values::Reals(_) => Err(words.error(format!(
            "expected {expected} as integers, found floating point numbers"
        ))),
    }
}

/// Reads so many real numbers.
pub fn reals(
    words: &mut Words<'_>,
    is_binary: bool,
    kind: NumberType,
    number: usize,
    expected: &str,
) -> Result<Vec<f64>> {
    Ok(match values(words, is_binary, kind, number, expected)? {
        Values::Integers(values) => values.into_iter().map(|value| value as f64).collect(),
        Values::Reals(values) => values,
    })
}
