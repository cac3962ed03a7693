//! The memory that cases run in: fixed, and the same on the host and on a device.

use heapless::Vec;
use octruss::blend::FixedBlend;
use octruss::mesh::{Counts, Solid, SolidArena, SolidBuffers};
use octruss::solid::tet_oct::{Scratch, VertexState};

use super::Status;
use super::guard::{GUARD_ELEMENTS, lend};

/// Vertices after the last level.
pub const VERTICES: usize = 1024;
/// Vertices before the last level.
pub const VERTICES_BEFORE: usize = 256;
/// Control points of a table for 16-bit displacements.
pub const CONTROL_POINTS: usize = 64;
/// Faces of the solid of a case, shared ones counted every time.
const FACES: usize = 64;
/// Edges of the solid before the last level, of cells and surface, shared ones counted every time.
const EDGES: usize = 3000;
/// Octahedra of the solid before the last level.
const OCTAHEDRA: usize = 112;

/// The surface of the solid of a case: its boundary and its sheets.
pub(super) type Surface = Vec<[u32; 3], FACES>;

/// All memory of all kinds of cases.
pub struct Memory {
    /// For refinement in slices, and for rows of a table.
    pub(super) refine: RefineMemory,
    /// For refinement in core's own arenas.
    pub(super) owned: OwnedMemory,
}

impl Memory {
    /// Memory that has not been used.
    #[must_use]
    pub const fn new() -> Self {
        Memory {
            refine: RefineMemory::new(),
            owned: OwnedMemory::new(),
        }
    }
}

impl Default for Memory {
    fn default() -> Self {
        Self::new()
    }
}

/// Slices for [`super::refine`]. Levels take turns between the large and the small one of each
/// pair, so that the last level's points, and the cells before it, meet the large ones.
pub(super) struct RefineMemory {
    pub faces: [[u32; 3]; FACES + GUARD_ELEMENTS],
    pub surface: Surface,
    pub edges: [[u32; 2]; EDGES + GUARD_ELEMENTS],
    pub octahedron_order: [u32; OCTAHEDRA + GUARD_ELEMENTS],
    pub sums: [[i64; 3]; VERTICES + GUARD_ELEMENTS],
    pub states: Vec<VertexState, VERTICES>,
    pub points_large: [[i32; 3]; VERTICES + GUARD_ELEMENTS],
    pub points_small: [[i32; 3]; VERTICES_BEFORE + GUARD_ELEMENTS],
    pub cells_large: CellArrays<226, 114, 354, 66, 10>,
    pub cells_small: CellArrays<66, 26, 162, 34, 10>,
}

impl RefineMemory {
    const fn new() -> Self {
        RefineMemory {
            faces: [[0; 3]; FACES + GUARD_ELEMENTS],
            surface: Surface::new(),
            edges: [[0; 2]; EDGES + GUARD_ELEMENTS],
            octahedron_order: [0; OCTAHEDRA + GUARD_ELEMENTS],
            sums: [[0; 3]; VERTICES + GUARD_ELEMENTS],
            states: Vec::new(),
            points_large: [[0; 3]; VERTICES + GUARD_ELEMENTS],
            points_small: [[0; 3]; VERTICES_BEFORE + GUARD_ELEMENTS],
            cells_large: CellArrays::new(),
            cells_small: CellArrays::new(),
        }
    }
}

/// The lists of one solid. The capacities include the guards' elements.
pub(super) struct CellArrays<
    const T: usize,
    const O: usize,
    const S: usize,
    const C: usize,
    const K: usize,
> {
    tetrahedra: [[u32; 4]; T],
    octahedra: [[u32; 6]; O],
    surface: [[u32; 3]; S],
    creases: [[u32; 2]; C],
    corners: [u32; K],
}

impl<const T: usize, const O: usize, const S: usize, const C: usize, const K: usize>
    CellArrays<T, O, S, C, K>
{
    const fn new() -> Self {
        CellArrays {
            tetrahedra: [[0; 4]; T],
            octahedra: [[0; 6]; O],
            surface: [[0; 3]; S],
            creases: [[0; 2]; C],
            corners: [0; K],
        }
    }

    /// These lists as slices, holding the empty solid.
    pub fn slices(&mut self) -> CellSlices<'_> {
        CellSlices {
            tetrahedra: &mut self.tetrahedra,
            octahedra: &mut self.octahedra,
            surface: &mut self.surface,
            creases: &mut self.creases,
            corners: &mut self.corners,
            counts: Counts::default(),
        }
    }
}

/// The lists of one solid, whatever their capacities.
pub(super) struct CellSlices<'a> {
    tetrahedra: &'a mut [[u32; 4]],
    octahedra: &'a mut [[u32; 6]],
    surface: &'a mut [[u32; 3]],
    creases: &'a mut [[u32; 2]],
    corners: &'a mut [u32],
    /// What the lists hold now.
    counts: Counts,
}

impl CellSlices<'_> {
    /// The solid that the lists hold.
    pub fn solid(&self) -> Solid<'_> {
        let Counts {
            vertices,
            tetrahedra,
            octahedra,
            surface,
            creases,
            corners,
            ..
        } = self.counts;
        Solid {
            vertex_count: u32::try_from(vertices).unwrap_or(u32::MAX),
            tetrahedra: self.tetrahedra.get(..tetrahedra).unwrap_or_default(),
            octahedra: self.octahedra.get(..octahedra).unwrap_or_default(),
            surface: self.surface.get(..surface).unwrap_or_default(),
            creases: self.creases.get(..creases).unwrap_or_default(),
            corners: self.corners.get(..corners).unwrap_or_default(),
            ..Solid::default()
        }
    }

    /// Whether a solid of this size fits.
    pub fn holds(&self, counts: &Counts) -> bool {
        let free =
            |capacity: usize, needed: usize| needed <= capacity.saturating_sub(GUARD_ELEMENTS);
        free(self.tetrahedra.len(), counts.tetrahedra)
            && free(self.octahedra.len(), counts.octahedra)
            && free(self.surface.len(), counts.surface)
            && free(self.creases.len(), counts.creases)
            && free(self.corners.len(), counts.corners)
    }

    /// Lends the lists at the lengths of `counts`, to be filled with the solid of that size.
    /// Checks afterwards that nothing behind them was written; `first_buffer` is the number of
    /// the first list.
    pub fn fill(
        &mut self,
        counts: Counts,
        first_buffer: u32,
        write: impl FnOnce(SolidBuffers<'_>) -> Result<(), Status>,
    ) -> Result<(), Status> {
        self.counts = counts;
        let (tetrahedra, behind_tetrahedra) = lend(self.tetrahedra, counts.tetrahedra);
        let (octahedra, behind_octahedra) = lend(self.octahedra, counts.octahedra);
        let (surface, behind_surface) = lend(self.surface, counts.surface);
        let (creases, behind_creases) = lend(self.creases, counts.creases);
        let (corners, behind_corners) = lend(self.corners, counts.corners);
        write(SolidBuffers {
            tetrahedra,
            octahedra,
            surface,
            creases,
            corners,
        })?;
        behind_tetrahedra.check(first_buffer)?;
        behind_octahedra.check(first_buffer + 1)?;
        behind_surface.check(first_buffer + 2)?;
        behind_creases.check(first_buffer + 3)?;
        behind_corners.check(first_buffer + 4)
    }
}

/// Vertices that core's own arenas hold: enough for one tetrahedron at level 3.
const OWNED_VERTICES: usize = 192;

/// A solid in core's own arena: enough for one tetrahedron at level 2.
pub(super) type OwnedSolid = SolidArena<36, 16, 72, 24, 4>;

/// Points beside a solid in core's own arena.
pub(super) type OwnedPoints = Vec<[i32; 3], OWNED_VERTICES>;

/// Core's own arenas: smaller, because they stand beside the slices.
pub(super) struct OwnedMemory {
    pub solids: [OwnedSolid; 2],
    pub points: [OwnedPoints; 2],
    pub scratch: Scratch<FixedBlend<i32, 3>, 560, 16, OWNED_VERTICES>,
    pub faces: [[u32; 3]; FACES + GUARD_ELEMENTS],
    pub surface: Surface,
}

impl OwnedMemory {
    const fn new() -> Self {
        OwnedMemory {
            solids: [OwnedSolid::new(), OwnedSolid::new()],
            points: [OwnedPoints::new(), OwnedPoints::new()],
            scratch: Scratch::new(),
            faces: [[0; 3]; FACES + GUARD_ELEMENTS],
            surface: Surface::new(),
        }
    }
}
