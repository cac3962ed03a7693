//! The crate's health of poses against the independent reference, bit for bit, on random cages and poses up to the ends of
//! the range.
//!
//! `OCTRUSS_CASES` sets how many cases; the default keeps the suite quick.

use octruss::control::health::{Health, MOST_NAMED};
use octruss_host_tests::random_health::HealthCase;
use octruss_host_tests::reference_health::health;
use zerocopy::IntoBytes as _;

fn case_count() -> u64 {
    let wanted = std::env::var("OCTRUSS_CASES").ok();
    wanted.and_then(|count| count.parse().ok()).unwrap_or(300)
}

#[test]
fn equals_the_reference_bit_for_bit() {
    let (mut healthy, mut folded, mut without) = (0, 0, 0);
    for seed in 0..case_count() {
        let case = HealthCase::new(seed, 24);
        let section = case.section();
        let cells = Health::from_section(section.as_bytes(), &case.rest).expect("sound cells");
        let got = cells.of(&case.pose).expect("as many points");
        let want = health(&case.mesh, &case.rest, &case.pose);
        let named = |cell: octruss::control::health::Cell| [cell.shape as u32, cell.index];
        let first: Vec<_> = got.first.iter().copied().map(named).collect();
        assert_eq!(got.folded as usize, want.folded.len(), "seed {seed}");
        assert_eq!(first, want.folded[..want.folded.len().min(MOST_NAMED)]);
        assert_eq!(got.least_ratio, want.least_ratio, "seed {seed}");
        assert_eq!(got.least.map(named), want.least, "seed {seed}");
        assert_eq!(got.without_ratio, want.without_ratio, "seed {seed}");
        healthy += u32::from(got.folded == 0);
        folded += got.folded;
        without += got.without_ratio;
    }
    println!(
        "{healthy} poses healthy, {folded} cells folded, {without} tetrahedra without a ratio"
    );
    assert!(healthy > 0 && folded > 0 && without > 0);
}
