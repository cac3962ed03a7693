//! The kinds [`REFINE`](super::REFINE) and [`REFINE_OWNED`](super::REFINE_OWNED): refine a solid
//! of tetrahedra and octahedra some levels.
//!
//! The words are those of [`super::solid`]. The results are, for each level from 1 on, the cells
//! of that level (left out where they are not needed and the memory does not hold them, or, in
//! core's own arenas, where they are not needed) and its points.

use core::mem::swap;

use heapless::Vec;
use octruss::blend::FixedBlend;
use octruss::mesh::{Arena, SolidArena};
use octruss::solid::tet_oct::{PointBuffers, Scratch, refine_points};

use super::results::{Results, Sink, Status};
use super::solid::{
    KEPT_BYTES, SolidCase, length, number, split_cells, sums_and_states, write_cells,
    write_last_cells,
};
use super::space::{Memory, Plain};
use super::{SECTION_POINTS, Words};

/// Runs a case in slices.
pub(super) fn run<S: Sink>(
    words: &[u32],
    memory: &mut Memory,
    results: &mut Results<'_, S>,
) -> Result<(), Status> {
    let mut words = Words(words);
    let case = SolidCase::read(&mut words)?;
    words.finish()?;
    let [mut keep, mut spare] = memory.split(KEPT_BYTES);
    let mut solid = case.with_surface(&mut keep, &mut spare)?;
    let mut points = case.points;
    let mut blend = FixedBlend::<i32, 3>::new();
    for level in 1..=case.levels {
        let mut scratch = spare.rest();
        let numbering = number(&solid, &mut scratch)?;
        let vertices = numbering.vertex_count();
        let out = keep.slice(Arena::OutputPoints, length(vertices), [0; 3])?;
        let (sums, states) = sums_and_states(vertices, &mut scratch)?;
        let buffers = PointBuffers {
            out: &mut *out,
            sums,
            states,
        };
        let boundary = case.boundary;
        refine_points(&mut blend, &solid, &numbering, boundary, points, buffers)
            .map_err(Status::Mesh)?;
        points = out;
        if level < case.levels {
            solid = split_cells(&solid, &numbering, &mut keep)?;
            write_cells(level, &solid, results);
        } else {
            write_last_cells(level, &solid, &numbering, &mut keep, results)?;
        }
        scratch.check()?;
        keep.check()?;
        results.section(SECTION_POINTS, &[level, blend.saturated()], points);
    }
    Ok(())
}

/// Vertices that core's own arenas hold: enough for one tetrahedron at level 3.
const OWNED_VERTICES: usize = 192;

/// Core's own arenas, smaller than the slices: enough for one tetrahedron at level 2.
struct OwnedMemory {
    solids: [SolidArena<36, 16, 72, 24, 4>; 2],
    points: [Vec<[i32; 3], OWNED_VERTICES>; 2],
    scratch: Scratch<FixedBlend<i32, 3>, 560, 16, OWNED_VERTICES>,
}

// SAFETY: vectors of numbers in place and numbers.
unsafe impl Plain for OwnedMemory {}

/// As it is before any case.
static UNUSED: OwnedMemory = OwnedMemory {
    solids: [SolidArena::new(), SolidArena::new()],
    points: [Vec::new(), Vec::new()],
    scratch: Scratch::new(),
};

/// Runs a case in core's own arenas.
pub(super) fn run_owned<S: Sink>(
    words: &[u32],
    memory: &mut Memory,
    results: &mut Results<'_, S>,
) -> Result<(), Status> {
    let mut words = Words(words);
    let case = SolidCase::read(&mut words)?;
    words.finish()?;
    let mut space = memory.space();
    let OwnedMemory {
        solids: [solid, next_solid],
        points: [points, next_points],
        scratch,
    } = space.place(&UNUSED)?;
    let mut rest = space.rest();
    if case.sheets.is_empty() {
        solid.assign(&case.solid).map_err(Status::Mesh)?;
        let needed = octruss::mesh::face_capacity(&case.solid).unwrap_or(usize::MAX);
        let faces = rest.slice(Arena::Faces, needed, [0; 3])?;
        solid.find_boundary(faces).map_err(Status::Mesh)?;
    } else {
        let [mut keep, mut spare] = rest.halves();
        let whole = case.with_surface(&mut keep, &mut spare)?;
        solid.assign(&whole).map_err(Status::Mesh)?;
    }
    points
        .extend_from_slice(case.points)
        .map_err(|_| Status::Malformed)?;
    let mut blend = FixedBlend::new();
    let (mut solid, mut next_solid) = (solid, next_solid);
    let (mut points, mut next_points) = (points, next_points);
    for level in 1..=case.levels {
        let next = (level < case.levels).then_some(&mut *next_solid);
        let view = solid.solid();
        let refined = scratch.refine(&mut blend, &view, case.boundary, points, next_points, next);
        refined.map_err(Status::Mesh)?;
        if level < case.levels {
            write_cells(level, &next_solid.solid(), results);
        }
        results.section(SECTION_POINTS, &[level, blend.saturated()], next_points);
        swap(&mut solid, &mut next_solid);
        swap(&mut points, &mut next_points);
    }
    Ok(())
}
