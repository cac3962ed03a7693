//! Names and numbers of the refined vertices, and the cells of the next level.

use std::collections::{BTreeMap, BTreeSet};

use super::faces::{Face, faces, sorted};
use super::{Cell, Class, Mesh};

/// Where a refined vertex comes from: how many parents, which, and, for a cell, its place.
type Name = (usize, Vec<u32>, usize);

/// The numbers of the refined vertices by their parents.
#[derive(Clone, Debug, Default)]
pub struct Names {
    numbers: BTreeMap<Name, u32>,
    /// Quadrilaterals on which a triangle of a cell lies, with the diagonal along which it does.
    touched: BTreeMap<Vec<u32>, Vec<u32>>,
    /// Those diagonals, with the least quadrilateral that is covered along each.
    covered: BTreeMap<Vec<u32>, Vec<u32>>,
    /// Triangles of cells.
    triangles: BTreeSet<Vec<u32>>,
    /// Number of refined vertices.
    pub count: u32,
}

impl Names {
    /// Names and numbers everything.
    pub fn new(mesh: &Mesh) -> Self {
        let cells = mesh.cells();
        let all: Vec<Face> = cells.iter().flat_map(faces).collect();
        let surface = mesh.quads.iter().map(|quad| Face {
            class: Class::Cube,
            cycle: quad.to_vec(),
            triangle_edges: Vec::new(),
        });
        let (mut quads, triangles): (Vec<Face>, Vec<Face>) =
            all.into_iter().partition(|face| face.cycle.len() == 4);
        quads.extend(surface);

        let mut names = Self {
            count: mesh.vertex_count,
            triangles: triangles.iter().map(Face::sorted).collect(),
            ..Self::default()
        };
        for quad in &quads {
            for triangle in triangles
                .iter()
                .filter(|face| quad.is_touched_by(&face.cycle))
            {
                let apex = quad.opposite(quad.free_corner(&triangle.cycle));
                let mut diagonal = triangle.sorted();
                diagonal.retain(|corner| Some(*corner) != apex);
                let least = names
                    .covered
                    .entry(diagonal.clone())
                    .or_insert(quad.sorted());
                *least = quad.sorted().min(least.clone());
                names.touched.insert(quad.sorted(), diagonal);
            }
        }
        names.number_all(mesh, &cells, &quads);
        names
    }

    fn number_all(&mut self, mesh: &Mesh, cells: &[Cell], quads: &[Face]) {
        let mut lines: BTreeSet<Vec<u32>> = cells.iter().flat_map(edges).collect();
        lines.extend(mesh.triangles.iter().flat_map(|face| cycle_edges(face)));
        lines.extend(mesh.quads.iter().flat_map(|face| cycle_edges(face)));
        lines.retain(|edge| !self.covered.contains_key(edge));
        let middles: BTreeSet<Vec<u32>> =
            quads.iter().map(|quad| self.owner(&quad.cycle)).collect();
        for edge in lines {
            self.push((2, edge, 0));
        }
        for middle in middles {
            self.push((4, middle, 0));
        }
        for count in [6, 8] {
            let with_centroid = cells
                .iter()
                .enumerate()
                .filter(|(_, cell)| cell.corners.len() == count && cell.class != Class::Pris);
            let centroids: BTreeSet<Name> = with_centroid
                .map(|(place, cell)| (count, sorted(&cell.corners), place))
                .collect();
            centroids.into_iter().for_each(|name| self.push(name));
        }
    }

    fn push(&mut self, name: Name) {
        self.numbers.insert(name, self.count);
        self.count += 1;
    }

    /// The quadrilateral in whose name a quadrilateral's middle stands.
    fn owner(&self, cycle: &[u32]) -> Vec<u32> {
        let own = sorted(cycle);
        match self.touched.get(&own) {
            Some(diagonal) => self.covered[diagonal].clone(),
            None => own,
        }
    }

    /// The vertex that is the mean of these vertices: one, the two of an edge, the four of a
    /// quadrilateral in any order, or all of the cell at this place.
    pub fn vertex(&self, parents: &[u32], place: usize) -> u32 {
        let name = match parents.len() {
            1 => return parents[0],
            2 => match self.covered.get(&sorted(parents)) {
                Some(owner) => (4, owner.clone(), 0),
                None => (2, sorted(parents), 0),
            },
            4 => (4, self.owner(parents), 0),
            count => (count, sorted(parents), place),
        };
        self.numbers[&name]
    }

    /// Diagonals along which triangles of cells cover quadrilaterals.
    pub fn covered_diagonals(&self) -> impl Iterator<Item = Vec<u32>> + '_ {
        self.covered.keys().cloned()
    }

    /// For a surface triangle that no cell has and that is half of a quadrilateral whose other half
    /// is covered: its corner off the diagonal.
    pub fn open_apex(&self, triangle: &[u32]) -> Option<u32> {
        let own = sorted(triangle);
        if self.triangles.contains(&own) {
            return None;
        }
        let half = self.touched.iter().find(|(quad, diagonal)| {
            own.iter().all(|corner| quad.contains(corner))
                && diagonal.iter().all(|corner| own.contains(corner))
        });
        half.map(|(_, diagonal)| {
            let apex = own.iter().find(|corner| !diagonal.contains(corner));
            *apex.expect("three corners, two on the diagonal")
        })
    }
}

/// The edges of a cell, each in ascending order.
fn edges(cell: &Cell) -> Vec<Vec<u32>> {
    faces(cell)
        .iter()
        .flat_map(|face| cycle_edges(&face.cycle))
        .collect()
}

/// The edges of a cycle, each in ascending order.
pub fn cycle_edges(cycle: &[u32]) -> Vec<Vec<u32>> {
    (0..cycle.len())
        .map(|place| sorted(&[cycle[place], cycle[(place + 1) % cycle.len()]]))
        .collect()
}

/// A small cell: for each of its corners the places of the parent's corners whose mean it is.
pub type Child = Vec<Vec<usize>>;

/// The small cells of a cell: those of four corners, those of six, and, for a hexahedron, those of
/// eight.
pub fn children(cell: &Cell) -> Vec<Child> {
    match (cell.class, cell.corners.len()) {
        (Class::Toc, 4) => {
            let mut all: Vec<Child> = (0..4)
                .map(|i| (0..4).map(|k| mean_of(i, k)).collect())
                .collect();
            let pairs = [[0, 1], [0, 2], [0, 3], [2, 3], [1, 3], [1, 2]];
            all.push(pairs.iter().map(|pair| pair.to_vec()).collect());
            all
        }
        (Class::Toc, _) => {
            let centroid: Vec<usize> = (0..6).collect();
            let whole = |a: usize, b: usize| match a.abs_diff(b) {
                3 => centroid.clone(),
                _ => mean_of(a, b),
            };
            let outward = [
                [0, 2, 1],
                [0, 1, 5],
                [0, 4, 2],
                [0, 5, 4],
                [3, 1, 2],
                [3, 5, 1],
                [3, 2, 4],
                [3, 4, 5],
            ];
            let mut all: Vec<Child> = outward
                .iter()
                .map(|&[a, b, c]| {
                    vec![
                        centroid.clone(),
                        mean_of(b, c),
                        mean_of(c, a),
                        mean_of(a, b),
                    ]
                })
                .collect();
            all.extend((0..6).map(|i| (0..6).map(|k| whole(i, k)).collect::<Child>()));
            all
        }
        (Class::Pris, _) => {
            let triangles = small_triangles();
            let mut all = Vec::new();
            for half in [0, 1] {
                for triangle in &triangles {
                    // A layer's vertex is over the same places of one or of both triangles.
                    let layer = |layer: usize| {
                        triangle.iter().map(move |places| {
                            let lower = places.iter().copied();
                            let upper = places.iter().map(|place| place + 3);
                            match layer {
                                0 => lower.collect(),
                                1 => lower.chain(upper).collect(),
                                _ => upper.collect(),
                            }
                        })
                    };
                    all.push(layer(half).chain(layer(half + 1)).collect());
                }
            }
            all
        }
        (Class::Cube, _) => (0..8)
            .map(|i| (0..8).map(|k| box_between(i, k)).collect())
            .collect(),
    }
}

/// One place, or the two places of an edge.
fn mean_of(a: usize, b: usize) -> Vec<usize> {
    if a == b { vec![a] } else { vec![a, b] }
}

/// The four small triangles of a triangle.
pub fn small_triangles() -> [[Vec<usize>; 3]; 4] {
    let [a, b, c] = [vec![0], vec![1], vec![2]];
    let [ab, bc, ca] = [vec![0, 1], vec![1, 2], vec![0, 2]];
    [
        [a, ab.clone(), ca.clone()],
        [ab.clone(), b, bc.clone()],
        [ca.clone(), bc.clone(), c],
        [ab, bc, ca],
    ]
}

/// The four small quadrilaterals of a quadrilateral.
pub fn small_quads() -> [[Vec<usize>; 4]; 4] {
    let [a, b, c, d] = [vec![0], vec![1], vec![2], vec![3]];
    let [ab, bc, cd, da] = [vec![0, 1], vec![1, 2], vec![2, 3], vec![0, 3]];
    let middle = vec![0, 1, 2, 3];
    [
        [a, ab.clone(), middle.clone(), da.clone()],
        [ab, b, bc.clone(), middle.clone()],
        [middle.clone(), bc, c, cd.clone()],
        [da, middle, cd, d],
    ]
}

/// All corners of a hexahedron in the smallest edge, face or cell that holds both corners.
fn box_between(a: usize, b: usize) -> Vec<usize> {
    let place = |corner: usize| {
        let x = usize::from(corner % 4 == 1 || corner % 4 == 2);
        [x, usize::from(corner % 4 >= 2), corner / 4]
    };
    let (from, to) = (place(a), place(b));
    (0..8)
        .filter(|corner| {
            let at = place(*corner);
            (0..3).all(|axis| at[axis] == from[axis] || at[axis] == to[axis])
        })
        .collect()
}

/// The next level's cells, surface, creases and corners.
pub fn split(mesh: &Mesh, names: &Names) -> Mesh {
    let mut next = Mesh {
        vertex_count: names.count,
        corners: mesh.corners.clone(),
        ..Mesh::default()
    };
    for (place, cell) in mesh.cells().iter().enumerate() {
        for child in children(cell) {
            let corners: Vec<u32> = child
                .iter()
                .map(|places| {
                    let parents: Vec<u32> = places.iter().map(|at| cell.corners[*at]).collect();
                    names.vertex(&parents, place)
                })
                .collect();
            match (cell.class, corners.len()) {
                (Class::Toc, 4) => next.tetrahedra.push(corners.try_into().expect("four")),
                (Class::Toc, _) => next.octahedra.push(corners.try_into().expect("six")),
                (Class::Pris, _) => next.prisms.push(corners.try_into().expect("six")),
                (Class::Cube, _) => next.hexahedra.push(corners.try_into().expect("eight")),
            }
        }
    }
    split_surface(mesh, names, &mut next);
    for &[a, b] in &mesh.creases {
        let middle = names.vertex(&[a, b], 0);
        next.creases.extend([[a, middle], [middle, b]]);
    }
    next
}

fn split_surface(mesh: &Mesh, names: &Names, next: &mut Mesh) {
    let numbers = |cycle: &[u32], places: &[usize]| {
        let parents: Vec<u32> = places.iter().map(|at| cycle[*at]).collect();
        names.vertex(&parents, 0)
    };
    for quad in &mesh.quads {
        for small in small_quads() {
            next.quads.push(small.map(|places| numbers(quad, &places)));
        }
    }
    for triangle in &mesh.triangles {
        match names.open_apex(triangle) {
            None => {
                for small in small_triangles() {
                    let corners = small.map(|places| numbers(triangle, &places));
                    next.triangles.push(corners);
                }
            }
            Some(apex) => {
                // What is open of the four small quadrilaterals under the triangle.
                let mut turned = *triangle;
                while turned[2] != apex {
                    turned.rotate_left(1);
                }
                let [a, b, c] = turned;
                let at = |parents: &[u32]| names.vertex(parents, 0);
                let (ab, bc, ca) = (at(&[a, b]), at(&[b, c]), at(&[c, a]));
                next.triangles.extend([[a, ab, ca], [ab, b, bc]]);
                next.quads.push([ca, ab, bc, c]);
            }
        }
    }
}
