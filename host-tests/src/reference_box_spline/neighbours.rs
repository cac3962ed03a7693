//! The neighbour sets of definition 3.3, as the readings have them.

use std::collections::{BTreeMap, BTreeSet};

use super::solid::{Cells, Scheme, pair, tetrahedron_faces};

/// Neighbours of a vertex or of an edge.
#[derive(Clone, Debug, Default)]
pub(super) struct Ring {
    /// At the other end of an edge, or next to both ends of the edge.
    pub(super) near: BTreeSet<u32>,
    /// Opposite in an octahedron; never in `near` too.
    pub(super) far: BTreeSet<u32>,
}

impl Ring {
    fn settle(&mut self) {
        self.far = &self.far - &self.near;
    }
}

/// All neighbour sets of a solid.
#[derive(Clone, Debug, Default)]
pub(super) struct Rings {
    pub(super) of_vertex: BTreeMap<u32, Ring>,
    pub(super) of_edge: BTreeMap<[u32; 2], Ring>,
}

/// Finds the neighbours of every vertex and edge of cells.
pub(super) fn rings(cells: &Cells, scheme: Scheme) -> Rings {
    let mut rings = Rings::default();
    for [a, b] in cells.cell_edges() {
        rings.of_vertex.entry(a).or_default().near.insert(b);
        rings.of_vertex.entry(b).or_default().near.insert(a);
    }
    for (cell, _) in &cells.tetrahedra {
        for [a, b, c] in tetrahedron_faces(*cell) {
            for [p, q, r] in [[a, b, c], [b, c, a], [c, a, b]] {
                rings.of_edge.entry(pair(p, q)).or_default().near.insert(r);
            }
        }
    }
    for (cell, diagonal) in &cells.octahedra {
        octahedron(&mut rings, *cell, |place| match scheme {
            Scheme::MajorDiagonals => place % 3 == usize::from(*diagonal),
            Scheme::Averaged => true,
        });
    }
    rings.of_vertex.values_mut().for_each(Ring::settle);
    rings.of_edge.values_mut().for_each(Ring::settle);
    rings
}

/// What an octahedron says; `counts` tells which of its corners lie on a diagonal that counts.
fn octahedron(rings: &mut Rings, cell: [u32; 6], counts: impl Fn(usize) -> bool) {
    let opposite = |place: usize| (place + 3) % 6;
    for one in 0..6 {
        if counts(one) {
            let ring = rings.of_vertex.entry(cell[one]).or_default();
            ring.far.insert(cell[opposite(one)]);
        }
        for two in (0..6).filter(|two| *two != one && *two != opposite(one)) {
            let ring = rings.of_edge.entry(pair(cell[one], cell[two])).or_default();
            let beside = (0..6).filter(|k| ![one, two, opposite(one), opposite(two)].contains(k));
            ring.near.extend(beside.map(|place| cell[place]));
            if counts(one) {
                ring.far.insert(cell[opposite(one)]);
            }
        }
    }
}
