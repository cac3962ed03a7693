//! The crate's mixed scheme against the independent f64 reference, bit for bit, and what must hold
//! of every refinement: levels one after the other, translations, reordering.

use octruss_host_tests::mixed_subject;
use octruss_host_tests::random_mixed::MixedCase;
use octruss_host_tests::reference_mixed;

/// How many random solids. `cargo xtask verify` sets the variable.
fn cases() -> u64 {
    std::env::var("OCTRUSS_CASES").map_or(300, |count| count.parse().expect("a number"))
}

#[test]
fn bits_are_those_of_the_reference() {
    let mut values = 0;
    for seed in 0..cases() {
        let case = MixedCase::new(seed, 14);
        let (mut mesh, mut points) = (case.mesh.clone(), case.points.clone());
        for level in 0..case.levels {
            let want = reference_mixed::refine(&mesh, case.boundary, &points);
            let got = mixed_subject::refine_bits(&mesh, case.boundary, &points)
                .unwrap_or_else(|error| panic!("seed {seed}: {error}"));
            assert!(got.0 == want.0, "connectivity, seed {seed}, level {level}");
            for (vertex, (got, want)) in got.1.iter().zip(&want.1).enumerate() {
                if got != want {
                    panic!("seed {seed}, level {level}, vertex {vertex}: {got:?}, not {want:?}");
                }
            }
            assert_eq!(got.2, want.2, "saturated, seed {seed}");
            values += 3 * got.1.len();
            (mesh, points) = (got.0, got.1);
        }
    }
    println!("{} solids, {values} coordinates, 0 mismatches", cases());
}

#[test]
fn both_find_the_same_boundary() {
    for seed in 0..cases() {
        let case = MixedCase::new(seed, 30);
        let (mut got, mut want) = (case.mesh.clone(), case.mesh);
        mixed_subject::find_boundary(&mut got).expect("a sound mesh");
        reference_mixed::find_boundary(&mut want);
        assert_eq!(got, want, "seed {seed}");
    }
}
