//! The kind [`REFINE_DATA`](super::REFINE_DATA): refine scalar channels of a solid of tetrahedra and
//! octahedra some levels, and hand the labels of its cells on.
//!
//! Behind the words of [`super::solid`], whose points are not looked at:
//!
//! | words | what |
//! | --- | --- |
//! | [`CHANNELS`] each | values of the vertices, raw bits, signed |
//! | 1 each | labels of the tetrahedra |
//! | 1 each | labels of the octahedra |
//!
//! The results are, for each level from 1 on, the values and the labels of that level.

use octruss::blend::FixedBlend;
use octruss::mesh::{Arena, Numbering, Solid};
use octruss::solid::tet_oct::{Boundary, PointBuffers, VertexState, refine_points};
use octruss::solid::{CellLabels, LabelBuffers, split_labels};

use super::results::{Results, Sink, Status};
use super::solid::{KEPT_BYTES, SolidCase, TOO_LARGE, length, number, split_cells};
use super::space::{Memory, Space};
use super::{SECTION_CHANNELS, SECTION_LABELS, Words};

/// Scalar channels of a case.
pub const CHANNELS: usize = 2;

/// Runs a case.
pub(super) fn run<S: Sink>(
    words: &[u32],
    memory: &mut Memory,
    results: &mut Results<'_, S>,
) -> Result<(), Status> {
    let mut words = Words(words);
    let case = SolidCase::read(&mut words)?;
    let mut channels = words.values::<CHANNELS>(case.points.len())?;
    let tetrahedra = words.elements::<1>(case.solid.tetrahedra.len())?;
    let octahedra = words.elements::<1>(case.solid.octahedra.len())?;
    words.finish()?;
    let mut labels = CellLabels {
        tetrahedra: tetrahedra.as_flattened(),
        octahedra: octahedra.as_flattened(),
        ..CellLabels::default()
    };
    let [mut keep, mut spare] = memory.split(KEPT_BYTES);
    let mut solid = case.with_surface(&mut keep, &mut spare)?;
    let mut blend = FixedBlend::new();
    for level in 1..=case.levels {
        let mut scratch = spare.rest();
        let numbering = number(&solid, &mut scratch)?;
        let out = keep.slice(
            Arena::OutputPoints,
            length(numbering.vertex_count()),
            [0; CHANNELS],
        )?;
        let step = (&solid, &numbering, case.boundary);
        refine(&mut blend, step, channels, out, &mut scratch)?;
        channels = out;
        labels = hand_on(&labels, &mut keep)?;
        if level < case.levels {
            solid = split_cells(&solid, &numbering, &mut keep)?;
        }
        scratch.check()?;
        keep.check()?;
        results.section_of(SECTION_CHANNELS, &[level, blend.saturated()], channels);
        results.section_of(SECTION_LABELS, &[level], labels.tetrahedra);
        results.section_of(SECTION_LABELS, &[level], labels.octahedra);
    }
    Ok(())
}

/// Refines the channels once.
fn refine(
    blend: &mut FixedBlend<i32, CHANNELS>,
    (solid, numbering, boundary): (&Solid<'_>, &Numbering<'_>, Boundary),
    before: &[[i32; CHANNELS]],
    out: &mut [[i32; CHANNELS]],
    scratch: &mut Space<'_>,
) -> Result<(), Status> {
    let vertices = out.len();
    let buffers = PointBuffers {
        out,
        sums: scratch.slice(Arena::Sums, vertices, [0; CHANNELS])?,
        states: scratch.slice(Arena::States, vertices, VertexState::default())?,
    };
    refine_points(blend, solid, numbering, boundary, before, buffers)
        .map(|_| ())
        .map_err(Status::Mesh)
}

/// The labels of the next level.
fn hand_on<'s>(
    labels: &CellLabels<'_, u32>,
    keep: &mut Space<'s>,
) -> Result<CellLabels<'s, u32>, Status> {
    let (tetrahedra, octahedra) = (labels.tetrahedra.len(), labels.octahedra.len());
    let children = |of_tetrahedron: usize, of_octahedron: usize| {
        let first = tetrahedra.checked_mul(of_tetrahedron)?;
        first.checked_add(octahedra.checked_mul(of_octahedron)?)
    };
    let buffers = LabelBuffers {
        tetrahedra: keep.slice(Arena::Labels, children(4, 8).ok_or(TOO_LARGE)?, 0)?,
        octahedra: keep.slice(Arena::Labels, children(1, 6).ok_or(TOO_LARGE)?, 0)?,
        ..LabelBuffers::default()
    };
    split_labels(labels, buffers).map_err(Status::Mesh)
}
