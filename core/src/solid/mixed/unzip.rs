//! The unzip (section 5.2): three clones of every vertex, one for each class of cells.

use super::classify::index;
use super::masks::{HEXAHEDRAL, PRISMATIC, TETRAHEDRAL};
use crate::blend::{Distortion, GuardedBlend};
use crate::mesh::{
    Arena, MeshError, MixedNumbering, QuadKind, Solid, prism_triangles, require,
    tetrahedral_triangles,
};
use crate::surface::tri_quad_weights as tri_quad;

/// The pairs of faces that distort a vertex, in the order of (5.2.2).
const TRIANGLE_ON_PRISM_TRIANGLE: usize = 0;
const TRIANGLE_ON_PRISM_QUAD: usize = 1;
const TRIANGLE_ON_HEXAHEDRON: usize = 2;
const PRISM_TRIANGLE_ON_HEXAHEDRON: usize = 3;
const PRISM_QUAD_ON_HEXAHEDRON: usize = 4;

/// Number of kinds of pairs.
const KINDS: usize = 5;

/// The distortions of all kinds are in units of 1/144 (and of one over the number of pairs).
const DENOMINATOR: u32 = 144;

/// Which kinds enter a class's clone, and whether they are taken away: (5.2.2), with the term
/// `- d(triangle, prism's quadrilateral)` of the prism's clone, which the printed formula misses.
const CLONES: [[(usize, bool); 4]; 3] = [
    [
        (TRIANGLE_ON_PRISM_TRIANGLE, false),
        (TRIANGLE_ON_PRISM_QUAD, false),
        (TRIANGLE_ON_HEXAHEDRON, false),
        NONE,
    ],
    [
        (TRIANGLE_ON_PRISM_TRIANGLE, true),
        (TRIANGLE_ON_PRISM_QUAD, true),
        (PRISM_TRIANGLE_ON_HEXAHEDRON, false),
        (PRISM_QUAD_ON_HEXAHEDRON, false),
    ],
    [
        (TRIANGLE_ON_HEXAHEDRON, true),
        (PRISM_TRIANGLE_ON_HEXAHEDRON, true),
        (PRISM_QUAD_ON_HEXAHEDRON, true),
        NONE,
    ],
];

/// No kind: a place that no sum has.
const NONE: (usize, bool) = (KINDS, false);

/// What an old vertex has gathered from the pairs of faces at it. An opaque piece of scratch memory.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct VertexDistortion<S> {
    sums: [S; KINDS],
    counts: [u32; KINDS],
}

impl<S: Clone> VertexDistortion<S> {
    /// Of a vertex without pairs; `zero` is the empty sum of the value type.
    pub fn new(zero: &S) -> Self {
        Self {
            sums: core::array::from_fn(|_| zero.clone()),
            counts: [0; KINDS],
        }
    }
}

/// Computes the three clones of every vertex: for tetrahedra and octahedra, for prisms, and for
/// hexahedra.
///
/// [`refine_points`](super::refine_points) makes them on its way; this is for whoever wants to see
/// them. `points`, `distortions` and `out` need one element for every vertex of `solid`; returns the
/// filled part of `out`.
///
/// # Errors
///
/// [`MeshError::ArenaTooSmall`] before anything is written; [`MeshError::OtherNumbering`] if the
/// numbering is seen to be of another solid.
pub fn unzip<'a, B: GuardedBlend>(
    blend: &B,
    solid: &Solid<'_>,
    numbering: &MixedNumbering<'_>,
    points: &[B::Point],
    distortions: &mut [VertexDistortion<B::Sum>],
    out: &'a mut [[B::Guarded; 3]],
) -> Result<&'a mut [[B::Guarded; 3]], MeshError> {
    let count = index(solid.vertex_count);
    require(Arena::InputPoints, count, points.len())?;
    require(Arena::Distortions, count, distortions.len())?;
    require(Arena::OutputPoints, count, out.len())?;
    let out = out.get_mut(..count).unwrap_or_default();
    let mut unzip = Unzip::new(blend, points, distortions);
    unzip
        .cells(blend, solid, numbering)
        .ok_or(MeshError::OtherNumbering)?;
    for (slots, vertex) in out.iter_mut().zip(0..) {
        for (class, slot) in slots.iter_mut().enumerate() {
            *slot = unzip
                .clone_for(blend, class, vertex)
                .ok_or(MeshError::OtherNumbering)?;
        }
    }
    Ok(out)
}

/// All old vertices with their distortions.
pub(super) struct Unzip<'a, B: GuardedBlend> {
    points: &'a [B::Point],
    distortions: &'a mut [VertexDistortion<B::Sum>],
}

impl<'a, B: GuardedBlend> Unzip<'a, B> {
    /// Nothing is distorted yet.
    pub(super) fn new(
        blend: &B,
        points: &'a [B::Point],
        distortions: &'a mut [VertexDistortion<B::Sum>],
    ) -> Self {
        distortions.fill(VertexDistortion::new(&blend.zero()));
        Self {
            points,
            distortions,
        }
    }

    /// A vertex's clone for a class of cells.
    pub(super) fn clone_for(&self, blend: &B, class: usize, vertex: u32) -> Option<B::Guarded> {
        let own = self.points.get(index(vertex))?;
        let distortion = self.distortions.get(index(vertex))?;
        if distortion.counts == [0; KINDS] {
            return Some(blend.guard(own));
        }
        let zero = blend.zero();
        let parts = CLONES.get(class)?.map(|(kind, is_negative)| Distortion {
            sum: distortion.sums.get(kind).unwrap_or(&zero),
            count: distortion.counts.get(kind).copied().unwrap_or(0),
            is_negative,
        });
        Some(blend.distort(own, &parts, DENOMINATOR))
    }

    /// A vertex's clone for triangles (0) or quadrilaterals (1) of the surface.
    pub(super) fn surface_clone(&self, blend: &B, class: usize, vertex: u32) -> Option<B::Guarded> {
        let own = self.points.get(index(vertex))?;
        let VertexDistortion { sums, counts } = self.distortions.get(index(vertex))?;
        let ([sum, ..], [count, ..]) = (sums, counts);
        let part = Distortion {
            sum,
            count: *count,
            is_negative: class != 0,
        };
        Some(blend.distort(own, &[part], tri_quad::UNZIP_DENOMINATOR))
    }

    /// Gathers all pairs of faces of cells that touch. `None` if a vertex does not exist.
    pub(super) fn cells(
        &mut self,
        blend: &B,
        solid: &Solid<'_>,
        numbering: &MixedNumbering<'_>,
    ) -> Option<()> {
        for triangle in tetrahedral_triangles(solid) {
            for _ in 0..numbering.prism_triangles_at(triangle) {
                let [a, b, c] = triangle;
                for [own, one, two] in [[a, b, c], [b, c, a], [c, a, b]] {
                    let entries = [(-4, own), (2, one), (2, two)];
                    self.add(blend, TRIANGLE_ON_PRISM_TRIANGLE, own, entries)?;
                }
            }
            for touch in numbering.quads().touching(triangle) {
                let (apex, along, across) = (touch.apex, touch.along, touch.across);
                match touch.kind {
                    QuadKind::PrismAlongFirst | QuadKind::PrismAlongSecond => {
                        self.on_prism_quad(blend, apex, along, across)?;
                    }
                    QuadKind::Hexahedron => {
                        let kind = TRIANGLE_ON_HEXAHEDRON;
                        self.on_hexahedron(blend, kind, [apex, along, across], ON_HEXAHEDRON)?;
                    }
                    QuadKind::Surface => {}
                }
            }
        }
        for triangle in prism_triangles(solid) {
            for touch in numbering.quads().touching(triangle) {
                if touch.kind == QuadKind::Hexahedron {
                    let corners = [touch.apex, touch.along, touch.across];
                    let kind = PRISM_TRIANGLE_ON_HEXAHEDRON;
                    self.on_hexahedron(blend, kind, corners, PRISM_ON_HEXAHEDRON)?;
                }
            }
        }
        self.prism_quads_on_hexahedra(blend, numbering)
    }

    /// A triangle on half of a prism's quadrilateral: (5.2.3) in 144ths.
    fn on_prism_quad(&mut self, blend: &B, apex: u32, along: u32, across: u32) -> Option<()> {
        let kind = TRIANGLE_ON_PRISM_QUAD;
        let at_apex = [(-31, apex), (11, along), (20, across)];
        self.add(blend, kind, apex, at_apex)?;
        let at_along = [(5, along), (11, apex), (-16, across)];
        self.add(blend, kind, along, at_along)?;
        let at_across = [(-4, across), (20, apex), (-16, along)];
        self.add(blend, kind, across, at_across)
    }

    /// A triangle on half of a hexahedron's face: (5.2.4) and (5.2.5) in 144ths.
    fn on_hexahedron(
        &mut self,
        blend: &B,
        kind: usize,
        [apex, one, two]: [u32; 3],
        weights: HalfWeights,
    ) -> Option<()> {
        let HalfWeights { at_apex, at_ends } = weights;
        let entries = [(at_apex[0], apex), (at_apex[1], one), (at_apex[1], two)];
        self.add(blend, kind, apex, entries)?;
        for (own, far) in [(one, two), (two, one)] {
            let entries = [(at_ends[0], own), (at_ends[1], apex), (at_ends[2], far)];
            self.add(blend, kind, own, entries)?;
        }
        Some(())
    }

    /// Faces between a prism and a hexahedron: (5.2.6) in 144ths.
    fn prism_quads_on_hexahedra(
        &mut self,
        blend: &B,
        numbering: &MixedNumbering<'_>,
    ) -> Option<()> {
        let faces = numbering.quads().all();
        for group in faces.chunk_by(|one, two| one.corners() == two.corners()) {
            let hexahedra = group
                .iter()
                .filter(|face| face.kind() == QuadKind::Hexahedron);
            for _ in 0..hexahedra.count() {
                for face in group {
                    let [a, b, c, d] = face.corners();
                    let along = match face.kind() {
                        QuadKind::PrismAlongFirst => [[a, b], [c, d]],
                        QuadKind::PrismAlongSecond => [[b, c], [d, a]],
                        QuadKind::Hexahedron | QuadKind::Surface => continue,
                    };
                    for [one, two] in along {
                        for (own, other) in [(one, two), (two, one)] {
                            let entries = [(-6, own), (6, other)];
                            self.add(blend, PRISM_QUAD_ON_HEXAHEDRON, own, entries)?;
                        }
                    }
                }
            }
        }
        Some(())
    }

    /// Gathers one edge that triangles and quadrilaterals of the surface share: (5.3.3).
    pub(super) fn surface_edge(&mut self, blend: &B, [own, other]: [u32; 2]) -> Option<()> {
        self.add(blend, 0, own, [(-1, own), (1, other)])
    }

    /// Adds one pair at a vertex.
    fn add<const N: usize>(
        &mut self,
        blend: &B,
        kind: usize,
        vertex: u32,
        entries: [(i64, u32); N],
    ) -> Option<()> {
        let distortion = self.distortions.get_mut(index(vertex))?;
        let count = distortion.counts.get_mut(kind)?;
        *count = count.saturating_add(1);
        let sum = distortion.sums.get_mut(kind)?;
        for (weight, vertex) in entries {
            if weight != 0 {
                blend.add(sum, weight, self.points.get(index(vertex))?);
            }
        }
        Some(())
    }
}

/// Weights of a triangle on half of a hexahedron's face, in 144ths.
#[derive(Clone, Copy)]
struct HalfWeights {
    /// At the corner off the diagonal: itself, each of the others.
    at_apex: [i64; 2],
    /// At an end of the diagonal: itself, the corner off the diagonal, the other end.
    at_ends: [i64; 3],
}

/// Triangles of tetrahedra and octahedra: -5/18, 5/36; -1/36, 5/36, -1/9.
const ON_HEXAHEDRON: HalfWeights = HalfWeights {
    at_apex: [-40, 20],
    at_ends: [-4, 20, -16],
};

/// Triangles of prisms: -1/4, 1/8; 0, 1/8, -1/8.
const PRISM_ON_HEXAHEDRON: HalfWeights = HalfWeights {
    at_apex: [-36, 18],
    at_ends: [0, 18, -18],
};

const _: () = assert!(TETRAHEDRAL == 0 && PRISMATIC == 1 && HEXAHEDRAL == 2);
