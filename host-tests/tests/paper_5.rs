//! Kobbelt, "sqrt(3)-Subdivision": every figure of the paper, from the crate's own masks.
//!
//! The figures come from the paper's formulas and tables; the masks from running the crate over
//! rows of exact fractions or of real numbers.

use std::collections::BTreeMap;

use nalgebra::DMatrix;
use num_bigint::BigInt;
use num_rational::BigRational;
use num_traits::{One as _, Zero as _};
use octruss::blend::{FixedBlend, NeighbourWeight};
use octruss::surface::sqrt3::multi_step::{Steps, between, own_weight, ring_position, ring_weight};
use octruss::surface::sqrt3::neighbour_weight;
use octruss_host_tests::reference_surface::{Border, Polygons, edge, sides};
use octruss_host_tests::surface_rows::{Row, Rows, identity};
use octruss_host_tests::surface_subject::{AdaptiveMemory, Scheme, refine, refine_bits};

fn ratio(numerator: i64, denominator: i64) -> BigRational {
    BigRational::new(numerator.into(), denominator.into())
}

fn real_rows() -> Rows<f64> {
    Rows {
        real: Some(|real| real),
    }
}

fn exact_rows() -> Rows<BigRational> {
    Rows { real: None }
}

/// `n` triangles around vertex 0; the ring is 1 to n.
fn fan(n: u32) -> Polygons {
    Polygons {
        vertex_count: n + 1,
        faces: (0..n).map(|i| vec![0, 1 + i, 1 + (i + 1) % n]).collect(),
        ..Polygons::default()
    }
}

/// The subdivision matrix (3) of a fan: vertex 0, then the new vertices between ring vertices
/// `i` and `i + 1`.
fn ring_matrix<T: Clone>(rows: &[Row<T>], n: u32) -> Vec<Row<T>> {
    let between = |i: u32| {
        let corners = [0, 1 + i, 1 + (i + 1) % n];
        let is_centre =
            |row: &&Row<T>| row.len() == 3 && corners.iter().all(|c| row.contains_key(c));
        rows[n as usize + 1..].iter().find(is_centre).cloned()
    };
    let centres = (0..n).map(|i| between(i).expect("a vertex in every triangle"));
    std::iter::once(rows[0].clone()).chain(centres).collect()
}

fn real_matrix(n: u32) -> DMatrix<f64> {
    let refined = refine(
        &mut real_rows(),
        Scheme::Sqrt3,
        Border::Spline,
        &fan(n),
        &identity(n + 1),
    );
    let rows = ring_matrix(&refined.expect("a fan").1, n);
    let size = n as usize + 1;
    DMatrix::from_fn(size, size, |i, j| {
        rows[i].get(&(j as u32)).copied().unwrap_or(0.0)
    })
}

fn exact_matrix(n: u32) -> Vec<Vec<BigRational>> {
    let refined = refine(
        &mut exact_rows(),
        Scheme::Sqrt3,
        Border::Spline,
        &fan(n),
        &identity(n + 1),
    );
    let rows = ring_matrix(&refined.expect("a fan").1, n);
    rows.iter()
        .map(|row| {
            (0..=n)
                .map(|j| row.get(&j).cloned().unwrap_or_else(BigRational::zero))
                .collect()
        })
        .collect()
}

fn alpha(n: u32) -> f64 {
    (4.0 - 2.0 * (std::f64::consts::TAU / f64::from(n)).cos()) / 9.0
}

/// (6) at the valences with a rational cosine.
fn exact_alpha(n: u32) -> BigRational {
    match n {
        3 => ratio(5, 9),
        4 => ratio(4, 9),
        6 => ratio(1, 3),
        _ => panic!("irrational"),
    }
}

/// (1), (2), (6): the ring's vertices are averaged, each with alpha/n; new vertices are means.
#[test]
fn rules_1_and_2() {
    for n in [3, 4, 6] {
        let matrix = exact_matrix(n);
        let alpha = exact_alpha(n);
        assert_eq!(matrix[0][0], BigRational::one() - &alpha);
        for (neighbour, row) in matrix[0].iter().zip(&matrix).skip(1) {
            assert_eq!(*neighbour, &alpha / ratio(i64::from(n), 1));
            let third = row.iter().filter(|w| **w == ratio(1, 3)).count();
            assert_eq!(third, 3);
        }
    }
    for n in (3..4097).filter(|n| ![3, 4, 6].contains(n)) {
        let NeighbourWeight::Irrational { bits, real } = neighbour_weight(n) else {
            panic!("valence {n} has an irrational weight");
        };
        let exact = alpha(n) / f64::from(n) * f64::from(1_u32 << 30);
        assert!((bits as f64 - exact).abs() <= 0.5 + 1e-6, "{n}");
        assert!((real * f64::from(1_u32 << 30) - exact).abs() < 1e-6, "{n}");
        // No valence comes so near a tie that double precision could round to the wrong side.
        assert!((exact - exact.floor() - 0.5).abs() > 1e-5, "{n}: {exact}");
    }
}

/// (4): the eigenvalues of two steps with the rotation taken back.
#[test]
fn eigenvalues_4() {
    for n in 3..13_u32 {
        let step = real_matrix(n);
        let twice = &step * &step;
        // After two steps the row of the new vertex by ring vertex i + 1 stands at i.
        let size = n as usize;
        let back = DMatrix::from_fn(size + 1, size + 1, |i, j| match i {
            0 => twice[(0, j)],
            _ => twice[((i + size - 2) % size + 1, j)],
        });
        let mut got: Vec<f64> = back
            .complex_eigenvalues()
            .iter()
            .map(|value| {
                assert!(value.im.abs() < 1e-7, "real eigenvalues");
                value.re
            })
            .collect();
        let turn = std::f64::consts::TAU / f64::from(n);
        let mut want: Vec<f64> = (1..n)
            .map(|k| (2.0 + 2.0 * (turn * f64::from(k)).cos()) / 9.0)
            .collect();
        want.push(1.0);
        want.push((2.0 - 3.0 * alpha(n)).powi(2) / 9.0);
        got.sort_by(f64::total_cmp);
        want.sort_by(f64::total_cmp);
        for (got, want) in got.iter().zip(&want) {
            assert!((got - want).abs() < 1e-7, "valence {n}: {got} {want}");
        }
    }
}

fn multiply(one: &[Vec<BigRational>], other: &[Vec<BigRational>]) -> Vec<Vec<BigRational>> {
    let size = one.len();
    (0..size)
        .map(|i| {
            (0..size)
                .map(|j| (0..size).map(|k| &one[i][k] * &other[k][j]).sum())
                .collect()
        })
        .collect()
}

fn power(base: &BigRational, exponent: u32) -> BigRational {
    (0..exponent).fold(BigRational::one(), |product, _| product * base)
}

fn fraction(weight: NeighbourWeight) -> BigRational {
    match weight {
        NeighbourWeight::Exact {
            numerator,
            denominator,
        } => ratio(numerator, denominator),
        NeighbourWeight::Irrational { bits, .. } => ratio(bits, 1 << 30),
    }
}

/// (7) and (8) against powers of (3), exactly, at the valences where the weights are rational; the
/// kernels' weights are these fractions, or within half of 2^-30 where the fraction is long.
#[test]
fn multi_step_7_and_8() {
    for n in [3, 4, 6] {
        let step = exact_matrix(n);
        let (alpha, valence) = (exact_alpha(n), ratio(i64::from(n), 1));
        let mut row = step.clone();
        for m in 1..12 {
            let rest = power(&(ratio(2, 3) - &alpha), m);
            let three = ratio(3, 1) * &alpha;
            let beta = (&three - &three * &rest) / (BigRational::one() + &three);
            let limit = &three / (BigRational::one() + &three);
            assert_eq!(row[0][0], BigRational::one() - &beta, "{n} {m}");
            assert!((1..=n as usize).all(|i| row[0][i] == &beta / &valence));
            // (8): the same from the vertex and its limit.
            let own = &rest + (BigRational::one() - &rest) * (BigRational::one() - &limit);
            assert_eq!(own, BigRational::one() - &beta);

            let half = ratio(1, 1 << 31);
            let got = fraction(ring_weight(n, Steps::Count(m)));
            let difference = &got - &beta / &valence;
            assert!(difference <= half && difference >= -half.clone());
            assert!(m > 4 || difference.is_zero(), "short fractions are exact");
            let difference = fraction(own_weight(n, m)) - &rest;
            assert!(difference <= half && difference >= -half.clone());
            assert_eq!(fraction(ring_weight(n, Steps::Limit)), &limit / &valence);
            row = multiply(&row, &step);
        }
    }
}

/// `2/3 - alpha_2` is zero, so (7) gives a third of each ring vertex after any number of steps: a short
/// fraction, exact although the powers of 9 in it outgrow 64 bits.
#[test]
fn valence_2_stays_exact_after_any_number_of_steps() {
    for m in 1..100 {
        assert_eq!(fraction(ring_weight(2, Steps::Count(m))), ratio(1, 3));
        assert!(fraction(own_weight(2, m)).is_zero());
    }
    assert!(fraction(ring_weight(2, Steps::Count(0))).is_zero());
}

/// (7) and (8) against level by level in device bits, within the bound that the module states.
#[test]
fn multi_step_is_within_its_bound_of_level_by_level() {
    for n in 3..10_u32 {
        for size in [5_i64, 1 << 20, 1 << 30] {
            let faces = (0..n).flat_map(|i| {
                let next = (i + 1) % n;
                [vec![i, next, n], vec![next, i, n + 1]]
            });
            let mesh = Polygons {
                vertex_count: n + 2,
                faces: faces.collect(),
                ..Polygons::default()
            };
            // Points from a linear congruential sequence.
            let mut state = 12345_i64 + i64::from(n);
            let mut next = || {
                state = (state * 1_103_515_245 + 12_345) % (1 << 31);
                (state % (2 * size) - size) as i32
            };
            let points: Vec<[i32; 3]> = (0..n + 2).map(|_| [next(), next(), next()]).collect();
            let ring = &points[..n as usize];
            let apex = points[n as usize];
            let mut memory = AdaptiveMemory::new(100, 20, 100, [0; 3]);
            let mut adaptive = memory
                .start::<FixedBlend<i32, 3>>(&mesh, &points)
                .expect("a bipyramid");
            let mut blend = FixedBlend::new();
            let limit = ring_position(&mut blend, &apex, ring, Steps::Limit);
            for m in 0..16 {
                let want = adaptive.position(&mut blend, n, m).expect("the apex");
                let by_ring = ring_position(&mut blend, &apex, ring, Steps::Count(m));
                let by_limit = between(&mut blend, &apex, &limit, n, m);
                let distance = 2.0 * size as f64;
                let grid = f64::from(n) / f64::from(1_u32 << 31) * (distance + 1.0);
                let bound = f64::from(m + 1) * (0.5 + grid);
                for axis in 0..3 {
                    let off = |value: i32| (f64::from(value) - f64::from(want[axis])).abs();
                    assert!(off(by_ring[axis]) <= bound, "{n} {m}");
                    assert!(off(by_limit[axis]) <= bound + 0.5 + grid, "{n} {m}");
                }
            }
        }
    }
}

/// Coefficients of a product of two masks.
fn convolve(one: &[i64], other: &[i64]) -> Vec<i64> {
    let mut product = vec![0; one.len() + other.len() - 1];
    for (i, a) in one.iter().enumerate() {
        for (j, b) in other.iter().enumerate() {
            product[i + j] += a * b;
        }
    }
    product
}

/// (9): two steps of an open mesh; its mask is (1 + z + z^2)^4 / 27.
#[test]
fn boundary_9() {
    let n = 6_u32;
    let blend = &mut exact_rows();
    let (once, rows) = refine(
        blend,
        Scheme::Sqrt3,
        Border::Spline,
        &fan(n),
        &identity(n + 1),
    )
    .expect("a fan");
    for vertex in 1..=n {
        let stays: Row<BigRational> = Row::from([(vertex, BigRational::one())]);
        assert_eq!(
            rows[vertex as usize], stays,
            "the first step keeps the boundary"
        );
    }
    let (twice, rows) = refine(blend, Scheme::Sqrt3, Border::Spline, &once, &rows).expect("odd");
    let line = [1, 1, 1];
    let square = convolve(&line, &line);
    let mask = convolve(&square, &square);
    assert_eq!(mask, [1, 4, 10, 16, 19, 16, 10, 4, 1]);

    // Walk the boundary: control vertex i stands at place 3 i.
    let rim: BTreeMap<u32, u32> = twice
        .faces
        .iter()
        .flat_map(|face| sides(face))
        .filter(|(a, b)| twice.edges()[&edge(*a, *b)].len() == 1)
        .collect();
    assert_eq!(rim.len() as u32, 3 * n);
    let mut vertex = 1;
    for place in 0..3 * i64::from(n) {
        let mut want: Row<BigRational> = Row::new();
        for control in 0..i64::from(n) {
            let around = 3 * i64::from(n);
            let offset = (place - 3 * control + 4).rem_euclid(around);
            if let Some(weight) = usize::try_from(offset).ok().and_then(|i| mask.get(i)) {
                want.insert(1 + control as u32, ratio(*weight, 27));
            }
        }
        assert_eq!(rows[vertex as usize], want, "place {place}");
        vertex = rim[&vertex];
    }
}

/// Faces of an icosahedron: 20, 60, 180, 540; an open mesh is 1-to-9 after two steps, its boundary
/// edges cut in three every second step.
#[test]
fn face_counts() {
    let mut mesh = icosahedron();
    let mut points = vec![[0; 3]; 12];
    for count in [20, 60, 180, 540] {
        assert_eq!(mesh.faces.len(), count);
        (mesh, points) =
            refine_bits(Scheme::Sqrt3, Border::Spline, &mesh, &points).expect("closed");
    }
    let mut open = icosahedron();
    open.faces.truncate(15);
    let mut points = vec![[0; 3]; 12];
    let rim = |mesh: &Polygons| mesh.edges().values().filter(|on| on.len() == 1).count();
    let first_rim = rim(&open);
    for (step, factor) in [(0, 1), (1, 1), (2, 3), (3, 3), (4, 9)] {
        assert_eq!(open.faces.len(), 15 * 3_usize.pow(step), "step {step}");
        assert_eq!(rim(&open), first_rim * factor, "step {step}");
        assert_eq!(open.odd, step % 2 == 1);
        (open, points) = refine_bits(Scheme::Sqrt3, Border::Spline, &open, &points).expect("open");
    }
}

fn icosahedron() -> Polygons {
    let ring = |i: u32| 1 + i % 5;
    let low = |i: u32| 6 + i % 5;
    let faces = (0..5).flat_map(|i| {
        [
            vec![0, ring(i), ring(i + 1)],
            vec![ring(i), low(i), ring(i + 1)],
            vec![ring(i + 1), low(i), low(i + 1)],
            vec![11, low(i + 1), low(i)],
        ]
    });
    Polygons {
        vertex_count: 12,
        faces: faces.collect(),
        ..Polygons::default()
    }
}

/// Points of the regular mesh within `radius` rings, by their two coordinates.
fn hexagon(radius: i64) -> Vec<[i64; 2]> {
    let all = (-radius..=radius).flat_map(|i| (-radius..=radius).map(move |j| [i, j]));
    all.filter(|[i, j]| (i - j).abs() <= radius).collect()
}

/// Two steps on the regular mesh as a map of the 6-ring to itself: the crate's masks at the points
/// of the finer mesh within six of its rings.
fn double_step(places: &[[i64; 2]]) -> DMatrix<f64> {
    let wide = hexagon(9);
    let number: BTreeMap<[i64; 2], u32> = wide.iter().copied().zip(0..).collect();
    let mut mesh = Polygons {
        vertex_count: wide.len() as u32,
        ..Polygons::default()
    };
    for [i, j] in &wide {
        for triangle in [
            [[*i, *j], [i + 1, *j], [i + 1, j + 1]],
            [[*i, *j], [i + 1, j + 1], [*i, j + 1]],
        ] {
            let corners: Option<Vec<u32>> =
                triangle.iter().map(|at| number.get(at).copied()).collect();
            mesh.faces.extend(corners);
        }
    }
    let blend = &mut exact_rows();
    let mut rows: Vec<Row<BigRational>> = identity(mesh.vertex_count);
    for _ in 0..2 {
        (mesh, rows) = refine(blend, Scheme::Sqrt3, Border::Spline, &mesh, &rows).expect("open");
    }
    // A mask's centre of mass is where its vertex lies: linear functions are reproduced.
    let mut by_place: BTreeMap<[i64; 2], &Row<BigRational>> = BTreeMap::new();
    for row in &rows {
        let axis = |axis: usize| -> BigRational {
            row.iter()
                .map(|(v, weight)| weight * BigInt::from(wide[*v as usize][axis]))
                .sum::<BigRational>()
                * BigInt::from(3)
        };
        let place = [axis(0), axis(1)];
        if place.iter().all(BigRational::is_integer) {
            let number = |value: &BigRational| i64::try_from(value.to_integer()).ok();
            if let (Some(i), Some(j)) = (number(&place[0]), number(&place[1])) {
                by_place.insert([i, j], row);
            }
        }
    }
    DMatrix::from_fn(places.len(), places.len(), |i, j| {
        let row = by_place[&places[i]];
        let weight = row.get(&number[&places[j]]).cloned();
        weight.map_or(0.0, |weight| {
            num_traits::ToPrimitive::to_f64(&weight).unwrap_or(f64::NAN)
        })
    })
}

/// The third differences (10) whose points all lie in the set.
fn third_differences(places: &[[i64; 2]]) -> DMatrix<f64> {
    let number: BTreeMap<[i64; 2], usize> = places.iter().copied().zip(0..).collect();
    let directions = [[1, 0], [0, 1]];
    let mut rows = Vec::new();
    for kinds in [[0, 0, 0], [0, 0, 1], [0, 1, 1], [1, 1, 1]] {
        for place in places {
            let mut row = BTreeMap::from([(*place, 1.0)]);
            for kind in kinds {
                let [di, dj] = directions[kind];
                let mut next = BTreeMap::new();
                for ([i, j], weight) in row {
                    *next.entry([i + di, j + dj]).or_insert(0.0) += weight;
                    *next.entry([i, j]).or_insert(0.0) -= weight;
                }
                row = next;
            }
            if row.keys().all(|at| number.contains_key(at)) {
                rows.push(row);
            }
        }
    }
    let mut matrix = DMatrix::zeros(rows.len(), places.len());
    for (i, row) in rows.iter().enumerate() {
        for (at, weight) in row {
            matrix[(i, number[at])] += weight;
        }
    }
    matrix
}

/// The appendix: third differences contract, so regular surfaces are C2. Two double steps have the
/// greatest singular value 0.7728 * 3^-4 (printed 0.78); one double step is not enough.
#[test]
fn third_differences_contract() {
    let places = hexagon(6);
    assert_eq!(places.len(), 127);
    let step = double_step(&places);
    let jets = third_differences(&places);
    let inverse = jets.clone().pseudo_inverse(1e-9).expect("an inverse");
    // Quadratic precision: what third differences do not see stays unseen.
    let kernel = DMatrix::identity(127, 127) - &inverse * &jets;
    assert!((&jets * &step * kernel).abs().max() < 1e-12);
    let scheme = &jets * &step * &inverse;
    let greatest = |matrix: DMatrix<f64>| matrix.singular_values().max();
    let twice = greatest(&scheme * &scheme) * 81.0;
    assert!((twice - 0.7728).abs() < 5e-5, "{twice}");
    assert!(greatest(scheme) * 9.0 > 1.0);
}
