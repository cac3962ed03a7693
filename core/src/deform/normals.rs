//! Normals of a model's deformed points, from its faces: see [`Normals`].

use core::ops::Range;

use super::table::ApplyError;
use crate::coord::Coordinate;

/// The most corners of faces at a point.
pub const MOST_CORNERS: usize = 512;

/// The greatest shift of edges.
pub const MOST_EDGE_SHIFT: u32 = 5;

/// A number that starts a fan: this bit says that another fan of the same point follows, the others how many
/// neighbours this one has.
const MORE: u16 = 1 << 15;

/// Fraction bits of a normal: one is `2^14`.
pub const NORMAL_BITS: u32 = 14;

/// The faces round every point of a model, for the normals of its deformed points.
///
/// It comes out of a [`Bundle`](crate::bundle::Bundle), which has proved that every neighbour exists. Its time is
/// bounded; but for some ten instructions a point it depends on no value.
///
/// # Definition
///
/// For a corner of a face at the point `v`, between the corner before it, `u`, and the one behind it, `w`:
///
/// ```text
/// edge(p)  = clamp(floor((p - v) / 2^shift + 1/2), -2^26, 2^26 - 1)     for each coordinate
/// corner   = edge(w) x edge(u)
/// sum      = all corners at v, exact
/// ```
///
/// For triangles that is the sum of the faces' normals, each as long as twice its area; for other faces each
/// corner counts with its own parallelogram. The sum is brought to unit length in 14 fraction bits: let `m` be
/// the magnitude of its greatest coordinate, `e` the number of bits of `m` less 16, and
///
/// ```text
/// short    = floor(sum / 2^e + 1/2)                                     (exact where e is not positive)
/// length   = floor(sqrt(short . short) + 1/2)
/// normal   = floor(short * 2^14 / length + 1/2)
/// ```
///
/// A sum of zero gives the normal zero, and is counted. `short` is off by at most `2^-17` of its length,
/// `length` by `2^-17` of itself, so that each coordinate of a normal is within one unit (`2^-14`) of that
/// of the real unit vector along the sum.
///
/// # Scaling and overflow
///
/// The shift is at most 5. Edges are of at most `2^26`, corners of at most `2^53`, and a point has at most
/// [`MOST_CORNERS`] of them: sums stay below `2^62`. `short` is at most `2^16`, its square at most
/// `3 * 2^32`, `short * 2^14` at most `2^30`.
#[derive(Clone, Copy, Debug)]
pub struct Normals<'a> {
    rows: usize,
    shift: u32,
    fans: &'a [u16],
}

impl<'a> Normals<'a> {
    /// The fans of `rows` points; the number of the first point that is not sound otherwise, or the number
    /// of points if something lies behind the last.
    pub(crate) fn new(rows: usize, shift: u32, fans: &'a [u16]) -> Result<Self, usize> {
        let normals = Self { rows, shift, fans };
        let mut words = fans;
        for row in 0..rows {
            let mut corners = 0_usize;
            loop {
                let Some((neighbours, more, rest)) = next_fan(words) else {
                    return Err(row);
                };
                corners = corners.wrapping_add(neighbours.len().saturating_sub(1));
                let exist = neighbours.iter().all(|&point| usize::from(point) < rows);
                if !exist || corners > MOST_CORNERS {
                    return Err(row);
                }
                words = rest;
                if !more {
                    break;
                }
            }
        }
        if shift <= MOST_EDGE_SHIFT && words.is_empty() {
            Ok(normals)
        } else {
            Err(rows)
        }
    }

    /// Number of points: rows of the table.
    #[must_use]
    pub const fn rows(&self) -> usize {
        self.rows
    }

    /// Edges are in units of `2^shift` units in the last place of a coordinate.
    #[must_use]
    pub const fn shift(&self) -> u32 {
        self.shift
    }

    /// Computes the normals of a range of points, and returns how many of them are zero because their faces
    /// have no area or there are none.
    ///
    /// `points` holds all points of the model as the table's apply gives them, in the order of its rows;
    /// `out` gets a unit vector of 14 fraction bits for each point of the range. Faces that are listed
    /// counter-clockwise, seen from outside, have normals that point outward. Finding the first point takes
    /// a few instructions for each point before it. The definition and what rounds stand in
    /// `docs/numerics.md`.
    ///
    /// # Errors
    ///
    /// An [`ApplyError`] if a length does not fit; nothing is then written.
    pub fn apply<C: Coordinate>(
        &self,
        rows: Range<usize>,
        points: &[[C; 3]],
        out: &mut [[i16; 3]],
    ) -> Result<u32, ApplyError> {
        let (needed, given) = (self.rows, points.len());
        if needed != given {
            return Err(ApplyError::PointsLength { needed, given });
        }
        let asked = rows.end.checked_sub(rows.start);
        let asked = asked.filter(|_| rows.end <= self.rows);
        let needed = asked.ok_or(ApplyError::row_range(&rows, self.rows))?;
        let given = out.len();
        if needed != given {
            return Err(ApplyError::OutputLength { needed, given });
        }
        let points = C::bits_of(points);
        Ok(match self.shift {
            0 => self.run(rows.start, points, out, |difference| difference),
            shift => {
                let shift = shift.wrapping_sub(1);
                self.run(rows.start, points, out, |difference| {
                    difference.wrapping_shr(shift).wrapping_add(1) >> 1
                })
            }
        })
    }

    #[inline(always)]
    fn run(
        &self,
        first: usize,
        points: &[[i32; 3]],
        out: &mut [[i16; 3]],
        scale: impl Fn(i32) -> i32 + Copy,
    ) -> u32 {
        let mut words = self.fans;
        for _ in 0..first {
            while let Some((_, more, rest)) = next_fan(words) {
                words = rest;
                if !more {
                    break;
                }
            }
        }
        let mut zeros = 0_u32;
        let places = points.get(first..).unwrap_or_default();
        for (slot, &at) in out.iter_mut().zip(places) {
            let mut sum = [0_i64; 3];
            while let Some((neighbours, more, rest)) = next_fan(words) {
                words = rest;
                sum = add_fan(sum, neighbours, at, points, scale);
                if !more {
                    break;
                }
            }
            *slot = unit(sum);
            zeros = zeros.wrapping_add(u32::from(*slot == [0; 3]));
        }
        zeros
    }
}

/// The neighbours of the first fan, whether another of the same point follows, and the words behind it.
#[inline(always)]
fn next_fan(words: &[u16]) -> Option<(&[u16], bool, &[u16])> {
    let (&head, rest) = words.split_first()?;
    let (neighbours, rest) = rest.split_at_checked(usize::from(head & !MORE))?;
    Some((neighbours, head & MORE != 0, rest))
}

/// Adds the corners between neighbours that follow one another.
#[inline(always)]
fn add_fan(
    [mut x, mut y, mut z]: [i64; 3],
    neighbours: &[u16],
    [ax, ay, az]: [i32; 3],
    points: &[[i32; 3]],
    scale: impl Fn(i32) -> i32 + Copy,
) -> [i64; 3] {
    let edge = |point: &u16| {
        // Never another length: the neighbours and the number of points were checked.
        let &[px, py, pz] = points.get(usize::from(*point))?;
        // A difference that does not fit 32 bits is clamped in the end either way: 2^31 / 2^5 is 2^26.
        let one = |p: i32, a: i32| scale(p.saturating_sub(a)).clamp(-(1 << 26), (1 << 26) - 1);
        Some([one(px, ax), one(py, ay), one(pz, az)])
    };
    let Some((first, rest)) = neighbours.split_first() else {
        return [x, y, z];
    };
    let Some([mut bx, mut by, mut bz]) = edge(first) else {
        return [x, y, z];
    };
    for point in rest {
        let Some([cx, cy, cz]) = edge(point) else {
            break;
        };
        let product = |a: i32, b: i32| i64::from(a).wrapping_mul(i64::from(b));
        x = x
            .wrapping_add(product(by, cz))
            .wrapping_add(product(bz.wrapping_neg(), cy));
        y = y
            .wrapping_add(product(bz, cx))
            .wrapping_add(product(bx.wrapping_neg(), cz));
        z = z
            .wrapping_add(product(bx, cy))
            .wrapping_add(product(by.wrapping_neg(), cx));
        (bx, by, bz) = (cx, cy, cz);
    }
    [x, y, z]
}

/// Bits of the greatest coordinate of a shortened sum.
const SHORT_BITS: u32 = 16;

/// The unit vector along a sum of at most 62 bits, zero for zero.
pub(crate) fn unit(sum: [i64; 3]) -> [i16; 3] {
    let mut greatest = 0_u64;
    for coordinate in sum {
        greatest = greatest.max(coordinate.unsigned_abs());
    }
    if greatest == 0 {
        return [0; 3];
    }
    let bits = u64::BITS.wrapping_sub(greatest.leading_zeros());
    let short = |coordinate: i64| match bits.checked_sub(SHORT_BITS) {
        None | Some(0) => coordinate.wrapping_shl(SHORT_BITS.wrapping_sub(bits)),
        Some(excess) => {
            coordinate
                .wrapping_shr(excess.wrapping_sub(1))
                .wrapping_add(1)
                >> 1
        }
    };
    let [x, y, z] = sum.map(|coordinate| low_half(short(coordinate)));
    let square =
        |value: i32| u64::from(value.unsigned_abs()).wrapping_mul(value.unsigned_abs().into());
    let length = root(square(x).wrapping_add(square(y)).wrapping_add(square(z)));
    [x, y, z].map(|value| {
        let scaled = value.wrapping_shl(NORMAL_BITS).wrapping_add(length >> 1);
        // Never another divisor than a positive one: the length is at least 2^15.
        low_quarter(scaled.checked_div_euclid(length).unwrap_or_default())
    })
}

/// `floor(sqrt(square) + 1/2)` for a square below `2^34`.
fn root(square: u64) -> i32 {
    let coarse = low_word(square >> 4).isqrt();
    // At most 3 too small now.
    let mut root = coarse.wrapping_shl(2);
    let mut rest = low_word(square.wrapping_sub(u64::from(root).wrapping_mul(root.into())));
    while rest > root.wrapping_shl(1) {
        rest = rest.wrapping_sub(root.wrapping_shl(1).wrapping_add(1));
        root = root.wrapping_add(1);
    }
    // (root + 1/2)^2 is root^2 + root + 1/4.
    root.wrapping_add(u32::from(rest > root)).cast_signed()
}

/// What fits 32 bits.
#[expect(clippy::as_conversions, reason = "truncation is what is meant")]
const fn low_word(value: u64) -> u32 {
    value as u32
}

/// What fits 32 bits.
#[expect(clippy::as_conversions, reason = "truncation is what is meant")]
const fn low_half(value: i64) -> i32 {
    value as i32
}

/// What fits 16 bits.
#[expect(clippy::as_conversions, reason = "truncation is what is meant")]
const fn low_quarter(value: i32) -> i16 {
    value as i16
}

#[cfg(test)]
mod tests {
    use super::{root, unit};

    /// Roots against their definition: `(2 root - 1)^2 <= 4 square < (2 root + 1)^2`.
    #[test]
    fn roots_are_to_the_nearest() {
        let limit = 3_u64 << 32;
        let near = (0..400_u64).chain((0..2000).map(|k| (1 << 15) * (1 << 15) + k));
        let wide = (0..20_000_u64).map(|k| k.wrapping_mul(0x9e37_79b9_7f4a_7c15) % (limit + 1));
        for square in near.chain(wide).chain([limit]) {
            let twice = 2 * u128::from(root(square).unsigned_abs());
            let four = 4 * u128::from(square);
            assert!(four < (twice + 1).pow(2), "{square}");
            assert!(twice == 0 || (twice - 1).pow(2) <= four, "{square}");
        }
    }

    #[test]
    fn unit_vectors_by_hand() {
        assert_eq!(unit([0; 3]), [0; 3]);
        assert_eq!(unit([0, 0, 1]), [0, 0, 16384]);
        assert_eq!(unit([0, -(1 << 61), 0]), [0, -16384, 0]);
        // 3-4-5: 0.6 * 16384 = 9830.4, 0.8 * 16384 = 13107.2.
        assert_eq!(unit([3 << 40, 0, -4 << 40]), [9830, 0, -13107]);
    }
}
