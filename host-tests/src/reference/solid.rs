//! A solid of tetrahedra and octahedra, and what is checked before it is refined.

use std::fmt;

/// The greatest number of cells at one vertex for which every sum is exact (see the module
/// documentation); it is stated a little below the exact limit of 12 944.
pub const CELLS_AT_A_VERTEX_MAXIMUM: usize = 12_000;

/// Connectivity of a solid: cells by corner indices, tagged triangles, crease edges and corners.
///
/// An octahedron's opposite corners are `(0, 3)`, `(1, 4)` and `(2, 5)`.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Solid {
    /// Number of vertices; every index below is less than it.
    pub vertex_count: usize,
    /// Corners of the tetrahedra.
    pub tetrahedra: Vec<[u32; 4]>,
    /// Corners of the octahedra.
    pub octahedra: Vec<[u32; 6]>,
    /// Triangles that follow the surface rule beside those of the boundary: interior surfaces
    /// that are to show as creases, and sheets that no cell has.
    pub sheets: Vec<[u32; 3]>,
    /// Crease edges, each an edge of a cell or of a sheet. One that is listed twice counts once.
    pub creases: Vec<[u32; 2]>,
    /// Corner vertices, which never move.
    pub corners: Vec<u32>,
}

/// What the boundary of a solid follows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Boundary {
    /// Loop's subdivision with the vertex weight of 1987:
    /// `beta = (1/n)(5/8 - (3/8 + cos(2 pi / n)/4)^2)`.
    Loop,
    /// Loop's subdivision with the vertex weight `3/(8n)`, and 3/16 at `n = 3`.
    LoopWarren,
    /// Loop's subdivision with the vertex weight `3/(8n)` at every `n`.
    TriQuad,
    /// The paper's smoothing everywhere, to the letter.
    Interior,
    /// The boundary polyhedron is kept: vertices stay, edge midpoints are plain midpoints.
    Fixed,
}

impl Boundary {
    /// All choices.
    pub const ALL: [Self; 5] = [
        Self::Loop,
        Self::LoopWarren,
        Self::TriQuad,
        Self::Interior,
        Self::Fixed,
    ];

    /// The name that users give.
    pub fn name(self) -> &'static str {
        match self {
            Self::Loop => "loop",
            Self::LoopWarren => "loop-warren",
            Self::TriQuad => "tri-quad",
            Self::Interior => "interior",
            Self::Fixed => "fixed",
        }
    }
}

/// Why a solid cannot be refined.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SolidError {
    /// A cell, crease or corner names a vertex that is not there.
    NoSuchVertex(u32),
    /// A cell or sheet names a vertex twice.
    RepeatedCorner(u32),
    /// A crease is not an edge of any cell or sheet.
    CreaseIsNoEdge([u32; 2]),
    /// More cells meet at a vertex than [`CELLS_AT_A_VERTEX_MAXIMUM`].
    TooManyCells(u32),
    /// The number of points is not the number of vertices: points, vertices.
    PointCount(usize, usize),
}

impl fmt::Display for SolidError {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoSuchVertex(vertex) => write!(formatter, "there is no vertex {vertex}"),
            Self::RepeatedCorner(vertex) => write!(formatter, "a cell names vertex {vertex} twice"),
            Self::CreaseIsNoEdge([a, b]) => {
                write!(
                    formatter,
                    "crease {a} {b} is not an edge of any cell or sheet"
                )
            }
            Self::TooManyCells(vertex) => write!(
                formatter,
                "more than {CELLS_AT_A_VERTEX_MAXIMUM} cells meet at vertex {vertex}"
            ),
            Self::PointCount(points, vertices) => {
                write!(
                    formatter,
                    "{points} points were given for {vertices} vertices"
                )
            }
        }
    }
}

impl std::error::Error for SolidError {}

/// The edge between two vertices, lower index first.
pub fn edge(a: u32, b: u32) -> [u32; 2] {
    [a.min(b), a.max(b)]
}

/// Pairs of corner positions that are edges of a tetrahedron.
pub const TETRAHEDRON_EDGES: [[usize; 2]; 6] = [[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]];

/// Pairs of corner positions that are edges of an octahedron: all that are not opposite.
pub const OCTAHEDRON_EDGES: [[usize; 2]; 12] = [
    [0, 1],
    [0, 2],
    [0, 4],
    [0, 5],
    [1, 2],
    [1, 3],
    [1, 5],
    [2, 3],
    [2, 4],
    [3, 4],
    [3, 5],
    [4, 5],
];

impl Solid {
    /// Every cell's corners, tetrahedra first.
    pub fn cells(&self) -> impl Iterator<Item = &[u32]> {
        let tetrahedra = self.tetrahedra.iter().map(|cell| cell.as_slice());
        let octahedra = self.octahedra.iter().map(|cell| cell.as_slice());
        tetrahedra.chain(octahedra)
    }

    /// All edges of cells and sheets, each once, lower index first, in ascending order.
    pub fn edges(&self) -> Vec<[u32; 2]> {
        let in_cells = 6 * self.tetrahedra.len() + 12 * self.octahedra.len();
        let capacity = in_cells + 3 * self.sheets.len();
        let mut edges = Vec::with_capacity(capacity);
        for cell in &self.tetrahedra {
            edges.extend(TETRAHEDRON_EDGES.map(|[i, k]| edge(cell[i], cell[k])));
        }
        for cell in &self.octahedra {
            edges.extend(OCTAHEDRON_EDGES.map(|[i, k]| edge(cell[i], cell[k])));
        }
        for &[a, b, c] in &self.sheets {
            edges.extend([edge(a, b), edge(b, c), edge(c, a)]);
        }
        edges.sort_unstable();
        edges.dedup();
        edges
    }

    /// Number of cells at each vertex: `val` of the paper's pseudocode.
    pub fn cells_at_vertices(&self) -> Vec<usize> {
        let mut count = vec![0; self.vertex_count];
        for vertex in self.cells().flatten() {
            count[*vertex as usize] += 1;
        }
        count
    }

    /// Checks all that refinement relies on.
    ///
    /// # Errors
    /// The first fault found.
    pub fn check(&self) -> Result<(), SolidError> {
        let features = self
            .sheets
            .iter()
            .flatten()
            .chain(self.creases.iter().flatten());
        let named = self.cells().flatten().chain(features).chain(&self.corners);
        for &vertex in named {
            if vertex as usize >= self.vertex_count {
                return Err(SolidError::NoSuchVertex(vertex));
            }
        }
        let sheets = self.sheets.iter().map(|sheet| sheet.as_slice());
        for cell in self.cells().chain(sheets) {
            for (place, corner) in cell.iter().enumerate() {
                if cell[..place].contains(corner) {
                    return Err(SolidError::RepeatedCorner(*corner));
                }
            }
        }
        let edges = self.edges();
        for &[a, b] in &self.creases {
            if edges.binary_search(&edge(a, b)).is_err() {
                return Err(SolidError::CreaseIsNoEdge([a, b]));
            }
        }
        let mut vertices = 0..;
        for (count, vertex) in self.cells_at_vertices().into_iter().zip(&mut vertices) {
            if count > CELLS_AT_A_VERTEX_MAXIMUM {
                return Err(SolidError::TooManyCells(vertex));
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::{OCTAHEDRON_EDGES, Solid, SolidError};

    #[test]
    fn octahedron_edges_are_the_pairs_that_are_not_opposite() {
        let pairs = (0..6).flat_map(|i| (i + 1..6).map(move |k| [i, k]));
        let expected: Vec<_> = pairs.filter(|[i, k]| i + 3 != *k).collect();
        assert_eq!(OCTAHEDRON_EDGES.to_vec(), expected);
    }

    #[test]
    fn faults_are_named() {
        let good = Solid {
            vertex_count: 5,
            tetrahedra: vec![[0, 1, 2, 3]],
            ..Solid::default()
        };
        assert_eq!(good.check(), Ok(()));
        let mut bad = good.clone();
        bad.corners = vec![5];
        assert_eq!(bad.check(), Err(SolidError::NoSuchVertex(5)));
        bad = good.clone();
        bad.tetrahedra.push([0, 1, 2, 1]);
        assert_eq!(bad.check(), Err(SolidError::RepeatedCorner(1)));
        bad = good.clone();
        bad.creases = vec![[0, 4]];
        assert_eq!(bad.check(), Err(SolidError::CreaseIsNoEdge([0, 4])));
    }
}
