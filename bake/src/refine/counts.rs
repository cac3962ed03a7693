//! How many elements the refinements of a mixed solid have, without refining it.

use super::Level;
use super::mixed::MixedMemory;
use crate::check::FaceUses;
use crate::error::Result;
use crate::mesh::{Cells, Shape};
use serde::Serialize;
use std::collections::HashSet;

/// Numbers of everything in a mixed solid, each counted once.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct MixedLevelCounts {
    /// Vertices.
    pub vertices: usize,
    /// Edges that are no diagonal of a covered quadrilateral.
    pub edges: usize,
    /// Triangles of cells that lie on no quadrilateral, and those of sheets.
    pub triangles: usize,
    /// Quadrilaterals of cells on which no triangle lies.
    pub free_quads: usize,
    /// Quadrilaterals with a triangle on one half. The other half is a surface triangle.
    pub half_covered_quads: usize,
    /// Quadrilaterals with triangles on both halves.
    pub covered_quads: usize,
    /// By how many the middles of quadrilaterals are fewer than these: several that are covered along
    /// one diagonal share theirs.
    pub shared_middles: usize,
    /// Tetrahedra.
    pub tetrahedra: usize,
    /// Octahedra.
    pub octahedra: usize,
    /// Prisms.
    pub prisms: usize,
    /// Hexahedra.
    pub hexahedra: usize,
    /// Surface triangles.
    pub surface: usize,
    /// Surface quadrilaterals.
    pub surface_quads: usize,
    /// Crease edges.
    pub creases: usize,
    /// Corners.
    pub corners: usize,
}

impl MixedLevelCounts {
    /// Counts a level.
    ///
    /// # Errors
    /// If the connectivity is none of a solid.
    pub fn of(level: &Level) -> Result<Self> {
        let solid = level.solid();
        let mut memory = MixedMemory::new(&solid)?;
        let numbering = memory.number(&solid)?;
        let cells = &level.cells;
        let (edges, new) = (numbering.edges().len(), numbering.vertex_count() as usize);
        let quads = Quads::of(cells);
        let middles = new - solid.vertex_count as usize - edges;
        let middles = middles - cells.octahedra.len() - cells.hexahedra.len();
        Ok(Self {
            vertices: solid.vertex_count as usize,
            edges,
            triangles: quads.triangles + level.sheets().len(),
            free_quads: quads.free,
            half_covered_quads: quads.half_covered,
            covered_quads: quads.covered,
            shared_middles: (quads.free + quads.half_covered + quads.covered) - middles,
            tetrahedra: cells.count(Shape::Tetrahedron),
            octahedra: cells.count(Shape::Octahedron),
            prisms: cells.count(Shape::Prism),
            hexahedra: cells.count(Shape::Hexahedron),
            surface: level.surface.len(),
            surface_quads: level.surface_quads.len(),
            creases: level.creases.len(),
            corners: level.corners.len(),
        })
    }

    /// Quadrilaterals of cells.
    pub fn quads(&self) -> usize {
        self.free_quads + self.half_covered_quads + self.covered_quads
    }

    /// The counts one level up; `None` where a count does not fit.
    ///
    /// Every edge is halved, every triangle and quadrilateral cut into four. Inside a tetrahedron
    /// there are four new triangles, inside an octahedron twelve edges and 24 triangles, inside a
    /// prism three edges, four triangles and six quadrilaterals, inside a hexahedron six edges and
    /// twelve quadrilaterals. Of the four parts of a half-covered quadrilateral the two at the
    /// diagonal's ends are half covered, one is covered and one free.
    #[must_use]
    pub fn refined(self) -> Option<Self> {
        let sum = |terms: &[(usize, usize)]| {
            terms.iter().try_fold(0_usize, |sum, (factor, count)| {
                sum.checked_add(factor.checked_mul(*count)?)
            })
        };
        let quads = self.quads();
        let (tetrahedra, octahedra) = (self.tetrahedra, self.octahedra);
        let (prisms, hexahedra, half) = (self.prisms, self.hexahedra, self.half_covered_quads);
        Some(Self {
            vertices: sum(&[
                (1, self.vertices),
                (1, self.edges),
                (1, quads - self.shared_middles),
                (1, octahedra),
                (1, hexahedra),
            ])?,
            edges: sum(&[
                (2, self.edges),
                (3, self.triangles),
                (4, quads),
                (12, octahedra),
                (3, prisms),
                (6, hexahedra),
            ])?,
            triangles: sum(&[
                (4, self.triangles),
                (4, tetrahedra),
                (24, octahedra),
                (4, prisms),
            ])?,
            free_quads: sum(&[
                (4, self.free_quads),
                (1, half),
                (6, prisms),
                (12, hexahedra),
            ])?,
            half_covered_quads: sum(&[(2, half)])?,
            covered_quads: sum(&[(4, self.covered_quads), (1, half)])?,
            shared_middles: sum(&[(2, self.shared_middles)])?,
            tetrahedra: sum(&[(4, tetrahedra), (8, octahedra)])?,
            octahedra: sum(&[(1, tetrahedra), (6, octahedra)])?,
            prisms: sum(&[(8, prisms)])?,
            hexahedra: sum(&[(8, hexahedra)])?,
            surface: sum(&[(4, self.surface)])?.checked_sub(2 * half)?,
            surface_quads: sum(&[(4, self.surface_quads), (1, half)])?,
            creases: sum(&[(2, self.creases)])?,
            corners: self.corners,
        })
    }
}

/// The faces of cells by what lies on them.
struct Quads {
    triangles: usize,
    free: usize,
    half_covered: usize,
    covered: usize,
}

impl Quads {
    fn of(cells: &Cells) -> Self {
        let uses = FaceUses::of(cells);
        let mut quads = Self {
            triangles: uses.triangles.len(),
            free: 0,
            half_covered: 0,
            covered: 0,
        };
        let mut lying = HashSet::new();
        for quad in uses.quads.keys() {
            let halves = (0..4).filter(|left_out| uses.on_half(quad, *left_out) > 0);
            let mut number = 0;
            for left_out in halves {
                let mut half = [1, 2, 3].map(|step| quad[(left_out + step) % 4]);
                half.sort_unstable();
                lying.insert(half);
                number += 1;
            }
            match number {
                0 => quads.free += 1,
                1 => quads.half_covered += 1,
                _ => quads.covered += 1,
            }
        }
        quads.triangles -= lying.len();
        quads
    }
}
