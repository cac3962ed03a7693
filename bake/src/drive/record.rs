//! Runs as files.
//!
//! A record is a `.csv` file, one line a tick from the restart on: `tick`, `commands` (the payloads that took effect
//! before it, without their headers, as hexadecimal digits with a space between two), `pose` and `model` (the checksums
//! that came out), `volume`. A comment in front of it names the bundle by its checksum.

use crate::error::{Error, Result};
use crate::read::bytes;
use crate::write::atomically;
use octruss::bundle::Bundle;
use octruss_firmware::controller::Moved;
use octruss_firmware::link::{Command, Header, Telemetry};
use std::fmt::Write as _;
use std::path::Path;

/// Bytes of a payload's header.
const HEADER_BYTES: usize = 6;
const COLUMNS: [&str; 5] = ["tick", "commands", "pose", "model", "volume"];
const TITLE: &str = "# octruss run, bundle ";

/// One tick of a run.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Line {
    /// The tick.
    pub tick: u32,
    /// What took effect at its start.
    pub commands: Vec<Command>,
    /// CRC-32 of the pose.
    pub pose: u32,
    /// CRC-32 of the deformed model.
    pub model: u32,
    /// The volume.
    pub volume: i64,
}

impl Line {
    /// What a record of telemetry says.
    #[must_use]
    pub fn of(record: &Telemetry, commands: Vec<Command>) -> Self {
        Line {
            tick: record.tick,
            commands,
            pose: record.pose_hash,
            model: record.skin_hash,
            volume: record.volume,
        }
    }

    /// Whether a tick of the controller came to the same.
    #[must_use]
    pub fn is_like(&self, moved: &Moved) -> bool {
        (self.pose, self.model, self.volume) == (moved.pose_hash, moved.skin_hash, moved.volume)
    }
}

/// Writes a run.
///
/// # Errors
/// If the file cannot be written.
pub fn write(file: &Path, bundle: &Bundle<'_>, lines: &[Line]) -> Result<()> {
    let mut text = format!("{TITLE}{:08x}\n", bundle.header().checksum.get());
    // Writing to a string cannot fail.
    let _ = writeln!(text, "{}", COLUMNS.join(","));
    for line in lines {
        let commands: Vec<String> = line.commands.iter().map(digits).collect();
        let _ = writeln!(
            text,
            "{},{},{:08x},{:08x},{}",
            line.tick,
            commands.join(" "),
            line.pose,
            line.model,
            line.volume
        );
    }
    atomically(file, |out| {
        out.write_all(text.as_bytes())
            .map_err(|error| Error::new(error.to_string()))
    })
}

/// Reads a run.
///
/// # Errors
/// If the file cannot be read, is no record, or is that of another bundle.
pub fn read(file: &Path, bundle: &Bundle<'_>) -> Result<Vec<Line>> {
    let text = bytes(file)?;
    parse(&text, bundle.header().checksum.get()).map_err(|error| error.in_file(file))
}

fn parse(text: &[u8], checksum: u32) -> Result<Vec<Line>> {
    let no_record = || {
        Error::new("this is no recorded run")
            .advise("give a file that `octruss drive --record` has written")
    };
    let text = std::str::from_utf8(text).map_err(|_| no_record())?;
    let title = text
        .lines()
        .next()
        .and_then(|line| line.strip_prefix(TITLE));
    let bundle = title.and_then(|digits| u32::from_str_radix(digits.trim(), 16).ok());
    if bundle.ok_or_else(no_record)? != checksum {
        return Err(
            Error::new("the run was recorded with another bundle").advise("give that bundle")
        );
    }
    let mut reader = csv::ReaderBuilder::new()
        .comment(Some(b'#'))
        .from_reader(text.as_bytes());
    let columns = reader.headers().map_err(|_| no_record())?;
    if *columns != COLUMNS[..] {
        return Err(no_record());
    }
    let mut lines = Vec::new();
    for (row, record) in reader.records().enumerate() {
        // The title and the columns' names come before.
        let place = row + 3;
        let record =
            record.map_err(|error| Error::new(format!("the line cannot be read: {error}")))?;
        let line = read_line(&record)
            .ok_or_else(|| Error::new("the line is no tick of a recorded run").at_line(place))?;
        if usize::try_from(line.tick) != Ok(lines.len()) {
            return Err(Error::new(format!(
                "the line is that of tick {}, and tick {} is expected",
                line.tick,
                lines.len()
            ))
            .at_line(place)
            .advise("record the run again; telemetry of every tick is needed"));
        }
        lines.push(line);
    }
    Ok(lines)
}

fn read_line(record: &csv::StringRecord) -> Option<Line> {
    let hash = |column: usize| u32::from_str_radix(record.get(column)?, 16).ok();
    let commands = record.get(1)?.split_whitespace().map(command);
    Some(Line {
        tick: record.get(0)?.parse().ok()?,
        commands: commands.collect::<Option<_>>()?,
        pose: hash(2)?,
        model: hash(3)?,
        volume: record.get(4)?.parse().ok()?,
    })
}

/// A command's body as hexadecimal digits.
fn digits(command: &Command) -> String {
    let payload = command.payload(Header::default());
    let mut text = String::new();
    for byte in payload.iter().skip(HEADER_BYTES) {
        let _ = write!(text, "{byte:02x}");
    }
    text
}

fn command(digits: &str) -> Option<Command> {
    if !digits.is_ascii() || !digits.len().is_multiple_of(2) {
        return None;
    }
    let bytes = (0..digits.len()).step_by(2);
    let bytes = bytes.map(|at| u8::from_str_radix(&digits[at..at + 2], 16).ok());
    let mut payload = vec![0; HEADER_BYTES];
    payload.extend(bytes.collect::<Option<Vec<u8>>>()?);
    Command::read(&payload).ok().map(|(_, command)| command)
}

#[cfg(test)]
mod tests {
    use super::{command, digits, parse};
    use octruss_firmware::link::{Command, Goal};

    #[test]
    fn commands_are_read_back() {
        let goals = Command::Goals(
            [Goal {
                effector: 3,
                place: [-1, 2, i32::MIN],
            }]
            .into_iter()
            .collect(),
        );
        for own in [goals, Command::Hold, Command::Restart] {
            assert_eq!(command(&digits(&own)), Some(own));
        }
        // The table of docs/protocol.md: the command's number, then its body.
        assert_eq!(digits(&Command::Hold), "03");
        assert_eq!(command("3"), None);
        assert_eq!(command("ff"), None);
        assert_eq!(command("\u{e4}"), None);
    }

    #[test]
    fn wrong_records_are_refused_with_their_line() {
        let title = "# octruss run, bundle 0000002a\n";
        let head = "tick,commands,pose,model,volume\n";
        let whole = format!("{title}{head}0,06,00000001,00000002,-3\n1,,00000001,00000002,-3\n");
        let lines = parse(whole.as_bytes(), 42).unwrap();
        assert_eq!((lines.len(), lines[1].volume), (2, -3));
        assert_eq!(lines[0].commands, [Command::Restart]);
        let other = parse(whole.as_bytes(), 43).unwrap_err().to_string();
        assert!(other.contains("another bundle"), "{other}");
        for (text, message) in [
            ("", "no recorded run"),
            ("# octruss run, bundle 0000002a\nx\n", "no recorded run"),
        ] {
            let error = parse(text.as_bytes(), 42).unwrap_err().to_string();
            assert!(error.contains(message), "{error}");
        }
        let gap = whole.replace("\n1,", "\n2,");
        let error = parse(gap.as_bytes(), 42).unwrap_err().to_string();
        assert!(
            error.contains("line 4") && error.contains("tick 1"),
            "{error}"
        );
        let wrong = whole.replace("06", "6");
        let error = parse(wrong.as_bytes(), 42).unwrap_err().to_string();
        assert!(error.contains("line 3"), "{error}");
    }
}
