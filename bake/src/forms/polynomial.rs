//! Polynomials in two variables with integer coefficients, and their integrals.

use num_rational::BigRational;
use num_traits::Zero;

/// Where a patch is integrated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Domain {
    /// `0 <= s, t <= 1`.
    Square,
    /// `0 <= s, t` and `s + t <= 1`.
    Triangle,
}

/// A polynomial: the coefficient of `s^a t^b` at `[a][b]`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Polynomial {
    coefficients: Vec<Vec<i128>>,
}

impl Polynomial {
    /// A constant.
    pub(crate) fn constant(value: i128) -> Self {
        Self {
            coefficients: vec![vec![value]],
        }
    }

    /// `constant + in_s * s + in_t * t`.
    pub(crate) fn linear(constant: i128, in_s: i128, in_t: i128) -> Self {
        Self {
            coefficients: vec![vec![constant, in_t], vec![in_s, 0]],
        }
    }

    /// `p(s) q(t)`, both given by their coefficients from the constant on.
    pub(crate) fn product_of(p: &[i128], q: &[i128]) -> Self {
        let row = |a: &i128| q.iter().map(|b| a * b).collect();
        Self {
            coefficients: p.iter().map(row).collect(),
        }
    }

    pub(crate) fn terms(&self) -> impl Iterator<Item = (usize, usize, i128)> {
        let rows = self.coefficients.iter().enumerate();
        rows.flat_map(|(a, row)| row.iter().enumerate().map(move |(b, &c)| (a, b, c)))
            .filter(|term| term.2 != 0)
    }

    fn from_terms(terms: impl Iterator<Item = (usize, usize, i128)>) -> Self {
        let mut coefficients: Vec<Vec<i128>> = vec![vec![0]];
        for (a, b, value) in terms {
            if coefficients.len() <= a {
                coefficients.resize(a + 1, Vec::new());
            }
            if coefficients[a].len() <= b {
                coefficients[a].resize(b + 1, 0);
            }
            coefficients[a][b] += value;
        }
        Self { coefficients }
    }

    pub(crate) fn times(&self, other: &Self) -> Self {
        Self::from_terms(self.terms().flat_map(|(a, b, x)| {
            let terms = other.terms();
            terms.map(move |(c, d, y)| (a + c, b + d, x * y))
        }))
    }

    /// `self + factor * other`.
    pub(crate) fn plus(&self, factor: i128, other: &Self) -> Self {
        let scaled = other.terms().map(|(a, b, value)| (a, b, factor * value));
        Self::from_terms(self.terms().chain(scaled))
    }

    /// The derivative by `s`.
    pub(crate) fn by_s(&self) -> Self {
        let terms = self.terms().filter(|term| term.0 > 0);
        Self::from_terms(terms.map(|(a, b, value)| (a - 1, b, value * exponent(a))))
    }

    /// The derivative by `t`.
    pub(crate) fn by_t(&self) -> Self {
        let terms = self.terms().filter(|term| term.1 > 0);
        Self::from_terms(terms.map(|(a, b, value)| (a, b - 1, value * exponent(b))))
    }

    /// The integral over the domain.
    pub(crate) fn integral(&self, domain: Domain) -> BigRational {
        let mut total = BigRational::zero();
        for (a, b, value) in self.terms() {
            let (numerator, denominator) = match domain {
                Domain::Square => (value, exponent(a + 1) * exponent(b + 1)),
                // a! b! / (a + b + 2)!
                Domain::Triangle => (
                    (1..=b).fold(value, |product, k| product * exponent(k)),
                    (1..=b + 2).fold(1, |product, k| product * exponent(a + k)),
                ),
            };
            total += BigRational::new(numerator.into(), denominator.into());
        }
        total
    }

    /// The greatest common divisor of the coefficients and a number.
    pub(crate) fn common_divisor(&self, start: i128) -> i128 {
        self.terms()
            .fold(start, |common, term| num_integer::gcd(common, term.2))
    }

    /// All coefficients divided by a divisor of them.
    pub(crate) fn divided_by(&self, divisor: i128) -> Self {
        Self::from_terms(self.terms().map(|(a, b, value)| (a, b, value / divisor)))
    }

    /// The value at a point, in double precision.
    #[expect(
        clippy::cast_precision_loss,
        reason = "the coefficients of the bases are far below 2^53"
    )]
    pub(crate) fn at(&self, s: f64, t: f64) -> f64 {
        let row = |row: &Vec<i128>| row.iter().rev().fold(0.0, |sum, &c| sum * t + c as f64);
        self.coefficients
            .iter()
            .rev()
            .fold(0.0, |sum, coefficients| sum * s + row(coefficients))
    }
}

fn exponent(value: usize) -> i128 {
    i128::try_from(value).expect("degrees are small")
}
