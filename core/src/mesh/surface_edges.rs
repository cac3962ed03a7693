//! The edges of a control mesh and the faces that meet on them.

use super::control_mesh::{ControlMesh, index, length};
use super::error::{Arena, MeshError, Part};
use super::numbering::require;

/// One side of a face: where a face runs along an edge. An opaque piece of scratch memory to
/// callers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct Side {
    /// The edge's ends, ascending.
    pub(crate) ends: [u32; 2],
    /// Place in the mesh's `indices` of the corner where the face enters the edge.
    pub(crate) corner: u32,
    /// The face.
    pub(crate) face: u32,
    /// The edge's place among all edges in ascending order.
    pub(crate) edge: u32,
}

/// The edges of a control mesh in ascending order of their ends, each with its sides.
///
/// This is also the numbering of edge midpoints: the midpoint of edge `e` is vertex
/// `vertex_count + e` of the refined mesh.
#[derive(Clone, Copy, Debug)]
pub struct SurfaceEdges<'a> {
    old: u32,
    count: u32,
    sides: &'a [Side],
}

impl<'a> SurfaceEdges<'a> {
    /// Finds the edges of `mesh`.
    ///
    /// `sides` must hold one element for each of the mesh's `indices`. The time is that of sorting
    /// them.
    ///
    /// # Errors
    ///
    /// Those of [`ControlMesh::check`]; [`MeshError::ArenaTooSmall`] before anything is written;
    /// [`MeshError::NotAnEdge`] for a crease that does not run along an edge.
    pub fn new(mesh: &ControlMesh<'_>, sides: &'a mut [Side]) -> Result<Self, MeshError> {
        mesh.check()?;
        let needed = mesh.indices.len();
        require(Arena::Sides, needed, sides.len())?;
        let sides = sides.get_mut(..needed).unwrap_or_default();
        fill(mesh, sides);
        sides.sort_unstable();
        let count = number(sides);
        mesh.vertex_count
            .checked_add(count)
            .and_then(|sum| sum.checked_add(length(mesh.indices)))
            .ok_or(MeshError::TooLarge)?;
        let edges = Self {
            old: mesh.vertex_count,
            count,
            sides,
        };
        for (place, &[a, b]) in mesh.creases.iter().enumerate() {
            if edges.sides(a, b).is_empty() {
                return Err(MeshError::NotAnEdge {
                    part: Part::Crease,
                    index: place,
                    edge: [a, b],
                });
            }
        }
        Ok(edges)
    }

    /// Number of edges.
    #[must_use]
    pub fn count(&self) -> u32 {
        self.count
    }

    /// Number of vertices of the mesh whose edges these are.
    #[must_use]
    pub fn old_count(&self) -> u32 {
        self.old
    }

    /// Number of sides: corners of all faces together.
    pub(crate) fn side_count(&self) -> u32 {
        length(self.sides)
    }

    /// The sides that faces have on the edge from `a` to `b`; none if that is no edge.
    pub(crate) fn sides(&self, a: u32, b: u32) -> &'a [Side] {
        let key = [a.min(b), a.max(b)];
        let start = self.sides.partition_point(|side| side.ends < key);
        let rest = self.sides.get(start..).unwrap_or_default();
        let length = rest.iter().take_while(|side| side.ends == key).count();
        rest.get(..length).unwrap_or_default()
    }

    /// The place of the edge from `a` to `b` among all edges.
    #[must_use]
    pub fn find(&self, a: u32, b: u32) -> Option<u32> {
        Some(self.sides(a, b).first()?.edge)
    }

    /// Index of the midpoint of the edge from `a` to `b`, if that is an edge.
    #[must_use]
    pub fn midpoint(&self, a: u32, b: u32) -> Option<u32> {
        self.find(a, b)?.checked_add(self.old)
    }

    /// The sides on every edge, edge by edge in ascending order.
    pub(crate) fn iter(&self) -> impl Iterator<Item = &'a [Side]> + use<'a> {
        self.sides.chunk_by(|one, other| one.edge == other.edge)
    }

    /// The two ends of every edge, ascending, in ascending order.
    pub fn ends(&self) -> impl Iterator<Item = [u32; 2]> + use<'a> {
        self.iter()
            .filter_map(|sides| sides.first().map(|side| side.ends))
    }

    /// Refuses a mesh in which two faces run along an edge in the same direction.
    ///
    /// # Errors
    ///
    /// [`MeshError::Orientation`] for the first such edge.
    pub fn check_orientation(&self, mesh: &ControlMesh<'_>) -> Result<(), MeshError> {
        for sides in self.iter() {
            let [one, other] = sides else { continue };
            if start(mesh, one) == start(mesh, other) {
                return Err(MeshError::Orientation { edge: one.ends });
            }
        }
        Ok(())
    }
}

/// The corner where a side enters its edge.
pub(crate) fn start(mesh: &ControlMesh<'_>, side: &Side) -> Option<u32> {
    mesh.indices.get(index(side.corner)).copied()
}

/// Writes one side for every corner of every face.
fn fill(mesh: &ControlMesh<'_>, sides: &mut [Side]) {
    let mut corner = 0_u32;
    let mut slots = sides.iter_mut();
    for (face, vertices) in (0..).zip(mesh.faces()) {
        let ends = vertices.iter().cycle().skip(1);
        for (&from, &to) in vertices.iter().zip(ends) {
            if let Some(slot) = slots.next() {
                *slot = Side {
                    ends: [from.min(to), from.max(to)],
                    corner,
                    face,
                    edge: 0,
                };
            }
            corner = corner.wrapping_add(1);
        }
    }
}

/// Numbers the edges of the sorted sides and returns how many there are.
fn number(sides: &mut [Side]) -> u32 {
    let mut count = 0_u32;
    let groups = sides.chunk_by_mut(|one, other| one.ends == other.ends);
    for group in groups {
        for side in group {
            side.edge = count;
        }
        count = count.wrapping_add(1);
    }
    count
}
