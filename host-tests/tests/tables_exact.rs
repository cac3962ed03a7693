//! The apply of every format against the reference, bit for bit, on this machine.

use octruss::bundle::Bundle;
use octruss::deform::Displacement;
use octruss_bake::bundle::BundleBytes;
use octruss_host_tests::random_bundle::{BundleCase, layout};

/// Stands before and behind every output.
const GUARD: [i32; 3] = [0x5a5a_5a5a, -0x5a5a_5a5a, 0x1234_5678];

/// Cases of each test; `cargo xtask verify` asks for more.
fn case_count() -> u64 {
    let asked = std::env::var("OCTRUSS_CASES").ok();
    asked.and_then(|count| count.parse().ok()).unwrap_or(400)
}

/// Ranges of rows: all, none, and some that start and end anywhere.
fn ranges(rows: usize, seed: u64) -> Vec<std::ops::Range<usize>> {
    let mut ranges = vec![0..rows, 0..0, rows..rows];
    let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1;
    for _ in 0..4 {
        state = state.rotate_left(23).wrapping_mul(0xd134_2543_de82_ef95);
        let first = (state >> 33) as usize % (rows + 1);
        let last = (state >> 13) as usize % (rows + 1);
        ranges.push(first.min(last)..first.max(last));
    }
    ranges
}

/// Applies one range into a buffer between guard points.
fn guarded(
    range: &std::ops::Range<usize>,
    apply: impl FnOnce(&mut [[i32; 3]]) -> u32,
) -> (Vec<[i32; 3]>, u32) {
    let mut buffer = vec![GUARD; range.len() + 2];
    let saturated = apply(&mut buffer[1..=range.len()]);
    assert_eq!((buffer[0], buffer[range.len() + 1]), (GUARD, GUARD));
    (buffer[1..=range.len()].to_vec(), saturated)
}

/// How many of the coordinates stand at the end of the range.
fn at_ends(points: &[[i32; 3]]) -> usize {
    let ends = |bits: &&i32| **bits == i32::MIN || **bits == i32::MAX;
    points.iter().flatten().filter(ends).count()
}

#[test]
fn every_format_gives_the_bits_of_the_reference() {
    let (mut rows_compared, mut extreme) = (0, 0);
    for seed in 0..case_count() {
        let case = BundleCase::new(seed, 40, 80, layout(seed));
        let bytes = BundleBytes::new(&case.bytes);
        let bundle = bytes
            .open()
            .unwrap_or_else(|error| panic!("seed {seed}: {error}"));
        let (want, clamped) = case.displaced();
        let in_order: Vec<[i32; 3]> = case.order.iter().map(|&row| want.points[row]).collect();
        let model_points: Vec<usize> = bundle.model_points().iter().collect();
        assert_eq!(model_points, case.order, "seed {seed}");
        for range in ranges(in_order.len(), seed) {
            let (got, saturated) =
                guarded(&range, |out| apply(&bundle, &case, &range, clamped, out));
            assert_eq!(got, in_order[range.clone()], "seed {seed}, rows {range:?}");
            if range.len() == in_order.len() {
                assert_eq!(saturated as usize, want.saturated, "seed {seed}");
            }
            rows_compared += got.len();
            extreme += at_ends(&got);
        }
    }
    println!(
        "{rows_compared} rows equal in every bit, {extreme} coordinates at the ends of the range"
    );
    assert!(
        extreme > 100,
        "only {extreme} coordinates at the ends of the range"
    );
}

/// The displacement form of whatever table the bundle holds.
fn apply(
    bundle: &Bundle<'_>,
    case: &BundleCase,
    range: &std::ops::Range<usize>,
    clamped: u32,
    out: &mut [[i32; 3]],
) -> u32 {
    let pose = &case.case.pose;
    if let Ok(table) = bundle.table::<i32>() {
        return table
            .apply(range.clone(), pose, out)
            .expect("fitting lengths");
    }
    let table = bundle.compact_table::<i32>().expect("a compact table");
    let mut memory = vec![Displacement::default(); pose.len()];
    let displacements = table
        .displacements(pose, &mut memory)
        .expect("fitting lengths");
    assert_eq!(displacements.saturated(), clamped);
    table
        .apply(range.clone(), &displacements, out)
        .expect("fitting lengths")
}

#[test]
fn the_absolute_form_gives_the_bits_of_the_reference() {
    for seed in 0..case_count() {
        let case = BundleCase::new(seed, 40, 80, layout(seed % 2));
        let bytes = BundleBytes::new(&case.bytes);
        let bundle = bytes.open().expect("a sound bundle");
        let table = bundle
            .table::<i32>()
            .expect("a table for 32-bit coordinates");
        let want = case.absolute();
        let in_order: Vec<[i32; 3]> = case.order.iter().map(|&row| want.points[row]).collect();
        for range in ranges(in_order.len(), seed) {
            let (got, saturated) = guarded(&range, |out| {
                let applied = table.apply_absolute(range.clone(), &case.case.pose, out);
                applied.expect("fitting lengths")
            });
            assert_eq!(got, in_order[range.clone()], "seed {seed}, rows {range:?}");
            if range.len() == in_order.len() {
                assert_eq!(saturated as usize, want.saturated, "seed {seed}");
            }
        }
    }
}

/// After some control points have moved, computing their rows alone gives what computing all gives.
#[test]
fn partial_updates_give_the_bits_of_whole_ones() {
    let (mut computed, mut all) = (0, 0);
    for seed in 0..case_count() {
        let case = BundleCase::new(seed, 40, 80, layout(seed));
        let bytes = BundleBytes::new(&case.bytes);
        let bundle = bytes.open().expect("a sound bundle");
        let before = &case.case.pose;
        // Every third control point at most moves, and some poses not at all.
        let moves = |point: usize| (seed as usize + point).is_multiple_of(3 + seed as usize % 9);
        let marks: Vec<bool> = (0..before.len()).map(moves).collect();
        let moved = before.iter().zip(&marks).map(|(point, moves)| match moves {
            true => point.map(|bits| bits.wrapping_mul(3).wrapping_add(77)),
            false => *point,
        });
        let after: Vec<[i32; 3]> = moved.collect();
        let rows = case.order.len();
        let (mut want, mut got) = (vec![[0; 3]; rows], vec![[0; 3]; rows]);
        let updated = if let Ok(table) = bundle.table::<i32>() {
            table
                .apply(0..rows, &after, &mut want)
                .expect("fitting lengths");
            table
                .apply(0..rows, before, &mut got)
                .expect("fitting lengths");
            table.apply_moved(&marks, &after, &mut got)
        } else {
            let table = bundle.compact_table::<i32>().expect("a compact table");
            let mut memory = vec![Displacement::default(); before.len()];
            let now = table
                .displacements(before, &mut memory)
                .expect("fitting lengths");
            table
                .apply(0..rows, &now, &mut got)
                .expect("fitting lengths");
            let now = table
                .displacements(&after, &mut memory)
                .expect("fitting lengths");
            table
                .apply(0..rows, &now, &mut want)
                .expect("fitting lengths");
            table.apply_moved(&marks, &now, &mut got)
        };
        let updated = updated.expect("fitting lengths");
        assert_eq!(got, want, "seed {seed}");
        computed += updated.rows;
        all += rows;
    }
    assert!(
        computed > all / 10 && computed < all * 19 / 20,
        "{computed} of {all} rows"
    );
}
