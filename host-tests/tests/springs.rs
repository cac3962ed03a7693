//! The crate's springs against the independent reference, bit for bit, on random springs, states, pushes
//! and obstacles up to the ends of every range, and what must hold of them: rest is a fixed point,
//! nothing runs away, and a shaken mesh comes back to the very bits of rest.
//!
//! `OCTRUSS_CASES` sets how many cases; the default keeps the suite quick. An hour of simulated time is
//! `--ignored`: `cargo xtask verify` runs it.

use octruss_host_tests::qemu::conformance::on_host;
use octruss_host_tests::qemu::judge::{Subject, Verdict};

fn case_count() -> u32 {
    let wanted = std::env::var("OCTRUSS_CASES").ok();
    wanted.and_then(|count| count.parse().ok()).unwrap_or(300)
}

/// Core on this machine by the very function that runs on the devices.
fn judge(subject: Subject, cases: u32) {
    let cases: Vec<_> = (0..cases).map(|seed| subject.case(seed)).collect();
    let sent: Vec<_> = cases.iter().map(|judged| judged.case.clone()).collect();
    let verdict = Verdict::of(&cases, &on_host(&sent), None);
    println!("{subject}: {verdict}");
    assert!(verdict.mismatches.is_empty(), "{verdict}");
    assert!(verdict.coordinates > 0);
}

#[test]
fn ticks_equal_the_reference() {
    judge(Subject::Springs, case_count());
}

#[test]
fn shakes_equal_the_reference() {
    judge(Subject::Shakes, case_count() / 10);
}
