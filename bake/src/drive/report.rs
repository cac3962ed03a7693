//! What a run came to.

use super::mirror::Mirror;
use octruss_firmware::controller::Parts;
use octruss_firmware::link::{Faults, Telemetry};
use serde::Serialize;
use std::collections::BTreeMap;

/// The figures of a run.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Report {
    /// Ticks from the restart to the last one.
    pub ticks: u32,
    /// Records of telemetry that were compared with the controller's code on the host.
    pub compared: u64,
    /// Values that differed.
    pub mismatches: u64,
    /// The first of them.
    pub first_mismatch: Option<String>,
    /// Ticks of a replay that did not come to what the record says.
    pub not_as_recorded: u64,
    /// Ticks that the device's loop missed.
    pub missed_ticks: u32,
    /// The longest tick in microseconds.
    pub busy_us: u32,
    /// The greatest part by which the volume was off that at rest; absent if the bundle has none.
    pub volume_error: Option<f64>,
    /// The greatest distance of a coordinate of an effector from its goal, in the bundle's unit.
    pub effector_error: f64,
    /// The last one.
    pub last_effector_error: f64,
    /// Ticks on which the pose was held.
    pub held_ticks: u32,
    /// Frames that the device refused.
    pub refused: u32,
    /// Frames that came from the device and were no telemetry.
    pub spoilt: u64,
    /// Faults that the device counted, those that are not zero.
    pub faults: BTreeMap<&'static str, u32>,
}

/// Collects the figures.
pub struct Collector {
    report: Report,
    first: Option<Telemetry>,
    rest_volume: Option<i64>,
    unit: f64,
}

impl Collector {
    /// For the controller of a bundle with so many fraction bits.
    #[must_use]
    pub fn new(parts: &Parts<'_>, fraction_bits: u32) -> Self {
        let rest_volume = parts.volume.map(|_| parts.rest_volume());
        Collector {
            report: Report {
                volume_error: rest_volume.map(|_| 0.0),
                ..Report::default()
            },
            first: None,
            rest_volume,
            unit: (-f64::from(fraction_bits)).exp2(),
        }
    }

    /// The part by which a volume is off.
    #[must_use]
    pub fn volume_error(&self, volume: i64) -> Option<f64> {
        let rest = self.rest_volume.filter(|rest| *rest != 0)?;
        let off = i128::from(volume) - i128::from(rest);
        Some(off as f64 / rest as f64)
    }

    /// Raw bits in the bundle's unit.
    #[must_use]
    pub fn length(&self, bits: u32) -> f64 {
        f64::from(bits) * self.unit
    }

    /// Takes a tick's record.
    pub fn take(&mut self, record: &Telemetry) {
        let first = *self.first.get_or_insert(*record);
        let off = self.volume_error(record.volume).map(f64::abs);
        let length = self.length(record.effector_error);
        let report = &mut self.report;
        report.ticks = record.tick;
        report.missed_ticks = record.missed.saturating_sub(first.missed);
        report.busy_us = report.busy_us.max(record.busy_us);
        report.volume_error = match (report.volume_error, off) {
            (Some(greatest), Some(off)) => Some(greatest.max(off)),
            (greatest, _) => greatest,
        };
        report.effector_error = report.effector_error.max(length);
        report.last_effector_error = length;
        let refused = record.faults.refused();
        report.refused = refused.saturating_sub(first.faults.refused());
        report.held_ticks += record.flags & Telemetry::HELD;
        let counts = record
            .faults
            .values()
            .into_iter()
            .zip(first.faults.values());
        report.faults = Faults::NAMES
            .into_iter()
            .zip(counts)
            .map(|(name, (now, before))| (name, now.saturating_sub(before)))
            .filter(|(_, count)| *count != 0)
            .collect();
    }

    /// A tick of a replay was not as it was recorded.
    pub fn not_as_recorded(&mut self) {
        self.report.not_as_recorded += 1;
    }

    /// So many frames from the device were no telemetry.
    pub fn spoilt(&mut self, count: u64) {
        self.report.spoilt = count;
    }

    /// The figures, with what a mirror saw.
    #[must_use]
    pub fn finish(mut self, mirror: &Mirror<'_, '_>) -> Report {
        self.report.compared = mirror.compared();
        self.report.mismatches = mirror.mismatches();
        self.report.first_mismatch = mirror.first_mismatch().map(str::to_owned);
        self.report
    }
}

impl Report {
    /// Whether device and host agree, and a replay with its record.
    #[must_use]
    pub fn agrees(&self) -> bool {
        self.mismatches == 0 && self.not_as_recorded == 0
    }

    /// The figures in words, one a line.
    #[must_use]
    pub fn words(&self, unit: &str) -> String {
        let mut lines = vec![
            format!("ticks       {}, {} missed", self.ticks, self.missed_ticks),
            format!(
                "compared    {} records with the controller's code on this machine, {} mismatches",
                self.compared, self.mismatches
            ),
        ];
        lines.extend(
            self.first_mismatch
                .iter()
                .map(|first| format!("            {first}")),
        );
        if self.not_as_recorded != 0 {
            lines.push(format!(
                "replay      {} ticks are not as recorded",
                self.not_as_recorded
            ));
        }
        if let Some(off) = self.volume_error {
            lines.push(format!("volume      within {off:.1e} of that at rest"));
        }
        lines.push(format!(
            "effectors   at most {:.3} {unit} from a goal's coordinate, {:.6} in the end",
            self.effector_error, self.last_effector_error
        ));
        lines.push(format!("busy        at most {} us a tick", self.busy_us));
        if self.spoilt != 0 {
            lines.push(format!(
                "line        {} frames from the device were spoilt",
                self.spoilt
            ));
        }
        if self.held_ticks != 0 {
            lines.push(format!("held        on {} ticks", self.held_ticks));
        }
        for (name, count) in &self.faults {
            lines.push(format!("{name:11} {count}"));
        }
        lines.join("\n")
    }
}
