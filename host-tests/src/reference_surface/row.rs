//! Masks as rows of integer numerators over one denominator, in `f64`.

use std::collections::BTreeMap;

/// The grid of irrational weights: one is 2^30.
pub const WEIGHT_UNIT: f64 = 1_073_741_824.0;

/// Whether irrational weights are those of the device or real numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Grid {
    /// Multiples of 2^-30.
    Device,
    /// Double precision, no grid.
    Real,
}

impl Grid {
    /// A weight as a numerator over [`WEIGHT_UNIT`].
    pub fn weight(self, real: f64) -> f64 {
        match self {
            Self::Device => (real * WEIGHT_UNIT + 0.5).floor(),
            Self::Real => real * WEIGHT_UNIT,
        }
    }
}

/// A mask: numerators by vertex over a positive denominator. On the device's grid all of them are
/// integers.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// Numerators by old vertex.
    pub entries: BTreeMap<u32, f64>,
    /// What they are counted in.
    pub denominator: f64,
}

impl Row {
    /// The old vertex itself.
    pub fn vertex(vertex: u32) -> Self {
        Self {
            entries: BTreeMap::from([(vertex, 1.0)]),
            denominator: 1.0,
        }
    }

    /// The mean of old vertices.
    pub fn mean(vertices: &[u32]) -> Self {
        let rows: Vec<Self> = vertices
            .iter()
            .map(|vertex| Self::vertex(*vertex))
            .collect();
        Self::mean_of(&rows)
    }

    /// The mean of rows.
    pub fn mean_of(rows: &[Self]) -> Self {
        let terms: Vec<_> = rows.iter().map(|row| (1.0, row.clone())).collect();
        Self::sum(&terms, rows.len() as f64)
    }

    /// `sum(factor * row) / divisor`.
    pub fn sum(terms: &[(f64, Self)], divisor: f64) -> Self {
        let common = terms.iter().fold(1.0, |common, (_, row)| {
            least_multiple(common, row.denominator)
        });
        let mut entries = BTreeMap::new();
        for (factor, row) in terms {
            for (vertex, numerator) in &row.entries {
                *entries.entry(*vertex).or_insert(0.0) +=
                    factor * numerator * (common / row.denominator);
            }
        }
        Self {
            entries,
            denominator: common * divisor,
        }
    }

    /// `own + weight * sum(neighbour - own)` with an irrational weight.
    pub fn umbrella(own: u32, neighbours: &[u32], weight: f64, grid: Grid) -> Self {
        let weight = grid.weight(weight);
        let mut entries = BTreeMap::from([(own, WEIGHT_UNIT - neighbours.len() as f64 * weight)]);
        for neighbour in neighbours {
            *entries.entry(*neighbour).or_insert(0.0) += weight;
        }
        Self {
            entries,
            denominator: WEIGHT_UNIT,
        }
    }

    /// [`Self::rounded`], saturated to 32 bits.
    pub fn round(&self, coordinate: impl Fn(u32) -> i32) -> i32 {
        let value = self.rounded(coordinate);
        value.clamp(f64::from(i32::MIN), f64::from(i32::MAX)) as i32
    }

    /// `floor(value + 1/2)` of the mask on integer coordinates, exactly.
    ///
    /// The numerators, doubled so that half the denominator is an integer, have magnitudes that add
    /// up to less than 2^34. Coordinates enter as a low limb of 16 bits and a high limb, so that
    /// both sums and all that follows are integers within 2^52.
    pub fn rounded(&self, coordinate: impl Fn(u32) -> i32) -> f64 {
        const LIMB: f64 = 65_536.0;
        let denominator = 2.0 * self.denominator;
        let (mut high, mut low) = (0.0, self.denominator);
        for (vertex, numerator) in &self.entries {
            let value = f64::from(coordinate(*vertex));
            let top = (value / LIMB).floor();
            high += 2.0 * numerator * top;
            low += 2.0 * numerator * (value - top * LIMB);
        }
        let quotient = floor_quotient(high, denominator);
        let rest = (high - quotient * denominator) * LIMB + low;
        quotient * LIMB + floor_quotient(rest, denominator)
    }

    /// The mask on real coordinates, to double precision.
    pub fn real(&self, coordinate: impl Fn(u32) -> f64) -> f64 {
        let sum: f64 = self
            .entries
            .iter()
            .map(|(vertex, numerator)| numerator * coordinate(*vertex))
            .sum();
        sum / self.denominator
    }
}

/// `floor(numerator / denominator)` of integers below 2^53: a quotient that was rounded up to the
/// next integer leaves a negative remainder.
fn floor_quotient(numerator: f64, denominator: f64) -> f64 {
    let estimate = (numerator / denominator).floor();
    if numerator - estimate * denominator < 0.0 {
        estimate - 1.0
    } else {
        estimate
    }
}

fn least_multiple(one: f64, other: f64) -> f64 {
    let (mut a, mut b) = (one, other);
    while b != 0.0 {
        (a, b) = (b, a % b);
    }
    one / a * other
}
