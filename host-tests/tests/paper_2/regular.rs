//! The masks on the regular lattice, from the generating function (3.2).

use std::collections::BTreeMap;

use octruss::solid::box_spline::Boundary;
use octruss_host_tests::box_spline::{BoxSolid, masks};
use octruss_host_tests::meshes::lattice;
use octruss_host_tests::rational::{Row, ratio};

pub type Point = [i32; 3];

/// The three axes along which octahedra of the lattice have their diagonals.
pub const AXES: [usize; 3] = [0, 1, 2];

/// The four directions of the box spline whose major diagonals run along `axis`: the edges that
/// are not perpendicular to it. The fourth is the sum of the others, as (1,1,1) is.
fn directions(axis: usize) -> [Point; 4] {
    [[1, 1, 0], [1, -1, 0], [-1, 0, -1], [1, 0, -1]].map(|mut direction: Point| {
        direction.swap(0, axis);
        direction
    })
}

/// (3.2): 1/32 of the product of (1 + z^d)^2 over the directions, as coefficients over 32 by
/// offset from the centre, in units of the refined lattice.
pub fn generating_function(axis: usize) -> BTreeMap<Point, i64> {
    let directions = directions(axis);
    let add = |a: Point, b: Point| [0, 1, 2].map(|k| a[k] + b[k]);
    // Half the sum of all eight directions is the spline's centre.
    let centre = directions.into_iter().fold([0; 3], add);
    let mut polynomial = BTreeMap::from([(centre.map(|x| -x), 1)]);
    for direction in directions.into_iter().chain(directions) {
        let mut product = polynomial.clone();
        for (exponent, coefficient) in polynomial {
            *product.entry(add(exponent, direction)).or_insert(0) += coefficient;
        }
        polynomial = product;
    }
    polynomial
}

/// The row that a mask gives to the refined vertex at `fine` (in units of the refined lattice).
pub fn expected_row(mask: &BTreeMap<Point, i64>, over: i64, fine: Point, points: &[Point]) -> Row {
    let mut row = Row::new();
    for (vertex, point) in (0..).zip(points) {
        let offset = [0, 1, 2].map(|k| fine[k] - 2 * point[k]);
        if let Some(&weight) = mask.get(&offset) {
            row.insert(vertex, ratio(weight, over));
        }
    }
    row
}

/// For every refined vertex the old ones whose middle it is.
pub fn parents(level: &BoxSolid, refined: u32) -> Vec<Vec<u32>> {
    let mut parents = vec![Vec::new(); refined as usize];
    for vertex in 0..level.vertex_count {
        parents[vertex as usize] = vec![vertex];
    }
    let pairs = (0..level.vertex_count).flat_map(|a| (0..a).map(move |b| (a, b)));
    let mut is_edge = std::collections::BTreeSet::new();
    for cell in &level.tetrahedra {
        is_edge.extend(cell.iter().flat_map(|a| cell.map(|b| (*a, b))));
    }
    for cell in &level.octahedra {
        for (i, a) in cell.iter().enumerate() {
            let others = cell.iter().enumerate();
            is_edge.extend(
                others
                    .filter(|(k, _)| i % 3 != k % 3)
                    .map(|(_, b)| (*a, *b)),
            );
        }
    }
    let edges: Vec<_> = pairs.filter(|pair| is_edge.contains(pair)).collect();
    let midpoints = level.midpoints(&edges);
    for (&(a, b), midpoint) in edges.iter().zip(midpoints) {
        parents[midpoint as usize] = vec![a, b];
    }
    for (place, cell) in level.octahedra.iter().enumerate() {
        parents[level.centroid(place) as usize] = cell.to_vec();
    }
    parents
}

/// Twice the middle of some points: their place in units of the refined lattice.
pub fn fine_place(parents: &[u32], points: &[Point]) -> Point {
    let count = i32::try_from(parents.len()).expect("few parents");
    [0, 1, 2].map(|k| {
        let sum: i32 = parents.iter().map(|v| points[*v as usize][k]).sum();
        assert_eq!(2 * sum % count, 0, "a point of the lattice");
        2 * sum / count
    })
}

/// Whether a refined vertex lies inside: not all of its parents on one boundary triangle.
pub fn is_inside(level: &BoxSolid, parents: &[u32]) -> bool {
    !level
        .surface
        .iter()
        .any(|triangle| parents.iter().all(|parent| triangle.contains(parent)))
}

/// A piece of the lattice with all major diagonals along an axis, and its points.
pub fn along(axis: usize) -> (BoxSolid, Vec<Point>) {
    let lattice = lattice([4, 4, 4]);
    let at = |vertex: u32| lattice.points[vertex as usize];
    let direction = |a: Point, b: Point| [0, 1, 2].map(|k| (a[k] - b[k]).abs());
    let parallel = |delta: Point| (0..3).all(|k| (delta[k] == 0) == (k != axis));
    let sum = |a: Point, b: Point| [0, 1, 2].map(|k| a[k] + b[k]);
    let mut solid = BoxSolid {
        vertex_count: u32::try_from(lattice.points.len()).expect("few"),
        tetrahedra: lattice.solid.tetrahedra.clone(),
        octahedra: lattice.solid.octahedra.clone(),
        ..BoxSolid::default()
    };
    for cell in &solid.tetrahedra {
        let [a, b, c, d] = cell.map(at);
        let pairs = [[a, b, c, d], [a, c, b, d], [a, d, b, c]];
        let runs = pairs.map(|[p, q, r, s]| parallel(direction(sum(p, q), sum(r, s))));
        let pair = runs.iter().position(|run| *run).expect("one of three");
        solid
            .of_tetrahedra
            .push(u8::try_from(pair).expect("0, 1, 2"));
    }
    for cell in &solid.octahedra {
        let cell = cell.map(at);
        let pair = (0..3).find(|k| parallel(direction(cell[*k], cell[k + 3])));
        solid
            .of_octahedra
            .push(u8::try_from(pair.expect("one of three")).expect("0, 1, 2"));
    }
    solid.find_boundary().expect("a sound solid");
    (solid, lattice.points)
}

/// Holds every inner mask of a regular solid against coefficients, and says how many there were.
pub fn check_all(
    level: &BoxSolid,
    points: &[Point],
    mask: &BTreeMap<Point, i64>,
    over: i64,
) -> usize {
    let (next, rows) = masks(level, Boundary::Interior);
    let mut inside = 0;
    for (row, parents) in rows.iter().zip(parents(level, next.vertex_count)) {
        if is_inside(level, &parents) {
            let fine = fine_place(&parents, points);
            assert_eq!(*row, expected_row(mask, over, fine, points), "{parents:?}");
            inside += 1;
        }
    }
    inside
}

/// (3.3) to (3.6) are the generating function (3.2), for each of the three diagonals.
#[test]
fn regular_masks_are_the_generating_function() {
    for axis in AXES {
        let mask = generating_function(axis);
        assert_eq!(mask.len(), 65);
        assert_eq!(mask.values().sum::<i64>(), 8 * 32);
        assert_eq!(mask[&[0; 3]], 18);
        let (solid, points) = along(axis);
        // More inner vertices, edges and octahedra than one of each kind.
        assert!(check_all(&solid, &points, &mask, 32) > 50);
    }
}

/// The masks of figure A.1 (lost in the text) are the means of the three; the readings give
/// them over 96.
#[test]
fn averaged_masks_are_the_mean_of_the_three() {
    let mut mask = BTreeMap::new();
    for axis in AXES {
        for (offset, weight) in generating_function(axis) {
            *mask.entry(offset).or_insert(0) += weight;
        }
    }
    // The weights that the refined vertex at `fine` gives: to offsets from twice a lattice point,
    // whose coordinates have an even sum.
    let weights = |fine: Point| {
        let is_lattice = |offset: &Point| {
            let twice = [0, 1, 2].map(|k| fine[k] - offset[k]);
            twice.iter().all(|x| x % 2 == 0) && twice.iter().sum::<i32>() % 4 == 0
        };
        let chosen = mask.iter().filter(|(offset, _)| is_lattice(offset));
        let mut weights: Vec<i64> = chosen.map(|(_, weight)| *weight).collect();
        weights.sort_unstable();
        weights
    };
    let of_vertex = weights([0, 0, 0]);
    assert_eq!(of_vertex, [[1; 6].as_slice(), &[3; 12], &[54]].concat());
    assert_eq!(weights([0, 1, 1]), [2, 2, 2, 2, 8, 8, 8, 8, 28, 28]);
    assert_eq!(weights([0, 0, 2]), [16; 6]);

    let (mut solid, points) = along(0);
    solid.is_averaged = true;
    assert!(check_all(&solid, &points, &mask, 96) > 50);
}
