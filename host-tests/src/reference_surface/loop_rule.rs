//! Loop's rules, vertex by vertex.

use super::polygons::{Border, Kind, Polygons, edge};
use super::row::{Grid, Row};
use super::{Refined, crease_limit_row, crease_row};

/// A neighbour's weight.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Family {
    /// `(5/8 - (3/8 + cos(2 pi/n)/4)^2) / n`.
    Loop,
    /// `3/(8n)`, `3/16` at 3.
    Warren,
    /// `3/(8n)`.
    TriQuad,
}

/// The weight as an exact fraction where it is one.
fn fraction(family: Family, n: usize) -> Option<(f64, f64)> {
    match (family, n) {
        (Family::Loop, 2) => Some((39.0, 128.0)),
        (Family::Loop | Family::Warren, 3) => Some((3.0, 16.0)),
        (Family::Loop, 4) => Some((31.0, 256.0)),
        (Family::Loop, 6) => Some((1.0, 16.0)),
        (Family::Loop, _) => None,
        _ => Some((3.0, 8.0 * n as f64)),
    }
}

fn real(n: usize) -> f64 {
    let ring = 0.375 + (std::f64::consts::TAU / n as f64).cos() / 4.0;
    (0.625 - ring * ring) / n as f64
}

fn smooth_row(vertex: u32, ring: &[u32], exact: Option<(f64, f64)>, real: f64, grid: Grid) -> Row {
    let Some((numerator, denominator)) = exact else {
        return Row::umbrella(vertex, ring, real, grid);
    };
    let own = denominator - ring.len() as f64 * numerator;
    let mut terms = vec![(own, Row::vertex(vertex))];
    terms.extend(ring.iter().map(|other| (numerator, Row::vertex(*other))));
    Row::sum(&terms, denominator)
}

/// One level.
pub fn loop_rule(mesh: &Polygons, family: Family, border: Border, grid: Grid) -> Refined {
    let neighbours = mesh.neighbours();
    let mut rows = Vec::new();
    for (kind, vertex) in mesh.kinds(border).iter().zip(0..) {
        let ring = &neighbours[vertex as usize];
        rows.push(match kind {
            Kind::Smooth => {
                let exact = fraction(family, ring.len());
                smooth_row(vertex, ring, exact, real(ring.len()), grid)
            }
            other => crease_row(vertex, other),
        });
    }
    let sharp = mesh.sharp_edges();
    for (ends, on) in mesh.edges() {
        rows.push(if sharp.contains(&ends) {
            Row::mean(&ends)
        } else {
            let mut terms = vec![(3.0, Row::vertex(ends[0])), (3.0, Row::vertex(ends[1]))];
            for face in on {
                let apex = mesh.faces[face].iter().filter(|v| !ends.contains(v));
                terms.extend(apex.map(|apex| (1.0, Row::vertex(*apex))));
            }
            Row::sum(&terms, 8.0)
        });
    }
    let middles = mesh.middles();
    Refined::new(
        mesh,
        rows,
        quadrisected(mesh),
        mesh.halved_creases(&middles),
    )
}

/// Every triangle as four.
pub fn quadrisected(mesh: &Polygons) -> Vec<Vec<u32>> {
    let middles = mesh.middles();
    let mut faces = Vec::new();
    for face in &mesh.faces {
        let (a, b, c) = (face[0], face[1], face[2]);
        let m = |a, b| middles[&edge(a, b)];
        faces.push(vec![a, m(a, b), m(c, a)]);
        faces.push(vec![m(a, b), b, m(b, c)]);
        faces.push(vec![m(c, a), m(b, c), c]);
        faces.push(vec![m(a, b), m(b, c), m(c, a)]);
    }
    faces
}

/// Limit positions: each neighbour has `1 / (n + 3/(8 beta))`.
pub fn loop_limit(mesh: &Polygons, family: Family, border: Border, grid: Grid) -> Vec<Row> {
    let neighbours = mesh.neighbours();
    let rows = mesh.kinds(border).into_iter().zip(0..);
    rows.map(|(kind, vertex)| match kind {
        Kind::Smooth => {
            let ring = &neighbours[vertex as usize];
            let n = ring.len() as f64;
            let exact = fraction(family, ring.len()).map(|(p, q)| (8.0 * p, 8.0 * p * n + 3.0 * q));
            let beta = real(ring.len());
            smooth_row(vertex, ring, exact, 1.0 / (n + 0.375 / beta), grid)
        }
        other => crease_limit_row(vertex, &other),
    })
    .collect()
}
