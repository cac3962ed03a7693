//! Memory that is too small by one element gives an error that names the need, and nothing is
//! written: not to that memory, and not to any other that the same call was lent.
//!
//! Needed sizes are counted from the reference's split, not asked from core.

use octruss::blend::FixedBlend;
use octruss::mesh::{
    Arena, MeshError, Numbering, SolidArena, SolidBuffers, boundary_triangles, edge_capacity,
};
use octruss::solid::tet_oct::{Scratch, refine_points, split};
use octruss::solid::{PointBuffers, VertexState};
use octruss_host_tests::meshes::two_tetrahedra;
use octruss_host_tests::random_mesh::{Limits, RefineCase};
use octruss_host_tests::reference::{Boundary, Counts, Solid, split as reference_split};
use octruss_host_tests::subject::{CoreSolid, core_boundary, refine_bits};

const GUARD: u32 = 0xdead_beef;

fn too_small(arena: Arena, needed: usize) -> MeshError {
    MeshError::ArenaTooSmall {
        arena,
        needed,
        given: needed - 1,
    }
}

/// Solids with every kind of part, among them the two of the random ones that have all.
fn levels() -> Vec<CoreSolid> {
    let solids = (0..60).map(|seed| RefineCase::new(seed, &Limits::default()).solid);
    let levels: Vec<_> = solids
        .map(|solid| CoreSolid::new(&solid).expect("a sound solid"))
        .collect();
    let has_all = |level: &&CoreSolid| {
        let Solid {
            octahedra,
            creases,
            corners,
            ..
        } = &level.solid;
        !octahedra.is_empty() && !creases.is_empty() && !corners.is_empty()
    };
    assert!(levels.iter().filter(has_all).count() >= 2);
    levels
}

#[test]
fn boundary() {
    for level in levels() {
        let needed = 4 * level.solid.tetrahedra.len() + 8 * level.solid.octahedra.len();
        let mut faces = vec![[GUARD; 3]; needed - 1];
        let error = boundary_triangles(&level.view(), &mut faces).err();
        assert_eq!(error, Some(too_small(Arena::Faces, needed)));
        assert!(faces.iter().all(|face| *face == [GUARD; 3]));
    }
}

#[test]
fn numbering() {
    for level in levels() {
        let solid = &level.solid;
        // Six edges a tetrahedron, twelve an octahedron, three a surface triangle.
        let edges_needed =
            6 * solid.tetrahedra.len() + 12 * solid.octahedra.len() + 3 * level.surface.len();
        assert_eq!(edge_capacity(&level.view()), Some(edges_needed));
        let order_needed = solid.octahedra.len();
        for short in [Arena::Edges, Arena::OctahedronOrder] {
            let needed = if short == Arena::Edges {
                edges_needed
            } else {
                order_needed
            };
            if needed == 0 {
                continue;
            }
            let missing = |arena| usize::from(arena == short);
            let mut edges = vec![[GUARD; 2]; edges_needed - missing(Arena::Edges)];
            let mut order = vec![GUARD; order_needed - missing(Arena::OctahedronOrder)];
            let error = Numbering::new(&level.view(), &mut edges, &mut order).err();
            assert_eq!(error, Some(too_small(short, needed)));
            assert!(edges.iter().all(|edge| *edge == [GUARD; 2]));
            assert!(order.iter().all(|place| *place == GUARD));
        }
    }
}

#[test]
fn connectivity() {
    for level in levels() {
        let refined = reference_split(&level.solid).solid;
        let needs = [
            (Arena::Tetrahedra, refined.tetrahedra.len()),
            (Arena::Octahedra, refined.octahedra.len()),
            (Arena::SurfaceTriangles, 4 * level.surface.len()),
            (Arena::Creases, refined.creases.len()),
            (Arena::Corners, refined.corners.len()),
        ];
        let (mut edges, mut order) = memory_to_number(&level);
        let numbering = Numbering::new(&level.view(), &mut edges, &mut order).expect("it fits");
        for (short, needed) in needs.into_iter().filter(|need| need.1 > 0) {
            let [t, o, s, c, k] = needs.map(|(arena, needed)| needed - usize::from(arena == short));
            let (mut tetrahedra, mut octahedra) = (vec![[GUARD; 4]; t], vec![[GUARD; 6]; o]);
            let (mut surface, mut creases) = (vec![[GUARD; 3]; s], vec![[GUARD; 2]; c]);
            let mut corners = vec![GUARD; k];
            let buffers = SolidBuffers {
                tetrahedra: &mut tetrahedra,
                octahedra: &mut octahedra,
                surface: &mut surface,
                creases: &mut creases,
                corners: &mut corners,
            };
            let error = split(&level.view(), &numbering, buffers).err();
            assert_eq!(error, Some(too_small(short, needed)));
            let lists = [
                tetrahedra.as_flattened(),
                octahedra.as_flattened(),
                surface.as_flattened(),
                creases.as_flattened(),
                &corners,
            ];
            assert!(lists.into_iter().flatten().all(|word| *word == GUARD));
        }
    }
}

#[test]
fn points() {
    const POINT: [i32; 3] = [0x5a5a_5a5a; 3];
    const SUM: [i64; 3] = [0x5a5a_5a5a; 3];
    for level in levels() {
        let old = level.solid.vertex_count;
        let new = reference_split(&level.solid).solid.vertex_count;
        let needs = [
            (Arena::InputPoints, old),
            (Arena::OutputPoints, new),
            (Arena::Sums, new),
            (Arena::States, new),
        ];
        let (mut edges, mut order) = memory_to_number(&level);
        let numbering = Numbering::new(&level.view(), &mut edges, &mut order).expect("it fits");
        for boundary in Boundary::ALL.map(core_boundary) {
            for (short, needed) in needs {
                let lengths = needs.map(|(arena, needed)| needed - usize::from(arena == short));
                let [inputs, outputs, sums, states] = lengths;
                let (mut out, mut sums) = (vec![POINT; outputs], vec![SUM; sums]);
                let mut states = vec![VertexState::default(); states];
                let buffers = PointBuffers {
                    out: &mut out,
                    sums: &mut sums,
                    states: &mut states,
                };
                let mut blend = FixedBlend::<i32, 3>::new();
                let (view, input) = (level.view(), vec![[1; 3]; inputs]);
                let done = refine_points(&mut blend, &view, &numbering, boundary, &input, buffers);
                assert_eq!(done.err(), Some(too_small(short, needed)));
                assert!(out.iter().all(|point| *point == POINT));
                assert!(sums.iter().all(|sum| *sum == SUM));
                assert!(states.iter().all(|state| *state == VertexState::default()));
                assert_eq!(blend.saturated(), 0);
            }
        }
    }
}

fn memory_to_number(level: &CoreSolid) -> (Vec<[u32; 2]>, Vec<u32>) {
    let edges = edge_capacity(&level.view()).expect("a small number");
    (vec![[0; 2]; edges], vec![0; level.solid.octahedra.len()])
}

/// What `info` prints and arenas are sized by: the counts of all levels from those of level 0.
#[test]
fn counts_are_foretold() {
    for mut level in levels() {
        // Only then are all edges and faces those of cells.
        level.solid.sheets.clear();
        level.solid.creases.clear();
        let known = |counts: Counts| octruss::mesh::Counts {
            vertices: counts.vertices,
            edges: counts.edges,
            faces: counts.faces,
            tetrahedra: counts.tetrahedra,
            octahedra: counts.octahedra,
            ..octruss::mesh::Counts::default()
        };
        let mut foretold = known(Counts::of(&level.solid));
        for _ in 0..2 {
            foretold = foretold.refined().expect("small numbers");
            level.solid = reference_split(&level.solid).solid;
            assert_eq!(foretold, known(Counts::of(&level.solid)));
        }
    }
}

/// Two tetrahedra with one crease and one corner. The refined mesh has 14 vertices (5 and 9
/// edges), 8 tetrahedra, 2 octahedra, 24 surface triangles, 2 creases, 1 corner; its edges
/// with repetitions are 30 of the cells' before it and the surface's 18: 2 * 6 + 6 * 3 = 30.
type Blend = FixedBlend<i32, 3>;

fn two_with_features() -> (CoreSolid, Vec<[i32; 3]>) {
    let solid = Solid {
        creases: vec![[1, 3]],
        corners: vec![4],
        ..two_tetrahedra()
    };
    let points = vec![[0, 0, 0], [90, 0, 0], [0, 90, 0], [0, 0, 90], [0, 0, -90]];
    (CoreSolid::new(&solid).expect("a sound solid"), points)
}

/// Arenas of exactly the right size give what slices give.
#[test]
fn owned_arenas_of_the_right_size_suffice() {
    let (level, points) = two_with_features();
    let (want_mesh, want, _) = refine_bits(&level, Boundary::Loop, &points).expect("it is sound");
    let mut scratch = Scratch::<Blend, 30, 0, 14>::new();
    let mut next = SolidArena::<8, 2, 24, 2, 1>::new();
    let mut out = heapless::Vec::<[i32; 3], 14>::new();
    let boundary = core_boundary(Boundary::Loop);
    let mut blend = Blend::new();
    scratch
        .refine(
            &mut blend,
            &level.view(),
            boundary,
            &points,
            &mut out,
            Some(&mut next),
        )
        .expect("it fits exactly");
    assert_eq!(out.as_slice(), want.as_slice());
    assert_eq!(next.solid(), want_mesh.view());

    let mut first = SolidArena::<2, 0, 6, 1, 1>::new();
    first.assign(&level.view()).expect("it fits exactly");
    assert_eq!(first.solid(), level.view());
    let mut faces = [[0; 3]; 8];
    first.find_boundary(&mut faces).expect("it fits exactly");
    assert_eq!(first.solid(), level.view());
}

/// One arena after the other too small by one: the output and the next solid stay as they were.
#[test]
fn owned_arenas_too_small_by_one() {
    fn try_sizes<
        const E: usize,
        const V: usize,
        const P: usize,
        const T: usize,
        const O: usize,
        const S: usize,
        const C: usize,
        const K: usize,
    >(
        expected: MeshError,
    ) {
        let (level, points) = two_with_features();
        let mut scratch = Scratch::<Blend, E, 0, V>::new();
        let mut next = SolidArena::<T, O, S, C, K>::new();
        let mut out = heapless::Vec::<[i32; 3], P>::new();
        out.push([7, 8, 9]).expect("there is room for one");
        let boundary = core_boundary(Boundary::Loop);
        let (view, mut blend) = (level.view(), Blend::new());
        let done = scratch.refine(
            &mut blend,
            &view,
            boundary,
            &points,
            &mut out,
            Some(&mut next),
        );
        assert_eq!(done, Err(expected));
        assert_eq!(out.as_slice(), [[7, 8, 9]]);
        assert_eq!(next.solid(), octruss::mesh::Solid::default());
    }
    try_sizes::<29, 14, 14, 8, 2, 24, 2, 1>(too_small(Arena::Edges, 30));
    try_sizes::<30, 13, 14, 8, 2, 24, 2, 1>(too_small(Arena::Sums, 14));
    try_sizes::<30, 14, 13, 8, 2, 24, 2, 1>(too_small(Arena::OutputPoints, 14));
    try_sizes::<30, 14, 14, 7, 2, 24, 2, 1>(too_small(Arena::Tetrahedra, 8));
    try_sizes::<30, 14, 14, 8, 1, 24, 2, 1>(too_small(Arena::Octahedra, 2));
    try_sizes::<30, 14, 14, 8, 2, 23, 2, 1>(too_small(Arena::SurfaceTriangles, 24));
    try_sizes::<30, 14, 14, 8, 2, 24, 1, 1>(too_small(Arena::Creases, 2));
    try_sizes::<30, 14, 14, 8, 2, 24, 2, 0>(too_small(Arena::Corners, 1));
}
