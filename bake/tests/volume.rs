//! Volumes and moments of whole meshes, against the figures of "Volume Enclosed by Subdivision
//! Surfaces", against refinement with extrapolation, and against their invariances.

mod forms_support;

use forms_support::{Shape, cubes, degenerate_cube, degenerate_tetrahedron, tetrahedron};
use num_bigint::BigInt;
use num_rational::BigRational;
use octruss_bake::forms::exact::{Field, Quadratic};
use octruss_bake::forms::{ClosedMesh, FormError, LimitSurface, Scheme};

fn mesh(shape: &Shape) -> ClosedMesh {
    ClosedMesh::new(shape.points.len(), &shape.faces).expect("a closed mesh")
}

fn exact_volume(scheme: Scheme, shape: &Shape) -> Quadratic {
    let surface = LimitSurface::<Quadratic>::new(scheme, &mesh(shape)).expect("exact weights");
    surface
        .volume(&shape.exact())
        .expect("as many points as vertices")
}

fn real_volume(scheme: Scheme, shape: &Shape) -> f64 {
    let surface = LimitSurface::<f64>::new(scheme, &mesh(shape)).expect("a fitting mesh");
    surface
        .volume(&shape.real())
        .expect("as many points as vertices")
}

fn fraction(numerator: &str, denominator: &str) -> BigRational {
    let integer = |text: &str| text.parse::<BigInt>().expect("an integer");
    BigRational::new(integer(numerator), integer(denominator))
}

/// The figures of the paper's first page.
#[test]
fn the_unit_cube_and_the_tetrahedron() {
    let cube = cubes(&[[0, 0, 0]]);
    assert_eq!(
        exact_volume(Scheme::DooSabin, &cube),
        fraction("6241", "9920").into()
    );
    // The paper's tetrahedron has edges of length 1, this one of sqrt 2: 2 sqrt 2 times the volume.
    assert_eq!(
        exact_volume(Scheme::Loop, &tetrahedron()),
        fraction("88384859027710202", "6865302375425894400").into()
    );
    assert!((real_volume(Scheme::CatmullClark, &cube) - 0.327_552_379_087).abs() < 5e-13);
}

/// Four unit cubes, a corner with a neighbour along each axis.
#[test]
fn the_four_cubes() {
    let tripod = cubes(&[[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]);
    let want = Quadratic::new(
        fraction("10357799098161", "3238292736000"),
        fraction("2535566756", "3238292736000"),
        5,
    );
    assert_eq!(exact_volume(Scheme::DooSabin, &tripod), want);
}

/// Meshes whose limit surface is the polyhedron itself.
#[test]
fn degenerate_meshes_have_the_volume_of_their_polyhedron() {
    assert_eq!(
        exact_volume(Scheme::DooSabin, &degenerate_cube(2)),
        Quadratic::one()
    );
    let sixth = Quadratic::from(fraction("1", "6"));
    for scheme in [Scheme::Loop, Scheme::LoopWarren] {
        assert_eq!(exact_volume(scheme, &degenerate_tetrahedron(8)), sixth);
    }
    let cube = degenerate_cube(3);
    assert_eq!(exact_volume(Scheme::CatmullClark, &cube), Quadratic::one());
    let surface = LimitSurface::<f64>::new(Scheme::CatmullClark, &mesh(&cube)).unwrap();
    for (degree, want) in [(0, 1.0), (1, 0.5), (2, 1.0 / 3.0), (3, 0.25)] {
        let got = surface.integral(&cube.real(), [degree, 0, 0]).unwrap();
        assert!((got - want).abs() < 1e-14, "degree {degree}: {got}");
    }
}

/// A shape that the scheme takes.
fn fitting(scheme: Scheme, shape: Shape) -> Shape {
    match scheme {
        Scheme::Loop | Scheme::LoopWarren => shape.triangulated(),
        _ => shape,
    }
}

/// Closed surfaces of genus 0, 1 and 2, without symmetry.
fn shapes() -> [Shape; 3] {
    let block = |width: i64, depth: i64, holes: &[[i64; 2]]| {
        let mut cells = Vec::new();
        for x in 0..width {
            for y in 0..depth {
                if !holes.contains(&[x, y]) {
                    cells.push([x, y, 0]);
                }
            }
        }
        cubes(&cells).scaled(1000)
    };
    [
        cubes(&[[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
            .scaled(1000)
            .shaken(1, 200),
        block(3, 3, &[[1, 1]]).shaken(2, 200),
        block(5, 3, &[[1, 1], [3, 1]]).shaken(3, 200),
    ]
}

/// Refining or moving a mesh changes no digit of an exact volume.
#[test]
fn refinement_and_translation_change_nothing() {
    let cube = cubes(&[[0, 0, 0]]).scaled(20).shaken(7, 5);
    for (scheme, shape) in [
        (Scheme::DooSabin, cube.clone()),
        (Scheme::Loop, tetrahedron().scaled(20).shaken(8, 5)),
        (Scheme::LoopWarren, cube.triangulated()),
        (Scheme::CatmullClark, cube.clone()),
    ] {
        let want = exact_volume(scheme, &shape);
        let coarse = mesh(&shape);
        let fine = scheme.refine(&coarse);
        let rows = scheme
            .rows::<Quadratic>(&coarse, &fine)
            .expect("exact weights");
        let points = shape.exact();
        let axis_of = |row: &Vec<(usize, Quadratic)>, axis: usize| {
            let mut sum = Quadratic::zero();
            for (vertex, weight) in row {
                sum.add_product(weight, &points[*vertex][axis]);
            }
            sum
        };
        let refined = rows
            .iter()
            .map(|row| [0, 1, 2].map(|axis| axis_of(row, axis)));
        let refined = refined.collect::<Vec<_>>();
        let surface = LimitSurface::new(scheme, &fine).expect("exact weights");
        assert_eq!(surface.volume(&refined).unwrap(), want, "{scheme} refined");

        let mut moved = shape.clone();
        for [x, y, z] in &mut moved.points {
            (*x, *y, *z) = (*x + 1234, *y - 77, *z + 5);
        }
        assert_eq!(exact_volume(scheme, &moved), want, "{scheme} moved");
    }
}

/// The triangles of a polyhedron: each face a fan round the mean of its corners.
fn triangles(mesh: &ClosedMesh, points: &[[f64; 3]]) -> Vec<[[f64; 3]; 3]> {
    let mut triangles = Vec::new();
    for face in 0..mesh.faces() {
        let corners = mesh
            .face_vertices(face)
            .map(|vertex| points[vertex])
            .collect::<Vec<_>>();
        let scale = 1.0 / f64::from(u32::try_from(corners.len()).unwrap());
        let centre =
            [0, 1, 2].map(|axis| corners.iter().map(|corner| corner[axis]).sum::<f64>() * scale);
        for (place, corner) in corners.iter().enumerate() {
            triangles.push([*corner, corners[(place + 1) % corners.len()], centre]);
        }
    }
    triangles
}

fn determinant([[ax, ay, az], [bx, by, bz], [cx, cy, cz]]: [[f64; 3]; 3]) -> f64 {
    cx * (ay * bz - az * by) + cy * (az * bx - ax * bz) + cz * (ax * by - ay * bx)
}

/// The volume of a polyhedron.
fn polyhedron_volume(mesh: &ClosedMesh, points: &[[f64; 3]]) -> f64 {
    let triangles = triangles(mesh, points).into_iter();
    triangles.map(determinant).sum::<f64>() / 6.0
}

/// Centroid and inertia tensor of a polyhedron, nine numbers: over a tetrahedron with one corner in
/// the origin the mean of `x_i x_j` is `(sum of p_i p_j + s_i s_j) / 20`, `s` the sum of its corners `p`.
fn polyhedron_moments(mesh: &ClosedMesh, points: &[[f64; 3]]) -> Vec<f64> {
    let (mut volume, mut first, mut second) = (0.0, [0.0; 3], [[0.0; 3]; 3]);
    for corners in triangles(mesh, points) {
        let own = determinant(corners) / 6.0;
        let sum = [0, 1, 2].map(|i| corners.iter().map(|corner| corner[i]).sum::<f64>());
        volume += own;
        for i in 0..3 {
            first[i] += own * sum[i] / 4.0;
            for j in 0..3 {
                let products = corners.iter().map(|corner| corner[i] * corner[j]);
                second[i][j] += own * (products.sum::<f64>() + sum[i] * sum[j]) / 20.0;
            }
        }
    }
    let centroid = first.map(|x| x / volume);
    let central = |i: usize, j: usize| second[i][j] - volume * centroid[i] * centroid[j];
    let trace = (0..3).map(|i| central(i, i)).sum::<f64>();
    let mut numbers = centroid.to_vec();
    for [i, j] in [[0, 0], [1, 1], [2, 2], [0, 1], [1, 2], [2, 0]] {
        numbers.push(if i == j { trace } else { 0.0 } - central(i, j));
    }
    numbers
}

/// Polyhedra of the refined mesh, level by level.
fn polyhedron_volumes(scheme: Scheme, shape: &Shape, levels: usize) -> Vec<f64> {
    polyhedra(scheme, shape, levels, polyhedron_volume)
}

/// A figure of the polyhedra of the refined mesh, level by level.
fn polyhedra<T>(
    scheme: Scheme,
    shape: &Shape,
    levels: usize,
    figure: impl Fn(&ClosedMesh, &[[f64; 3]]) -> T,
) -> Vec<T> {
    let mut connectivity = mesh(shape);
    let mut points = shape.real();
    let mut figures = Vec::new();
    for _ in 0..levels {
        let fine = scheme.refine(&connectivity);
        let rows = scheme.rows::<f64>(&connectivity, &fine).unwrap();
        points = rows
            .iter()
            .map(|row| [0, 1, 2].map(|axis| row.iter().map(|(v, w)| w * points[*v][axis]).sum()))
            .collect();
        connectivity = fine;
        figures.push(figure(&connectivity, &points));
    }
    figures
}

#[test]
fn polyhedra_of_every_genus_converge_to_the_volume() {
    refine_polyhedra([6, 5, 5]);
}

#[test]
// Off in the quick suite, where it would be the longest test by far: `cargo xtask verify` runs it.
#[ignore = "six levels at every genus: cargo xtask verify"]
fn polyhedra_of_six_levels_converge_to_the_volume() {
    refine_polyhedra([6; 3]);
}

/// The polyhedra's error falls by 4 a level, and their extrapolation meets the form's volume within
/// what the last two extrapolations differ by.
fn refine_polyhedra(of_genus: [usize; 3]) {
    for (genus, shape) in shapes().into_iter().enumerate() {
        for scheme in Scheme::ALL {
            let shape = fitting(scheme, shape.clone());
            let edges = shape.faces.iter().map(Vec::len).sum::<usize>() / 2;
            let euler = shape.points.len() + shape.faces.len();
            assert_eq!(euler + 2 * genus, edges + 2);
            let volume = real_volume(scheme, &shape);
            let levels = polyhedron_volumes(scheme, &shape, of_genus[genus]);
            let [.., a, b, c] = levels[..] else {
                panic!("three levels")
            };
            let ratio = (b - volume) / (c - volume);
            assert!(
                (ratio - 4.0).abs() < 0.02,
                "{scheme}, genus {genus}: {ratio}"
            );
            let (before, last) = ((4.0 * b - a) / 3.0, (4.0 * c - b) / 3.0);
            let error = (last - before).abs();
            assert!(
                (last - volume).abs() <= error,
                "{scheme}: {volume} {last} +- {error}"
            );
            assert!(error < 2e-5 * volume, "{scheme}: {error}");
        }
    }
}

/// Centroid and inertia of the polyhedra likewise.
#[test]
fn moments_of_polyhedra_converge() {
    for shape in shapes() {
        for scheme in Scheme::ALL {
            let shape = fitting(scheme, shape.clone());
            let surface = LimitSurface::<f64>::new(scheme, &mesh(&shape)).unwrap();
            let moments = surface.moments(&shape.real()).unwrap();
            let [[xx, xy, xz], [_, yy, yz], [_, _, zz]] = moments.inertia;
            let [x, y, z] = moments.centroid;
            let levels = polyhedra(scheme, &shape, 5, polyhedron_moments);
            let [.., a, b, c] = &levels[..] else {
                panic!("three levels")
            };
            for (k, want) in [x, y, z, xx, yy, zz, xy, yz, xz].into_iter().enumerate() {
                let (before, last) = ((4.0 * b[k] - a[k]) / 3.0, (4.0 * c[k] - b[k]) / 3.0);
                let error = (last - before).abs();
                assert!(
                    (last - want).abs() <= error,
                    "{scheme} {k}: {want} {last} +- {error}"
                );
            }
        }
    }
}

/// A double pyramid or a prism has a vertex or a face of any valence.
fn of_valence(scheme: Scheme, valence: u32) -> Shape {
    let turn = |i: u32| 2.0 * std::f64::consts::PI * f64::from(i) / f64::from(valence);
    let ring = |z: i64| {
        (0..valence).map(move |i| {
            #[expect(clippy::cast_possible_truncation, reason = "whole numbers below 1000")]
            let coordinate = |x: f64| (1000.0 * x) as i64;
            [coordinate(turn(i).cos()), coordinate(turn(i).sin()), z]
        })
    };
    if scheme == Scheme::DooSabin {
        let mut faces = vec![
            (valence..2 * valence).collect(),
            (0..valence).rev().collect::<Vec<_>>(),
        ];
        faces.extend((0..valence).map(|i| {
            let j = (i + 1) % valence;
            vec![i, j, valence + j, valence + i]
        }));
        return Shape {
            points: ring(0).chain(ring(900)).collect(),
            faces,
        };
    }
    let mut faces = Vec::new();
    for i in 0..valence {
        let j = (i + 1) % valence;
        faces.extend([vec![i, j, valence], vec![j, i, valence + 1]]);
    }
    let apexes = [[0, 0, 800], [0, 0, -700]];
    Shape {
        points: ring(0).chain(apexes).collect(),
        faces,
    }
}

#[test]
fn great_valences_agree_with_refinement_too() {
    for scheme in Scheme::ALL {
        for valence in [7, 13, 32] {
            let shape = of_valence(scheme, valence);
            let volume = real_volume(scheme, &shape);
            let levels = polyhedron_volumes(scheme, &shape, 5);
            let [.., a, b, c] = levels[..] else {
                panic!("three levels")
            };
            let (before, last) = ((4.0 * b - a) / 3.0, (4.0 * c - b) / 3.0);
            assert!(volume > 0.0);
            assert!(
                (last - volume).abs() <= (last - before).abs(),
                "{scheme} {valence}"
            );
            assert!((last - before).abs() < 1e-3 * volume, "{scheme} {valence}");
        }
    }
}

/// Volume and moments by quadrature and by the form, and under a rotation by a quarter turn and
/// a shift, which no coordinate is rounded by.
#[test]
fn moments_follow_rigid_motions() {
    for shape in shapes() {
        for scheme in Scheme::ALL {
            let shape = fitting(scheme, shape.clone());
            let surface = LimitSurface::<f64>::new(scheme, &mesh(&shape)).unwrap();
            let points = shape.real();
            let still = surface.moments(&points).unwrap();
            let volume = surface.volume(&points).unwrap();
            assert!((still.volume / volume - 1.0).abs() < 1e-13, "{scheme}");
            let turned = points
                .iter()
                .map(|[x, y, z]| [-y + 64.0, x - 32.0, z + 16.0]);
            let turned = surface.moments(&turned.collect::<Vec<_>>()).unwrap();
            let [x, y, z] = still.centroid;
            for (got, want) in turned.centroid.iter().zip([-y + 64.0, x - 32.0, z + 16.0]) {
                assert!((got - want).abs() < 1e-9, "{scheme}: {got} {want}");
            }
            let [[xx, xy, xz], [_, yy, yz], [_, _, zz]] = still.inertia;
            let want = [[yy, -xy, -yz], [-xy, xx, xz], [-yz, xz, zz]];
            let size = xx + yy + zz;
            for (got, want) in turned.inertia.iter().flatten().zip(want.iter().flatten()) {
                assert!((got - want).abs() < 1e-12 * size, "{scheme}: {got} {want}");
            }
        }
    }
}

/// The volume is affine in each single coordinate, so a difference of two exact volumes is the
/// derivative itself.
#[test]
fn the_gradient_is_an_exact_difference() {
    for (scheme, shape) in [
        (
            Scheme::DooSabin,
            cubes(&[[0, 0, 0]]).scaled(20).shaken(4, 5),
        ),
        (Scheme::Loop, tetrahedron().scaled(20).shaken(5, 5)),
        (Scheme::LoopWarren, tetrahedron().scaled(20).shaken(6, 5)),
        (
            Scheme::CatmullClark,
            cubes(&[[0, 0, 0]]).scaled(20).shaken(7, 5),
        ),
    ] {
        let surface = LimitSurface::<f64>::new(scheme, &mesh(&shape)).unwrap();
        let gradient = surface.gradient(&shape.real()).unwrap();
        let start = exact_volume(scheme, &shape);
        for (vertex, slope) in gradient.iter().enumerate() {
            for (axis, got) in slope.iter().enumerate() {
                let mut moved = shape.clone();
                moved.points[vertex][axis] += 1;
                let want = exact_volume(scheme, &moved).minus(&start).to_f64();
                assert!(
                    (got - want).abs() < 1e-11,
                    "{scheme} {vertex} {axis}: {got} {want}"
                );
            }
        }
    }
}

#[test]
fn a_target_volume_is_reached_with_the_least_movement() {
    for scheme in Scheme::ALL {
        let shape = fitting(scheme, shapes()[0].clone());
        let surface = LimitSurface::<f64>::new(scheme, &mesh(&shape)).unwrap();
        let points = shape.real();
        let target = 1.2 * surface.volume(&points).unwrap();
        let reached = surface.enclosing(&points, target).unwrap();
        assert!((surface.volume(&reached).unwrap() / target - 1.0).abs() < 1e-12);
        // Nearest: the movement is parallel to the gradient at the answer.
        let gradient = surface.gradient(&reached).unwrap();
        let (mut both, mut slopes, mut steps) = (0.0, 0.0, 0.0);
        for ((slope, to), from) in gradient.iter().zip(&reached).zip(&points) {
            for axis in 0..3 {
                let step = to[axis] - from[axis];
                both += step * slope[axis];
                slopes += slope[axis] * slope[axis];
                steps += step * step;
            }
        }
        assert!(1.0 - both / (slopes * steps).sqrt() < 1e-12, "{scheme}");
        let none = surface.enclosing(&points, f64::NAN);
        assert!(matches!(none, Err(FormError::Target { .. })));
    }
}

#[test]
fn unsound_meshes_are_refused_by_name() {
    let cube = cubes(&[[0, 0, 0]]);
    let new = |faces: &[Vec<u32>]| ClosedMesh::new(8, faces).map(|_| ());
    assert_eq!(new(&cube.faces), Ok(()));

    let Err(FormError::Open { edge }) = new(&cube.faces[1..]) else {
        panic!("open")
    };
    let removed = |vertex: usize| {
        cube.faces[0]
            .iter()
            .any(|&corner| corner as usize == vertex)
    };
    assert!(edge.into_iter().all(removed));

    let mut turned = cube.faces.clone();
    turned[0].reverse();
    let Err(FormError::Orientation { edge }) = new(&turned) else {
        panic!("turned")
    };
    assert!(edge.into_iter().all(removed));

    let two = cubes(&[[0, 0, 0], [1, 1, 0]]);
    let shared = ClosedMesh::new(two.points.len(), &two.faces);
    let Err(FormError::NonManifold { edge }) = shared else {
        panic!("four faces at an edge")
    };
    for vertex in edge {
        assert_eq!(two.points[vertex][..2], [1, 1]);
    }

    let two = cubes(&[[0, 0, 0], [1, 1, 1]]);
    let touching = ClosedMesh::new(two.points.len(), &two.faces);
    let Err(FormError::VertexFans { vertex, .. }) = touching else {
        panic!("a shared corner")
    };
    assert_eq!(two.points[vertex], [1, 1, 1]);

    let quads = LimitSurface::<f64>::new(Scheme::Loop, &mesh(&cube));
    assert!(matches!(quads, Err(FormError::NotTriangles { face: 0 })));
    // Faces of 5 and of 8 corners: sqrt 5 and sqrt 2.
    assert_eq!(
        Scheme::DooSabin.exact_radicand(&[3, 5, 8]),
        Err(FormError::NotExact { valence: 8 })
    );
}
