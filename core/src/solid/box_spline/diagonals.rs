//! Major diagonals: a number for each cell, and how children inherit it.

use super::choice::DiagonalBuffers;
use crate::mesh::{Arena, MeshError, Part, Solid, require};

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

/// The major diagonals of the cells that [`split`](super::split) makes: each child's is its
/// parent's.
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
    for (children, first, from_tetrahedra, from_octahedra) in [
        (&mut *tetrahedra, tetrahedra_first, 4, 8),
        (&mut *octahedra, octahedra_first, 1, 6),
    ] {
        let (of_tetrahedra, of_octahedra) = children
            .split_at_mut_checked(first)
            .ok_or(MeshError::TooLarge)?;
        hand_on(diagonals.tetrahedra, of_tetrahedra, from_tetrahedra);
        hand_on(diagonals.octahedra, of_octahedra, from_octahedra);
    }
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

fn hand_on(parents: &[u8], children: &mut [u8], each: usize) {
    for (&diagonal, children) in parents.iter().zip(children.chunks_mut(each)) {
        children.fill(diagonal);
    }
}
