//! Memory of a fixed size to refine in, for devices.

use heapless::Vec;

use super::{Boundary, PointBuffers, VertexState, refine_points, split, split_counts};
use crate::blend::Blend;
use crate::mesh::{Arena, MeshError, Numbering, Solid, SolidArena, edge_capacity, require};

/// Scratch memory for one level: edges to number (`E`, with repetitions: see
/// [`edge_capacity`]), octahedra of the mesh that is refined (`O`), and vertices of the refined
/// mesh (`V`).
#[derive(Debug)]
pub struct Scratch<B: Blend, const E: usize, const O: usize, const V: usize> {
    edges: Vec<[u32; 2], E>,
    octahedra: Vec<u32, O>,
    sums: Vec<B::Sum, V>,
    states: Vec<VertexState, V>,
}

impl<B: Blend, const E: usize, const O: usize, const V: usize> Default for Scratch<B, E, O, V> {
    fn default() -> Self {
        Self::new()
    }
}

impl<B: Blend, const E: usize, const O: usize, const V: usize> Scratch<B, E, O, V> {
    /// Empty scratch memory.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            edges: Vec::new(),
            octahedra: Vec::new(),
            sums: Vec::new(),
            states: Vec::new(),
        }
    }

    /// Numbers the vertices of the split of `solid` in this memory.
    ///
    /// # Errors
    ///
    /// Those of [`Numbering::new`].
    pub fn number(&mut self, solid: &Solid<'_>) -> Result<Numbering<'_>, MeshError> {
        number(&mut self.edges, &mut self.octahedra, solid)
    }

    /// Refines one level: the values into `out`, and the cells into `next` if the next level is
    /// wanted too.
    ///
    /// # Errors
    ///
    /// [`MeshError::ArenaTooSmall`] says which memory needs how much; `out` and `next` are then
    /// as they were. Otherwise those of [`Numbering::new`].
    pub fn refine<
        const P: usize,
        const T2: usize,
        const O2: usize,
        const S2: usize,
        const C2: usize,
        const K2: usize,
    >(
        &mut self,
        blend: &mut B,
        solid: &Solid<'_>,
        boundary: Boundary,
        points: &[B::Point],
        out: &mut Vec<B::Point, P>,
        next: Option<&mut SolidArena<T2, O2, S2, C2, K2>>,
    ) -> Result<(), MeshError> {
        self.refine_by(
            blend,
            solid,
            points,
            out,
            next,
            |blend, numbering, points, buffers| {
                refine_points(blend, solid, numbering, boundary, points, buffers).map(|_| ())
            },
        )
    }

    /// Refines one level with any scheme that splits cells as this one does: `refine` computes
    /// the values.
    pub(crate) fn refine_by<
        const P: usize,
        const T2: usize,
        const O2: usize,
        const S2: usize,
        const C2: usize,
        const K2: usize,
    >(
        &mut self,
        blend: &mut B,
        solid: &Solid<'_>,
        points: &[B::Point],
        out: &mut Vec<B::Point, P>,
        next: Option<&mut SolidArena<T2, O2, S2, C2, K2>>,
        refine: impl FnOnce(
            &mut B,
            &Numbering<'_>,
            &[B::Point],
            PointBuffers<'_, B>,
        ) -> Result<(), MeshError>,
    ) -> Result<(), MeshError> {
        let numbering = number(&mut self.edges, &mut self.octahedra, solid)?;
        let vertices = usize::try_from(numbering.vertex_count()).unwrap_or(usize::MAX);
        let old = usize::try_from(solid.vertex_count).unwrap_or(usize::MAX);
        require(Arena::InputPoints, old, points.len())?;
        require(Arena::OutputPoints, vertices, P)?;
        require(Arena::Sums, vertices, V)?;
        if let Some(next) = next {
            next.fill(
                split_counts(solid, &numbering).ok_or(MeshError::TooLarge)?,
                |buffers| split(solid, &numbering, buffers).map(|solid| solid.vertex_count),
            )?;
        }
        let zero = blend.zero();
        let none = blend.divide(&zero, 1);
        resize(&mut self.sums, vertices, zero, Arena::Sums)?;
        resize(
            &mut self.states,
            vertices,
            VertexState::default(),
            Arena::States,
        )?;
        resize(out, vertices, none, Arena::OutputPoints)?;
        let buffers = PointBuffers {
            out,
            sums: &mut self.sums,
            states: &mut self.states,
        };
        refine(blend, &numbering, points, buffers)
    }
}

fn number<'a, const E: usize, const O: usize>(
    edges: &'a mut Vec<[u32; 2], E>,
    octahedra: &'a mut Vec<u32, O>,
    solid: &Solid<'_>,
) -> Result<Numbering<'a>, MeshError> {
    let edges_needed = edge_capacity(solid).ok_or(MeshError::TooLarge)?;
    require(Arena::OctahedronOrder, solid.octahedra.len(), O)?;
    resize(edges, edges_needed, [0; 2], Arena::Edges)?;
    resize(octahedra, solid.octahedra.len(), 0, Arena::OctahedronOrder)?;
    Numbering::new(solid, edges, octahedra)
}

/// Makes a vector `needed` long, or says that it cannot be.
pub(crate) fn resize<T: Clone, const N: usize>(
    vector: &mut Vec<T, N>,
    needed: usize,
    value: T,
    arena: Arena,
) -> Result<(), MeshError> {
    vector
        .resize(needed, value)
        .map_err(|_| MeshError::ArenaTooSmall {
            arena,
            needed,
            given: N,
        })
}
