//! Loop's scheme in its weight families.
//!
//! A refined mesh has the old vertices first, then one for each edge; a triangle (a, b, c) gives
//! (a, ab, ca) (ab, b, bc) (ca, bc, c) (ab, bc, ca).

use super::row::{Row, RowBuilder};
use crate::forms::error::FormError;
use crate::forms::exact::Field;
use crate::forms::mesh::{ClosedMesh, HalfEdge};

pub(super) fn require(mesh: &ClosedMesh) -> Result<(), FormError> {
    match (0..mesh.faces()).find(|&face| mesh.face(face).len() != 3) {
        Some(face) => Err(FormError::NotTriangles { face }),
        None => Ok(()),
    }
}

pub(super) fn refine(mesh: &ClosedMesh) -> (usize, Vec<Vec<u32>>) {
    let name = |vertex: usize| u32::try_from(vertex).expect("meshes fit 32-bit indices");
    let mut faces = Vec::with_capacity(4 * mesh.faces());
    for face in 0..mesh.faces() {
        let first = mesh.face(face).start;
        let [a, b, c] = [0, 1, 2].map(|corner| name(mesh.origin(first + corner)));
        let [ab, bc, ca] = [0, 1, 2].map(|side| name(mesh.vertices() + mesh.edge_of(first + side)));
        faces.extend([
            vec![a, ab, ca],
            vec![ab, b, bc],
            vec![ca, bc, c],
            vec![ab, bc, ca],
        ]);
    }
    (mesh.vertices() + mesh.edges(), faces)
}

pub(super) fn row<F: Field>(
    mesh: &ClosedMesh,
    vertex: usize,
    weight: impl Fn(u32) -> Option<F>,
) -> Option<Row<F>> {
    let mut row = RowBuilder::new();
    if vertex < mesh.vertices() {
        let around = mesh.around(vertex);
        let valence = u32::try_from(around.len()).ok()?;
        let weight = weight(valence)?;
        row.add(
            vertex,
            &F::one().minus(&weight.scaled(i64::from(valence), 1)),
        );
        for half_edge in around {
            row.add(mesh.end(half_edge), &weight);
        }
    } else {
        let side = mesh.edge_side(vertex - mesh.vertices());
        for half_edge in [side, mesh.twin(side)] {
            row.add(mesh.origin(half_edge), &F::ratio(3, 8));
            row.add(mesh.end(mesh.next(half_edge)), &F::ratio(1, 8));
        }
    }
    Some(row.finish())
}

/// Loop's weight of one neighbour, `(5/8 - (3/8 + cos(2 pi / n) / 4)^2) / n`.
pub(super) fn loop_weight<F: Field>(valence: u32) -> Option<F> {
    let root = F::ratio(3, 8).plus(&F::cosine(1, valence)?.scaled(1, 4));
    let all = F::ratio(5, 8).minus(&root.times(&root));
    Some(all.scaled(1, i64::from(valence)))
}

/// Warren's weight of one neighbour, `3/(8n)`, and `3/16` at valence 3.
pub(super) fn warren_weight<F: Field>(valence: u32) -> Option<F> {
    Some(match valence {
        3 => F::ratio(3, 16),
        n => F::ratio(3, 8 * i64::from(n)),
    })
}

/// Rows `0 1 2 / 3 4 5 6 / 7 8 9 / 10 11`, the facet 4 5 8 with the irregular vertex at 8, whose
/// ring is 4 5 9 [11 12 ...] 10 7.
pub(super) fn control_points(mesh: &ClosedMesh, facet: HalfEdge) -> Vec<usize> {
    let around = mesh.turned_from(facet);
    let mut points = vec![usize::MAX; around.len() + 6];
    points[8] = mesh.origin(facet);
    for (slot, spoke) in ring_slots(around.len()).into_iter().zip(&around) {
        points[slot] = mesh.end(*spoke);
    }
    let side = mesh.next(facet);
    let left = mesh.turned_from(side);
    let right = mesh.turned_from(mesh.next(side));
    points[3] = mesh.end(left[3 % left.len()]);
    points[0] = mesh.end(left[4 % left.len()]);
    points[1] = mesh.end(left[5 % left.len()]);
    points[2] = mesh.end(right[3 % right.len()]);
    points[6] = mesh.end(right[4 % right.len()]);
    points
}

/// Where the ring of the irregular vertex goes, counter-clockwise from the facet's side 8 to 4.
fn ring_slots(valence: usize) -> Vec<usize> {
    match valence {
        3 => vec![4, 5, 7],
        4 => vec![4, 5, 9, 7],
        _ => {
            let mut slots = vec![4, 5, 9];
            slots.extend(11..valence + 6);
            slots.extend([10, 7]);
            slots
        }
    }
}

pub(super) fn children(mesh: &ClosedMesh, facet: HalfEdge) -> [HalfEdge; 4] {
    let face = mesh.face_of(facet);
    let corner = facet - mesh.face(face).start;
    let [one, two] = [(corner + 1) % 3, (corner + 2) % 3];
    let half_edge = |child: usize, place: usize| 3 * (4 * face + child) + place;
    [
        half_edge(one, one),
        half_edge(two, two),
        half_edge(3, 0),
        half_edge(corner, corner),
    ]
}
