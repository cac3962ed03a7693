//! Why bytes are no bundle, or not the one that was wanted.

use core::fmt;

use crate::control::actuation::ActuationError;
use crate::control::health::HealthError;
use crate::control::inverse::InverseError;
use crate::control::project::ProjectError;
use crate::control::rig::RigError;
use crate::control::springs::SpringsError;
use crate::enclosed::EnclosedError;

/// Why a bundle cannot be opened.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum BundleError {
    /// This machine is big-endian; a bundle is read in place and is little-endian.
    ByteOrder,
    /// The first byte does not lie on a multiple of [`ALIGNMENT`](super::ALIGNMENT):
    /// [`include_bundle!`](crate::include_bundle) does that.
    Unaligned,
    /// Shorter than its header says, or than a header.
    Truncated {
        /// Bytes needed.
        needed: usize,
        /// Bytes given.
        given: usize,
    },
    /// Longer than its header says.
    TrailingBytes {
        /// Bytes of the bundle.
        needed: usize,
        /// Bytes given.
        given: usize,
    },
    /// The first bytes are not those of a bundle.
    Magic,
    /// Another version of the format: bake the table again with this version of the tools.
    Version {
        /// The bundle's version.
        found: u32,
    },
    /// The bytes were changed after they were written.
    Checksum {
        /// What the header says.
        stored: u32,
        /// What the bytes give.
        computed: u32,
    },
    /// A field of the header, or the padding, has a value that no baker writes.
    Header,
    /// A section does not lie where it must, or is there twice.
    Section {
        /// Its entry in the section table, counted from 0.
        index: u32,
    },
    /// A stage is missing, of an unknown format, or its parts do not fit one another.
    Stage {
        /// The stage, counted from 0.
        stage: u32,
    },
    /// A row names a control point that does not exist.
    ControlPoint {
        /// The row.
        row: u32,
    },
    /// A row's weights do not add up to one, or their magnitudes to more than two.
    Weights {
        /// The row.
        row: u32,
    },
    /// A row's start value is larger than [`START_LIMIT`](super::START_LIMIT).
    Start {
        /// The row.
        row: u32,
    },
    /// A volume form is not sound.
    Volume(EnclosedError),
    /// A rig is not sound.
    Rig(RigError),
    /// Springs are not sound.
    Springs(SpringsError),
    /// The cage's cells are not sound.
    Cells(HealthError),
    /// Limits of poses are not sound.
    Limits(ProjectError),
    /// Actuators are not sound.
    Actuation(ActuationError),
    /// A solver for goals is not sound.
    Inverse(InverseError),
    /// The faces round the point of a row are not sound: a neighbour that does not exist, too many corners,
    /// or lengths that do not fit. The number of rows if it is not the fault of a row.
    Normals {
        /// The row.
        row: u32,
    },
    /// A row names a point that the model does not have.
    ModelPoints,
    /// The bundle holds another kind of table than was asked for: for 32-bit coordinates or 16-bit
    /// displacements, direct or factored.
    OtherTable,
    /// The coordinate format is not the one that the program uses.
    FractionBits {
        /// Fraction bits of the bundle.
        bundle: u32,
        /// Fraction bits of the program's type.
        wanted: u32,
    },
}

impl fmt::Display for BundleError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::ByteOrder => f.write_str("a bundle cannot be read in place on a big-endian machine"),
            Self::Unaligned => f.write_str(
                "the bundle does not start on a multiple of 8 bytes: include it with include_bundle!",
            ),
            Self::Truncated { needed, given } => {
                write!(f, "the bundle is cut short: {given} bytes of {needed}")
            }
            Self::TrailingBytes { needed, given } => {
                write!(f, "{given} bytes were given, but the bundle ends after {needed}")
            }
            Self::Magic => f.write_str("these bytes are no octruss bundle"),
            Self::Version { found } => write!(
                f,
                "the bundle has version {found}, this library reads version {}: bake it again",
                super::VERSION
            ),
            Self::Checksum { stored, computed } => write!(
                f,
                "the bundle is damaged: its checksum is {stored:08x}, its bytes give {computed:08x}"
            ),
            Self::Header => f.write_str("the bundle's header holds a value that no baker writes"),
            Self::Section { index } => write!(f, "section {index} of the bundle lies in a wrong place"),
            Self::Stage { stage } => write!(
                f,
                "stage {stage} of the table is missing, or of a format that this library does not know"
            ),
            Self::ControlPoint { row } => {
                write!(f, "row {row} names a control point that does not exist")
            }
            Self::Weights { row } => write!(
                f,
                "the weights of row {row} do not add up to one, or their magnitudes to more than two"
            ),
            Self::Start { row } => write!(f, "the start value of row {row} is too large"),
            Self::Volume(error) => write!(f, "the bundle's volume form is not sound: {error}"),
            Self::Rig(error) => write!(f, "the bundle's rig is not sound: {error}"),
            Self::Cells(error) => write!(f, "the bundle's cells are not sound: {error}"),
            Self::Limits(error) => write!(f, "the bundle's limits are not sound: {error}"),
            Self::Springs(error) => write!(f, "the bundle's springs are not sound: {error}"),
            Self::Actuation(error) => write!(f, "the bundle's actuators are not sound: {error}"),
            Self::Inverse(error) => write!(f, "the bundle's solver for goals is not sound: {error}"),
            Self::Normals { row } => {
                write!(f, "the faces round the point of row {row} are not sound")
            }
            Self::ModelPoints => f.write_str("a row names a point that the model does not have"),
            Self::OtherTable => f.write_str(
                "the bundle holds another kind of table: bake it again with the --format that the program uses",
            ),
            Self::FractionBits { bundle, wanted } => write!(
                f,
                "the bundle's coordinates have {bundle} fraction bits, the program's {wanted}: \
                 bake it again with --fraction-bits {wanted}, or use the other type"
            ),
        }
    }
}

impl core::error::Error for BundleError {}
