//! The health of a pose written again from its documentation, in integers of any length.
//!
//! Small tetrahedra are taken from the faces of cells: every corner of a prism or a hexahedron is a tetrahedron of the
//! corner and the three corners that share an edge with it, oriented by a cell of the unit's shape rather than by a
//! table.

use num_bigint::BigInt;
use num_traits::{Signed as _, ToPrimitive as _, Zero as _};

use crate::reference_mixed::Mesh;

/// What is told of a pose. Cells are shape (0 to 3) and place.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Told {
    /// Cells that fold.
    pub folded: Vec<[u32; 2]>,
    /// The least ratio with 16 fraction bits.
    pub least_ratio: i32,
    /// Its first cell.
    pub least: Option<[u32; 2]>,
    /// Tetrahedra that are not positive at rest.
    pub without_ratio: u32,
}

/// A unit prism's corners.
const PRISM: [[i32; 3]; 6] = [
    [0, 0, 0],
    [1, 0, 0],
    [0, 1, 0],
    [0, 0, 1],
    [1, 0, 1],
    [0, 1, 1],
];

/// A unit cube's corners.
const CUBE: [[i32; 3]; 8] = [
    [0, 0, 0],
    [1, 0, 0],
    [1, 1, 0],
    [0, 1, 0],
    [0, 0, 1],
    [1, 0, 1],
    [1, 1, 1],
    [0, 1, 1],
];

type Vector = [BigInt; 3];

fn determinant([a, b, c]: &[Vector; 3]) -> BigInt {
    let minor = |i: usize, j: usize| &b[i] * &c[j] - &b[j] * &c[i];
    &a[0] * minor(1, 2) - &a[1] * minor(0, 2) + &a[2] * minor(0, 1)
}

fn between(from: [i32; 3], to: [i32; 3]) -> Vector {
    [0, 1, 2].map(|axis| BigInt::from(i64::from(to[axis]) - i64::from(from[axis])))
}

/// The corners of a shape, each with its neighbours along edges, in a positive order.
fn corners(shape: &[[i32; 3]], is_edge: impl Fn(usize, usize) -> bool) -> Vec<[usize; 4]> {
    let all = 0..shape.len();
    all.clone()
        .map(|corner| {
            let mut near = all.clone().filter(|&other| is_edge(corner, other));
            let mut next = || near.next().expect("three edges meet at a corner");
            let [a, b, c] = [next(), next(), next()];
            let spokes = [a, b, c].map(|other| between(shape[corner], shape[other]));
            if determinant(&spokes).is_positive() {
                [corner, a, b, c]
            } else {
                [corner, b, a, c]
            }
        })
        .collect()
}

fn prism_corners() -> Vec<[usize; 4]> {
    corners(&PRISM, |a, b| a != b && (a / 3 == b / 3 || a % 3 == b % 3))
}

fn cube_corners() -> Vec<[usize; 4]> {
    corners(&CUBE, |a, b| {
        let steps = CUBE[a].iter().zip(&CUBE[b]).filter(|(a, b)| a != b);
        steps.count() == 1
    })
}

/// One determinant for each small tetrahedron of a cell.
fn determinants(cell: &[u32], corners: &[[usize; 4]], points: &[[i32; 3]]) -> Vec<BigInt> {
    let at = |corner: usize| points[cell[corner] as usize];
    let of =
        |&[from, a, b, c]: &[usize; 4]| determinant(&[a, b, c].map(|to| between(at(from), at(to))));
    corners.iter().map(of).collect()
}

/// The same of an octahedron: to each face, whose corners are one of each opposite pair, from six times the centroid.
fn octahedron(cell: &[u32; 6], points: &[[i32; 3]]) -> Vec<BigInt> {
    let at = |corner: usize| points[cell[corner] as usize].map(BigInt::from);
    let spoke = |corner: usize| {
        [0, 1, 2].map(|axis| {
            let sum: BigInt = (0..6).map(|other| at(other)[axis].clone()).sum();
            &at(corner)[axis] * 6 - sum
        })
    };
    (0..8)
        .map(|face: usize| {
            let [a, b, c] = [0, 1, 2].map(|pair| pair + 3 * (face >> pair & 1));
            // Corners 0, 2, 1 are counter-clockwise from outside, and every exchange with an opposite turns them.
            let is_turned = face.count_ones() % 2 == 1;
            let [second, third] = if is_turned { [b, c] } else { [c, b] };
            determinant(&[a, second, third].map(spoke))
        })
        .collect()
}

/// `floor(2^16 pose / rest + 1/2)`.
fn ratio(pose: &BigInt, rest: &BigInt) -> BigInt {
    let numerator: BigInt = (pose << 17_u32) + rest;
    let denominator: BigInt = rest * 2;
    let remainder = ((&numerator % &denominator) + &denominator) % &denominator;
    (numerator - remainder) / denominator
}

/// Looks at a pose.
pub fn health(mesh: &Mesh, rest: &[[i32; 3]], pose: &[[i32; 3]]) -> Told {
    let tetrahedron = vec![[0, 1, 2, 3]];
    let (prism, cube) = (prism_corners(), cube_corners());
    let mut cells: Vec<(u32, usize, [Vec<BigInt>; 2])> = Vec::new();
    for (place, cell) in mesh.tetrahedra.iter().enumerate() {
        cells.push((
            0,
            place,
            [rest, pose].map(|points| determinants(cell, &tetrahedron, points)),
        ));
    }
    for (place, cell) in mesh.octahedra.iter().enumerate() {
        cells.push((
            1,
            place,
            [rest, pose].map(|points| octahedron(cell, points)),
        ));
    }
    for (place, cell) in mesh.prisms.iter().enumerate() {
        cells.push((
            2,
            place,
            [rest, pose].map(|points| determinants(cell, &prism, points)),
        ));
    }
    for (place, cell) in mesh.hexahedra.iter().enumerate() {
        cells.push((
            3,
            place,
            [rest, pose].map(|points| determinants(cell, &cube, points)),
        ));
    }
    let mut told = Told {
        folded: Vec::new(),
        least_ratio: 4 << 16,
        least: None,
        without_ratio: 0,
    };
    for (shape, place, [rest, pose]) in cells {
        let name = [shape, u32::try_from(place).expect("a small mesh")];
        let sound = rest
            .iter()
            .zip(&pose)
            .filter(|(rest, _)| rest.is_positive());
        told.without_ratio +=
            u32::try_from(rest.len() - sound.clone().count()).expect("eight at most");
        if sound
            .clone()
            .any(|(_, pose)| pose.is_zero() || pose.is_negative())
        {
            told.folded.push(name);
        }
        let least = sound.map(|(rest, pose)| ratio(pose, rest)).min();
        // Below the range of 32 bits the end of the range stands for all.
        let least = least.map(|least| least.max(BigInt::from(i32::MIN)));
        if let Some(least) = least.filter(|least| *least < BigInt::from(told.least_ratio)) {
            told.least_ratio = least.to_i32().expect("within the range");
            told.least = Some(name);
        }
    }
    told
}
