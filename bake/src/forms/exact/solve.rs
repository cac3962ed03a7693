//! Exact solution of linear systems over Q(sqrt d), by p-adic lifting.
//!
//! A system with integer entries is factored once modulo a prime `p`. Each further solution modulo
//! `p` gives one more digit of the answer in base `p` (Dixon 1982); when there are enough digits,
//! the rational numbers are read off, and the answer is checked in the system itself. A root
//! is taken out of the system first, by doubling it: `(A + B sqrt d)(u + v sqrt d) = r + s sqrt d`
//! is `A u + d B v = r`, `B u + A v = s`.

use num_bigint::BigInt;
use num_integer::Integer;
use num_rational::BigRational;
use num_traits::{One, Signed, ToPrimitive, Zero};

use super::quadratic::Quadratic;

/// The prime 2^61 - 1: products are reduced by one shift and one addition.
const PRIME: u64 = (1 << 61) - 1;

/// The integer `rational + surd * sqrt d`, of magnitudes below 2^55.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct QuadraticInteger {
    pub rational: i128,
    pub surd: i128,
}

/// Solves `matrix * x = right`; `matrix` holds the nonzero entries of each row.
///
/// `None` if the matrix is singular (modulo 2^61 - 1).
pub(crate) fn solve(
    matrix: &[Vec<(usize, QuadraticInteger)>],
    right: &[Quadratic],
    radicand: u32,
) -> Option<Vec<Quadratic>> {
    let size = right.len();
    let rational = right.iter().map(|value| value.rational().clone());
    if radicand == 1 {
        let rows = matrix
            .iter()
            .map(|row| {
                row.iter()
                    .map(|(column, entry)| (*column, entry.rational))
                    .collect()
            })
            .collect::<Vec<Vec<_>>>();
        let solution = solve_rational(&rows, &rational.collect::<Vec<_>>())?;
        return Some(solution.into_iter().map(Quadratic::from).collect());
    }
    let mut rows = vec![Vec::new(); 2 * size];
    for (index, row) in matrix.iter().enumerate() {
        for (column, entry) in row {
            if entry.rational != 0 {
                rows[index].push((*column, entry.rational));
                rows[index + size].push((*column + size, entry.rational));
            }
            if entry.surd != 0 {
                rows[index].push((*column + size, entry.surd * i128::from(radicand)));
                rows[index + size].push((*column, entry.surd));
            }
        }
    }
    let surd = right.iter().map(|value| value.surd().clone());
    let right = rational.chain(surd).collect::<Vec<_>>();
    let solution = solve_rational(&rows, &right)?;
    let (rational, surd) = solution.split_at(size);
    let pairs = rational.iter().zip(surd);
    Some(
        pairs
            .map(|(rational, surd)| Quadratic::new(rational.clone(), surd.clone(), radicand))
            .collect(),
    )
}

fn solve_rational(rows: &[Vec<(usize, i128)>], right: &[BigRational]) -> Option<Vec<BigRational>> {
    if right.iter().all(Zero::is_zero) {
        return Some(vec![BigRational::zero(); right.len()]);
    }
    let denominator = right
        .iter()
        .fold(BigInt::one(), |common, value| common.lcm(value.denom()));
    let target = right
        .iter()
        .map(|value| value.numer() * (&denominator / value.denom()))
        .collect::<Vec<_>>();
    let factors = Factors::new(rows)?;
    let mut residual = target.clone();
    let mut digits: Vec<Vec<u64>> = Vec::new();
    let mut wanted = 8;
    loop {
        while digits.len() < wanted {
            let digit = factors.solve(&residual);
            subtract_and_divide(rows, &digit, &mut residual);
            digits.push(digit);
        }
        if let Some((numerators, common)) = read_off(&digits)
            && is_solution(rows, &numerators, &common, &target)
        {
            let common = common * &denominator;
            let value = |numerator| BigRational::new(numerator, common.clone());
            return Some(numerators.into_iter().map(value).collect());
        }
        wanted *= 2;
    }
}

/// `residual = (residual - matrix * digit) / p`.
fn subtract_and_divide(rows: &[Vec<(usize, i128)>], digit: &[u64], residual: &mut [BigInt]) {
    for (row, value) in rows.iter().zip(residual) {
        // Entries below 2^56, digits below 2^61 and fewer than 2^10 columns: below 2^127.
        let product: i128 = row
            .iter()
            .map(|(column, entry)| entry * i128::from(digit[*column]))
            .sum();
        *value -= product;
        *value /= PRIME;
    }
}

/// The numerators and the common denominator of the numbers with these digits in base `p`.
fn read_off(digits: &[Vec<u64>]) -> Option<(Vec<BigInt>, BigInt)> {
    let modulus = BigInt::from(PRIME).pow(u32::try_from(digits.len()).ok()?);
    let bound = (&modulus / 2_u32).sqrt();
    let size = digits.first()?.len();
    let mut common = BigInt::one();
    let mut numerators: Vec<BigInt> = Vec::with_capacity(size);
    for index in 0..size {
        let mut value = BigInt::zero();
        for digit in digits.iter().rev() {
            value = value * PRIME + digit[index];
        }
        let value = (value * &common).mod_floor(&modulus);
        let (numerator, factor) = reconstruct(value, &modulus, &bound)?;
        if !factor.is_one() {
            common *= &factor;
            for earlier in &mut numerators {
                *earlier *= &factor;
            }
        }
        numerators.push(numerator);
    }
    Some((numerators, common))
}

/// The fraction with numerator and denominator at most `bound` that is `value` modulo `modulus`.
fn reconstruct(value: BigInt, modulus: &BigInt, bound: &BigInt) -> Option<(BigInt, BigInt)> {
    let (mut above, mut remainder) = (modulus.clone(), value);
    let (mut factor_above, mut factor) = (BigInt::zero(), BigInt::one());
    while &remainder > bound {
        let quotient = &above / &remainder;
        let next = &above - &quotient * &remainder;
        above = std::mem::replace(&mut remainder, next);
        let next = &factor_above - &quotient * &factor;
        factor_above = std::mem::replace(&mut factor, next);
    }
    if &factor.abs() > bound || factor.is_zero() {
        return None;
    }
    if factor.is_negative() {
        return Some((-remainder, -factor));
    }
    Some((remainder, factor))
}

fn is_solution(
    rows: &[Vec<(usize, i128)>],
    numerators: &[BigInt],
    common: &BigInt,
    target: &[BigInt],
) -> bool {
    rows.iter().zip(target).all(|(row, target)| {
        let sum: BigInt = row
            .iter()
            .map(|(column, entry)| &numerators[*column] * entry)
            .sum();
        sum == target * common
    })
}

/// A matrix modulo `p` as the product of a lower and an upper triangular one, rows exchanged.
struct Factors {
    size: usize,
    entries: Vec<u64>,
    order: Vec<usize>,
    inverse_pivots: Vec<u64>,
}

impl Factors {
    fn new(rows: &[Vec<(usize, i128)>]) -> Option<Self> {
        let size = rows.len();
        let mut entries = vec![0_u64; size * size];
        for (index, row) in rows.iter().enumerate() {
            for (column, entry) in row {
                let entry = entry.rem_euclid(i128::from(PRIME));
                entries[index * size + column] = u64::try_from(entry).ok()?;
            }
        }
        let mut order = (0..size).collect::<Vec<_>>();
        let mut inverse_pivots = Vec::with_capacity(size);
        for pivot in 0..size {
            let found = (pivot..size).find(|row| entries[row * size + pivot] != 0)?;
            if found != pivot {
                order.swap(found, pivot);
                for column in 0..size {
                    entries.swap(found * size + column, pivot * size + column);
                }
            }
            let inverse = power(entries[pivot * size + pivot], PRIME - 2);
            inverse_pivots.push(inverse);
            let (done, below) = entries.split_at_mut((pivot + 1) * size);
            let pivot_row = &done[pivot * size..];
            for row in below.chunks_exact_mut(size) {
                if row[pivot] == 0 {
                    continue;
                }
                let factor = multiply(row[pivot], inverse);
                row[pivot] = factor;
                let rest = row[pivot + 1..].iter_mut().zip(&pivot_row[pivot + 1..]);
                for (entry, &above) in rest {
                    *entry = subtract(*entry, multiply(factor, above));
                }
            }
        }
        Some(Self {
            size,
            entries,
            order,
            inverse_pivots,
        })
    }

    /// The solution modulo `p`, each number from 0 to `p - 1`.
    fn solve(&self, right: &[BigInt]) -> Vec<u64> {
        let prime = BigInt::from(PRIME);
        let reduced = |value: &BigInt| value.mod_floor(&prime).to_u64().unwrap_or_default();
        let mut values = self
            .order
            .iter()
            .map(|&row| reduced(&right[row]))
            .collect::<Vec<_>>();
        for row in 0..self.size {
            let entries = &self.entries[row * self.size..][..row];
            let mut value = values[row];
            for (&entry, &known) in entries.iter().zip(&values) {
                value = subtract(value, multiply(entry, known));
            }
            values[row] = value;
        }
        for row in (0..self.size).rev() {
            let entries = &self.entries[row * self.size..][row + 1..self.size];
            let mut value = values[row];
            for (&entry, &known) in entries.iter().zip(&values[row + 1..]) {
                value = subtract(value, multiply(entry, known));
            }
            values[row] = multiply(value, self.inverse_pivots[row]);
        }
        values
    }
}

fn multiply(a: u64, b: u64) -> u64 {
    let product = u128::from(a) * u128::from(b);
    #[expect(
        clippy::cast_possible_truncation,
        reason = "the low 61 bits and the high 61 bits of a product below 2^122"
    )]
    let (low, high) = ((product as u64) & PRIME, (product >> 61) as u64);
    let sum = low + high;
    if sum >= PRIME { sum - PRIME } else { sum }
}

fn subtract(a: u64, b: u64) -> u64 {
    if a >= b { a - b } else { a + PRIME - b }
}

fn power(base: u64, exponent: u64) -> u64 {
    let (mut result, mut square) = (1, base);
    for bit in 0..u64::BITS {
        if exponent >> bit & 1 == 1 {
            result = multiply(result, square);
        }
        square = multiply(square, square);
    }
    result
}

/// The least positive integer that clears the denominators of all numbers.
pub(crate) fn common_denominator<'a>(values: impl Iterator<Item = &'a Quadratic>) -> BigInt {
    values.fold(BigInt::one(), |common, value| {
        common
            .lcm(value.rational().denom())
            .lcm(value.surd().denom())
    })
}

impl QuadraticInteger {
    /// `value * scale`, which must be an integer.
    pub(crate) fn from_scaled(value: &Quadratic, scale: &BigInt) -> Option<Self> {
        let integer = |part: &BigRational| {
            let scaled = part * BigRational::from(scale.clone());
            scaled.is_integer().then(|| scaled.to_integer().to_i128())?
        };
        Some(Self {
            rational: integer(value.rational())?,
            surd: integer(value.surd())?,
        })
    }

    pub(crate) fn times(self, other: Self, radicand: i128) -> Self {
        Self {
            rational: self.rational * other.rational + radicand * self.surd * other.surd,
            surd: self.rational * other.surd + self.surd * other.rational,
        }
    }

    pub(crate) fn minus(self, other: Self) -> Self {
        Self {
            rational: self.rational - other.rational,
            surd: self.surd - other.surd,
        }
    }

    pub(crate) fn plus(self, other: Self) -> Self {
        Self {
            rational: self.rational + other.rational,
            surd: self.surd + other.surd,
        }
    }

    pub(crate) fn is_zero(self) -> bool {
        self == Self::default()
    }
}
