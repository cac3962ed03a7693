//! The kernels: differences, the volume's sum, the gradient's sums, and the last rounding of each.
//!
//! Every index was proved to exist when the form was made; the arithmetic wraps in the sense of the
//! language only.

use super::form::{Enclosed, GRADIENT_LIMIT, VolumeFormParts};
use crate::coord::{Coordinate, round_shift};

/// Bits by which cross products of differences are rounded: from at most `2^61` to `2^30`.
const AREA_SHIFT: u32 = 31;

/// Writes the rounded differences to the base, doubled as often as all stay within `2^30`, and
/// returns how often.
pub(super) fn differences<C: Coordinate>(
    parts: &VolumeFormParts<'_>,
    pose: &[[C; 3]],
    out: &mut [[i32; 3]],
) -> u32 {
    let position = |point: &u16| match pose.get(usize::from(*point)) {
        Some(position) => position.map(Coordinate::to_bits),
        None => [0; 3],
    };
    let Some((base, others)) = parts.points.split_first() else {
        return 0;
    };
    let [base_x, base_y, base_z] = position(base);
    let mut occupied = 0_u32;
    let mut rounded = |coordinate: i32, base: i32| {
        let difference = i64::from(coordinate).wrapping_sub(i64::from(base));
        // At most 2^32 - 1, so at most 2^30 after a shift of 2 or more.
        let difference = round_shift(difference, parts.difference_shift);
        let difference = i32::try_from(difference).unwrap_or_default();
        occupied |= difference.unsigned_abs();
        difference
    };
    for (point, difference) in others.iter().zip(out.iter_mut()) {
        let [x, y, z] = position(point);
        *difference = [rounded(x, base_x), rounded(y, base_y), rounded(z, base_z)];
    }
    // The highest bit goes to place 29 at most; 2^30 itself stays.
    let doublings = match occupied {
        0 => 0,
        _ => occupied.leading_zeros().saturating_sub(2),
    };
    for difference in out.iter_mut() {
        *difference = difference.map(|coordinate| coordinate.wrapping_shl(doublings));
    }
    doublings
}

/// The exact sum of all `weight * det(d_i, d_j, d_k)`.
pub(super) fn volume(parts: &VolumeFormParts<'_>, differences: &[[i32; 3]]) -> i128 {
    let mut total = 0_i128;
    for_each_pair(parts, differences, |pair| {
        let sum = weighted_sum(pair.weights, pair.thirds, differences);
        total = total.wrapping_add(dot(cross(pair.first, pair.second), sum));
    });
    total
}

/// The exact sum, and the gradients of all points but the base in units of `2^31` of their exact
/// value.
pub(super) fn volume_and_gradient(
    parts: &VolumeFormParts<'_>,
    differences: &[[i32; 3]],
    gradient: &mut [[i64; 3]],
) -> i128 {
    gradient.fill([0; 3]);
    let pair_bits = parts.pair_bits;
    let mut total = 0_i128;
    for_each_pair(parts, differences, |pair| {
        let area = cross(pair.first, pair.second);
        let narrow = |wide: i64, shift| {
            // At most 2^30 either way: see VolumeForm::volume_and_gradient.
            i32::try_from(round_bits(wide, shift)).unwrap_or_default()
        };
        let narrow_area = area.map(|axis| narrow(axis, AREA_SHIFT));
        let sum = spread(
            pair.weights,
            pair.thirds,
            differences,
            narrow_area,
            gradient,
        );
        total = total.wrapping_add(dot(area, sum));
        let narrow_sum = sum.map(|axis| narrow(axis, pair_bits));
        let rest = AREA_SHIFT.wrapping_sub(pair_bits);
        let by_first = cross(pair.second, narrow_sum).map(|axis| round_bits(axis, rest));
        let by_second = cross(narrow_sum, pair.first).map(|axis| round_bits(axis, rest));
        add(gradient, pair.first_index, by_first);
        add(gradient, pair.second_index, by_second);
    });
    total
}

/// One pair of points with its taps.
struct Pair<'a> {
    first_index: usize,
    second_index: usize,
    first: [i32; 3],
    second: [i32; 3],
    thirds: &'a [u16],
    weights: &'a [i32],
}

#[inline(always)]
fn for_each_pair<'a>(
    parts: &VolumeFormParts<'a>,
    differences: &[[i32; 3]],
    mut work: impl FnMut(Pair<'a>),
) {
    let (mut weights, mut thirds) = (parts.weights, parts.thirds);
    for (&[i, j], range) in parts.pairs.iter().zip(parts.pair_starts.windows(2)) {
        let &[start, end] = range else { break };
        let taps = usize::try_from(end.wrapping_sub(start)).unwrap_or_default();
        let (Some((pair_weights, more_weights)), Some((pair_thirds, more_thirds))) = (
            weights.split_at_checked(taps),
            thirds.split_at_checked(taps),
        ) else {
            break;
        };
        (weights, thirds) = (more_weights, more_thirds);
        let (first_index, second_index) = (usize::from(i), usize::from(j));
        let (Some(&first), Some(&second)) =
            (differences.get(first_index), differences.get(second_index))
        else {
            break;
        };
        work(Pair {
            first_index,
            second_index,
            first,
            second,
            thirds: pair_thirds,
            weights: pair_weights,
        });
    }
}

/// The sum of `weight * d_k`: three multiplications with 64-bit accumulation a tap.
#[inline(never)]
fn weighted_sum(weights: &[i32], thirds: &[u16], differences: &[[i32; 3]]) -> [i64; 3] {
    let (mut x, mut y, mut z) = (0_i64, 0_i64, 0_i64);
    for (&weight, &third) in weights.iter().zip(thirds) {
        let Some(&[dx, dy, dz]) = differences.get(usize::from(third)) else {
            break;
        };
        let weight = i64::from(weight);
        x = x.wrapping_add(weight.wrapping_mul(i64::from(dx)));
        y = y.wrapping_add(weight.wrapping_mul(i64::from(dy)));
        z = z.wrapping_add(weight.wrapping_mul(i64::from(dz)));
    }
    [x, y, z]
}

/// The sum of `weight * d_k`, while `weight * area` goes to each third point's gradient.
#[inline(never)]
fn spread(
    weights: &[i32],
    thirds: &[u16],
    differences: &[[i32; 3]],
    [area_x, area_y, area_z]: [i32; 3],
    gradient: &mut [[i64; 3]],
) -> [i64; 3] {
    let (mut x, mut y, mut z) = (0_i64, 0_i64, 0_i64);
    for (&weight, &third) in weights.iter().zip(thirds) {
        let third = usize::from(third);
        let (Some(&[dx, dy, dz]), Some([gx, gy, gz])) =
            (differences.get(third), gradient.get_mut(third))
        else {
            break;
        };
        let weight = i64::from(weight);
        x = x.wrapping_add(weight.wrapping_mul(i64::from(dx)));
        y = y.wrapping_add(weight.wrapping_mul(i64::from(dy)));
        z = z.wrapping_add(weight.wrapping_mul(i64::from(dz)));
        *gx = gx.wrapping_add(weight.wrapping_mul(i64::from(area_x)));
        *gy = gy.wrapping_add(weight.wrapping_mul(i64::from(area_y)));
        *gz = gz.wrapping_add(weight.wrapping_mul(i64::from(area_z)));
    }
    [x, y, z]
}

/// The cross product, exact: at most `2^61` in each component.
#[inline(always)]
fn cross([ax, ay, az]: [i32; 3], [bx, by, bz]: [i32; 3]) -> [i64; 3] {
    let minor = |a: i32, b: i32, c: i32, d: i32| {
        let left = i64::from(a).wrapping_mul(i64::from(d));
        left.wrapping_sub(i64::from(b).wrapping_mul(i64::from(c)))
    };
    [
        minor(ay, az, by, bz),
        minor(az, ax, bz, bx),
        minor(ax, ay, bx, by),
    ]
}

/// The scalar product, exact.
#[inline(always)]
fn dot([ax, ay, az]: [i64; 3], [bx, by, bz]: [i64; 3]) -> i128 {
    let product = |a: i64, b: i64| i128::from(a).wrapping_mul(i128::from(b));
    let sum = product(ax, bx).wrapping_add(product(ay, by));
    sum.wrapping_add(product(az, bz))
}

fn add(gradient: &mut [[i64; 3]], index: usize, [x, y, z]: [i64; 3]) {
    if let Some([gx, gy, gz]) = gradient.get_mut(index) {
        *gx = gx.wrapping_add(x);
        *gy = gy.wrapping_add(y);
        *gz = gz.wrapping_add(z);
    }
}

/// [`round_shift`], which a shift of 0 leaves alone.
fn round_bits(value: i64, shift: u32) -> i64 {
    if shift == 0 {
        value
    } else {
        round_shift(value, shift)
    }
}

/// Takes the doublings out, which is exact, and rounds by the form's shift.
pub(super) fn finish_volume(parts: &VolumeFormParts<'_>, sum: i128, doublings: u32) -> Enclosed {
    let undoubled = sum.wrapping_shr(doublings.wrapping_mul(3));
    let half = 1_i128.wrapping_shl(parts.volume_shift.wrapping_sub(1));
    let rounded = undoubled
        .wrapping_add(half)
        .wrapping_shr(parts.volume_shift);
    match i64::try_from(rounded) {
        Ok(volume) => Enclosed {
            volume,
            saturated: 0,
        },
        Err(_) => Enclosed {
            volume: if rounded < 0 { i64::MIN } else { i64::MAX },
            saturated: 1,
        },
    }
}

/// Brings the gradients to their unit, rounded and clamped, and the base's to minus their sum.
pub(super) fn finish_gradient(
    gradient_bits: u32,
    doublings: u32,
    base: &mut [i64; 3],
    others: &mut [[i64; 3]],
    saturated: &mut u32,
) {
    let down = doublings.wrapping_mul(2);
    let mut finish = |sum: i64| {
        let value = match down.checked_sub(gradient_bits) {
            Some(shift) => round_bits(sum, shift),
            None => enlarge(sum, gradient_bits.wrapping_sub(down)),
        };
        let clamped = value.clamp(GRADIENT_LIMIT.wrapping_neg(), GRADIENT_LIMIT);
        if clamped != value {
            *saturated = saturated.saturating_add(1);
        }
        clamped
    };
    let (mut x, mut y, mut z) = (0_i64, 0_i64, 0_i64);
    for gradient in others {
        *gradient = gradient.map(&mut finish);
        let [gx, gy, gz] = *gradient;
        x = x.wrapping_sub(gx);
        y = y.wrapping_sub(gy);
        z = z.wrapping_sub(gz);
    }
    *base = [x, y, z];
}

/// `value * 2^shift`, or the end of the range that it lies beyond.
fn enlarge(value: i64, shift: u32) -> i64 {
    let enlarged = value.wrapping_shl(shift);
    if enlarged.wrapping_shr(shift) == value {
        enlarged
    } else if value < 0 {
        i64::MIN
    } else {
        i64::MAX
    }
}
