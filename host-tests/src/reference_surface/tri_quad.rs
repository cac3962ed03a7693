//! Schaefer and Warren's scheme of triangles and quads, literally: unzip, split, average, collapse.
//!
//! The only values between are the clones, integers in units of 2^-8 of the last place; the masks
//! over them are [`Row`]s, and what comes of both is computed in 128-bit integers.

use std::collections::BTreeMap;

use super::crease_row;
use super::polygons::{Border, Kind, Polygons, edge, sides};
use super::row::Row;

/// A clone's units in one of the last place.
const GUARD: i128 = 256;

/// Places of a vertex's two clones among all clones.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Side {
    Triangle = 0,
    Quad = 1,
}

/// The clone that a face's corner is split from, among all clones.
fn clone_of(vertex: u32, face: &[u32]) -> Row {
    let side = if face.len() == 3 {
        Side::Triangle
    } else {
        Side::Quad
    };
    Row::vertex(2 * vertex + side as u32)
}

/// A mask of one refined vertex.
#[derive(Clone, Debug, PartialEq)]
enum Mask {
    /// Over the vertices.
    Vertices(Row),
    /// Over the clones: twice the vertex for its triangles, one more for its quads.
    Clones(Row),
}

/// A refined mesh and the masks of its vertices.
#[derive(Clone, Debug, PartialEq)]
pub struct TriQuad {
    /// Connectivity.
    pub mesh: Polygons,
    /// The other ends of the edges between triangles and quads, by vertex.
    across: Vec<Vec<u32>>,
    masks: Vec<Mask>,
}

/// One level of triangles and quads.
pub fn tri_quad(mesh: &Polygons, border: Border) -> TriQuad {
    let middles = mesh.middles();
    let first = mesh.vertex_count + middles.len() as u32;
    let quads = mesh.sorted_faces().into_iter();
    let quads = quads.filter(|face| mesh.faces[*face].len() == 4);
    let centres: BTreeMap<usize, u32> = quads.zip(first..).collect();
    let vertex_count = first + centres.len() as u32;

    // What new faces say of every vertex, with 12 times the weights 1/6 and 1/4 of the collapse.
    let mut said: Vec<Vec<(f64, Row)>> = vec![Vec::new(); vertex_count as usize];
    let mut faces = Vec::new();
    for (index, face) in mesh.faces.iter().enumerate() {
        let (children, positions) = split(face, &middles, centres.get(&index).copied());
        let weight = if face.len() == 3 { 2.0 } else { 3.0 };
        for child in children {
            for vertex in &child {
                said[*vertex as usize].push((weight, averaged(*vertex, &child, &positions)));
            }
            faces.push(child);
        }
    }
    let collapsed = |vertex: u32| {
        let terms = &said[vertex as usize];
        let weight: f64 = terms.iter().map(|(weight, _)| weight).sum();
        Mask::Clones(Row::sum(terms, weight))
    };
    let mut masks = Vec::new();
    for (kind, vertex) in mesh.kinds(border).iter().zip(0..) {
        masks.push(match kind {
            Kind::Smooth => collapsed(vertex),
            other => Mask::Vertices(crease_row(vertex, other)),
        });
    }
    let sharp = mesh.sharp_edges();
    for (ends, middle) in &middles {
        masks.push(if sharp.contains(ends) {
            Mask::Vertices(Row::mean(ends))
        } else {
            collapsed(*middle)
        });
    }
    masks.extend((first..vertex_count).map(collapsed));
    TriQuad {
        mesh: Polygons {
            vertex_count,
            faces,
            creases: mesh.halved_creases(&middles),
            corners: mesh.corners.clone(),
            odd: mesh.odd,
        },
        across: across(mesh, border),
        masks,
    }
}

/// A face's four new faces, and where the linear split puts their vertices.
fn split(
    face: &[u32],
    middles: &BTreeMap<[u32; 2], u32>,
    centre: Option<u32>,
) -> (Vec<Vec<u32>>, BTreeMap<u32, Row>) {
    let mut positions = BTreeMap::new();
    for corner in face {
        positions.insert(*corner, clone_of(*corner, face));
    }
    let corners = positions.clone();
    let mut middle_of = Vec::new();
    for (a, b) in sides(face) {
        let middle = middles[&edge(a, b)];
        let ends = [corners[&a].clone(), corners[&b].clone()];
        positions.insert(middle, Row::mean_of(&ends));
        middle_of.push(middle);
    }
    let all: Vec<Row> = corners.into_values().collect();
    let n = face.len();
    let children = match centre {
        None => vec![
            vec![face[0], middle_of[0], middle_of[2]],
            vec![middle_of[0], face[1], middle_of[1]],
            vec![middle_of[2], middle_of[1], face[2]],
            middle_of,
        ],
        Some(centre) => {
            positions.insert(centre, Row::mean_of(&all));
            (0..n)
                .map(|i| vec![face[i], middle_of[i], centre, middle_of[(i + n - 1) % n]])
                .collect()
        }
    };
    (children, positions)
}

/// What a new face says of one of its vertices: `1/4 3/8 3/8` of a triangle, the mean of a quad.
fn averaged(vertex: u32, child: &[u32], positions: &BTreeMap<u32, Row>) -> Row {
    let terms: Vec<(f64, Row)> = child
        .iter()
        .map(|other| {
            let weight = match child.len() {
                3 if *other == vertex => 2.0,
                3 => 3.0,
                _ => 2.0,
            };
            (weight, positions[other].clone())
        })
        .collect();
    Row::sum(&terms, 8.0)
}

/// By vertex, the other ends of the edges on which a triangle and a quad lie; none at vertices that
/// follow a crease, the rim or a corner.
fn across(mesh: &Polygons, border: Border) -> Vec<Vec<u32>> {
    let mut across = vec![Vec::new(); mesh.vertex_count as usize];
    let kinds = mesh.kinds(border);
    for ([a, b], on) in mesh.edges() {
        let has = |count: usize| on.iter().any(|face| mesh.faces[*face].len() == count);
        if has(3) && has(4) {
            for (own, other) in [(a, b), (b, a)] {
                if matches!(kinds[own as usize], Kind::Smooth) {
                    across[own as usize].push(other);
                }
            }
        }
    }
    across
}

/// `floor(numerator / denominator + 1/2)`.
fn round(numerator: i128, denominator: i128) -> i128 {
    (2 * numerator + denominator).div_euclid(2 * denominator)
}

impl TriQuad {
    /// The refined positions.
    pub fn points(&self, points: &[[i32; 3]]) -> Vec<[i32; 3]> {
        let clamp = |value: i128| value.clamp(i32::MIN.into(), i32::MAX.into()) as i32;
        let rounded = self.rounded(points).into_iter();
        rounded.map(|point| point.map(clamp)).collect()
    }

    /// How many coordinates do not fit 32 bits.
    pub fn count_saturated(&self, points: &[[i32; 3]]) -> usize {
        let rounded = self.rounded(points);
        let values = rounded.as_flattened().iter();
        values
            .filter(|value| i32::try_from(**value).is_err())
            .count()
    }

    fn rounded(&self, points: &[[i32; 3]]) -> Vec<[i128; 3]> {
        let axes = [0, 1, 2].map(|axis| {
            let value = |vertex: u32| i128::from(points[vertex as usize][axis]);
            let clones: Vec<i128> = (0..2 * self.across.len() as u32)
                .map(|clone| self.clone_value(clone, &value))
                .collect();
            let masks = self.masks.iter();
            let values = masks.map(|mask| match mask {
                Mask::Vertices(row) => apply(row, 1, value),
                Mask::Clones(row) => apply(row, GUARD, |clone| clones[clone as usize]),
            });
            values.collect::<Vec<i128>>()
        });
        let [x, y, z] = axes;
        let xy = x.into_iter().zip(y);
        xy.zip(z).map(|((x, y), z)| [x, y, z]).collect()
    }

    /// A clone in units of 2^-8: the vertex, moved toward the mean of its neighbours across or away
    /// from it.
    fn clone_value(&self, clone: u32, value: &impl Fn(u32) -> i128) -> i128 {
        let (vertex, side) = (clone / 2, clone % 2);
        let across = &self.across[vertex as usize];
        let own = value(vertex);
        if across.is_empty() {
            return own * GUARD;
        }
        let toward: i128 = across.iter().map(|other| value(*other) - own).sum();
        let sign = if side == Side::Triangle as u32 { 1 } else { -1 };
        own * GUARD + round(sign * GUARD * toward, 24 * across.len() as i128)
    }
}

/// A mask on integers in units of `1 / units`, rounded once.
fn apply(row: &Row, units: i128, value: impl Fn(u32) -> i128) -> i128 {
    let entries = row.entries.iter();
    let sum: i128 = entries
        .map(|(vertex, numerator)| *numerator as i128 * value(*vertex))
        .sum();
    round(sum, row.denominator as i128 * units)
}
