//! Mixed solids in the host tools: the levels that `octruss refine` and `octruss bake` go through,
//! against the independent reference.

use std::collections::BTreeSet;

use octruss_bake::mesh::{Cells, Features, Labels, Shape, SolidMesh};
use octruss_bake::refine::{BoundaryRule, Level, MixedLevelCounts, Refinement, Scheme};
use octruss_host_tests::random_mixed::MixedCase;
use octruss_host_tests::reference_mixed::{self, Boundary, Mesh};

/// How many random solids. `cargo xtask verify` sets the variable.
fn cases() -> u64 {
    std::env::var("OCTRUSS_CASES").map_or(150, |count| count.parse().expect("a number"))
}

/// A random solid without sheets. Its first tetrahedron's first face and its first hexahedron's
/// last one belong to a crease surface, if they lie inside.
fn random(seed: u64) -> (SolidMesh, MixedCase) {
    let mut case = MixedCase::new(seed, 14);
    reference_mixed::find_boundary(&mut case.mesh);
    let mesh = &mut case.mesh;
    let cells = Cells {
        tetrahedra: mesh.tetrahedra.clone(),
        octahedra: mesh.octahedra.clone(),
        prisms: mesh.prisms.clone(),
        hexahedra: mesh.hexahedra.clone(),
    };
    let edges: BTreeSet<[u32; 2]> = cells
        .iter()
        .flat_map(|(shape, corners)| {
            let ends = shape.edges().iter();
            ends.map(|[a, b]| [corners[*a], corners[*b]].map(|end| end))
        })
        .map(|[a, b]| [a.min(b), a.max(b)])
        .collect();
    mesh.creases
        .retain(|[a, b]| edges.contains(&[*a.min(b), *a.max(b)]));
    let mut features = Features {
        creases: mesh.creases.clone(),
        corners: mesh.corners.clone(),
        faces: cells.triangles().take(1).collect(),
        quads: cells.quads().last().into_iter().collect(),
        ..Features::default()
    };
    features.normalise();
    mesh.creases = features.creases.clone();
    mesh.corners = features.corners.clone();
    let solid = SolidMesh {
        points: vec![[0.0; 3]; case.points.len()],
        cells,
        features,
        ..SolidMesh::default()
    };
    (solid, case)
}

fn rule(boundary: Boundary) -> BoundaryRule {
    match boundary {
        Boundary::TriQuad => BoundaryRule::TriQuad,
        Boundary::Interior => BoundaryRule::Interior,
        Boundary::Fixed => BoundaryRule::Fixed,
    }
}

/// The mesh that the reference takes for a level with its whole surface.
fn reference_mesh(level: &Level) -> Mesh {
    Mesh {
        vertex_count: level.vertex_count,
        tetrahedra: level.cells.tetrahedra.clone(),
        octahedra: level.cells.octahedra.clone(),
        prisms: level.cells.prisms.clone(),
        hexahedra: level.cells.hexahedra.clone(),
        triangles: level.surface.clone(),
        quads: level.surface_quads.clone(),
        creases: level.creases.clone(),
        corners: level.corners.clone(),
    }
}

#[test]
fn fixed_point_levels_are_those_of_the_reference() {
    let mut values = 0;
    for seed in 0..cases() {
        let (solid, case) = random(seed);
        let level = Level::of_scheme(&solid, Scheme::Mixed, None).expect("a sound solid");
        let boundary = rule(case.boundary).to_core();
        let mut step = Refinement::new(&level, boundary).expect("a rule of the scheme");
        let mut saturated = 0;
        let got = step.bits(&case.points, &mut saturated).expect("a solid");
        let next = step.split().expect("a solid");
        // A crease surface keeps its rule where the boundary has none.
        let mut mesh = reference_mesh(&level);
        let mut wanted = case.boundary;
        let has_creases = !level.crease_faces().is_empty() || !level.crease_quads().is_empty();
        if wanted == Boundary::Interior && has_creases {
            mesh.triangles = level.crease_faces().to_vec();
            mesh.quads = level.crease_quads().to_vec();
            wanted = Boundary::TriQuad;
        }
        let want = reference_mixed::refine(&mesh, wanted, &case.points);
        assert!(got == want.1, "seed {seed}");
        assert_eq!(saturated, want.2 as usize, "seed {seed}");
        assert_eq!(next.cells.hexahedra, want.0.hexahedra, "seed {seed}");
        assert_eq!(next.cells.prisms, want.0.prisms, "seed {seed}");
        assert_eq!(next.cells.tetrahedra, want.0.tetrahedra, "seed {seed}");
        values += 3 * got.len();
    }
    println!("{} solids, {values} coordinates, 0 mismatches", cases());
}

/// Which vertices each face has.
fn sets<const N: usize>(faces: &[[u32; N]]) -> Vec<BTreeSet<u32>> {
    let mut sets: Vec<BTreeSet<u32>> = faces
        .iter()
        .map(|face| face.iter().copied().collect())
        .collect();
    sets.sort();
    sets
}

/// The first faces of a level are the boundary that the reference finds, and the others faces of
/// cells inside.
#[test]
fn the_boundary_stays_in_front_of_crease_surfaces() {
    let (mut inside, mut open) = (0, 0);
    for seed in 0..cases() {
        let (solid, _) = random(seed);
        let mut level = Level::of_scheme(&solid, Scheme::Mixed, None).expect("a sound solid");
        open += MixedLevelCounts::of(&level)
            .expect("a solid")
            .half_covered_quads;
        for _ in 0..2 {
            let boundary = BoundaryRule::TriQuad.to_core();
            let mut step = Refinement::new(&level, boundary).expect("a rule of the scheme");
            level = step.split().expect("a solid");
            let mut found = reference_mesh(&level);
            reference_mixed::find_boundary(&mut found);
            assert_eq!(
                sets(level.boundary()),
                sets(&found.triangles),
                "seed {seed}"
            );
            assert_eq!(
                sets(level.boundary_quads()),
                sets(&found.quads),
                "seed {seed}"
            );
            let all: BTreeSet<BTreeSet<u32>> = level
                .cells
                .triangles()
                .map(BTreeSet::from)
                .chain(level.cells.quads().map(BTreeSet::from))
                .collect();
            for face in [sets(level.crease_faces()), sets(level.crease_quads())].concat() {
                assert!(all.contains(&face), "seed {seed}: {face:?}");
                inside += 1;
            }
        }
    }
    assert!(inside > 0 && open > 0, "{inside} {open}");
}

/// The numbers that arenas are sized by, predicted and counted.
#[test]
fn counts_are_predicted() {
    for seed in 0..cases() {
        let (solid, _) = random(seed);
        let mut level = Level::of_scheme(&solid, Scheme::Mixed, None).expect("a sound solid");
        let mut predicted = MixedLevelCounts::of(&level).expect("a solid");
        for number in 1..3 {
            let boundary = BoundaryRule::TriQuad.to_core();
            let mut step = Refinement::new(&level, boundary).expect("a rule of the scheme");
            level = step.split().expect("a solid");
            predicted = predicted.refined().expect("a small solid");
            let counted = MixedLevelCounts::of(&level).expect("a solid");
            assert_eq!(counted, predicted, "seed {seed}, level {number}");
        }
    }
}

/// A label goes to a cell's children, which hold its corners: child `i` of a hexahedron has corner
/// `i`, and the children of every cell come together.
#[test]
fn labels_go_to_children() {
    for seed in 0..cases() {
        let (solid, _) = random(seed);
        let level = Level::of_scheme(&solid, Scheme::Mixed, None).expect("a sound solid");
        let boundary = BoundaryRule::TriQuad.to_core();
        let next = Refinement::new(&level, boundary)
            .and_then(|mut step| step.split())
            .expect("a solid");
        let mut numbers = 0..;
        let mut take = |shape| numbers.by_ref().take(solid.cells.count(shape)).collect();
        let [tetrahedra, octahedra, prisms, hexahedra] = Shape::ALL.map(&mut take);
        let labels = Labels {
            tetrahedra,
            octahedra,
            prisms,
            hexahedra,
        };
        let labels: Vec<i32> = labels.refined().iter().collect();
        assert_eq!(labels.len(), next.cells.len(), "seed {seed}");
        let parents: Vec<&[u32]> = solid.cells.corners().collect();
        for (corners, label) in next.cells.corners().zip(labels) {
            let old = corners
                .iter()
                .filter(|vertex| **vertex < level.vertex_count);
            let parent = parents[label as usize];
            for vertex in old {
                assert!(parent.contains(vertex), "seed {seed}");
            }
        }
    }
}
