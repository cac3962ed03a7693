//! The faces around a vertex from one sharp edge to the next.

use crate::mesh::{ControlMesh, Side, SurfaceEdges, index, start_of_side};
use crate::surface::features::{Rule, VertexState};

/// A run of faces around a vertex. Corners are places in the mesh's `indices`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Sector {
    pub vertex: u32,
    /// Its first corner, clockwise.
    pub first: u32,
    /// Its last one.
    pub last: u32,
    pub faces: u32,
    /// Faces go all round, or its two ends are the same edge.
    pub is_closed: bool,
    /// It lies at a vertex that stays.
    pub is_corner: bool,
}

/// A mesh whose vertices and edges have been classified.
pub(super) struct Around<'a> {
    pub mesh: &'a ControlMesh<'a>,
    pub edges: &'a SurfaceEdges<'a>,
    pub states: &'a [VertexState],
}

impl Around<'_> {
    /// The sector that a corner belongs to. A closed one starts at this corner.
    pub fn sector(&self, corner: u32) -> Option<Sector> {
        let vertex = self.vertex(corner)?;
        let rule = self.states.get(index(vertex))?.rule;
        let mut first = corner;
        let mut is_closed = false;
        // A walk cannot be longer than the list.
        for _ in self.mesh.indices {
            match self.clockwise(vertex, first, rule)? {
                Some(other) if other == corner => {
                    is_closed = true;
                    first = corner;
                    break;
                }
                Some(other) => first = other,
                None => break,
            }
        }
        let mut sector = Sector {
            vertex,
            first,
            last: first,
            faces: 1,
            is_closed,
            is_corner: rule == Rule::Linear,
        };
        for _ in self.mesh.indices {
            match self.counter_clockwise(vertex, sector.last, rule)? {
                Some(other) if other != first => {
                    sector.last = other;
                    sector.faces = sector.faces.saturating_add(1);
                }
                _ => break,
            }
        }
        sector.is_closed |= self.next(first)? == self.before(sector.last)?;
        Some(sector)
    }

    /// The corners of a sector, counter-clockwise.
    pub fn corners(&self, sector: &Sector) -> impl Iterator<Item = u32> {
        let vertex = sector.vertex;
        let rule = self.states.get(index(vertex)).map(|state| state.rule);
        let first = Some(sector.first);
        let step = move |corner: &u32| self.counter_clockwise(vertex, *corner, rule?).flatten();
        core::iter::successors(first, step).take(index(sector.faces))
    }

    /// The vertex after a corner's own in its face, and the next but one.
    pub fn neighbours(&self, corner: u32) -> Option<[u32; 2]> {
        let face = self.face(corner)?;
        Some([face.at(1)?, face.at(2)?])
    }

    /// The vertex after a corner's own in its face.
    pub fn next(&self, corner: u32) -> Option<u32> {
        self.face(corner)?.at(1)
    }

    /// The vertex before a corner's own in its face.
    pub fn before(&self, corner: u32) -> Option<u32> {
        let face = self.face(corner)?;
        face.at(face.vertices.len().checked_sub(1)?)
    }

    fn vertex(&self, corner: u32) -> Option<u32> {
        self.mesh.indices.get(index(corner)).copied()
    }

    fn face(&self, corner: u32) -> Option<FaceFrom<'_>> {
        let offsets = self.mesh.offsets;
        let face = offsets.partition_point(|&start| start <= corner);
        let &[start, end, ..] = offsets.get(face.checked_sub(1)?..)? else {
            return None;
        };
        Some(FaceFrom {
            vertices: self.mesh.indices.get(index(start)..index(end))?,
            place: index(corner.checked_sub(start)?),
        })
    }

    /// The next corner, over the edge by which the face arrives; none if that edge bounds the sector.
    fn counter_clockwise(&self, vertex: u32, corner: u32, rule: Rule) -> Option<Option<u32>> {
        let over = self.before(corner)?;
        let leaves = |side: &&Side| start_of_side(self.mesh, side) == Some(vertex);
        let sides = self.passable(vertex, over, rule)?;
        Some(sides.iter().find(leaves).map(|side| side.corner))
    }

    /// The corner before, over the edge by which the face leaves.
    fn clockwise(&self, vertex: u32, corner: u32, rule: Rule) -> Option<Option<u32>> {
        let over = self.next(corner)?;
        let arrives = |side: &&Side| start_of_side(self.mesh, side) == Some(over);
        let sides = self.passable(vertex, over, rule)?;
        let Some(side) = sides.iter().find(arrives) else {
            return Some(None);
        };
        // The side enters the edge at its other end; the vertex comes next in that face.
        let face = self.face(side.corner)?;
        let (start, corners) = (
            side.corner.checked_sub(u32::try_from(face.place).ok()?)?,
            face.vertices.len(),
        );
        let place = face.place.checked_add(1)?.checked_rem(corners)?;
        Some(start.checked_add(u32::try_from(place).ok()?))
    }

    /// The two sides of an edge that does not bound a sector; none of another.
    fn passable(&self, vertex: u32, over: u32, rule: Rule) -> Option<&[Side]> {
        let sides = self.edges.sides(vertex, over);
        let edge = sides.first()?.edge;
        let middle = self
            .states
            .get(index(self.edges.old_count().checked_add(edge)?))?;
        // A dart's crease does not part its faces.
        let is_open = sides.len() == 2 && (middle.sharp == 0 || rule == Rule::Smooth);
        Some(if is_open { sides } else { &[] })
    }
}

/// A face, seen from one of its corners.
struct FaceFrom<'a> {
    vertices: &'a [u32],
    place: usize,
}

impl FaceFrom<'_> {
    /// The vertex some places after the corner's own.
    fn at(&self, places: usize) -> Option<u32> {
        let place = self.place.checked_add(places)?;
        let place = place.checked_rem(self.vertices.len())?;
        self.vertices.get(place).copied()
    }
}
