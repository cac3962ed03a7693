//! The meshes that the papers' figures belong to.

use crate::reference::Solid;

/// Vertices of the axis of a fan: its ends.
pub const FAN_AXIS: [u32; 2] = [0, 1];

/// `count` positive tetrahedra around the edge between vertices 0 and 1; their ring is
/// 2, 3, and so on.
///
/// A closed fan (three tetrahedra or more) has an interior edge, an open one has it on its
/// boundary.
pub fn fan(count: u32, closed: bool) -> Solid {
    let ring_length = if closed { count } else { count + 1 };
    let ring = |place: u32| 2 + place % ring_length;
    Solid {
        vertex_count: 2 + ring_length as usize,
        tetrahedra: (0..count).map(|i| [0, 1, ring(i), ring(i + 1)]).collect(),
        ..Solid::default()
    }
}

/// Two positive tetrahedra on the common face 0 1 2; the fourth corners are 3 and 4.
pub fn two_tetrahedra() -> Solid {
    Solid {
        vertex_count: 5,
        tetrahedra: vec![[0, 1, 2, 3], [0, 2, 1, 4]],
        ..Solid::default()
    }
}

/// A box cut from the uniform mesh, with its points.
#[derive(Clone, Debug)]
pub struct Lattice {
    /// Connectivity.
    pub solid: Solid,
    /// Integer points with an even coordinate sum: the nearest are the square root of two apart.
    pub points: Vec<[i32; 3]>,
}

impl Lattice {
    /// The vertex at a point.
    pub fn vertex_at(&self, point: [i32; 3]) -> Option<u32> {
        let place = self.points.binary_search(&point).ok()?;
        u32::try_from(place).ok()
    }
}

/// All cells of the uniform mesh within the box from the origin to `size`, positive.
///
/// The vertices are the points with an even coordinate sum; there is one tetrahedron in each
/// unit cube, and one octahedron around each inner point with an odd sum.
pub fn lattice(size: [i32; 3]) -> Lattice {
    let is_even = |point: &[i32; 3]| point.iter().sum::<i32>() % 2 == 0;
    let [points, others]: [Vec<_>; 2] = {
        let all = box_points(size);
        let (even, odd) = all.into_iter().partition(is_even);
        [even, odd]
    };
    let mut lattice = Lattice {
        solid: Solid::default(),
        points,
    };
    lattice.solid.vertex_count = lattice.points.len();
    for corner in box_points(size.map(|length| length - 1)) {
        let [x, y, z] = corner;
        // Even corners of a cube at an even point, and of one at an odd point: mirror images.
        let cell = if is_even(&corner) {
            [
                [x, y, z],
                [x, y + 1, z + 1],
                [x + 1, y, z + 1],
                [x + 1, y + 1, z],
            ]
        } else {
            [
                [x + 1, y, z],
                [x, y + 1, z],
                [x, y, z + 1],
                [x + 1, y + 1, z + 1],
            ]
        };
        let cell = cell.map(|point| lattice.vertex_at(point).expect("a corner in the box"));
        lattice.solid.tetrahedra.push(cell);
    }
    for [x, y, z] in others {
        let around = [
            [x + 1, y, z],
            [x, y, z + 1],
            [x, y + 1, z],
            [x - 1, y, z],
            [x, y, z - 1],
            [x, y - 1, z],
        ];
        let cell = around.map(|point| lattice.vertex_at(point));
        if let [Some(a), Some(b), Some(c), Some(d), Some(e), Some(f)] = cell {
            lattice.solid.octahedra.push([a, b, c, d, e, f]);
        }
    }
    lattice
}

/// All integer points from the origin to `size`, both included, in ascending order.
fn box_points(size: [i32; 3]) -> Vec<[i32; 3]> {
    let mut points = Vec::new();
    for x in 0..=size[0] {
        for y in 0..=size[1] {
            points.extend((0..=size[2]).map(|z| [x, y, z]));
        }
    }
    points
}

#[cfg(test)]
mod tests {
    use super::{fan, lattice};
    use crate::reference::boundary_triangles;

    /// Every tetrahedron positive, every octahedron as the middle one of a positive
    /// tetrahedron: its corners 0, 1, 2 turn the other way about its centre.
    #[test]
    fn lattice_cells_are_positive() {
        let lattice = lattice([3, 3, 4]);
        let at = |vertex: u32| lattice.points[vertex as usize];
        let determinant = |o: [i32; 3], corners: [[i32; 3]; 3]| {
            let [a, b, c] = corners.map(|p| [p[0] - o[0], p[1] - o[1], p[2] - o[2]]);
            a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0])
                + a[2] * (b[0] * c[1] - b[1] * c[0])
        };
        for cell in &lattice.solid.tetrahedra {
            let [o, a, b, c] = cell.map(at);
            assert_eq!(determinant(o, [a, b, c]), 2);
        }
        for cell in &lattice.solid.octahedra {
            let [a, b, c, d, ..] = cell.map(at);
            let centre = [0, 1, 2].map(|axis| (a[axis] + d[axis]) / 2);
            assert_eq!(determinant(centre, [a, b, c]), -1);
        }
        lattice.solid.check().expect("a sound solid");
    }

    #[test]
    fn fans_have_the_boundary_of_a_bipyramid() {
        for count in 3..=10 {
            assert_eq!(
                boundary_triangles(&fan(count, true)).len(),
                2 * count as usize
            );
            assert_eq!(
                boundary_triangles(&fan(count, false)).len(),
                2 * count as usize + 2
            );
        }
    }
}
