//! Applies a bundle on the host, with the device's own code.

use crate::bundle::{cage_checksum, model_checksum, surface_checksum};
use crate::error::{Error, Result, count};
use crate::mesh::{Point, SolidMesh};
use crate::read::obj::Model;
use crate::surface::{SurfaceLevel, SurfaceMesh};
use crate::table::format::Format;
use octruss::bundle::Bundle;
use octruss::deform::{CompactTable, Displacement, Table};
use std::io::Write;

/// Which of the table's two forms is applied.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, clap::ValueEnum)]
pub enum Form {
    /// Rest model plus weighted displacements: gives the rest model to the bit at rest
    #[default]
    Displacement,
    /// Weighted positions alone
    Absolute,
}

/// A deformed model.
#[derive(Clone, Debug, PartialEq)]
pub struct Deformed {
    /// The device's bits, a point for each vertex of the model.
    pub bits: Vec<[i32; 3]>,
    /// How many coordinates did not fit and were clamped to the end of their range.
    pub saturated: u32,
}

/// The coordinate format of a bundle.
pub fn format_of(bundle: &Bundle<'_>) -> Format {
    Format {
        fraction_bits: bundle.header().fraction_bits.get(),
    }
}

/// Applies the table to a pose in raw bits, a point for each control point.
///
/// # Errors
/// If the pose has another number of points than the bundle's cage, or the absolute form of a table for
/// 16-bit displacements is asked for, which has none.
pub fn deform(bundle: &Bundle<'_>, pose: &[[i32; 3]], form: Form) -> Result<Deformed> {
    let rows = deform_rows(bundle, pose, form)?;
    let mut bits = vec![[0; 3]; rows.bits.len()];
    for (row, point) in bundle.model_points().iter().enumerate() {
        bits[point] = rows.bits[row];
    }
    Ok(Deformed { bits, ..rows })
}

/// As [`deform`], with the points in the order of the table's rows, as a device computes them.
///
/// # Errors
/// Those of [`deform`].
pub fn deform_rows(bundle: &Bundle<'_>, pose: &[[i32; 3]], form: Form) -> Result<Deformed> {
    // Raw bits fit every format.
    if let Ok(table) = bundle.table::<i32>() {
        return wide(&table, pose, form);
    }
    if let Ok([first, second]) = bundle.factored_table::<i32>() {
        let refined = wide(&first, pose, form)?;
        return wide(&second, &refined.bits, form).map(|deformed| deformed.and(&refined));
    }
    if form == Form::Absolute {
        return Err(Error::new(
            "a table for 16-bit displacements has no absolute form",
        ));
    }
    if let Ok([first, second]) = bundle.compact_factored_table::<i32>() {
        let refined = compact(&first, pose)?;
        return compact(&second, &refined.bits).map(|deformed| deformed.and(&refined));
    }
    let table = bundle
        .compact_table::<i32>()
        .map_err(|error| failed(&error))?;
    compact(&table, pose)
}

impl Deformed {
    fn and(self, before: &Self) -> Self {
        let saturated = self.saturated.saturating_add(before.saturated);
        Self { saturated, ..self }
    }
}

fn failed(error: &dyn std::error::Error) -> Error {
    Error::new(error.to_string())
}

fn wide(table: &Table<'_, i32>, pose: &[[i32; 3]], form: Form) -> Result<Deformed> {
    let mut bits = vec![[0; 3]; table.rows()];
    let applied = match form {
        Form::Displacement => table.apply(0..table.rows(), pose, &mut bits),
        Form::Absolute => table.apply_absolute(0..table.rows(), pose, &mut bits),
    };
    let saturated = applied.map_err(|error| failed(&error))?;
    Ok(Deformed { bits, saturated })
}

fn compact(table: &CompactTable<'_, i32>, pose: &[[i32; 3]]) -> Result<Deformed> {
    let mut memory = vec![Displacement::default(); table.control_points()];
    let displacements = table
        .displacements(pose, &mut memory)
        .map_err(|error| failed(&error))?;
    let mut bits = vec![[0; 3]; table.rows()];
    let saturated = table
        .apply(0..table.rows(), &displacements, &mut bits)
        .map_err(|error| failed(&error))?;
    let saturated = saturated.saturating_add(displacements.saturated());
    Ok(Deformed { bits, saturated })
}

/// The bits of a pose in the bundle's format.
///
/// # Errors
/// If a coordinate does not fit the format, or the number of points is not that of the cage.
pub fn pose_bits(bundle: &Bundle<'_>, pose: &[Point]) -> Result<Vec<[i32; 3]>> {
    if pose.len() != bundle.rest_cage().len() {
        return Err(Error::new(format!(
            "the pose has {} points, the bundle's cage has {}",
            pose.len(),
            bundle.rest_cage().len()
        ))
        .advise("pose the cage that the bundle was baked from"));
    }
    format_of(bundle).bits_of(pose, "point")
}

/// Error unless the mesh has the connectivity of the cage that the bundle was baked from.
pub fn require_cage(bundle: &Bundle<'_>, mesh: &SolidMesh) -> Result<()> {
    if cage_checksum(mesh.points.len(), &mesh.cells) == bundle.header().cage_checksum.get() {
        return Ok(());
    }
    let control_points = bundle.rest_cage().len();
    let difference = match mesh.points.len() == control_points {
        true => ": its cells are others, or in another order",
        false => "",
    };
    Err(Error::new(format!(
        "the mesh ({}, {}) has not the connectivity of the cage that the bundle was baked from ({}){difference}",
        count(mesh.points.len(), "vertex", "vertices"),
        count(mesh.cells.len(), "cell", "cells"),
        count(control_points, "vertex", "vertices"),
    ))
    .advise("a pose is the cage itself with its vertices moved: same vertices, same cells, same order"))
}

/// True if the bundle was baked from a control mesh of a surface.
pub fn is_of_surface(bundle: &Bundle<'_>) -> bool {
    bundle.header().scheme.get() >= octruss::bundle::SCHEME_LOOP
}

/// Error unless the control mesh has the connectivity of the one that the bundle was baked from.
pub fn require_control_mesh(bundle: &Bundle<'_>, mesh: &SurfaceMesh) -> Result<()> {
    let level = SurfaceLevel::new(mesh)?;
    if surface_checksum(&level) == bundle.header().cage_checksum.get() {
        return Ok(());
    }
    Err(Error::new(format!(
        "the mesh ({}, {}) has not the connectivity of the control mesh that the bundle was baked from ({})",
        count(mesh.points.len(), "vertex", "vertices"),
        count(mesh.faces.len(), "face", "faces"),
        count(bundle.rest_cage().len(), "vertex", "vertices")
    ))
    .advise("a pose is the control mesh itself with its vertices moved: same vertices, same faces, same order"))
}

/// Error unless the model is the one that the bundle was baked for, at rest.
pub fn require_model(bundle: &Bundle<'_>, model: &Model) -> Result<()> {
    if model_checksum(&model.points) == bundle.header().model_checksum.get() {
        return Ok(());
    }
    let rows = bundle.header().rows.get();
    let what = if usize::try_from(rows).is_ok_and(|rows| rows == model.points.len()) {
        format!("its {rows} vertices stand elsewhere")
    } else {
        format!(
            "it has {}, the bundle has {rows} rows",
            count(model.points.len(), "vertex", "vertices")
        )
    };
    Err(Error::new(format!(
        "this is not the model that the bundle was baked for: {what}"
    ))
    .advise("give the model that was baked, at rest, or bake again"))
}

/// Writes raw poses for firmware: for each frame and each control point x, y and z as 32-bit
/// integers in the bundle's format, least significant byte first, nothing before, between or after.
pub fn write_poses(frames: &[Vec<[i32; 3]>], out: &mut dyn Write) -> Result<()> {
    for coordinate in frames.iter().flatten().flatten() {
        out.write_all(&coordinate.to_le_bytes())
            .map_err(crate::write::failed)?;
    }
    Ok(())
}
