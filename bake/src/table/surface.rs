//! Baking of surfaces: the table that moves every vertex of a refined control mesh.
//!
//! There is nothing to locate: the model is the refined mesh itself, or its limit, and a row is a
//! product of core's own masks.

use super::choice::{FormatReport, Material, Request, choose};
use super::format::Format;
use super::volume::{self, Region, VolumeReport};
use super::{TapsReport, require_unit};
use crate::bundle::{self, Contents};
use crate::dynamics::Dynamics;
use crate::error::{Error, Result, count};
use crate::mesh::Point;
use crate::pack::normals::{self, NormalsReport};
use crate::progress::Progress;
use crate::refine::RealBlend;
use crate::refine::rows::{RowBlend, compose, composition_error, identity};
use crate::surface::{RimRule, SurfaceLevel, SurfaceMesh, SurfaceScheme, SurfaceStep};
use serde::Serialize;
use std::fmt;

/// How to bake a surface.
#[derive(Clone, Debug)]
pub struct SurfaceOptions {
    /// The scheme.
    pub scheme: SurfaceScheme,
    /// What the rim follows.
    pub rim: RimRule,
    /// How many times the control mesh is refined.
    pub levels: u32,
    /// Take the vertices of the last level to where they go in the limit.
    pub limit: bool,
    /// Fraction bits of the coordinates, 0 to 32; by default as many as leave two bits of headroom.
    pub fraction_bits: Option<u32>,
    /// Name of the unit, at most 16 bytes.
    pub unit: String,
    /// Also bake the forms of these volumes.
    pub volumes: Vec<Region>,
    /// Modes that they are also baked for: each the pose at amplitude one.
    pub modes: Vec<Vec<Point>>,
    /// Also bake the centroids for those modes.
    pub centroid: bool,
    /// Also bake the faces of the refined surface, for the normals of its points.
    pub normals: bool,
    /// What moves the control points.
    pub dynamics: Dynamics,
    /// Which format is taken.
    pub request: Request,
    /// Random poses on which the table's error is measured.
    pub random_poses: u32,
    /// Where their random numbers start from.
    pub seed: u64,
}

/// What baking a surface gives.
#[derive(Clone, Debug)]
pub struct BakedSurface {
    /// The bundle's bytes.
    pub bundle: Vec<u8>,
    /// The refined surface at rest: the model that the bundle moves.
    pub points: Vec<Point>,
    /// Its connectivity.
    pub level: SurfaceLevel,
    /// What there is to say about it.
    pub report: SurfaceReport,
}

/// The figures of a surface's table.
#[derive(Clone, Debug, Serialize)]
pub struct SurfaceReport {
    /// The scheme.
    pub scheme: SurfaceScheme,
    /// What the rim followed.
    pub rim: RimRule,
    /// How many times the control mesh was refined.
    pub levels: u32,
    /// Whether rows are limit points.
    pub limit: bool,
    /// Name of the unit.
    pub unit: String,
    /// Fraction bits of the coordinates.
    pub fraction_bits: u32,
    /// Vertices of the control mesh.
    pub control_points: usize,
    /// Vertices of the refined mesh.
    pub rows: usize,
    /// Faces of the refined mesh.
    pub faces: usize,
    /// Numbers of taps.
    pub taps: TapsReport,
    /// Bytes of the bundle.
    pub bytes: usize,
    /// What every format costs; the one that was taken comes first.
    pub formats: Vec<FormatReport>,
    /// The forms of enclosed volumes that were baked.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub volumes: Vec<VolumeReport>,
    /// The faces for normals, if they were baked.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub normals: Option<NormalsReport>,
}

/// Bakes the table of all vertices of a refined surface.
///
/// # Errors
/// If the scheme does not take the mesh, an option is out of range, or a row's magnitudes add up to
/// more than two.
pub fn bake_surface(
    mesh: &SurfaceMesh,
    options: &SurfaceOptions,
    progress: &mut dyn Progress,
) -> Result<BakedSurface> {
    require_unit(&options.unit)?;
    let control_points = mesh.points.len();
    if control_points == 0 || u16::try_from(control_points - 1).is_err() {
        return Err(Error::new(format!(
            "the control mesh has {control_points} vertices; a table has 1 to 65536 control points"
        )));
    }
    let control = SurfaceLevel::new(mesh)?;
    let (mut level, mut points, mut matrices) = (control.clone(), mesh.points.clone(), Vec::new());
    progress.stage("refining", options.levels as usize);
    for _ in 0..options.levels {
        let mut step = SurfaceStep::new(&level, options.scheme, options.rim);
        points = step.values(&mut RealBlend, &points)?;
        matrices.push(step.values(&mut RowBlend, &identity(level.vertex_count))?);
        let next = step.split()?;
        level = next;
        progress.step();
    }
    let mut embeddings = identity(level.vertex_count);
    if options.limit {
        let mut step = SurfaceStep::new(&level, options.scheme, options.rim);
        points = step.limit(&mut RealBlend, &points)?;
        embeddings = step.limit(&mut RowBlend, &embeddings)?;
    }
    let format = match options.fraction_bits {
        Some(fraction_bits) => Format { fraction_bits },
        None => Format::with_headroom(mesh.points.iter().chain(&points)),
    };
    let rest_cage = format.bits_of(&mesh.points, "vertex")?;
    super::require_extent(&rest_cage, format)?;
    let rest_model = format.bits_of(&points, "refined vertex")?;
    let rows = compose(&embeddings, &matrices, control.vertex_count);
    progress.stage("packing", 1);
    let material = Material {
        format,
        embeddings: &embeddings,
        matrices: &matrices,
        rows: &rows,
        cage: &mesh.points,
        rest_cage: &rest_cage,
        rest_model: &rest_model,
        composition: composition_error(&embeddings, &matrices, 0),
        random_poses: options.random_poses,
        seed: options.seed,
    };
    let (packed, formats) = choose(&material, options.request)?;
    let wanted = volume::Wanted {
        regions: &options.volumes,
        modes: &options.modes,
        centroid: options.centroid,
        points: &mesh.points,
        rest: &rest_cage,
        format,
    };
    let (of_volumes, volumes) = wanted.sections(
        |region| volume::of_surface(mesh, options.scheme, region),
        |_, combined| volume::moments_of_surface(mesh, options.scheme, combined),
    )?;
    let mut sections = [packed.sections.clone(), of_volumes].concat();
    let mut report_of_normals = None;
    if options.normals {
        let faces: Vec<Vec<u32>> = level.faces().map(<[u32]>::to_vec).collect();
        let (section, report) = normals::section(&faces, &packed.order, &rest_model)?;
        sections.push(section);
        report_of_normals = Some(report);
    }
    sections.extend(options.dynamics.sections(format, &rest_cage)?);
    let bytes = bundle::write(&Contents {
        format,
        unit: &options.unit,
        scheme: options.scheme.code(),
        boundary: options.rim.code(),
        levels: options.levels,
        control_points,
        rows: points.len(),
        sections: &sections,
        cage_checksum: bundle::surface_checksum(&control),
        model_checksum: bundle::model_checksum(&points),
    })?;
    progress.finish();
    let taps: Vec<usize> = rows.iter().map(Vec::len).collect();
    let report = SurfaceReport {
        scheme: options.scheme,
        rim: options.rim,
        levels: options.levels,
        limit: options.limit,
        unit: options.unit.clone(),
        fraction_bits: format.fraction_bits,
        control_points,
        rows: points.len(),
        faces: level.mesh().face_count(),
        taps: TapsReport::of_lengths(&taps),
        bytes: bytes.len(),
        formats,
        volumes,
        normals: report_of_normals,
    };
    Ok(BakedSurface {
        bundle: bytes,
        points,
        level,
        report,
    })
}

impl fmt::Display for SurfaceReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let step = 2.0_f64.powi(-(self.fraction_bits as i32));
        writeln!(
            f,
            "surface     {}; {} and {} after {}{}",
            count(self.control_points, "control point", "control points"),
            count(self.rows, "vertex", "vertices"),
            count(self.faces, "face", "faces"),
            count(self.levels as usize, "level", "levels"),
            if self.limit { ", in the limit" } else { "" }
        )?;
        writeln!(
            f,
            "format      {} fraction bits, one unit in the last place is {step:e} {}",
            self.fraction_bits, self.unit
        )?;
        writeln!(
            f,
            "taps        {} ({:.1} a row on average, {} at most)",
            self.taps.total, self.taps.mean, self.taps.longest
        )?;
        for volume in &self.volumes {
            volume.write(f, &self.unit)?;
        }
        let taken = self.formats.first();
        let proved = taken.map_or(0.0, |format| format.proved * step);
        write!(
            f,
            "bundle      {} bytes; proved error {proved:.3e} {}",
            self.bytes, self.unit
        )
    }
}
