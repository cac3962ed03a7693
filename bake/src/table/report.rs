//! What there is to say about a baked table.

use super::inverse::SolverReport;
use super::precision::{FormPrecision, Precision};
use super::quantise::{ONE, QuantisedRow};
use super::volume::VolumeReport;
use super::{BoundaryRule, FormatReport, NormalsReport, Outside, Scheme};
use crate::error::count;
use serde::Serialize;
use std::fmt;

/// The figures of a baked table.
#[derive(Clone, Debug, Serialize)]
pub struct Report {
    /// The scheme.
    pub scheme: Scheme,
    /// What the boundary followed.
    pub boundary: BoundaryRule,
    /// How many times the cage was refined.
    pub levels: u32,
    /// Name of the unit.
    pub unit: String,
    /// Fraction bits of the coordinates.
    pub fraction_bits: u32,
    /// Vertices of the cage.
    pub control_points: usize,
    /// Cells of the cage.
    pub cells: usize,
    /// Cells of the last level.
    pub refined_cells: usize,
    /// Cells of the last level without positive volume: the map at rest folds there.
    pub refined_cells_without_volume: usize,
    /// Rows of the table: points of the model.
    pub rows: usize,
    /// Numbers of taps.
    pub taps: TapsReport,
    /// Bytes of the bundle.
    pub bytes: usize,
    /// Weights.
    pub weights: WeightsReport,
    /// Points outside the refined cage.
    pub outside: OutsideReport,
    /// What every format costs; the one that was taken comes first.
    pub formats: Vec<FormatReport>,
    /// Errors of a direct table with weights of 30 fraction bits.
    pub precision: Precision,
    /// The forms of enclosed volumes that were baked.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub volumes: Vec<VolumeReport>,
    /// The solvers for goals that were baked.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub solvers: Vec<SolverReport>,
    /// The faces for normals, if they were baked.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub normals: Option<NormalsReport>,
}

/// Numbers of taps.
#[derive(Clone, Debug, Serialize)]
pub struct TapsReport {
    /// Of all rows.
    pub total: usize,
    /// On average a row.
    pub mean: f64,
    /// Of the longest row.
    pub longest: usize,
}

impl TapsReport {
    pub(super) fn of_lengths(lengths: &[usize]) -> Self {
        let total = lengths.iter().sum();
        Self {
            total,
            mean: total as f64 / lengths.len().max(1) as f64,
            longest: lengths.iter().copied().max().unwrap_or(0),
        }
    }

    pub(super) fn of(rows: &[QuantisedRow]) -> Self {
        let lengths: Vec<usize> = rows.iter().map(|row| row.taps.len()).collect();
        Self::of_lengths(&lengths)
    }
}

/// The weights of a table, as real numbers.
#[derive(Clone, Debug, Serialize)]
pub struct WeightsReport {
    /// The least of all.
    pub least: f64,
    /// The greatest of all.
    pub greatest: f64,
    /// The rows with the largest sums of magnitudes, largest first; 1 unless weights are negative.
    pub largest_rows: Vec<LargestRow>,
}

/// A row with a large sum of magnitudes.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct LargestRow {
    /// The row: the model point, counted from 0.
    pub row: usize,
    /// The sum of the magnitudes of its weights, at most 2.
    pub magnitude: f64,
}

impl WeightsReport {
    pub(super) fn of(rows: &[QuantisedRow]) -> Self {
        const SHOWN: usize = 3;
        let weights = || {
            rows.iter()
                .flat_map(|row| row.taps.iter().map(|(_, weight)| *weight))
        };
        let real = |weight: i64| weight as f64 / ONE as f64;
        let magnitude = |row: &QuantisedRow| {
            row.taps
                .iter()
                .map(|(_, weight)| i64::from(*weight).abs())
                .sum()
        };
        let mut order: Vec<(usize, i64)> = rows.iter().map(magnitude).enumerate().collect();
        order.sort_by_key(|(row, magnitude)| (std::cmp::Reverse(*magnitude), *row));
        let largest = order.iter().take(SHOWN);
        Self {
            least: real(weights().min().unwrap_or(0).into()),
            greatest: real(weights().max().unwrap_or(0).into()),
            largest_rows: largest
                .map(|(row, magnitude)| LargestRow {
                    row: *row,
                    magnitude: real(*magnitude),
                })
                .collect(),
        }
    }
}

/// Points that no cell of the last level contains.
#[derive(Clone, Debug, Default, Serialize)]
pub struct OutsideReport {
    /// What was done with them.
    pub treatment: Outside,
    /// How many lie outside by more than one unit in the last place of a coordinate.
    pub count: usize,
    /// How many lie outside by less; they count as being on the boundary.
    pub on_boundary: usize,
    /// The one that lies farthest outside.
    pub farthest: Option<usize>,
    /// How far that is, in the cage's units.
    pub farthest_distance: f64,
}

impl OutsideReport {
    pub(super) fn add(&mut self, point: usize, distance: f64) {
        self.count += 1;
        if self.farthest.is_none() || distance > self.farthest_distance {
            self.farthest = Some(point);
            self.farthest_distance = distance;
        }
    }
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let unit = if self.unit.is_empty() {
            ""
        } else {
            &format!(" {}", self.unit)
        };
        let step = 2.0_f64.powi(-(self.fraction_bits as i32));
        writeln!(
            f,
            "cage        {} control points, {} cells; {} cells after {}",
            self.control_points,
            self.cells,
            self.refined_cells,
            count(self.levels as usize, "level", "levels")
        )?;
        writeln!(
            f,
            "format      {} fraction bits, one unit in the last place is {step:e}{unit}",
            self.fraction_bits
        )?;
        writeln!(f, "rows        {}", self.rows)?;
        writeln!(
            f,
            "taps        {} ({:.1} a row on average, {} at most)",
            self.taps.total, self.taps.mean, self.taps.longest
        )?;
        writeln!(f, "bundle      {} bytes", self.bytes)?;
        writeln!(
            f,
            "weights     from {:.3e} to {:.6}",
            self.weights.least, self.weights.greatest
        )?;
        for LargestRow { row, magnitude } in &self.weights.largest_rows {
            // Without negative weights every sum of magnitudes is one.
            if *magnitude > 1.0 {
                writeln!(
                    f,
                    "            magnitudes of row {row} add up to {magnitude:.6}"
                )?;
            }
        }
        for volume in &self.volumes {
            volume.write(f, unit)?;
        }
        for solver in &self.solvers {
            solver.write(f)?;
        }
        if let Some(normals) = &self.normals {
            writeln!(
                f,
                "normals     {} of faces, {} bytes",
                count(normals.corners, "corner", "corners"),
                normals.bytes
            )?;
        }
        self.write_outside(f, unit)?;
        self.write_formats(f, unit, step)?;
        writeln!(
            f,
            "error of the q30 table against the unquantised map, in units in the last place"
        )?;
        let Precision {
            absolute,
            displacement,
            composition,
            random_poses,
            seed,
        } = &self.precision;
        for (name, form) in [("absolute", absolute), ("displacement", displacement)] {
            write_form(f, name, form)?;
        }
        write!(
            f,
            "            measured on {random_poses} random poses (seed {seed}) and the worst pose of the worst row; bounds include {composition:.1e} of double precision"
        )
    }
}

fn write_form(f: &mut fmt::Formatter<'_>, name: &str, form: &FormPrecision) -> fmt::Result {
    writeln!(
        f,
        "  {name:<13} at most {:.4} for a pose of the rest cage's size, {:.4} for any pose (proved); {:.4} measured",
        form.proved_rest_size, form.proved_any_pose, form.measured
    )
}

impl Report {
    /// A line for each format.
    fn write_formats(&self, f: &mut fmt::Formatter<'_>, unit: &str, step: f64) -> fmt::Result {
        writeln!(
            f,
            "formats     bytes, bytes a tap, estimated instructions a tap (Cortex-M4), error{unit} proved and measured; * is written"
        )?;
        for (place, format) in self.formats.iter().enumerate() {
            let name = format.format.name();
            writeln!(
                f,
                "{} {name:<17} {:>9} {:>6.2} {:>6.2} {:>10.3e} {:>10.3e}",
                if place == 0 { "*" } else { " " },
                format.bytes,
                format.bytes_a_tap,
                format.instructions / self.taps.total.max(1) as f64,
                format.proved * step,
                format.measured * step
            )?;
        }
        Ok(())
    }

    fn write_outside(&self, f: &mut fmt::Formatter<'_>, unit: &str) -> fmt::Result {
        let outside = &self.outside;
        let what = match outside.treatment {
            Outside::Error => "refused",
            Outside::Nearest => "moving with the nearest boundary point",
            Outside::Extrapolate => "extrapolated",
        };
        match outside.farthest {
            None => writeln!(f, "outside     0 points")?,
            Some(farthest) => writeln!(
                f,
                "outside     {}, {what}; the farthest is point {farthest}, by {}{unit}",
                count(outside.count, "point", "points"),
                outside.farthest_distance
            )?,
        }
        if outside.on_boundary > 0 {
            writeln!(
                f,
                "            {} more within one unit in the last place, taken as on the boundary",
                outside.on_boundary
            )?;
        }
        Ok(())
    }
}
