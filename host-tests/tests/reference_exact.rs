//! The f64 reference against exact rational arithmetic: its masks, its sums, its rounding, its
//! weights, its order.
//!
//! The rational rows here are written from the paper's fractions (1/16, 17/48, 3/8, 1/12,
//! 7/24) and from the rules' text, vertex by vertex, with no common denominators and no
//! limbs.

use std::collections::{BTreeMap, BTreeSet};

use num_bigint::BigInt;
use num_rational::BigRational;
use num_traits::{One as _, ToPrimitive as _, Zero as _};
use octruss_host_tests::random_mesh::{Limits, RefineCase};
use octruss_host_tests::random_table::{ApplyCase, RowSum};
use octruss_host_tests::reference::{
    Boundary, LinearSplit, LoopWeight, Solid, WEIGHT_UNIT, apply_absolute, apply_displacement,
    boundary_triangles, level_masks, refine, split, split_triangles,
};

type Row = BTreeMap<u32, BigRational>;

fn ratio(numerator: i64, denominator: i64) -> BigRational {
    BigRational::new(numerator.into(), denominator.into())
}

fn add(row: &mut Row, other: &Row, factor: &BigRational) {
    for (vertex, weight) in other {
        *row.entry(*vertex).or_insert_with(BigRational::zero) += weight * factor;
    }
}

fn mean(vertices: &[u32]) -> Row {
    vertices
        .iter()
        .map(|vertex| (*vertex, ratio(1, vertices.len() as i64)))
        .collect()
}

/// Triangles of a cell as sets: any three corners of which no two are opposite.
fn triangles(cell: &[u32]) -> Vec<BTreeSet<u32>> {
    let mut found = Vec::new();
    for a in 0..cell.len() {
        for b in a + 1..cell.len() {
            for c in b + 1..cell.len() {
                let is_face = cell.len() == 4 || (b - a != 3 && c - b != 3 && c - a != 3);
                if is_face {
                    found.push(BTreeSet::from([cell[a], cell[b], cell[c]]));
                }
            }
        }
    }
    found
}

struct Rational<'a> {
    solid: &'a Solid,
    linear: &'a LinearSplit,
    boundary: Boundary,
    /// Triangles with the surface rule: those of one cell only, and the sheets.
    surface: Vec<BTreeSet<u32>>,
}

impl<'a> Rational<'a> {
    fn new(solid: &'a Solid, linear: &'a LinearSplit, boundary: Boundary) -> Self {
        let mut count: BTreeMap<BTreeSet<u32>, usize> = BTreeMap::new();
        for face in solid.cells().flat_map(triangles) {
            *count.entry(face).or_default() += 1;
        }
        let single = count
            .into_iter()
            .filter(|entry| entry.1 == 1)
            .map(|entry| entry.0);
        let sheets = solid.sheets.iter().map(|sheet| BTreeSet::from(*sheet));
        Self {
            solid,
            linear,
            boundary,
            surface: single.chain(sheets).collect(),
        }
    }

    fn parents(&self, vertex: u32) -> Vec<u32> {
        let new = (vertex as usize).checked_sub(self.solid.vertex_count);
        match new {
            None => vec![vertex],
            Some(i) if i < self.linear.edges.len() => self.linear.edges[i].to_vec(),
            Some(i) => self.linear.octahedra[i - self.linear.edges.len()]
                .0
                .to_vec(),
        }
    }

    fn has_surface_rule(&self) -> bool {
        !matches!(self.boundary, Boundary::Interior | Boundary::Fixed)
    }

    fn row(&self, vertex: u32) -> Row {
        match *self.parents(vertex).as_slice() {
            [old] => self.old_vertex(old),
            [a, b] => self.edge(a, b),
            _ => self.interior(vertex),
        }
    }

    fn old_vertex(&self, vertex: u32) -> Row {
        let creases = self.solid.creases.iter().filter(|c| c.contains(&vertex));
        let ends = creases.flatten().filter(|end| **end != vertex);
        let ends: BTreeSet<u32> = ends.copied().collect();
        let ends: Vec<u32> = ends.into_iter().collect();
        let faces = self.surface.iter().filter(|face| face.contains(&vertex));
        let ring: BTreeSet<u32> = faces.flatten().copied().filter(|v| *v != vertex).collect();
        if self.solid.corners.contains(&vertex) || ends.len() > 2 {
            return mean(&[vertex]);
        }
        if self.boundary == Boundary::Fixed && !ring.is_empty() {
            return mean(&[vertex]);
        }
        if ends.len() == 2 {
            let mut row = Row::from([(vertex, ratio(6, 8))]);
            add(&mut row, &mean(&ends), &ratio(2, 8));
            return row;
        }
        if self.has_surface_rule() && !ring.is_empty() {
            let beta = beta(self.boundary, ring.len() as i64);
            let all = &beta * BigRational::from(BigInt::from(ring.len()));
            let mut row = Row::from([(vertex, BigRational::one() - all)]);
            row.extend(ring.into_iter().map(|other| (other, beta.clone())));
            return row;
        }
        self.interior(vertex)
    }

    fn edge(&self, a: u32, b: u32) -> Row {
        let ends = BTreeSet::from([a, b]);
        let is_crease = self
            .solid
            .creases
            .iter()
            .any(|c| BTreeSet::from(*c) == ends);
        let faces = self.surface.iter().filter(|face| ends.is_subset(face));
        let opposite: Vec<u32> = faces.flat_map(|face| face - &ends).collect();
        if is_crease || (self.boundary == Boundary::Fixed && !opposite.is_empty()) {
            return mean(&[a, b]);
        }
        if self.has_surface_rule() && !opposite.is_empty() {
            let mut row = Row::from([(a, ratio(3, 8)), (b, ratio(3, 8))]);
            for vertex in &opposite {
                add(
                    &mut row,
                    &mean(&[*vertex]),
                    &ratio(1, 4 * opposite.len() as i64),
                );
            }
            return row;
        }
        let middle = self.linear.midpoint(a, b);
        self.interior(middle)
    }

    fn interior(&self, vertex: u32) -> Row {
        let mut row = Row::new();
        let cells = self
            .linear
            .solid
            .cells()
            .filter(|cell| cell.contains(&vertex));
        let cells: Vec<&[u32]> = cells.collect();
        if cells.is_empty() {
            return mean(&[vertex]);
        }
        for cell in &cells {
            let place = cell
                .iter()
                .position(|corner| *corner == vertex)
                .expect("it contains it");
            for (other_place, other) in cell.iter().enumerate() {
                let weight = match (cell.len(), place.abs_diff(other_place)) {
                    (4, 0) => ratio(-1, 16),
                    (4, _) => ratio(17, 48),
                    (_, 0) => ratio(3, 8),
                    (_, 3) => ratio(7, 24),
                    _ => ratio(1, 12),
                };
                add(&mut row, &mean(&self.parents(*other)), &weight);
            }
        }
        let mut divided = Row::new();
        add(&mut divided, &row, &ratio(1, cells.len() as i64));
        divided
    }
}

/// pi times 2^200, by Machin's formula, off by less than 2^16.
fn pi_times_2_200() -> BigInt {
    let arctangent_of_inverse = |x: i64| {
        let mut power: BigInt = (BigInt::one() << 200) / x;
        let mut sum = power.clone();
        for term in 1..100_i64 {
            power /= -(x * x);
            sum += &power / (2 * term + 1);
        }
        sum
    };
    4 * (4 * arctangent_of_inverse(5) - arctangent_of_inverse(239))
}

/// cos(2 pi / n) times 2^200 by its series; the error is far below 2^40.
fn cosine_times_2_200(n: i64) -> BigInt {
    let angle = 2 * pi_times_2_200() / n;
    let square = (&angle * &angle) >> 200;
    let mut term: BigInt = BigInt::one() << 200;
    let mut sum = term.clone();
    for k in 1..60_i64 {
        let product: BigInt = (&term * &square) >> 200;
        term = -product / ((2 * k - 1) * (2 * k));
        sum += &term;
    }
    sum
}

/// The boundary's vertex weight: exact where the numeric contract says so, else on the grid.
fn beta(boundary: Boundary, n: i64) -> BigRational {
    if boundary == Boundary::TriQuad || (boundary == Boundary::LoopWarren && n != 3) {
        return ratio(3, 8 * n);
    }
    if boundary == Boundary::LoopWarren {
        return ratio(3, 16);
    }
    let cosine = match n {
        1 => ratio(1, 1),
        2 => ratio(-1, 1),
        3 => ratio(-1, 2),
        4 => ratio(0, 1),
        6 => ratio(1, 2),
        _ => BigRational::new(cosine_times_2_200(n), BigInt::one() << 200),
    };
    let ring = ratio(3, 8) + cosine / BigInt::from(4);
    let exact = (ratio(5, 8) - &ring * &ring) / BigInt::from(n);
    if [1, 2, 3, 4, 6].contains(&n) {
        return exact;
    }
    let unit = BigInt::one() << 30;
    let scaled = exact * &unit;
    // The series is good to far more than the 2^-100 that this asks for.
    let shifted: BigRational = &scaled + ratio(1, 2);
    let from_tie = shifted.fract();
    let room = BigRational::new(BigInt::one(), BigInt::one() << 100);
    assert!(from_tie > room && BigRational::one() - &from_tie > room);
    BigRational::new(shifted.floor().to_integer(), unit)
}

fn rounded(value: &BigRational) -> i128 {
    (value + ratio(1, 2))
        .floor()
        .to_integer()
        .to_i128()
        .expect("a small number")
}

/// READINGS P1 and the numeric contract: Loop's weights. The rational ones are worked out
/// by hand from (1/n)(5/8 - (3/8 + cos/4)^2).
#[test]
fn vertex_weights_are_the_named_families() {
    let weight = |boundary, n: i64| {
        let weight = LoopWeight::new(boundary, n as usize).expect("a surface rule");
        assert_eq!(weight.own + n as f64 * weight.neighbour, weight.denominator);
        ratio(weight.neighbour as i64, weight.denominator as i64)
    };
    for (n, expected) in [
        (1, ratio(15, 64)),
        (2, ratio(39, 128)),
        (3, ratio(3, 16)),
        (4, ratio(31, 256)),
    ] {
        assert_eq!(weight(Boundary::Loop, n), expected);
    }
    assert_eq!(weight(Boundary::Loop, 6), ratio(1, 16));
    for n in 1..=300 {
        for boundary in [Boundary::Loop, Boundary::LoopWarren, Boundary::TriQuad] {
            assert_eq!(weight(boundary, n), beta(boundary, n), "{boundary:?} {n}");
        }
    }
    assert_eq!(
        LoopWeight::new(Boundary::Loop, 5)
            .expect("a rule")
            .denominator,
        WEIGHT_UNIT
    );
}

/// The masks behind the f64 sums are the paper's, and the sums are those masks times the
/// coordinates rounded once, for every boundary choice and both ends of the range.
#[test]
fn masks_and_sums_are_exact() {
    let limits = Limits {
        cells: 4,
        vertices: 300,
        levels: 2,
        sheets: true,
    };
    let mut rows = 0;
    for seed in 0..40 {
        let case = RefineCase::new(seed, &limits);
        let refined = refine(&case.solid, &case.points, case.boundary).expect("a sound solid");
        rows += compare(&case.solid, &case.points, case.boundary);
        if case.levels == 2 && refined.solid.vertex_count < 40 {
            rows += compare(&refined.solid, &refined.points, case.boundary);
        }
    }
    println!("{rows} rows against rational arithmetic");
}

fn compare(solid: &Solid, points: &[[i32; 3]], boundary: Boundary) -> usize {
    let linear = split(solid);
    let rational = Rational::new(solid, &linear, boundary);
    let (mask_solid, masks) = level_masks(solid, boundary).expect("a sound solid");
    let refined = refine(solid, points, boundary).expect("a sound solid");
    assert_eq!(mask_solid, linear.solid);
    assert_eq!(refined.solid, linear.solid);
    for (vertex, mask) in (0..).zip(&masks) {
        let row = rational.row(vertex);
        let mask: Row = mask
            .iter()
            .map(|&(other, numerator, denominator)| (other, ratio(numerator, denominator)))
            .collect();
        assert_eq!(mask, row, "mask of vertex {vertex} of {solid:?}");
        assert!(row.values().all(|weight| *weight > BigRational::zero()));
        assert_eq!(row.values().sum::<BigRational>(), BigRational::one());
        let exact = [0, 1, 2].map(|channel| {
            let products = row.iter().map(|(other, weight)| {
                weight * BigRational::from(BigInt::from(points[*other as usize][channel]))
            });
            rounded(&products.sum())
        });
        assert_eq!(refined.points[vertex as usize].map(i128::from), exact);
    }
    // Positive weights that add up to one cannot leave the range.
    assert_eq!(refined.saturated, 0);
    masks.len()
}

/// The boundary that is found anew from the faces of each level consists of the children of
/// the triangles before, orientation included, and the order of vertices is as documented.
#[test]
fn boundaries_are_inherited_and_vertices_in_order() {
    for seed in 0..150 {
        let mut solid = RefineCase::new(seed, &Limits::default()).solid;
        let mut triangles = boundary_triangles(&solid);
        assert!(triangles.iter().all(|[a, b, c]| a < b && a < c));
        for _ in 0..2 {
            let linear = split(&solid);
            assert!(linear.edges.is_sorted_by(|one, next| one < next));
            assert!(linear.octahedra.is_sorted_by(|one, next| one < next));
            triangles = split_triangles(&triangles, |a, b| linear.midpoint(a, b));
            let least_first = |face: &[u32; 3]| {
                let place = (0..3).min_by_key(|i| face[*i]).expect("three corners");
                [face[place], face[(place + 1) % 3], face[(place + 2) % 3]]
            };
            let inherited: BTreeSet<_> = triangles.iter().map(least_first).collect();
            let anew: BTreeSet<_> = boundary_triangles(&linear.solid).into_iter().collect();
            assert_eq!(inherited, anew, "seed {seed}");
            assert_eq!(inherited.len(), triangles.len());
            solid = linear.solid;
        }
    }
}

/// Both forms of the table's apply against 128-bit integers.
#[test]
fn table_sums_are_exact() {
    let clamp = |value: i128| value.clamp(i32::MIN.into(), i32::MAX.into());
    let round = |sum: i128| (sum + (1 << 29)).div_euclid(1 << 30);
    let mut saturated_rows = 0;
    for seed in 0..400 {
        let sum = if seed % 2 == 0 {
            RowSum::One
        } else {
            RowSum::Any
        };
        let case = ApplyCase::<3>::new(seed, 40, 64, sum);
        let absolute = apply_absolute(&case.table, &case.pose).expect("a sound table");
        let displaced = apply_displacement(&case.table, &case.pose, &case.rest_pose, &case.rest)
            .expect("a sound table");
        let mut saturated = [0, 0];
        for row in 0..case.table.row_count() {
            for channel in 0..3 {
                let (mut at, mut moved) = (0, 0);
                for (point, weight) in case.table.row(row) {
                    let now = i128::from(case.pose[usize::from(point)][channel]);
                    let before = i128::from(case.rest_pose[usize::from(point)][channel]);
                    at += i128::from(weight) * now;
                    moved += i128::from(weight) * (now - before);
                }
                let exact = [
                    round(at),
                    i128::from(case.rest[row][channel]) + round(moved),
                ];
                let got = [
                    absolute.points[row][channel],
                    displaced.points[row][channel],
                ];
                assert_eq!(
                    got.map(i128::from),
                    exact.map(clamp),
                    "seed {seed} row {row}"
                );
                for (count, exact) in saturated.iter_mut().zip(exact) {
                    *count += usize::from(clamp(exact) != exact);
                }
            }
        }
        assert_eq!(
            [absolute.saturated, displaced.saturated],
            saturated,
            "seed {seed}"
        );
        saturated_rows += saturated[0] + saturated[1];
    }
    assert!(
        saturated_rows > 1000,
        "only {saturated_rows} coordinates saturate"
    );
}
