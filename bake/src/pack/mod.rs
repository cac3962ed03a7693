//! Packing: from rows of integer weights to the sections of a bundle.
//!
//! [`group`] finds rows that share, or nearly share, their control points; [`sections`] writes groups in
//! the order in which core's kernels read them; [`writer`] puts sections into a bundle. The layout itself
//! is core's ([`octruss::bundle`], `docs/bundle.md`).

pub mod cost;
pub mod group;
pub mod normals;
pub mod sections;
pub mod writer;

/// A row: points in ascending order, with integer weights that are not zero.
pub type Taps = [(u32, i32)];

/// How weights and inputs are stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Layout {
    /// Weights of 30 fraction bits, 32-bit coordinates.
    Q30,
    /// Weights of 14 fraction bits, 32-bit coordinates.
    Q14,
    /// Weights of 14 fraction bits, 16-bit displacements in units of 2^shift.
    Compact {
        /// The shift.
        shift: u32,
    },
}

impl Layout {
    /// Fraction bits of the weights.
    pub fn weight_bits(self) -> u32 {
        match self {
            Self::Q30 => 30,
            Self::Q14 | Self::Compact { .. } => 14,
        }
    }

    /// Bytes of a weight.
    pub fn weight_bytes(self) -> usize {
        match self {
            Self::Q30 => 4,
            Self::Q14 | Self::Compact { .. } => 2,
        }
    }
}
