//! Extrapolated volumes and moments: of surfaces with creases, and of tri-quad, square-root-3 and butterfly
//! surfaces, of which the volume alone has an exact form (see `neighbourhood_forms.rs`).
//!
//! What they should be comes from forms that are exact (a scheme of triangles and quads is Loop's or
//! Catmull and Clark's on one kind of face), from meshes whose limit is a polyhedron, and from the cells.

mod common;
mod forms_support;

use common::{Folder, octruss};
use forms_support::{Shape, cubes, degenerate_cube, degenerate_tetrahedron};
use octruss_bake::forms::solid::Enclosure;
use octruss_bake::forms::{ClosedMesh, LimitSurface, Scheme, region};
use octruss_bake::mesh::{Cells, Features, Labels, SolidMesh};
use octruss_bake::refine::{BoundaryRule, Level, RealBlend, Scheme as SolidScheme};
use octruss_bake::surface::{RimRule, SurfaceLevel, SurfaceMesh, SurfaceScheme, SurfaceStep};
use predicates::prelude::PredicateBooleanExt;
use predicates::str::contains;

const INEXACT: [SurfaceScheme; 4] = [
    SurfaceScheme::TriQuad,
    SurfaceScheme::Sqrt3,
    SurfaceScheme::Butterfly,
    SurfaceScheme::ButterflyModified,
];

/// Volume, then centroid and inertia, each with what it may be wrong by.
fn figures(scheme: SurfaceScheme, faces: &[Vec<u32>], points: &[[f64; 3]]) -> Vec<[f64; 2]> {
    let surface = Enclosure::new(faces, &Features::default()).unwrap();
    let own = surface.own(points);
    let [last, before] = surface.extrapolated_moments(scheme, &own).unwrap();
    let flat = |moments: &octruss_bake::forms::Moments| {
        let mut numbers = vec![moments.volume];
        numbers.extend(moments.centroid);
        numbers.extend(moments.inertia.as_flattened());
        numbers
    };
    let pairs = flat(&last).into_iter().zip(flat(&before));
    pairs.map(|(a, b)| [a, (a - b).abs()]).collect()
}

fn agree(got: &[[f64; 2]], want: &[[f64; 2]], what: &str) {
    let most = want
        .iter()
        .fold(1.0_f64, |most, [value, _]| most.max(value.abs()));
    for (place, ([got, error], [want, own])) in got.iter().zip(want).enumerate() {
        // Entries of the inertia tensor that are nearly zero are differences of great ones.
        let allowed = error + own + 1e-13 * most;
        let gap = (got - want).abs();
        assert!(gap <= allowed, "{what} {place}: {got} {want} +- {allowed}");
    }
}

/// A tower of two cubes, one, and a ring of eight: a sphere, and a torus of valences 3 to 5.
fn solids() -> [Shape; 2] {
    let ring = (0..3).flat_map(|x| (0..3).map(move |y| [x, y, 0]));
    let ring: Vec<[i64; 3]> = ring.filter(|cell| cell[..2] != [1, 1]).collect();
    [cubes(&[[0, 0, 0], [0, 0, 1]]), cubes(&ring)].map(|shape| shape.scaled(100).shaken(7, 20))
}

/// Every other quad cut in two.
fn half_cut(shape: &Shape) -> Shape {
    let mut faces = Vec::new();
    for (place, face) in shape.faces.iter().enumerate() {
        if place % 2 == 0 {
            faces.push(face.clone());
        } else {
            faces.push(vec![face[0], face[1], face[2]]);
            faces.push(vec![face[0], face[2], face[3]]);
        }
    }
    Shape {
        points: shape.points.clone(),
        faces,
    }
}

fn fitting(scheme: SurfaceScheme, shape: &Shape) -> Shape {
    match scheme {
        SurfaceScheme::TriQuad => half_cut(shape),
        _ => shape.triangulated(),
    }
}

/// An octahedron has valence 4 throughout, where 3/(8n) is Warren's weight; a torus of quads has valence
/// 4, where the even averages are Catmull and Clark's.
#[test]
fn one_kind_of_face_is_the_exact_form() {
    let octahedron = Shape {
        points: vec![
            [90, 3, 1],
            [-80, 5, 2],
            [4, 70, -6],
            [1, -60, 9],
            [7, -3, 100],
            [-9, 8, -110],
        ],
        faces: [
            [0, 2, 4],
            [2, 1, 4],
            [1, 3, 4],
            [3, 0, 4],
            [2, 0, 5],
            [1, 2, 5],
            [3, 1, 5],
            [0, 3, 5],
        ]
        .map(|face| face.to_vec())
        .to_vec(),
    };
    for (exact, shape) in [
        (Scheme::LoopWarren, octahedron),
        (Scheme::CatmullClark, torus()),
    ] {
        let mesh = ClosedMesh::new(shape.points.len(), &shape.faces).unwrap();
        let limit = LimitSurface::<f64>::new(exact, &mesh).unwrap();
        let moments = limit.moments(&shape.real()).unwrap();
        let got = figures(SurfaceScheme::TriQuad, &shape.faces, &shape.real());
        let mut want = vec![moments.volume];
        want.extend(moments.centroid);
        want.extend(moments.inertia.as_flattened());
        let want = want
            .into_iter()
            .map(|value| [value, 0.0])
            .collect::<Vec<_>>();
        agree(&got, &want, exact.name());
        assert!(got[0][1] < 1e-5 * got[0][0], "{:?}", got[0]);
        let surface = Enclosure::new(&shape.faces, &Features::default()).unwrap();
        let [form, before] = surface.control_forms(SurfaceScheme::TriQuad).unwrap();
        for form in [form, before] {
            let got = form.volume(&shape.real());
            assert!((got / moments.volume - 1.0).abs() < 1e-13, "{got}");
        }
    }
}

/// Four by four quads round a ring.
fn torus() -> Shape {
    let at = |u: u32, v: u32| 4 * (u % 4) + v % 4;
    let around = [[1_i64, 0], [0, 1], [-1, 0], [0, -1]];
    let mut shape = Shape {
        points: Vec::new(),
        faces: Vec::new(),
    };
    for ([c, s], u) in around.into_iter().zip(0..) {
        for ([across, up], v) in around.into_iter().zip(0..) {
            let radius = 100 + 40 * across;
            shape
                .points
                .push([radius * c + up, radius * s - across, 50 * up + 3 * c]);
            shape
                .faces
                .push(vec![at(u, v), at(u + 1, v), at(u + 1, v + 1), at(u, v + 1)]);
        }
    }
    shape
}

/// Control points that coincide along all edges make the polyhedron itself the limit.
#[test]
fn degenerate_meshes_are_their_polyhedra() {
    let cube = degenerate_cube(3);
    let cut = cube.triangulated();
    for (scheme, shape, want) in [
        (SurfaceScheme::TriQuad, half_cut(&cube), 1.0),
        (SurfaceScheme::TriQuad, cube, 1.0),
        (SurfaceScheme::TriQuad, degenerate_tetrahedron(8), 1.0 / 6.0),
        (SurfaceScheme::Sqrt3, cut.clone(), 1.0),
        (SurfaceScheme::Butterfly, cut.clone(), 1.0),
        (SurfaceScheme::ButterflyModified, cut, 1.0),
    ] {
        let [volume, error] = figures(scheme, &shape.faces, &shape.real())[0];
        let gap = (volume - want).abs();
        assert!(
            gap < 1e-12 && error < 1e-12,
            "{scheme:?}: {volume} +- {error}"
        );
    }
}

/// A mesh and its refinement have the same limit; a rigid motion moves the volume with it.
#[test]
fn refinement_and_rigid_motions_change_nothing() {
    for scheme in INEXACT {
        // A torus costs more; schemes of triangles see one with the modified butterfly.
        let triangles = [SurfaceScheme::Sqrt3, SurfaceScheme::Butterfly].contains(&scheme);
        for shape in solids().into_iter().take(if triangles { 1 } else { 2 }) {
            let shape = fitting(scheme, &shape);
            let points = shape.real();
            let before = figures(scheme, &shape.faces, &points);
            let what = format!("{scheme:?}");
            assert!(
                before[0][1] < 2e-3 * before[0][0],
                "{what}: {:?}",
                before[0]
            );
            let level = SurfaceLevel::new(&SurfaceMesh {
                points: points.clone(),
                faces: shape.faces.clone(),
                ..SurfaceMesh::default()
            })
            .unwrap();
            let mut step = SurfaceStep::new(&level, scheme, RimRule::Spline);
            let finer = step.values(&mut RealBlend, &points).unwrap();
            let next = step.split().unwrap();
            let faces = next.faces().map(<[u32]>::to_vec).collect::<Vec<_>>();
            agree(&figures(scheme, &faces, &finer), &before, &what);
            // (3, 4, 5) turns exactly but for rounding.
            let moved = points
                .iter()
                .map(|[x, y, z]| [0.6 * x - 0.8 * y + 7.0, 0.8 * x + 0.6 * y - 300.0, z + 11.0]);
            let moved = figures(scheme, &shape.faces, &moved.collect::<Vec<_>>());
            assert!((moved[0][0] / before[0][0] - 1.0).abs() < 1e-12, "{what}");
            let [x, y, z] = [1, 2, 3].map(|place| before[place][0]);
            let centroid = [0.6 * x - 0.8 * y + 7.0, 0.8 * x + 0.6 * y - 300.0, z + 11.0];
            for (got, want) in moved[1..4].iter().zip(centroid) {
                assert!((got[0] - want).abs() < 1e-9, "{what}: {got:?} {want}");
            }
        }
    }
}

/// A cube, on it a pyramid of two tetrahedra, beside it a prism; all cells with the label 1.
fn house() -> SolidMesh {
    let cells = Cells {
        tetrahedra: vec![[4, 5, 6, 8], [4, 6, 7, 8]],
        octahedra: vec![],
        prisms: vec![[1, 5, 9, 2, 6, 10]],
        hexahedra: vec![[0, 1, 2, 3, 4, 5, 6, 7]],
    };
    SolidMesh {
        points: vec![
            [0.0, 0.0, 0.0],
            [2.0, 0.0, 0.0],
            [2.0, 2.0, 0.0],
            [0.0, 2.0, 0.0],
            [0.0, 0.0, 2.0],
            [2.0, 0.0, 2.0],
            [2.0, 2.0, 2.0],
            [0.0, 2.0, 2.0],
            [1.0, 1.0, 3.0],
            [4.0, 0.0, 0.0],
            [4.0, 2.0, 0.0],
        ],
        labels: Labels {
            tetrahedra: vec![1, 1],
            prisms: vec![1],
            hexahedra: vec![1],
            ..Labels::default()
        },
        cells,
        ..SolidMesh::default()
    }
}

/// The boundary's own surface encloses what the cells fill: two ways through core.
#[test]
fn a_mixed_cage_fills_its_boundary() {
    let cage = house();
    let level = Level::new(&cage).unwrap();
    let surface = Enclosure::of_cage(&level, &cage.features).unwrap();
    let whole = surface.control_forms(SurfaceScheme::TriQuad).unwrap();
    let rules = region::Rules {
        scheme: SolidScheme::Mixed,
        diagonals: None,
        boundary: BoundaryRule::TriQuad,
    };
    let cells = region::forms(&cage, rules, Some(1)).unwrap();
    let [[a, b], [c, d]] =
        [whole, cells.clone()].map(|forms| forms.map(|form| form.volume(&cage.points)));
    assert!(
        (a - c).abs() <= (a - b).abs() + (c - d).abs(),
        "{a} {b} {c} {d}"
    );
    assert!((a - b).abs() < 1e-3 * a, "{a} {b}");
    // All cells are those with the label 1.
    assert_eq!(cells, region::forms(&cage, rules, None).unwrap());
    // The smooth solid lies within the house of 8 + 4/3 + 4.
    assert!(a > 5.0 && a < 13.4, "{a}");
}

#[test]
fn the_command_says_how_wrong_it_may_be() {
    let folder = Folder::new();
    let shape = half_cut(&cubes(&[[0, 0, 0]]));
    let mut text = String::new();
    for [x, y, z] in &shape.points {
        text += &format!("v {x} {y} {z}\n");
    }
    for face in &shape.faces {
        let corners = face.iter().map(|vertex| format!(" {}", vertex + 1));
        text += &format!("f{}\n", corners.collect::<String>());
    }
    let cube = folder.write("cube.obj", &text);
    let volume = |arguments: &[&str]| {
        let mut command = octruss();
        command.arg("volume").arg(&cube).args(arguments);
        command.assert()
    };
    volume(&["--scheme", "tri-quad", "--moments", "--device", "--json"])
        .success()
        .stdout(contains("\"inertia_error_estimate\""))
        .stdout(contains("\"error_bound\""))
        .stdout(contains("\"error_estimate\"").not());
    let corner = folder.write("corner.txt", "corner 0\n");
    let corner = corner.to_str().unwrap();
    let creased = ["--scheme", "tri-quad", "--features", corner];
    volume(&[&creased[..], &["--moments", "--json"]].concat())
        .success()
        .stdout(contains("\"error_estimate\""));
    volume(&["--scheme", "sqrt3"])
        .failure()
        .stderr(contains("triangle"));
    volume(&[&creased[..], &["--picture", "none.png"]].concat())
        .failure()
        .stderr(contains("no exact form"));
}
