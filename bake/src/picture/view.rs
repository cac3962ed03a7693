//! From points in space to places on a tile.

use super::Frame;
use crate::geometry::{bounds, cross, dot, normalised, subtract};
use crate::mesh::Point;

/// From which side things are seen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// From the things to the viewer.
    pub toward_viewer: Point,
    /// What points upward in the picture.
    pub up: Point,
}

impl Default for View {
    /// From the front right and a little above, with z upward.
    fn default() -> Self {
        Self {
            toward_viewer: [0.9, -0.55, 0.35],
            up: [0.0, 0.0, 1.0],
        }
    }
}

/// A place on a tile: x to the right and y downward in pixels, and the distance toward the viewer
/// in the same measure.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Projected {
    pub x: f64,
    pub y: f64,
    pub near: f64,
}

/// A parallel projection that fits all frames into one tile.
pub struct Camera {
    right: Point,
    upward: Point,
    pub toward_viewer: Point,
    scale: f64,
    /// Of the middle of what is seen, along right and upward.
    middle: [f64; 2],
    tile: [f64; 2],
}

impl Camera {
    pub fn new(view: View, tile: [u32; 2], frames: &[Frame]) -> Self {
        let toward_viewer = direction(view.toward_viewer, [0.0, -1.0, 0.0]);
        let mut right = cross(view.up, toward_viewer);
        if dot(right, right) == 0.0 {
            // Seen along the upward direction: any other will do.
            right = cross([0.3, 0.5, 0.8], toward_viewer);
        }
        let right = normalised(right);
        let upward = cross(toward_viewer, right);
        let seen: Vec<Point> = frames
            .iter()
            .flat_map(|frame| frame.model.iter().chain(&frame.cage))
            .map(|point| [dot(*point, right), dot(*point, upward), 0.0])
            .collect();
        let [low, high] = bounds(&seen).unwrap_or_default();
        let size = subtract(high, low);
        let tile = tile.map(f64::from);
        const FILLED: f64 = 0.92;
        let fitting = |axis: usize| tile[axis] * FILLED / size[axis].max(f64::MIN_POSITIVE);
        let scale = fitting(0).min(fitting(1));
        Self {
            right,
            upward,
            toward_viewer,
            scale: if scale.is_finite() { scale } else { 1.0 },
            middle: [
                f64::midpoint(low[0], high[0]),
                f64::midpoint(low[1], high[1]),
            ],
            tile,
        }
    }

    pub fn project(&self, point: Point) -> Projected {
        Projected {
            x: (dot(point, self.right) - self.middle[0]) * self.scale + self.tile[0] / 2.0,
            y: self.tile[1] / 2.0 - (dot(point, self.upward) - self.middle[1]) * self.scale,
            near: dot(point, self.toward_viewer) * self.scale,
        }
    }

    /// A direction given as right, upward and toward the viewer.
    pub fn direction(&self, [right, upward, near]: [f64; 3]) -> Point {
        let along = |axis: usize| {
            right * self.right[axis] + upward * self.upward[axis] + near * self.toward_viewer[axis]
        };
        normalised([along(0), along(1), along(2)])
    }
}

/// The direction, or the other one if it is no direction at all.
fn direction(wanted: Point, otherwise: Point) -> Point {
    let direction = normalised(wanted);
    if direction.iter().all(|c| c.is_finite()) && dot(direction, direction) > 0.5 {
        direction
    } else {
        otherwise
    }
}
