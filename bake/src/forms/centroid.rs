//! The centroid of combinations of modes: quartic polynomials of their amplitudes.
//!
//! With `q_0 = 1` for the rest pose, the integral of `x - base` over the enclosed solid is `sum over a <= b
//! <= c <= d of k_abcd q_a q_b q_c q_d`, for each axis; `base` is a control point that moves with the pose.

use std::collections::HashMap;

use octruss::enclosed::{CentroidModesRecord, MODE_WEIGHT_LIMIT};
use zerocopy::IntoBytes;

use super::modes::DeviceModes;
use super::region::Border;

/// The most modes that a centroid is baked for: 14 535 coefficients.
pub const MOST_CENTROID_MODES: usize = 16;

type Point = [f64; 3];

/// The three quartic polynomials in double precision.
#[derive(Clone, Debug, PartialEq)]
pub struct ModeMoments {
    /// Number of modes.
    pub modes: usize,
    /// The control point that moments are about.
    pub base: usize,
    /// The coefficients of each axis, `k_0000, k_0001, ... k_mmmm` in ascending order, in fourth powers of the
    /// positions' unit.
    pub coefficients: [Vec<f64>; 3],
}

/// The rest pose and the modes' displacements, about the base: what amplitudes combine.
#[derive(Clone, Debug)]
pub struct Combined {
    base: usize,
    vectors: Vec<Vec<Point>>,
}

impl Combined {
    /// Takes the base out of the rest pose, and out of the displacements of poses at amplitude one.
    #[must_use]
    pub fn new(rest: &[Point], poses: &[Vec<Point>], base: usize) -> Self {
        let about = |points: Vec<Point>| -> Vec<Point> {
            let origin = points.get(base).copied().unwrap_or_default();
            let moved = points.iter();
            moved
                .map(|point| [0, 1, 2].map(|k| point[k] - origin[k]))
                .collect()
        };
        let displaced = poses.iter().map(|pose| {
            let pairs = pose.iter().zip(rest);
            about(pairs.map(|(a, b)| [0, 1, 2].map(|k| a[k] - b[k])).collect())
        });
        Self {
            base,
            vectors: std::iter::once(about(rest.to_vec()))
                .chain(displaced)
                .collect(),
        }
    }

    /// The polynomials of `moment`, which is a homogeneous quartic of the positions of all control points.
    ///
    /// Polarised: its symmetric map `T` with `moment(p) = T(p, p, p, p)` is the sum over all subsets of four
    /// arguments of `+-moment(their sum)`, over `4!`.
    #[must_use]
    pub fn moments(&self, moment: impl Fn(&[Point]) -> Point) -> ModeMoments {
        let mut known: HashMap<Vec<usize>, Point> = HashMap::new();
        let modes = self.vectors.len() - 1;
        let mut coefficients = [const { Vec::new() }; 3];
        for four in quadruples(modes) {
            let mut total = [0.0; 3];
            for subset in 1_u32..16 {
                let members = (0..4).filter(|place| subset >> place & 1 == 1);
                let chosen: Vec<usize> = members.map(|place| four[place]).collect();
                let sign = if chosen.len().is_multiple_of(2) {
                    1.0
                } else {
                    -1.0
                };
                let value = known
                    .entry(chosen)
                    .or_insert_with_key(|chosen| moment(&self.sum(chosen)));
                for (sum, value) in total.iter_mut().zip(value) {
                    *sum += sign * *value;
                }
            }
            for (axis, sum) in coefficients.iter_mut().zip(total) {
                axis.push(orders(four) * sum / 24.0);
            }
        }
        ModeMoments {
            modes,
            base: self.base,
            coefficients,
        }
    }

    fn sum(&self, chosen: &[usize]) -> Vec<Point> {
        let count = self.vectors[0].len();
        let at = |point: usize| {
            let members = chosen.iter().map(|&vector| self.vectors[vector][point]);
            members.fold([0.0; 3], |sum, own| [0, 1, 2].map(|k| sum[k] + own[k]))
        };
        (0..count).map(at).collect()
    }
}

impl ModeMoments {
    /// The moments at these amplitudes, one for each mode.
    #[must_use]
    pub fn at(&self, amplitudes: &[f64]) -> Point {
        let all: Vec<f64> = std::iter::once(1.0)
            .chain(amplitudes.iter().copied())
            .collect();
        let mut total = [0.0; 3];
        for (place, four) in quadruples(self.modes).enumerate() {
            let product: f64 = four.iter().map(|&index| all[index]).product();
            for (sum, axis) in total.iter_mut().zip(&self.coefficients) {
                *sum += axis[place] * product;
            }
        }
        total
    }
}

/// The first moment of a polyhedron: a sum of cones from the origin, the centroid of each a quarter of the
/// sum of its triangle's corners.
#[must_use]
pub fn of_border(border: &Border, points: &[Point]) -> Point {
    let own: Vec<Point> = border
        .rows
        .iter()
        .map(|row| {
            row.iter().fold([0.0; 3], |sum, (point, weight)| {
                [0, 1, 2].map(|k| sum[k] + weight * points[*point][k])
            })
        })
        .collect();
    let mut total = [0.0; 3];
    for triangle in &border.triangles {
        let [a, b, c] = triangle.map(|vertex| own[vertex as usize]);
        let normal = super::form::cross(&b, &c);
        let cone = (a[0] * normal[0] + a[1] * normal[1] + a[2] * normal[2]) / 24.0;
        for (k, sum) in total.iter_mut().enumerate() {
            *sum += cone * (a[k] + b[k] + c[k]);
        }
    }
    total
}

/// The polynomials in the device's integers.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DeviceCentroid {
    /// Number of modes.
    pub modes: usize,
    /// The control point that offsets are counted from.
    pub base: usize,
    /// What a moment's unit over a volume's is: `2^shift` of the coordinates' last place.
    pub shift: i32,
    /// The coefficients of x, y and z.
    pub coefficients: Vec<i32>,
    exponent: i32,
}

impl DeviceCentroid {
    /// Rounds the coefficients, for coordinates with so many fraction bits, as finely as the device's limit
    /// on the sum of an axis' magnitudes allows. `volume` is what moments are divided by.
    #[must_use]
    pub fn new(moments: &ModeMoments, fraction_bits: u32, volume: &DeviceModes) -> Self {
        let places = 2.0_f64.powi(4 * i32::try_from(fraction_bits).unwrap_or_default());
        let scaled = |axis: &[f64], exponent: i32| -> Vec<f64> {
            let unit = places * 2.0_f64.powi(-exponent);
            axis.iter().map(|value| (value * unit).round()).collect()
        };
        #[expect(clippy::cast_precision_loss, reason = "the limit is below 2^53")]
        let limit = MODE_WEIGHT_LIMIT as f64;
        let largest = |exponent: i32| {
            let axes = moments.coefficients.iter();
            let sums = axes.map(|axis| scaled(axis, exponent).iter().map(|x| x.abs()).sum::<f64>());
            sums.fold(0.0, f64::max)
        };
        let total = largest(0);
        #[expect(clippy::cast_possible_truncation, reason = "exponents are small")]
        let mut exponent = if total == 0.0 {
            0
        } else {
            (total / limit).log2().floor() as i32 - 1
        };
        while largest(exponent) > limit {
            exponent += 1;
        }
        // The shift of a quotient is at most 60; small moments need not be finer than that.
        exponent = exponent.clamp(volume.exponent - 61, volume.exponent + 59);
        let coefficients = moments.coefficients.iter();
        #[expect(
            clippy::cast_possible_truncation,
            reason = "magnitudes add up to less than 2^30"
        )]
        let coefficients = coefficients
            .flat_map(|axis| scaled(axis, exponent))
            .map(|rounded| rounded as i32)
            .collect();
        Self {
            modes: moments.modes,
            base: moments.base,
            // 2^-27 of a coefficient over 2^-28 of the volume's.
            shift: exponent - volume.exponent + 1,
            coefficients,
            exponent,
        }
    }

    /// The bytes of a bundle's section.
    #[must_use]
    pub fn section(&self) -> Vec<u8> {
        let wide = |number: usize| u32::try_from(number).unwrap_or(u32::MAX).into();
        let record = CentroidModesRecord {
            modes: wide(self.modes),
            shift: self.shift.into(),
            base: wide(self.base),
            reserved: 0.into(),
        };
        [record.as_bytes(), self.coefficients.as_bytes()].concat()
    }

    /// How far a device's moment can be from the polynomial's, in fourth powers of the coordinates' last place,
    /// for amplitudes of magnitude at most `reach`, which are at most 2 and multiples of `2^-30`.
    ///
    /// As for the volume ([`DeviceModes::volume_bound`]): with `s = 1 + m reach`, coefficients are off by a
    /// half, times at most `s^4`; sums over the last index by a half in units of 2 coefficients, times `s^3`;
    /// over the next by a half in units of 4, times `s^2`; and over the next in units of 8, times `s`.
    #[must_use]
    pub fn moment_bound(&self, reach: f64) -> f64 {
        #[expect(clippy::cast_precision_loss, reason = "few modes")]
        let s = 1.0 + self.modes as f64 * reach;
        let halves = 0.5 * s.powi(4) + s.powi(3) + 2.0 * s * s + 4.0 * s;
        halves * 2.0_f64.powi(self.exponent)
    }
}

/// All `a <= b <= c <= d <= modes`, ascending.
fn quadruples(modes: usize) -> impl Iterator<Item = [usize; 4]> {
    let from = move |first: usize| first..=modes;
    from(0).flat_map(move |a| {
        from(a).flat_map(move |b| from(b).flat_map(move |c| from(c).map(move |d| [a, b, c, d])))
    })
}

/// In how many orders four ascending indices can stand: 4! over the factorials of how often each is there.
fn orders(four: [usize; 4]) -> f64 {
    let mut run = 1.0;
    let mut total = 24.0;
    for pair in four.windows(2) {
        run = if pair[0] == pair[1] { run + 1.0 } else { 1.0 };
        total /= run;
    }
    total
}

#[cfg(test)]
mod tests {
    use super::{Combined, orders, quadruples};

    #[test]
    fn orders_add_up() {
        // All words of four letters.
        let total: f64 = quadruples(4).map(orders).sum();
        assert!((total - 625.0).abs() < 1e-9);
        assert_eq!(quadruples(16).count(), 4845);
    }

    /// Polynomials that are known: of one point, `x^4`, `x^2 y^2` and `x y z^2`, at amplitudes with exact
    /// products.
    #[test]
    fn a_quartic_is_found_again() {
        let rest = [[0.0; 3], [1.0, 2.0, -1.0]];
        let poses = [
            vec![[0.0; 3], [2.0, 2.0, -1.0]],
            vec![[5.0, 0.0, 0.0], [6.0, 3.0, 1.0]],
        ];
        let combined = Combined::new(&rest, &poses, 0);
        let moments = combined.moments(|points| {
            let [x, y, z] = points[1];
            [x.powi(4), x * x * y * y, x * y * z * z]
        });
        for [a, b] in [[0.0, 0.0], [1.0, 0.0], [0.5, -2.0], [-1.5, 1.0]] {
            let (x, y, z): (f64, f64, f64) = (1.0 + a, 2.0 + b, -1.0 + 2.0 * b);
            let want = [x.powi(4), x * x * y * y, x * y * z * z];
            let got = moments.at(&[a, b]);
            for (got, want) in got.iter().zip(want) {
                assert!((got - want).abs() < 1e-9, "{got} {want}");
            }
        }
    }
}
