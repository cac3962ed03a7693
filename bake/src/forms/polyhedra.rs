//! The volume of a surface that has no exact form, from the polyhedra that it is refined to.
//!
//! A polyhedron's faces are fans of triangles round the mean of their corners, which is the bilinear
//! surface's volume for a quadrilateral. Its error falls by four in a step that halves edges, and by
//! three in a square-root-3 step, so two levels are extrapolated; the two levels before give a second
//! value, and the difference is what the result may be wrong by.

use super::control::ControlForm;
use super::error::FormError;
use super::moments::{Moments, polyhedral_integrals};
use super::surface::centred;
use crate::error::{Error, Result};
use crate::mesh::Point;
use crate::refine::RealBlend;
use crate::refine::rows::{Row, RowBlend, identity};
use crate::surface::{RimRule, SurfaceLevel, SurfaceMesh, SurfaceScheme, SurfaceStep};
use octruss::blend::GuardedBlend;

/// Levels that are made at least...
const FEWEST_LEVELS: usize = 3;
/// ...and at most, ...
const MOST_LEVELS: usize = 7;
/// ...further ones only up to so many faces: of rows over the control points...
const MOST_FACES_OF_ROWS: usize = 120_000;
/// ...of rows that positions of many poses are made with...
const MOST_FACES_OF_MOMENTS: usize = 12_000;
/// ...and of points.
const MOST_FACES_OF_POINTS: usize = 400_000;

/// How a scheme's polyhedra come near the limit.
#[derive(Clone, Copy)]
struct Pace {
    /// Steps of the scheme from one polyhedron to the next.
    steps: usize,
    /// How much smaller its error is then. There are as many times more faces.
    ratio: f64,
}

impl Pace {
    /// Square-root-3 steps move creases only every second time.
    fn of(scheme: SurfaceScheme, has_features: bool) -> Self {
        match (scheme, has_features) {
            (SurfaceScheme::Sqrt3, false) => Self {
                steps: 1,
                ratio: 3.0,
            },
            (SurfaceScheme::Sqrt3, true) => Self {
                steps: 2,
                ratio: 9.0,
            },
            _ => Self {
                steps: 1,
                ratio: 4.0,
            },
        }
    }

    fn limit(self, coarser: f64, finer: f64) -> f64 {
        (self.ratio * finer - coarser) / (self.ratio - 1.0)
    }
}

/// The volume as one form over the vertices of a closed mesh, and the one from the levels before.
///
/// # Errors
/// If the scheme does not take the mesh or there are too many control points.
pub fn forms(mesh: &SurfaceMesh, scheme: SurfaceScheme) -> Result<[ControlForm; 2]> {
    let features = &mesh.features;
    let has_features = !features.creases.is_empty() || !features.corners.is_empty();
    let pace = Pace::of(scheme, has_features);
    let columns = u32::try_from(mesh.points.len()).unwrap_or(u32::MAX);
    let rows = identity(columns);
    let of_level = |level: &SurfaceLevel, rows: &[Row]| {
        let wide = |row: &Row| {
            let entries = row.iter();
            entries
                .map(|(point, weight)| (*point as usize, *weight))
                .collect::<Vec<_>>()
        };
        let rows = rows.iter().map(wide).collect::<Vec<_>>();
        ControlForm::of_faces(level.faces(), &rows).map_err(of_form)
    };
    let [first, second, third] = last_three(
        mesh,
        scheme,
        pace,
        MOST_FACES_OF_ROWS,
        RowBlend,
        rows,
        of_level,
    )?;
    let extrapolated = |coarser: &ControlForm, finer: &ControlForm| {
        ControlForm::combined(coarser, finer, |a, b| pace.limit(a, b))
    };
    Ok([extrapolated(&second, &third), extrapolated(&first, &second)])
}

/// A surface at one level, its vertices as rows over the control points.
#[derive(Clone, Debug)]
pub struct Polyhedron {
    faces: Vec<Vec<u32>>,
    rows: Vec<Row>,
    ratio: f64,
}

impl Polyhedron {
    /// The integrals of x, y and z over the solid, for positions of all control points, extrapolated from
    /// those of the level before.
    pub fn limit_of_first_moments(&self, coarser: &Self, points: &[Point]) -> Point {
        let (coarse, fine) = (coarser.first_moment(points), self.first_moment(points));
        [0, 1, 2].map(|k| (self.ratio * fine[k] - coarse[k]) / (self.ratio - 1.0))
    }

    fn first_moment(&self, points: &[Point]) -> Point {
        let place = |row: &Row| {
            row.iter().fold([0.0; 3], |sum: Point, (point, weight)| {
                let own = points[*point as usize];
                [0, 1, 2].map(|k| sum[k] + weight * own[k])
            })
        };
        let own: Vec<Point> = self.rows.iter().map(place).collect();
        let [_, x, y, z, ..] = polyhedral_integrals(self.faces.iter().map(Vec::as_slice), &own);
        [x, y, z]
    }
}

/// The last three levels.
///
/// # Errors
/// If the scheme does not take the mesh.
pub fn levels(mesh: &SurfaceMesh, scheme: SurfaceScheme) -> Result<[Polyhedron; 3]> {
    let features = &mesh.features;
    let has_features = !features.creases.is_empty() || !features.corners.is_empty();
    let pace = Pace::of(scheme, has_features);
    let rows = identity(u32::try_from(mesh.points.len()).unwrap_or(u32::MAX));
    let of_level = |level: &SurfaceLevel, rows: &[Row]| {
        Ok(Polyhedron {
            faces: level.faces().map(<[u32]>::to_vec).collect(),
            rows: rows.to_vec(),
            ratio: pace.ratio,
        })
    };
    let most = MOST_FACES_OF_MOMENTS;
    last_three(mesh, scheme, pace, most, RowBlend, rows, of_level)
}

/// Volume, centroid and inertia of what a closed mesh's limit surface encloses, and those from the
/// levels before.
///
/// # Errors
/// If the scheme does not take the mesh.
pub fn moments(mesh: &SurfaceMesh, scheme: SurfaceScheme) -> Result<[Moments; 2]> {
    let features = &mesh.features;
    let has_features = !features.creases.is_empty() || !features.corners.is_empty();
    let pace = Pace::of(scheme, has_features);
    let (moved, middle) = centred(&mesh.points);
    let of_level =
        |level: &SurfaceLevel, points: &[Point]| Ok(polyhedral_integrals(level.faces(), points));
    let [first, second, third] = last_three(
        mesh,
        scheme,
        pace,
        MOST_FACES_OF_POINTS,
        RealBlend,
        moved,
        of_level,
    )?;
    let extrapolated = |coarser: &[f64; 10], finer: &[f64; 10]| {
        let limits = std::array::from_fn(|place| pace.limit(coarser[place], finer[place]));
        Moments::of_integrals(limits, middle)
    };
    Ok([extrapolated(&second, &third), extrapolated(&first, &second)])
}

/// Refines and keeps what `of_level` makes of the last three levels.
fn last_three<B: GuardedBlend, T>(
    mesh: &SurfaceMesh,
    scheme: SurfaceScheme,
    pace: Pace,
    most_faces: usize,
    mut blend: B,
    mut values: Vec<B::Point>,
    of_level: impl Fn(&SurfaceLevel, &[B::Point]) -> Result<T>,
) -> Result<[T; 3]> {
    let mut level = SurfaceLevel::new(mesh)?;
    let mut kept = Vec::new();
    for made in 0..MOST_LEVELS {
        let faces = level.mesh().face_count() as f64 * pace.ratio;
        if made >= FEWEST_LEVELS && faces > most_faces as f64 {
            break;
        }
        for _ in 0..pace.steps {
            let mut step = SurfaceStep::new(&level, scheme, RimRule::Spline);
            values = step.values(&mut blend, &values)?;
            level = step.split()?;
        }
        if kept.len() == 3 {
            kept.remove(0);
        }
        kept.push(of_level(&level, &values)?);
    }
    kept.try_into()
        .map_err(|_| Error::new("a surface is refined at least three times"))
}

fn of_form(error: FormError) -> Error {
    Error::new(error.to_string())
}
