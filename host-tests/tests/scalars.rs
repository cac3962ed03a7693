//! Scalar channels through a table of every format against the reference, bit for bit.

use std::ops::Range;

use fixed::types::I16F16;
use octruss::bundle::Bundle;
use octruss::coord::Coordinate;
use octruss::deform::ApplyError;
use octruss_bake::bundle::BundleBytes;
use octruss_host_tests::random_bundle::{BundleCase, layout};
use octruss_host_tests::random_mesh::random_points;
use octruss_host_tests::reference::apply_absolute;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng as _;

/// Stands before and behind every output.
const GUARD: i32 = 0x5a5a_a5a5;

/// Cases of each test; `cargo xtask verify` asks for more.
fn cases() -> u64 {
    std::env::var("OCTRUSS_CASES").map_or(300, |count| count.parse().expect("a number"))
}

/// Applies whatever table the bundle holds.
fn apply_scalars<V: Coordinate, const D: usize>(
    bundle: &Bundle<'_>,
    rows: Range<usize>,
    values: &[[V; D]],
    out: &mut [[V; D]],
) -> Result<u32, ApplyError> {
    match bundle.table::<i32>() {
        Ok(table) => table.apply_scalars(rows, values, out),
        Err(_) => {
            let table = bundle.compact_table::<i32>().expect("a compact table");
            table.apply_scalars(rows, values, out)
        }
    }
}

/// What a run has seen.
#[derive(Default)]
struct Seen {
    values: usize,
    saturated: usize,
}

/// One case with `D` channels: all rows, and ranges that start and end anywhere.
fn run<const D: usize>(seed: u64, seen: &mut Seen) {
    let case = BundleCase::new(seed, 40, 80, layout(seed));
    let bytes = BundleBytes::new(&case.bytes);
    let bundle = bytes.open().expect("a sound bundle");
    let mut rng = ChaCha8Rng::seed_from_u64(seed ^ 0x5ca1a5);
    let values: Vec<[i32; D]> = random_points(&mut rng, case.case.pose.len());
    // The weights of a 14-bit table are those of the case in units of 2^-14.
    let want = apply_absolute(&case.case.table, &values).expect("a sound table");
    let in_order: Vec<[i32; D]> = case.order.iter().map(|&row| want.points[row]).collect();
    let rows = in_order.len();
    let mut counts = Vec::new();
    for range in [0..rows, 0..rows / 3, rows / 3..rows, rows / 2..rows / 2] {
        let mut out = vec![[GUARD; D]; range.len() + 2];
        let part = &mut out[1..=range.len()];
        let saturated = apply_scalars(&bundle, range.clone(), &values, part);
        let saturated = saturated.expect("fitting lengths") as usize;
        assert_eq!(
            out[1..=range.len()],
            in_order[range.clone()],
            "seed {seed}, rows {range:?}"
        );
        assert_eq!((out[0], out[range.len() + 1]), ([GUARD; D], [GUARD; D]));
        counts.push(saturated);
    }
    let whole = want.saturated;
    assert_eq!(
        (counts[0], counts[1] + counts[2], counts[3]),
        (whole, whole, 0),
        "seed {seed}"
    );
    seen.saturated += whole;
    seen.values += D * rows;
}

#[test]
fn every_format_gives_the_bits_of_the_reference() {
    let mut seen = Seen::default();
    for seed in 0..cases() {
        run::<1>(seed, &mut seen);
        run::<2>(seed, &mut seen);
        run::<5>(seed, &mut seen);
    }
    println!(
        "{} tables, {} values equal in every bit, {} saturated",
        cases(),
        seen.values,
        seen.saturated
    );
    assert!(
        seen.saturated > 100,
        "only {} values saturate",
        seen.saturated
    );
}

/// Weights of a row add up to exactly one: what is the same everywhere stays so, in every format of the
/// values, and three channels are what positions are.
#[test]
fn constants_stay_and_positions_are_channels() {
    for seed in 0..cases().min(300) {
        let case = BundleCase::new(seed, 40, 80, layout(seed));
        let bytes = BundleBytes::new(&case.bytes);
        let bundle = bytes.open().expect("a sound bundle");
        let (points, rows) = (case.case.pose.len(), case.order.len());
        let constant = [I16F16::from_num(21.5), I16F16::MIN, I16F16::MAX];
        let mut out = vec![[I16F16::ZERO; 3]; rows];
        let saturated = apply_scalars(&bundle, 0..rows, &vec![constant; points], &mut out);
        assert_eq!(saturated, Ok(0), "seed {seed}");
        assert_eq!(out, vec![constant; rows], "seed {seed}");
        if let Ok(table) = bundle.table::<i32>() {
            let (mut one, mut other) = (vec![[0; 3]; rows], vec![[0; 3]; rows]);
            let pose = &case.case.pose;
            let same = table.apply_absolute(0..rows, pose, &mut one);
            assert_eq!(same, table.apply_scalars(0..rows, pose, &mut other));
            assert_eq!(one, other, "seed {seed}");
        }
    }
}

/// What does not fit is refused in words, and nothing is written.
#[test]
fn wrong_lengths_are_refused() {
    for seed in 0..8 {
        let case = BundleCase::new(seed, 40, 80, layout(seed));
        let bytes = BundleBytes::new(&case.bytes);
        let bundle = bytes.open().expect("a sound bundle");
        let (points, rows) = (case.case.pose.len(), case.order.len());
        let values = vec![[7, 8]; points + 1];
        let refused = |values: &[[i32; 2]], range: Range<usize>, length: usize| {
            let mut out = vec![[GUARD; 2]; length];
            let error = apply_scalars(&bundle, range, values, &mut out);
            assert!(out.iter().all(|value| *value == [GUARD; 2]));
            error.expect_err("a wrong length").to_string()
        };
        assert_eq!(
            refused(&values, 0..rows, rows),
            format!(
                "{} control points have values, the table's cage has {points}",
                points + 1
            )
        );
        let values = &values[..points];
        assert_eq!(
            refused(values, 0..rows + 1, rows + 1),
            format!(
                "rows 0 to {} were asked for of a table with {rows}",
                rows + 1
            )
        );
        assert_eq!(
            refused(values, 0..rows, rows + 2),
            format!(
                "the output holds {} points, {rows} rows were asked for",
                rows + 2
            )
        );
    }
}
