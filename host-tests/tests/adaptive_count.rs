//! Kobbelt, "sqrt(3)-Subdivision", figure 11: adaptive square-root-3 meshes need fewer triangles than adaptive Loop
//! meshes of the same tolerance. What is counted is written again in [`adaptive_count`](octruss_host_tests), and held
//! against core here.

use std::collections::BTreeMap;
use std::path::PathBuf;

use octruss::surface::sqrt3::adaptive::Patch;
use octruss_bake::refine::RealBlend;
use octruss_host_tests::adaptive_count::loop_rule::Green;
use octruss_host_tests::adaptive_count::meshes::{self, Closed};
use octruss_host_tests::adaptive_count::sqrt3::Sqrt3Mesh;
use octruss_host_tests::adaptive_count::surface::{Point, Rule, Surface};
use octruss_host_tests::adaptive_count::{counts, saving};
use octruss_host_tests::reference_surface::{Border, Family, Polygons};
use octruss_host_tests::surface_subject::{AdaptiveMemory, Scheme, limit, refine};

fn all() -> Vec<Closed> {
    let models = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../models");
    meshes::all(&models).expect("the models can be read")
}

/// The paper says 5 to 25 %; 13 to 24 % is what an independent program found on three meshes with the red-green
/// triangulation, as a geometric mean over log-spaced tolerances. Against the rival whose green triangles are fans of
/// two or three, which the paper does not name, something must still be saved.
#[test]
fn fewer_triangles_than_loop() {
    let judge = |mesh: &Closed| {
        let halves = saving(&counts(mesh, Green::Halves));
        assert!((0.13..=0.24).contains(&halves), "{}: {halves}", mesh.name);
        let fans = saving(&counts(mesh, Green::Fans));
        assert!((0.0..halves).contains(&fans), "{}: {fans}", mesh.name);
        println!("{}: {halves:.3}, against fans {fans:.3}", mesh.name);
    };
    // Side by side: each takes its time.
    let meshes = all();
    std::thread::scope(|scope| {
        for mesh in &meshes {
            scope.spawn(move || judge(mesh));
        }
    });
}

fn polygons(mesh: &Closed) -> Polygons {
    Polygons {
        vertex_count: mesh.points.len() as u32,
        faces: mesh.triangles.iter().map(|own| own.to_vec()).collect(),
        ..Polygons::default()
    }
}

/// A triangle to look up: generation and corners in the limit in units of 1e-9, from the least on.
fn key(generation: u32, corners: [Point; 3]) -> (u32, [[i64; 3]; 3]) {
    let mut corners = corners.map(|point| point.map(|own| (own * 1e9).round() as i64));
    let least = (0..3).min_by_key(|i| corners[*i]).unwrap_or_default();
    corners.rotate_left(least);
    (generation, corners)
}

/// The splitting procedure here and core's leave the same triangles, wherever a threshold sends them.
#[test]
fn the_splitting_procedure_is_cores() {
    for mesh in all() {
        let x = || mesh.points.iter().map(|point| point[0]);
        let threshold = x().sum::<f64>() / mesh.points.len() as f64 + 0.01 * mesh.extent();
        let wants = |generation: u32, limits: &[Point; 3]| {
            let x = || limits.iter().map(|limit| limit[0]);
            let crosses = x().any(|x| x < threshold) && x().any(|x| x > threshold);
            crosses && generation < 9
        };
        let mut own = Sqrt3Mesh::new(&mesh.points, &mesh.triangles);
        own.refine(|measure, triangle| {
            let limits = triangle.corners.map(|corner| measure.surface.limit(corner));
            wants(triangle.generation, &limits)
        });
        let mut memory = AdaptiveMemory::new(100_000, 50_000, 300_000, [0.0; 3]);
        let mut core = memory
            .start::<RealBlend>(&polygons(&mesh), &mesh.points)
            .expect("a closed mesh");
        core.refine_where(&mut RealBlend, 30, |patch: &Patch<Point>| {
            wants(patch.generation, &patch.limits)
        })
        .expect("memory enough");
        let mut left: BTreeMap<_, u32> = BTreeMap::new();
        for triangle in &own.triangles {
            let limits = triangle
                .corners
                .map(|corner| own.measure.surface.limit(corner));
            *left.entry(key(triangle.generation, limits)).or_default() += 1;
        }
        let count = core.triangles().len();
        assert!(count > 4 * mesh.triangles.len(), "{count}");
        assert_eq!(count, own.triangles.len(), "{}", mesh.name);
        for triangle in 0..count as u32 {
            let patch = core.patch(&mut RealBlend, triangle).expect("a triangle");
            let known = left.get_mut(&key(patch.generation, patch.limits));
            let known = known.unwrap_or_else(|| panic!("{}: {patch:?}", mesh.name));
            *known = known.checked_sub(1).expect("as often as here");
        }
    }
}

/// Limit points of the surfaces that are measured are core's, two levels on, to 1e-12 of the extent.
#[test]
fn limit_points_are_cores() {
    for mesh in all() {
        for (rule, scheme, times, levels) in [
            (Rule::Sqrt3, Scheme::Sqrt3, 1, 2),
            (Rule::Loop, Scheme::Loop(Family::Loop), 2, 2),
        ] {
            let mut surface = Surface::new(rule, &mesh.points, &mesh.triangles);
            let mut own = Vec::new();
            for triangle in &mesh.triangles {
                let samples = surface.samples(0, *triangle, times);
                own.extend(samples.into_values());
            }
            own.sort_unstable();
            own.dedup();
            let mut own: Vec<Point> = own.into_iter().map(|own| surface.limit(own)).collect();
            let blend = &mut RealBlend;
            let (mut refined, mut points) = (polygons(&mesh), mesh.points.clone());
            for _ in 0..levels {
                (refined, points) =
                    refine(blend, scheme, Border::Spline, &refined, &points).expect("triangles");
            }
            let mut want = limit(blend, scheme, Border::Spline, &refined, &points).expect("closed");
            // In the order of a direction that no two of them share.
            let along = |p: &Point| p[0] + 0.618_034 * p[1] + 0.271_828 * p[2];
            own.sort_by(|a, b| along(a).total_cmp(&along(b)));
            want.sort_by(|a, b| along(a).total_cmp(&along(b)));
            assert_eq!(own.len(), want.len(), "{} {rule:?}", mesh.name);
            let extent = mesh.extent();
            for (own, want) in own.iter().flatten().zip(want.iter().flatten()) {
                assert!(
                    (own - want).abs() < 1e-12 * extent,
                    "{} {rule:?}",
                    mesh.name
                );
            }
        }
    }
}
