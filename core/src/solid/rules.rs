//! Which rule a refined vertex follows, and the rules that the schemes of tetrahedra and
//! octahedra share: surfaces, creases and corners.
//!
//! Values are gathered into one exact sum for each refined vertex, part by part (cells, surface,
//! creases), and every sum is divided once at the end. So the order of cells does not matter to
//! any bit. A scheme says what it gathers for its interior vertices and by what it divides:
//! [`Interior`].

use super::Boundary;
use crate::blend::Blend;
use crate::mesh::{Arena, MeshError, Numbering, Solid, require};
use crate::surface::LoopWeights;
use crate::surface::loop_weights::WeightCache;

/// The rule that a refined vertex follows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum Rule {
    /// The scheme's own rule.
    #[default]
    Interior,
    /// Stays, or lies halfway between the ends of its edge.
    Linear,
    /// `1/8 6/8 1/8` along a crease.
    Crease,
    /// Loop's vertex or edge rule.
    Surface,
}

/// What is known of a refined vertex while its sum grows. An opaque piece of scratch memory.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct VertexState {
    /// Cells, surface triangles or neighbours in the sum, or their weights.
    count: u32,
    /// The rule in force.
    rule: Rule,
    /// Crease edges that meet at an old vertex (counted up to 255); 1 on a crease's midpoint.
    creases: u8,
    /// Lies on a surface triangle.
    on_surface: bool,
    /// The midpoint of an edge of a cell, where the scheme asks for it.
    in_cell: bool,
}

/// Where refined values and the scratch to compute them are written.
///
/// `out`, `sums` and `states` each need one element for every vertex of the refined mesh.
#[derive(Debug)]
pub struct PointBuffers<'a, B: Blend> {
    /// The refined values, in the order of [`Numbering`].
    pub out: &'a mut [B::Point],
    /// Scratch: one sum for each refined vertex.
    pub sums: &'a mut [B::Sum],
    /// Scratch: one state for each refined vertex.
    pub states: &'a mut [VertexState],
}

/// A scheme's rule for vertices that are on no surface, crease or corner.
pub(super) trait Interior<B: Blend> {
    /// Adds what enters the interior vertices. `None` if the numbering is of another solid.
    fn gather(
        &self,
        gather: &mut Gather<'_, B>,
        solid: &Solid<'_>,
        numbering: &Numbering<'_>,
    ) -> Option<()>;

    /// An old vertex. `count` is what was counted for the sum, and is positive.
    fn vertex(&self, blend: &mut B, own: &B::Point, sum: &B::Sum, count: i64) -> B::Point;

    /// The midpoint of an edge of a cell, whose ends have the sum `ends`.
    fn midpoint(&self, blend: &mut B, ends: &B::Sum, sum: &B::Sum, count: i64) -> B::Point;

    /// The centroid of an octahedron.
    fn centroid(&self, blend: &mut B, sum: &B::Sum, count: i64) -> B::Point;
}

/// Computes the values of all refined vertices.
pub(super) fn refine_points<'a, B: Blend, I: Interior<B>>(
    blend: &mut B,
    interior: &I,
    solid: &Solid<'_>,
    numbering: &Numbering<'_>,
    boundary: Boundary,
    points: &[B::Point],
    buffers: PointBuffers<'a, B>,
) -> Result<&'a mut [B::Point], MeshError> {
    let old = index(solid.vertex_count);
    let new = index(numbering.vertex_count());
    require(Arena::InputPoints, old, points.len())?;
    require(Arena::OutputPoints, new, buffers.out.len())?;
    require(Arena::Sums, new, buffers.sums.len())?;
    require(Arena::States, new, buffers.states.len())?;
    let out = buffers.out.get_mut(..new).unwrap_or_default();
    let sums = buffers.sums.get_mut(..new).unwrap_or_default();
    let states = buffers.states.get_mut(..new).unwrap_or_default();

    sums.fill(blend.zero());
    states.fill(VertexState::default());
    classify(solid, numbering, boundary, states).ok_or(MeshError::OtherNumbering)?;

    let mut gather = Gather {
        blend: &*blend,
        points,
        sums,
        states,
    };
    interior
        .gather(&mut gather, solid, numbering)
        .ok_or(MeshError::OtherNumbering)?;
    gather
        .surface(solid, numbering)
        .ok_or(MeshError::OtherNumbering)?;
    gather
        .creases(solid, numbering)
        .ok_or(MeshError::OtherNumbering)?;

    let family = match boundary {
        Boundary::Surface(family) => family,
        Boundary::Interior | Boundary::Fixed => LoopWeights::Loop,
    };
    let mut finish = Finish {
        blend,
        interior,
        weights: WeightCache::new(family),
        points,
    };
    finish
        .all(numbering, sums, states, out)
        .ok_or(MeshError::OtherNumbering)?;
    Ok(out)
}

/// An index of a mesh as an index of a slice. On the targets of this library `usize` holds every
/// `u32`.
pub(super) fn index(vertex: u32) -> usize {
    usize::try_from(vertex).unwrap_or(usize::MAX)
}

/// Finds the rule of every refined vertex. `None` if an edge is not numbered.
fn classify(
    solid: &Solid<'_>,
    numbering: &Numbering<'_>,
    boundary: Boundary,
    states: &mut [VertexState],
) -> Option<()> {
    if boundary != Boundary::Interior {
        for &[a, b, c] in solid.surface {
            for (from, to) in [(a, b), (b, c), (c, a)] {
                states.get_mut(index(from))?.on_surface = true;
                states
                    .get_mut(index(numbering.midpoint(from, to)?))?
                    .on_surface = true;
            }
        }
    }
    for &[a, b] in solid.creases {
        let middle = states.get_mut(index(numbering.midpoint(a, b)?))?;
        // A crease that is listed twice counts once.
        if middle.creases == 0 {
            middle.creases = 1;
            for end in [a, b] {
                let end = states.get_mut(index(end))?;
                end.creases = end.creases.saturating_add(1);
            }
        }
    }
    let on_surface = match boundary {
        Boundary::Surface(_) => Rule::Surface,
        Boundary::Fixed => Rule::Linear,
        Boundary::Interior => Rule::Interior,
    };
    let (old, new) = states.split_at_mut_checked(index(solid.vertex_count))?;
    for state in old.iter_mut() {
        state.rule = match (state.creases, state.on_surface, boundary) {
            (3.., _, _) | (_, true, Boundary::Fixed) => Rule::Linear,
            (2, _, _) => Rule::Crease,
            (_, true, _) => on_surface,
            (_, false, _) => Rule::Interior,
        };
    }
    for &corner in solid.corners {
        old.get_mut(index(corner))?.rule = Rule::Linear;
    }
    for state in new {
        state.rule = match (state.creases, state.on_surface) {
            (1.., _) => Rule::Linear,
            (0, true) => on_surface,
            (0, false) => Rule::Interior,
        };
    }
    Some(())
}

/// The sums while they grow.
pub(super) struct Gather<'a, B: Blend> {
    blend: &'a B,
    points: &'a [B::Point],
    sums: &'a mut [B::Sum],
    states: &'a mut [VertexState],
}

impl<B: Blend> Gather<'_, B> {
    /// Adds weighted vertices to an interior vertex and `count` to what it has counted.
    pub(super) fn interior(
        &mut self,
        vertex: u32,
        count: u32,
        weighted: impl IntoIterator<Item = (i64, u32)>,
    ) -> Option<()> {
        let state = self.states.get_mut(index(vertex))?;
        if state.rule != Rule::Interior {
            return Some(());
        }
        state.count = state.count.saturating_add(count);
        let sum = self.sums.get_mut(index(vertex))?;
        for (weight, neighbour) in weighted {
            if weight != 0 {
                self.blend
                    .add(sum, weight, self.points.get(index(neighbour))?);
            }
        }
        Some(())
    }

    /// Remembers that an edge, named by its midpoint, is one of a cell.
    pub(super) fn mark_cell_edge(&mut self, midpoint: u32) -> Option<()> {
        self.states.get_mut(index(midpoint))?.in_cell = true;
        Some(())
    }

    /// Whether [`Gather::mark_cell_edge`] was told of this edge.
    pub(super) fn is_cell_edge(&self, midpoint: u32) -> Option<bool> {
        Some(self.states.get(index(midpoint))?.in_cell)
    }

    /// Opposite vertices for surface edges, neighbours for surface vertices.
    fn surface(&mut self, solid: &Solid<'_>, numbering: &Numbering<'_>) -> Option<()> {
        for &[a, b, c] in solid.surface {
            for (from, to, opposite) in [(a, b, c), (b, c, a), (c, a, b)] {
                self.neighbour(numbering.midpoint(from, to)?, opposite, Rule::Surface)?;
            }
        }
        for (&[a, b], middle) in numbering.edges().iter().zip(numbering.old_count()..) {
            if self.states.get(index(middle))?.on_surface {
                self.neighbour(a, b, Rule::Surface)?;
                self.neighbour(b, a, Rule::Surface)?;
            }
        }
        Some(())
    }

    /// Neighbours along a crease.
    fn creases(&mut self, solid: &Solid<'_>, numbering: &Numbering<'_>) -> Option<()> {
        for &[a, b] in solid.creases {
            let middle = self.states.get_mut(index(numbering.midpoint(a, b)?))?;
            // Counted here so that a crease that is listed twice enters once.
            if middle.count == 0 {
                middle.count = 1;
                self.neighbour(a, b, Rule::Crease)?;
                self.neighbour(b, a, Rule::Crease)?;
            }
        }
        Some(())
    }

    /// Adds a neighbour's value to a vertex, if it follows this rule.
    fn neighbour(&mut self, vertex: u32, neighbour: u32, rule: Rule) -> Option<()> {
        let state = self.states.get_mut(index(vertex))?;
        if state.rule == rule {
            state.count = state.count.saturating_add(1);
            let sum = self.sums.get_mut(index(vertex))?;
            self.blend.add(sum, 1, self.points.get(index(neighbour))?);
        }
        Some(())
    }
}

/// The divisions at the end, one for each refined vertex.
struct Finish<'a, B: Blend, I: Interior<B>> {
    blend: &'a mut B,
    interior: &'a I,
    weights: WeightCache,
    points: &'a [B::Point],
}

impl<B: Blend, I: Interior<B>> Finish<'_, B, I> {
    fn all(
        &mut self,
        numbering: &Numbering<'_>,
        sums: &mut [B::Sum],
        states: &[VertexState],
        out: &mut [B::Point],
    ) -> Option<()> {
        let old = index(numbering.old_count());
        let (out_old, out_new) = out.split_at_mut_checked(old)?;
        let (sums_old, sums_new) = sums.split_at_mut_checked(old)?;
        let (states_old, states_new) = states.split_at_checked(old)?;

        let points = self.points;
        let sums_and_states = sums_old.iter_mut().zip(states_old);
        for ((slot, own), (sum, state)) in out_old.iter_mut().zip(points).zip(sums_and_states) {
            *slot = self.vertex(own, sum, state);
        }

        // Midpoints have their edge's ends; centroids, which come last, only follow the interior
        // rule.
        let ends = numbering
            .edges()
            .iter()
            .map(Some)
            .chain(core::iter::repeat(None));
        let sums_and_states = sums_new.iter_mut().zip(states_new);
        for ((slot, ends), (sum, state)) in out_new.iter_mut().zip(ends).zip(sums_and_states) {
            *slot = match ends {
                Some(&ends) => self.midpoint(ends, sum, state)?,
                None => self
                    .interior
                    .centroid(self.blend, sum, i64::from(state.count)),
            };
        }
        Some(())
    }

    fn vertex(&mut self, own: &B::Point, sum: &mut B::Sum, state: &VertexState) -> B::Point {
        let count = i64::from(state.count);
        match state.rule {
            // A vertex without a cell has nothing to be averaged with.
            _ if count == 0 => own.clone(),
            Rule::Linear => own.clone(),
            Rule::Interior => self.interior.vertex(self.blend, own, sum, count),
            Rule::Surface => {
                let weight = self.weights.neighbour(state.count);
                self.blend.umbrella(own, sum, count, weight)
            }
            Rule::Crease => {
                self.blend.add(sum, 6, own);
                self.blend.divide(sum, 8)
            }
        }
    }

    fn midpoint(&mut self, ends: [u32; 2], sum: &B::Sum, state: &VertexState) -> Option<B::Point> {
        let count = i64::from(state.count);
        let mut both = self.blend.zero();
        for end in ends {
            self.blend.add(&mut both, 1, self.points.get(index(end))?);
        }
        Some(match state.rule {
            Rule::Interior if count > 0 => self.interior.midpoint(self.blend, &both, sum, count),
            Rule::Surface => {
                // 3/8 (a + b) + 1/(4 count) sum, over the denominator 8 count.
                let mut total = self.blend.zero();
                self.blend.add_sum(&mut total, 2, sum);
                self.blend.add_sum(&mut total, count.wrapping_mul(3), &both);
                self.blend.divide(&total, count.wrapping_mul(8))
            }
            // An edge of a sheet alone that follows no surface rule is halved.
            Rule::Linear | Rule::Crease | Rule::Interior => self.blend.divide(&both, 2),
        })
    }
}
