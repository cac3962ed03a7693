//! The kinds [`BOX_SPLINE`](super::BOX_SPLINE) and [`BOX_SPLINE_OWNED`](super::BOX_SPLINE_OWNED):
//! refine a solid of tetrahedra and octahedra some levels as a box spline.
//!
//! | words | what |
//! | --- | --- |
//! | 1 | major diagonals: 0 core chooses them, 1 they are given, 2 the averaged scheme, which has none |
//! | | the solid: see [`super::solid`] |
//! | 1 each | if they are given, the major diagonals of the tetrahedra, then of the octahedra |
//!
//! The results are first, unless the scheme is averaged, the faces where diagonals clash. Then
//! follow, for each level, the diagonals (at level 0 and on, unless the scheme is averaged; in
//! core's own arenas not at the last level), the cells (from level 1 on, as of [`super::refine`])
//! and the points (from level 1 on).

use core::mem::swap;

use heapless::Vec;
use octruss::blend::FixedBlend;
use octruss::mesh::{Arena, Solid, SolidArena, face_capacity};
use octruss::solid::box_spline::{
    DiagonalArena, DiagonalBuffers, Diagonals, Face, Neighbours, PointBuffers, Scheme, Scratch,
    choose_diagonals, improper_faces, neighbour_capacity, refine_points, split_diagonals,
};

use super::results::{Results, Sink, Status};
use super::solid::{
    KEPT_BYTES, SolidCase, TOO_LARGE, length, number, split_cells, sums_and_states, write_cells,
    write_last_cells,
};
use super::space::{Memory, Plain, Space};
use super::{SECTION_DIAGONALS, SECTION_IMPROPER_FACES, SECTION_POINTS, Words, summary};

/// Where the major diagonals come from.
#[derive(Clone, Copy)]
enum Source<'a> {
    Chosen,
    Given {
        tetrahedra: &'a [[u32; 1]],
        octahedra: &'a [[u32; 1]],
    },
    Averaged,
}

fn read(words: &[u32]) -> Result<(SolidCase<'_>, Source<'_>), Status> {
    let mut words = Words(words);
    let source = words.word()?;
    let case = SolidCase::read(&mut words)?;
    let source = match source {
        0 => Source::Chosen,
        1 => Source::Given {
            tetrahedra: words.elements(case.solid.tetrahedra.len())?,
            octahedra: words.elements(case.solid.octahedra.len())?,
        },
        2 => Source::Averaged,
        _ => return Err(Status::Malformed),
    };
    words.finish()?;
    Ok((case, source))
}

impl Source<'_> {
    /// Finds or takes the diagonals, and writes them and the faces where they clash.
    fn scheme<'s, S: Sink>(
        self,
        solid: &Solid<'_>,
        keep: &mut Space<'s>,
        spare: &mut Space<'_>,
        results: &mut Results<'_, S>,
    ) -> Result<Scheme<'s>, Status> {
        let (tetrahedra, octahedra) = (solid.tetrahedra.len(), solid.octahedra.len());
        let buffers = DiagonalBuffers {
            tetrahedra: keep.slice(Arena::Diagonals, tetrahedra, 0)?,
            octahedra: keep.slice(Arena::Diagonals, octahedra, 0)?,
        };
        let mut scratch = spare.rest();
        let faces_needed = face_capacity(solid).ok_or(TOO_LARGE)?;
        let faces = scratch.slice(Arena::Faces, faces_needed, Face::default())?;
        let diagonals = match self {
            Source::Averaged => return Ok(Scheme::Averaged),
            Source::Given {
                tetrahedra,
                octahedra,
            } => {
                copy(tetrahedra, buffers.tetrahedra)?;
                copy(octahedra, buffers.octahedra)?;
                Diagonals {
                    tetrahedra: buffers.tetrahedra,
                    octahedra: buffers.octahedra,
                }
            }
            Source::Chosen => {
                let cells = tetrahedra.saturating_add(octahedra);
                let queue = scratch.slice(Arena::CellQueue, cells, 0)?;
                choose_diagonals(solid, buffers, faces, queue).map_err(Status::Mesh)?
            }
        };
        let improper = improper_faces(solid, &diagonals, faces).map_err(Status::Mesh)?;
        scratch.check()?;
        results.begin_section(SECTION_IMPROPER_FACES, improper.len().saturating_mul(3));
        for face in improper {
            results.words(&face.corners());
        }
        write_diagonals(0, &diagonals, results);
        Ok(Scheme::MajorDiagonals(diagonals))
    }
}

/// Numbers of a case as the bytes that core takes; what no byte holds is no number of a case.
fn copy(words: &[[u32; 1]], bytes: &mut [u8]) -> Result<(), Status> {
    for (byte, [word]) in bytes.iter_mut().zip(words) {
        *byte = u8::try_from(*word).map_err(|_| Status::Malformed)?;
    }
    Ok(())
}

fn write_diagonals<S: Sink>(level: u32, diagonals: &Diagonals<'_>, results: &mut Results<'_, S>) {
    let [tetrahedra, crc_tetrahedra] = summary(diagonals.tetrahedra);
    let [octahedra, crc_octahedra] = summary(diagonals.octahedra);
    let words = [level, tetrahedra, crc_tetrahedra, octahedra, crc_octahedra];
    results.section(SECTION_DIAGONALS, &words, &[]);
}

/// The diagonals of the next level, written too.
fn hand_on<'s, S: Sink>(
    level: u32,
    scheme: Scheme<'_>,
    keep: &mut Space<'s>,
    results: &mut Results<'_, S>,
) -> Result<Scheme<'s>, Status> {
    let Scheme::MajorDiagonals(parents) = scheme else {
        return Ok(Scheme::Averaged);
    };
    let (tetrahedra, octahedra) = (parents.tetrahedra.len(), parents.octahedra.len());
    // Four tetrahedra and an octahedron in each tetrahedron, eight and six in each octahedron.
    let children = |each: usize, others: usize| {
        let of_octahedra = octahedra.saturating_mul(others);
        tetrahedra.saturating_mul(each).saturating_add(of_octahedra)
    };
    let buffers = DiagonalBuffers {
        tetrahedra: keep.slice(Arena::Diagonals, children(4, 8), 0)?,
        octahedra: keep.slice(Arena::Diagonals, children(1, 6), 0)?,
    };
    let diagonals = split_diagonals(&parents, buffers).map_err(Status::Mesh)?;
    write_diagonals(level, &diagonals, results);
    Ok(Scheme::MajorDiagonals(diagonals))
}

/// Runs a case in slices.
pub(super) fn run<S: Sink>(
    words: &[u32],
    memory: &mut Memory,
    results: &mut Results<'_, S>,
) -> Result<(), Status> {
    let (case, source) = read(words)?;
    let [mut keep, mut spare] = memory.split(KEPT_BYTES);
    let mut scheme = source.scheme(&case.solid, &mut keep, &mut spare, results)?;
    let mut solid = case.with_surface(&mut keep, &mut spare)?;
    let mut points = case.points;
    let mut blend = FixedBlend::<i32, 3>::new();
    for level in 1..=case.levels {
        let mut scratch = spare.rest();
        let numbering = number(&solid, &mut scratch)?;
        let needed = neighbour_capacity(&solid, &scheme).ok_or(TOO_LARGE)?;
        let triples = scratch.slice(Arena::Neighbours, needed, [0; 3])?;
        let neighbours = Neighbours::new(&solid, scheme, triples).map_err(Status::Mesh)?;
        let vertices = numbering.vertex_count();
        let out = keep.slice(Arena::OutputPoints, length(vertices), [0; 3])?;
        let (sums, states) = sums_and_states(vertices, &mut scratch)?;
        let buffers = PointBuffers {
            out: &mut *out,
            sums,
            states,
        };
        let boundary = case.boundary;
        refine_points(
            &mut blend,
            &solid,
            &numbering,
            &neighbours,
            boundary,
            points,
            buffers,
        )
        .map_err(Status::Mesh)?;
        points = out;
        scheme = hand_on(level, scheme, &mut keep, results)?;
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

/// Vertices that core's own arenas hold.
const OWNED_VERTICES: usize = 192;

/// Core's own arenas, smaller than the slices: enough for one tetrahedron at level 2.
struct OwnedMemory {
    solids: [SolidArena<36, 16, 72, 24, 4>; 2],
    diagonals: [DiagonalArena<36, 16>; 2],
    points: [Vec<[i32; 3], OWNED_VERTICES>; 2],
    scratch: Scratch<FixedBlend<i32, 3>, 560, 16, OWNED_VERTICES, 464>,
}

// SAFETY: vectors of numbers in place and numbers.
unsafe impl Plain for OwnedMemory {}

/// As it is before any case.
static UNUSED: OwnedMemory = OwnedMemory {
    solids: [SolidArena::new(), SolidArena::new()],
    diagonals: [DiagonalArena::new(), DiagonalArena::new()],
    points: [Vec::new(), Vec::new()],
    scratch: Scratch::new(),
};

/// Runs a case in core's own arenas.
pub(super) fn run_owned<S: Sink>(
    words: &[u32],
    memory: &mut Memory,
    results: &mut Results<'_, S>,
) -> Result<(), Status> {
    let (case, source) = read(words)?;
    let mut space = memory.space();
    let OwnedMemory {
        solids: [solid, next_solid],
        diagonals: [diagonals, next_diagonals],
        points: [points, next_points],
        scratch,
    } = space.place(&UNUSED)?;
    let [mut keep, mut spare] = space.halves();
    let scheme = source.scheme(&case.solid, &mut keep, &mut spare, results)?;
    if let Scheme::MajorDiagonals(chosen) = scheme {
        diagonals.assign(&chosen).map_err(Status::Mesh)?;
    }
    let whole = case.with_surface(&mut keep, &mut spare)?;
    solid.assign(&whole).map_err(Status::Mesh)?;
    points
        .extend_from_slice(case.points)
        .map_err(|_| Status::Malformed)?;
    let mut blend = FixedBlend::new();
    let (mut solid, mut next_solid) = (solid, next_solid);
    let (mut diagonals, mut next_diagonals) = (diagonals, next_diagonals);
    let (mut points, mut next_points) = (points, next_points);
    for level in 1..=case.levels {
        let scheme = match scheme {
            Scheme::Averaged => Scheme::Averaged,
            Scheme::MajorDiagonals(_) => Scheme::MajorDiagonals(diagonals.diagonals()),
        };
        let is_last = level == case.levels;
        let next = (!is_last).then_some((&mut *next_solid, &mut *next_diagonals));
        let (view, boundary) = (solid.solid(), case.boundary);
        let refined = scratch.refine(
            &mut blend,
            &view,
            scheme,
            boundary,
            points,
            next_points,
            next,
        );
        refined.map_err(Status::Mesh)?;
        if !is_last {
            if let Scheme::MajorDiagonals(_) = scheme {
                write_diagonals(level, &next_diagonals.diagonals(), results);
            }
            write_cells(level, &next_solid.solid(), results);
        }
        results.section(SECTION_POINTS, &[level, blend.saturated()], next_points);
        swap(&mut solid, &mut next_solid);
        swap(&mut diagonals, &mut next_diagonals);
        swap(&mut points, &mut next_points);
    }
    Ok(())
}
