//! Reads the sections of a legacy VTK file.

use super::cell::{self, Cell, Kept, POLYHEDRON};
use super::data::{self, DataArray};
use super::numbers::{NumberType, integers, reals, values};
use crate::error::{Error, Result};
use crate::mesh::{SolidMesh, Vertex};
use crate::read::words::{Words, shown};
use std::collections::HashSet;

/// What has been read so far.
#[derive(Default)]
struct Grid {
    mesh: SolidMesh,
    /// The entries of the cells: points, or the list of faces of a polyhedron.
    entries: Option<Vec<Vec<i64>>>,
    /// What each cell of the file became, once types are known.
    kept: Option<Vec<Kept>>,
    on_cells: Vec<DataArray>,
    on_points: Vec<DataArray>,
}

/// Reads a mesh from the bytes of a `.vtk` file.
pub fn read(bytes: &[u8]) -> Result<SolidMesh> {
    let mut words = Words::new(bytes);
    let (is_binary, is_version_5) = header(&mut words)?;
    let mut grid = Grid::default();
    // The data that a section of attributes is about, and how many of them there are.
    let mut about: Option<(bool, usize)> = None;
    while let Some(word) = words.next_word()? {
        match (word.to_ascii_uppercase().as_str(), about) {
            ("POINTS", None) => points(&mut words, is_binary, &mut grid.mesh)?,
            ("CELLS", None) if is_version_5 => {
                grid.entries = Some(entries_of_version_5(&mut words, is_binary)?);
            }
            ("CELLS", None) => grid.entries = Some(entries(&mut words, is_binary)?),
            ("CELL_TYPES", None) => types(&mut words, is_binary, &mut grid)?,
            ("CELL_DATA", _) => about = Some((true, words.number("the number of cells")?)),
            ("POINT_DATA", _) => about = Some((false, words.number("the number of points")?)),
            ("METADATA", _) => skip_metadata(&mut words)?,
            ("FIELD", _) => {
                let arrays = field(&mut words, is_binary)?;
                match about {
                    Some((true, _)) => grid.on_cells.extend(arrays),
                    Some((false, _)) => grid.on_points.extend(arrays),
                    // Data about the file as a whole.
                    None => {}
                }
            }
            (keyword, Some((is_on_cells, number))) => {
                let array = attribute(&mut words, is_binary, keyword, number)?;
                let arrays = if is_on_cells {
                    &mut grid.on_cells
                } else {
                    &mut grid.on_points
                };
                arrays.extend(array);
            }
            (_, None) => {
                return Err(words
                    .error(format!(
                        "expected POINTS, CELLS, CELL_TYPES, CELL_DATA or POINT_DATA, found \"{}\"",
                        shown(word)
                    ))
                    .advise("a count in the section before may be wrong"));
            }
        }
    }
    finish(grid)
}

fn finish(mut grid: Grid) -> Result<SolidMesh> {
    let Some(kept) = grid.kept else {
        return Err(Error::new("the file has no section CELL_TYPES")
            .advise("the file seems to be cut off; write it again"));
    };
    data::add_labels(&grid.on_cells, &kept, &mut grid.mesh)?;
    data::add_channels(&grid.on_points, &kept, &mut grid.mesh)?;
    Ok(grid.mesh)
}

/// Whether the numbers are binary, and whether cells are listed as in version 5.
fn header(words: &mut Words<'_>) -> Result<(bool, bool)> {
    let first = words.line()?;
    let version = first.strip_prefix("# vtk DataFile Version ");
    let Some(version) = version.and_then(|version| version.trim().parse::<f64>().ok()) else {
        return Err(words
            .error(format!(
                "expected \"# vtk DataFile Version\" and a number, found \"{}\"",
                shown(first)
            ))
            .advise("this is no legacy VTK file; files of VTK's XML formats are named .vtu"));
    };
    let _title = words.line()?;
    let is_binary = match words.word("ASCII or BINARY")?.to_ascii_uppercase().as_str() {
        "ASCII" => false,
        "BINARY" => true,
        other => {
            return Err(words.error(format!(
                "expected ASCII or BINARY, found \"{}\"",
                shown(other)
            )));
        }
    };
    if is_binary {
        words.name_bytes();
    }
    let keyword = words.word("DATASET")?;
    let kind = words.word("UNSTRUCTURED_GRID")?;
    if !keyword.eq_ignore_ascii_case("DATASET") || !kind.eq_ignore_ascii_case("UNSTRUCTURED_GRID") {
        return Err(words
            .error(format!(
                "expected DATASET UNSTRUCTURED_GRID, found \"{} {}\"",
                shown(keyword),
                shown(kind)
            ))
            .advise("save the mesh as an unstructured grid"));
    }
    Ok((is_binary, version >= 5.0))
}

fn points(words: &mut Words<'_>, is_binary: bool, mesh: &mut SolidMesh) -> Result<()> {
    let number: usize = words.number("the number of points")?;
    if Vertex::try_from(number).is_err() {
        return Err(words.error("there are more than 2^32 points"));
    }
    let kind = NumberType::read(words)?;
    let values = reals(
        words,
        is_binary,
        kind,
        number.saturating_mul(3),
        "a coordinate of a point",
    )?;
    let (points, _) = values.as_chunks::<3>();
    let is_finite = |point: &[f64; 3]| point.iter().all(|coordinate| coordinate.is_finite());
    if let Some(bad) = points.iter().position(|point| !is_finite(point)) {
        return Err(words.error(format!(
            "point {bad} (counted from 0) has a coordinate that is no finite number"
        )));
    }
    mesh.points = points.to_vec();
    Ok(())
}

/// The cells of versions up to 4: each with its number of entries in front.
fn entries(words: &mut Words<'_>, is_binary: bool) -> Result<Vec<Vec<i64>>> {
    let number: usize = words.number("the number of cells")?;
    let size: usize = words.number("the number of integers in CELLS")?;
    let list = integers(
        words,
        is_binary,
        NumberType::Signed(4),
        size,
        "an entry of CELLS",
    )?;
    let mut rest = list.as_slice();
    let mut cells = Vec::new();
    for cell in 0..number {
        let entry = rest
            .split_first()
            .and_then(|(length, rest)| rest.split_at_checked(usize::try_from(*length).ok()?));
        let Some((entry, others)) = entry else {
            return Err(words
                .error(format!(
                    "cell {cell} (counted from 0) has entries beyond the {size} integers of CELLS"
                ))
                .advise("the counts behind CELLS may be wrong"));
        };
        cells.push(entry.to_vec());
        rest = others;
    }
    if !rest.is_empty() {
        return Err(words
            .error(format!(
                "{} of the {size} integers of CELLS are left over",
                rest.len()
            ))
            .advise("the counts behind CELLS may be wrong"));
    }
    Ok(cells)
}

/// The cells of version 5: where each starts, then the entries of all.
fn entries_of_version_5(words: &mut Words<'_>, is_binary: bool) -> Result<Vec<Vec<i64>>> {
    let starts: usize = words.number("the number of offsets")?;
    let size: usize = words.number("the number of integers in CONNECTIVITY")?;
    let mut list = |keyword: &str, number: usize| {
        let word = words.word(keyword)?;
        if !word.eq_ignore_ascii_case(keyword) {
            return Err(words.error(format!("expected {keyword}, found \"{}\"", shown(word))));
        }
        let kind = NumberType::read(words)?;
        integers(
            words,
            is_binary,
            kind,
            number,
            &format!("an entry of {keyword}"),
        )
    };
    let offsets = list("OFFSETS", starts)?;
    let connectivity = list("CONNECTIVITY", size)?;
    let range = |pair: &[i64]| {
        let (start, end) = (
            usize::try_from(pair[0]).ok()?,
            usize::try_from(pair[1]).ok()?,
        );
        connectivity.get(start..end).map(<[i64]>::to_vec)
    };
    let cells = offsets.windows(2).enumerate().map(|(cell, pair)| {
        range(pair).ok_or_else(|| {
            words.error(format!(
                "cell {cell} (counted from 0) has offsets beyond the connectivity"
            ))
        })
    });
    cells.collect()
}

fn types(words: &mut Words<'_>, is_binary: bool, grid: &mut Grid) -> Result<()> {
    let number: usize = words.number("the number of cell types")?;
    let place = words.place();
    let Some(entries) = grid.entries.take() else {
        return Err(words.error("CELL_TYPES comes before CELLS"));
    };
    if number != entries.len() {
        return Err(words.error(format!(
            "expected a type for each of {} cells, found {number}",
            entries.len()
        )));
    }
    let kinds = integers(
        words,
        is_binary,
        NumberType::Signed(4),
        number,
        "the type of a cell",
    )?;
    let cells = kinds.into_iter().zip(entries);
    let cells = cells.map(|(kind, entry)| match kind {
        POLYHEDRON => polyhedron(&entry),
        _ => Ok(Cell {
            kind,
            points: entry,
            faces: Vec::new(),
        }),
    });
    grid.kept = Some(cell::add_all(cells, &mut grid.mesh).map_err(|error| error.at(place))?);
    Ok(())
}

/// A polyhedron's entry: the number of faces, then for each its number of points and the points.
/// Its corners are the points in the order in which they turn up.
fn polyhedron(entry: &[i64]) -> Result<Cell> {
    let incomplete = || Error::new("has an incomplete list of faces");
    let (number, mut rest) = entry.split_first().ok_or_else(incomplete)?;
    let (mut points, mut faces) = (Vec::new(), Vec::new());
    let mut known = HashSet::new();
    for _ in 0..*number {
        let (length, others) = rest.split_first().ok_or_else(incomplete)?;
        let length = usize::try_from(*length).map_err(|_| incomplete())?;
        let (face, others) = others.split_at_checked(length).ok_or_else(incomplete)?;
        points.extend(face.iter().copied().filter(|point| known.insert(*point)));
        faces.push(face.to_vec());
        rest = others;
    }
    Ok(Cell {
        kind: POLYHEDRON,
        points,
        faces,
    })
}

/// The arrays of a FIELD.
fn field(words: &mut Words<'_>, is_binary: bool) -> Result<Vec<DataArray>> {
    let _name = words.word("the name of a field")?;
    let number: usize = words.number("the number of arrays in a field")?;
    let mut arrays = Vec::new();
    for _ in 0..number {
        if words.is_next("METADATA") {
            words.word("METADATA")?;
            skip_metadata(words)?;
        }
        let name = words.word("the name of an array")?.to_owned();
        let components: usize = words.number("the number of components of an array")?;
        let tuples: usize = words.number("the number of tuples of an array")?;
        if words.is_next("string") {
            return Err(words
                .error(format!(
                    "the array \"{}\" holds text, which is not read",
                    shown(&name)
                ))
                .advise("remove the array"));
        }
        let kind = NumberType::read(words)?;
        let length = components.saturating_mul(tuples);
        arrays.push(DataArray {
            name,
            components,
            values: values(words, is_binary, kind, length, "a value of an array")?,
        });
    }
    Ok(arrays)
}

/// One attribute: scalars, or something else of a known size.
fn attribute(
    words: &mut Words<'_>,
    is_binary: bool,
    keyword: &str,
    number: usize,
) -> Result<Option<DataArray>> {
    let components = match keyword {
        "SCALARS"
        | "COLOR_SCALARS"
        | "LOOKUP_TABLE"
        | "TEXTURE_COORDINATES"
        | "GLOBAL_IDS"
        | "PEDIGREE_IDS" => 1,
        "VECTORS" | "NORMALS" => 3,
        "TENSORS" => 9,
        _ => {
            return Err(words
                .error(format!(
                    "expected SCALARS, FIELD or another kind of data, found \"{}\"",
                    shown(keyword)
                ))
                .advise("a count in the section before may be wrong"));
        }
    };
    let name = words.word("the name of the data")?.to_owned();
    let own = |components, values| DataArray {
        name: name.clone(),
        components,
        values,
    };
    let expected = "a value of the data";
    match keyword {
        "SCALARS" => {
            let kind = NumberType::read(words)?;
            let rest = words.rest_of_line()?;
            let components = match rest {
                "" => 1,
                count => count.parse().map_err(|_| {
                    words.error(format!(
                        "expected a number of components, found \"{}\"",
                        shown(count)
                    ))
                })?,
            };
            if words.is_next("LOOKUP_TABLE") {
                words.word("LOOKUP_TABLE")?;
                words.word("the name of a lookup table")?;
            }
            let length = number.saturating_mul(components);
            let values = values(words, is_binary, kind, length, expected)?;
            Ok(Some(own(components, values)))
        }
        "COLOR_SCALARS" | "LOOKUP_TABLE" => {
            // Colours: bytes in binary files, numbers from 0 to 1 in others.
            let count: usize = words.number("a number of colours or components")?;
            let length = match keyword {
                "LOOKUP_TABLE" => count.saturating_mul(4),
                _ => count.saturating_mul(number),
            };
            let kind = if is_binary {
                NumberType::Unsigned(1)
            } else {
                NumberType::Real(4)
            };
            values(words, is_binary, kind, length, expected)?;
            Ok(None)
        }
        _ => {
            let components = match keyword {
                "TEXTURE_COORDINATES" => words.number("a number of dimensions")?,
                _ => components,
            };
            let kind = NumberType::read(words)?;
            let length = number.saturating_mul(components);
            let values = values(words, is_binary, kind, length, expected)?;
            // Of one component only if these are numbers of points or cells.
            Ok((components > 1).then(|| own(components, values)))
        }
    }
}

/// METADATA ends with an empty line.
fn skip_metadata(words: &mut Words<'_>) -> Result<()> {
    words.line()?;
    while words.remaining() > 0 && !words.line()?.is_empty() {}
    Ok(())
}
