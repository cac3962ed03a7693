//! Writes bundles and opens them from files.
//!
//! The layout is core's ([`octruss::bundle`]). What the two checksums of its header are taken of is
//! said here: [`cage_checksum`], [`model_checksum`].

use crate::error::{Error, Result};
use crate::mesh::{Cells, Point};
use crate::refine::{BoundaryRule, Scheme};
use crate::table::format::Format;
use crate::table::quantise::{ONE, QuantisedRow};
use octruss::bundle::{self, Bundle, Header, RESIDUAL_LIMIT, Sections};
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
    /// The scheme.
    pub scheme: Scheme,
    /// What the boundary followed.
    pub boundary: BoundaryRule,
    /// How many times the cage was refined.
    pub levels: u32,
    /// Bits of the cage at rest.
    pub rest_cage: &'a [[i32; 3]],
    /// Bits of the model at rest, a point for each row.
    pub rest_model: &'a [[i32; 3]],
    /// The table.
    pub rows: &'a [QuantisedRow],
    /// See [`cage_checksum`].
    pub cage_checksum: u32,
    /// See [`model_checksum`].
    pub model_checksum: u32,
}

/// CRC-32 of a cage's connectivity: the numbers of vertices, tetrahedra and octahedra, then the
/// corners of all tetrahedra, then those of all octahedra, each number as 32 bits, least
/// significant byte first.
pub fn cage_checksum(vertices: usize, cells: &Cells) -> u32 {
    let counts = [vertices, cells.tetrahedra.len(), cells.octahedra.len()];
    let words = counts.into_iter().map(|count| count as u32);
    let bytes: Vec<u8> = words
        .chain(cells.corners().flatten().copied())
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
/// If a count does not fit, or a point moved so far from its rest position that its residual does
/// not.
pub fn write(contents: &Contents<'_>) -> Result<Vec<u8>> {
    let taps: usize = contents.rows.iter().map(|row| row.taps.len()).sum();
    let sections = Sections::new(contents.rest_cage.len(), contents.rows.len(), taps)
        .filter(|sections| u32::try_from(sections.total).is_ok())
        .ok_or_else(|| Error::new("the table does not fit into 4 GiB"))?;
    let mut bytes = vec![0; sections.total];
    let header = header(contents, taps, sections.total);
    bytes[..size_of::<Header>()].copy_from_slice(header.as_bytes());
    let residuals = residuals(contents)?;
    fill(
        &mut bytes[sections.residuals],
        residuals.into_iter().flatten().map(i64::to_le_bytes),
    );
    fill(
        &mut bytes[sections.rest_cage],
        contents.rest_cage.iter().flatten().map(|c| c.to_le_bytes()),
    );
    let ends = contents.rows.iter().scan(0_u32, |end, row| {
        *end += row.taps.len() as u32;
        Some(*end)
    });
    fill(
        &mut bytes[sections.row_starts],
        std::iter::once(0).chain(ends).map(u32::to_le_bytes),
    );
    let all_taps = || contents.rows.iter().flat_map(|row| &row.taps);
    fill(
        &mut bytes[sections.weights],
        all_taps().map(|(_, weight)| weight.to_le_bytes()),
    );
    fill(
        &mut bytes[sections.indices],
        all_taps().map(|(point, _)| (*point as u16).to_le_bytes()),
    );
    let checksum = bundle::checksum(&bytes).to_le_bytes();
    bytes[std::mem::offset_of!(Header, checksum)..][..checksum.len()].copy_from_slice(&checksum);
    Ok(bytes)
}

fn fill<const N: usize>(section: &mut [u8], numbers: impl Iterator<Item = [u8; N]>) {
    let (places, _) = section.as_chunks_mut::<N>();
    for (place, number) in places.iter_mut().zip(numbers) {
        *place = number;
    }
}

fn header(contents: &Contents<'_>, taps: usize, total: usize) -> Header {
    let mut unit = [0; LONGEST_UNIT];
    for (place, byte) in unit.iter_mut().zip(contents.unit.bytes()) {
        *place = byte;
    }
    let scheme = match contents.scheme {
        Scheme::TetOct => bundle::SCHEME_TET_OCT,
        Scheme::BoxSpline => bundle::SCHEME_BOX_SPLINE,
        Scheme::BoxSplineAveraged => bundle::SCHEME_BOX_SPLINE_AVERAGED,
    };
    Header {
        magic: bundle::MAGIC,
        version: bundle::VERSION.into(),
        total_bytes: (total as u32).into(),
        checksum: 0.into(),
        fraction_bits: contents.format.fraction_bits.into(),
        unit,
        scheme: scheme.into(),
        boundary: contents.boundary.code().into(),
        levels: contents.levels.into(),
        control_points: (contents.rest_cage.len() as u32).into(),
        rows: (contents.rows.len() as u32).into(),
        taps: (taps as u32).into(),
        cage_checksum: contents.cage_checksum.into(),
        model_checksum: contents.model_checksum.into(),
        reserved: [0; 56],
    }
}

/// What the displacement form starts its sums from: the rest position less what the weights make
/// of the rest cage, in units of 2^-30.
fn residuals(contents: &Contents<'_>) -> Result<Vec<[i64; 3]>> {
    let residual = |(index, (rest, row)): (usize, (&[i32; 3], &QuantisedRow))| {
        let of_axis: [i64; 3] = std::array::from_fn(|axis| {
            let weighted = |(point, weight): &(u32, i32)| {
                i64::from(*weight) * i64::from(contents.rest_cage[*point as usize][axis])
            };
            // At most 2^61 and 2^62: the difference fits.
            i64::from(rest[axis]) * ONE - row.taps.iter().map(weighted).sum::<i64>()
        });
        if of_axis
            .iter()
            .all(|residual| residual.unsigned_abs() <= RESIDUAL_LIMIT.unsigned_abs())
        {
            return Ok(of_axis);
        }
        Err(Error::new(format!(
            "point {index} (counted from 0) lies more than half the coordinates' range from the place that the cage gives it"
        ))
        .advise("bake with fewer --fraction-bits, or move the point into the cage"))
    };
    contents
        .rest_model
        .iter()
        .zip(contents.rows)
        .enumerate()
        .map(residual)
        .collect()
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
