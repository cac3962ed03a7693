//! Finds the cell that holds a point, and the point's coordinates in it.
//!
//! Whether a tetrahedron or an octahedron contains a point is decided exactly, and whether a prism or a
//! hexahedron does to within a few roundings in favour of the cell ([`inverse::reach`]), so that a
//! point on a face, an edge or a vertex is never lost between cells. Of several cells the lowest wins:
//! tetrahedra, octahedra, prisms and hexahedra in turn, each in their order. Where flat triangles lie
//! on a curved quadrilateral and bulge out of its cell there is a lens in no cell; its points belong to
//! that cell, in coordinates that are continuous through it. A point that no cell contains has a nearest
//! point on the boundary; who asks decides what becomes of it ([`Nearest`]).

mod cage;
pub mod curved;
pub mod inverse;
mod lens;
mod nearest;
pub mod octahedron;
mod patch;
pub mod tetrahedron;

pub use cage::{Located, RefinedCage};
pub use nearest::Nearest;

use crate::geometry::{add_scaled, bounds, length, subtract};
use crate::mesh::{Cells, Faces, Point, Shape};
use curved::{Hexahedron, Prism};
use inverse::Map;
use lens::Lenses;
use nearest::BoundaryIndex;
use octahedron::Octahedron;
use rstar::RTree;
use rstar::primitives::{GeomWithData, Rectangle};
use std::cell::OnceCell;

/// Vertices with the weights that make a point of them; the weights sum to one.
pub type Embedding = Vec<(u32, f64)>;

/// A cell's box, with its place in [`Cells::iter`].
type CellBox = GeomWithData<Rectangle<Point>, usize>;

/// A spatial index over the cells of a solid.
pub struct Locator<'a> {
    cells: &'a Cells,
    surface: &'a Faces,
    points: &'a [Point],
    tree: RTree<CellBox>,
    lenses: Lenses,
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
            lenses: Lenses::new(cells, points),
            boundary: OnceCell::new(),
        }
    }

    /// The point as a weighted sum of the corners of the lowest cell that contains it; `None` if no
    /// cell does.
    pub fn inside(&self, point: Point) -> Option<Embedding> {
        self.find(point).map(|(_, embedding)| embedding)
    }

    /// The lowest cell that contains the point, as a place in [`Cells::iter`], and the point as a
    /// weighted sum of its corners.
    pub fn find(&self, point: Point) -> Option<(usize, Embedding)> {
        if let Some((cell, weights)) = self.lenses.find(self.points, point) {
            let used = weights.into_iter().filter(|(_, weight)| *weight != 0.0);
            return Some((cell, used.collect()));
        }
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
            .get_or_init(|| BoundaryIndex::new(self.surface, self.points));
        index.nearest(point)
    }

    /// The point, which lies outside, in the coordinates of the boundary cell behind `nearest`: affine
    /// ones of a tetrahedron or of a part of an octahedron, for other cells to first order from the nearest
    /// point.
    pub fn extrapolated(&self, nearest: &Nearest, point: Point) -> Option<Embedding> {
        match self.cells.place(self.cell_behind(nearest)?) {
            (Shape::Tetrahedron, place) => {
                let corners = &self.cells.tetrahedra[place];
                let positions = self.positions(corners);
                Some(embedding(
                    corners,
                    tetrahedron::coordinates(&positions, point)?,
                ))
            }
            (Shape::Octahedron, place) => {
                let corners = &self.cells.octahedra[place];
                let face = *self.surface.triangles.get(nearest.face)?;
                let place = |vertex| corners.iter().position(|corner| *corner == vertex);
                let local = face.map(|vertex| place(vertex).unwrap_or(0));
                let shape = Octahedron::new(self.positions(corners));
                Some(embedding(corners, shape.coordinates_behind(local, point)?))
            }
            (Shape::Prism, place) => {
                let corners = &self.cells.prisms[place];
                let shape = Prism::new(self.positions(corners));
                Some(embedding(corners, self.beside(&shape, nearest, point)?))
            }
            (Shape::Hexahedron, place) => {
                let corners = &self.cells.hexahedra[place];
                let shape = Hexahedron::new(self.positions(corners));
                Some(embedding(corners, self.beside(&shape, nearest, point)?))
            }
        }
    }

    /// Weights of a curved cell's corners for a point outside.
    fn beside<const N: usize, M: Map<N>>(
        &self,
        shape: &M,
        nearest: &Nearest,
        point: Point,
    ) -> Option<[f64; N]> {
        let at_face = self
            .projected(nearest)
            .iter()
            .fold([0.0; 3], |sum, (vertex, weight)| {
                add_scaled(sum, *weight, self.points[*vertex as usize])
            });
        // The open half of a covered quadrilateral is flat and may lie a little outside the cell.
        let from = inverse::inside(shape, at_face).unwrap_or_else(|| {
            let toward = |corner: &Point| length(subtract(*corner, at_face));
            let nearer = |a: &usize, b: &usize| {
                toward(&shape.corners()[*a]).total_cmp(&toward(&shape.corners()[*b]))
            };
            M::CORNERS[(0..N).min_by(nearer).unwrap_or(0)]
        });
        inverse::extrapolated(shape, from, point)
    }

    /// The cell whose face `nearest` lies on, as a place in [`Cells::iter`].
    pub fn cell_behind(&self, nearest: &Nearest) -> Option<usize> {
        let face = self.face(nearest);
        let corners: Vec<Point> = face.iter().map(|v| self.points[*v as usize]).collect();
        let holds_face = |cell: &usize| {
            let corners = self.cells.corners_of(*cell);
            face.iter().all(|vertex| corners.contains(vertex))
        };
        // The cell's box holds its face, and so the middle of it.
        let candidates = self.tree.locate_all_at_point(nearest::middle(&corners));
        candidates
            .map(|candidate| candidate.data)
            .filter(holds_face)
            .min()
    }

    /// The nearest point itself, as a weighted sum of its face's corners.
    pub fn projected(&self, nearest: &Nearest) -> Embedding {
        let weighted = self.face(nearest).iter().copied().zip(nearest.weights);
        weighted.filter(|(_, weight)| *weight != 0.0).collect()
    }

    /// The corners of the face that `nearest` lies on.
    fn face(&self, nearest: &Nearest) -> &[u32] {
        match nearest.face.checked_sub(self.surface.triangles.len()) {
            None => &self.surface.triangles[nearest.face],
            Some(quad) => &self.surface.quads[quad],
        }
    }

    fn positions<const N: usize>(&self, corners: &[u32; N]) -> [Point; N] {
        corners.map(|corner| self.points[corner as usize])
    }

    fn in_cell(&self, cell: usize, point: Point) -> Option<Embedding> {
        match self.cells.place(cell) {
            (Shape::Tetrahedron, place) => {
                let corners = &self.cells.tetrahedra[place];
                let positions = self.positions(corners);
                if !tetrahedron::contains(&positions, point) {
                    return None;
                }
                Some(embedding(
                    corners,
                    tetrahedron::coordinates(&positions, point)?,
                ))
            }
            (Shape::Octahedron, place) => {
                let corners = &self.cells.octahedra[place];
                let shape = Octahedron::new(self.positions(corners));
                if !shape.contains(point) {
                    return None;
                }
                Some(embedding(corners, shape.coordinates(point)?))
            }
            (Shape::Prism, place) => {
                let corners = &self.cells.prisms[place];
                let found = inverse::inside(&Prism::new(self.positions(corners)), point)?;
                Some(embedding(corners, Prism::weights(found)))
            }
            (Shape::Hexahedron, place) => {
                let corners = &self.cells.hexahedra[place];
                let found = inverse::inside(&Hexahedron::new(self.positions(corners)), point)?;
                Some(embedding(corners, Hexahedron::weights(found)))
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
