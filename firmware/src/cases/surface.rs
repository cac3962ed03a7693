//! The kinds [`SURFACE`](super::SURFACE) and [`LIMIT_NORMALS`](super::LIMIT_NORMALS): refine a control mesh some
//! levels.
//!
//! | words | what |
//! | --- | --- |
//! | 1 | scheme: 1 `loop`, 2 `loop-warren`, 3 Loop's with the weights of `tri-quad`, 4 `catmull-clark`, 5 `doo-sabin`, 6 `sqrt3`, 7 `butterfly`, 8 `butterfly-modified`, 9 `tri-quad` |
//! | 1 | what the rim follows: 1 spline, 2 spline with corners, 3 fixed |
//! | 1 | levels, at most 8 |
//! | 1 | 1 if limit positions are wanted after the last level, else 0 |
//! | 5 | numbers of vertices, faces, corners of all faces together, creases and corners |
//! | 1 each, and 1 | where each face's corners start, and where the last one's end |
//! | 1 each | corners of the faces |
//! | 2 each | creases |
//! | 1 each | corners |
//! | 3 each | points of the vertices, raw bits, signed |
//!
//! The results are, for each level from 1 on, the faces and the points of that level, and then the
//! limit positions: of the last level's vertices, for Doo-Sabin of its faces. The butterflies go
//! through their vertices and have none of their own, and `tri-quad` has no limit masks. Of the kind `LIMIT_NORMALS`
//! follow the limit normals of the last level, for Loop's, Catmull-Clark and Doo-Sabin surfaces.

use octruss::blend::{Blend, FixedBlend, GuardedBlend};
use octruss::mesh::{
    Arena, ControlMesh, ControlMeshBuffers, FaceOrder, Fans, MeshError, Side, SurfaceEdges,
};
use octruss::surface::limit_normals::{
    FixedTangents, NormalBuffers, TangentMasks, face_normals, limit_normals,
};
use octruss::surface::{
    LoopWeights, PointBuffers, Rim, SurfaceCounts, VertexState, butterfly, catmull_clark,
    doo_sabin, loop_scheme, sqrt3, tri_quad,
};

use super::results::{Results, Sink, Status};
use super::solid::{LEVELS_AT_MOST, TOO_LARGE, length};
use super::space::{Memory, Space};
use super::{SECTION_FACES, SECTION_LIMIT, SECTION_LIMIT_NORMALS, SECTION_POINTS, Words, summary};

/// Bytes for what a level hands on to the next one, faces and points; the rest of the memory is
/// what a level needs for itself.
const KEPT_BYTES: usize = 44 * 1024;

/// Values are raw bits.
type Values = FixedBlend<i32, 3>;
/// So are those that normals are made of.
type Tangents = FixedTangents<i32>;

#[derive(Clone, Copy)]
enum Scheme {
    Loop(LoopWeights),
    CatmullClark,
    DooSabin,
    Sqrt3,
    Butterfly(butterfly::Variant),
    TriQuad,
}

fn scheme(word: u32) -> Result<Scheme, Status> {
    Ok(match word {
        1 => Scheme::Loop(LoopWeights::Loop),
        2 => Scheme::Loop(LoopWeights::Warren),
        3 => Scheme::Loop(LoopWeights::TriQuad),
        4 => Scheme::CatmullClark,
        5 => Scheme::DooSabin,
        6 => Scheme::Sqrt3,
        7 => Scheme::Butterfly(butterfly::Variant::Original),
        8 => Scheme::Butterfly(butterfly::Variant::Modified),
        9 => Scheme::TriQuad,
        _ => return Err(Status::Malformed),
    })
}

fn rim(word: u32) -> Result<Rim, Status> {
    Ok(match word {
        1 => Rim::Spline,
        2 => Rim::SplineWithCorners,
        3 => Rim::Fixed,
        _ => return Err(Status::Malformed),
    })
}

/// Takes a control mesh and its points off the front of a case's words.
pub(super) fn read_mesh<'a>(
    words: &mut Words<'a>,
) -> Result<(ControlMesh<'a>, &'a [[i32; 3]]), Status> {
    let vertices = words.length()?;
    let faces = words.length()?;
    let [corners_of_faces, creases, corners] = [words.length()?, words.length()?, words.length()?];
    let offsets = faces.checked_add(1).ok_or(Status::Malformed)?;
    let mesh = ControlMesh {
        vertex_count: u32::try_from(vertices).map_err(|_| Status::Malformed)?,
        offsets: words.elements::<1>(offsets)?.as_flattened(),
        indices: words.elements::<1>(corners_of_faces)?.as_flattened(),
        creases: words.elements(creases)?,
        corners: words.elements::<1>(corners)?.as_flattened(),
        odd: false,
    };
    Ok((mesh, words.points(vertices)?))
}

/// Runs a case of points and limit positions.
pub(super) fn run<S: Sink>(
    words: &[u32],
    memory: &mut Memory,
    results: &mut Results<'_, S>,
) -> Result<(), Status> {
    run_to_end(words, false, memory, results)
}

/// Runs a case of limit normals.
pub(super) fn run_normals<S: Sink>(
    words: &[u32],
    memory: &mut Memory,
    results: &mut Results<'_, S>,
) -> Result<(), Status> {
    run_to_end(words, true, memory, results)
}

fn run_to_end<S: Sink>(
    words: &[u32],
    wants_normals: bool,
    memory: &mut Memory,
    results: &mut Results<'_, S>,
) -> Result<(), Status> {
    let mut words = Words(words);
    let scheme = scheme(words.word()?)?;
    let rim = rim(words.word()?)?;
    let levels = words.word()?;
    let wants_limit = words.word()?;
    if levels > LEVELS_AT_MOST || wants_limit > 1 {
        return Err(Status::Malformed);
    }
    let (mut mesh, mut points) = read_mesh(&mut words)?;
    words.finish()?;
    let [mut keep, mut spare] = memory.split(KEPT_BYTES);
    let mut blend = Values::new();
    for level in 1..=levels {
        let mut scratch = spare.rest();
        (mesh, points) = match scheme {
            Scheme::Loop(weights) => refine_loop(
                &mut blend,
                weights,
                rim,
                mesh,
                points,
                &mut keep,
                &mut scratch,
            )?,
            Scheme::CatmullClark => {
                refine_catmull_clark(&mut blend, rim, mesh, points, &mut keep, &mut scratch)?
            }
            Scheme::DooSabin => {
                refine_doo_sabin(&mut blend, mesh, points, &mut keep, &mut scratch)?
            }
            Scheme::Sqrt3 => refine_sqrt3(&mut blend, mesh, points, &mut keep, &mut scratch)?,
            Scheme::Butterfly(variant) => refine_butterfly(
                &mut blend,
                variant,
                rim,
                mesh,
                points,
                &mut keep,
                &mut scratch,
            )?,
            Scheme::TriQuad => {
                refine_tri_quad(&mut blend, rim, mesh, points, &mut keep, &mut scratch)?
            }
        };
        scratch.check()?;
        keep.check()?;
        write_faces(level, &mesh, results);
        results.section(SECTION_POINTS, &[level, blend.saturated()], points);
    }
    if wants_limit == 1 {
        let mut scratch = spare.rest();
        let limit = limit(&mut blend, scheme, rim, mesh, points, &mut scratch)?;
        scratch.check()?;
        results.section(SECTION_LIMIT, &[levels, blend.saturated()], limit);
    }
    if wants_normals {
        let mut scratch = spare.rest();
        let mut tangents = Tangents::new();
        let normals = normals(&mut tangents, scheme, rim, mesh, points, &mut scratch)?;
        scratch.check()?;
        let words = [levels, tangents.zeros()];
        results.section(SECTION_LIMIT_NORMALS, &words, normals);
    }
    Ok(())
}

/// A refined mesh and its points.
type Refined<'s> = Result<(ControlMesh<'s>, &'s [[i32; 3]]), Status>;

/// The edges of a mesh.
pub(super) fn find_edges<'s>(
    mesh: &ControlMesh<'_>,
    scratch: &mut Space<'s>,
) -> Result<SurfaceEdges<'s>, Status> {
    let sides = scratch.slice(Arena::Sides, mesh.indices.len(), Side::default())?;
    SurfaceEdges::new(mesh, sides).map_err(Status::Mesh)
}

fn order<'s>(mesh: &ControlMesh<'_>, scratch: &mut Space<'s>) -> Result<FaceOrder<'s>, Status> {
    let order = scratch.slice(Arena::FaceOrder, mesh.face_count(), 0)?;
    FaceOrder::new(mesh, order).map_err(Status::Mesh)
}

/// Room for a refined mesh.
fn mesh_buffers<'s>(
    counts: Option<SurfaceCounts>,
    keep: &mut Space<'s>,
) -> Result<ControlMeshBuffers<'s>, Status> {
    let counts = counts.ok_or(TOO_LARGE)?;
    let offsets = counts.faces.saturating_add(1);
    Ok(ControlMeshBuffers {
        offsets: keep.slice(Arena::FaceOffsets, offsets, 0)?,
        indices: keep.slice(Arena::FaceCorners, counts.indices, 0)?,
        creases: keep.slice(Arena::Creases, counts.creases, [0; 2])?,
        corners: keep.slice(Arena::Corners, counts.corners, 0)?,
    })
}

/// Room for refined values, the values themselves apart.
struct Scratch<'s> {
    sums: &'s mut [[i64; 3]],
    states: &'s mut [VertexState],
}

impl<'s> Scratch<'s> {
    fn new(vertices: usize, scratch: &mut Space<'s>) -> Result<Self, Status> {
        Ok(Scratch {
            sums: scratch.slice(Arena::Sums, vertices, [0; 3])?,
            states: scratch.slice(Arena::States, vertices, VertexState::default())?,
        })
    }

    /// With where the values go.
    fn with<'t>(self, out: &'t mut [[i32; 3]]) -> PointBuffers<'t, Values>
    where
        's: 't,
    {
        PointBuffers {
            out,
            sums: self.sums,
            states: self.states,
        }
    }
}

/// Room for the values of a refined mesh.
fn values<'s>(mesh: &ControlMesh<'_>, keep: &mut Space<'s>) -> Result<&'s mut [[i32; 3]], Status> {
    keep.slice(Arena::OutputPoints, length(mesh.vertex_count), [0; 3])
}

fn refine_loop<'s>(
    blend: &mut Values,
    weights: LoopWeights,
    rim: Rim,
    mesh: ControlMesh<'_>,
    points: &[[i32; 3]],
    keep: &mut Space<'s>,
    scratch: &mut Space<'_>,
) -> Refined<'s> {
    let edges = find_edges(&mesh, scratch)?;
    let buffers = mesh_buffers(loop_scheme::split_counts(&mesh, &edges), keep)?;
    let next = loop_scheme::split(&mesh, &edges, buffers).map_err(Status::Mesh)?;
    let out = values(&next, keep)?;
    let buffers = Scratch::new(out.len(), scratch)?.with(out);
    loop_scheme::refine_points(blend, &mesh, &edges, weights, rim, points, buffers)
        .map_err(Status::Mesh)?;
    Ok((next, out))
}

fn refine_catmull_clark<'s>(
    blend: &mut Values,
    rim: Rim,
    mesh: ControlMesh<'_>,
    points: &[[i32; 3]],
    keep: &mut Space<'s>,
    scratch: &mut Space<'_>,
) -> Refined<'s> {
    let edges = find_edges(&mesh, scratch)?;
    let order = order(&mesh, scratch)?;
    let buffers = mesh_buffers(catmull_clark::split_counts(&mesh, &edges), keep)?;
    let next = catmull_clark::split(&mesh, &edges, &order, buffers).map_err(Status::Mesh)?;
    let out = values(&next, keep)?;
    let buffers = Scratch::new(out.len(), scratch)?.with(out);
    catmull_clark::refine_points(blend, &mesh, &edges, &order, rim, points, buffers)
        .map_err(Status::Mesh)?;
    Ok((next, out))
}

fn refine_doo_sabin<'s>(
    blend: &mut Values,
    mesh: ControlMesh<'_>,
    points: &[[i32; 3]],
    keep: &mut Space<'s>,
    scratch: &mut Space<'_>,
) -> Refined<'s> {
    let edges = find_edges(&mesh, scratch)?;
    let starts = scratch.slice(Arena::FanStarts, length(mesh.vertex_count), 0)?;
    let fans = Fans::new(mesh, edges, starts).map_err(Status::Mesh)?;
    let buffers = mesh_buffers(doo_sabin::split_counts(&fans), keep)?;
    let next = doo_sabin::split(&fans, buffers).map_err(Status::Mesh)?;
    let out = values(&next, keep)?;
    let sums = scratch.slice(Arena::Sums, out.len(), [0; 3])?;
    doo_sabin::refine_points(blend, &mesh, points, out, sums).map_err(Status::Mesh)?;
    Ok((next, out))
}

fn refine_sqrt3<'s>(
    blend: &mut Values,
    mesh: ControlMesh<'_>,
    points: &[[i32; 3]],
    keep: &mut Space<'s>,
    scratch: &mut Space<'_>,
) -> Refined<'s> {
    let numbering = number_sqrt3(&mesh, scratch)?;
    let buffers = mesh_buffers(sqrt3::split_counts(&mesh, &numbering), keep)?;
    let next = sqrt3::split(&mesh, &numbering, buffers).map_err(Status::Mesh)?;
    let out = values(&next, keep)?;
    let buffers = Scratch::new(out.len(), scratch)?.with(out);
    sqrt3::refine_points(blend, &mesh, &numbering, points, buffers).map_err(Status::Mesh)?;
    Ok((next, out))
}

fn number_sqrt3<'s>(
    mesh: &ControlMesh<'_>,
    scratch: &mut Space<'s>,
) -> Result<sqrt3::Numbering<'s>, Status> {
    let edges = find_edges(mesh, scratch)?;
    let order = order(mesh, scratch)?;
    let edge_count = length(edges.count());
    let states = with_edges(length(mesh.vertex_count), &edges);
    let buffers = sqrt3::NumberingBuffers {
        states: scratch.slice(Arena::States, states, VertexState::default())?,
        edge_vertices: scratch.slice(Arena::EdgeVertices, edge_count, 0)?,
        face_vertices: scratch.slice(Arena::FaceVertices, mesh.face_count(), 0)?,
    };
    sqrt3::Numbering::new(mesh, edges, &order, buffers).map_err(Status::Mesh)
}

fn refine_butterfly<'s>(
    blend: &mut Values,
    variant: butterfly::Variant,
    rim: Rim,
    mesh: ControlMesh<'_>,
    points: &[[i32; 3]],
    keep: &mut Space<'s>,
    scratch: &mut Space<'_>,
) -> Refined<'s> {
    let edges = find_edges(&mesh, scratch)?;
    let buffers = mesh_buffers(butterfly::split_counts(&mesh, &edges), keep)?;
    let next = butterfly::split(&mesh, &edges, buffers).map_err(Status::Mesh)?;
    let out = values(&next, keep)?;
    let buffers = Scratch::new(out.len(), scratch)?.with(out);
    butterfly::refine_points(blend, &mesh, &edges, variant, rim, points, buffers)
        .map_err(Status::Mesh)?;
    Ok((next, out))
}

fn refine_tri_quad<'s>(
    blend: &mut Values,
    rim: Rim,
    mesh: ControlMesh<'_>,
    points: &[[i32; 3]],
    keep: &mut Space<'s>,
    scratch: &mut Space<'_>,
) -> Refined<'s> {
    let edges = find_edges(&mesh, scratch)?;
    let order = order(&mesh, scratch)?;
    let buffers = mesh_buffers(tri_quad::split_counts(&mesh, &edges), keep)?;
    let next = tri_quad::split(&mesh, &edges, &order, buffers).map_err(Status::Mesh)?;
    let out = values(&next, keep)?;
    let (vertices, old) = (out.len(), length(mesh.vertex_count));
    let unknown = tri_quad::VertexDistortion::new(blend.zero());
    let buffers = tri_quad::PointBuffers {
        out: &mut *out,
        sums: scratch.slice(Arena::Sums, vertices, blend.guarded_zero())?,
        states: scratch.slice(Arena::States, vertices, VertexState::default())?,
        distortions: scratch.slice(Arena::Distortions, old, unknown)?,
    };
    tri_quad::refine_points(blend, &mesh, &edges, &order, rim, points, buffers)
        .map_err(Status::Mesh)?;
    Ok((next, out))
}

/// Limit positions.
fn limit<'s>(
    blend: &mut Values,
    scheme: Scheme,
    rim: Rim,
    mesh: ControlMesh<'_>,
    points: &[[i32; 3]],
    scratch: &mut Space<'s>,
) -> Result<&'s [[i32; 3]], Status> {
    let vertices = length(mesh.vertex_count);
    let done: Result<_, MeshError> = match scheme {
        Scheme::Butterfly(_) | Scheme::TriQuad => return Err(Status::Malformed),
        Scheme::DooSabin => {
            let out = scratch.slice(Arena::OutputPoints, mesh.face_count(), [0; 3])?;
            doo_sabin::limit_points(blend, &mesh, points, out)
        }
        Scheme::Sqrt3 => {
            let numbering = number_sqrt3(&mesh, scratch)?;
            let buffers = limit_buffers(vertices, scratch)?;
            sqrt3::limit_points(blend, &mesh, &numbering, points, buffers)
        }
        Scheme::Loop(weights) => {
            let edges = find_edges(&mesh, scratch)?;
            let buffers = limit_buffers(with_edges(vertices, &edges), scratch)?;
            loop_scheme::limit_points(blend, &mesh, &edges, weights, rim, points, buffers)
        }
        Scheme::CatmullClark => {
            let edges = find_edges(&mesh, scratch)?;
            let buffers = limit_buffers(with_edges(vertices, &edges), scratch)?;
            catmull_clark::limit_points(blend, &mesh, &edges, rim, points, buffers)
        }
    };
    done.map(|limit| &*limit).map_err(Status::Mesh)
}

/// Limit normals, as words.
fn normals<'s>(
    tangents: &mut Tangents,
    scheme: Scheme,
    rim: Rim,
    mesh: ControlMesh<'_>,
    points: &[[i32; 3]],
    scratch: &mut Space<'s>,
) -> Result<&'s [[i32; 3]], Status> {
    let masks = match scheme {
        Scheme::Loop(_) => Some(TangentMasks::Loop),
        Scheme::CatmullClark => Some(TangentMasks::CatmullClark),
        Scheme::DooSabin => None,
        Scheme::Sqrt3 | Scheme::Butterfly(_) | Scheme::TriQuad => return Err(Status::Malformed),
    };
    let count = if masks.is_some() {
        mesh.indices.len()
    } else {
        mesh.face_count()
    };
    let out = scratch.slice(Arena::OutputPoints, count, [0_i16; 3])?;
    let found: Result<&mut [[i16; 3]], MeshError> = if let Some(masks) = masks {
        let edges = find_edges(&mesh, scratch)?;
        let states = with_edges(length(mesh.vertex_count), &edges);
        let buffers = NormalBuffers {
            out,
            done: scratch.slice(Arena::FaceCorners, count, true)?,
            states: scratch.slice(Arena::States, states, VertexState::default())?,
        };
        limit_normals(tangents, &mesh, &edges, masks, rim, points, buffers)
    } else {
        face_normals(tangents, &mesh, points, out)
    };
    let found = found.map_err(Status::Mesh)?;
    let words = scratch.slice(Arena::OutputPoints, count, [0_i32; 3])?;
    for (word, normal) in words.iter_mut().zip(found.iter()) {
        *word = normal.map(i32::from);
    }
    Ok(words)
}

/// As many elements as there are vertices and edges.
fn with_edges(vertices: usize, edges: &SurfaceEdges<'_>) -> usize {
    vertices.saturating_add(length(edges.count()))
}

fn limit_buffers<'s>(
    count: usize,
    scratch: &mut Space<'s>,
) -> Result<PointBuffers<'s, Values>, Status> {
    let out = scratch.slice(Arena::OutputPoints, count, [0; 3])?;
    Ok(Scratch::new(count, scratch)?.with(out))
}

/// Writes how long the lists of a level's faces are, and a checksum of each.
fn write_faces<S: Sink>(level: u32, mesh: &ControlMesh<'_>, results: &mut Results<'_, S>) {
    let [offsets, crc_offsets] = summary(mesh.offsets);
    let [indices, crc_indices] = summary(mesh.indices);
    let [creases, crc_creases] = summary(mesh.creases);
    let [corners, crc_corners] = summary(mesh.corners);
    let words = [
        level,
        mesh.vertex_count,
        offsets,
        crc_offsets,
        indices,
        crc_indices,
        creases,
        crc_creases,
        corners,
        crc_corners,
        u32::from(mesh.odd),
    ];
    results.section(SECTION_FACES, &words, &[]);
}
