//! Uniform refinement of a closed mesh, as far as it is asked for: vertices, their rings and their positions come
//! into being when something reads them, in double precision, from the papers' rules alone.
//!
//! A vertex is one of a level and of what it was born in: a triangle (square-root-3) or an edge (Loop). Its ring on
//! the next level lies in the triangles around it, or on its edges, so a ring follows from the ring before, and a
//! position from the positions of the ring before.

use std::collections::{BTreeMap, HashMap};
use std::rc::Rc;

/// A point of real numbers.
pub type Point = [f64; 3];

/// How a mesh is refined.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rule {
    /// Kobbelt's: a vertex in every triangle, all edges flipped.
    Sqrt3,
    /// Loop's of 1987: a vertex on every edge.
    Loop,
}

impl Rule {
    /// The weight of the ring's mean at a vertex of this valence, in one step and in the limit.
    fn weights(self, valence: usize) -> [f64; 2] {
        let n = valence as f64;
        let cosine = (std::f64::consts::TAU / n).cos();
        match self {
            Self::Sqrt3 => {
                let alpha = (4.0 - 2.0 * cosine) / 9.0;
                [alpha, 3.0 * alpha / (1.0 + 3.0 * alpha)]
            }
            Self::Loop => {
                let step = 0.625 - (0.375 + 0.25 * cosine).powi(2);
                [step, step / (0.375 + step)]
            }
        }
    }

    /// Into how many parts an edge is cut, in how many levels.
    fn cuts(self) -> (u32, u32) {
        match self {
            Self::Sqrt3 => (3, 2),
            Self::Loop => (2, 1),
        }
    }
}

/// A vertex with what is known of it from its birth on, level by level.
#[derive(Clone, Debug, Default)]
struct Vertex {
    birth: u32,
    /// Corners of the triangle, or ends of the edge, that it was born in.
    parents: Vec<u32>,
    rings: Vec<Rc<[u32]>>,
    positions: Vec<Point>,
    limit: Option<Point>,
}

/// A closed mesh of triangles and all its refinements.
#[derive(Debug)]
pub struct Surface {
    rule: Rule,
    vertices: Vec<Vertex>,
    born: HashMap<[u32; 4], u32>,
}

/// Vertices on and in a triangle some levels on, by their barycentric coordinates.
pub type Samples = BTreeMap<[u32; 3], u32>;

impl Surface {
    /// A closed mesh of triangles that turn counter-clockwise.
    ///
    /// # Panics
    /// If there is an edge without two triangles.
    pub fn new(rule: Rule, points: &[Point], triangles: &[[u32; 3]]) -> Self {
        let mut after = HashMap::new();
        for &[a, b, c] in triangles {
            for (own, from, to) in [(a, b, c), (b, c, a), (c, a, b)] {
                after.insert((own, from), to);
            }
        }
        let first: HashMap<u32, u32> = after.keys().map(|(own, from)| (*own, *from)).collect();
        let vertices = points.iter().zip(0..).map(|(point, own)| {
            let mut ring = vec![first[&own]];
            loop {
                let next = after[&(own, ring[ring.len() - 1])];
                if next == ring[0] {
                    break;
                }
                ring.push(next);
            }
            Vertex {
                rings: vec![ring.into()],
                positions: vec![*point],
                ..Vertex::default()
            }
        });
        Self {
            rule,
            vertices: vertices.collect(),
            born: HashMap::new(),
        }
    }

    /// The vertex that a level gets in a triangle or on an edge of the level before.
    pub fn child(&mut self, level: u32, parents: &[u32]) -> u32 {
        let mut key = [u32::MAX; 4];
        key[..parents.len()].copy_from_slice(parents);
        key[..3].sort_unstable();
        key[3] = level;
        let Self { vertices, born, .. } = self;
        *born.entry(key).or_insert_with(|| {
            vertices.push(Vertex {
                birth: level,
                parents: parents.to_vec(),
                ..Vertex::default()
            });
            vertices.len() as u32 - 1
        })
    }

    /// The ring of a vertex on a level, counter-clockwise.
    pub fn ring(&mut self, vertex: u32, level: u32) -> Rc<[u32]> {
        let place = (level - self.vertices[vertex as usize].birth) as usize;
        while self.vertices[vertex as usize].rings.len() <= place {
            let own = &self.vertices[vertex as usize];
            let ring = match own.rings.last() {
                None => self.ring_at_birth(own.birth, &own.parents.clone()),
                Some(before) => {
                    let (before, level) = (before.clone(), own.birth + own.rings.len() as u32);
                    self.next_ring(vertex, level, &before)
                }
            };
            self.vertices[vertex as usize].rings.push(ring.into());
        }
        self.vertices[vertex as usize].rings[place].clone()
    }

    fn next_ring(&mut self, vertex: u32, level: u32, before: &[u32]) -> Vec<u32> {
        let following = before.iter().cycle().skip(1);
        let pairs = before.iter().zip(following);
        pairs
            .map(|(one, next)| match self.rule {
                Rule::Sqrt3 => self.child(level, &[vertex, *one, *next]),
                Rule::Loop => self.child(level, &[vertex, *one]),
            })
            .collect()
    }

    fn ring_at_birth(&mut self, level: u32, parents: &[u32]) -> Vec<u32> {
        match *parents {
            [a, b, c] => {
                let sides = [(a, b), (b, c), (c, a)];
                let both = sides.map(|(from, to)| {
                    let [_, beyond] = self.opposite(level - 1, from, to);
                    [from, self.child(level, &[from, beyond, to])]
                });
                both.concat()
            }
            [a, b] => {
                let [c, d] = self.opposite(level - 1, a, b);
                let mut middle = |from, to| self.child(level, &[from, to]);
                let [bc, ca, ad, db] = [middle(b, c), middle(c, a), middle(a, d), middle(d, b)];
                vec![b, bc, ca, a, ad, db]
            }
            _ => panic!("a vertex is born in a triangle or on an edge"),
        }
    }

    /// What lies opposite the edge from one vertex to another: on its left and on its right.
    pub fn opposite(&mut self, level: u32, from: u32, to: u32) -> [u32; 2] {
        let ring = self.ring(from, level);
        let place = ring.iter().position(|other| *other == to);
        let place = place.expect("the edge is one of this level");
        [
            ring[(place + 1) % ring.len()],
            ring[(place + ring.len() - 1) % ring.len()],
        ]
    }

    /// Where a vertex is on a level.
    pub fn position(&mut self, vertex: u32, level: u32) -> Point {
        let place = (level - self.vertices[vertex as usize].birth) as usize;
        while self.vertices[vertex as usize].positions.len() <= place {
            let own = &self.vertices[vertex as usize];
            let (birth, known) = (own.birth, own.positions.len() as u32);
            let position = if known == 0 {
                self.position_at_birth(birth - 1, &own.parents.clone())
            } else {
                self.relaxed(vertex, birth + known - 1, 0)
            };
            self.vertices[vertex as usize].positions.push(position);
        }
        self.vertices[vertex as usize].positions[place]
    }

    fn position_at_birth(&mut self, level: u32, parents: &[u32]) -> Point {
        let ends = self.mean(level, parents);
        let [a, b] = *parents else { return ends };
        let opposite = self.opposite(level, a, b);
        let others = self.mean(level, &opposite);
        mix(ends, others, 0.25)
    }

    fn mean(&mut self, level: u32, vertices: &[u32]) -> Point {
        let mut sum = [0.0; 3];
        for vertex in vertices {
            let position = self.position(*vertex, level);
            sum = [0, 1, 2].map(|axis| sum[axis] + position[axis]);
        }
        sum.map(|total| total / vertices.len() as f64)
    }

    /// One step on from a level (`which` is 0) or in the limit (1).
    fn relaxed(&mut self, vertex: u32, level: u32, which: usize) -> Point {
        let ring = self.ring(vertex, level);
        let own = self.position(vertex, level);
        let mean = self.mean(level, &ring);
        mix(own, mean, self.rule.weights(ring.len())[which])
    }

    /// Where a vertex goes in the limit.
    pub fn limit(&mut self, vertex: u32) -> Point {
        if let Some(limit) = self.vertices[vertex as usize].limit {
            return limit;
        }
        let limit = self.relaxed(vertex, self.vertices[vertex as usize].birth, 1);
        self.vertices[vertex as usize].limit = Some(limit);
        limit
    }

    /// The triangle that a vertex was put into; of a vertex of the square-root-3 scheme only.
    pub fn parents(&self, vertex: u32) -> &[u32] {
        &self.vertices[vertex as usize].parents
    }

    /// Vertices on and in a triangle of a level, after its edges were cut `times` times.
    pub fn samples(&mut self, level: u32, triangle: [u32; 3], times: u32) -> Samples {
        let (cuts, _) = self.rule.cuts();
        let parts = cuts.pow(times);
        let mut samples = Samples::new();
        let corners = [[parts, 0, 0], [0, parts, 0], [0, 0, parts]];
        self.sample(level, triangle, corners, times, &mut samples);
        samples
    }

    fn sample(
        &mut self,
        level: u32,
        triangle: [u32; 3],
        places: [[u32; 3]; 3],
        times: u32,
        samples: &mut Samples,
    ) {
        if times == 0 {
            samples.extend(places.into_iter().zip(triangle));
            return;
        }
        let (cuts, levels) = self.rule.cuts();
        let grid = self.cut(level, triangle);
        let place = |[i, j]: [u32; 2]| {
            let [a, b, c] = places;
            [0, 1, 2].map(|axis| ((cuts - i - j) * a[axis] + i * b[axis] + j * c[axis]) / cuts)
        };
        for i in 0..cuts {
            for j in 0..cuts - i {
                let mut parts = vec![[[i, j], [i + 1, j], [i, j + 1]]];
                if i + j + 2 <= cuts {
                    parts.push([[i + 1, j], [i + 1, j + 1], [i, j + 1]]);
                }
                for part in parts {
                    let corners = part.map(|at| grid[&at]);
                    self.sample(level + levels, corners, part.map(place), times - 1, samples);
                }
            }
        }
    }

    /// The vertices after the edges were cut once: by steps toward the second and the third corner.
    fn cut(&mut self, level: u32, [a, b, c]: [u32; 3]) -> BTreeMap<[u32; 2], u32> {
        let (cuts, _) = self.rule.cuts();
        let mut grid = BTreeMap::from([([0, 0], a), ([cuts, 0], b), ([0, cuts], c)]);
        let ends = [(a, [0, 0]), (b, [cuts, 0]), (c, [0, cuts])];
        let centre = (self.rule == Rule::Sqrt3).then(|| self.child(level + 1, &[a, b, c]));
        for side in 0..3 {
            let ((from, near), (to, far)) = (ends[side], ends[(side + 1) % 3]);
            let between = |steps: u32| {
                [0, 1].map(|axis| (near[axis] * (cuts - steps) + far[axis] * steps) / cuts)
            };
            let Some(centre) = centre else {
                grid.insert(between(1), self.child(level + 1, &[from, to]));
                continue;
            };
            let [_, beyond] = self.opposite(level, from, to);
            let other = self.child(level + 1, &[from, beyond, to]);
            grid.insert([1, 1], centre);
            grid.insert(between(1), self.child(level + 2, &[from, other, centre]));
            grid.insert(between(2), self.child(level + 2, &[to, centre, other]));
        }
        grid
    }
}

fn mix(one: Point, other: Point, part: f64) -> Point {
    [0, 1, 2].map(|axis| (1.0 - part) * one[axis] + part * other[axis])
}
