//! The edge case of appendix A: `n` tetrahedra around an edge of the base mesh.

use std::slice::from_ref;

use octruss_host_tests::local::{Neighbourhood, Placed};
use octruss_host_tests::meshes::{FAN_AXIS, fan};
use octruss_host_tests::spectrum::{eigenvalue_magnitudes, to_matrix};
use octruss_host_tests::subject::SCHEMES;

/// READINGS P1, "edge case": the eigenvalues are 1, l, l, 1/2, with l as printed there.
const PRINTED: [(u32, f64); 8] = [
    (3, 0.317_021),
    (4, 0.428_122),
    (5, 0.494_787),
    (6, 0.535_631),
    (7, 0.561_939),
    (8, 0.579_716),
    (9, 0.592_230),
    (10, 0.601_347),
];

/// Half a unit of the last printed digit.
const PRINTED_ERROR: f64 = 0.5e-6;

/// The matrix is that of the smallest set of vertices around the middle of the edge that
/// depends on itself alone: the vertices of the cells at it, 3 n + 3.
#[test]
fn edge_case_eigenvalues() {
    for scheme in SCHEMES {
        for (count, lambda) in PRINTED {
            let placed = Placed::base(fan(count, true)).at_level(3);
            let mut centre = vec![0; 2 + count as usize];
            for end in FAN_AXIS {
                centre[end as usize] = 4;
            }
            let neighbourhood = Neighbourhood::new(scheme, &placed, &centre, 3);
            let here = vec![0; centre.len()];
            let set = neighbourhood.closure(from_ref(&here), from_ref(&here));
            assert_eq!(set.len(), 3 * count as usize + 3);
            let matrix = to_matrix(&neighbourhood.matrix(&set, &here));
            let mut expected = [1.0, lambda, lambda, 0.5];
            expected.sort_by(|one, other| f64::total_cmp(other, one));
            let found = eigenvalue_magnitudes(&matrix);
            for (found, expected) in found.iter().zip(expected) {
                assert!(
                    (found - expected).abs() <= PRINTED_ERROR,
                    "{} n = {count}: {found} instead of {expected}",
                    scheme.name()
                );
            }
            assert!(found[4] < expected[3]);
        }
    }
}
