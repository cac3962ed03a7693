//! Adaptive square-root-3 refinement of closed meshes, in memory of a fixed size.
//!
//! # Generations
//!
//! Every triangle has a generation. An even one, `2 k`, is a triangle of the uniform mesh after `k`
//! steps. Splitting it puts a vertex into it and leaves three triangles of the odd generation
//! `2 k + 1`; where two of those meet, their common edge is flipped and both are of generation
//! `2 k + 2`. So the mesh has no gaps at any moment, and every even triangle is one of the uniform
//! mesh.
//!
//! Splitting an odd triangle means splitting the neighbour across its outer edge until the two can
//! flip. Before an even triangle is split, every neighbour of an older odd generation is split, so
//! that generations of neighbours differ by one at most and the ring of every new vertex is known.
//!
//! # Positions
//!
//! A vertex keeps the position that it was born with and the values of its ring at that moment. The
//! ring of a vertex maps to itself: one step on, the vertex follows rule (2) and each ring value is
//! the mean (rule (1)) of the vertex and two neighbouring ring values. So
//! [`AdaptiveMesh::position`] finds the position at any later level by rules (1) and (2), level by
//! level, rounding where uniform refinement rounds: it is the uniform mesh's position to the bit.

mod build;
mod position;
mod split;

pub use position::Patch;

use super::multi_step::Steps;
use crate::blend::Blend;
#[cfg(doc)]
use crate::mesh::MeshError;
use crate::mesh::index;

/// Greatest level of a vertex; triangles reach twice this generation.
pub const LEVEL_MAXIMUM: u32 = 30;

/// A triangle of an adaptive mesh.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct AdaptiveTriangle {
    /// Corners, counter-clockwise. An odd triangle's first corner is the vertex that was put into
    /// its parent.
    pub vertices: [u32; 3],
    /// Neighbours: element `i` lies opposite corner `i`. An odd triangle's first is its outer one.
    pub neighbours: [u32; 3],
    /// Even: a triangle of the uniform mesh after half as many steps. Odd: between two such.
    pub generation: u32,
}

/// A vertex of an adaptive mesh; its values lie in other lists.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct AdaptiveVertex {
    /// The first level that has this vertex.
    pub birth: u32,
    /// Number of ring vertices.
    pub valence: u32,
    /// Where its ring values start.
    ring: u32,
}

/// Memory for an adaptive mesh. What a mesh needs at the start is one triangle and three ring values
/// for each triangle and one vertex for each vertex; every split of an even triangle needs one
/// vertex, two triangles and six ring values more.
#[derive(Debug)]
pub struct AdaptiveBuffers<'a, P> {
    /// Triangles.
    pub triangles: &'a mut [AdaptiveTriangle],
    /// Vertices.
    pub vertices: &'a mut [AdaptiveVertex],
    /// One value for each vertex.
    pub positions: &'a mut [P],
    /// Ring values.
    pub rings: &'a mut [P],
    /// Scratch: as many values as the greatest valence, 6 at least.
    pub ring_scratch: &'a mut [P],
}

/// A closed mesh that is refined where its owner wants it.
#[derive(Debug)]
pub struct AdaptiveMesh<'a, B: Blend> {
    memory: AdaptiveBuffers<'a, B::Point>,
    triangle_count: usize,
    vertex_count: usize,
    ring_count: usize,
}

impl<B: Blend> AdaptiveMesh<'_, B> {
    /// The triangles, all generations mixed.
    #[must_use]
    pub fn triangles(&self) -> &[AdaptiveTriangle] {
        self.memory
            .triangles
            .get(..self.triangle_count)
            .unwrap_or_default()
    }

    /// The vertices, those of the control mesh first.
    #[must_use]
    pub fn vertices(&self) -> &[AdaptiveVertex] {
        self.memory
            .vertices
            .get(..self.vertex_count)
            .unwrap_or_default()
    }

    fn triangle(&self, triangle: u32) -> Option<&AdaptiveTriangle> {
        self.triangles().get(index(triangle))
    }

    fn triangle_mut(&mut self, triangle: u32) -> Option<&mut AdaptiveTriangle> {
        self.memory
            .triangles
            .get_mut(..self.triangle_count)?
            .get_mut(index(triangle))
    }

    /// Ring values of a vertex at its birth.
    fn ring(&self, vertex: &AdaptiveVertex) -> &[B::Point] {
        let start = index(vertex.ring);
        let end = start.saturating_add(index(vertex.valence));
        self.memory.rings.get(start..end).unwrap_or_default()
    }

    /// The limit position of a vertex, by (7) from its ring at birth, rounded once. `None` if there
    /// is no such vertex.
    pub fn limit(&self, blend: &mut B, vertex: u32) -> Option<B::Point> {
        let facts = self.vertices().get(index(vertex))?;
        let own = self.memory.positions.get(index(vertex))?;
        Some(super::multi_step::ring_position(
            blend,
            own,
            self.ring(facts),
            Steps::Limit,
        ))
    }
}
