//! Words of a line that know which bytes of the file they take.

use super::words::shown;
use crate::error::{Error, Result};
use std::ops::Range;

/// A word of a line and the bytes it takes in the file.
pub struct Word<'a> {
    /// The word.
    pub text: &'a [u8],
    /// Its bytes in the file.
    pub span: Range<usize>,
}

impl Word<'_> {
    /// The word as it may stand in a message.
    pub fn shown(&self) -> String {
        shown(&String::from_utf8_lossy(self.text))
    }

    /// The word as a finite coordinate.
    pub fn coordinate(&self, line: usize) -> Result<f64> {
        let value: Option<f64> = std::str::from_utf8(self.text)
            .ok()
            .and_then(|word| word.parse().ok());
        value.filter(|value| value.is_finite()).ok_or_else(|| {
            Error::new(format!(
                "expected a finite coordinate, found \"{}\"",
                self.shown()
            ))
            .at_line(line)
        })
    }
}

/// The words of the line, the bytes from its first to its last.
pub fn span_of(words: &[Word<'_>]) -> Range<usize> {
    match (words.first(), words.last()) {
        (Some(first), Some(last)) => first.span.start..last.span.end,
        _ => 0..0,
    }
}

/// The words of a line up to a comment.
pub fn words(bytes: &[u8], line: Range<usize>) -> Vec<Word<'_>> {
    let mut words = Vec::new();
    let is_space = |at: usize| {
        let joins = bytes[at] == b'\\' && matches!(bytes.get(at + 1), Some(b'\n' | b'\r'));
        joins || bytes[at].is_ascii_whitespace()
    };
    let mut at = line.start;
    while at < line.end {
        if is_space(at) {
            at += 1;
            continue;
        }
        if bytes[at] == b'#' {
            break;
        }
        let start = at;
        while at < line.end && !is_space(at) {
            at += 1;
        }
        words.push(Word {
            text: &bytes[start..at],
            span: start..at,
        });
    }
    words
}
