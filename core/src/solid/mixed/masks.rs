//! What prisms and hexahedra contribute to their refined vertices, and how the four shapes count
//! against one another.
//!
//! As in [`tet_oct`](crate::solid::tet_oct) only the children and the averaging matrices are typed
//! in; the rest is computed when the library is compiled.
#![expect(
    clippy::indexing_slicing,
    clippy::arithmetic_side_effects,
    reason = "evaluated when the library is compiled: an index or a sum out of range is a build error"
)]

use crate::mesh::{HEXAHEDRON_EDGES, HEXAHEDRON_QUADS, PRISM_EDGES, PRISM_QUADS};
use crate::solid::tet_oct::masks::Contribution;

/// Local vertices of a split prism: 6 corners, the midpoints of [`PRISM_EDGES`], the middles of
/// [`PRISM_QUADS`].
pub(super) const PRISM_VERTICES: usize = 18;

/// Local vertices of a split hexahedron: 8 corners, the midpoints of [`HEXAHEDRON_EDGES`], the
/// middles of [`HEXAHEDRON_QUADS`], the centroid.
pub(super) const HEXAHEDRON_VERTICES: usize = 27;

/// The local vertices of a prism's three layers: the corners of a triangle and the midpoints of its
/// edges `01 12 20`.
const PRISM_LAYERS: [[usize; 6]; 3] = [
    [0, 1, 2, 6, 9, 7],
    [8, 10, 11, 15, 16, 17],
    [3, 4, 5, 12, 14, 13],
];

/// The four triangles of a split triangle, in the numbers of a layer.
const TRIANGLES: [[usize; 3]; 4] = [[0, 3, 5], [3, 1, 4], [5, 4, 2], [3, 4, 5]];

/// The eight prisms of a prism: four in the lower layer, in the order of a triangle's split, then
/// four in the upper.
pub(super) const PRISM_PRISMS: [[usize; 6]; 8] = prism_prisms();

/// The eight hexahedra of a hexahedron: corner `k` of child `i` is the middle of the edge, face or
/// cell between `v_i` and `v_k`.
pub(super) const HEXAHEDRON_HEXAHEDRA: [[usize; 8]; 8] = hexahedron_hexahedra();

/// Denominator of a prism's and a hexahedron's contributions, for each child: 4 and 8 for the
/// linear split, 16 and 8 for the averaging.
const DENOMINATOR: i64 = 64;

/// Section 5.3's matrix of a prism, in sixteenths: the corner itself and the one joined to it by an
/// edge between the triangles, and everything else.
const PRISM_AVERAGING: (i64, i64) = (2, 3);

/// A prism's contributions to its refined vertices, in units of 1/64 for each child.
pub(super) const PRISM: [Contribution<6>; PRISM_VERTICES] = prism_contributions();

/// A hexahedron's contributions to its refined vertices, in units of 1/64 for each child.
pub(super) const HEXAHEDRON: [Contribution<8>; HEXAHEDRON_VERTICES] = hexahedron_contributions();

/// The classes of cells, in the order in which their children are counted.
pub(super) const TETRAHEDRAL: usize = 0;
pub(super) const PRISMATIC: usize = 1;
pub(super) const HEXAHEDRAL: usize = 2;

/// What the contributions of a class are multiplied by: the collapse weights 1/14, 1/12 and 1/8 of
/// (5.3.2) over the classes' denominators 288, 64 and 64, in units of `1/(192 * 168)`.
pub(super) const CLASS_FACTORS: [i64; 3] = [8, 42, 63];

/// The collapse weights of (5.3.2), in units of 1/168.
pub(super) const COLLAPSE: [i64; 3] = [12, 14, 21];

/// Denominator of an interior vertex, for each unit of its collapse weights.
pub(super) const COMMON_DENOMINATOR: i64 = 192;

const _: () = {
    use crate::solid::tet_oct::masks::DENOMINATOR as TETRAHEDRAL_DENOMINATOR;
    assert!(CLASS_FACTORS[0] * TETRAHEDRAL_DENOMINATOR == COMMON_DENOMINATOR * COLLAPSE[0]);
    assert!(CLASS_FACTORS[1] * DENOMINATOR == COMMON_DENOMINATOR * COLLAPSE[1]);
    assert!(CLASS_FACTORS[2] * DENOMINATOR == COMMON_DENOMINATOR * COLLAPSE[2]);
};

const fn prism_prisms() -> [[usize; 6]; 8] {
    let mut children = [[0; 6]; 8];
    let mut child = 0;
    while child < 8 {
        let layer = child / 4;
        let mut corner = 0;
        while corner < 3 {
            let place = TRIANGLES[child % 4][corner];
            children[child][corner] = PRISM_LAYERS[layer][place];
            children[child][corner + 3] = PRISM_LAYERS[layer + 1][place];
            corner += 1;
        }
        child += 1;
    }
    children
}

/// Where a hexahedron's corner lies in the cube of side 2.
const fn corner_place(corner: usize) -> [usize; 3] {
    let around = corner % 4;
    let x = if around == 1 || around == 2 { 2 } else { 0 };
    let y = if around >= 2 { 2 } else { 0 };
    let z = if corner >= 4 { 2 } else { 0 };
    [x, y, z]
}

/// Where a hexahedron's local vertex lies in the cube of side 2.
const fn place(vertex: usize) -> [usize; 3] {
    let (first, second) = if vertex < 8 {
        (vertex, vertex)
    } else if vertex < 20 {
        let [a, b] = HEXAHEDRON_EDGES[vertex - 8];
        (a, b)
    } else if vertex < 26 {
        let [a, _, c, _] = HEXAHEDRON_QUADS[vertex - 20];
        (a, c)
    } else {
        (0, 6)
    };
    between(first, second)
}

/// Halfway between two corners of the cube of side 2.
const fn between(first: usize, second: usize) -> [usize; 3] {
    let [ax, ay, az] = corner_place(first);
    let [bx, by, bz] = corner_place(second);
    [(ax + bx) / 2, (ay + by) / 2, (az + bz) / 2]
}

const fn vertex_at(wanted: [usize; 3]) -> usize {
    let mut vertex = 0;
    while vertex < HEXAHEDRON_VERTICES {
        let [x, y, z] = place(vertex);
        if x == wanted[0] && y == wanted[1] && z == wanted[2] {
            return vertex;
        }
        vertex += 1;
    }
    // Every place of the cube has a vertex: a table built from this would not compile.
    usize::MAX
}

const fn hexahedron_hexahedra() -> [[usize; 8]; 8] {
    let mut children = [[0; 8]; 8];
    let mut child = 0;
    while child < 8 {
        let mut corner = 0;
        while corner < 8 {
            children[child][corner] = vertex_at(between(child, corner));
            corner += 1;
        }
        child += 1;
    }
    children
}

/// The linear split of a prism, in quarters.
const fn prism_split() -> [[i64; 6]; PRISM_VERTICES] {
    let mut rows = [[0; 6]; PRISM_VERTICES];
    let mut corner = 0;
    while corner < 6 {
        rows[corner][corner] = 4;
        corner += 1;
    }
    let mut edge = 0;
    while edge < PRISM_EDGES.len() {
        let [a, b] = PRISM_EDGES[edge];
        rows[6 + edge][a] = 2;
        rows[6 + edge][b] = 2;
        edge += 1;
    }
    let mut face = 0;
    while face < PRISM_QUADS.len() {
        let mut corner = 0;
        while corner < 4 {
            rows[15 + face][PRISM_QUADS[face][corner]] = 1;
            corner += 1;
        }
        face += 1;
    }
    rows
}

/// The linear split of a hexahedron, in eighths.
const fn hexahedron_split() -> [[i64; 8]; HEXAHEDRON_VERTICES] {
    let mut rows = [[0; 8]; HEXAHEDRON_VERTICES];
    let mut corner = 0;
    while corner < 8 {
        rows[corner][corner] = 8;
        rows[26][corner] = 1;
        corner += 1;
    }
    let mut edge = 0;
    while edge < HEXAHEDRON_EDGES.len() {
        let [a, b] = HEXAHEDRON_EDGES[edge];
        rows[8 + edge][a] = 4;
        rows[8 + edge][b] = 4;
        edge += 1;
    }
    let mut face = 0;
    while face < HEXAHEDRON_QUADS.len() {
        let mut corner = 0;
        while corner < 4 {
            rows[20 + face][HEXAHEDRON_QUADS[face][corner]] = 2;
            corner += 1;
        }
        face += 1;
    }
    rows
}

const fn prism_contributions() -> [Contribution<6>; PRISM_VERTICES] {
    let split = prism_split();
    let mut result = [Contribution {
        weights: [0; 6],
        cells: 0,
    }; PRISM_VERTICES];
    let mut child = 0;
    while child < 8 {
        let vertices = PRISM_PRISMS[child];
        let mut own = 0;
        while own < 6 {
            let to = vertices[own];
            let mut other = 0;
            while other < 6 {
                let (same, rest) = PRISM_AVERAGING;
                let weight = if own % 3 == other % 3 { same } else { rest };
                let row = split[vertices[other]];
                let mut corner = 0;
                while corner < 6 {
                    result[to].weights[corner] += weight * row[corner];
                    corner += 1;
                }
                other += 1;
            }
            result[to].cells += 1;
            own += 1;
        }
        child += 1;
    }
    result
}

const fn hexahedron_contributions() -> [Contribution<8>; HEXAHEDRON_VERTICES] {
    let split = hexahedron_split();
    let mut result = [Contribution {
        weights: [0; 8],
        cells: 0,
    }; HEXAHEDRON_VERTICES];
    let mut child = 0;
    while child < 8 {
        let vertices = HEXAHEDRON_HEXAHEDRA[child];
        let mut mean = [0; 8];
        let mut other = 0;
        while other < 8 {
            let row = split[vertices[other]];
            let mut corner = 0;
            while corner < 8 {
                mean[corner] += row[corner];
                corner += 1;
            }
            other += 1;
        }
        let mut own = 0;
        while own < 8 {
            let to = vertices[own];
            let mut corner = 0;
            while corner < 8 {
                result[to].weights[corner] += mean[corner];
                corner += 1;
            }
            result[to].cells += 1;
            own += 1;
        }
        child += 1;
    }
    result
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn contributions_add_up_to_their_cells() {
        for contribution in PRISM {
            let sum: i64 = contribution.weights.iter().sum();
            assert_eq!(sum, DENOMINATOR * i64::from(contribution.cells));
        }
        for contribution in HEXAHEDRON {
            let sum: i64 = contribution.weights.iter().sum();
            assert_eq!(sum, DENOMINATOR * i64::from(contribution.cells));
        }
    }

    /// A corner of a hexahedron keeps (3/4)^3 of itself: 27, 9, 3, 1 over 64 by distance.
    #[test]
    fn hexahedron_corner_is_the_tensor_product() {
        assert_eq!(HEXAHEDRON[0].weights, [27, 9, 3, 9, 9, 3, 1, 3]);
        assert_eq!(HEXAHEDRON[0].cells, 1);
        assert!(HEXAHEDRON[8..20].iter().all(|vertex| vertex.cells == 2));
        assert!(HEXAHEDRON[20..26].iter().all(|vertex| vertex.cells == 4));
        assert_eq!(HEXAHEDRON[26].cells, 8);
    }

    /// A corner of a prism, worked out by hand: 10, 3, 3 over 16 in its triangle (Loop's corner
    /// child) times 3/4 and 1/4 along the edge.
    #[test]
    fn prism_corner_is_the_tensor_product() {
        assert_eq!(PRISM[0].weights, [30, 9, 9, 10, 3, 3]);
        assert_eq!(PRISM[0].cells, 1);
        assert!(PRISM[15..].iter().all(|vertex| vertex.cells == 6));
    }

    /// Every local vertex but the centroid is where its number says, each place once.
    #[test]
    fn children_of_a_hexahedron_fill_the_cube() {
        let mut seen = [0; HEXAHEDRON_VERTICES];
        for child in HEXAHEDRON_HEXAHEDRA {
            for vertex in child {
                seen[vertex] += 1;
            }
        }
        assert_eq!(seen[26], 8);
        assert_eq!(seen.iter().sum::<i32>(), 64);
        assert_eq!(HEXAHEDRON_HEXAHEDRA[0], [0, 8, 20, 9, 10, 22, 26, 25]);
    }
}
