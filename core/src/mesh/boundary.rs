//! The boundary of a solid: the triangles that belong to exactly one cell.

use super::error::{Arena, MeshError};
use super::view::Solid;
use super::{OCTAHEDRON_FACES, TETRAHEDRON_FACES, corners_of};

/// How many faces the scratch of [`boundary_triangles`] must hold: four for each tetrahedron and
/// eight for each octahedron. `None` if that does not fit.
#[must_use]
pub fn face_capacity(solid: &Solid<'_>) -> Option<usize> {
    let tetrahedra = solid.tetrahedra.len().checked_mul(4)?;
    solid
        .octahedra
        .len()
        .checked_mul(8)?
        .checked_add(tetrahedra)
}

/// Finds the boundary of a solid and returns its triangles.
///
/// The triangles come in ascending order of their sorted corners, each rotated so that its least
/// corner is first, and counter-clockwise from outside where the cell is positive. The result is
/// the front of `scratch`, which must hold [`face_capacity`] triangles. A face that more than two
/// cells share is no boundary.
///
/// # Errors
///
/// Any error of [`Solid::check`]; [`MeshError::UnsupportedPart`] if the solid has other cells than
/// tetrahedra and octahedra; [`MeshError::ArenaTooSmall`], which leaves `scratch` untouched.
pub fn boundary_triangles<'a>(
    solid: &Solid<'_>,
    scratch: &'a mut [[u32; 3]],
) -> Result<&'a [[u32; 3]], MeshError> {
    solid.check()?;
    solid.require_tetrahedral()?;
    let needed = face_capacity(solid).ok_or(MeshError::TooLarge)?;
    let given = scratch.len();
    let faces = scratch.get_mut(..needed).ok_or(MeshError::ArenaTooSmall {
        arena: Arena::Faces,
        needed,
        given,
    })?;

    let of_tetrahedra = solid
        .tetrahedra
        .iter()
        .flat_map(|cell| corners_of(cell, &TETRAHEDRON_FACES));
    let of_octahedra = solid
        .octahedra
        .iter()
        .flat_map(|cell| corners_of(cell, &OCTAHEDRON_FACES));
    for (slot, face) in faces.iter_mut().zip(of_tetrahedra.chain(of_octahedra)) {
        *slot = least_first(face);
    }
    // Ties are the same face seen from two cells; their order does not matter, since neither
    // stays.
    faces.sort_unstable_by_key(|&face| sorted(face));
    let kept = keep_single(faces);
    Ok(scratch.get(..kept).unwrap_or_default())
}

/// The same triangle, with its least corner first.
pub(super) fn least_first([a, b, c]: [u32; 3]) -> [u32; 3] {
    if b < a && b < c {
        [b, c, a]
    } else if c < a && c < b {
        [c, a, b]
    } else {
        [a, b, c]
    }
}

/// The corners in ascending order, for a triangle whose least corner is first.
pub(super) fn sorted([a, b, c]: [u32; 3]) -> [u32; 3] {
    [a, b.min(c), b.max(c)]
}

/// Moves the faces that occur once in the sorted list to its front and returns their number.
#[expect(
    clippy::indexing_slicing,
    clippy::arithmetic_side_effects,
    reason = "`next` and `start` are at most the length, and `kept` at most `start`"
)]
pub(super) fn keep_single(faces: &mut [[u32; 3]]) -> usize {
    let mut kept = 0;
    let mut start = 0;
    while start < faces.len() {
        let key = sorted(faces[start]);
        let mut next = start + 1;
        while next < faces.len() && sorted(faces[next]) == key {
            next += 1;
        }
        if next == start + 1 {
            faces[kept] = faces[start];
            kept += 1;
        }
        start = next;
    }
    kept
}
