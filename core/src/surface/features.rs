//! Boundaries, creases and corners of control meshes: which rule a vertex or an edge follows.
//!
//! An edge is *sharp* if it is tagged as a crease or is not shared by exactly two faces (one: the
//! mesh's rim; three or more: a seam where sheets meet). Along sharp edges surfaces follow a cubic
//! B-spline of the sharp edges alone, so that meshes that share such a line stay closed.

use crate::blend::Blend;
use crate::mesh::{Arena, ControlMesh, MeshError, SurfaceEdges, index, require};

/// What the rim of an open control mesh follows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Rim {
    /// A cubic B-spline of the rim's vertices: midpoints `1/2 1/2`, vertices `1/8 6/8 1/8`.
    #[default]
    Spline,
    /// The same, but a rim vertex in a single face is a corner and stays.
    SplineWithCorners,
    /// Rim vertices stay and rim edges are halved: the rim's polygon stays as it is.
    Fixed,
}

/// The rule of an old vertex or of an edge's midpoint.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Rule {
    /// The scheme's smooth rule.
    #[default]
    Smooth,
    /// `1/8 6/8 1/8` along two sharp edges.
    Crease,
    /// A vertex stays, a midpoint lies halfway.
    Linear,
}

/// What is known of a refined vertex while its sum grows. An opaque piece of scratch memory.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct VertexState {
    /// The rule in force.
    pub(crate) rule: Rule,
    /// Sharp edges that meet at an old vertex; 1 on a sharp edge.
    pub(crate) sharp: u32,
    /// Edges at an old vertex that do not have two faces.
    pub(crate) rim: u32,
    /// Edges that meet at an old vertex.
    pub(crate) edges: u32,
    /// Faces that meet at a vertex or on an edge.
    pub(crate) faces: u32,
    /// Common multiple of the faces' numbers of corners; 0 stands for 1.
    pub(crate) common: u32,
}

/// Where refined values and the scratch to compute them are written.
///
/// `out`, `sums` and `states` each need one element for every vertex of the refined mesh.
#[derive(Debug)]
pub struct PointBuffers<'a, B: Blend> {
    /// The refined values, in the order of the scheme's numbering.
    pub out: &'a mut [B::Point],
    /// Scratch: one sum for each refined vertex.
    pub sums: &'a mut [B::Sum],
    /// Scratch: one state for each refined vertex.
    pub states: &'a mut [VertexState],
}

/// Checks the sizes of the buffers and clears the scratch; returns exactly `new` of each.
pub(crate) fn prepare<'a, B: Blend>(
    blend: &B,
    old: usize,
    new: usize,
    points: &[B::Point],
    buffers: PointBuffers<'a, B>,
) -> Result<PointBuffers<'a, B>, MeshError> {
    require(Arena::InputPoints, old, points.len())?;
    require(Arena::OutputPoints, new, buffers.out.len())?;
    require(Arena::Sums, new, buffers.sums.len())?;
    require(Arena::States, new, buffers.states.len())?;
    let sums = buffers.sums.get_mut(..new).unwrap_or_default();
    let states = buffers.states.get_mut(..new).unwrap_or_default();
    sums.fill(blend.zero());
    states.fill(VertexState::default());
    Ok(PointBuffers {
        out: buffers.out.get_mut(..new).unwrap_or_default(),
        sums,
        states,
    })
}

/// Finds the rule of every old vertex and every edge's midpoint. `states` are cleared, old
/// vertices first, then edges. `None` if the edges are seen to be of another mesh.
pub(crate) fn classify(
    mesh: &ControlMesh<'_>,
    edges: &SurfaceEdges<'_>,
    rim: Rim,
    states: &mut [VertexState],
) -> Option<()> {
    for &[a, b] in mesh.creases {
        states.get_mut(index(edges.midpoint(a, b)?))?.sharp = 1;
    }
    let (old, new) = states.split_at_mut_checked(index(mesh.vertex_count))?;
    for (sides, middle) in edges.iter().zip(new.iter_mut()) {
        middle.faces = u32::try_from(sides.len()).ok()?;
        let is_rim = sides.len() != 2;
        if is_rim {
            middle.sharp = 1;
        }
        if middle.sharp > 0 {
            middle.rule = Rule::Linear;
        }
        for end in sides.first()?.ends {
            let vertex = old.get_mut(index(end))?;
            vertex.edges = vertex.edges.saturating_add(1);
            vertex.sharp = vertex.sharp.saturating_add(middle.sharp);
            vertex.rim = vertex.rim.saturating_add(u32::from(is_rim));
        }
    }
    for &corner in mesh.indices {
        let vertex = old.get_mut(index(corner))?;
        vertex.faces = vertex.faces.saturating_add(1);
    }
    for vertex in old.iter_mut() {
        vertex.rule = vertex_rule(vertex, rim);
    }
    for &corner in mesh.corners {
        old.get_mut(index(corner))?.rule = Rule::Linear;
    }
    Some(())
}

/// The rule of an old vertex that is no tagged corner.
fn vertex_rule(vertex: &VertexState, rim: Rim) -> Rule {
    let on_rim = vertex.rim > 0;
    match (rim, vertex.sharp) {
        (Rim::Fixed, _) if on_rim => Rule::Linear,
        (Rim::SplineWithCorners, _) if vertex.rim == 2 && vertex.faces == 1 => Rule::Linear,
        (_, 3..) => Rule::Linear,
        (_, 2) => Rule::Crease,
        // A seam of three sheets that ends here: no smooth rule knows such a neighbourhood.
        (_, 0 | 1) if on_rim => Rule::Linear,
        (_, 0 | 1) if vertex.edges == 0 => Rule::Linear,
        (_, 0 | 1) => Rule::Smooth,
    }
}

/// Adds to every vertex on a crease its two neighbours along it.
pub(crate) fn gather_creases<B: Blend>(
    blend: &B,
    edges: &SurfaceEdges<'_>,
    points: &[B::Point],
    sums: &mut [B::Sum],
    states: &[VertexState],
) -> Option<()> {
    let middles = states.get(index(edges.old_count())..)?;
    for ([a, b], middle) in edges.ends().zip(middles) {
        if middle.sharp == 0 {
            continue;
        }
        for (vertex, neighbour) in [(a, b), (b, a)] {
            if states.get(index(vertex))?.rule == Rule::Crease {
                let sum = sums.get_mut(index(vertex))?;
                blend.add(sum, 1, points.get(index(neighbour))?);
            }
        }
    }
    Some(())
}

/// The vertex on a crease whose neighbours along it are already in `sum`.
pub(crate) fn crease_vertex<B: Blend>(blend: &mut B, sum: &mut B::Sum, own: &B::Point) -> B::Point {
    blend.add(sum, 6, own);
    blend.divide(sum, 8)
}

/// Halfway between two values.
pub(crate) fn halfway<B: Blend>(
    blend: &mut B,
    [a, b]: [u32; 2],
    points: &[B::Point],
) -> Option<B::Point> {
    let mut sum = blend.zero();
    blend.add(&mut sum, 1, points.get(index(a))?);
    blend.add(&mut sum, 1, points.get(index(b))?);
    Some(blend.divide(&sum, 2))
}

/// Adds to every smooth vertex its neighbours, `weight` times each.
pub(crate) fn gather_ring<B: Blend>(
    blend: &B,
    edges: &SurfaceEdges<'_>,
    weight: i64,
    points: &[B::Point],
    sums: &mut [B::Sum],
    states: &[VertexState],
) -> Option<()> {
    for [a, b] in edges.ends() {
        for (vertex, neighbour) in [(a, b), (b, a)] {
            if states.get(index(vertex))?.rule == Rule::Smooth {
                let sum = sums.get_mut(index(vertex))?;
                blend.add(sum, weight, points.get(index(neighbour))?);
            }
        }
    }
    Some(())
}

/// Where a cubic B-spline's vertex goes in the limit, `1/6 4/6 1/6`; its neighbours are already in
/// `sum`.
pub(crate) fn crease_limit<B: Blend>(blend: &mut B, sum: &mut B::Sum, own: &B::Point) -> B::Point {
    blend.add(sum, 4, own);
    blend.divide(sum, 6)
}
