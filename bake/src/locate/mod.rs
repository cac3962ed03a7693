//! Finds the cell that holds a point, and the point's coordinates in it.
//!
//! Whether a cell contains a point is decided exactly, so that a point on a face, an edge or a
//! vertex is never lost between cells. Of several cells the lowest wins: tetrahedra before
//! octahedra, each in their order. A point that no cell contains has a nearest point on the
//! boundary; who asks decides what becomes of it ([`Nearest`]).

mod cage;
pub mod curved;
mod nearest;
pub mod octahedron;
pub mod tetrahedron;

pub use cage::{Located, RefinedCage};
pub use nearest::Nearest;

use crate::geometry::bounds;
use crate::mesh::{Cells, Faces, Point};
use nearest::BoundaryIndex;
use octahedron::Octahedron;
use rstar::RTree;
use rstar::primitives::{GeomWithData, Rectangle};
use std::cell::OnceCell;

/// Vertices with the weights that make a point of them; the weights sum to one.
pub type Embedding = Vec<(u32, f64)>;

/// A cell's box, with its number: tetrahedra first, then octahedra.
type CellBox = GeomWithData<Rectangle<Point>, usize>;

/// A spatial index over the cells of a solid.
pub struct Locator<'a> {
    cells: &'a Cells,
    surface: &'a Faces,
    points: &'a [Point],
    tree: RTree<CellBox>,
    boundary: OnceCell<BoundaryIndex>,
}

impl<'a> Locator<'a> {
    /// Indexes the cells. `surface` is the boundary, `points` the positions.
    pub fn new(cells: &'a Cells, surface: &'a Faces, points: &'a [Point]) -> Self {
        let boxes = cells.corners().enumerate().filter_map(|(cell, corners)| {
            let [low, high] = bounds(corners.iter().map(|corner| &points[*corner as usize]))?;
            Some(CellBox::new(Rectangle::from_corners(low, high), cell))
        });
        let tree = RTree::bulk_load(boxes.collect());
        Self {
            cells,
            surface,
            points,
            tree,
            boundary: OnceCell::new(),
        }
    }

    /// The point as a weighted sum of the corners of the lowest cell that contains it; `None` if no
    /// cell does.
    pub fn inside(&self, point: Point) -> Option<Embedding> {
        self.find(point).map(|(_, embedding)| embedding)
    }

    /// The lowest cell that contains the point, as a place in [`Cells::corners`], and the point as a
    /// weighted sum of its corners.
    pub fn find(&self, point: Point) -> Option<(usize, Embedding)> {
        let mut candidates: Vec<usize> = self
            .tree
            .locate_all_at_point(point)
            .map(|candidate| candidate.data)
            .collect();
        candidates.sort_unstable();
        candidates
            .into_iter()
            .find_map(|cell| Some((cell, self.in_cell(cell, point)?)))
    }

    /// The nearest point of the boundary. `None` if the solid has no boundary.
    pub fn nearest(&self, point: Point) -> Option<Nearest> {
        let index = self
            .boundary
            .get_or_init(|| BoundaryIndex::new(&self.surface.triangles, self.points));
        index.nearest(point)
    }

    /// The point, which lies outside, in the coordinates of the boundary cell behind `nearest`.
    pub fn extrapolated(&self, nearest: &Nearest, point: Point) -> Option<Embedding> {
        let cell = self.cell_behind(nearest)?;
        match cell.checked_sub(self.cells.tetrahedra.len()) {
            None => {
                let corners = &self.cells.tetrahedra[cell];
                let positions = self.positions(corners);
                Some(embedding(
                    corners,
                    tetrahedron::coordinates(&positions, point)?,
                ))
            }
            Some(cell) => {
                let corners = &self.cells.octahedra[cell];
                let face = self.surface.triangles[nearest.triangle];
                let place = |vertex| corners.iter().position(|corner| *corner == vertex);
                let local = face.map(|vertex| place(vertex).unwrap_or(0));
                let shape = Octahedron::new(self.positions(corners));
                Some(embedding(corners, shape.coordinates_behind(local, point)?))
            }
        }
    }

    /// The cell whose face `nearest` lies on, as a place in [`Cells::corners`].
    pub fn cell_behind(&self, nearest: &Nearest) -> Option<usize> {
        let face = self.surface.triangles[nearest.triangle];
        let middle = nearest.middle(face.map(|vertex| self.points[vertex as usize]));
        let holds_face = |cell: &usize| {
            let corners = self.cells.corners_of(*cell);
            face.iter().all(|vertex| corners.contains(vertex))
        };
        // The cell's box holds its face, and so the middle of it.
        let candidates = self.tree.locate_all_at_point(middle);
        candidates
            .map(|candidate| candidate.data)
            .filter(holds_face)
            .min()
    }

    /// The nearest point itself, as a weighted sum of its triangle's corners.
    pub fn projected(&self, nearest: &Nearest) -> Embedding {
        embedding(&self.surface.triangles[nearest.triangle], nearest.weights)
    }

    fn positions<const N: usize>(&self, corners: &[u32; N]) -> [Point; N] {
        corners.map(|corner| self.points[corner as usize])
    }

    fn in_cell(&self, cell: usize, point: Point) -> Option<Embedding> {
        match cell.checked_sub(self.cells.tetrahedra.len()) {
            None => {
                let corners = &self.cells.tetrahedra[cell];
                let positions = self.positions(corners);
                if !tetrahedron::contains(&positions, point) {
                    return None;
                }
                Some(embedding(
                    corners,
                    tetrahedron::coordinates(&positions, point)?,
                ))
            }
            Some(cell) => {
                let corners = &self.cells.octahedra[cell];
                let shape = Octahedron::new(self.positions(corners));
                if !shape.contains(point) {
                    return None;
                }
                Some(embedding(corners, shape.coordinates(point)?))
            }
        }
    }
}

fn embedding<const N: usize>(corners: &[u32; N], weights: [f64; N]) -> Embedding {
    corners
        .iter()
        .copied()
        .zip(weights)
        .filter(|(_, weight)| *weight != 0.0)
        .collect()
}
