//! The three named families of Loop's vertex weight.

use super::solid::Boundary;

/// The grid of weights that are not rational: one is 2^30.
pub const WEIGHT_UNIT: f64 = 1_073_741_824.0;

/// The weights of a boundary vertex with `n` neighbours, as integers over a denominator.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LoopWeight {
    /// The vertex's own weight: the denominator less `n` times `neighbour`.
    pub own: f64,
    /// The weight of each of the `n` neighbours.
    pub neighbour: f64,
    /// What both are counted in; [`WEIGHT_UNIT`] exactly where the weight is not rational.
    pub denominator: f64,
    /// The real number that `neighbour / denominator` stands for.
    pub real_neighbour: f64,
}

impl LoopWeight {
    /// The weights at a vertex with `valence >= 1` boundary edges.
    ///
    /// `None` for the boundary choices that have no surface rule.
    pub fn new(boundary: Boundary, valence: usize) -> Option<Self> {
        let n = valence as f64;
        match boundary {
            Boundary::Interior | Boundary::Fixed => None,
            Boundary::LoopWarren if valence == 3 => Some(Self::rational(3.0, 16.0, n)),
            Boundary::LoopWarren | Boundary::TriQuad => Some(Self::rational(3.0, 8.0 * n, n)),
            Boundary::Loop => Some(Self::of_1987(valence)),
        }
    }

    fn rational(neighbour: f64, denominator: f64, valence: f64) -> Self {
        Self {
            own: denominator - valence * neighbour,
            neighbour,
            denominator,
            real_neighbour: neighbour / denominator,
        }
    }

    /// `(1/n)(5/8 - (3/8 + cos(2 pi / n)/4)^2)`; the cosines 1, -1, -1/2, 0 and 1/2 of the
    /// valences 1, 2, 3, 4 and 6 are the rational ones.
    fn of_1987(valence: usize) -> Self {
        let n = valence as f64;
        match valence {
            1 => Self::rational(15.0, 64.0, n),
            2 => Self::rational(39.0, 128.0, n),
            3 => Self::rational(3.0, 16.0, n),
            4 => Self::rational(31.0, 256.0, n),
            6 => Self::rational(1.0, 16.0, n),
            _ => {
                let ring = 0.375 + (std::f64::consts::TAU / n).cos() / 4.0;
                let beta = (0.625 - ring * ring) / n;
                let neighbour = (beta * WEIGHT_UNIT + 0.5).floor();
                Self {
                    real_neighbour: beta,
                    ..Self::rational(neighbour, WEIGHT_UNIT, n)
                }
            }
        }
    }
}
