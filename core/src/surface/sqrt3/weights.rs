//! The weight of rule (2).

use crate::blend::NeighbourWeight;
use crate::surface::irrational::{cosine, irrational};

/// `9 alpha_n` where the cosine is rational.
pub(super) const fn ninths(valence: u32) -> Option<i64> {
    match valence {
        1 => Some(2),
        2 => Some(6),
        3 => Some(5),
        4 => Some(4),
        6 => Some(3),
        _ => None,
    }
}

/// `alpha_n` in double precision.
#[expect(
    clippy::float_arithmetic,
    reason = "an irrational weight is made in double precision, once for its valence"
)]
pub(super) fn alpha(valence: u32) -> f64 {
    (4.0 - 2.0 * cosine(1, valence)) / 9.0
}

/// The weight of each neighbour of a vertex of valence `n` in rule (2), `alpha_n / n`: exact for
/// the valences 1, 2, 3, 4 and 6, else the real number rounded to a multiple of 2^-30. A valence of
/// 0 gives weight 0.
#[must_use]
#[expect(
    clippy::float_arithmetic,
    reason = "an irrational weight is made in double precision, once for its valence"
)]
pub fn neighbour_weight(valence: u32) -> NeighbourWeight {
    match (valence, ninths(valence)) {
        (0, _) => NeighbourWeight::Exact {
            numerator: 0,
            denominator: 1,
        },
        (_, Some(numerator)) => NeighbourWeight::Exact {
            numerator,
            denominator: i64::from(valence).wrapping_mul(9),
        },
        (_, None) => {
            let (bits, real) = irrational(alpha(valence) / f64::from(valence));
            NeighbourWeight::Irrational { bits, real }
        }
    }
}

/// The last weights that were asked for, so that a refinement calls the cosine once for each
/// valence of ordinary meshes.
pub(super) struct Weights {
    known: [Option<NeighbourWeight>; 32],
}

impl Weights {
    pub(super) const fn new() -> Self {
        Self { known: [None; 32] }
    }

    pub(super) fn neighbour(&mut self, valence: u32) -> NeighbourWeight {
        match usize::try_from(valence)
            .ok()
            .and_then(|slot| self.known.get_mut(slot))
        {
            Some(slot) => *slot.get_or_insert_with(|| neighbour_weight(valence)),
            None => neighbour_weight(valence),
        }
    }
}
