//! The square-root-3 rules: split in three, then flip, triangle by triangle.

use std::collections::BTreeMap;

use super::Refined;
use super::polygons::{Border, Kind, Polygons, edge, sides};
use super::row::{Grid, Row};

/// `9 alpha_n` where it is an integer.
fn ninths(n: usize) -> Option<f64> {
    match n {
        2 => Some(6.0),
        3 => Some(5.0),
        4 => Some(4.0),
        6 => Some(3.0),
        _ => None,
    }
}

/// The relaxed vertex, rule (2).
fn relaxed(vertex: u32, ring: &[u32], grid: Grid) -> Row {
    let n = ring.len() as f64;
    let Some(ninths) = ninths(ring.len()) else {
        let alpha = (4.0 - 2.0 * (std::f64::consts::TAU / n).cos()) / 9.0;
        return Row::umbrella(vertex, ring, alpha / n, grid);
    };
    let mean = Row::mean(ring);
    Row::sum(&[(9.0 - ninths, Row::vertex(vertex)), (ninths, mean)], 9.0)
}

/// The kinds that this scheme knows: the end of a crease stays.
fn kinds(mesh: &Polygons) -> Vec<Kind> {
    let sharp = mesh.sharp_edges();
    let kinds = mesh.kinds(Border::Spline).into_iter().zip(0..);
    kinds
        .map(|(kind, vertex)| {
            let lines = sharp.iter().filter(|edge| edge.contains(&vertex)).count();
            if lines == 1 { Kind::Stays } else { kind }
        })
        .collect()
}

/// A side's triangle after the split in three: its apex and the side.
struct Piece {
    apex: u32,
    from: u32,
    to: u32,
}

/// One step. The mesh must be one that the step is defined for.
pub fn sqrt3(mesh: &Polygons, grid: Grid) -> Refined {
    let kinds = kinds(mesh);
    let sharp = mesh.sharp_edges();
    let neighbours = mesh.neighbours();
    let mut rows: Vec<Row> = kinds
        .iter()
        .zip(0..)
        .map(|(kind, vertex)| match kind {
            Kind::Smooth => relaxed(vertex, &neighbours[vertex as usize], grid),
            Kind::Crease(a, b) if mesh.odd => weighted(&[(4.0, *a), (19.0, vertex), (4.0, *b)]),
            _ => Row::vertex(vertex),
        })
        .collect();
    let mut thirds: BTreeMap<(u32, u32), u32> = BTreeMap::new();
    if mesh.odd {
        for [a, b] in &sharp {
            for (near, far) in [(*a, *b), (*b, *a)] {
                let Kind::Crease(one, other) = kinds[near as usize] else {
                    panic!("not trisectable at {near}");
                };
                let before = if one == far { other } else { one };
                thirds.insert((near, far), rows.len() as u32);
                rows.push(weighted(&[(1.0, before), (16.0, near), (10.0, far)]));
            }
        }
    }
    let mut centre = vec![None; mesh.faces.len()];
    for face in mesh.sorted_faces() {
        let corners = &mesh.faces[face];
        let on_line = sides(corners)
            .iter()
            .any(|(a, b)| sharp.contains(&edge(*a, *b)));
        if !(mesh.odd && on_line) {
            centre[face] = Some(rows.len() as u32);
            rows.push(Row::mean(corners));
        }
    }
    let faces = flipped(mesh, &centre, &thirds);
    let creases = mesh.creases.iter().flat_map(|[a, b]| {
        if mesh.odd {
            let (x, y) = (thirds[&(*a, *b)], thirds[&(*b, *a)]);
            vec![[*a, x], [x, y], [y, *b]]
        } else {
            vec![[*a, *b]]
        }
    });
    let mut refined = Refined::new(mesh, rows, faces, creases.collect());
    refined.mesh.odd = !mesh.odd;
    refined
}

fn weighted(terms: &[(f64, u32)]) -> Row {
    let terms: Vec<_> = terms
        .iter()
        .map(|(weight, vertex)| (*weight, Row::vertex(*vertex)))
        .collect();
    Row::sum(&terms, 27.0)
}

/// Splits and flips.
fn flipped(
    mesh: &Polygons,
    centre: &[Option<u32>],
    thirds: &BTreeMap<(u32, u32), u32>,
) -> Vec<Vec<u32>> {
    let sharp = mesh.sharp_edges();
    let mut pieces = Vec::new();
    for (corners, centre) in mesh.faces.iter().zip(centre) {
        for (from, to) in sides(corners) {
            let inner = |near: u32| thirds.get(&(near, opposite(corners, from, to)));
            let apex = match centre {
                Some(centre) => *centre,
                // The fan's outer parts point to the third that lies next to them.
                None => *inner(from).or(inner(to)).unwrap_or(&u32::MAX),
            };
            pieces.push(Piece { apex, from, to });
        }
    }
    let place: BTreeMap<(u32, u32), usize> = pieces
        .iter()
        .enumerate()
        .map(|(place, piece)| ((piece.from, piece.to), place))
        .collect();
    let corners = mesh.faces.iter().flat_map(|face| vec![face; 3]);
    pieces
        .iter()
        .zip(corners)
        .map(|(piece, corners)| {
            let Piece { apex, from, to } = *piece;
            if !sharp.contains(&edge(from, to)) {
                let beyond = pieces[place[&(to, from)]].apex;
                return vec![to, apex, beyond];
            }
            match (thirds.get(&(from, to)), thirds.get(&(to, from))) {
                (Some(x), Some(y)) => vec![opposite(corners, from, to), *x, *y],
                _ => vec![apex, from, to],
            }
        })
        .collect()
}

fn opposite(corners: &[u32], a: u32, b: u32) -> u32 {
    let other = corners.iter().find(|corner| **corner != a && **corner != b);
    *other.unwrap_or(&u32::MAX)
}

/// Limit positions: `beta(inf) = 3 alpha / (1 + 3 alpha)` of the ring's mean.
pub fn sqrt3_limit(mesh: &Polygons, grid: Grid) -> Vec<Row> {
    let neighbours = mesh.neighbours();
    let rows = kinds(mesh).into_iter().zip(0..);
    rows.map(|(kind, vertex)| match kind {
        Kind::Smooth => {
            let ring = &neighbours[vertex as usize];
            let n = ring.len() as f64;
            match ninths(ring.len()) {
                Some(a) => {
                    let terms = [(3.0, Row::vertex(vertex)), (a, Row::mean(ring))];
                    Row::sum(&terms, 3.0 + a)
                }
                None => {
                    let alpha = (4.0 - 2.0 * (std::f64::consts::TAU / n).cos()) / 9.0;
                    let weight = 3.0 * alpha / (1.0 + 3.0 * alpha) / n;
                    Row::umbrella(vertex, ring, weight, grid)
                }
            }
        }
        other => super::crease_limit_row(vertex, &other),
    })
    .collect()
}
