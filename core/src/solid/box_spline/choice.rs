//! The paper's Algorithm 2: a major diagonal for every cell of a mesh that has none.

use super::diagonals::Diagonals;
use super::faces::{Cell, Face, cell_count, partner, sharing, sorted_faces};
use crate::mesh::{Arena, MeshError, Solid, require};

/// Where major diagonals are written: at least one byte for each tetrahedron and octahedron.
#[derive(Debug, Default)]
pub struct DiagonalBuffers<'a> {
    /// For the tetrahedra.
    pub tetrahedra: &'a mut [u8],
    /// For the octahedra.
    pub octahedra: &'a mut [u8],
}

/// A cell that the search has not seen, in place of its diagonal.
const UNSEEN: u8 = 3;
/// A cell that waits in the queue.
const WAITING: u8 = 4;

/// Chooses a major diagonal for every cell by breadth-first search over cells that share a
/// triangle, so that neighbours clash as little as the search can arrange.
///
/// The paper leaves some choices open. Here the search starts at the lowest cell of each
/// component (tetrahedra before octahedra), neighbours enter the queue in the order of their
/// indices, and a cell takes, of its three pairs of opposite edges, the one with the fewest edges
/// that neighbours already visited use; the lowest number on ties. The paper starts from tetrahedra
/// alone; where octahedra take part, a tetrahedron and an octahedron that share a
/// triangle agree if their diagonals are parallel, as on the regular lattice, and an octahedron
/// counts the four edges round each of its diagonals.
///
/// `faces` is scratch for [`face_capacity`](crate::mesh::face_capacity) faces, `queue` for one
/// index for each cell. The time is that of sorting the faces and looking each of them up.
///
/// # Errors
///
/// Any error of [`Solid::check`], [`MeshError::UnsupportedPart`] for cells of other shapes,
/// [`MeshError::ArenaTooSmall`] and [`MeshError::TooLarge`], before
/// anything is written to `buffers`.
pub fn choose_diagonals<'a>(
    solid: &Solid<'_>,
    buffers: DiagonalBuffers<'a>,
    faces: &mut [Face],
    queue: &mut [u32],
) -> Result<Diagonals<'a>, MeshError> {
    solid.check()?;
    solid.require_tetrahedral()?;
    let cells = cell_count(solid).ok_or(MeshError::TooLarge)?;
    let waiting = usize::try_from(cells).unwrap_or(usize::MAX);
    require(Arena::CellQueue, waiting, queue.len())?;
    let (tetrahedra, octahedra) = (solid.tetrahedra.len(), solid.octahedra.len());
    require(Arena::Diagonals, tetrahedra, buffers.tetrahedra.len())?;
    require(Arena::Diagonals, octahedra, buffers.octahedra.len())?;
    let faces = &*sorted_faces(solid, faces)?;

    let mut search = Search {
        solid,
        faces,
        tetrahedra: buffers.tetrahedra.get_mut(..tetrahedra).unwrap_or_default(),
        octahedra: buffers.octahedra.get_mut(..octahedra).unwrap_or_default(),
    };
    search.tetrahedra.fill(UNSEEN);
    search.octahedra.fill(UNSEEN);
    search.all(cells, queue).ok_or(MeshError::TooLarge)?;
    Ok(Diagonals {
        tetrahedra: search.tetrahedra,
        octahedra: search.octahedra,
    })
}

struct Search<'s, 'd> {
    solid: &'s Solid<'s>,
    faces: &'s [Face],
    tetrahedra: &'d mut [u8],
    octahedra: &'d mut [u8],
}

impl Search<'_, '_> {
    /// Visits every cell. `None` cannot happen with arenas of the sizes that were checked.
    fn all(&mut self, cells: u32, queue: &mut [u32]) -> Option<()> {
        let (mut popped, mut pushed) = (0_usize, 0_usize);
        for start in 0..cells {
            if *self.state(start)? != UNSEEN {
                continue;
            }
            *self.state(start)? = WAITING;
            *queue.get_mut(pushed)? = start;
            pushed = pushed.checked_add(1)?;
            while popped < pushed {
                let cell = *queue.get(popped)?;
                popped = popped.checked_add(1)?;
                let mut last = None;
                while let Some(next) = self.neighbour_after(cell, last)? {
                    last = Some(next);
                    if *self.state(next)? == UNSEEN {
                        *self.state(next)? = WAITING;
                        *queue.get_mut(pushed)? = next;
                        pushed = pushed.checked_add(1)?;
                    }
                }
                *self.state(cell)? = self.choose(cell)?;
            }
        }
        Some(())
    }

    /// The diagonal of a cell, or what stands in its place.
    fn state(&mut self, cell: u32) -> Option<&mut u8> {
        let place = usize::try_from(cell).ok()?;
        match place.checked_sub(self.tetrahedra.len()) {
            None => self.tetrahedra.get_mut(place),
            Some(place) => self.octahedra.get_mut(place),
        }
    }

    /// The lowest neighbour of `cell` above `last`.
    fn neighbour_after(&self, cell: u32, last: Option<u32>) -> Option<Option<u32>> {
        let above = |other: u32| last.is_none_or(|last| other > last);
        let neighbours = Cell::of(self.solid, cell)?
            .faces()
            .flat_map(|corners| sharing(self.faces, corners))
            .map(Face::cell)
            .filter(|&other| other != cell && above(other))
            .min();
        Some(neighbours)
    }

    /// The diagonal with the fewest edges in use, the lowest on ties.
    fn choose(&mut self, cell: u32) -> Option<u8> {
        let shape = Cell::of(self.solid, cell)?;
        let mut best = (u8::MAX, 0);
        for diagonal in 0..3 {
            let mut used = 0_u8;
            let (edges, count) = edges_of(&shape, diagonal)?;
            for &edge in edges.get(..count)? {
                used = used.checked_add(u8::from(self.is_used(cell, &shape, edge)?))?;
            }
            best = best.min((used, diagonal));
        }
        Some(best.1)
    }

    /// Whether a visited neighbour uses an edge of `cell`.
    fn is_used(&mut self, cell: u32, shape: &Cell, edge: [u32; 2]) -> Option<bool> {
        for corners in shape.faces() {
            for face in sharing(self.faces, corners) {
                let other = face.cell();
                let diagonal = *self.state(other)?;
                if other == cell || diagonal > 2 {
                    continue;
                }
                let neighbour = Cell::of(self.solid, other)?;
                if uses(shape, &neighbour, diagonal, corners, edge)? {
                    return Some(true);
                }
            }
        }
        Some(false)
    }
}

/// The edges that a cell uses with a diagonal, and how many they are: a tetrahedron's pair, and
/// the four round an octahedron's diagonal.
fn edges_of(cell: &Cell, diagonal: u8) -> Option<([[u32; 2]; 4], usize)> {
    let pair = usize::from(diagonal);
    match cell {
        Cell::Tetrahedron(corners) => {
            // Corner 0 and its partner, and the two others.
            let near = partner(0, pair);
            let far = if pair == 0 { 2 } else { 1 };
            let at = |corner: usize| corners.get(corner).copied();
            let near = [at(0)?, at(near)?];
            let far = [at(far)?, at(partner(far, pair))?];
            Some(([near, far, [0; 2], [0; 2]], 2))
        }
        Cell::Octahedron(corners) => {
            let &[a, b, c, opposite_a, opposite_b, opposite_c] = corners;
            let pairs = [[a, opposite_a], [b, opposite_b], [c, opposite_c]];
            let one = pairs.get(pair.wrapping_add(1).checked_rem(3)?)?;
            let two = pairs.get(pair.wrapping_add(2).checked_rem(3)?)?;
            let [[p, q], [r, s]] = [*one, *two];
            Some(([[p, r], [p, s], [q, r], [q, s]], 4))
        }
    }
}

/// Whether a visited neighbour across the face `corners` makes an edge of `cell` one to avoid.
fn uses(
    cell: &Cell,
    neighbour: &Cell,
    diagonal: u8,
    corners: [u32; 3],
    edge: [u32; 2],
) -> Option<bool> {
    let same = |[a, b]: [u32; 2], [c, d]: [u32; 2]| (a == c && b == d) || (a == d && b == c);
    let on_face = edge.iter().all(|end| corners.contains(end));
    Some(match (cell, neighbour) {
        (Cell::Tetrahedron(_), Cell::Tetrahedron(_)) => {
            let (edges, count) = edges_of(neighbour, diagonal)?;
            edges.get(..count)?.iter().any(|&other| same(other, edge))
        }
        // The neighbour uses the edge opposite the corner that it singles out.
        (Cell::Octahedron(_), Cell::Octahedron(_)) => {
            let single = neighbour.singled_out(diagonal, corners)?;
            on_face && !edge.contains(&single)
        }
        // To be parallel to it, all edges of the face but that one are to be avoided.
        _ => {
            let single = neighbour.singled_out(diagonal, corners)?;
            on_face && edge.contains(&single)
        }
    })
}
