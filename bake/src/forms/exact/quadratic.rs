//! The exact field Q(sqrt d).

use std::fmt;

use num_bigint::BigInt;
use num_rational::BigRational;
use num_traits::{Signed, ToPrimitive, Zero};

use super::field::{Field, rational_cosine};

/// A number `rational + surd * sqrt(radicand)` of a real quadratic field, exactly.
///
/// Rational numbers have no radicand and mix with every field.
///
/// # Panics
///
/// Adding or multiplying numbers with different radicands panics: their sum lies in no quadratic
/// field. Callers choose one field first (see `exact_radicand` of a scheme).
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Quadratic {
    rational: BigRational,
    surd: BigRational,
    /// Square-free; 1 if `surd` is zero.
    radicand: u32,
}

impl Quadratic {
    /// `rational + surd * sqrt(radicand)`; the radicand is square-free and at least 2.
    #[must_use]
    pub fn new(rational: BigRational, surd: BigRational, radicand: u32) -> Self {
        let radicand = if surd.is_zero() { 1 } else { radicand };
        Self {
            rational,
            surd,
            radicand,
        }
    }

    /// The rational part.
    #[must_use]
    pub fn rational(&self) -> &BigRational {
        &self.rational
    }

    /// What the root is multiplied with.
    #[must_use]
    pub fn surd(&self) -> &BigRational {
        &self.surd
    }

    /// The number under the root; 1 for a rational number.
    #[must_use]
    pub fn radicand(&self) -> u32 {
        self.radicand
    }

    fn common_radicand(&self, other: &Self) -> u32 {
        assert!(
            self.radicand == other.radicand || self.radicand == 1 || other.radicand == 1,
            "sqrt({}) and sqrt({}) do not lie in one quadratic field",
            self.radicand,
            other.radicand
        );
        self.radicand.max(other.radicand)
    }
}

impl From<BigRational> for Quadratic {
    fn from(rational: BigRational) -> Self {
        Self::new(rational, BigRational::zero(), 1)
    }
}

impl Field for Quadratic {
    fn ratio(numerator: i64, denominator: i64) -> Self {
        BigRational::new(numerator.into(), denominator.into()).into()
    }

    fn from_rational(value: &BigRational) -> Self {
        value.clone().into()
    }

    fn cosine(turns: u32, of: u32) -> Option<Self> {
        if let Some(halves) = rational_cosine(turns, of) {
            return Some(Self::ratio(halves.into(), 2));
        }
        let ratio = |n: i64, d: i64| BigRational::new(n.into(), d.into());
        let turns = u64::from(turns % of);
        let part = |parts: u64| {
            (parts * turns)
                .is_multiple_of(u64::from(of))
                .then(|| parts * turns / u64::from(of))
        };
        let (rational, surd, radicand) = if let Some(eighths) = part(8) {
            let sign = if matches!(eighths, 1 | 7) { 1 } else { -1 };
            (ratio(0, 1), ratio(sign, 2), 2)
        } else if let Some(tenths) = part(10) {
            match tenths {
                1 | 9 => (ratio(1, 4), ratio(1, 4), 5),
                2 | 8 => (ratio(-1, 4), ratio(1, 4), 5),
                3 | 7 => (ratio(1, 4), ratio(-1, 4), 5),
                _ => (ratio(-1, 4), ratio(-1, 4), 5),
            }
        } else {
            let twelfths = part(12)?;
            let sign = if matches!(twelfths, 1 | 11) { 1 } else { -1 };
            (ratio(0, 1), ratio(sign, 2), 3)
        };
        Some(Self::new(rational, surd, radicand))
    }

    fn plus(&self, other: &Self) -> Self {
        let radicand = self.common_radicand(other);
        Self::new(
            &self.rational + &other.rational,
            &self.surd + &other.surd,
            radicand,
        )
    }

    fn minus(&self, other: &Self) -> Self {
        let radicand = self.common_radicand(other);
        Self::new(
            &self.rational - &other.rational,
            &self.surd - &other.surd,
            radicand,
        )
    }

    fn times(&self, other: &Self) -> Self {
        let radicand = self.common_radicand(other);
        if radicand == 1 {
            return (&self.rational * &other.rational).into();
        }
        let root = BigRational::from(BigInt::from(radicand));
        Self::new(
            &self.rational * &other.rational + &self.surd * &other.surd * root,
            &self.rational * &other.surd + &self.surd * &other.rational,
            radicand,
        )
    }

    fn is_zero(&self) -> bool {
        self.rational.is_zero() && self.surd.is_zero()
    }

    fn to_f64(&self) -> f64 {
        let rational = self.rational.to_f64().unwrap_or(f64::NAN);
        if self.radicand == 1 {
            return rational;
        }
        // The parts may nearly cancel: the root is taken to 256 bits, not to 53.
        let bits = 256_u32;
        let root = (BigInt::from(self.radicand) << (2 * bits)).sqrt();
        let root = BigRational::new(root, BigInt::from(1) << bits);
        (&self.rational + &self.surd * root)
            .to_f64()
            .unwrap_or(f64::NAN)
    }
}

impl fmt::Display for Quadratic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.surd.is_zero() {
            return write!(f, "{}", self.rational);
        }
        if self.rational.is_zero() {
            return write!(f, "{}*sqrt({})", self.surd, self.radicand);
        }
        let sign = if self.surd.is_negative() { '-' } else { '+' };
        let (rational, surd) = (&self.rational, self.surd.abs());
        write!(f, "{rational} {sign} {surd}*sqrt({})", self.radicand)
    }
}
