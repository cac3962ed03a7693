//! The splitting procedure.

use super::{AdaptiveMesh, AdaptiveTriangle, AdaptiveVertex, LEVEL_MAXIMUM, Patch};
use crate::blend::Blend;
use crate::mesh::{Arena, MeshError, index, require};

/// Longest chain of splits that wait for one another: each waits for one of a lower generation.
const CHAIN: usize = 64;

/// A split that waits: a triangle, and the generation that it is to leave.
#[derive(Clone, Copy, Default)]
struct Wish {
    triangle: u32,
    generation: u32,
}

impl<B: Blend> AdaptiveMesh<'_, B> {
    /// Refines every triangle, old or new, for which `wants` says so, until it does for none.
    /// Triangles of level `levels` (and on the way there) are the last that it is asked for: none is
    /// split that is of generation `2 * levels` or above.
    ///
    /// # Errors
    ///
    /// Those of [`AdaptiveMesh::split`]; the mesh is then a valid one, refined as far as memory
    /// went.
    pub fn refine_where(
        &mut self,
        blend: &mut B,
        levels: u32,
        mut wants: impl FnMut(&Patch<B::Point>) -> bool,
    ) -> Result<(), MeshError> {
        let last = levels.min(LEVEL_MAXIMUM).saturating_mul(2);
        loop {
            let mut changed = false;
            let mut triangle = 0_u32;
            while index(triangle) < self.triangle_count {
                let generation = self
                    .triangle(triangle)
                    .map_or(last, |facts| facts.generation);
                let patch = if generation < last {
                    self.patch(blend, triangle)
                } else {
                    None
                };
                if patch.is_some_and(|patch| wants(&patch)) {
                    self.split(blend, triangle)?;
                    changed = true;
                } else {
                    triangle = triangle.saturating_add(1);
                }
            }
            if !changed {
                return Ok(());
            }
        }
    }

    /// Splits a triangle: it becomes one of the next generation, and so does what must be split
    /// before it. The number of splits that one call causes is bounded by the generations below.
    ///
    /// # Errors
    ///
    /// [`MeshError::ArenaTooSmall`]: some of the triangles before it may be split by then; the mesh
    /// is a valid one. A triangle that does not exist is [`MeshError::OtherNumbering`].
    pub fn split(&mut self, blend: &mut B, triangle: u32) -> Result<(), MeshError> {
        let mut chain = [Wish::default(); CHAIN];
        let mut length = 1_usize;
        let wish = self.wish(triangle)?;
        if let Some(slot) = chain.first_mut() {
            *slot = wish;
        }
        while let Some(place) = length.checked_sub(1) {
            let wish = chain.get(place).copied().unwrap_or_default();
            match self.before(wish)? {
                Some(first) => {
                    require(Arena::AdaptiveLevels, length.saturating_add(1), CHAIN)?;
                    if let Some(slot) = chain.get_mut(length) {
                        *slot = first;
                    }
                    length = length.saturating_add(1);
                }
                None => {
                    if self.wish(wish.triangle)?.generation == wish.generation {
                        self.insert(blend, wish.triangle)?;
                    }
                    length = place;
                }
            }
        }
        Ok(())
    }

    fn wish(&self, triangle: u32) -> Result<Wish, MeshError> {
        let facts = self.triangle(triangle).ok_or(MeshError::OtherNumbering)?;
        Ok(Wish {
            triangle,
            generation: facts.generation,
        })
    }

    /// What must be split before this can be; nothing also if this is done.
    fn before(&self, wish: Wish) -> Result<Option<Wish>, MeshError> {
        let facts = self
            .triangle(wish.triangle)
            .ok_or(MeshError::OtherNumbering)?;
        if facts.generation > wish.generation {
            return Ok(None);
        }
        if facts.generation & 1 == 1 {
            // Flips when the neighbour across the outer edge has come as far.
            let [outer, ..] = facts.neighbours;
            return self.wish(outer).map(Some);
        }
        for neighbour in facts.neighbours {
            let neighbour = self.wish(neighbour)?;
            if neighbour.generation & 1 == 1 && neighbour.generation < facts.generation {
                return Ok(Some(neighbour));
            }
        }
        Ok(None)
    }

    /// Puts a vertex into an even triangle whose neighbours are ready, and flips what can be.
    fn insert(&mut self, blend: &mut B, triangle: u32) -> Result<(), MeshError> {
        let parent = *self.triangle(triangle).ok_or(MeshError::OtherNumbering)?;
        let level = (parent.generation >> 1).saturating_add(1);
        require(Arena::AdaptiveLevels, index(level), index(LEVEL_MAXIMUM))?;
        let more = |count: usize, by: usize| count.checked_add(by).ok_or(MeshError::TooLarge);
        let triangles = more(self.triangle_count, 2)?;
        let vertices = more(self.vertex_count, 1)?;
        let rings = more(self.ring_count, 6)?;
        require(
            Arena::AdaptiveTriangles,
            triangles,
            self.memory.triangles.len(),
        )?;
        require(
            Arena::AdaptiveVertices,
            vertices,
            self.memory.vertices.len(),
        )?;
        require(Arena::OutputPoints, vertices, self.memory.positions.len())?;
        require(Arena::AdaptiveRings, rings, self.memory.rings.len())?;

        let centre = self
            .give_birth(blend, &parent, level)
            .ok_or(MeshError::OtherNumbering)?;
        let second = u32::try_from(self.triangle_count).map_err(|_| MeshError::TooLarge)?;
        let third = second.checked_add(1).ok_or(MeshError::TooLarge)?;
        self.triangle_count = triangles;
        self.cut(triangle, [second, third], centre)
            .ok_or(MeshError::OtherNumbering)?;
        for new in [triangle, second, third] {
            self.flip_if_ready(new).ok_or(MeshError::OtherNumbering)?;
        }
        Ok(())
    }

    /// The new vertex: its position, and its ring one level on from the triangle.
    fn give_birth(&mut self, blend: &mut B, parent: &AdaptiveTriangle, level: u32) -> Option<u32> {
        let [a, b, c] = parent.vertices;
        let [beyond_a, beyond_b, beyond_c] = parent.neighbours;
        let position = self.centre(blend, parent, level)?;
        let ring = [
            self.position(blend, a, level)?,
            self.beyond(blend, beyond_c, a, b, level)?,
            self.position(blend, b, level)?,
            self.beyond(blend, beyond_a, b, c, level)?,
            self.position(blend, c, level)?,
            self.beyond(blend, beyond_b, c, a, level)?,
        ];
        let vertex = u32::try_from(self.vertex_count).ok()?;
        *self.memory.vertices.get_mut(self.vertex_count)? = AdaptiveVertex {
            birth: level,
            valence: 6,
            ring: u32::try_from(self.ring_count).ok()?,
        };
        *self.memory.positions.get_mut(self.vertex_count)? = position;
        let slots = self.memory.rings.get_mut(self.ring_count..)?;
        for (slot, value) in slots.iter_mut().zip(ring) {
            *slot = value;
        }
        self.ring_count = self.ring_count.checked_add(6)?;
        self.vertex_count = self.vertex_count.checked_add(1)?;
        Some(vertex)
    }

    /// Rule (1) in an even triangle, for the vertex of `level`.
    fn centre(
        &mut self,
        blend: &mut B,
        triangle: &AdaptiveTriangle,
        level: u32,
    ) -> Option<B::Point> {
        let before = level.checked_sub(1)?;
        let mut sum = blend.zero();
        for vertex in triangle.vertices {
            let value = self.position(blend, vertex, before)?;
            blend.add(&mut sum, 1, &value);
        }
        Some(blend.divide(&sum, 3))
    }

    /// The vertex of `level` in the triangle beyond the edge from `a` to `b`, whether it is there
    /// yet or not.
    fn beyond(
        &mut self,
        blend: &mut B,
        triangle: u32,
        a: u32,
        b: u32,
        level: u32,
    ) -> Option<B::Point> {
        let facts = *self.triangle(triangle)?;
        if facts.generation & 1 == 0 {
            return self.centre(blend, &facts, level);
        }
        let inner = facts
            .vertices
            .into_iter()
            .find(|&vertex| vertex != a && vertex != b)?;
        self.position(blend, inner, level)
    }

    /// Cuts `(a, b, c)` into `(p, a, b) (p, b, c) (p, c, a)`, of which the first takes its place.
    fn cut(&mut self, first: u32, [second, third]: [u32; 2], p: u32) -> Option<()> {
        let parent = *self.triangle(first)?;
        let [a, b, c] = parent.vertices;
        let [beyond_a, beyond_b, beyond_c] = parent.neighbours;
        let generation = parent.generation.checked_add(1)?;
        let mut write = |triangle, vertices, neighbours| {
            *self.triangle_mut(triangle)? = AdaptiveTriangle {
                vertices,
                neighbours,
                generation,
            };
            Some(())
        };
        write(first, [p, a, b], [beyond_c, second, third])?;
        write(second, [p, b, c], [beyond_a, third, first])?;
        write(third, [p, c, a], [beyond_b, first, second])?;
        self.rejoin(beyond_a, [b, c], second)?;
        self.rejoin(beyond_b, [c, a], third)
    }

    /// Tells a triangle who lies beyond one of its edges.
    fn rejoin(&mut self, triangle: u32, edge: [u32; 2], neighbour: u32) -> Option<()> {
        let facts = self.triangle_mut(triangle)?;
        let slots = facts.vertices.into_iter().zip(&mut facts.neighbours);
        for (vertex, slot) in slots {
            if !edge.contains(&vertex) {
                *slot = neighbour;
            }
        }
        Some(())
    }

    /// Flips the outer edge of an odd triangle if the triangle beyond is as far:
    /// `(p, a, b) (d, b, a)` become `(b, p, d) (a, d, p)`.
    fn flip_if_ready(&mut self, one: u32) -> Option<()> {
        let first = *self.triangle(one)?;
        let [other, by_bp, by_pa] = first.neighbours;
        let second = *self.triangle(other)?;
        if second.generation != first.generation {
            return Some(());
        }
        let [p, a, b] = first.vertices;
        let [d, _, _] = second.vertices;
        let [_, by_ad, by_db] = second.neighbours;
        let generation = first.generation.checked_add(1)?;
        *self.triangle_mut(one)? = AdaptiveTriangle {
            vertices: [b, p, d],
            neighbours: [other, by_db, by_bp],
            generation,
        };
        *self.triangle_mut(other)? = AdaptiveTriangle {
            vertices: [a, d, p],
            neighbours: [one, by_pa, by_ad],
            generation,
        };
        self.rejoin(by_pa, [p, a], other)?;
        self.rejoin(by_db, [d, b], one)
    }
}
