//! The faces where two major diagonals clash.

use super::diagonals::Diagonals;
use super::faces::{Cell, Face, sorted_faces};
use crate::mesh::{MeshError, Solid};

/// Finds the faces whose cells' major diagonals clash, in ascending order of their corners.
///
/// Two tetrahedra clash at the triangle that they share if both use the same edge of it: what the
/// paper's Algorithm 2 tries to avoid and, for most meshes, cannot avoid everywhere. Two octahedra
/// clash if their diagonals single out the same corner, a tetrahedron and an octahedron if their
/// diagonals are not parallel. A face that more than two cells share clashes if any two of them
/// do. Each face is listed once, with the lowest of its cells.
///
/// The result is the front of `faces`, which must hold
/// [`face_capacity`](crate::mesh::face_capacity) faces.
///
/// # Errors
///
/// Any error of [`Solid::check`] and [`Diagonals::check`]; [`MeshError::ArenaTooSmall`] and
/// [`MeshError::TooLarge`].
pub fn improper_faces<'a>(
    solid: &Solid<'_>,
    diagonals: &Diagonals<'_>,
    faces: &'a mut [Face],
) -> Result<&'a [Face], MeshError> {
    solid.check()?;
    solid.require_tetrahedral()?;
    diagonals.check(solid)?;
    let faces = sorted_faces(solid, faces)?;
    let kept = keep_improper(solid, diagonals, faces);
    Ok(faces.get(..kept).unwrap_or_default())
}

/// Moves one face of each clash to the front and returns their number.
fn keep_improper(solid: &Solid<'_>, diagonals: &Diagonals<'_>, faces: &mut [Face]) -> usize {
    let mut kept = 0_usize;
    let mut start = 0_usize;
    while let Some(&first) = faces.get(start) {
        let rest = faces.get(start..).unwrap_or_default();
        let length = rest.partition_point(|face| face.corners() == first.corners());
        let sharing = rest.get(..length).unwrap_or_default();
        let clash = sharing.iter().enumerate().any(|(place, one)| {
            sharing
                .iter()
                .skip(place)
                .any(|two| clashes(solid, diagonals, *one, *two).unwrap_or(false))
        });
        if clash && let Some(slot) = faces.get_mut(kept) {
            *slot = first;
            kept = kept.saturating_add(1);
        }
        start = start.saturating_add(length.max(1));
    }
    kept
}

/// Whether two cells clash at a face that they share; a cell does not clash with itself.
fn clashes(solid: &Solid<'_>, diagonals: &Diagonals<'_>, one: Face, two: Face) -> Option<bool> {
    if one.cell() == two.cell() {
        return Some(false);
    }
    let single = |face: Face| {
        let place = usize::try_from(face.cell()).ok()?;
        let diagonal = match place.checked_sub(solid.tetrahedra.len()) {
            None => diagonals.tetrahedra.get(place),
            Some(place) => diagonals.octahedra.get(place),
        };
        let cell = Cell::of(solid, face.cell())?;
        let is_octahedron = matches!(cell, Cell::Octahedron(_));
        Some((is_octahedron, cell.singled_out(*diagonal?, face.corners())?))
    };
    let ((shape, corner), (other_shape, other_corner)) = (single(one)?, single(two)?);
    Some((shape == other_shape) == (corner == other_corner))
}
