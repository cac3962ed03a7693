//! The forms of irregular facets.
//!
//! The volume of a facet is that of its four children, so its form `w` satisfies
//! `w = M w + b`, where `M` pulls a form back through the child that keeps the irregular place
//! and `b` is what the three regular children add. On alternating forms every eigenvalue of `M` is a
//! product of three different ones of the refinement matrix, below 1 in magnitude, so that
//! `w = b + M b + M M b + ...` and no null space has to be fixed.

use num_bigint::BigInt;

use super::error::FormError;
use super::exact::{Field, Quadratic, QuadraticInteger, common_denominator, solve};
use super::form::{TrilinearForm, triples};
use super::local;
use super::patch::Patch;
use super::scheme::{Row, Scheme};

/// The form of a facet of this valence, exactly.
///
/// # Errors
///
/// [`FormError::NotExact`] if the weights lie in no quadratic field, [`FormError::Valence`] if
/// there is no such facet.
pub fn exact_form(scheme: Scheme, valence: usize) -> Result<TrilinearForm<Quadratic>, FormError> {
    let regular = Patch::new(scheme).form();
    if valence == scheme.regular_valence() {
        return Ok(regular);
    }
    let radicand = scheme.exact_radicand(&[valence])?;
    let children = local::children::<Quadratic>(scheme, valence)?;
    let size = scheme.control_point_count(valence);
    let added = from_regular_children(&regular, &children, size);
    let system =
        System::new(scheme, &children[3], radicand).ok_or(FormError::NotExact { valence })?;
    let mut form = TrilinearForm::zero(size);
    for inner in 0..=3 {
        // Triples with fewer control points of the irregular place are known by now and do not
        // depend on those with more.
        let known = form.pull_back(&children[3], size).plus(&added);
        let unknown = system.triples_with(inner);
        let right = unknown
            .iter()
            .map(|&[i, j, k]| known.get(i, j, k))
            .collect::<Vec<_>>();
        let values = system
            .solve(&unknown, &right)
            .ok_or(FormError::NotExact { valence })?;
        for (triple, value) in unknown.into_iter().zip(values) {
            form.set(triple, value);
        }
    }
    Ok(form)
}

/// The form of a facet of this valence in double precision.
///
/// The iteration `w = M w + b` corrects its own rounding errors and stops when no coefficient
/// changes by more than 2^-60 of the greatest, so that the error of each coefficient is a few
/// roundings of the greatest one: the tests hold it below [`FORM_ERROR`] times the greatest
/// coefficient against the exact forms of the valences that have them.
///
/// # Errors
///
/// [`FormError::Valence`] if there is no such facet.
pub fn real_form(scheme: Scheme, valence: usize) -> Result<TrilinearForm<f64>, FormError> {
    iterated_form(scheme, valence, f64::EPSILON / 256.0)
}

/// The error of a coefficient of [`real_form`], relative to the greatest coefficient.
pub const FORM_ERROR: f64 = 1e-15;

/// The form by iteration in any field, until no coefficient changes by more than `tolerance` times
/// the greatest.
///
/// # Errors
///
/// Those of [`exact_form`].
pub fn iterated_form<F: Field>(
    scheme: Scheme,
    valence: usize,
    tolerance: f64,
) -> Result<TrilinearForm<F>, FormError> {
    let exact = Patch::new(scheme).form();
    let regular = exact.map(|value| F::from_rational(value.rational()));
    if valence == scheme.regular_valence() {
        return Ok(regular);
    }
    let children = local::children::<F>(scheme, valence)?;
    let size = scheme.control_point_count(valence);
    let added = from_regular_children(&regular, &children, size);
    let mut form = added.clone();
    // The slowest schemes gain a factor of 2.4 in each step.
    for _ in 0..200 {
        let next = form.pull_back(&children[3], size).plus(&added);
        let greatest = magnitude(next.coefficients().iter().map(Field::to_f64));
        let pairs = next.coefficients().iter().zip(form.coefficients());
        let change = magnitude(pairs.map(|(a, b)| a.minus(b).to_f64()));
        form = next;
        if change <= tolerance * greatest {
            break;
        }
    }
    Ok(form)
}

fn magnitude(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(0.0, |greatest: f64, value| greatest.max(value.abs()))
}

fn from_regular_children<F: Field>(
    regular: &TrilinearForm<F>,
    children: &local::Children<F>,
    size: usize,
) -> TrilinearForm<F> {
    children[..3]
        .iter()
        .map(|rows| regular.pull_back(rows, size))
        .fold(TrilinearForm::zero(size), |sum, form| sum.plus(&form))
}

/// The system `(1 - M) w = right`, block by block.
///
/// The control points that determine the surface at the irregular place are mapped to themselves.
/// So the coefficients fall into four blocks, by how many of a triple's control points are such
/// *inner* ones, and each block depends on itself and on those with fewer.
struct System {
    size: usize,
    outer: &'static [usize],
    /// `scale` times the refinement matrix, `[new][old]`.
    matrix: Vec<Vec<QuadraticInteger>>,
    scale: BigInt,
    radicand: u32,
}

impl System {
    fn new(scheme: Scheme, rows: &[Row<Quadratic>], radicand: u32) -> Option<Self> {
        let size = rows.len();
        let weights = rows.iter().flatten().map(|(_, weight)| weight);
        let scale = common_denominator(weights);
        let mut matrix = vec![vec![QuadraticInteger::default(); size]; size];
        for (new, row) in rows.iter().enumerate() {
            for (old, weight) in row {
                matrix[new][*old] = QuadraticInteger::from_scaled(weight, &scale)?;
            }
        }
        Some(Self {
            size,
            outer: scheme.outer_control_points(),
            matrix,
            scale,
            radicand,
        })
    }

    fn triples_with(&self, inner: usize) -> Vec<[usize; 3]> {
        let is_inner = |point: &&usize| !self.outer.contains(point);
        triples(self.size)
            .filter(|triple| triple.iter().filter(is_inner).count() == inner)
            .collect()
    }

    fn solve(&self, unknown: &[[usize; 3]], right: &[Quadratic]) -> Option<Vec<Quadratic>> {
        let cube = self.scale.pow(3);
        let one = QuadraticInteger {
            rational: i128::try_from(&cube).ok()?,
            surd: 0,
        };
        let row = |old: &[usize; 3]| {
            let entry = |(place, new): (usize, &[usize; 3])| {
                let mut entry = QuadraticInteger::default().minus(self.minor(new, old));
                if new == old {
                    entry = entry.plus(one);
                }
                (!entry.is_zero()).then_some((place, entry))
            };
            unknown.iter().enumerate().filter_map(entry).collect()
        };
        let matrix = unknown.iter().map(row).collect::<Vec<Vec<_>>>();
        let cube = Quadratic::from(num_rational::BigRational::from(cube));
        let right = right
            .iter()
            .map(|value| value.times(&cube))
            .collect::<Vec<_>>();
        solve(&matrix, &right, self.radicand)
    }

    /// The determinant of three rows and three columns of the matrix.
    fn minor(&self, new: &[usize; 3], old: &[usize; 3]) -> QuadraticInteger {
        let d = i128::from(self.radicand);
        let [a, b, c] = new.map(|row| old.map(|column| self.matrix[row][column]));
        let two = |x: usize, y: usize| b[x].times(c[y], d).minus(b[y].times(c[x], d));
        let sum = a[0].times(two(1, 2), d).plus(a[1].times(two(2, 0), d));
        sum.plus(a[2].times(two(0, 1), d))
    }
}
