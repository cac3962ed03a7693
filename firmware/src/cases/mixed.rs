//! The kinds [`MIXED`](super::MIXED) and [`MIXED_OWNED`](super::MIXED_OWNED): refine a solid of
//! tetrahedra, octahedra, prisms and hexahedra some levels.
//!
//! | words | what |
//! | --- | --- |
//! | 1 | what the boundary follows: 1 `tri-quad`, 2 `interior`, 3 `fixed` |
//! | 1 | levels, at most 8 |
//! | 9 | numbers of vertices, tetrahedra, octahedra, prisms, hexahedra, surface triangles, surface quadrilaterals, creases and corners |
//! | 4 each | tetrahedra |
//! | 6 each | octahedra |
//! | 6 each | prisms |
//! | 8 each | hexahedra |
//! | 3 each | surface triangles |
//! | 4 each | surface quadrilaterals |
//! | 2 each | creases |
//! | 1 each | corners |
//! | 3 each | points of the vertices, raw bits, signed |
//!
//! The results are the boundary that core finds of the cells (in slices only), and for each level
//! from 1 on the cells and the points of that level. The surface that is refined is the case's own.

use core::mem::swap;

use heapless::Vec;
use octruss::blend::{Blend, FixedBlend, GuardedBlend};
use octruss::mesh::{
    Arena, BoundarySizes, MixedBoundaryBuffers, MixedNumbering, MixedNumberingBuffers,
    MixedNumberingSizes, QuadDiagonal, QuadFace, Solid, boundary_faces,
};
use octruss::solid::mixed::{
    Boundary, MixedArena, MixedBuffers, MixedCounts, NumberingScratch, PointBuffers, PointScratch,
    VertexDistortion, VertexState, refine_points, split, split_counts,
};

use super::results::{Results, Sink, Status};
use super::solid::{LEVELS_AT_MOST, TOO_LARGE, length};
use super::space::{Memory, Plain, Space};
use super::{SECTION_BOUNDARY, SECTION_MIXED_CELLS, SECTION_POINTS, Words, summary};

/// Bytes for what a level hands on to the next one; the rest is what a level needs for itself.
const KEPT_BYTES: usize = 38 * 1024;

/// Values are raw bits.
type Values = FixedBlend<i32, 3>;

struct Case<'a> {
    boundary: Boundary,
    levels: u32,
    solid: Solid<'a>,
    points: &'a [[i32; 3]],
}

impl<'a> Case<'a> {
    fn read(words: &'a [u32]) -> Result<Self, Status> {
        let mut words = Words(words);
        let boundary = match words.word()? {
            1 => Boundary::TriQuad,
            2 => Boundary::Interior,
            3 => Boundary::Fixed,
            _ => return Err(Status::Malformed),
        };
        let levels = words.word()?;
        if levels > LEVELS_AT_MOST {
            return Err(Status::Malformed);
        }
        let mut counts = [0; 9];
        for count in &mut counts {
            *count = words.length()?;
        }
        let [
            vertices,
            tetrahedra,
            octahedra,
            prisms,
            hexahedra,
            triangles,
            quads,
            creases,
            corners,
        ] = counts;
        let solid = Solid {
            vertex_count: u32::try_from(vertices).map_err(|_| Status::Malformed)?,
            tetrahedra: words.elements(tetrahedra)?,
            octahedra: words.elements(octahedra)?,
            prisms: words.elements(prisms)?,
            hexahedra: words.elements(hexahedra)?,
            surface: words.elements(triangles)?,
            surface_quads: words.elements(quads)?,
            creases: words.elements(creases)?,
            corners: words.elements::<1>(corners)?.as_flattened(),
        };
        let points = words.points(vertices)?;
        words.finish()?;
        Ok(Case {
            boundary,
            levels,
            solid,
            points,
        })
    }
}

/// Runs a case in slices.
pub(super) fn run<S: Sink>(
    words: &[u32],
    memory: &mut Memory,
    results: &mut Results<'_, S>,
) -> Result<(), Status> {
    let case = Case::read(words)?;
    let [mut keep, mut spare] = memory.split(KEPT_BYTES);
    write_boundary(&case.solid, spare.rest(), results)?;
    let (mut solid, mut points) = (case.solid, case.points);
    let mut blend = Values::new();
    for level in 1..=case.levels {
        let mut scratch = spare.rest();
        let numbering = number(&solid, &mut scratch)?;
        let next = split_cells(&solid, &numbering, &mut keep)?;
        let vertices = length(numbering.vertex_count());
        let out = keep.slice(Arena::OutputPoints, vertices, [0; 3])?;
        let distortion = VertexDistortion::new(&blend.zero());
        let buffers = PointBuffers {
            out: &mut *out,
            sums: scratch.slice(Arena::Sums, vertices, blend.guarded_zero())?,
            states: scratch.slice(Arena::States, vertices, VertexState::default())?,
            distortions: scratch.slice(Arena::Distortions, points.len(), distortion)?,
        };
        let boundary = case.boundary;
        refine_points(&mut blend, &solid, &numbering, boundary, points, buffers)
            .map_err(Status::Mesh)?;
        scratch.check()?;
        keep.check()?;
        (solid, points) = (next, out);
        write_cells(level, &solid, results);
        results.section(SECTION_POINTS, &[level, blend.saturated()], points);
    }
    Ok(())
}

/// Finds the boundary of the cells and writes it.
fn write_boundary<S: Sink>(
    solid: &Solid<'_>,
    mut scratch: Space<'_>,
    results: &mut Results<'_, S>,
) -> Result<(), Status> {
    let sizes = BoundarySizes::of(solid).ok_or(TOO_LARGE)?;
    let buffers = MixedBoundaryBuffers {
        triangles: scratch.slice(Arena::Faces, sizes.triangles, [0; 3])?,
        quads: scratch.slice(Arena::QuadFaces, sizes.quads, [0; 4])?,
    };
    let found = boundary_faces(solid, buffers).map_err(Status::Mesh)?;
    scratch.check()?;
    let lists = [summary(found.triangles), summary(found.quads)];
    results.section(SECTION_BOUNDARY, lists.as_flattened(), &[]);
    Ok(())
}

fn number<'s>(solid: &Solid<'_>, scratch: &mut Space<'s>) -> Result<MixedNumbering<'s>, Status> {
    let sizes = MixedNumberingSizes::of(solid).ok_or(TOO_LARGE)?;
    let (face, diagonal) = (QuadFace::default(), QuadDiagonal::default());
    let buffers = MixedNumberingBuffers {
        edges: scratch.slice(Arena::Edges, sizes.edges, [0; 2])?,
        quads: scratch.slice(Arena::QuadFaces, sizes.quads, face)?,
        diagonals: scratch.slice(Arena::QuadDiagonals, sizes.diagonals, diagonal)?,
        prism_triangles: scratch.slice(Arena::PrismTriangles, sizes.prism_triangles, [0; 3])?,
        octahedra: scratch.slice(Arena::OctahedronOrder, sizes.octahedra, 0)?,
        hexahedra: scratch.slice(Arena::HexahedronOrder, sizes.hexahedra, 0)?,
    };
    MixedNumbering::new(solid, buffers).map_err(Status::Mesh)
}

fn split_cells<'s>(
    solid: &Solid<'_>,
    numbering: &MixedNumbering<'_>,
    keep: &mut Space<'s>,
) -> Result<Solid<'s>, Status> {
    let counts: MixedCounts = split_counts(solid, numbering).ok_or(TOO_LARGE)?;
    let buffers = MixedBuffers {
        tetrahedra: keep.slice(Arena::Tetrahedra, counts.tetrahedra, [0; 4])?,
        octahedra: keep.slice(Arena::Octahedra, counts.octahedra, [0; 6])?,
        prisms: keep.slice(Arena::Prisms, counts.prisms, [0; 6])?,
        hexahedra: keep.slice(Arena::Hexahedra, counts.hexahedra, [0; 8])?,
        surface: keep.slice(Arena::SurfaceTriangles, counts.surface, [0; 3])?,
        surface_quads: keep.slice(Arena::SurfaceQuads, counts.surface_quads, [0; 4])?,
        creases: keep.slice(Arena::Creases, counts.creases, [0; 2])?,
        corners: keep.slice(Arena::Corners, counts.corners, 0)?,
    };
    split(solid, numbering, buffers).map_err(Status::Mesh)
}

/// Writes how many elements of each kind a level has, and a checksum of each list.
fn write_cells<S: Sink>(level: u32, solid: &Solid<'_>, results: &mut Results<'_, S>) {
    let lists = [
        [level, solid.vertex_count],
        summary(solid.tetrahedra),
        summary(solid.octahedra),
        summary(solid.prisms),
        summary(solid.hexahedra),
        summary(solid.surface),
        summary(solid.surface_quads),
        summary(solid.creases),
        summary(solid.corners),
    ];
    results.section(SECTION_MIXED_CELLS, lists.as_flattened(), &[]);
}

/// Vertices after a level in core's own arenas.
const OWNED_VERTICES: usize = 160;

type OwnedPoints = Vec<[i32; 3], OWNED_VERTICES>;

/// Core's own arenas, smaller than the slices: enough for two cells at level 1.
struct OwnedMemory {
    solids: [MixedArena<24, 16, 24, 24, 96, 64, 96, 32>; 2],
    numbering: NumberingScratch<240, 32, 64, 16, 8, 8>,
    points: [OwnedPoints; 2],
    scratch: PointScratch<Values, 64, OWNED_VERTICES>,
}

// SAFETY: vectors of numbers in place and numbers.
unsafe impl Plain for OwnedMemory {}

/// As it is before any case.
static UNUSED: OwnedMemory = OwnedMemory {
    solids: [MixedArena::new(), MixedArena::new()],
    numbering: NumberingScratch::new(),
    points: [Vec::new(), Vec::new()],
    scratch: PointScratch::new(),
};

/// Runs a case in core's own arenas.
pub(super) fn run_owned<S: Sink>(
    words: &[u32],
    mut space: Space<'_>,
    results: &mut Results<'_, S>,
) -> Result<(), Status> {
    let case = Case::read(words)?;
    let OwnedMemory {
        solids: [solid, next_solid],
        numbering: numbers,
        points: [points, next_points],
        scratch,
    } = space.place(&UNUSED)?;
    solid.assign(&case.solid).map_err(Status::Mesh)?;
    points
        .extend_from_slice(case.points)
        .map_err(|_| Status::Malformed)?;
    let mut blend = Values::new();
    let (mut solid, mut next_solid) = (solid, next_solid);
    let (mut points, mut next_points) = (points, next_points);
    for level in 1..=case.levels {
        let view = solid.solid();
        let numbering = numbers.number(&view).map_err(Status::Mesh)?;
        next_solid
            .assign_split(&view, &numbering)
            .map_err(Status::Mesh)?;
        let boundary = case.boundary;
        scratch
            .refine(&mut blend, &view, &numbering, boundary, points, next_points)
            .map_err(Status::Mesh)?;
        write_cells(level, &next_solid.solid(), results);
        results.section(SECTION_POINTS, &[level, blend.saturated()], next_points);
        swap(&mut solid, &mut next_solid);
        swap(&mut points, &mut next_points);
    }
    Ok(())
}
