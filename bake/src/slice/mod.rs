//! Cross-sections of refined solids: values on a plane and along a line.
//!
//! A value at every vertex of the cage (a material density, a temperature, one control point's
//! basis function) is refined by the masks that refine positions. Between the vertices of the last
//! level it is interpolated linearly, cell by cell.

mod checkerboard;
mod draw;
mod isolines;
mod over_time;

pub use checkerboard::{Checkerboard, Deformed, Window};
pub use draw::{Panel, Picture, Profile, draw, register_font};
pub use over_time::{Moment, Places, over_time};

use crate::error::{Error, Result};
use crate::geometry::bounds;
use crate::locate::{Embedding, Locator};
use crate::mesh::{Faces, Point, SolidMesh};
use crate::progress::Progress;
use crate::refine::{BoundaryRule, Level, Refinement};

/// A plane with the two axes that its picture has.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    origin: Point,
    across: Point,
    up: Point,
    normal: Point,
    /// Names of the two axes.
    pub names: [&'static str; 2],
}

impl Plane {
    /// The plane `a x + b y + c z = d`. A plane across one coordinate axis is shown in the
    /// coordinates of the other two, any other in its own, from the point nearest the origin.
    ///
    /// # Errors
    /// If a, b and c are all zero, or a number is not finite.
    pub fn new([a, b, c, d]: [f64; 4]) -> Result<Self> {
        let length = (a * a + b * b + c * c).sqrt();
        if !(length.is_finite() && length > 0.0 && d.is_finite()) {
            return Err(Error::new(
                "a, b and c of a plane are not all zero, and all four finite",
            ));
        }
        let normal = [a, b, c].map(|x| x / length);
        let steepest = (0..3).fold(0, |best, axis| {
            if normal[axis].abs() > normal[best].abs() {
                axis
            } else {
                best
            }
        });
        let mut across = [0.0; 3];
        across[(steepest + 1) % 3] = 1.0;
        let along = dot(across, normal);
        let across = unit([0, 1, 2].map(|k| across[k] - along * normal[k]));
        let mut up = cross(normal, across);
        if normal[steepest] < 0.0 {
            up = up.map(|x| -x);
        }
        let is_across_an_axis = normal.iter().filter(|x| **x != 0.0).count() == 1;
        let names = match (is_across_an_axis, steepest) {
            (true, 0) => ["y", "z"],
            (true, 1) => ["z", "x"],
            (true, _) => ["x", "y"],
            (false, _) => ["across", "up"],
        };
        Ok(Self {
            origin: normal.map(|x| x * d / length),
            across,
            up,
            normal,
            names,
        })
    }

    fn point(&self, [u, v]: [f64; 2]) -> Point {
        [0, 1, 2].map(|k| self.origin[k] + u * self.across[k] + v * self.up[k])
    }

    fn coordinates(&self, point: Point) -> [f64; 2] {
        let from = [0, 1, 2].map(|k| point[k] - self.origin[k]);
        [dot(from, self.across), dot(from, self.up)]
    }

    /// How far a point lies in front of the plane.
    fn height(&self, point: Point) -> f64 {
        dot([0, 1, 2].map(|k| point[k] - self.origin[k]), self.normal)
    }
}

fn dot(a: Point, b: Point) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: Point, b: Point) -> Point {
    [0, 1, 2].map(|k| {
        let (i, j) = ((k + 1) % 3, (k + 2) % 3);
        a[i] * b[j] - a[j] * b[i]
    })
}

fn unit(a: Point) -> Point {
    let length = dot(a, a).sqrt();
    a.map(|x| x / length)
}

/// A solid with a value at every vertex.
#[derive(Clone, Debug)]
pub struct Field {
    level: Level,
    points: Vec<Point>,
    values: Vec<f64>,
}

impl Field {
    /// A cage, ready to be refined with the scheme of `level`, with one value for each vertex.
    ///
    /// # Errors
    /// If there are more or fewer values than vertices.
    pub fn new(mesh: &SolidMesh, level: Level, values: Vec<f64>) -> Result<Self> {
        require_length(&values, mesh.points.len())?;
        Ok(Self {
            level,
            points: mesh.points.clone(),
            values,
        })
    }

    /// The same solid so many levels on: positions and values by the same masks.
    ///
    /// # Errors
    /// If that would be too large.
    pub fn refined(
        &self,
        levels: u32,
        boundary: BoundaryRule,
        progress: &mut dyn Progress,
    ) -> Result<Self> {
        self.level.require_levels(levels)?;
        let mut field = self.clone();
        progress.stage("refining", levels as usize);
        for _ in 0..levels {
            let mut step = Refinement::new(&field.level, boundary.to_core())?;
            // Values travel in the first coordinate of points.
            let values: Vec<Point> = field.values.iter().map(|x| [*x, 0.0, 0.0]).collect();
            let values = step.points(&values)?;
            field = Self {
                points: step.points(&field.points)?,
                values: values.into_iter().map(|[x, ..]| x).collect(),
                level: step.split()?,
            };
            progress.step();
        }
        Ok(field)
    }

    fn locator<'a>(&'a self, boundary: &'a Faces) -> Locator<'a> {
        Locator::new(&self.level.cells, boundary, &self.points)
    }

    fn value(&self, embedding: &Embedding) -> f64 {
        let terms = embedding.iter();
        terms
            .map(|(vertex, weight)| weight * self.values[*vertex as usize])
            .sum()
    }

    /// The values on a plane, on a square grid of `size` by `size` points around the cut.
    ///
    /// # Errors
    /// If the plane misses the solid.
    pub fn cut(&self, plane: Plane, size: usize, progress: &mut dyn Progress) -> Result<Cut> {
        let corners = corners_cut(&self.level, &self.points, plane);
        let places: Vec<Point> = corners
            .map(|vertex| {
                let [u, v] = plane.coordinates(self.points[vertex as usize]);
                [u, v, 0.0]
            })
            .collect();
        let sheets = self.cut_sheets(plane);
        let of_sheets = sheets.iter().flat_map(|segment| segment.ends);
        let of_sheets = of_sheets.map(|[u, v]| [u, v, 0.0]);
        let places: Vec<Point> = places.into_iter().chain(of_sheets).collect();
        let Some([low, high]) = bounds(&places) else {
            return Err(Error::new("the plane misses the refined solid"));
        };
        let side = (high[0] - low[0]).max(high[1] - low[1]) * 1.04;
        let start = [0, 1].map(|k| (low[k] + high[k] - side) / 2.0);
        let step = side / (size - 1) as f64;
        let boundary = self.level.boundary_faces();
        let locator = self.locator(&boundary);
        let mut values = Vec::with_capacity(size * size);
        progress.stage("cutting", size);
        for row in 0..size {
            for column in 0..size {
                let place = [column, row].map(|place| place as f64 * step);
                let place = [start[0] + place[0], start[1] + place[1]];
                let found = locator.inside(plane.point(place));
                values.push(found.map(|embedding| self.value(&embedding)));
            }
            progress.step();
        }
        Ok(Cut {
            plane,
            size,
            start,
            side,
            values,
            sheets,
        })
    }

    /// Where the plane cuts the triangles of sheets.
    fn cut_sheets(&self, plane: Plane) -> Vec<Segment> {
        let segment = |corners: &[u32; 3]| {
            let mut crossings = Vec::with_capacity(3);
            for [from, to] in [[0, 1], [1, 2], [2, 0]].map(|side| side.map(|k| corners[k])) {
                let [at, to_at] = [from, to].map(|vertex| self.points[vertex as usize]);
                let (low, high) = (plane.height(at), plane.height(to_at));
                // Each corner belongs to one side, so that two of three sides are crossed or none.
                if (low < 0.0) == (high < 0.0) {
                    continue;
                }
                let part = low / (low - high);
                let place = [0, 1, 2].map(|k| at[k] + part * (to_at[k] - at[k]));
                let [value, to_value] = [from, to].map(|vertex| self.values[vertex as usize]);
                crossings.push((plane.coordinates(place), value + part * (to_value - value)));
            }
            match crossings.as_slice() {
                &[(from, value), (to, to_value)] => Some(Segment {
                    ends: [from, to],
                    value: (value + to_value) / 2.0,
                }),
                _ => None,
            }
        };
        self.level.sheets().iter().filter_map(segment).collect()
    }

    /// The values at `count` points that part a segment evenly, both ends included; `None` outside
    /// the solid.
    pub fn along(&self, ends: [Point; 2], count: usize) -> Vec<Option<f64>> {
        let boundary = self.level.boundary_faces();
        let locator = self.locator(&boundary);
        (0..count)
            .map(|place| {
                let found = locator.inside(on_line(ends, place, count));
                found.map(|found| self.value(&found))
            })
            .collect()
    }
}

/// The corners of all cells that a plane cuts or touches.
fn corners_cut<'a>(
    level: &'a Level,
    points: &'a [Point],
    plane: Plane,
) -> impl Iterator<Item = u32> + 'a {
    let of_cut = move |corners: &&[u32]| {
        let heights = corners.iter().map(|v| plane.height(points[*v as usize]));
        let (low, high) = heights.fold((f64::MAX, f64::MIN), |(low, high), height| {
            (low.min(height), high.max(height))
        });
        low <= 0.0 && high >= 0.0
    };
    level.cells.corners().filter(of_cut).flatten().copied()
}

/// The point at `place` of `count` points that part a segment evenly.
fn on_line([from, to]: [Point; 2], place: usize, count: usize) -> Point {
    let part = place as f64 / (count - 1) as f64;
    [0, 1, 2].map(|k| from[k] * (1.0 - part) + to[k] * part)
}

fn require_length(values: &[f64], vertices: usize) -> Result<()> {
    if values.len() == vertices {
        return Ok(());
    }
    Err(Error::new(format!(
        "there are {} values, but the mesh has {vertices} vertices",
        values.len()
    ))
    .advise("give one value for each vertex, in file order"))
}

/// Where a plane cuts a triangle of a sheet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Segment {
    /// From where to where, in the plane's coordinates.
    pub ends: [[f64; 2]; 2],
    /// The value in its middle.
    pub value: f64,
}

/// Values on a square part of a plane, row by row from below.
#[derive(Clone, Debug)]
pub struct Cut {
    /// The plane.
    pub plane: Plane,
    size: usize,
    start: [f64; 2],
    side: f64,
    values: Vec<Option<f64>>,
    sheets: Vec<Segment>,
}

impl Cut {
    /// The least and the greatest value; `None` if no grid point lies inside and no sheet is cut.
    pub fn range(&self) -> Option<[f64; 2]> {
        let of_sheets = self.sheets.iter().map(|segment| segment.value);
        let values = self.values.iter().flatten().copied().chain(of_sheets);
        values.fold(None, |range: Option<[f64; 2]>, value| match range {
            None => Some([value; 2]),
            Some([low, high]) => Some([low.min(value), high.max(value)]),
        })
    }

    /// Where the plane cuts sheets.
    pub fn sheets(&self) -> &[Segment] {
        &self.sheets
    }

    /// The grid points that lie inside the solid, row by row.
    fn points_inside(&self) -> Vec<Point> {
        let step = self.side / (self.size - 1) as f64;
        let places = self.values.iter().enumerate();
        places
            .filter(|(_, value)| value.is_some())
            .map(|(place, _)| {
                let place = [place % self.size, place / self.size];
                let [u, v] = [0, 1].map(|k| self.start[k] + place[k] as f64 * step);
                self.plane.point([u, v])
            })
            .collect()
    }

    /// How many grid points lie inside the solid.
    pub fn inside(&self) -> usize {
        self.values.iter().flatten().count()
    }
}

/// Central differences of samples that lie `step` apart; `None` at the ends and beside gaps.
pub fn central_differences(samples: &[Option<f64>], step: f64) -> Vec<Option<f64>> {
    let mut differences = vec![None; samples.len()];
    for (slot, three) in differences.iter_mut().skip(1).zip(samples.windows(3)) {
        if let [Some(before), _, Some(after)] = three {
            *slot = Some((after - before) / (2.0 * step));
        }
    }
    differences
}

#[cfg(test)]
mod tests {
    use super::{Plane, central_differences};

    #[test]
    fn planes_across_an_axis_keep_coordinates() {
        for (numbers, point, want) in [
            ([0.0, 0.0, 2.0, 6.0], [1.0, 2.0, 3.0], [1.0, 2.0]),
            ([0.0, 0.0, -1.0, -3.0], [1.0, 2.0, 3.0], [1.0, 2.0]),
            ([4.0, 0.0, 0.0, 4.0], [1.0, 2.0, 3.0], [2.0, 3.0]),
            ([0.0, 1.0, 0.0, 2.0], [1.0, 2.0, 3.0], [3.0, 1.0]),
        ] {
            let plane = Plane::new(numbers).unwrap();
            assert_eq!(plane.coordinates(point), want);
            assert_eq!(plane.point(want), point);
            assert_eq!(plane.height(point), 0.0);
        }
        assert!(Plane::new([0.0, 0.0, 0.0, 1.0]).is_err());
        assert!(Plane::new([1.0, f64::NAN, 0.0, 1.0]).is_err());
    }

    /// Of x^2 at 0, 1, 2, 3 with a gap after it: 2x.
    #[test]
    fn differences_are_central() {
        let samples = [Some(0.0), Some(1.0), Some(4.0), Some(9.0), None];
        let got = central_differences(&samples, 1.0);
        assert_eq!(got, [None, Some(2.0), Some(4.0), None, None]);
    }
}
