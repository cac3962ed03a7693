//! The small tetrahedra of cells, and what a pose makes of them.

use super::{Cell, HealthReport, RATIO_LIMIT, Shape};
use crate::coord::round_div_wide;
use crate::mesh::{OCTAHEDRON_FACES, Solid};

/// A corner of a prism and its neighbours, so that the tetrahedron is positive.
const PRISM_CORNERS: [[usize; 4]; 6] = [
    [0, 1, 2, 3],
    [1, 2, 0, 4],
    [2, 0, 1, 5],
    [3, 5, 4, 0],
    [4, 3, 5, 1],
    [5, 4, 3, 2],
];

/// The same of a hexahedron.
const HEXAHEDRON_CORNERS: [[usize; 4]; 8] = [
    [0, 1, 3, 4],
    [1, 2, 0, 5],
    [2, 3, 1, 6],
    [3, 0, 2, 7],
    [4, 7, 5, 0],
    [5, 4, 6, 1],
    [6, 5, 7, 2],
    [7, 6, 4, 3],
];

type Place = [i64; 3];

/// Looks at every cell.
pub(super) fn report(cells: &Solid<'_>, rest: &[[i32; 3]], pose: &[[i32; 3]]) -> HealthReport {
    let mut seen = Seen {
        report: HealthReport {
            least_ratio: RATIO_LIMIT,
            ..HealthReport::default()
        },
        rest,
        pose,
    };
    for (cell, index) in cells.tetrahedra.iter().zip(0..) {
        let whole = seen.corners(cell, &[[0, 1, 2, 3]]);
        seen.take(Shape::Tetrahedron, index, &whole);
    }
    for (cell, index) in cells.octahedra.iter().zip(0..) {
        let parts = [determinants(rest, cell), determinants(pose, cell)];
        seen.take(Shape::Octahedron, index, &pairs(parts));
    }
    for (cell, index) in cells.prisms.iter().zip(0..) {
        let corners = seen.corners(cell, &PRISM_CORNERS);
        seen.take(Shape::Prism, index, &corners);
    }
    for (cell, index) in cells.hexahedra.iter().zip(0..) {
        let corners = seen.corners(cell, &HEXAHEDRON_CORNERS);
        seen.take(Shape::Hexahedron, index, &corners);
    }
    seen.report
}

/// A determinant at rest and in the pose.
type Pair = [i128; 2];

struct Seen<'a> {
    report: HealthReport,
    rest: &'a [[i32; 3]],
    pose: &'a [[i32; 3]],
}

impl Seen<'_> {
    fn corners<const N: usize>(&self, cell: &[u32], corners: &[[usize; 4]; N]) -> [Pair; N] {
        let of = |points: &[[i32; 3]]| {
            corners.map(|corners| {
                let [from, a, b, c] = corners.map(|corner| place(points, cell, corner));
                determinant([away(a, from), away(b, from), away(c, from)])
            })
        };
        pairs([of(self.rest), of(self.pose)])
    }

    /// Takes a cell's determinants into the report.
    fn take(&mut self, shape: Shape, index: u32, pairs: &[Pair]) {
        let cell = Cell { shape, index };
        let report = &mut self.report;
        let mut is_folded = false;
        for &[rest, pose] in pairs {
            if rest <= 0 {
                report.without_ratio = report.without_ratio.wrapping_add(1);
                continue;
            }
            is_folded |= pose <= 0;
            if is_less(pose, rest, report.least_ratio) {
                let ratio = round_div_wide(pose.wrapping_shl(16), rest);
                report.least_ratio = i32::try_from(ratio).unwrap_or(i32::MIN);
                report.least = Some(cell);
            }
        }
        if is_folded {
            report.folded = report.folded.wrapping_add(1);
            // Those beyond are only counted.
            let _ = report.first.push(cell);
        }
    }
}

/// Whether `floor(2^16 pose / rest + 1/2) < least`, which is `2^17 pose < (2 least - 1) rest`.
///
/// A `least` of `-2^31` is never undercut. Others are above `-2^31` and at most `2^18`; for negative ones both sides are
/// negative, and the right one is cut to where the left one cannot lie.
fn is_less(pose: i128, rest: i128, least: i32) -> bool {
    let twice = i128::from(least).wrapping_mul(2).wrapping_sub(1);
    let limit = rest.checked_mul(twice).unwrap_or(i128::MIN);
    least != i32::MIN && pose.wrapping_shl(17) < limit
}

/// Six times the places of a cell's corner less the sum of all six, for each face of an octahedron.
fn determinants(points: &[[i32; 3]], cell: &[u32; 6]) -> [i128; 8] {
    let corners = [0, 1, 2, 3, 4, 5].map(|corner| place(points, cell, corner));
    let mut sum = [0_i64; 3];
    for corner in corners {
        sum = away(sum, corner.map(i64::wrapping_neg));
    }
    let spokes = corners.map(|corner| away(corner.map(|axis| axis.wrapping_mul(6)), sum));
    OCTAHEDRON_FACES.map(|face| {
        let [a, b, c] = face.map(|corner| spokes.get(corner).copied().unwrap_or_default());
        determinant([a, b, c])
    })
}

fn pairs<const N: usize>([rest, pose]: [[i128; N]; 2]) -> [Pair; N] {
    let mut pairs = [[0; 2]; N];
    for (pair, (rest, pose)) in pairs.iter_mut().zip(rest.into_iter().zip(pose)) {
        *pair = [rest, pose];
    }
    pairs
}

/// A corner's place; cells have been checked, so it is there.
fn place(points: &[[i32; 3]], cell: &[u32], corner: usize) -> Place {
    let vertex = cell.get(corner).copied().unwrap_or_default();
    let vertex = usize::try_from(vertex).unwrap_or(usize::MAX);
    points
        .get(vertex)
        .copied()
        .unwrap_or_default()
        .map(i64::from)
}

/// The way from the second place to the first.
fn away([ax, ay, az]: Place, [bx, by, bz]: Place) -> Place {
    [
        ax.wrapping_sub(bx),
        ay.wrapping_sub(by),
        az.wrapping_sub(bz),
    ]
}

fn determinant([[ax, ay, az], [bx, by, bz], [cx, cy, cz]]: [Place; 3]) -> i128 {
    let product = |a: i64, b: i64| i128::from(a).wrapping_mul(i128::from(b));
    let minor = |a: i64, b: i64, c: i64, d: i64| product(a, d).wrapping_sub(product(b, c));
    let x = i128::from(ax).wrapping_mul(minor(by, bz, cy, cz));
    let y = i128::from(ay).wrapping_mul(minor(bz, bx, cz, cx));
    let z = i128::from(az).wrapping_mul(minor(bx, by, cx, cy));
    x.wrapping_add(y).wrapping_add(z)
}
