//! The faces around each vertex of a control mesh, in order.

use super::control_mesh::{ControlMesh, index, length};
use super::error::{Arena, MeshError};
use super::numbering::require;
use super::surface_edges::{Side, SurfaceEdges, start};

/// Stands for a vertex that faces do not go all round. A mesh has fewer corners.
const NONE: u32 = u32::MAX;

/// Where to start walking round each vertex that faces go all round.
#[derive(Clone, Copy, Debug)]
pub struct Fans<'a> {
    mesh: ControlMesh<'a>,
    edges: SurfaceEdges<'a>,
    starts: &'a [u32],
}

impl<'a> Fans<'a> {
    /// Finds the closed fans of a mesh. `starts` must hold one element for each vertex.
    ///
    /// # Errors
    ///
    /// [`MeshError::Orientation`]; [`MeshError::NotManifold`] for an edge of more than two faces or
    /// a vertex at which two fans touch; [`MeshError::ArenaTooSmall`];
    /// [`MeshError::OtherNumbering`] if the edges are of another mesh.
    pub fn new(
        mesh: ControlMesh<'a>,
        edges: SurfaceEdges<'a>,
        starts: &'a mut [u32],
    ) -> Result<Self, MeshError> {
        let vertices = index(mesh.vertex_count);
        require(Arena::FanStarts, vertices, starts.len())?;
        edges.check_orientation(&mesh)?;
        let starts = starts.get_mut(..vertices).unwrap_or_default();
        starts.fill(NONE);
        // Backwards, so that the first corner of each vertex stays.
        for (&vertex, corner) in mesh.indices.iter().zip(0..length(mesh.indices)).rev() {
            *starts
                .get_mut(index(vertex))
                .ok_or(MeshError::OtherNumbering)? = corner;
        }
        for sides in edges.iter() {
            let Some(&Side { ends, .. }) = sides.first() else {
                continue;
            };
            match sides {
                [_] => ends.map(|end| starts.get_mut(index(end)).map(|start| *start = NONE)),
                [_, _] => continue,
                _ => {
                    let [vertex, _] = ends;
                    return Err(MeshError::NotManifold { vertex });
                }
            };
        }
        let fans = Self {
            mesh,
            edges,
            starts,
        };
        fans.check_single()?;
        Ok(fans)
    }

    /// Refuses a vertex at which more corners lie than its fan has.
    fn check_single(&self) -> Result<(), MeshError> {
        let on_rim = |vertex: u32| self.starts.get(index(vertex)) == Some(&NONE);
        let rim = self.mesh.indices.iter().filter(|&&vertex| on_rim(vertex));
        let walked = (0..self.mesh.vertex_count)
            .map(|vertex| self.around(vertex).count())
            .fold(rim.count(), usize::saturating_add);
        if walked == self.mesh.indices.len() {
            return Ok(());
        }
        let doubled = (0..self.mesh.vertex_count).find(|&vertex| {
            let corners = self.mesh.indices.iter().filter(|&&at| at == vertex);
            !on_rim(vertex) && corners.count() != self.around(vertex).count()
        });
        Err(MeshError::NotManifold {
            vertex: doubled.unwrap_or_default(),
        })
    }

    /// Number of vertices that faces go all round, and of corners at them.
    pub(crate) fn closed_counts(&self) -> (usize, usize) {
        let closed = (0..self.mesh.vertex_count)
            .map(|vertex| self.around(vertex).count())
            .filter(|&count| count > 0);
        closed.fold((0, 0), |(fans, corners), count| {
            (fans.saturating_add(1), corners.saturating_add(count))
        })
    }

    /// Places in `indices` of the corners at a vertex, counter-clockwise from the first in the list;
    /// none if faces do not go all round it.
    pub(crate) fn around(&self, vertex: u32) -> impl Iterator<Item = u32> + use<'a> {
        let fans = *self;
        let first = self.starts.get(index(vertex)).copied().unwrap_or(NONE);
        let mut next = (first != NONE).then_some(first);
        core::iter::from_fn(move || {
            let corner = next?;
            next = fans.step(vertex, corner).filter(|&other| other != first);
            Some(corner)
        })
        // A walk cannot be longer than the list.
        .take(self.mesh.indices.len())
    }

    /// From a corner at a vertex to the next one counter-clockwise, over the edge by which the face
    /// arrives.
    fn step(&self, vertex: u32, corner: u32) -> Option<u32> {
        let before = *self.mesh.indices.get(index(self.before(corner)?))?;
        self.edges
            .sides(vertex, before)
            .iter()
            .find(|side| start(&self.mesh, side) == Some(vertex))
            .map(|side| side.corner)
    }

    /// The place of the corner before this one in its face.
    fn before(&self, corner: u32) -> Option<u32> {
        let face = self
            .mesh
            .offsets
            .partition_point(|&start| start <= corner)
            .checked_sub(1)?;
        let &[first, end, ..] = self.mesh.offsets.get(face..)? else {
            return None;
        };
        if corner == first {
            end.checked_sub(1)
        } else {
            corner.checked_sub(1)
        }
    }

    /// The mesh whose fans these are.
    pub(crate) fn mesh(&self) -> &ControlMesh<'a> {
        &self.mesh
    }

    /// Its edges.
    pub(crate) fn edges(&self) -> &SurfaceEdges<'a> {
        &self.edges
    }
}
