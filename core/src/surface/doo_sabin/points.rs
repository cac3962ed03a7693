//! Values of the refined vertices, and where faces go in the limit.

use crate::blend::{Blend, IrrationalWeight, WEIGHT_BITS};
use crate::mesh::{Arena, ControlMesh, MeshError, index, require};
use crate::surface::irrational::{cosine, irrational};

/// Computes the values of the refined vertices, in the order of the mesh's `indices`.
///
/// `mesh` passed [`ControlMesh::check`]; `points` holds one value for each old vertex; `out` and the
/// scratch `sums` need one element for each of the mesh's `indices`. Returns the filled part of
/// `out`.
///
/// # Scaling and overflow
///
/// All weights are positive and add up to the denominator (6, 16, 24 or 2^30): sums of 32-bit
/// coordinates stay below 2^62.
///
/// # Errors
///
/// [`MeshError::ArenaTooSmall`] before anything is written; [`MeshError::OtherNumbering`] for a mesh
/// that does not pass its check.
pub fn refine_points<'a, B: Blend>(
    blend: &mut B,
    mesh: &ControlMesh<'_>,
    points: &[B::Point],
    out: &'a mut [B::Point],
    sums: &mut [B::Sum],
) -> Result<&'a mut [B::Point], MeshError> {
    let count = mesh.indices.len();
    require(Arena::InputPoints, index(mesh.vertex_count), points.len())?;
    require(Arena::OutputPoints, count, out.len())?;
    require(Arena::Sums, count, sums.len())?;
    let out = out.get_mut(..count).unwrap_or_default();
    let sums = sums.get_mut(..count).unwrap_or_default();
    sums.fill(blend.zero());
    let (mut sums_left, mut out_left) = (sums, &mut *out);
    for face in mesh.faces() {
        let (sums, sums_rest) = core::mem::take(&mut sums_left)
            .split_at_mut_checked(face.len())
            .ok_or(MeshError::OtherNumbering)?;
        let (slots, out_rest) = core::mem::take(&mut out_left)
            .split_at_mut_checked(face.len())
            .ok_or(MeshError::OtherNumbering)?;
        let denominator = gather(blend, face, points, sums).ok_or(MeshError::OtherNumbering)?;
        for (slot, sum) in slots.iter_mut().zip(sums) {
            *slot = blend.divide(sum, denominator);
        }
        (sums_left, out_left) = (sums_rest, out_rest);
    }
    Ok(out)
}

/// The weights of a corner and of those 1, 2 and 3 places away, and their denominator, where the
/// cosines are rational.
const fn exact(corners: usize) -> Option<([i64; 4], i64)> {
    match corners {
        3 => Some(([4, 1, 0, 0], 6)),
        4 => Some(([9, 3, 1, 0], 16)),
        6 => Some(([11, 4, 2, 1], 24)),
        _ => None,
    }
}

/// Fills the sums of one face and returns their denominator.
fn gather<B: Blend>(
    blend: &B,
    face: &[u32],
    points: &[B::Point],
    sums: &mut [B::Sum],
) -> Option<i64> {
    let count = face.len();
    let exact = exact(count);
    let mut own = IrrationalWeight {
        bits: 1 << WEIGHT_BITS,
        real: 1.0,
    };
    for distance in 1..count {
        let mirrored = distance.min(count.checked_sub(distance)?);
        let weight = irrational_weight(mirrored, count)?;
        own = less(own, weight);
        let shifted = face.iter().cycle().skip(distance);
        for (sum, &corner) in sums.iter_mut().zip(shifted) {
            let point = points.get(index(corner))?;
            match exact {
                Some((weights, _)) => blend.add(sum, *weights.get(mirrored)?, point),
                None => blend.add_irrational(sum, weight, point),
            }
        }
    }
    for (sum, &corner) in sums.iter_mut().zip(face) {
        let point = points.get(index(corner))?;
        match exact {
            Some(([weight, ..], _)) => blend.add(sum, weight, point),
            None => blend.add_irrational(sum, own, point),
        }
    }
    Some(exact.map_or(1 << WEIGHT_BITS, |(_, denominator)| denominator))
}

/// `w_j = (3 + 2 cos(2 pi j / n)) / (4n)`.
#[expect(
    clippy::float_arithmetic,
    reason = "an irrational weight is made in double precision, once for its place in a face"
)]
fn irrational_weight(distance: usize, corners: usize) -> Option<IrrationalWeight> {
    let (distance, corners) = (u32::try_from(distance).ok()?, u32::try_from(corners).ok()?);
    let real = (3.0 + 2.0 * cosine(distance, corners)) / (4.0 * f64::from(corners));
    let (bits, real) = irrational(real);
    Some(IrrationalWeight { bits, real })
}

#[expect(
    clippy::float_arithmetic,
    reason = "a weight in double precision, for value types of real numbers"
)]
fn less(one: IrrationalWeight, other: IrrationalWeight) -> IrrationalWeight {
    IrrationalWeight {
        bits: one.bits.wrapping_sub(other.bits),
        real: one.real - other.real,
    }
}

/// Where each face's centre is in the limit: the mean of its corners, which every level keeps. One
/// value for each face; returns the filled part of `out`.
///
/// # Errors
///
/// [`MeshError::ArenaTooSmall`] before anything is written; [`MeshError::OtherNumbering`] for a mesh
/// that does not pass its check.
pub fn limit_points<'a, B: Blend>(
    blend: &mut B,
    mesh: &ControlMesh<'_>,
    points: &[B::Point],
    out: &'a mut [B::Point],
) -> Result<&'a mut [B::Point], MeshError> {
    let count = mesh.face_count();
    require(Arena::InputPoints, index(mesh.vertex_count), points.len())?;
    require(Arena::OutputPoints, count, out.len())?;
    let out = out.get_mut(..count).unwrap_or_default();
    for (slot, face) in out.iter_mut().zip(mesh.faces()) {
        let mut sum = blend.zero();
        for &corner in face {
            let point = points.get(index(corner)).ok_or(MeshError::OtherNumbering)?;
            blend.add(&mut sum, 1, point);
        }
        let corners = i64::try_from(face.len()).map_err(|_| MeshError::TooLarge)?;
        *slot = blend.divide(&sum, corners);
    }
    Ok(out)
}
