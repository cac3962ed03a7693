//! What a solver is made of, proved once.

use super::error::InverseError;
use crate::coord::round_div;

/// The most actuators of a solver.
pub const MOST_ACTUATORS: usize = 16;
/// The most effectors of a solver.
pub const MOST_EFFECTORS: usize = 32;
/// The magnitudes of a row of `H` add up to at most this.
pub const HESSIAN_LIMIT: i64 = 1 << 30;
/// A diagonal element of `H` is at least this.
pub const LEAST_CURVATURE: i32 = 1 << 8;
/// The magnitudes of an actuator's gains add up to at most this.
pub const GAIN_LIMIT: i64 = 1 << 31;
/// Forces are clamped to this magnitude.
pub const FORCE_LIMIT: i64 = 1 << 61;

/// What a baker knows of a solver. See [`Inverse::new_checked`] for what must hold.
#[derive(Clone, Copy, Debug)]
pub struct InverseParts<'a> {
    /// `H`, row by row: actuators times actuators.
    pub hessian: &'a [i32],
    /// [`reciprocal`] of each diagonal element of `H`.
    pub reciprocals: &'a [i32],
    /// `A`, row by row: for each actuator x, y and z of each effector.
    pub gains: &'a [i32],
    /// Effectors at rest: raw bits of coordinates.
    pub rest: &'a [[i32; 3]],
    /// Least amplitudes, with 30 fraction bits.
    pub lower: &'a [i32],
    /// Greatest amplitudes.
    pub upper: &'a [i32],
    /// How far amplitudes move in a tick at most.
    pub rates: &'a [i32],
    /// Bits by which differences of goals to the rest positions are rounded.
    pub difference_shift: u32,
    /// Bits by which gains times differences are too small to be forces; negative if they are too large.
    pub gain_shift: i32,
}

/// A solver that has been proved sound.
#[derive(Clone, Copy, Debug)]
pub struct Inverse<'a> {
    pub(super) parts: InverseParts<'a>,
}

impl<'a> Inverse<'a> {
    /// Proves that
    ///
    /// * there are 1 to [`MOST_ACTUATORS`] actuators, 1 to [`MOST_EFFECTORS`] effectors, and all lists fit them;
    /// * the difference shift is at most 31, the gain shift from -31 to 31;
    /// * `H` is symmetric, the magnitudes of each row add up to at most [`HESSIAN_LIMIT`], each diagonal element is
    ///   at least [`LEAST_CURVATURE`] and its reciprocal is right;
    /// * the magnitudes of each actuator's gains add up to at most [`GAIN_LIMIT`];
    /// * no bounds are empty, none is the least 32-bit number, and no rate is negative.
    ///
    /// # Errors
    ///
    /// The [`InverseError`] of the first that does not hold.
    pub fn new_checked(parts: InverseParts<'a>) -> Result<Self, InverseError> {
        let (actuators, effectors) = (parts.lower.len(), parts.rest.len());
        if !(1..=MOST_ACTUATORS).contains(&actuators) || !(1..=MOST_EFFECTORS).contains(&effectors)
        {
            return Err(InverseError::Counts);
        }
        let square = actuators.wrapping_mul(actuators);
        let axes = effectors.wrapping_mul(3);
        let fits = parts.hessian.len() == square
            && parts.reciprocals.len() == actuators
            && parts.gains.len() == actuators.wrapping_mul(axes)
            && parts.upper.len() == actuators
            && parts.rates.len() == actuators;
        if !fits {
            return Err(InverseError::Layout);
        }
        if parts.difference_shift > 31 || !(-31..=31).contains(&parts.gain_shift) {
            return Err(InverseError::Shift);
        }
        check_hessian(&parts, actuators)?;
        for (row, actuator) in parts.gains.chunks_exact(axes).zip(0_u32..) {
            if magnitudes(row) > GAIN_LIMIT {
                return Err(InverseError::Gains { actuator });
            }
        }
        let limits = parts.lower.iter().zip(parts.upper).zip(parts.rates);
        for (((&lower, &upper), &rate), actuator) in limits.zip(0_u32..) {
            if lower > upper || lower == i32::MIN || rate < 0 {
                return Err(InverseError::Bounds { actuator });
            }
        }
        Ok(Self { parts })
    }

    /// Number of actuators.
    #[must_use]
    pub const fn actuators(&self) -> usize {
        self.parts.lower.len()
    }

    /// Number of effectors.
    #[must_use]
    pub const fn effectors(&self) -> usize {
        self.parts.rest.len()
    }

    /// What it is made of.
    #[must_use]
    pub const fn parts(&self) -> &InverseParts<'a> {
        &self.parts
    }

    /// The row of `H` of an actuator.
    #[inline(always)]
    pub(super) fn row(&self, actuator: usize) -> &'a [i32] {
        let start = actuator.wrapping_mul(self.actuators());
        let end = start.wrapping_add(self.actuators());
        self.parts.hessian.get(start..end).unwrap_or_default()
    }
}

/// The reciprocal of a diagonal element `h` with `2^e <= h < 2^(e+1)`: `2^(e+30) / h`, rounded. 0 if `h` is not
/// positive.
#[must_use]
pub const fn reciprocal(diagonal: i32) -> i32 {
    if diagonal <= 0 {
        return 0;
    }
    let exponent = 31_u32.wrapping_sub(diagonal.leading_zeros());
    let numerator = (1_i64 << 30).wrapping_shl(exponent);
    // Above 2^29 and at most 2^30; written without a cast that could cut.
    let bytes = round_div(numerator, widen(diagonal)).to_le_bytes();
    let [a, b, c, d, ..] = bytes;
    i32::from_le_bytes([a, b, c, d])
}

const fn widen(value: i32) -> i64 {
    // `i64::from` is no constant function; the value is positive.
    let [a, b, c, d] = value.to_le_bytes();
    i64::from_le_bytes([a, b, c, d, 0, 0, 0, 0])
}

fn check_hessian(parts: &InverseParts<'_>, actuators: usize) -> Result<(), InverseError> {
    let rows = parts.hessian.chunks_exact(actuators);
    for ((row, &inverse), place) in rows.zip(parts.reciprocals).zip(0_usize..) {
        let actuator = u32::try_from(place).unwrap_or(u32::MAX);
        let column = parts.hessian.iter().skip(place).step_by(actuators);
        let diagonal = row.get(place).copied().unwrap_or_default();
        if diagonal < LEAST_CURVATURE || magnitudes(row) > HESSIAN_LIMIT || !row.iter().eq(column) {
            return Err(InverseError::Hessian { actuator });
        }
        if inverse != reciprocal(diagonal) {
            return Err(InverseError::Reciprocal { actuator });
        }
    }
    Ok(())
}

/// The sum of magnitudes: at most 96 numbers of at most `2^31`.
fn magnitudes(row: &[i32]) -> i64 {
    let magnitude = |&weight: &i32| i64::from(weight.unsigned_abs());
    row.iter().map(magnitude).fold(0, i64::wrapping_add)
}
