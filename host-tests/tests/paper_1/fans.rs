//! Weights on fans of tetrahedra around an edge.

use num_traits::{One as _, Zero as _};
use octruss_host_tests::meshes::fan;
use octruss_host_tests::rational::{BigRational, Row, compose, ratio};
use octruss_host_tests::reference::Boundary;
use octruss_host_tests::subject::SCHEMES;

fn least_weight(rows: &[Row]) -> BigRational {
    for row in rows {
        assert_eq!(row.values().sum::<BigRational>(), BigRational::one());
        assert!(row.values().all(|weight| *weight > BigRational::zero()));
    }
    rows.iter()
        .flat_map(|row| row.values())
        .min()
        .expect("a weight")
        .clone()
}

/// READINGS P1, "combined weights" (of split and smoothing in one): all positive on fans of 3 to 10
/// tetrahedra over two levels, least 7/4320; sums exactly 1. It holds for every boundary
/// choice, and the least weight is always the one that the axis' midpoint in ten tetrahedra gives
/// to the far corners of its octahedra, 7/24 * 1/6 over 30 cells.
///
/// The masks of both levels together are positive with sum one as well.
#[test]
fn weights_are_positive_and_add_up_to_one() {
    for scheme in SCHEMES {
        for boundary in Boundary::ALL {
            let mut least = Vec::new();
            for count in 3..=10 {
                let solid = fan(count, true);
                let (refined, first) = scheme.masks(&solid, boundary);
                let (_, second) = scheme.masks(&refined, boundary);
                least.extend([least_weight(&first), least_weight(&second)]);
                least_weight(&compose(&second, &first));
            }
            let least = least.into_iter().min();
            assert_eq!(
                least,
                Some(ratio(7, 4320)),
                "{} {boundary:?}",
                scheme.name()
            );
        }
    }
}
