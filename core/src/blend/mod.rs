//! Weighted sums over any value type.
//!
//! The topological code of the left wing is written once. It says which values enter a new
//! vertex with which integer weights, and by which integer the sum is divided; a [`Blend`] says
//! what that means: fixed-point coordinates with one rounding ([`FixedBlend`]), double precision,
//! sparse rows over the control points, exact rationals. A [`GuardedBlend`] adds what schemes need
//! that round in between.

mod fixed_point;
mod guarded;

pub use fixed_point::FixedBlend;
pub use guarded::{Distortion, GUARD_BITS, GuardedBlend};

/// Fraction bits of an irrational weight once it is rounded for the device.
pub const WEIGHT_BITS: u32 = 30;

/// The weight of one neighbour of a vertex in a rule of the form
/// `own + weight * sum(neighbour - own)`.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum NeighbourWeight {
    /// A weight that is rational for its valence stays an exact fraction.
    Exact {
        /// Numerator.
        numerator: i64,
        /// Denominator, positive.
        denominator: i64,
    },
    /// An irrational weight.
    Irrational {
        /// The device's weight, in units of 2^-30: the real number rounded once.
        bits: i64,
        /// The real number in double precision, for value types that are not held to a grid.
        real: f64,
    },
}

/// An irrational weight of a mask that is counted in units of 2^-30.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct IrrationalWeight {
    /// The device's weight, in units of 2^-30.
    pub bits: i64,
    /// The real number.
    pub real: f64,
}

/// A value type that a mesh can carry, and how a weighted sum of it is formed.
///
/// A rule calls [`Blend::zero`], then [`Blend::add`] for every value that enters, and ends with
/// [`Blend::divide`] or [`Blend::umbrella`], the only places where a value may be rounded.
pub trait Blend {
    /// What a vertex stores.
    type Point: Clone;
    /// A sum before its division. It must hold every sum of a mask exactly.
    type Sum: Clone;

    /// The empty sum.
    fn zero(&self) -> Self::Sum;

    /// `sum += weight * point`.
    fn add(&self, sum: &mut Self::Sum, weight: i64, point: &Self::Point);

    /// `sum += weight * other`.
    fn add_sum(&self, sum: &mut Self::Sum, weight: i64, other: &Self::Sum);

    /// `sum += weight * 2^30 * point`.
    ///
    /// The default takes the device's weight. A value type of real numbers overrides it to use the
    /// real weight.
    fn add_irrational(&self, sum: &mut Self::Sum, weight: IrrationalWeight, point: &Self::Point) {
        self.add(sum, weight.bits, point);
    }

    /// `sum / denominator`, rounded if the value type rounds. `denominator` is positive.
    fn divide(&mut self, sum: &Self::Sum, denominator: i64) -> Self::Point;

    /// `own + weight * sum(neighbour - own)`, where `ring` is the sum of the neighbours and
    /// `valence` their number.
    ///
    /// The default takes the device's weight: exact fractions as they are, irrational ones in
    /// units of 2^-30. A value type of real numbers overrides it to use the real weight.
    fn umbrella(
        &mut self,
        own: &Self::Point,
        ring: &Self::Sum,
        valence: i64,
        weight: NeighbourWeight,
    ) -> Self::Point {
        let (numerator, denominator) = match weight {
            NeighbourWeight::Exact {
                numerator,
                denominator,
            } => (numerator, denominator),
            NeighbourWeight::Irrational { bits, .. } => (bits, 1 << WEIGHT_BITS),
        };
        let mut sum = self.zero();
        let own_weight = denominator.wrapping_sub(valence.wrapping_mul(numerator));
        self.add(&mut sum, own_weight, own);
        self.add_sum(&mut sum, numerator, ring);
        self.divide(&sum, denominator)
    }
}
