//! The numbering of the vertices that a split adds.

use super::error::{Arena, MeshError, Part};
use super::view::Solid;
use super::{OCTAHEDRON_EDGES, TETRAHEDRON_EDGES, TRIANGLE_EDGES, corners_of};

/// How many edges the scratch of [`Numbering::new`] must hold: six for each tetrahedron, twelve
/// for each octahedron and three for each surface triangle, shared ones counted every time. `None`
/// if that does not fit.
#[must_use]
pub fn edge_capacity(solid: &Solid<'_>) -> Option<usize> {
    let tetrahedra = solid.tetrahedra.len().checked_mul(6)?;
    let octahedra = solid.octahedra.len().checked_mul(12)?;
    let surface = solid.surface.len().checked_mul(3)?;
    tetrahedra.checked_add(octahedra)?.checked_add(surface)
}

/// The vertices of a split: which index the midpoint of an edge and the centroid of an
/// octahedron get.
///
/// Old vertices keep their index; then come midpoints of the edges of cells and of surface
/// triangles (those of sheets are in no cell) by ascending pair of their ends; then
/// octahedron centroids by ascending sorted corners (octahedra with the same corners by their
/// place in the list).
#[derive(Clone, Copy, Debug)]
pub struct Numbering<'a> {
    old: u32,
    edges: &'a [[u32; 2]],
    octahedra: &'a [u32],
}

impl<'a> Numbering<'a> {
    /// Numbers the vertices of the split of `solid`.
    ///
    /// `edges` must hold [`edge_capacity`] pairs, `octahedra` one index for each octahedron. The
    /// time is that of sorting them.
    ///
    /// # Errors
    ///
    /// Any error of [`Solid::check`]; [`MeshError::UnsupportedPart`] if the solid has other cells
    /// than tetrahedra and octahedra; [`MeshError::ArenaTooSmall`], which leaves both arenas
    /// untouched; [`MeshError::NotAnEdge`] if a crease runs along no edge of a cell or of a surface
    /// triangle.
    pub fn new(
        solid: &Solid<'_>,
        edges: &'a mut [[u32; 2]],
        octahedra: &'a mut [u32],
    ) -> Result<Self, MeshError> {
        solid.check()?;
        solid.require_tetrahedral()?;
        let edges_needed = edge_capacity(solid).ok_or(MeshError::TooLarge)?;
        let octahedra_needed = solid.octahedra.len();
        require(Arena::Edges, edges_needed, edges.len())?;
        require(Arena::OctahedronOrder, octahedra_needed, octahedra.len())?;

        let numbering = Self {
            old: solid.vertex_count,
            edges: unique_edges(solid, edges.get_mut(..edges_needed).unwrap_or_default()),
            octahedra: order_cells(
                solid.octahedra,
                octahedra.get_mut(..octahedra_needed).unwrap_or_default(),
            ),
        };
        let new = numbering
            .edges
            .len()
            .checked_add(octahedra_needed)
            .ok_or(MeshError::TooLarge)?;
        u32::try_from(new)
            .ok()
            .and_then(|new| new.checked_add(solid.vertex_count))
            .ok_or(MeshError::TooLarge)?;
        numbering.check_creases(solid)?;
        Ok(numbering)
    }

    /// Number of vertices before the split.
    #[must_use]
    pub fn old_count(&self) -> u32 {
        self.old
    }

    /// Number of vertices after the split.
    #[must_use]
    pub fn vertex_count(&self) -> u32 {
        self.old
            .wrapping_add(length(self.edges))
            .wrapping_add(length(self.octahedra))
    }

    /// All edges in the order of their midpoints, ends ascending.
    #[must_use]
    pub fn edges(&self) -> &'a [[u32; 2]] {
        self.edges
    }

    /// Index of the midpoint of the edge from `a` to `b`, if that is an edge.
    #[must_use]
    pub fn midpoint(&self, a: u32, b: u32) -> Option<u32> {
        let place = self.edges.binary_search(&[a.min(b), a.max(b)]).ok()?;
        self.old.checked_add(u32::try_from(place).ok()?)
    }

    /// Every octahedron's place in the solid's list with the index of its centroid, in the order
    /// of the centroids.
    pub fn centroids(&self) -> impl Iterator<Item = (usize, u32)> + use<'a> {
        let first = self.old.wrapping_add(length(self.edges));
        self.octahedra
            .iter()
            .zip(first..)
            .filter_map(|(&place, vertex)| Some((usize::try_from(place).ok()?, vertex)))
    }

    fn check_creases(&self, solid: &Solid<'_>) -> Result<(), MeshError> {
        for (index, &[a, b]) in solid.creases.iter().enumerate() {
            if self.midpoint(a, b).is_none() {
                return Err(MeshError::NotAnEdge {
                    part: Part::Crease,
                    index,
                    edge: [a, b],
                });
            }
        }
        Ok(())
    }
}

/// Refuses an arena that holds less than `needed`.
pub(crate) fn require(arena: Arena, needed: usize, given: usize) -> Result<(), MeshError> {
    if given < needed {
        Err(MeshError::ArenaTooSmall {
            arena,
            needed,
            given,
        })
    } else {
        Ok(())
    }
}

/// The length of a list whose total was checked to fit 32 bits.
fn length<T>(list: &[T]) -> u32 {
    u32::try_from(list.len()).unwrap_or(u32::MAX)
}

/// Fills `arena` with the edges of all cells and surface triangles, sorts them and drops
/// repetitions.
fn unique_edges<'a>(solid: &Solid<'_>, arena: &'a mut [[u32; 2]]) -> &'a [[u32; 2]] {
    let of_tetrahedra = solid
        .tetrahedra
        .iter()
        .flat_map(|cell| edges_of(cell, &TETRAHEDRON_EDGES));
    let of_octahedra = solid
        .octahedra
        .iter()
        .flat_map(|cell| edges_of(cell, &OCTAHEDRON_EDGES));
    let of_surface = solid
        .surface
        .iter()
        .flat_map(|triangle| edges_of(triangle, &TRIANGLE_EDGES));
    let of_all = of_tetrahedra.chain(of_octahedra).chain(of_surface);
    for (slot, edge) in arena.iter_mut().zip(of_all) {
        *slot = edge;
    }
    arena.sort_unstable();
    drop_repetitions(arena, |_| true)
}

/// Moves the first of each run of equal elements that is to be kept to the front of a sorted list
/// and returns that front.
pub(super) fn drop_repetitions<T: Copy + PartialEq>(
    sorted: &mut [T],
    is_kept: impl Fn(&T) -> bool,
) -> &[T] {
    let mut kept = 0_usize;
    for place in 0..sorted.len() {
        let Some(&element) = sorted.get(place) else {
            break;
        };
        let last = kept.checked_sub(1).and_then(|last| sorted.get(last));
        if last == Some(&element) || !is_kept(&element) {
            continue;
        }
        if let Some(slot) = sorted.get_mut(kept) {
            *slot = element;
            kept = kept.saturating_add(1);
        }
    }
    sorted.get(..kept).unwrap_or_default()
}

fn edges_of<const N: usize>(
    cell: &[u32; N],
    edges: &'static [[usize; 2]],
) -> impl Iterator<Item = [u32; 2]> {
    corners_of(cell, edges).map(|[a, b]| [a.min(b), a.max(b)])
}

/// Fills `arena` with the places of the cells, sorted by their sorted corners.
pub(super) fn order_cells<'a, const N: usize>(
    cells: &[[u32; N]],
    arena: &'a mut [u32],
) -> &'a [u32] {
    for (slot, place) in arena.iter_mut().zip(0..) {
        *slot = place;
    }
    arena.sort_unstable_by_key(|&place| {
        let cell = usize::try_from(place)
            .ok()
            .and_then(|place| cells.get(place));
        let mut corners = cell.copied().unwrap_or([0; N]);
        corners.sort_unstable();
        (corners, place)
    });
    arena
}
