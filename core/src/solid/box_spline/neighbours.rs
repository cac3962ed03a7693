//! The neighbours of vertices and edges (definition 3.3).

use super::Scheme;
use crate::mesh::{
    Arena, MeshError, OCTAHEDRON_FACES, Solid, TETRAHEDRON_FACES, face_capacity, require,
};

/// How many triples the scratch of [`Neighbours::new`] must hold: a triangle for each face of a
/// cell (4 and 8), and for each octahedron 4 around its major diagonal or 12 around all three.
/// `None` if that does not fit.
#[must_use]
pub fn neighbour_capacity(solid: &Solid<'_>, scheme: &Scheme<'_>) -> Option<usize> {
    let around = solid.octahedra.len().checked_mul(spokes_each(scheme))?;
    face_capacity(solid)?.checked_add(around)
}

fn spokes_each(scheme: &Scheme<'_>) -> usize {
    match scheme {
        Scheme::MajorDiagonals(_) => 4,
        Scheme::Averaged => 12,
    }
}

/// Who is whose neighbour in a solid, made once for a level and used for any number of values.
///
/// An edge's neighbours in the cells that contain it are the third corners of the triangles at
/// that edge, and across octahedra the far ends of diagonals. So two sorted lists without
/// repetitions say everything.
#[derive(Clone, Copy, Debug)]
pub struct Neighbours<'a> {
    pub(super) scheme: Scheme<'a>,
    /// Triangles of cells, corners ascending.
    pub(super) triangles: &'a [[u32; 3]],
    /// The two ends of a diagonal, ascending, and a corner next to both.
    spokes: &'a [[u32; 3]],
}

impl<'a> Neighbours<'a> {
    /// Finds the neighbours in `solid`.
    ///
    /// `arena` must hold [`neighbour_capacity`] triples. The time is that of sorting them.
    ///
    /// # Errors
    ///
    /// Any error of [`Solid::check`] and
    /// [`Diagonals::check`](super::Diagonals::check); [`MeshError::ArenaTooSmall`], which leaves
    /// the arena untouched, and [`MeshError::TooLarge`].
    pub fn new(
        solid: &Solid<'_>,
        scheme: Scheme<'a>,
        arena: &'a mut [[u32; 3]],
    ) -> Result<Self, MeshError> {
        solid.check()?;
        solid.require_tetrahedral()?;
        if let Scheme::MajorDiagonals(diagonals) = scheme {
            diagonals.check(solid)?;
        }
        let needed = neighbour_capacity(solid, &scheme).ok_or(MeshError::TooLarge)?;
        require(Arena::Neighbours, needed, arena.len())?;
        let faces = face_capacity(solid).ok_or(MeshError::TooLarge)?;
        let arena = arena.get_mut(..needed).unwrap_or_default();
        let (triangles, spokes) = arena
            .split_at_mut_checked(faces)
            .ok_or(MeshError::TooLarge)?;
        fill_triangles(solid, triangles);
        fill_spokes(solid, &scheme, spokes);
        Ok(Self {
            scheme,
            triangles: unique(triangles),
            spokes: unique(spokes),
        })
    }

    /// Edges with the vertices across octahedra that are their neighbours, each pair once, without
    /// those that a triangle at the edge has counted.
    pub(super) fn across(&self) -> impl Iterator<Item = ([u32; 2], u32)> {
        self.spokes.iter().flat_map(move |&[p, q, corner]| {
            let mut corners = [p, q, corner];
            corners.sort_unstable();
            let is_new = self.triangles.binary_search(&corners).is_err();
            [(p, q), (q, p)]
                .into_iter()
                .filter(move |&(end, far)| is_new && self.is_first(end, corner, far))
                .map(move |(end, far)| ([end, corner], far))
        })
    }

    /// Whether `far`, opposite `end`, is not opposite `corner` too in another octahedron, which
    /// then says the same of the edge `end corner`; one of the two is the first.
    fn is_first(&self, end: u32, corner: u32, far: u32) -> bool {
        let other = [corner.min(far), corner.max(far), end];
        end < corner || self.spokes.binary_search(&other).is_err()
    }

    /// The ends of the diagonals, each pair once.
    pub(super) fn diagonals(&self) -> impl Iterator<Item = [u32; 2]> {
        let before = core::iter::once(None).chain(self.spokes.iter().map(Some));
        self.spokes
            .iter()
            .zip(before)
            .filter_map(|(&[p, q, _], before)| match before {
                Some(&[last_p, last_q, _]) if last_p == p && last_q == q => None,
                _ => Some([p, q]),
            })
    }
}

fn fill_triangles(solid: &Solid<'_>, triangles: &mut [[u32; 3]]) {
    let of_tetrahedra = solid
        .tetrahedra
        .iter()
        .flat_map(|cell| faces_of(cell, &TETRAHEDRON_FACES));
    let of_octahedra = solid
        .octahedra
        .iter()
        .flat_map(|cell| faces_of(cell, &OCTAHEDRON_FACES));
    for (slot, face) in triangles.iter_mut().zip(of_tetrahedra.chain(of_octahedra)) {
        *slot = face;
    }
}

fn faces_of<const N: usize>(
    cell: &[u32; N],
    faces: &'static [[usize; 3]],
) -> impl Iterator<Item = [u32; 3]> {
    let corner = |slot: usize| cell.get(slot).copied().unwrap_or_default();
    faces.iter().map(move |face| {
        let mut face = face.map(corner);
        face.sort_unstable();
        face
    })
}

fn fill_spokes(solid: &Solid<'_>, scheme: &Scheme<'_>, spokes: &mut [[u32; 3]]) {
    let each = spokes_each(scheme);
    for (place, (cell, slots)) in solid
        .octahedra
        .iter()
        .zip(spokes.chunks_exact_mut(each))
        .enumerate()
    {
        let &[a, b, c, opposite_a, opposite_b, opposite_c] = cell;
        let around =
            |p: u32, q: u32, corners: [u32; 4]| corners.map(|corner| [p.min(q), p.max(q), corner]);
        let all = [
            around(a, opposite_a, [b, c, opposite_b, opposite_c]),
            around(b, opposite_b, [a, c, opposite_a, opposite_c]),
            around(c, opposite_c, [a, b, opposite_a, opposite_b]),
        ];
        let wanted = match scheme {
            Scheme::MajorDiagonals(diagonals) => diagonals.octahedra.get(place).copied(),
            Scheme::Averaged => None,
        };
        let chosen = all
            .iter()
            .zip(0_u8..)
            .filter(|&(_, pair)| wanted.is_none_or(|wanted| wanted == pair))
            .flat_map(|(spokes, _)| spokes);
        for (slot, spoke) in slots.iter_mut().zip(chosen) {
            *slot = *spoke;
        }
    }
}

/// Sorts, drops repetitions and returns what is left.
fn unique(list: &mut [[u32; 3]]) -> &[[u32; 3]] {
    list.sort_unstable();
    let mut kept = 0_usize;
    for place in 0..list.len() {
        let Some(&triple) = list.get(place) else {
            break;
        };
        let last = kept.checked_sub(1).and_then(|last| list.get(last));
        if last == Some(&triple) {
            continue;
        }
        if let Some(slot) = list.get_mut(kept) {
            *slot = triple;
            kept = kept.saturating_add(1);
        }
    }
    list.get(..kept).unwrap_or_default()
}
