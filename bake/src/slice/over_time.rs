//! A channel over time, as a device carries it: a table baked for the points of the picture, applied
//! to the values at every moment with the device's own code.

use super::{Cut, Field, on_line};
use crate::bundle::BundleBytes;
use crate::error::{Error, Result};
use crate::mesh::{Point, SolidMesh};
use crate::progress::Progress;
use crate::table::format::Format;
use crate::table::{Input, Options, Outside, bake};
use std::path::Path;

/// The values of one moment, at the places of a picture.
#[derive(Clone, Debug)]
pub struct Moment {
    /// On the plane.
    pub cut: Cut,
    /// Along the line, if there is one; `None` outside the solid.
    pub along: Vec<Option<f64>>,
    /// How many values did not fit the format of the channel and were clamped.
    pub saturated: u32,
}

/// What is looked at: a cut of the refined solid, and points on a line.
#[derive(Clone, Copy, Debug)]
pub struct Places<'a> {
    /// The cut; its values say only which points lie inside.
    pub cut: &'a Cut,
    /// Ends of the line and how many points lie on it.
    pub line: Option<([Point; 2], usize)>,
}

/// Carries a channel with one value for each vertex of the cage, at several moments, to the places
/// of a picture: the table is baked once, and each moment is one `apply_scalars`.
///
/// All moments have one format, the finest that leaves two bits of headroom over the largest value,
/// so that a value of the picture is within one unit of its last place, plus the rounding of the
/// weights, of the refinement in real numbers.
///
/// # Errors
/// If the table cannot be baked or a value does not fit the format.
pub fn over_time(
    (cage, cage_file): (&SolidMesh, &Path),
    options: &Options,
    refined: &Field,
    places: Places<'_>,
    moments: &[Vec<f64>],
    progress: &mut dyn Progress,
) -> Result<Vec<Moment>> {
    let along = match places.line {
        Some((ends, count)) => refined.along(ends, count),
        None => Vec::new(),
    };
    let points = points(places, &along);
    let options = Options {
        outside: Outside::Nearest,
        random_poses: 0,
        ..options.clone()
    };
    let input = Input {
        cage,
        cage_file,
        model: &points,
        model_file: cage_file,
    };
    let baked = bake(input, &options, progress)?;
    let bytes = BundleBytes::new(&baked.bundle);
    let bundle = bytes.open()?;
    let failed = |error: &dyn std::error::Error| Error::new(error.to_string());
    let table = bundle.table::<i32>().map_err(|error| failed(&error))?;
    let format = Format::with_headroom(
        &moments
            .iter()
            .flatten()
            .map(|x| [*x; 3])
            .collect::<Vec<_>>(),
    );
    let carry = |values: &Vec<f64>| {
        let bits = bits(format, values)?;
        let mut rows = vec![[0_i32; 1]; table.rows()];
        let saturated = table
            .apply_scalars(0..table.rows(), &bits, &mut rows)
            .map_err(|error| failed(&error))?;
        let mut carried = vec![0.0; rows.len()];
        for (row, point) in bundle.model_points().iter().enumerate() {
            carried[point] = format.from_bits(rows[row][0]);
        }
        Ok(moment(places.cut, &along, carried, saturated))
    };
    moments.iter().map(carry).collect()
}

/// The bits of a channel's values, one channel for each vertex.
fn bits(format: Format, values: &[f64]) -> Result<Vec<[i32; 1]>> {
    let bits = |(vertex, value): (usize, &f64)| {
        let bits = format.to_bits(*value).ok_or_else(|| {
            Error::new(format!(
                "the value {value} of vertex {vertex} (counted from 0) does not fit 32 bits"
            ))
            .advise("take a larger unit for the channel")
        })?;
        Ok([bits])
    };
    values.iter().enumerate().map(bits).collect()
}

/// The points that values are carried to: those of the cut inside the solid, the middles of the
/// segments in which it cuts sheets, and those of the line inside the solid.
fn points(places: Places<'_>, along: &[Option<f64>]) -> Vec<Point> {
    let cut = places.cut;
    let mut points = cut.points_inside();
    points.extend(cut.sheets().iter().map(|segment| {
        let [from, to] = segment.ends;
        cut.plane
            .point([0, 1].map(|k| f64::midpoint(from[k], to[k])))
    }));
    if let Some((ends, count)) = places.line {
        let inside = along
            .iter()
            .enumerate()
            .filter(|(_, value)| value.is_some());
        points.extend(inside.map(|(place, _)| on_line(ends, place, count)));
    }
    points
}

/// The carried values, in the order of [`points`], back at their places.
fn moment(cut: &Cut, along: &[Option<f64>], carried: Vec<f64>, saturated: u32) -> Moment {
    let mut carried = carried.into_iter();
    let mut cut = cut.clone();
    for value in cut.values.iter_mut().flatten() {
        *value = carried.next().unwrap_or_default();
    }
    for segment in &mut cut.sheets {
        segment.value = carried.next().unwrap_or_default();
    }
    let along = along.iter().map(|value| value.and_then(|_| carried.next()));
    Moment {
        along: along.collect(),
        cut,
        saturated,
    }
}
