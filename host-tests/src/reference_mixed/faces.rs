//! Faces of cells, as sets of corners.

use super::{Cell, Class};

/// A face of a cell: its corners in cyclic order.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Face {
    /// The class of its cell.
    pub class: Class,
    /// Three or four corners, counter-clockwise from outside of a positive cell.
    pub cycle: Vec<u32>,
    /// For a prism's quadrilateral: the edges that belong to its triangles.
    pub triangle_edges: Vec<[u32; 2]>,
}

impl Face {
    /// Its corners in ascending order.
    pub fn sorted(&self) -> Vec<u32> {
        sorted(&self.cycle)
    }

    /// For a quadrilateral: the corner opposite one of its corners.
    pub fn opposite(&self, corner: u32) -> Option<u32> {
        let place = self.cycle.iter().position(|other| *other == corner)?;
        (self.cycle.len() == 4).then(|| self.cycle[(place + 2) % 4])
    }

    /// Whether a triangle has three corners on this quadrilateral.
    pub fn is_touched_by(&self, triangle: &[u32]) -> bool {
        self.cycle.len() == 4
            && triangle.len() == 3
            && triangle.iter().all(|corner| self.cycle.contains(corner))
    }

    /// The corner of this quadrilateral that a triangle on it does not have.
    pub fn free_corner(&self, triangle: &[u32]) -> u32 {
        *self
            .cycle
            .iter()
            .find(|corner| !triangle.contains(corner))
            .expect("three of four corners")
    }
}

/// Ascending.
pub fn sorted(corners: &[u32]) -> Vec<u32> {
    let mut sorted = corners.to_vec();
    sorted.sort_unstable();
    sorted
}

/// All faces of a cell.
pub fn faces(cell: &Cell) -> Vec<Face> {
    let v = &cell.corners;
    let face = |places: &[usize]| Face {
        class: cell.class,
        cycle: places.iter().map(|place| v[*place]).collect(),
        triangle_edges: Vec::new(),
    };
    match (cell.class, v.len()) {
        (Class::Toc, 4) => [[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]]
            .iter()
            .map(|places| face(places))
            .collect(),
        (Class::Toc, _) => octahedron_faces()
            .iter()
            .map(|places| face(places))
            .collect(),
        (Class::Pris, _) => {
            let mut all = vec![face(&[2, 1, 0]), face(&[3, 4, 5])];
            for i in 0..3 {
                let j = (i + 1) % 3;
                let mut side = face(&[i, j, j + 3, i + 3]);
                side.triangle_edges = vec![[v[i], v[j]], [v[i + 3], v[j + 3]]];
                all.push(side);
            }
            all
        }
        (Class::Cube, _) => {
            let mut all = vec![face(&[3, 2, 1, 0]), face(&[4, 5, 6, 7])];
            for i in 0..4 {
                let j = (i + 1) % 4;
                all.push(face(&[i, j, j + 4, i + 4]));
            }
            all
        }
    }
}

/// One corner of each opposite pair; from (0,2,1), swapping a corner for its opposite turns the
/// orientation.
fn octahedron_faces() -> Vec<[usize; 3]> {
    let mut all = Vec::new();
    for swaps in 0..8_usize {
        let pick = |corner: usize| corner + 3 * (swaps >> corner & 1);
        let [a, b, c] = [pick(0), pick(2), pick(1)];
        let is_turned = swaps.count_ones() % 2 == 1;
        all.push(if is_turned { [a, c, b] } else { [a, b, c] });
    }
    all
}
