//! Linear split, averaging and collapse (section 5.3), and what overrides them.

use std::collections::{BTreeMap, BTreeSet};

use super::split::{Child, Names, children, cycle_edges, small_quads, small_triangles, split};
use super::unzip::{Clones, GUARD, clones, surface_clones};
use super::{Boundary, Class, Mesh, Wide};

/// What a unit of a small cell's averaged position is less than a guarded unit: 24 for the linear
/// split, 48 for the matrix.
const FINE: f64 = 24.0 * 48.0;

/// A weighted mean while it grows: the sum, and the sum of weights.
#[derive(Clone, Copy)]
struct Mean<const D: usize> {
    sum: [Wide; D],
    weight: f64,
}

impl<const D: usize> Mean<D> {
    const EMPTY: Self = Self {
        sum: [Wide { limbs: [0.0; 3] }; D],
        weight: 0.0,
    };

    fn add(&mut self, weight: f64, position: &[Wide; D]) {
        for (sum, coordinate) in self.sum.iter_mut().zip(position) {
            sum.add(weight, coordinate);
        }
        self.weight += weight;
    }

    /// Rounded once; the sum is in units of `1 / (unit * weight)` of the last place.
    fn round(&self, unit: f64, saturated: &mut usize) -> [i32; D] {
        self.sum.map(|sum| {
            let value = sum.round_quotient(unit * self.weight);
            let clamped = value.clamp(f64::from(i32::MIN), f64::from(i32::MAX));
            *saturated += usize::from(clamped != value);
            clamped as i32
        })
    }
}

/// A characteristic matrix in 48ths.
fn characteristic(class: Class, corners: usize, row: usize, column: usize) -> f64 {
    match (class, corners) {
        (Class::Toc, 4) => [17.0, -3.0][usize::from(row == column)],
        (Class::Toc, _) if row == column => 18.0,
        (Class::Toc, _) if row.abs_diff(column) == 3 => 14.0,
        (Class::Toc, _) => 4.0,
        (Class::Pris, _) => [9.0, 6.0][usize::from(row % 3 == column % 3)],
        (Class::Cube, _) => 6.0,
    }
}

/// The collapse's weights over 168: 1/14, 1/12, 1/8.
fn collapse_weight(class: Class) -> f64 {
    match class {
        Class::Toc => 12.0,
        Class::Pris => 14.0,
        Class::Cube => 21.0,
    }
}

/// The positions of a small cell's corners in units of 1/24.
fn linear<const D: usize>(child: &Child, corners: &[[f64; D]]) -> Vec<[Wide; D]> {
    let position = |places: &Vec<usize>| {
        let mut position = [Wide::default(); D];
        for place in places {
            for (total, coordinate) in position.iter_mut().zip(corners[*place]) {
                total.add(24.0 / places.len() as f64, &Wide::from_integer(coordinate));
            }
        }
        position
    };
    child.iter().map(position).collect()
}

/// The interior rule at every refined vertex that a cell has.
fn interior<const D: usize>(mesh: &Mesh, names: &Names, clones: &[Clones<D>; 3]) -> Vec<Mean<D>> {
    let mut means = vec![Mean::EMPTY; names.count as usize];
    for (place, cell) in mesh.cells().iter().enumerate() {
        let of_class = &clones[cell.class as usize];
        let corners: Vec<[f64; D]> = cell.corners.iter().map(|v| of_class[*v as usize]).collect();
        for child in children(cell) {
            let positions = linear(&child, &corners);
            for (row, places) in child.iter().enumerate() {
                let parents: Vec<u32> = places.iter().map(|at| cell.corners[*at]).collect();
                let mut averaged = [Wide::default(); D];
                for (column, position) in positions.iter().enumerate() {
                    let weight = characteristic(cell.class, child.len(), row, column);
                    for (total, coordinate) in averaged.iter_mut().zip(position) {
                        total.add(weight, coordinate);
                    }
                }
                let vertex = names.vertex(&parents, place) as usize;
                means[vertex].add(collapse_weight(cell.class), &averaged);
            }
        }
    }
    means
}

/// The surface's scheme at every refined vertex that a surface face has.
fn surface<const D: usize>(
    mesh: &Mesh,
    names: &Names,
    clones: &[Clones<D>; 2],
) -> BTreeMap<u32, Mean<D>> {
    let mut means = BTreeMap::new();
    let mut face = |cycle: &[u32], small: Vec<Child>, clones: &Clones<D>, collapse: f64| {
        let corners: Vec<[f64; D]> = cycle
            .iter()
            .map(|vertex| clones[*vertex as usize])
            .collect();
        for child in small {
            let positions = linear(&child, &corners);
            for (row, places) in child.iter().enumerate() {
                let parents: Vec<u32> = places.iter().map(|at| cycle[*at]).collect();
                let mut averaged = [Wide::default(); D];
                for (column, position) in positions.iter().enumerate() {
                    // In 48ths: 1/4 and 3/8, or 1/4.
                    let is_side = child.len() == 3 && row != column;
                    let weight = if is_side { 18.0 } else { 12.0 };
                    for (total, coordinate) in averaged.iter_mut().zip(position) {
                        total.add(weight, coordinate);
                    }
                }
                let mean = means
                    .entry(names.vertex(&parents, 0))
                    .or_insert(Mean::EMPTY);
                mean.add(collapse, &averaged);
            }
        }
    };
    // 1/6 and 1/4, over 12.
    for triangle in &mesh.triangles {
        let small = small_triangles().map(|small| small.to_vec()).to_vec();
        face(triangle, small, &clones[0], 2.0);
    }
    for quad in &mesh.quads {
        let small = small_quads().map(|small| small.to_vec()).to_vec();
        face(quad, small, &clones[1], 3.0);
    }
    let on_quads: BTreeSet<u32> = mesh.quads.iter().flatten().copied().collect();
    let mut neighbours: BTreeMap<u32, BTreeSet<u32>> = BTreeMap::new();
    for edge in mesh.triangles.iter().flat_map(|face| cycle_edges(face)) {
        neighbours.entry(edge[0]).or_default().insert(edge[1]);
        neighbours.entry(edge[1]).or_default().insert(edge[0]);
    }
    for (vertex, others) in neighbours {
        if on_quads.contains(&vertex) {
            continue;
        }
        // A vertex of triangles only: 5/8 of itself and 3/8 of the mean of its neighbours.
        let mut mean = Mean::EMPTY;
        let wide = |vertex: u32| clones[0][vertex as usize].map(Wide::from_integer);
        mean.add(5.0 * others.len() as f64, &wide(vertex));
        for other in others {
            mean.add(3.0, &wide(other));
        }
        // In the units of the others.
        let mut fine = Mean::EMPTY;
        fine.add(FINE, &mean.sum);
        fine.weight = mean.weight;
        means.insert(vertex, fine);
    }
    means
}

/// The mean of some vertices, in guarded units.
fn plain<const D: usize>(points: &[[i32; D]], entries: &[(f64, u32)]) -> Mean<D> {
    let mut mean = Mean::EMPTY;
    for (weight, vertex) in entries {
        let point = points[*vertex as usize];
        mean.add(
            *weight,
            &point.map(|x| Wide::from_integer(f64::from(x) * GUARD)),
        );
    }
    mean
}

/// One level: the refined mesh, its points, how many coordinates saturated.
pub fn refine<const D: usize>(
    mesh: &Mesh,
    boundary: Boundary,
    points: &[[i32; D]],
) -> (Mesh, Vec<[i32; D]>, usize) {
    let names = Names::new(mesh);
    let next = split(mesh, &names);
    let mut saturated = 0;
    let mut out: BTreeMap<u32, (f64, Mean<D>)> = BTreeMap::new();
    linear_split(mesh, &names, points, &mut out);
    let inside = interior(mesh, &names, &clones(mesh, points));
    for (vertex, mean) in (0..).zip(inside) {
        if mean.weight > 0.0 {
            out.insert(vertex, (GUARD * FINE, mean));
        }
    }
    if boundary != Boundary::Interior {
        let on_it = surface(mesh, &names, &surface_clones(mesh, points));
        let mut flat = BTreeMap::new();
        linear_split(mesh, &names, points, &mut flat);
        for (vertex, mean) in on_it {
            let value = match boundary {
                Boundary::Fixed => flat[&vertex],
                _ => (GUARD * FINE, mean),
            };
            out.insert(vertex, value);
        }
    }
    features(mesh, &names, boundary, points, &mut out);
    let refined = (0..names.count)
        .map(|vertex| {
            let (unit, mean) = &out[&vertex];
            mean.round(*unit, &mut saturated)
        })
        .collect();
    (next, refined, saturated)
}

/// Where the linear split puts vertices, edges and quadrilaterals. An edge along which a
/// quadrilateral is covered comes after the quadrilaterals.
fn linear_split<const D: usize>(
    mesh: &Mesh,
    names: &Names,
    points: &[[i32; D]],
    out: &mut BTreeMap<u32, (f64, Mean<D>)>,
) {
    for vertex in 0..mesh.vertex_count {
        out.insert(vertex, (GUARD, plain(points, &[(2.0, vertex)])));
    }
    let mut lines: BTreeSet<Vec<u32>> = BTreeSet::new();
    lines.extend(mesh.triangles.iter().flat_map(|face| cycle_edges(face)));
    for quad in &mesh.quads {
        lines.extend(cycle_edges(quad));
        let entries = quad.map(|vertex| (1.0, vertex));
        let middle = names.vertex(quad, 0);
        out.insert(middle, (GUARD, plain(points, &entries)));
    }
    lines.extend(names.covered_diagonals());
    for edge in lines {
        let entries = [(1.0, edge[0]), (1.0, edge[1])];
        let middle = names.vertex(&edge, 0);
        out.insert(middle, (GUARD, plain(points, &entries)));
    }
}

/// Creases and corners.
fn features<const D: usize>(
    mesh: &Mesh,
    names: &Names,
    boundary: Boundary,
    points: &[[i32; D]],
    out: &mut BTreeMap<u32, (f64, Mean<D>)>,
) {
    let stay = |vertex: u32| (GUARD, plain(points, &[(2.0, vertex)]));
    let surface: BTreeSet<u32> = mesh
        .triangles
        .iter()
        .flatten()
        .chain(mesh.quads.iter().flatten())
        .copied()
        .collect();
    let mut ends: BTreeMap<u32, BTreeSet<u32>> = BTreeMap::new();
    for &[a, b] in &mesh.creases {
        let middle = names.vertex(&[a, b], 0);
        out.insert(middle, (GUARD, plain(points, &[(1.0, a), (1.0, b)])));
        ends.entry(a).or_default().insert(b);
        ends.entry(b).or_default().insert(a);
    }
    for (vertex, others) in ends {
        let is_fixed = boundary == Boundary::Fixed && surface.contains(&vertex);
        let others: Vec<u32> = others.into_iter().collect();
        match others.as_slice() {
            [_, _, _, ..] => {
                out.insert(vertex, stay(vertex));
            }
            [a, b] if !is_fixed => {
                let entries = [(6.0, vertex), (1.0, *a), (1.0, *b)];
                out.insert(vertex, (GUARD, plain(points, &entries)));
            }
            _ => {}
        }
    }
    for &corner in &mesh.corners {
        out.insert(corner, stay(corner));
    }
}
