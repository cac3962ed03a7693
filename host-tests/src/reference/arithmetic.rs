//! What becomes of an exact sum: a rounded coordinate, a real number, or the fraction itself.
//!
//! The rules hand over integer numerators and denominators, so that one set of rules
//! serves all three.

use super::exact::{LimbSum, round_quotient, saturate};
use super::loop_weight::{LoopWeight, WEIGHT_UNIT};

/// Turns sums into values.
pub(super) trait Arithmetic {
    /// What a coordinate of a new vertex is.
    type Value: Copy;

    /// `numerator / denominator`; the denominator is positive and even.
    fn quotient(&mut self, numerator: f64, denominator: f64) -> Self::Value;

    /// A boundary vertex: its own coordinate and those of its neighbours.
    fn vertex(
        &mut self,
        weight: &LoopWeight,
        own: f64,
        neighbours: impl Iterator<Item = f64>,
    ) -> Self::Value;
}

/// Rounds once, `floor(x + 1/2)`, saturates and counts.
#[derive(Debug, Default)]
pub(super) struct Fixed {
    pub saturated: usize,
}

impl Arithmetic for Fixed {
    type Value = i32;

    fn quotient(&mut self, numerator: f64, denominator: f64) -> i32 {
        saturate(round_quotient(numerator, denominator), &mut self.saturated)
    }

    fn vertex(
        &mut self,
        weight: &LoopWeight,
        own: f64,
        neighbours: impl Iterator<Item = f64>,
    ) -> i32 {
        if weight.denominator != WEIGHT_UNIT {
            let sum = weight.own * own + weight.neighbour * neighbours.sum::<f64>();
            return self.quotient(sum, weight.denominator);
        }
        let mut sum = LimbSum::default();
        sum.add(weight.own, own);
        for neighbour in neighbours {
            sum.add(weight.neighbour, neighbour);
        }
        saturate(sum.round(), &mut self.saturated)
    }
}

/// Real-number weights in double precision, rounded to no grid.
#[derive(Debug, Default)]
pub(super) struct Real;

impl Arithmetic for Real {
    type Value = f64;

    fn quotient(&mut self, numerator: f64, denominator: f64) -> f64 {
        numerator / denominator
    }

    fn vertex(
        &mut self,
        weight: &LoopWeight,
        own: f64,
        neighbours: impl Iterator<Item = f64>,
    ) -> f64 {
        own + weight.real_neighbour * neighbours.map(|neighbour| neighbour - own).sum::<f64>()
    }
}

/// Keeps the exact fraction: numerator, denominator. For masks, where coordinates are 0 or 1.
#[derive(Debug, Default)]
pub(super) struct Fraction;

impl Arithmetic for Fraction {
    type Value = (f64, f64);

    fn quotient(&mut self, numerator: f64, denominator: f64) -> (f64, f64) {
        (numerator, denominator)
    }

    fn vertex(
        &mut self,
        weight: &LoopWeight,
        own: f64,
        neighbours: impl Iterator<Item = f64>,
    ) -> (f64, f64) {
        let sum = weight.own * own + weight.neighbour * neighbours.sum::<f64>();
        (sum, weight.denominator)
    }
}
