//! Which rule a refined vertex follows.

use super::Boundary;
use crate::mesh::{MixedNumbering, Solid};

/// The rule that a refined vertex follows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum Rule {
    /// The mean of the averaged cells (5.3.2).
    #[default]
    Interior,
    /// Stays, or lies where the linear split puts it.
    Linear,
    /// `1/8 6/8 1/8` along a crease.
    Crease,
    /// The triangle/quadrilateral scheme, from what the surface's faces give.
    Surface,
    /// The same at an old vertex that has triangles only: each neighbour counts once.
    TriangleVertex,
}

/// What is known of a refined vertex while its sum grows. An opaque piece of scratch memory.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct VertexState {
    /// New cells of each class in the sum, or new triangles and quadrilaterals of the surface, or
    /// neighbours.
    pub(super) counts: [u32; 3],
    /// The rule in force.
    pub(super) rule: Rule,
    /// Crease edges that meet at an old vertex (counted up to 255); 1 on a crease's midpoint.
    pub(super) creases: u8,
    /// Lies on an edge of a surface triangle.
    pub(super) on_triangle: bool,
    /// Lies on an edge of a surface quadrilateral.
    pub(super) on_quad_edge: bool,
    /// Lies in the middle of a surface quadrilateral.
    pub(super) on_quad_middle: bool,
}

impl VertexState {
    fn is_on_surface(&self) -> bool {
        self.on_triangle || self.on_quad_edge || self.on_quad_middle
    }

    /// Whether an old vertex follows neither a crease nor stays.
    pub(super) fn is_smooth(&self) -> bool {
        !matches!(self.rule, Rule::Linear | Rule::Crease)
    }

    /// Whether a triangle and a quadrilateral of the surface share the edge whose midpoint this is.
    pub(super) fn is_mixed_edge(&self) -> bool {
        self.on_triangle && self.on_quad_edge
    }
}

/// An index of a mesh as an index of a slice. On the targets of this library `usize` holds every
/// `u32`.
pub(super) fn index(vertex: u32) -> usize {
    usize::try_from(vertex).unwrap_or(usize::MAX)
}

/// Finds the rule of every refined vertex. `None` if an edge or a face is not numbered.
pub(super) fn classify(
    solid: &Solid<'_>,
    numbering: &MixedNumbering<'_>,
    boundary: Boundary,
    states: &mut [VertexState],
) -> Option<()> {
    if boundary != Boundary::Interior {
        mark_surface(solid, numbering, states)?;
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
    let (old, new) = states.split_at_mut_checked(index(solid.vertex_count))?;
    for state in old.iter_mut() {
        state.rule = match (state.creases, state.is_on_surface(), boundary) {
            (3.., _, _) | (_, true, Boundary::Fixed) => Rule::Linear,
            (2, _, _) => Rule::Crease,
            (_, true, Boundary::TriQuad) if !state.on_quad_edge => Rule::TriangleVertex,
            (_, true, Boundary::TriQuad) => Rule::Surface,
            (_, true, Boundary::Interior) | (_, false, _) => Rule::Interior,
        };
    }
    for &corner in solid.corners {
        old.get_mut(index(corner))?.rule = Rule::Linear;
    }
    for state in new {
        state.rule = match (state.creases, state.is_on_surface(), boundary) {
            (1.., _, _) | (_, true, Boundary::Fixed) => Rule::Linear,
            (0, true, Boundary::TriQuad) => Rule::Surface,
            (0, true, Boundary::Interior) | (0, false, _) => Rule::Interior,
        };
    }
    Some(())
}

fn mark_surface(
    solid: &Solid<'_>,
    numbering: &MixedNumbering<'_>,
    states: &mut [VertexState],
) -> Option<()> {
    for &[a, b, c] in solid.surface {
        for (from, to) in [(a, b), (b, c), (c, a)] {
            states.get_mut(index(from))?.on_triangle = true;
            let middle = numbering.midpoint(from, to)?;
            states.get_mut(index(middle))?.on_triangle = true;
        }
    }
    for &[a, b, c, d] in solid.surface_quads {
        for (from, to) in [(a, b), (b, c), (c, d), (d, a)] {
            states.get_mut(index(from))?.on_quad_edge = true;
            let middle = numbering.midpoint(from, to)?;
            states.get_mut(index(middle))?.on_quad_edge = true;
        }
        let middle = numbering.quad_middle([a, b, c, d])?;
        states.get_mut(index(middle))?.on_quad_middle = true;
    }
    Some(())
}
