//! The linear split's connectivity (section 2.1).

use super::masks::{
    CENTROID, OCTAHEDRON_OCTAHEDRA, OCTAHEDRON_TETRAHEDRA, OCTAHEDRON_VERTICES,
    TETRAHEDRON_OCTAHEDRA, TETRAHEDRON_TETRAHEDRA, TETRAHEDRON_VERTICES,
};
use crate::mesh::{
    Arena, Counts, MeshError, Numbering, OCTAHEDRON_EDGES, Solid, SolidBuffers, TETRAHEDRON_EDGES,
    require,
};

/// Number of elements that the split of `solid` has, `None` where one does not fit.
///
/// `edges` and `faces` of the result are not known without counting the solid's faces and are 0;
/// [`Counts::refined`] predicts them level by level.
#[must_use]
pub fn split_counts(solid: &Solid<'_>, numbering: &Numbering<'_>) -> Option<Counts> {
    let counts = Counts {
        tetrahedra: solid.tetrahedra.len(),
        octahedra: solid.octahedra.len(),
        surface: solid.surface.len(),
        creases: solid.creases.len(),
        corners: solid.corners.len(),
        ..Counts::default()
    };
    Some(Counts {
        vertices: usize::try_from(numbering.vertex_count()).ok()?,
        edges: 0,
        faces: 0,
        ..counts.refined()?
    })
}

/// Splits every cell and writes the cells, surface triangles, crease edges and corners of the
/// next level into `buffers`, of which it returns the filled part.
///
/// Children come in the order of their parents: tetrahedra of tetrahedra (four each), then
/// tetrahedra of octahedra (eight each); octahedra of tetrahedra (one each), then octahedra of
/// octahedra (six each); so labels of cells can be handed on by position. A surface triangle
/// `(a, b, c)` becomes `(a, ab, ca) (ab, b, bc) (ca, bc, c) (ab, bc, ca)`, a crease edge its two
/// halves, and corners stay.
///
/// `numbering` must be of the same solid.
///
/// # Errors
///
/// [`MeshError::ArenaTooSmall`] before anything is written; [`MeshError::OtherNumbering`] if the
/// numbering is seen to be of another solid.
pub fn split<'a>(
    solid: &Solid<'_>,
    numbering: &Numbering<'_>,
    buffers: SolidBuffers<'a>,
) -> Result<Solid<'a>, MeshError> {
    let counts = split_counts(solid, numbering).ok_or(MeshError::TooLarge)?;
    require(
        Arena::Tetrahedra,
        counts.tetrahedra,
        buffers.tetrahedra.len(),
    )?;
    require(Arena::Octahedra, counts.octahedra, buffers.octahedra.len())?;
    require(
        Arena::SurfaceTriangles,
        counts.surface,
        buffers.surface.len(),
    )?;
    require(Arena::Creases, counts.creases, buffers.creases.len())?;
    require(Arena::Corners, counts.corners, buffers.corners.len())?;

    let tetrahedra = buffers
        .tetrahedra
        .get_mut(..counts.tetrahedra)
        .unwrap_or_default();
    let octahedra = buffers
        .octahedra
        .get_mut(..counts.octahedra)
        .unwrap_or_default();
    let surface = buffers
        .surface
        .get_mut(..counts.surface)
        .unwrap_or_default();
    let creases = buffers
        .creases
        .get_mut(..counts.creases)
        .unwrap_or_default();
    let corners = buffers
        .corners
        .get_mut(..counts.corners)
        .unwrap_or_default();

    split_cells(solid, numbering, tetrahedra, octahedra)?;
    split_surface(solid, numbering, surface)?;
    split_creases(solid, numbering, creases)?;
    corners.copy_from_slice(solid.corners);
    Ok(Solid {
        vertex_count: numbering.vertex_count(),
        tetrahedra,
        octahedra,
        surface,
        creases,
        corners,
        ..Solid::default()
    })
}

/// The refined vertices of a tetrahedron in local order, `None` if an edge is not numbered.
pub(super) fn tetrahedron_vertices(
    cell: &[u32; 4],
    numbering: &Numbering<'_>,
) -> Option<[u32; TETRAHEDRON_VERTICES]> {
    local_vertices(cell, &TETRAHEDRON_EDGES, numbering)
}

/// The refined vertices of an octahedron in local order, `None` if an edge is not numbered.
pub(super) fn octahedron_vertices(
    cell: &[u32; 6],
    centroid: u32,
    numbering: &Numbering<'_>,
) -> Option<[u32; OCTAHEDRON_VERTICES]> {
    let mut vertices = local_vertices(cell, &OCTAHEDRON_EDGES, numbering)?;
    *vertices.get_mut(CENTROID)? = centroid;
    Some(vertices)
}

fn local_vertices<const CORNERS: usize, const VERTICES: usize>(
    cell: &[u32; CORNERS],
    edges: &[[usize; 2]],
    numbering: &Numbering<'_>,
) -> Option<[u32; VERTICES]> {
    let mut vertices = [0; VERTICES];
    let (corners, middles) = vertices.split_at_mut_checked(CORNERS)?;
    corners.copy_from_slice(cell);
    for (slot, &[a, b]) in middles.iter_mut().zip(edges) {
        *slot = numbering.midpoint(*cell.get(a)?, *cell.get(b)?)?;
    }
    Some(vertices)
}

fn split_cells(
    solid: &Solid<'_>,
    numbering: &Numbering<'_>,
    tetrahedra: &mut [[u32; 4]],
    octahedra: &mut [[u32; 6]],
) -> Result<(), MeshError> {
    let (tetrahedra_tet, tetrahedra_oct) = halves(tetrahedra, solid.tetrahedra.len(), 4)?;
    let (octahedra_tet, octahedra_oct) = halves(octahedra, solid.tetrahedra.len(), 1)?;

    let children = tetrahedra_tet
        .chunks_exact_mut(4)
        .zip(octahedra_tet.chunks_exact_mut(1));
    for (cell, (small, middle)) in solid.tetrahedra.iter().zip(children) {
        let vertices = tetrahedron_vertices(cell, numbering).ok_or(MeshError::OtherNumbering)?;
        write_children(&vertices, &TETRAHEDRON_TETRAHEDRA, small);
        write_children(&vertices, &TETRAHEDRON_OCTAHEDRA, middle);
    }
    for (place, centroid) in numbering.centroids() {
        let cell = solid
            .octahedra
            .get(place)
            .ok_or(MeshError::OtherNumbering)?;
        let vertices =
            octahedron_vertices(cell, centroid, numbering).ok_or(MeshError::OtherNumbering)?;
        let faces = tetrahedra_oct
            .chunks_exact_mut(8)
            .nth(place)
            .unwrap_or_default();
        write_children(&vertices, &OCTAHEDRON_TETRAHEDRA, faces);
        let corners = octahedra_oct
            .chunks_exact_mut(6)
            .nth(place)
            .unwrap_or_default();
        write_children(&vertices, &OCTAHEDRON_OCTAHEDRA, corners);
    }
    Ok(())
}

/// Parts the children of tetrahedra from those of octahedra.
#[expect(clippy::type_complexity, reason = "two halves of one slice")]
fn halves<const N: usize>(
    children: &mut [[u32; N]],
    parents: usize,
    each: usize,
) -> Result<(&mut [[u32; N]], &mut [[u32; N]]), MeshError> {
    parents
        .checked_mul(each)
        .and_then(|middle| children.split_at_mut_checked(middle))
        .ok_or(MeshError::OtherNumbering)
}

fn write_children<const N: usize>(vertices: &[u32], local: &[[usize; N]], to: &mut [[u32; N]]) {
    for (slot, child) in to.iter_mut().zip(local) {
        *slot = child.map(|corner| vertices.get(corner).copied().unwrap_or_default());
    }
}

fn split_surface(
    solid: &Solid<'_>,
    numbering: &Numbering<'_>,
    surface: &mut [[u32; 3]],
) -> Result<(), MeshError> {
    let middle = |a, b| numbering.midpoint(a, b).ok_or(MeshError::OtherNumbering);
    for (&[a, b, c], children) in solid.surface.iter().zip(surface.chunks_exact_mut(4)) {
        let (ab, bc, ca) = (middle(a, b)?, middle(b, c)?, middle(c, a)?);
        children.copy_from_slice(&[[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
    }
    Ok(())
}

fn split_creases(
    solid: &Solid<'_>,
    numbering: &Numbering<'_>,
    creases: &mut [[u32; 2]],
) -> Result<(), MeshError> {
    for (&[a, b], halves) in solid.creases.iter().zip(creases.chunks_exact_mut(2)) {
        let middle = numbering.midpoint(a, b).ok_or(MeshError::OtherNumbering)?;
        halves.copy_from_slice(&[[a, middle], [middle, b]]);
    }
    Ok(())
}
