//! Catmull and Clark's rules, vertex by vertex.

use super::polygons::{Border, Kind, Polygons, edge};
use super::row::Row;
use super::{Refined, crease_row};

/// One level: `(F + 2 R + (n - 3) p) / n` at smooth vertices.
pub fn catmull_clark(mesh: &Polygons, border: Border) -> Refined {
    let face_row: Vec<Row> = mesh.faces.iter().map(|face| Row::mean(face)).collect();
    let neighbours = mesh.neighbours();
    let faces_at = mesh.faces_at();
    let mut rows = Vec::new();
    for (kind, vertex) in mesh.kinds(border).iter().zip(0..) {
        let at = vertex as usize;
        rows.push(match kind {
            Kind::Smooth => {
                let n = neighbours[at].len() as f64;
                let own = Row::vertex(vertex);
                let faces: Vec<Row> = faces_at[at].iter().map(|f| face_row[*f].clone()).collect();
                let middles: Vec<Row> = neighbours[at]
                    .iter()
                    .map(|other| Row::mean(&[vertex, *other]))
                    .collect();
                let terms = [
                    (1.0, Row::mean_of(&faces)),
                    (2.0, Row::mean_of(&middles)),
                    (n - 3.0, own),
                ];
                Row::sum(&terms, n)
            }
            other => crease_row(vertex, other),
        });
    }
    let sharp = mesh.sharp_edges();
    for (ends, on) in mesh.edges() {
        rows.push(if sharp.contains(&ends) {
            Row::mean(&ends)
        } else {
            Row::mean_of(&[
                Row::vertex(ends[0]),
                Row::vertex(ends[1]),
                face_row[on[0]].clone(),
                face_row[on[1]].clone(),
            ])
        });
    }
    let middles = mesh.middles();
    let first = mesh.vertex_count + middles.len() as u32;
    let mut face_vertex = vec![0; mesh.faces.len()];
    for (face, vertex) in mesh.sorted_faces().into_iter().zip(first..) {
        face_vertex[face] = vertex;
        rows.push(face_row[face].clone());
    }
    let mut faces = Vec::new();
    for (face, centre) in mesh.faces.iter().zip(face_vertex) {
        let n = face.len();
        for i in 0..n {
            let (before, next) = (face[(i + n - 1) % n], face[(i + 1) % n]);
            let (one, other) = (edge(face[i], next), edge(before, face[i]));
            faces.push(vec![face[i], middles[&one], centre, middles[&other]]);
        }
    }
    Refined::new(mesh, rows, faces, mesh.halved_creases(&middles))
}

/// The limit positions on a mesh of quads, `(n^2 p + 4 sum(e) + sum(f)) / (n (n + 5))`.
pub fn catmull_clark_limit(mesh: &Polygons, border: Border) -> Vec<Row> {
    let neighbours = mesh.neighbours();
    let faces_at = mesh.faces_at();
    let rows = mesh.kinds(border).into_iter().zip(0..);
    rows.map(|(kind, vertex)| match kind {
        Kind::Smooth => {
            let n = neighbours[vertex as usize].len() as f64;
            let mut terms = vec![(n * n, Row::vertex(vertex))];
            for other in &neighbours[vertex as usize] {
                terms.push((4.0, Row::vertex(*other)));
            }
            for face in &faces_at[vertex as usize] {
                let quad = &mesh.faces[*face];
                let place = quad.iter().position(|corner| *corner == vertex);
                let across = quad[(place.unwrap_or_default() + 2) % 4];
                terms.push((1.0, Row::vertex(across)));
            }
            Row::sum(&terms, n * (n + 5.0))
        }
        other => super::crease_limit_row(vertex, &other),
    })
    .collect()
}
