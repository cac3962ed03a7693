//! Core's box-spline solids against the independent reference, bit for bit.

use octruss_host_tests::box_spline_cases::compare;

/// Some hundred random solids; the long proof below takes thousands of others.
#[test]
fn random_solids_agree_in_every_bit() {
    let compared = compare(0..600);
    println!("{compared:?}");
    assert_eq!(compared.cases, 600);
    assert!(compared.with_sheets > 100 && compared.diagonals > 500);
}

#[test]
#[ignore = "six thousand cases: part of cargo xtask verify"]
fn six_thousand_random_solids_agree_in_every_bit() {
    let compared = compare(1000..7000);
    println!("{compared:?}");
    assert_eq!(compared.cases, 6000);
}
