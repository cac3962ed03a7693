//! Files of springs.

use super::rig::aligned;
use super::{lines, number, part, points, vector};
use crate::error::{Error, Result};
use crate::pack::writer::Section;
use crate::read::words::shown;
use crate::table::format::Format;
use octruss::bundle::SECTION_SPRINGS;
use octruss::control::springs::{
    FACTOR_ONE, PointData, STATE_BITS, SUBSTEPS_AT_MOST, Spring, Springs, SpringsRecord,
    VELOCITY_LIMIT, length,
};
use std::collections::BTreeMap;
use zerocopy::IntoBytes;

/// Springs as their file says them.
#[derive(Clone, Debug, PartialEq)]
pub struct SpringsFile {
    /// Ticks a second.
    pub rate: f64,
    /// Substeps of a tick.
    pub substeps: u32,
    /// In the cage's unit a second squared.
    pub gravity: [f64; 3],
    /// The part of a velocity that is lost in a substep.
    pub drag: f64,
    /// The part of the ends' difference of velocities that is lost in a substep.
    pub damping: f64,
    /// Mass of each vertex; none for a pinned one.
    pub masses: Vec<Option<f64>>,
    /// The part of its way to the goal that a vertex takes back in a substep.
    pub anchors: Vec<f64>,
    /// Stretch and shape of every spring, by its ends in ascending order.
    pub springs: BTreeMap<[usize; 2], [f64; 2]>,
}

/// The pairs of vertices that a file can make springs of by one word.
#[derive(Clone, Debug, Default)]
pub struct Pairs {
    /// The edges of the cage.
    pub edges: Vec<[u32; 2]>,
    /// The diagonals of its quadrilaterals, and of its hexahedra and octahedra from corner to corner.
    pub diagonals: Vec<[u32; 2]>,
}

/// Reads a file of springs for a cage of so many vertices.
///
/// # Errors
/// Names the line and what is wrong in it.
pub fn read(bytes: &[u8], vertices: usize, pairs: &Pairs) -> Result<SpringsFile> {
    let mut file = SpringsFile {
        rate: 50.0,
        substeps: 4,
        gravity: [0.0; 3],
        drag: 0.01,
        damping: 0.05,
        masses: vec![Some(1.0); vertices],
        anchors: vec![0.0; vertices],
        springs: BTreeMap::new(),
    };
    for line in lines(bytes)? {
        file.take(&line.words, pairs)
            .map_err(|error| error.at_line(line.number))?;
    }
    let is_pinned = |point: usize| file.masses[point].is_none();
    file.springs
        .retain(|[a, b], _| !(is_pinned(*a) && is_pinned(*b)));
    if file.springs.is_empty() {
        return Err(Error::new("no spring moves anything")
            .advise("`edges STRETCH SHAPE` makes a spring of every edge of the cage"));
    }
    Ok(file)
}

impl SpringsFile {
    fn take(&mut self, words: &[&str], pairs: &Pairs) -> Result<()> {
        let count = self.masses.len();
        match words {
            ["rate", rate] => {
                self.rate = number(rate)?;
                if self.rate <= 0.0 {
                    return Err(Error::new("the ticks a second are not greater than zero"));
                }
            }
            ["substeps", substeps] => {
                let wanted = substeps.parse().ok();
                let wanted = wanted.filter(|wanted| (1..=SUBSTEPS_AT_MOST).contains(wanted));
                self.substeps = wanted.ok_or_else(|| {
                    Error::new(format!(
                        "expected 1 to {SUBSTEPS_AT_MOST} substeps, found \"{}\"",
                        shown(substeps)
                    ))
                })?;
            }
            ["gravity", gravity @ ..] => self.gravity = vector(gravity)?,
            ["drag", drag] => self.drag = part(drag)?,
            ["damping", damping] => self.damping = part(damping)?,
            ["pin", run] => {
                points(run, count)?.for_each(|point| self.masses[point] = None);
            }
            ["mass", run, mass] => {
                let mass = number(mass)?;
                if mass <= 0.0 {
                    return Err(Error::new("the mass is not greater than zero")
                        .advise("a vertex that does not move is pinned: `pin VERTICES`"));
                }
                points(run, count)?.for_each(|point| self.masses[point] = Some(mass));
            }
            ["anchor", run, anchor] => {
                let anchor = part(anchor)?;
                points(run, count)?.for_each(|point| self.anchors[point] = anchor);
            }
            ["edges", stretch, shape] => self.springs_of(&pairs.edges, stretch, shape)?,
            ["diagonals", stretch, shape] => self.springs_of(&pairs.diagonals, stretch, shape)?,
            ["spring", a, b, stretch, shape] => {
                let [a, b] = [*points(a, count)?.start(), *points(b, count)?.start()];
                if a == b {
                    return Err(Error::new(format!(
                        "both ends of the spring are vertex {a}"
                    )));
                }
                self.springs
                    .insert([a.min(b), a.max(b)], factors(stretch, shape)?);
            }
            [word, ..] => {
                return Err(Error::new(format!(
                    "expected `rate`, `substeps`, `gravity`, `drag`, `damping`, `pin`, `mass`, `anchor`, `edges`, \
                     `diagonals` or `spring` with what belongs to it, found \"{}\" with {} behind it",
                    shown(word),
                    crate::error::count(words.len() - 1, "word", "words")
                )));
            }
            [] => {}
        }
        Ok(())
    }

    fn springs_of(&mut self, pairs: &[[u32; 2]], stretch: &str, shape: &str) -> Result<()> {
        let factors = factors(stretch, shape)?;
        let ends = pairs
            .iter()
            .map(|&[a, b]| [a.min(b) as usize, a.max(b) as usize]);
        ends.for_each(|ends| {
            self.springs.insert(ends, factors);
        });
        Ok(())
    }

    /// The section, proved sound by core.
    ///
    /// # Errors
    /// If gravity is too large for the format.
    pub fn section(&self, format: Format, rest: &[[i32; 3]]) -> Result<Section> {
        let lightest = self
            .masses
            .iter()
            .flatten()
            .copied()
            .fold(f64::INFINITY, f64::min);
        let mobility = |point: usize| match self.masses[point] {
            // Not zero: that would be a pinned point.
            Some(mass) => factor(lightest / mass).max(1),
            None => 0,
        };
        let points: Vec<PointData> = (0..rest.len())
            .map(|point| PointData {
                mobility: mobility(point),
                anchor: factor(self.anchors[point]),
            })
            .collect();
        let springs = self.springs.iter().map(|(&[a, b], &[stretch, shape])| {
            let state = |point: usize| rest[point].map(|bits| i64::from(bits) << STATE_BITS);
            let (from, to) = (state(a), state(b));
            let rest = length([0, 1, 2].map(|axis| from[axis] - to[axis]));
            let (first, second) = (f64::from(mobility(a)), f64::from(mobility(b)));
            let stretch = factor(stretch);
            Spring {
                points: [a as u16, b as u16],
                length: rest.length as u32,
                length_shift: rest.shift,
                share: factor(first / (first + second)),
                stretch,
                shape: factor(shape).min(FACTOR_ONE - stretch),
            }
        });
        let springs: Vec<Spring> = springs.collect();
        let record = SpringsRecord {
            points: (points.len() as u32).into(),
            springs: (springs.len() as u32).into(),
            substeps: self.substeps.into(),
            drag: factor(self.drag).into(),
            damping: factor(self.damping).into(),
            push_shift: STATE_BITS.into(),
            reserved: [0.into(); 2],
            gravity: self.gravity_bits(format)?.map(Into::into),
        };
        let bytes = [record.as_bytes(), points.as_bytes(), springs.as_bytes()].concat();
        let words = aligned(&bytes);
        Springs::from_section(&words.as_bytes()[..bytes.len()], rest.len())
            .map_err(|error| Error::new(error.to_string()))?;
        Ok(Section {
            kind: SECTION_SPRINGS,
            stage: 0,
            bytes,
        })
    }

    fn gravity_bits(&self, format: Format) -> Result<[i64; 3]> {
        let substeps = self.rate * f64::from(self.substeps);
        let unit = format.unit() / f64::from(1 << STATE_BITS);
        let bits = self
            .gravity
            .map(|gravity| (gravity / (substeps * substeps) / unit).round());
        if bits.iter().any(|bits| bits.abs() > VELOCITY_LIMIT as f64) {
            return Err(
                Error::new("gravity crosses half the range of coordinates in a substep").advise(
                    "is it in the cage's unit a second squared, and the rate in ticks a second?",
                ),
            );
        }
        Ok(bits.map(|bits| bits as i64))
    }
}

fn factors(stretch: &str, shape: &str) -> Result<[f64; 2]> {
    let factors = [part(stretch)?, part(shape)?];
    if factors[0] + factors[1] <= 1.0 {
        return Ok(factors);
    }
    Err(Error::new("stretch and shape add up to more than one"))
}

/// A number from 0 to 1 with 16 fraction bits.
fn factor(part: f64) -> u32 {
    (part * f64::from(FACTOR_ONE)).round() as u32
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pairs() -> Pairs {
        Pairs {
            edges: vec![[0, 1], [1, 2]],
            diagonals: vec![[2, 0]],
        }
    }

    #[test]
    fn what_is_wrong_is_named() {
        let of = |text: &str| read(text.as_bytes(), 3, &pairs()).unwrap_err().to_string();
        let cases = [
            ("", "no spring moves anything"),
            ("edges 0.5 0.1\npin 0-2", "no spring moves anything"),
            ("edges 0.9 0.2", "line 1: stretch and shape add up"),
            ("edges 0.9", "line 1: expected `rate`"),
            ("substeps 65", "line 1: expected 1 to 64 substeps"),
            ("rate 0", "line 1: the ticks a second"),
            ("drag 1.5", "line 1: expected a number from 0 to 1"),
            ("\nmass 0 0", "line 2: the mass is not"),
            ("pin 3", "line 1: there is no vertex 3"),
            ("spring 1 1 1 0", "line 1: both ends"),
            ("gravity 0 0", "line 1: expected three numbers"),
        ];
        for (text, want) in cases {
            assert!(of(text).starts_with(want), "{}", of(text));
        }
    }

    #[test]
    fn a_file_becomes_springs() {
        let text = "rate 100\nsubsteps 2 # of a tick\ngravity 0 0 -10000\npin 0\nmass 2 3\nedges 0.5 0.25\nspring 0 1 1 0";
        let file = read(text.as_bytes(), 3, &pairs()).unwrap();
        let format = Format { fraction_bits: 4 };
        let rest = [[0, 0, 0], [48, 64, 0], [48, 64, 160]];
        let section = file.section(format, &rest).unwrap();
        let words = aligned(&section.bytes);
        let springs = Springs::from_section(words.as_bytes(), 3).unwrap().parts();
        // 10 000 / 200^2 is a quarter, which has 2^16 units of 2^-12 of 1/16 in one.
        assert_eq!(springs.gravity, [0, 0, -(1 << 14)]);
        let [first, second] = springs.springs else {
            panic!("two springs")
        };
        // 80 sixteenths; pinned, so all of it falls to the second.
        assert_eq!(
            (first.length, first.share, first.stretch),
            (80 << 12, 0, FACTOR_ONE)
        );
        // A third as mobile: three quarters of it fall to the first.
        assert_eq!((second.length, second.share), (160 << 12, 49_152));
    }
}
