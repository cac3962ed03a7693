//! From a control mesh to an adaptive one.

use super::{AdaptiveBuffers, AdaptiveMesh, AdaptiveTriangle, AdaptiveVertex};
use crate::blend::Blend;
use crate::mesh::{Arena, ControlMesh, MeshError, Side, SurfaceEdges, index, length, require};
use crate::surface::split::{require_triangles, same_mesh};

impl<'a, B: Blend> AdaptiveMesh<'a, B> {
    /// Takes a closed mesh of triangles without creases; tagged corners are refused as well.
    /// `points` holds one value for each vertex.
    ///
    /// # Errors
    ///
    /// [`MeshError::NotATriangle`], [`MeshError::Orientation`], [`MeshError::Open`] for a boundary, a
    /// crease or an edge of more than two triangles, [`MeshError::NotManifold`] for a vertex without
    /// one ring of three triangles or more around it, or one that is a tagged corner;
    /// [`MeshError::ArenaTooSmall`]; [`MeshError::OtherNumbering`] if the edges are seen to be of
    /// another mesh.
    pub fn new(
        mesh: &ControlMesh<'_>,
        edges: &SurfaceEdges<'_>,
        points: &[B::Point],
        memory: AdaptiveBuffers<'a, B::Point>,
    ) -> Result<Self, MeshError> {
        require_triangles(mesh)?;
        if !same_mesh(mesh, edges, mesh.face_count()) {
            return Err(MeshError::OtherNumbering);
        }
        edges.check_orientation(mesh)?;
        if let Some(&[a, b]) = mesh.creases.first() {
            return Err(MeshError::Open { edge: [a, b] });
        }
        if let Some(&vertex) = mesh.corners.first() {
            return Err(MeshError::NotManifold { vertex });
        }
        let vertices = index(mesh.vertex_count);
        let triangles = mesh.face_count();
        require(Arena::InputPoints, vertices, points.len())?;
        require(Arena::AdaptiveTriangles, triangles, memory.triangles.len())?;
        require(Arena::AdaptiveVertices, vertices, memory.vertices.len())?;
        require(Arena::OutputPoints, vertices, memory.positions.len())?;
        require(Arena::AdaptiveRings, mesh.indices.len(), memory.rings.len())?;
        require(Arena::AdaptiveRings, 6, memory.ring_scratch.len())?;
        let mut adaptive = Self {
            memory,
            triangle_count: triangles,
            vertex_count: vertices,
            ring_count: 0,
        };
        for (slot, point) in adaptive.memory.positions.iter_mut().zip(points) {
            *slot = point.clone();
        }
        adaptive.join(mesh, edges)?;
        adaptive.find_rings(points)?;
        Ok(adaptive)
    }

    /// Writes the triangles with their neighbours.
    fn join(&mut self, mesh: &ControlMesh<'_>, edges: &SurfaceEdges<'_>) -> Result<(), MeshError> {
        let slots = self.memory.triangles.iter_mut();
        for ((face, corners), slot) in (0..).zip(mesh.faces()).zip(slots) {
            let &[a, b, c] = corners else { continue };
            let beyond = |from, to| match edges.sides(from, to) {
                [one, other] => Ok(other_face(face, one, other)),
                _ => Err(MeshError::Open { edge: [from, to] }),
            };
            *slot = AdaptiveTriangle {
                vertices: [a, b, c],
                neighbours: [beyond(b, c)?, beyond(c, a)?, beyond(a, b)?],
                generation: 0,
            };
        }
        Ok(())
    }

    /// Walks round every vertex once and keeps its ring's values.
    fn find_rings(&mut self, points: &[B::Point]) -> Result<(), MeshError> {
        let vertices = self.memory.vertices.get_mut(..self.vertex_count);
        vertices.unwrap_or_default().fill(AdaptiveVertex::default());
        for place in 0..self.triangle_count {
            let Some(&triangle) = self.triangles().get(place) else {
                continue;
            };
            for vertex in triangle.vertices {
                let known = self.vertices().get(index(vertex));
                if known.is_some_and(|facts| facts.valence == 0) {
                    self.find_ring(u32::try_from(place).unwrap_or(u32::MAX), vertex, points)?;
                }
            }
        }
        // Two rings around one vertex leave values of fewer triangles than there are.
        let walked = self.ring_count;
        if walked != self.triangle_count.saturating_mul(3) {
            return Err(MeshError::NotManifold {
                vertex: self.doubled_vertex(),
            });
        }
        Ok(())
    }

    fn find_ring(&mut self, first: u32, vertex: u32, points: &[B::Point]) -> Result<(), MeshError> {
        let broken = MeshError::NotManifold { vertex };
        let start = self.ring_count;
        let mut at = first;
        loop {
            let triangle = *self.triangle(at).ok_or(broken)?;
            let (next, neighbour) = step_round(&triangle, vertex).ok_or(broken)?;
            let value = points.get(index(neighbour)).ok_or(broken)?.clone();
            *self.memory.rings.get_mut(self.ring_count).ok_or(broken)? = value;
            self.ring_count = self.ring_count.saturating_add(1);
            at = next;
            if at == first {
                break;
            }
        }
        let valence = self.ring_count.saturating_sub(start);
        require(
            Arena::AdaptiveRings,
            valence,
            self.memory.ring_scratch.len(),
        )?;
        if valence < 3 {
            return Err(broken);
        }
        let slot = self.memory.vertices.get_mut(index(vertex)).ok_or(broken)?;
        *slot = AdaptiveVertex {
            birth: 0,
            valence: u32::try_from(valence).map_err(|_| MeshError::TooLarge)?,
            ring: u32::try_from(start).map_err(|_| MeshError::TooLarge)?,
        };
        Ok(())
    }

    /// A vertex that more triangles have than its ring.
    fn doubled_vertex(&self) -> u32 {
        let vertices = (0..length(self.vertices())).zip(self.vertices());
        let doubled = vertices.into_iter().find(|&(vertex, facts)| {
            let at = self
                .triangles()
                .iter()
                .filter(|triangle| triangle.vertices.contains(&vertex));
            at.count() != index(facts.valence)
        });
        doubled.map_or(0, |(vertex, _)| vertex)
    }
}

fn other_face(face: u32, one: &Side, other: &Side) -> u32 {
    if one.face == face {
        other.face
    } else {
        one.face
    }
}

/// From a triangle at a vertex to the next one counter-clockwise, and the ring vertex at which this
/// triangle starts.
fn step_round(triangle: &AdaptiveTriangle, vertex: u32) -> Option<(u32, u32)> {
    let [a, b, c] = triangle.vertices;
    let [opposite_a, opposite_b, opposite_c] = triangle.neighbours;
    // Counter-clockwise about the vertex: over the side from the last corner back to it.
    if vertex == a {
        Some((opposite_b, b))
    } else if vertex == b {
        Some((opposite_c, c))
    } else if vertex == c {
        Some((opposite_a, a))
    } else {
        None
    }
}
