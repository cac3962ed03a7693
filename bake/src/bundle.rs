//! Writes bundles and opens them from files.
//!
//! The layout is core's ([`octruss::bundle`]). What the two checksums of its header are taken of is
//! said here: [`cage_checksum`], [`model_checksum`].

use crate::error::{Error, Result};
use crate::mesh::{Cells, Point};
use crate::pack::writer::{self, Section};
use crate::surface::SurfaceLevel;
use crate::table::format::Format;
use octruss::bundle::{self, Bundle, Header};
use std::path::Path;
use zerocopy::IntoBytes;

/// The longest name of a unit, in bytes.
pub const LONGEST_UNIT: usize = 16;

/// What a bundle is made of.
pub struct Contents<'a> {
    /// The coordinate format.
    pub format: Format,
    /// Name of the unit of the coordinates, at most [`LONGEST_UNIT`] bytes; may be empty.
    pub unit: &'a str,
    /// The scheme's number in the header.
    pub scheme: u32,
    /// The number of what the boundary followed.
    pub boundary: u32,
    /// How many times the cage was refined.
    pub levels: u32,
    /// Control points of the cage.
    pub control_points: usize,
    /// Points of the model.
    pub rows: usize,
    /// The sections.
    pub sections: &'a [Section],
    /// See [`cage_checksum`].
    pub cage_checksum: u32,
    /// See [`model_checksum`].
    pub model_checksum: u32,
}

/// CRC-32 of a cage's connectivity: the numbers of vertices, tetrahedra and octahedra, and if there
/// are any prisms or hexahedra the numbers of these two, then the corners of all tetrahedra,
/// octahedra, prisms and hexahedra, each number as 32 bits, least significant byte first.
pub fn cage_checksum(vertices: usize, cells: &Cells) -> u32 {
    let mut counts = vec![vertices, cells.tetrahedra.len(), cells.octahedra.len()];
    if !cells.is_tetrahedral() {
        counts.extend([cells.prisms.len(), cells.hexahedra.len()]);
    }
    let words = counts.into_iter().map(|count| count as u32);
    let bytes: Vec<u8> = words
        .chain(cells.corners().flatten().copied())
        .flat_map(u32::to_le_bytes)
        .collect();
    bundle::checksum_of(&bytes)
}

/// CRC-32 of a control mesh's connectivity: the numbers of vertices and faces, then for each face its
/// number of corners and the corners, each number as 32 bits, least significant byte first.
pub fn surface_checksum(level: &SurfaceLevel) -> u32 {
    let counts = [level.vertex_count, level.faces().count() as u32];
    let faces = level
        .faces()
        .flat_map(|face| std::iter::once(face.len() as u32).chain(face.iter().copied()));
    let bytes: Vec<u8> = counts
        .into_iter()
        .chain(faces)
        .flat_map(u32::to_le_bytes)
        .collect();
    bundle::checksum_of(&bytes)
}

/// CRC-32 of a model's points: x, y and z of every vertex in file order as double precision
/// numbers, least significant byte first, zeros without their sign.
pub fn model_checksum(points: &[Point]) -> u32 {
    // Adding zero turns -0 into 0 and changes nothing else.
    let bytes: Vec<u8> = points
        .iter()
        .flatten()
        .flat_map(|coordinate| (coordinate + 0.0).to_le_bytes())
        .collect();
    bundle::checksum_of(&bytes)
}

/// The bytes of a bundle.
///
/// # Errors
/// If it would be longer than 4 GiB.
pub fn write(contents: &Contents<'_>) -> Result<Vec<u8>> {
    writer::bundle(header(contents), contents.sections)
        .ok_or_else(|| Error::new("the table does not fit into 4 GiB"))
}

fn header(contents: &Contents<'_>) -> Header {
    let mut unit = [0; LONGEST_UNIT];
    for (place, byte) in unit.iter_mut().zip(contents.unit.bytes()) {
        *place = byte;
    }
    Header {
        magic: bundle::MAGIC,
        version: bundle::VERSION.into(),
        // The writer knows these.
        total_bytes: 0.into(),
        checksum: 0.into(),
        sections: 0.into(),
        fraction_bits: contents.format.fraction_bits.into(),
        unit,
        scheme: contents.scheme.into(),
        boundary: contents.boundary.into(),
        levels: contents.levels.into(),
        control_points: (contents.control_points as u32).into(),
        rows: (contents.rows as u32).into(),
        cage_checksum: contents.cage_checksum.into(),
        model_checksum: contents.model_checksum.into(),
        reserved: [0; 56],
    }
}

/// A bundle's bytes at the alignment that core asks for.
#[derive(Clone, Debug)]
pub struct BundleBytes {
    words: Vec<u64>,
    length: usize,
}

impl BundleBytes {
    /// Copies the bytes to where they are aligned.
    pub fn new(bytes: &[u8]) -> Self {
        let mut words = vec![0_u64; bytes.len().div_ceil(size_of::<u64>())];
        words.as_mut_bytes()[..bytes.len()].copy_from_slice(bytes);
        Self {
            words,
            length: bytes.len(),
        }
    }

    /// Reads a bundle from a file; [`BundleBytes::open`] checks it.
    pub fn read(file: &Path) -> Result<Self> {
        crate::read::bytes(file).map(|bytes| Self::new(&bytes))
    }

    /// The checked view.
    ///
    /// # Errors
    /// If the bytes are no sound bundle of the version that core reads.
    pub fn open(&self) -> Result<Bundle<'_>> {
        Bundle::new_checked(&self.words.as_bytes()[..self.length]).map_err(|error| {
            Error::new(error.to_string())
                .advise("bundles are written by `octruss bake`; bake it again")
        })
    }
}
