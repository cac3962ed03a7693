//! Doo and Sabin's scheme.
//!
//! A refined mesh has a vertex for each corner of a face (numbered as its half-edge), and a face
//! for each old face, edge and vertex, in this order.

use super::row::{Row, RowBuilder};
use crate::forms::exact::Field;
use crate::forms::mesh::{ClosedMesh, HalfEdge};

pub(super) fn refine(mesh: &ClosedMesh) -> (usize, Vec<Vec<u32>>) {
    let name = |half_edge: HalfEdge| u32::try_from(half_edge).expect("meshes fit 32-bit indices");
    let mut faces = Vec::with_capacity(mesh.faces() + mesh.edges() + mesh.vertices());
    for face in 0..mesh.faces() {
        faces.push(mesh.face(face).map(name).collect::<Vec<_>>());
    }
    for edge in 0..mesh.edges() {
        let side = mesh.edge_side(edge);
        let twin = mesh.twin(side);
        faces.push(
            [mesh.next(side), side, mesh.next(twin), twin]
                .map(name)
                .to_vec(),
        );
    }
    for vertex in 0..mesh.vertices() {
        faces.push(mesh.around(vertex).into_iter().map(name).collect());
    }
    (mesh.half_edges(), faces)
}

/// The new vertex at a corner of a face with `n` corners: `1/4 + 5/(4n)` of the corner and
/// `(3 + 2 cos(2 pi i / n)) / (4n)` of the corner `i` places further.
pub(super) fn row<F: Field>(mesh: &ClosedMesh, vertex: usize) -> Option<Row<F>> {
    let sides = mesh.sides(vertex);
    let n = i64::try_from(sides).ok()?;
    let mut row = RowBuilder::new();
    row.add(mesh.origin(vertex), &F::ratio(n + 5, 4 * n));
    let mut corner = vertex;
    for place in 1..u32::try_from(sides).ok()? {
        corner = mesh.next(corner);
        let cosine = F::cosine(place, u32::try_from(sides).ok()?)?;
        let weight = F::ratio(3, 4 * n).plus(&cosine.scaled(1, 2 * n));
        row.add(mesh.origin(corner), &weight);
    }
    Some(row.finish())
}

/// Three rows of three, the facet's vertex in the middle, then the rest of the irregular face:
/// `4 5 8 [9 10 ...] 7` counter-clockwise.
pub(super) fn control_points(mesh: &ClosedMesh, facet: HalfEdge) -> Vec<usize> {
    let sides = mesh.sides(facet);
    let mut points = vec![usize::MAX; sides + 5];
    let mut corner = facet;
    for place in 0..sides {
        let slot = match place {
            0 => 4,
            1 => 5,
            _ if place + 1 == sides => 7,
            _ => place + 6,
        };
        points[slot] = mesh.origin(corner);
        corner = mesh.next(corner);
    }
    let left = mesh.turn(facet);
    points[6] = mesh.end(mesh.next(left));
    points[3] = mesh.origin(mesh.previous(left));
    let below = mesh.next(mesh.twin(facet));
    points[1] = mesh.end(below);
    points[2] = mesh.end(mesh.next(below));
    let corner = mesh.turn(left);
    points[0] = mesh.end(mesh.next(corner));
    points
}

pub(super) fn children(mesh: &ClosedMesh, facet: HalfEdge) -> [HalfEdge; 4] {
    let around = mesh.turned_from(facet);
    [around[1], around[2], around[3], facet]
}
