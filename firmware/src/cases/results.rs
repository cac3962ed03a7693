//! How the results of a case are written.

use core::fmt;

use crc::Digest;
use octruss::bundle::BundleError;
use octruss::control::health::HealthError;
use octruss::control::inverse::InverseError;
use octruss::control::project::ProjectError;
use octruss::control::rig::RigError;
use octruss::control::springs::SpringsError;
use octruss::deform::ApplyError;
use octruss::enclosed::EnclosedError;
use octruss::mesh::MeshError;
use zerocopy::{Immutable, IntoBytes};

use super::{CASE_WORDS_AT_MOST, CHECKSUM, FILE_HEADER_WORDS, RESULTS_MAGIC, SECTION_END, VERSION};

/// Where results go: a file of the host on a device, a vector on the host.
pub trait Sink {
    /// Takes the next bytes.
    fn write(&mut self, bytes: &[u8]);
}

/// How a case ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Status {
    /// 0: all results are there.
    Done,
    /// 1: the words of the case are not what its kind says.
    Malformed,
    /// 2: the case has more words (first detail) than [`CASE_WORDS_AT_MOST`] (second).
    TooLong {
        /// Words of the case.
        words: u32,
    },
    /// 3: core wrote behind a buffer that it was lent; the detail is the buffer's number, counted
    /// in the order in which the case lends them.
    GuardBroken {
        /// The buffer.
        buffer: u32,
    },
    /// 4: an arena is too small; the details are the arena (its place in `octruss::mesh::Arena`),
    /// the elements needed and those given. 5: another error of a mesh; the detail is the CRC-32
    /// of its message.
    Mesh(MeshError),
    /// 6: the bundle cannot be opened; the detail is the CRC-32 of the error's message.
    Bundle(BundleError),
    /// 7: the table cannot be applied; the detail is the CRC-32 of the error's message.
    Apply(ApplyError),
    /// 8: the memory does not hold the arenas of this kind of case.
    Memory,
    /// 9: the volume form is unsound or cannot be evaluated; the detail is the CRC-32 of the error's
    /// message.
    Enclosed(EnclosedError),
    /// 20: the rig is unsound or cannot be posed; the detail is the CRC-32 of the error's message.
    Rig(RigError),
    /// 21: the springs are unsound or cannot be moved; the detail is the CRC-32 of the error's message.
    Springs(SpringsError),
    /// 32: the goals' solver is unsound or cannot be run; the detail is the CRC-32 of the error's message.
    Inverse(InverseError),
    /// 34: the cells are unsound or do not fit the pose; the detail is the CRC-32 of the error's message.
    Health(HealthError),
    /// 35: the limits are unsound or a pose cannot be projected; the detail is the CRC-32 of the error's message.
    Project(ProjectError),
}

impl Status {
    /// The number of the status and its details.
    #[must_use]
    pub fn words(self) -> [u32; 4] {
        match self {
            Status::Done => [0, 0, 0, 0],
            Status::Malformed => [1, 0, 0, 0],
            Status::TooLong { words } => [2, words, word(CASE_WORDS_AT_MOST), 0],
            Status::GuardBroken { buffer } => [3, buffer, 0, 0],
            Status::Mesh(MeshError::ArenaTooSmall {
                arena,
                needed,
                given,
            }) => [4, arena as u32, word(needed), word(given)],
            Status::Mesh(error) => [5, checksum(&error), 0, 0],
            Status::Bundle(error) => [6, checksum(&error), 0, 0],
            Status::Apply(error) => [7, checksum(&error), 0, 0],
            Status::Memory => [8, 0, 0, 0],
            Status::Enclosed(error) => [9, checksum(&error), 0, 0],
            Status::Rig(error) => [20, checksum(&error), 0, 0],
            Status::Springs(error) => [21, checksum(&error), 0, 0],
            Status::Inverse(error) => [32, checksum(&error), 0, 0],
            Status::Health(error) => [34, checksum(&error), 0, 0],
            Status::Project(error) => [35, checksum(&error), 0, 0],
        }
    }
}

/// The CRC-32 of an error's message, which holds every field of it.
fn checksum(error: &dyn fmt::Display) -> u32 {
    struct Text(Digest<'static, u32>);

    impl fmt::Write for Text {
        fn write_str(&mut self, text: &str) -> fmt::Result {
            self.0.update(text.as_bytes());
            Ok(())
        }
    }

    let mut text = Text(CHECKSUM.digest());
    // Writing to a checksum never fails.
    let _ = fmt::write(&mut text, format_args!("{error}"));
    text.0.finalize()
}

/// A length as a word. On a device every length fits.
fn word(length: usize) -> u32 {
    u32::try_from(length).unwrap_or(u32::MAX)
}

/// Writes the results of cases one after the other.
pub struct Results<'a, S: Sink> {
    sink: &'a mut S,
}

impl<'a, S: Sink> Results<'a, S> {
    /// Starts a file of results for `cases` cases.
    pub fn begin(sink: &'a mut S, cases: u32) -> Self {
        let header: [u32; FILE_HEADER_WORDS] = [RESULTS_MAGIC, VERSION, cases];
        sink.write(header.as_bytes());
        Results { sink }
    }

    /// Starts the results of the case with this number.
    pub fn case(&mut self, number: u32) {
        self.sink.write(number.as_bytes());
    }

    /// Writes a section: its tag, a few words and points.
    pub(super) fn section(&mut self, tag: u32, words: &[u32], points: &[[i32; 3]]) {
        self.section_of(tag, words, points);
    }

    /// Writes a section: its tag, a few words and elements that are made of words.
    pub(super) fn section_of<T: IntoBytes + Immutable>(
        &mut self,
        tag: u32,
        words: &[u32],
        elements: &[T],
    ) {
        let elements = elements.as_bytes();
        let length = word(
            words
                .len()
                .saturating_add(elements.len() / size_of::<u32>()),
        );
        self.sink.write([tag, length].as_bytes());
        self.sink.write(words.as_bytes());
        self.sink.write(elements);
    }

    /// Starts a section of `length` words, which [`Self::words`] then writes.
    pub(super) fn begin_section(&mut self, tag: u32, length: usize) {
        self.sink.write([tag, word(length)].as_bytes());
    }

    /// Writes words of the section that was begun.
    pub(super) fn words(&mut self, words: &[u32]) {
        self.sink.write(words.as_bytes());
    }

    /// Writes the section that ends a case.
    pub fn end(&mut self, status: Status) {
        self.section(SECTION_END, &status.words(), &[]);
    }
}
