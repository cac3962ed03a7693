//! Which number each new vertex gets, and which step a mesh can take.

use crate::mesh::{Arena, ControlMesh, FaceOrder, MeshError, Side, SurfaceEdges, index, require};
use crate::surface::features::{Rim, Rule, VertexState, classify};
use crate::surface::split::{require_triangles, same_mesh};

/// Memory for a [`Numbering`].
#[derive(Debug)]
pub struct NumberingBuffers<'a> {
    /// One element for each vertex and one for each edge.
    pub states: &'a mut [VertexState],
    /// One element for each edge.
    pub edge_vertices: &'a mut [u32],
    /// One element for each face.
    pub face_vertices: &'a mut [u32],
}

/// Stands for no vertex. A mesh has fewer vertices.
const NONE: u32 = u32::MAX;

/// The new vertices of a square-root-3 step: old vertices keep their index; then come, in an odd
/// step, two for each sharp edge by ascending ends (the one by the lesser end first); then one for
/// each triangle that gets one, by ascending sorted corners.
#[derive(Clone, Copy, Debug)]
pub struct Numbering<'a> {
    pub(super) edges: SurfaceEdges<'a>,
    pub(super) states: &'a [VertexState],
    edge_vertices: &'a [u32],
    face_vertices: &'a [u32],
    vertex_count: u32,
}

impl<'a> Numbering<'a> {
    /// Numbers the vertices of the next step and checks that the mesh can take it. `edges` and
    /// `order` must be of the same mesh.
    ///
    /// # Errors
    ///
    /// [`MeshError::NotATriangle`], [`MeshError::Orientation`]; [`MeshError::ArenaTooSmall`];
    /// [`MeshError::NotTrisectable`] in an odd step beside the end of a sharp line, and
    /// [`MeshError::TwoSharpEdges`] in an odd step for a triangle that no even step leaves;
    /// [`MeshError::OtherNumbering`].
    pub fn new(
        mesh: &ControlMesh<'_>,
        edges: SurfaceEdges<'a>,
        order: &FaceOrder<'_>,
        buffers: NumberingBuffers<'a>,
    ) -> Result<Self, MeshError> {
        require_triangles(mesh)?;
        if !same_mesh(mesh, &edges, order.len()) {
            return Err(MeshError::OtherNumbering);
        }
        edges.check_orientation(mesh)?;
        let old = index(mesh.vertex_count);
        let edge_count = index(edges.count());
        let all = old.checked_add(edge_count).ok_or(MeshError::TooLarge)?;
        require(Arena::States, all, buffers.states.len())?;
        require(Arena::EdgeVertices, edge_count, buffers.edge_vertices.len())?;
        require(
            Arena::FaceVertices,
            mesh.face_count(),
            buffers.face_vertices.len(),
        )?;
        let states = buffers.states.get_mut(..all).unwrap_or_default();
        states.fill(VertexState::default());
        classify(mesh, &edges, Rim::Spline, states).ok_or(MeshError::OtherNumbering)?;
        for state in states.get_mut(..old).unwrap_or_default() {
            // The paper does not define a crease's end: it stays.
            if state.sharp == 1 {
                state.rule = Rule::Linear;
            }
        }
        let mut numbering = Self {
            edges,
            states,
            edge_vertices: &[],
            face_vertices: &[],
            vertex_count: mesh.vertex_count,
        };
        let edge_vertices = buffers.edge_vertices.get_mut(..edge_count);
        let face_vertices = buffers.face_vertices.get_mut(..mesh.face_count());
        numbering.edge_vertices =
            numbering.number_edges(mesh.odd, edge_vertices.unwrap_or_default())?;
        numbering.face_vertices =
            numbering.number_faces(mesh, order, face_vertices.unwrap_or_default())?;
        Ok(numbering)
    }

    /// Number of vertices after the step.
    #[must_use]
    pub fn vertex_count(&self) -> u32 {
        self.vertex_count
    }

    /// Two vertices on every sharp edge if the step is odd.
    fn number_edges<'b>(
        &mut self,
        odd: bool,
        vertices: &'b mut [u32],
    ) -> Result<&'b [u32], MeshError> {
        vertices.fill(NONE);
        if !odd {
            return Ok(vertices);
        }
        for (ends, slot) in self.edges.ends().zip(vertices.iter_mut()) {
            if !self.is_sharp(ends) {
                continue;
            }
            for vertex in ends {
                if self.rule(vertex) != Rule::Crease {
                    return Err(MeshError::NotTrisectable { vertex });
                }
            }
            *slot = self.vertex_count;
            self.vertex_count = self
                .vertex_count
                .checked_add(2)
                .ok_or(MeshError::TooLarge)?;
        }
        Ok(vertices)
    }

    /// A vertex in every triangle that is not cut into a fan.
    fn number_faces<'b>(
        &mut self,
        mesh: &ControlMesh<'_>,
        order: &FaceOrder<'_>,
        vertices: &'b mut [u32],
    ) -> Result<&'b [u32], MeshError> {
        vertices.fill(NONE);
        for face in order.iter() {
            let &[a, b, c] = mesh.face(face) else {
                continue;
            };
            let sides = [[a, b], [b, c], [c, a]];
            let sharp = sides.iter().filter(|&&ends| self.is_sharp(ends)).count();
            match (mesh.odd, sharp) {
                (true, 1) => continue,
                (true, 2..) => return Err(MeshError::TwoSharpEdges { face }),
                _ => {}
            }
            if let Some(slot) = vertices.get_mut(face) {
                *slot = self.vertex_count;
                self.vertex_count = self
                    .vertex_count
                    .checked_add(1)
                    .filter(|&count| count != NONE)
                    .ok_or(MeshError::TooLarge)?;
            }
        }
        Ok(vertices)
    }

    /// True for an edge that is not flipped.
    pub(super) fn is_sharp(&self, [a, b]: [u32; 2]) -> bool {
        self.edges
            .midpoint(a, b)
            .and_then(|middle| self.states.get(index(middle)))
            .is_some_and(|state| state.sharp > 0)
    }

    /// The rule of an old vertex.
    pub(super) fn rule(&self, vertex: u32) -> Rule {
        self.states
            .get(index(vertex))
            .map_or(Rule::Linear, |state| state.rule)
    }

    /// The vertex in a face, if it gets one.
    pub(super) fn centre(&self, face: usize) -> Option<u32> {
        self.face_vertices
            .get(face)
            .copied()
            .filter(|&vertex| vertex != NONE)
    }

    /// The new vertex on the edge from `near` to `far` that lies by `near`, if the edge is
    /// trisected.
    pub(super) fn third(&self, near: u32, far: u32) -> Option<u32> {
        let first = *self.edge_vertices.get(index(self.edges.find(near, far)?))?;
        match first {
            NONE => None,
            first if near < far => Some(first),
            first => first.checked_add(1),
        }
    }

    /// The faces on an edge.
    pub(super) fn sides(&self, a: u32, b: u32) -> &'a [Side] {
        self.edges.sides(a, b)
    }
}
