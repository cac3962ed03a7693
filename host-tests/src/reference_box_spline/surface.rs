//! What the surface (boundary and sheets), creases and corners make of vertices and edges.

use std::collections::{BTreeMap, BTreeSet};

use super::solid::{Cells, pair, triple};
use crate::reference::Boundary;

/// The surface of one level.
pub(super) struct Surface {
    boundary: Boundary,
    /// For every surface edge the vertices opposite, one for each triangle.
    opposite: BTreeMap<[u32; 2], Vec<u32>>,
    neighbours: BTreeMap<u32, BTreeSet<u32>>,
    creases: BTreeSet<[u32; 2]>,
    along: BTreeMap<u32, BTreeSet<u32>>,
    corners: BTreeSet<u32>,
}

/// The rule of an old vertex.
pub(super) enum VertexRule {
    Stay,
    Crease([u32; 2]),
    Surface(Vec<u32>),
    Interior,
}

/// The rule of an edge's midpoint.
pub(super) enum EdgeRule {
    Half,
    Surface(Vec<u32>),
    Interior,
}

impl Surface {
    pub(super) fn of(cells: &Cells, boundary: Boundary) -> Self {
        let mut seen: BTreeMap<[u32; 3], u32> = BTreeMap::new();
        for ([a, b, c], _) in cells.faces() {
            *seen.entry(triple(a, b, c)).or_default() += 1;
        }
        let skin = seen.into_iter().filter(|(_, times)| *times == 1);
        let triangles = skin
            .map(|(face, _)| face)
            .chain(cells.sheets.iter().copied());
        let mut surface = Self {
            boundary,
            opposite: BTreeMap::new(),
            neighbours: BTreeMap::new(),
            creases: cells.creases.iter().map(|&[a, b]| pair(a, b)).collect(),
            along: BTreeMap::new(),
            corners: cells.corners.iter().copied().collect(),
        };
        for [a, b, c] in triangles {
            for [p, q, r] in [[a, b, c], [b, c, a], [c, a, b]] {
                surface.opposite.entry(pair(p, q)).or_default().push(r);
                surface.neighbours.entry(p).or_default().extend([q, r]);
            }
        }
        for &[a, b] in &surface.creases {
            surface.along.entry(a).or_default().insert(b);
            surface.along.entry(b).or_default().insert(a);
        }
        surface
    }

    pub(super) fn vertex(&self, vertex: u32) -> VertexRule {
        let along: Vec<u32> = self
            .along
            .get(&vertex)
            .into_iter()
            .flatten()
            .copied()
            .collect();
        let ring = self.neighbours.get(&vertex);
        if self.corners.contains(&vertex) || along.len() > 2 {
            return VertexRule::Stay;
        }
        if ring.is_some() && self.boundary == Boundary::Fixed {
            return VertexRule::Stay;
        }
        if let [a, b] = along[..] {
            return VertexRule::Crease([a, b]);
        }
        match (ring, self.boundary) {
            (None, _) | (_, Boundary::Interior) => VertexRule::Interior,
            (Some(ring), _) => VertexRule::Surface(ring.iter().copied().collect()),
        }
    }

    pub(super) fn edge(&self, edge: [u32; 2]) -> EdgeRule {
        if self.creases.contains(&edge) {
            return EdgeRule::Half;
        }
        match (self.opposite.get(&edge), self.boundary) {
            (None, _) | (_, Boundary::Interior) => EdgeRule::Interior,
            (_, Boundary::Fixed) => EdgeRule::Half,
            (Some(opposite), _) => EdgeRule::Surface(opposite.clone()),
        }
    }
}
