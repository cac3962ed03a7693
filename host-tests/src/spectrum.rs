//! Eigenvalues and norms of subdivision matrices.

use nalgebra::linalg::Schur;
use nalgebra::{Complex, DMatrix};
use num_traits::ToPrimitive as _;

use crate::rational::{BigRational, null_space, ratio};

/// The nearest matrix of double-precision numbers.
pub fn to_matrix(rows: &[Vec<BigRational>]) -> DMatrix<f64> {
    let columns = rows.first().map_or(0, Vec::len);
    DMatrix::from_fn(rows.len(), columns, |i, k| {
        rows[i][k].to_f64().expect("a finite number")
    })
}

/// The magnitudes of all eigenvalues, greatest first.
///
/// # Panics
/// If the iteration does not converge.
pub fn eigenvalue_magnitudes(matrix: &DMatrix<f64>) -> Vec<f64> {
    // Below 1e-13 an off-diagonal entry counts as zero; to ask for less can go on forever.
    let schur = Schur::try_new(matrix.clone(), 1e-13, 100_000).expect("convergence");
    let eigenvalues = schur.complex_eigenvalues();
    let mut magnitudes: Vec<f64> = eigenvalues
        .iter()
        .map(|value: &Complex<f64>| value.re.hypot(value.im))
        .collect();
    magnitudes.sort_by(|one, other| other.total_cmp(one));
    magnitudes
}

/// The number of linearly independent eigenvectors of an eigenvalue, exactly.
pub fn eigenspace_dimension(rows: &[Vec<BigRational>], eigenvalue: &BigRational) -> usize {
    let mut shifted = rows.to_vec();
    for (place, row) in shifted.iter_mut().enumerate() {
        row[place] -= eigenvalue;
    }
    null_space(shifted, rows.len()).len()
}

/// An upper bound of the joint spectral radius: the greatest spectral norm of all products of
/// `length` of the matrices, and its root of that order.
///
/// The spectral norm is submultiplicative, so the joint spectral radius is at most this for
/// every length.
pub fn joint_spectral_bound(matrices: &[DMatrix<f64>], length: usize) -> f64 {
    let size = matrices[0].nrows();
    let mut products = vec![DMatrix::identity(size, size)];
    for _ in 0..length {
        let longer = |product: &DMatrix<f64>| -> Vec<_> {
            matrices.iter().map(|matrix| matrix * product).collect()
        };
        products = products.iter().flat_map(longer).collect();
    }
    let norms = products
        .into_iter()
        .map(|product| product.singular_values().max());
    norms.fold(0.0, f64::max).powf(1.0 / length as f64)
}

/// The same maps in a basis in which they are short: that of the ellipsoid x' P x = 1 with
/// P = I + sum of A' P A / rate^2 over all of them.
///
/// If there is such a P, every map shortens the ellipsoid's norm by `rate` at least. A similar matrix
/// has the same products up to one similarity, so a bound of the joint spectral radius in the new
/// basis is one in the old.
///
/// # Panics
/// If the maps do not contract so fast in the mean square.
pub fn in_contracting_norm(matrices: &[DMatrix<f64>], rate: f64) -> Vec<DMatrix<f64>> {
    let size = matrices[0].nrows();
    let scaled: Vec<_> = matrices.iter().map(|matrix| matrix / rate).collect();
    let mut ellipsoid = DMatrix::<f64>::identity(size, size);
    for _ in 0..10_000 {
        let terms = scaled.iter().map(|map| map.transpose() * &ellipsoid * map);
        let next = terms.fold(DMatrix::identity(size, size), |sum, term| sum + term);
        let change = (&next - &ellipsoid).amax();
        ellipsoid = next;
        if change <= 1e-9 * ellipsoid.amax() {
            let factor = ellipsoid.cholesky().expect("at least the identity").l();
            let basis = factor.transpose();
            let inverse = basis.clone().try_inverse().expect("a triangle");
            let turned = matrices.iter().map(|map| &basis * map * &inverse);
            return turned.collect();
        }
    }
    panic!("the maps do not contract by {rate}");
}

/// An orthonormal basis, as columns, of the vectors orthogonal to all columns of a matrix of
/// full rank.
pub fn orthogonal_complement(columns: &DMatrix<f64>) -> DMatrix<f64> {
    let (size, rank) = columns.shape();
    let gram = columns * columns.transpose();
    let eigen = gram.symmetric_eigen();
    let mut order: Vec<usize> = (0..size).collect();
    order.sort_by(|one, other| eigen.eigenvalues[*one].total_cmp(&eigen.eigenvalues[*other]));
    DMatrix::from_fn(size, size - rank, |i, k| eigen.eigenvectors[(i, order[k])])
}

/// One, a half or a quarter: the eigenvalues that polynomials of degree 0, 1 and 2 have.
pub fn polynomial_eigenvalue(degree: u32) -> BigRational {
    ratio(1, 1 << degree)
}
