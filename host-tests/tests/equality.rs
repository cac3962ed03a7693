//! Core on the host equals the independent reference, to the bit.

use octruss_host_tests::equality::{Report, refine_cases};
use octruss_host_tests::random_mesh::Limits;
use octruss_host_tests::snapshot;

/// How many random cases every test run compares.
const CASES: u64 = 500;

/// How many the long proof compares.
const CASES_OF_VERIFY: u64 = 10_000;

fn run(count: u64) -> Report {
    let report =
        refine_cases(0, count, &Limits::default()).unwrap_or_else(|fault| panic!("{fault}"));
    println!(
        "{} cases, {} levels, {} coordinates compared, 0 mismatches, {} saturated",
        report.cases, report.levels, report.coordinates, report.saturated
    );
    println!(
        "distance to the real-number answer, units of the last place:\n{}",
        report.distances
    );
    report
}

/// Meshes of every kind, every boundary choice, one to three levels, guard words behind every
/// buffer. The reference proves why none of the coordinates saturates.
#[test]
fn random_cases_are_equal() {
    let report = run(CASES);
    assert_eq!(report.saturated, 0);
    snapshot::check("distance.txt", &report.distances.to_string())
        .unwrap_or_else(|fault| panic!("{fault}"));
}

#[test]
#[ignore = "ten thousand cases: part of cargo xtask verify"]
fn ten_thousand_random_cases_are_equal() {
    run(CASES_OF_VERIFY);
}
