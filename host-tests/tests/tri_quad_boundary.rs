//! The surface scheme `tri-quad` beside the mixed solids whose boundary follows the same rule: where a
//! solid's boundary is a surface, its refined boundary is the refined surface, to the bit.

use std::collections::BTreeSet;

use octruss::blend::FixedBlend;
use octruss_host_tests::mixed_subject;
use octruss_host_tests::random_mixed::MixedCase;
use octruss_host_tests::reference_mixed::{Boundary, Mesh, Names, find_boundary};
use octruss_host_tests::reference_surface::{Border, Polygons, edge};
use octruss_host_tests::surface_subject::refine_tri_quad;

/// How many random solids. `cargo xtask verify` sets the variable.
fn cases() -> u64 {
    std::env::var("OCTRUSS_CASES").map_or(300, |count| count.parse().expect("a number"))
}

/// A solid's boundary as a control mesh with the solid's vertices.
fn skin(mesh: &Mesh) -> Polygons {
    let triangles = mesh.triangles.iter().map(|face| face.to_vec());
    let quads = mesh.quads.iter().map(|face| face.to_vec());
    Polygons {
        vertex_count: mesh.vertex_count,
        faces: triangles.chain(quads).collect(),
        creases: mesh.creases.clone(),
        corners: mesh.corners.clone(),
        odd: false,
    }
}

/// The solid's number of every vertex of the refined skin.
fn names(mesh: &Mesh, skin: &Polygons) -> Vec<u32> {
    let names = Names::new(mesh);
    let edges = skin.edges().into_keys().map(|ends| names.vertex(&ends, 0));
    let quads = skin.sorted_faces().into_iter();
    let quads = quads.filter(|face| skin.faces[*face].len() == 4);
    let middles = quads.map(|face| names.vertex(&skin.faces[face], 0));
    (0..mesh.vertex_count).chain(edges).chain(middles).collect()
}

/// Faces from their least corners on.
fn turned(faces: impl Iterator<Item = Vec<u32>>) -> BTreeSet<Vec<u32>> {
    faces
        .map(|mut face| {
            let least = (0..face.len()).min_by_key(|place| face[*place]);
            face.rotate_left(least.unwrap_or_default());
            face
        })
        .collect()
}

/// Whether a triangle of the boundary is the open half of a quadrilateral that a triangle covers on
/// its other half. There the cell's quadrilaterals stay faces, so the solid's split is another; the
/// values are the same.
fn has_half_quads(mesh: &Mesh) -> bool {
    let names = Names::new(mesh);
    let mut triangles = mesh.triangles.iter();
    triangles.any(|triangle| names.open_apex(triangle).is_some())
}

/// Two levels of every random solid whose boundary has two faces at each of its edges (cells that
/// touch along an edge alone have four there, which a solid does not take for sharp and a surface
/// does), with the creases that run along the boundary.
#[test]
fn a_mixed_solids_boundary_is_the_surface() {
    let (mut levels, mut same_faces, mut coordinates, mut mixed) = (0, 0, 0, 0);
    for seed in 0..cases() {
        let case = MixedCase::new(seed, 14);
        let (mut mesh, mut points) = (case.mesh, case.points);
        // Sheets and creases inside are none of the surface's.
        find_boundary(&mut mesh);
        let edges = skin(&mesh).edges();
        if edges.values().any(|on| on.len() != 2) {
            continue;
        }
        mesh.creases
            .retain(|[a, b]| edges.contains_key(&edge(*a, *b)));
        for level in 0..2 {
            let surface = skin(&mesh);
            let mut blend = FixedBlend::<i32, 3>::new();
            let (refined, got) =
                refine_tri_quad(&mut blend, Border::Spline, &surface, &points).expect("a surface");
            let (next, want, _) =
                mixed_subject::refine_bits(&mesh, Boundary::TriQuad, &points).expect("a solid");
            let names = names(&mesh, &surface);
            let used: BTreeSet<u32> = refined.faces.iter().flatten().copied().collect();
            for vertex in used {
                let name = names[vertex as usize] as usize;
                let pair = (got[vertex as usize], want[name]);
                assert_eq!(pair.0, pair.1, "seed {seed}, level {level}, vertex {name}");
                coordinates += 3;
            }
            if !has_half_quads(&mesh) {
                let renamed = refined.faces.iter().map(|face| {
                    let corners = face.iter().map(|vertex| names[*vertex as usize]);
                    corners.collect::<Vec<u32>>()
                });
                let faces = skin(&next).faces.into_iter();
                assert_eq!(turned(renamed), turned(faces), "seed {seed}, level {level}");
                same_faces += 1;
            }
            levels += 1;
            mixed += u64::from(!mesh.triangles.is_empty() && !mesh.quads.is_empty());
            (mesh, points) = (next, want);
        }
    }
    println!("{levels} levels, {mixed} with both shapes, {coordinates} coordinates, all equal");
    assert!(levels > cases() / 2 && mixed > cases() / 8 && same_faces > cases() / 4);
}
