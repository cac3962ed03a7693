//! The butterfly rules, edge by edge.

use super::Refined;
use super::loop_rule::quadrisected;
use super::polygons::{Border, Kind, Polygons, edge};
use super::row::{Grid, Row, WEIGHT_UNIT};

/// One level. `modified` takes the stencils of 1996 at vertices of valence other than 6.
pub fn butterfly(mesh: &Polygons, modified: bool, border: Border, grid: Grid) -> Refined {
    let surface = Surface {
        mesh,
        kinds: mesh.kinds(border),
        sharp: mesh.sharp_edges(),
        neighbours: mesh.neighbours(),
    };
    let mut rows: Vec<Row> = (0..mesh.vertex_count).map(Row::vertex).collect();
    for ([a, b], on) in mesh.edges() {
        rows.push(if !surface.sharp.contains(&[a, b]) {
            surface.smooth(a, b, modified, grid)
        } else if border == Border::Fixed && on.len() != 2 {
            Row::mean(&[a, b])
        } else {
            let terms = [
                (9.0, Row::vertex(a)),
                (9.0, Row::vertex(b)),
                (-1.0, surface.continuation(b, a)),
                (-1.0, surface.continuation(a, b)),
            ];
            Row::sum(&terms, 16.0)
        });
    }
    let creases = mesh.halved_creases(&mesh.middles());
    Refined::new(mesh, rows, quadrisected(mesh), creases)
}

struct Surface<'a> {
    mesh: &'a Polygons,
    kinds: Vec<Kind>,
    sharp: std::collections::BTreeSet<[u32; 2]>,
    neighbours: Vec<Vec<u32>>,
}

impl Surface<'_> {
    /// Where the sharp line from `from` to `to` goes on.
    fn continuation(&self, from: u32, to: u32) -> Row {
        match self.kinds[to as usize] {
            Kind::Crease(a, b) => Row::vertex(if a == from { b } else { a }),
            _ => Row::sum(&[(2.0, Row::vertex(to)), (-1.0, Row::vertex(from))], 1.0),
        }
    }

    /// The third corners of the triangles on an edge.
    fn apexes(&self, a: u32, b: u32) -> Vec<u32> {
        let on = self
            .mesh
            .faces
            .iter()
            .filter(|f| f.contains(&a) && f.contains(&b));
        on.flatten()
            .copied()
            .filter(|v| *v != a && *v != b)
            .collect()
    }

    /// Across the edge from `a` to `b` of a triangle with the third corner `inner`.
    fn across(&self, a: u32, b: u32, inner: u32) -> Row {
        if self.sharp.contains(&edge(a, b)) {
            let terms = [
                (1.0, Row::vertex(a)),
                (1.0, Row::vertex(b)),
                (-1.0, Row::vertex(inner)),
            ];
            return Row::sum(&terms, 1.0);
        }
        let mut beyond = self.apexes(a, b);
        // Two triangles back to back have the same three corners.
        if let Some(place) = beyond.iter().position(|apex| *apex == inner) {
            beyond.remove(place);
        }
        Row::vertex(beyond[0])
    }

    fn smooth(&self, a: u32, b: u32, modified: bool, grid: Grid) -> Row {
        let is_irregular = |vertex: u32| {
            let ring = &self.neighbours[vertex as usize];
            let on_line = ring
                .iter()
                .any(|end| self.sharp.contains(&edge(vertex, *end)));
            modified && !on_line && ring.len() != 6
        };
        match (is_irregular(a), is_irregular(b)) {
            (false, false) => self.regular(a, b),
            (true, false) => self.stencil(a, b, grid, false),
            (false, true) => self.stencil(b, a, grid, false),
            (true, true) => {
                let valence = |vertex: u32| self.neighbours[vertex as usize].len();
                let rounded = valence(a) > 4 || valence(b) > 4;
                Row::mean_of(&[
                    self.stencil(a, b, grid, rounded),
                    self.stencil(b, a, grid, rounded),
                ])
            }
        }
    }

    fn regular(&self, a: u32, b: u32) -> Row {
        let mut terms = vec![(8.0, Row::vertex(a)), (8.0, Row::vertex(b))];
        for c in self.apexes(a, b) {
            terms.push((2.0, Row::vertex(c)));
            terms.push((-1.0, self.across(a, c, b)));
            terms.push((-1.0, self.across(b, c, a)));
        }
        Row::sum(&terms, 16.0)
    }

    /// The vertex's ring from `end` on.
    fn ring(&self, vertex: u32, end: u32) -> Vec<u32> {
        let mut ring = vec![end, self.apexes(vertex, end)[0]];
        while ring.len() < self.neighbours[vertex as usize].len() {
            let [.., before, last] = ring.as_slice() else {
                break;
            };
            let next = self.apexes(vertex, *last).into_iter().find(|v| v != before);
            ring.push(next.unwrap_or(*before));
        }
        ring
    }

    fn stencil(&self, vertex: u32, end: u32, grid: Grid, rounded: bool) -> Row {
        let ring = self.ring(vertex, end);
        let k = ring.len();
        let weights: Vec<f64> = (0..k).map(|j| real_weight(j, k)).collect();
        let mut terms = Vec::new();
        let unit = if k > 4 || rounded { WEIGHT_UNIT } else { 24.0 };
        let mut own = unit;
        for (weight, neighbour) in weights.into_iter().zip(ring) {
            let weight = if k > 4 || rounded {
                grid.weight(weight)
            } else {
                (weight * unit).round()
            };
            own -= weight;
            terms.push((weight, Row::vertex(neighbour)));
        }
        terms.push((own, Row::vertex(vertex)));
        Row::sum(&terms, unit)
    }
}

/// `s_j` of a vertex of valence `k`.
fn real_weight(j: usize, k: usize) -> f64 {
    match k {
        3 => [5.0 / 12.0, -1.0 / 12.0, -1.0 / 12.0][j],
        4 => [3.0 / 8.0, 0.0, -1.0 / 8.0, 0.0][j],
        _ => {
            // Mirror images alike.
            let turn = std::f64::consts::TAU * j.min(k - j) as f64 / k as f64;
            (0.25 + turn.cos() + 0.5 * (2.0 * turn).cos()) / k as f64
        }
    }
}
