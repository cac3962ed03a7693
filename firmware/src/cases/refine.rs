//! The kinds [`REFINE`](super::REFINE) and [`REFINE_OWNED`](super::REFINE_OWNED): refine a solid
//! of tetrahedra and octahedra some levels.
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
//! The surface is what core finds as the boundary of the cells, and then the sheet triangles. The results are, for each level
//! from 1 on, the cells of that level (left out where they are not needed and the memory does not
//! hold them, or, in core's own arenas, where they are not needed) and its points.

use core::mem::swap;

use octruss::blend::FixedBlend;
use octruss::mesh::{
    Arena, MeshError, Numbering, Solid, boundary_triangles, edge_capacity, face_capacity,
};
use octruss::solid::tet_oct::{
    Boundary, PointBuffers, VertexState, refine_points, split, split_counts,
};
use octruss::surface::LoopWeights;
use zerocopy::{Immutable, IntoBytes};

use super::guard::lend;
use super::memory::{OwnedMemory, RefineMemory, Surface, VERTICES};
use super::results::{Results, Sink, Status};
use super::{CHECKSUM, SECTION_CELLS, SECTION_POINTS, Words};

/// More levels than any memory holds; an empty solid could be refined for ever.
const LEVELS_AT_MOST: u32 = 8;

/// A case as its words say it.
struct Case<'a> {
    boundary: Boundary,
    levels: u32,
    /// All but its surface.
    solid: Solid<'a>,
    sheets: &'a [[u32; 3]],
    points: &'a [[i32; 3]],
}

impl<'a> Case<'a> {
    fn read(words: &'a [u32]) -> Result<Self, Status> {
        let mut words = Words(words);
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
        words.finish()?;
        Ok(Case {
            boundary,
            levels,
            solid,
            sheets,
            points,
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

/// Runs a case in slices.
pub(super) fn run<S: Sink>(
    words: &[u32],
    memory: &mut RefineMemory,
    results: &mut Results<'_, S>,
) -> Result<(), Status> {
    let case = Case::read(words)?;
    memory.surface.clear();
    find_surface(&case, &mut memory.faces, &mut memory.surface)?;
    let first = Solid {
        surface: &memory.surface,
        ..case.solid
    };
    // It grows to its capacity, so this is never refused.
    let _ = memory.states.resize_default(VERTICES);
    let mut values = Values {
        blend: FixedBlend::new(),
        boundary: case.boundary,
        sums: &mut memory.sums,
        states: &mut memory.states,
    };
    // Two sets of buffers take turns: a level is read from one and written to the other. They are
    // dealt so that the last level's points, and the cells before it, meet the large ones.
    let (mut cells, mut next_cells) = (memory.cells_large.slices(), memory.cells_small.slices());
    let (mut points, mut next_points) = (
        memory.points_small.as_mut_slice(),
        memory.points_large.as_mut_slice(),
    );
    if case.levels.is_multiple_of(2) {
        swap(&mut cells, &mut next_cells);
        swap(&mut points, &mut next_points);
    }
    let mut count = 0;
    for level in 1..=case.levels {
        let (solid, before) = match level {
            1 => (first, case.points),
            _ => (cells.solid(), points.get(..count).unwrap_or_default()),
        };
        let is_last = level == case.levels;
        let numbering = number(&solid, &mut memory.edges, &mut memory.octahedron_order)?;
        let counts = split_counts(&solid, &numbering).ok_or(Status::Mesh(MeshError::TooLarge))?;
        if !is_last || next_cells.holds(&counts) {
            next_cells.fill(counts, CELL_BUFFERS, |buffers| {
                let done = split(&solid, &numbering, buffers);
                done.map(|_| ()).map_err(Status::Mesh)
            })?;
            write_cells(level, &next_cells.solid(), results);
        }
        count = values.refine(&solid, &numbering, before, next_points)?;
        let refined = next_points.get(..count).unwrap_or_default();
        results.section(SECTION_POINTS, &[level, values.blend.saturated()], refined);
        swap(&mut cells, &mut next_cells);
        swap(&mut points, &mut next_points);
    }
    Ok(())
}

/// Finds the boundary in exactly the memory that is needed, and collects it and the sheets.
fn find_surface(
    case: &Case<'_>,
    faces: &mut [[u32; 3]],
    surface: &mut Surface,
) -> Result<(), Status> {
    let faces_needed = face_capacity(&case.solid).ok_or(Status::Mesh(MeshError::TooLarge))?;
    let (faces, behind_faces) = lend(faces, faces_needed);
    let boundary = boundary_triangles(&case.solid, faces).map_err(Status::Mesh)?;
    behind_faces.check(0)?;
    for triangles in [boundary, case.sheets] {
        surface.extend_from_slice(triangles).map_err(|_| {
            Status::Mesh(MeshError::ArenaTooSmall {
                arena: Arena::SurfaceTriangles,
                needed: boundary.len().saturating_add(case.sheets.len()),
                given: surface.capacity(),
            })
        })?;
    }
    Ok(())
}

/// The first of the five numbers of the cells' buffers; those before are the faces' (0), the
/// edges' (1) and the octahedron order's (2).
const CELL_BUFFERS: u32 = 3;
/// The number of the points' buffer.
const POINT_BUFFER: u32 = 8;
/// The number of the sums' buffer.
const SUM_BUFFER: u32 = 9;

/// Numbers the vertices of a split in exactly the memory that is needed.
fn number<'a>(
    solid: &Solid<'_>,
    edges: &'a mut [[u32; 2]],
    octahedron_order: &'a mut [u32],
) -> Result<Numbering<'a>, Status> {
    let edges_needed = edge_capacity(solid).ok_or(Status::Mesh(MeshError::TooLarge))?;
    let (edges, behind_edges) = lend(edges, edges_needed);
    let (order, behind_order) = lend(octahedron_order, solid.octahedra.len());
    let numbering = Numbering::new(solid, edges, order).map_err(Status::Mesh)?;
    behind_edges.check(1)?;
    behind_order.check(2)?;
    Ok(numbering)
}

/// What the values of one level after the other need.
struct Values<'a> {
    blend: FixedBlend<i32, 3>,
    boundary: Boundary,
    sums: &'a mut [[i64; 3]],
    states: &'a mut [VertexState],
}

impl Values<'_> {
    /// Refines the points `before` in exactly the memory that is needed; returns how many are
    /// then at the front of `out`.
    fn refine(
        &mut self,
        solid: &Solid<'_>,
        numbering: &Numbering<'_>,
        before: &[[i32; 3]],
        out: &mut [[i32; 3]],
    ) -> Result<usize, Status> {
        let vertices = usize::try_from(numbering.vertex_count()).unwrap_or(usize::MAX);
        let (out, behind_out) = lend(out, vertices);
        let (sums, behind_sums) = lend(self.sums, vertices);
        let states = vertices.min(self.states.len());
        let buffers = PointBuffers {
            out,
            sums,
            states: self.states.get_mut(..states).unwrap_or_default(),
        };
        let boundary = self.boundary;
        let refined = refine_points(&mut self.blend, solid, numbering, boundary, before, buffers)
            .map_err(Status::Mesh)?
            .len();
        behind_out.check(POINT_BUFFER)?;
        behind_sums.check(SUM_BUFFER)?;
        Ok(refined)
    }
}

/// Runs a case in core's own arenas.
pub(super) fn run_owned<S: Sink>(
    words: &[u32],
    memory: &mut OwnedMemory,
    results: &mut Results<'_, S>,
) -> Result<(), Status> {
    let case = Case::read(words)?;
    let [solid, next_solid] = &mut memory.solids;
    let [points, next_points] = &mut memory.points;
    if case.sheets.is_empty() {
        solid.assign(&case.solid).map_err(Status::Mesh)?;
        let found = solid.find_boundary(&mut memory.faces);
        found.map_err(Status::Mesh)?;
    } else {
        memory.surface.clear();
        find_surface(&case, &mut memory.faces, &mut memory.surface)?;
        let whole = Solid {
            surface: &memory.surface,
            ..case.solid
        };
        solid.assign(&whole).map_err(Status::Mesh)?;
    }
    points.clear();
    points
        .extend_from_slice(case.points)
        .map_err(|_| Status::Malformed)?;
    let mut blend = FixedBlend::new();
    for level in 1..=case.levels {
        let next = (level < case.levels).then_some(&mut *next_solid);
        let (boundary, scratch) = (case.boundary, &mut memory.scratch);
        scratch
            .refine(
                &mut blend,
                &solid.solid(),
                boundary,
                points,
                next_points,
                next,
            )
            .map_err(Status::Mesh)?;
        if level < case.levels {
            write_cells(level, &next_solid.solid(), results);
        }
        results.section(SECTION_POINTS, &[level, blend.saturated()], next_points);
        swap(solid, next_solid);
        swap(points, next_points);
    }
    Ok(())
}

/// Writes how many cells of each kind a level has, and a checksum of each list.
fn write_cells<S: Sink>(level: u32, solid: &Solid<'_>, results: &mut Results<'_, S>) {
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

/// The length of a list and the checksum of its bytes.
fn summary<Element: IntoBytes + Immutable>(list: &[Element]) -> [u32; 2] {
    let length = u32::try_from(list.len()).unwrap_or(u32::MAX);
    [length, CHECKSUM.checksum(list.as_bytes())]
}
