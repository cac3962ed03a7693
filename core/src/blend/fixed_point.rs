//! Fixed-point coordinates and channels: 64-bit exact sums, one rounding, saturation counted.

use core::marker::PhantomData;

use super::Blend;
use crate::coord::{Coordinate, round_div, saturate};

/// Blends points of `D` coordinates (or scalar channels) in the format `C`.
///
/// # Scaling and overflow
///
/// Inputs are 32-bit, weights are integers, the sum is 64-bit and exact. Every mask's weights
/// divided by its denominator have magnitudes that add up to at most 9/8, so a sum is below
/// `2^31 * 9/8 * denominator`. Denominators are at most `288 * cells` for a vertex in `cells`
/// cells, `8 * triangles` and `8 * neighbours` on a surface, or `2^30`: the sum stays below
/// `2^62` for up to six million cells, triangles or neighbours at one vertex, more than a mesh
/// with 32-bit indices and this library's arenas can hold on a device. The quotient is rounded
/// once by [`round_div`] and saturates.
#[derive(Clone, Debug)]
pub struct FixedBlend<C, const D: usize> {
    saturated: u32,
    format: PhantomData<C>,
}

impl<C, const D: usize> FixedBlend<C, D> {
    /// A blend that has saturated nothing yet.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            saturated: 0,
            format: PhantomData,
        }
    }

    /// How many coordinates did not fit their range and were clamped since [`FixedBlend::new`].
    #[must_use]
    pub const fn saturated(&self) -> u32 {
        self.saturated
    }

    pub(super) fn saturation_count(&mut self) -> &mut u32 {
        &mut self.saturated
    }
}

impl<C, const D: usize> Default for FixedBlend<C, D> {
    fn default() -> Self {
        Self::new()
    }
}

impl<C: Coordinate, const D: usize> Blend for FixedBlend<C, D> {
    type Point = [C; D];
    type Sum = [i64; D];

    #[inline]
    fn zero(&self) -> [i64; D] {
        [0; D]
    }

    #[inline]
    fn add(&self, sum: &mut [i64; D], weight: i64, point: &[C; D]) {
        for (total, coordinate) in sum.iter_mut().zip(point) {
            *total = total.wrapping_add(weight.wrapping_mul(i64::from(coordinate.to_bits())));
        }
    }

    #[inline]
    fn add_sum(&self, sum: &mut [i64; D], weight: i64, other: &[i64; D]) {
        for (total, value) in sum.iter_mut().zip(other) {
            *total = total.wrapping_add(weight.wrapping_mul(*value));
        }
    }

    #[inline]
    fn divide(&mut self, sum: &[i64; D], denominator: i64) -> [C; D] {
        sum.map(|total| C::from_bits(saturate(round_div(total, denominator), &mut self.saturated)))
    }
}
