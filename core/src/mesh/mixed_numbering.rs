//! The numbering of the vertices that the split of a mixed solid adds.

use super::error::{Arena, MeshError, Part};
use super::numbering::{drop_repetitions, order_cells, require};
use super::quad_faces::{
    QuadDiagonal, QuadFace, QuadFaces, number_faces, prism_triangles, quad_count,
};
use super::view::Solid;
use super::{
    HEXAHEDRON_EDGES, OCTAHEDRON_EDGES, PRISM_EDGES, QUAD_EDGES, TETRAHEDRON_EDGES, TRIANGLE_EDGES,
    corners_of,
};

/// How long the scratch lists of [`MixedNumbering::new`] must be.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct MixedNumberingSizes {
    /// Edges of all cells and surface faces, shared ones counted every time.
    pub edges: usize,
    /// Quadrilateral faces: three of each prism, six of each hexahedron, and the surface's.
    pub quads: usize,
    /// Two for each quadrilateral face.
    pub diagonals: usize,
    /// Two for each prism.
    pub prism_triangles: usize,
    /// One for each octahedron.
    pub octahedra: usize,
    /// One for each hexahedron.
    pub hexahedra: usize,
}

impl MixedNumberingSizes {
    /// What this solid needs; `None` where that does not fit.
    #[must_use]
    pub fn of(solid: &Solid<'_>) -> Option<Self> {
        let of_each = [
            (solid.tetrahedra.len(), 6),
            (solid.octahedra.len(), 12),
            (solid.prisms.len(), 9),
            (solid.hexahedra.len(), 12),
            (solid.surface.len(), 3),
            (solid.surface_quads.len(), 4),
        ];
        let edges = of_each.iter().try_fold(0_usize, |sum, (count, edges)| {
            sum.checked_add(count.checked_mul(*edges)?)
        })?;
        let quads = quad_count(solid)?;
        Some(Self {
            edges,
            quads,
            diagonals: quads.checked_mul(2)?,
            prism_triangles: solid.prisms.len().checked_mul(2)?,
            octahedra: solid.octahedra.len(),
            hexahedra: solid.hexahedra.len(),
        })
    }
}

/// The scratch lists of [`MixedNumbering::new`], at least as long as [`MixedNumberingSizes`] says.
#[derive(Debug, Default)]
pub struct MixedNumberingBuffers<'a> {
    /// Edges.
    pub edges: &'a mut [[u32; 2]],
    /// Quadrilateral faces.
    pub quads: &'a mut [QuadFace],
    /// Their diagonals.
    pub diagonals: &'a mut [QuadDiagonal],
    /// Triangles of prisms.
    pub prism_triangles: &'a mut [[u32; 3]],
    /// The order of the octahedra.
    pub octahedra: &'a mut [u32],
    /// The order of the hexahedra.
    pub hexahedra: &'a mut [u32],
}

/// The vertices of the split of a mixed solid: which index the middle of an edge, of a
/// quadrilateral face, of an octahedron and of a hexahedron get.
///
/// Old vertices keep their index; then come edges, quadrilateral faces, octahedra and hexahedra,
/// each by ascending tuple of their sorted corners (cells with the same corners by their place in
/// the list). Where a triangle of a cell covers half of a quadrilateral face, the edge along the
/// face's diagonal has no vertex of its own: its midpoint *is* the face's. If several faces are
/// covered along the same diagonal they share one vertex, numbered by the least of them.
///
/// For a solid of tetrahedra and octahedra alone the order is that of
/// [`Numbering`](super::Numbering).
#[derive(Clone, Copy, Debug)]
pub struct MixedNumbering<'a> {
    old: u32,
    edges: &'a [[u32; 2]],
    quads: QuadFaces<'a>,
    quad_vertices: u32,
    prism_triangles: &'a [[u32; 3]],
    octahedra: &'a [u32],
    hexahedra: &'a [u32],
}

impl<'a> MixedNumbering<'a> {
    /// Numbers the vertices of the split of `solid`.
    ///
    /// The time is that of sorting the lists.
    ///
    /// # Errors
    ///
    /// Any error of [`Solid::check`]; [`MeshError::ArenaTooSmall`], which leaves all lists
    /// untouched; [`MeshError::CrossedDiagonals`] if triangles cover a face along both of its
    /// diagonals; [`MeshError::NotAnEdge`] if a crease runs along no edge of a cell or of a surface
    /// face.
    pub fn new(solid: &Solid<'_>, buffers: MixedNumberingBuffers<'a>) -> Result<Self, MeshError> {
        solid.check()?;
        let sizes = MixedNumberingSizes::of(solid).ok_or(MeshError::TooLarge)?;
        let given = [
            (Arena::Edges, sizes.edges, buffers.edges.len()),
            (Arena::QuadFaces, sizes.quads, buffers.quads.len()),
            (
                Arena::QuadDiagonals,
                sizes.diagonals,
                buffers.diagonals.len(),
            ),
            (
                Arena::PrismTriangles,
                sizes.prism_triangles,
                buffers.prism_triangles.len(),
            ),
            (
                Arena::OctahedronOrder,
                sizes.octahedra,
                buffers.octahedra.len(),
            ),
            (
                Arena::HexahedronOrder,
                sizes.hexahedra,
                buffers.hexahedra.len(),
            ),
        ];
        for (arena, needed, given) in given {
            require(arena, needed, given)?;
        }

        let (faces, diagonals) = QuadFaces::find(solid, buffers.quads, buffers.diagonals)?;
        let edges = buffers.edges.get_mut(..sizes.edges).unwrap_or_default();
        let edges = unique_edges(solid, QuadFaces::new(faces, diagonals), edges);
        let old = solid.vertex_count;
        let quad_vertices = length(edges)
            .and_then(|count| old.checked_add(count))
            .and_then(|first| number_faces(faces, diagonals, first))
            .ok_or(MeshError::TooLarge)?;
        let octahedra = buffers.octahedra.get_mut(..sizes.octahedra);
        let hexahedra = buffers.hexahedra.get_mut(..sizes.hexahedra);
        let triangles = buffers.prism_triangles.get_mut(..sizes.prism_triangles);
        let numbering = Self {
            old,
            edges,
            quads: QuadFaces::new(faces, diagonals),
            quad_vertices,
            prism_triangles: sorted_triangles(solid, triangles.unwrap_or_default()),
            octahedra: order_cells(solid.octahedra, octahedra.unwrap_or_default()),
            hexahedra: order_cells(solid.hexahedra, hexahedra.unwrap_or_default()),
        };
        numbering.checked_count().ok_or(MeshError::TooLarge)?;
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
        self.checked_count().unwrap_or(u32::MAX)
    }

    /// The edges that have a vertex of their own, in the order of their midpoints, ends ascending.
    /// Diagonals of covered faces are not among them.
    #[must_use]
    pub fn edges(&self) -> &'a [[u32; 2]] {
        self.edges
    }

    /// Index of the midpoint of the edge from `a` to `b`, if that is an edge.
    #[must_use]
    pub fn midpoint(&self, a: u32, b: u32) -> Option<u32> {
        match self.edges.binary_search(&[a.min(b), a.max(b)]) {
            Ok(place) => self.old.checked_add(u32::try_from(place).ok()?),
            Err(_) => self.quads.on_diagonal(a, b),
        }
    }

    /// Index of the middle of the quadrilateral face with these corners in cyclic order.
    #[must_use]
    pub fn quad_middle(&self, cycle: [u32; 4]) -> Option<u32> {
        self.quads.vertex(cycle)
    }

    /// Every octahedron's place in the solid's list with the index of its centroid, in the order
    /// of the centroids.
    pub fn octahedra(&self) -> impl Iterator<Item = (usize, u32)> + use<'a> {
        let first = self.first_octahedron().unwrap_or(u32::MAX);
        placed(self.octahedra, first)
    }

    /// Every hexahedron's place in the solid's list with the index of its centroid, in the order
    /// of the centroids.
    pub fn hexahedra(&self) -> impl Iterator<Item = (usize, u32)> + use<'a> {
        let before = length(self.octahedra).unwrap_or(u32::MAX);
        let first = self.first_octahedron().unwrap_or(u32::MAX);
        placed(self.hexahedra, first.saturating_add(before))
    }

    pub(crate) fn quads(&self) -> &QuadFaces<'a> {
        &self.quads
    }

    /// The index of the first quadrilateral face's vertex.
    pub(crate) fn first_quad(&self) -> u32 {
        self.old
            .saturating_add(length(self.edges).unwrap_or(u32::MAX))
    }

    /// How many vertices the quadrilateral faces have.
    pub(crate) fn quad_vertices(&self) -> u32 {
        self.quad_vertices
    }

    /// How many triangles of prisms have these corners.
    pub(crate) fn prism_triangles_at(&self, mut triangle: [u32; 3]) -> usize {
        triangle.sort_unstable();
        let first = self.prism_triangles.partition_point(|at| *at < triangle);
        let rest = self.prism_triangles.get(first..).unwrap_or_default();
        rest.partition_point(|at| *at == triangle)
    }

    fn first_octahedron(&self) -> Option<u32> {
        let edges = length(self.edges)?;
        self.old.checked_add(edges)?.checked_add(self.quad_vertices)
    }

    fn checked_count(&self) -> Option<u32> {
        self.first_octahedron()?
            .checked_add(length(self.octahedra)?)?
            .checked_add(length(self.hexahedra)?)
    }

    fn check_creases(&self, solid: &Solid<'_>) -> Result<(), MeshError> {
        let mut creases = solid.creases.iter().enumerate();
        match creases.find(|(_, [a, b])| self.midpoint(*a, *b).is_none()) {
            Some((index, &edge)) => Err(MeshError::NotAnEdge {
                part: Part::Crease,
                index,
                edge,
            }),
            None => Ok(()),
        }
    }
}

fn length<T>(list: &[T]) -> Option<u32> {
    u32::try_from(list.len()).ok()
}

fn placed(order: &[u32], first: u32) -> impl Iterator<Item = (usize, u32)> {
    order
        .iter()
        .zip(first..)
        .filter_map(|(&place, vertex)| Some((usize::try_from(place).ok()?, vertex)))
}

/// Fills `arena` with the edges of all cells and surface faces, sorts them, and drops repetitions
/// and the diagonals of covered faces.
fn unique_edges<'a>(
    solid: &Solid<'_>,
    quads: QuadFaces<'_>,
    arena: &'a mut [[u32; 2]],
) -> &'a [[u32; 2]] {
    let tetrahedra = solid.tetrahedra.iter();
    let octahedra = solid.octahedra.iter();
    let prisms = solid.prisms.iter();
    let hexahedra = solid.hexahedra.iter();
    let triangles = solid.surface.iter();
    let surface_quads = solid.surface_quads.iter();
    let all = tetrahedra
        .flat_map(|cell| corners_of(cell, &TETRAHEDRON_EDGES))
        .chain(octahedra.flat_map(|cell| corners_of(cell, &OCTAHEDRON_EDGES)))
        .chain(prisms.flat_map(|cell| corners_of(cell, &PRISM_EDGES)))
        .chain(hexahedra.flat_map(|cell| corners_of(cell, &HEXAHEDRON_EDGES)))
        .chain(triangles.flat_map(|face| corners_of(face, &TRIANGLE_EDGES)))
        .chain(surface_quads.flat_map(|face| corners_of(face, &QUAD_EDGES)));
    for (slot, [a, b]) in arena.iter_mut().zip(all) {
        *slot = [a.min(b), a.max(b)];
    }
    arena.sort_unstable();
    drop_repetitions(arena, |&[a, b]| quads.on_diagonal(a, b).is_none())
}

fn sorted_triangles<'a>(solid: &Solid<'_>, arena: &'a mut [[u32; 3]]) -> &'a [[u32; 3]] {
    for (slot, mut triangle) in arena.iter_mut().zip(prism_triangles(solid)) {
        triangle.sort_unstable();
        *slot = triangle;
    }
    arena.sort_unstable();
    arena
}
