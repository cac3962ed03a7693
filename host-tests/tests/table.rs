//! Core's table against the reference's apply: both forms, every bit, saturation counted.

use fixed::types::I12F20;
use octruss::bundle::{Bundle, BundleError, Sections};
use octruss_host_tests::bundle_bytes::{BundleBytes, row_with_a_great_residual};
use octruss_host_tests::compare::compare;
use octruss_host_tests::random_table::{ApplyCase, RowSum};
use octruss_host_tests::reference::{apply_absolute, apply_displacement};

/// How many random tables every test run compares.
const CASES: u64 = 400;

/// How many the long proof compares.
const CASES_OF_VERIFY: u64 = 10_000;

/// Stands behind every output.
const GUARD: [i32; 3] = [0x7a7a_7a7a; 3];

#[derive(Default)]
struct Seen {
    applied: usize,
    refused: usize,
    coordinates: usize,
    saturated: usize,
}

fn run(count: u64) -> Seen {
    let mut seen = Seen::default();
    for seed in 0..count {
        let case = ApplyCase::<3>::new(seed, 40, 64, RowSum::One);
        let bundle = BundleBytes::new(&case, 20);
        let opened = Bundle::new_checked(bundle.bytes());
        if let Some(row) = row_with_a_great_residual(&case) {
            assert_eq!(
                opened.err(),
                Some(BundleError::Start { row }),
                "seed {seed}"
            );
            seen.refused += 1;
            continue;
        }
        let opened = opened.unwrap_or_else(|error| panic!("seed {seed}: {error}"));
        seen.applied += 1;
        apply(&case, &opened, &mut seen).unwrap_or_else(|fault| panic!("seed {seed}: {fault}"));
    }
    println!(
        "{} tables, {} refused for their residuals, {} coordinates compared, 0 mismatches, \
         {} saturated",
        seen.applied, seen.refused, seen.coordinates, seen.saturated
    );
    seen
}

fn apply(case: &ApplyCase<3>, bundle: &Bundle<'_>, seen: &mut Seen) -> Result<(), String> {
    let table = bundle.table::<i32>().map_err(|error| error.to_string())?;
    let rows = case.table.row_count();
    let displacement = apply_displacement(&case.table, &case.pose, &case.rest_pose, &case.rest)
        .map_err(|error| error.to_string())?;
    let absolute = apply_absolute(&case.table, &case.pose).map_err(|error| error.to_string())?;
    for (form, want) in [("displacement", &displacement), ("absolute", &absolute)] {
        // All rows at once, then in two ranges.
        for middle in [rows, rows / 3] {
            let mut out = vec![GUARD; rows + 4];
            let mut saturated = 0;
            for range in [0..middle, middle..rows] {
                let part = &mut out[range.clone()];
                let counted = match form {
                    "displacement" => table.apply(range, &case.pose, part),
                    _ => table.apply_absolute(range, &case.pose, part),
                };
                saturated += counted.map_err(|error| error.to_string())?;
            }
            compare(form, &out[..rows], &want.points)?;
            compare("guards", &out[rows..], &[GUARD; 4])?;
            compare("saturated", &[saturated as usize], &[want.saturated])?;
        }
        seen.coordinates += 3 * rows;
        seen.saturated += want.saturated;
    }
    at_rest(case, bundle)
}

/// The displacement form at rest gives the rest model to the bit, in a typed format too.
fn at_rest(case: &ApplyCase<3>, bundle: &Bundle<'_>) -> Result<(), String> {
    let typed = bundle
        .table::<I12F20>()
        .map_err(|error| error.to_string())?;
    let pose: Vec<_> = bundle
        .rest_cage()
        .iter()
        .map(|p| p.map(I12F20::from_bits))
        .collect();
    let mut out = vec![[I12F20::ZERO; 3]; case.rest.len()];
    let saturated = typed
        .apply(0..typed.rows(), &pose, &mut out)
        .map_err(|error| error.to_string())?;
    let bits: Vec<_> = out.iter().map(|point| point.map(I12F20::to_bits)).collect();
    compare("rest model", &bits, &case.rest)?;
    compare("saturated at rest", &[saturated], &[0])
}

#[test]
fn random_tables_are_equal() {
    let seen = run(CASES);
    assert!(
        seen.saturated > 100,
        "only {} coordinates saturate",
        seen.saturated
    );
    assert!(
        seen.refused > 5,
        "only {} bundles are refused",
        seen.refused
    );
}

/// One weight changed by one unit is refused; two of a row changed against each other keep the
/// sum, pass, and show in the bits.
#[test]
fn a_changed_weight_is_refused_or_seen() {
    let mut changed = 0;
    for seed in 0..100 {
        let mut case = ApplyCase::<3>::new(seed, 10, 20, RowSum::One);
        // Residuals that fit, and a first tap as far from the others as can be.
        case.rest_pose.fill([0; 3]);
        case.rest.fill([0; 3]);
        case.pose.fill([i32::MIN / 4; 3]);
        let rows = 0..case.table.row_count();
        let Some(row) = rows
            .into_iter()
            .find(|row| case.table.row(*row).count() > 1)
        else {
            continue;
        };
        let first = case.table.offsets[row] as usize;
        case.pose[usize::from(case.table.indices[first])] = [i32::MAX / 4; 3];
        let sound = change_weights(&case, first, [0, 0]);
        assert!(Bundle::new_checked(sound.bytes()).is_ok(), "seed {seed}");
        let alone = change_weights(&case, first, [1, 0]);
        let error = BundleError::Weights { row: row as u32 };
        assert_eq!(
            Bundle::new_checked(alone.bytes()).err(),
            Some(error),
            "seed {seed}"
        );
        let both = change_weights(&case, first, [-1, 1]);
        // Only magnitudes that add up to exactly two can grow too great.
        let Ok(bundle) = Bundle::new_checked(both.bytes()) else {
            continue;
        };
        let mut seen = Seen::default();
        apply(&case, &bundle, &mut seen).expect_err("the bits change");
        changed += 1;
    }
    assert!(changed > 30, "only {changed} tables were changed");
}

/// The bundle of a case, two neighbouring weights of which are changed by so many units.
fn change_weights(case: &ApplyCase<3>, first: usize, by: [i32; 2]) -> BundleBytes {
    let mut bundle = BundleBytes::new(case, 16);
    let (rows, taps) = (case.table.row_count(), case.table.weights.len());
    let sections = Sections::new(case.pose.len(), rows, taps).expect("a small bundle");
    for (tap, by) in (first..).zip(by) {
        let place = sections.weights.start + 4 * tap;
        let weight = case.table.weights[tap] + by;
        bundle.bytes_mut()[place..place + 4].copy_from_slice(&weight.to_le_bytes());
    }
    bundle.seal();
    bundle
}

#[test]
#[ignore = "ten thousand cases: part of cargo xtask verify"]
fn ten_thousand_random_tables_are_equal() {
    run(CASES_OF_VERIFY);
}
