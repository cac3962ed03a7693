//! Memory of a fixed size to refine in, for devices.

use heapless::Vec;

use super::{
    Boundary, DiagonalBuffers, Diagonals, Face, Neighbours, Scheme, choose_diagonals,
    neighbour_capacity, refine_points, split_diagonals,
};
use crate::blend::Blend;
use crate::mesh::{Arena, MeshError, Solid, SolidArena, require};
use crate::solid::tet_oct;
use crate::solid::tet_oct::resize;

/// Owns the major diagonals of at most `T` tetrahedra and `O` octahedra.
#[derive(Clone, Debug, Default)]
pub struct DiagonalArena<const T: usize, const O: usize> {
    tetrahedra: Vec<u8, T>,
    octahedra: Vec<u8, O>,
}

impl<const T: usize, const O: usize> DiagonalArena<T, O> {
    /// No diagonals.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            tetrahedra: Vec::new(),
            octahedra: Vec::new(),
        }
    }

    /// The view that refinement takes.
    #[must_use]
    pub fn diagonals(&self) -> Diagonals<'_> {
        Diagonals {
            tetrahedra: &self.tetrahedra,
            octahedra: &self.octahedra,
        }
    }

    /// Copies diagonals, for example those that a baker chose.
    ///
    /// # Errors
    ///
    /// [`MeshError::ArenaTooSmall`]; these are then as they were.
    pub fn assign(&mut self, diagonals: &Diagonals<'_>) -> Result<(), MeshError> {
        let Diagonals {
            tetrahedra,
            octahedra,
        } = *diagonals;
        let buffers = self.resized(tetrahedra.len(), octahedra.len())?;
        buffers.tetrahedra.copy_from_slice(tetrahedra);
        buffers.octahedra.copy_from_slice(octahedra);
        Ok(())
    }

    /// Chooses the diagonals of a solid: see [`choose_diagonals`], which says what `faces` and
    /// `queue` must hold.
    ///
    /// # Errors
    ///
    /// Those of [`choose_diagonals`]; nothing promised of these diagonals then.
    pub fn choose(
        &mut self,
        solid: &Solid<'_>,
        faces: &mut [Face],
        queue: &mut [u32],
    ) -> Result<(), MeshError> {
        let buffers = self.resized(solid.tetrahedra.len(), solid.octahedra.len())?;
        choose_diagonals(solid, buffers, faces, queue).map(|_| ())
    }

    /// Makes both lists this long.
    fn resized(
        &mut self,
        tetrahedra: usize,
        octahedra: usize,
    ) -> Result<DiagonalBuffers<'_>, MeshError> {
        require(Arena::Diagonals, tetrahedra, T)?;
        require(Arena::Diagonals, octahedra, O)?;
        resize(&mut self.tetrahedra, tetrahedra, 0, Arena::Diagonals)?;
        resize(&mut self.octahedra, octahedra, 0, Arena::Diagonals)?;
        Ok(DiagonalBuffers {
            tetrahedra: &mut self.tetrahedra,
            octahedra: &mut self.octahedra,
        })
    }
}

/// Scratch memory for one level: as [`tet_oct::Scratch`] (edges `E`, octahedra `O`, refined
/// vertices `V`), and triples to find neighbours with (`N`: see [`neighbour_capacity`]).
pub struct Scratch<B: Blend, const E: usize, const O: usize, const V: usize, const N: usize> {
    level: tet_oct::Scratch<B, E, O, V>,
    neighbours: Vec<[u32; 3], N>,
}

impl<B: Blend, const E: usize, const O: usize, const V: usize, const N: usize> Default
    for Scratch<B, E, O, V, N>
{
    fn default() -> Self {
        Self::new()
    }
}

impl<B: Blend, const E: usize, const O: usize, const V: usize, const N: usize>
    Scratch<B, E, O, V, N>
{
    /// Empty scratch memory.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            level: tet_oct::Scratch::new(),
            neighbours: Vec::new(),
        }
    }

    /// Refines one level: the values into `out`, and the cells with their diagonals into `next`
    /// if the next level is wanted too. The averaged scheme leaves the diagonals empty.
    ///
    /// # Errors
    ///
    /// [`MeshError::ArenaTooSmall`] says which memory needs how much; `out` and `next` are then
    /// as they were. Otherwise those of [`Numbering::new`](crate::mesh::Numbering::new) and
    /// [`Neighbours::new`].
    #[expect(
        clippy::too_many_arguments,
        reason = "the same as the paper 1 scheme's, and which scheme"
    )]
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
        scheme: Scheme<'_>,
        boundary: Boundary,
        points: &[B::Point],
        out: &mut Vec<B::Point, P>,
        next: Option<(
            &mut SolidArena<T2, O2, S2, C2, K2>,
            &mut DiagonalArena<T2, O2>,
        )>,
    ) -> Result<(), MeshError> {
        let needed = neighbour_capacity(solid, &scheme).ok_or(MeshError::TooLarge)?;
        resize(&mut self.neighbours, needed, [0; 3], Arena::Neighbours)?;
        let neighbours = Neighbours::new(solid, scheme, &mut self.neighbours)?;
        let (next_solid, next_diagonals) = match next {
            Some((solid, diagonals)) => (Some(solid), Some(diagonals)),
            None => (None, None),
        };
        self.level.refine_by(
            blend,
            solid,
            points,
            out,
            next_solid,
            |blend, numbering, points, buffers| {
                refine_points(
                    blend,
                    solid,
                    numbering,
                    &neighbours,
                    boundary,
                    points,
                    buffers,
                )
                .map(|_| ())
            },
        )?;
        match next_diagonals {
            Some(next) => next.split_from(&scheme),
            None => Ok(()),
        }
    }
}

impl<const T: usize, const O: usize> DiagonalArena<T, O> {
    /// The diagonals of the children of a level's cells.
    fn split_from(&mut self, scheme: &Scheme<'_>) -> Result<(), MeshError> {
        let parents = match scheme {
            Scheme::MajorDiagonals(diagonals) => *diagonals,
            Scheme::Averaged => Diagonals::default(),
        };
        let counts = super::diagonals::child_counts(&parents).ok_or(MeshError::TooLarge)?;
        let [_, tetrahedra, _, octahedra] = counts;
        let buffers = self.resized(tetrahedra, octahedra)?;
        split_diagonals(&parents, buffers).map(|_| ())
    }
}
