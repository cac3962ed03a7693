//! The linear split's connectivity (section 5.3, figure 5.4).

use super::masks::{HEXAHEDRON_HEXAHEDRA, HEXAHEDRON_VERTICES, PRISM_PRISMS, PRISM_VERTICES};
use crate::mesh::{
    Arena, HEXAHEDRON_EDGES, HEXAHEDRON_QUADS, MeshError, MixedNumbering, OCTAHEDRON_EDGES,
    PRISM_EDGES, PRISM_QUADS, Solid, TETRAHEDRON_EDGES, require,
};
use crate::solid::tet_oct::masks::{
    OCTAHEDRON_OCTAHEDRA, OCTAHEDRON_TETRAHEDRA, OCTAHEDRON_VERTICES, TETRAHEDRON_OCTAHEDRA,
    TETRAHEDRON_TETRAHEDRA, TETRAHEDRON_VERTICES,
};

/// Numbers of elements of a mixed solid: how long its lists are or must be.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct MixedCounts {
    /// Vertices.
    pub vertices: usize,
    /// Tetrahedra.
    pub tetrahedra: usize,
    /// Octahedra.
    pub octahedra: usize,
    /// Prisms.
    pub prisms: usize,
    /// Hexahedra.
    pub hexahedra: usize,
    /// Surface triangles.
    pub surface: usize,
    /// Surface quadrilaterals.
    pub surface_quads: usize,
    /// Crease edges.
    pub creases: usize,
    /// Corners.
    pub corners: usize,
}

impl MixedCounts {
    /// Numbers of elements of a solid.
    #[must_use]
    pub fn of(solid: &Solid<'_>) -> Self {
        Self {
            vertices: usize::try_from(solid.vertex_count).unwrap_or(usize::MAX),
            tetrahedra: solid.tetrahedra.len(),
            octahedra: solid.octahedra.len(),
            prisms: solid.prisms.len(),
            hexahedra: solid.hexahedra.len(),
            surface: solid.surface.len(),
            surface_quads: solid.surface_quads.len(),
            creases: solid.creases.len(),
            corners: solid.corners.len(),
        }
    }
}

/// Where the lists of a refined mixed solid are written, at least as long as [`split_counts`] says.
#[derive(Debug, Default)]
pub struct MixedBuffers<'a> {
    /// Tetrahedra.
    pub tetrahedra: &'a mut [[u32; 4]],
    /// Octahedra.
    pub octahedra: &'a mut [[u32; 6]],
    /// Prisms.
    pub prisms: &'a mut [[u32; 6]],
    /// Hexahedra.
    pub hexahedra: &'a mut [[u32; 8]],
    /// Surface triangles.
    pub surface: &'a mut [[u32; 3]],
    /// Surface quadrilaterals.
    pub surface_quads: &'a mut [[u32; 4]],
    /// Crease edges.
    pub creases: &'a mut [[u32; 2]],
    /// Corners.
    pub corners: &'a mut [u32],
}

/// Numbers of elements that the split of `solid` has, `None` where one does not fit.
#[must_use]
pub fn split_counts(solid: &Solid<'_>, numbering: &MixedNumbering<'_>) -> Option<MixedCounts> {
    let of = MixedCounts::of(solid);
    let open = solid
        .surface
        .iter()
        .filter(|&&triangle| numbering.quads().open_half(triangle).is_some())
        .count();
    let twice = |count: usize| count.checked_mul(2);
    Some(MixedCounts {
        vertices: usize::try_from(numbering.vertex_count()).ok()?,
        tetrahedra: weighted(4, of.tetrahedra, 8, of.octahedra)?,
        octahedra: weighted(1, of.tetrahedra, 6, of.octahedra)?,
        prisms: of.prisms.checked_mul(8)?,
        hexahedra: of.hexahedra.checked_mul(8)?,
        surface: weighted(4, of.surface, 0, 0)?.checked_sub(twice(open)?)?,
        surface_quads: weighted(4, of.surface_quads, 1, open)?,
        creases: twice(of.creases)?,
        corners: of.corners,
    })
}

fn weighted(first: usize, one: usize, second: usize, two: usize) -> Option<usize> {
    first
        .checked_mul(one)?
        .checked_add(second.checked_mul(two)?)
}

/// Splits every cell and writes the cells, surface faces, crease edges and corners of the next
/// level into `buffers`, of which it returns the filled part.
///
/// Children come in the order of their parents: tetrahedra of tetrahedra (four each), then
/// tetrahedra of octahedra (eight each); octahedra of tetrahedra (one each), then of octahedra (six
/// each); eight prisms of each prism, the lower four first; eight hexahedra of each hexahedron, child
/// `i` at corner `i`. So labels of cells can be handed on by position.
///
/// A surface triangle `(a, b, c)` becomes `(a, ab, ca) (ab, b, bc) (ca, bc, c) (ab, bc, ca)`, a
/// surface quadrilateral four, each at its corner. A surface triangle that is the open half of a
/// covered quadrilateral, with the diagonal `a b`, becomes what is open of the four quadrilaterals
/// below it: the triangles `(a, ab, ca) (ab, b, bc)` and the quadrilateral `(ca, ab, bc, c)`; those
/// quadrilaterals come after the others. So the surface of a solid that is its boundary is the
/// boundary at every level. A crease edge becomes its halves, and corners stay.
///
/// `numbering` must be of the same solid.
///
/// # Errors
///
/// [`MeshError::ArenaTooSmall`] before anything is written; [`MeshError::OtherNumbering`] if the
/// numbering is seen to be of another solid.
pub fn split<'a>(
    solid: &Solid<'_>,
    numbering: &MixedNumbering<'_>,
    buffers: MixedBuffers<'a>,
) -> Result<Solid<'a>, MeshError> {
    let counts = split_counts(solid, numbering).ok_or(MeshError::TooLarge)?;
    let buffers = buffers.cut(&counts)?;
    let mut write = Write {
        solid,
        numbering,
        buffers,
    };
    write.tetrahedral().ok_or(MeshError::OtherNumbering)?;
    write
        .prisms_and_hexahedra()
        .ok_or(MeshError::OtherNumbering)?;
    write.surface().ok_or(MeshError::OtherNumbering)?;
    write.creases().ok_or(MeshError::OtherNumbering)?;
    let buffers = write.buffers;
    Ok(Solid {
        vertex_count: numbering.vertex_count(),
        tetrahedra: buffers.tetrahedra,
        octahedra: buffers.octahedra,
        prisms: buffers.prisms,
        hexahedra: buffers.hexahedra,
        surface: buffers.surface,
        surface_quads: buffers.surface_quads,
        creases: buffers.creases,
        corners: buffers.corners,
    })
}

impl<'a> MixedBuffers<'a> {
    /// Cuts every list to its length, or says which one is too short.
    fn cut(self, counts: &MixedCounts) -> Result<Self, MeshError> {
        let needed = [
            (Arena::Tetrahedra, counts.tetrahedra, self.tetrahedra.len()),
            (Arena::Octahedra, counts.octahedra, self.octahedra.len()),
            (Arena::Prisms, counts.prisms, self.prisms.len()),
            (Arena::Hexahedra, counts.hexahedra, self.hexahedra.len()),
            (Arena::SurfaceTriangles, counts.surface, self.surface.len()),
            (
                Arena::SurfaceQuads,
                counts.surface_quads,
                self.surface_quads.len(),
            ),
            (Arena::Creases, counts.creases, self.creases.len()),
            (Arena::Corners, counts.corners, self.corners.len()),
        ];
        for (arena, needed, given) in needed {
            require(arena, needed, given)?;
        }
        Ok(Self {
            tetrahedra: front(self.tetrahedra, counts.tetrahedra),
            octahedra: front(self.octahedra, counts.octahedra),
            prisms: front(self.prisms, counts.prisms),
            hexahedra: front(self.hexahedra, counts.hexahedra),
            surface: front(self.surface, counts.surface),
            surface_quads: front(self.surface_quads, counts.surface_quads),
            creases: front(self.creases, counts.creases),
            corners: front(self.corners, counts.corners),
        })
    }
}

fn front<T>(list: &mut [T], count: usize) -> &mut [T] {
    list.get_mut(..count).unwrap_or_default()
}

/// The refined vertices of a cell in local order: corners, midpoints of edges, middles of
/// quadrilaterals, and the centroid if there is one. `None` if one is not numbered.
pub(super) fn local_vertices<const CORNERS: usize, const VERTICES: usize>(
    cell: &[u32; CORNERS],
    edges: &[[usize; 2]],
    quads: &[[usize; 4]],
    centroid: Option<u32>,
    numbering: &MixedNumbering<'_>,
) -> Option<[u32; VERTICES]> {
    let corner = |place: usize| cell.get(place).copied();
    let mut vertices = [0; VERTICES];
    let mut slots = vertices.iter_mut();
    // The cell's list leads, so that it ends before a slot is taken that the next part needs.
    for (&vertex, slot) in cell.iter().zip(slots.by_ref()) {
        *slot = vertex;
    }
    for (&[a, b], slot) in edges.iter().zip(slots.by_ref()) {
        *slot = numbering.midpoint(corner(a)?, corner(b)?)?;
    }
    for (&[a, b, c, d], slot) in quads.iter().zip(slots.by_ref()) {
        *slot = numbering.quad_middle([corner(a)?, corner(b)?, corner(c)?, corner(d)?])?;
    }
    for (centroid, slot) in centroid.into_iter().zip(slots) {
        *slot = centroid;
    }
    Some(vertices)
}

pub(super) fn tetrahedron_vertices(
    cell: &[u32; 4],
    numbering: &MixedNumbering<'_>,
) -> Option<[u32; TETRAHEDRON_VERTICES]> {
    local_vertices(cell, &TETRAHEDRON_EDGES, &[], None, numbering)
}

pub(super) fn octahedron_vertices(
    cell: &[u32; 6],
    centroid: u32,
    numbering: &MixedNumbering<'_>,
) -> Option<[u32; OCTAHEDRON_VERTICES]> {
    local_vertices(cell, &OCTAHEDRON_EDGES, &[], Some(centroid), numbering)
}

pub(super) fn prism_vertices(
    cell: &[u32; 6],
    numbering: &MixedNumbering<'_>,
) -> Option<[u32; PRISM_VERTICES]> {
    local_vertices(cell, &PRISM_EDGES, &PRISM_QUADS, None, numbering)
}

pub(super) fn hexahedron_vertices(
    cell: &[u32; 8],
    centroid: u32,
    numbering: &MixedNumbering<'_>,
) -> Option<[u32; HEXAHEDRON_VERTICES]> {
    let centroid = Some(centroid);
    local_vertices(
        cell,
        &HEXAHEDRON_EDGES,
        &HEXAHEDRON_QUADS,
        centroid,
        numbering,
    )
}

/// A split while it is written.
struct Write<'s, 'a> {
    solid: &'s Solid<'s>,
    numbering: &'s MixedNumbering<'s>,
    buffers: MixedBuffers<'a>,
}

impl Write<'_, '_> {
    fn tetrahedral(&mut self) -> Option<()> {
        let parents = self.solid.tetrahedra.len();
        let (small, face) = self
            .buffers
            .tetrahedra
            .split_at_mut_checked(parents.checked_mul(4)?)?;
        let (middle, corner) = self.buffers.octahedra.split_at_mut_checked(parents)?;
        let children = small.chunks_exact_mut(4).zip(middle.chunks_exact_mut(1));
        for (cell, (small, middle)) in self.solid.tetrahedra.iter().zip(children) {
            let vertices = tetrahedron_vertices(cell, self.numbering)?;
            write_children(&vertices, &TETRAHEDRON_TETRAHEDRA, small);
            write_children(&vertices, &TETRAHEDRON_OCTAHEDRA, middle);
        }
        for (place, centroid) in self.numbering.octahedra() {
            let cell = self.solid.octahedra.get(place)?;
            let vertices = octahedron_vertices(cell, centroid, self.numbering)?;
            let face = face.chunks_exact_mut(8).nth(place)?;
            write_children(&vertices, &OCTAHEDRON_TETRAHEDRA, face);
            let corner = corner.chunks_exact_mut(6).nth(place)?;
            write_children(&vertices, &OCTAHEDRON_OCTAHEDRA, corner);
        }
        Some(())
    }

    fn prisms_and_hexahedra(&mut self) -> Option<()> {
        let children = self.buffers.prisms.chunks_exact_mut(8);
        for (cell, children) in self.solid.prisms.iter().zip(children) {
            let vertices = prism_vertices(cell, self.numbering)?;
            write_children(&vertices, &PRISM_PRISMS, children);
        }
        for (place, centroid) in self.numbering.hexahedra() {
            let cell = self.solid.hexahedra.get(place)?;
            let vertices = hexahedron_vertices(cell, centroid, self.numbering)?;
            let children = self.buffers.hexahedra.chunks_exact_mut(8).nth(place)?;
            write_children(&vertices, &HEXAHEDRON_HEXAHEDRA, children);
        }
        Some(())
    }

    fn surface(&mut self) -> Option<()> {
        let middle = |a, b| self.numbering.midpoint(a, b);
        let mut triangles = self.buffers.surface.iter_mut();
        let (closed, open) = self
            .buffers
            .surface_quads
            .split_at_mut_checked(self.solid.surface_quads.len().checked_mul(4)?)?;
        let mut open = open.iter_mut();
        for &triangle in self.solid.surface {
            let half = self.numbering.quads().open_half(triangle);
            let [a, b, c] = half.unwrap_or(triangle);
            let (ab, bc, ca) = (middle(a, b)?, middle(b, c)?, middle(c, a)?);
            *triangles.next()? = [a, ab, ca];
            *triangles.next()? = [ab, b, bc];
            if half.is_some() {
                *open.next()? = [ca, ab, bc, c];
            } else {
                *triangles.next()? = [ca, bc, c];
                *triangles.next()? = [ab, bc, ca];
            }
        }
        let children = closed.chunks_exact_mut(4);
        for (&[a, b, c, d], children) in self.solid.surface_quads.iter().zip(children) {
            let (ab, bc, cd, da) = (middle(a, b)?, middle(b, c)?, middle(c, d)?, middle(d, a)?);
            let face = self.numbering.quad_middle([a, b, c, d])?;
            let four = [
                [a, ab, face, da],
                [ab, b, bc, face],
                [face, bc, c, cd],
                [da, face, cd, d],
            ];
            for (slot, child) in children.iter_mut().zip(four) {
                *slot = child;
            }
        }
        Some(())
    }

    fn creases(&mut self) -> Option<()> {
        let halves = self.buffers.creases.chunks_exact_mut(2);
        for (&[a, b], halves) in self.solid.creases.iter().zip(halves) {
            let middle = self.numbering.midpoint(a, b)?;
            for (slot, half) in halves.iter_mut().zip([[a, middle], [middle, b]]) {
                *slot = half;
            }
        }
        for (slot, &corner) in self.buffers.corners.iter_mut().zip(self.solid.corners) {
            *slot = corner;
        }
        Some(())
    }
}

fn write_children<const N: usize>(vertices: &[u32], local: &[[usize; N]], to: &mut [[u32; N]]) {
    for (slot, child) in to.iter_mut().zip(local) {
        *slot = child.map(|corner| vertices.get(corner).copied().unwrap_or_default());
    }
}
