//! Partial updates, factored tables and normals against the reference, bit for bit, on this machine, with
//! the very function that the emulated processors run.

use octruss_host_tests::qemu::conformance::{Case, on_host};
use octruss_host_tests::qemu::judge::{Judged, Subject, Verdict};

/// Cases; `cargo xtask verify` asks for more.
fn case_count() -> u32 {
    let asked = std::env::var("OCTRUSS_CASES").ok();
    asked.and_then(|count| count.parse().ok()).unwrap_or(500)
}

#[test]
fn updates_and_normals_give_the_bits_of_the_reference() {
    let judged: Vec<Judged> = (0..case_count())
        .map(|seed| Subject::Update.case(seed))
        .collect();
    let cases: Vec<Case> = judged.iter().map(|judged| judged.case.clone()).collect();
    let verdict = Verdict::of(&judged, &on_host(&cases), None);
    println!("{verdict}");
    assert!(verdict.mismatches.is_empty(), "{verdict}");
    assert!(verdict.coordinates > 10_000, "{verdict}");
    assert!(verdict.saturated > 100, "{verdict}");
}
