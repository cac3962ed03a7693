//! The bundle's first bytes.

use zerocopy::byteorder::little_endian::U32;
use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout, Unaligned};

/// The first eight bytes of every bundle.
pub const MAGIC: [u8; 8] = *b"octruss\0";

/// The version that this library reads and the baker writes.
pub const VERSION: u32 = 0;

/// [`Header::scheme`]: tetrahedra and octahedra.
pub const SCHEME_TET_OCT: u32 = 1;
/// [`Header::scheme`]: box-spline solids with major diagonals.
pub const SCHEME_BOX_SPLINE: u32 = 2;
/// [`Header::scheme`]: the averaged box-spline scheme.
pub const SCHEME_BOX_SPLINE_AVERAGED: u32 = 3;

/// [`Header::boundary`]: Loop's scheme with its weights of 1987.
pub const BOUNDARY_LOOP: u32 = 1;
/// [`Header::boundary`]: Loop's scheme with Warren's weights.
pub const BOUNDARY_LOOP_WARREN: u32 = 2;
/// [`Header::boundary`]: the triangle/quad scheme.
pub const BOUNDARY_TRI_QUAD: u32 = 3;
/// [`Header::boundary`]: the interior rule everywhere.
pub const BOUNDARY_INTERIOR: u32 = 4;
/// [`Header::boundary`]: the boundary polyhedron kept.
pub const BOUNDARY_FIXED: u32 = 5;

/// The bundle's header: 128 bytes.
#[derive(Clone, Copy, Debug, FromBytes, IntoBytes, Immutable, KnownLayout, Unaligned)]
#[repr(C)]
pub struct Header {
    /// [`MAGIC`].
    pub magic: [u8; 8],
    /// [`VERSION`].
    pub version: U32,
    /// Bytes of the whole bundle, header and padding included.
    pub total_bytes: U32,
    /// CRC-32 of the whole bundle with this field set to zero.
    pub checksum: U32,
    /// Fraction bits of the coordinate format, 0 to 32.
    pub fraction_bits: U32,
    /// Name of the unit that one whole coordinate step stands for ("mm"), padded with zeros.
    pub unit: [u8; 16],
    /// The scheme that made the table.
    pub scheme: U32,
    /// What the solid's boundary follows.
    pub boundary: U32,
    /// How many times the cage was refined.
    pub levels: U32,
    /// Control points of the cage.
    pub control_points: U32,
    /// Rows of the table: points of the model.
    pub rows: U32,
    /// Taps of all rows.
    pub taps: U32,
    /// CRC-32 of the cage's connectivity.
    pub cage_checksum: U32,
    /// CRC-32 of the model's points at rest.
    pub model_checksum: U32,
    /// Zero.
    pub reserved: [u8; 56],
}
