//! The weight families of Loop's triangle scheme.
//!
//! A vertex with `n` neighbours moves to `own + weight(n) * sum(neighbour - own)`; the midpoint
//! of an edge moves to `3/8 3/8` of its ends and `1/8 1/8` of the vertices opposite. The
//! families differ in `weight(n)` only, and agree at `n = 6` (1/16).

use crate::blend::{NeighbourWeight, WEIGHT_BITS};

/// Which weight a vertex gives to each of its neighbours.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum LoopWeights {
    /// Loop's own weight of 1987: `(5/8 - (3/8 + cos(2 pi / n) / 4)^2) / n`.
    Loop,
    /// Warren's simpler weight: `3/(8n)`, and `3/16` at `n = 3`.
    Warren,
    /// What the triangle/quad scheme of Schaefer and Warren gives on triangles: `3/(8n)` at
    /// every `n`.
    TriQuad,
}

impl LoopWeights {
    /// The weight of one neighbour of a vertex with `valence` neighbours.
    ///
    /// Rational weights are exact fractions: all of `Warren` and `TriQuad`, and those of `Loop`
    /// whose cosine is rational (valences 1, 2, 3, 4 and 6). The others are rounded to the
    /// nearest multiple of 2^-30, and the vertex's own weight is one minus the rounded weights,
    /// so that every mask adds up to one. A valence of 0 gives weight 0.
    #[must_use]
    pub fn neighbour(self, valence: u32) -> NeighbourWeight {
        let exact = |numerator, denominator| NeighbourWeight::Exact {
            numerator,
            denominator,
        };
        match (self, valence) {
            (_, 0) => exact(0, 1),
            (Self::Loop, 1) => exact(15, 64),
            (Self::Loop, 2) => exact(39, 128),
            (Self::Loop | Self::Warren, 3) => exact(3, 16),
            (Self::Loop, 4) => exact(31, 256),
            (Self::Loop, 6) => exact(1, 16),
            (Self::Loop, n) => loop_irrational(n),
            (Self::Warren | Self::TriQuad, n) => exact(3, i64::from(n).wrapping_mul(8)),
        }
    }
}

/// Loop's weight at a valence whose cosine is irrational.
///
/// The error of the double-precision value is below 2^-51, so its rounding to 2^-30 can differ
/// from the real number's only within 2^-21 units of a tie; the test suite shows that no valence
/// up to 4096 comes near one.
#[expect(
    clippy::float_arithmetic,
    clippy::as_conversions,
    clippy::cast_possible_truncation,
    reason = "an irrational weight is made in double precision, once for its valence; it is \
              below 1, so 2^30 times it fits 64 bits"
)]
fn loop_irrational(valence: u32) -> NeighbourWeight {
    let valence = f64::from(valence);
    let root = 0.375 + 0.25 * libm::cos(2.0 * core::f64::consts::PI / valence);
    let real = (0.625 - root * root) / valence;
    let bits = libm::floor(real * f64::from(1_u32 << WEIGHT_BITS) + 0.5) as i64;
    NeighbourWeight::Irrational { bits, real }
}

/// The last irrational weights that were asked for, so that a refinement calls the cosine once
/// for each valence of ordinary meshes.
#[derive(Clone, Debug)]
pub(crate) struct WeightCache {
    family: LoopWeights,
    known: [Option<NeighbourWeight>; 32],
}

impl WeightCache {
    pub(crate) const fn new(family: LoopWeights) -> Self {
        Self {
            family,
            known: [None; 32],
        }
    }

    pub(crate) fn neighbour(&mut self, valence: u32) -> NeighbourWeight {
        let family = self.family;
        match usize::try_from(valence)
            .ok()
            .and_then(|slot| self.known.get_mut(slot))
        {
            Some(slot) => *slot.get_or_insert_with(|| family.neighbour(valence)),
            None => family.neighbour(valence),
        }
    }
}
