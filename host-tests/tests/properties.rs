//! What must hold for every mesh: translations, the order of cells, vertex numbers, channels.

use std::collections::BTreeMap;

use octruss::bundle::Bundle;
use octruss_host_tests::bundle_bytes::{BundleBytes, row_with_a_great_residual};
use octruss_host_tests::random_mesh::{Limits, RefineCase, SeedableRng as _};
use octruss_host_tests::random_table::{ApplyCase, RowSum};
use octruss_host_tests::reference::{Boundary, Solid, refine, split};
use octruss_host_tests::subject::{CoreSolid, refine_bits};
use proptest::prelude::{ProptestConfig, any, proptest};
use proptest::prop_assert_eq;
use rand::seq::SliceRandom as _;
use rand_chacha::ChaCha8Rng;

/// Coordinates and translations of half the range, so that no sum of two leaves it.
fn halved<const D: usize>(points: &[[i32; D]]) -> Vec<[i32; D]> {
    points
        .iter()
        .map(|point| point.map(|coordinate| coordinate / 2))
        .collect()
}

fn translated<const D: usize>(points: &[[i32; D]], by: [i32; D]) -> Vec<[i32; D]> {
    let move_point = |point: &[i32; D]| std::array::from_fn(|axis| point[axis] + by[axis]);
    points.iter().map(move_point).collect()
}

fn core(solid: &Solid, boundary: Boundary, points: &[[i32; 3]]) -> (CoreSolid, Vec<[i32; 3]>) {
    let level = CoreSolid::new(solid).expect("a sound solid");
    let (next, points, _) = refine_bits(&level, boundary, points).expect("a sound solid");
    (next, points)
}

fn half_range() -> std::ops::RangeInclusive<i32> {
    i32::MIN / 2..=i32::MAX / 2
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 128, failure_persistence: None, ..ProptestConfig::default() })]

    /// Moving all points by whole units moves every refined point by the same units.
    #[test]
    fn refinement_commutes_with_translation(seed: u64, x in half_range(), y in half_range(), z in half_range()) {
        let case = RefineCase::new(seed, &Limits::default());
        let points = halved(&case.points);
        let (_, here) = core(&case.solid, case.boundary, &points);
        let (_, there) = core(&case.solid, case.boundary, &translated(&points, [x, y, z]));
        prop_assert_eq!(there, translated(&here, [x, y, z]));
    }

    /// The order of the cells, of sheets, creases and corners changes no bit of any point, and
    /// of the refined mesh only the order.
    #[test]
    fn order_of_cells_does_not_matter(seed: u64, order: u64) {
        let case = RefineCase::new(seed, &Limits { levels: 2, ..Limits::default() });
        let mut rng = ChaCha8Rng::seed_from_u64(order);
        let mut other = case.solid.clone();
        other.tetrahedra.shuffle(&mut rng);
        other.creases.shuffle(&mut rng);
        other.corners.shuffle(&mut rng);
        other.sheets.shuffle(&mut rng);
        // Octahedra with the same corners number their centroids by their place in the list.
        let mut sets: Vec<_> = other.octahedra.clone();
        sets.iter_mut().for_each(|cell| cell.sort_unstable());
        sets.sort_unstable();
        if sets.windows(2).all(|pair| pair[0] != pair[1]) {
            other.octahedra.shuffle(&mut rng);
        }
        let (mesh, points) = core(&case.solid, case.boundary, &case.points);
        let (other_mesh, other_points) = core(&other, case.boundary, &case.points);
        prop_assert_eq!(points, other_points);
        prop_assert_eq!(sorted(&mesh.solid), sorted(&other_mesh.solid));
    }

    /// Renumbering the vertices renumbers the refined ones and changes no point.
    #[test]
    fn numbers_of_vertices_do_not_matter(seed: u64, order: u64) {
        let case = RefineCase::new(seed, &Limits { levels: 1, ..Limits::default() });
        let mut names: Vec<u32> = (0..).take(case.solid.vertex_count).collect();
        names.shuffle(&mut ChaCha8Rng::seed_from_u64(order));
        let renamed = renamed(&case.solid, &names);
        let mut points = case.points.clone();
        for (name, point) in names.iter().zip(&case.points) {
            points[*name as usize] = *point;
        }
        let (_, refined) = core(&case.solid, case.boundary, &case.points);
        let (_, other) = core(&renamed, case.boundary, &points);
        // Every midpoint by its ends' old names; octahedra may have twins and are left to the
        // comparison with the reference.
        let there = split(&renamed);
        let mut expected = BTreeMap::new();
        for ([a, b], point) in split(&case.solid).edges.iter().zip(&refined[names.len()..]) {
            expected.insert(there.midpoint(names[*a as usize], names[*b as usize]), *point);
        }
        for (name, point) in names.iter().zip(&refined) {
            expected.insert(*name, *point);
        }
        for (vertex, point) in expected {
            prop_assert_eq!(other[vertex as usize], point, "vertex {}", vertex);
        }
    }

    /// Channels are refined each on its own, one, four or seven at a time.
    #[test]
    fn channels_are_independent(seed: u64) {
        let case = RefineCase::new(seed, &Limits { levels: 1, ..Limits::default() });
        let level = CoreSolid::new(&case.solid).expect("a sound solid");
        let (_, three, _) = refine_bits(&level, case.boundary, &case.points).expect("sound");
        let seven: Vec<[i32; 7]> = case.points.iter().map(|&[x, y, z]| [x, y, z, 0, z, 7, x]).collect();
        let (_, seven_refined, _) = refine_bits(&level, case.boundary, &seven).expect("sound");
        let want = refine(&case.solid, &seven, case.boundary).expect("sound");
        prop_assert_eq!(&seven_refined, &want.points);
        for ([x, y, z], channels) in three.iter().zip(&seven_refined) {
            prop_assert_eq!([*x, *y, *z, 0, *z, 7, *x], *channels);
        }
        let one: Vec<[i32; 1]> = case.points.iter().map(|&[_, y, _]| [y]).collect();
        let (_, one_refined, _) = refine_bits(&level, case.boundary, &one).expect("sound");
        let wanted: Vec<_> = three.iter().map(|point| [point[1]]).collect();
        prop_assert_eq!(one_refined, wanted);
    }

    /// Solids with arbitrary indices are refused by core exactly where the reference refuses them,
    /// and otherwise refined to the same bits: tangled, but defined.
    #[test]
    fn damaged_solids_are_refused_alike(seed: u64, damages in proptest::collection::vec(any::<[u32; 3]>(), 1..4)) {
        let case = RefineCase::new(seed, &Limits { levels: 1, ..Limits::default() });
        let mut solid = case.solid.clone();
        for damage in damages {
            damage_one(&mut solid, damage);
        }
        let want = refine(&solid, &case.points, case.boundary);
        let level = CoreSolid::new(&solid);
        let got = level.and_then(|level| refine_bits(&level, case.boundary, &case.points));
        match (got, want) {
            (Ok((mesh, points, saturated)), Ok(want)) => {
                prop_assert_eq!(mesh.solid, want.solid);
                prop_assert_eq!(points, want.points);
                prop_assert_eq!(saturated, want.saturated);
            }
            (got, want) => prop_assert_eq!(got.is_err(), want.is_err(), "{:?} {:?}", got.err(), want.err()),
        }
    }

    /// Both forms of the table move by whole units with the pose.
    #[test]
    fn tables_commute_with_translation(seed: u64, by in any::<[i16; 3]>()) {
        let mut case = ApplyCase::<3>::new(seed, 20, 30, RowSum::One);
        // Magnitudes of weights add up to two at most: an eighth of the range leaves room.
        let eighth = |points: &[[i32; 3]]| halved(&halved(&halved(points)));
        (case.pose, case.rest_pose, case.rest) =
            (eighth(&case.pose), eighth(&case.rest_pose), eighth(&case.rest));
        prop_assert_eq!(row_with_a_great_residual(&case), None);
        let bytes = BundleBytes::new(&case, 16);
        let bundle = Bundle::new_checked(bytes.bytes()).expect("a sound bundle");
        let table = bundle.table::<i32>().expect("raw bits fit");
        let by = by.map(i32::from);
        let moved = translated(&case.pose, by);
        let rows = table.rows();
        let (mut here, mut there) = (vec![[0; 3]; rows], vec![[0; 3]; rows]);
        let saturated = table.apply(0..rows, &case.pose, &mut here).expect("the lengths fit")
            + table.apply(0..rows, &moved, &mut there).expect("the lengths fit");
        prop_assert_eq!(saturated, 0);
        prop_assert_eq!(&there, &translated(&here, by));
        let saturated = table.apply_absolute(0..rows, &case.pose, &mut here).expect("they fit")
            + table.apply_absolute(0..rows, &moved, &mut there).expect("they fit");
        prop_assert_eq!(saturated, 0);
        prop_assert_eq!(&there, &translated(&here, by));
    }
}

/// Overwrites one index somewhere: which list and element, which place in it, with what.
fn damage_one(solid: &mut Solid, [which, place, value]: [u32; 3]) {
    // Two that do not exist are among the new ones.
    let value = value % (solid.vertex_count as u32 + 2);
    let lists: [&mut [u32]; 5] = [
        solid.tetrahedra.as_flattened_mut(),
        solid.octahedra.as_flattened_mut(),
        solid.sheets.as_flattened_mut(),
        solid.creases.as_flattened_mut(),
        &mut solid.corners,
    ];
    let mut filled: Vec<_> = lists.into_iter().filter(|list| !list.is_empty()).collect();
    let count = filled.len();
    let list = &mut filled[which as usize % count];
    let length = list.len();
    list[place as usize % length] = value;
}

/// A solid with all its lists in ascending order.
fn sorted(solid: &Solid) -> Solid {
    let mut solid = solid.clone();
    solid.tetrahedra.sort_unstable();
    solid.octahedra.sort_unstable();
    solid.sheets.sort_unstable();
    solid.creases.sort_unstable();
    solid.corners.sort_unstable();
    solid
}

fn renamed(solid: &Solid, names: &[u32]) -> Solid {
    let name = |vertex: u32| names[vertex as usize];
    Solid {
        vertex_count: solid.vertex_count,
        tetrahedra: solid.tetrahedra.iter().map(|cell| cell.map(name)).collect(),
        octahedra: solid.octahedra.iter().map(|cell| cell.map(name)).collect(),
        sheets: solid.sheets.iter().map(|sheet| sheet.map(name)).collect(),
        creases: solid
            .creases
            .iter()
            .map(|crease| crease.map(name))
            .collect(),
        corners: solid.corners.iter().map(|corner| name(*corner)).collect(),
    }
}
