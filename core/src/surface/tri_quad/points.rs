//! Values of the refined vertices.
//!
//! What the faces say is gathered into one exact sum for each refined vertex, and every sum is
//! divided once at the end, so the order of faces does not matter to any bit. Only the clones of the
//! unzip are rounded before, to 8 more bits than are stored.

use super::split::quads;
use super::unzip::{QUAD, TRIANGLE, Unzip, VertexDistortion};
use crate::blend::GuardedBlend;
use crate::mesh::{Arena, ControlMesh, FaceOrder, MeshError, SurfaceEdges, index, require};
use crate::surface::features::{Rim, Rule, VertexState, classify, halfway};
use crate::surface::split::{first_face_vertex, same_mesh};
use crate::surface::tri_quad_weights as weights;

/// What a smooth edge's two faces count in the collapse: three new triangles or two new quads of
/// each, and both come to the same.
const HALF_EDGE_WEIGHT: i64 = {
    let [triangle, quad] = weights::COLLAPSE;
    assert!(triangle * 3 == quad * 2, "the faces of an edge count alike");
    assert!(weights::TRIANGLE_EDGE_FACES == 3 && weights::QUAD_EDGE_FACES == 2);
    triangle * 3
};

/// Where refined values and the scratch to compute them are written.
///
/// `out`, `sums` and `states` each need one element for every vertex of the refined mesh,
/// `distortions` one for every vertex of the mesh that is refined.
#[derive(Debug)]
pub struct PointBuffers<'a, B: GuardedBlend> {
    /// The refined values: old vertices, then edges, then quads.
    pub out: &'a mut [B::Point],
    /// Scratch: one sum for each refined vertex.
    pub sums: &'a mut [B::GuardedSum],
    /// Scratch: one state for each refined vertex.
    pub states: &'a mut [VertexState],
    /// Scratch: what each old vertex gathers.
    pub distortions: &'a mut [VertexDistortion<B::Sum>],
}

/// Computes the values of the refined vertices: old vertices, then edge midpoints, then the middles
/// of the quads.
///
/// `edges` and `order` belong to `mesh`; `points` holds one value for each old vertex. Returns the
/// filled part of `buffers.out`. The rules are those of the [module documentation](super).
///
/// # Scaling and overflow
///
/// A distortion of `m` edges is a sum of `2 m` coordinates, below `2^32 m`, over `24 m`: a clone is at
/// most `2^8 (2^31 + 2^32 / 24)`, below `2^40`, in units of 2^-8 of the last place. All weights of a
/// mask over the clones are positive and add up to its denominator, at most `16 * 3 = 48` for each
/// face at the vertex: a sum is below `2^40 * 2^6 * 2^32`, far inside 128 bits. See [`GuardedBlend`].
///
/// # Errors
///
/// [`MeshError::NotATriangleOrQuad`] and [`MeshError::ArenaTooSmall`] before anything is written;
/// [`MeshError::OtherNumbering`] if the numbering is seen to be of another mesh.
pub fn refine_points<'a, B: GuardedBlend>(
    blend: &mut B,
    mesh: &ControlMesh<'_>,
    edges: &SurfaceEdges<'_>,
    order: &FaceOrder<'_>,
    rim: Rim,
    points: &[B::Point],
    buffers: PointBuffers<'a, B>,
) -> Result<&'a mut [B::Point], MeshError> {
    super::require_triangles_and_quads(mesh)?;
    if !same_mesh(mesh, edges, order.len()) {
        return Err(MeshError::OtherNumbering);
    }
    let PointBuffers {
        out,
        sums,
        states,
        distortions,
    } = prepare(blend, mesh, edges, points, buffers)?;
    classify(mesh, edges, rim, states).ok_or(MeshError::OtherNumbering)?;
    let mut unzip = Unzip {
        points,
        distortions: &mut *distortions,
    };
    unzip.gather(blend, mesh, edges, states)?;
    let mut gather = Gather {
        blend: &*blend,
        sums: &mut *sums,
        states,
        unzip,
    };
    gather
        .all(mesh, edges, order)
        .ok_or(MeshError::OtherNumbering)?;
    let mut finish = Finish {
        blend,
        points,
        states,
    };
    finish
        .all(edges, sums, distortions, out)
        .ok_or(MeshError::OtherNumbering)?;
    Ok(out)
}

/// Checks the sizes of the buffers and clears the scratch; returns exactly what is needed of each.
fn prepare<'a, B: GuardedBlend>(
    blend: &B,
    mesh: &ControlMesh<'_>,
    edges: &SurfaceEdges<'_>,
    points: &[B::Point],
    buffers: PointBuffers<'a, B>,
) -> Result<PointBuffers<'a, B>, MeshError> {
    let old = index(mesh.vertex_count);
    let counts = super::split_counts(mesh, edges).ok_or(MeshError::TooLarge)?;
    let new = counts.vertices;
    require(Arena::InputPoints, old, points.len())?;
    require(Arena::OutputPoints, new, buffers.out.len())?;
    require(Arena::Sums, new, buffers.sums.len())?;
    require(Arena::States, new, buffers.states.len())?;
    require(Arena::Distortions, old, buffers.distortions.len())?;
    let sums = buffers.sums.get_mut(..new).unwrap_or_default();
    let states = buffers.states.get_mut(..new).unwrap_or_default();
    let distortions = buffers.distortions.get_mut(..old).unwrap_or_default();
    sums.fill(blend.guarded_zero());
    states.fill(VertexState::default());
    distortions.fill(VertexDistortion::new(blend.zero()));
    Ok(PointBuffers {
        out: buffers.out.get_mut(..new).unwrap_or_default(),
        sums,
        states,
        distortions,
    })
}

/// The sums while they grow.
struct Gather<'a, B: GuardedBlend> {
    blend: &'a B,
    sums: &'a mut [B::GuardedSum],
    states: &'a [VertexState],
    unzip: Unzip<'a, B>,
}

impl<B: GuardedBlend> Gather<'_, B> {
    fn all(
        &mut self,
        mesh: &ControlMesh<'_>,
        edges: &SurfaceEdges<'_>,
        order: &FaceOrder<'_>,
    ) -> Option<()> {
        for face in mesh.faces() {
            if let &[a, b, c] = face {
                self.triangle([a, b, c], edges)?;
            }
        }
        for (face, middle) in quads(mesh, order).zip(first_face_vertex(edges)..) {
            if let &[a, b, c, d] = mesh.face(face) {
                self.quad([a, b, c, d], middle, edges)?;
            }
        }
        self.creases(edges)
    }

    /// What a triangle gives to its corners and edges.
    fn triangle(&mut self, [a, b, c]: [u32; 3], edges: &SurfaceEdges<'_>) -> Option<()> {
        let clone = |vertex| self.unzip.clone_for(self.blend, TRIANGLE, vertex);
        let [at_a, at_b, at_c] = [clone(a)?, clone(b)?, clone(c)?];
        for (from, to, corners) in [
            (a, b, [&at_a, &at_b, &at_c]),
            (b, c, [&at_b, &at_c, &at_a]),
            (c, a, [&at_c, &at_a, &at_b]),
        ] {
            let middle = edges.midpoint(from, to)?;
            self.face(TRIANGLE, middle, corners, &weights::TRIANGLE_EDGE)?;
            self.face(TRIANGLE, from, corners, &weights::TRIANGLE_CORNER)?;
            self.count(TRIANGLE, from)?;
        }
        Some(())
    }

    /// What a quad gives to its corners, its edges and its middle.
    fn quad(
        &mut self,
        [a, b, c, d]: [u32; 4],
        middle: u32,
        edges: &SurfaceEdges<'_>,
    ) -> Option<()> {
        let clone = |vertex| self.unzip.clone_for(self.blend, QUAD, vertex);
        let [at_a, at_b, at_c, at_d] = [clone(a)?, clone(b)?, clone(c)?, clone(d)?];
        for (from, to, corners) in [
            (a, b, [&at_a, &at_b, &at_c, &at_d]),
            (b, c, [&at_b, &at_c, &at_d, &at_a]),
            (c, d, [&at_c, &at_d, &at_a, &at_b]),
            (d, a, [&at_d, &at_a, &at_b, &at_c]),
        ] {
            let middle = edges.midpoint(from, to)?;
            self.face(QUAD, middle, corners, &weights::QUAD_EDGE)?;
            self.face(QUAD, from, corners, &weights::QUAD_CORNER)?;
            self.count(QUAD, from)?;
        }
        let corners = [&at_a, &at_b, &at_c, &at_d];
        self.face(QUAD, middle, corners, &weights::QUAD_MIDDLE)
    }

    /// Adds what a face says of a vertex, if that is smooth.
    fn face<const CORNERS: usize>(
        &mut self,
        kind: usize,
        vertex: u32,
        corners: [&B::Guarded; CORNERS],
        face_weights: &[i64; CORNERS],
    ) -> Option<()> {
        if self.states.get(index(vertex))?.rule != Rule::Smooth {
            return Some(());
        }
        let factor = *weights::COLLAPSE.get(kind)?;
        let sum = self.sums.get_mut(index(vertex))?;
        for (corner, weight) in corners.into_iter().zip(face_weights) {
            self.blend
                .add_guarded(sum, weight.wrapping_mul(factor), corner);
        }
        Some(())
    }

    /// Counts the one new face that a face has at its corner.
    fn count(&mut self, kind: usize, corner: u32) -> Option<()> {
        let weight = u32::try_from(*weights::COLLAPSE.get(kind)?).ok()?;
        let distortion = self.unzip.distortions.get_mut(index(corner))?;
        distortion.weight = distortion.weight.saturating_add(weight);
        Some(())
    }

    /// Neighbours along creases.
    fn creases(&mut self, edges: &SurfaceEdges<'_>) -> Option<()> {
        let middles = self.states.get(index(edges.old_count())..)?;
        for ([a, b], middle) in edges.ends().zip(middles) {
            if middle.sharp == 0 {
                continue;
            }
            for (vertex, neighbour) in [(a, b), (b, a)] {
                if self.states.get(index(vertex))?.rule == Rule::Crease {
                    let sum = self.sums.get_mut(index(vertex))?;
                    let point = self.unzip.points.get(index(neighbour))?;
                    self.blend.add_guarded(sum, 1, &self.blend.guard(point));
                }
            }
        }
        Some(())
    }
}

/// The divisions at the end, one for each refined vertex.
struct Finish<'a, B: GuardedBlend> {
    blend: &'a mut B,
    points: &'a [B::Point],
    states: &'a [VertexState],
}

impl<B: GuardedBlend> Finish<'_, B> {
    fn all(
        &mut self,
        edges: &SurfaceEdges<'_>,
        sums: &mut [B::GuardedSum],
        distortions: &[VertexDistortion<B::Sum>],
        out: &mut [B::Point],
    ) -> Option<()> {
        let (out_old, out) = out.split_at_mut_checked(index(edges.old_count()))?;
        let (out_edges, out_quads) = out.split_at_mut_checked(index(edges.count()))?;
        let mut given = sums.iter_mut().zip(self.states);

        let old = out_old.iter_mut().zip(self.points).zip(distortions);
        for (((slot, own), distortion), (sum, state)) in old.zip(given.by_ref()) {
            *slot = self.vertex(own, sum, state, i64::from(distortion.weight));
        }
        for ((slot, ends), (sum, state)) in
            out_edges.iter_mut().zip(edges.ends()).zip(given.by_ref())
        {
            *slot = if state.rule == Rule::Smooth {
                self.collapse(sum, HALF_EDGE_WEIGHT.wrapping_mul(2))
            } else {
                halfway(self.blend, ends, self.points)?
            };
        }
        let [_, quad] = weights::COLLAPSE;
        let middle = quad.wrapping_mul(i64::from(weights::QUAD_MIDDLE_FACES));
        for (slot, (sum, _)) in out_quads.iter_mut().zip(given) {
            *slot = self.collapse(sum, middle);
        }
        Some(())
    }

    /// An old vertex. A smooth one has a face, as it has an edge.
    fn vertex(
        &mut self,
        own: &B::Point,
        sum: &mut B::GuardedSum,
        state: &VertexState,
        weight: i64,
    ) -> B::Point {
        match state.rule {
            Rule::Linear => own.clone(),
            Rule::Smooth => self.collapse(sum, weight.max(1)),
            Rule::Crease => {
                let own = self.blend.guard(own);
                self.blend.add_guarded(sum, 6, &own);
                self.blend.divide_guarded(sum, 8)
            }
        }
    }

    /// The mean of what new faces of these collapse weights say.
    fn collapse(&mut self, sum: &B::GuardedSum, weight: i64) -> B::Point {
        let denominator = weight.wrapping_mul(weights::DENOMINATOR);
        self.blend.divide_guarded(sum, denominator)
    }
}
