//! The enclosed volume of combinations of modes: a cubic polynomial in their amplitudes.
//!
//! With `q_0 = 1` for the rest pose, `volume = sum over a <= b <= c of k_abc q_a q_b q_c`. A fast tick
//! evaluates it instead of the form over all control points: 969 coefficients for 16 modes.

use octruss::enclosed::{MODE_WEIGHT_LIMIT, VolumeModesRecord};
use zerocopy::IntoBytes;

use super::control::ControlForm;
use super::surface::centred;

/// The most modes that are baked: 6545 coefficients.
pub const MOST_MODES: usize = 32;

/// The cubic polynomial in double precision, `k_000, k_001, ... k_mmm` in ascending order.
#[derive(Clone, Debug, PartialEq)]
pub struct ModeVolume {
    /// Number of modes.
    pub modes: usize,
    /// The coefficients, in cubes of the positions' unit.
    pub coefficients: Vec<f64>,
}

impl ModeVolume {
    /// The volume of `rest + sum of amplitude * (pose - rest)` by a form over the control points.
    ///
    /// The form polarised: its trilinear map `B` with `volume(p) = B(p, p, p)` has
    /// `3 B(p, p, h) = gradient(p) . h`, and `2 B(a, b, h) = B(a + b, a + b, h) - B(a, a, h) - B(b, b, h)`.
    /// So a gradient for each mode and each pair of them gives all coefficients.
    #[must_use]
    pub fn new(form: &ControlForm, rest: &[[f64; 3]], poses: &[Vec<[f64; 3]>]) -> Self {
        let (centre, _) = centred(rest);
        let moved = poses.iter().map(|pose| combined(pose, rest, -1.0));
        let vectors: Vec<Vec<[f64; 3]>> = std::iter::once(centre).chain(moved).collect();
        let squares: Vec<_> = vectors.iter().map(|own| form.gradient(own)).collect();
        let mut coefficients = Vec::new();
        for (a, first) in vectors.iter().enumerate() {
            for (b, second) in vectors.iter().enumerate().skip(a) {
                // 3 B(a, b, .) at each of the form's points.
                let mixed = if a == b {
                    squares[a].clone()
                } else {
                    let both = form.gradient(&combined(first, second, 1.0));
                    let parts = both.iter().zip(&squares[a]).zip(&squares[b]);
                    parts
                        .map(|((both, first), second)| {
                            [0, 1, 2].map(|k| (both[k] - first[k] - second[k]) / 2.0)
                        })
                        .collect()
                };
                for (c, third) in vectors.iter().enumerate().skip(b) {
                    let product = dot(&mixed, form, third) / 3.0;
                    coefficients.push(orders(a, b, c) * product);
                }
            }
        }
        Self {
            modes: poses.len(),
            coefficients,
        }
    }

    /// The volume at these amplitudes, one for each mode.
    #[must_use]
    pub fn volume(&self, amplitudes: &[f64]) -> f64 {
        let all: Vec<f64> = std::iter::once(1.0)
            .chain(amplitudes.iter().copied())
            .collect();
        let products = all.iter().enumerate().flat_map(|(a, first)| {
            let all = &all;
            all.iter().enumerate().skip(a).flat_map(move |(b, second)| {
                all.iter().skip(b).map(move |third| first * second * third)
            })
        });
        let terms = self.coefficients.iter().zip(products);
        terms
            .map(|(coefficient, product)| coefficient * product)
            .sum()
    }
}

/// The polynomial in the device's integers.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DeviceModes {
    /// Number of modes.
    pub modes: usize,
    /// The coefficients.
    pub coefficients: Vec<i32>,
    /// A coefficient of one stands for `2^exponent` cubes of the coordinates' last place.
    pub exponent: i32,
}

impl DeviceModes {
    /// Rounds the coefficients, for coordinates with so many fraction bits, as finely as the device's
    /// limit on the sum of their magnitudes allows.
    #[must_use]
    pub fn new(volume: &ModeVolume, fraction_bits: u32) -> Self {
        let places = 2.0_f64.powi(3 * i32::try_from(fraction_bits).unwrap_or_default());
        let scaled = |exponent: i32| {
            let unit = places * 2.0_f64.powi(-exponent);
            volume
                .coefficients
                .iter()
                .map(move |coefficient| (coefficient * unit).round())
        };
        #[expect(clippy::cast_precision_loss, reason = "the limit is below 2^53")]
        let limit = MODE_WEIGHT_LIMIT as f64;
        let total: f64 = scaled(0).map(f64::abs).sum();
        #[expect(clippy::cast_possible_truncation, reason = "exponents are small")]
        let mut exponent = if total == 0.0 {
            0
        } else {
            (total / limit).log2().floor() as i32 - 1
        };
        while scaled(exponent).map(f64::abs).sum::<f64>() > limit {
            exponent += 1;
        }
        #[expect(
            clippy::cast_possible_truncation,
            reason = "magnitudes add up to less than 2^30"
        )]
        let coefficients = scaled(exponent).map(|rounded| rounded as i32).collect();
        Self {
            modes: volume.modes,
            coefficients,
            exponent,
        }
    }

    /// The bytes of a bundle's section.
    #[must_use]
    pub fn section(&self) -> Vec<u8> {
        let record = VolumeModesRecord {
            modes: u32::try_from(self.modes).unwrap_or(u32::MAX).into(),
            exponent: self.exponent.into(),
            reserved: [0.into(); 2],
        };
        [record.as_bytes(), self.coefficients.as_bytes()].concat()
    }

    /// How far the device's volume can be from the polynomial's, in cubes of the coordinates' last
    /// place, for amplitudes of magnitude at most `reach`, which are at most 2 and multiples of `2^-30`.
    ///
    /// With `s = 1 + m reach` the magnitudes of all amplitudes add up to at most `s`. A coefficient is off
    /// by at most a half; the products that they are multiplied by add up to at most `s^3`. A sum over
    /// the last index is rounded by a half in units of `2` coefficients and multiplied by two
    /// amplitudes; one over the middle index by a half in units of `4` and multiplied by one: `s^2` and `2 s`.
    #[must_use]
    pub fn volume_bound(&self, reach: f64) -> f64 {
        #[expect(clippy::cast_precision_loss, reason = "few modes")]
        let sum = 1.0 + self.modes as f64 * reach;
        (0.5 * sum.powi(3) + sum * sum + 2.0 * sum) * 2.0_f64.powi(self.exponent)
    }
}

/// `first + sign * second`, point by point.
fn combined(first: &[[f64; 3]], second: &[[f64; 3]], sign: f64) -> Vec<[f64; 3]> {
    let both = first.iter().zip(second);
    both.map(|(a, b)| [0, 1, 2].map(|k| a[k] + sign * b[k]))
        .collect()
}

/// The sum of products of a gradient over the form's points with positions of all points.
fn dot(gradient: &[[f64; 3]], form: &ControlForm, positions: &[[f64; 3]]) -> f64 {
    let pairs = gradient.iter().zip(&form.points);
    pairs
        .map(|(slope, &point)| {
            let position = positions[point];
            slope[0] * position[0] + slope[1] * position[1] + slope[2] * position[2]
        })
        .sum()
}

/// In how many orders three indices `a <= b <= c` can stand.
fn orders(a: usize, b: usize, c: usize) -> f64 {
    match (a == b, b == c) {
        (true, true) => 1.0,
        (false, false) => 6.0,
        _ => 3.0,
    }
}
