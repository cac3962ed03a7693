//! Solvers for goals as sections of the bundle: `H = J'WJ` and `A = J'W` in the device's integers.

use super::format::Format;
use crate::error::{Error, Result};
use crate::mesh::Point;
use crate::pack::writer::Section;
use crate::refine::rows::Row;
use octruss::bundle::{SECTION_ACTUATION, SECTION_INVERSE};
use octruss::control::actuation::{ActuationRecord, DISPLACEMENT_LIMIT};
use octruss::control::inverse::{
    GAIN_LIMIT, HESSIAN_LIMIT, Inverse, InverseRecord, LEAST_CURVATURE, MOST_ACTUATORS,
    MOST_EFFECTORS, reciprocal,
};
use std::fmt;
use zerocopy::IntoBytes;

/// Differences of goals are at most this on a device.
const DIFFERENCE_LIMIT: f64 = 1_073_741_824.0;
/// An amplitude of one.
const ONE: f64 = 1_073_741_824.0;
/// Below this part of a mode's displacement that no mode before it has, modes are called dependent.
const DEPENDENT: f64 = 1e-2;

/// How an actuator may move.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Actuator {
    /// Its least amplitude, above -2.
    pub lower: f64,
    /// Its greatest amplitude, below 2.
    pub upper: f64,
    /// How far it moves in a tick at most; infinite for no limit.
    pub rate: f64,
}

/// A point of the model that has goals, or is measured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Effector {
    /// The point, counted from 0.
    pub point: usize,
    /// What the square of its distance to its goal weighs.
    pub weight: f64,
}

/// The solvers that are baked, over the modes of [`super::Options::modes`].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Solvers {
    /// One for each mode.
    pub actuators: Vec<Actuator>,
    /// Points with goals; none for no such solver.
    pub effectors: Vec<Effector>,
    /// Points that are measured; none for no such solver.
    pub sensors: Vec<Effector>,
    /// What the square of an amplitude costs, as a part of the largest diagonal element of `J'WJ`.
    pub damping: f64,
}

/// What there is to say about a baked solver.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct SolverReport {
    /// Whether its points are measured.
    pub sensors: bool,
    /// Actuators.
    pub actuators: usize,
    /// Effectors or sensors.
    pub points: usize,
    /// Bytes of the section.
    pub bytes: usize,
    /// The smallest part of a mode's displacement of the points that no mode before it has.
    pub least_independence: f64,
    /// The mode that it is the part of.
    pub most_dependent: usize,
}

impl SolverReport {
    /// A line for people.
    pub(super) fn write(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let what = if self.sensors { "sensors" } else { "effectors" };
        writeln!(
            f,
            "inverse     {} actuators, {} {what}, {} bytes; mode {} is the least independent: {:.1e} of it is its own",
            self.actuators, self.points, self.bytes, self.most_dependent, self.least_independence
        )
    }

    /// Whether the points cannot tell the modes apart.
    #[must_use]
    pub fn is_dependent(&self) -> bool {
        self.least_independence < DEPENDENT
    }
}

/// What solvers are baked of.
pub(super) struct Wanted<'a> {
    pub solvers: &'a Solvers,
    pub modes: &'a [Vec<Point>],
    pub cage: &'a [Point],
    /// The real weights of every model point.
    pub rows: &'a [Row],
    pub rest_model: &'a [[i32; 3]],
    /// The model's point of each of the table's rows.
    pub order: &'a [usize],
    pub format: Format,
}

impl Wanted<'_> {
    /// The sections: solvers, stage 0 for effectors and stage 1 for sensors, and the actuators' displacements.
    pub fn sections(&self) -> Result<(Vec<Section>, Vec<SolverReport>)> {
        let Solvers {
            effectors, sensors, ..
        } = self.solvers;
        let (mut sections, mut reports) = (Vec::new(), Vec::new());
        for (stage, points) in [(0, effectors), (1, sensors)] {
            if !points.is_empty() {
                let (bytes, report) = self.solver(points, stage == 1)?;
                reports.push(report);
                sections.push(Section {
                    kind: SECTION_INVERSE,
                    stage,
                    bytes,
                });
            }
        }
        if !sections.is_empty() {
            sections.push(self.actuation()?);
        }
        Ok((sections, reports))
    }

    /// How far every actuator moves every control point at amplitude one, each rounded once, and the rows of the
    /// effectors.
    fn actuation(&self) -> Result<Section> {
        let mut displacements = Vec::with_capacity(3 * self.cage.len() * self.modes.len());
        for (point, rest) in self.cage.iter().enumerate() {
            for axis in 0..3 {
                let ways = self
                    .modes
                    .iter()
                    .map(|mode| ((mode[point][axis] - rest[axis]) / self.format.unit()).round());
                let ways: Vec<f64> = ways.collect();
                let sum: f64 = ways.iter().map(|way| way.abs()).sum();
                if sum > DISPLACEMENT_LIMIT as f64 {
                    return Err(Error::new(format!(
                        "the modes together displace control point {point} (counted from 0) too far for the device's sums"
                    ))
                    .advise("take fewer --fraction-bits, or smaller modes"));
                }
                displacements.extend(ways.iter().map(|&way| way as i32));
            }
        }
        let effectors = &self.solvers.effectors;
        let row = |own: &Effector| self.order.iter().position(|&point| point == own.point);
        let rows: Option<Vec<u32>> = effectors
            .iter()
            .map(|own| row(own).and_then(|row| u32::try_from(row).ok()))
            .collect();
        let rows = rows.ok_or_else(|| Error::new("an effector is no point of the model"))?;
        let record = ActuationRecord {
            control_points: (self.cage.len() as u32).into(),
            actuators: (self.modes.len() as u32).into(),
            effectors: (rows.len() as u32).into(),
            reserved: [0; 4],
        };
        Ok(Section {
            kind: SECTION_ACTUATION,
            stage: 0,
            bytes: [record.as_bytes(), displacements.as_bytes(), rows.as_bytes()].concat(),
        })
    }

    fn solver(&self, points: &[Effector], sensors: bool) -> Result<(Vec<u8>, SolverReport)> {
        let actuators = self.modes.len();
        if actuators == 0 || actuators > MOST_ACTUATORS || points.len() > MOST_EFFECTORS {
            return Err(Error::new(format!(
                "{actuators} modes and {} points are given; a solver takes 1 to {MOST_ACTUATORS} modes and up to {MOST_EFFECTORS} points",
                points.len()
            )));
        }
        if self.solvers.actuators.len() != actuators {
            return Err(Error::new(format!(
                "{} actuators are given for {actuators} modes",
                self.solvers.actuators.len()
            )));
        }
        let columns: Vec<Vec<f64>> = self
            .modes
            .iter()
            .map(|mode| self.column(mode, points))
            .collect();
        let numbers = Numbers::new(&columns, points, self.solvers.damping, self.format)?;
        let rest: Vec<[i32; 3]> = points
            .iter()
            .map(|own| self.rest_model[own.point])
            .collect();
        let record = InverseRecord {
            actuators: (actuators as u32).into(),
            effectors: (points.len() as u32).into(),
            difference_shift: numbers.difference_shift.into(),
            gain_shift: numbers.gain_shift.into(),
        };
        let diagonal = numbers.hessian.iter().step_by(actuators + 1);
        let reciprocals: Vec<i32> = diagonal.map(|&own| reciprocal(own)).collect();
        let amplitudes = |value: fn(&Actuator) -> f64| -> Vec<i32> {
            let scaled =
                |own: &Actuator| (value(own) * ONE).round().min(f64::from(i32::MAX)) as i32;
            self.solvers.actuators.iter().map(scaled).collect()
        };
        let bytes = [
            record.as_bytes(),
            numbers.hessian.as_bytes(),
            reciprocals.as_bytes(),
            numbers.gains.as_bytes(),
            rest.as_bytes(),
            amplitudes(|own| own.lower).as_bytes(),
            amplitudes(|own| own.upper).as_bytes(),
            amplitudes(|own| own.rate).as_bytes(),
        ]
        .concat();
        let (most_dependent, least_independence) = independence(&columns, points);
        let report = SolverReport {
            sensors,
            actuators,
            points: points.len(),
            bytes: bytes.len(),
            least_independence,
            most_dependent,
        };
        Ok((bytes, report))
    }

    /// How far a mode at amplitude one moves each axis of the points.
    fn column(&self, mode: &[Point], points: &[Effector]) -> Vec<f64> {
        let moved = |own: &Effector| {
            let mut sum = [0.0; 3];
            for &(column, weight) in &self.rows[own.point] {
                let (to, from) = (mode[column as usize], self.cage[column as usize]);
                for axis in 0..3 {
                    sum[axis] += weight * (to[axis] - from[axis]);
                }
            }
            sum
        };
        points.iter().flat_map(moved).collect()
    }
}

/// A solver's real numbers in the device's integers, each rounded once.
struct Numbers {
    hessian: Vec<i32>,
    gains: Vec<i32>,
    difference_shift: u32,
    gain_shift: i32,
}

impl Numbers {
    /// `H` is scaled so that its largest row just fits. Differences are rounded so that four times the farthest that
    /// any axis moves with all amplitudes at one fits; gains take what is left of their range.
    fn new(
        columns: &[Vec<f64>],
        points: &[Effector],
        damping: f64,
        format: Format,
    ) -> Result<Self> {
        let actuators = columns.len();
        let mut hessian: Vec<Vec<f64>> = columns
            .iter()
            .map(|a| columns.iter().map(|b| product(a, b, points)).collect())
            .collect();
        let greatest = (0..actuators)
            .map(|own| hessian[own][own])
            .fold(0.0, f64::max);
        if greatest == 0.0 {
            return Err(Error::new("no mode moves any of the points")
                .advise("take other points, or modes that move control points near them"));
        }
        for (place, row) in hessian.iter_mut().enumerate() {
            row[place] += greatest * damping;
        }
        let scale = (HESSIAN_LIMIT as f64 - actuators as f64) / greatest_sum(hessian.iter());
        let least = (0..actuators).min_by(|&a, &b| hessian[a][a].total_cmp(&hessian[b][b]));
        let least = least.unwrap_or_default();
        if hessian[least][least] * scale < f64::from(LEAST_CURVATURE) {
            return Err(Error::new(format!(
                "mode {least} (counted from 0) moves the points too little beside the others"
            ))
            .advise("scale it up, leave it out, or give more --damping"));
        }
        let axes = 3 * points.len();
        let reach = (0..axes).map(|axis| columns.iter().map(|own| own[axis].abs()).sum::<f64>());
        let reach = 4.0 * reach.fold(0.0, f64::max) / format.unit();
        let difference_shift = (reach / DIFFERENCE_LIMIT).log2().ceil().max(0.0);
        // A force is H times an amplitude with 30 fraction bits, the difference is in units of the last place.
        let unit = scale * ONE * format.unit() * difference_shift.exp2();
        let gains: Vec<Vec<f64>> = columns
            .iter()
            .map(|column| {
                let weighted = column.iter().enumerate();
                weighted
                    .map(|(axis, own)| points[axis / 3].weight * own * unit)
                    .collect()
            })
            .collect();
        let room = GAIN_LIMIT as f64 - axes as f64;
        let gain_shift = (greatest_sum(gains.iter()) / room).log2().ceil();
        if difference_shift > 31.0 || gain_shift.abs() > 31.0 {
            return Err(Error::new(
                "the displacements of the points do not fit the device's numbers",
            )
            .advise("take fewer or more --fraction-bits"));
        }
        let part = (-gain_shift).exp2();
        Ok(Self {
            hessian: hessian
                .iter()
                .flatten()
                .map(|own| (own * scale).round() as i32)
                .collect(),
            gains: gains
                .iter()
                .flatten()
                .map(|own| (own * part).round() as i32)
                .collect(),
            difference_shift: difference_shift as u32,
            gain_shift: gain_shift as i32,
        })
    }
}

/// The greatest sum of magnitudes of a row.
fn greatest_sum<'a>(rows: impl Iterator<Item = &'a Vec<f64>>) -> f64 {
    rows.map(|row| row.iter().map(|own| own.abs()).sum())
        .fold(0.0, f64::max)
}

/// The weighted product of two modes' displacements.
fn product(a: &[f64], b: &[f64], points: &[Effector]) -> f64 {
    let pairs = a.iter().zip(b).enumerate();
    pairs
        .map(|(axis, (a, b))| points[axis / 3].weight * a * b)
        .sum()
}

/// The mode whose displacement is most of all a combination of those before it, and what part of it is its own.
fn independence(columns: &[Vec<f64>], points: &[Effector]) -> (usize, f64) {
    let mut own: Vec<Vec<f64>> = Vec::new();
    let mut least = (0, 1.0);
    for (mode, column) in columns.iter().enumerate() {
        let mut left = column.clone();
        // Twice is enough for Gram and Schmidt.
        for _ in 0..2 {
            for before in &own {
                let square = product(before, before, points);
                if square > 0.0 {
                    let part = product(&left, before, points) / square;
                    left.iter_mut()
                        .zip(before)
                        .for_each(|(left, before)| *left -= part * before);
                }
            }
        }
        let whole = product(column, column, points);
        let part = if whole > 0.0 {
            (product(&left, &left, points) / whole).sqrt()
        } else {
            0.0
        };
        if part < least.1 {
            least = (mode, part);
        }
        own.push(left);
    }
    least
}

/// Opens a section as a device does.
///
/// # Errors
/// If the device would refuse it.
pub fn open(bytes: &[u8]) -> Result<Inverse<'_>> {
    Inverse::from_section(bytes).map_err(|error| Error::new(error.to_string()))
}
