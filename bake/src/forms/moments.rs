//! Moments of the solid that a limit surface encloses: volume, centroid, inertia.
//!
//! For a homogeneous function `g` of degree `d` the integral over the cone from the origin over a
//! facet is `1/(d+3)` times the integral of `g(p) det(p, dp/ds, dp/dt)` over the facet. On a regular
//! facet that integrand is a polynomial, and Gauss points integrate it without error but for
//! rounding. An irregular facet is the sum of the three regular children of every step toward its
//! irregular place; what they add falls at least by a factor of 2.4 a step.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use std::f64::consts::PI;

use super::error::FormError;
use super::form::cross;
use super::local;
use super::patch::Patch;
use super::polynomial::{Domain, Polynomial};
use super::scheme::{Scheme, apply};
use super::surface::{FacetKind, LimitSurface, centred, gather};

/// Volume, centroid and inertia of a solid of unit density.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moments {
    /// The volume.
    pub volume: f64,
    /// The centroid.
    pub centroid: [f64; 3],
    /// The inertia tensor about the centroid, axes as the coordinates: `[0][0]` is the integral of
    /// `y^2 + z^2`, `[0][1]` that of `-x y`.
    pub inertia: [[f64; 3]; 3],
}

impl LimitSurface<f64> {
    /// The integral of `x^a y^b z^c` over the enclosed solid, for exponents `[a, b, c]` with a sum of
    /// at most 3.
    ///
    /// # Errors
    ///
    /// [`FormError::Points`] if the number of control points is not that of the mesh,
    /// [`FormError::NoMoments`] if facets have forms of the volume only.
    pub fn integral(&self, points: &[[f64; 3]], exponents: [u8; 3]) -> Result<f64, FormError> {
        let degree = exponents
            .iter()
            .map(|&exponent| f64::from(exponent))
            .sum::<f64>();
        let [value] = self.integrate(points, &|point: [f64; 3]| {
            let powers = point.iter().zip(exponents);
            let monomial: f64 = powers
                .map(|(c, exponent)| c.powi(exponent.into()))
                .product();
            [monomial / (degree + 3.0)]
        })?;
        Ok(value)
    }

    /// The integrals of x, y and z over the enclosed solid.
    ///
    /// # Errors
    ///
    /// [`FormError::Points`] if the number of control points is not that of the mesh,
    /// [`FormError::NoMoments`] if facets have forms of the volume only.
    pub fn first_moment(&self, points: &[[f64; 3]]) -> Result<[f64; 3], FormError> {
        self.integrate(points, &|point: [f64; 3]| point.map(|value| value / 4.0))
    }

    /// The integrals over the enclosed solid of homogeneous functions; `functions` gives their
    /// values at a point, each divided by its degree plus 3.
    fn integrate<const N: usize>(
        &self,
        points: &[[f64; 3]],
        functions: &impl Fn([f64; 3]) -> [f64; N],
    ) -> Result<[f64; N], FormError> {
        let scheme = Scheme::of_surface(self.scheme()).ok_or(FormError::NoMoments)?;
        let refined = self.refined_points(points)?;
        let rule = Rule::new(scheme);
        let mut children = BTreeMap::new();
        let mut total = [0.0; N];
        for facet in self.facets() {
            let own = gather(facet, &refined);
            let FacetKind::Valence(valence) = facet.kind else {
                return Err(FormError::NoMoments);
            };
            if valence == scheme.regular_valence() {
                add(&mut total, &rule.integrate(&own, functions));
                continue;
            }
            let matrices = match children.entry(valence) {
                Entry::Occupied(entry) => entry.into_mut(),
                Entry::Vacant(entry) => entry.insert(local::children::<f64>(scheme, valence)?),
            };
            add(&mut total, &irregular(&rule, matrices, own, functions));
        }
        Ok(total)
    }

    /// Volume, centroid and inertia of the enclosed solid at unit density.
    ///
    /// # Errors
    ///
    /// [`FormError::Points`] if the number of control points is not that of the mesh,
    /// [`FormError::NoMoments`] if facets have forms of the volume only.
    pub fn moments(&self, points: &[[f64; 3]]) -> Result<Moments, FormError> {
        let (moved, middle) = centred(points);
        let integrals = self.integrate(&moved, &second_order)?;
        Ok(Moments::of_integrals(integrals, middle))
    }
}

impl Moments {
    /// From the integrals of 1, x, y, z, xx, yy, zz, xy, yz, zx over a solid that was moved so that
    /// `middle` is the origin.
    pub(crate) fn of_integrals(integrals: [f64; 10], middle: [f64; 3]) -> Self {
        let [volume, x, y, z, xx, yy, zz, xy, yz, zx] = integrals;
        let [cx, cy, cz] = [x, y, z].map(|first| first / volume);
        // Moved to the centroid: the parallel axis theorem.
        let (xx, yy, zz) = (xx - cx * x, yy - cy * y, zz - cz * z);
        let (xy, yz, zx) = (xy - cx * y, yz - cy * z, zx - cz * x);
        Self {
            volume,
            centroid: [cx + middle[0], cy + middle[1], cz + middle[2]],
            inertia: [
                [yy + zz, -xy, -zx],
                [-xy, zz + xx, -yz],
                [-zx, -yz, xx + yy],
            ],
        }
    }
}

/// The integrals of 1, x, y, z, xx, yy, zz, xy, yz, zx over the inside of a closed mesh, its faces fans
/// of triangles round the mean of their corners: sums over the cones from the origin.
pub(crate) fn polyhedral_integrals<'a>(
    faces: impl Iterator<Item = &'a [u32]>,
    points: &[[f64; 3]],
) -> [f64; 10] {
    let mut total = [0.0; 10];
    for face in faces {
        let at = |place: usize| points[face[place % face.len()] as usize];
        if face.len() == 3 {
            add(&mut total, &cone([at(0), at(1), at(2)]));
            continue;
        }
        let mut mean = [0.0; 3];
        for place in 0..face.len() {
            for (axis, coordinate) in mean.iter_mut().zip(at(place)) {
                *axis += coordinate / face.len() as f64;
            }
        }
        for place in 0..face.len() {
            add(&mut total, &cone([mean, at(place), at(place + 1)]));
        }
    }
    total
}

/// The integrals over the tetrahedron of the origin and three points: of a linear function its volume
/// times the sum at the corners over 4, of a product of two the sum of products and the product of sums
/// over 20.
fn cone([a, b, c]: [[f64; 3]; 3]) -> [f64; 10] {
    let normal = cross(&b, &c);
    let volume = (a[0] * normal[0] + a[1] * normal[1] + a[2] * normal[2]) / 6.0;
    let sum = [0, 1, 2].map(|axis| a[axis] + b[axis] + c[axis]);
    let product = |i: usize, j: usize| {
        let products = a[i] * a[j] + b[i] * b[j] + c[i] * c[j];
        volume * (products + sum[i] * sum[j]) / 20.0
    };
    let [x, y, z] = sum.map(|value| volume * value / 4.0);
    [
        volume,
        x,
        y,
        z,
        product(0, 0),
        product(1, 1),
        product(2, 2),
        product(0, 1),
        product(1, 2),
        product(2, 0),
    ]
}

/// 1, x, y, z, xx, yy, zz, xy, yz, zx, each divided by its degree plus 3.
fn second_order([x, y, z]: [f64; 3]) -> [f64; 10] {
    let first = [x, y, z].map(|value| value / 4.0);
    let second = [x * x, y * y, z * z, x * y, y * z, z * x].map(|value| value / 5.0);
    let mut all = [1.0 / 3.0; 10];
    all[1..4].copy_from_slice(&first);
    all[4..].copy_from_slice(&second);
    all
}

/// An irregular facet: the regular children of every step toward its irregular place.
fn irregular<const N: usize>(
    rule: &Rule,
    matrices: &local::Children<f64>,
    mut own: Vec<[f64; 3]>,
    functions: &impl Fn([f64; 3]) -> [f64; N],
) -> [f64; N] {
    let mut total = [0.0; N];
    for _ in 0..MAX_STEPS {
        let mut step = [0.0; N];
        for rows in &matrices[..3] {
            add(&mut step, &rule.integrate(&apply(rows, &own), functions));
        }
        add(&mut total, &step);
        let small = |(part, whole): (&f64, &f64)| part.abs() <= whole.abs() * (f64::EPSILON / 16.0);
        if step.iter().zip(&total).all(small) {
            break;
        }
        own = apply(&matrices[3], &own);
    }
    total
}

/// More steps than any valence needs: 2.4^64 is above 2^80.
const MAX_STEPS: usize = 64;

fn add<const N: usize>(total: &mut [f64; N], values: &[f64; N]) {
    for (sum, value) in total.iter_mut().zip(values) {
        *sum += value;
    }
}

/// Gauss points on a regular facet, with the basis and its derivatives there.
struct Rule {
    nodes: Vec<Node>,
}

struct Node {
    weight: f64,
    values: Vec<f64>,
    by_s: Vec<f64>,
    by_t: Vec<f64>,
}

impl Rule {
    fn new(scheme: Scheme) -> Self {
        let patch = Patch::new(scheme);
        #[expect(clippy::cast_precision_loss, reason = "denominators are at most 2304")]
        let scale = 1.0 / patch.denominator as f64;
        let by_s = patch.basis.iter().map(Polynomial::by_s).collect::<Vec<_>>();
        let by_t = patch.basis.iter().map(Polynomial::by_t).collect::<Vec<_>>();
        let at = |basis: &[Polynomial], s, t| {
            let values = basis.iter().map(|member| member.at(s, t) * scale);
            values.collect::<Vec<_>>()
        };
        // A function of degree 3 makes six factors. Bicubic ones with a derivative in each
        // variable: degree 17, 9 points. Quartics with two derivatives: degree 22, and one more
        // for the triangle's own factor, 12 points.
        let line = gauss(match patch.domain {
            Domain::Square => 9,
            Domain::Triangle => 12,
        });
        let mut nodes = Vec::new();
        for (u, u_weight) in &line {
            for (v, v_weight) in &line {
                let (s, t, weight) = match patch.domain {
                    Domain::Square => (*u, *v, u_weight * v_weight),
                    Domain::Triangle => (*u, (1.0 - u) * v, u_weight * v_weight * (1.0 - u)),
                };
                nodes.push(Node {
                    weight,
                    values: at(&patch.basis, s, t),
                    by_s: at(&by_s, s, t),
                    by_t: at(&by_t, s, t),
                });
            }
        }
        Self { nodes }
    }

    fn integrate<const N: usize>(
        &self,
        points: &[[f64; 3]],
        functions: &impl Fn([f64; 3]) -> [f64; N],
    ) -> [f64; N] {
        let mut total = [0.0; N];
        for node in &self.nodes {
            let [x, y, z] = blend(&node.values, points);
            let [a, b, c] = cross(&blend(&node.by_s, points), &blend(&node.by_t, points));
            let cone = node.weight * (x * a + y * b + z * c);
            add(&mut total, &functions([x, y, z]).map(|value| value * cone));
        }
        total
    }
}

fn blend(weights: &[f64], points: &[[f64; 3]]) -> [f64; 3] {
    let mut sum = [0.0; 3];
    for (weight, point) in weights.iter().zip(points) {
        for (axis, coordinate) in sum.iter_mut().zip(point) {
            *axis += weight * coordinate;
        }
    }
    sum
}

/// The points and weights of Gauss and Legendre on the interval from 0 to 1.
fn gauss(count: u32) -> Vec<(f64, f64)> {
    let n = f64::from(count);
    let mut nodes = Vec::new();
    for place in 0..count {
        let mut x = (PI * (f64::from(place) + 0.75) / (n + 0.5)).cos();
        let mut slope = 1.0;
        // Newton's method on Legendre's polynomial, from Tricomi's estimate: quadratic at once.
        for _ in 0..8 {
            let (mut before, mut value) = (1.0, x);
            for k in 2..=count {
                let k = f64::from(k);
                let next = ((2.0 * k - 1.0) * x * value - (k - 1.0) * before) / k;
                before = value;
                value = next;
            }
            slope = n * (x * value - before) / (x * x - 1.0);
            x -= value / slope;
        }
        let weight = 1.0 / ((1.0 - x * x) * slope * slope);
        nodes.push(((1.0 - x) / 2.0, weight));
    }
    nodes
}
