//! The rig written again from its contract, in integers of any length.
//!
//! Every value is a whole number of a stated unit and every rounding a floor division of the exact
//! number. The coefficients of sine and cosine are made here from the digits of pi. Joints are walked
//! from each control point up to its root's frame by recursion, not in the order of a table.

use num_bigint::BigInt;
use num_rational::BigRational;
use num_traits::{One, Signed, ToPrimitive, Zero};

/// Digits of pi behind the decimal point: far more than the coefficients take.
const PI: &str = "31415926535897932384626433832795028841971693993751058209749445923078164062862";

/// A joint: its parent, its pivot and its axis (30 fraction bits).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct JointData {
    /// The joint that carries it.
    pub parent: Option<usize>,
    /// Its pivot at rest.
    pub pivot: [i32; 3],
    /// Its axis; zero if it is fixed.
    pub axis: [i32; 3],
}

/// A rig.
#[derive(Clone, Debug, Default)]
pub struct RigData {
    /// Its joints.
    pub joints: Vec<JointData>,
    /// The control points at rest.
    pub rest: Vec<[i32; 3]>,
    /// Joint and weight (14 fraction bits) of what carries each control point.
    pub influences: Vec<Vec<(u16, u16)>>,
}

/// A joint in space: rotation (30 fraction bits) and pivot (units of 2^-8).
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Placed {
    /// Rows of the rotation.
    pub rotation: [[BigInt; 3]; 3],
    /// The pivot.
    pub pivot: [BigInt; 3],
}

/// `floor(value / 2^shift + 1/2)`.
fn round(value: &BigInt, shift: u32) -> BigInt {
    let doubled: BigInt = (value * 2) + (BigInt::one() << shift);
    doubled >> (shift + 1)
}

fn nearest(value: &BigRational) -> BigInt {
    let half = BigRational::new(BigInt::one(), BigInt::from(2));
    (value + half).floor().to_integer()
}

/// What the contract says of the two polynomials: the fraction bits of their coefficients.
const SINE_BITS: [u32; 6] = [32, 34, 38, 44, 50, 56];
const COSINE_BITS: [u32; 7] = [30, 32, 36, 41, 47, 54, 60];

/// Sine and cosine by the contract.
#[derive(Clone, Debug)]
pub struct Turns {
    sine: Vec<BigInt>,
    cosine: Vec<BigInt>,
}

impl Default for Turns {
    fn default() -> Self {
        Self::new()
    }
}

impl Turns {
    /// Makes the coefficients: Taylor's, of an eighth of a turn.
    #[must_use]
    pub fn new() -> Self {
        let digits = BigInt::parse_bytes(PI.as_bytes(), 10).unwrap_or_default();
        let scale = num_traits::pow(BigInt::from(10), PI.len() - 1);
        let eighth = BigRational::new(digits, scale * 4);
        let (mut sine, mut cosine) = (Vec::new(), Vec::new());
        let mut term = BigRational::one();
        for power in 0_u32..13 {
            let half = (power / 2) as usize;
            let signed = if half.is_multiple_of(2) {
                term.clone()
            } else {
                -&term
            };
            let (list, bits) = if power.is_multiple_of(2) {
                (&mut cosine, COSINE_BITS.get(half))
            } else {
                (&mut sine, SINE_BITS.get(half))
            };
            if let Some(&bits) = bits {
                let unit = BigRational::from_integer(BigInt::one() << bits);
                list.push(nearest(&(signed * unit)));
            }
            term = term * &eighth / BigRational::from_integer(BigInt::from(power + 1));
        }
        Self { sine, cosine }
    }

    /// Sine and cosine of an angle, 30 fraction bits.
    #[must_use]
    pub fn of(&self, angle: i32) -> [BigInt; 2] {
        let turn = BigInt::from(angle);
        let quarters = round(&turn, 30);
        let left: BigInt = turn - (&quarters << 30);
        let square = round(&(&left * &left), 28);
        let value = |coefficients: &[BigInt], bits: &[u32]| {
            let last = coefficients.len() - 1;
            (0..last).rev().fold(coefficients[last].clone(), |sum, at| {
                &coefficients[at] + round(&(sum * &square), bits[at + 1] + 30 - bits[at])
            })
        };
        let slope = value(&self.sine, &SINE_BITS);
        let sine = round(&(slope * left), 32 + 29 - 30);
        let cosine = value(&self.cosine, &COSINE_BITS);
        // A quarter turn takes (sine, cosine) to (cosine, -sine).
        let quarters = ((quarters % 4_u32 + 4_u32) % 4_u32)
            .to_u32()
            .unwrap_or_default();
        (0..quarters).fold([sine, cosine], |[sine, cosine], _| [cosine, -sine])
    }
}

impl RigData {
    /// Where a joint is in space.
    fn placed(&self, turns: &Turns, joint: usize, angles: &[i32], base: [i32; 3]) -> Placed {
        let own = self.joints[joint];
        let rotation = own_rotation(turns, own.axis, angles[joint]);
        match own.parent {
            None => Placed {
                rotation,
                pivot: [0, 1, 2].map(|axis| {
                    (BigInt::from(own.pivot[axis]) + BigInt::from(base[axis])) << 8_u32
                }),
            },
            Some(parent) => {
                let carrier = self.placed(turns, parent, angles, base);
                let rows = carrier.rotation.clone().map(|row| {
                    [0, 1, 2].map(|column| {
                        let sum: BigInt = (0..3).map(|k| &row[k] * &rotation[k][column]).sum();
                        round(&sum, 30)
                    })
                });
                Placed {
                    rotation: rows,
                    pivot: self.carried(parent, &carrier, own.pivot),
                }
            }
        }
    }

    /// Where a joint takes what stood at `place`.
    fn carried(&self, joint: usize, placed: &Placed, place: [i32; 3]) -> [BigInt; 3] {
        let pivot = self.joints[joint].pivot;
        [0, 1, 2].map(|row| {
            let sum: BigInt = (0..3)
                .map(|k| {
                    &placed.rotation[row][k] * (BigInt::from(place[k]) - BigInt::from(pivot[k]))
                })
                .sum();
            &placed.pivot[row] + round(&sum, 22)
        })
    }

    /// All joints in space.
    #[must_use]
    pub fn frames(&self, turns: &Turns, angles: &[i32], base: [i32; 3]) -> Vec<Placed> {
        let joints = 0..self.joints.len();
        joints
            .map(|joint| self.placed(turns, joint, angles, base))
            .collect()
    }

    /// The control points that are carried, the others as in `pose`, and how many coordinates were
    /// clamped.
    #[must_use]
    pub fn carry(&self, frames: &[Placed], pose: &[[i32; 3]]) -> (Vec<[i32; 3]>, u32) {
        let mut clamped = 0;
        let mut carried = pose.to_vec();
        for (point, influences) in self.influences.iter().enumerate() {
            if influences.is_empty() {
                continue;
            }
            let mut sum = [0, 1, 2].map(|_| BigInt::zero());
            for &(joint, weight) in influences {
                let joint = usize::from(joint);
                let placed = self.carried(joint, &frames[joint], self.rest[point]);
                for (sum, value) in sum.iter_mut().zip(placed) {
                    *sum += value * weight;
                }
            }
            carried[point] = sum.map(|sum| {
                let value = round(&sum, 22);
                value.to_i32().unwrap_or_else(|| {
                    clamped += 1;
                    if value.is_negative() {
                        i32::MIN
                    } else {
                        i32::MAX
                    }
                })
            });
        }
        (carried, clamped)
    }
}

/// The rotation by an angle about an axis.
fn own_rotation(turns: &Turns, axis: [i32; 3], angle: i32) -> [[BigInt; 3]; 3] {
    let one: BigInt = BigInt::one() << 30;
    let identity = |row: usize, column: usize| BigInt::from(u8::from(row == column));
    if axis == [0; 3] {
        return [0, 1, 2].map(|row| [0, 1, 2].map(|column| identity(row, column) * &one));
    }
    let [sine, cosine] = turns.of(angle);
    let axis = axis.map(BigInt::from);
    [0, 1, 2].map(|row: usize| {
        let scaled = round(&((&one - &cosine) * &axis[row]), 30);
        [0, 1, 2].map(|column: usize| {
            // The cross product's matrix: entry (i, j) is minus epsilon_ijk a_k.
            let cross = match (column + 3 - row) % 3 {
                1 => -&axis[(row + 2) % 3],
                2 => axis[(row + 1) % 3].clone(),
                _ => BigInt::zero(),
            };
            let exact =
                identity(row, column) * &cosine * &one + &scaled * &axis[column] + cross * &sine;
            round(&exact, 30)
        })
    })
}
