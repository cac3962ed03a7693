//! The one error type of the host tools: what is wrong, where in which file, and what to do.

use std::fmt;
use std::path::{Path, PathBuf};

/// What every fallible function of this package returns.
pub type Result<T> = std::result::Result<T, Error>;

/// Where in a file something was found.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum Place {
    /// No single place, or no file at all.
    #[default]
    Whole,
    /// A line, counted from 1.
    Line(usize),
    /// A byte, counted from 0.
    Byte(usize),
}

/// A failure that the user can act upon.
///
/// Shown as `FILE, line N: MESSAGE` and, where there is advice, a second line that begins with
/// `help:`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Error {
    // Boxed so that `Result<f64>` and the like stay small in the readers' inner loops.
    inner: Box<Inner>,
}

#[derive(Clone, Debug, PartialEq, Eq)]
struct Inner {
    file: Option<PathBuf>,
    place: Place,
    message: String,
    advice: Option<String>,
}

impl Error {
    /// An error that says what is wrong and, for input, what was expected instead.
    pub fn new(message: impl Into<String>) -> Self {
        Self {
            inner: Box::new(Inner {
                file: None,
                place: Place::Whole,
                message: message.into(),
                advice: None,
            }),
        }
    }

    /// Names the line, counted from 1.
    #[must_use]
    pub fn at_line(mut self, line: usize) -> Self {
        self.inner.place = Place::Line(line);
        self
    }

    /// Names the byte, counted from 0.
    #[must_use]
    pub fn at_byte(mut self, byte: usize) -> Self {
        self.inner.place = Place::Byte(byte);
        self
    }

    /// Names the place.
    #[must_use]
    pub fn at(mut self, place: Place) -> Self {
        self.inner.place = place;
        self
    }

    /// The same error with another sentence in front of its own.
    #[must_use]
    pub fn with_message(mut self, message: impl Into<String>) -> Self {
        self.inner.message = message.into();
        self
    }

    /// Adds what the user can do about it.
    #[must_use]
    pub fn advise(mut self, advice: impl Into<String>) -> Self {
        self.inner.advice = Some(advice.into());
        self
    }

    /// Names the file, unless an inner function already named one.
    #[must_use]
    pub fn in_file(mut self, file: &Path) -> Self {
        if self.inner.file.is_none() {
            self.inner.file = Some(file.to_path_buf());
        }
        self
    }

    /// What is wrong, without file, place and advice.
    pub fn message(&self) -> &str {
        &self.inner.message
    }

    /// What to do about it.
    pub fn advice(&self) -> Option<&str> {
        self.inner.advice.as_deref()
    }

    /// Where in the file it is.
    pub fn place(&self) -> Place {
        self.inner.place
    }

    /// The file it is about.
    pub fn file(&self) -> Option<&Path> {
        self.inner.file.as_deref()
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(file) = &self.inner.file {
            write!(f, "{}", file.display())?;
            match self.inner.place {
                Place::Whole => {}
                Place::Line(line) => write!(f, ", line {line}")?,
                Place::Byte(byte) => write!(f, ", byte {byte}")?,
            }
            write!(f, ": ")?;
        } else {
            match self.inner.place {
                Place::Whole => {}
                Place::Line(line) => write!(f, "line {line}: ")?,
                Place::Byte(byte) => write!(f, "byte {byte}: ")?,
            }
        }
        write!(f, "{}", self.inner.message)?;
        if let Some(advice) = &self.inner.advice {
            write!(f, "\n  help: {advice}")?;
        }
        Ok(())
    }
}

impl std::error::Error for Error {}

/// "1 triangle", "2 triangles".
pub fn count(number: usize, singular: &str, plural: &str) -> String {
    format!("{number} {}", if number == 1 { singular } else { plural })
}

/// "a", "a and b", "a, b and c".
pub fn listed(items: &[String]) -> String {
    match items {
        [] => String::new(),
        [one] => one.clone(),
        [first @ .., last] => format!("{} and {last}", first.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_error_says_where_and_what_to_do() {
        let error = Error::new("expected a number, found \"x\"")
            .at_line(7)
            .advise("write a number")
            .in_file(Path::new("cage.msh"))
            .in_file(Path::new("other.msh"));
        assert_eq!(
            error.to_string(),
            "cage.msh, line 7: expected a number, found \"x\"\n  help: write a number"
        );
    }
}
