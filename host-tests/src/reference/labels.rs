//! Which cell every refined cell came from, found from its vertices alone.

use std::collections::BTreeMap;

use super::solid::Solid;
use super::split::LinearSplit;

/// For each refined cell, tetrahedra first, the place of its parent among the cells of `solid`,
/// tetrahedra first, of which `linear` is the split.
///
/// Every child of an octahedron has its centroid. A child without one is a tetrahedron's: its
/// corners are old vertices and midpoints of edges, which together reach all four corners of
/// the parent. So the order of the children is not looked at. No two tetrahedra may have the same
/// corners.
///
/// # Panics
/// If a child lies in no cell, which no split gives.
pub fn parents(solid: &Solid, linear: &LinearSplit) -> Vec<usize> {
    let mut tetrahedra = BTreeMap::new();
    for (place, corners) in solid.tetrahedra.iter().enumerate() {
        let mut corners = corners.to_vec();
        corners.sort_unstable();
        let twin = tetrahedra.insert(corners, place);
        assert_eq!(twin, None, "two tetrahedra with the same corners");
    }
    let first_centroid = linear.old_vertex_count + linear.edges.len();
    let parent = |child: &[u32]| {
        let mut reached = Vec::new();
        for &vertex in child {
            let place = vertex as usize;
            if let Some(octahedron) = place.checked_sub(first_centroid) {
                return solid.tetrahedra.len() + linear.octahedra[octahedron].1;
            }
            match place.checked_sub(linear.old_vertex_count) {
                None => reached.push(vertex),
                Some(edge) => reached.extend(linear.edges[edge]),
            }
        }
        reached.sort_unstable();
        reached.dedup();
        *tetrahedra.get(&reached).expect("a cell of the solid")
    };
    linear.solid.cells().map(parent).collect()
}

/// Labels of cells, tetrahedra first, handed on to their children.
///
/// # Panics
/// As [`parents`], and if there is not a label for every cell.
pub fn split_labels<L: Copy>(solid: &Solid, linear: &LinearSplit, labels: &[L]) -> Vec<L> {
    assert_eq!(
        labels.len(),
        solid.cells().count(),
        "a label for every cell"
    );
    let parents = parents(solid, linear);
    parents.into_iter().map(|parent| labels[parent]).collect()
}

#[cfg(test)]
mod tests {
    use super::{Solid, parents};
    use crate::reference::split;

    /// Section 2.1 of paper 1: a tetrahedron becomes four and an octahedron, an octahedron eight tetrahedra
    /// and six octahedra.
    #[test]
    fn every_cell_has_as_many_children_as_the_paper_draws() {
        let solid = Solid {
            vertex_count: 8,
            tetrahedra: vec![[0, 1, 2, 6], [2, 1, 0, 7]],
            octahedra: vec![[0, 1, 2, 3, 4, 5]],
            ..Solid::default()
        };
        let parents = parents(&solid, &split(&solid));
        let count = |cell: usize| parents.iter().filter(|parent| **parent == cell).count();
        assert_eq!([count(0), count(1), count(2)], [5, 5, 14]);
    }
}
