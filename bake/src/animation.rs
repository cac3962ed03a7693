//! A model in motion, as files of animations hold it.
//!
//! [`crate::write::glb`] and [`crate::write::pvd`] write it.

use crate::error::{Error, Result};
use crate::mesh::Point;
use std::path::Path;

/// The extensions of the files that [`write()`] writes.
pub const EXTENSIONS: [&str; 2] = ["glb", "pvd"];

/// A model at one moment.
#[derive(Clone, Debug, PartialEq)]
pub struct Frame<'a> {
    /// The frame's number in its motion.
    pub number: u64,
    /// The model's points, in its order.
    pub points: &'a [Point],
}

/// A model at rest and in motion.
#[derive(Clone, Debug, PartialEq)]
pub struct Animation<'a> {
    /// The model's name.
    pub name: &'a str,
    /// Its points at rest.
    pub rest: &'a [Point],
    /// Its polygons, each of at least three of the points.
    pub faces: &'a [Vec<u32>],
    /// The frames, their numbers ascending; one at least, each with as many points as there are at
    /// rest.
    pub frames: &'a [Frame<'a>],
    /// Frames a second: numbers that differ by one are so far apart. Positive.
    pub frame_rate: f64,
    /// Name of the unit of the coordinates; may be empty.
    pub unit: &'a str,
    /// The direction that points upward. Not zero.
    pub up: Point,
}

impl Animation<'_> {
    /// When a frame is shown, in seconds from the first.
    pub fn seconds(&self, frame: &Frame<'_>) -> f64 {
        let first = self.frames.first().map_or(0, |first| first.number);
        frame.number.saturating_sub(first) as f64 / self.frame_rate
    }
}

/// Writes the animation in the format that the file's extension names: one of [`EXTENSIONS`].
///
/// # Errors
/// If the format cannot hold it or a file cannot be written.
pub fn write(animation: &Animation<'_>, file: &Path) -> Result<()> {
    match crate::read::extension(file).as_str() {
        "glb" => crate::write::atomically(file, |out| crate::write::glb::write(animation, out)),
        "pvd" => crate::write::pvd::write(animation, file),
        other => {
            Err(Error::new(format!("no writer of animations for \".{other}\" files")).in_file(file))
        }
    }
}
