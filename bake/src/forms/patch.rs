//! Regular facets: the polynomials that their surface is made of.
//!
//! A regular facet is a polynomial patch, `p(s, t) = sum of B_i(s, t) p_i`: biquadratic for
//! Doo-Sabin, bicubic for Catmull-Clark (both products of uniform B-splines), and for Loop a
//! quartic on a triangle, the box spline of three doubled directions.

use std::collections::HashMap;

use num_rational::BigRational;

use super::exact::Quadratic;
use super::form::TrilinearForm;
use super::polynomial::{Domain, Polynomial};
use super::scheme::Scheme;

/// The basis of a regular facet: `denominator * B_i` for each control point, in the form's order.
#[derive(Clone, Debug)]
pub(crate) struct Patch {
    pub basis: Vec<Polynomial>,
    pub denominator: i128,
    pub domain: Domain,
}

impl Patch {
    pub(crate) fn new(scheme: Scheme) -> Self {
        match scheme {
            Scheme::DooSabin => Self::tensor(&[&[1, -2, 1], &[1, 2, -2], &[0, 0, 1]], 2),
            Scheme::CatmullClark => Self::tensor(
                &[
                    &[1, -3, 3, -1],
                    &[4, 0, -6, 3],
                    &[1, 3, 3, -3],
                    &[0, 0, 0, 1],
                ],
                6,
            ),
            Scheme::Loop | Scheme::LoopWarren => Self::box_spline(),
        }
    }

    /// Products of the pieces of one uniform B-spline.
    fn tensor(pieces: &[&[i128]], denominator: i128) -> Self {
        let product = |t: &&[i128]| {
            let row = pieces.iter().map(|s| Polynomial::product_of(s, t));
            row.collect::<Vec<_>>()
        };
        Self {
            basis: pieces.iter().flat_map(product).collect(),
            denominator: denominator * denominator,
            domain: Domain::Square,
        }
    }

    /// The quartics of the box spline. Each takes the limit values that two refinements of a
    /// single control point give on the quarters of the triangle, which determine a quartic.
    fn box_spline() -> Self {
        let quarters = box_spline_at_quarters();
        let mut basis = Vec::with_capacity(12);
        for (s, t) in TRIANGLE_LATTICE {
            let mut sum = Polynomial::constant(0);
            for i in 0..=4 {
                for j in 0..=4 - i {
                    let place = (i - 4 * s, j - 4 * t);
                    let value = quarters.get(&place).copied().unwrap_or_default();
                    sum = sum.plus(value, &quartic_through(i, j));
                }
            }
            basis.push(sum);
        }
        // 16 for each refinement, 12 for the limit, 24 for the quartics.
        let denominator = 16 * 16 * 12 * 24;
        let common = basis
            .iter()
            .fold(denominator, |common, member| member.common_divisor(common));
        Self {
            basis: basis
                .iter()
                .map(|member| member.divided_by(common))
                .collect(),
            denominator: denominator / common,
            domain: Domain::Triangle,
        }
    }

    /// The alternating form of the volume between a facet and the origin,
    /// `1/3 integral of det(p, dp/ds, dp/dt)`.
    pub(crate) fn form(&self) -> TrilinearForm<Quadratic> {
        let size = self.basis.len();
        let by_s = self.basis.iter().map(Polynomial::by_s).collect::<Vec<_>>();
        let by_t = self.basis.iter().map(Polynomial::by_t).collect::<Vec<_>>();
        let area = |j: usize, k: usize| {
            let product = by_s[j].times(&by_t[k]);
            product.plus(-1, &by_s[k].times(&by_t[j]))
        };
        let mut areas = HashMap::new();
        for j in 0..size {
            for k in j + 1..size {
                areas.insert((j, k), area(j, k));
            }
        }
        let scale = BigRational::from(num_bigint::BigInt::from(3 * self.denominator.pow(3)));
        TrilinearForm::from_fn(size, |i, j, k| {
            let cone = self.basis[i]
                .times(&areas[&(j, k)])
                .plus(-1, &self.basis[j].times(&areas[&(i, k)]))
                .plus(1, &self.basis[k].times(&areas[&(i, j)]));
            (cone.integral(self.domain) / &scale).into()
        })
    }
}

/// Where the control points of a regular triangle lie, in its coordinates `(s, t)`: the facet is
/// (0, 0) (1, 0) (0, 1).
const TRIANGLE_LATTICE: [(i32, i32); 12] = [
    (0, -1),
    (1, -1),
    (2, -1),
    (-1, 0),
    (0, 0),
    (1, 0),
    (2, 0),
    (-1, 1),
    (0, 1),
    (1, 1),
    (-1, 2),
    (0, 2),
];

/// `16^2 * 12` times the box spline at the quarters of the lattice.
fn box_spline_at_quarters() -> HashMap<(i32, i32), i128> {
    let mut values = HashMap::from([((0, 0), 1_i128)]);
    for _ in 0..2 {
        let mut refined: HashMap<(i32, i32), i128> = HashMap::new();
        for (&(s, t), value) in &values {
            for ((ds, dt), weight) in refinement_mask() {
                *refined.entry((2 * s + ds, 2 * t + dt)).or_default() += value * weight;
            }
        }
        values = refined;
    }
    let mut limit: HashMap<(i32, i32), i128> = HashMap::new();
    for (&(s, t), value) in &values {
        *limit.entry((s, t)).or_default() += 6 * value;
        for (ds, dt) in [(1, 0), (0, 1), (-1, 1), (-1, 0), (0, -1), (1, -1)] {
            *limit.entry((s + ds, t + dt)).or_default() += value;
        }
    }
    limit
}

/// 16 times the weights of Loop's regular refinement, `(1+x)^2 (1+y)^2 (1+y/x)^2 / y^2`.
fn refinement_mask() -> HashMap<(i32, i32), i128> {
    let mut mask = HashMap::from([((0, -2), 1_i128)]);
    for (ds, dt) in [(1, 0), (1, 0), (0, 1), (0, 1), (-1, 1), (-1, 1)] {
        let mut product = mask.clone();
        for (&(s, t), value) in &mask {
            *product.entry((s + ds, t + dt)).or_default() += value;
        }
        mask = product;
    }
    mask
}

/// 24 times the quartic that is 1 at `(i/4, j/4)` and 0 at the other quarters of the triangle.
fn quartic_through(i: i32, j: i32) -> Polynomial {
    let [i, j] = [i, j].map(i128::from);
    let coordinates = [(i, [0, 4, 0]), (j, [0, 0, 4]), (4 - i - j, [4, -4, -4])];
    let mut product = Polynomial::constant(24);
    for (count, [constant, in_s, in_t]) in coordinates {
        for factor in 0..count {
            let linear = Polynomial::linear(constant - factor, in_s, in_t);
            product = product.times(&linear);
        }
        let factorial: i128 = (1..=count).product();
        product = product.divided_by(factorial);
    }
    product
}
