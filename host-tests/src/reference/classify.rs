//! Which rule a vertex of a refined solid follows.

use super::loop_weight::LoopWeight;
use super::solid::{Boundary, Solid, edge};
use super::split::LinearSplit;
use super::surface::{BoundarySurface, surface_triangles};

/// The rule of one new vertex. Indices are those of the level before.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Rule {
    /// Keeps its place.
    Stay,
    /// On a crease: 1/8 6/8 1/8 with the two neighbours along it.
    CreaseVertex([u32; 2]),
    /// The mean of the edge's ends.
    Midpoint,
    /// On the boundary: its own weight and that of its neighbours.
    SurfaceVertex(LoopWeight, Vec<u32>),
    /// On a boundary edge: 3/8 3/8 and 1/4 of the mean of these opposite corners.
    SurfaceEdge(Vec<u32>),
    /// The mean of the smoothing matrices' rows over its cells.
    Interior,
}

/// Everything about a level that its rules ask for.
struct Features {
    boundary: Boundary,
    surface: BoundarySurface,
    creases: Vec<[u32; 2]>,
    crease_neighbours: Vec<Vec<u32>>,
    is_corner: Vec<bool>,
}

impl Features {
    fn of(solid: &Solid, boundary: Boundary) -> Self {
        let mut creases: Vec<_> = solid.creases.iter().map(|&[a, b]| edge(a, b)).collect();
        creases.sort_unstable();
        creases.dedup();
        let mut crease_neighbours = vec![Vec::new(); solid.vertex_count];
        for &[a, b] in &creases {
            crease_neighbours[a as usize].push(b);
            crease_neighbours[b as usize].push(a);
        }
        let mut is_corner = vec![false; solid.vertex_count];
        for corner in &solid.corners {
            is_corner[*corner as usize] = true;
        }
        let surface = BoundarySurface::new(&surface_triangles(solid));
        Self {
            boundary,
            surface,
            creases,
            crease_neighbours,
            is_corner,
        }
    }

    fn of_vertex(&self, vertex: u32) -> Rule {
        let creases = self.crease_neighbours[vertex as usize].as_slice();
        if self.is_corner[vertex as usize] || creases.len() > 2 {
            return Rule::Stay;
        }
        let neighbours: Vec<_> = self.surface.neighbours(vertex).collect();
        let on_boundary = !neighbours.is_empty();
        if on_boundary && self.boundary == Boundary::Fixed {
            return Rule::Stay;
        }
        if let &[a, b] = creases {
            return Rule::CreaseVertex([a, b]);
        }
        match LoopWeight::new(self.boundary, neighbours.len()) {
            Some(weight) if on_boundary => Rule::SurfaceVertex(weight, neighbours),
            _ => Rule::Interior,
        }
    }

    fn of_edge(&self, edge: [u32; 2]) -> Rule {
        if self.creases.binary_search(&edge).is_ok() {
            return Rule::Midpoint;
        }
        let opposite: Vec<_> = self.surface.opposite(edge).collect();
        match self.boundary {
            _ if opposite.is_empty() => Rule::Interior,
            Boundary::Interior => Rule::Interior,
            Boundary::Fixed => Rule::Midpoint,
            Boundary::Loop | Boundary::LoopWarren | Boundary::TriQuad => {
                Rule::SurfaceEdge(opposite)
            }
        }
    }
}

/// The rules of all vertices of a split, in order; octahedron centroids are interior.
///
/// The boundary is found anew from the faces of `solid`, the level before.
pub(super) fn classify(solid: &Solid, linear: &LinearSplit, boundary: Boundary) -> Vec<Rule> {
    let features = Features::of(solid, boundary);
    let mut rules = Vec::with_capacity(linear.solid.vertex_count);
    rules.extend(
        (0..)
            .take(solid.vertex_count)
            .map(|vertex| features.of_vertex(vertex)),
    );
    rules.extend(linear.edges.iter().map(|edge| features.of_edge(*edge)));
    rules.extend(linear.octahedra.iter().map(|_| Rule::Interior));
    rules
}
