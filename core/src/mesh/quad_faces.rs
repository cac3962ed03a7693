//! Quadrilateral faces of prisms and hexahedra, and the triangles that lie on them.

use super::error::{Arena, MeshError};
use super::numbering::require;
use super::view::Solid;
use super::{
    HEXAHEDRON_QUADS, OCTAHEDRON_FACES, PRISM_QUADS, PRISM_TRIANGLES, TETRAHEDRON_FACES, corners_of,
};

/// Whose face a quadrilateral is, and which of its edges are edges of a prism's triangles.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) enum QuadKind {
    /// Of a prism; the edges from corner 0 to 1 and from 2 to 3 belong to its triangles.
    PrismAlongFirst,
    /// Of a prism; the edges from corner 1 to 2 and from 3 to 0 belong to its triangles.
    PrismAlongSecond,
    /// Of a hexahedron.
    #[default]
    Hexahedron,
    /// A surface quadrilateral, whether or not a cell has it too.
    Surface,
}

/// One quadrilateral face of one cell (a face between two cells is there twice) or of the
/// surface. An opaque piece of scratch memory of
/// [`MixedNumbering`](super::MixedNumbering).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct QuadFace {
    /// Cyclic; the least corner first, then its lesser neighbour.
    corners: [u32; 4],
    kind: QuadKind,
    /// Bit `i`: a triangle of a cell covers the half without corner `i`.
    covered: u8,
    /// The refined vertex in the middle.
    vertex: u32,
}

impl QuadFace {
    fn new(cycle: [u32; 4], is_first_along: bool, is_prism: bool, is_surface: bool) -> Self {
        let (corners, is_turned) = canonical(cycle);
        let kind = match (is_surface, is_prism, is_first_along != is_turned) {
            (true, _, _) => QuadKind::Surface,
            (_, false, _) => QuadKind::Hexahedron,
            (_, true, true) => QuadKind::PrismAlongFirst,
            (_, true, false) => QuadKind::PrismAlongSecond,
        };
        Self {
            corners,
            kind,
            covered: 0,
            vertex: 0,
        }
    }

    pub(crate) fn corners(&self) -> [u32; 4] {
        self.corners
    }

    pub(crate) fn kind(&self) -> QuadKind {
        self.kind
    }

    pub(crate) fn vertex(&self) -> u32 {
        self.vertex
    }

    /// What faces are sorted and found by: sorted corners, then the corner opposite the least.
    fn key(&self) -> ([u32; 4], u32) {
        let mut sorted = self.corners;
        sorted.sort_unstable();
        let [_, _, opposite, _] = self.corners;
        (sorted, opposite)
    }

    /// Both diagonals, each in ascending order.
    fn diagonals(&self) -> [[u32; 2]; 2] {
        let [a, b, c, d] = self.corners;
        [[a.min(c), a.max(c)], [b.min(d), b.max(d)]]
    }

    /// Whether a triangle covers a half along this diagonal.
    fn is_covered_along(&self, ends: [u32; 2]) -> bool {
        let [first, second] = self.diagonals();
        (ends == first && self.covered & 0b1010 != 0)
            || (ends == second && self.covered & 0b0101 != 0)
    }

    /// The diagonal along which a triangle covers a half.
    pub(crate) fn covered_diagonal(&self) -> Option<[u32; 2]> {
        self.diagonals()
            .into_iter()
            .find(|&ends| self.is_covered_along(ends))
    }

    /// The place of the corner that a triangle on this face leaves free, if the triangle is on it.
    fn free_corner(&self, triangle: [u32; 3]) -> Option<usize> {
        let is_on = triangle.iter().all(|corner| self.corners.contains(corner));
        let free = || {
            self.corners
                .iter()
                .position(|corner| !triangle.contains(corner))
        };
        if is_on { free() } else { None }
    }

    fn is_half_covered(&self, free: usize) -> bool {
        self.covered & half_bit(free) != 0
    }

    /// The corner opposite another place.
    fn opposite(&self, place: usize) -> Option<u32> {
        self.corners.get((place ^ 2) & 3).copied()
    }
}

fn half_bit(free: usize) -> u8 {
    match free {
        0 => 0b0001,
        1 => 0b0010,
        2 => 0b0100,
        _ => 0b1000,
    }
}

/// The same cycle with its least corner first and that corner's lesser neighbour second, and
/// whether edges `0 1` and `1 2` have changed places.
fn canonical(cycle: [u32; 4]) -> ([u32; 4], bool) {
    let [a, b, c, d] = cycle;
    let least = a.min(b).min(c).min(d);
    let (first, next, across, last, is_turned) = if least == a {
        (a, b, c, d, false)
    } else if least == b {
        (b, c, d, a, true)
    } else if least == c {
        (c, d, a, b, false)
    } else {
        (d, a, b, c, true)
    };
    if next < last {
        ([first, next, across, last], is_turned)
    } else {
        ([first, last, across, next], !is_turned)
    }
}

/// One diagonal of one quadrilateral face. An opaque piece of scratch memory of
/// [`MixedNumbering`](super::MixedNumbering).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct QuadDiagonal {
    ends: [u32; 2],
    face: u32,
}

/// A triangle's place on a quadrilateral face.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Touch {
    /// Whose face it is.
    pub kind: QuadKind,
    /// The corner of the triangle that is not on the diagonal.
    pub apex: u32,
    /// The corner of the triangle that an edge of a prism's triangle joins to the apex; for other
    /// faces one of the two.
    pub along: u32,
    /// The third corner.
    pub across: u32,
}

/// All quadrilateral faces of a solid with the triangles that lie on them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct QuadFaces<'a> {
    faces: &'a [QuadFace],
    diagonals: &'a [QuadDiagonal],
}

/// How many quadrilateral faces a solid has, those between two cells counted twice.
pub(crate) fn quad_count(solid: &Solid<'_>) -> Option<usize> {
    let prisms = solid.prisms.len().checked_mul(3)?;
    let hexahedra = solid.hexahedra.len().checked_mul(6)?;
    prisms
        .checked_add(hexahedra)?
        .checked_add(solid.surface_quads.len())
}

/// All triangles of cells whose class is tetrahedra and octahedra.
pub(crate) fn tetrahedral_triangles<'a>(
    solid: &Solid<'a>,
) -> impl Iterator<Item = [u32; 3]> + use<'a> {
    let of_tetrahedra = solid.tetrahedra.iter();
    let of_octahedra = solid.octahedra.iter();
    of_tetrahedra
        .flat_map(|cell| corners_of(cell, &TETRAHEDRON_FACES))
        .chain(of_octahedra.flat_map(|cell| corners_of(cell, &OCTAHEDRON_FACES)))
}

/// All triangles of prisms.
pub(crate) fn prism_triangles<'a>(solid: &Solid<'a>) -> impl Iterator<Item = [u32; 3]> + use<'a> {
    let prisms = solid.prisms.iter();
    prisms.flat_map(|cell| corners_of(cell, &PRISM_TRIANGLES))
}

/// All quadrilaterals of cells, counter-clockwise from outside where the cell is positive: three
/// of each prism, each starting with an edge of a triangle, then six of each hexahedron.
pub(crate) fn cell_quads<'a>(solid: &Solid<'a>) -> impl Iterator<Item = [u32; 4]> + use<'a> {
    let of_prisms = solid.prisms.iter();
    let of_hexahedra = solid.hexahedra.iter();
    of_prisms
        .flat_map(|cell| corners_of(cell, &PRISM_QUADS))
        .chain(of_hexahedra.flat_map(|cell| corners_of(cell, &HEXAHEDRON_QUADS)))
}

impl<'a> QuadFaces<'a> {
    /// Finds the faces and the halves that are covered. The faces have no vertex yet.
    ///
    /// `faces` must hold [`quad_count`] elements and `diagonals` twice as many.
    pub(crate) fn find(
        solid: &Solid<'_>,
        faces: &'a mut [QuadFace],
        diagonals: &'a mut [QuadDiagonal],
    ) -> Result<(&'a mut [QuadFace], &'a [QuadDiagonal]), MeshError> {
        let count = quad_count(solid).ok_or(MeshError::TooLarge)?;
        let twice = count.checked_mul(2).ok_or(MeshError::TooLarge)?;
        require(Arena::QuadFaces, count, faces.len())?;
        require(Arena::QuadDiagonals, twice, diagonals.len())?;
        let faces = faces.get_mut(..count).unwrap_or_default();
        let diagonals = diagonals.get_mut(..twice).unwrap_or_default();

        let prism_faces = solid.prisms.len().wrapping_mul(3);
        let of_cells = cell_quads(solid)
            .zip(0..)
            .map(|(cycle, place): (_, usize)| {
                QuadFace::new(cycle, true, place < prism_faces, false)
            });
        let of_surface = solid.surface_quads.iter();
        let of_surface = of_surface.map(|&cycle| QuadFace::new(cycle, true, false, true));
        for (slot, face) in faces.iter_mut().zip(of_cells.chain(of_surface)) {
            *slot = face;
        }
        faces.sort_unstable_by_key(|face| (face.key(), face.kind));
        let pairs = diagonals.chunks_exact_mut(2);
        for ((slots, face), place) in pairs.zip(faces.iter()).zip(0..) {
            for (slot, ends) in slots.iter_mut().zip(face.diagonals()) {
                *slot = QuadDiagonal { ends, face: place };
            }
        }
        diagonals.sort_unstable();
        for triangle in tetrahedral_triangles(solid).chain(prism_triangles(solid)) {
            cover(faces, diagonals, triangle);
        }
        for face in faces.iter() {
            if face.covered & 0b1010 != 0 && face.covered & 0b0101 != 0 {
                return Err(MeshError::CrossedDiagonals {
                    corners: face.corners,
                });
            }
        }
        Ok((faces, diagonals))
    }

    pub(crate) const fn new(faces: &'a [QuadFace], diagonals: &'a [QuadDiagonal]) -> Self {
        Self { faces, diagonals }
    }

    /// All faces, ascending; equal ones (the two sides of a face) stand together.
    pub(crate) fn all(&self) -> &'a [QuadFace] {
        self.faces
    }

    /// The middle of the face with these corners in this cycle.
    pub(crate) fn vertex(&self, cycle: [u32; 4]) -> Option<u32> {
        let key = QuadFace::new(cycle, true, false, false).key();
        let place = self.faces.partition_point(|face| face.key() < key);
        self.faces
            .get(place)
            .filter(|face| face.key() == key)
            .map(QuadFace::vertex)
    }

    /// The middle of the first face that a triangle covers along this diagonal.
    pub(crate) fn on_diagonal(&self, a: u32, b: u32) -> Option<u32> {
        let ends = [a.min(b), a.max(b)];
        along(self.diagonals, ends)
            .iter()
            .filter_map(|diagonal| self.faces.get(place(diagonal.face)))
            .find(|face| face.is_covered_along(ends))
            .map(QuadFace::vertex)
    }

    /// Every diagonal along which a face is covered, once, with its midpoint.
    pub(crate) fn covered_diagonals(&self) -> impl Iterator<Item = ([u32; 2], u32)> + use<'a> {
        let faces = self.faces;
        let groups = self.diagonals.chunk_by(|one, two| one.ends == two.ends);
        groups.filter_map(move |group| {
            group.iter().find_map(|diagonal| {
                let face = faces.get(place(diagonal.face))?;
                let is_covered = face.is_covered_along(diagonal.ends);
                is_covered.then_some((diagonal.ends, face.vertex))
            })
        })
    }

    /// All faces of cells that this triangle of a cell lies on.
    pub(crate) fn touching(&self, triangle: [u32; 3]) -> impl Iterator<Item = Touch> + use<'a> {
        let (faces, diagonals) = (self.faces, self.diagonals);
        sides(triangle).into_iter().flat_map(move |ends| {
            along(diagonals, ends).iter().filter_map(move |diagonal| {
                let face = faces.get(place(diagonal.face))?;
                let free = face.free_corner(triangle)?;
                touch(face, free)
            })
        })
    }

    /// If a surface triangle is the half of a face that no triangle of a cell covers while one
    /// covers the other half: the triangle, turned so that the diagonal is its first edge.
    pub(crate) fn open_half(&self, triangle: [u32; 3]) -> Option<[u32; 3]> {
        let [a, b, c] = triangle;
        [[a, b, c], [b, c, a], [c, a, b]]
            .into_iter()
            .find(|&[from, to, apex]| {
                let ends = [from.min(to), from.max(to)];
                along(self.diagonals, ends).iter().any(|diagonal| {
                    let Some(face) = self.faces.get(place(diagonal.face)) else {
                        return false;
                    };
                    face.free_corner(triangle).is_some_and(|free| {
                        face.opposite(free) == Some(apex)
                            && !face.is_half_covered(free)
                            && face.is_half_covered((free ^ 2) & 3)
                    })
                })
            })
    }
}

/// An index of a list as an index of a slice.
fn place(face: u32) -> usize {
    usize::try_from(face).unwrap_or(usize::MAX)
}

/// The three edges of a triangle, each in ascending order.
fn sides([a, b, c]: [u32; 3]) -> [[u32; 2]; 3] {
    [[a, b], [b, c], [c, a]].map(|[a, b]| [a.min(b), a.max(b)])
}

/// The diagonals with these ends.
fn along(diagonals: &[QuadDiagonal], ends: [u32; 2]) -> &[QuadDiagonal] {
    let first = diagonals.partition_point(|diagonal| diagonal.ends < ends);
    let rest = diagonals.get(first..).unwrap_or_default();
    let count = rest.partition_point(|diagonal| diagonal.ends == ends);
    rest.get(..count).unwrap_or_default()
}

/// Marks the halves that a triangle of a cell covers.
fn cover(faces: &mut [QuadFace], diagonals: &[QuadDiagonal], triangle: [u32; 3]) {
    for ends in sides(triangle) {
        for diagonal in along(diagonals, ends) {
            if let Some(face) = faces.get_mut(place(diagonal.face))
                && let Some(free) = face.free_corner(triangle)
            {
                face.covered |= half_bit(free);
            }
        }
    }
}

/// How the triangle that leaves a corner free lies on a face.
fn touch(face: &QuadFace, free: usize) -> Option<Touch> {
    let corner = |place: usize| face.corners.get(place & 3).copied();
    let apex = corner(free ^ 2)?;
    // The apex's neighbours in the cycle: corners 0 and 1, 2 and 3 are joined by first edges.
    let first = corner(free ^ 3)?;
    let second = corner(free ^ 1)?;
    let (along, across) = match face.kind {
        QuadKind::PrismAlongSecond => (second, first),
        QuadKind::PrismAlongFirst | QuadKind::Hexahedron | QuadKind::Surface => (first, second),
    };
    Some(Touch {
        kind: face.kind,
        apex,
        along,
        across,
    })
}

/// Assigns the middle vertices of sorted faces from `first` on; returns how many there are.
///
/// Sides of the same face share one, and so do all faces that triangles cover along the same
/// diagonal; it is numbered by the least of them.
pub(crate) fn number_faces(
    faces: &mut [QuadFace],
    diagonals: &[QuadDiagonal],
    first: u32,
) -> Option<u32> {
    let mut count = 0_u32;
    for own in 0..faces.len() {
        let face = *faces.get(own)?;
        let earlier = match face.covered_diagonal() {
            Some(ends) => along(diagonals, ends)
                .iter()
                .map(|diagonal| place(diagonal.face))
                .find(|&other| {
                    faces
                        .get(other)
                        .is_some_and(|face| face.is_covered_along(ends))
                }),
            None => own.checked_sub(1).filter(|&before| {
                faces
                    .get(before)
                    .is_some_and(|other| other.key() == face.key())
            }),
        };
        let vertex = match earlier.filter(|&other| other < own) {
            Some(other) => faces.get(other)?.vertex,
            None => {
                let vertex = first.checked_add(count)?;
                count = count.checked_add(1)?;
                vertex
            }
        };
        faces.get_mut(own)?.vertex = vertex;
    }
    Some(count)
}

#[cfg(test)]
mod tests {
    use super::{QuadFace, QuadFaces, QuadKind, canonical, touch};

    #[test]
    fn canonical_cycles_know_which_edges_turned() {
        assert_eq!(canonical([5, 6, 7, 8]), ([5, 6, 7, 8], false));
        assert_eq!(canonical([8, 5, 6, 7]), ([5, 6, 7, 8], true));
        assert_eq!(canonical([5, 8, 7, 6]), ([5, 6, 7, 8], true));
        assert_eq!(canonical([6, 5, 8, 7]), ([5, 6, 7, 8], false));
        assert_eq!(canonical([7, 8, 5, 6]), ([5, 6, 7, 8], false));
    }

    /// Prism quadrilateral 1 2 12 11 whose triangle edges are 1-2 and 11-12, listed with another
    /// corner first: the edge along stays the edge along.
    #[test]
    fn a_prism_face_keeps_its_triangle_edges() {
        for cycle in [[1, 2, 12, 11], [12, 11, 1, 2]] {
            let face = QuadFace::new(cycle, true, true, false);
            assert_eq!(face.kind(), QuadKind::PrismAlongFirst);
            // The triangle 1 2 12 leaves corner 11 (place 3) free.
            let touch = touch(&face, 3).map(|touch| (touch.apex, touch.along, touch.across));
            assert_eq!(touch, Some((2, 1, 12)));
        }
        let face = QuadFace::new([4, 2, 1, 3], true, true, false);
        // Cycle 1 2 4 3 with triangle edges 4-2 and 1-3.
        assert_eq!(face.corners(), [1, 2, 4, 3]);
        assert_eq!(face.kind(), QuadKind::PrismAlongSecond);
        let touch = touch(&face, 0).map(|touch| (touch.apex, touch.along, touch.across));
        assert_eq!(touch, Some((4, 2, 3)));
    }

    #[test]
    fn nothing_touches_where_there_are_no_faces() {
        let faces = QuadFaces::new(&[], &[]);
        assert_eq!(faces.touching([0, 1, 2]).count(), 0);
        assert_eq!(faces.open_half([0, 1, 2]), None);
    }
}
