//! Values of the refined vertices: interior masks, surface and crease rules.
//!
//! Values are gathered into one exact sum for each refined vertex, part by part (cells, surface,
//! creases), and every sum is divided once at the end. So the order of cells does not matter to
//! any bit.

use super::Boundary;
use super::masks::{Contribution, DENOMINATOR, OCTAHEDRON, TETRAHEDRON};
use super::split::{octahedron_vertices, tetrahedron_vertices};
use crate::blend::Blend;
use crate::mesh::{Arena, MeshError, Numbering, Solid, require};
use crate::surface::LoopWeights;
use crate::surface::loop_weights::WeightCache;

/// The rule that a refined vertex follows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Rule {
    /// The mean of the smoothed cells.
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
    /// Cells, surface triangles or neighbours in the sum.
    count: u32,
    /// The rule in force.
    rule: Rule,
    /// Crease edges that meet at an old vertex (counted up to 255); 1 on a crease's midpoint.
    creases: u8,
    /// Lies on a surface triangle.
    on_surface: bool,
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

/// Computes the values of the refined vertices from the values of the old ones.
///
/// `solid` and `numbering` belong together; `points` holds one value for each old vertex. Returns
/// the filled part of `buffers.out`. The rules are those of the
/// [module documentation](super); each result is the exact value of its mask on `points`, divided
/// (and, for fixed-point types, rounded) once.
///
/// # Scaling and overflow
///
/// See [`FixedBlend`](crate::blend::FixedBlend): sums of integer weights times 32-bit
/// coordinates, exact in 64 bits.
///
/// # Errors
///
/// [`MeshError::ArenaTooSmall`] before anything is written; [`MeshError::OtherNumbering`] if the
/// numbering is seen to be of another solid.
pub fn refine_points<'a, B: Blend>(
    blend: &mut B,
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
    gather
        .cells(solid, numbering)
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
    finish(blend, numbering, family, points, sums, states, out).ok_or(MeshError::OtherNumbering)?;
    Ok(out)
}

/// An index of a mesh as an index of a slice. On the targets of this library `usize` holds every
/// `u32`.
fn index(vertex: u32) -> usize {
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
struct Gather<'a, B: Blend> {
    blend: &'a B,
    points: &'a [B::Point],
    sums: &'a mut [B::Sum],
    states: &'a mut [VertexState],
}

impl<B: Blend> Gather<'_, B> {
    /// What every cell gives to its interior vertices.
    fn cells(&mut self, solid: &Solid<'_>, numbering: &Numbering<'_>) -> Option<()> {
        for cell in solid.tetrahedra {
            let vertices = tetrahedron_vertices(cell, numbering)?;
            self.cell(cell, &vertices, &TETRAHEDRON)?;
        }
        for (place, centroid) in numbering.centroids() {
            let cell = solid.octahedra.get(place)?;
            let vertices = octahedron_vertices(cell, centroid, numbering)?;
            self.cell(cell, &vertices, &OCTAHEDRON)?;
        }
        Some(())
    }

    fn cell<const CORNERS: usize>(
        &mut self,
        cell: &[u32; CORNERS],
        vertices: &[u32],
        contributions: &[Contribution<CORNERS>],
    ) -> Option<()> {
        for (&vertex, contribution) in vertices.iter().zip(contributions) {
            let state = self.states.get_mut(index(vertex))?;
            if state.rule != Rule::Interior {
                continue;
            }
            state.count = state.count.saturating_add(contribution.cells);
            let sum = self.sums.get_mut(index(vertex))?;
            for (&corner, &weight) in cell.iter().zip(&contribution.weights) {
                if weight != 0 {
                    self.blend.add(sum, weight, self.points.get(index(corner))?);
                }
            }
        }
        Some(())
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

/// Divides every sum, once.
fn finish<B: Blend>(
    blend: &mut B,
    numbering: &Numbering<'_>,
    family: LoopWeights,
    points: &[B::Point],
    sums: &mut [B::Sum],
    states: &[VertexState],
    out: &mut [B::Point],
) -> Option<()> {
    let mut weights = WeightCache::new(family);
    let old = index(numbering.old_count());
    let (out_old, out_new) = out.split_at_mut_checked(old)?;
    let (sums_old, sums_new) = sums.split_at_mut_checked(old)?;
    let (states_old, states_new) = states.split_at_checked(old)?;

    let sums_and_states = sums_old.iter_mut().zip(states_old);
    for ((slot, own), (sum, state)) in out_old.iter_mut().zip(points).zip(sums_and_states) {
        let count = i64::from(state.count);
        *slot = match state.rule {
            // A vertex without a cell has nothing to be averaged with.
            _ if count == 0 => own.clone(),
            Rule::Linear => own.clone(),
            Rule::Interior => blend.divide(sum, count.wrapping_mul(DENOMINATOR)),
            Rule::Surface => blend.umbrella(own, sum, count, weights.neighbour(state.count)),
            Rule::Crease => {
                blend.add(sum, 6, own);
                blend.divide(sum, 8)
            }
        };
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
        let count = i64::from(state.count);
        *slot = match (state.rule, ends) {
            (Rule::Interior, _) | (_, None) => blend.divide(sum, count.wrapping_mul(DENOMINATOR)),
            (Rule::Surface, Some(&[a, b])) => {
                // 3/8 (a + b) + 1/(4 count) sum, over the denominator 8 count.
                let mut total = blend.zero();
                blend.add_sum(&mut total, 2, sum);
                for end in [a, b] {
                    blend.add(&mut total, count.wrapping_mul(3), points.get(index(end))?);
                }
                blend.divide(&total, count.wrapping_mul(8))
            }
            (Rule::Linear | Rule::Crease, Some(&[a, b])) => {
                let mut total = blend.zero();
                for end in [a, b] {
                    blend.add(&mut total, 1, points.get(index(end))?);
                }
                blend.divide(&total, 2)
            }
        };
    }
    Some(())
}
