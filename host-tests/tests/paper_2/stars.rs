//! The neighbourhoods of extraordinary vertices and edges, and their subdivision matrices.

use octruss::solid::box_spline::Boundary;
use octruss_host_tests::box_spline::{BoxSolid, masks};
use octruss_host_tests::rational::{BigRational, Row, ratio, unit_row};
use octruss_host_tests::spectrum::{eigenvalue_magnitudes, to_matrix};

/// A square matrix of exact weights.
pub type Matrix = Vec<Vec<BigRational>>;

/// One split, whose result is the invariant neighbourhood (the paper's "2-ring").
fn split_once(solid: &BoxSolid) -> BoxSolid {
    masks(solid, Boundary::Interior).0
}

/// Tetrahedra (0, a, b, c) around vertex 0, whose neighbours form rings of `n` vertices between two
/// apices: 1 above, then `rings` rings, then the last vertex below. `diagonal` says the pair of
/// each. The second result lists the triangles.
pub fn vertex_star(
    n: u32,
    rings: u32,
    diagonal: impl Fn([u32; 3]) -> u8,
) -> (BoxSolid, Vec<[u32; 3]>) {
    let ring = |level: u32, place: u32| 2 + level * n + place % n;
    let (above, below) = (1, 2 + rings * n);
    let mut link = Vec::new();
    for i in 0..n {
        link.push([above, ring(0, i), ring(0, i + 1)]);
        for level in 0..rings - 1 {
            let next = level + 1;
            link.push([ring(level, i), ring(next, i), ring(level, i + 1)]);
            link.push([ring(level, i + 1), ring(next, i), ring(next, i + 1)]);
        }
        link.push([below, ring(rings - 1, i), ring(rings - 1, i + 1)]);
    }
    let mut solid = BoxSolid {
        vertex_count: below + 1,
        tetrahedra: link.iter().map(|&[a, b, c]| [0, a, b, c]).collect(),
        of_tetrahedra: link.iter().map(|triangle| diagonal(*triangle)).collect(),
        ..BoxSolid::default()
    };
    solid.find_boundary().expect("a sound solid");
    (solid, link)
}

/// `n` tetrahedra (0, 1, r, s) around the edge 0 1, all with the same pair.
pub fn edge_star(n: u32, diagonal: u8) -> BoxSolid {
    let ring = |place: u32| 2 + place % n;
    let mut solid = BoxSolid {
        vertex_count: 2 + n,
        tetrahedra: (0..n).map(|i| [0, 1, ring(i), ring(i + 1)]).collect(),
        of_tetrahedra: vec![diagonal; n as usize],
        ..BoxSolid::default()
    };
    solid.find_boundary().expect("a sound solid");
    solid
}

/// The weights of `rows` in the order of `columns`; every weight must have a column.
fn matrix(rows: impl IntoIterator<Item = Row>, columns: &[u32]) -> Matrix {
    let mut matrix = Vec::new();
    for row in rows {
        let weight = |column: &u32| row.get(column).cloned().unwrap_or_else(|| ratio(0, 1));
        let weights: Vec<_> = columns.iter().map(weight).collect();
        assert_eq!(
            weights.iter().sum::<BigRational>(),
            ratio(1, 1),
            "a weight has no column"
        );
        matrix.push(weights);
    }
    matrix
}

/// The subdivision matrix `S_v` of a vertex star over its split.
///
/// `order` names the vertices of the split: `[0, 0]` the middle, `[0, i]` the midpoint toward i,
/// `[i, i]` the outer vertex i, `[i, k]` the midpoint between two outer ones.
pub fn vertex_matrix(star: &BoxSolid, order: &[[u32; 2]]) -> Matrix {
    let level = split_once(star);
    let toward = |i: u32| star.midpoint(0, i);
    let columns: Vec<u32> = order
        .iter()
        .map(|&[a, b]| if a == b { a } else { star.midpoint(a, b) })
        .collect();
    let (_, rows) = masks(&level, Boundary::Interior);
    let row = |vertex: u32| rows[vertex as usize].clone();
    // One split nearer: outer vertices are where the midpoints toward them were.
    let rows = order.iter().map(|&[a, b]| match (a, b) {
        (0, 0) => row(0),
        (0, i) => row(level.midpoint(0, toward(i))),
        (i, k) if i == k => row(toward(i)),
        (i, k) => row(level.midpoint(toward(i), toward(k))),
    });
    matrix(rows, &columns)
}

/// All vertices of the split of a vertex star, for [`vertex_matrix`].
pub fn vertex_order(star: &BoxSolid, link: &[[u32; 3]]) -> Vec<[u32; 2]> {
    let mut outer: Vec<[u32; 2]> = link
        .iter()
        .flat_map(|&[a, b, c]| [[a, b], [b, c], [a, c]])
        .map(|[a, b]| [a.min(b), a.max(b)])
        .collect();
    outer.sort_unstable();
    outer.dedup();
    let ends = 1..star.vertex_count;
    let inner = std::iter::once([0, 0]).chain(ends.clone().map(|i| [0, i]));
    inner.chain(ends.map(|i| [i, i])).chain(outer).collect()
}

/// The subdivision matrix `S_e` of an edge star over its split, in the order of appendix B.2: the
/// middle of the edge, its two ends, the midpoints toward the ring from one end and from the
/// other, then outside by turns a ring vertex and the midpoint to the next.
pub fn edge_matrix(star: &BoxSolid) -> Matrix {
    let level = split_once(star);
    let ring: Vec<u32> = (2..star.vertex_count).collect();
    let following = ring.iter().copied().cycle().skip(1);
    let middle = star.midpoint(0, 1);
    let from = |end: u32| ring.iter().map(move |r| star.midpoint(end, *r));
    let mut columns = vec![middle, 0, 1];
    columns.extend(from(0).chain(from(1)));
    for (&r, s) in ring.iter().zip(following.clone()) {
        columns.extend([r, star.midpoint(r, s)]);
    }

    let (_, rows) = masks(&level, Boundary::Interior);
    let row = |vertex: u32| rows[vertex as usize].clone();
    let mut nearer = vec![row(middle)];
    nearer.extend([0, 1].map(|end| row(level.midpoint(middle, end))));
    nearer.extend(
        from(0)
            .chain(from(1))
            .map(|v| row(level.midpoint(middle, v))),
    );
    for (place, &r) in ring.iter().enumerate() {
        let (one, two) = (star.midpoint(0, r), star.midpoint(1, r));
        // The middle octahedron of tetrahedron i is octahedron i of the split.
        nearer.extend([row(level.midpoint(one, two)), row(level.centroid(place))]);
    }
    matrix(nearer, &columns)
}

/// A matrix that is printed row by row.
pub fn parse(text: &str) -> Matrix {
    let entry = |word: &str| match word.split_once('/') {
        None => ratio(word.parse().expect("an integer"), 1),
        Some((a, b)) => ratio(
            a.parse().expect("an integer"),
            b.parse().expect("an integer"),
        ),
    };
    let lines = text.lines().filter(|line| !line.is_empty());
    lines
        .map(|line| line.split_whitespace().map(entry).collect())
        .collect()
}

/// The eigenvalues, greatest first; all of these matrices' leading ones are real and positive.
///
/// They are those of the matrix plus one, less one, in turned coordinates: the outer blocks have
/// eigenvalue zero many times over and turn rings in circles, and the iteration would not end.
pub fn eigenvalues(matrix: &Matrix) -> Vec<f64> {
    let size = matrix.len();
    let moved = to_matrix(matrix) + nalgebra::DMatrix::identity(size, size);
    let turn = nalgebra::DMatrix::from_fn(size, size, |i, k| ((i * size + k + 1) as f64).sin());
    let turn = turn.qr().q();
    let values = eigenvalue_magnitudes(&(turn.transpose() * moved * &turn)).into_iter();
    values.map(|value| value - 1.0).collect()
}

/// A row of one vertex alone, to compare with.
#[test]
fn a_corner_keeps_its_row() {
    let mut star = edge_star(3, 0);
    star.corners = vec![0];
    let (_, rows) = masks(&star, Boundary::Interior);
    assert_eq!(rows[0], unit_row(0));
}
