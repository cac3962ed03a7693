//! Random solids from a seed: connectivity of every kind that refinement must get right.
//!
//! The solids are topological. Their points are drawn apart from them and need not make
//! cells positive, or even different from one another: refinement does not ask.

use std::collections::{BTreeMap, BTreeSet};

use rand::RngExt as _;
use rand::seq::{IndexedRandom as _, SliceRandom as _};
use rand_chacha::ChaCha8Rng;
pub use rand_chacha::rand_core::SeedableRng;

use crate::meshes::{fan, lattice};
use crate::reference::{Boundary, Counts, Solid, boundary_triangles};

/// How great a random solid may become.
#[derive(Clone, Copy, Debug)]
pub struct Limits {
    /// Most cells of the solid itself.
    pub cells: usize,
    /// Most vertices after all levels.
    pub vertices: usize,
    /// Most levels.
    pub levels: u32,
    /// Whether tagged triangles beside the boundary may occur.
    pub sheets: bool,
}

impl Default for Limits {
    /// What all runs use that do not say otherwise: six cells, three levels, 1000 vertices,
    /// everything that may occur.
    fn default() -> Self {
        Self {
            cells: 6,
            vertices: 1000,
            levels: 3,
            sheets: true,
        }
    }
}

/// One random case of refinement.
#[derive(Clone, Debug)]
pub struct RefineCase {
    /// The seed that made it.
    pub seed: u64,
    /// Connectivity at level 0.
    pub solid: Solid,
    /// Points at level 0, raw bits.
    pub points: Vec<[i32; 3]>,
    /// What the boundary follows.
    pub boundary: Boundary,
    /// How often to refine.
    pub levels: u32,
}

impl RefineCase {
    /// The case of a seed. Boundary choices take turns, so that equally many cases have each.
    pub fn new(seed: u64, limits: &Limits) -> Self {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let levels = rng.random_range(1..=limits.levels);
        let limits = Limits { levels, ..*limits };
        let solid = random_solid(&mut rng, &limits);
        let points = random_points(&mut rng, solid.vertex_count);
        let boundary = Boundary::ALL[(seed % 5) as usize];
        Self {
            seed,
            solid,
            points,
            boundary,
            levels,
        }
    }
}

/// A random solid with creases and corners, renumbered and reordered at random.
pub fn random_solid(rng: &mut ChaCha8Rng, limits: &Limits) -> Solid {
    // A vertex that no cell uses, and a triangle that no cell has, may come on top.
    let steps_of_an_edge = (1_usize << limits.levels) + 1;
    let reserve = 1 + steps_of_an_edge * (steps_of_an_edge + 1) / 2;
    let vertices = limits.vertices.saturating_sub(reserve);
    let mut growth = Growth {
        solid: Solid::default(),
        limits: Limits {
            vertices,
            ..*limits
        },
    };
    growth.start(rng);
    let steps = rng.random_range(0..=2 * limits.cells);
    for _ in 0..steps {
        match rng.random_range(0..24) {
            0..=9 => growth.glue_tetrahedron(rng),
            10..=15 => growth.glue_octahedron(rng),
            16..=17 => growth.close_gap(rng),
            18..=19 => growth.touch(rng, 1),
            20..=21 => growth.touch(rng, 2),
            22 => growth.touch(rng, 0),
            _ => growth.twin(rng),
        };
    }
    let mut solid = growth.solid;
    if rng.random_ratio(1, 10) {
        // A vertex that no cell uses.
        solid.vertex_count += 1;
    }
    if limits.sheets {
        add_sheets(rng, &mut solid);
    }
    add_features(rng, &mut solid);
    shuffle(rng, &solid)
}

/// A solid that grows cell by cell and never beyond its limits.
struct Growth {
    solid: Solid,
    limits: Limits,
}

impl Growth {
    /// A first piece of a random kind; a single tetrahedron if that would be too great.
    fn start(&mut self, rng: &mut ChaCha8Rng) {
        let piece = match rng.random_range(0..6) {
            0 => fan(1, false),
            1 => one_octahedron(),
            2 => fan(rng.random_range(3..=10), true),
            3 => fan(rng.random_range(2..=9), false),
            4 => star(rng),
            _ => lattice_piece(rng, self.limits.cells),
        };
        if !self.accept(piece) {
            self.accept(fan(1, false));
        }
    }

    /// Takes a new state over if it is within the limits and sound: no cell twice, and no
    /// triangle in more than two cells.
    fn accept(&mut self, solid: Solid) -> bool {
        let mut counts = Counts::of(&solid);
        // The first piece may be a fan of ten around an edge whatever the number of cells is.
        let cells = self.limits.cells.max(10);
        if counts.tetrahedra + counts.octahedra > cells {
            return false;
        }
        for _ in 0..self.limits.levels {
            counts = counts.after_split();
        }
        let is_good = counts.vertices <= self.limits.vertices && is_sound(&solid);
        if is_good {
            self.solid = solid;
        }
        is_good
    }

    fn has_room(&self) -> bool {
        self.solid.cells().count() < self.limits.cells
    }

    fn boundary_face(&self, rng: &mut ChaCha8Rng) -> Option<[u32; 3]> {
        boundary_triangles(&self.solid).choose(rng).copied()
    }

    /// A vertex for a new cell: mostly a new one, sometimes one that is there already.
    fn apex(rng: &mut ChaCha8Rng, solid: &mut Solid) -> u32 {
        if rng.random_ratio(1, 4) {
            return rng.random_range(0..solid.vertex_count as u32);
        }
        solid.vertex_count += 1;
        solid.vertex_count as u32 - 1
    }

    fn glue_tetrahedron(&mut self, rng: &mut ChaCha8Rng) -> bool {
        let Some([a, b, c]) = self.boundary_face(rng).filter(|_| self.has_room()) else {
            return false;
        };
        let mut solid = self.solid.clone();
        let apex = Self::apex(rng, &mut solid);
        solid.tetrahedra.push([a, b, c, apex]);
        self.accept(solid)
    }

    fn glue_octahedron(&mut self, rng: &mut ChaCha8Rng) -> bool {
        let Some([a, b, c]) = self.boundary_face(rng).filter(|_| self.has_room()) else {
            return false;
        };
        let mut solid = self.solid.clone();
        let [d, e, f] = [(); 3].map(|()| Self::apex(rng, &mut solid));
        // Its outward triangle 0 2 1 is a c b: the face from the other side.
        solid.octahedra.push([a, b, c, d, e, f]);
        self.accept(solid)
    }

    /// A tetrahedron between two boundary triangles that share an edge, with no new vertex.
    fn close_gap(&mut self, rng: &mut ChaCha8Rng) -> bool {
        let Some([a, b, c]) = self.boundary_face(rng).filter(|_| self.has_room()) else {
            return false;
        };
        let triangles = boundary_triangles(&self.solid);
        let beside = triangles.iter().filter(|triangle| {
            triangle
                .iter()
                .filter(|corner| [a, b, c].contains(corner))
                .count()
                == 2
        });
        let apexes: Vec<u32> = beside
            .flat_map(|triangle| triangle.iter().filter(|corner| ![a, b, c].contains(corner)))
            .copied()
            .collect();
        let Some(apex) = apexes.choose(rng) else {
            return false;
        };
        let mut solid = self.solid.clone();
        solid.tetrahedra.push([a, b, c, *apex]);
        self.accept(solid)
    }

    /// An octahedron with the corners of another, paired otherwise.
    fn twin(&mut self, rng: &mut ChaCha8Rng) -> bool {
        let octahedra = &self.solid.octahedra;
        let Some(&[a, b, c, d, e, f]) = octahedra.choose(rng).filter(|_| self.has_room()) else {
            return false;
        };
        let mut solid = self.solid.clone();
        solid.octahedra.push([a, b, c, e, d, f]);
        self.accept(solid)
    }

    /// A new cell that shares `shared` vertices (none, a vertex, an edge or a pair) and no
    /// triangle with the solid.
    fn touch(&mut self, rng: &mut ChaCha8Rng, shared: usize) -> bool {
        if !self.has_room() {
            return false;
        }
        let mut solid = self.solid.clone();
        let size = if rng.random_ratio(1, 3) { 6 } else { 4 };
        let mut corners: Vec<u32> = match (shared, solid.edges().choose(rng)) {
            (0, _) | (_, None) => Vec::new(),
            (1, Some(edge)) => vec![edge[0]],
            (_, Some(edge)) => edge.to_vec(),
        };
        while corners.len() < size {
            corners.push(solid.vertex_count as u32);
            solid.vertex_count += 1;
        }
        corners.shuffle(rng);
        match *corners.as_slice() {
            [a, b, c, d] => solid.tetrahedra.push([a, b, c, d]),
            [a, b, c, d, e, f] => solid.octahedra.push([a, b, c, d, e, f]),
            _ => return false,
        }
        self.accept(solid)
    }
}

fn is_sound(solid: &Solid) -> bool {
    if solid.check().is_err() {
        return false;
    }
    let mut cells = BTreeSet::new();
    let mut faces: BTreeMap<[u32; 3], usize> = BTreeMap::new();
    for cell in solid.cells() {
        let mut key = cell.to_vec();
        if let &[a, b, c, d, e, f] = cell {
            let mut pairs = [[a, d], [b, e], [c, f]].map(|[p, q]| [p.min(q), p.max(q)]);
            pairs.sort_unstable();
            key = pairs.concat();
        } else {
            key.sort_unstable();
        }
        if !cells.insert(key) {
            return false;
        }
        for (i, a) in cell.iter().enumerate() {
            for (k, b) in cell.iter().enumerate().skip(i + 1) {
                for (l, c) in cell.iter().enumerate().skip(k + 1) {
                    let opposite = |one: usize, other: usize| cell.len() == 6 && one + 3 == other;
                    if opposite(i, k) || opposite(k, l) || opposite(i, l) {
                        continue;
                    }
                    let mut face = [*a, *b, *c];
                    face.sort_unstable();
                    *faces.entry(face).or_default() += 1;
                }
            }
        }
    }
    faces.values().all(|count| *count <= 2)
}

fn one_octahedron() -> Solid {
    Solid {
        vertex_count: 6,
        octahedra: vec![[0, 1, 2, 3, 4, 5]],
        ..Solid::default()
    }
}

/// All the cells around an interior vertex: a random triangulated sphere joined to vertex 0.
fn star(rng: &mut ChaCha8Rng) -> Solid {
    let mut vertex_count = 5;
    let mut sphere: Vec<[u32; 3]> = vec![[1, 3, 2], [1, 2, 4], [1, 4, 3], [2, 3, 4]];
    for _ in 0..rng.random_range(0..3) {
        // A new vertex in a triangle, joined to its three corners.
        let place = rng.random_range(0..sphere.len());
        let [a, b, c] = sphere.swap_remove(place);
        sphere.extend([
            [a, b, vertex_count],
            [b, c, vertex_count],
            [c, a, vertex_count],
        ]);
        vertex_count += 1;
    }
    Solid {
        vertex_count: vertex_count as usize,
        tetrahedra: sphere.into_iter().map(|[a, b, c]| [0, a, b, c]).collect(),
        ..Solid::default()
    }
}

/// A few cells of the uniform mesh, each touching one before it.
fn lattice_piece(rng: &mut ChaCha8Rng, cells: usize) -> Solid {
    let whole = lattice([2, 2, 2]).solid;
    let mut left: Vec<Vec<u32>> = whole.cells().map(<[u32]>::to_vec).collect();
    left.shuffle(rng);
    let mut taken: Vec<Vec<u32>> = left.pop().into_iter().collect();
    let count = rng.random_range(1..=cells);
    while taken.len() < count {
        let touches = |cell: &Vec<u32>| {
            taken
                .iter()
                .any(|other| cell.iter().filter(|corner| other.contains(corner)).count() >= 3)
        };
        let Some(place) = left.iter().position(touches) else {
            break;
        };
        taken.push(left.swap_remove(place));
    }
    let mut names = BTreeMap::new();
    let mut solid = Solid::default();
    for cell in taken {
        let renamed: Vec<u32> = cell
            .iter()
            .map(|corner| {
                let next = names.len() as u32;
                *names.entry(*corner).or_insert(next)
            })
            .collect();
        match *renamed.as_slice() {
            [a, b, c, d] => solid.tetrahedra.push([a, b, c, d]),
            [a, b, c, d, e, f] => solid.octahedra.push([a, b, c, d, e, f]),
            _ => {}
        }
    }
    solid.vertex_count = names.len();
    solid
}

/// Tagged triangles: some between two cells, and some that no cell has.
fn add_sheets(rng: &mut ChaCha8Rng, solid: &mut Solid) {
    if rng.random_ratio(1, 6) {
        let boundary = boundary_triangles(solid);
        let shared = |cell: &[u32; 4]| {
            let mut triangle = [cell[1], cell[2], cell[3]];
            triangle.sort_unstable();
            let is_boundary = boundary.iter().any(|face| {
                let mut face = *face;
                face.sort_unstable();
                face == triangle
            });
            (!is_boundary).then_some(triangle)
        };
        let inside: BTreeSet<_> = solid.tetrahedra.iter().filter_map(shared).collect();
        solid.sheets.extend(inside);
    }
    if rng.random_ratio(1, 12) {
        // Hangs on an edge of the solid, or on a vertex, or on nothing.
        let old = solid.vertex_count as u32;
        let new = [old, old + 1, old + 2];
        let [a, b] = *solid.edges().choose(rng).unwrap_or(&[old, old + 1]);
        let (sheet, count) = match rng.random_range(0..3) {
            0 => ([a, b, old], 1),
            1 => ([a, old, old + 1], 2),
            _ => (new, 3),
        };
        solid.sheets.push(sheet);
        solid.vertex_count += count;
    }
}

/// Creases of every kind (paths, loops, single edges, inside and on the boundary) and corners.
fn add_features(rng: &mut ChaCha8Rng, solid: &mut Solid) {
    let edges = solid.edges();
    let triangles = boundary_triangles(solid);
    let mut creases: BTreeSet<[u32; 2]> = BTreeSet::new();
    let pair = |a: u32, b: u32| [a.min(b), a.max(b)];
    for _ in 0..rng.random_range(0..4) {
        match rng.random_range(0..3) {
            0 => creases.extend(edges.choose(rng)),
            1 => {
                if let Some(&[a, b, c]) = triangles.choose(rng) {
                    creases.extend([pair(a, b), pair(b, c), pair(c, a)]);
                }
            }
            _ => {
                let mut at = rng.random_range(0..solid.vertex_count as u32);
                for _ in 0..rng.random_range(2..6) {
                    let ways: Vec<_> = edges.iter().filter(|edge| edge.contains(&at)).collect();
                    let Some(&&[a, b]) = ways.choose(rng) else {
                        break;
                    };
                    creases.insert([a, b]);
                    at = if a == at { b } else { a };
                }
            }
        }
    }
    solid.creases = creases.into_iter().collect();
    if let Some(&twice) = solid.creases.choose(rng).filter(|_| rng.random_ratio(1, 8)) {
        solid.creases.push(twice);
    }
    if rng.random_bool(0.5) {
        let corners =
            (0..rng.random_range(1..4)).map(|_| rng.random_range(0..solid.vertex_count as u32));
        solid.corners = corners.collect::<BTreeSet<_>>().into_iter().collect();
    }
}

/// Renumbers vertices, reorders cells and features, and turns every cell.
///
/// In one of eight solids some cells are mirrored too, so that their triangles' orientations
/// contradict each other; no rule depends on orientation.
fn shuffle(rng: &mut ChaCha8Rng, solid: &Solid) -> Solid {
    let mut names: Vec<u32> = (0..solid.vertex_count as u32).collect();
    names.shuffle(rng);
    let rename = |vertex: u32| names[vertex as usize];
    let mirrors = rng.random_ratio(1, 8);
    let mut shuffled = Solid {
        vertex_count: solid.vertex_count,
        ..Solid::default()
    };
    for cell in &solid.tetrahedra {
        let mut cell = cell.map(rename);
        for _ in 0..rng.random_range(0..6) {
            // Two generators of the rotations of a tetrahedron.
            let [a, b, c, d] = cell;
            cell = if rng.random() {
                [a, c, d, b]
            } else {
                [b, c, a, d]
            };
        }
        if mirrors && rng.random() {
            cell.swap(0, 1);
        }
        shuffled.tetrahedra.push(cell);
    }
    for cell in &solid.octahedra {
        let mut cell = cell.map(rename);
        for _ in 0..rng.random_range(0..8) {
            // Quarter turns about two diagonals.
            let [a, b, c, d, e, f] = cell;
            cell = if rng.random() {
                [a, c, e, d, f, b]
            } else {
                [c, b, d, f, e, a]
            };
        }
        if mirrors && rng.random() {
            cell.swap(0, 3);
        }
        shuffled.octahedra.push(cell);
    }
    shuffled.sheets = solid.sheets.iter().map(|sheet| sheet.map(rename)).collect();
    for crease in &solid.creases {
        let [a, b] = crease.map(rename);
        shuffled
            .creases
            .push(if rng.random() { [a, b] } else { [b, a] });
    }
    shuffled.corners = solid.corners.iter().map(|corner| rename(*corner)).collect();
    shuffled.tetrahedra.shuffle(rng);
    shuffled.octahedra.shuffle(rng);
    shuffled.creases.shuffle(rng);
    shuffled.corners.shuffle(rng);
    shuffled
}

/// Random raw coordinates in one of several ranges, the same for all points.
pub fn random_points<const D: usize>(rng: &mut ChaCha8Rng, count: usize) -> Vec<[i32; D]> {
    let mode = rng.random_range(0..7);
    let constant: [i32; D] = std::array::from_fn(|_| rng.random());
    let mut points = Vec::with_capacity(count);
    for _ in 0..count {
        points.push(std::array::from_fn(|channel| match mode {
            0 => rng.random_range(-10..=10),
            1 => rng.random_range(-1_048_576..=1_048_576),
            2 | 3 => rng.random(),
            // Only the ends of the range.
            4 => {
                if rng.random() {
                    i32::MIN
                } else {
                    i32::MAX
                }
            }
            // Within a few units of one end.
            5 if channel % 2 == 0 => i32::MAX - rng.random_range(0..4),
            5 => i32::MIN + rng.random_range(0..4),
            // All points the same.
            _ => constant[channel],
        }));
    }
    points
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::{Limits, RefineCase};
    use crate::reference::{Counts, boundary_triangles, split};

    /// Every kind of solid that the module promises does occur, within the limits.
    #[test]
    fn every_kind_occurs() {
        let mut kinds: BTreeMap<&str, usize> = BTreeMap::new();
        for seed in 0..300 {
            let case = RefineCase::new(seed, &Limits::default());
            let mut solid = case.solid.clone();
            solid.check().expect("a sound solid");
            let mut note = |kind: &'static str, is_there: bool| {
                *kinds.entry(kind).or_default() += usize::from(is_there);
            };
            note("octahedra", !solid.octahedra.is_empty());
            note("sheets", !solid.sheets.is_empty());
            note("creases", !solid.creases.is_empty());
            note("corners", !solid.corners.is_empty());
            note("three levels", case.levels == 3);
            let triangles = boundary_triangles(&solid);
            let mut on_boundary = vec![false; solid.vertex_count];
            let mut sides: BTreeMap<[u32; 2], usize> = BTreeMap::new();
            for [a, b, c] in triangles {
                for [a, b] in [[a, b], [b, c], [c, a]] {
                    on_boundary[a as usize] = true;
                    *sides.entry([a.min(b), a.max(b)]).or_default() += 1;
                }
            }
            note("interior vertex", on_boundary.contains(&false));
            note(
                "interior edge",
                solid.edges().iter().any(|edge| !sides.contains_key(edge)),
            );
            note("non-manifold edge", sides.values().any(|count| *count > 2));
            let inner_crease = |crease: &[u32; 2]| {
                !sides.contains_key(&[crease[0].min(crease[1]), crease[0].max(crease[1])])
            };
            note("interior crease", solid.creases.iter().any(inner_crease));
            for _ in 0..case.levels {
                solid = split(&solid).solid;
            }
            assert!(solid.vertex_count <= Limits::default().vertices);
        }
        for (kind, count) in &kinds {
            assert!(*count >= 5, "{kind} occurs {count} times in 300 cases");
        }
    }

    #[test]
    fn counts_after_a_split_are_foretold() {
        for seed in 0..100 {
            let mut solid = RefineCase::new(seed, &Limits::default()).solid;
            solid.sheets.clear();
            solid.creases.clear();
            let refined = split(&solid).solid;
            assert_eq!(
                Counts::of(&solid).after_split(),
                Counts::of(&refined),
                "seed {seed}"
            );
        }
    }
}
