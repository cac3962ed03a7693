//! Random control meshes from a seed: connectivity of every kind that refinement must get right.

use std::collections::BTreeSet;

use rand::RngExt as _;
use rand::seq::SliceRandom as _;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng as _;

use crate::reference_surface::{Polygons, edge, sides};

/// Which faces a scheme takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    /// Any polygons.
    Polygons,
    /// Triangles.
    Triangles,
    /// Triangles and quads.
    TrianglesAndQuads,
}

/// What a random mesh may have.
#[derive(Clone, Copy, Debug)]
pub struct Wishes {
    /// Its faces.
    pub shape: Shape,
    /// Holes and rims.
    pub open: bool,
    /// Creases and corners.
    pub features: bool,
    /// Edges of three faces and vertices where only vertices touch.
    pub tangled: bool,
}

/// A control mesh with its points.
#[derive(Clone, Debug)]
pub struct SurfaceCase {
    /// Connectivity.
    pub mesh: Polygons,
    /// Points, raw bits.
    pub points: Vec<[i32; 3]>,
}

impl SurfaceCase {
    /// The case of a seed.
    pub fn new(seed: u64, wishes: Wishes) -> Self {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let mut mesh = base(&mut rng, wishes.shape);
        for _ in 0..rng.random_range(0..6) {
            grow(&mut rng, &mut mesh, wishes.shape);
        }
        if wishes.shape == Shape::TrianglesAndQuads {
            cut_polygons(&mut rng, &mut mesh);
        }
        if wishes.open && rng.random_range(0..3) > 0 {
            for _ in 0..rng.random_range(1..4) {
                if mesh.faces.len() > 2 {
                    let face = rng.random_range(0..mesh.faces.len());
                    mesh.faces.swap_remove(face);
                }
            }
        }
        if wishes.tangled && rng.random_range(0..4) == 0 {
            tangle(&mut rng, &mut mesh);
        }
        if wishes.features {
            add_features(&mut rng, &mut mesh);
        }
        shuffle(&mut rng, &mut mesh);
        let points = random_points(&mut rng, mesh.vertex_count);
        Self { mesh, points }
    }

    /// Every coordinate at the end of the range that it is nearer to: weights of either sign then lead
    /// out of the range.
    #[must_use]
    pub fn at_the_ends(mut self) -> Self {
        for coordinate in self.points.as_flattened_mut() {
            *coordinate = if *coordinate < 0 { i32::MIN } else { i32::MAX };
        }
        self
    }
}

/// Points that fill small grids, ordinary ranges or the whole of `i32`.
fn random_points(rng: &mut ChaCha8Rng, count: u32) -> Vec<[i32; 3]> {
    let reach: i64 = match rng.random_range(0..4) {
        0 => 3,
        1 => 1 << 12,
        2 => 1 << 26,
        _ => 1 << 31,
    };
    let mut coordinate = || (rng.random_range(-reach..reach)) as i32;
    (0..count)
        .map(|_| [coordinate(), coordinate(), coordinate()])
        .collect()
}

/// A closed mesh to start from: a bipyramid, a prism, a pyramid, or their triangulations.
fn base(rng: &mut ChaCha8Rng, shape: Shape) -> Polygons {
    let n: u32 = rng.random_range(3..10);
    let next = |i: u32| (i + 1) % n;
    let mut mesh = match (shape, rng.random_range(0..3)) {
        (Shape::Polygons | Shape::TrianglesAndQuads, 0) => Polygons {
            vertex_count: 2 * n,
            faces: (0..n)
                .map(|i| vec![i, next(i), n + next(i), n + i])
                .chain([(0..n).rev().collect(), (n..2 * n).collect()])
                .collect(),
            ..Polygons::default()
        },
        (Shape::Polygons | Shape::TrianglesAndQuads, 1) => Polygons {
            vertex_count: n + 1,
            faces: (0..n)
                .map(|i| vec![i, next(i), n])
                .chain([(0..n).rev().collect()])
                .collect(),
            ..Polygons::default()
        },
        _ => Polygons {
            vertex_count: n + 2,
            faces: (0..n)
                .flat_map(|i| [vec![i, next(i), n], vec![next(i), i, n + 1]])
                .collect(),
            ..Polygons::default()
        },
    };
    if shape == Shape::Triangles && rng.random_range(0..2) == 0 {
        flip(rng, &mut mesh);
    }
    mesh
}

/// One change that keeps the mesh closed and its orientation consistent.
fn grow(rng: &mut ChaCha8Rng, mesh: &mut Polygons, shape: Shape) {
    match (shape, rng.random_range(0..3)) {
        (_, 0) => star(rng, mesh),
        (Shape::Triangles, _) => flip(rng, mesh),
        (_, 1) => merge(rng, mesh),
        (_, _) => cut(rng, mesh),
    }
}

/// Puts a vertex into a face and joins it to the corners.
fn star(rng: &mut ChaCha8Rng, mesh: &mut Polygons) {
    let index = rng.random_range(0..mesh.faces.len());
    let face = mesh.faces.swap_remove(index);
    let centre = mesh.vertex_count;
    mesh.vertex_count += 1;
    mesh.faces
        .extend(sides(&face).into_iter().map(|(a, b)| vec![a, b, centre]));
}

/// Cuts a polygon of four corners or more along a diagonal that is no edge yet.
fn cut(rng: &mut ChaCha8Rng, mesh: &mut Polygons) {
    let index = rng.random_range(0..mesh.faces.len());
    let face = mesh.faces[index].clone();
    if face.len() < 4 {
        return;
    }
    let end = rng.random_range(2..face.len() - 1);
    if mesh.edges().contains_key(&edge(face[0], face[end])) {
        return;
    }
    mesh.faces[index] = face[..=end].to_vec();
    let mut rest = face[end..].to_vec();
    rest.push(face[0]);
    mesh.faces.push(rest);
}

/// Cuts every polygon of more than four corners into triangles and quads at a new vertex.
fn cut_polygons(rng: &mut ChaCha8Rng, mesh: &mut Polygons) {
    for face in std::mem::take(&mut mesh.faces) {
        let count = face.len();
        if count <= 4 {
            mesh.faces.push(face);
            continue;
        }
        let mut start = 0;
        while start < count {
            let takes_two = start + 2 <= count && rng.random_range(0..2) == 0;
            let end = start + 1 + usize::from(takes_two);
            let mut part: Vec<u32> = (start..=end).map(|i| face[i % count]).collect();
            part.push(mesh.vertex_count);
            mesh.faces.push(part);
            start = end;
        }
        mesh.vertex_count += 1;
    }
}

/// Two faces and their common edge, if they have nothing else in common.
fn pair(rng: &mut ChaCha8Rng, mesh: &Polygons) -> Option<(usize, usize, u32, u32)> {
    let edges: Vec<_> = mesh.edges().into_iter().collect();
    let ([a, b], on) = &edges[rng.random_range(0..edges.len())];
    let [one, other] = on.as_slice() else {
        return None;
    };
    let set = |face: usize| mesh.faces[face].iter().copied().collect::<BTreeSet<u32>>();
    (set(*one).intersection(&set(*other)).count() == 2).then_some((*one, *other, *a, *b))
}

/// The corners of a face from the end of a side round to its start.
fn round(face: &[u32], a: u32, b: u32) -> Vec<u32> {
    let place = sides(face)
        .iter()
        .position(|side| *side == (a, b) || *side == (b, a))
        .unwrap_or_default();
    (1..=face.len())
        .map(|i| face[(place + i) % face.len()])
        .collect()
}

/// Takes an edge out, so that two faces become one of up to nine corners.
fn merge(rng: &mut ChaCha8Rng, mesh: &mut Polygons) {
    let Some((one, other, a, b)) = pair(rng, mesh) else {
        return;
    };
    let (first, second) = (
        round(&mesh.faces[one], a, b),
        round(&mesh.faces[other], a, b),
    );
    // No vertex may be left with a single edge pair that both merged faces share.
    let neighbours = mesh.neighbours();
    let lonely = |vertex: u32| neighbours[vertex as usize].len() < 4;
    if first.len() + second.len() > 11 || mesh.faces.len() < 5 || lonely(a) || lonely(b) {
        return;
    }
    let mut merged = first;
    merged.extend(&second[1..second.len() - 1]);
    mesh.faces[one] = merged;
    mesh.faces.swap_remove(other);
}

/// Swaps the diagonal of two triangles.
fn flip(rng: &mut ChaCha8Rng, mesh: &mut Polygons) {
    let Some((one, other, a, b)) = pair(rng, mesh) else {
        return;
    };
    let (first, second) = (
        round(&mesh.faces[one], a, b),
        round(&mesh.faces[other], a, b),
    );
    let neighbours = mesh.neighbours();
    let lonely = |vertex: u32| neighbours[vertex as usize].len() < 4;
    let taken = mesh.edges().contains_key(&edge(first[1], second[1]));
    if taken || lonely(a) || lonely(b) {
        return;
    }
    // `first` runs b', l, a' with the side a' b'; `second` runs a', r, b'.
    mesh.faces[one] = vec![first[0], first[1], second[1]];
    mesh.faces[other] = vec![second[0], second[1], first[1]];
}

/// Joins two vertices into one, or hangs a third face on an edge.
fn tangle(rng: &mut ChaCha8Rng, mesh: &mut Polygons) {
    let face = mesh.faces[rng.random_range(0..mesh.faces.len())].clone();
    let fin = mesh.vertex_count;
    mesh.vertex_count += 1;
    mesh.faces.push(vec![face[0], face[1], fin]);
    if rng.random_range(0..2) == 0 {
        // Touches the mesh at one vertex only.
        mesh.faces.push(vec![face[2], fin + 1, fin + 2]);
        mesh.vertex_count += 2;
    }
}

fn add_features(rng: &mut ChaCha8Rng, mesh: &mut Polygons) {
    let edges: Vec<[u32; 2]> = mesh.edges().into_keys().collect();
    let share = rng.random_range(0..4);
    for [a, b] in edges {
        if rng.random_range(0..8) < share {
            let turned = rng.random_range(0..2) == 0;
            mesh.creases.push(if turned { [b, a] } else { [a, b] });
        }
    }
    for vertex in 0..mesh.vertex_count {
        if rng.random_range(0..12) == 0 {
            mesh.corners.push(vertex);
        }
    }
}

/// Renumbers vertices, turns faces and reorders everything; sometimes leaves a vertex unused.
fn shuffle(rng: &mut ChaCha8Rng, mesh: &mut Polygons) {
    if rng.random_range(0..8) == 0 {
        mesh.vertex_count += 1;
    }
    let mut names: Vec<u32> = (0..mesh.vertex_count).collect();
    names.shuffle(rng);
    let name = |vertex: &mut u32| *vertex = names[*vertex as usize];
    mesh.faces.iter_mut().flatten().for_each(name);
    mesh.creases.iter_mut().flatten().for_each(name);
    mesh.corners.iter_mut().for_each(name);
    for face in &mut mesh.faces {
        let turn = rng.random_range(0..face.len());
        face.rotate_left(turn);
    }
    mesh.faces.shuffle(rng);
    mesh.creases.shuffle(rng);
}
