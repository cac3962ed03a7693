//! The crate's mixed scheme against the independent f64 reference, bit for bit, and what must hold
//! of every refinement: levels one after the other, translations, reordering.

use std::collections::{BTreeMap, BTreeSet};

use octruss::blend::FixedBlend;
use octruss::mesh::{Numbering, Solid, edge_capacity};
use octruss::solid::tet_oct;
use octruss::surface::LoopWeights;
use octruss_host_tests::mixed_subject;
use octruss_host_tests::random_mixed::{MixedCase, shuffled};
use octruss_host_tests::reference_mixed::{self, Boundary, Class, Mesh, faces};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng as _;

/// How many random solids. `cargo xtask verify` sets the variable.
fn cases() -> u64 {
    std::env::var("OCTRUSS_CASES").map_or(300, |count| count.parse().expect("a number"))
}

#[test]
fn bits_are_those_of_the_reference() {
    let mut values = 0;
    for seed in 0..cases() {
        let case = MixedCase::new(seed, 14);
        let (mut mesh, mut points) = (case.mesh.clone(), case.points.clone());
        for level in 0..case.levels {
            let want = reference_mixed::refine(&mesh, case.boundary, &points);
            let got = mixed_subject::refine_bits(&mesh, case.boundary, &points)
                .unwrap_or_else(|error| panic!("seed {seed}: {error}"));
            assert!(got.0 == want.0, "connectivity, seed {seed}, level {level}");
            for (vertex, (got, want)) in got.1.iter().zip(&want.1).enumerate() {
                if got != want {
                    panic!("seed {seed}, level {level}, vertex {vertex}: {got:?}, not {want:?}");
                }
            }
            assert_eq!(got.2, want.2, "saturated, seed {seed}");
            values += 3 * got.1.len();
            (mesh, points) = (got.0, got.1);
        }
    }
    println!("{} solids, {values} coordinates, 0 mismatches", cases());
}

#[test]
fn both_find_the_same_boundary() {
    for seed in 0..cases() {
        let case = MixedCase::new(seed, 30);
        let (mut got, mut want) = (case.mesh.clone(), case.mesh);
        mixed_subject::find_boundary(&mut got).expect("a sound mesh");
        reference_mixed::find_boundary(&mut want);
        assert_eq!(got, want, "seed {seed}");
    }
}

/// The sides of a surface's faces, in both directions.
fn sides(mesh: &Mesh) -> impl Iterator<Item = [u32; 2]> {
    let triangles = mesh.triangles.iter().map(|face| face.as_slice());
    let quads = mesh.quads.iter().map(|face| face.as_slice());
    triangles.chain(quads).flat_map(|face| {
        let next = face.iter().cycle().skip(1);
        face.iter().zip(next).flat_map(|(&a, &b)| [[a, b], [b, a]])
    })
}

/// The faces of a surface as sets: which corners, and how many faces have them.
fn face_sets(mesh: &Mesh) -> BTreeMap<BTreeSet<u32>, usize> {
    let mut sets = BTreeMap::new();
    let triangles = mesh
        .triangles
        .iter()
        .map(|face| face.iter().copied().collect());
    let quads = mesh.quads.iter().map(|face| face.iter().copied().collect());
    for set in triangles.chain(quads) {
        *sets.entry(set).or_insert(0) += 1;
    }
    sets
}

/// The surface that a split hands on is the boundary of the refined cells: so refining a refined
/// mesh that was written to a file gives what refining twice gives.
#[test]
fn the_split_of_the_boundary_is_the_boundary_of_the_split() {
    for seed in 0..cases() {
        let case = MixedCase::new(seed, 12);
        let mut mesh = case.mesh;
        reference_mixed::find_boundary(&mut mesh);
        // Sheets that no cell has are gone from the surface, and so are the creases along them.
        let on_surface: BTreeSet<[u32; 2]> = sides(&mesh).collect();
        mesh.creases.retain(|edge| on_surface.contains(edge));
        let (next, points, _) =
            mixed_subject::refine_bits(&mesh, case.boundary, &case.points).expect("a sound mesh");
        let mut found = next.clone();
        reference_mixed::find_boundary(&mut found);
        assert_eq!(face_sets(&found), face_sets(&next), "seed {seed}");
        if seed % 10 == 0 {
            let one = mixed_subject::refine_bits(&next, case.boundary, &points);
            let other = mixed_subject::refine_bits(&found, case.boundary, &points);
            let (one, other) = (one.expect("a sound mesh"), other.expect("a sound mesh"));
            assert_eq!(one.1, other.1, "seed {seed}");
        }
    }
}

/// Moving all points by whole units moves all results by them.
#[test]
fn translations_commute_to_the_bit() {
    for seed in 0..cases() {
        let case = MixedCase::new(seed, 12);
        let small: Vec<[i32; 3]> = case
            .points
            .iter()
            .map(|point| point.map(|x| x / 8))
            .collect();
        let offset = [12_345_677, -98_765_431, 3];
        let moved = |points: &[[i32; 3]]| -> Vec<[i32; 3]> {
            let add = |point: &[i32; 3]| [0, 1, 2].map(|axis| point[axis] + offset[axis]);
            points.iter().map(add).collect()
        };
        let refine = |points: &[[i32; 3]]| {
            let refined = mixed_subject::refine_bits(&case.mesh, case.boundary, points);
            refined.expect("a sound mesh").1
        };
        assert_eq!(
            refine(&moved(&small)),
            moved(&refine(&small)),
            "seed {seed}"
        );
    }
}

/// Other numbers and another order of cells change nothing but the order: vertices are recognised by
/// their parents.
#[test]
fn reordering_changes_nothing_but_the_order() {
    for seed in 0..cases() {
        let case = MixedCase::new(seed, 12);
        let mut plain = case.mesh.clone();
        (plain.creases, plain.corners) = (Vec::new(), Vec::new());
        reference_mixed::find_boundary(&mut plain);
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let (mut other, numbers) = shuffled(&mut rng, plain.clone());
        reference_mixed::find_boundary(&mut other);
        let mut points = vec![[0; 3]; other.vertex_count as usize];
        for (old, new) in &numbers {
            points[*new as usize] = case.points[*old as usize];
        }
        let by_parents = |mesh: &Mesh, points: &[[i32; 3]]| {
            let names = reference_mixed::Names::new(mesh);
            let refined = mixed_subject::refine_bits(mesh, case.boundary, points);
            let refined = refined.expect("a sound mesh").1;
            let mut values: Vec<[i32; 3]> = Vec::new();
            for (place, cell) in mesh.cells().iter().enumerate() {
                for group in reference_mixed::children(cell).into_iter().flatten() {
                    let parents: Vec<u32> = group.iter().map(|at| cell.corners[*at]).collect();
                    values.push(refined[names.vertex(&parents, place) as usize]);
                }
            }
            values.sort_unstable();
            values
        };
        let (one, two) = (
            by_parents(&plain, &case.points),
            by_parents(&other, &points),
        );
        assert_eq!(one, two, "seed {seed}");
    }
}

/// Tetrahedra and octahedra alone: the bits of `tet_oct` with `LoopWeights::TriQuad`.
#[test]
fn tetrahedra_and_octahedra_refine_as_by_their_own_scheme() {
    let mut compared = 0;
    for seed in 0..4 * cases() {
        let case = MixedCase::new(seed, 14);
        let mut mesh = case.mesh;
        (mesh.prisms, mesh.hexahedra) = (Vec::new(), Vec::new());
        (mesh.creases, mesh.triangles, mesh.quads) = (Vec::new(), Vec::new(), Vec::new());
        if mesh.cell_count() == 0 {
            continue;
        }
        reference_mixed::find_boundary(&mut mesh);
        if let (Some(&[a, b, c]), true) = (mesh.triangles.first(), seed % 3 == 0) {
            mesh.creases = vec![[a, b], [b, c]];
        }
        let (next, points, saturated) =
            mixed_subject::refine_bits(&mesh, case.boundary, &case.points).expect("a sound mesh");
        let (own, own_saturated) = by_tet_oct(&mesh, case.boundary, &case.points);
        assert_eq!(points, own, "seed {seed}");
        assert_eq!(saturated, own_saturated, "seed {seed}");
        assert_eq!(next.vertex_count as usize, own.len());
        compared += 1;
    }
    assert!(compared > 100);
}

fn by_tet_oct(mesh: &Mesh, boundary: Boundary, points: &[[i32; 3]]) -> (Vec<[i32; 3]>, usize) {
    let solid = Solid {
        vertex_count: mesh.vertex_count,
        tetrahedra: &mesh.tetrahedra,
        octahedra: &mesh.octahedra,
        surface: &mesh.triangles,
        creases: &mesh.creases,
        corners: &mesh.corners,
        ..Solid::default()
    };
    let mut edges = vec![[0; 2]; edge_capacity(&solid).expect("it fits")];
    let mut order = vec![0; solid.octahedra.len()];
    let numbering = Numbering::new(&solid, &mut edges, &mut order).expect("a sound mesh");
    let count = numbering.vertex_count() as usize;
    let mut out = vec![[0; 3]; count];
    let buffers = octruss::solid::PointBuffers {
        out: &mut out,
        sums: &mut vec![[0; 3]; count],
        states: &mut vec![octruss::solid::VertexState::default(); count],
    };
    let rule = match boundary {
        Boundary::TriQuad => octruss::solid::Boundary::Surface(LoopWeights::TriQuad),
        Boundary::Interior => octruss::solid::Boundary::Interior,
        Boundary::Fixed => octruss::solid::Boundary::Fixed,
    };
    let mut blend = FixedBlend::<i32, 3>::new();
    tet_oct::refine_points(&mut blend, &solid, &numbering, rule, points, buffers)
        .expect("a sound mesh");
    (out, blend.saturated() as usize)
}

/// The random solids have what they are for: every kind of pair, covered and half-covered
/// quadrilaterals, surface quadrilaterals and triangles, saturation.
#[test]
fn random_solids_have_every_kind_of_pair() {
    let mut kinds: BTreeMap<(Class, usize, Class, usize), usize> = BTreeMap::new();
    let (mut open, mut mixed_edges, mut two_levels, mut saturating) = (0, 0, 0, 0);
    for seed in 0..600 {
        let case = MixedCase::new(seed, 14);
        let all: Vec<_> = case.mesh.cells().iter().flat_map(faces).collect();
        for one in &all {
            for other in &all {
                let is_on = other.is_touched_by(&one.cycle) || one.sorted() == other.sorted();
                if is_on && one.class < other.class {
                    let kind = (one.class, one.cycle.len(), other.class, other.cycle.len());
                    *kinds.entry(kind).or_default() += 1;
                }
            }
        }
        let names = reference_mixed::Names::new(&case.mesh);
        let is_open = |face: &[u32; 3]| names.open_apex(face).is_some();
        open += case
            .mesh
            .triangles
            .iter()
            .filter(|face| is_open(face))
            .count();
        mixed_edges += usize::from(!case.mesh.triangles.is_empty() && !case.mesh.quads.is_empty());
        two_levels += usize::from(case.levels == 2);
        let (_, _, saturated) = reference_mixed::refine(&case.mesh, case.boundary, &case.points);
        saturating += usize::from(saturated > 0);
    }
    assert_eq!(kinds.len(), 5, "{kinds:?}");
    assert!(kinds.values().all(|count| *count > 20), "{kinds:?}");
    assert!(open > 20 && mixed_edges > 50, "{open} {mixed_edges}");
    assert!(
        two_levels > 10 && saturating > 5,
        "{two_levels} {saturating}"
    );
}
