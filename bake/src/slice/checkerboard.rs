//! A checkerboard that moves with a solid: what a deformation does inside, to the eye.
//!
//! Space at rest is filled with square columns of two colours that stand on the plane. A place of the
//! deformed solid has the colour of the place that it came from: where the map is smooth, so are the
//! edges of the squares, and where it is only linear from cell to cell, they have corners (Hakenberg,
//! figure 4.9). Columns, not cubes: a pose that moves places through the plane would change the colours
//! of cubes, and show where places came from across the plane, which the eye cannot tell from a corner.

use super::{Plane, corners_cut};
use crate::error::{Error, Result};
use crate::geometry::bounds;
use crate::locate::Locator;
use crate::mesh::{Point, SolidMesh};
use crate::progress::Progress;
use crate::refine::{BoundaryRule, Level, Refinement};

/// A solid at rest and deformed.
#[derive(Clone, Debug)]
pub struct Deformed {
    level: Level,
    rest: Vec<Point>,
    posed: Vec<Point>,
}

/// The square part of a plane that a picture shows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Window {
    /// The lower left corner, in the plane's coordinates.
    pub start: [f64; 2],
    /// Width and height.
    pub side: f64,
}

/// The colours on a window, row by row from below.
#[derive(Clone, Debug)]
pub struct Checkerboard {
    /// The plane.
    pub plane: Plane,
    pub(super) size: usize,
    pub(super) window: Window,
    /// Whether the place came from a dark column; `None` outside the solid.
    pub(super) dark: Vec<Option<bool>>,
}

impl Deformed {
    /// A cage whose control points are moved to `posed`, ready to be refined with the scheme of `level`.
    ///
    /// # Errors
    /// If there are more or fewer positions than vertices.
    pub fn new(mesh: &SolidMesh, level: Level, posed: Vec<Point>) -> Result<Self> {
        if posed.len() != mesh.points.len() {
            return Err(Error::new(format!(
                "the pose has {} points, but the cage has {} vertices",
                posed.len(),
                mesh.points.len()
            )));
        }
        Ok(Self {
            level,
            rest: mesh.points.clone(),
            posed,
        })
    }

    /// The same solid so many levels on, both shapes by the same masks.
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
        let mut deformed = self.clone();
        progress.stage("refining", levels as usize);
        for _ in 0..levels {
            let mut step = Refinement::new(&deformed.level, boundary.to_core())?;
            deformed = Self {
                rest: step.points(&deformed.rest)?,
                posed: step.points(&deformed.posed)?,
                level: step.split()?,
            };
            progress.step();
        }
        Ok(deformed)
    }

    /// The part of a plane where it cuts the deformed solid, with a little room.
    ///
    /// # Errors
    /// If the plane misses it.
    pub fn window(&self, plane: Plane) -> Result<Window> {
        let corners = corners_cut(&self.level, &self.posed, plane);
        let places: Vec<Point> = corners
            .map(|vertex| {
                let [u, v] = plane.coordinates(self.posed[vertex as usize]);
                [u, v, 0.0]
            })
            .collect();
        let Some([low, high]) = bounds(&places) else {
            return Err(Error::new("the plane misses the deformed solid")
                .advise("the plane cuts the solid where the pose has moved it to"));
        };
        let side = (high[0] - low[0]).max(high[1] - low[1]) * 1.04;
        Ok(Window {
            start: [0, 1].map(|k| (low[k] + high[k] - side) / 2.0),
            side,
        })
    }

    /// The colours on a window of `size` by `size` places, of columns of width `edge`.
    pub fn checkerboard(
        &self,
        plane: Plane,
        window: Window,
        (size, edge): (usize, f64),
        progress: &mut dyn Progress,
    ) -> Checkerboard {
        let boundary = self.level.boundary_faces();
        let locator = Locator::new(&self.level.cells, &boundary, &self.posed);
        let step = window.side / (size - 1) as f64;
        let mut dark = Vec::with_capacity(size * size);
        progress.stage("cutting", size);
        for row in 0..size {
            for column in 0..size {
                let place = [
                    window.start[0] + column as f64 * step,
                    window.start[1] + row as f64 * step,
                ];
                let found = locator.inside(plane.point(place));
                dark.push(found.map(|embedding| {
                    let mut from = [0.0; 3];
                    for (vertex, weight) in embedding.iter() {
                        for (sum, coordinate) in from.iter_mut().zip(self.rest[*vertex as usize]) {
                            *sum += weight * coordinate;
                        }
                    }
                    is_dark(plane.coordinates(from), edge)
                }));
            }
            progress.step();
        }
        Checkerboard {
            plane,
            size,
            window,
            dark,
        }
    }
}

impl Checkerboard {
    /// How many places lie inside the solid.
    pub fn inside(&self) -> usize {
        self.dark.iter().flatten().count()
    }
}

/// Whether a place, in the plane's coordinates, lies in a dark column: the one from the origin along
/// both axes is.
fn is_dark(place: [f64; 2], edge: f64) -> bool {
    let columns: f64 = place.iter().map(|x| (x / edge).floor()).sum();
    columns.rem_euclid(2.0) < 0.5
}

#[cfg(test)]
mod tests {
    use super::is_dark;

    #[test]
    fn neighbouring_columns_differ() {
        for [u, v] in [[0.5, 0.5], [-7.5, 3.5], [4.5, -1.5]] {
            let colour = is_dark([u, v], 1.0);
            for k in 0..2 {
                let mut next = [u, v];
                next[k] += 1.0;
                assert_ne!(is_dark(next, 1.0), colour);
                next[k] += 1.0;
                assert_eq!(is_dark(next, 1.0), colour);
            }
        }
        assert!(is_dark([0.1, 0.1], 0.25));
        assert!(!is_dark([0.3, 0.1], 0.25));
    }
}
