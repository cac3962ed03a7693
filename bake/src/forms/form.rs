//! Alternating trilinear forms, and how refinement acts on them.

use super::exact::Field;
use super::scheme::Row;

/// An alternating trilinear form over the coordinates of some control points:
///
/// `volume = sum over i < j < k of c_ijk det(p_i, p_j, p_k)`,
///
/// which is the sum over all i, j, k of `c_ijk x_i y_j z_k` with `c` extended by its signs.
#[derive(Clone, Debug, PartialEq)]
pub struct TrilinearForm<F> {
    size: usize,
    coefficients: Vec<F>,
}

/// Place of `i < j < k` among the triples of `size` indices in ascending order.
fn place(size: usize, i: usize, j: usize, k: usize) -> usize {
    let pairs = |n: usize| n * n.saturating_sub(1) / 2;
    let triples = |n: usize| n * n.saturating_sub(1) * n.saturating_sub(2) / 6;
    let above_i = triples(size) - triples(size - i);
    let above_j = pairs(size - i - 1) - pairs(size - j);
    above_i + above_j + (k - j - 1)
}

/// All triples `i < j < k` below `size`, ascending.
pub(crate) fn triples(size: usize) -> impl Iterator<Item = [usize; 3]> {
    (0..size)
        .flat_map(move |i| (i + 1..size).flat_map(move |j| (j + 1..size).map(move |k| [i, j, k])))
}

/// A dense tensor of three indices.
struct Tensor<F> {
    dimensions: [usize; 3],
    values: Vec<F>,
}

impl<F: Field> Tensor<F> {
    fn zero(dimensions: [usize; 3]) -> Self {
        let length = dimensions.iter().product();
        Self {
            dimensions,
            values: vec![F::zero(); length],
        }
    }

    fn row(&self, i: usize, j: usize) -> &[F] {
        let [_, columns, depth] = self.dimensions;
        &self.values[(i * columns + j) * depth..][..depth]
    }

    fn row_mut(&mut self, i: usize, j: usize) -> &mut [F] {
        let [_, columns, depth] = self.dimensions;
        &mut self.values[(i * columns + j) * depth..][..depth]
    }
}

impl<F: Field> TrilinearForm<F> {
    /// The form with coefficient `value(i, j, k)` for each `i < j < k < size`.
    pub fn from_fn(size: usize, mut value: impl FnMut(usize, usize, usize) -> F) -> Self {
        Self {
            size,
            coefficients: triples(size).map(|[i, j, k]| value(i, j, k)).collect(),
        }
    }

    /// The form that is zero everywhere.
    #[must_use]
    pub fn zero(size: usize) -> Self {
        Self::from_fn(size, |_, _, _| F::zero())
    }

    /// Number of control points.
    #[must_use]
    pub fn size(&self) -> usize {
        self.size
    }

    /// The coefficients of `i < j < k`, ascending.
    #[must_use]
    pub fn coefficients(&self) -> &[F] {
        &self.coefficients
    }

    /// The coefficient of any three control points, counted from 0, with its sign.
    #[must_use]
    pub fn get(&self, i: usize, j: usize, k: usize) -> F {
        let mut order = [i, j, k];
        order.sort_unstable();
        let [a, b, c] = order;
        if a == b || b == c {
            return F::zero();
        }
        let value = self.coefficients[place(self.size, a, b, c)].clone();
        let even = [i, j, k] == [a, b, c] || [i, j, k] == [b, c, a] || [i, j, k] == [c, a, b];
        if even { value } else { value.negated() }
    }

    /// Sets the coefficient of `i < j < k`.
    pub(crate) fn set(&mut self, [i, j, k]: [usize; 3], value: F) {
        self.coefficients[place(self.size, i, j, k)] = value;
    }

    /// Adds to the coefficient of `i < j < k`.
    pub(crate) fn add_to(&mut self, [i, j, k]: [usize; 3], value: F) {
        let sum = &mut self.coefficients[place(self.size, i, j, k)];
        *sum = sum.plus(&value);
    }

    /// The same form in another field.
    pub fn map<G>(&self, convert: impl Fn(&F) -> G) -> TrilinearForm<G> {
        TrilinearForm {
            size: self.size,
            coefficients: self.coefficients.iter().map(convert).collect(),
        }
    }

    /// The sum of two forms over the same control points.
    #[must_use]
    pub fn plus(&self, other: &Self) -> Self {
        let pairs = self.coefficients.iter().zip(&other.coefficients);
        Self {
            size: self.size,
            coefficients: pairs.map(|(a, b)| a.plus(b)).collect(),
        }
    }

    /// The value of the form at control points.
    #[must_use]
    pub fn value(&self, points: &[[F; 3]]) -> F {
        let mut total = F::zero();
        let mut coefficients = self.coefficients.iter();
        for i in 0..self.size {
            for j in i + 1..self.size {
                let cross = cross(&points[i], &points[j]);
                let mut sum = [F::zero(), F::zero(), F::zero()];
                for (point, weight) in points[j + 1..self.size].iter().zip(&mut coefficients) {
                    for (axis, coordinate) in sum.iter_mut().zip(point) {
                        axis.add_product(weight, coordinate);
                    }
                }
                for (a, b) in cross.iter().zip(&sum) {
                    total.add_product(a, b);
                }
            }
        }
        total
    }

    /// The form seen from older control points: `rows` holds, for each control point of this
    /// form, its weights over `size` older ones.
    #[must_use]
    pub fn pull_back(&self, rows: &[Row<F>], size: usize) -> Self {
        let own = self.size;
        // One index at a time: (i, b, c), then (i, j, c), then (i, j, k).
        let mut first: Tensor<F> = Tensor::zero([size, own, own]);
        for (a, row) in rows.iter().enumerate() {
            for b in 0..own {
                for c in 0..own {
                    let value = self.get(a, b, c);
                    if value.is_zero() {
                        continue;
                    }
                    for (i, weight) in row {
                        first.row_mut(*i, b)[c].add_product(weight, &value);
                    }
                }
            }
        }
        let mut second: Tensor<F> = Tensor::zero([size, size, own]);
        for i in 0..size {
            for (b, row) in rows.iter().enumerate() {
                let values = first.row(i, b);
                for (j, weight) in row.iter().filter(|(j, _)| *j > i) {
                    let target = second.row_mut(i, *j).iter_mut();
                    for (sum, value) in target.zip(values) {
                        sum.add_product(weight, value);
                    }
                }
            }
        }
        let mut result = Self::zero(size);
        for i in 0..size {
            for j in i + 1..size {
                let start = place(size, i, j, j + 1);
                for (row, value) in rows.iter().zip(second.row(i, j)) {
                    for (k, weight) in row.iter().filter(|(k, _)| *k > j) {
                        result.coefficients[start + k - j - 1].add_product(weight, value);
                    }
                }
            }
        }
        result
    }
}

impl TrilinearForm<f64> {
    /// The value of the form at control points, and its derivative by each of them, multiplied
    /// by `factor` and added to `gradient`.
    pub(crate) fn add_gradient(&self, points: &[[f64; 3]], gradient: &mut [[f64; 3]]) {
        let mut coefficients = self.coefficients.iter();
        for i in 0..self.size {
            for j in i + 1..self.size {
                let area = cross(&points[i], &points[j]);
                let mut sum = [0.0; 3];
                for k in j + 1..self.size {
                    let Some(weight) = coefficients.next() else {
                        return;
                    };
                    for axis in 0..3 {
                        sum[axis] += weight * points[k][axis];
                        gradient[k][axis] += weight * area[axis];
                    }
                }
                let by_i = cross(&points[j], &sum);
                let by_j = cross(&sum, &points[i]);
                for axis in 0..3 {
                    gradient[i][axis] += by_i[axis];
                    gradient[j][axis] += by_j[axis];
                }
            }
        }
    }
}

/// The cross product.
pub(crate) fn cross<F: Field>(a: &[F; 3], b: &[F; 3]) -> [F; 3] {
    let minor = |x: usize, y: usize| a[x].times(&b[y]).minus(&a[y].times(&b[x]));
    [minor(1, 2), minor(2, 0), minor(0, 1)]
}
