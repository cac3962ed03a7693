//! Adaptive Loop refinement, red-green: the rival.
//!
//! A triangle is split in four (red). One that is not, beside triangles that are, is cut to the middles of its split
//! edges (green); [`Green`] says with how many. Green triangles are never refined: if one is too far from the surface,
//! or if a half of its edge is split again, the triangle that it lies in is split instead. So levels of neighbours
//! differ by one at most.

use std::collections::HashSet;

use super::measure::{Measure, Part};
use super::surface::{Point, Rule};

/// What becomes of a triangle beside split ones.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Green {
    /// With one split edge it is cut in two; with more it is split: the red-green triangulation of the finite element
    /// community, which the paper names.
    Halves,
    /// With one split edge it is cut in two, with two in three, along the diagonal that leaves less distance; with
    /// three it is split: fewer triangles, and slimmer ones.
    Fans,
}

/// A triangle of a level.
type Leaf = (u32, [u32; 3]);

/// A closed mesh that is refined in places.
#[derive(Debug)]
pub struct LoopMesh {
    measure: Measure,
    control: Vec<Leaf>,
    leaves: Vec<Leaf>,
    /// Middles of split edges.
    split: HashSet<u32>,
    green: Green,
}

impl LoopMesh {
    /// The control mesh.
    pub fn new(green: Green, points: &[Point], faces: &[[u32; 3]]) -> Self {
        Self {
            measure: Measure::new(Rule::Loop, points, faces),
            control: faces.iter().map(|face| (0, *face)).collect(),
            leaves: Vec::new(),
            split: HashSet::new(),
            green,
        }
    }

    /// How many triangles are needed so that the limit surface is nowhere farther than the tolerance.
    pub fn count(&mut self, tolerance: f64) -> usize {
        self.leaves.clone_from(&self.control);
        self.split.clear();
        let mut changed = true;
        while changed {
            changed = false;
            let mut place = 0;
            while place < self.leaves.len() {
                let leaf = self.leaves[place];
                if self.is_unfit(leaf, tolerance) {
                    self.split(place);
                    changed = true;
                } else {
                    place += 1;
                }
            }
        }
        let leaves = self.leaves.clone();
        let fans = leaves.into_iter().map(|leaf| self.fan(leaf).len());
        fans.sum()
    }

    /// Whether a triangle must be split: it, or its fan, is too far off, or an edge is split twice.
    fn is_unfit(&mut self, leaf: Leaf, tolerance: f64) -> bool {
        let middles = self.middles(leaf);
        let split = middles.map(|middle| self.split.contains(&middle));
        let count = split.iter().filter(|own| **own).count();
        let most = match self.green {
            Green::Halves => 1,
            Green::Fans => 2,
        };
        if count > most || self.is_split_twice(leaf, middles, split) {
            return true;
        }
        let fan = self.fan(leaf);
        fan.into_iter()
            .any(|part| self.measure.distance(part) > tolerance)
    }

    fn is_split_twice(
        &mut self,
        (level, corners): Leaf,
        middles: [u32; 3],
        split: [bool; 3],
    ) -> bool {
        (0..3).filter(|side| split[*side]).any(|side| {
            let ends = [corners[side], corners[(side + 1) % 3]];
            ends.into_iter().any(|end| {
                let middle = self.measure.surface.child(level + 2, &[end, middles[side]]);
                self.split.contains(&middle)
            })
        })
    }

    /// The middles of the edges, the first between the first two corners.
    fn middles(&mut self, (level, [a, b, c]): Leaf) -> [u32; 3] {
        let surface = &mut self.measure.surface;
        [[a, b], [b, c], [c, a]].map(|ends| surface.child(level + 1, &ends))
    }

    fn split(&mut self, place: usize) {
        let (level, [a, b, c]) = self.leaves[place];
        let [ab, bc, ca] = self.middles(self.leaves[place]);
        self.split.extend([ab, bc, ca]);
        self.leaves[place] = (level + 1, [ab, bc, ca]);
        for corner in [[a, ab, ca], [ab, b, bc], [ca, bc, c]] {
            self.leaves.push((level + 1, corner));
        }
    }

    /// The triangles that a leaf is drawn as.
    fn fan(&mut self, leaf: Leaf) -> Vec<Part> {
        let (level, corners) = leaf;
        let middles = self.middles(leaf);
        let split = middles.map(|middle| self.split.contains(&middle));
        let count = split.iter().filter(|split| **split).count();
        if count == 0 {
            return vec![Part::whole(level, corners)];
        }
        // Turned so that the first edge is split, and of two the second as well.
        let first = (0..3)
            .find(|side| split[*side] && (count == 1 || split[(side + 1) % 3]))
            .unwrap_or_default();
        let turned = |list: [u32; 3]| [0, 1, 2].map(|i| list[(first + i) % 3]);
        let ([a, b, c], [ab, bc, _]) = (turned(corners), turned(middles));
        let places = [
            (a, [2, 0, 0]),
            (b, [0, 2, 0]),
            (c, [0, 0, 2]),
            (ab, [1, 1, 0]),
            (bc, [0, 1, 1]),
        ];
        let part = |triangle: [usize; 3]| Part {
            level,
            whole: [a, b, c],
            corners: triangle.map(|place| places[place].0),
            places: triangle.map(|place| places[place].1),
        };
        if count == 1 {
            return vec![part([0, 3, 2]), part([3, 1, 2])];
        }
        let one = [part([0, 3, 4]), part([0, 4, 2])];
        let other = [part([0, 3, 2]), part([3, 4, 2])];
        let mut off = |parts: [Part; 2]| {
            let distances = parts.map(|part| self.measure.distance(part));
            distances[0].max(distances[1])
        };
        let better = if off(one) <= off(other) { one } else { other };
        vec![part([3, 1, 4]), better[0], better[1]]
    }
}
