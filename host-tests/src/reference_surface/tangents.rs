//! Normals in the limit, vertex by vertex: the rules of `docs/numerics.md` in integers of 128 bits.
//!
//! The weights at the ends of a crease are not taken from a formula: they are what makes the mask a left
//! eigenvector of the sector's matrix, two equations for the weights of an end and of the vertex itself.

use super::polygons::{Border, Kind, Polygons, edge};
use super::row::Grid;
use crate::reference::normals::unit;

type Vector = [i128; 3];
type Corner = (usize, usize);

/// The faces of a sector, counter-clockwise: the edges' other ends, one more than faces unless the sector is
/// closed, and the vertices across the quads.
struct Sector {
    corners: Vec<Corner>,
    edges: Vec<u32>,
    across: Vec<u32>,
    is_closed: bool,
}

/// A normal for every corner of every face, face by face, and how many sectors have none.
pub fn limit_normals(
    mesh: &Polygons,
    are_quads: bool,
    border: Border,
    points: &[[i32; 3]],
) -> (Vec<[i16; 3]>, u32) {
    let mut normals: Vec<Vec<[i16; 3]>> =
        mesh.faces.iter().map(|f| vec![[0; 3]; f.len()]).collect();
    let mut zeros = 0;
    let edges = mesh.edges();
    for (vertex, kind) in (0..).zip(mesh.kinds(border)) {
        let rim = edges
            .iter()
            .filter(|(e, on)| e.contains(&vertex) && on.len() != 2);
        let sharp = mesh.sharp_edges();
        let lines = sharp.iter().filter(|e| e.contains(&vertex)).count();
        let stays_on_rim = border == Border::Fixed && rim.count() > 0 && lines == 2;
        let is_corner = kind == Kind::Stays && !stays_on_rim;
        for sector in sectors(mesh, vertex, kind == Kind::Smooth) {
            let normal = sector_normal(&sector, vertex, are_quads, is_corner, points);
            zeros += u32::from(normal == [0; 3]);
            for (face, place) in sector.corners {
                normals[face][place] = normal;
            }
        }
    }
    (normals.concat(), zeros)
}

/// A normal for every face at its centre, and how many faces have none.
pub fn face_normals(mesh: &Polygons, points: &[[i32; 3]]) -> (Vec<[i16; 3]>, u32) {
    let normal = |face: &Vec<u32>| {
        let tangents = ring(face.len()).map(|weights| {
            let terms = face.iter().copied().zip(weights).collect::<Vec<_>>();
            tangent(&terms, face[0], points)
        });
        unit(crossed(&tangents))
    };
    let normals: Vec<[i16; 3]> = mesh.faces.iter().map(normal).collect();
    let zeros = normals.iter().filter(|normal| **normal == [0; 3]).count();
    (normals, zeros as u32)
}

fn sectors(mesh: &Polygons, vertex: u32, ignores_lines: bool) -> Vec<Sector> {
    let mut left: Vec<Corner> = Vec::new();
    for (index, face) in mesh.faces.iter().enumerate() {
        left.extend(
            face.iter()
                .position(|v| *v == vertex)
                .map(|place| (index, place)),
        );
    }
    let at = |(face, place): Corner, step: usize| {
        let corners = &mesh.faces[face];
        corners[(place + step) % corners.len()]
    };
    let before = |corner: Corner| at(corner, mesh.faces[corner.0].len() - 1);
    let (sharp, edges) = (mesh.sharp_edges(), mesh.edges());
    let parts = |other: u32| {
        let key = edge(vertex, other);
        edges[&key].len() != 2 || sharp.contains(&key) && !ignores_lines
    };
    let all = left.clone();
    let mut found = Vec::new();
    while let Some(&seed) = left.first() {
        let mut first = seed;
        while !parts(at(first, 1)) {
            let over = at(first, 1);
            let next = all.iter().copied().find(|c| before(*c) == over);
            first = next.expect("a face on the other side of the edge");
            if first == seed {
                break;
            }
        }
        let mut corners = vec![first];
        loop {
            let last = corners[corners.len() - 1];
            if parts(before(last)) {
                break;
            }
            let next = all.iter().copied().find(|c| at(*c, 1) == before(last));
            let next = next.expect("a face on the other side of the edge");
            if next == first {
                break;
            }
            corners.push(next);
        }
        left.retain(|corner| !corners.contains(corner));
        let last = before(corners[corners.len() - 1]);
        let mut ends: Vec<u32> = corners.iter().map(|corner| at(*corner, 1)).collect();
        let is_closed = ends[0] == last;
        if !is_closed {
            ends.push(last);
        }
        found.push(Sector {
            across: corners.iter().map(|corner| at(*corner, 2)).collect(),
            corners,
            edges: ends,
            is_closed,
        });
    }
    found
}

fn sector_normal(
    sector: &Sector,
    own: u32,
    are_quads: bool,
    is_corner: bool,
    points: &[[i32; 3]],
) -> [i16; 3] {
    let k = sector.corners.len();
    let weighted = |edges: &[f64], across: &[f64]| {
        let mut terms: Vec<(u32, f64)> = Vec::new();
        terms.extend(sector.edges.iter().copied().zip(edges.iter().copied()));
        if are_quads {
            terms.extend(sector.across.iter().copied().zip(across.iter().copied()));
        }
        tangent(&terms, own, points)
    };
    if sector.is_closed {
        if k < 3 {
            return [0; 3];
        }
        let turn = std::f64::consts::TAU / k as f64;
        let tangents = ring(k).map(|edges| {
            let across: Vec<f64> = (0..k)
                .map(|i| (edges[i] + edges[(i + 1) % k]) / divisor(turn))
                .collect();
            weighted(&edges, &across)
        });
        return unit(crossed(&tangents));
    }
    let (first, last) = (sector.edges[0], sector.edges[k]);
    let (edges, across) = crease(k, are_quads);
    let along = tangent(&[(first, 1.0), (last, -1.0)], own, points);
    let beside = crossed(&[along, weighted(&edges, &across)]);
    if !is_corner {
        return unit(beside);
    }
    let ends = [first, last].map(|end| tangent(&[(end, 1.0)], own, points));
    let plane = crossed(&ends);
    let side: i128 = (0..3).map(|axis| plane[axis] * beside[axis]).sum();
    match plane {
        [0, 0, 0] => unit(beside),
        _ if side < 0 => unit(plane.map(|coordinate| -coordinate)),
        _ => unit(plane),
    }
}

/// Cosines round a ring, from its start and from a quarter on.
fn ring(count: usize) -> [Vec<f64>; 2] {
    [0, (count + 2) / 4].map(|shift| {
        let turn = |i: usize| std::f64::consts::TAU * (i as f64 - shift as f64) / count as f64;
        (0..count).map(|i| turn(i).cos()).collect()
    })
}

/// `16 lambda - 4`, with the greatest root `lambda` of
/// `(lambda - 3/8 - cos/8) (16 lambda - 4) = (1 + cos) / 2`.
fn divisor(turn: f64) -> f64 {
    // With D = 16 lambda - 4: D^2 - 2 (1 + cos) D = 8 (1 + cos).
    let half = 1.0 + turn.cos();
    half + (half * half + 8.0 * half).sqrt()
}

/// Weights across a crease: of the `k + 1` edges and of the `k` vertices across.
fn crease(k: usize, are_quads: bool) -> (Vec<f64>, Vec<f64>) {
    let turn = std::f64::consts::PI / k as f64;
    let mut edges: Vec<f64> = (0..=k)
        .map(|i| (turn * i as f64).sin() / turn.sin())
        .collect();
    (edges[0], edges[k]) = (0.0, 0.0);
    if k == 1 {
        return (vec![1.0; 2], vec![0.0]);
    }
    let (value, across) = if are_quads {
        let d = divisor(turn);
        let across = (0..k).map(|i| (edges[i] + edges[i + 1]) / d).collect();
        ((d + 4.0) / 16.0, across)
    } else {
        (0.375 + turn.cos() / 4.0, vec![0.0; k])
    };
    // How far an end and the vertex itself enter the new points beside them.
    let (beside, face_of_end, ring_of_own, face_of_own) = if are_quads {
        (1.0 / 16.0, 0.25, 0.375, 0.25)
    } else {
        (1.0 / 8.0, 0.0, 0.375, 0.0)
    };
    let inside: f64 = edges.iter().sum();
    let faces: f64 = across.iter().sum();
    // value * end = end / 2 + own / 8 + what the points beside the end take of it;
    // value * own = 3/4 own + 2 end / 2 + what all others take of the vertex.
    let (p, q) = (
        beside * edges[1] + face_of_end * across[0],
        ring_of_own * inside + face_of_own * faces,
    );
    let [[a, b], [c, d]] = [[value - 0.5, -0.125], [-1.0, value - 0.75]];
    let end = (p * d - b * q) / (a * d - b * c);
    (edges[0], edges[k]) = (end, end);
    (edges, across)
}

fn tangent(terms: &[(u32, f64)], own: u32, points: &[[i32; 3]]) -> Vector {
    let mut sum = [0; 3];
    for (vertex, weight) in terms {
        let weight = Grid::Device.weight(*weight) as i128;
        for (axis, total) in sum.iter_mut().enumerate() {
            let way =
                i128::from(points[*vertex as usize][axis]) - i128::from(points[own as usize][axis]);
            *total += weight * way;
        }
    }
    sum
}

/// The cross product of two tangents of at most 30 bits.
fn crossed([one, other]: &[Vector; 2]) -> Vector {
    let (a, b) = (short(one), short(other));
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

fn short(sum: &Vector) -> Vector {
    let greatest = sum.iter().map(|c| c.unsigned_abs()).max().unwrap_or(0);
    let mut unit = 1_i128;
    while greatest >= 1 << 30 && greatest / unit.unsigned_abs() >= 1 << 30 {
        unit *= 2;
    }
    sum.map(|coordinate| (2 * coordinate + unit).div_euclid(2 * unit))
}
