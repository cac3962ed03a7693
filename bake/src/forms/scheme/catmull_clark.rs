//! Catmull and Clark's scheme.
//!
//! A refined mesh has the old vertices first, then one for each edge, then one for each face; its
//! faces are the corners of the old faces, numbered as half-edges, each with its old corner first.

use super::row::{Row, RowBuilder};
use crate::forms::exact::Field;
use crate::forms::mesh::{ClosedMesh, HalfEdge};

/// One step if all faces have four corners, otherwise two.
pub(super) fn steps(mesh: &ClosedMesh) -> usize {
    let all_quads = (0..mesh.faces()).all(|face| mesh.face(face).len() == 4);
    if all_quads { 1 } else { 2 }
}

pub(super) fn refine(mesh: &ClosedMesh) -> (usize, Vec<Vec<u32>>) {
    let name = |vertex: usize| u32::try_from(vertex).expect("meshes fit 32-bit indices");
    let edge = |half_edge| mesh.vertices() + mesh.edge_of(half_edge);
    let centre = |half_edge| mesh.vertices() + mesh.edges() + mesh.face_of(half_edge);
    let faces = (0..mesh.half_edges())
        .map(|corner| {
            let before = mesh.previous(corner);
            [
                mesh.origin(corner),
                edge(corner),
                centre(corner),
                edge(before),
            ]
            .map(name)
            .to_vec()
        })
        .collect();
    (mesh.vertices() + mesh.edges() + mesh.faces(), faces)
}

pub(super) fn row<F: Field>(mesh: &ClosedMesh, vertex: usize) -> Row<F> {
    let mut row = RowBuilder::new();
    if vertex < mesh.vertices() {
        add_vertex(&mut row, mesh, vertex);
    } else if vertex < mesh.vertices() + mesh.edges() {
        let side = mesh.edge_side(vertex - mesh.vertices());
        let twin = mesh.twin(side);
        for half_edge in [side, twin] {
            row.add(mesh.origin(half_edge), &F::ratio(1, 4));
            add_centre(&mut row, mesh, mesh.face_of(half_edge), &F::ratio(1, 4));
        }
    } else {
        let face = vertex - mesh.vertices() - mesh.edges();
        add_centre(&mut row, mesh, face, &F::one());
    }
    row.finish()
}

/// `(Q + 2 R + (n - 3) v) / n`, with Q the mean of the new face points and R the mean of the
/// edges' midpoints.
fn add_vertex<F: Field>(row: &mut RowBuilder<F>, mesh: &ClosedMesh, vertex: usize) {
    let around = mesh.around(vertex);
    let n = i64::try_from(around.len()).expect("valences are small");
    row.add(vertex, &F::ratio(n - 2, n));
    for half_edge in around {
        row.add(mesh.end(half_edge), &F::ratio(1, n * n));
        add_centre(row, mesh, mesh.face_of(half_edge), &F::ratio(1, n * n));
    }
}

/// `weight` times the mean of a face's corners.
fn add_centre<F: Field>(row: &mut RowBuilder<F>, mesh: &ClosedMesh, face: usize, weight: &F) {
    let corners = i64::try_from(mesh.face(face).len()).expect("faces are small");
    let weight = weight.scaled(1, corners);
    for corner in mesh.face_vertices(face) {
        row.add(corner, &weight);
    }
}

/// Four rows of four, the facet 5 6 10 9 in the middle with the irregular vertex at 10, whose ring
/// is 11 15 16 ... 14 13 9 5 6 7.
pub(super) fn control_points(mesh: &ClosedMesh, facet: HalfEdge) -> Vec<usize> {
    let around = mesh.turned_from(facet);
    let valence = around.len();
    let mut points = vec![usize::MAX; 2 * valence + 8];
    points[10] = mesh.origin(facet);
    for (slot, place) in ring_slots(valence).into_iter().zip(0..) {
        let spoke = around[place / 2];
        points[slot] = if place % 2 == 0 {
            mesh.end(spoke)
        } else {
            mesh.end(mesh.next(spoke))
        };
    }
    let left = mesh.next(mesh.twin(mesh.next(facet)));
    points[8] = mesh.end(left);
    points[4] = mesh.end(mesh.next(left));
    let low_left = mesh.next(mesh.twin(left));
    points[12] = mesh.end(mesh.next(low_left));
    let above = mesh.next(mesh.twin(mesh.next(mesh.next(facet))));
    points[1] = mesh.end(above);
    points[2] = mesh.end(mesh.next(above));
    points[0] = mesh.end(mesh.next(mesh.next(mesh.twin(above))));
    let right = mesh.twin(mesh.next(mesh.next(above)));
    points[3] = mesh.end(mesh.next(right));
    points
}

/// Where the ring of the irregular vertex goes, counter-clockwise from the facet's side 10 to 9.
fn ring_slots(valence: usize) -> Vec<usize> {
    let mut slots = vec![9, 5, 6, 7, 11];
    if valence == 3 {
        slots.push(13);
    } else {
        slots.extend(15..2 * valence + 8);
        slots.extend([14, 13]);
    }
    slots
}

pub(super) fn children(mesh: &ClosedMesh, facet: HalfEdge) -> [HalfEdge; 4] {
    let one = mesh.next(facet);
    let two = mesh.next(one);
    [one, two, mesh.next(two), facet].map(|corner| 4 * corner)
}
