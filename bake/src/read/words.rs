//! Splits a text file into words at white space and knows the line of each.
//!
//! Some formats have a text for a frame and binary numbers inside: [`Words::take`] takes bytes from
//! between the words. Errors of such files name bytes instead of lines.

use crate::error::{Error, Place, Result};
use std::str::FromStr;

/// A cursor over the words of a text file.
pub struct Words<'a> {
    text: &'a [u8],
    position: usize,
    /// Line of `position`, counted from 1.
    line: usize,
    /// Line of the word that was read last.
    word_line: usize,
    /// First byte of what was read last.
    word_start: usize,
    /// Whether places are named by their byte.
    is_binary: bool,
}

impl<'a> Words<'a> {
    /// Starts at the first byte of a file.
    pub fn new(text: &'a [u8]) -> Self {
        Self {
            text,
            position: 0,
            line: 1,
            word_line: 1,
            word_start: 0,
            is_binary: false,
        }
    }

    /// Line of the word that was read last, counted from 1.
    pub fn word_line(&self) -> usize {
        self.word_line
    }

    /// From here on places are named by their byte: the file has binary parts, so it has no lines.
    pub fn name_bytes(&mut self) {
        self.is_binary = true;
    }

    /// Where the word or the bytes stand that were read last.
    pub fn place(&self) -> Place {
        if self.is_binary {
            Place::Byte(self.word_start)
        } else {
            Place::Line(self.word_line)
        }
    }

    /// An error at the word that was read last.
    pub fn error(&self, message: impl Into<String>) -> Error {
        Error::new(message).at(self.place())
    }

    /// The next bytes, whatever they are; `expected` says in the error what was wanted if there are
    /// fewer.
    pub fn take(&mut self, number: usize, expected: &str) -> Result<&'a [u8]> {
        self.word_start = self.position;
        let rest = self.text.get(self.position..).unwrap_or_default();
        let Some(bytes) = rest.get(..number) else {
            return Err(self
                .error(format!("expected {expected}, found the end of the file"))
                .advise("the file seems to be cut off; write it again"));
        };
        self.position += number;
        Ok(bytes)
    }

    /// The next bytes as an array.
    pub fn take_array<const N: usize>(&mut self, expected: &str) -> Result<[u8; N]> {
        let bytes = self.take(N, expected)?;
        let mut array = [0; N];
        array.copy_from_slice(bytes);
        Ok(array)
    }

    /// How many bytes are left.
    pub fn remaining(&self) -> usize {
        self.text.len().saturating_sub(self.position)
    }

    fn skip_space(&mut self) {
        while let Some(byte) = self.text.get(self.position) {
            if !byte.is_ascii_whitespace() {
                break;
            }
            if *byte == b'\n' {
                self.line += 1;
            }
            self.position += 1;
        }
    }

    /// The next word, or `None` at the end of the file.
    pub fn next_word(&mut self) -> Result<Option<&'a str>> {
        self.skip_space();
        self.word_line = self.line;
        self.word_start = self.position;
        let rest = self.text.get(self.position..).unwrap_or_default();
        let length = rest
            .iter()
            .position(u8::is_ascii_whitespace)
            .unwrap_or(rest.len());
        let word = &rest[..length];
        self.position += length;
        if word.is_empty() {
            return Ok(None);
        }
        match std::str::from_utf8(word) {
            Ok(word) => Ok(Some(word)),
            Err(_) => Err(self
                .error("found bytes that are not text")
                .advise("the file may be damaged, or a binary file under a name that says text")),
        }
    }

    /// The next word; `expected` says in the error what was wanted when the file ends here.
    pub fn word(&mut self, expected: &str) -> Result<&'a str> {
        match self.next_word()? {
            Some(word) => Ok(word),
            None => Err(self
                .error(format!("expected {expected}, found the end of the file"))
                .advise("the file seems to be cut off; write it again")),
        }
    }

    /// The next word as a number; `expected` names it in the error.
    pub fn number<T: FromStr>(&mut self, expected: &str) -> Result<T> {
        let word = self.word(expected)?;
        word.parse()
            .map_err(|_| self.error(format!("expected {expected}, found \"{}\"", shown(word))))
    }

    /// The next word as a finite coordinate.
    pub fn coordinate(&mut self, expected: &str) -> Result<f64> {
        let value: f64 = self.number(expected)?;
        if value.is_finite() {
            return Ok(value);
        }
        Err(self.error(format!(
            "expected {expected}, found {value}, which is no finite number"
        )))
    }

    /// Whether there is a word of that spelling next; the cursor stays before it.
    pub fn is_next(&mut self, wanted: &str) -> bool {
        self.skip_space();
        let rest = self.text.get(self.position..).unwrap_or_default();
        rest.strip_prefix(wanted.as_bytes())
            .is_some_and(|rest| rest.first().is_none_or(u8::is_ascii_whitespace))
    }

    /// Whether the next word starts with a letter; the cursor stays before it.
    pub fn is_keyword_next(&mut self) -> bool {
        self.skip_space();
        let next = self.text.get(self.position);
        next.is_some_and(|byte| byte.is_ascii_alphabetic())
    }

    /// The bytes of the word that was read last.
    pub fn span(&self) -> std::ops::Range<usize> {
        self.word_start..self.position
    }

    /// Moves past the next `pattern`; false if there is none.
    pub fn skip_past(&mut self, pattern: &[u8]) -> bool {
        let rest = self.text.get(self.position..).unwrap_or_default();
        let found = rest
            .windows(pattern.len())
            .position(|window| window == pattern);
        if let Some(at) = found {
            self.position += at + pattern.len();
        }
        found.is_some()
    }

    /// The rest of the current line; the cursor moves to the start of the next.
    pub fn line(&mut self) -> Result<&'a str> {
        let line = self.rest_of_line()?;
        if self.remaining() > 0 {
            self.position += 1;
            self.line += 1;
        }
        Ok(line)
    }

    /// Moves past the end of the current line: binary numbers start right behind it.
    pub fn skip_line_end(&mut self) -> Result<()> {
        let rest = self.line()?;
        if rest.is_empty() {
            return Ok(());
        }
        Err(self.error(format!(
            "expected the end of the line, found \"{}\"",
            shown(rest)
        )))
    }

    /// The rest of the current line, without its end; the cursor moves past it.
    pub fn rest_of_line(&mut self) -> Result<&'a str> {
        self.word_line = self.line;
        self.word_start = self.position;
        let rest = self.text.get(self.position..).unwrap_or_default();
        let length = rest
            .iter()
            .position(|byte| *byte == b'\n')
            .unwrap_or(rest.len());
        self.position += length;
        std::str::from_utf8(&rest[..length])
            .map(str::trim)
            .map_err(|_| self.error("found bytes that are not text"))
    }
}

/// A word as it may be shown in a message: long ones are cut.
pub fn shown(word: &str) -> String {
    const LONGEST: usize = 40;
    if word.chars().count() <= LONGEST {
        return word.escape_debug().to_string();
    }
    let start: String = word.chars().take(LONGEST).collect();
    format!("{}...", start.escape_debug())
}
