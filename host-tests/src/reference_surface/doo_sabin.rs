//! Doo and Sabin's rule, face by face.

use std::collections::BTreeMap;

use super::Refined;
use super::polygons::{Polygons, edge, sides};
use super::row::{Grid, Row, WEIGHT_UNIT};

/// `w_j = (3 + 2 cos(2 pi j / n)) / (4n)`, with `5/(4n) + 1/4` at `j = 0`.
fn real_weight(j: usize, n: usize) -> f64 {
    (3.0 + 2.0 * (std::f64::consts::TAU * j as f64 / n as f64).cos()) / (4.0 * n as f64)
}

/// The weights by distance as integers over a denominator, where the cosines are rational.
fn rational(n: usize) -> Option<(Vec<f64>, f64)> {
    match n {
        // cos = -1/2: w = 2/12, w_0 = 1/4 + 5/12.
        3 => Some((vec![2.0 / 3.0 * 12.0, 2.0], 12.0)),
        // cos = 0, -1: 3/16, 1/16, w_0 = 1/4 + 5/16.
        4 => Some((vec![9.0, 3.0, 1.0], 16.0)),
        // cos = 1/2, -1/2, -1: 4/24, 2/24, 1/24, w_0 = 1/4 + 5/24.
        6 => Some((vec![11.0, 4.0, 2.0, 1.0], 24.0)),
        _ => None,
    }
}

fn corner_row(face: &[u32], corner: usize, grid: Grid) -> Row {
    let n = face.len();
    let distance = |j: usize| {
        let around = (j + n - corner) % n;
        around.min(n - around)
    };
    if let Some((weights, denominator)) = rational(n) {
        let terms: Vec<_> = (0..n)
            .map(|j| (weights[distance(j)], Row::vertex(face[j])))
            .collect();
        return Row::sum(&terms, denominator);
    }
    let others = (0..n).filter(|j| *j != corner);
    let mut terms: Vec<(f64, Row)> = others
        .map(|j| {
            let weight = grid.weight(real_weight(distance(j), n));
            (weight, Row::vertex(face[j]))
        })
        .collect();
    let rest: f64 = terms.iter().map(|term| term.0).sum();
    terms.push((WEIGHT_UNIT - rest, Row::vertex(face[corner])));
    Row::sum(&terms, WEIGHT_UNIT)
}

/// One level of an oriented manifold without creases and corners.
pub fn doo_sabin(mesh: &Polygons, grid: Grid) -> Refined {
    let mut rows = Vec::new();
    let mut faces = Vec::new();
    // Which new vertex stands where a directed side starts and ends in its face.
    let mut starts: BTreeMap<(u32, u32), u32> = BTreeMap::new();
    let mut ends: BTreeMap<(u32, u32), u32> = BTreeMap::new();
    let mut corner_of = Vec::new();
    for face in &mesh.faces {
        let first = rows.len() as u32;
        let n = face.len();
        rows.extend((0..n).map(|corner| corner_row(face, corner, grid)));
        faces.push((first..first + n as u32).collect());
        for (i, (a, b)) in sides(face).into_iter().enumerate() {
            starts.insert((a, b), first + i as u32);
            ends.insert((a, b), first + ((i + 1) % n) as u32);
            corner_of.push((a, face[(i + n - 1) % n]));
        }
    }
    for ([a, b], on) in mesh.edges() {
        if on.len() != 2 {
            continue;
        }
        let (x, y) = if starts[&(a, b)] < starts[&(b, a)] {
            ((a, b), (b, a))
        } else {
            ((b, a), (a, b))
        };
        faces.push(vec![starts[&x], ends[&y], starts[&y], ends[&x]]);
    }
    let edges = mesh.edges();
    for vertex in 0..mesh.vertex_count {
        let at = |corner: &(u32, u32)| corner.0 == vertex;
        let is_closed = edges
            .iter()
            .filter(|(ends, _)| ends.contains(&vertex))
            .all(|(_, on)| on.len() == 2);
        let Some(first) = corner_of.iter().position(at).filter(|_| is_closed) else {
            continue;
        };
        let mut fan = vec![first as u32];
        loop {
            let (_, before) = corner_of[fan[fan.len() - 1] as usize];
            let next = starts[&(vertex, before)];
            if next == fan[0] {
                break;
            }
            fan.push(next);
        }
        debug_assert!(edges.contains_key(&edge(vertex, corner_of[first].1)));
        faces.push(fan);
    }
    Refined::new(mesh, rows, faces, Vec::new())
}
