//! Cells that share space: the places at which no map can be built, because a point there would
//! belong to two cells.
//!
//! Decided exactly. Two tetrahedra share no space if and only if some plane has one on either side,
//! and if there is such a plane there is one through three of their eight corners: the planes
//! between them form a cone, and an edge of that cone touches three corners that lie on no line. So
//! all planes through three corners are tried, and on which side of them the others lie is decided
//! exactly ([`crate::geometry`]). An octahedron is the four tetrahedra round the diagonal that cuts it; a
//! prism or hexahedron with plane faces is cut into tetrahedra too. One with bent faces is left out:
//! where its quadrilaterals run depends on its neighbours, and touching must not pass for sharing.

use crate::error::{Error, Result, count};
use crate::geometry::{bounds, inside_of_face, tetrahedron_volume_6};
use crate::locate::octahedron::Octahedron;
use crate::mesh::{Cells, Point, Shape, SolidMesh, Vertex};
use rstar::RTree;
use rstar::primitives::{GeomWithData, Rectangle};

/// Four corners of a cell's tetrahedron.
type Corners = [Vertex; 4];

/// The box of a tetrahedron, with its number.
type PartBox = GeomWithData<Rectangle<Point>, usize>;

/// The pairs of cells that share space, as places in [`Cells::corners`], ascending, each with the
/// lesser first. Cells without volume and folded octahedra take no space here: these are faults
/// of their own.
pub fn overlapping_cells(cells: &Cells, points: &[Point]) -> Vec<[usize; 2]> {
    let parts = parts(cells, points);
    let boxes = parts.iter().enumerate().filter_map(|(index, (_, part))| {
        let [low, high] = bounds(part.iter().map(|corner| &points[*corner as usize]))?;
        Some(PartBox::new(Rectangle::from_corners(low, high), index))
    });
    let tree = RTree::bulk_load(boxes.collect());
    let mut pairs: Vec<[usize; 2]> = tree
        .intersection_candidates_with_other_tree(&tree)
        .filter(|(a, b)| a.data < b.data && boxes_share_space(a.geom(), b.geom()))
        .filter_map(|(a, b)| {
            let ((cell, part), (other, other_part)) = (&parts[a.data], &parts[b.data]);
            let shared = cell != other && share_space(*part, *other_part, points);
            shared.then(|| [*cell.min(other), *cell.max(other)])
        })
        .collect();
    pairs.sort_unstable();
    pairs.dedup();
    pairs
}

/// Error if cells share space. Volumes were checked before.
pub fn require_none(mesh: &SolidMesh) -> Result<()> {
    let pairs = overlapping_cells(&mesh.cells, &mesh.points);
    let Some([a, b]) = pairs.first() else {
        return Ok(());
    };
    Err(Error::new(format!(
        "{} space, first {} and {} (counted from 0 in file order)",
        count(pairs.len(), "pair of cells shares", "pairs of cells share"),
        mesh.cells.name(*a),
        mesh.cells.name(*b)
    ))
    .advise("a point there would belong to both cells: remove one of them, or move their vertices apart"))
}

/// The tetrahedra that the cells are made of, each with its cell.
fn parts(cells: &Cells, points: &[Point]) -> Vec<(usize, Corners)> {
    let position = |vertex: Vertex| points[vertex as usize];
    let volume = |part: &Corners| tetrahedron_volume_6(part.map(position));
    let mut parts = Vec::new();
    for (cell, part) in cells.tetrahedra.iter().enumerate() {
        if volume(part) != 0.0 {
            parts.push((cell, *part));
        }
    }
    let mut cell = cells.tetrahedra.len();
    for corners in &cells.octahedra {
        let shape = Octahedron::new(corners.map(position));
        if shape.is_sound() {
            let own = shape.parts().map(|part| part.map(|corner| corners[corner]));
            parts.extend(own.map(|part| (cell, part)));
        }
        cell += 1;
    }
    let prisms = cells
        .prisms
        .iter()
        .map(|prism| (Shape::Prism, prism.as_slice()));
    let hexahedra = cells.hexahedra.iter();
    let hexahedra = hexahedra.map(|hexahedron| (Shape::Hexahedron, hexahedron.as_slice()));
    for (shape, corners) in prisms.chain(hexahedra) {
        let own: Vec<Corners> = cut(shape)
            .map(|part| part.map(|corner| corners[corner]))
            .collect();
        let is_plane = |quad: &[usize; 4]| volume(&quad.map(|corner| corners[corner])) == 0.0;
        if shape.quads().iter().all(is_plane) && own.iter().all(|part| volume(part) > 0.0) {
            parts.extend(own.into_iter().map(|part| (cell, part)));
        }
        cell += 1;
    }
    parts
}

/// Places of the corners of the tetrahedra into which a prism or hexahedron is cut, positive if it is.
fn cut(shape: Shape) -> impl Iterator<Item = [usize; 4]> {
    /// Of a prism.
    const TETRAHEDRA: [[usize; 4]; 3] = [[0, 1, 2, 5], [0, 1, 5, 4], [0, 4, 5, 3]];
    let prisms: &[[usize; 6]] = match shape {
        Shape::Prism => &[[0, 1, 2, 3, 4, 5]],
        Shape::Hexahedron => &[[0, 1, 2, 4, 5, 6], [0, 2, 3, 4, 6, 7]],
        Shape::Tetrahedron | Shape::Octahedron => &[],
    };
    let of_prism = |prism: &[usize; 6]| TETRAHEDRA.map(|part| part.map(|corner| prism[corner]));
    prisms.iter().flat_map(of_prism)
}

/// Whether two boxes share more than a side.
fn boxes_share_space(a: &Rectangle<Point>, b: &Rectangle<Point>) -> bool {
    (0..3).all(|axis| a.lower()[axis] < b.upper()[axis] && b.lower()[axis] < a.upper()[axis])
}

/// Whether two tetrahedra with volume share space.
fn share_space(a: Corners, b: Corners, points: &[Point]) -> bool {
    let all: [Vertex; 8] = std::array::from_fn(|place| match place {
        0..4 => a[place],
        _ => b[place - 4],
    });
    !TRIPLES
        .iter()
        .any(|triple| separates(triple.map(|place| all[place]), a, b, points))
}

/// Whether the plane through three corners has `a` on one side and `b` on the other; corners in the
/// plane are on both.
fn separates(plane: [Vertex; 3], a: Corners, b: Corners, points: &[Point]) -> bool {
    let [first, second, third] = plane;
    if first == second || second == third || third == first {
        return false;
    }
    let face = plane.map(|vertex| points[vertex as usize]);
    // A plane's own corners lie in it, whatever the predicate's zero looks like.
    let others = |cell: Corners| cell.into_iter().filter(|vertex| !plane.contains(vertex));
    let (mut side, mut is_plane) = (0.0, false);
    for (cell, sign) in [(a, 1.0), (b, -1.0)] {
        for vertex in others(cell) {
            let own = sign * inside_of_face(face, points[vertex as usize]);
            if own == 0.0 {
                continue;
            }
            if is_plane && (own > 0.0) != (side > 0.0) {
                return false;
            }
            (side, is_plane) = (own, true);
        }
    }
    // Of corners on one line no other corner lies to a side: that is no plane.
    is_plane
}

/// All triples of places among eight corners; faces of one cell, which separate most cells, first.
const TRIPLES: [[usize; 3]; 56] = triples();

const fn triples() -> [[usize; 3]; 56] {
    let mut list = [[0; 3]; 56];
    let mut number = 0;
    let mut of_one_cell = true;
    loop {
        let mut a = 0;
        while a < 6 {
            let mut b = a + 1;
            while b < 7 {
                let mut c = b + 1;
                while c < 8 {
                    if (c < 4 || a >= 4) == of_one_cell {
                        list[number] = [a, b, c];
                        number += 1;
                    }
                    c += 1;
                }
                b += 1;
            }
            a += 1;
        }
        if !of_one_cell {
            return list;
        }
        of_one_cell = false;
    }
}
