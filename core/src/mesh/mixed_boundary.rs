//! The boundary of a mixed solid: triangles and quadrilaterals that belong to exactly one cell.

use super::boundary::{keep_single, least_first, sorted};
use super::error::{Arena, MeshError};
use super::numbering::require;
use super::quad_faces::{cell_quads, prism_triangles, quad_count, tetrahedral_triangles};
use super::view::Solid;

/// How long the scratch lists of [`boundary_faces`] must be.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct BoundarySizes {
    /// Triangles: those of all cells, and four for each quadrilateral.
    pub triangles: usize,
    /// Quadrilaterals: three of each prism and six of each hexahedron.
    pub quads: usize,
}

impl BoundarySizes {
    /// What this solid needs; `None` where that does not fit.
    #[must_use]
    pub fn of(solid: &Solid<'_>) -> Option<Self> {
        let cells = Solid {
            surface_quads: &[],
            ..*solid
        };
        let quads = quad_count(&cells)?;
        let of_each = [
            (solid.tetrahedra.len(), 4),
            (solid.octahedra.len(), 8),
            (solid.prisms.len(), 2),
            (quads, 4),
        ];
        let triangles = of_each.iter().try_fold(0_usize, |sum, (count, faces)| {
            sum.checked_add(count.checked_mul(*faces)?)
        })?;
        Some(Self { triangles, quads })
    }
}

/// The lists that [`boundary_faces`] fills, at least as long as [`BoundarySizes`] says.
#[derive(Debug, Default)]
pub struct MixedBoundaryBuffers<'a> {
    /// Triangles.
    pub triangles: &'a mut [[u32; 3]],
    /// Quadrilaterals.
    pub quads: &'a mut [[u32; 4]],
}

/// The boundary of a mixed solid.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct BoundaryFaces<'a> {
    /// Triangles.
    pub triangles: &'a [[u32; 3]],
    /// Quadrilaterals.
    pub quads: &'a [[u32; 4]],
}

/// Finds the boundary of a mixed solid and returns its triangles and its quadrilaterals.
///
/// Both come in ascending order of their sorted corners, each face rotated so that its least
/// corner is first, and counter-clockwise from outside where the cell is positive; they are the
/// fronts of the buffers. A quadrilateral whose halves are both covered by triangles of other cells
/// is inside. If one half is covered, the other is a triangle of the boundary. A face that more
/// than two cells share is no boundary. The surface that `solid` already has is not looked at.
///
/// # Errors
///
/// Any error of [`Solid::check`], and [`MeshError::ArenaTooSmall`], which leaves the buffers
/// untouched.
pub fn boundary_faces<'a>(
    solid: &Solid<'_>,
    buffers: MixedBoundaryBuffers<'a>,
) -> Result<BoundaryFaces<'a>, MeshError> {
    solid.check()?;
    let sizes = BoundarySizes::of(solid).ok_or(MeshError::TooLarge)?;
    require(Arena::Faces, sizes.triangles, buffers.triangles.len())?;
    require(Arena::QuadFaces, sizes.quads, buffers.quads.len())?;

    let quads = buffers.quads.get_mut(..sizes.quads).unwrap_or_default();
    for (slot, face) in quads.iter_mut().zip(cell_quads(solid)) {
        *slot = least_corner_first(face);
    }
    quads.sort_unstable_by_key(quad_key);
    let single_quads = keep_runs_of_one(quads);

    let of_cells = tetrahedral_triangles(solid).chain(prism_triangles(solid));
    let mut filled = 0_usize;
    for (slot, face) in buffers.triangles.iter_mut().zip(of_cells) {
        *slot = least_first(face);
        filled = filled.saturating_add(1);
    }
    let triangles = buffers.triangles.get_mut(..filled).unwrap_or_default();
    triangles.sort_unstable_by_key(|&face| sorted(face));
    let single = keep_single(triangles);

    let quads = quads.get_mut(..single_quads).unwrap_or_default();
    let (open_quads, triangles) = open_halves(quads, buffers.triangles, single);
    let faces = buffers.triangles.get_mut(..triangles).unwrap_or_default();
    faces.sort_unstable_by_key(|&face| sorted(face));
    let kept = keep_single(faces);
    Ok(BoundaryFaces {
        triangles: buffers.triangles.get(..kept).unwrap_or_default(),
        quads: buffers.quads.get(..open_quads).unwrap_or_default(),
    })
}

/// Meets the quadrilaterals with the triangles that cover their halves, the first `single` of the
/// list. A covering triangle is written a second time behind them, so that it no longer occurs
/// once; so is the half that a quadrilateral with one covered half leaves open. Quadrilaterals
/// without a covered half move to the front. Returns how many there are, and how long the list of
/// triangles has become.
fn open_halves(
    quads: &mut [[u32; 4]],
    triangles: &mut [[u32; 3]],
    single: usize,
) -> (usize, usize) {
    let (mut kept, mut end) = (0_usize, single);
    for place in 0..quads.len() {
        let Some(&face) = quads.get(place) else { break };
        let [a, b, c, d] = face;
        let halves = [[a, b, c], [c, d, a], [b, c, d], [d, a, b]].map(least_first);
        let sides = triangles.get(..single).unwrap_or_default();
        let is_covered = halves.map(|half| {
            let key = sorted(half);
            sides
                .binary_search_by_key(&key, |&face| sorted(face))
                .is_ok()
        });
        let covered = is_covered.iter().filter(|is_covered| **is_covered).count();
        if covered == 0 {
            if let Some(slot) = quads.get_mut(kept) {
                *slot = face;
                kept = kept.saturating_add(1);
            }
            continue;
        }
        // Halves stand in pairs: each is what its partner leaves open.
        let [first, second, third, fourth] = is_covered;
        let is_partner_covered = [second, first, fourth, third];
        for ((half, is_covered), is_open) in halves.iter().zip(is_covered).zip(is_partner_covered) {
            if (is_covered || (is_open && covered == 1))
                && let Some(slot) = triangles.get_mut(end)
            {
                *slot = *half;
                end = end.saturating_add(1);
            }
        }
    }
    (kept, end)
}

/// The same cycle in the same direction, with its least corner first.
fn least_corner_first([a, b, c, d]: [u32; 4]) -> [u32; 4] {
    let least = a.min(b).min(c).min(d);
    if least == a {
        [a, b, c, d]
    } else if least == b {
        [b, c, d, a]
    } else if least == c {
        [c, d, a, b]
    } else {
        [d, a, b, c]
    }
}

/// Sorted corners, then the corner opposite the least, for a quadrilateral whose least corner is
/// first.
fn quad_key(face: &[u32; 4]) -> ([u32; 4], u32) {
    let mut corners = *face;
    corners.sort_unstable();
    let [_, _, opposite, _] = *face;
    (corners, opposite)
}

/// Moves the faces that occur once in the sorted list to its front and returns their number.
#[expect(
    clippy::indexing_slicing,
    clippy::arithmetic_side_effects,
    reason = "`next` and `start` are at most the length, and `kept` at most `start`"
)]
fn keep_runs_of_one(faces: &mut [[u32; 4]]) -> usize {
    let (mut kept, mut start) = (0, 0);
    while start < faces.len() {
        let key = quad_key(&faces[start]);
        let mut next = start + 1;
        while next < faces.len() && quad_key(&faces[next]) == key {
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

#[cfg(test)]
mod tests {
    use super::{BoundarySizes, MixedBoundaryBuffers, boundary_faces};
    use crate::mesh::Solid;

    fn boundary(solid: &Solid<'_>) -> (usize, usize, [[u32; 3]; 12]) {
        let mut triangles = [[0; 3]; 64];
        let mut quads = [[0; 4]; 16];
        let sizes = BoundarySizes::of(solid);
        assert!(sizes.is_some_and(|sizes| sizes.triangles <= 64 && sizes.quads <= 16));
        let buffers = MixedBoundaryBuffers {
            triangles: &mut triangles,
            quads: &mut quads,
        };
        let mut first = [[0; 3]; 12];
        let Ok(faces) = boundary_faces(solid, buffers) else {
            return (usize::MAX, usize::MAX, first);
        };
        for (slot, face) in first.iter_mut().zip(faces.triangles) {
            *slot = *face;
        }
        (faces.triangles.len(), faces.quads.len(), first)
    }

    const CUBE: [u32; 8] = [0, 1, 2, 3, 4, 5, 6, 7];

    /// A cube, then with one tetrahedron on half of its top, then with a pyramid of two.
    #[test]
    fn covered_quadrilaterals_leave_what_is_open() {
        let mut solid = Solid {
            vertex_count: 9,
            hexahedra: &[CUBE],
            ..Solid::default()
        };
        assert_eq!(boundary(&solid).0, 0);
        assert_eq!(boundary(&solid).1, 6);
        solid.tetrahedra = &[[4, 5, 6, 8]];
        let (triangles, quads, faces) = boundary(&solid);
        assert_eq!((triangles, quads), (4, 5));
        assert_eq!(&faces[..4], &[[4, 5, 8], [4, 6, 7], [4, 8, 6], [5, 6, 8]]);
        solid.tetrahedra = &[[4, 5, 6, 8], [4, 6, 7, 8]];
        let (triangles, quads, faces) = boundary(&solid);
        assert_eq!((triangles, quads), (4, 5));
        assert_eq!(&faces[..4], &[[4, 5, 8], [4, 8, 7], [5, 6, 8], [6, 7, 8]]);
    }
}
