//! The enclosed volume written again, in integers of any length.
//!
//! Determinants are expanded one by one, and every rounding is a floor division of the exact
//! number, so that no format and no order of sums is shared with the crate that is judged. Double
//! precision would need limbs for the 128-bit sums; integers of any length need no argument.

use num_bigint::BigInt;
use num_traits::{Signed, ToPrimitive, Zero};

/// A volume form as its baker sees it.
#[derive(Clone, Debug, Default)]
pub struct VolumeTable {
    /// Control points of the region; the first is the base.
    pub points: Vec<u16>,
    /// Triples `i < j < k` of the other points, counted from 0, with their weights; ascending.
    pub taps: Vec<([u16; 3], i32)>,
    /// Pairs that have no tap but are listed.
    pub empty_pairs: Vec<[u16; 2]>,
    /// Bits by which differences to the base are rounded.
    pub difference_shift: u32,
    /// Bits by which weighted sums of a pair are rounded.
    pub pair_bits: u32,
    /// Bits by which the volume is rounded.
    pub volume_shift: u32,
    /// How much finer the gradient is than 2^31 of its exact unit.
    pub gradient_bits: u32,
}

/// The results of one pose.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct VolumeResult {
    /// The volume.
    pub volume: i64,
    /// The gradient by each point of the region.
    pub gradient: Vec<[i64; 3]>,
    /// How many results of the volume alone were clamped.
    pub volume_saturated: u32,
    /// How many of all.
    pub saturated: u32,
}

type Vector = [BigInt; 3];

/// `floor(value / 2^shift + 1/2)`.
fn round(value: &BigInt, shift: u32) -> BigInt {
    let doubled: BigInt = (value * 2) + (BigInt::from(1) << shift);
    // BigInt's shift to the right is a floor division.
    doubled >> (shift + 1)
}

fn cross(a: &Vector, b: &Vector) -> Vector {
    let minor = |x: usize, y: usize| &a[x] * &b[y] - &a[y] * &b[x];
    [minor(1, 2), minor(2, 0), minor(0, 1)]
}

fn determinant(a: &Vector, b: &Vector, c: &Vector) -> BigInt {
    let [x, y, z] = cross(b, c);
    &a[0] * x + &a[1] * y + &a[2] * z
}

fn map(vector: &Vector, change: impl Fn(&BigInt) -> BigInt) -> Vector {
    [0, 1, 2].map(|axis| change(&vector[axis]))
}

impl VolumeTable {
    fn differences(&self, pose: &[[i32; 3]]) -> Vec<Vector> {
        let at = |point: &u16| pose[usize::from(*point)].map(BigInt::from);
        let base = at(&self.points[0]);
        let difference = |point: &u16| {
            let own = at(point);
            [0, 1, 2].map(|axis| round(&(&own[axis] - &base[axis]), self.difference_shift))
        };
        self.points[1..].iter().map(difference).collect()
    }

    /// The volume and gradient of a pose.
    pub fn evaluate(&self, pose: &[[i32; 3]]) -> VolumeResult {
        let differences = self.differences(pose);
        let mut sum = BigInt::zero();
        for ([i, j, k], weight) in &self.taps {
            let [a, b, c] = [i, j, k].map(|&index| &differences[usize::from(index)]);
            sum += determinant(a, b, c) * *weight;
        }
        let mut volume_saturated = 0;
        let limits = [BigInt::from(i64::MIN), BigInt::from(i64::MAX)];
        let volume = clamp(
            round(&sum, self.volume_shift),
            &limits,
            &mut volume_saturated,
        );
        let mut saturated = volume_saturated;
        let gradient = self.gradient(&differences, &mut saturated);
        VolumeResult {
            volume,
            gradient,
            volume_saturated,
            saturated,
        }
    }

    fn gradient(&self, differences: &[Vector], saturated: &mut u32) -> Vec<[i64; 3]> {
        let greatest = differences.iter().flatten().map(Signed::abs).max();
        let greatest = greatest.unwrap_or_default();
        let mut doublings = 0;
        let limit = BigInt::from(1_u32 << 30);
        while !greatest.is_zero() && (&greatest << (doublings + 1)) < limit {
            doublings += 1;
        }
        let doubled = differences.iter().map(|d| map(d, |axis| axis << doublings));
        let doubled = doubled.collect::<Vec<_>>();
        let zero = || [0, 1, 2].map(|_| BigInt::zero());
        let mut sums = vec![zero(); differences.len()];
        let mut add = |index: u16, value: Vector| {
            for (sum, axis) in sums[usize::from(index)].iter_mut().zip(value) {
                *sum += axis;
            }
        };
        let mut rest = &self.taps[..];
        while let Some(([i, j, _], _)) = rest.first() {
            let length = rest
                .iter()
                .take_while(|(triple, _)| triple[..2] == [*i, *j])
                .count();
            let (pair, more) = rest.split_at(length);
            rest = more;
            let (a, b) = (&doubled[usize::from(*i)], &doubled[usize::from(*j)]);
            let area = map(&cross(a, b), |axis| round(axis, 31));
            let mut weighted = zero();
            for ([_, _, k], weight) in pair {
                for (sum, axis) in weighted.iter_mut().zip(&doubled[usize::from(*k)]) {
                    *sum += axis * *weight;
                }
                add(*k, map(&area, |axis| axis * *weight));
            }
            let weighted = map(&weighted, |axis| round(axis, self.pair_bits));
            let unit = |axis: &BigInt| round(axis, 31 - self.pair_bits);
            add(*i, map(&cross(b, &weighted), unit));
            add(*j, map(&cross(&weighted, a), unit));
        }
        let limits = [-(1_i64 << 47) + 1, (1 << 47) - 1].map(BigInt::from);
        let mut base = [0; 3];
        let mut gradient = vec![base];
        for sum in &sums {
            let own = [0, 1, 2].map(|axis| {
                let fine = &sum[axis] << self.gradient_bits;
                clamp(round(&fine, 2 * doublings), &limits, saturated)
            });
            for (total, value) in base.iter_mut().zip(own) {
                *total -= value;
            }
            gradient.push(own);
        }
        gradient[0] = base;
        gradient
    }
}

fn clamp(value: BigInt, limits: &[BigInt; 2], saturated: &mut u32) -> i64 {
    let [low, high] = limits;
    let clamped = value.clone().clamp(low.clone(), high.clone());
    *saturated += u32::from(clamped != value);
    clamped.to_i64().expect("the limits fit")
}

/// The volume of a combination of modes and its derivatives, straight from the polynomial's
/// definition with its three roundings.
pub fn modes(count: usize, coefficients: &[i32], amplitudes: &[i32]) -> (i64, Vec<i64>) {
    let q = |index: usize| match index {
        0 => BigInt::from(1 << 30),
        _ => BigInt::from(amplitudes[index - 1]),
    };
    let mut next = coefficients.iter();
    let mut total = BigInt::zero();
    let mut derivatives = vec![BigInt::zero(); count + 1];
    for a in 0..=count {
        let mut plane = BigInt::zero();
        for b in a..=count {
            let area = round(&(q(a) * q(b)), 31);
            let mut line = BigInt::zero();
            for (c, coefficient) in (b..=count).zip(&mut next) {
                line += q(c) * *coefficient;
                derivatives[c] += &area * *coefficient;
            }
            let line = round(&line, 31);
            derivatives[a] += q(b) * &line;
            derivatives[b] += q(a) * &line;
            plane += q(b) * line;
        }
        total += q(a) * round(&plane, 31);
    }
    let fits = |value: &BigInt| value.to_i64().expect("below 2^63");
    (fits(&total), derivatives[1..].iter().map(fits).collect())
}

/// The way from the base to the centroid, clamped to 32 bits, and how many axes were: the quartic
/// polynomials of the three moments from their definition with its roundings, over the volume.
///
/// A quotient is rounded as the exact fraction `moment * 2^shift / volume`: twice that plus one,
/// halved, each time by floor division.
pub fn centroid(
    coefficients: &[i32],
    amplitudes: &[i32],
    volume: i64,
    shift: i32,
) -> ([i32; 3], u32) {
    let count = amplitudes.len();
    let q = |index: usize| match index {
        0 => BigInt::from(1 << 30),
        _ => BigInt::from(amplitudes[index - 1]),
    };
    let mut next = coefficients.iter();
    let mut saturated = 0;
    let limits = [BigInt::from(i32::MIN), BigInt::from(i32::MAX)];
    let offset = [0, 1, 2].map(|_| {
        let mut total = BigInt::zero();
        for a in 0..=count {
            let mut space = BigInt::zero();
            for b in a..=count {
                let mut plane = BigInt::zero();
                for c in b..=count {
                    let terms = (c..=count).zip(&mut next);
                    let line: BigInt = terms.map(|(d, coefficient)| q(d) * *coefficient).sum();
                    plane += q(c) * round(&line, 31);
                }
                space += q(b) * round(&plane, 31);
            }
            total += q(a) * round(&space, 31);
        }
        let power = |exponent: i32| BigInt::from(1) << exponent.max(0).unsigned_abs();
        let numerator: BigInt = total * power(shift);
        let denominator: BigInt = BigInt::from(volume) * power(-shift);
        let doubled: BigInt = numerator * 2_u32;
        let exact = (&doubled % &denominator).is_zero();
        // BigInt divides toward zero.
        let below = u32::from(doubled.is_negative() && !exact);
        let halves = doubled / denominator - below;
        let rounded: BigInt = (halves + 1_u32) >> 1;
        let fits = clamp(rounded, &limits, &mut saturated);
        i32::try_from(fits).expect("the limits fit")
    });
    (offset, saturated)
}
