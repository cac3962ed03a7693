//! The sums of the refined vertices: what cells, surface and creases give to each.

use super::classify::{Rule, VertexState, index};
use super::masks::{CLASS_FACTORS, HEXAHEDRAL, HEXAHEDRON, PRISM, PRISMATIC, TETRAHEDRAL};
use super::split::{
    hexahedron_vertices, octahedron_vertices, prism_vertices, tetrahedron_vertices,
};
use super::unzip::Unzip;
use crate::blend::GuardedBlend;
use crate::mesh::{MixedNumbering, Solid};
use crate::solid::tet_oct::masks::{Contribution, OCTAHEDRON, TETRAHEDRON};
use crate::surface::tri_quad_weights as tri_quad;

/// Triangles and quadrilaterals of the surface, as places of [`tri_quad::COLLAPSE`].
const TRIANGLE: usize = 0;
const QUAD: usize = 1;

/// The sums while they grow.
pub(super) struct Gather<'a, B: GuardedBlend> {
    pub(super) blend: &'a B,
    pub(super) points: &'a [B::Point],
    pub(super) sums: &'a mut [B::GuardedSum],
    pub(super) states: &'a mut [VertexState],
}

impl<B: GuardedBlend> Gather<'_, B> {
    /// What every cell gives to its interior vertices.
    pub(super) fn cells(
        &mut self,
        solid: &Solid<'_>,
        numbering: &MixedNumbering<'_>,
        unzip: &Unzip<'_, B>,
    ) -> Option<()> {
        for cell in solid.tetrahedra {
            let vertices = tetrahedron_vertices(cell, numbering)?;
            self.cell(unzip, TETRAHEDRAL, cell, &vertices, &TETRAHEDRON)?;
        }
        for (place, centroid) in numbering.octahedra() {
            let cell = solid.octahedra.get(place)?;
            let vertices = octahedron_vertices(cell, centroid, numbering)?;
            self.cell(unzip, TETRAHEDRAL, cell, &vertices, &OCTAHEDRON)?;
        }
        for cell in solid.prisms {
            let vertices = prism_vertices(cell, numbering)?;
            self.cell(unzip, PRISMATIC, cell, &vertices, &PRISM)?;
        }
        for (place, centroid) in numbering.hexahedra() {
            let cell = solid.hexahedra.get(place)?;
            let vertices = hexahedron_vertices(cell, centroid, numbering)?;
            self.cell(unzip, HEXAHEDRAL, cell, &vertices, &HEXAHEDRON)?;
        }
        Some(())
    }

    fn cell<const CORNERS: usize>(
        &mut self,
        unzip: &Unzip<'_, B>,
        class: usize,
        cell: &[u32; CORNERS],
        vertices: &[u32],
        contributions: &[Contribution<CORNERS>],
    ) -> Option<()> {
        let factor = *CLASS_FACTORS.get(class)?;
        let mut clones: [Option<B::Guarded>; CORNERS] = [const { None }; CORNERS];
        for (slot, &corner) in clones.iter_mut().zip(cell) {
            *slot = Some(unzip.clone_for(self.blend, class, corner)?);
        }
        for (&vertex, contribution) in vertices.iter().zip(contributions) {
            let state = self.states.get_mut(index(vertex))?;
            if state.rule != Rule::Interior {
                continue;
            }
            let count = state.counts.get_mut(class)?;
            *count = count.saturating_add(contribution.cells);
            let sum = self.sums.get_mut(index(vertex))?;
            for (clone, &weight) in clones.iter().zip(&contribution.weights) {
                if weight != 0 {
                    let weight = weight.wrapping_mul(factor);
                    self.blend.add_guarded(sum, weight, clone.as_ref()?);
                }
            }
        }
        Some(())
    }

    /// What every face of the surface gives to its vertices.
    pub(super) fn surface(
        &mut self,
        solid: &Solid<'_>,
        numbering: &MixedNumbering<'_>,
        unzip: &Unzip<'_, B>,
    ) -> Option<()> {
        for &[a, b, c] in solid.surface {
            let clone = |vertex| unzip.surface_clone(self.blend, TRIANGLE, vertex);
            let (at_a, at_b, at_c) = (clone(a)?, clone(b)?, clone(c)?);
            for ([from, to], corners) in [
                ([a, b], [&at_a, &at_b, &at_c]),
                ([b, c], [&at_b, &at_c, &at_a]),
                ([c, a], [&at_c, &at_a, &at_b]),
            ] {
                let middle = numbering.midpoint(from, to)?;
                let faces = tri_quad::TRIANGLE_EDGE_FACES;
                self.face(TRIANGLE, middle, faces, corners, &tri_quad::TRIANGLE_EDGE)?;
                self.face(TRIANGLE, from, 1, corners, &tri_quad::TRIANGLE_CORNER)?;
            }
        }
        for &[a, b, c, d] in solid.surface_quads {
            let clone = |vertex| unzip.surface_clone(self.blend, QUAD, vertex);
            let (at_a, at_b, at_c, at_d) = (clone(a)?, clone(b)?, clone(c)?, clone(d)?);
            for ([from, to], corners) in [
                ([a, b], [&at_a, &at_b, &at_c, &at_d]),
                ([b, c], [&at_b, &at_c, &at_d, &at_a]),
                ([c, d], [&at_c, &at_d, &at_a, &at_b]),
                ([d, a], [&at_d, &at_a, &at_b, &at_c]),
            ] {
                let middle = numbering.midpoint(from, to)?;
                let faces = tri_quad::QUAD_EDGE_FACES;
                self.face(QUAD, middle, faces, corners, &tri_quad::QUAD_EDGE)?;
                self.face(QUAD, from, 1, corners, &tri_quad::QUAD_CORNER)?;
            }
            let middle = numbering.quad_middle([a, b, c, d])?;
            let faces = tri_quad::QUAD_MIDDLE_FACES;
            let corners = [&at_a, &at_b, &at_c, &at_d];
            self.face(QUAD, middle, faces, corners, &tri_quad::QUAD_MIDDLE)?;
        }
        self.triangle_vertices(numbering, unzip)
    }

    fn face<const CORNERS: usize>(
        &mut self,
        class: usize,
        vertex: u32,
        faces: u32,
        corners: [&B::Guarded; CORNERS],
        weights: &[i64; CORNERS],
    ) -> Option<()> {
        let state = self.states.get_mut(index(vertex))?;
        if state.rule != Rule::Surface {
            return Some(());
        }
        let count = state.counts.get_mut(class)?;
        *count = count.saturating_add(faces);
        let factor = *tri_quad::COLLAPSE.get(class)?;
        let sum = self.sums.get_mut(index(vertex))?;
        for (corner, weight) in corners.into_iter().zip(weights) {
            let weight = weight.wrapping_mul(factor);
            self.blend.add_guarded(sum, weight, corner);
        }
        Some(())
    }

    /// Neighbours of old vertices that have triangles only.
    fn triangle_vertices(
        &mut self,
        numbering: &MixedNumbering<'_>,
        unzip: &Unzip<'_, B>,
    ) -> Option<()> {
        for ([a, b], middle) in all_edges(numbering) {
            if !self.states.get(index(middle))?.on_triangle {
                continue;
            }
            for (own, other) in [(a, b), (b, a)] {
                let state = self.states.get_mut(index(own))?;
                if state.rule == Rule::TriangleVertex {
                    let [count, ..] = &mut state.counts;
                    *count = count.saturating_add(1);
                    let clone = unzip.surface_clone(self.blend, TRIANGLE, other)?;
                    let sum = self.sums.get_mut(index(own))?;
                    self.blend.add_guarded(sum, 1, &clone);
                }
            }
        }
        Some(())
    }

    /// Neighbours along a crease, and the ends of a crease for its midpoint.
    pub(super) fn creases(
        &mut self,
        solid: &Solid<'_>,
        numbering: &MixedNumbering<'_>,
    ) -> Option<()> {
        for &[a, b] in solid.creases {
            let middle = numbering.midpoint(a, b)?;
            let state = self.states.get_mut(index(middle))?;
            // Counted here so that a crease that is listed twice enters once.
            let [count, ..] = &mut state.counts;
            if *count == 0 {
                *count = 1;
                self.neighbour(a, b, Rule::Crease)?;
                self.neighbour(b, a, Rule::Crease)?;
            }
        }
        Some(())
    }

    fn neighbour(&mut self, vertex: u32, neighbour: u32, rule: Rule) -> Option<()> {
        let state = self.states.get_mut(index(vertex))?;
        if state.rule == rule {
            let [count, ..] = &mut state.counts;
            *count = count.saturating_add(1);
            let guarded = self.blend.guard(self.points.get(index(neighbour))?);
            let sum = self.sums.get_mut(index(vertex))?;
            self.blend.add_guarded(sum, 1, &guarded);
        }
        Some(())
    }
}

/// All edges with their midpoints: those with a vertex of their own, then the diagonals of covered
/// faces.
pub(super) fn all_edges<'a>(
    numbering: &MixedNumbering<'a>,
) -> impl Iterator<Item = ([u32; 2], u32)> + use<'a> {
    let own = numbering.edges().iter().copied();
    own.zip(numbering.old_count()..)
        .chain(numbering.quads().covered_diagonals())
}
