//! Weighted sums of points in double precision, not held to any grid.

use octruss::blend::{Blend, IrrationalWeight, NeighbourWeight, WEIGHT_BITS};

/// One, in the units of an irrational weight.
pub(super) const WEIGHT_ONE: f64 = (1_u64 << WEIGHT_BITS) as f64;

/// Blends points of real numbers; irrational weights are taken in double precision, not as the
/// device rounds them.
#[derive(Clone, Copy, Debug, Default)]
pub struct RealBlend;

impl Blend for RealBlend {
    type Point = [f64; 3];
    type Sum = [f64; 3];

    fn zero(&self) -> [f64; 3] {
        [0.0; 3]
    }

    fn add(&self, sum: &mut [f64; 3], weight: i64, point: &[f64; 3]) {
        self.add_sum(sum, weight, point);
    }

    fn add_sum(&self, sum: &mut [f64; 3], weight: i64, other: &[f64; 3]) {
        for (total, value) in sum.iter_mut().zip(other) {
            *total += weight as f64 * value;
        }
    }

    fn add_irrational(&self, sum: &mut [f64; 3], weight: IrrationalWeight, point: &[f64; 3]) {
        for (total, value) in sum.iter_mut().zip(point) {
            *total += weight.real * WEIGHT_ONE * value;
        }
    }

    fn divide(&mut self, sum: &[f64; 3], denominator: i64) -> [f64; 3] {
        sum.map(|total| total / denominator as f64)
    }

    fn umbrella(
        &mut self,
        own: &[f64; 3],
        ring: &[f64; 3],
        valence: i64,
        weight: NeighbourWeight,
    ) -> [f64; 3] {
        let weight = real_weight(weight);
        let own_weight = 1.0 - valence as f64 * weight;
        std::array::from_fn(|axis| own_weight * own[axis] + weight * ring[axis])
    }
}

/// The weight of one neighbour as a real number.
pub(super) fn real_weight(weight: NeighbourWeight) -> f64 {
    match weight {
        NeighbourWeight::Exact {
            numerator,
            denominator,
        } => numerator as f64 / denominator as f64,
        NeighbourWeight::Irrational { real, .. } => real,
    }
}
