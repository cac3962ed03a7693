//! Core's box-spline solids against the independent reference, bit for bit.

use octruss_host_tests::box_spline_cases::compare;

/// How many random solids. `cargo xtask verify` sets the variable.
fn cases() -> u64 {
    std::env::var("OCTRUSS_CASES").map_or(600, |count| count.parse().expect("a number"))
}

#[test]
fn random_solids_agree_in_every_bit() {
    let cases = cases();
    let compared = compare(0..cases);
    println!("{compared:?}, 0 mismatches");
    assert_eq!(compared.cases, cases);
    assert!(compared.with_sheets > cases / 6 && compared.diagonals > cases * 5 / 6);
}
