//! Adaptive square-root-3 refinement, the paper's splitting procedure in as many words.

use super::measure::{Measure, Part};
use super::surface::{Point, Rule};

/// A triangle: its first corner is the new vertex if its generation is odd, and mate `i` lies opposite corner `i`.
#[derive(Clone, Copy, Debug)]
pub struct Triangle {
    /// Corners, counter-clockwise.
    pub corners: [u32; 3],
    /// Neighbours.
    pub mates: [usize; 3],
    /// Twice the level, or one more between two.
    pub generation: u32,
}

/// A closed mesh that is refined in places.
#[derive(Debug)]
pub struct Sqrt3Mesh {
    /// The uniform hierarchy that it is a part of.
    pub measure: Measure,
    /// All triangles.
    pub triangles: Vec<Triangle>,
    control: Vec<Triangle>,
}

impl Sqrt3Mesh {
    /// The control mesh.
    pub fn new(points: &[Point], faces: &[[u32; 3]]) -> Self {
        let beyond = |from: u32, to: u32| {
            let has = |face: &[u32; 3]| (0..3).any(|i| face[i] == to && face[(i + 1) % 3] == from);
            faces.iter().position(has).expect("a closed mesh")
        };
        let control: Vec<_> = faces
            .iter()
            .map(|&[a, b, c]| Triangle {
                corners: [a, b, c],
                mates: [beyond(b, c), beyond(c, a), beyond(a, b)],
                generation: 0,
            })
            .collect();
        Self {
            measure: Measure::new(Rule::Sqrt3, points, faces),
            triangles: control.clone(),
            control,
        }
    }

    /// Starts anew and splits while a triangle is wanted.
    pub fn refine(&mut self, mut wants: impl FnMut(&mut Measure, &Triangle) -> bool) {
        self.triangles = self.control.clone();
        let mut changed = true;
        while changed {
            changed = false;
            let mut place = 0;
            while place < self.triangles.len() {
                if wants(&mut self.measure, &self.triangles[place]) {
                    self.split(place);
                    changed = true;
                } else {
                    place += 1;
                }
            }
        }
    }

    /// How many triangles are needed so that the limit surface is nowhere farther than the tolerance.
    pub fn count(&mut self, tolerance: f64) -> usize {
        self.refine(|measure, triangle| {
            let part = part(measure, triangle);
            measure.distance(part) > tolerance
        });
        self.triangles.len()
    }

    fn split(&mut self, place: usize) {
        let own = self.triangles[place];
        if !own.generation.is_multiple_of(2) {
            if self.triangles[own.mates[0]].generation + 2 == own.generation {
                self.split(own.mates[0]);
            }
            // The mate's split makes the two swap.
            self.split(self.triangles[place].mates[0]);
            return;
        }
        for side in 0..3 {
            let mate = self.triangles[place].mates[side];
            let generation = self.triangles[mate].generation;
            if !generation.is_multiple_of(2) && generation < own.generation {
                self.split(mate);
            }
        }
        self.insert(place);
    }

    fn insert(&mut self, place: usize) {
        let Triangle {
            corners: [a, b, c],
            mates: [beyond_a, beyond_b, beyond_c],
            generation,
        } = self.triangles[place];
        let p = self.measure.surface.child(generation / 2 + 1, &[a, b, c]);
        let (second, third) = (self.triangles.len(), self.triangles.len() + 1);
        let new = |corners, mates| Triangle {
            corners,
            mates,
            generation: generation + 1,
        };
        self.triangles[place] = new([p, a, b], [beyond_c, second, third]);
        self.triangles
            .push(new([p, b, c], [beyond_a, third, place]));
        self.triangles
            .push(new([p, c, a], [beyond_b, place, second]));
        self.rejoin(beyond_a, second, [b, c]);
        self.rejoin(beyond_b, third, [c, a]);
        for triangle in [place, second, third] {
            let mate = self.triangles[triangle].mates[0];
            if self.triangles[mate].generation == generation + 1 {
                self.swap(triangle, mate);
            }
        }
    }

    /// Tells a triangle that another one lies beyond one of its sides now.
    fn rejoin(&mut self, triangle: usize, now: usize, side: [u32; 2]) {
        let own = &mut self.triangles[triangle];
        for (corner, mate) in own.corners.iter().zip(&mut own.mates) {
            if !side.contains(corner) {
                *mate = now;
            }
        }
    }

    /// T1 (A, B, C) and T2 (D, C, B) become T1 (C, A, D) and T2 (B, D, A).
    fn swap(&mut self, one: usize, other: usize) {
        let (first, second) = (self.triangles[one], self.triangles[other]);
        let ([a, b, c], [d, ..]) = (first.corners, second.corners);
        let [_, by_ca, by_ab] = first.mates;
        let [_, by_bd, by_dc] = second.mates;
        let generation = first.generation + 1;
        self.triangles[one] = Triangle {
            corners: [c, a, d],
            mates: [other, by_dc, by_ca],
            generation,
        };
        self.triangles[other] = Triangle {
            corners: [b, d, a],
            mates: [one, by_ab, by_bd],
            generation,
        };
        self.rejoin(by_dc, one, [d, c]);
        self.rejoin(by_ab, other, [a, b]);
    }
}

/// The part of the uniform mesh that a triangle stands for: an odd one for a third of its parent.
fn part(measure: &Measure, triangle: &Triangle) -> Part {
    let level = triangle.generation / 2;
    if triangle.generation.is_multiple_of(2) {
        return Part::whole(level, triangle.corners);
    }
    let [p, a, b] = triangle.corners;
    let parents = measure.surface.parents(p);
    let other = parents.iter().find(|corner| **corner != a && **corner != b);
    let whole = [a, b, *other.expect("a third corner")];
    Part {
        level,
        whole,
        corners: triangle.corners,
        places: [[1, 1, 1], [3, 0, 0], [0, 3, 0]],
    }
}
