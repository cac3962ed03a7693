//! The bundle's first bytes.

use zerocopy::byteorder::little_endian::U32;
use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout, Unaligned};

/// The first eight bytes of every bundle.
pub const MAGIC: [u8; 8] = *b"octruss\0";

/// The version that this library reads and the baker writes.
pub const VERSION: u32 = 1;

/// [`Header::scheme`]: tetrahedra and octahedra.
pub const SCHEME_TET_OCT: u32 = 1;
/// [`Header::scheme`]: box-spline solids with major diagonals.
pub const SCHEME_BOX_SPLINE: u32 = 2;
/// [`Header::scheme`]: the averaged box-spline scheme.
pub const SCHEME_BOX_SPLINE_AVERAGED: u32 = 3;
/// [`Header::scheme`]: tetrahedra, octahedra, prisms and hexahedra together.
pub const SCHEME_MIXED: u32 = 4;

/// [`Header::scheme`]: Loop's surfaces. The codes of surfaces are 16 to 22.
pub const SCHEME_LOOP: u32 = 16;
/// [`Header::scheme`]: Loop's surfaces with Warren's weights.
pub const SCHEME_LOOP_WARREN: u32 = 17;
/// [`Header::scheme`]: Catmull and Clark's surfaces.
pub const SCHEME_CATMULL_CLARK: u32 = 18;
/// [`Header::scheme`]: Doo and Sabin's surfaces.
pub const SCHEME_DOO_SABIN: u32 = 19;
/// [`Header::scheme`]: square-root-3 surfaces.
pub const SCHEME_SQRT3: u32 = 20;
/// [`Header::scheme`]: butterfly surfaces.
pub const SCHEME_BUTTERFLY: u32 = 21;
/// [`Header::scheme`]: modified butterfly surfaces.
pub const SCHEME_BUTTERFLY_MODIFIED: u32 = 22;
/// [`Header::scheme`]: surfaces of triangles and quads by the triangle/quadrilateral scheme.
pub const SCHEME_TRI_QUAD: u32 = 23;

/// [`Header::boundary`] of surfaces: the rim is a cubic B-spline.
pub const RIM_SPLINE: u32 = 16;
/// [`Header::boundary`] of surfaces: the rim is a cubic B-spline with corners.
pub const RIM_SPLINE_WITH_CORNERS: u32 = 17;
/// [`Header::boundary`] of surfaces: the rim stays.
pub const RIM_FIXED: u32 = 18;

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
    /// What the solid's boundary or the surface's rim follows.
    pub boundary: U32,
    /// How many times the cage was refined.
    pub levels: U32,
    /// Control points of the cage.
    pub control_points: U32,
    /// Points of the model: rows of the last stage.
    pub rows: U32,
    /// Sections of the bundle.
    pub sections: U32,
    /// CRC-32 of the cage's connectivity.
    pub cage_checksum: U32,
    /// CRC-32 of the model's points at rest.
    pub model_checksum: U32,
    /// Zero.
    pub reserved: [u8; 56],
}

/// [`Section::kind`]: the control points of the cage at rest.
pub const SECTION_REST_CAGE: u32 = 1;
/// [`Section::kind`]: a [`Stage`].
pub const SECTION_STAGE: u32 = 2;
/// [`Section::kind`]: rows and taps of every group.
pub const SECTION_GROUPS: u32 = 3;
/// [`Section::kind`]: the control points of every group.
pub const SECTION_INDICES: u32 = 4;
/// [`Section::kind`]: the weights.
pub const SECTION_WEIGHTS: u32 = 5;
/// [`Section::kind`]: what the sums of every row start from, or its rest position.
pub const SECTION_STARTS: u32 = 6;
/// [`Section::kind`]: which point of the model each row is.
pub const SECTION_MODEL_POINTS: u32 = 7;
/// [`Section::kind`]: the form of an enclosed volume; [`Section::stage`] is the region, 0 for the whole
/// boundary.
pub const SECTION_VOLUME: u32 = 8;
/// [`Section::kind`]: an enclosed volume as a cubic polynomial of modes; [`Section::stage`] as in
/// [`SECTION_VOLUME`].
pub const SECTION_VOLUME_MODES: u32 = 9;

/// [`Section::kind`]: the faces round every row's point, for normals.
pub const SECTION_NORMALS: u32 = 10;

/// [`Section::kind`]: the cage's cells.
pub const SECTION_CELLS: u32 = 16;

/// [`Section::kind`]: limits of poses.
pub const SECTION_LIMITS: u32 = 12;

/// [`Section::kind`]: a skeleton that carries the control points.
pub const SECTION_RIG: u32 = 13;

/// [`Section::kind`]: damped springs between the control points.
pub const SECTION_SPRINGS: u32 = 14;

/// [`Section::kind`]: the centroid of an enclosed solid by modes; [`Section::stage`] as in
/// [`SECTION_VOLUME`].
pub const SECTION_CENTROID_MODES: u32 = 15;

/// [`Section::kind`]: a solver for goals over modes; [`Section::stage`] is its number: 0 for effectors, 1 for sensors.
pub const SECTION_INVERSE: u32 = 11;

/// [`Section::kind`]: the displacements of actuators, and the rows of effectors.
pub const SECTION_ACTUATION: u32 = 17;

/// What the section of normals starts with: 16 bytes. The fans follow, `u16` each.
#[derive(Clone, Copy, Debug, FromBytes, IntoBytes, Immutable, KnownLayout, Unaligned)]
#[repr(C)]
pub struct NormalsRecord {
    /// Rows of the table.
    pub rows: U32,
    /// Edges are in units of `2^shift` units in the last place of a coordinate; 0 to 5.
    pub shift: U32,
    /// How many `u16` follow.
    pub words: U32,
    /// Zero.
    pub reserved: [u8; 4],
}

/// An entry of the section table, which follows the header: 16 bytes.
#[derive(Clone, Copy, Debug, FromBytes, IntoBytes, Immutable, KnownLayout, Unaligned)]
#[repr(C)]
pub struct Section {
    /// What the section holds. Readers skip kinds that they do not know.
    pub kind: U32,
    /// The stage that it belongs to; 0 where that means nothing.
    pub stage: U32,
    /// First byte, counted from the bundle's first; a multiple of 8.
    pub offset: U32,
    /// Bytes, without the padding behind it.
    pub bytes: U32,
}

/// [`Stage::format`]: weights of 32 bits with 30 fraction bits, 32-bit coordinates.
pub const FORMAT_Q30: u32 = 1;
/// [`Stage::format`]: weights of 16 bits with 14 fraction bits, 32-bit coordinates.
pub const FORMAT_Q14: u32 = 2;
/// [`Stage::format`]: weights of 16 bits with 14 fraction bits in pairs of rows, 16-bit displacements.
pub const FORMAT_COMPACT: u32 = 3;

/// [`Stage::starts`]: none; the stage has the absolute form only.
pub const STARTS_NONE: u32 = 0;
/// [`Stage::starts`]: three 32-bit sums a row.
pub const STARTS_NARROW: u32 = 1;
/// [`Stage::starts`]: three 64-bit sums a row.
pub const STARTS_WIDE: u32 = 2;
/// [`Stage::starts`]: three 32-bit coordinates a row, the rest position.
pub const STARTS_REST: u32 = 3;

/// What a stage of the table is: 32 bytes.
#[derive(Clone, Copy, Debug, FromBytes, IntoBytes, Immutable, KnownLayout, Unaligned)]
#[repr(C)]
pub struct Stage {
    /// Points that the rows are sums of: the control points, or the rows of the stage before.
    pub inputs: U32,
    /// Rows.
    pub rows: U32,
    /// How weights and inputs are stored.
    pub format: U32,
    /// What the sums start from.
    pub starts: U32,
    /// Shift of 16-bit displacements; 0 in other formats.
    pub displacement_shift: U32,
    /// Zero.
    pub reserved: [u8; 12],
}
