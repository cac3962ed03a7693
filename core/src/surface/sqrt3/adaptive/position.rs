//! Positions at any level, by rules (1) and (2).

use super::AdaptiveMesh;
use crate::blend::Blend;
use crate::mesh::index;
use crate::surface::sqrt3::weights::neighbour_weight;

/// What a caller sees of a triangle when it decides whether to refine it.
#[derive(Clone, Debug, PartialEq)]
pub struct Patch<P> {
    /// The triangle's place.
    pub triangle: u32,
    /// Its generation.
    pub generation: u32,
    /// Its corners at the level `generation / 2` (an odd triangle's first corner one level on).
    pub corners: [P; 3],
    /// Where its corners go in the limit.
    pub limits: [P; 3],
}

impl<B: Blend> AdaptiveMesh<'_, B> {
    /// The position of a vertex at a level: the uniform mesh's position after as many steps, to the
    /// bit. At its birth and below that is the position it was born with. `None` if there is no such
    /// vertex.
    pub fn position(&mut self, blend: &mut B, vertex: u32, level: u32) -> Option<B::Point> {
        let facts = *self.vertices().get(index(vertex))?;
        let mut own = self.memory.positions.get(index(vertex))?.clone();
        let valence = index(facts.valence);
        let start = index(facts.ring);
        let rings = self.memory.rings.get(start..start.checked_add(valence)?)?;
        let ring = self.memory.ring_scratch.get_mut(..valence)?;
        ring.clone_from_slice(rings);
        let weight = neighbour_weight(facts.valence);
        for _ in facts.birth..level {
            let mut sum = blend.zero();
            for value in ring.iter() {
                blend.add(&mut sum, 1, value);
            }
            let moved = blend.umbrella(&own, &sum, i64::from(facts.valence), weight);
            turn_ring(blend, &own, ring);
            own = moved;
        }
        Some(own)
    }

    /// What a caller may want to know of a triangle; `None` if there is no such triangle.
    pub fn patch(&mut self, blend: &mut B, triangle: u32) -> Option<Patch<B::Point>> {
        let facts = *self.triangle(triangle)?;
        let level = facts.generation >> 1;
        let first = level.checked_add(facts.generation & 1)?;
        let [a, b, c] = facts.vertices;
        Some(Patch {
            triangle,
            generation: facts.generation,
            corners: [
                self.position(blend, a, first)?,
                self.position(blend, b, level)?,
                self.position(blend, c, level)?,
            ],
            limits: [
                self.limit(blend, a)?,
                self.limit(blend, b)?,
                self.limit(blend, c)?,
            ],
        })
    }
}

/// Rule (1) in every triangle around a vertex: the ring one step on.
fn turn_ring<B: Blend>(blend: &mut B, own: &B::Point, ring: &mut [B::Point]) {
    let Some(first) = ring.first().cloned() else {
        return;
    };
    let mut values = ring.iter_mut().peekable();
    while let Some(value) = values.next() {
        let mut sum = blend.zero();
        blend.add(&mut sum, 1, own);
        blend.add(&mut sum, 1, value);
        match values.peek() {
            Some(next) => blend.add(&mut sum, 1, next),
            None => blend.add(&mut sum, 1, &first),
        }
        *value = blend.divide(&sum, 3);
    }
}
