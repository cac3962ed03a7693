//! One level: (3.3) to (3.8), appendix A, and the boundary.

use super::neighbours::{Ring, Rings, rings};
use super::solid::{Cells, NEIGHBOURS_MAXIMUM, Scheme, split};
use super::surface::{EdgeRule, Surface, VertexRule};
use crate::reference::exact::{LimbSum, round_quotient, saturate};
use crate::reference::{Boundary, LoopWeight, WEIGHT_UNIT};

/// A solid one level on.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Refined<const D: usize> {
    /// The refined connectivity with inherited diagonals.
    pub cells: Cells,
    /// Raw bits, one entry for each vertex.
    pub points: Vec<[i32; D]>,
    /// How many coordinates were clamped.
    pub saturated: usize,
}

/// One coordinate of all vertices, and what was clamped.
struct Channel<'a> {
    values: Vec<f64>,
    rings: &'a Rings,
    scheme: Scheme,
    boundary: Boundary,
    saturated: usize,
}

/// Refines once.
///
/// # Panics
/// If the solid is not sound or has more than [`NEIGHBOURS_MAXIMUM`] neighbours somewhere.
pub fn refine<const D: usize>(
    cells: &Cells,
    points: &[[i32; D]],
    scheme: Scheme,
    boundary: Boundary,
) -> Refined<D> {
    let divided = split(cells);
    let rings = rings(cells, scheme);
    let surface = Surface::of(cells, boundary);
    let greatest = rings.of_vertex.values().chain(rings.of_edge.values());
    let greatest = greatest.map(|ring| ring.near.len() + ring.far.len()).max();
    assert!(
        greatest.unwrap_or(0) <= NEIGHBOURS_MAXIMUM,
        "too many neighbours"
    );
    let mut refined = vec![[0; D]; divided.next.vertex_count as usize];
    let mut saturated = 0;
    for axis in 0..D {
        let mut channel = Channel {
            values: points.iter().map(|point| f64::from(point[axis])).collect(),
            rings: &rings,
            scheme,
            boundary,
            saturated: 0,
        };
        let mut slots = refined.iter_mut().map(|point| &mut point[axis]);
        for vertex in 0..cells.vertex_count {
            *slots.next().expect("a slot") = channel.vertex(vertex, surface.vertex(vertex));
        }
        for edge in &divided.edges {
            *slots.next().expect("a slot") = channel.edge(*edge, surface.edge(*edge));
        }
        for place in &divided.octahedra {
            let (cell, diagonal) = cells.octahedra[*place];
            *slots.next().expect("a slot") = channel.cell(cell, diagonal);
        }
        saturated += channel.saturated;
    }
    Refined {
        cells: divided.next,
        points: refined,
        saturated,
    }
}

impl Channel<'_> {
    fn at(&self, vertex: u32) -> f64 {
        self.values[vertex as usize]
    }

    fn sum<'v>(&self, vertices: impl IntoIterator<Item = &'v u32>) -> f64 {
        vertices.into_iter().map(|vertex| self.at(*vertex)).sum()
    }

    fn quotient(&mut self, numerator: f64, denominator: f64) -> i32 {
        saturate(round_quotient(numerator, denominator), &mut self.saturated)
    }

    fn vertex(&mut self, vertex: u32, rule: VertexRule) -> i32 {
        let own = self.at(vertex);
        match rule {
            VertexRule::Stay => own as i32,
            VertexRule::Crease([a, b]) => {
                let numerator = self.at(a) + 6.0 * own + self.at(b);
                self.quotient(numerator, 8.0)
            }
            VertexRule::Surface(ring) => self.on_surface(own, &ring),
            VertexRule::Interior => {
                let Some(ring) = self.rings.of_vertex.get(&vertex) else {
                    return own as i32;
                };
                let (sum, weights) = self.mean(ring, 3.0);
                // 9/16 own + 7/16 of the mean.
                self.quotient(9.0 * weights * own + 7.0 * sum, 16.0 * weights)
            }
        }
    }

    fn edge(&mut self, [a, b]: [u32; 2], rule: EdgeRule) -> i32 {
        let ends = self.at(a) + self.at(b);
        match rule {
            EdgeRule::Half => self.quotient(ends, 2.0),
            EdgeRule::Surface(opposite) => {
                // 3/8 3/8 and 1/4 of the mean of the vertices opposite.
                let count = opposite.len() as f64;
                let numerator = 3.0 * count * ends + 2.0 * self.sum(&opposite);
                self.quotient(numerator, 8.0 * count)
            }
            EdgeRule::Interior => {
                let Some(ring) = self.rings.of_edge.get(&[a, b]) else {
                    return self.quotient(ends, 2.0);
                };
                let (sum, weights) = self.mean(ring, 4.0);
                match self.scheme {
                    // (3.5): 8/32 and 4/32.
                    Scheme::MajorDiagonals if weights == 4.0 => {
                        self.quotient(8.0 * ends + 4.0 * sum, 32.0)
                    }
                    // (3.8): 5/16 and 3/(8k).
                    Scheme::MajorDiagonals => {
                        self.quotient(5.0 * weights * ends + 6.0 * sum, 16.0 * weights)
                    }
                    // 7/24 and 5/12 of the mean.
                    Scheme::Averaged => {
                        self.quotient(7.0 * weights * ends + 10.0 * sum, 24.0 * weights)
                    }
                }
            }
        }
    }

    /// The weighted sum over a ring and the sum of its weights; `near` is the weight of the near
    /// ones in the averaged scheme.
    fn mean(&self, ring: &Ring, near: f64) -> (f64, f64) {
        let near = match self.scheme {
            Scheme::MajorDiagonals => 1.0,
            Scheme::Averaged => near,
        };
        let sum = near * self.sum(&ring.near) + self.sum(&ring.far);
        let weights = near * ring.near.len() as f64 + ring.far.len() as f64;
        (sum, weights)
    }

    fn cell(&mut self, cell: [u32; 6], diagonal: u8) -> i32 {
        let all = self.sum(&cell);
        match self.scheme {
            Scheme::Averaged => self.quotient(all, 6.0),
            Scheme::MajorDiagonals => {
                let place = usize::from(diagonal);
                let ends = self.at(cell[place]) + self.at(cell[place + 3]);
                self.quotient(4.0 * all + 4.0 * ends, 32.0)
            }
        }
    }

    /// Loop's vertex rule with the weight that the boundary names.
    fn on_surface(&mut self, own: f64, ring: &[u32]) -> i32 {
        let weight = LoopWeight::new(self.boundary, ring.len()).expect("a surface rule");
        if weight.denominator != WEIGHT_UNIT {
            let numerator = weight.own * own + weight.neighbour * self.sum(ring);
            return self.quotient(numerator, weight.denominator);
        }
        let mut sum = LimbSum::default();
        sum.add(weight.own, own);
        for neighbour in ring {
            sum.add(weight.neighbour, self.at(*neighbour));
        }
        saturate(sum.round(), &mut self.saturated)
    }
}
