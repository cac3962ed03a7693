//! Baking: from a cage and a model to a table of integer weights.
//!
//! The cage at rest is refined in double precision ([`crate::refine`]), every model point is
//! located in a cell of the last level ([`crate::locate`]), and its weights there are carried back
//! to the control points: `D = B * S_K * ... * S_1`, equation (1) of "Smooth Subdivision of
//! Tetrahedral Meshes". The real weights become integers that sum to one ([`mod@quantise`]);
//! [`precision`] says what that costs; [`crate::bundle`] writes the bytes.

mod choice;
pub mod format;
pub mod inverse;
mod measure;
pub mod precision;
pub mod quantise;
mod report;
pub mod surface;
mod volume;

pub use crate::pack::normals::NormalsReport;
pub use choice::{FormatReport, Request, TableFormat};
pub use report::{LargestRow, OutsideReport, Report, TapsReport, WeightsReport};
pub use volume::{CentroidReport, ModesReport, Region, VolumeReport};

use crate::bundle::{self, Contents, LONGEST_UNIT};
use crate::check::{self, Volumes};
use crate::dynamics::Dynamics;
use crate::error::{Error, Result, count};
use crate::locate::{Embedding, Locator, Nearest};
use crate::mesh::{Point, SolidMesh};
use crate::overlap;
use crate::pack::normals;
use crate::progress::Progress;
use crate::refine::rows::{Row, RowBlend, compose, composition_error, identity};
use crate::refine::{BoundaryRule, DiagonalLists, Level, Refinement, Scheme};
use choice::{Material, choose};
use format::{Format, MOST_FRACTION_BITS};
use precision::Table;
use quantise::{QuantisedRow, quantise};
use std::path::Path;

/// What to do with a model point outside the refined cage.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, clap::ValueEnum, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Outside {
    /// Refuse, and say how many there are and how far the farthest lies outside
    #[default]
    Error,
    /// Move with the nearest point of the refined cage's boundary
    Nearest,
    /// Extrapolate the coordinates in the cell behind the nearest point of the boundary
    Extrapolate,
}

/// How to bake.
#[derive(Clone, Debug)]
pub struct Options {
    /// The scheme.
    pub scheme: Scheme,
    /// Major diagonals of the cage's cells, for box splines; chosen if not given.
    pub diagonals: Option<DiagonalLists>,
    /// What the boundary follows.
    pub boundary: BoundaryRule,
    /// How many times the cage is refined.
    pub levels: u32,
    /// Fraction bits of the coordinates, 0 to 32; by default as many as leave two bits of headroom
    /// over the largest coordinate of cage and model.
    pub fraction_bits: Option<u32>,
    /// Name of the unit of cage and model, at most 16 bytes.
    pub unit: String,
    /// What to do with points outside.
    pub outside: Outside,
    /// Also bake the forms of these regions' volumes.
    pub volumes: Vec<Region>,
    /// Modes that those volumes are also baked for, as polynomials: each the pose at amplitude one.
    pub modes: Vec<Vec<Point>>,
    /// Also bake the centroids for those modes.
    pub centroid: bool,
    /// Also bake solvers for goals over those modes.
    pub solvers: inverse::Solvers,
    /// Also bake the faces of the model, for the normals of its points: each the points round a face, counter-
    /// clockwise from outside. None by default.
    pub faces: Option<Vec<Vec<u32>>>,
    /// What moves the control points.
    pub dynamics: Dynamics,
    /// How the format of the table is chosen.
    pub request: Request,
    /// Random poses on which the table's error is measured.
    pub random_poses: u32,
    /// Where their random numbers start from.
    pub seed: u64,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            scheme: Scheme::TetOct,
            diagonals: None,
            boundary: BoundaryRule::Loop,
            levels: 2,
            fraction_bits: None,
            unit: String::new(),
            outside: Outside::Error,
            volumes: Vec::new(),
            modes: Vec::new(),
            centroid: false,
            solvers: inverse::Solvers::default(),
            faces: None,
            dynamics: Dynamics::default(),
            request: Request::default(),
            random_poses: 4,
            seed: 0,
        }
    }
}

/// What baking gives.
#[derive(Clone, Debug)]
pub struct Baked {
    /// The bundle's bytes.
    pub bundle: Vec<u8>,
    /// The real weights, a row for each model point.
    pub rows: Vec<Row>,
    /// What there is to say about it.
    pub report: Report,
}

/// What is baked, and the files it came from, which errors name.
#[derive(Clone, Copy, Debug)]
pub struct Input<'a> {
    /// The cage at rest.
    pub cage: &'a SolidMesh,
    /// Where the cage came from.
    pub cage_file: &'a Path,
    /// The points of the model at rest.
    pub model: &'a [Point],
    /// Where the model came from.
    pub model_file: &'a Path,
}

/// Bakes the table that moves the points of a model with a cage.
///
/// # Errors
/// If the cage is no sound solid, an option is out of range, or a model point cannot be embedded.
pub fn bake(input: Input<'_>, options: &Options, progress: &mut dyn Progress) -> Result<Baked> {
    let Input { cage, model, .. } = input;
    let of_cage = |error: Error| error.in_file(input.cage_file);
    let of_model = |error: Error| error.in_file(input.model_file);
    check::require_sound_connectivity(cage).map_err(of_cage)?;
    check::require_positive_volumes(cage).map_err(of_cage)?;
    require_sizes(input)?;
    let format = choose_format(cage, model, options)?;
    let rest_cage = format.bits_of(&cage.points, "vertex").map_err(of_cage)?;
    let rest_model = format.bits_of(model, "vertex").map_err(of_model)?;
    overlap::require_none(cage).map_err(of_cage)?;
    require_extent(&rest_cage, format).map_err(of_cage)?;

    let refined = refine(cage, options, progress).map_err(of_cage)?;
    let (embeddings, outside) =
        locate(&refined, model, options.outside, format, progress).map_err(of_model)?;
    progress.stage("composing rows", 1);
    let rows = compose(&embeddings, &refined.matrices, refined.control_points);
    let composition = composition_error(&embeddings, &refined.matrices, refined.terms);
    progress.step();
    let quantised = quantise_all(&rows, progress).map_err(of_model)?;

    progress.stage("packing", 1);
    let material = Material {
        format,
        embeddings: &embeddings,
        matrices: &refined.matrices,
        rows: &rows,
        cage: &cage.points,
        rest_cage: &rest_cage,
        rest_model: &rest_model,
        composition,
        random_poses: options.random_poses,
        seed: options.seed,
    };
    let (packed, formats) = choose(&material, options.request)?;
    let mut sections = packed.sections.clone();
    let wanted = volume::Wanted {
        regions: &options.volumes,
        modes: &options.modes,
        centroid: options.centroid,
        points: &cage.points,
        rest: &rest_cage,
        format,
    };
    let (of_volumes, volumes) = wanted
        .sections(
            |region| volume::of_cage(cage, options, region),
            |region, combined| volume::moments_of_cage(cage, options, region, combined),
        )
        .map_err(of_cage)?;
    sections.extend(of_volumes);
    let wanted = inverse::Wanted {
        solvers: &options.solvers,
        modes: &options.modes,
        cage: &cage.points,
        rows: &rows,
        rest_model: &rest_model,
        order: &packed.order,
        format,
    };
    let (of_solvers, solvers) = wanted.sections().map_err(of_model)?;
    sections.extend(of_solvers);
    let normals = match &options.faces {
        None => None,
        Some(faces) => {
            let (section, report) =
                normals::section(faces, &packed.order, &rest_model).map_err(of_model)?;
            sections.push(section);
            Some(report)
        }
    };
    sections.extend(options.dynamics.sections(format, &rest_cage)?);
    let bytes = bundle::write(&Contents {
        format,
        unit: &options.unit,
        scheme: options.scheme.code(),
        boundary: options.boundary.code(),
        levels: options.levels,
        control_points: cage.points.len(),
        rows: model.len(),
        sections: &sections,
        cage_checksum: bundle::cage_checksum(cage.points.len(), &cage.cells),
        model_checksum: bundle::model_checksum(model),
    })
    .map_err(of_model)?;
    progress.stage("measuring the error", 1);
    let table = Table {
        rows: &rows,
        quantised: &quantised,
        rest_cage: &rest_cage,
        composition,
    };
    let precision = table.precision(options.random_poses, options.seed);
    progress.finish();
    let report = Report {
        scheme: options.scheme,
        boundary: options.boundary,
        levels: options.levels,
        unit: options.unit.clone(),
        fraction_bits: format.fraction_bits,
        control_points: cage.points.len(),
        cells: cage.cells.len(),
        refined_cells: refined.last.cells.len(),
        refined_cells_without_volume: refined.cells_without_volume(),
        rows: quantised.len(),
        taps: TapsReport::of(&quantised),
        bytes: bytes.len(),
        weights: WeightsReport::of(&quantised),
        outside,
        formats,
        precision,
        volumes,
        solvers,
        normals,
    };
    Ok(Baked {
        bundle: bytes,
        rows,
        report,
    })
}

/// A table has at least one row, and its indices have 16 bits.
fn require_sizes(input: Input<'_>) -> Result<()> {
    if input.model.is_empty() {
        return Err(Error::new("the model has no points").in_file(input.model_file));
    }
    let control_points = input.cage.points.len();
    if u16::try_from(control_points.saturating_sub(1)).is_ok() {
        return Ok(());
    }
    Err(Error::new(format!(
        "the cage has {control_points} control points; a table has at most 65536"
    ))
    .advise("take a coarser cage")
    .in_file(input.cage_file))
}

/// A unit's name fits its field.
fn require_unit(unit: &str) -> Result<()> {
    if unit.len() > LONGEST_UNIT || unit.contains('\0') {
        return Err(
            Error::new(format!("the unit's name \"{unit}\" is too long")).advise(format!(
                "a unit has at most {LONGEST_UNIT} bytes, such as \"mm\""
            )),
        );
    }
    Ok(())
}

/// Error if the grid of the coordinates is so coarse that nothing is left of the cage.
fn require_extent(rest_cage: &[[i32; 3]], format: Format) -> Result<()> {
    if rest_cage.len() < 2 || rest_cage.windows(2).any(|pair| pair[0] != pair[1]) {
        return Ok(());
    }
    Err(Error::new(format!(
        "all control points fall on one place: with {} fraction bits coordinates are multiples of {:e}",
        format.fraction_bits,
        format.unit()
    ))
    .advise("take a smaller unit, so that coordinates are larger numbers, or more --fraction-bits"))
}

fn choose_format(cage: &SolidMesh, model: &[Point], options: &Options) -> Result<Format> {
    require_unit(&options.unit)?;
    match options.fraction_bits {
        None => Ok(Format::with_headroom(cage.points.iter().chain(model))),
        Some(fraction_bits @ 0..=MOST_FRACTION_BITS) => Ok(Format { fraction_bits }),
        Some(other) => Err(
            Error::new(format!("{other} fraction bits do not fit a coordinate"))
                .advise(format!("take 0 to {MOST_FRACTION_BITS}")),
        ),
    }
}

/// The refined cage and how it came about.
struct Refined {
    last: Level,
    points: Vec<Point>,
    /// One matrix for each level, the first level first.
    matrices: Vec<Vec<Row>>,
    control_points: u32,
    /// Of how many rounded terms an entry of a matrix can be the sum; 0 but for the scheme mixed.
    terms: usize,
}

impl Refined {
    /// Cells of the last level that do not have positive volume: the map folds there.
    fn cells_without_volume(&self) -> usize {
        let volumes = Volumes::of(&self.last.cells, &self.points);
        volumes.inverted.len() + volumes.flat.len() + volumes.folded.len()
    }
}

fn refine(cage: &SolidMesh, options: &Options, progress: &mut dyn Progress) -> Result<Refined> {
    let mut level = Level::of_scheme(cage, options.scheme, options.diagonals.as_ref())?;
    level.require_levels(options.levels)?;
    let control_points = level.vertex_count;
    let (mut points, mut matrices) = (cage.points.clone(), Vec::new());
    let mut terms = 0;
    progress.stage("refining", options.levels as usize);
    for _ in 0..options.levels {
        let mut step = Refinement::new(&level, options.boundary.to_core())?;
        points = step.points(&points)?;
        matrices.push(step.values(&mut RowBlend, &identity(level.vertex_count))?);
        level = step.split()?;
        if options.scheme == Scheme::Mixed {
            terms = terms.max(CORNERS * most_cells_at_a_vertex(&level));
        }
        progress.step();
    }
    Ok(Refined {
        last: level,
        points,
        matrices,
        control_points,
        terms,
    })
}

/// Every cell at a vertex weighs the clones of its parent's corners, which are eight at most.
const CORNERS: usize = 8;

fn most_cells_at_a_vertex(level: &Level) -> usize {
    let mut cells = vec![0; level.vertex_count as usize];
    for vertex in level.cells.corners().flatten() {
        cells[*vertex as usize] += 1;
    }
    cells.into_iter().max().unwrap_or(0)
}

/// The points as weighted sums of refined vertices.
fn locate(
    refined: &Refined,
    model: &[Point],
    outside: Outside,
    format: Format,
    progress: &mut dyn Progress,
) -> Result<(Vec<Embedding>, OutsideReport)> {
    progress.stage("locating points", model.len());
    let skin = refined.last.skin();
    let locator = Locator::new(&refined.last.cells, &skin, &refined.points);
    // There is no cell behind a sheet: what is beside it moves with its nearest point.
    let carried = |nearest: &Nearest, point: Point| {
        let of_sheets = refined.last.boundary_count..skin.triangles.len();
        if of_sheets.contains(&nearest.face) {
            Some(locator.projected(nearest))
        } else {
            locator.extrapolated(nearest, point)
        }
    };
    let mut report = OutsideReport {
        treatment: outside,
        ..OutsideReport::default()
    };
    let mut embeddings = Vec::with_capacity(model.len());
    for (index, point) in model.iter().enumerate() {
        let embedding = match locator.inside(*point) {
            Some(embedding) => embedding,
            None => {
                let lost = || {
                    Error::new(format!(
                        "model point {index} (counted from 0) lies in no cell"
                    ))
                };
                let nearest = locator.nearest(*point).ok_or_else(lost)?;
                let embedding = match outside {
                    // The bits could not tell such a point from one on the boundary.
                    _ if nearest.distance <= format.unit() => {
                        report.on_boundary += 1;
                        carried(&nearest, *point)
                    }
                    Outside::Extrapolate => {
                        report.add(index, nearest.distance);
                        carried(&nearest, *point)
                    }
                    Outside::Error | Outside::Nearest => {
                        report.add(index, nearest.distance);
                        Some(locator.projected(&nearest))
                    }
                };
                embedding.ok_or_else(lost)?
            }
        };
        embeddings.push(embedding);
        progress.step();
    }
    if outside == Outside::Error
        && let Some(farthest) = report.farthest
    {
        progress.finish();
        return Err(Error::new(format!(
            "{} of {} outside the refined cage; the farthest, point {farthest} (counted from 0), by {}",
            report.count,
            count(model.len(), "point lies", "points lie"),
            report.farthest_distance
        ))
        .advise(
            "the smooth scheme pulls the boundary inward: enlarge the cage, or take --boundary fixed, or choose --outside nearest or --outside extrapolate",
        ));
    }
    Ok((embeddings, report))
}

fn quantise_all(rows: &[Row], progress: &mut dyn Progress) -> Result<Vec<QuantisedRow>> {
    progress.stage("quantising weights", rows.len());
    let quantised = rows.iter().enumerate().map(|(index, row)| {
        progress.step();
        quantise(row).map_err(|error| {
            let message = format!(
                "point {index} (counted from 0) cannot be baked: {}",
                error.message()
            );
            Error::new(message).advise(
                error
                    .advice()
                    .unwrap_or("the cage's geometry is too far from regular"),
            )
        })
    });
    quantised.collect()
}
