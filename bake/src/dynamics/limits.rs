//! Files of limits: pins, boxes, speeds and what it costs to move a control point.

use super::rig::aligned;
use super::{lines, number, part, points, vector};
use crate::error::{Error, Result};
use crate::pack::writer::Section;
use crate::read::words::shown;
use crate::table::format::Format;
use octruss::bundle::SECTION_LIMITS;
use octruss::control::project::{Limits, LimitsRecord, MOBILITY_ONE};
use zerocopy::IntoBytes;

/// Where a coordinate may be.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Place {
    /// Anywhere.
    Free,
    /// Where it is at rest.
    Pinned,
    /// At most this far from rest.
    Within(f64),
    /// From the first to the second.
    Between(f64, f64),
}

/// Limits as their file says them.
#[derive(Clone, Debug, PartialEq)]
pub struct LimitsFile {
    /// Ticks a second.
    rate: f64,
    /// A pose that no step moves further than this has settled.
    settled: f64,
    /// Where each coordinate of each vertex may be.
    places: Vec<[Place; 3]>,
    /// Units a second of each coordinate of a vertex.
    speeds: Vec<Option<f64>>,
    /// How cheap each vertex is to move, at most 1.
    mobilities: Vec<f64>,
}

/// Reads a file of limits for a cage of so many vertices.
///
/// # Errors
/// Names the line and what is wrong in it.
pub fn read(bytes: &[u8], vertices: usize) -> Result<LimitsFile> {
    let mut file = LimitsFile {
        rate: 50.0,
        settled: 0.0,
        places: vec![[Place::Free; 3]; vertices],
        speeds: vec![None; vertices],
        mobilities: vec![1.0; vertices],
    };
    for line in lines(bytes)? {
        file.take(&line.words)
            .map_err(|error| error.at_line(line.number))?;
    }
    Ok(file)
}

impl LimitsFile {
    fn take(&mut self, words: &[&str]) -> Result<()> {
        let count = self.places.len();
        match words {
            ["rate", rate] => {
                self.rate = number(rate)?;
                if self.rate <= 0.0 {
                    return Err(Error::new("the ticks a second are not greater than zero"));
                }
            }
            ["settled", length] => self.settled = not_negative(length)?,
            ["pin", run] => {
                points(run, count)?.for_each(|point| self.places[point] = [Place::Pinned; 3]);
            }
            ["reach", run, x, y, z] => {
                let reach = [x, y, z].map(|word| not_negative(word).map(Place::Within));
                let [x, y, z] = reach;
                let place = [x?, y?, z?];
                points(run, count)?.for_each(|point| self.places[point] = place);
            }
            ["box", run, ends @ ..] => {
                let place = between(ends)?;
                points(run, count)?.for_each(|point| self.places[point] = place);
            }
            ["speed", run, speed] => {
                let speed = not_negative(speed)?;
                points(run, count)?.for_each(|point| self.speeds[point] = Some(speed));
            }
            ["mobility", run, mobility] => {
                let mobility = part(mobility)?;
                points(run, count)?.for_each(|point| self.mobilities[point] = mobility);
            }
            [word, ..] => {
                return Err(Error::new(format!(
                    "expected `rate`, `settled`, `pin`, `reach`, `box`, `speed` or `mobility` with what belongs to \
                     it, found \"{}\" with {} behind it",
                    shown(word),
                    crate::error::count(words.len() - 1, "word", "words")
                )));
            }
            [] => {}
        }
        Ok(())
    }

    /// The section, proved sound by core.
    ///
    /// A limit is never wider on the device than in the file: lower ends round up, upper ends, speeds and the settled length
    /// round down. A pin is the rest's own bits.
    ///
    /// # Errors
    /// If no number of the format lies in a box.
    pub fn section(&self, format: Format, rest: &[[i32; 3]]) -> Result<Section> {
        let mut lower = Vec::with_capacity(rest.len());
        let mut upper = Vec::with_capacity(rest.len());
        for (index, (places, rest)) in self.places.iter().zip(rest).enumerate() {
            let mut ends = [[0; 3]; 2];
            for (axis, name) in ["x", "y", "z"].iter().enumerate() {
                let [low, high] = places[axis].ends(format, rest[axis]);
                if low > high {
                    return Err(Error::new(format!(
                        "no {name} of the coordinate format lies in the box of vertex {index}"
                    ))
                    .advise("make the box wider, or bake with more --fraction-bits"));
                }
                [ends[0][axis], ends[1][axis]] = [low, high];
            }
            lower.push(ends[0]);
            upper.push(ends[1]);
        }
        let per_tick = format.unit() * self.rate;
        let rates: Vec<u32> = self
            .speeds
            .iter()
            // A number too large for its type becomes the largest, which leaves it free.
            .map(|speed| speed.map_or(u32::MAX, |speed| (speed / per_tick).floor() as u32))
            .collect();
        let mobilities: Vec<u16> = self
            .mobilities
            .iter()
            .map(|part| (part * f64::from(MOBILITY_ONE)).round() as u16)
            .collect();
        let record = LimitsRecord {
            points: (rest.len() as u32).into(),
            settled: ((self.settled / format.unit()).floor() as u32).into(),
            reserved: [0.into(); 2],
        };
        let bytes = [
            record.as_bytes(),
            lower.as_bytes(),
            upper.as_bytes(),
            rates.as_bytes(),
            mobilities.as_bytes(),
        ]
        .concat();
        let words = aligned(&bytes);
        Limits::from_section(&words.as_bytes()[..bytes.len()], rest.len())
            .map_err(|error| Error::new(error.to_string()))?;
        Ok(Section {
            kind: SECTION_LIMITS,
            stage: 0,
            bytes,
        })
    }
}

impl Place {
    /// The least and the greatest bits; what does not fit the format is its end.
    fn ends(self, format: Format, rest: i32) -> [i32; 2] {
        let unit = format.unit();
        match self {
            Place::Free => [i32::MIN, i32::MAX],
            Place::Pinned => [rest; 2],
            Place::Within(reach) => {
                let reach = (reach / unit).floor() as u32;
                [
                    rest.saturating_sub_unsigned(reach),
                    rest.saturating_add_unsigned(reach),
                ]
            }
            Place::Between(low, high) => [(low / unit).ceil() as i32, (high / unit).floor() as i32],
        }
    }
}

/// The lower corner of a box and the upper one.
fn between(ends: &[&str]) -> Result<[Place; 3]> {
    let Some((low, high)) = ends.split_at_checked(3) else {
        return Err(Error::new(format!(
            "expected the lower and the upper corner of a box, six numbers, found {}",
            ends.len()
        )));
    };
    let (low, high) = (vector(low)?, vector(high)?);
    for (axis, name) in ["x", "y", "z"].iter().enumerate() {
        if low[axis] > high[axis] {
            return Err(Error::new(format!(
                "the box is empty: its {name} goes from {} down to {}",
                low[axis], high[axis]
            )));
        }
    }
    Ok([0, 1, 2].map(|axis| Place::Between(low[axis], high[axis])))
}

fn not_negative(word: &str) -> Result<f64> {
    let value = number(word)?;
    if value < 0.0 {
        return Err(Error::new(format!(
            "expected a number that is not negative, found {value}"
        )));
    }
    Ok(value)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_wrong_is_named() {
        let of = |text: &str| read(text.as_bytes(), 3).unwrap_err().to_string();
        let cases = [
            ("pin", "line 1: expected `rate`"),
            ("\npin 3", "line 2: there is no vertex 3"),
            ("rate 0", "line 1: the ticks a second"),
            ("speed 1 -2", "line 1: expected a number that is not"),
            ("mobility 1 1.5", "line 1: expected a number from 0 to 1"),
            ("reach 1 1 1 nan", "line 1: expected a number, found"),
            ("box 1 0 0 0 1 1", "line 1: expected three numbers, found 2"),
            ("box 1 0 0", "line 1: expected the lower and the upper"),
            ("box 1 0 3 0 1 2 1", "line 1: the box is empty: its y goes"),
        ];
        for (text, want) in cases {
            assert!(of(text).starts_with(want), "{}", of(text));
        }
    }

    /// Bits by hand, with four fraction bits.
    #[test]
    fn a_file_becomes_limits() {
        let text = "rate 100\nsettled 0.1\npin 0 # the root\nreach 1 0.5 0.1 1e300\nspeed 1-2 40\n\
                    box 2 -1.01 0 0 1.01 0.5 2\nmobility 2 0.25";
        let file = read(text.as_bytes(), 3).unwrap();
        let rest = [[5, 6, 7], [16, 16, -16], [0, 0, 0]];
        let section = file.section(Format { fraction_bits: 4 }, &rest).unwrap();
        let words = aligned(&section.bytes);
        let bytes = &words.as_bytes()[..section.bytes.len()];
        let limits = Limits::from_section(bytes, 3).unwrap();
        let parts = limits.parts();
        assert_eq!(parts.lower, [[5, 6, 7], [8, 15, i32::MIN], [-16, 0, 0]]);
        assert_eq!(parts.upper, [[5, 6, 7], [24, 17, i32::MAX], [16, 8, 32]]);
        // 40 a second are 0.4 a tick, 6.4 units.
        assert_eq!(parts.rates, [u32::MAX, 6, 6]);
        assert_eq!(parts.mobilities, [1 << 15, 1 << 15, 1 << 13]);
        assert_eq!(parts.settled, 1);
    }

    #[test]
    fn a_box_between_two_numbers_of_the_format_is_refused() {
        let file = read(b"box 1 0 0.01 0 1 0.05 1", 2).unwrap();
        let error = file.section(Format { fraction_bits: 4 }, &[[0; 3]; 2]);
        let text = error.unwrap_err().to_string();
        assert!(
            text.starts_with("no y of the coordinate format lies in the box of vertex 1"),
            "{text}"
        );
    }
}
