//! Hakenberg's scheme for mixed solids, written again from the thesis in double precision that is
//! exact by construction. It shares nothing with the crate that it judges.
//!
//! Nothing here is a mask. One level is done as chapter 5 says it: clones are made, every cell is
//! cut into small cells whose corners have positions, every small cell is multiplied by its
//! characteristic matrix, and what falls on the same vertex is averaged.
//!
//! Positions are integers: clones in units of 2^-8 of the last place, then 24 times that for the
//! linear split (halves, quarters, sixths, eighths) and 48 times for the matrices (8ths, 16ths,
//! 24ths, 48ths). They are kept in three limbs of 16 bits ([`Wide`]), whose sums stay far below
//! 2^53, so every operation on `f64` here is exact. Rounding is `floor(x + 1/2)`, at the same two
//! places as in the crate: a clone, and a final coordinate.

mod boundary;
mod collapse;
mod faces;
mod split;
mod unzip;
mod wide;

pub use boundary::find_boundary;
pub use collapse::refine;
pub use faces::{Face, faces};
pub use split::{Names, children, split};
pub use wide::Wide;

/// A mixed solid, its surface, creases and corners.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Mesh {
    /// Number of vertices.
    pub vertex_count: u32,
    /// Tetrahedra.
    pub tetrahedra: Vec<[u32; 4]>,
    /// Octahedra, opposite corners (0,3) (1,4) (2,5).
    pub octahedra: Vec<[u32; 6]>,
    /// Prisms: triangles (0,1,2) and (3,4,5).
    pub prisms: Vec<[u32; 6]>,
    /// Hexahedra: quadrilaterals (0,1,2,3) and (4,5,6,7).
    pub hexahedra: Vec<[u32; 8]>,
    /// Surface triangles.
    pub triangles: Vec<[u32; 3]>,
    /// Surface quadrilaterals.
    pub quads: Vec<[u32; 4]>,
    /// Crease edges.
    pub creases: Vec<[u32; 2]>,
    /// Corners.
    pub corners: Vec<u32>,
}

/// What the surface follows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Boundary {
    /// The triangle/quadrilateral scheme.
    TriQuad,
    /// The interior rule.
    Interior,
    /// Nothing moves.
    Fixed,
}

impl Boundary {
    /// All choices.
    pub const ALL: [Self; 3] = [Self::TriQuad, Self::Interior, Self::Fixed];
}

/// The class of a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Class {
    /// Tetrahedra and octahedra.
    Toc,
    /// Prisms.
    Pris,
    /// Hexahedra.
    Cube,
}

/// A cell of any shape.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Cell {
    /// Its class.
    pub class: Class,
    /// Its corners: 4 or 6 (toc), 6 (pris), 8 (cube).
    pub corners: Vec<u32>,
}

impl Mesh {
    /// All cells: tetrahedra, octahedra, prisms, hexahedra.
    pub fn cells(&self) -> Vec<Cell> {
        let mut cells = Vec::new();
        let mut push = |class, corners: &[u32]| {
            let corners = corners.to_vec();
            cells.push(Cell { class, corners });
        };
        self.tetrahedra
            .iter()
            .for_each(|cell| push(Class::Toc, cell));
        self.octahedra
            .iter()
            .for_each(|cell| push(Class::Toc, cell));
        self.prisms.iter().for_each(|cell| push(Class::Pris, cell));
        self.hexahedra
            .iter()
            .for_each(|cell| push(Class::Cube, cell));
        cells
    }

    /// Number of cells.
    pub fn cell_count(&self) -> usize {
        self.tetrahedra.len() + self.octahedra.len() + self.prisms.len() + self.hexahedra.len()
    }
}
