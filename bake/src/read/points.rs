//! Points to be looked up: the vertices of a model, or a `.csv` file.
//!
//! A `.csv` file has the columns `x`, `y` and `z`. A first row with these names may be left out; with
//! it, columns may stand in any order and others may stand between them. What follows a `#` at the
//! start of a row is skipped.

use super::words::shown;
use crate::error::{Error, Result};
use crate::mesh::Point;
use std::path::Path;

const NAMES: [&str; 3] = ["x", "y", "z"];

/// Reads points in the format that the file's extension names.
pub fn read(file: &Path) -> Result<Vec<Point>> {
    match super::extension(file).as_str() {
        "csv" => read_csv(&super::bytes(file)?).map_err(|error| error.in_file(file)),
        "obj" | "ply" | "stl" | "off" => super::model(file).map(|model| model.points),
        other => Err(super::no_reader("points", other)
            .advise("points are read from .csv (columns x, y, z), .obj, .ply, .stl and .off")
            .in_file(file)),
    }
}

/// Reads points from the bytes of a `.csv` file.
pub fn read_csv(bytes: &[u8]) -> Result<Vec<Point>> {
    let mut reader = csv::ReaderBuilder::new()
        .has_headers(false)
        .flexible(true)
        .comment(Some(b'#'))
        .trim(csv::Trim::All)
        .from_reader(bytes);
    let (mut points, mut columns) = (Vec::new(), None);
    for record in reader.records() {
        let record = record.map_err(|error| {
            let line = error.position().map_or(1, |position| position.line());
            Error::new(format!("the row cannot be read: {error}")).at_line(line_number(line))
        })?;
        let line = line_number(record.position().map_or(1, |position| position.line()));
        let at_line = |error: Error| error.at_line(line);
        let columns = match columns {
            Some(columns) => columns,
            None => {
                let (found, is_header) = header(&record).map_err(at_line)?;
                columns = Some(found);
                if is_header {
                    continue;
                }
                found
            }
        };
        points.push(row(&record, columns).map_err(at_line)?);
    }
    if points.is_empty() {
        return Err(
            Error::new("the file has no points").advise("list one row for each point: x,y,z")
        );
    }
    Ok(points)
}

fn line_number(line: u64) -> usize {
    usize::try_from(line).unwrap_or(usize::MAX)
}

/// The columns, and whether this record names them.
fn header(record: &csv::StringRecord) -> Result<([usize; 3], bool)> {
    let is_number = |field: &str| field.parse::<f64>().is_ok();
    if record.get(0).is_some_and(is_number) {
        return Ok(([0, 1, 2], false));
    }
    let mut columns = [0; 3];
    for (column, name) in columns.iter_mut().zip(NAMES) {
        let place = record
            .iter()
            .position(|field| field.eq_ignore_ascii_case(name));
        *column = place.ok_or_else(|| {
            Error::new(format!("the first row names no column \"{name}\""))
                .advise("the columns are x, y, z")
        })?;
    }
    Ok((columns, true))
}

fn row(record: &csv::StringRecord, columns: [usize; 3]) -> Result<Point> {
    let mut point = [0.0; 3];
    for (axis, coordinate) in point.iter_mut().enumerate() {
        let field = record.get(columns[axis]).ok_or_else(|| {
            Error::new(format!(
                "expected the columns x, y, z, found {} columns",
                record.len()
            ))
        })?;
        let value: Option<f64> = field.parse().ok();
        *coordinate = value.filter(|value| value.is_finite()).ok_or_else(|| {
            Error::new(format!(
                "expected a finite number as {}, found \"{}\"",
                NAMES[axis],
                shown(field)
            ))
        })?;
    }
    Ok(point)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_by_name_or_by_place() {
        let points = [[1.0, 2.0, -3.5], [0.0, 1e-3, 4.0]];
        for text in [
            "1,2,-3.5\n0,1e-3,4\n",
            "# by hand\nz, name, X, y\n-3.5,a,1,2\n\n4,b,0,0.001\n",
        ] {
            assert_eq!(read_csv(text.as_bytes()).unwrap(), points);
        }
    }

    #[test]
    fn errors_say_what_and_where() {
        for (text, message) in [
            (
                "",
                "the file has no points\n  help: list one row for each point: x,y,z",
            ),
            (
                "x,y\n",
                "line 1: the first row names no column \"z\"\n  help: the columns are x, y, z",
            ),
            (
                "0,0,0\n1,2\n",
                "line 2: expected the columns x, y, z, found 2 columns",
            ),
            (
                "0,0,0\n1,2,inf\n",
                "line 2: expected a finite number as z, found \"inf\"",
            ),
        ] {
            assert_eq!(read_csv(text.as_bytes()).unwrap_err().to_string(), message);
        }
    }
}
