//! A solid with major diagonals and sheets, and its split.

use std::collections::{BTreeMap, BTreeSet};

/// The most neighbours of one vertex for which every sum is exact (see the module documentation).
pub const NEIGHBOURS_MAXIMUM: usize = 10_000;

/// Which of the paper's two schemes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Scheme {
    /// Sections 3 and 5.
    MajorDiagonals,
    /// Appendix A.
    Averaged,
}

/// Connectivity with everything that the scheme needs.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Cells {
    /// Number of vertices.
    pub vertex_count: u32,
    /// Tetrahedra, each with its major diagonal: 0 for the pair of edges 01 23, 1 for 02 13, 2 for
    /// 03 12.
    pub tetrahedra: Vec<([u32; 4], u8)>,
    /// Octahedra (opposite corners 03, 14, 25), each with its major diagonal: the first corner of
    /// the pair.
    pub octahedra: Vec<([u32; 6], u8)>,
    /// Triangles that are no face of a cell.
    pub sheets: Vec<[u32; 3]>,
    /// Crease edges.
    pub creases: Vec<[u32; 2]>,
    /// Corner vertices.
    pub corners: Vec<u32>,
}

/// Two vertices, lower first.
pub(super) fn pair(a: u32, b: u32) -> [u32; 2] {
    if a < b { [a, b] } else { [b, a] }
}

/// Three vertices in ascending order.
pub(super) fn triple(a: u32, b: u32, c: u32) -> [u32; 3] {
    let mut corners = [a, b, c];
    corners.sort();
    corners
}

/// The two edges of a tetrahedron that a diagonal pairs.
pub(super) fn edge_pair(cell: [u32; 4], diagonal: u8) -> [[u32; 2]; 2] {
    let [a, b, c, d] = cell;
    match diagonal {
        0 => [pair(a, b), pair(c, d)],
        1 => [pair(a, c), pair(b, d)],
        2 => [pair(a, d), pair(b, c)],
        _ => panic!("a diagonal is 0, 1 or 2"),
    }
}

/// Eight faces, counter-clockwise from outside: one corner of every opposite pair each.
pub(super) fn octahedron_faces(cell: [u32; 6]) -> [[u32; 3]; 8] {
    let [a, b, c, d, e, f] = cell;
    [
        [a, c, b],
        [a, b, f],
        [a, e, c],
        [a, f, e],
        [d, b, c],
        [d, f, b],
        [d, c, e],
        [d, e, f],
    ]
}

/// Four faces, counter-clockwise from outside.
pub(super) fn tetrahedron_faces(cell: [u32; 4]) -> [[u32; 3]; 4] {
    let [a, b, c, d] = cell;
    [[b, c, d], [a, d, c], [a, b, d], [a, c, b]]
}

impl Cells {
    /// The edges of cells alone.
    pub(super) fn cell_edges(&self) -> BTreeSet<[u32; 2]> {
        let mut edges = BTreeSet::new();
        for [a, b, c] in self.faces().into_iter().map(|(face, _)| face) {
            edges.extend([pair(a, b), pair(b, c), pair(c, a)]);
        }
        edges
    }

    /// All faces of all cells as their cells orient them, with the cell: tetrahedra first.
    pub(super) fn faces(&self) -> Vec<([u32; 3], usize)> {
        let mut faces = Vec::new();
        for (index, (cell, _)) in self.tetrahedra.iter().enumerate() {
            faces.extend(tetrahedron_faces(*cell).map(|face| (face, index)));
        }
        for (place, (cell, _)) in self.octahedra.iter().enumerate() {
            let index = self.tetrahedra.len() + place;
            faces.extend(octahedron_faces(*cell).map(|face| (face, index)));
        }
        faces
    }
}

/// The next level's connectivity and where its vertices come from.
pub(super) struct Split {
    pub(super) next: Cells,
    /// Ends of the edges, in the order of their midpoints.
    pub(super) edges: Vec<[u32; 2]>,
    /// Octahedra (places in the list), in the order of their centroids.
    pub(super) octahedra: Vec<usize>,
}

/// New indices of midpoints and centroids.
struct Names {
    midpoints: BTreeMap<[u32; 2], u32>,
    centroids: Vec<u32>,
}

impl Names {
    fn mid(&self, a: u32, b: u32) -> u32 {
        if a == b {
            a
        } else {
            self.midpoints[&pair(a, b)]
        }
    }
}

/// Splits cells, sheets and creases; every child keeps the direction of its parent's diagonal.
pub(super) fn split(cells: &Cells) -> Split {
    let mut edge_set = cells.cell_edges();
    for &[a, b, c] in &cells.sheets {
        edge_set.extend([pair(a, b), pair(b, c), pair(c, a)]);
    }
    let edges: Vec<_> = edge_set.into_iter().collect();
    let mut octahedra: Vec<usize> = (0..cells.octahedra.len()).collect();
    octahedra.sort_by_key(|place| {
        let mut corners = cells.octahedra[*place].0;
        corners.sort();
        (corners, *place)
    });
    let mut fresh = cells.vertex_count..;
    let midpoints = edges.iter().copied().zip(&mut fresh).collect();
    let mut centroids = vec![0; octahedra.len()];
    for place in &octahedra {
        centroids[*place] = fresh.next().expect("fewer than 2^32 vertices");
    }
    let names = Names {
        midpoints,
        centroids,
    };
    let next = children(cells, &names, fresh.start);
    Split {
        next,
        edges,
        octahedra,
    }
}

fn children(cells: &Cells, names: &Names, vertex_count: u32) -> Cells {
    let mut next = Cells {
        vertex_count,
        corners: cells.corners.clone(),
        ..Cells::default()
    };
    for &(cell, diagonal) in &cells.tetrahedra {
        let [a, b, c, d] = cell;
        for corner in cell {
            let child = cell.map(|other| names.mid(corner, other));
            next.tetrahedra.push((child, diagonal));
        }
        let m = |p, q| names.mid(p, q);
        let middle = [m(a, b), m(a, c), m(a, d), m(c, d), m(b, d), m(b, c)];
        next.octahedra.push((middle, diagonal));
    }
    for (&(cell, diagonal), &centre) in cells.octahedra.iter().zip(&names.centroids) {
        for [a, b, c] in octahedron_faces(cell) {
            let child = [centre, names.mid(b, c), names.mid(c, a), names.mid(a, b)];
            // From the middle of centre and m_bc to that of m_ca and m_ab it is a quarter of the way
            // from the centre to a: the pair of the face's corner on the diagonal.
            let place = usize::from(diagonal);
            let ends = [cell[place], cell[place + 3]];
            let on_diagonal = [a, b, c].into_iter().position(|v| ends.contains(&v));
            let inherited = [0, 1, 2][on_diagonal.expect("one corner of every pair")];
            next.tetrahedra.push((child, inherited));
        }
        for (place, corner) in cell.into_iter().enumerate() {
            let mut child = [centre; 6];
            for (other, vertex) in cell.into_iter().enumerate() {
                if other != (place + 3) % 6 {
                    child[other] = names.mid(corner, vertex);
                }
            }
            next.octahedra.push((child, diagonal));
        }
    }
    for &[a, b, c] in &cells.sheets {
        let (ab, bc, ca) = (names.mid(a, b), names.mid(b, c), names.mid(c, a));
        next.sheets
            .extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
    }
    for &[a, b] in &cells.creases {
        let middle = names.mid(a, b);
        next.creases.extend([[a, middle], [middle, b]]);
    }
    next
}
