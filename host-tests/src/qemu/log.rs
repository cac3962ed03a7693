//! Turns the bytes that an image prints through semihosting back into messages.
//!
//! `defmt` sends the number of a message and its arguments; the words are in the image's file.

use std::path::Path;

use defmt_decoder::{DecodeError, StreamDecoder, Table};
use octruss_firmware::exit::END_MARKER;

use super::error::{Error, LogTail};

/// One message of an image.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Message {
    /// `error`, `warn`, `info`, `debug` or `trace`; empty for a plain print.
    pub level: &'static str,
    /// The words.
    pub text: String,
}

/// What an image has logged.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Log {
    /// The messages in order.
    pub messages: Vec<Message>,
}

impl Log {
    /// The value of the last figure of that name (see `octruss_firmware::exit::figure`).
    #[must_use]
    pub fn figure(&self, name: &str) -> Option<u64> {
        let figures = self.messages.iter().rev();
        figures
            .filter_map(|message| octruss_firmware::exit::parse_figure(&message.text))
            .find_map(|(found, value)| (found == name).then_some(value))
    }

    /// True if the last message is the end marker.
    pub(super) fn has_ended(&self) -> bool {
        self.messages
            .last()
            .is_some_and(|message| message.text == END_MARKER)
    }

    /// The last messages, for an error.
    pub(super) fn tail(&self) -> LogTail {
        let first = self.messages.len().saturating_sub(LogTail::LINES);
        let lines = self.messages.iter().skip(first);
        LogTail(
            lines
                .map(|message| format!("{:5} {}", message.level, message.text))
                .collect(),
        )
    }
}

/// Reads the table of messages from an image's file.
pub(super) fn read_table(image: &Path) -> Result<Table, Error> {
    let bytes = std::fs::read(image).map_err(|source| Error::File {
        action: "read",
        path: image.to_path_buf(),
        source,
    })?;
    let not_an_image = |reason: String| Error::NotAnImage {
        path: image.to_path_buf(),
        reason,
    };
    Table::parse(&bytes)
        .map_err(|error| not_an_image(error.to_string()))?
        .ok_or_else(|| not_an_image("it has no table of defmt messages".to_owned()))
}

/// Decodes a stream of bytes that arrives in pieces.
pub(super) struct Decoder<'table> {
    stream: Box<dyn StreamDecoder + Send + Sync + 'table>,
    /// All messages so far.
    pub log: Log,
}

impl<'table> Decoder<'table> {
    /// Starts before the first byte.
    pub fn new(table: &'table Table) -> Self {
        Decoder {
            stream: table.new_stream_decoder(),
            log: Log::default(),
        }
    }

    /// Takes the next bytes and hands each message that they complete to `on_message`.
    pub fn receive(
        &mut self,
        bytes: &[u8],
        on_message: &mut dyn FnMut(&Message),
    ) -> Result<(), Error> {
        self.stream.received(bytes);
        loop {
            match self.stream.decode() {
                Ok(frame) => {
                    let message = Message {
                        level: frame.level().map_or("", |level| level.as_str()),
                        text: frame.display_message().to_string(),
                    };
                    on_message(&message);
                    self.log.messages.push(message);
                }
                Err(DecodeError::UnexpectedEof) => return Ok(()),
                Err(DecodeError::Malformed) => {
                    return Err(Error::LogCorrupt {
                        log: self.log.tail(),
                    });
                }
            }
        }
    }
}
