//! Values of the refined vertices.

use super::Variant;
use super::stencil::{EXACT_DENOMINATOR, exact, less, rounded};
use crate::blend::{Blend, IrrationalWeight, WEIGHT_BITS};
use crate::mesh::{ControlMesh, MeshError, Side, SurfaceEdges, index};
use crate::surface::features::{
    PointBuffers, Rim, Rule, VertexState, classify, gather_creases, halfway, prepare,
};
use crate::surface::split::{require_triangles, same_mesh};

/// Computes the values of the refined vertices: old vertices, then edge midpoints.
///
/// `edges` belongs to `mesh`; `points` holds one value for each old vertex. Returns the filled part
/// of `buffers.out`.
///
/// # Scaling and overflow
///
/// Magnitudes of a mask's weights add up to at most twice its denominator, 2^31 at most, so sums of
/// 32-bit coordinates stay below 2^63. (The stencils over 2^31 have magnitudes below 1.5.) Weights
/// are of either sign, so refined coordinates can leave the range of the input and saturate.
///
/// # Errors
///
/// [`MeshError::NotATriangle`] and [`MeshError::ArenaTooSmall`] before anything is written;
/// [`MeshError::OtherNumbering`] if the edges are seen to be of another mesh.
pub fn refine_points<'a, B: Blend>(
    blend: &mut B,
    mesh: &ControlMesh<'_>,
    edges: &SurfaceEdges<'_>,
    variant: Variant,
    rim: Rim,
    points: &[B::Point],
    buffers: PointBuffers<'a, B>,
) -> Result<&'a mut [B::Point], MeshError> {
    require_triangles(mesh)?;
    if !same_mesh(mesh, edges, mesh.face_count()) {
        return Err(MeshError::OtherNumbering);
    }
    let old = index(mesh.vertex_count);
    let new = old
        .checked_add(index(edges.count()))
        .ok_or(MeshError::TooLarge)?;
    let PointBuffers { out, sums, states } = prepare(blend, old, new, points, buffers)?;
    classify(mesh, edges, rim, states).ok_or(MeshError::OtherNumbering)?;
    gather_creases(blend, edges, points, sums, states).ok_or(MeshError::OtherNumbering)?;
    let (out_old, out_new) = out.split_at_mut_checked(old).unwrap_or_default();
    out_old.clone_from_slice(points.get(..old).unwrap_or_default());
    let mut midpoints = Midpoints {
        blend,
        mesh,
        edges,
        points,
        sums,
        states,
    };
    for (sides, slot) in edges.iter().zip(out_new) {
        *slot = midpoints
            .midpoint(sides, variant, rim)
            .ok_or(MeshError::OtherNumbering)?;
    }
    Ok(out)
}

/// What a midpoint is made from.
struct Midpoints<'a, B: Blend> {
    blend: &'a mut B,
    mesh: &'a ControlMesh<'a>,
    edges: &'a SurfaceEdges<'a>,
    points: &'a [B::Point],
    /// Sums of the two neighbours along a line, at vertices on lines.
    sums: &'a [B::Sum],
    states: &'a [VertexState],
}

impl<B: Blend> Midpoints<'_, B> {
    fn midpoint(&mut self, sides: &[Side], variant: Variant, rim: Rim) -> Option<B::Point> {
        let ends = sides.first()?.ends;
        if self.is_sharp(ends) {
            return if rim == Rim::Fixed && sides.len() != 2 {
                halfway(self.blend, ends, self.points)
            } else {
                self.four_points(ends)
            };
        }
        let [a, b] = ends;
        let irregular = |vertex: u32| {
            let state = self.states.get(index(vertex))?;
            let is_inner = state.sharp == 0 && state.edges != 6;
            (variant == Variant::Modified && is_inner).then_some(state.edges)
        };
        match (irregular(a), irregular(b)) {
            (None, None) => self.eight_points(sides),
            (Some(valence), None) => self.one_ring(a, b, valence),
            (None, Some(valence)) => self.one_ring(b, a, valence),
            (Some(first), Some(second)) => self.two_rings([a, b], [first, second]),
        }
    }

    fn point(&self, vertex: u32) -> Option<&B::Point> {
        self.points.get(index(vertex))
    }

    fn is_sharp(&self, [a, b]: [u32; 2]) -> bool {
        let state = self.edges.midpoint(a, b).map(index);
        state
            .and_then(|middle| self.states.get(middle))
            .is_some_and(|state| state.sharp > 0)
    }

    /// `(9 a + 9 b - before - after) / 16` along a line. At a regular vertex of the line the sum of
    /// its two neighbours is known; elsewhere the line goes on as its mirror image.
    fn four_points(&mut self, [a, b]: [u32; 2]) -> Option<B::Point> {
        let mut sum = self.blend.zero();
        for (near, far) in [(a, b), (b, a)] {
            self.blend.add(&mut sum, 9, self.point(near)?);
            if self.states.get(index(near))?.rule == Rule::Crease {
                // The neighbour before is the sum less the far end.
                self.blend
                    .add_sum(&mut sum, -1, self.sums.get(index(near))?);
                self.blend.add(&mut sum, 1, self.point(far)?);
            } else {
                self.blend.add(&mut sum, -2, self.point(near)?);
                self.blend.add(&mut sum, 1, self.point(far)?);
            }
        }
        Some(self.blend.divide(&sum, 16))
    }

    /// The stencil of 1990.
    fn eight_points(&mut self, sides: &[Side]) -> Option<B::Point> {
        let mut sum = self.blend.zero();
        for side in sides {
            let [a, b] = side.ends;
            let opposite = self.third(side.face, a, b)?;
            self.blend.add(&mut sum, 2, self.point(opposite)?);
            for (near, far) in [(a, b), (b, a)] {
                // Each end enters for each of the two triangles: 4 + 4.
                self.blend.add(&mut sum, 4, self.point(near)?);
                self.subtract_across(&mut sum, side.face, near, opposite, far)?;
            }
        }
        Some(self.blend.divide(&sum, 16))
    }

    /// Takes the vertex across the edge from `near` to `opposite` of a face, whose third corner is
    /// `far`, from a sum.
    fn subtract_across(
        &self,
        sum: &mut B::Sum,
        face: u32,
        near: u32,
        opposite: u32,
        far: u32,
    ) -> Option<()> {
        if self.is_sharp([near, opposite]) {
            self.blend.add(sum, -1, self.point(near)?);
            self.blend.add(sum, -1, self.point(opposite)?);
            self.blend.add(sum, 1, self.point(far)?);
        } else {
            let beyond = self.beyond(face, near, opposite)?;
            let wing = self.third(beyond, near, opposite)?;
            self.blend.add(sum, -1, self.point(wing)?);
        }
        Some(())
    }

    /// The corner of a triangle that is neither `a` nor `b`.
    fn third(&self, face: u32, a: u32, b: u32) -> Option<u32> {
        let corners = self.mesh.face(index(face));
        corners.iter().copied().find(|&v| v != a && v != b)
    }

    /// The other face on an edge.
    fn beyond(&self, face: u32, a: u32, b: u32) -> Option<u32> {
        let mut sides = self.edges.sides(a, b).iter().map(|side| side.face);
        sides.find(|&other| other != face)
    }

    /// The stencil of one vertex whose valence is not 6.
    fn one_ring(&mut self, vertex: u32, end: u32, valence: u32) -> Option<B::Point> {
        let mut sum = self.blend.zero();
        let denominator = if exact(valence, 0).is_some() {
            self.add_exact(&mut sum, vertex, end, valence)?;
            EXACT_DENOMINATOR
        } else {
            self.add_rounded(&mut sum, vertex, end, valence)?;
            1 << WEIGHT_BITS
        };
        Some(self.blend.divide(&sum, denominator))
    }

    /// The mean of both ends' stencils.
    fn two_rings(&mut self, [a, b]: [u32; 2], [first, second]: [u32; 2]) -> Option<B::Point> {
        let mut sum = self.blend.zero();
        let is_exact = exact(first, 0).is_some() && exact(second, 0).is_some();
        for (vertex, end, valence) in [(a, b, first), (b, a, second)] {
            if is_exact {
                self.add_exact(&mut sum, vertex, end, valence)?;
            } else {
                self.add_rounded(&mut sum, vertex, end, valence)?;
            }
        }
        let denominator = if is_exact {
            EXACT_DENOMINATOR
        } else {
            1 << WEIGHT_BITS
        };
        Some(self.blend.divide(&sum, denominator.wrapping_mul(2)))
    }

    /// A vertex's stencil in 24ths, of which the vertex itself has 18.
    fn add_exact(&self, sum: &mut B::Sum, vertex: u32, end: u32, valence: u32) -> Option<()> {
        self.blend.add(sum, 18, self.point(vertex)?);
        self.walk(vertex, end, valence, |place, point| {
            let weight = exact(valence, place).unwrap_or_default();
            self.blend.add(sum, weight, point);
        })
    }

    /// A vertex's stencil in units of 2^-30.
    fn add_rounded(&self, sum: &mut B::Sum, vertex: u32, end: u32, valence: u32) -> Option<()> {
        let mut own = IrrationalWeight {
            bits: 1 << WEIGHT_BITS,
            real: 1.0,
        };
        self.walk(vertex, end, valence, |place, point| {
            let weight = rounded(valence, place);
            own = less(own, weight);
            self.blend.add_irrational(sum, weight, point);
        })?;
        self.blend.add_irrational(sum, own, self.point(vertex)?);
        Some(())
    }

    /// Visits the ring of a vertex from `end` on, with each ring vertex's distance from `end` along
    /// the ring.
    fn walk(
        &self,
        vertex: u32,
        end: u32,
        valence: u32,
        mut visit: impl FnMut(u32, &B::Point),
    ) -> Option<()> {
        let mut at = end;
        let mut face = self.edges.sides(vertex, end).first()?.face;
        for step in 0..valence {
            visit(step.min(valence.wrapping_sub(step)), self.point(at)?);
            at = self.third(face, vertex, at)?;
            face = self.beyond(face, vertex, at)?;
        }
        Some(())
    }
}
