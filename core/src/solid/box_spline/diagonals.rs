//! Major diagonals: a number for each cell, and how children inherit it.

use super::choice::DiagonalBuffers;
use crate::mesh::{Arena, MeshError, OCTAHEDRON_FACES, Part, Solid, require};

/// The major diagonal of every cell: 0, 1 or 2 (see the [module documentation](super)).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Diagonals<'a> {
    /// One number for each tetrahedron.
    pub tetrahedra: &'a [u8],
    /// One number for each octahedron.
    pub octahedra: &'a [u8],
}

impl Diagonals<'_> {
    /// Checks that there is a number from 0 to 2 for every cell.
    ///
    /// # Errors
    ///
    /// [`MeshError::DiagonalCount`] or [`MeshError::DiagonalOutOfRange`].
    pub fn check(&self, solid: &Solid<'_>) -> Result<(), MeshError> {
        check_part(Part::Tetrahedron, self.tetrahedra, solid.tetrahedra.len())?;
        check_part(Part::Octahedron, self.octahedra, solid.octahedra.len())
    }
}

fn check_part(part: Part, diagonals: &[u8], cells: usize) -> Result<(), MeshError> {
    if diagonals.len() != cells {
        return Err(MeshError::DiagonalCount {
            part,
            needed: cells,
            given: diagonals.len(),
        });
    }
    match diagonals.iter().enumerate().find(|&(_, &value)| value > 2) {
        Some((index, &value)) => Err(MeshError::DiagonalOutOfRange { part, index, value }),
        None => Ok(()),
    }
}

/// The major diagonals of the cells that [`split`](super::split) makes: each child keeps the
/// direction of its parent's.
///
/// In this library's order of corners that is the parent's number, except in the tetrahedron on a
/// face of an octahedron: `(centroid, m_bc, m_ca, m_ab)` pairs its corners with `a`, `b`, `c`, so
/// its number is the place in the face of the corner on the parent's diagonal. In the faces whose
/// corners come from the pairs 0, 2, 1 the numbers 1 and 2 change places.
///
/// Writes one number for each refined cell and returns the filled part.
///
/// # Errors
///
/// [`MeshError::ArenaTooSmall`] before anything is written, and [`MeshError::TooLarge`].
pub fn split_diagonals<'a>(
    diagonals: &Diagonals<'_>,
    buffers: DiagonalBuffers<'a>,
) -> Result<Diagonals<'a>, MeshError> {
    let counts = child_counts(diagonals).ok_or(MeshError::TooLarge)?;
    let [tetrahedra_first, tetrahedra, octahedra_first, octahedra] = counts;
    require(Arena::Diagonals, tetrahedra, buffers.tetrahedra.len())?;
    require(Arena::Diagonals, octahedra, buffers.octahedra.len())?;
    let tetrahedra = buffers.tetrahedra.get_mut(..tetrahedra).unwrap_or_default();
    let octahedra = buffers.octahedra.get_mut(..octahedra).unwrap_or_default();
    let (of_tetrahedra, of_octahedra) = tetrahedra
        .split_at_mut_checked(tetrahedra_first)
        .ok_or(MeshError::TooLarge)?;
    hand_on(diagonals.tetrahedra, of_tetrahedra, |_| [0, 1, 2], 4);
    hand_on(diagonals.octahedra, of_octahedra, on_face, 8);
    let (of_tetrahedra, of_octahedra) = octahedra
        .split_at_mut_checked(octahedra_first)
        .ok_or(MeshError::TooLarge)?;
    hand_on(diagonals.tetrahedra, of_tetrahedra, |_| [0, 1, 2], 1);
    hand_on(diagonals.octahedra, of_octahedra, |_| [0, 1, 2], 6);
    Ok(Diagonals {
        tetrahedra,
        octahedra,
    })
}

/// Numbers of tetrahedra of tetrahedra, of all tetrahedra, of octahedra of tetrahedra, and of all
/// octahedra.
pub(super) fn child_counts(diagonals: &Diagonals<'_>) -> Option<[usize; 4]> {
    let (tetrahedra, octahedra) = (diagonals.tetrahedra.len(), diagonals.octahedra.len());
    let first = tetrahedra.checked_mul(4)?;
    Some([
        first,
        octahedra.checked_mul(8)?.checked_add(first)?,
        tetrahedra,
        octahedra.checked_mul(6)?.checked_add(tetrahedra)?,
    ])
}

/// Writes the diagonals of `each` children of every parent; `numbers` says what becomes of 0, 1
/// and 2 in a child.
fn hand_on(parents: &[u8], children: &mut [u8], numbers: impl Fn(usize) -> [u8; 3], each: usize) {
    for (&diagonal, children) in parents.iter().zip(children.chunks_mut(each)) {
        for (child, slot) in children.iter_mut().enumerate() {
            let place = usize::from(diagonal);
            *slot = numbers(child).get(place).copied().unwrap_or(diagonal);
        }
    }
}

/// What becomes of the diagonals of an octahedron in the tetrahedron on one of its faces.
fn on_face(face: usize) -> [u8; 3] {
    let mut numbers = [0, 1, 2];
    let face = OCTAHEDRON_FACES.get(face).copied().unwrap_or_default();
    for (corner, number) in face.into_iter().zip(0_u8..) {
        // Opposite corners, of the same pair, are three apart.
        let pair = corner.checked_rem(3).and_then(|pair| numbers.get_mut(pair));
        if let Some(slot) = pair {
            *slot = number;
        }
    }
    numbers
}
