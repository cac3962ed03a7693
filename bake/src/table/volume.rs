//! The enclosed volumes as sections of the bundle.

use super::Options;
use super::format::Format;
use crate::error::{Error, Result};
use crate::forms::centroid::{Combined, of_border};
use crate::forms::region::Border;
use crate::forms::solid::Enclosure;
use crate::forms::{
    ControlForm, DeviceCentroid, DeviceForm, DeviceModes, MOST_CENTROID_MODES, MOST_MODES,
    ModeMoments, ModeVolume, polyhedra, region,
};
use crate::mesh::{Point, SolidMesh};
use crate::pack::writer::Section;
use crate::refine::{BoundaryRule, Level};
use crate::surface::{SurfaceMesh, SurfaceScheme};
use octruss::bundle::{SECTION_CENTROID_MODES, SECTION_VOLUME, SECTION_VOLUME_MODES};
use std::fmt;

/// What a volume is enclosed by.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Region {
    /// The smooth boundary of the cage.
    Whole,
    /// The border of the cells with this label, which is not 0.
    Label(i32),
}

impl Region {
    /// Its number in the bundle: 0 for the whole, else the label in two's complement.
    pub fn number(self) -> u32 {
        match self {
            Self::Whole => 0,
            Self::Label(label) => label.cast_unsigned(),
        }
    }
}

/// What there is to say about a baked volume form.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct VolumeReport {
    /// The label of the region's cells; none for the whole boundary.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub label: Option<i32>,
    /// The volume at rest, in cubes of the unit.
    pub volume: f64,
    /// Where it is an extrapolation (creases, regions): how far the one before is from it.
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
    /// The same volume as a polynomial of modes, if there are any.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub modes: Option<ModesReport>,
}

/// What there is to say about a volume by modes.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct ModesReport {
    /// Number of modes.
    pub modes: usize,
    /// Coefficients.
    pub coefficients: usize,
    /// Bytes of the section.
    pub bytes: usize,
    /// How far the device's result can be from the polynomial's, for amplitudes from -1 to 1.
    pub error_bound: f64,
    /// The centroid, if it was asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub centroid: Option<CentroidReport>,
}

/// What there is to say about a centroid by modes.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct CentroidReport {
    /// The control point that the device's offsets are counted from.
    pub base: usize,
    /// The centroid at rest, in the unit.
    pub at_rest: [f64; 3],
    /// Coefficients of all axes.
    pub coefficients: usize,
    /// Bytes of the section.
    pub bytes: usize,
    /// How far the one of the level before is from it at rest, in the unit.
    pub error_estimate: f64,
    /// How far the device's result can be from the polynomials' at rest, in the unit.
    pub error_bound: f64,
}

impl VolumeReport {
    /// A line or two for people.
    pub(super) fn write(&self, f: &mut fmt::Formatter<'_>, unit: &str) -> fmt::Result {
        let cube = match unit {
            "" => String::new(),
            unit => format!("{unit}^3"),
        };
        let region = match self.label {
            None => String::new(),
            Some(label) => format!(" of label {label}"),
        };
        writeln!(
            f,
            "volume      {}{cube}{region} (estimated error {:.1e}); {} taps on {} control points, \
             {} bytes, off by at most {:.1e} on a device",
            self.volume,
            self.error_estimate,
            self.taps,
            self.control_points,
            self.bytes,
            self.error_bound
        )?;
        let Some(modes) = &self.modes else {
            return Ok(());
        };
        writeln!(
            f,
            "            in {} modes: {} coefficients, {} bytes, off by at most {:.1e} for amplitudes to 1",
            modes.modes, modes.coefficients, modes.bytes, modes.error_bound
        )?;
        let Some(centroid) = &modes.centroid else {
            return Ok(());
        };
        let [x, y, z] = centroid.at_rest;
        writeln!(
            f,
            "            centroid {x:.6} {y:.6} {z:.6}{} at rest (estimated error {:.1e}), from control point {}; \
             {} coefficients, {} bytes, off by at most {:.1e} there",
            match unit {
                "" => String::new(),
                unit => format!(" {unit}"),
            },
            centroid.error_estimate,
            centroid.base,
            centroid.coefficients,
            centroid.bytes,
            centroid.error_bound
        )
    }
}

/// What volumes are baked of, and for which modes.
pub(super) struct Wanted<'a> {
    /// The regions.
    pub regions: &'a [Region],
    /// The poses of modes at amplitude one.
    pub modes: &'a [Vec<Point>],
    /// Whether the centroids are baked for them too.
    pub centroid: bool,
    /// The control points at rest.
    pub points: &'a [Point],
    /// Their bits.
    pub rest: &'a [[i32; 3]],
    /// The format of coordinates.
    pub format: Format,
}

impl Wanted<'_> {
    /// The sections of all volumes; `forms` makes a region's form, and one that it should agree with,
    /// and `moments` its first moments, likewise.
    pub fn sections(
        &self,
        forms: impl Fn(Region) -> Result<[ControlForm; 2]>,
        moments: impl Fn(Region, &Combined) -> Result<[ModeMoments; 2]>,
    ) -> Result<(Vec<Section>, Vec<VolumeReport>)> {
        self.check_modes()?;
        let (mut sections, mut reports) = (Vec::new(), Vec::new());
        for (place, region) in self.regions.iter().enumerate() {
            if self.regions[..place].contains(region) {
                continue;
            }
            let forms = forms(*region)?;
            let (section, mut report) = self.whole(*region, &forms)?;
            sections.push(section);
            if !self.modes.is_empty() {
                let volume = ModeVolume::new(&forms[0], self.points, self.modes);
                let device = DeviceModes::new(&volume, self.format.fraction_bits);
                let (section, mut of_modes) = self.by_modes(*region, &device);
                sections.push(section);
                if self.centroid {
                    let base = forms[0].points.first().copied().unwrap_or_default();
                    let combined = Combined::new(self.points, self.modes, base);
                    let moments = moments(*region, &combined)?;
                    let (section, centroid) =
                        self.centroid(*region, &moments, (&device, report.volume))?;
                    sections.push(section);
                    of_modes.centroid = Some(centroid);
                }
                report.modes = Some(of_modes);
            }
            reports.push(report);
        }
        Ok((sections, reports))
    }

    fn check_modes(&self) -> Result<()> {
        if self.modes.len() > MOST_MODES {
            return Err(Error::new(format!(
                "{} modes are given; a volume is baked for at most {MOST_MODES}",
                self.modes.len()
            )));
        }
        let points = self.points.len();
        if self.centroid && self.modes.is_empty() {
            return Err(
                Error::new("a centroid is baked for modes, and there are none")
                    .advise("name them with --modes"),
            );
        }
        if self.centroid && self.modes.len() > MOST_CENTROID_MODES {
            return Err(Error::new(format!(
                "{} modes are given; a centroid is baked for at most {MOST_CENTROID_MODES}",
                self.modes.len()
            )));
        }
        match self.modes.iter().position(|pose| pose.len() != points) {
            None => Ok(()),
            Some(mode) => Err(Error::new(format!(
                "mode {mode} (counted from 0) has {} points, the mesh has {points}",
                self.modes[mode].len()
            ))),
        }
    }

    /// The form in the device's integers.
    fn whole(
        &self,
        region: Region,
        [form, before]: &[ControlForm; 2],
    ) -> Result<(Section, VolumeReport)> {
        let device =
            DeviceForm::new(form, self.rest).map_err(|error| Error::new(error.to_string()))?;
        let (moved, _) = crate::forms::surface::centred(self.points);
        let volume = form.volume(&moved);
        let bytes = device.section();
        let report = VolumeReport {
            label: match region {
                Region::Whole => None,
                Region::Label(label) => Some(label),
            },
            volume,
            error_estimate: (before.volume(&moved) - volume).abs(),
            control_points: device.points.len(),
            taps: device.weights.len(),
            bytes: bytes.len(),
            error_bound: device.volume_bound(device.reach(self.rest)) * self.cube(),
            modes: None,
        };
        let section = Section {
            kind: SECTION_VOLUME,
            stage: region.number(),
            bytes,
        };
        Ok((section, report))
    }

    /// The form's volume as a polynomial of modes.
    fn by_modes(&self, region: Region, device: &DeviceModes) -> (Section, ModesReport) {
        let bytes = device.section();
        let report = ModesReport {
            modes: device.modes,
            coefficients: device.coefficients.len(),
            bytes: bytes.len(),
            error_bound: device.volume_bound(1.0) * self.cube(),
            centroid: None,
        };
        let section = Section {
            kind: SECTION_VOLUME_MODES,
            stage: region.number(),
            bytes,
        };
        (section, report)
    }

    /// The first moments as polynomials of modes. A moment that is off by `e` and a volume that is off by `v`
    /// make the quotient off by `(e + |offset| v) / (volume - v)`, and it is rounded by a half.
    fn centroid(
        &self,
        region: Region,
        [moments, before]: &[ModeMoments; 2],
        (modes, volume): (&DeviceModes, f64),
    ) -> Result<(Section, CentroidReport)> {
        if volume <= 0.0 {
            return Err(Error::new("the volume at rest is not above zero")
                .advise("leave --centroid out, or turn the faces of the surface round"));
        }
        let device = DeviceCentroid::new(moments, self.format.fraction_bits, modes);
        let bytes = device.section();
        let offset =
            |moments: &ModeMoments| moments.at(&vec![0.0; moments.modes]).map(|m| m / volume);
        let (own, other) = (offset(moments), offset(before));
        let origin = self.points.get(moments.base).copied().unwrap_or_default();
        let place = 0.5_f64.powi(self.format.fraction_bits as i32);
        let largest = own.iter().fold(0.0, |largest: f64, x| largest.max(x.abs()));
        let off = modes.volume_bound(0.0) * self.cube();
        let moment = device.moment_bound(0.0) * self.cube() * place;
        let gap = |k: usize| (own[k] - other[k]).abs();
        let report = CentroidReport {
            base: moments.base,
            at_rest: [0, 1, 2].map(|k| origin[k] + own[k]),
            coefficients: device.coefficients.len(),
            bytes: bytes.len(),
            error_estimate: (0..3).map(gap).fold(0.0, f64::max),
            error_bound: (moment + largest * off) / (volume - off).max(f64::MIN_POSITIVE)
                + place / 2.0,
        };
        let section = Section {
            kind: SECTION_CENTROID_MODES,
            stage: region.number(),
            bytes,
        };
        Ok((section, report))
    }

    /// A cube of the coordinates' last place, in cubes of the unit.
    fn cube(&self) -> f64 {
        0.5_f64.powi(3 * self.format.fraction_bits as i32)
    }
}

/// The form of a cage's region, and one that it should agree with.
pub(super) fn of_cage(
    cage: &SolidMesh,
    options: &Options,
    region: Region,
) -> Result<[ControlForm; 2]> {
    let cells = |label| region::forms(cage, rules(options), label);
    if let Region::Label(label) = region {
        return cells(Some(label));
    }
    match (options.boundary.surface_scheme(), options.boundary) {
        (Some(scheme), _) => {
            Enclosure::of_cage(&Level::new(cage)?, &cage.features)?.control_forms(scheme)
        }
        (None, BoundaryRule::Fixed) => {
            let form = Enclosure::of_cage(&Level::new(cage)?, &cage.features)?.polyhedron()?;
            Ok([form.clone(), form])
        }
        (None, _) => cells(None),
    }
}

/// The first moments of a cage's region by modes, and ones that they should agree with.
pub(super) fn moments_of_cage(
    cage: &SolidMesh,
    options: &Options,
    region: Region,
    combined: &Combined,
) -> Result<[ModeMoments; 2]> {
    let label = match region {
        Region::Whole => None,
        Region::Label(label) => Some(label),
    };
    let borders = region::borders(cage, rules(options), label)?;
    extrapolated(&borders, combined, <[Point]>::to_vec)
}

fn rules(options: &Options) -> region::Rules<'_> {
    region::Rules {
        scheme: options.scheme,
        diagonals: options.diagonals.as_ref(),
        boundary: options.boundary,
    }
}

/// The limits of the moments of three successive polyhedra, of which each has a quarter of the error of the
/// one before; the second from the levels before. `own` takes the surface's points out of all.
fn extrapolated(
    borders: &[Border],
    combined: &Combined,
    own: impl Fn(&[Point]) -> Vec<Point>,
) -> Result<[ModeMoments; 2]> {
    let [first, second, third] = borders else {
        return Err(Error::new("a region is refined at least three times"));
    };
    let limit = |coarser: &Border, finer: &Border| {
        combined.moments(|points| {
            let own = own(points);
            let (coarse, fine) = (of_border(coarser, &own), of_border(finer, &own));
            [0, 1, 2].map(|k| (4.0 * fine[k] - coarse[k]) / 3.0)
        })
    };
    Ok([limit(second, third), limit(first, second)])
}

/// The form of what a control mesh's limit surface encloses, and one that it should agree with.
pub(super) fn of_surface(
    mesh: &SurfaceMesh,
    scheme: SurfaceScheme,
    region: Region,
) -> Result<[ControlForm; 2]> {
    if region != Region::Whole {
        return Err(
            Error::new("a surface has no labelled regions").advise("give --volume without a label")
        );
    }
    Enclosure::new(&mesh.faces, &mesh.features)?.control_forms(scheme)
}

/// The first moments by modes of what a control mesh's limit surface encloses, and ones that they should
/// agree with.
pub(super) fn moments_of_surface(
    mesh: &SurfaceMesh,
    scheme: SurfaceScheme,
    combined: &Combined,
) -> Result<[ModeMoments; 2]> {
    let surface = Enclosure::new(&mesh.faces, &mesh.features)?;
    if surface.has_moments(scheme) {
        let limit = surface.limit(scheme)?;
        // One number of points for the mesh and all poses: it was checked.
        let moments = combined.moments(|points| {
            let own = surface.own(points);
            limit.first_moment(&own).unwrap_or_default()
        });
        return Ok([moments.clone(), moments]);
    }
    let [first, second, third] = polyhedra::levels(mesh, scheme)?;
    let limit = |coarser: &polyhedra::Polyhedron, finer: &polyhedra::Polyhedron| {
        combined.moments(|points| finer.limit_of_first_moments(coarser, points))
    };
    Ok([limit(&second, &third), limit(&first, &second)])
}
