//! Clones (section 5.2), and those of the surface (example 5.2).

use std::collections::{BTreeMap, BTreeSet};

use super::faces::{Face, faces};
use super::split::cycle_edges;
use super::{Class, Mesh, Wide};

/// Guarded units in one unit of the last place.
pub const GUARD: f64 = 256.0;

/// What distorts a vertex: by the classes of the two faces and how many corners each has, the sum
/// of all pairs in 144ths and their number.
type Kind = (Class, usize, Class, usize);

/// Positions of one class of clones, by vertex, in guarded units.
pub type Clones<const D: usize> = Vec<[f64; D]>;

struct Pairs<'a, const D: usize> {
    points: &'a [[i32; D]],
    found: BTreeMap<(Kind, u32), ([f64; D], f64)>,
}

impl<const D: usize> Pairs<'_, D> {
    /// One pair at the vertex that comes first, with weights in 144ths.
    fn add(&mut self, kind: Kind, entries: &[(f64, u32)]) {
        let zero = ([0.0; D], 0.0);
        let (sum, count) = self.found.entry((kind, entries[0].1)).or_insert(zero);
        *count += 1.0;
        for (weight, vertex) in entries {
            for (total, coordinate) in sum.iter_mut().zip(self.points[*vertex as usize]) {
                *total += weight * f64::from(coordinate);
            }
        }
    }

    /// A triangle of a class against a face of another.
    fn pair(&mut self, triangle: &Face, face: &Face) {
        let kind = (
            triangle.class,
            triangle.cycle.len(),
            face.class,
            face.cycle.len(),
        );
        let corners = &triangle.cycle;
        for place in 0..3 {
            let [own, one, two] = [0, 1, 2].map(|step| corners[(place + step) % 3]);
            if face.cycle.len() == 3 {
                // -1/36, 1/72, 1/72.
                self.add(kind, &[(-4.0, own), (2.0, one), (2.0, two)]);
                continue;
            }
            let apex = face.opposite(face.free_corner(corners)).expect("a corner");
            let is_along = |a: u32, b: u32| {
                face.triangle_edges
                    .iter()
                    .any(|edge| edge.contains(&a) && edge.contains(&b))
            };
            // The other end of the diagonal, if the vertex is on it.
            let far = if one == apex { two } else { one };
            let entries = match (triangle.class, face.class, own == apex) {
                (Class::Toc, Class::Pris, true) => {
                    // -31/144, 11/144 along an edge of the prism's triangle, 5/36 across.
                    let weight = |other| if is_along(own, other) { 11.0 } else { 20.0 };
                    [(-31.0, own), (weight(one), one), (weight(two), two)]
                }
                (Class::Toc, Class::Pris, false) if is_along(own, apex) => {
                    // 5/144, -1/9 to the far end, 11/144 to the corner off the diagonal.
                    [(5.0, own), (-16.0, far), (11.0, apex)]
                }
                // -1/36, -1/9, 5/36.
                (Class::Toc, _, false) => [(-4.0, own), (-16.0, far), (20.0, apex)],
                // -5/18, 5/36, 5/36.
                (Class::Toc, _, true) => [(-40.0, own), (20.0, one), (20.0, two)],
                // 0, -1/8, 1/8.
                (_, _, false) => [(0.0, own), (-18.0, far), (18.0, apex)],
                // -1/4, 1/8, 1/8.
                (_, _, true) => [(-36.0, own), (18.0, one), (18.0, two)],
            };
            self.add(kind, &entries);
        }
    }

    /// A prism's quadrilateral against a hexahedron's: -1/24, 1/24 along edges of triangles.
    fn quad_pair(&mut self, prism: &Face) {
        for &[a, b] in &prism.triangle_edges {
            for (own, other) in [(a, b), (b, a)] {
                let kind = (Class::Pris, 4, Class::Cube, 4);
                self.add(kind, &[(-6.0, own), (6.0, other)]);
            }
        }
    }

    /// The clone of a vertex: (5.2.2), with the term of the prism's that is missing in print. Every
    /// kind moves its first class one way and its second the other.
    fn clone_of(&self, class: Class, vertex: u32) -> [f64; D] {
        let own = self.points[vertex as usize];
        let terms: Vec<(f64, [f64; D], f64)> = self
            .found
            .iter()
            .filter(|((_, at), _)| *at == vertex)
            .filter_map(|(((first, _, second, _), _), (sum, count))| {
                let sign = match class {
                    class if class == *first => 1.0,
                    class if class == *second => -1.0,
                    _ => return None,
                };
                Some((sign, *sum, *count))
            })
            .collect();
        let common: f64 = terms.iter().map(|(_, _, count)| count).product();
        std::array::from_fn(|axis| {
            let mut numerator = Wide::default();
            for (sign, sum, count) in &terms {
                let factor = sign * GUARD * (common / count);
                numerator.add(factor, &Wide::from_integer(sum[axis]));
            }
            f64::from(own[axis]) * GUARD + numerator.round_quotient(144.0 * common)
        })
    }
}

/// The clones for each class.
pub fn clones<const D: usize>(mesh: &Mesh, points: &[[i32; D]]) -> [Clones<D>; 3] {
    let mut pairs = Pairs {
        points,
        found: BTreeMap::new(),
    };
    let all: Vec<Face> = mesh.cells().iter().flat_map(faces).collect();
    let mut by_vertex: BTreeMap<u32, Vec<&Face>> = BTreeMap::new();
    for face in &all {
        for corner in &face.cycle {
            by_vertex.entry(*corner).or_default().push(face);
        }
    }
    for first in &all {
        // Every face that shares three corners shares the first or the second.
        let near = &first.cycle[..2];
        let mut seen = BTreeSet::new();
        for second in near.iter().flat_map(|corner| &by_vertex[corner]) {
            if first.class >= second.class || !seen.insert(std::ptr::from_ref(*second)) {
                continue;
            }
            let shared = first
                .cycle
                .iter()
                .filter(|corner| second.cycle.contains(corner));
            match (first.cycle.len(), second.cycle.len(), shared.count()) {
                (3, _, 3) => pairs.pair(first, second),
                (4, 4, 4) => pairs.quad_pair(first),
                _ => {}
            }
        }
    }
    [Class::Toc, Class::Pris, Class::Cube].map(|class| {
        (0..mesh.vertex_count)
            .map(|vertex| pairs.clone_of(class, vertex))
            .collect()
    })
}

/// The surface's clones for triangles and for quadrilaterals: (5.3.3).
pub fn surface_clones<const D: usize>(mesh: &Mesh, points: &[[i32; D]]) -> [Clones<D>; 2] {
    let of_triangles: BTreeSet<Vec<u32>> = mesh
        .triangles
        .iter()
        .flat_map(|face| cycle_edges(face))
        .collect();
    let of_quads: BTreeSet<Vec<u32>> = mesh
        .quads
        .iter()
        .flat_map(|face| cycle_edges(face))
        .collect();
    let mut along: BTreeMap<u32, BTreeSet<u32>> = BTreeMap::new();
    for &[a, b] in &mesh.creases {
        along.entry(a).or_default().insert(b);
        along.entry(b).or_default().insert(a);
    }
    let is_sharp = |vertex: u32| {
        mesh.corners.contains(&vertex) || along.get(&vertex).is_some_and(|ends| ends.len() > 1)
    };
    let mut ends: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
    for edge in of_triangles.intersection(&of_quads) {
        for (own, other) in [(edge[0], edge[1]), (edge[1], edge[0])] {
            if !is_sharp(own) {
                ends.entry(own).or_default().push(other);
            }
        }
    }
    [1.0, -1.0].map(|sign| {
        (0..mesh.vertex_count)
            .map(|vertex| {
                let own = points[vertex as usize].map(f64::from);
                let Some(others) = ends.get(&vertex) else {
                    return own.map(|coordinate| coordinate * GUARD);
                };
                let count = others.len() as f64;
                std::array::from_fn(|axis| {
                    let mut sum = -count * own[axis];
                    for other in others {
                        sum += f64::from(points[*other as usize][axis]);
                    }
                    let mut numerator = Wide::default();
                    numerator.add(sign * GUARD, &Wide::from_integer(sum));
                    own[axis] * GUARD + numerator.round_quotient(24.0 * count)
                })
            })
            .collect()
    })
}
