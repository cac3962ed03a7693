//! Memory of a fixed size to refine mixed solids in, for devices.

use heapless::Vec;

use super::arena::MixedArena;
use super::classify::index;
use super::points::{PointBuffers, refine_points};
use super::{Boundary, VertexDistortion, VertexState, split, split_counts};
use crate::blend::GuardedBlend;
use crate::mesh::{
    Arena, MeshError, MixedNumbering, MixedNumberingBuffers, MixedNumberingSizes, QuadDiagonal,
    QuadFace, Solid, require,
};
use crate::solid::tet_oct::resize;

/// Scratch memory for the numbering of one level: edges (`E`), quadrilateral faces (`F`), their
/// diagonals (`D`, two for each), triangles of prisms (`R`), octahedra (`O`) and hexahedra (`H`) of
/// the mesh that is refined. [`MixedNumberingSizes`] says how many.
#[derive(Debug, Default)]
pub struct NumberingScratch<
    const E: usize,
    const F: usize,
    const D: usize,
    const R: usize,
    const O: usize,
    const H: usize,
> {
    edges: Vec<[u32; 2], E>,
    quads: Vec<QuadFace, F>,
    diagonals: Vec<QuadDiagonal, D>,
    prism_triangles: Vec<[u32; 3], R>,
    octahedra: Vec<u32, O>,
    hexahedra: Vec<u32, H>,
}

impl<const E: usize, const F: usize, const D: usize, const R: usize, const O: usize, const H: usize>
    NumberingScratch<E, F, D, R, O, H>
{
    /// Empty scratch memory.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            edges: Vec::new(),
            quads: Vec::new(),
            diagonals: Vec::new(),
            prism_triangles: Vec::new(),
            octahedra: Vec::new(),
            hexahedra: Vec::new(),
        }
    }

    /// Numbers the vertices of the split of `solid` in this memory.
    ///
    /// # Errors
    ///
    /// Those of [`MixedNumbering::new`].
    pub fn number(&mut self, solid: &Solid<'_>) -> Result<MixedNumbering<'_>, MeshError> {
        let sizes = MixedNumberingSizes::of(solid).ok_or(MeshError::TooLarge)?;
        resize(&mut self.edges, sizes.edges, [0; 2], Arena::Edges)?;
        let (face, diagonal) = (QuadFace::default(), QuadDiagonal::default());
        resize(&mut self.quads, sizes.quads, face, Arena::QuadFaces)?;
        let diagonals = &mut self.diagonals;
        resize(diagonals, sizes.diagonals, diagonal, Arena::QuadDiagonals)?;
        let triangles = sizes.prism_triangles;
        resize(
            &mut self.prism_triangles,
            triangles,
            [0; 3],
            Arena::PrismTriangles,
        )?;
        resize(
            &mut self.octahedra,
            sizes.octahedra,
            0,
            Arena::OctahedronOrder,
        )?;
        resize(
            &mut self.hexahedra,
            sizes.hexahedra,
            0,
            Arena::HexahedronOrder,
        )?;
        MixedNumbering::new(
            solid,
            MixedNumberingBuffers {
                edges: &mut self.edges,
                quads: &mut self.quads,
                diagonals: &mut self.diagonals,
                prism_triangles: &mut self.prism_triangles,
                octahedra: &mut self.octahedra,
                hexahedra: &mut self.hexahedra,
            },
        )
    }
}

/// Scratch memory for the values of one level: vertices of the mesh that is refined (`N`) and of
/// the refined mesh (`V`).
#[derive(Debug)]
pub struct PointScratch<B: GuardedBlend, const N: usize, const V: usize> {
    sums: Vec<B::GuardedSum, V>,
    states: Vec<VertexState, V>,
    distortions: Vec<VertexDistortion<B::Sum>, N>,
}

impl<B: GuardedBlend, const N: usize, const V: usize> Default for PointScratch<B, N, V> {
    fn default() -> Self {
        Self::new()
    }
}

impl<B: GuardedBlend, const N: usize, const V: usize> PointScratch<B, N, V> {
    /// Empty scratch memory.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            sums: Vec::new(),
            states: Vec::new(),
            distortions: Vec::new(),
        }
    }

    /// Computes the values of the refined vertices in this memory: see [`refine_points`].
    ///
    /// # Errors
    ///
    /// [`MeshError::ArenaTooSmall`] says which memory needs how much; `out` is then as it was.
    /// Otherwise those of [`refine_points`].
    pub fn refine<const P: usize>(
        &mut self,
        blend: &mut B,
        solid: &Solid<'_>,
        numbering: &MixedNumbering<'_>,
        boundary: Boundary,
        points: &[B::Point],
        out: &mut Vec<B::Point, P>,
    ) -> Result<(), MeshError> {
        let (old, new) = (index(solid.vertex_count), index(numbering.vertex_count()));
        require(Arena::InputPoints, old, points.len())?;
        require(Arena::OutputPoints, new, P)?;
        let zero = blend.zero();
        let none = blend.divide(&zero, 1);
        resize(&mut self.sums, new, blend.guarded_zero(), Arena::Sums)?;
        resize(&mut self.states, new, VertexState::default(), Arena::States)?;
        let distortion = VertexDistortion::new(&zero);
        resize(&mut self.distortions, old, distortion, Arena::Distortions)?;
        resize(out, new, none, Arena::OutputPoints)?;
        let buffers = PointBuffers {
            out,
            sums: &mut self.sums,
            states: &mut self.states,
            distortions: &mut self.distortions,
        };
        refine_points(blend, solid, numbering, boundary, points, buffers).map(|_| ())
    }
}

impl<
    const T: usize,
    const O: usize,
    const P: usize,
    const H: usize,
    const S: usize,
    const Q: usize,
    const C: usize,
    const K: usize,
> MixedArena<T, O, P, H, S, Q, C, K>
{
    /// Takes the split of a solid in place of what was there.
    ///
    /// # Errors
    ///
    /// [`MeshError::ArenaTooSmall`]; this solid is then as it was. Otherwise those of [`split`].
    pub fn assign_split(
        &mut self,
        solid: &Solid<'_>,
        numbering: &MixedNumbering<'_>,
    ) -> Result<(), MeshError> {
        let counts = split_counts(solid, numbering).ok_or(MeshError::TooLarge)?;
        self.fill(&counts, |buffers| {
            split(solid, numbering, buffers).map(|solid| solid.vertex_count)
        })
    }
}
