//! The split's topology in local numbers, and the interior masks that follow from it.
//!
//! Only two things are typed in: which local vertices a child has, and the paper's two smoothing
//! matrices. What a cell contributes to each of its refined vertices is computed from them when
//! the library is compiled.
#![expect(
    clippy::indexing_slicing,
    clippy::arithmetic_side_effects,
    reason = "evaluated when the library is compiled: an index or a sum out of range is a build error"
)]

use crate::mesh::{OCTAHEDRON_EDGES, OCTAHEDRON_FACES, TETRAHEDRON_EDGES};

/// Local vertices of a split tetrahedron: 4 corners, then the midpoints of
/// [`TETRAHEDRON_EDGES`].
pub(in crate::solid) const TETRAHEDRON_VERTICES: usize = 10;

/// Local vertices of a split octahedron: 6 corners, the midpoints of [`OCTAHEDRON_EDGES`], and
/// the centroid.
pub(in crate::solid) const OCTAHEDRON_VERTICES: usize = 19;

/// The local vertex that is an octahedron's centroid.
pub(in crate::solid) const CENTROID: usize = 18;

/// The four tetrahedra of a tetrahedron: corner `k` of child `i` is the midpoint of `v_i v_k`.
pub(in crate::solid) const TETRAHEDRON_TETRAHEDRA: [[usize; 4]; 4] = tetrahedron_tetrahedra();

/// The middle octahedron `(m01, m02, m03, m23, m13, m12)`.
pub(in crate::solid) const TETRAHEDRON_OCTAHEDRA: [[usize; 6]; 1] = [[4, 5, 6, 9, 8, 7]];

/// The eight tetrahedra of an octahedron, one for each face `(a, b, c)`:
/// `(centroid, m_bc, m_ca, m_ab)`.
pub(in crate::solid) const OCTAHEDRON_TETRAHEDRA: [[usize; 4]; 8] = octahedron_tetrahedra();

/// The six octahedra of an octahedron: corner `k` of child `i` is the midpoint of `v_i v_k`,
/// corner `i` is `v_i`, and the corner opposite is the centroid.
pub(in crate::solid) const OCTAHEDRON_OCTAHEDRA: [[usize; 6]; 6] = octahedron_octahedra();

/// Figure 5's matrix of a tetrahedron, in 48ths: its diagonal and everything else. (The paper's
/// text drops the sign of -1/16; its figure has it.)
const TETRAHEDRON_SMOOTHING: (i64, i64) = (-3, 17);

/// Figure 5's matrix of an octahedron, in 48ths: its diagonal, edge neighbours and the opposite
/// corner.
const OCTAHEDRON_SMOOTHING: (i64, i64, i64) = (18, 4, 14);

/// Denominator of a refined vertex, for each child cell that meets there: 6 for the linear split
/// (2 for midpoints, 6 for centroids) times 48 for the smoothing.
pub(in crate::solid) const DENOMINATOR: i64 = 6 * 48;

/// What a shape contributes to one of its refined vertices.
#[derive(Clone, Copy)]
pub(in crate::solid) struct Contribution<const CORNERS: usize> {
    /// Weights of the cell's corners, in units of `1 / DENOMINATOR`.
    pub weights: [i64; CORNERS],
    /// Number of the cell's children that meet at the vertex; the weights add up to
    /// `DENOMINATOR` times that.
    pub cells: u32,
}

/// A tetrahedron's contributions to its ten refined vertices.
pub(in crate::solid) const TETRAHEDRON: [Contribution<4>; TETRAHEDRON_VERTICES] = contributions(
    &tetrahedron_split(),
    &TETRAHEDRON_TETRAHEDRA,
    &TETRAHEDRON_OCTAHEDRA,
);

/// An octahedron's contributions to its nineteen refined vertices.
pub(in crate::solid) const OCTAHEDRON: [Contribution<6>; OCTAHEDRON_VERTICES] = contributions(
    &octahedron_split(),
    &OCTAHEDRON_TETRAHEDRA,
    &OCTAHEDRON_OCTAHEDRA,
);

/// The corner opposite a corner of an octahedron.
const fn opposite(corner: usize) -> usize {
    if corner < 3 { corner + 3 } else { corner - 3 }
}

/// The local vertex in the middle between two corners: `first` plus the place of their edge.
const fn middle(edges: &[[usize; 2]], first: usize, a: usize, b: usize) -> usize {
    let mut place = 0;
    while place < edges.len() {
        let [low, high] = edges[place];
        if (low == a && high == b) || (low == b && high == a) {
            return first + place;
        }
        place += 1;
    }
    // Not an edge: no caller asks for one, and a table built from this would not compile.
    usize::MAX
}

const fn tetrahedron_tetrahedra() -> [[usize; 4]; 4] {
    let mut children = [[0; 4]; 4];
    let mut child = 0;
    while child < 4 {
        let mut corner = 0;
        while corner < 4 {
            children[child][corner] = if corner == child {
                corner
            } else {
                middle(&TETRAHEDRON_EDGES, 4, child, corner)
            };
            corner += 1;
        }
        child += 1;
    }
    children
}

const fn octahedron_tetrahedra() -> [[usize; 4]; 8] {
    let mut children = [[0; 4]; 8];
    let mut child = 0;
    while child < 8 {
        let [a, b, c] = OCTAHEDRON_FACES[child];
        children[child] = [
            CENTROID,
            middle(&OCTAHEDRON_EDGES, 6, b, c),
            middle(&OCTAHEDRON_EDGES, 6, c, a),
            middle(&OCTAHEDRON_EDGES, 6, a, b),
        ];
        child += 1;
    }
    children
}

const fn octahedron_octahedra() -> [[usize; 6]; 6] {
    let mut children = [[0; 6]; 6];
    let mut child = 0;
    while child < 6 {
        let mut corner = 0;
        while corner < 6 {
            children[child][corner] = if corner == child {
                corner
            } else if corner == opposite(child) {
                CENTROID
            } else {
                middle(&OCTAHEDRON_EDGES, 6, child, corner)
            };
            corner += 1;
        }
        child += 1;
    }
    children
}

/// The linear split of a tetrahedron, in sixths: a row of corner weights for each local vertex.
const fn tetrahedron_split() -> [[i64; 4]; TETRAHEDRON_VERTICES] {
    let mut rows = [[0; 4]; TETRAHEDRON_VERTICES];
    let mut corner = 0;
    while corner < 4 {
        rows[corner][corner] = 6;
        corner += 1;
    }
    let mut edge = 0;
    while edge < TETRAHEDRON_EDGES.len() {
        let [a, b] = TETRAHEDRON_EDGES[edge];
        rows[4 + edge][a] = 3;
        rows[4 + edge][b] = 3;
        edge += 1;
    }
    rows
}

/// The linear split of an octahedron, in sixths.
const fn octahedron_split() -> [[i64; 6]; OCTAHEDRON_VERTICES] {
    let mut rows = [[0; 6]; OCTAHEDRON_VERTICES];
    let mut corner = 0;
    while corner < 6 {
        rows[corner][corner] = 6;
        rows[CENTROID][corner] = 1;
        corner += 1;
    }
    let mut edge = 0;
    while edge < OCTAHEDRON_EDGES.len() {
        let [a, b] = OCTAHEDRON_EDGES[edge];
        rows[6 + edge][a] = 3;
        rows[6 + edge][b] = 3;
        edge += 1;
    }
    rows
}

/// Smooths the split over all children and adds up what each local vertex receives.
const fn contributions<const CORNERS: usize, const VERTICES: usize>(
    split: &[[i64; CORNERS]; VERTICES],
    tetrahedra: &[[usize; 4]],
    octahedra: &[[usize; 6]],
) -> [Contribution<CORNERS>; VERTICES] {
    let mut result = [Contribution {
        weights: [0; CORNERS],
        cells: 0,
    }; VERTICES];
    let mut child = 0;
    while child < tetrahedra.len() {
        let mut own = 0;
        while own < 4 {
            let mut other = 0;
            while other < 4 {
                let (diagonal, rest) = TETRAHEDRON_SMOOTHING;
                let weight = if own == other { diagonal } else { rest };
                let to = &mut result[tetrahedra[child][own]].weights;
                add(to, weight, &split[tetrahedra[child][other]]);
                other += 1;
            }
            result[tetrahedra[child][own]].cells += 1;
            own += 1;
        }
        child += 1;
    }
    child = 0;
    while child < octahedra.len() {
        let mut own = 0;
        while own < 6 {
            let mut other = 0;
            while other < 6 {
                let (diagonal, neighbour, across) = OCTAHEDRON_SMOOTHING;
                let weight = if own == other {
                    diagonal
                } else if other == opposite(own) {
                    across
                } else {
                    neighbour
                };
                let to = &mut result[octahedra[child][own]].weights;
                add(to, weight, &split[octahedra[child][other]]);
                other += 1;
            }
            result[octahedra[child][own]].cells += 1;
            own += 1;
        }
        child += 1;
    }
    result
}

const fn add<const N: usize>(to: &mut [i64; N], weight: i64, row: &[i64; N]) {
    let mut corner = 0;
    while corner < N {
        to[corner] += weight * row[corner];
        corner += 1;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Worked out by hand from figure 5: the corner child of a tetrahedron gives its corner
    /// (-3 * 6 + 3 * 17 * 3) / 288 and every other corner 17 * 3 / 288.
    #[test]
    fn tetrahedron_corner_has_the_weights_worked_out_by_hand() {
        assert_eq!(TETRAHEDRON[0].weights, [135, 51, 51, 51]);
        assert_eq!(TETRAHEDRON[0].cells, 1);
    }

    /// Every smoothing row and every split row adds up to one, so a contribution adds up to the
    /// number of children that meet.
    #[test]
    fn contributions_add_up_to_their_cells() {
        for contribution in TETRAHEDRON {
            let sum: i64 = contribution.weights.iter().sum();
            assert_eq!(sum, DENOMINATOR * i64::from(contribution.cells));
        }
        for contribution in OCTAHEDRON {
            let sum: i64 = contribution.weights.iter().sum();
            assert_eq!(sum, DENOMINATOR * i64::from(contribution.cells));
        }
    }

    /// Section 2.1: the numbers of children that meet at a corner, a midpoint and a centroid.
    #[test]
    fn children_meet_as_the_split_says() {
        assert!(TETRAHEDRON[..4].iter().all(|vertex| vertex.cells == 1));
        assert!(TETRAHEDRON[4..].iter().all(|vertex| vertex.cells == 3));
        assert!(OCTAHEDRON[..6].iter().all(|vertex| vertex.cells == 1));
        assert!(
            OCTAHEDRON[6..CENTROID]
                .iter()
                .all(|vertex| vertex.cells == 4)
        );
        assert_eq!(OCTAHEDRON[CENTROID].cells, 14);
    }
}
