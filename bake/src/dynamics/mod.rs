//! What moves the control points, from text files to sections of a bundle: rigs, springs and limits, and the cells that poses
//! are not to fold over.
//!
//! `docs/files.md` says what stands in the files. [`rig`], [`springs`] and [`limits`] read them; core proves their
//! sections before they are written.

pub mod health;
pub mod limits;
pub mod rig;
pub mod springs;

use crate::error::{Error, Result};
use crate::mesh::{Cells, Shape};
use crate::pack::writer::Section;
use crate::read;
use crate::read::words::shown;
use crate::table::format::Format;
use limits::LimitsFile;
use rig::RigFile;
use springs::{Pairs, SpringsFile};
use std::collections::BTreeSet;
use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};
use std::str::FromStr;

/// What moves the control points, with the files that it came from.
#[derive(Clone, Debug, Default)]
pub struct Dynamics {
    /// The rig.
    pub rig: Option<(PathBuf, RigFile)>,
    /// The springs.
    pub springs: Option<(PathBuf, SpringsFile)>,
    /// The limits of poses.
    pub limits: Option<(PathBuf, LimitsFile)>,
    /// The cage's cells, from which a device tells the health of poses.
    pub cells: Option<Cells>,
}

/// The files that are given.
#[derive(Clone, Copy, Debug, Default)]
pub struct Files<'a> {
    /// A rig's.
    pub rig: Option<&'a Path>,
    /// Springs'.
    pub springs: Option<&'a Path>,
    /// Limits'.
    pub limits: Option<&'a Path>,
}

impl Dynamics {
    /// Reads the files that are given, for a cage of so many vertices.
    ///
    /// # Errors
    /// Names the file, the line and what is wrong in it.
    pub fn read(
        files: Files<'_>,
        vertices: usize,
        pairs: impl Fn() -> Result<Pairs>,
    ) -> Result<Self> {
        let mut dynamics = Self::default();
        if let Some(file) = files.rig {
            let rig = read::bytes(file).and_then(|bytes| rig::read(&bytes, vertices));
            dynamics.rig = Some((file.into(), rig.map_err(|error| error.in_file(file))?));
        }
        if let Some(file) = files.springs {
            let pairs = pairs()?;
            let springs =
                read::bytes(file).and_then(|bytes| springs::read(&bytes, vertices, &pairs));
            dynamics.springs = Some((file.into(), springs.map_err(|error| error.in_file(file))?));
        }
        if let Some(file) = files.limits {
            let limits = read::bytes(file).and_then(|bytes| limits::read(&bytes, vertices));
            dynamics.limits = Some((file.into(), limits.map_err(|error| error.in_file(file))?));
        }
        Ok(dynamics)
    }

    /// The sections, proved sound by core.
    ///
    /// # Errors
    /// If a number does not fit the format.
    pub fn sections(&self, format: Format, rest: &[[i32; 3]]) -> Result<Vec<Section>> {
        let mut sections = Vec::new();
        if let Some((file, rig)) = &self.rig {
            sections.push(
                rig.section(format, rest)
                    .map_err(|error| error.in_file(file))?,
            );
        }
        if let Some((file, springs)) = &self.springs {
            let section = springs.section(format, rest);
            sections.push(section.map_err(|error| error.in_file(file))?);
        }
        if let Some(cells) = &self.cells {
            sections.push(health::section(cells, rest)?);
        }
        if let Some((file, limits)) = &self.limits {
            let section = limits.section(format, rest);
            sections.push(section.map_err(|error| error.in_file(file))?);
        }
        Ok(sections)
    }
}

impl Pairs {
    /// Those of a solid.
    pub fn of_cells(cells: &Cells) -> Self {
        let (mut edges, mut diagonals) = (BTreeSet::new(), BTreeSet::new());
        for (shape, corners) in cells.iter() {
            let pair = |&[a, b]: &[usize; 2]| [corners[a], corners[b]];
            edges.extend(shape.edges().iter().map(pair));
            let quads = shape.quads().iter();
            diagonals.extend(
                quads
                    .flat_map(|&[a, b, c, d]| [[a, c], [b, d]])
                    .map(|ends| pair(&ends)),
            );
            let through: &[[usize; 2]] = match shape {
                Shape::Hexahedron => &[[0, 6], [1, 7], [2, 4], [3, 5]],
                Shape::Octahedron => &[[0, 3], [1, 4], [2, 5]],
                Shape::Tetrahedron | Shape::Prism => &[],
            };
            diagonals.extend(through.iter().map(pair));
        }
        Self::sorted(edges, diagonals)
    }

    /// Those of a control mesh: the diagonals are of its quadrilaterals.
    pub fn of_faces<'a>(faces: impl Iterator<Item = &'a [u32]>) -> Self {
        let (mut edges, mut diagonals) = (BTreeSet::new(), BTreeSet::new());
        for face in faces {
            let after = face.iter().cycle().skip(1);
            edges.extend(face.iter().zip(after).map(|(&a, &b)| [a, b]));
            if let &[a, b, c, d] = face {
                diagonals.extend([[a, c], [b, d]]);
            }
        }
        Self::sorted(edges, diagonals)
    }

    /// Every pair once, its lower vertex first.
    fn sorted(edges: BTreeSet<[u32; 2]>, diagonals: BTreeSet<[u32; 2]>) -> Self {
        let once = |pairs: BTreeSet<[u32; 2]>| {
            let ordered = pairs.into_iter().map(|[a, b]| [a.min(b), a.max(b)]);
            ordered.collect::<BTreeSet<_>>().into_iter().collect()
        };
        Self {
            edges: once(edges),
            diagonals: once(diagonals),
        }
    }
}

/// A line that says something: its number and its words, without what follows `#`.
struct Line<'a> {
    number: usize,
    words: Vec<&'a str>,
}

/// The lines that say something.
fn lines(bytes: &[u8]) -> Result<Vec<Line<'_>>> {
    let text = std::str::from_utf8(bytes).map_err(|error| {
        Error::new("found bytes that are not text").at_byte(error.valid_up_to())
    })?;
    let all = text.lines().enumerate().map(|(index, line)| Line {
        number: index + 1,
        words: line
            .split('#')
            .next()
            .unwrap_or("")
            .split_ascii_whitespace()
            .collect(),
    });
    Ok(all.filter(|line| !line.words.is_empty()).collect())
}

/// A finite number.
fn number(word: &str) -> Result<f64> {
    let value = f64::from_str(word).ok().filter(|value| value.is_finite());
    value.ok_or_else(|| Error::new(format!("expected a number, found \"{}\"", shown(word))))
}

/// A number from 0 to 1.
fn part(word: &str) -> Result<f64> {
    let value = number(word)?;
    if (0.0..=1.0).contains(&value) {
        return Ok(value);
    }
    Err(Error::new(format!(
        "expected a number from 0 to 1, found {value}"
    )))
}

/// Three numbers.
fn vector(words: &[&str]) -> Result<[f64; 3]> {
    match words {
        [x, y, z] => Ok([number(x)?, number(y)?, number(z)?]),
        _ => Err(Error::new(format!(
            "expected three numbers, found {}",
            words.len()
        ))),
    }
}

/// Control points: one, or the first and last of a run, `3` or `3-8`.
fn points(word: &str, count: usize) -> Result<RangeInclusive<usize>> {
    let point = |word: &str| {
        let index: usize = word.parse().map_err(|_| {
            Error::new(format!(
                "expected a vertex or a run of them such as 3-8, found \"{}\"",
                shown(word)
            ))
        })?;
        if index < count {
            return Ok(index);
        }
        Err(
            Error::new(format!("there is no vertex {index}; the cage has {count}"))
                .advise("vertices are counted from 0 in the order of the cage's file"),
        )
    };
    let (first, last) = word.split_once('-').unwrap_or((word, word));
    let (first, last) = (point(first)?, point(last)?);
    if first > last {
        return Err(Error::new(format!(
            "the run of vertices {first}-{last} ends before it starts"
        )));
    }
    Ok(first..=last)
}
