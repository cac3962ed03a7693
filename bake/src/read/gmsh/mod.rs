//! Gmsh meshes (`.msh`), versions 2.2 and 4.1, ASCII and binary.
//!
//! Vertices are numbered from 0 in the order of the file, whatever their tags. Lines in a
//! physical curve whose name starts with `crease` become crease edges, points in a physical point
//! whose name starts with `corner` become corners, triangles in a physical surface whose name starts
//! with `crease` become crease faces (capitals do not matter). The first physical group of a
//! tetrahedron is its label. Other points, lines, triangles and quadrangles are counted and left out; volume elements other than tetrahedra and
//! elements of second order are errors. Sections that say nothing about the mesh itself
//! (periodicity, node data, comments) are skipped.

mod builder;
mod elements;
mod numbers;
mod version_2;
mod version_4;

use crate::error::{Error, Result};
use crate::mesh::SolidMesh;
use crate::read::words::{Words, shown};
use builder::Builder;
use numbers::{Mode, Numbers};

/// The two layouts of nodes and elements.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Version {
    Two,
    Four,
}

/// Reads a mesh from the bytes of a `.msh` file.
pub fn read(bytes: &[u8]) -> Result<SolidMesh> {
    let mut words = Words::new(bytes);
    let (version, mode) = header(&mut words)?;
    let mut builder = Builder::default();
    let mut entities = version_4::EntityGroups::default();
    let (mut nodes, mut elements) = (false, false);
    while let Some(word) = words.next_word()? {
        let Some(section) = word.strip_prefix('$') else {
            return Err(words
                .error(format!(
                    "expected the start of a section, such as $Nodes, found \"{}\"",
                    shown(word)
                ))
                .advise("a count in the section before may be wrong"));
        };
        match (section, version) {
            ("PhysicalNames" | "Entities", _) if elements => {
                return Err(words
                    .error(format!("${section} comes after $Elements, which need it"))
                    .advise("write the mesh again with Gmsh"));
            }
            ("PhysicalNames", _) => physical_names(&mut words, &mut builder)?,
            ("Entities", Version::Four) => {
                entities = version_4::entities(&mut Numbers::new(&mut words, mode)?)?;
            }
            ("PartitionedEntities", Version::Four) => {
                return Err(words
                    .error("the mesh is partitioned")
                    .advise("join the parts before saving: Mesh > Unpartition in Gmsh"));
            }
            ("Nodes", Version::Two) => version_2::nodes(&mut words, mode, &mut builder)?,
            ("Nodes", Version::Four) => {
                version_4::nodes(&mut Numbers::new(&mut words, mode)?, &mut builder)?;
            }
            ("Elements", Version::Two) => version_2::elements(&mut words, mode, &mut builder)?,
            ("Elements", Version::Four) => {
                let mut numbers = Numbers::new(&mut words, mode)?;
                version_4::elements(&mut numbers, &mut builder, &entities)?;
            }
            _ => {
                skip_section(&mut words, mode, section)?;
                continue;
            }
        }
        nodes |= section == "Nodes";
        elements |= section == "Elements";
        end_of_section(&mut words, section)?;
    }
    for (found, section) in [(nodes, "$Nodes"), (elements, "$Elements")] {
        if !found {
            return Err(Error::new(format!("the file has no section {section}"))
                .advise("the file seems to be cut off, or the geometry was saved without a mesh: run `gmsh -3` first"));
        }
    }
    builder.finish()
}

fn header(words: &mut Words<'_>) -> Result<(Version, Mode)> {
    let first = words.word("$MeshFormat")?;
    if first != "$MeshFormat" {
        return Err(words
            .error(format!("expected $MeshFormat, found \"{}\"", shown(first)))
            .advise("this is no Gmsh mesh of version 2 or 4; save it as \"Version 4.1 ASCII\""));
    }
    let number = words.word("the version of the format")?;
    let version = match number {
        "2" | "2.0" | "2.1" | "2.2" => Version::Two,
        "4.1" => Version::Four,
        _ => {
            return Err(words
                .error(format!(
                    "expected MSH version 2.2 or 4.1, found \"{}\"",
                    shown(number)
                ))
                .advise("save it again: `gmsh MESH -save -format msh41 -o NEW.msh`"));
        }
    };
    let binary: u32 = words.number("0 (ASCII) or 1 (binary)")?;
    let size: u32 = words.number("the size of a number in bytes")?;
    let mode = match binary {
        0 => Mode::Ascii,
        1 if size == 8 => byte_order(words)?,
        1 => {
            return Err(words.error(format!(
                "expected binary numbers of 8 bytes, found \"{size}\""
            )));
        }
        _ => {
            return Err(words.error(format!(
                "expected 0 (ASCII) or 1 (binary), found \"{binary}\""
            )));
        }
    };
    end_of_section(words, "MeshFormat")?;
    Ok((version, mode))
}

/// A binary file starts with the number one in its own byte order.
fn byte_order(words: &mut Words<'_>) -> Result<Mode> {
    words.name_bytes();
    words.skip_line_end()?;
    match words.take_array::<4>("the number 1 in four bytes")? {
        [1, 0, 0, 0] => Ok(Mode::LittleEndian),
        [0, 0, 0, 1] => Ok(Mode::BigEndian),
        other => Err(words
            .error(format!(
                "expected the number 1 in four bytes, which shows the byte order, found {other:?}"
            ))
            .advise("the file is damaged, or its line ends were changed; write it again")),
    }
}

fn end_of_section(words: &mut Words<'_>, section: &str) -> Result<()> {
    let end = words.word(&format!("$End{section}"))?;
    if end.strip_prefix("$End") == Some(section) {
        return Ok(());
    }
    Err(words
        .error(format!("expected $End{section}, found \"{}\"", shown(end)))
        .advise("a count at the start of the section may be wrong"))
}

fn skip_section(words: &mut Words<'_>, mode: Mode, section: &str) -> Result<()> {
    let start = words.place();
    if mode != Mode::Ascii && words.skip_past(format!("$End{section}").as_bytes()) {
        return Ok(());
    }
    while mode == Mode::Ascii
        && let Some(word) = words.next_word()?
    {
        if word.strip_prefix("$End") == Some(section) {
            return Ok(());
        }
    }
    Err(Error::new(format!(
        "the section ${} has no $End{}",
        shown(section),
        shown(section)
    ))
    .at(start)
    .advise("the file seems to be cut off; write it again"))
}

fn physical_names(words: &mut Words<'_>, builder: &mut Builder) -> Result<()> {
    let number: usize = words.number("the number of physical names")?;
    for _ in 0..number {
        let dimension: u8 = words.number("the dimension of a physical group")?;
        let group: i64 = words.number("the number of a physical group")?;
        let name = words.rest_of_line()?;
        builder.name_group(dimension, group, name.trim_matches('"'));
    }
    Ok(())
}
