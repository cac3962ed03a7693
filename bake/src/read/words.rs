//! Splits a text file into words at white space and knows the line of each.

use crate::error::{Error, Result};
use std::str::FromStr;

/// A cursor over the words of a text file.
pub struct Words<'a> {
    text: &'a [u8],
    position: usize,
    /// Line of `position`, counted from 1.
    line: usize,
    /// Line of the word that was read last.
    word_line: usize,
}

impl<'a> Words<'a> {
    /// Starts at the first byte of a file.
    pub fn new(text: &'a [u8]) -> Self {
        Self {
            text,
            position: 0,
            line: 1,
            word_line: 1,
        }
    }

    /// Line of the word that was read last, counted from 1.
    pub fn word_line(&self) -> usize {
        self.word_line
    }

    /// An error at the word that was read last.
    pub fn error(&self, message: impl Into<String>) -> Error {
        Error::new(message).at_line(self.word_line)
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

    /// The rest of the current line, without its end; the cursor moves past it.
    pub fn rest_of_line(&mut self) -> Result<&'a str> {
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
