//! The crate's surface schemes against the independent reference, bit for bit, on random control
//! meshes.
//!
//! `OCTRUSS_CASES` sets how many cases each scheme gets; the default keeps the suite quick.

use std::collections::{BTreeMap, BTreeSet};

use octruss::blend::FixedBlend;
use octruss::mesh::MeshError;
use octruss_host_tests::random_surface::{Shape, SurfaceCase, Wishes};
use octruss_host_tests::reference_surface::{
    Border, Family, Grid, Polygons, Refined, Row, apply, butterfly, catmull_clark,
    catmull_clark_limit, doo_sabin, loop_limit, loop_rule, sqrt3, sqrt3_limit, tri_quad,
};
use octruss_host_tests::surface_subject::{
    AdaptiveMemory, Scheme, limit, refine_bits, refine_tri_quad,
};

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

#[test]
fn doo_sabin_equals_the_reference() {
    let mut compared = 0;
    for seed in 0..case_count() {
        let SurfaceCase {
            mut mesh,
            mut points,
        } = SurfaceCase::new(
            seed,
            Wishes {
                features: false,
                tangled: false,
                ..wishes(Shape::Polygons)
            },
        );
        for level in 0..1 + seed % 3 {
            let (got, got_points) =
                match refine_bits(Scheme::DooSabin, Border::Spline, &mesh, &points) {
                    Ok(got) => got,
                    // Taking faces out can leave two fans that touch.
                    Err(MeshError::NotManifold { vertex }) => {
                        assert!(mesh.has_two_fans(vertex), "seed {seed}: {vertex}");
                        break;
                    }
                    Err(error) => panic!("seed {seed}, level {level}: {error}"),
                };
            let want = doo_sabin(&mesh, Grid::Device);
            assert_eq!(got, want.mesh, "seed {seed}, level {level}");
            assert_eq!(
                got_points,
                want.points(&points),
                "seed {seed}, level {level}"
            );
            (mesh, points) = (got, got_points);
            compared += 1;
        }
        let mut blend = FixedBlend::<i32, 3>::new();
        let got = limit(&mut blend, Scheme::DooSabin, Border::Spline, &mesh, &points);
        let faces = mesh.faces.iter().map(Vec::as_slice);
        let want: Vec<Row> = faces.map(Row::mean).collect();
        if let Ok(got) = got {
            assert_eq!(got, apply(&want, &points), "seed {seed}, limit");
        }
    }
    assert!(compared > case_count());
}

/// Closed and open meshes with creases, darts and corners, edges of three faces; coordinates at the ends of
/// their range, where weights of either sign saturate.
#[test]
fn tri_quad_equals_the_reference() {
    let (mut mixed, mut saturated) = (0, 0);
    for seed in 0..case_count() {
        let mut case = SurfaceCase::new(seed, wishes(Shape::TrianglesAndQuads));
        if seed % 5 == 0 {
            case = case.at_the_ends();
        }
        let SurfaceCase {
            mut mesh,
            mut points,
        } = case;
        let border = BORDERS[(seed % 3) as usize];
        for level in 0..1 + seed % 3 {
            let count = |corners: usize| mesh.faces.iter().filter(|f| f.len() == corners).count();
            mixed += u64::from(count(3) > 0 && count(4) > 0);
            let want = tri_quad(&mesh, border);
            let mut blend = FixedBlend::<i32, 3>::new();
            let (got, got_points) = refine_tri_quad(&mut blend, border, &mesh, &points)
                .unwrap_or_else(|error| panic!("seed {seed}, level {level}: {error}"));
            assert_eq!(got, want.mesh, "seed {seed}, level {level}");
            let wanted = want.points(&points);
            assert_eq!(got_points, wanted, "seed {seed}, level {level}");
            let clamped = want.count_saturated(&points);
            assert_eq!(blend.saturated() as usize, clamped, "seed {seed}");
            saturated += clamped;
            (mesh, points) = (got, got_points);
        }
    }
    assert!(
        mixed > case_count() / 2 && saturated > 0,
        "{mixed}, {saturated}"
    );
}

/// On triangles alone the scheme is Loop's with 3/(8n) of each neighbour.
#[test]
fn tri_quad_on_triangles_is_loops_scheme() {
    for seed in 0..case_count() / 4 {
        let SurfaceCase { mesh, points } = SurfaceCase::new(seed, wishes(Shape::Triangles));
        let border = BORDERS[(seed % 3) as usize];
        let want = refine_bits(Scheme::Loop(Family::TriQuad), border, &mesh, &points);
        let mut blend = FixedBlend::<i32, 3>::new();
        let got = refine_tri_quad(&mut blend, border, &mesh, &points);
        assert_eq!(got, want, "seed {seed}");
        assert!(got.is_ok(), "seed {seed}");
    }
}

#[test]
fn butterfly_equals_the_reference() {
    for modified in [false, true] {
        for seed in 0..case_count() {
            let wishes = Wishes {
                tangled: false,
                ..wishes(Shape::Triangles)
            };
            compare(
                seed,
                wishes,
                Scheme::Butterfly { modified },
                |mesh, border| butterfly(mesh, modified, border, Grid::Device),
            );
        }
    }
}

/// As many steps as the mesh can take: a crease that ends or crosses cannot be cut in three, and
/// then the crate must say so.
#[test]
fn sqrt3_equals_the_reference() {
    let mut odd_steps = 0;
    let mut limits = 0;
    for seed in 0..case_count() {
        let wishes = Wishes {
            features: seed % 4 == 0,
            tangled: false,
            ..wishes(Shape::Triangles)
        };
        let SurfaceCase {
            mut mesh,
            mut points,
        } = SurfaceCase::new(seed, wishes);
        for level in 0..1 + seed % 4 {
            let (got, got_points) = match refine_bits(Scheme::Sqrt3, Border::Spline, &mesh, &points)
            {
                Ok(got) => got,
                Err(MeshError::NotTrisectable { vertex }) => {
                    assert!(mesh.odd && mesh.is_end(vertex), "seed {seed}");
                    break;
                }
                Err(error) => panic!("seed {seed}, level {level}: {error}"),
            };
            odd_steps += u32::from(mesh.odd && !mesh.sharp_edges().is_empty());
            let want = sqrt3(&mesh, Grid::Device);
            assert_eq!(got, want.mesh, "seed {seed}, level {level}");
            assert_eq!(
                got_points,
                want.points(&points),
                "seed {seed}, level {level}"
            );
            (mesh, points) = (got, got_points);
        }
        let mut blend = FixedBlend::<i32, 3>::new();
        match limit(&mut blend, Scheme::Sqrt3, Border::Spline, &mesh, &points) {
            Ok(got) => {
                assert_eq!(got, apply(&sqrt3_limit(&mesh, Grid::Device), &points));
                limits += 1;
            }
            Err(MeshError::OddBoundary) => {
                assert!(mesh.odd && !mesh.sharp_edges().is_empty());
            }
            Err(MeshError::NotTrisectable { vertex }) => assert!(mesh.is_end(vertex)),
            Err(error) => panic!("seed {seed}: {error}"),
        }
    }
    assert!(odd_steps > 10 && limits > 100, "{odd_steps}, {limits}");
}

/// Every triangle of an adaptive mesh is one of the uniform hierarchy, and every position is equal:
/// triangles are looked up by the bits of their corners.
#[test]
fn adaptive_sqrt3_is_part_of_the_uniform_hierarchy() {
    let mut checked = 0;
    for seed in 0..case_count() / 4 {
        let wishes = Wishes {
            shape: Shape::Triangles,
            open: false,
            features: false,
            tangled: false,
        };
        let case = SurfaceCase::new(seed, wishes);
        let levels = 3_u32;
        let hierarchy = uniform(&case, levels);
        let mut memory = AdaptiveMemory::new(20_000, 10_000, 60_000, [0; 3]);
        let mut blend = FixedBlend::<i32, 3>::new();
        let mut adaptive = match memory.start::<FixedBlend<i32, 3>>(&case.mesh, &case.points) {
            Ok(adaptive) => adaptive,
            Err(error) => panic!("seed {seed}: {error}"),
        };
        let pivot = case.points[0][0];
        let wants = |corners: &[[i32; 3]; 3]| match seed % 3 {
            0 => corners.iter().any(|corner| corner[0] < pivot),
            1 => {
                corners.iter().map(|corner| corner[0]).min() <= Some(pivot)
                    && corners.iter().map(|corner| corner[0]).max() >= Some(pivot)
            }
            _ => true,
        };
        adaptive
            .refine_where(&mut blend, levels, |patch| wants(&patch.corners))
            .unwrap_or_else(|error| panic!("seed {seed}: {error}"));
        let triangles = adaptive.triangles().to_vec();
        check_joined(&triangles, seed);
        for (place, triangle) in triangles.iter().enumerate() {
            let patch = adaptive.patch(&mut blend, place as u32).unwrap();
            let level = (triangle.generation / 2) as usize;
            let known = if triangle.generation % 2 == 0 {
                hierarchy[level].faces.contains(&least_first(patch.corners))
            } else {
                let [centre, a, b] = patch.corners;
                hierarchy[level].centres.contains(&(a, b, centre))
            };
            assert!(known, "seed {seed}, triangle {place}: {patch:?}");
            checked += 1;
        }
        if seed % 3 == 2 {
            assert_eq!(triangles.len(), case.mesh.faces.len() * 27, "seed {seed}");
            assert!(triangles.iter().all(|t| t.generation == 2 * levels));
        }
    }
    assert!(checked > 1000);
}

type Corner = [i32; 3];

/// A level's triangles by their corners' bits, and what the next level puts into them: two corners
/// and the new vertex, side by side.
#[derive(Default)]
struct Level {
    faces: BTreeSet<[Corner; 3]>,
    centres: BTreeSet<(Corner, Corner, Corner)>,
}

fn uniform(case: &SurfaceCase, levels: u32) -> Vec<Level> {
    let (mut mesh, mut points) = (case.mesh.clone(), case.points.clone());
    let mut hierarchy = Vec::new();
    for _ in 0..=levels {
        let (next, next_points) =
            refine_bits(Scheme::Sqrt3, Border::Spline, &mesh, &points).unwrap();
        let mut level = Level::default();
        let first = mesh.vertex_count as usize;
        for (rank, face) in mesh.sorted_faces().into_iter().enumerate() {
            let corner = |i: usize| points[mesh.faces[face][i % 3] as usize];
            level
                .faces
                .insert(least_first([corner(0), corner(1), corner(2)]));
            for i in 0..3 {
                let centre = next_points[first + rank];
                level.centres.insert((corner(i), corner(i + 1), centre));
            }
        }
        hierarchy.push(level);
        (mesh, points) = (next, next_points);
    }
    hierarchy
}

fn least_first(mut corners: [Corner; 3]) -> [Corner; 3] {
    let least = (0..3).min_by_key(|i| (corners[*i], corners[(*i + 1) % 3], corners[(*i + 2) % 3]));
    corners.rotate_left(least.unwrap_or_default());
    corners
}

/// Neighbours point at one another over the same edge, and generations differ by one at most.
fn check_joined(triangles: &[octruss::surface::sqrt3::adaptive::AdaptiveTriangle], seed: u64) {
    let mut sides: BTreeMap<(u32, u32), usize> = BTreeMap::new();
    for (place, triangle) in triangles.iter().enumerate() {
        for i in 0..3 {
            let side = (triangle.vertices[i], triangle.vertices[(i + 1) % 3]);
            assert!(sides.insert(side, place).is_none(), "seed {seed}");
        }
    }
    for (place, triangle) in triangles.iter().enumerate() {
        for i in 0..3 {
            let (from, to) = (triangle.vertices[i], triangle.vertices[(i + 1) % 3]);
            let beyond = sides[&(to, from)];
            assert_eq!(triangle.neighbours[(i + 2) % 3] as usize, beyond);
            let difference = triangle.generation.abs_diff(triangles[beyond].generation);
            assert!(difference <= 1, "seed {seed}, {place} and {beyond}");
        }
    }
}
