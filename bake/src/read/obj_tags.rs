//! Crease and corner tags of Wavefront files, as OpenSubdiv's shapes write them.
//!
//! `t crease 2/1/0 A B S` and `t corner 1/1/0 A S`: after the name the numbers of integers, reals
//! and words, then those. Vertices are counted from 0, two for each crease. A sharpness `S` of 0 is
//! none; any other is taken as infinite, and said so if it is below 10, where OpenSubdiv's surface
//! would be rounded.

use super::words::shown;
use crate::error::{Error, Result};
use crate::mesh::Features;

/// From this on OpenSubdiv takes a sharpness as infinite.
const INFINITE: f64 = 10.0;

/// Reads the tags of a file with so many vertices; the second value has what is to be said about
/// them.
pub fn read(bytes: &[u8], vertices: usize) -> Result<(Features, Vec<String>)> {
    let mut features = Features::default();
    let (mut finite, mut others) = (0, 0);
    for (line, number) in bytes.split(|byte| *byte == b'\n').zip(1..) {
        let line = String::from_utf8_lossy(line);
        let words: Vec<&str> = line.split_ascii_whitespace().collect();
        let ["t", name, counts, arguments @ ..] = words.as_slice() else {
            continue;
        };
        let tag = Tag::parse(counts, arguments, vertices).map_err(|error| error.at_line(number))?;
        if !matches!(*name, "crease" | "corner") {
            others += 1;
            continue;
        }
        let each = if *name == "crease" { 2 } else { 1 };
        for (place, group) in tag.vertices.chunks_exact(each).enumerate() {
            let sharpness = tag.sharpness(place * each);
            if sharpness <= 0.0 {
                continue;
            }
            finite += usize::from(sharpness < INFINITE);
            match *group {
                [a, b] => features.creases.push([a, b]),
                [a] => features.corners.push(a),
                _ => {}
            }
        }
    }
    features.normalise();
    let mut notes = Vec::new();
    if finite > 0 {
        notes.push(format!(
            "{finite} creases or corners have a sharpness below 10 and are taken as infinitely sharp"
        ));
    }
    if others > 0 {
        notes.push(format!(
            "{others} tags other than crease and corner are skipped"
        ));
    }
    Ok((features, notes))
}

struct Tag {
    vertices: Vec<u32>,
    reals: Vec<f64>,
}

impl Tag {
    fn parse(counts: &str, arguments: &[&str], vertices: usize) -> Result<Self> {
        let wrong = |what: &str, word: &str| {
            Error::new(format!(
                "expected {what} of a tag, found \"{}\"",
                shown(word)
            ))
        };
        let counted: Option<Vec<usize>> = counts.split('/').map(|word| word.parse().ok()).collect();
        let Some(&[integers, reals, ..]) = counted.as_deref() else {
            return Err(wrong("the numbers of arguments", counts));
        };
        let total = integers.checked_add(reals);
        if total.is_none_or(|total| total > arguments.len()) {
            return Err(wrong("as many arguments as announced", counts));
        }
        let vertex = |word: &&str| {
            let index: Option<u32> = word.parse().ok();
            let known = index.filter(|index| (*index as usize) < vertices);
            known.ok_or_else(|| wrong("a vertex, counted from 0,", word))
        };
        let real = |word: &&str| {
            let value: Option<f64> = word.parse().ok();
            value.ok_or_else(|| wrong("a sharpness", word))
        };
        Ok(Self {
            vertices: arguments[..integers]
                .iter()
                .map(vertex)
                .collect::<Result<_>>()?,
            reals: arguments[integers..integers + reals]
                .iter()
                .map(real)
                .collect::<Result<_>>()?,
        })
    }

    /// One sharpness for all, or one for each vertex.
    fn sharpness(&self, place: usize) -> f64 {
        let one = self.reals.first().copied().unwrap_or(f64::INFINITY);
        match self.reals.len() {
            0 | 1 => one,
            _ => self.reals.get(place).copied().unwrap_or(one),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Lines in the form of OpenSubdiv's regression shapes.
    #[test]
    fn reads_creases_and_corners() {
        let text = b"v 0 0 0\nt interpolateboundary 1/0/0 2\nt crease 2/1/0 1 0 10\nt crease 4/1/0 1 2 2 3 2.5\nt corner 1/1/0 3 10\nt corner 1/1/0 2 0\n";
        let (features, notes) = read(text, 4).unwrap();
        assert_eq!(features.creases, [[0, 1], [1, 2], [2, 3]]);
        assert_eq!(features.corners, [3]);
        assert_eq!(notes.len(), 2);
        let error = read(b"\nt crease 2/1/0 0 4 1\n", 4)
            .unwrap_err()
            .to_string();
        assert!(error.starts_with("line 2: expected a vertex"), "{error}");
    }
}
