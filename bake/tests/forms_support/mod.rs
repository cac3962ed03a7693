//! Closed meshes that the tests of forms and volumes share.

#![allow(dead_code, reason = "each test file uses some of the shapes")]

use std::collections::{BTreeMap, BTreeSet};

use num_bigint::BigInt;
use num_rational::BigRational;
use octruss_bake::forms::exact::Quadratic;

/// A mesh with integer points.
#[derive(Clone, Debug)]
pub struct Shape {
    pub points: Vec<[i64; 3]>,
    pub faces: Vec<Vec<u32>>,
}

impl Shape {
    pub fn real(&self) -> Vec<[f64; 3]> {
        let point = |point: &[i64; 3]| point.map(|c| f64::from(i32::try_from(c).unwrap()));
        self.points.iter().map(point).collect()
    }

    pub fn exact(&self) -> Vec<[Quadratic; 3]> {
        let number = |c| Quadratic::from(BigRational::from(BigInt::from(c)));
        self.points.iter().map(|point| point.map(number)).collect()
    }

    /// Every face cut into triangles from its first corner.
    pub fn triangulated(&self) -> Self {
        let fan = |face: &Vec<u32>| {
            let pairs = face[1..].windows(2);
            pairs
                .map(|pair| vec![face[0], pair[0], pair[1]])
                .collect::<Vec<_>>()
        };
        Self {
            points: self.points.clone(),
            faces: self.faces.iter().flat_map(fan).collect(),
        }
    }

    /// Moved by whole numbers, each point by its own, from a fixed sequence.
    pub fn shaken(&self, seed: u64, reach: i64) -> Self {
        let mut state = seed;
        let mut next = || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            i64::try_from(state >> 33).unwrap() % (2 * reach + 1) - reach
        };
        let mut points = self.points.clone();
        for point in &mut points {
            *point = point.map(|c| c + next());
        }
        Self {
            points,
            faces: self.faces.clone(),
        }
    }

    pub fn scaled(&self, factor: i64) -> Self {
        let mut scaled = self.clone();
        for point in &mut scaled.points {
            *point = point.map(|c| c * factor);
        }
        scaled
    }
}

/// The tetrahedron on four corners of the unit cube: edges of length sqrt 2.
pub fn tetrahedron() -> Shape {
    Shape {
        points: vec![[0, 0, 0], [1, 1, 0], [1, 0, 1], [0, 1, 1]],
        faces: vec![vec![0, 1, 2], vec![0, 2, 3], vec![0, 3, 1], vec![1, 3, 2]],
    }
}

/// The boundary of some unit cubes, given by their lowest corners; one quadrilateral for each
/// outer square.
pub fn cubes(cells: &[[i64; 3]]) -> Shape {
    let cells = cells.iter().copied().collect::<BTreeSet<_>>();
    let mut names = BTreeMap::new();
    let mut points = Vec::new();
    let mut faces = Vec::new();
    for cell in &cells {
        for axis in 0..3 {
            for side in [0, 1] {
                let mut beyond = *cell;
                beyond[axis] += 2 * side - 1;
                if cells.contains(&beyond) {
                    continue;
                }
                let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
                let mut square = [[0, 0], [1, 0], [1, 1], [0, 1]];
                if side == 0 {
                    square.reverse();
                }
                let face = square.map(|[a, b]| {
                    let mut corner = *cell;
                    corner[axis] += side;
                    corner[u] += a;
                    corner[v] += b;
                    *names.entry(corner).or_insert_with(|| {
                        points.push(corner);
                        u32::try_from(points.len() - 1).unwrap()
                    })
                });
                faces.push(face.to_vec());
            }
        }
    }
    Shape { points, faces }
}

/// A cube of 2^levels squares a side whose vertices were moved to the nearest of its corners
/// (halfway: the farther from the origin).
pub fn degenerate_cube(levels: u32) -> Shape {
    let side = 1_i64 << levels;
    let mut cells = Vec::new();
    for x in 0..side {
        for y in 0..side {
            for z in 0..side {
                cells.push([x, y, z]);
            }
        }
    }
    let mut shape = cubes(&cells);
    for point in &mut shape.points {
        *point = point.map(|c| i64::from(2 * c >= side));
    }
    shape
}

/// The surface of the tetrahedron with the corners 0 and the three units, each face cut into side^2
/// triangles, whose vertices were moved to the nearest of its corners (halfway: the first).
pub fn degenerate_tetrahedron(side: i64) -> Shape {
    let mut places: Vec<[i64; 4]> = Vec::new();
    let mut faces = Vec::new();
    // Outward faces of the tetrahedron, by corners.
    for corners in [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]] {
        let mut vertex = |i: i64, j: i64| {
            let mut place = [0; 4];
            for (corner, weight) in corners.into_iter().zip([side - i - j, i, j]) {
                place[corner] = weight;
            }
            let found = places.iter().position(|own| *own == place);
            let index = found.unwrap_or_else(|| {
                places.push(place);
                places.len() - 1
            });
            u32::try_from(index).unwrap()
        };
        for i in 0..side {
            for j in 0..side - i {
                faces.push(vec![vertex(i, j), vertex(i + 1, j), vertex(i, j + 1)]);
                if i + j + 1 < side {
                    faces.push(vec![
                        vertex(i + 1, j),
                        vertex(i + 1, j + 1),
                        vertex(i, j + 1),
                    ]);
                }
            }
        }
    }
    let nearest = |place: &[i64; 4]| {
        let corner = (0..4).rev().max_by_key(|&corner| place[corner]);
        [1, 2, 3].map(|k| i64::from(corner == Some(k)))
    };
    Shape {
        points: places.iter().map(nearest).collect(),
        faces,
    }
}
