//! The faces of all cells, sorted, with the cell that each belongs to.
//!
//! Cells are numbered tetrahedra first, then octahedra.

use crate::mesh::{
    Arena, MeshError, OCTAHEDRON_FACES, Solid, TETRAHEDRON_FACES, face_capacity, require,
};

/// A face of a cell. Also the scratch that finding diagonals needs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct Face {
    /// The corners, ascending.
    corners: [u32; 3],
    /// The cell, tetrahedra before octahedra.
    cell: u32,
}

impl Face {
    /// The corners in ascending order.
    #[must_use]
    pub const fn corners(&self) -> [u32; 3] {
        self.corners
    }

    /// The cell that the face belongs to: the place of a tetrahedron in its list, or the number of
    /// tetrahedra plus the place of an octahedron in its list.
    #[must_use]
    pub const fn cell(&self) -> u32 {
        self.cell
    }
}

/// Number of cells, if 32 bits hold it.
pub(super) fn cell_count(solid: &Solid<'_>) -> Option<u32> {
    let cells = solid.tetrahedra.len().checked_add(solid.octahedra.len())?;
    u32::try_from(cells).ok()
}

/// A cell's shape and corners.
#[derive(Clone, Copy)]
pub(super) enum Cell {
    Tetrahedron([u32; 4]),
    Octahedron([u32; 6]),
}

impl Cell {
    pub(super) fn of(solid: &Solid<'_>, cell: u32) -> Option<Self> {
        let place = usize::try_from(cell).ok()?;
        match place.checked_sub(solid.tetrahedra.len()) {
            None => solid.tetrahedra.get(place).copied().map(Self::Tetrahedron),
            Some(place) => solid.octahedra.get(place).copied().map(Self::Octahedron),
        }
    }

    /// The corners of the faces, each in ascending order.
    pub(super) fn faces(&self) -> impl Iterator<Item = [u32; 3]> {
        let (faces, corners): (&[[usize; 3]], &[u32]) = match self {
            Self::Tetrahedron(corners) => (&TETRAHEDRON_FACES, corners),
            Self::Octahedron(corners) => (&OCTAHEDRON_FACES, corners),
        };
        faces.iter().map(move |face| {
            let mut face = face.map(|corner| corners.get(corner).copied().unwrap_or_default());
            face.sort_unstable();
            face
        })
    }

    /// The corner of a face that a major diagonal singles out: in an octahedron the corner that
    /// lies on the diagonal, in a tetrahedron the one opposite the edge that belongs to the pair.
    /// Where the two cells of a face are a tetrahedron and an octahedron, equal corners mean
    /// parallel diagonals.
    pub(super) fn singled_out(&self, diagonal: u8, face: [u32; 3]) -> Option<u32> {
        let pair = usize::from(diagonal);
        match self {
            Self::Tetrahedron(corners) => {
                let missing = corners.iter().position(|corner| !face.contains(corner))?;
                corners.get(partner(missing, pair)).copied()
            }
            Self::Octahedron(corners) => {
                let ends = [corners.get(pair)?, corners.get(pair.checked_add(3)?)?];
                ends.into_iter().copied().find(|end| face.contains(end))
            }
        }
    }
}

/// The other end of the edge that starts at a corner of a tetrahedron and belongs to a pair of
/// opposite edges.
pub(super) fn partner(corner: usize, pair: usize) -> usize {
    corner ^ pair.wrapping_add(1)
}

/// Fills the front of `arena` with the faces of all cells, sorted, and returns it.
pub(super) fn sorted_faces<'a>(
    solid: &Solid<'_>,
    arena: &'a mut [Face],
) -> Result<&'a mut [Face], MeshError> {
    let needed = face_capacity(solid).ok_or(MeshError::TooLarge)?;
    require(Arena::Faces, needed, arena.len())?;
    let cells = cell_count(solid).ok_or(MeshError::TooLarge)?;
    let all = (0..cells)
        .filter_map(|cell| Some((cell, Cell::of(solid, cell)?)))
        .flat_map(|(cell, shape)| {
            // Collected, because the iterator borrows the shape.
            let mut faces = [None; 8];
            for (slot, corners) in faces.iter_mut().zip(shape.faces()) {
                *slot = Some(Face { corners, cell });
            }
            faces.into_iter().flatten()
        });
    let faces = arena.get_mut(..needed).unwrap_or_default();
    for (slot, face) in faces.iter_mut().zip(all) {
        *slot = face;
    }
    faces.sort_unstable();
    Ok(faces)
}

/// The part of the sorted list with these corners: one face for each cell that has it.
pub(super) fn sharing(faces: &[Face], corners: [u32; 3]) -> &[Face] {
    let start = faces.partition_point(|face| face.corners < corners);
    let rest = faces.get(start..).unwrap_or_default();
    let end = rest.partition_point(|face| face.corners == corners);
    rest.get(..end).unwrap_or_default()
}
