//! Control meshes and what is found on them: edges, rings, sharp edges.

use std::collections::{BTreeMap, BTreeSet};

/// A control mesh.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Polygons {
    /// Number of vertices.
    pub vertex_count: u32,
    /// Corners of the faces, counter-clockwise.
    pub faces: Vec<Vec<u32>>,
    /// Crease edges.
    pub creases: Vec<[u32; 2]>,
    /// Vertices that stay.
    pub corners: Vec<u32>,
    /// True after an odd number of square-root-3 steps.
    pub odd: bool,
}

/// What a rim follows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Border {
    /// Cubic B-spline.
    Spline,
    /// Cubic B-spline with corners where the rim's vertex is in one face.
    SplineWithCorners,
    /// Stays.
    Fixed,
}

/// A vertex by its rule.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Kind {
    /// The scheme's own rule.
    Smooth,
    /// Along a crease, between these two.
    Crease(u32, u32),
    /// Stays.
    Stays,
}

/// The pair in ascending order.
pub fn edge(a: u32, b: u32) -> [u32; 2] {
    [a.min(b), a.max(b)]
}

/// The sides of a face: consecutive corners.
pub fn sides(face: &[u32]) -> Vec<(u32, u32)> {
    (0..face.len())
        .map(|i| (face[i], face[(i + 1) % face.len()]))
        .collect()
}

impl Polygons {
    /// Every edge with the faces on it, ascending.
    pub fn edges(&self) -> BTreeMap<[u32; 2], Vec<usize>> {
        let mut edges: BTreeMap<[u32; 2], Vec<usize>> = BTreeMap::new();
        for (index, face) in self.faces.iter().enumerate() {
            for (a, b) in sides(face) {
                edges.entry(edge(a, b)).or_default().push(index);
            }
        }
        edges
    }

    /// Faces by ascending sorted corners.
    pub fn sorted_faces(&self) -> Vec<usize> {
        let mut order: Vec<usize> = (0..self.faces.len()).collect();
        order.sort_by_key(|index| {
            let mut key = self.faces[*index].clone();
            key.sort_unstable();
            key
        });
        order
    }

    /// Edges that are creases or do not have two faces.
    pub fn sharp_edges(&self) -> BTreeSet<[u32; 2]> {
        let tagged = self.creases.iter().map(|crease| edge(crease[0], crease[1]));
        let rim = self.edges().into_iter().filter(|entry| entry.1.len() != 2);
        tagged.chain(rim.map(|entry| entry.0)).collect()
    }

    /// The neighbours of every vertex, ascending.
    pub fn neighbours(&self) -> Vec<Vec<u32>> {
        let mut found = vec![Vec::new(); self.vertex_count as usize];
        for [a, b] in self.edges().into_keys() {
            found[a as usize].push(b);
            found[b as usize].push(a);
        }
        for ring in &mut found {
            ring.sort_unstable();
        }
        found
    }

    /// The faces at every vertex.
    pub fn faces_at(&self) -> Vec<Vec<usize>> {
        let mut found = vec![Vec::new(); self.vertex_count as usize];
        for (index, face) in self.faces.iter().enumerate() {
            for corner in face {
                found[*corner as usize].push(index);
            }
        }
        found
    }

    /// Whether two faces run along an edge, theirs alone, in the same direction.
    pub fn has_turned_faces(&self) -> bool {
        let directed: Vec<(u32, u32)> = self.faces.iter().flat_map(|face| sides(face)).collect();
        let twice = |a: u32, b: u32| directed.iter().filter(|side| **side == (a, b)).count() == 2;
        let edges = self.edges().into_iter();
        let mut pairs = edges.filter(|(_, on)| on.len() == 2).map(|entry| entry.0);
        pairs.any(|[a, b]| twice(a, b) || twice(b, a))
    }

    /// Whether the faces at a vertex do not all hang together over edges at the vertex.
    pub fn has_two_fans(&self, vertex: u32) -> bool {
        let at: Vec<&Vec<u32>> = self.faces.iter().filter(|f| f.contains(&vertex)).collect();
        let edges = self.edges();
        let mut reached = BTreeSet::from([0]);
        while let Some(next) = (0..at.len()).find(|i| {
            !reached.contains(i)
                && reached.iter().any(|j| {
                    let share = |v: &&u32| **v != vertex && at[*j].contains(v);
                    let neighbours = |v: &u32| edges.contains_key(&edge(vertex, *v));
                    at[*i].iter().filter(share).any(neighbours)
                })
        }) {
            reached.insert(next);
        }
        reached.len() < at.len()
    }

    /// Whether a vertex is tagged as a corner, or other than two sharp edges meet there: no sharp
    /// line runs through it.
    pub fn is_end(&self, vertex: u32) -> bool {
        let lines = self.sharp_edges();
        let count = lines.iter().filter(|edge| edge.contains(&vertex)).count();
        self.corners.contains(&vertex) || count != 2
    }

    /// The rule of every vertex.
    pub fn kinds(&self, border: Border) -> Vec<Kind> {
        let edges = self.edges();
        let sharp = self.sharp_edges();
        let faces_at = self.faces_at();
        (0..self.vertex_count)
            .map(|vertex| {
                let at = |edge: &[u32; 2]| edge.contains(&vertex);
                let rim = edges
                    .iter()
                    .filter(|(e, on)| at(e) && on.len() != 2)
                    .count();
                let lines: Vec<u32> = sharp
                    .iter()
                    .filter(|edge| at(edge))
                    .map(|[a, b]| if *a == vertex { *b } else { *a })
                    .collect();
                let faces = faces_at[vertex as usize].len();
                let keeps = border == Border::Fixed && rim > 0
                    || border == Border::SplineWithCorners && rim == 2 && faces == 1
                    || self.corners.contains(&vertex)
                    || faces == 0;
                match lines.as_slice() {
                    _ if keeps => Kind::Stays,
                    [a, b] => Kind::Crease(*a, *b),
                    [] => Kind::Smooth,
                    [_] if rim == 0 => Kind::Smooth,
                    _ => Kind::Stays,
                }
            })
            .collect()
    }

    /// Creases cut in two at their edges' new vertices.
    pub fn halved_creases(&self, middle: &BTreeMap<[u32; 2], u32>) -> Vec<[u32; 2]> {
        self.creases
            .iter()
            .flat_map(|[a, b]| {
                let m = middle[&edge(*a, *b)];
                [[*a, m], [m, *b]]
            })
            .collect()
    }

    /// The number of every edge's new vertex, after the old ones.
    pub fn middles(&self) -> BTreeMap<[u32; 2], u32> {
        self.edges().into_keys().zip(self.vertex_count..).collect()
    }
}
