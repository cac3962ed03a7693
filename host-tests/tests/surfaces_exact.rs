//! The crate's surface schemes against the independent reference, bit for bit, on random control
//! meshes.
//!
//! `OCTRUSS_CASES` sets how many cases each scheme gets; the default keeps the suite quick.

use octruss::blend::FixedBlend;
use octruss_host_tests::random_surface::{Shape, SurfaceCase, Wishes};
use octruss_host_tests::reference_surface::{
    Border, Family, Grid, Polygons, Refined, apply, catmull_clark, catmull_clark_limit, loop_limit,
    loop_rule,
};
use octruss_host_tests::surface_subject::{Scheme, limit, refine_bits};

fn case_count() -> u64 {
    let wanted = std::env::var("OCTRUSS_CASES").ok();
    wanted.and_then(|count| count.parse().ok()).unwrap_or(400)
}

const BORDERS: [Border; 3] = [Border::Spline, Border::SplineWithCorners, Border::Fixed];

/// Refines up to three levels with both and compares everything.
fn compare(
    seed: u64,
    wishes: Wishes,
    scheme: Scheme,
    reference: impl Fn(&Polygons, Border) -> Refined,
) -> (Polygons, Vec<[i32; 3]>) {
    let SurfaceCase {
        mut mesh,
        mut points,
    } = SurfaceCase::new(seed, wishes);
    let border = BORDERS[(seed % 3) as usize];
    for level in 0..1 + seed % 3 {
        let want = reference(&mesh, border);
        let want_points = want.points(&points);
        let (got, got_points) = refine_bits(scheme, border, &mesh, &points)
            .unwrap_or_else(|error| panic!("seed {seed}, level {level}: {error}"));
        assert_eq!(got, want.mesh, "seed {seed}, level {level}");
        assert_eq!(got_points, want_points, "seed {seed}, level {level}");
        (mesh, points) = (got, got_points);
    }
    (mesh, points)
}

fn wishes(shape: Shape) -> Wishes {
    Wishes {
        shape,
        open: true,
        features: true,
        tangled: true,
    }
}

#[test]
fn catmull_clark_equals_the_reference() {
    for seed in 0..case_count() {
        let (mesh, points) = compare(
            seed,
            wishes(Shape::Polygons),
            Scheme::CatmullClark,
            catmull_clark,
        );
        let border = BORDERS[(seed % 3) as usize];
        let mut blend = FixedBlend::<i32, 3>::new();
        let got = limit(&mut blend, Scheme::CatmullClark, border, &mesh, &points);
        let want = apply(&catmull_clark_limit(&mesh, border), &points);
        assert_eq!(got, Ok(want), "seed {seed}, limit");
        assert_eq!(blend.saturated(), 0);
    }
}

#[test]
fn loop_equals_the_reference() {
    for seed in 0..case_count() {
        let family = [Family::Loop, Family::Warren, Family::TriQuad][(seed / 3 % 3) as usize];
        let scheme = Scheme::Loop(family);
        let (mesh, points) = compare(seed, wishes(Shape::Triangles), scheme, |mesh, border| {
            loop_rule(mesh, family, border, Grid::Device)
        });
        let border = BORDERS[(seed % 3) as usize];
        let mut blend = FixedBlend::<i32, 3>::new();
        let got = limit(&mut blend, scheme, border, &mesh, &points);
        let want = apply(&loop_limit(&mesh, family, border, Grid::Device), &points);
        assert_eq!(got, Ok(want), "seed {seed}, limit");
        assert_eq!(blend.saturated(), 0);
    }
}
