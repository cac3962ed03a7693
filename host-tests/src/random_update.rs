//! Random tables, direct and factored, whose control points move twice, with faces between their points.
//!
//! The bundles are packed by the baker; what is expected comes from [`reference`](crate::reference) and from
//! the rows before they were packed.

use octruss_bake::pack::normals;
use octruss_bake::pack::writer::{self, Section};
use octruss_bake::pack::{Layout, sections::Stage};
use rand::RngExt as _;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng as _;

use crate::random_bundle::{BundleCase, bundle_of, layout, stage_of};
use crate::random_table::{ApplyCase, RowSum};
use crate::reference::normals::normals as reference_normals;

/// Rows of a table at most, and control points.
const ROWS: usize = 12;
const POINTS: u16 = 24;

/// A random case.
#[derive(Clone, Debug)]
pub struct UpdateCase {
    /// The layout of both stages.
    pub layout: Layout,
    /// Whether the table is factored.
    pub factored: bool,
    /// The bundle.
    pub bytes: Vec<u8>,
    /// Control points at first.
    pub before: Vec<[i32; 3]>,
    /// Control points then.
    pub behind: Vec<[i32; 3]>,
    /// Which of them may be elsewhere.
    pub moved: Vec<bool>,
    /// The rows of the bundle in the end.
    pub rows: Vec<[i32; 3]>,
    /// How many displacements were clamped on the way there.
    pub clamped: u32,
    /// How many coordinates of rows stand at the ends of the range.
    pub at_ends: usize,
    /// Normals of the rows, and how many are zero.
    pub normals: (Vec<[i16; 3]>, u32),
}

impl UpdateCase {
    /// The case of a seed.
    ///
    /// # Panics
    /// If the baker cannot pack it, which is a fault.
    #[must_use]
    pub fn new(seed: u64) -> Self {
        let mut rng = ChaCha8Rng::seed_from_u64(seed ^ 0x7570_6461_7465);
        let layout = layout(seed / 2);
        let factored = seed.is_multiple_of(2);
        // With smaller numbers nothing saturates, so that the kernels take their quick way.
        let scale = [0, 2, 3, 8, 20][rng.random_range(0..5)];
        let first = first_stage(seed, layout, scale);
        let (behind, moved) = moved(&mut rng, &first.case.pose);
        let first_behind = with_pose(&first, behind.clone());
        let (first_rows, first_clamped) = first_behind.displaced();
        let order = |points: &[[i32; 3]], order: &[usize]| -> Vec<[i32; 3]> {
            order.iter().map(|&row| points[row]).collect()
        };
        let mut sections = vec![writer::rest_cage(&first.case.rest_pose)];
        let first_packed = stage_of(&first.case, layout);
        sections.extend(first_packed.sections(0));
        let (last, packed, points, clamped) = if factored {
            let refined = order(&first_rows.points, &first_packed.order);
            let rest = order(&first.case.rest, &first_packed.order);
            let last = last_stage(seed, layout, rest, refined);
            let (rows, clamped) = last.displaced();
            let packed = stage_of(&last.case, layout);
            sections.extend(packed.sections(1));
            (last, packed, rows.points, first_clamped + clamped)
        } else {
            (
                first.clone(),
                first_packed,
                first_rows.points,
                first_clamped,
            )
        };
        let faces = faces(&mut rng, points.len());
        let normals = finish(&mut sections, &packed, &faces, &last, &points);
        let rows = order(&points, &packed.order);
        let ends = |bits: &&i32| **bits == i32::MIN || **bits == i32::MAX;
        Self {
            layout,
            factored,
            bytes: bundle_of(&sections, first.case.pose.len(), rows.len()),
            before: first.case.pose,
            behind,
            moved,
            clamped,
            at_ends: rows.iter().flatten().filter(ends).count(),
            rows,
            normals,
        }
    }
}

/// Adds the order of the rows and the faces; returns the reference's normals in the order of the rows.
fn finish(
    sections: &mut Vec<Section>,
    packed: &Stage,
    faces: &[Vec<u32>],
    last: &BundleCase,
    points: &[[i32; 3]],
) -> (Vec<[i16; 3]>, u32) {
    sections.extend(writer::model_points(&packed.order));
    let made = normals::section(faces, &packed.order, &last.case.rest);
    let (section, report) = made.expect("faces of points that exist");
    sections.push(section);
    let (vectors, zeros) = reference_normals(points, faces, report.shift);
    let in_order = packed.order.iter().map(|&row| vectors[row]).collect();
    (in_order, zeros)
}

/// Rows over random control points; there is at least one.
fn first_stage(seed: u64, layout: Layout, scale: u32) -> BundleCase {
    let mut case = (0..)
        .map(|more| ApplyCase::<3>::new(seed + (more << 32), ROWS, POINTS, RowSum::One))
        .find(|case| case.table.row_count() > 0)
        .expect("some case has rows");
    for points in [&mut case.pose, &mut case.rest_pose, &mut case.rest] {
        points
            .iter_mut()
            .for_each(|point| *point = point.map(|bits| bits >> scale));
    }
    BundleCase::of(case, layout)
}

/// Rows over the rows of the first stage, in the order in which these are packed.
fn last_stage(
    seed: u64,
    layout: Layout,
    rest: Vec<[i32; 3]>,
    refined: Vec<[i32; 3]>,
) -> BundleCase {
    let inputs = rest.len() as u16;
    let mut case = ApplyCase::<3>::new(seed ^ (1 << 40), ROWS, inputs, RowSum::One);
    // Rest positions of the same size as the inputs.
    case.rest = (0..case.table.row_count())
        .map(|row| rest[row % rest.len()])
        .collect();
    (case.rest_pose, case.pose) = (rest, refined);
    BundleCase::of(case, layout)
}

/// The same rows over another pose.
fn with_pose(case: &BundleCase, pose: Vec<[i32; 3]>) -> BundleCase {
    let mut case = case.clone();
    case.case.pose = pose;
    case
}

/// Where control points go, and marks of all that went, and of some that stayed.
fn moved(rng: &mut ChaCha8Rng, pose: &[[i32; 3]]) -> (Vec<[i32; 3]>, Vec<bool>) {
    let part = rng.random_range(1..6);
    let each = pose.iter().map(|point| match rng.random_range(0..6) {
        number if number >= part => (*point, false),
        0 => (*point, true),
        1 => (point.map(|bits| !bits), true),
        _ => (point.map(|bits| bits / 3 * 2 + 1), true),
    });
    each.unzip()
}

/// Triangles, quads and pentagons between random points, and a fan that closes.
fn faces(rng: &mut ChaCha8Rng, points: usize) -> Vec<Vec<u32>> {
    if points < 3 {
        return Vec::new();
    }
    let mut faces = Vec::new();
    for _ in 0..rng.random_range(0..2 * points) {
        let corners = rng.random_range(3..=points.min(5));
        let corners = rand::seq::index::sample(rng, points, corners);
        faces.push(corners.into_iter().map(|point| point as u32).collect());
    }
    let ring = points as u32 - 1;
    for place in 0..ring {
        faces.push(vec![ring, place, (place + 1) % ring]);
    }
    faces
}
