//! Case files: how a host asks for core's results and how they come back.
//!
//! The image `conformance` reads the file `cases.bin` and writes `results.bin`. The host runs the
//! very same function ([`run`]) on the same cases with memory of the same size ([`Memory`]), so
//! its results must be equal in every word, errors included.
//!
//! Both files are words: unsigned 32-bit numbers, little-endian. Signed numbers are in two's
//! complement. Every part tells its own length, so a reader can pass over what it does not know.
//!
//! # Cases
//!
//! | words | what |
//! | --- | --- |
//! | 1 | the letters `OCTC` |
//! | 1 | [`VERSION`] |
//! | 1 | number of cases |
//! | | the cases |
//!
//! A case:
//!
//! | words | what |
//! | --- | --- |
//! | 1 | its kind: [`REFINE`] or another of the constants below |
//! | 1 | a number that the results repeat |
//! | 1 | number of words n that follow |
//! | n | what the kind says: see the module of each kind |
//!
//! # Results
//!
//! | words | what |
//! | --- | --- |
//! | 1 | the letters `OCTR` |
//! | 1 | [`VERSION`] |
//! | 1 | number of cases |
//! | | the results of each case, in order |
//!
//! The results of a case are its number (one word), then sections. A section is a tag, the number
//! of words n that follow, and these. The last section of a case has the tag [`SECTION_END`] and
//! four words: a [`Status`] and three details.
//!
//! | tag | words |
//! | --- | --- |
//! | [`SECTION_END`] | status, three details |
//! | [`SECTION_CELLS`] | level, then number of elements and CRC-32 of tetrahedra, octahedra, surface triangles, creases and corners at that level |
//! | [`SECTION_POINTS`] | level, coordinates saturated so far, x y z of each vertex at that level |
//! | [`SECTION_ROWS`] | coordinates saturated, coordinates of displacements clamped to 16 bits, x y z of each row |
//! | [`SECTION_DIAGONALS`] | level, then number and CRC-32 of the major diagonals (a byte each) of tetrahedra and octahedra at that level |
//! | [`SECTION_IMPROPER_FACES`] | three corners of each face where major diagonals clash |
//! | [`SECTION_FACES`] | level, vertices, then number of elements and CRC-32 of the faces' offsets, their corners, creases and corners at that level, and 1 after an odd number of square-root-3 steps |
//! | [`SECTION_LIMIT`] | level, coordinates saturated so far, x y z of each limit position of that level |
//! | [`SECTION_TRIANGLE`] | generation, corners, neighbours, x y z of the corners and of their limits |
//! | [`SECTION_MIXED_CELLS`] | level, vertices, then number of elements and CRC-32 of tetrahedra, octahedra, prisms, hexahedra, surface triangles, surface quadrilaterals, creases and corners at that level |
//! | [`SECTION_BOUNDARY`] | number of elements and CRC-32 of the triangles, then of the quadrilaterals of a boundary |
//! | [`SECTION_VOLUME`] | see [`volume`]; numbers of 64 bits have their low word first |
//! | [`SECTION_NORMALS`] | how many are zero, x y z of the normal of each row |
//! | [`SECTION_SCALARS`] | values saturated, the channels of each row |
//! | [`SECTION_CHANNELS`] | level, values saturated so far, the channels of each vertex at that level |
//! | [`SECTION_RIG`] | see [`rig`]; numbers of 64 bits have their low word first |
//! | [`SECTION_SPRINGS`] | see [`springs`] |
//! | [`SECTION_LABELS`] | level, the label of each tetrahedron at that level; then the same of octahedra |
//! | [`SECTION_LIMIT_NORMALS`] | level, how many are zero, x y z of the limit normal of each corner of each face (Doo-Sabin: of each face) at that level |
//! | [`SECTION_HEALTH`] | see [`health`] |
//! | [`SECTION_INVERSE`] | see [`inverse`] |
//! | [`SECTION_PROJECT`] | see [`project`] |

pub mod apply;
pub mod box_spline;
pub mod data;
pub mod health;
pub mod inverse;
pub mod mixed;
pub mod project;
pub mod refine;
mod results;
pub mod rig;
pub mod scalars;
pub mod solid;
mod space;
pub mod springs;
pub mod sqrt3;
pub mod surface;
pub mod update;
pub mod volume;

pub use results::{Results, Sink, Status};
pub use space::Memory;

use crc::{CRC_32_ISO_HDLC, Crc};
use zerocopy::{Immutable, IntoBytes};

/// The checksum of lists and messages.
static CHECKSUM: Crc<u32> = Crc::<u32>::new(&CRC_32_ISO_HDLC);

/// The first word of a case file.
pub const CASES_MAGIC: u32 = u32::from_le_bytes(*b"OCTC");
/// The first word of a file of results.
pub const RESULTS_MAGIC: u32 = u32::from_le_bytes(*b"OCTR");
/// The version of both files.
pub const VERSION: u32 = 1;
/// Words of a file's header.
pub const FILE_HEADER_WORDS: usize = 3;
/// Words of a case before what its kind says.
pub const CASE_HEADER_WORDS: usize = 3;
/// Words that a case may have behind its header.
pub const CASE_WORDS_AT_MOST: usize = 2048;

/// Kind of a case: refine a solid in slices.
pub const REFINE: u32 = 1;
/// Kind of a case: refine a solid in core's own arenas of a fixed size.
pub const REFINE_OWNED: u32 = 2;
/// Kind of a case: open a bundle and apply its table to a pose.
pub const APPLY: u32 = 3;
/// Kind of a case: refine a box-spline solid in slices.
pub const BOX_SPLINE: u32 = 4;
/// Kind of a case: refine a box-spline solid in core's own arenas of a fixed size.
pub const BOX_SPLINE_OWNED: u32 = 5;
/// Kind of a case: refine a control mesh.
pub const SURFACE: u32 = 6;
/// Kind of a case: refine a control mesh adaptively by the square-root-3 scheme.
pub const SQRT3_ADAPTIVE: u32 = 7;
/// Kind of a case: take a vertex of the square-root-3 scheme several steps on at once.
pub const SQRT3_STEPS: u32 = 8;
/// Kind of a case: evaluate a volume form.
pub const VOLUME: u32 = 9;
/// Kind of a case: evaluate a volume's polynomial in modes.
pub const VOLUME_MODES: u32 = 10;
/// Kind of a case: refine a mixed solid in slices.
pub const MIXED: u32 = 11;
/// Kind of a case: refine a mixed solid in core's own arenas of a fixed size.
pub const MIXED_OWNED: u32 = 12;
/// Kind of a case: find a centroid by modes.
pub const CENTROID_MODES: u32 = 25;
/// Kind of a case: open a bundle and carry scalar channels through its table.
pub const APPLY_SCALARS: u32 = 16;
/// Kind of a case: refine channels and hand on labels of a solid in slices.
pub const REFINE_DATA: u32 = 17;
/// Kind of a case: apply a table again where control points moved, with factored tables and normals too.
pub const UPDATE: u32 = 20;
/// Kind of a case: refine a control mesh and find its limit normals.
pub const LIMIT_NORMALS: u32 = 30;

/// Kind of a case: pose a rig.
pub const RIG: u32 = 40;
/// Kind of a case: sines and cosines of angles.
pub const TURN: u32 = 41;

/// Kind of a case: points on springs, tick by tick.
pub const SPRINGS: u32 = 42;
/// Kind of a case: points on springs that are shaken at random, by hashes of their state.
pub const SHAKES: u32 = 43;
/// Kind of a case: find amplitudes for goals while a volume is held.
pub const INVERSE: u32 = 32;
/// Kind of a case: find amplitudes for measured points.
pub const SENSORS: u32 = 33;
/// Kind of a case: tell the health of a pose.
pub const HEALTH: u32 = 34;
/// Kind of a case: find the nearest pose under limits and volumes.
pub const PROJECT: u32 = 35;

/// Tag of the section that ends a case.
pub const SECTION_END: u32 = 0;
/// Tag of a section about the cells of a level.
pub const SECTION_CELLS: u32 = 1;
/// Tag of a section with the points of a level.
pub const SECTION_POINTS: u32 = 2;
/// Tag of a section with rows of a table.
pub const SECTION_ROWS: u32 = 3;
/// Tag of a section about the major diagonals of a level.
pub const SECTION_DIAGONALS: u32 = 4;
/// Tag of a section with the faces where major diagonals clash.
pub const SECTION_IMPROPER_FACES: u32 = 5;
/// Tag of a section about the faces of a control mesh at a level.
pub const SECTION_FACES: u32 = 6;
/// Tag of a section with limit positions.
pub const SECTION_LIMIT: u32 = 7;
/// Tag of a section with a triangle of an adaptive mesh.
pub const SECTION_TRIANGLE: u32 = 8;
/// Tag of a section with volumes and gradients.
pub const SECTION_VOLUME: u32 = 9;
/// Tag of a section about the cells of a mixed solid at a level.
pub const SECTION_MIXED_CELLS: u32 = 10;
/// Tag of a section about the boundary of a mixed solid.
pub const SECTION_BOUNDARY: u32 = 11;
/// Tag of a section with normals.
pub const SECTION_NORMALS: u32 = 20;
/// Tag of a section with channels of rows of a table.
pub const SECTION_SCALARS: u32 = 16;
/// Tag of a section with the channels of a level.
pub const SECTION_CHANNELS: u32 = 17;
/// Tag of a section with the labels of the cells of one shape at a level.
pub const SECTION_LABELS: u32 = 18;
/// Tag of a section with limit normals.
pub const SECTION_LIMIT_NORMALS: u32 = 30;

/// Tag of a section with the joints and control points of a rig, or sines and cosines.
pub const SECTION_RIG: u32 = 40;

/// Tag of a section with points on springs or the hash of their state.
pub const SECTION_SPRINGS: u32 = 42;
/// Tag of a section with the amplitudes and the report of a tick.
pub const SECTION_INVERSE: u32 = 32;
/// Tag of a section with the health of a pose.
pub const SECTION_HEALTH: u32 = 34;
/// Tag of a section with a projected pose and its report.
pub const SECTION_PROJECT: u32 = 35;

/// Runs one case: `words` is what follows its header. Results go to `results`, whatever happens.
///
/// Nothing here panics or takes more than `memory`: a case that is malformed, wrong or too large
/// has results that say so.
pub fn run<S: Sink>(kind: u32, words: &[u32], memory: &mut Memory, results: &mut Results<'_, S>) {
    let done = match kind {
        REFINE => refine::run(words, memory, results),
        REFINE_OWNED => refine::run_owned(words, memory, results),
        APPLY => apply::run(words, memory.space(), results),
        BOX_SPLINE => box_spline::run(words, memory, results),
        BOX_SPLINE_OWNED => box_spline::run_owned(words, memory, results),
        SURFACE => surface::run(words, memory, results),
        SQRT3_ADAPTIVE => sqrt3::run_adaptive(words, memory, results),
        SQRT3_STEPS => sqrt3::run_steps(words, results),
        VOLUME => volume::run(words, memory.space(), results),
        VOLUME_MODES => volume::run_modes(words, memory.space(), results),
        CENTROID_MODES => volume::run_centroid(words, memory.space(), results),
        MIXED => mixed::run(words, memory, results),
        MIXED_OWNED => mixed::run_owned(words, memory.space(), results),
        UPDATE => update::run(words, memory.space(), results),
        APPLY_SCALARS => scalars::run(words, memory.space(), results),
        LIMIT_NORMALS => surface::run_normals(words, memory, results),
        REFINE_DATA => data::run(words, memory, results),
        RIG => rig::run(words, memory.space(), results),
        TURN => rig::run_turn(words, results),
        SPRINGS => springs::run(words, memory.space(), results),
        SHAKES => springs::run_shakes(words, memory.space(), results),
        INVERSE => inverse::run(words, results),
        SENSORS => inverse::run_sensors(words, results),
        HEALTH => health::run(words, results),
        PROJECT => project::run(words, memory.space(), results),
        _ => Err(Status::Malformed),
    };
    results.end(done.err().unwrap_or(Status::Done));
}

/// The length of a list and the CRC-32 of its bytes.
#[must_use]
pub fn summary<Element: IntoBytes + Immutable>(list: &[Element]) -> [u32; 2] {
    let length = u32::try_from(list.len()).unwrap_or(u32::MAX);
    [length, CHECKSUM.checksum(list.as_bytes())]
}

/// Takes things off the front of a case's words.
struct Words<'a>(&'a [u32]);

impl<'a> Words<'a> {
    /// The next word.
    fn word(&mut self) -> Result<u32, Status> {
        let (&first, rest) = self.0.split_first().ok_or(Status::Malformed)?;
        self.0 = rest;
        Ok(first)
    }

    /// The next word as a length.
    fn length(&mut self) -> Result<usize, Status> {
        usize::try_from(self.word()?).map_err(|_| Status::Malformed)
    }

    /// The next signed number of 64 bits, the low word first.
    fn number(&mut self) -> Result<i64, Status> {
        let [low, high] = [self.word()?, self.word()?].map(u64::from);
        Ok((low | (high << 32)).cast_signed())
    }

    /// The next `count` elements of `N` words.
    fn elements<const N: usize>(&mut self, count: usize) -> Result<&'a [[u32; N]], Status> {
        let words = count.checked_mul(N).ok_or(Status::Malformed)?;
        let (taken, rest) = self.0.split_at_checked(words).ok_or(Status::Malformed)?;
        self.0 = rest;
        Ok(taken.as_chunks().0)
    }

    /// The next `count` points: raw bits of x, y and z.
    fn points(&mut self, count: usize) -> Result<&'a [[i32; 3]], Status> {
        self.values(count)
    }

    /// The next `count` elements of `N` signed numbers.
    fn values<const N: usize>(&mut self, count: usize) -> Result<&'a [[i32; N]], Status> {
        let numbers = count.checked_mul(N).ok_or(Status::Malformed)?;
        Ok(self.numbers(numbers)?.as_chunks().0)
    }

    /// The next `count` signed numbers.
    fn numbers(&mut self, count: usize) -> Result<&'a [i32], Status> {
        use zerocopy::FromBytes;
        let words: &[[u32; 1]] = self.elements(count)?;
        // The same size and alignment, so this is never refused.
        <[i32]>::ref_from_bytes(words.as_bytes()).map_err(|_| Status::Malformed)
    }

    /// Nothing may be left.
    fn finish(self) -> Result<(), Status> {
        if self.0.is_empty() {
            Ok(())
        } else {
            Err(Status::Malformed)
        }
    }
}
