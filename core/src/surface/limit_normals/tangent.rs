//! Value types of tangents and normals.

use core::marker::PhantomData;

use crate::blend::IrrationalWeight;
use crate::coord::Coordinate;
use crate::deform::unit_vector;

/// A value type of positions, and how tangents and normals are formed of it.
pub trait TangentBlend {
    /// What a vertex stores.
    type Point;
    /// A sum of weighted differences.
    type Sum: Clone;
    /// What comes out.
    type Normal: Clone;

    /// The empty sum.
    fn zero(&self) -> Self::Sum;

    /// `sum += weight * (point - own)`.
    fn add(
        &self,
        sum: &mut Self::Sum,
        weight: IrrationalWeight,
        point: &Self::Point,
        own: &Self::Point,
    );

    /// The unit vector along `one x other`; that of [`TangentBlend::no_normal`] if they are parallel.
    fn normal(&mut self, one: &Self::Sum, other: &Self::Sum) -> Self::Normal;

    /// The unit vector along the cross product of the first two, on the side of that of the second two; that of the
    /// second two if the first are parallel.
    fn corner_normal(&mut self, edges: &[Self::Sum; 2], crease: &[Self::Sum; 2]) -> Self::Normal;

    /// What stands where there is no normal. An implementation may count.
    fn no_normal(&mut self) -> Self::Normal;
}

/// Tangents of fixed-point positions, normals of 14 fraction bits.
///
/// A tangent is an exact sum. It is then *shortened*: with `m` the magnitude of its greatest coordinate
/// and `b` the number of bits of `m` less 30, every coordinate becomes `floor(x / 2^b + 1/2)` if `b` is
/// positive. The cross product of two shortened tangents is exact and is brought to unit length as that of a
/// deformed point's faces ([`Normals`](crate::deform::Normals)): one is `2^14`.
///
/// # Scaling and overflow
///
/// Differences of 32-bit coordinates have 33 bits, weights are at most `2^30 * k` for `k` faces of a
/// sector: a sum of `n` terms is below `2^63 * k * n`, held in 128 bits for any 32-bit `k` and `n`. A
/// shortened coordinate is at most `2^30`, a cross product's at most `2^61`, and the dot product of two of these at
/// most `3 * 2^122`, in 128 bits.
///
/// # Precision
///
/// Shortening turns a tangent by less than `2^-29`; at an angle `a` between the tangents the normal is within
/// `2^-13 + 2^-28 / sin(a)` of that of the real numbers, plus what the weights' grid of 2^-30 does to
/// neighbourhoods whose tangents nearly vanish.
#[derive(Clone, Debug)]
pub struct FixedTangents<C> {
    zeros: u32,
    format: PhantomData<C>,
}

impl<C> FixedTangents<C> {
    /// Has met no normal of zero yet.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            zeros: 0,
            format: PhantomData,
        }
    }

    /// How many normals were zero since [`FixedTangents::new`], a sector's counted once.
    #[must_use]
    pub const fn zeros(&self) -> u32 {
        self.zeros
    }

    fn unit(&mut self, cross: [i64; 3]) -> [i16; 3] {
        if cross == [0; 3] {
            return self.none();
        }
        unit_vector(cross)
    }

    fn none(&mut self) -> [i16; 3] {
        self.zeros = self.zeros.saturating_add(1);
        [0; 3]
    }
}

impl<C> Default for FixedTangents<C> {
    fn default() -> Self {
        Self::new()
    }
}

impl<C: Coordinate> TangentBlend for FixedTangents<C> {
    type Point = [C; 3];
    type Sum = [i128; 3];
    type Normal = [i16; 3];

    fn zero(&self) -> [i128; 3] {
        [0; 3]
    }

    fn add(&self, sum: &mut [i128; 3], weight: IrrationalWeight, point: &[C; 3], own: &[C; 3]) {
        for ((total, to), from) in sum.iter_mut().zip(point).zip(own) {
            let difference = i64::from(to.to_bits()).wrapping_sub(i64::from(from.to_bits()));
            let product = i128::from(weight.bits).wrapping_mul(i128::from(difference));
            *total = total.wrapping_add(product);
        }
    }

    fn normal(&mut self, one: &[i128; 3], other: &[i128; 3]) -> [i16; 3] {
        self.unit(cross(one, other))
    }

    fn corner_normal(&mut self, edges: &[[i128; 3]; 2], crease: &[[i128; 3]; 2]) -> [i16; 3] {
        let ([first, last], [along, across]) = (edges, crease);
        let guide = cross(along, across);
        let plane = cross(first, last);
        if plane == [0; 3] {
            return self.unit(guide);
        }
        let terms = plane.iter().zip(guide);
        let side = terms.fold(0_i128, |sum, (&one, other)| {
            sum.wrapping_add(i128::from(one).wrapping_mul(other.into()))
        });
        self.unit(if side < 0 {
            plane.map(i64::wrapping_neg)
        } else {
            plane
        })
    }

    fn no_normal(&mut self) -> [i16; 3] {
        self.none()
    }
}

/// Bits of the greatest coordinate of a shortened tangent.
const SHORT_BITS: u32 = 30;

/// At most 30 bits and a sign.
fn shortened(sum: &[i128; 3]) -> [i64; 3] {
    let mut greatest = 0_u128;
    for coordinate in sum {
        greatest = greatest.max(coordinate.unsigned_abs());
    }
    let bits = u128::BITS.wrapping_sub(greatest.leading_zeros());
    sum.map(|coordinate| {
        let short = match bits.checked_sub(SHORT_BITS) {
            None | Some(0) => coordinate,
            Some(excess) => {
                coordinate
                    .wrapping_shr(excess.wrapping_sub(1))
                    .wrapping_add(1)
                    >> 1
            }
        };
        // Never fails: at most 2^30.
        i64::try_from(short).unwrap_or_default()
    })
}

/// The cross product of two shortened tangents.
fn cross(one: &[i128; 3], other: &[i128; 3]) -> [i64; 3] {
    let ([ax, ay, az], [bx, by, bz]) = (shortened(one), shortened(other));
    let minor = |a: i64, d: i64, b: i64, c: i64| a.wrapping_mul(d).wrapping_sub(b.wrapping_mul(c));
    [
        minor(ay, bz, az, by),
        minor(az, bx, ax, bz),
        minor(ax, by, ay, bx),
    ]
}
