//! The uniform mesh: linear and smoothing mask, their composite, the basis function.

use std::collections::BTreeMap;

use num_traits::{One as _, Zero as _};
use octruss_host_tests::meshes::lattice;
use octruss_host_tests::rational::{BigRational, Row, null_space, ratio};
use octruss_host_tests::reference::{
    Boundary, LinearSplit, OCTAHEDRON_TIMES_48, Solid, TETRAHEDRON_TIMES_48, linear_masks, split,
};
use octruss_host_tests::subject::{Core, SCHEMES, Scheme as _};

/// Weights by the offset on the uniform mesh, whose points have even coordinate sums.
type Mask = BTreeMap<[i32; 3], BigRational>;

/// A piece of the uniform mesh, large enough that everything that the middle vertex reaches in
/// one level has all its cells.
struct Uniform {
    solid: Solid,
    linear: LinearSplit,
    middle: u32,
    /// Offset of each refined vertex from the middle one, in units of the refined mesh.
    offsets: Vec<[i32; 3]>,
}

impl Uniform {
    fn new() -> Self {
        let lattice = lattice([8; 3]);
        let linear = split(&lattice.solid);
        let twice_middle = [8; 3];
        let at = |parents: &[u32], factor: i32| {
            [0, 1, 2].map(|axis| {
                let points = parents
                    .iter()
                    .map(|parent| lattice.points[*parent as usize]);
                points.map(|point| point[axis]).sum::<i32>() * factor / 6 - twice_middle[axis]
            })
        };
        let old = (0..).take(lattice.solid.vertex_count);
        let mut offsets: Vec<_> = old.map(|vertex| at(&[vertex], 12)).collect();
        offsets.extend(linear.edges.iter().map(|ends| at(ends, 6)));
        offsets.extend(linear.octahedra.iter().map(|(corners, _)| at(corners, 2)));
        let middle = lattice
            .vertex_at([4; 3])
            .expect("the middle has an even sum");
        Self {
            solid: lattice.solid,
            linear,
            middle,
            offsets,
        }
    }

    /// The subdivision mask: what the middle vertex gives to the vertices of the next level.
    fn column(&self, rows: &[Row]) -> Mask {
        let entries = self.offsets.iter().zip(rows);
        entries
            .filter_map(|(offset, row)| Some((*offset, row.get(&self.middle)?.clone())))
            .collect()
    }
}

/// Figure 9 and equation (2): 1, 1/2 on the twelve permutations of (1, -1, 0, 0) (here the
/// nearest neighbours), 1/6 on the six of (1, 1, -1, -1) (the next nearest).
fn linear_mask() -> Mask {
    let mut mask = Mask::new();
    for x in -2..=2_i32 {
        for y in -2..=2_i32 {
            for z in -2..=2_i32 {
                let weight = match (x * x + y * y + z * z, (x + y + z) % 2) {
                    (0, _) => ratio(1, 1),
                    (2, _) => ratio(1, 2),
                    (4, 0) if x.abs().max(y.abs()).max(z.abs()) == 2 => ratio(1, 6),
                    _ => continue,
                };
                mask.insert([x, y, z], weight);
            }
        }
    }
    mask
}

/// The discrete convolution of the linear mask with itself, over 8.
fn composite_mask() -> Mask {
    let linear = linear_mask();
    let mut mask = Mask::new();
    for (one, first) in &linear {
        for (other, second) in &linear {
            let offset = [0, 1, 2].map(|axis| one[axis] + other[axis]);
            *mask.entry(offset).or_insert_with(BigRational::zero) += first * second * ratio(1, 8);
        }
    }
    mask
}

/// READINGS P1, "linear mask on the uniform mesh": 1; 1/2 on 12; 1/6 on 6.
#[test]
fn linear_mask_on_the_uniform_mesh() {
    let expected = linear_mask();
    let count = |weight: BigRational| expected.values().filter(|entry| **entry == weight).count();
    assert_eq!(
        [count(ratio(1, 1)), count(ratio(1, 2)), count(ratio(1, 6))],
        [1, 12, 6]
    );

    let uniform = Uniform::new();
    let (_, masks) = linear_masks(&uniform.solid).expect("a sound solid");
    let rows = masks.into_iter().map(|mask| {
        mask.into_iter()
            .map(|(vertex, weight, over)| (vertex, ratio(weight, over)))
            .collect()
    });
    assert_eq!(uniform.column(&rows.collect::<Vec<_>>()), expected);
}

/// The same of core, which never computes the linear split apart. Where every edge is a crease,
/// old vertices and midpoints stay where the split puts them; what is left are the centroids,
/// which [`composite_mask_is_the_square_of_the_linear_one`] settles.
#[test]
fn linear_mask_of_core_on_creases() {
    let uniform = Uniform::new();
    let creased = Solid {
        creases: uniform.solid.edges(),
        ..uniform.solid.clone()
    };
    let (_, rows) = Core.masks(&creased, Boundary::Interior);
    let mut column = uniform.column(&rows);
    let centroids =
        &uniform.offsets[uniform.linear.old_vertex_count + uniform.linear.edges.len()..];
    column.retain(|offset, _| !centroids.contains(offset));
    let mut expected = linear_mask();
    expected.retain(|_, weight| *weight != ratio(1, 6));
    assert_eq!(column, expected);
}

/// READINGS P1, "smoothing mask": 1/8 of the linear mask, exactly. Of the matrices in figure 5,
/// averaged over the eight tetrahedra and six octahedra at a vertex.
#[test]
fn smoothing_mask_is_an_eighth_of_the_linear_one() {
    let lattice = lattice([8; 3]);
    let middle = lattice
        .vertex_at([4; 3])
        .expect("the middle has an even sum");
    let mut mask = Mask::new();
    let mut cells = 0;
    for cell in lattice.solid.cells() {
        let Some(own) = cell.iter().position(|corner| *corner == middle) else {
            continue;
        };
        cells += 1;
        for (place, corner) in cell.iter().enumerate() {
            let weight = match cell.len() {
                4 => TETRAHEDRON_TIMES_48[own][place],
                _ => OCTAHEDRON_TIMES_48[own][place],
            };
            let offset = lattice.points[*corner as usize].map(|coordinate| coordinate - 4);
            *mask.entry(offset).or_insert_with(BigRational::zero) += ratio(weight as i64, 48 * 14);
        }
    }
    assert_eq!(cells, 14);
    let linear = linear_mask().into_iter();
    assert_eq!(
        mask,
        linear
            .map(|(offset, weight)| (offset, weight * ratio(1, 8)))
            .collect()
    );
}

/// READINGS P1: composite = m*m/8, 85 non-zeros, from 1/288 to 25/48.
#[test]
fn composite_mask_is_the_square_of_the_linear_one() {
    let expected = composite_mask();
    assert_eq!(expected.len(), 85);
    assert_eq!(expected.values().min(), Some(&ratio(1, 288)));
    assert_eq!(expected.values().max(), Some(&ratio(25, 48)));
    let uniform = Uniform::new();
    for scheme in SCHEMES {
        let (_, rows) = scheme.masks(&uniform.solid, Boundary::Interior);
        assert_eq!(uniform.column(&rows), expected, "{}", scheme.name());
    }
}

/// P3, example 3.1: the three layers of the basis function at the integers, times 774, on the
/// grid whose steps lead to the nearest neighbours (1, 1, 0), (1, 0, 1) and (0, 1, 1).
const BASIS_TIMES_774: [[[i64; 3]; 3]; 3] = [
    [[0, 0, 5], [0, 38, 38], [5, 38, 5]],
    [[0, 38, 38], [38, 288, 38], [38, 38, 0]],
    [[5, 38, 5], [38, 38, 0], [5, 0, 0]],
];

/// The values of the basis function at the vertices: the fixed vector, with sum one, of
/// `phi(b) = sum over a of mask(a) phi(2 b - a)`.
fn basis(mask: &Mask) -> Mask {
    let support: Vec<[i32; 3]> = mask.keys().copied().collect();
    let zero = BigRational::zero();
    let mut equations = Vec::new();
    for (place, at) in support.iter().enumerate() {
        let weight = |from: &[i32; 3]| {
            let offset = [0, 1, 2].map(|axis| 2 * at[axis] - from[axis]);
            mask.get(&offset).unwrap_or(&zero).clone()
        };
        let mut row: Vec<_> = support.iter().map(weight).collect();
        row[place] -= BigRational::one();
        equations.push(row);
    }
    let solutions = null_space(equations, support.len());
    assert_eq!(solutions.len(), 1, "one fixed vector up to scale");
    let total: BigRational = solutions[0].iter().sum();
    let values = solutions[0].iter().map(|value| value / &total);
    support
        .into_iter()
        .zip(values)
        .filter(|entry| !entry.1.is_zero())
        .collect()
}

/// READINGS P1, "basis function at the integers (P3 ex. 3.1)": 288, 38 x 12, 5 x 6 over 774;
/// moments 1/3 and -1/9.
#[test]
fn basis_function_at_the_integers() {
    let mut expected = Mask::new();
    let mut moments = BTreeMap::new();
    for (k, layer) in (-1..).zip(BASIS_TIMES_774) {
        for (i, line) in (-1..).zip(layer) {
            for (j, value) in (-1..).zip(line) {
                // i (1,1,0) + j (1,0,1) + k (0,1,1).
                let value = ratio(value, 774);
                let grid = [i, j, k];
                for one in 0..3 {
                    for other in one..3 {
                        let moment = &value * ratio(grid[one] * grid[other], 1);
                        *moments
                            .entry((one, other))
                            .or_insert_with(BigRational::zero) += moment;
                    }
                }
                if !value.is_zero() {
                    expected.insert([i + j, i + k, j + k].map(|x| x as i32), value);
                }
            }
        }
    }
    assert_eq!(expected.len(), 19);
    for ((one, other), moment) in moments {
        assert_eq!(
            moment,
            if one == other {
                ratio(1, 3)
            } else {
                ratio(-1, 9)
            }
        );
    }
    let uniform = Uniform::new();
    for scheme in SCHEMES {
        let (_, rows) = scheme.masks(&uniform.solid, Boundary::Interior);
        assert_eq!(basis(&uniform.column(&rows)), expected, "{}", scheme.name());
    }
}
