//! The inverse of the map from parameters to a cell with curved faces.
//!
//! Newton's method from the middle finds the parameters of most points. Where it does not come to
//! rest inside, the cell is cut into eight again and again: a part lies in the box of its corners, so
//! that parts whose boxes do not hold the point are dropped, and Newton's method starts again from
//! the middles of the others. So every point of the cell is found, however distorted the cell is, and
//! a point is in the cell if some point of the closed cell lies within [`reach`] of it: a few roundings
//! of the coordinates. Cells that share a face so both hold what rounding leaves beside it, and
//! nothing is lost between them.

use super::tetrahedron::combine;
use crate::geometry::{cross, dot, length, subtract};
use crate::mesh::Point;

/// A point of the parameter domain.
pub type Parameters = [f64; 3];

/// A cell as the image of a parameter domain.
pub trait Map<const N: usize> {
    /// The parameters of the corners.
    const CORNERS: [Parameters; N];

    /// The corners in space.
    fn corners(&self) -> &[Point; N];

    /// The weights of the corners. They sum to one.
    fn weights(at: Parameters) -> [f64; N];

    /// Derivatives of the weights along each parameter. Each sums to zero.
    fn derivatives(at: Parameters) -> [[f64; N]; 3];

    /// The nearest parameters of the closed domain.
    fn clamped(at: Parameters) -> Parameters;

    /// A part of the domain, given by its corners, cut into eight of the same kind.
    fn parts(corners: &[Parameters; N]) -> Vec<[Parameters; N]>;
}

/// How far from the closed cell a point may lie to count as in it: 32 roundings of its largest
/// coordinate.
pub fn reach(corners: &[Point]) -> f64 {
    let largest = corners.as_flattened().iter();
    32.0 * f64::EPSILON * largest.fold(0.0, |largest: f64, x| largest.max(x.abs()))
}

/// The parameters of a point of the closed cell; `None` if it lies outside.
///
/// The corners with the weights of these parameters give the point back to within [`reach`].
pub fn inside<const N: usize, M: Map<N>>(cell: &M, point: Point) -> Option<Parameters> {
    let reach = reach(cell.corners());
    if let Some(found) = newton(cell, middle_of(&M::CORNERS), point, reach) {
        return Some(found);
    }
    search(cell, point, reach)
}

/// How often a part is cut: beyond that parameters are one number to double precision.
const MOST_CUTS: u32 = 50;

/// How many parts are looked at, so that a cell without volume costs no more than that.
const MOST_PARTS: usize = 20_000;

/// Cuts the cell until what is left holds the point or nothing.
fn search<const N: usize, M: Map<N>>(cell: &M, point: Point, reach: f64) -> Option<Parameters> {
    let local = Local::new(cell);
    let target = local.of(point);
    let slack = local.slack(reach);
    let mut waiting = vec![(0, M::CORNERS)];
    let mut seen = 0;
    while let Some((cuts, part)) = waiting.pop() {
        seen += 1;
        if seen > MOST_PARTS {
            return None;
        }
        let images = part.map(|at| local.of(combine(cell.corners(), &M::weights(at))));
        let may_hold = (0..3).all(|axis| {
            let along = images.map(|image| image[axis]);
            let low = along.iter().copied().fold(f64::INFINITY, f64::min);
            let high = along.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            low - slack <= target[axis] && target[axis] <= high + slack
        });
        if !may_hold {
            continue;
        }
        let middle = middle_of(&part);
        if let Some(found) = newton(cell, middle, point, reach) {
            return Some(found);
        }
        if cuts < MOST_CUTS {
            waiting.extend(M::parts(&part).into_iter().map(|part| (cuts + 1, part)));
        }
    }
    None
}

/// Newton's method; `None` unless it comes to rest within `reach` of a point of the closed cell.
fn newton<const N: usize, M: Map<N>>(
    cell: &M,
    start: Parameters,
    point: Point,
    reach: f64,
) -> Option<Parameters> {
    const STEPS: usize = 12;
    /// Farther away the method runs off.
    const FARTHEST: f64 = 4.0;
    let mut at = start;
    for _ in 0..STEPS {
        let closest = M::clamped(at);
        let missing = subtract(point, combine(cell.corners(), &M::weights(closest)));
        if length(missing) <= reach {
            return Some(closest);
        }
        let missing = subtract(point, combine(cell.corners(), &M::weights(at)));
        let step = solve(columns(cell, at), missing)?;
        at = [0, 1, 2].map(|axis| at[axis] + step[axis]);
        if at.iter().any(|parameter| parameter.abs() > FARTHEST) {
            return None;
        }
    }
    let closest = M::clamped(at);
    let missing = subtract(point, combine(cell.corners(), &M::weights(closest)));
    (length(missing) <= reach).then_some(closest)
}

/// The weights of a point near the cell, to first order from the point of the closed cell with these
/// parameters: they sum to one and give the point. `None` where the map is singular.
pub fn extrapolated<const N: usize, M: Map<N>>(
    cell: &M,
    from: Parameters,
    point: Point,
) -> Option<[f64; N]> {
    let mut weights = M::weights(from);
    let derivatives = M::derivatives(from);
    for _ in 0..2 {
        // The second time for what the first left over.
        let missing = subtract(point, combine(cell.corners(), &weights));
        let step = solve(columns(cell, from), missing)?;
        for (corner, weight) in weights.iter_mut().enumerate() {
            *weight += dot(step, [0, 1, 2].map(|axis| derivatives[axis][corner]));
        }
    }
    Some(weights)
}

/// The derivatives of the point along each parameter.
fn columns<const N: usize, M: Map<N>>(cell: &M, at: Parameters) -> [Point; 3] {
    let corners = cell.corners();
    // The derivatives of the weights sum to zero, so a corner may be taken as origin.
    let local = corners.map(|corner| subtract(corner, corners[0]));
    M::derivatives(at).map(|weights| combine(&local, &weights))
}

/// Solves `a x + b y + c z = right`; `None` if the columns span no volume.
fn solve([a, b, c]: [Point; 3], right: Point) -> Option<Parameters> {
    let volume = dot(a, cross(b, c));
    let solution = [
        dot(right, cross(b, c)),
        dot(right, cross(c, a)),
        dot(right, cross(a, b)),
    ]
    .map(|part| part / volume);
    solution.iter().all(|x| x.is_finite()).then_some(solution)
}

fn middle_of<const N: usize>(corners: &[Parameters; N]) -> Parameters {
    combine(corners, &[1.0 / N as f64; N])
}

/// Coordinates in which the cell is about as long as wide, so that boxes fit its parts closely.
struct Local {
    origin: Point,
    /// Rows of the inverse of the map's derivative in the middle, or of the identity.
    rows: [Point; 3],
}

impl Local {
    fn new<const N: usize, M: Map<N>>(cell: &M) -> Self {
        let middle = middle_of(&M::CORNERS);
        let [a, b, c] = columns(cell, middle);
        let volume = dot(a, cross(b, c));
        let rows = [cross(b, c), cross(c, a), cross(a, b)].map(|row| row.map(|x| x / volume));
        let is_sound = rows.as_flattened().iter().all(|x| x.is_finite());
        Self {
            origin: cell.corners()[0],
            rows: match is_sound {
                true => rows,
                false => [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
            },
        }
    }

    fn of(&self, point: Point) -> Point {
        let offset = subtract(point, self.origin);
        self.rows.map(|row| dot(row, offset))
    }

    /// How far apart two points can be here whose distance in space is `reach`, and what is lost to
    /// rounding on the way.
    fn slack(&self, reach: f64) -> f64 {
        let steepest = self.rows.map(length).into_iter().fold(0.0, f64::max);
        4.0 * reach * steepest + 32.0 * f64::EPSILON
    }
}
