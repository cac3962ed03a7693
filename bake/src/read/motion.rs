//! Motions: positions of all control points, frame by frame.
//!
//! A `.csv` file has the columns `frame`, `point`, `x`, `y`, `z`: numbers of frame and point
//! counted from 0, and the point's position in the cage's units. A first line with these names is
//! optional; with it, the columns may stand in any order and others may stand between them. Rows
//! come in any order, frames need not be numbered without gaps, and every frame lists every point
//! exactly once. A directory holds one mesh a frame, with the cage's connectivity; the number at
//! the end of each file's stem gives the order.

use super::words::shown;
use crate::error::{Error, Result};
use crate::mesh::{Point, SolidMesh};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Positions of all control points at one moment.
#[derive(Clone, Debug, PartialEq)]
pub struct Frame {
    /// The frame's number in its file or file name.
    pub number: u64,
    /// One position for each control point, in the cage's units and order.
    pub points: Vec<Point>,
}

/// The places of the five columns.
type Columns = [usize; 5];

const NAMES: [&str; 5] = ["frame", "point", "x", "y", "z"];

/// Reads a motion of `points` control points from the bytes of a `.csv` file; frames ascend.
pub fn read_csv(bytes: &[u8], points: usize) -> Result<Vec<Frame>> {
    let mut reader = csv::ReaderBuilder::new()
        .has_headers(false)
        .flexible(true)
        .comment(Some(b'#'))
        .trim(csv::Trim::All)
        .from_reader(bytes);
    let mut columns: Option<Columns> = None;
    let mut frames: BTreeMap<u64, Vec<Option<Point>>> = BTreeMap::new();
    for record in reader.records() {
        let record = record.map_err(|error| {
            let line = error
                .position()
                .map_or(1, |position| line_number(position.line()));
            Error::new(format!("the row cannot be read: {error}")).at_line(line)
        })?;
        let line = record
            .position()
            .map_or(1, |position| line_number(position.line()));
        let columns = match columns {
            Some(columns) => columns,
            None => {
                let (found, is_header) = header(&record).map_err(|error| error.at_line(line))?;
                columns = Some(found);
                if is_header {
                    continue;
                }
                found
            }
        };
        let (frame, point, position) =
            row(&record, columns, points).map_err(|error| error.at_line(line))?;
        let positions = frames.entry(frame).or_insert_with(|| vec![None; points]);
        if positions[point].replace(position).is_some() {
            return Err(
                Error::new(format!("point {point} of frame {frame} is listed twice")).at_line(line),
            );
        }
    }
    if frames.is_empty() {
        return Err(Error::new("the motion has no frames")
            .advise("list one row for each frame and control point: frame,point,x,y,z"));
    }
    frames
        .into_iter()
        .map(|(number, positions)| complete(number, positions))
        .collect()
}

fn line_number(line: u64) -> usize {
    usize::try_from(line).unwrap_or(usize::MAX)
}

/// The columns, and whether this record names them.
fn header(record: &csv::StringRecord) -> Result<(Columns, bool)> {
    if record
        .get(0)
        .is_some_and(|first| first.parse::<f64>().is_ok())
    {
        return Ok(([0, 1, 2, 3, 4], false));
    }
    let mut columns = [0; 5];
    for (column, name) in columns.iter_mut().zip(NAMES) {
        *column = record
            .iter()
            .position(|field| field.eq_ignore_ascii_case(name))
            .ok_or_else(|| {
                Error::new(format!("the first row names no column \"{name}\""))
                    .advise("the columns are frame, point, x, y, z")
            })?;
    }
    Ok((columns, true))
}

fn row(record: &csv::StringRecord, columns: Columns, points: usize) -> Result<(u64, usize, Point)> {
    let field = |index: usize| -> Result<&str> {
        record.get(columns[index]).ok_or_else(|| {
            Error::new(format!(
                "expected the columns frame, point, x, y, z, found {} columns",
                record.len()
            ))
        })
    };
    let wrong = |index: usize, word: &str| {
        Error::new(format!(
            "expected a number as {}, found \"{}\"",
            NAMES[index],
            shown(word)
        ))
    };
    let coordinate = |index: usize| -> Result<f64> {
        let word = field(index)?;
        let value: Option<f64> = word.parse().ok();
        value
            .filter(|value| value.is_finite())
            .ok_or_else(|| wrong(index, word))
    };
    let frame = field(0)?
        .parse()
        .map_err(|_| wrong(0, field(0).unwrap_or("")))?;
    let point: usize = field(1)?
        .parse()
        .map_err(|_| wrong(1, field(1).unwrap_or("")))?;
    if point >= points {
        return Err(
            Error::new(format!("there is no point {point}; the cage has {points}"))
                .advise("points are counted from 0 in the order of the cage's file"),
        );
    }
    Ok((
        frame,
        point,
        [coordinate(2)?, coordinate(3)?, coordinate(4)?],
    ))
}

fn complete(number: u64, positions: Vec<Option<Point>>) -> Result<Frame> {
    if let Some(missing) = positions.iter().position(Option::is_none) {
        let listed = positions.iter().flatten().count();
        return Err(Error::new(format!(
            "frame {number} lists {listed} of {} points; the first one missing is point {missing}",
            positions.len()
        ))
        .advise("every frame lists the position of every control point"));
    }
    Ok(Frame {
        number,
        points: positions.into_iter().flatten().collect(),
    })
}

/// The numbered meshes in a directory, in the order of their numbers.
pub fn numbered_meshes(directory: &Path) -> Result<Vec<(u64, PathBuf)>> {
    let cannot = |error: std::io::Error| {
        Error::new(format!("the directory cannot be read: {error}")).in_file(directory)
    };
    let mut found: BTreeMap<u64, PathBuf> = BTreeMap::new();
    let entries = std::fs::read_dir(directory).map_err(cannot)?;
    let paths = entries.map(|entry| entry.map(|entry| entry.path()));
    let mut paths: Vec<PathBuf> = paths.collect::<std::io::Result<_>>().map_err(cannot)?;
    paths.sort();
    for path in paths {
        let extension = super::extension(&path);
        // A TetGen pose has two files and is found by one of them.
        if extension == "ele" || !super::SOLID_EXTENSIONS.contains(&extension.as_str()) {
            continue;
        }
        let Some(number) = trailing_number(&path) else {
            continue;
        };
        if let Some(other) = found.insert(number, path.clone()) {
            return Err(Error::new(format!(
                "two poses have the number {number}: {} and {}",
                other.display(),
                path.display()
            ))
            .in_file(directory));
        }
    }
    if found.is_empty() {
        return Err(Error::new("the directory has no numbered poses")
            .advise("name them like pose-0001.vtu, pose-0002.vtu")
            .in_file(directory));
    }
    Ok(found.into_iter().collect())
}

/// The number at the end of a file name's stem.
pub fn trailing_number(path: &Path) -> Option<u64> {
    let stem = path.file_stem()?.to_str()?;
    let start = stem
        .trim_end_matches(|character: char| character.is_ascii_digit())
        .len();
    stem[start..].parse().ok()
}

/// Reads a motion of `points` control points: a `.csv` file, or a directory of numbered meshes,
/// each of which `check` accepts as a pose of the cage.
pub fn read(
    path: &Path,
    points: usize,
    check: &dyn Fn(&SolidMesh) -> Result<()>,
) -> Result<Vec<Frame>> {
    if path.is_dir() {
        let pose = |(number, file): (u64, PathBuf)| -> Result<Frame> {
            let mesh = super::solid(&file)?;
            check(&mesh).map_err(|error| error.in_file(&file))?;
            Ok(Frame {
                number,
                points: mesh.points,
            })
        };
        return numbered_meshes(path)?.into_iter().map(pose).collect();
    }
    if super::extension(path) != "csv" {
        return Err(
            Error::new("a motion is a directory of numbered poses or a .csv file")
                .advise("the columns of a .csv are frame, point, x, y, z")
                .in_file(path),
        );
    }
    read_csv(&super::bytes(path)?, points).map_err(|error| error.in_file(path))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_in_any_order_and_frames_sorted() {
        let text =
            "z, y, x, note, point, frame\n3,2,1,a,0,7\n6,5,4,b,1,7\n0,0,0,,1,2\n9,8,7,,0,2\n";
        let frames = read_csv(text.as_bytes(), 2).unwrap();
        assert_eq!(
            frames,
            [
                Frame {
                    number: 2,
                    points: vec![[7.0, 8.0, 9.0], [0.0; 3]]
                },
                Frame {
                    number: 7,
                    points: vec![[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]]
                },
            ]
        );
        assert_eq!(read_csv(b"2,0,7,8,9\n2,1,0,0,0\n", 2).unwrap(), frames[..1]);
    }

    #[test]
    fn errors_say_what_and_where() {
        for (text, message) in [
            (
                "0,0,1,2,3\n",
                "frame 0 lists 1 of 2 points; the first one missing is point 1\n  help: every frame lists the position of every control point",
            ),
            (
                "0,0,1,2,3\n0,0,1,2,3\n",
                "line 2: point 0 of frame 0 is listed twice",
            ),
            (
                "0,2,1,2,3\n",
                "line 1: there is no point 2; the cage has 2\n  help: points are counted from 0 in the order of the cage's file",
            ),
            (
                "0,0,1,inf,3\n",
                "line 1: expected a number as y, found \"inf\"",
            ),
            (
                "0,0,1,2\n",
                "line 1: expected the columns frame, point, x, y, z, found 4 columns",
            ),
            (
                "frame,x,y,z\n",
                "line 1: the first row names no column \"point\"\n  help: the columns are frame, point, x, y, z",
            ),
            (
                "",
                "the motion has no frames\n  help: list one row for each frame and control point: frame,point,x,y,z",
            ),
        ] {
            assert_eq!(
                read_csv(text.as_bytes(), 2).unwrap_err().to_string(),
                message
            );
        }
    }
}
