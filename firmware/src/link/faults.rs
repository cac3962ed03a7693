//! What was refused.

/// Counters of everything that went wrong on the line, since the start. They stop at their greatest value.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Faults {
    /// Frames that ended early.
    pub truncated: u32,
    /// Frames whose checksum does not match.
    pub checksum: u32,
    /// Frames longer than any frame may be.
    pub oversize: u32,
    /// Sound frames with an unknown command or a wrong body.
    pub unknown: u32,
    /// Frames with the sequence number of the last one.
    pub repeated: u32,
    /// Frames with a sequence number that has passed.
    pub out_of_order: u32,
    /// Sequence numbers that were left out before an accepted frame.
    pub skipped: u32,
    /// Frames beyond those that a tick takes, or that wait already.
    pub flood: u32,
    /// Bytes that the full ring lost.
    pub overrun: u32,
    /// Accepted commands that name what the controller has not: an effector, a channel, a tick that has passed.
    pub rejected: u32,
    /// How often the host was silent for too long.
    pub silence: u32,
}

impl Faults {
    /// How many counters there are.
    pub const COUNT: usize = 11;

    /// Their names, in the order of [`values`](Faults::values).
    pub const NAMES: [&'static str; Self::COUNT] = [
        "truncated",
        "checksum",
        "oversize",
        "unknown",
        "repeated",
        "out of order",
        "skipped",
        "flood",
        "overrun",
        "rejected",
        "silence",
    ];

    /// The counters in the order in which telemetry carries them.
    #[must_use]
    pub fn values(&self) -> [u32; Self::COUNT] {
        [
            self.truncated,
            self.checksum,
            self.oversize,
            self.unknown,
            self.repeated,
            self.out_of_order,
            self.skipped,
            self.flood,
            self.overrun,
            self.rejected,
            self.silence,
        ]
    }

    /// The counters out of their values.
    #[must_use]
    pub fn from_values(values: [u32; Self::COUNT]) -> Self {
        let [
            truncated,
            checksum,
            oversize,
            unknown,
            repeated,
            out_of_order,
            ..,
        ] = values;
        let [.., skipped, flood, overrun, rejected, silence] = values;
        Faults {
            truncated,
            checksum,
            oversize,
            unknown,
            repeated,
            out_of_order,
            skipped,
            flood,
            overrun,
            rejected,
            silence,
        }
    }

    /// Frames that were refused.
    #[must_use]
    pub fn refused(&self) -> u32 {
        [
            self.truncated,
            self.checksum,
            self.oversize,
            self.unknown,
            self.repeated,
            self.out_of_order,
            self.flood,
        ]
        .iter()
        .fold(0, |sum: u32, count| sum.saturating_add(*count))
    }
}

/// Adds one.
pub(super) fn count(counter: &mut u32) {
    *counter = counter.saturating_add(1);
}
