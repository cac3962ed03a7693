//! How an image ends: a marker in the log and an exit code, the same words for image and host.
//!
//! An emulator that dies, or an image that runs off into nowhere, must never look like success.
//! So a run has passed only if the last message is [`END_MARKER`] *and* the exit code is that of
//! [`Ending::Finished`].

/// The message that an image logs when it has done all its work.
pub const END_MARKER: &str = "octruss: the image has finished";

/// Why an image stopped, as the exit code that semihosting hands to the host.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum Ending {
    /// All work is done.
    Finished = 0,
    /// A panic; the log names its place.
    Panicked = 101,
    /// A processor fault or an interrupt nobody handles; the log gives the registers.
    Faulted = 102,
    /// The stack reached the end of its space.
    StackOverflowed = 103,
    /// The image met a state it cannot go on from, such as a missing file; the log says which.
    Refused = 104,
}

impl Ending {
    /// The ending that an exit code stands for, if it is one of ours.
    #[must_use]
    pub fn from_code(code: i32) -> Option<Ending> {
        let all = [
            Ending::Finished,
            Ending::Panicked,
            Ending::Faulted,
            Ending::StackOverflowed,
            Ending::Refused,
        ];
        all.into_iter()
            .find(|ending| i32::from(*ending as u8) == code)
    }

    /// A sentence without a full stop for people.
    #[must_use]
    pub fn describe(self) -> &'static str {
        match self {
            Ending::Finished => "the image finished",
            Ending::Panicked => "the image panicked",
            Ending::Faulted => "the processor faulted",
            Ending::StackOverflowed => "the stack overflowed",
            Ending::Refused => "the image gave up",
        }
    }
}

/// The word that starts the message of a figure.
const FIGURE: &str = "figure ";

/// Reads a message that `figure` logged: the figure's name and value.
#[must_use]
pub fn parse_figure(message: &str) -> Option<(&str, u64)> {
    let (name, value) = message.strip_prefix(FIGURE)?.rsplit_once(' ')?;
    Some((name, value.parse().ok()?))
}

/// Logs a figure in a form that the host can read ([`parse_figure`]). The name may have spaces
/// and says the unit.
#[cfg(target_os = "none")]
pub fn figure(name: &str, value: u32) {
    defmt::info!("{=str}{=str} {=u32}", FIGURE, name, value);
}

/// Ends the image: checks that the stack never came near the end of its space, logs the marker, exits.
#[cfg(target_os = "none")]
pub fn finish() -> ! {
    if crate::stack::bytes_never_used() < crate::stack::RED_ZONE_BYTES {
        defmt::error!("the stack used its space up and may have overwritten statics");
        stop(Ending::StackOverflowed)
    }
    defmt::info!("{=str}", END_MARKER);
    stop(Ending::Finished)
}

/// Ends the image at once with the exit code of `ending`, and says nothing.
#[cfg(target_os = "none")]
pub fn stop(ending: Ending) -> ! {
    semihosting::process::exit(i32::from(ending as u8))
}

#[cfg(test)]
mod tests {
    use super::{Ending, parse_figure};

    #[test]
    fn exit_codes_name_their_ending() {
        assert_eq!(Ending::from_code(0), Some(Ending::Finished));
        assert_eq!(Ending::from_code(103), Some(Ending::StackOverflowed));
        assert_eq!(Ending::from_code(1), None);
    }

    #[test]
    fn a_figure_is_read_back() {
        let message = "figure instructions a frame 1750000";
        assert_eq!(
            parse_figure(message),
            Some(("instructions a frame", 1_750_000))
        );
        assert_eq!(parse_figure("figure without value"), None);
        assert_eq!(parse_figure("a message 3"), None);
    }
}
