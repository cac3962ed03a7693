//! The face case of appendix A: two tetrahedra of the base mesh that share a triangle.
//!
//! The infinite mesh along the face is cut from two tetrahedra refined four times, around the
//! face's vertex with the barycentric coordinates (6, 5, 5)/16. A patch is a parallelogram of
//! one triangle between two tetrahedra and one between two octahedra; the next level has four
//! like it, each a shift of the first. The support used here is the smallest set of vertices that
//! contains the patch's four corners and, for each of the four shifts, everything that the
//! set's images depend on: 40 vertices.

use nalgebra::DMatrix;
use num_traits::Zero as _;
use octruss_host_tests::local::{Neighbourhood, Offset, Placed};
use octruss_host_tests::meshes::two_tetrahedra;
use octruss_host_tests::rational::{BigRational, ratio};
use octruss_host_tests::spectrum::{
    eigenspace_dimension, eigenvalue_magnitudes, joint_spectral_bound, orthogonal_complement,
    polynomial_eigenvalue, to_matrix,
};
use octruss_host_tests::subject::{SCHEMES, Scheme};

const LEVEL: usize = 4;

/// The vertex of the face that offsets are counted from.
const CENTRE: [i32; 5] = [6, 5, 5, 0, 0];

/// The corners of the patch, which are also the shifts to the next level's four patches.
const PATCH: [[i32; 5]; 4] = [
    [0, 0, 0, 0, 0],
    [-1, 1, 0, 0, 0],
    [-1, 0, 1, 0, 0],
    [-2, 1, 1, 0, 0],
];

struct Face {
    neighbourhood: Neighbourhood,
    patch: Vec<Offset>,
    support: Vec<Offset>,
}

impl Face {
    fn new(scheme: &dyn Scheme) -> Self {
        let placed = Placed::base(two_tetrahedra()).at_level(LEVEL);
        let neighbourhood = Neighbourhood::new(scheme, &placed, &CENTRE.to_vec(), 5);
        let patch: Vec<Offset> = PATCH.iter().map(|corner| corner.to_vec()).collect();
        let support = neighbourhood.closure(&patch, &patch);
        assert_eq!(support.len(), 40);
        Self {
            neighbourhood,
            patch,
            support,
        }
    }

    fn matrices(&self) -> Vec<Vec<Vec<BigRational>>> {
        let matrix = |shift| self.neighbourhood.matrix(&self.support, shift);
        self.patch.iter().map(matrix).collect()
    }
}

/// Rational points of two regular tetrahedra, mirror images of each other, of edge sqrt 2.
fn mirror_images() -> [[BigRational; 3]; 5] {
    let corners = [[3, 3, 0], [3, 0, 3], [0, 3, 3], [0, 0, 0], [4, 4, 4]];
    corners.map(|corner| corner.map(|coordinate| ratio(coordinate, 3)))
}

/// A point of the characteristic map: an offset at the level of edge length sqrt 2.
fn point(offset: &Offset) -> [BigRational; 3] {
    let corners = mirror_images();
    [0, 1, 2].map(|axis| {
        let weighted = offset.iter().zip(&corners);
        weighted
            .map(|(weight, corner)| ratio(i64::from(*weight), 1) * &corner[axis])
            .sum()
    })
}

/// The ten monomials of degree 0 to 2 as exponents of x, y and z.
const MONOMIALS: [[usize; 3]; 10] = [
    [0, 0, 0],
    [1, 0, 0],
    [0, 1, 0],
    [0, 0, 1],
    [2, 0, 0],
    [0, 2, 0],
    [0, 0, 2],
    [1, 1, 0],
    [0, 1, 1],
    [1, 0, 1],
];

/// The quasi-interpolant of the regular mesh at the level of edge length `edge`:
/// `p - edge^2/9 Laplacian(p)` (P3, chapter 3: `Q = Id - 1/9 Laplacian` for unit edges).
fn quasi_interpolant(
    monomial: &[usize; 3],
    at: &[BigRational; 3],
    edge_squared: &BigRational,
) -> BigRational {
    let power = |axis: usize| {
        (0..monomial[axis])
            .map(|_| &at[axis])
            .product::<BigRational>()
    };
    let value = power(0) * power(1) * power(2);
    let laplacian = if monomial.contains(&2) {
        ratio(2, 1)
    } else {
        ratio(0, 1)
    };
    value - edge_squared * laplacian * ratio(1, 9)
}

/// READINGS P1, "face case eigenvalues": 1, 1/2 x3, 1/4 x6, then 0.136699. The multiplicities
/// are exact numbers of independent eigenvectors.
#[test]
fn face_case_eigenvalues() {
    for scheme in SCHEMES {
        let face = Face::new(scheme);
        let rows = face.neighbourhood.matrix(&face.support, &face.patch[0]);
        for (degree, multiplicity) in [(0, 1), (1, 3), (2, 6)] {
            let dimension = eigenspace_dimension(&rows, &polynomial_eigenvalue(degree));
            assert_eq!(dimension, multiplicity, "{} degree {degree}", scheme.name());
        }
        let found = eigenvalue_magnitudes(&to_matrix(&rows));
        let expected = [
            1.0, 0.5, 0.5, 0.5, 0.25, 0.25, 0.25, 0.25, 0.25, 0.25, 0.136_699,
        ];
        for (found, expected) in found.iter().zip(expected) {
            // Half a unit of the last printed digit.
            assert!(
                (found - expected).abs() <= 0.5e-6,
                "{found} instead of {expected}"
            );
        }
    }
}

/// READINGS P1, "face smoothness": S Q p = Q sigma p for every quadratic p, exactly; on both
/// sides of the face, on it, and everywhere around the patch.
#[test]
fn quadratics_are_reproduced_across_the_face() {
    let edge_squared = ratio(2, 1);
    for scheme in SCHEMES {
        let face = Face::new(scheme);
        for shift in &face.patch {
            for offset in &face.support {
                let new: Offset = offset.iter().zip(shift).map(|(a, b)| a + b).collect();
                // The new level has half the edge length: the same map seen at half the size.
                let at = point(&new).map(|coordinate| coordinate * ratio(1, 2));
                for monomial in &MONOMIALS {
                    let expected = quasi_interpolant(monomial, &at, &ratio(1, 2));
                    let mut sum = BigRational::zero();
                    for (old, weight) in face.neighbourhood.row(&new) {
                        sum += weight * quasi_interpolant(monomial, &point(old), &edge_squared);
                    }
                    assert_eq!(sum, expected, "{} {monomial:?} at {new:?}", scheme.name());
                }
            }
        }
    }
}

/// READINGS P1: the joint spectral radius is below 1/4, seen at k = 4 on the minimal support
/// (the 40 vertices of the module documentation).
///
/// The four matrices map quadratics to quadratics; `Y` is what they do to the orthogonal
/// complement of the quadratics' values. The bound is the greatest spectral norm of all 256
/// products of four, to the power 1/4, and is about 0.1975; double precision changes it by less
/// than 1e-12.
#[test]
fn joint_spectral_radius_is_below_a_quarter() {
    for scheme in SCHEMES {
        let face = Face::new(scheme);
        let values = |offset: &Offset| {
            let at = point(offset);
            MONOMIALS
                .iter()
                .map(|m| quasi_interpolant(m, &at, &ratio(2, 1)))
                .collect::<Vec<_>>()
        };
        let quadratics = to_matrix(&face.support.iter().map(values).collect::<Vec<_>>());
        let complement = orthogonal_complement(&quadratics);
        let restricted: Vec<DMatrix<f64>> = face
            .matrices()
            .iter()
            .map(|rows| complement.transpose() * to_matrix(rows) * &complement)
            .collect();
        for rows in face.matrices() {
            let left_over = complement.transpose() * to_matrix(&rows) * &quadratics;
            assert!(
                left_over.amax() < 1e-12,
                "quadratics are not mapped to quadratics"
            );
        }
        let bound = joint_spectral_bound(&restricted, 4);
        println!(
            "{}: joint spectral radius at most {bound:.6}",
            scheme.name()
        );
        assert!(bound < 0.25);
    }
}
