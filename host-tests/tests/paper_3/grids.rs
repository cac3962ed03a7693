//! Pieces of uniform and bi-uniform grids (section 4.4), in coordinates in which everything is
//! rational.
//!
//! The boundary between two grids is spanned by the thesis's vectors b1 = (1, 0) and b2 = (1/2,
//! sqrt(3)/2) where triangles touch it, and by unit vectors where quadrilaterals do. All coordinates
//! here are over b1, b2 and the unit vector across. In them the operators H of the quasi-interpolants
//! Q f = f - div H grad f are rational: an orthonormal diag(h, h, 1/6) becomes h times
//! ((4/3, -2/3), (-2/3, 4/3)) in the plane.

use std::collections::{BTreeMap, BTreeSet};

use num_rational::BigRational;
use octruss_host_tests::mixed_subject::ratio;
use octruss_host_tests::reference_mixed::Mesh;

/// A point of the grid: two indices along the boundary and a layer.
pub type Index = [i32; 3];

/// A position or a vector.
pub type Position = [BigRational; 3];

/// One side of a bi-uniform grid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// Tetrahedra and octahedra; triangles on the boundary.
    Toc,
    /// Prisms, their triangles on the boundary.
    PrismTriangles,
    /// Prisms, their quadrilaterals on the boundary, triangle edges along b1.
    PrismQuads,
    /// Hexahedra.
    Cubes,
}

impl Side {
    /// Where a layer's origin lies above the boundary's.
    fn shift(self) -> [BigRational; 2] {
        match self {
            Self::Toc => [ratio(1, 3), ratio(1, 3)],
            Self::PrismQuads => [ratio(-1, 2), ratio(0, 1)],
            Self::PrismTriangles | Self::Cubes => [ratio(0, 1), ratio(0, 1)],
        }
    }

    /// The symmetric matrix H: xx, xy, yy, zz. (All sides have xz = yz = 0.)
    pub fn quasi_interpolant(self) -> [BigRational; 4] {
        match self {
            // 1/9 in the plane.
            Self::Toc => [ratio(4, 27), ratio(-2, 27), ratio(4, 27), ratio(1, 6)],
            // 1/8 in the plane.
            Self::PrismTriangles => [ratio(1, 6), ratio(-1, 12), ratio(1, 6), ratio(1, 6)],
            Self::PrismQuads => [ratio(1, 8), ratio(0, 1), ratio(1, 6), ratio(1, 6)],
            Self::Cubes => [ratio(1, 6), ratio(0, 1), ratio(1, 6), ratio(1, 6)],
        }
    }

    /// Adds the cells of the unit cube at an index.
    fn fill(self, mesh: &mut Mesh, vertex: &mut impl FnMut(Index) -> u32, [i, j, k]: Index) {
        let mut at = |[x, y, z]: Index| vertex([i + x, j + y, k + z]);
        match self {
            Self::Toc => {
                mesh.tetrahedra
                    .push([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]].map(&mut at));
                mesh.tetrahedra
                    .push([[1, 1, 1], [0, 1, 1], [1, 0, 1], [1, 1, 0]].map(&mut at));
                let corners = [
                    [1, 0, 0],
                    [0, 1, 0],
                    [0, 0, 1],
                    [0, 1, 1],
                    [1, 0, 1],
                    [1, 1, 0],
                ];
                mesh.octahedra.push(corners.map(at));
            }
            Self::PrismTriangles => {
                // Triangles with edges b1, b2 and b1 - b2.
                for [a, b, c] in [[[0, 0], [1, 0], [0, 1]], [[1, 1], [0, 1], [1, 0]]] {
                    let corners = [(a, 0), (b, 0), (c, 0), (a, 1), (b, 1), (c, 1)];
                    mesh.prisms.push(corners.map(|([x, y], z)| at([x, y, z])));
                }
            }
            Self::PrismQuads => {
                // Triangles with edges along b1, the third vector and their sum.
                for [a, b, c] in [[[0, 0], [1, 0], [1, 1]], [[0, 0], [1, 1], [0, 1]]] {
                    let corners = [(a, 0), (b, 0), (c, 0), (a, 1), (b, 1), (c, 1)];
                    mesh.prisms.push(corners.map(|([x, z], y)| at([x, y, z])));
                }
            }
            Self::Cubes => {
                let ring = [[0, 0], [1, 0], [1, 1], [0, 1]];
                let corner = |place: usize| {
                    let [x, y] = ring[place % 4];
                    [x, y, (place / 4) as i32]
                };
                mesh.hexahedra
                    .push([0, 1, 2, 3, 4, 5, 6, 7].map(|place| at(corner(place))));
            }
        }
    }
}

/// A piece of a grid: cells between two sides of the boundary plane.
#[derive(Clone, Debug)]
pub struct Grid {
    pub mesh: Mesh,
    pub below: Side,
    pub above: Side,
    pub indices: Vec<Index>,
    pub vertices: BTreeMap<Index, u32>,
}

impl Grid {
    /// Cells with indices from `-reach` to `reach` along the boundary and `layers` on each side.
    pub fn new(below: Side, above: Side, reach: i32, layers: i32) -> Self {
        let mut grid = Self {
            mesh: Mesh::default(),
            below,
            above,
            indices: Vec::new(),
            vertices: BTreeMap::new(),
        };
        let mut mesh = Mesh::default();
        for k in -layers..layers {
            let side = if k < 0 { below } else { above };
            for i in -reach..reach {
                for j in -reach..reach {
                    side.fill(&mut mesh, &mut |index| grid.vertex(index), [i, j, k]);
                }
            }
        }
        mesh.vertex_count = grid.indices.len() as u32;
        grid.mesh = mesh;
        grid
    }

    fn vertex(&mut self, index: Index) -> u32 {
        let next = self.indices.len() as u32;
        let vertex = *self.vertices.entry(index).or_insert(next);
        if vertex == next {
            self.indices.push(index);
        }
        vertex
    }

    /// Where a point of the grid lies.
    pub fn position(&self, [i, j, k]: Index) -> Position {
        let side = if k < 0 { self.below } else { self.above };
        let [u, v] = side.shift();
        let layer = ratio(i64::from(k), 1);
        [
            ratio(i64::from(i), 1) + u * &layer,
            ratio(i64::from(j), 1) + v * &layer,
            layer,
        ]
    }

    /// The index of every refined vertex, on the grid of half the spacing: twice the mean of the
    /// indices of its parents.
    ///
    /// Indices of linear splits are affine images of positions on either side, so the mean of indices
    /// is the index of the mean.
    pub fn refined_indices(&self, count: u32) -> Vec<Index> {
        let names = octruss_host_tests::reference_mixed::Names::new(&self.mesh);
        let mut indices: Vec<Option<Index>> = vec![None; count as usize];
        for (index, slot) in self.indices.iter().zip(&mut indices) {
            *slot = Some(index.map(|coordinate| 2 * coordinate));
        }
        for (place, cell) in self.mesh.cells().iter().enumerate() {
            let lists = octruss_host_tests::reference_mixed::children(cell);
            let groups: BTreeSet<Vec<usize>> = lists.into_iter().flatten().collect();
            for group in groups {
                let parents: Vec<u32> = group.iter().map(|at| cell.corners[*at]).collect();
                let sum = parents.iter().fold([0; 3], |sum: Index, parent| {
                    let index = self.indices[*parent as usize];
                    [0, 1, 2].map(|axis| sum[axis] + index[axis])
                });
                let index = sum.map(|total| {
                    let twice = 2 * total;
                    assert_eq!(twice % group.len() as i32, 0, "on the grid");
                    twice / group.len() as i32
                });
                let vertex = names.vertex(&parents, place) as usize;
                assert!(indices[vertex].is_none_or(|other| other == index));
                indices[vertex] = Some(index);
            }
        }
        indices
            .into_iter()
            .map(|index| index.expect("every vertex has a cell"))
            .collect()
    }
}

/// Every pair of sides, with the name of its example in section 4.4.
pub const PAIRS: [(&str, Side, Side); 5] = [
    ("4.5", Side::PrismTriangles, Side::Toc),
    ("4.6", Side::PrismQuads, Side::Toc),
    ("4.7", Side::Cubes, Side::Toc),
    ("4.8", Side::Cubes, Side::PrismTriangles),
    ("4.6 (remark)", Side::Cubes, Side::PrismQuads),
];
