//! Algorithm 2 with its queue and its set, and the faces that it leaves improper.

use std::collections::{BTreeMap, BTreeSet, VecDeque};

use super::solid::{Cells, edge_pair, pair, triple};

/// For every cell the cells that share a triangle with it, with those triangles.
fn adjacency(cells: &Cells) -> Vec<BTreeMap<usize, BTreeSet<[u32; 3]>>> {
    let mut owners: BTreeMap<[u32; 3], BTreeSet<usize>> = BTreeMap::new();
    for ([a, b, c], cell) in cells.faces() {
        owners.entry(triple(a, b, c)).or_default().insert(cell);
    }
    let mut adjacent = vec![BTreeMap::<_, BTreeSet<_>>::new(); count(cells)];
    for (face, sharing) in owners {
        for &one in &sharing {
            for &two in sharing.iter().filter(|two| **two != one) {
                adjacent[one].entry(two).or_default().insert(face);
            }
        }
    }
    adjacent
}

fn count(cells: &Cells) -> usize {
    cells.tetrahedra.len() + cells.octahedra.len()
}

fn is_tetrahedron(cells: &Cells, cell: usize) -> bool {
    cell < cells.tetrahedra.len()
}

/// The edge of a face that a cell uses with a diagonal: in a tetrahedron the one of its pair, in
/// an octahedron the one that a neighbouring tetrahedron with a parallel diagonal would use.
fn used_on(cells: &Cells, cell: usize, diagonal: u8, face: [u32; 3]) -> [u32; 2] {
    if is_tetrahedron(cells, cell) {
        let pairs = edge_pair(cells.tetrahedra[cell].0, diagonal);
        let on_face = |edge: &[u32; 2]| edge.iter().all(|end| face.contains(end));
        pairs.into_iter().find(on_face).expect("one edge of a pair")
    } else {
        let corners = cells.octahedra[cell - cells.tetrahedra.len()].0;
        let ends = [
            corners[usize::from(diagonal)],
            corners[usize::from(diagonal) + 3],
        ];
        let rest: Vec<u32> = face.into_iter().filter(|v| !ends.contains(v)).collect();
        pair(rest[0], rest[1])
    }
}

/// The edges that a cell would use: a tetrahedron's pair, the equator of an octahedron.
fn candidate(cells: &Cells, cell: usize, diagonal: u8) -> Vec<[u32; 2]> {
    if is_tetrahedron(cells, cell) {
        return edge_pair(cells.tetrahedra[cell].0, diagonal).to_vec();
    }
    let corners = cells.octahedra[cell - cells.tetrahedra.len()].0;
    let around: Vec<usize> = (0..6).filter(|k| k % 3 != usize::from(diagonal)).collect();
    let mut edges = Vec::new();
    for (place, &one) in around.iter().enumerate() {
        for &two in &around[place + 1..] {
            if two != one + 3 {
                edges.push(pair(corners[one], corners[two]));
            }
        }
    }
    edges
}

/// A major diagonal for every cell, tetrahedra first.
pub fn choose(cells: &Cells) -> Vec<u8> {
    let adjacent = adjacency(cells);
    let mut chosen: Vec<Option<u8>> = vec![None; count(cells)];
    while let Some(start) = chosen.iter().position(Option::is_none) {
        let mut queue = VecDeque::from([start]);
        while let Some(cell) = queue.pop_front() {
            if chosen[cell].is_some() {
                continue;
            }
            let mut used = BTreeSet::new();
            for (&other, shared) in &adjacent[cell] {
                match chosen[other] {
                    Some(diagonal) => {
                        used.extend(to_avoid(cells, cell, other, diagonal, shared));
                    }
                    None => queue.push_back(other),
                }
            }
            let conflicts = |diagonal: &u8| {
                let edges = candidate(cells, cell, *diagonal);
                edges.iter().filter(|edge| used.contains(*edge)).count()
            };
            chosen[cell] = (0..3).min_by_key(conflicts);
        }
    }
    chosen.into_iter().flatten().collect()
}

/// What a visited neighbour adds to the set of edges in use.
fn to_avoid(
    cells: &Cells,
    cell: usize,
    other: usize,
    diagonal: u8,
    shared: &BTreeSet<[u32; 3]>,
) -> Vec<[u32; 2]> {
    match (is_tetrahedron(cells, cell), is_tetrahedron(cells, other)) {
        (true, true) => candidate(cells, other, diagonal),
        (false, false) => shared
            .iter()
            .map(|face| used_on(cells, other, diagonal, *face))
            .collect(),
        _ => shared
            .iter()
            .flat_map(|&[a, b, c]| {
                let parallel = used_on(cells, other, diagonal, [a, b, c]);
                let edges = [pair(a, b), pair(b, c), pair(a, c)];
                edges.into_iter().filter(move |edge| *edge != parallel)
            })
            .collect(),
    }
}

/// The faces where the diagonals of two cells clash, ascending.
pub fn improper(cells: &Cells) -> Vec<[u32; 3]> {
    let diagonal = |cell: usize| {
        if is_tetrahedron(cells, cell) {
            cells.tetrahedra[cell].1
        } else {
            cells.octahedra[cell - cells.tetrahedra.len()].1
        }
    };
    let mut faces = BTreeSet::new();
    for (one, adjacent) in adjacency(cells).into_iter().enumerate() {
        for (two, shared) in adjacent {
            let alike = is_tetrahedron(cells, one) == is_tetrahedron(cells, two);
            faces.extend(shared.into_iter().filter(|face| {
                let mine = used_on(cells, one, diagonal(one), *face);
                let other = used_on(cells, two, diagonal(two), *face);
                (mine == other) == alike
            }));
        }
    }
    faces.into_iter().collect()
}
