//! One level of refinement: split, smooth, and overwrite where a rule of its own holds.

use super::arithmetic::{Arithmetic, Fixed, Real};
use super::classify::{Rule, classify};
use super::smooth::smooth;
use super::solid::{Boundary, Solid, SolidError};
use super::split::{LinearSplit, split};

/// A solid one level on, with coordinates as the device has them.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Refined<const D: usize> {
    /// The refined connectivity.
    pub solid: Solid,
    /// Raw bits of the coordinates, one entry for each vertex.
    pub points: Vec<[i32; D]>,
    /// How many coordinates were outside 32 bits and were clamped.
    pub saturated: usize,
}

/// A solid one level on, in real numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct RefinedReal<const D: usize> {
    /// The refined connectivity.
    pub solid: Solid,
    /// Coordinates, one entry for each vertex.
    pub points: Vec<[f64; D]>,
}

/// Refines once in the device's numbers: exact masks, each coordinate rounded once.
///
/// # Errors
/// If the solid is not sound or the number of points is not its number of vertices.
pub fn refine<const D: usize>(
    solid: &Solid,
    points: &[[i32; D]],
    boundary: Boundary,
) -> Result<Refined<D>, SolidError> {
    let points: Vec<_> = points.iter().map(|point| point.map(f64::from)).collect();
    let mut arithmetic = Fixed::default();
    let (solid, points) = level(solid, &points, boundary, &mut arithmetic)?;
    Ok(Refined {
        solid,
        points,
        saturated: arithmetic.saturated,
    })
}

/// Refines once in double precision with real-number weights, rounding to no grid.
///
/// # Errors
/// As for [`refine`].
pub fn refine_real<const D: usize>(
    solid: &Solid,
    points: &[[f64; D]],
    boundary: Boundary,
) -> Result<RefinedReal<D>, SolidError> {
    let (solid, points) = level(solid, points, boundary, &mut Real)?;
    Ok(RefinedReal { solid, points })
}

type Level<A, const D: usize> = (Solid, Vec<[<A as Arithmetic>::Value; D]>);

fn level<A: Arithmetic, const D: usize>(
    solid: &Solid,
    points: &[[f64; D]],
    boundary: Boundary,
    arithmetic: &mut A,
) -> Result<Level<A, D>, SolidError> {
    solid.check()?;
    if points.len() != solid.vertex_count {
        return Err(SolidError::PointCount(points.len(), solid.vertex_count));
    }
    let linear = split(solid);
    linear.solid.check()?;
    let rules = classify(solid, &linear, boundary);
    let points = evaluate(&linear, &rules, points, arithmetic);
    Ok((linear.solid, points))
}

/// The positions of all vertices of a split under their rules.
pub(super) fn evaluate<A: Arithmetic, const D: usize>(
    linear: &LinearSplit,
    rules: &[Rule],
    points: &[[f64; D]],
    arithmetic: &mut A,
) -> Vec<[A::Value; D]> {
    let (numerators, denominators) = smooth(linear, points);
    let mut refined = Vec::with_capacity(rules.len());
    for (vertex, rule) in rules.iter().enumerate() {
        let edge = vertex
            .checked_sub(linear.old_vertex_count)
            .and_then(|i| linear.edges.get(i));
        refined.push(std::array::from_fn(|channel| {
            let at = |vertex: u32| points[vertex as usize][channel];
            match (rule, edge) {
                (Rule::Stay, _) => arithmetic.quotient(2.0 * points[vertex][channel], 2.0),
                (Rule::CreaseVertex([a, b]), _) => {
                    arithmetic.quotient(at(*a) + 6.0 * points[vertex][channel] + at(*b), 8.0)
                }
                (Rule::SurfaceVertex(weight, neighbours), _) => {
                    let neighbours = neighbours.iter().map(|other| at(*other));
                    arithmetic.vertex(weight, points[vertex][channel], neighbours)
                }
                (Rule::Midpoint, Some([a, b])) => arithmetic.quotient(at(*a) + at(*b), 2.0),
                (Rule::SurfaceEdge(opposite), Some([a, b])) => {
                    let count = opposite.len() as f64;
                    let sum = opposite.iter().map(|other| at(*other)).sum::<f64>();
                    let numerator = 3.0 * count * (at(*a) + at(*b)) + 2.0 * sum;
                    arithmetic.quotient(numerator, 8.0 * count)
                }
                (Rule::Interior | Rule::Midpoint | Rule::SurfaceEdge(_), _) => {
                    arithmetic.quotient(numerators[vertex][channel], denominators[vertex])
                }
            }
        }));
    }
    refined
}
