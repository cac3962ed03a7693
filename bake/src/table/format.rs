//! The coordinate format: how many fraction bits, and positions to bits and back.

use crate::error::{Error, Result};
use crate::mesh::Point;

/// The most fraction bits a format of 32 bits can have.
pub const MOST_FRACTION_BITS: u32 = 32;

/// Bits of headroom that the default format leaves over the largest coordinate.
const HEADROOM_BITS: i32 = 2;

/// A 32-bit fixed-point format.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Format {
    /// Bits after the point, 0 to 32.
    pub fraction_bits: u32,
}

impl Format {
    /// The finest format that still holds four times the largest of these coordinates (two bits of
    /// headroom), or the coarsest of all if none does.
    pub fn with_headroom<'a>(points: impl IntoIterator<Item = &'a Point>) -> Self {
        let largest = points
            .into_iter()
            .flatten()
            .fold(0.0, |m: f64, c| m.max(c.abs()));
        let fits = |bits: &u32| largest * two_to(*bits as i32) <= two_to(31 - HEADROOM_BITS);
        let fraction_bits = (0..=MOST_FRACTION_BITS).rev().find(fits).unwrap_or(0);
        Self { fraction_bits }
    }

    /// The value of one unit in the last place.
    pub fn unit(self) -> f64 {
        two_to(-(self.fraction_bits as i32))
    }

    /// The coordinate's bits by the one rounding rule, floor(x + 1/2); `None` if they do not fit.
    pub fn to_bits(self, coordinate: f64) -> Option<i32> {
        let scaled = coordinate * two_to(self.fraction_bits as i32);
        let floor = scaled.floor();
        // The difference is exact; adding 1/2 to the number itself would not be.
        let rounded = if scaled - floor >= 0.5 {
            floor + 1.0
        } else {
            floor
        };
        let fits = rounded >= f64::from(i32::MIN) && rounded <= f64::from(i32::MAX);
        fits.then_some(rounded as i32)
    }

    /// The coordinate that the bits stand for; exact.
    pub fn from_bits(self, bits: i32) -> f64 {
        f64::from(bits) * self.unit()
    }

    /// The bits of many points; `what` names a point in the error.
    pub fn bits_of(self, points: &[Point], what: &str) -> Result<Vec<[i32; 3]>> {
        let to_bits = |(index, point): (usize, &Point)| {
            let mut bits = [0; 3];
            for (axis, name) in ["x", "y", "z"].iter().enumerate() {
                bits[axis] = self.to_bits(point[axis]).ok_or_else(|| {
                    let limit = two_to(31 - self.fraction_bits as i32);
                    Error::new(format!(
                        "{what} {index} (counted from 0) has {name} = {}, but with {} fraction bits coordinates lie between -{limit} and {limit}",
                        point[axis], self.fraction_bits
                    ))
                    .advise("bake with fewer --fraction-bits, or take a larger unit")
                })?;
            }
            Ok(bits)
        };
        points.iter().enumerate().map(to_bits).collect()
    }

    /// The points that the bits stand for.
    pub fn points_of(self, bits: &[[i32; 3]]) -> Vec<Point> {
        bits.iter()
            .map(|bits| bits.map(|bits| self.from_bits(bits)))
            .collect()
    }
}

fn two_to(exponent: i32) -> f64 {
    2.0_f64.powi(exponent)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rounding_is_to_nearest_with_ties_up() {
        let format = Format { fraction_bits: 1 };
        for (coordinate, bits) in [
            (0.25, Some(1)),
            (-0.25, Some(0)),
            (-0.2500001, Some(-1)),
            // Half a unit less one place: adding 1/2 in double precision would give 1.
            (0.249_999_999_999_999_97, Some(0)),
            (1_073_741_823.5, Some(i32::MAX)),
            (1_073_741_823.75, None),
            (-1_073_741_824.25, Some(i32::MIN)),
            (-1_073_741_824.5, None),
            (f64::NAN, None),
        ] {
            assert_eq!(format.to_bits(coordinate), bits, "{coordinate}");
        }
        assert_eq!(format.from_bits(-3), -1.5);
    }

    #[test]
    fn two_bits_of_headroom() {
        let bits = |largest: f64| Format::with_headroom(&[[0.0, -largest, 0.0]]).fraction_bits;
        // 128 * 2^22 = 2^29, a quarter of the range; a little more needs one bit less.
        assert_eq!(bits(128.0), 22);
        assert_eq!(bits(128.001), 21);
        assert_eq!(bits(1e-9), 32);
        assert_eq!(bits(1e12), 0);
    }
}
