//! Core's table against the reference's apply: both forms, every bit, saturation counted.

use fixed::types::I12F20;
use octruss::bundle::{Bundle, BundleError};
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

#[test]
#[ignore = "ten thousand cases: part of cargo xtask verify"]
fn ten_thousand_random_tables_are_equal() {
    run(CASES_OF_VERIFY);
}
