//! Limit normals: core against the reference, and both against real numbers.

use std::collections::BTreeMap;
use std::f64::consts::{PI, TAU};

use octruss::blend::IrrationalWeight;
use octruss::mesh::MeshError;
use octruss::surface::limit_normals::{FixedTangents, TangentBlend};
use octruss_host_tests::random_surface::{Shape, SurfaceCase, Wishes};
use octruss_host_tests::reference_surface::{
    Border, Family, Grid, Polygons, Refined, Row, catmull_clark, catmull_clark_limit, doo_sabin,
    face_normals, limit_normals, loop_limit, loop_rule,
};
use octruss_host_tests::surface_subject::{Scheme, normals};

const BORDERS: [Border; 3] = [Border::Spline, Border::SplineWithCorners, Border::Fixed];

fn case_count() -> u64 {
    std::env::var("OCTRUSS_CASES")
        .ok()
        .and_then(|count| count.parse().ok())
        .unwrap_or(60)
}

fn wishes(shape: Shape) -> Wishes {
    Wishes {
        shape,
        open: true,
        features: true,
        tangled: true,
    }
}

/// Core in fixed point and the reference must agree in every bit.
fn compare(scheme: Scheme, mesh: &Polygons, border: Border, points: &[[i32; 3]], seed: u64) {
    let mut blend = FixedTangents::<i32>::new();
    let got = normals(&mut blend, scheme, border, mesh, points);
    if scheme != Scheme::DooSabin && mesh.has_turned_faces() {
        let is_refused = matches!(got, Err(MeshError::Orientation { .. }));
        assert!(is_refused, "seed {seed}: {got:?}");
        return;
    }
    let (want, zeros) = match scheme {
        Scheme::DooSabin => face_normals(mesh, points),
        _ => limit_normals(mesh, scheme == Scheme::CatmullClark, border, points),
    };
    assert_eq!(got, Ok(want), "seed {seed}");
    // The subject's own call of `no_normal` is one.
    assert_eq!(blend.zeros(), zeros + 1, "seed {seed}");
}

#[test]
fn loop_equals_the_reference() {
    for seed in 0..case_count() {
        let SurfaceCase { mesh, points } = SurfaceCase::new(seed, wishes(Shape::Triangles));
        let border = BORDERS[(seed % 3) as usize];
        compare(Scheme::Loop(Family::Loop), &mesh, border, &points, seed);
    }
}

#[test]
fn catmull_clark_equals_the_reference() {
    for seed in 0..case_count() {
        let SurfaceCase { mesh, points } = SurfaceCase::new(seed, wishes(Shape::Polygons));
        let border = BORDERS[(seed % 3) as usize];
        let refined = catmull_clark(&mesh, border);
        let points = refined.points(&points);
        compare(Scheme::CatmullClark, &refined.mesh, border, &points, seed);
    }
}

#[test]
fn doo_sabin_equals_the_reference() {
    for seed in 0..case_count() {
        let SurfaceCase { mesh, points } = SurfaceCase::new(seed, wishes(Shape::Polygons));
        compare(Scheme::DooSabin, &mesh, Border::Spline, &points, seed);
    }
}

/// Tangents as rows: which weight every vertex has in them.
#[derive(Default)]
struct Masks;

type Weights = BTreeMap<u32, f64>;

impl TangentBlend for Masks {
    type Point = u32;
    type Sum = Weights;
    type Normal = Vec<Weights>;

    fn zero(&self) -> Weights {
        Weights::new()
    }

    fn add(&self, sum: &mut Weights, weight: IrrationalWeight, point: &u32, own: &u32) {
        *sum.entry(*point).or_default() += weight.real;
        *sum.entry(*own).or_default() -= weight.real;
    }

    fn normal(&mut self, one: &Weights, other: &Weights) -> Vec<Weights> {
        vec![one.clone(), other.clone()]
    }

    fn corner_normal(&mut self, edges: &[Weights; 2], crease: &[Weights; 2]) -> Vec<Weights> {
        edges.iter().chain(crease).cloned().collect()
    }

    fn no_normal(&mut self) -> Vec<Weights> {
        Vec::new()
    }
}

/// A vertex 0 with `k` faces of three or four corners, all round it or between two rims.
fn fan(k: u32, corners: u32, closed: bool) -> Polygons {
    let ends = if closed { k } else { k + 1 };
    let face = |i: u32| {
        let [from, to] = [1 + i, 1 + (i + 1) % ends];
        if corners == 3 {
            vec![0, from, to]
        } else {
            vec![0, from, 1 + ends + i, to]
        }
    };
    let across = if corners == 3 { 0 } else { k };
    Polygons {
        vertex_count: 1 + ends + across,
        faces: (0..k).map(face).collect(),
        ..Polygons::default()
    }
}

/// The refinement of a fan in real numbers, and which refined vertex stands where each vertex stood.
fn step(mesh: &Polygons, corners: u32, border: Border) -> (Vec<Row>, Vec<usize>) {
    let refined = if corners == 3 {
        loop_rule(mesh, Family::Loop, border, Grid::Real)
    } else {
        catmull_clark(mesh, border)
    };
    let count = mesh.vertex_count;
    let middles: BTreeMap<[u32; 2], u32> = mesh.edges().into_keys().zip(count..).collect();
    let faces = count + middles.len() as u32;
    let mut ranks = vec![0; mesh.faces.len()];
    for (rank, face) in mesh.sorted_faces().into_iter().enumerate() {
        ranks[face] = rank as u32;
    }
    let place = |vertex: u32| match middles.get(&[0, vertex]) {
        _ if vertex == 0 => 0,
        Some(middle) => *middle as usize,
        None => {
            let face = mesh.faces.iter().position(|f| f[2] == vertex);
            (faces + ranks[face.expect("a vertex across")]) as usize
        }
    };
    (refined.rows, (0..count).map(place).collect())
}

/// `mask * matrix - value * mask`, its greatest magnitude; the value is taken from the greatest weight.
fn eigenvector_residual(mask: &Weights, rows: &[Row], places: &[usize]) -> (f64, f64) {
    let mut image: Weights = Weights::new();
    for (vertex, weight) in mask {
        let row = &rows[places[*vertex as usize]];
        for (old, numerator) in &row.entries {
            *image.entry(*old).or_default() += weight * numerator / row.denominator;
        }
    }
    let (vertex, weight) = mask
        .iter()
        .max_by(|one, other| one.1.abs().total_cmp(&other.1.abs()))
        .expect("a mask");
    let value = image[vertex] / weight;
    let difference = |(vertex, weight): (&u32, &f64)| {
        (weight - value * mask.get(vertex).copied().unwrap_or(0.0)).abs()
    };
    (image.iter().map(difference).fold(0.0, f64::max), value)
}

/// The masks of tangents are left eigenvectors of the refinement itself (the reference's), with the
/// eigenvalues that the literature has: Loop's 3/8 + cos/4 and Catmull-Clark's
/// (5 + cos + sqrt((9 + cos)(1 + cos)))/16; along creases 1/2.
#[test]
fn tangents_are_left_eigenvectors() {
    for corners in [3, 4] {
        for k in 1..=40_u32 {
            for closed in [true, false] {
                if closed && k < 3 {
                    continue;
                }
                let mesh = fan(k, corners, closed);
                let scheme = match corners {
                    3 => Scheme::Loop(Family::Loop),
                    _ => Scheme::CatmullClark,
                };
                let names: Vec<u32> = (0..mesh.vertex_count).collect();
                let masks = normals(&mut Masks, scheme, Border::Spline, &mesh, &names)
                    .expect("a sound mesh");
                let (rows, places) = step(&mesh, corners, Border::Spline);
                let angle = if closed { TAU } else { PI } / f64::from(k);
                let c = angle.cos();
                let smooth = match corners {
                    3 => 0.375 + c / 4.0,
                    _ => (5.0 + c + ((9.0 + c) * (1.0 + c)).sqrt()) / 16.0,
                };
                let what = format!("{corners} corners, {k} faces, closed {closed}");
                for (place, mask) in masks[0].iter().enumerate() {
                    let (residual, value) = eigenvector_residual(mask, &rows, &places);
                    let want = match (closed, place, k) {
                        (true, ..) => smooth,
                        (false, 0, _) => 0.5,
                        // The rim of a single face: 1/4.
                        (false, _, 1) => 0.25,
                        (false, ..) => smooth,
                    };
                    let size = mask.values().map(|weight| weight.abs()).fold(0.0, f64::max);
                    assert!((value - want).abs() < 1e-12, "{what}: {value}, not {want}");
                    assert!(residual < 1e-12 * size, "{what}: residual {residual}");
                }
            }
        }
    }
}

/// A level in real numbers.
fn refined(refined: Refined, points: &[[f64; 3]]) -> (Polygons, Vec<[f64; 3]>) {
    let points = apply_real(&refined.rows, points);
    (refined.mesh, points)
}

fn apply_real(rows: &[Row], points: &[[f64; 3]]) -> Vec<[f64; 3]> {
    let value = |row: &Row, axis: usize| {
        let terms = row.entries.iter();
        terms
            .map(|(v, n)| n * points[*v as usize][axis])
            .sum::<f64>()
            / row.denominator
    };
    let axes = |row| [0, 1, 2].map(|axis| value(row, axis));
    rows.iter().map(axes).collect()
}

fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

fn unit(a: [f64; 3]) -> [f64; 3] {
    let length = a.iter().map(|x| x * x).sum::<f64>().sqrt();
    a.map(|x| x / length)
}

fn apart(a: [f64; 3], b: [f64; 3]) -> f64 {
    minus(a, b).iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// Whole numbers of 2^20 for the control points, so that core takes them as they are.
fn wavy(mesh: &Polygons, spread: f64) -> Vec<[f64; 3]> {
    let around = mesh.vertex_count as f64;
    (0..mesh.vertex_count)
        .map(|vertex| {
            let (turn, vertex) = (TAU * f64::from(vertex) / around, f64::from(vertex));
            let lift = spread * (1.7 * vertex + 0.4).sin();
            [turn.cos() * 1e6, turn.sin() * 1e6, lift * 3e5].map(f64::round)
        })
        .collect()
}

/// Fans of every kind are refined in real numbers until the facets around the first vertex turn no more; their
/// normal is the limit's. A facet's normal at level m differs from the limit by a multiple of the ratio of
/// the third eigenvalue to the second to the m-th power, hence the bounds; the device's is within 2^-13 more.
#[test]
fn facets_of_deep_levels_turn_to_the_limit_normals() {
    for (corners, faces, closed, levels, bound) in [
        (3, 6, true, 9, 0.02),
        (3, 3, true, 9, 0.03),
        (3, 5, true, 9, 0.02),
        (3, 9, true, 9, 0.06),
        (4, 4, true, 9, 0.02),
        (4, 3, true, 9, 0.02),
        (4, 5, true, 9, 0.02),
        (4, 7, true, 9, 0.06),
        (3, 3, false, 9, 0.02),
        (3, 2, false, 9, 0.2),
        (4, 2, false, 9, 0.02),
        (4, 3, false, 9, 0.05),
    ] {
        let what = format!("{corners} corners, {faces} faces, closed {closed}");
        let mut mesh = ringed(faces, corners, closed);
        let mut points = wavy_fan(&mesh, faces, closed);
        let scheme = match corners {
            3 => Scheme::Loop(Family::Loop),
            _ => Scheme::CatmullClark,
        };
        let bits: Vec<[i32; 3]> = points.iter().map(|p| p.map(|x| x as i32)).collect();
        let mut blend = FixedTangents::<i32>::new();
        let got = normals(&mut blend, scheme, Border::Spline, &mesh, &bits).expect("a sound mesh");
        let got = got[0].map(|x| f64::from(x) / 16384.0);
        for _ in 0..levels {
            let near = near_first(&mesh, &points);
            (mesh, points) = near;
            let next = match corners {
                3 => loop_rule(&mesh, Family::Loop, Border::Spline, Grid::Real),
                _ => catmull_clark(&mesh, Border::Spline),
            };
            (mesh, points) = refined(next, &points);
        }
        let limits = match corners {
            3 => loop_limit(&mesh, Family::Loop, Border::Spline, Grid::Real),
            _ => catmull_clark_limit(&mesh, Border::Spline),
        };
        let limits = apply_real(&limits, &points);
        let mut sum = [0.0; 3];
        for face in mesh.faces.iter().filter(|face| face.contains(&0)) {
            let place = face.iter().position(|v| *v == 0).expect("it is there");
            let at = |step: usize| limits[face[(place + step) % face.len()] as usize];
            let facet = cross(minus(at(1), at(0)), minus(at(face.len() - 1), at(0)));
            sum = [0, 1, 2].map(|axis| sum[axis] + facet[axis]);
        }
        let far = apart(unit(sum), got);
        assert!(far < bound, "{what}: {far}, {sum:?} {got:?}");
    }
}

/// A fan with a ring of faces around it, so that the first vertex is far from any other rim. Faces at the first
/// vertex come first.
fn ringed(k: u32, corners: u32, closed: bool) -> Polygons {
    let inner = fan(k, corners, closed);
    let ends = if closed { k } else { k + 1 };
    // The polygon round the fan, counter-clockwise.
    let round: Vec<u32> = (0..k)
        .flat_map(|i| {
            if corners == 3 {
                vec![1 + i]
            } else {
                vec![1 + i, 1 + ends + i]
            }
        })
        .chain((!closed).then_some(k + 1))
        .collect();
    let outer = inner.vertex_count;
    let mut faces = inner.faces;
    let count = round.len();
    let spans = if closed { count } else { count - 1 };
    for i in 0..spans {
        let (a, b) = (round[i], round[(i + 1) % count]);
        let (p, q) = (outer + i as u32, outer + ((i + 1) % count) as u32);
        if corners == 3 {
            faces.extend([vec![a, p, q], vec![a, q, b]]);
        } else {
            faces.push(vec![a, p, q, b]);
        }
    }
    Polygons {
        vertex_count: outer + count as u32,
        faces,
        ..Polygons::default()
    }
}

/// A wavy disc, or half of one, in the order of [`ringed`].
fn wavy_fan(mesh: &Polygons, k: u32, closed: bool) -> Vec<[f64; 3]> {
    let neighbours = mesh.neighbours();
    // Rings by distance from the first vertex, angles by the polygon's order.
    let ends = if closed { k } else { k + 1 };
    let angle_of = |vertex: u32| -> (f64, f64) {
        let whole = if closed { TAU } else { PI };
        let triangles = mesh.faces[0].len() == 3;
        let (count, across) = (f64::from(k), !triangles);
        let inner = 1 + ends + if across { k } else { 0 };
        let step = whole / count;
        if vertex == 0 {
            (0.0, 0.0)
        } else if vertex <= ends {
            (f64::from(vertex - 1) * step, 1.0)
        } else if vertex < inner {
            ((f64::from(vertex - 1 - ends) + 0.5) * step, 1.3)
        } else {
            let place = f64::from(vertex - inner);
            let step = if triangles { step } else { step / 2.0 };
            (place * step, 2.2)
        }
    };
    assert_eq!(neighbours.len(), mesh.vertex_count as usize);
    (0..mesh.vertex_count)
        .map(|vertex| {
            let (angle, radius) = angle_of(vertex);
            let name = f64::from(vertex);
            let lift = 0.3 * (2.3 * name + 0.9).sin();
            let place = [
                radius * angle.cos() + 0.1 * (3.1 * name).sin(),
                radius * angle.sin() + 0.1 * (1.3 * name).cos(),
                lift,
            ];
            place.map(|x| (x * 1e7).round())
        })
        .collect()
}

/// The part of a mesh within two edges of its first vertex; names are kept in order.
fn near_first(mesh: &Polygons, points: &[[f64; 3]]) -> (Polygons, Vec<[f64; 3]>) {
    let mut near = std::collections::BTreeSet::from([0]);
    for _ in 0..2 {
        let reached: Vec<u32> = mesh
            .faces
            .iter()
            .filter(|face| face.iter().any(|v| near.contains(v)))
            .flatten()
            .copied()
            .collect();
        near.extend(reached);
    }
    let names: BTreeMap<u32, u32> = near.iter().copied().zip(0..).collect();
    let kept = mesh
        .faces
        .iter()
        .filter(|face| face.iter().all(|v| near.contains(v)));
    let faces = kept
        .map(|face| face.iter().map(|v| names[v]).collect())
        .collect();
    let part = Polygons {
        vertex_count: near.len() as u32,
        faces,
        ..Polygons::default()
    };
    (part, near.iter().map(|v| points[*v as usize]).collect())
}

/// A Doo-Sabin face keeps its centre; its corners at level m are the centre and half of the tangents' part
/// each level, so the face's own facets turn to the normal.
#[test]
fn doo_sabin_faces_turn_to_their_normals() {
    for n in 3..=9_u32 {
        let mut mesh = Polygons {
            vertex_count: n,
            faces: vec![(0..n).collect()],
            ..Polygons::default()
        };
        let mut points = wavy(&mesh, 1.0);
        let bits: Vec<[i32; 3]> = points.iter().map(|p| p.map(|x| x as i32)).collect();
        let mut blend = FixedTangents::<i32>::new();
        let got = normals(&mut blend, Scheme::DooSabin, Border::Spline, &mesh, &bits);
        let got = got.expect("a sound mesh")[0].map(|x| f64::from(x) / 16384.0);
        for _ in 0..20 {
            (mesh, points) = refined(doo_sabin(&mesh, Grid::Real), &points);
        }
        let corner = |i: usize| points[mesh.faces[0][i % n as usize] as usize];
        for i in 0..n as usize {
            let facet = cross(
                minus(corner(i + 1), corner(i)),
                minus(corner(i + 2), corner(i)),
            );
            // All other parts shrink by 4 where the tangents shrink by 2: 2^-20, and the device's 2^-13.
            let far = apart(unit(facet), got);
            assert!(far < 3e-4, "{n} corners: {far}");
        }
    }
}

/// A cube's top with a crease round it: the top's corners of the crease look up and outward by halves, each
/// side's own way. By hand: on a flat crease between two flat sides the normals are the sides'.
#[test]
fn creases_have_a_normal_on_either_side() {
    // Two flat strips that meet at a right angle along the x axis, creased there.
    let mesh = Polygons {
        vertex_count: 9,
        faces: vec![
            vec![0, 1, 4, 3],
            vec![1, 2, 5, 4],
            vec![3, 4, 7, 6],
            vec![4, 5, 8, 7],
        ],
        creases: vec![[3, 4], [4, 5]],
        ..Polygons::default()
    };
    let points = [
        [-100, 0, -100],
        [0, 0, -100],
        [100, 0, -100],
        [-100, 0, 0],
        [0, 0, 0],
        [100, 0, 0],
        [-100, 100, 0],
        [0, 100, 0],
        [100, 100, 0],
    ];
    let mut blend = FixedTangents::<i32>::new();
    let got = normals(
        &mut blend,
        Scheme::CatmullClark,
        Border::Spline,
        &mesh,
        &points,
    );
    let got = got.expect("a sound mesh");
    let side = [0, -16384, 0];
    let top = [0, 0, 16384];
    let want: Vec<[i16; 3]> = [[side; 8], [top; 8]].concat();
    assert_eq!(got, want);
    assert_eq!(blend.zeros(), 1);
}

/// A concave corner of a flat mesh looks the way its faces do.
#[test]
fn concave_corners_are_not_turned_over() {
    // Three quads round the origin, an L, with its inner corner tagged.
    let mesh = Polygons {
        vertex_count: 8,
        faces: vec![vec![0, 1, 2, 3], vec![0, 3, 4, 5], vec![0, 5, 6, 7]],
        corners: vec![0],
        ..Polygons::default()
    };
    let points = [
        [0, 0, 0],
        [1, 0, 0],
        [1, 1, 0],
        [0, 1, 0],
        [-1, 1, 0],
        [-1, 0, 0],
        [-1, -1, 0],
        [0, -1, 0],
    ]
    .map(|point: [i32; 3]| point.map(|x| x * 1000));
    let mut blend = FixedTangents::<i32>::new();
    for border in BORDERS {
        let got = normals(&mut blend, Scheme::CatmullClark, border, &mesh, &points);
        assert!(
            got.expect("sound")
                .iter()
                .all(|normal| *normal == [0, 0, 16384])
        );
    }
}

#[test]
fn what_has_no_normals_is_refused() {
    let quad = fan(4, 4, true);
    let points = vec![[0; 3]; quad.vertex_count as usize];
    let mut blend = FixedTangents::<i32>::new();
    let spline = Border::Spline;
    let refused = normals(
        &mut blend,
        Scheme::Loop(Family::Loop),
        spline,
        &quad,
        &points,
    );
    assert_eq!(
        refused,
        Err(MeshError::NotATriangle {
            face: 0,
            corners: 4
        })
    );
    let mut turned = fan(5, 3, true);
    turned.faces[2].reverse();
    let refused = normals(
        &mut blend,
        Scheme::Loop(Family::Loop),
        spline,
        &turned,
        &points,
    );
    assert!(
        matches!(refused, Err(MeshError::Orientation { .. })),
        "{refused:?}"
    );
    let refused = normals(&mut blend, Scheme::CatmullClark, spline, &turned, &points);
    assert_eq!(
        refused,
        Err(MeshError::NotAQuad {
            face: 0,
            corners: 3
        })
    );
    // All points in one place.
    let got = normals(&mut blend, Scheme::CatmullClark, spline, &quad, &points);
    assert!(got.expect("sound").iter().all(|normal| *normal == [0; 3]));
}
