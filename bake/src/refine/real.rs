//! Weighted sums of points in double precision, not held to any grid.

use octruss::blend::{
    Blend, Distortion, GuardedBlend, IrrationalWeight, NeighbourWeight, WEIGHT_BITS,
};

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

/// Real numbers have no grid, so a guarded value is the value.
impl GuardedBlend for RealBlend {
    type Guarded = [f64; 3];
    type GuardedSum = [f64; 3];

    fn guard(&self, point: &[f64; 3]) -> [f64; 3] {
        *point
    }

    fn distort(
        &self,
        own: &[f64; 3],
        parts: &[Distortion<'_, [f64; 3]>],
        denominator: u32,
    ) -> [f64; 3] {
        let mut value = *own;
        for part in parts.iter().filter(|part| part.count != 0) {
            let divisor = distortion_divisor(part, denominator);
            for (total, sum) in value.iter_mut().zip(part.sum) {
                *total += sum / divisor;
            }
        }
        value
    }

    fn guarded_zero(&self) -> [f64; 3] {
        self.zero()
    }

    fn add_guarded(&self, sum: &mut [f64; 3], weight: i64, value: &[f64; 3]) {
        self.add(sum, weight, value);
    }

    fn add_guarded_sum(&self, sum: &mut [f64; 3], weight: i64, other: &[f64; 3]) {
        self.add_sum(sum, weight, other);
    }

    fn divide_guarded(&mut self, sum: &[f64; 3], denominator: i64) -> [f64; 3] {
        self.divide(sum, denominator)
    }
}

/// By what a part's sum is divided, negative if the part is taken away.
pub(super) fn distortion_divisor<S>(part: &Distortion<'_, S>, denominator: u32) -> f64 {
    let sign = if part.is_negative { -1.0 } else { 1.0 };
    sign * f64::from(part.count) * f64::from(denominator)
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
