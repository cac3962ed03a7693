//! Random mixed solids from a seed: every pair of faces that can touch, covered and half-covered
//! quadrilaterals, boundaries, branches, creases and corners.
//!
//! A block of unit cubes is filled so that neighbours always fit: a face's diagonal is a function of
//! its axis and its place in the plane, the same in all layers. A cube stays a hexahedron, or is cut
//! into two prisms along an axis, or gets a centre with two tetrahedra on each face; two such cubes
//! side by side may share an octahedron in place of the four tetrahedra on the face between. Fans of
//! prisms with tetrahedra on top and hexahedra around bring edges of any valence. Then cells are
//! taken away at random. The solids are topological; their points are drawn apart from them.

use std::collections::{BTreeMap, BTreeSet};

use rand::RngExt as _;
use rand::seq::SliceRandom as _;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng as _;

use crate::reference_mixed::{Boundary, Mesh, find_boundary};

/// A mixed solid with its points.
#[derive(Clone, Debug)]
pub struct MixedCase {
    /// The seed that made it.
    pub seed: u64,
    /// Connectivity at level 0, with its boundary.
    pub mesh: Mesh,
    /// Points, raw bits.
    pub points: Vec<[i32; 3]>,
    /// What the surface follows.
    pub boundary: Boundary,
    /// How often to refine.
    pub levels: u32,
}

impl MixedCase {
    /// The case of a seed, with at most `cells` cells before any refinement. Three of four follow
    /// the surface's scheme.
    pub fn new(seed: u64, cells: usize) -> Self {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let mut mesh = match rng.random_range(0..4) {
            0 => fan(&mut rng),
            _ => block(&mut rng),
        };
        thin(&mut rng, &mut mesh, cells);
        let (mut mesh, _) = shuffled(&mut rng, mesh);
        find_boundary(&mut mesh);
        add_surfaces(&mut rng, &mut mesh);
        add_features(&mut rng, &mut mesh);
        let points = random_points(&mut rng, mesh.vertex_count);
        let boundary = match seed % 8 {
            6 => Boundary::Interior,
            7 => Boundary::Fixed,
            _ => Boundary::TriQuad,
        };
        // The second level multiplies cells by eight once more.
        let levels = if mesh.cell_count() <= 8 && rng.random_range(0..3) == 0 {
            2
        } else {
            1
        };
        Self {
            seed,
            mesh,
            points,
            boundary,
            levels,
        }
    }
}

/// A point of a block, in half units.
type Place = [i32; 3];

/// How a cube is filled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Filling {
    Hexahedron,
    Prisms(usize),
    Centre,
}

struct Block {
    mesh: Mesh,
    vertices: BTreeMap<Place, u32>,
    /// Whether the diagonal of a face runs from its least corner, by axis and place in the plane.
    diagonals: BTreeMap<(usize, i32, i32), bool>,
}

impl Block {
    fn vertex(&mut self, place: Place) -> u32 {
        let next = self.vertices.len() as u32;
        let vertex = *self.vertices.entry(place).or_insert(next);
        self.mesh.vertex_count = self.vertices.len() as u32;
        vertex
    }

    /// The four corners of a cube's face in cyclic order, starting with an end of its diagonal:
    /// counter-clockwise seen from the far end of the axis.
    fn face(&mut self, cube: Place, axis: usize, side: i32) -> [u32; 4] {
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        let key = (axis, cube[u], cube[v]);
        let is_first = self.diagonals.get(&key).copied().unwrap_or(true);
        let mut places = [[0, 0], [1, 0], [1, 1], [0, 1]].map(|[a, b]| {
            let mut place = cube.map(|coordinate| 2 * coordinate);
            place[axis] += 2 * side;
            place[u] += 2 * a;
            place[v] += 2 * b;
            place
        });
        if !is_first {
            places.rotate_left(1);
        }
        places.map(|place| self.vertex(place))
    }

    fn fill(&mut self, cube: Place, filling: Filling, shared: &BTreeSet<(Place, usize, i32)>) {
        match filling {
            Filling::Hexahedron => {
                let corners = [
                    [0, 0, 0],
                    [1, 0, 0],
                    [1, 1, 0],
                    [0, 1, 0],
                    [0, 0, 1],
                    [1, 0, 1],
                    [1, 1, 1],
                    [0, 1, 1],
                ];
                let cell = corners.map(|corner| {
                    self.vertex([0, 1, 2].map(|axis| 2 * (cube[axis] + corner[axis])))
                });
                self.mesh.hexahedra.push(cell);
            }
            Filling::Prisms(axis) => {
                let [a, b, c, d] = self.face(cube, axis, 0);
                let [e, f, g, h] = self.face(cube, axis, 1);
                self.mesh
                    .prisms
                    .extend([[a, b, c, e, f, g], [a, c, d, e, g, h]]);
            }
            Filling::Centre => {
                let centre = self.vertex(cube.map(|coordinate| 2 * coordinate + 1));
                for axis in 0..3 {
                    for side in 0..2 {
                        if shared.contains(&(cube, axis, side)) {
                            continue;
                        }
                        let [a, b, c, d] = self.face(cube, axis, side);
                        let two = match side {
                            0 => [[a, b, c, centre], [a, c, d, centre]],
                            _ => [[a, c, b, centre], [a, d, c, centre]],
                        };
                        self.mesh.tetrahedra.extend(two);
                    }
                }
            }
        }
    }
}

/// A block of up to four cubes.
fn block(rng: &mut ChaCha8Rng) -> Mesh {
    let sides: [i32; 3] = match rng.random_range(0..6) {
        0 => [1, 1, 1],
        1 => [1, 1, 3],
        2 => [2, 2, 1],
        3 => [1, 2, 2],
        _ => [2, 1, 1],
    };
    let mut block = Block {
        mesh: Mesh::default(),
        vertices: BTreeMap::new(),
        diagonals: BTreeMap::new(),
    };
    let mut cubes = Vec::new();
    for x in 0..sides[0] {
        for y in 0..sides[1] {
            for z in 0..sides[2] {
                let filling = match rng.random_range(0..6) {
                    0 | 1 => Filling::Hexahedron,
                    2 | 3 => Filling::Prisms(rng.random_range(0..3)),
                    _ => Filling::Centre,
                };
                cubes.push(([x, y, z], filling));
            }
        }
    }
    for axis in 0..3 {
        for a in 0..3 {
            for b in 0..3 {
                block.diagonals.insert((axis, a, b), rng.random());
            }
        }
    }
    let mut shared = BTreeSet::new();
    for (cube, filling) in &cubes {
        for axis in 0..3 {
            let mut next = *cube;
            next[axis] += 1;
            let are_centres = *filling == Filling::Centre && cubes.contains(&(next, *filling));
            if are_centres && rng.random() {
                shared.insert((*cube, axis, 1));
                shared.insert((next, axis, 0));
                let [a, b, c, d] = block.face(*cube, axis, 1);
                let below = block.vertex(cube.map(|coordinate| 2 * coordinate + 1));
                let above = block.vertex(next.map(|coordinate| 2 * coordinate + 1));
                block.mesh.octahedra.push([below, a, b, above, c, d]);
            }
        }
    }
    for (cube, filling) in cubes {
        block.fill(cube, filling, &shared);
    }
    block.mesh
}

/// Prisms around an axis, with tetrahedra on top that meet in an apex and hexahedra or prisms
/// outside; closed or open.
fn fan(rng: &mut ChaCha8Rng) -> Mesh {
    let count = rng.random_range(3..8_u32);
    let is_closed = rng.random();
    let around = if is_closed { count } else { count + 1 };
    // Two layers of a centre and a ring; an apex; two layers of an outer ring.
    let centre = |layer: u32| layer * (around + 1);
    let ring = |layer: u32, place: u32| layer * (around + 1) + 1 + place % around;
    let apex = 2 * (around + 1);
    let outer = |layer: u32, place: u32| apex + 1 + layer * around + place % around;
    let mut mesh = Mesh {
        vertex_count: apex + 1 + 2 * around,
        ..Mesh::default()
    };
    for place in 0..count {
        let next = place + 1;
        let side = |layer: u32| [centre(layer), ring(layer, place), ring(layer, next)];
        let ([a, b, c], [d, e, f]) = (side(0), side(1));
        mesh.prisms.push([a, b, c, d, e, f]);
        if rng.random_ratio(2, 3) {
            mesh.tetrahedra.push([d, e, f, apex]);
        }
        let out = |layer: u32| [outer(layer, place), outer(layer, next)];
        let ([p, q], [r, s]) = (out(0), out(1));
        match rng.random_range(0..4) {
            0 | 1 => mesh.hexahedra.push([b, p, q, c, e, r, s, f]),
            2 => mesh.prisms.extend([[b, p, q, e, r, s], [b, q, c, e, s, f]]),
            // Half of the side is covered by one tetrahedron.
            _ => mesh.tetrahedra.push([b, c, e, p]),
        }
    }
    mesh
}

/// Takes cells away at random until at most `cells` are left, and now and then a few more.
fn thin(rng: &mut ChaCha8Rng, mesh: &mut Mesh, cells: usize) {
    let more = if rng.random() {
        rng.random_range(0..4)
    } else {
        0
    };
    let count = mesh.cell_count();
    let wanted = cells.min(count.saturating_sub(more)).max(1);
    for _ in wanted..count {
        let lost = rng.random_range(0..mesh.cell_count());
        let before = mesh.tetrahedra.len();
        let second = before + mesh.octahedra.len();
        let third = second + mesh.prisms.len();
        match lost {
            place if place < before => drop(mesh.tetrahedra.swap_remove(place)),
            place if place < second => drop(mesh.octahedra.swap_remove(place - before)),
            place if place < third => drop(mesh.prisms.swap_remove(place - second)),
            place => drop(mesh.hexahedra.swap_remove(place - third)),
        }
    }
}

/// Unused vertices go (all but one, sometimes), the others and the cells change places. Returns the
/// cells and the new number of every vertex that one of them has.
pub fn shuffled(rng: &mut ChaCha8Rng, mesh: Mesh) -> (Mesh, BTreeMap<u32, u32>) {
    let used: BTreeSet<u32> = mesh
        .cells()
        .into_iter()
        .flat_map(|cell| cell.corners)
        .collect();
    let mut order: Vec<u32> = used.into_iter().collect();
    order.shuffle(rng);
    let numbers: BTreeMap<u32, u32> = order.iter().copied().zip(0..).collect();
    let number = |vertex: u32| numbers[&vertex];
    let mut next = Mesh {
        vertex_count: numbers.len() as u32 + u32::from(rng.random_ratio(1, 12)),
        tetrahedra: mesh
            .tetrahedra
            .iter()
            .map(|cell| cell.map(number))
            .collect(),
        octahedra: mesh.octahedra.iter().map(|cell| cell.map(number)).collect(),
        prisms: mesh.prisms.iter().map(|cell| cell.map(number)).collect(),
        hexahedra: mesh.hexahedra.iter().map(|cell| cell.map(number)).collect(),
        ..Mesh::default()
    };
    next.tetrahedra.shuffle(rng);
    next.octahedra.shuffle(rng);
    next.prisms.shuffle(rng);
    next.hexahedra.shuffle(rng);
    (next, numbers)
}

/// Now and then a face inside that follows the surface rule, or a sheet that no cell has.
fn add_surfaces(rng: &mut ChaCha8Rng, mesh: &mut Mesh) {
    if rng.random_ratio(1, 8)
        && let Some(&[a, b, c, d]) = mesh.tetrahedra.first()
    {
        let face = if rng.random() { [a, b, c] } else { [b, d, c] };
        let sorted = |face: [u32; 3]| BTreeSet::from(face);
        if mesh
            .triangles
            .iter()
            .all(|other| sorted(*other) != sorted(face))
        {
            mesh.triangles.push(face);
        }
    }
    if rng.random_ratio(1, 12) {
        let first = mesh.vertex_count;
        mesh.vertex_count += 2;
        match mesh.quads.first() {
            Some(&[a, b, _, _]) => mesh.quads.push([b, a, first, first + 1]),
            None => mesh
                .triangles
                .push([mesh.triangles[0][0], first, first + 1]),
        }
    }
}

/// Creases along edges of cells, repeated now and then, and corners.
fn add_features(rng: &mut ChaCha8Rng, mesh: &mut Mesh) {
    let mut edges = BTreeSet::new();
    for face in &mesh.triangles {
        edges.extend([[face[0], face[1]], [face[1], face[2]], [face[2], face[0]]]);
    }
    for cell in &mesh.tetrahedra {
        edges.extend([[cell[0], cell[1]], [cell[2], cell[3]]]);
    }
    for cell in &mesh.prisms {
        edges.extend([[cell[0], cell[3]], [cell[4], cell[5]]]);
    }
    for cell in &mesh.hexahedra {
        edges.extend([[cell[0], cell[1]], [cell[1], cell[2]], [cell[2], cell[6]]]);
    }
    let mut edges: Vec<[u32; 2]> = edges.into_iter().collect();
    edges.shuffle(rng);
    if rng.random() {
        let count = rng.random_range(0..edges.len().min(6) + 1);
        mesh.creases = edges[..count].to_vec();
        if let Some(&[a, b]) = mesh.creases.first()
            && rng.random()
        {
            mesh.creases.push([b, a]);
        }
    }
    if rng.random_ratio(1, 3) {
        mesh.corners.push(rng.random_range(0..mesh.vertex_count));
    }
}

/// Points of every size: small, all 32 bits, at the ends of the range.
pub fn random_points(rng: &mut ChaCha8Rng, count: u32) -> Vec<[i32; 3]> {
    let kind = rng.random_range(0..4);
    let mut coordinate = || match kind {
        0 => rng.random_range(-100..100),
        1 => rng.random_range(-100_000_000..100_000_000),
        2 => rng.random(),
        _ => [i32::MIN, i32::MAX, 0, 1, -1][rng.random_range(0..5)],
    };
    (0..count)
        .map(|_| [coordinate(), coordinate(), coordinate()])
        .collect()
}
