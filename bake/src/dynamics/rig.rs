//! Rig files.

use super::{lines, number, points, vector};
use crate::error::{Error, Result};
use crate::mesh::Point;
use crate::pack::writer::Section;
use crate::read::words::shown;
use crate::table::format::Format;
use octruss::bundle::SECTION_RIG;
use octruss::control::rig::{
    Influence, JOINTS_AT_MOST, Joint, NO_PARENT, Rig, RigRecord, WEIGHT_ONE,
};
use std::collections::HashMap;
use zerocopy::IntoBytes;

/// A rig as its file says it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RigFile {
    /// The joints, each behind its parent.
    pub joints: Vec<JointLine>,
    /// Joints and weights of each control point; the weights add up to one.
    pub influences: Vec<Vec<(usize, f64)>>,
}

/// A joint.
#[derive(Clone, Debug, PartialEq)]
pub struct JointLine {
    /// Its name.
    pub name: String,
    /// The joint that carries it.
    pub parent: Option<usize>,
    /// Its pivot.
    pub pivot: Point,
    /// Its axis: of unit length, or zero.
    pub axis: Point,
}

/// Reads a rig file for a cage of so many vertices.
///
/// # Errors
/// Names the line and what is wrong in it.
pub fn read(bytes: &[u8], vertices: usize) -> Result<RigFile> {
    let mut rig = RigFile {
        influences: vec![Vec::new(); vertices],
        ..RigFile::default()
    };
    let mut names = HashMap::new();
    for line in lines(bytes)? {
        let done = match line.words.as_slice() {
            ["joint", name, parent, "at", place @ ..] => rig.joint(&mut names, name, parent, place),
            ["carry", run, weights @ ..] => rig.carry(&names, run, weights),
            [word, ..] => Err(Error::new(format!(
                "expected `joint NAME PARENT at X Y Z about X Y Z` or `carry VERTICES NAME WEIGHT`, found \"{}\"",
                shown(word)
            ))),
            [] => Ok(()),
        };
        done.map_err(|error| error.at_line(line.number))?;
    }
    if rig.joints.is_empty() {
        return Err(Error::new("there is no joint in it").advise(
            "a joint is a line `joint NAME PARENT at X Y Z about X Y Z`, with - for no parent",
        ));
    }
    Ok(rig)
}

impl RigFile {
    fn joint(
        &mut self,
        names: &mut HashMap<String, usize>,
        name: &str,
        parent: &str,
        place: &[&str],
    ) -> Result<()> {
        let parent = match parent {
            "-" => None,
            parent => Some(find(names, parent)?),
        };
        let (pivot, axis) = match place {
            [x, y, z, "about", axis @ ..] => (vector(&[x, y, z])?, vector(axis)?),
            [x, y, z, "fixed"] => (vector(&[x, y, z])?, [0.0; 3]),
            _ => {
                return Err(Error::new(
                    "expected `joint NAME PARENT at X Y Z` and `about X Y Z` or `fixed`",
                ));
            }
        };
        let length = axis.iter().map(|x| x * x).sum::<f64>().sqrt();
        let is_fixed = place.last() == Some(&"fixed");
        if !is_fixed && (length == 0.0 || !length.is_finite()) {
            return Err(
                Error::new("the axis has no length").advise("a joint that never turns is `fixed`")
            );
        }
        if self.joints.len() == JOINTS_AT_MOST {
            return Err(Error::new(format!(
                "a rig has at most {JOINTS_AT_MOST} joints"
            )));
        }
        if names.insert(name.to_owned(), self.joints.len()).is_some() {
            return Err(Error::new(format!(
                "there is a joint \"{}\" already",
                shown(name)
            )));
        }
        self.joints.push(JointLine {
            name: name.to_owned(),
            parent,
            pivot,
            axis: if is_fixed {
                axis
            } else {
                axis.map(|x| x / length)
            },
        });
        Ok(())
    }

    fn carry(&mut self, names: &HashMap<String, usize>, run: &str, weights: &[&str]) -> Result<()> {
        let run = points(run, self.influences.len())?;
        let mut own: Vec<(usize, f64)> = Vec::new();
        for pair in weights.chunks(2) {
            let (joint, weight) = match pair {
                [name] if weights.len() == 1 => (find(names, name)?, 1.0),
                [name, weight] => (find(names, name)?, number(weight)?),
                _ => return Err(Error::new("a joint's weight is missing")),
            };
            if weight <= 0.0 {
                return Err(Error::new(format!(
                    "the weight {weight} is not greater than zero"
                )));
            }
            if own.iter().any(|(other, _)| *other == joint) {
                return Err(Error::new("a joint is named twice"));
            }
            own.push((joint, weight));
        }
        if own.is_empty() {
            return Err(Error::new("no joint is named that carries the vertices"));
        }
        let sum: f64 = own.iter().map(|(_, weight)| weight).sum();
        own.iter_mut().for_each(|(_, weight)| *weight /= sum);
        own.sort_by_key(|(joint, _)| *joint);
        for point in run {
            if !self.influences[point].is_empty() {
                return Err(Error::new(format!("vertex {point} is carried already")));
            }
            self.influences[point].clone_from(&own);
        }
        Ok(())
    }

    /// The section, proved sound by core.
    ///
    /// # Errors
    /// If a pivot does not fit the format.
    pub fn section(&self, format: Format, rest: &[[i32; 3]]) -> Result<Section> {
        let pivots: Vec<Point> = self.joints.iter().map(|joint| joint.pivot).collect();
        let pivots = format.bits_of(&pivots, "the pivot of joint")?;
        let joints = self.joints.iter().zip(pivots).map(|(joint, pivot)| Joint {
            parent: joint.parent.map_or(NO_PARENT, |parent| parent as u32),
            pivot,
            axis: joint.axis.map(|x| (x * f64::from(1 << 30)).round() as i32),
        });
        let joints: Vec<Joint> = joints.collect();
        let mut starts = vec![0_u32];
        let mut influences = Vec::new();
        for own in &self.influences {
            influences.extend(quantised(own));
            starts.push(influences.len() as u32);
        }
        let record = RigRecord {
            joints: (joints.len() as u32).into(),
            points: (rest.len() as u32).into(),
            influences: (influences.len() as u32).into(),
            reserved: 0.into(),
        };
        let bytes = [
            record.as_bytes(),
            joints.as_bytes(),
            starts.as_bytes(),
            influences.as_bytes(),
        ]
        .concat();
        let aligned = aligned(&bytes);
        Rig::from_section(&aligned.as_bytes()[..bytes.len()], rest)
            .map_err(|error| Error::new(error.to_string()))?;
        Ok(Section {
            kind: SECTION_RIG,
            stage: 0,
            bytes,
        })
    }
}

/// The bytes as words, which lie on multiples of four.
pub(super) fn aligned(bytes: &[u8]) -> Vec<u32> {
    let mut words = vec![0_u32; bytes.len().div_ceil(4)];
    words.as_mut_bytes()[..bytes.len()].copy_from_slice(bytes);
    words
}

/// Weights of 14 bits that add up to exactly one: rounded down, then the largest remainders get one more.
/// A weight that comes out as zero is left out.
fn quantised(own: &[(usize, f64)]) -> Vec<Influence> {
    let scaled: Vec<f64> = own
        .iter()
        .map(|(_, weight)| weight * f64::from(WEIGHT_ONE))
        .collect();
    let mut whole: Vec<u16> = scaled.iter().map(|weight| weight.floor() as u16).collect();
    let mut order: Vec<usize> = (0..own.len()).collect();
    let remainder = |place: usize| scaled[place] - scaled[place].floor();
    order.sort_by(|&a, &b| remainder(b).total_cmp(&remainder(a)).then(a.cmp(&b)));
    let sum: u32 = whole.iter().map(|&weight| u32::from(weight)).sum();
    let missing = u32::from(WEIGHT_ONE).saturating_sub(sum) as usize;
    if !own.is_empty() {
        order
            .iter()
            .cycle()
            .take(missing)
            .for_each(|&place| whole[place] += 1);
    }
    let pairs = own.iter().zip(whole).filter(|(_, weight)| *weight > 0);
    pairs
        .map(|((joint, _), weight)| Influence {
            joint: *joint as u16,
            weight,
        })
        .collect()
}

fn find(names: &HashMap<String, usize>, name: &str) -> Result<usize> {
    names.get(name).copied().ok_or_else(|| {
        Error::new(format!(
            "there is no joint \"{}\" before this line",
            shown(name)
        ))
        .advise("joints stand before what they carry")
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weights_add_up_to_one() {
        let thirds = [(0, 1.0 / 3.0), (4, 1.0 / 3.0), (7, 1.0 / 3.0)];
        let weights: Vec<u16> = quantised(&thirds).iter().map(|own| own.weight).collect();
        assert_eq!(weights, [5462, 5461, 5461]);
        let tiny = [(0, 1.0 - 1e-9), (1, 1e-9)];
        assert_eq!(quantised(&tiny).len(), 1);
    }

    #[test]
    fn what_is_wrong_is_named() {
        let of = |text: &str| read(text.as_bytes(), 4).unwrap_err().to_string();
        let base = "joint a - at 0 0 0 about 0 0 1\n";
        let cases = [
            ("", "there is no joint in it"),
            (
                "joint a b at 0 0 0 about 0 0 1",
                "line 1: there is no joint \"b\" before this line",
            ),
            (
                "joint a - at 0 0 0 about 0 0 0",
                "line 1: the axis has no length",
            ),
            ("joint a - at 0 0 about 0 0 1", "line 1: expected `joint"),
            ("bone a", "line 1: expected `joint"),
            ("carry 0 a", "line 1: there is no joint \"a\""),
        ];
        for (text, want) in cases {
            assert!(of(text).starts_with(want), "{}", of(text));
        }
        let more = [
            ("carry 4 a", "line 2: there is no vertex 4"),
            ("carry 2-1 a", "line 2: the run of vertices"),
            ("carry 0 a -1", "line 2: the weight -1 is not"),
            ("carry 0 a 1 a 1", "line 2: a joint is named twice"),
            (
                "carry 0-1 a\ncarry 1 a",
                "line 3: vertex 1 is carried already",
            ),
            (
                "joint a - at 0 0 0 fixed",
                "line 2: there is a joint \"a\" already",
            ),
        ];
        for (text, want) in more {
            let got = of(&format!("{base}{text}"));
            assert!(got.starts_with(want), "{got}");
        }
    }
}
