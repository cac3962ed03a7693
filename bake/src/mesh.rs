//! A solid mesh as it stands in a file: vertices in file order, cells by shape, features.
//!
//! Readers fill it, `check` judges it, `refine` hands it to core. A new cell shape is one more
//! field of [`Cells`]; labels and scalar channels of vertices or cells are further fields of
//! [`SolidMesh`].

use crate::error::{Error, Result};

/// Index of a vertex, counted from 0 in file order.
pub type Vertex = u32;

/// Position of a point in the units of its file.
pub type Point = [f64; 3];

/// The cells of a solid mesh, by shape, each in file order.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Cells {
    /// Corners of the tetrahedra: positive if `det(v1-v0, v2-v0, v3-v0) > 0`.
    pub tetrahedra: Vec<[Vertex; 4]>,
    /// Corners of the octahedra: opposite pairs are (0,3), (1,4) and (2,5), and seen from outside
    /// a positive octahedron the face (0,2,1) runs counter-clockwise.
    pub octahedra: Vec<[Vertex; 6]>,
}

impl Cells {
    /// Number of cells of all shapes.
    pub fn len(&self) -> usize {
        self.tetrahedra.len() + self.octahedra.len()
    }

    /// True if there is no cell of any shape.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The corners of every cell: tetrahedra first, then octahedra.
    pub fn corners(&self) -> impl Iterator<Item = &[Vertex]> {
        let tetrahedra = self.tetrahedra.iter().map(|cell| cell.as_slice());
        tetrahedra.chain(self.octahedra.iter().map(|cell| cell.as_slice()))
    }

    /// "tetrahedron 7" or "octahedron 2", counted from 0 in file order within the shape, for the
    /// cell at `index` of [`Cells::corners`].
    pub fn name(&self, index: usize) -> String {
        match index.checked_sub(self.tetrahedra.len()) {
            None => format!("tetrahedron {index}"),
            Some(octahedron) => format!("octahedron {octahedron}"),
        }
    }
}

/// The faces of a tetrahedron, counter-clockwise from outside when the cell is positive.
pub const TETRAHEDRON_FACES: [[usize; 3]; 4] = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];

/// The faces of an octahedron, counter-clockwise from outside when the cell is positive.
pub const OCTAHEDRON_FACES: [[usize; 3]; 8] = [
    [0, 2, 1],
    [0, 1, 5],
    [0, 4, 2],
    [0, 5, 4],
    [3, 1, 2],
    [3, 5, 1],
    [3, 2, 4],
    [3, 4, 5],
];

/// The edges of a tetrahedron.
pub const TETRAHEDRON_EDGES: [[usize; 2]; 6] = [[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]];

/// The edges of an octahedron: every pair of corners but the three opposite ones.
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

/// Where the smooth map is meant not to be smooth.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Features {
    /// Crease edges, each with its lesser vertex first, ascending, none twice.
    pub creases: Vec<[Vertex; 2]>,
    /// Vertices that keep their place, ascending, none twice.
    pub corners: Vec<Vertex>,
}

impl Features {
    /// Brings the features into their one canonical order.
    pub fn normalise(&mut self) {
        for edge in &mut self.creases {
            edge.sort_unstable();
        }
        self.creases.sort_unstable();
        self.creases.dedup();
        self.corners.sort_unstable();
        self.corners.dedup();
    }
}

/// A solid mesh: a cage, a posed cage, or a refined one.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SolidMesh {
    /// Vertex positions, in file order, in the file's units. All finite.
    pub points: Vec<Point>,
    /// The cells.
    pub cells: Cells,
    /// Creases and corners.
    pub features: Features,
    /// What a reader left out or found odd, a sentence each.
    pub notes: Vec<String>,
}

impl SolidMesh {
    /// Adds features that were read from elsewhere.
    pub fn add_features(&mut self, more: Features) {
        self.features.creases.extend(more.creases);
        self.features.corners.extend(more.corners);
        self.features.normalise();
    }

    /// Error if the meshes do not have the same vertices and cells in the same order; `self` is
    /// the posed one.
    pub fn require_connectivity_of(&self, cage: &SolidMesh) -> Result<()> {
        if self.points.len() != cage.points.len() {
            return Err(Error::new(format!(
                "the pose has {} vertices, the cage has {}",
                self.points.len(),
                cage.points.len()
            ))
            .advise("a pose is the cage itself with its vertices moved: same vertices, same cells, same order"));
        }
        if self.cells != cage.cells {
            let differing = self
                .cells
                .corners()
                .zip(cage.cells.corners())
                .position(|(a, b)| a != b);
            let what = match differing {
                Some(index) => format!(
                    "the pose's cells differ from the cage's, first at {}",
                    cage.cells.name(index)
                ),
                None => format!(
                    "the pose has {} cells, the cage has {}",
                    self.cells.len(),
                    cage.cells.len()
                ),
            };
            return Err(Error::new(what).advise(
                "a pose is the cage itself with its vertices moved: same vertices, same cells, same order",
            ));
        }
        Ok(())
    }
}
