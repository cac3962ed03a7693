//! The enclosed volume as a section of the bundle.

use super::format::Format;
use crate::error::{Error, Result};
use crate::forms::solid::Enclosure;
use crate::forms::{DeviceForm, Scheme};
use crate::mesh::SolidMesh;
use crate::pack::writer::Section;
use crate::refine::{BoundaryRule, Level};
use octruss::bundle::SECTION_VOLUME;

/// What there is to say about a baked volume form.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct VolumeReport {
    /// The volume at rest, in cubes of the unit.
    pub volume: f64,
    /// Where creases make it an extrapolation: how far the one before is from it.
    pub error_estimate: f64,
    /// Control points that it depends on.
    pub control_points: usize,
    /// Weights.
    pub taps: usize,
    /// Bytes of the section.
    pub bytes: usize,
    /// How far the device's result can be from the form's, for poses that are no larger than the cage
    /// at rest along any axis.
    pub error_bound: f64,
}

/// The form of the volume that the cage's smooth boundary encloses.
pub(super) fn section(
    cage: &SolidMesh,
    boundary: BoundaryRule,
    format: Format,
    rest: &[[i32; 3]],
) -> Result<(Section, VolumeReport)> {
    let scheme = match boundary {
        BoundaryRule::Loop => Scheme::Loop,
        BoundaryRule::LoopWarren => Scheme::LoopWarren,
        _ => {
            return Err(
                Error::new("the enclosed volume of this boundary rule has no form")
                    .advise("bake --volume with --boundary loop or loop-warren"),
            );
        }
    };
    let level = Level::new(cage)?;
    level.require_bare_boundary()?;
    let faces = level.boundary().iter().map(|face| face.to_vec());
    let surface = Enclosure::new(&faces.collect::<Vec<_>>(), &cage.features)?;
    let [form, before] = surface.control_forms(scheme)?;
    let device = DeviceForm::new(&form, rest).map_err(|error| Error::new(error.to_string()))?;
    let (moved, _) = crate::forms::surface::centred(&cage.points);
    let volume = form.volume(&moved);
    let cube = 0.5_f64.powi(3 * format.fraction_bits as i32);
    let bytes = device.section();
    let report = VolumeReport {
        volume,
        error_estimate: (before.volume(&moved) - volume).abs(),
        control_points: device.points.len(),
        taps: device.weights.len(),
        bytes: bytes.len(),
        error_bound: device.volume_bound(device.reach(rest)) * cube,
    };
    let section = Section {
        kind: SECTION_VOLUME,
        stage: 0,
        bytes,
    };
    Ok((section, report))
}
