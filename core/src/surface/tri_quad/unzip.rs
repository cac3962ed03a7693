//! The unzip (5.3.3): two clones of every vertex, for its triangles and for its quads.

use crate::blend::{Distortion, GuardedBlend};
use crate::mesh::{ControlMesh, MeshError, SurfaceEdges, index};
use crate::surface::features::{Rule, VertexState};
use crate::surface::tri_quad_weights::UNZIP_DENOMINATOR;

/// The two kinds of faces, as places of [`COLLAPSE`](crate::surface::tri_quad_weights::COLLAPSE).
pub(super) const TRIANGLE: usize = 0;
pub(super) const QUAD: usize = 1;

/// What an old vertex has gathered from the edges and the faces at it. An opaque piece of scratch
/// memory.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct VertexDistortion<S> {
    /// Over the edges between triangles and quads: the other end less the vertex.
    sum: S,
    /// How many such edges there are.
    edges: u32,
    /// The collapse weights of the new faces at the vertex, all together.
    pub(super) weight: u32,
}

impl<S> VertexDistortion<S> {
    /// Of a vertex of which nothing is known yet; `zero` is the empty sum of the value type.
    pub fn new(zero: S) -> Self {
        Self {
            sum: zero,
            edges: 0,
            weight: 0,
        }
    }
}

/// All old vertices with their distortions.
pub(super) struct Unzip<'a, B: GuardedBlend> {
    pub(super) points: &'a [B::Point],
    pub(super) distortions: &'a mut [VertexDistortion<B::Sum>],
}

impl<B: GuardedBlend> Unzip<'_, B> {
    /// Gathers every edge that a triangle and a quad share, at its ends that follow the smooth rule.
    pub(super) fn gather(
        &mut self,
        blend: &B,
        mesh: &ControlMesh<'_>,
        edges: &SurfaceEdges<'_>,
        states: &[VertexState],
    ) -> Result<(), MeshError> {
        let corners = |face: u32| mesh.face(index(face)).len();
        for sides in edges.iter() {
            let has = |count: usize| sides.iter().any(|side| corners(side.face) == count);
            let Some(side) = sides.first().filter(|_| has(3) && has(4)) else {
                continue;
            };
            let [a, b] = side.ends;
            for (own, other) in [(a, b), (b, a)] {
                let state = states.get(index(own)).ok_or(MeshError::OtherNumbering)?;
                if state.rule == Rule::Smooth {
                    self.add(blend, own, other)
                        .ok_or(MeshError::OtherNumbering)?;
                }
            }
        }
        Ok(())
    }

    fn add(&mut self, blend: &B, own: u32, other: u32) -> Option<()> {
        let distortion = self.distortions.get_mut(index(own))?;
        distortion.edges = distortion.edges.saturating_add(1);
        blend.add(&mut distortion.sum, -1, self.points.get(index(own))?);
        blend.add(&mut distortion.sum, 1, self.points.get(index(other))?);
        Some(())
    }

    /// A vertex's clone for [`TRIANGLE`] or [`QUAD`].
    pub(super) fn clone_for(&self, blend: &B, kind: usize, vertex: u32) -> Option<B::Guarded> {
        let own = self.points.get(index(vertex))?;
        let distortion = self.distortions.get(index(vertex))?;
        let part = Distortion {
            sum: &distortion.sum,
            count: distortion.edges,
            is_negative: kind != TRIANGLE,
        };
        Some(blend.distort(own, &[part], UNZIP_DENOMINATOR))
    }
}
