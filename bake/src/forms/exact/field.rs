//! What a weight can be.

use std::f64::consts::PI;
use std::fmt::Debug;

use num_rational::BigRational;
use num_traits::ToPrimitive;

/// A field that subdivision weights, forms and coordinates are computed in.
pub trait Field: Clone + Debug + PartialEq + 'static {
    /// The number `numerator / denominator`; the denominator is not zero.
    fn ratio(numerator: i64, denominator: i64) -> Self;

    /// The number nearest to a rational number, or one beside it.
    fn from_rational(value: &BigRational) -> Self;

    /// `cos(2 pi turns / of)`, if the field holds it.
    fn cosine(turns: u32, of: u32) -> Option<Self>;

    /// `self + other`.
    fn plus(&self, other: &Self) -> Self;

    /// `self - other`.
    fn minus(&self, other: &Self) -> Self;

    /// `self * other`.
    fn times(&self, other: &Self) -> Self;

    /// True for zero.
    fn is_zero(&self) -> bool;

    /// The nearest number in double precision, or one beside it.
    fn to_f64(&self) -> f64;

    /// Zero.
    fn zero() -> Self {
        Self::ratio(0, 1)
    }

    /// One.
    fn one() -> Self {
        Self::ratio(1, 1)
    }

    /// `-self`.
    fn negated(&self) -> Self {
        Self::zero().minus(self)
    }

    /// `numerator / denominator * self`.
    fn scaled(&self, numerator: i64, denominator: i64) -> Self {
        self.times(&Self::ratio(numerator, denominator))
    }

    /// `self += weight * other`, skipping products with zero.
    fn add_product(&mut self, weight: &Self, other: &Self) {
        if !weight.is_zero() && !other.is_zero() {
            *self = self.plus(&weight.times(other));
        }
    }
}

impl Field for f64 {
    #[expect(
        clippy::cast_precision_loss,
        reason = "weights have small numerators and denominators"
    )]
    fn ratio(numerator: i64, denominator: i64) -> Self {
        numerator as f64 / denominator as f64
    }

    fn from_rational(value: &BigRational) -> Self {
        value.to_f64().unwrap_or(f64::NAN)
    }

    fn cosine(turns: u32, of: u32) -> Option<Self> {
        Some(match rational_cosine(turns, of) {
            Some(halves) => f64::from(halves) / 2.0,
            None => (2.0 * PI * f64::from(turns % of) / f64::from(of)).cos(),
        })
    }

    fn plus(&self, other: &Self) -> Self {
        self + other
    }

    fn minus(&self, other: &Self) -> Self {
        self - other
    }

    fn times(&self, other: &Self) -> Self {
        self * other
    }

    fn is_zero(&self) -> bool {
        *self == 0.0
    }

    fn to_f64(&self) -> f64 {
        *self
    }

    fn scaled(&self, numerator: i64, denominator: i64) -> Self {
        self * Self::ratio(numerator, denominator)
    }
}

/// Twice `cos(2 pi turns / of)` where that is an integer: the only rational cosines.
pub(super) fn rational_cosine(turns: u32, of: u32) -> Option<i32> {
    // The angle in twelfths of a turn, if it is one.
    let twelfths = 12 * (u64::from(turns) % u64::from(of));
    if !twelfths.is_multiple_of(u64::from(of)) {
        return None;
    }
    match twelfths / u64::from(of) {
        0 => Some(2),
        2 | 10 => Some(1),
        3 | 9 => Some(0),
        4 | 8 => Some(-1),
        6 => Some(-2),
        _ => None,
    }
}
