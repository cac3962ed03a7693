//! The weights of tangents.

use super::TangentMasks;
use crate::blend::{IrrationalWeight, WEIGHT_BITS};
use crate::surface::irrational::{cosine, irrational};

/// The weight one.
pub(super) const ONE: IrrationalWeight = IrrationalWeight {
    bits: 1 << WEIGHT_BITS,
    real: 1.0,
};

fn weight(real: f64) -> IrrationalWeight {
    let (bits, real) = irrational(real);
    IrrationalWeight { bits, real }
}

/// The opposite weight.
#[expect(
    clippy::float_arithmetic,
    reason = "a weight in double precision, for value types of real numbers"
)]
pub(super) fn negative(weight: IrrationalWeight) -> IrrationalWeight {
    IrrationalWeight {
        bits: weight.bits.wrapping_neg(),
        real: -weight.real,
    }
}

/// `cos(2 pi step / count)`, without a call where it is rational.
fn turn_cosine(step: u32, count: u32) -> f64 {
    let step = step.checked_rem(count).unwrap_or_default();
    match (step, count) {
        (0, _) => 1.0,
        (1 | 5, 6) => 0.5,
        (1 | 3, 4) => 0.0,
        (1 | 2, 3) | (2 | 4, 6) => -0.5,
        (2, 4) | (3, 6) => -1.0,
        _ => cosine(step, count),
    }
}

/// `A = 1 + cos + sqrt((9 + cos) (1 + cos))`: what divides the weights across Catmull-Clark's quads.
#[expect(
    clippy::float_arithmetic,
    reason = "an irrational weight is made in double precision, once for its sector"
)]
fn face_divisor(cosine: f64) -> f64 {
    1.0 + cosine + libm::sqrt((9.0 + cosine) * (1.0 + cosine))
}

/// Weights all round a vertex.
pub(super) struct Ring {
    count: u32,
    divisor: f64,
}

impl Ring {
    /// Those of a ring of this many faces, 3 at least.
    pub fn new(masks: TangentMasks, count: u32) -> Option<Self> {
        let divisor = match masks {
            TangentMasks::Loop => 1.0,
            TangentMasks::CatmullClark => face_divisor(turn_cosine(1, count)),
        };
        (count >= 3).then_some(Self { count, divisor })
    }

    /// How many places make a quarter of the ring.
    pub fn quarter(&self) -> u32 {
        self.count.wrapping_add(2) >> 2
    }

    fn cosine(&self, place: u32, turn: u32) -> f64 {
        let step = place.wrapping_add(self.count).wrapping_sub(turn);
        turn_cosine(step, self.count)
    }

    /// Of an edge.
    pub fn edge(&self, place: u32, turn: u32) -> IrrationalWeight {
        weight(self.cosine(place, turn))
    }

    /// Of the vertex across the quad after an edge.
    #[expect(
        clippy::float_arithmetic,
        reason = "an irrational weight is made in double precision, once for its place in a ring"
    )]
    pub fn face(&self, place: u32, turn: u32) -> IrrationalWeight {
        let sum = self.cosine(place, turn) + self.cosine(place.wrapping_add(1), turn);
        weight(sum / self.divisor)
    }
}

/// Weights across a crease.
pub(super) struct Crease {
    faces: u32,
    end: f64,
    divisor: f64,
}

impl Crease {
    /// Those of a sector of this many faces.
    #[expect(
        clippy::float_arithmetic,
        reason = "an irrational weight is made in double precision, once for its sector"
    )]
    pub fn new(masks: TangentMasks, faces: u32) -> Option<Self> {
        let cosine = turn_cosine(1, faces.checked_mul(2)?);
        let divisor = face_divisor(cosine);
        let end = match (masks, faces) {
            (_, 0) => return None,
            (_, 1) => 1.0,
            (TangentMasks::Loop, _) => -cosine / ((1.0 - cosine) * (1.0 + 2.0 * cosine)),
            (TangentMasks::CatmullClark, _) => {
                let value = (divisor + 4.0) / 16.0;
                let ends = (0.375 + 0.5 / divisor) / (1.0 - cosine);
                let inside = (value - 0.75) * (0.5 + 2.0 / divisor);
                (ends + inside) / (2.0 * (4.0 * value - 1.0) * (value - 1.0))
            }
        };
        Some(Self {
            faces,
            end,
            divisor,
        })
    }

    /// `sin(place x) / sin x`: zero at both ends.
    #[expect(
        clippy::float_arithmetic,
        reason = "an irrational weight is made in double precision, once for its place in a sector"
    )]
    fn sine(&self, place: u32) -> f64 {
        // The sine is the same from either end, and rational for up to three faces.
        let place = place.min(self.faces.saturating_sub(place));
        let sine = |place: u32| {
            libm::sin(core::f64::consts::PI * f64::from(place) / f64::from(self.faces))
        };
        match place {
            0 => 0.0,
            1 => 1.0,
            _ => sine(place) / sine(1),
        }
    }

    /// Of an edge.
    pub fn edge(&self, place: u32) -> IrrationalWeight {
        if place == 0 || place >= self.faces {
            weight(self.end)
        } else {
            weight(self.sine(place))
        }
    }

    /// Of the vertex across the quad after an edge.
    #[expect(
        clippy::float_arithmetic,
        reason = "an irrational weight is made in double precision, once for its place in a sector"
    )]
    pub fn face(&self, place: u32) -> IrrationalWeight {
        let sum = self.sine(place) + self.sine(place.saturating_add(1));
        weight(sum / self.divisor)
    }
}
