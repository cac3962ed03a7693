//! What the kinds that refine solids of tetrahedra and octahedra share: how a case tells its
//! solid, and refinement in buffers of exactly the lengths that core asks for.
//!
//! | words | what |
//! | --- | --- |
//! | 1 | what the boundary follows: 1 `loop`, 2 `loop-warren`, 3 `tri-quad`, 4 `interior`, 5 `fixed` |
//! | 1 | levels, at most 8 |
//! | 6 | numbers of vertices, tetrahedra, octahedra, sheet triangles, creases and corners |
//! | 4 each | tetrahedra |
//! | 6 each | octahedra |
//! | 3 each | sheet triangles |
//! | 2 each | creases |
//! | 1 each | corners |
//! | 3 each | points of the vertices, raw bits, signed |
//!
//! The surface is what core finds as the boundary of the cells, and then the sheet triangles.

use octruss::mesh::{
    Arena, Counts, MeshError, Numbering, Solid, SolidBuffers, boundary_triangles, edge_capacity,
    face_capacity,
};
use octruss::solid::tet_oct::{Boundary, VertexState, split, split_counts};
use octruss::surface::LoopWeights;

use super::results::{Results, Sink, Status};
use super::space::Space;
use super::{SECTION_CELLS, Words, summary};

/// More levels than any memory holds; an empty solid could be refined for ever.
pub(super) const LEVELS_AT_MOST: u32 = 8;

/// Bytes for what a level hands on to the next one, cells and points; the rest of the memory is
/// what a level needs for itself.
pub(super) const KEPT_BYTES: usize = 36 * 1024;

/// A solid as a case's words say it.
pub(super) struct SolidCase<'a> {
    pub boundary: Boundary,
    pub levels: u32,
    /// All but its surface.
    pub solid: Solid<'a>,
    pub sheets: &'a [[u32; 3]],
    pub points: &'a [[i32; 3]],
}

impl<'a> SolidCase<'a> {
    /// Takes the solid off the front of a case's words.
    pub fn read(words: &mut Words<'a>) -> Result<Self, Status> {
        let boundary = boundary(words.word()?)?;
        let levels = words.word()?;
        if levels > LEVELS_AT_MOST {
            return Err(Status::Malformed);
        }
        let vertices = words.length()?;
        let [tetrahedra, octahedra, sheets, creases, corners] = [
            words.length()?,
            words.length()?,
            words.length()?,
            words.length()?,
            words.length()?,
        ];
        let (tetrahedra, octahedra) = (words.elements(tetrahedra)?, words.elements(octahedra)?);
        let sheets = words.elements(sheets)?;
        let solid = Solid {
            vertex_count: u32::try_from(vertices).map_err(|_| Status::Malformed)?,
            tetrahedra,
            octahedra,
            creases: words.elements(creases)?,
            corners: words.elements::<1>(corners)?.as_flattened(),
            ..Solid::default()
        };
        let points = words.points(vertices)?;
        Ok(SolidCase {
            boundary,
            levels,
            solid,
            sheets,
            points,
        })
    }

    /// The solid with its surface: the boundary that core finds, and the sheets.
    pub fn with_surface<'s>(
        &self,
        keep: &mut Space<'s>,
        spare: &mut Space<'_>,
    ) -> Result<Solid<'s>, Status>
    where
        'a: 's,
    {
        let mut scratch = spare.rest();
        let needed = face_capacity(&self.solid).ok_or(TOO_LARGE)?;
        let faces = scratch.slice(Arena::Faces, needed, [0; 3])?;
        let boundary = boundary_triangles(&self.solid, faces).map_err(Status::Mesh)?;
        scratch.check()?;
        let count = boundary.len().saturating_add(self.sheets.len());
        let surface = keep.slice(Arena::SurfaceTriangles, count, [0; 3])?;
        let triangles = boundary.iter().chain(self.sheets);
        for (slot, triangle) in surface.iter_mut().zip(triangles) {
            *slot = *triangle;
        }
        Ok(Solid {
            surface,
            ..self.solid
        })
    }
}

fn boundary(word: u32) -> Result<Boundary, Status> {
    Ok(match word {
        1 => Boundary::Surface(LoopWeights::Loop),
        2 => Boundary::Surface(LoopWeights::Warren),
        3 => Boundary::Surface(LoopWeights::TriQuad),
        4 => Boundary::Interior,
        5 => Boundary::Fixed,
        _ => return Err(Status::Malformed),
    })
}

/// Core's answer to numbers that no memory holds.
pub(super) const TOO_LARGE: Status = Status::Mesh(MeshError::TooLarge);

/// Numbers the vertices of a split.
pub(super) fn number<'s>(
    solid: &Solid<'_>,
    scratch: &mut Space<'s>,
) -> Result<Numbering<'s>, Status> {
    let edges_needed = edge_capacity(solid).ok_or(TOO_LARGE)?;
    let edges = scratch.slice(Arena::Edges, edges_needed, [0; 2])?;
    let order = scratch.slice(Arena::OctahedronOrder, solid.octahedra.len(), 0)?;
    Numbering::new(solid, edges, order).map_err(Status::Mesh)
}

/// Splits the cells.
pub(super) fn split_cells<'s>(
    solid: &Solid<'_>,
    numbering: &Numbering<'_>,
    keep: &mut Space<'s>,
) -> Result<Solid<'s>, Status> {
    let Counts {
        tetrahedra,
        octahedra,
        surface,
        creases,
        corners,
        ..
    } = split_counts(solid, numbering).ok_or(TOO_LARGE)?;
    let buffers = SolidBuffers {
        tetrahedra: keep.slice(Arena::Tetrahedra, tetrahedra, [0; 4])?,
        octahedra: keep.slice(Arena::Octahedra, octahedra, [0; 6])?,
        surface: keep.slice(Arena::SurfaceTriangles, surface, [0; 3])?,
        creases: keep.slice(Arena::Creases, creases, [0; 2])?,
        corners: keep.slice(Arena::Corners, corners, 0)?,
    };
    split(solid, numbering, buffers).map_err(Status::Mesh)
}

/// Sums and states of the refined vertices.
pub(super) type SumsAndStates<'s> = (&'s mut [[i64; 3]], &'s mut [VertexState]);

/// Lends what the values of a level need.
pub(super) fn sums_and_states<'s>(
    vertices: u32,
    scratch: &mut Space<'s>,
) -> Result<SumsAndStates<'s>, Status> {
    let vertices = length(vertices);
    Ok((
        scratch.slice(Arena::Sums, vertices, [0; 3])?,
        scratch.slice(Arena::States, vertices, VertexState::default())?,
    ))
}

/// A number of vertices as a length.
pub(super) fn length(vertices: u32) -> usize {
    usize::try_from(vertices).unwrap_or(usize::MAX)
}

/// Writes the cells of the last level if the memory holds them: nothing else needs them.
pub(super) fn write_last_cells<S: Sink>(
    level: u32,
    solid: &Solid<'_>,
    numbering: &Numbering<'_>,
    keep: &mut Space<'_>,
    results: &mut Results<'_, S>,
) -> Result<(), Status> {
    let mut rest = keep.rest();
    match split_cells(solid, numbering, &mut rest) {
        Ok(cells) => write_cells(level, &cells, results),
        Err(Status::Mesh(MeshError::ArenaTooSmall { .. })) => {}
        Err(error) => return Err(error),
    }
    rest.check()
}

/// Writes how many cells of each kind a level has, and a checksum of each list.
pub(super) fn write_cells<S: Sink>(level: u32, solid: &Solid<'_>, results: &mut Results<'_, S>) {
    let lists = [
        summary(solid.tetrahedra),
        summary(solid.octahedra),
        summary(solid.surface),
        summary(solid.creases),
        summary(solid.corners),
    ];
    let mut words = [level; 11];
    for (place, word) in words.iter_mut().skip(1).zip(lists.as_flattened()) {
        *place = *word;
    }
    results.section(SECTION_CELLS, &words, &[]);
}
