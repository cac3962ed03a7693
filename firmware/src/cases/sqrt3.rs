//! The kinds [`SQRT3_ADAPTIVE`](super::SQRT3_ADAPTIVE) and [`SQRT3_STEPS`](super::SQRT3_STEPS):
//! what the square-root-3 scheme has beside uniform refinement.
//!
//! # Adaptive refinement
//!
//! | words | what |
//! | --- | --- |
//! | 1 | levels |
//! | 1 | which triangles are refined: 0 all; 1 those with a corner whose x is below the threshold; 2 those whose corners' x have the threshold between them; 3 those with a corner that is farther from its limit than the threshold along an axis |
//! | 1 | the threshold, raw bits, signed |
//! | | the control mesh: see [`super::surface`], from the numbers of vertices on |
//!
//! The result is one section for each triangle.
//!
//! # Several steps at once
//!
//! | words | what |
//! | --- | --- |
//! | 1 | steps |
//! | 1 | valence |
//! | 3 | the vertex, raw bits, signed |
//! | 3 each | its ring |
//!
//! The result is the vertex that many steps on, its limit, and the vertex that many steps on once
//! more from itself and the limit.

use octruss::blend::FixedBlend;
use octruss::mesh::Arena;
use octruss::surface::sqrt3::adaptive::{
    AdaptiveBuffers, AdaptiveMesh, AdaptiveTriangle, AdaptiveVertex, Patch,
};
use octruss::surface::sqrt3::multi_step::{Steps, between, ring_position};

use super::results::{Results, Sink, Status};
use super::solid::LEVELS_AT_MOST;
use super::space::Memory;
use super::surface::{find_edges, read_mesh};
use super::{SECTION_POINTS, SECTION_TRIANGLE, Words};

/// Triangles of an adaptive mesh.
const TRIANGLES: usize = 1000;
/// Vertices of an adaptive mesh.
const VERTICES: usize = 520;
/// Ring values of an adaptive mesh.
const RINGS: usize = 3200;
/// The greatest valence.
const VALENCE: usize = 64;
/// Bytes for the adaptive mesh; the rest is what its start needs.
const KEPT_BYTES: usize = 84 * 1024;

/// Which triangles are refined.
#[derive(Clone, Copy)]
enum Wish {
    All,
    Below,
    Between,
    FarFromLimit,
}

impl Wish {
    fn wants(self, threshold: i32, patch: &Patch<[i32; 3]>) -> bool {
        let x = patch.corners.map(|[x, ..]| x);
        match self {
            Wish::All => true,
            Wish::Below => x.iter().any(|x| *x < threshold),
            Wish::Between => x.iter().any(|x| *x <= threshold) && x.iter().any(|x| *x >= threshold),
            Wish::FarFromLimit => {
                let corners = patch.corners.as_flattened().iter();
                let mut pairs = corners.zip(patch.limits.as_flattened());
                pairs.any(|(corner, limit)| corner.abs_diff(*limit) > threshold.unsigned_abs())
            }
        }
    }
}

/// Runs a case of adaptive refinement.
pub(super) fn run_adaptive<S: Sink>(
    words: &[u32],
    memory: &mut Memory,
    results: &mut Results<'_, S>,
) -> Result<(), Status> {
    let mut words = Words(words);
    let levels = words.word()?;
    let wish = match words.word()? {
        0 => Wish::All,
        1 => Wish::Below,
        2 => Wish::Between,
        3 => Wish::FarFromLimit,
        _ => return Err(Status::Malformed),
    };
    let threshold = words.word()?.cast_signed();
    let (mesh, points) = read_mesh(&mut words)?;
    words.finish()?;
    if levels > LEVELS_AT_MOST {
        return Err(Status::Malformed);
    }
    let [mut keep, mut spare] = memory.split(KEPT_BYTES);
    let none = AdaptiveTriangle::default();
    let buffers = AdaptiveBuffers {
        triangles: keep.slice(Arena::AdaptiveTriangles, TRIANGLES, none)?,
        vertices: keep.slice(Arena::AdaptiveVertices, VERTICES, AdaptiveVertex::default())?,
        positions: keep.slice(Arena::OutputPoints, VERTICES, [0; 3])?,
        rings: keep.slice(Arena::AdaptiveRings, RINGS, [0; 3])?,
        ring_scratch: keep.slice(Arena::AdaptiveRings, VALENCE, [0; 3])?,
    };
    let edges = find_edges(&mesh, &mut spare)?;
    let mut blend = FixedBlend::<i32, 3>::new();
    let mut adaptive = AdaptiveMesh::<FixedBlend<i32, 3>>::new(&mesh, &edges, points, buffers)
        .map_err(Status::Mesh)?;
    let refined = adaptive.refine_where(&mut blend, levels, |patch| wish.wants(threshold, patch));
    refined.map_err(Status::Mesh)?;
    let triangles = u32::try_from(adaptive.triangles().len()).unwrap_or(u32::MAX);
    for place in 0..triangles {
        write_triangle(&mut adaptive, &mut blend, place, results);
    }
    keep.check()?;
    spare.check()
}

/// Writes a triangle: generation, corners, neighbours; where its corners are and where they go.
fn write_triangle<S: Sink>(
    adaptive: &mut AdaptiveMesh<'_, FixedBlend<i32, 3>>,
    blend: &mut FixedBlend<i32, 3>,
    place: u32,
    results: &mut Results<'_, S>,
) {
    let list = adaptive.triangles();
    let triangle = usize::try_from(place)
        .ok()
        .and_then(|place| list.get(place));
    let Some(&AdaptiveTriangle {
        vertices: [a, b, c],
        neighbours: [beyond_a, beyond_b, beyond_c],
        generation,
    }) = triangle
    else {
        return;
    };
    let words = [generation, a, b, c, beyond_a, beyond_b, beyond_c];
    if let Some(Patch {
        corners: [p, q, r],
        limits: [limit_p, limit_q, limit_r],
        ..
    }) = adaptive.patch(blend, place)
    {
        let points = [p, q, r, limit_p, limit_q, limit_r];
        results.section(SECTION_TRIANGLE, &words, &points);
    }
}

/// Runs a case of several steps at once.
pub(super) fn run_steps<S: Sink>(
    words: &[u32],
    results: &mut Results<'_, S>,
) -> Result<(), Status> {
    let mut words = Words(words);
    let steps = words.word()?;
    let valence = words.word()?;
    let (own, ring) = (words.points(1)?, words.points(words_of(valence)?)?);
    words.finish()?;
    let [own] = own else {
        return Err(Status::Malformed);
    };
    let mut blend = FixedBlend::<i32, 3>::new();
    let moved = ring_position(&mut blend, own, ring, Steps::Count(steps));
    let limit = ring_position(&mut blend, own, ring, Steps::Limit);
    let again = between(&mut blend, own, &limit, valence, steps);
    let points = [moved, limit, again];
    results.section(SECTION_POINTS, &[0, blend.saturated()], &points);
    Ok(())
}

fn words_of(valence: u32) -> Result<usize, Status> {
    usize::try_from(valence).map_err(|_| Status::Malformed)
}
