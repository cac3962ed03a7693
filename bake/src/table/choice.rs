//! The formats of a table: what each costs, how exact it is, and which is taken.
//!
//! A format is a layout of weights and coordinates ([`Layout`]) and either **direct**, rows over the control
//! points, or **factored**: short rows over refined vertices that were themselves computed by rows over
//! the control points. Every format is packed and measured, so that the report can show what the
//! choice was made from.

use super::format::Format;
use super::measure::measure;
use super::quantise::{QuantisedRow, quantise_to, total_change};
use crate::error::{Error, Result};
use crate::mesh::Point;
use crate::pack::cost::Cost;
use crate::pack::sections::{Source, Stage};
use crate::pack::writer::{self, Section};
use crate::pack::{Layout, Taps};
use crate::refine::rows::{Row, compose, identity};
use octruss::deform::displacement_shift;
use serde::Serialize;

/// The formats of a table by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum TableFormat {
    /// Weights of 32 bits over 32-bit coordinates; opened with `Bundle::table`
    Q30,
    /// Weights of 16 bits over 32-bit coordinates; opened with `Bundle::table`
    Q14,
    /// Weights of 16 bits over 16-bit displacements; opened with `Bundle::compact_table`
    Compact,
    /// As q30, over refined points; opened with `Bundle::factored_table`
    Q30Factored,
    /// As q14, over refined points; opened with `Bundle::factored_table`
    Q14Factored,
    /// As compact, over refined points; opened with `Bundle::compact_factored_table`
    CompactFactored,
}

impl TableFormat {
    /// All of them.
    pub const ALL: [Self; 6] = [
        Self::Q30,
        Self::Q14,
        Self::Compact,
        Self::Q30Factored,
        Self::Q14Factored,
        Self::CompactFactored,
    ];

    /// The name on the command line.
    #[must_use]
    pub fn name(self) -> String {
        use clap::ValueEnum as _;
        let value = self.to_possible_value();
        value.map_or_else(String::new, |value| value.get_name().to_owned())
    }

    fn is_factored(self) -> bool {
        matches!(
            self,
            Self::Q30Factored | Self::Q14Factored | Self::CompactFactored
        )
    }

    /// The layout for inputs that move by so many units at most; `None` if 16 bits cannot hold them.
    fn layout(self, displacement: f64) -> Option<Layout> {
        match self {
            Self::Q30 | Self::Q30Factored => Some(Layout::Q30),
            Self::Q14 | Self::Q14Factored => Some(Layout::Q14),
            Self::Compact | Self::CompactFactored => {
                let shift = displacement_shift(displacement.ceil().max(0.0) as u64)?;
                Some(Layout::Compact { shift })
            }
        }
    }
}

/// How the format of a table is chosen.
#[derive(Clone, Copy, Debug, Default)]
pub struct Request {
    /// This one; by default, and without an accuracy, [`TableFormat::Q30`].
    pub format: Option<TableFormat>,
    /// The cheapest whose proved error is at most this, in units of the model.
    pub max_error: Option<f64>,
    /// The farthest that a control point moves along an axis, in units of the cage; by default the
    /// cage's largest extent.
    pub max_displacement: Option<f64>,
    /// Rows in the order of the model's points: costs time and flash.
    pub keep_order: bool,
    /// Pack and measure every format for the report, not only what the choice needs.
    pub survey: bool,
}

/// What a format costs and how exact it is.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct FormatReport {
    /// The format.
    pub format: TableFormat,
    /// Bytes of the sections of the table, start values and rest positions among them.
    pub bytes: usize,
    /// Bytes of weights, indices and groups for each tap of the direct table.
    pub bytes_a_tap: f64,
    /// Weights that are stored.
    pub stored_taps: usize,
    /// Groups of rows.
    pub groups: usize,
    /// Instructions on a Cortex-M4 for all rows, estimated.
    pub instructions: f64,
    /// The level whose vertices a factored table computes first.
    pub refined_level: Option<usize>,
    /// How many they are: points of memory that a device needs.
    pub refined_points: usize,
    /// No pose within the greatest displacement gives a greater error, in units in the last place.
    pub proved: f64,
    /// The greatest error on random poses within the greatest displacement.
    pub measured: f64,
}

/// What tables are made from.
pub(super) struct Material<'a> {
    pub format: Format,
    /// Rows of the model's points over the last level's vertices.
    pub embeddings: &'a [Row],
    /// One matrix for each level, the first level first.
    pub matrices: &'a [Vec<Row>],
    /// Rows of the model's points over the control points.
    pub rows: &'a [Row],
    /// The control points.
    pub cage: &'a [Point],
    pub rest_cage: &'a [[i32; 3]],
    pub rest_model: &'a [[i32; 3]],
    /// A bound of the composition's errors.
    pub composition: f64,
    pub random_poses: u32,
    pub seed: u64,
}

/// A packed table.
pub(super) struct Packed {
    /// The model's point that each row is.
    pub order: Vec<usize>,
    pub sections: Vec<Section>,
    pub report: FormatReport,
}

/// Packs every format and takes one; the reports of all come with it, the taken one first.
///
/// # Errors
/// If the format asked for cannot hold the table, or none is as exact as was asked for.
pub(super) fn choose(
    material: &Material<'_>,
    request: Request,
) -> Result<(Packed, Vec<FormatReport>)> {
    let displacement = material.greatest_displacement(request);
    let asked = match (request.format, request.max_error) {
        (Some(format), _) => Some(format),
        (None, None) => Some(TableFormat::Q30),
        (None, Some(_)) => None,
    };
    let mut packed: Vec<Packed> = TableFormat::ALL
        .into_iter()
        .filter(|format| request.survey || asked.is_none_or(|asked| asked == *format))
        .filter_map(|format| material.pack(format, displacement, request.keep_order))
        .collect();
    let step = material.format.unit();
    let taken = match (asked, request.max_error) {
        (None, Some(most)) => {
            let exact = packed
                .iter()
                .filter(|table| table.report.proved * step <= most);
            let cheapest =
                exact.min_by(|a, b| a.report.instructions.total_cmp(&b.report.instructions));
            cheapest.map(|table| table.report.format)
        }
        (asked, _) => asked,
    };
    packed.sort_by_key(|table| Some(table.report.format) != taken);
    let reports: Vec<FormatReport> = packed.iter().map(|table| table.report).collect();
    let first = packed.into_iter().next();
    let Some(first) = first.filter(|first| Some(first.report.format) == taken) else {
        return Err(refusal(&reports, taken, step));
    };
    match request.max_error {
        Some(most) if first.report.proved * step > most => Err(refusal(&reports, None, step)),
        _ => Ok((first, reports)),
    }
}

fn refusal(reports: &[FormatReport], asked: Option<TableFormat>, step: f64) -> Error {
    let best = reports
        .iter()
        .map(|report| report.proved)
        .fold(f64::INFINITY, f64::min);
    match asked {
        Some(format) => Error::new(format!("the table does not fit the format {format:?}"))
            .advise("take q30, fewer --fraction-bits, or a smaller --max-displacement"),
        None => Error::new(format!(
            "no format is as exact as was asked for; the best has an error of at most {}",
            best * step
        ))
        .advise("allow a larger --max-error, take more --fraction-bits, or a smaller --max-displacement"),
    }
}

impl Material<'_> {
    /// In units in the last place.
    fn greatest_displacement(&self, request: Request) -> f64 {
        let extent = |axis: usize| {
            let bits = || self.rest_cage.iter().map(|point| f64::from(point[axis]));
            bits().fold(f64::MIN, f64::max) - bits().fold(f64::MAX, f64::min)
        };
        match request.max_displacement {
            Some(most) => most / self.format.unit(),
            None => (0..3).map(extent).fold(0.0, f64::max),
        }
    }

    fn pack(&self, format: TableFormat, displacement: f64, keep_order: bool) -> Option<Packed> {
        if format.is_factored() {
            let mut cheapest: Option<Packed> = None;
            for level in 1..=self.matrices.len() {
                let cost = |table: &Packed| table.report.instructions;
                let most = cheapest.as_ref().map_or(f64::INFINITY, cost);
                let table = self.pack_factored(format, level, displacement, keep_order, most);
                cheapest = table.filter(|table| cost(table) < most).or(cheapest);
            }
            return Some(self.measured(cheapest?, displacement));
        }
        let layout = format.layout(displacement)?;
        let rows = quantised(self.rows, layout)?;
        let stage = stage(&rows, layout, self.rest_cage, self.rest_model, keep_order)?;
        let error = Bound::of(self.rows, &rows, self.composition);
        let report = FormatReport {
            format,
            bytes: 0,
            bytes_a_tap: 0.0,
            stored_taps: stage.stored_taps(),
            groups: stage.group_count(),
            instructions: stage.instructions,
            refined_level: None,
            refined_points: 0,
            proved: error.after(layout, displacement, 0.0),
            measured: 0.0,
        };
        let tap_bytes = stage.tap_bytes();
        let mut sections = stage.sections(0);
        sections.extend(writer::model_points(&stage.order));
        let packed = self.completed(sections, stage.order, tap_bytes, report);
        Some(self.measured(packed, displacement))
    }

    /// The table by way of the vertices of a level; `None` too if its first rows alone take as many
    /// instructions as `most`.
    fn pack_factored(
        &self,
        format: TableFormat,
        level: usize,
        displacement: f64,
        keep_order: bool,
        most: f64,
    ) -> Option<Packed> {
        let (before, after) = self.matrices.split_at_checked(level)?;
        let columns = u32::try_from(before.last()?.len()).ok()?;
        let real_last = compose(self.embeddings, after, columns);
        let mut used: Vec<u32> = real_last
            .iter()
            .flatten()
            .map(|(column, _)| *column)
            .collect();
        used.sort_unstable();
        used.dedup();
        let units = identity(columns);
        let wanted: Vec<Row> = used
            .iter()
            .map(|&vertex| units[vertex as usize].clone())
            .collect();
        let real_first = compose(&wanted, before, u32::try_from(self.cage.len()).ok()?);
        let rest_used = self.rest_of(&real_first)?;

        let layout = format.layout(displacement)?;
        let rows = quantised(&real_first, layout)?;
        let cost = Cost::of(layout);
        let least = rows.iter().map(|row| cost.row_at_least(row.taps.len()));
        if least.sum::<f64>() >= most {
            return None;
        }
        let first = stage(&rows, layout, self.rest_cage, &rest_used, false)?;
        let first_bound = Bound::of(&real_first, &rows, self.composition);
        let moved = displacement * first_bound.magnitude + 1.0;

        let mut place = vec![0; columns as usize];
        for (row, &vertex) in first.order.iter().enumerate() {
            place[used[vertex] as usize] = row as u32;
        }
        let rest_first: Vec<[i32; 3]> = first.order.iter().map(|&row| rest_used[row]).collect();
        let relabelled = real_last.iter().map(|row| {
            let mut row: Row = row.iter().map(|&(c, w)| (place[c as usize], w)).collect();
            row.sort_unstable_by_key(|(column, _)| *column);
            row
        });
        let real_last: Vec<Row> = relabelled.collect();
        let last_layout = format.layout(moved)?;
        let rows = quantised(&real_last, last_layout)?;
        let last = stage(&rows, last_layout, &rest_first, self.rest_model, keep_order)?;
        let last_bound = Bound::of(&real_last, &rows, self.composition);
        let error = first_bound.after(layout, displacement, 0.0);
        let report = FormatReport {
            format,
            bytes: 0,
            bytes_a_tap: 0.0,
            stored_taps: first.stored_taps() + last.stored_taps(),
            groups: first.group_count() + last.group_count(),
            instructions: first.instructions + last.instructions,
            refined_level: Some(level),
            refined_points: used.len(),
            proved: last_bound.after(last_layout, moved, error),
            measured: 0.0,
        };
        let tap_bytes = first.tap_bytes() + last.tap_bytes();
        let mut sections = first.sections(0);
        sections.extend(last.sections(1));
        sections.extend(writer::model_points(&last.order));
        Some(self.completed(sections, last.order, tap_bytes, report))
    }

    /// The bits of the points that rows give at rest; `None` if one does not fit.
    fn rest_of(&self, rows: &[Row]) -> Option<Vec<[i32; 3]>> {
        let bits = rows.iter().map(|row| {
            let coordinate = |axis: usize| {
                let sum = row
                    .iter()
                    .map(|&(point, weight)| weight * self.cage[point as usize][axis]);
                self.format.to_bits(sum.sum())
            };
            Some([coordinate(0)?, coordinate(1)?, coordinate(2)?])
        });
        bits.collect()
    }

    fn completed(
        &self,
        table: Vec<Section>,
        order: Vec<usize>,
        tap_bytes: usize,
        report: FormatReport,
    ) -> Packed {
        let taps: usize = self.rows.iter().map(Vec::len).sum();
        let report = FormatReport {
            bytes: table.iter().map(|section| section.bytes.len()).sum(),
            bytes_a_tap: tap_bytes as f64 / taps.max(1) as f64,
            ..report
        };
        let mut sections = vec![writer::rest_cage(self.rest_cage)];
        sections.extend(table);
        Packed {
            order,
            sections,
            report,
        }
    }

    fn measured(&self, mut packed: Packed, displacement: f64) -> Packed {
        packed.report.measured = measure(self, &packed, displacement);
        packed
    }
}

/// How far a stage's quantised weights are from the real ones.
struct Bound {
    /// The greatest sum of the magnitudes of a row's errors.
    error: f64,
    /// The greatest sum of the magnitudes of a row's weights.
    magnitude: f64,
}

impl Bound {
    fn of(real: &[Row], rows: &[QuantisedRow], composition: f64) -> Self {
        let changes = real
            .iter()
            .zip(rows)
            .map(|(real, row)| total_change(real, row));
        let magnitudes = rows.iter().map(QuantisedRow::magnitude);
        Self {
            error: changes.fold(0.0, f64::max) + composition,
            magnitude: magnitudes.fold(1.0, f64::max),
        }
    }

    /// The error of a row whose inputs move by at most `displacement` and are off by at most `before`:
    /// of its weights, of its inputs, of their displacements' rounding, and of its own rounding.
    fn after(&self, layout: Layout, displacement: f64, before: f64) -> f64 {
        let rounding = match layout {
            Layout::Q30 | Layout::Q14 => 0.0,
            Layout::Compact { shift: 0 } => 0.0,
            Layout::Compact { shift } => 2.0_f64.powi(shift as i32 - 1),
        };
        self.error * displacement + self.magnitude * (before + rounding) + 0.5
    }
}

fn quantised(rows: &[Row], layout: Layout) -> Option<Vec<QuantisedRow>> {
    let quantise = |row: &Row| quantise_to(row, layout.weight_bits()).ok();
    rows.iter().map(quantise).collect()
}

fn stage(
    rows: &[QuantisedRow],
    layout: Layout,
    rest_inputs: &[[i32; 3]],
    rest: &[[i32; 3]],
    keep_order: bool,
) -> Option<Stage> {
    let shift = octruss::blend::WEIGHT_BITS - layout.weight_bits();
    let whole = |row: &QuantisedRow| -> Vec<(u32, i32)> {
        row.taps
            .iter()
            .map(|&(point, weight)| (point, weight >> shift))
            .collect()
    };
    let rows: Vec<Vec<(u32, i32)>> = rows.iter().map(whole).collect();
    let rows: Vec<&Taps> = rows.iter().map(Vec::as_slice).collect();
    let source = Source {
        rows: &rows,
        rest_inputs,
        rest: Some(rest),
        keep_order,
    };
    Stage::new(&source, layout)
}
