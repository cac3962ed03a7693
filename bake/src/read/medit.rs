//! Medit meshes (`.mesh`), ASCII.
//!
//! Tetrahedra, prisms (pentahedra), hexahedra and pyramids make the cage, their references are its labels. Edges listed under `Ridges` become
//! crease edges, vertices under `Corners` corners. Other edges, triangles and quadrilaterals are
//! counted and left out; other volume elements are errors. Sections that say nothing about the mesh
//! itself (normals, tangents, what a remesher must keep) are skipped. MFEM's meshes, which have the
//! same extension, are recognised and refused.

use super::pyramids::{self, Pyramid};
use super::words::{Words, shown};
use crate::error::{Error, Result, count, listed};
use crate::mesh::{SolidMesh, Vertex};

/// What the sections say, until all of them are read.
#[derive(Default)]
struct Sections {
    mesh: SolidMesh,
    edges: Vec<[Vertex; 2]>,
    /// Edges that are creases, with the line of each.
    ridges: Vec<(usize, usize)>,
    ignored: Vec<(usize, &'static str, &'static str)>,
    /// Elements that a cage cannot hold, section by section, with the line of the number.
    foreign: Vec<(String, usize)>,
    has_curved: bool,
    pyramids: Vec<Pyramid>,
}

/// Reads a mesh from the bytes of a `.mesh` file.
pub fn read(bytes: &[u8]) -> Result<SolidMesh> {
    let mut words = Words::new(bytes);
    header(&mut words)?;
    let mut sections = Sections::default();
    loop {
        match keyword(&mut words, "a section or End")? {
            "End" | "END" => break,
            keyword => section(&mut words, keyword, &mut sections)?,
        }
    }
    finish(sections)
}

/// The next word that is in no comment.
fn keyword<'a>(words: &mut Words<'a>, expected: &str) -> Result<&'a str> {
    loop {
        let word = words.word(expected)?;
        if !word.starts_with('#') {
            return Ok(word);
        }
        words.rest_of_line()?;
    }
}

fn header(words: &mut Words<'_>) -> Result<()> {
    let first = keyword(words, "MeshVersionFormatted")?;
    if first == "MFEM" {
        return Err(words
            .error("this is an MFEM mesh, which is another format with the same extension")
            .advise("convert it: MFEM's tool `convert-dc` writes VTK"));
    }
    if first != "MeshVersionFormatted" {
        return Err(words
            .error(format!(
                "expected MeshVersionFormatted, found \"{}\"",
                shown(first)
            ))
            .advise("this is no Medit mesh"));
    }
    let version: u32 = words.number("the version of the format, 1 to 4")?;
    if !(1..=4).contains(&version) {
        return Err(words.error(format!(
            "expected the version of the format, 1 to 4, found \"{version}\""
        )));
    }
    let keyword = keyword(words, "Dimension")?;
    let dimension: u32 = words.number("the dimension, 3")?;
    if keyword != "Dimension" || dimension != 3 {
        return Err(words
            .error(format!(
                "expected Dimension 3, found \"{} {dimension}\"",
                shown(keyword)
            ))
            .advise("a cage is a mesh of tetrahedra in space"));
    }
    Ok(())
}

fn section(words: &mut Words<'_>, keyword: &str, sections: &mut Sections) -> Result<()> {
    match keyword {
        "Vertices" => vertices(words, &mut sections.mesh),
        "Tetrahedra" => {
            for (corners, label) in cells(words, sections, ("tetrahedron", "tetrahedra"))? {
                sections.mesh.cells.tetrahedra.push(corners);
                sections.mesh.labels.tetrahedra.push(label);
            }
            Ok(())
        }
        "Edges" => {
            for _ in 0..words.number::<u64>("the number of edges")? {
                let edge = corners(words, sections.mesh.points.len(), "a vertex of an edge")?;
                words.number::<i64>("the reference of an edge")?;
                sections.edges.push(edge);
            }
            Ok(())
        }
        "Ridges" => {
            for _ in 0..words.number::<u64>("the number of ridges")? {
                let edge = words.number("the edge of a ridge")?;
                sections.ridges.push((edge, words.word_line()));
            }
            Ok(())
        }
        "Corners" => {
            for _ in 0..words.number::<u64>("the number of corners")? {
                let [vertex] =
                    corners(words, sections.mesh.points.len(), "the vertex of a corner")?;
                sections.mesh.features.corners.push(vertex);
            }
            Ok(())
        }
        "Triangles" => left_out(words, 4, ("triangle", "triangles"), sections),
        "Quadrilaterals" => left_out(words, 5, ("quadrilateral", "quadrilaterals"), sections),
        "Hexahedra" | "Hexaedra" => {
            for (corners, label) in cells(words, sections, ("hexahedron", "hexahedra"))? {
                sections.mesh.cells.hexahedra.push(corners);
                sections.mesh.labels.hexahedra.push(label);
            }
            Ok(())
        }
        "Prisms" | "Pentahedra" | "Pentaedra" => {
            for (corners, label) in cells(words, sections, ("prism", "prisms"))? {
                sections.mesh.cells.prisms.push(corners);
                sections.mesh.labels.prisms.push(label);
            }
            Ok(())
        }
        "Pyramids" => {
            let pyramids = cells(words, sections, ("pyramid", "pyramids"))?.into_iter();
            let pyramid = |(corners, label)| Pyramid { corners, label };
            sections.pyramids.extend(pyramids.map(pyramid));
            Ok(())
        }
        _ if ["P2", "P3", "P4", "Q2", "Q3", "Q4"]
            .iter()
            .any(|order| keyword.contains(order)) =>
        {
            sections.has_curved = true;
            let of = |elements: &str| format!("{elements} of second or higher order ({keyword})");
            foreign(words, keyword, (&of("element"), &of("elements")), sections)
        }
        _ if keyword.starts_with(|first: char| first.is_ascii_alphabetic()) => skip(words, keyword),
        _ => Err(words
            .error(format!("expected a section, found \"{}\"", shown(keyword)))
            .advise("the number at the start of the section before may be wrong")),
    }
}

fn vertices(words: &mut Words<'_>, mesh: &mut SolidMesh) -> Result<()> {
    let number: Vertex = words.number("the number of vertices")?;
    if !mesh.points.is_empty() {
        return Err(words.error("there is a second section Vertices"));
    }
    for _ in 0..number {
        let point = [
            words.coordinate("the x coordinate of a vertex")?,
            words.coordinate("the y coordinate of a vertex")?,
            words.coordinate("the z coordinate of a vertex")?,
        ];
        // Some programs write references as real numbers.
        words.number::<f64>("the reference of a vertex")?;
        mesh.points.push(point);
    }
    Ok(())
}

/// A section of cells: their corners and references.
fn cells<const N: usize>(
    words: &mut Words<'_>,
    sections: &Sections,
    (singular, plural): (&str, &str),
) -> Result<Vec<([Vertex; N], i32)>> {
    let mut cells = Vec::new();
    for _ in 0..words.number::<u64>(&format!("the number of {plural}"))? {
        let vertices = sections.mesh.points.len();
        let cell = corners(words, vertices, &format!("a vertex of a {singular}"))?;
        let label = words.number(&format!("the reference of a {singular}"))?;
        cells.push((cell, label));
    }
    Ok(cells)
}

/// Vertices, which Medit counts from 1.
fn corners<const N: usize>(
    words: &mut Words<'_>,
    vertices: usize,
    expected: &str,
) -> Result<[Vertex; N]> {
    let mut corners = [0; N];
    for corner in &mut corners {
        let listed: i64 = words.number(expected)?;
        let index = listed
            .checked_sub(1)
            .and_then(|index| Vertex::try_from(index).ok());
        let in_range = index.filter(|index| usize::try_from(*index).is_ok_and(|i| i < vertices));
        *corner = in_range.ok_or_else(|| {
            words
                .error(format!(
                    "expected {expected}, 1 to {vertices}, found \"{listed}\""
                ))
                .advise("the section Vertices must come first and hold all vertices")
        })?;
    }
    Ok(corners)
}

fn left_out(
    words: &mut Words<'_>,
    numbers: usize,
    (singular, plural): (&'static str, &'static str),
    sections: &mut Sections,
) -> Result<()> {
    let number: usize = words.number(&format!("the number of {plural}"))?;
    for _ in 0..number {
        for _ in 0..numbers {
            words.number::<i64>(&format!("a vertex or the reference of a {singular}"))?;
        }
    }
    sections.ignored.push((number, singular, plural));
    Ok(())
}

/// Counts elements that a cage cannot hold and moves past them.
fn foreign(
    words: &mut Words<'_>,
    keyword: &str,
    (singular, plural): (&str, &str),
    sections: &mut Sections,
) -> Result<()> {
    let number: usize = words.number(&format!("the number of {plural}"))?;
    if number > 0 {
        let counted = count(number, singular, plural);
        sections.foreign.push((counted, words.word_line()));
    }
    skip(words, keyword)
}

/// Moves past a section that says nothing about the mesh itself: numbers up to the next word.
fn skip(words: &mut Words<'_>, keyword: &str) -> Result<()> {
    let place = words.place();
    while !words.is_keyword_next() {
        if words.next_word()?.is_none() {
            return Err(
                Error::new(format!("the file ends in the section {}", shown(keyword)))
                    .at(place)
                    .advise("the file seems to be cut off; write it again"),
            );
        }
    }
    Ok(())
}

fn finish(sections: Sections) -> Result<SolidMesh> {
    if let Some((_, line)) = sections.foreign.first() {
        let counted: Vec<String> = sections
            .foreign
            .iter()
            .map(|(name, _)| name.clone())
            .collect();
        let advice = match sections.has_curved {
            true => "write the mesh at first order",
            false => "mesh the volume with tetrahedra alone",
        };
        return Err(Error::new(format!(
            "the mesh has {}; a cage consists of tetrahedra, octahedra, prisms and hexahedra with straight edges",
            listed(&counted)
        ))
        .at_line(*line)
        .advise(advice));
    }
    let mut mesh = sections.mesh;
    pyramids::add(&sections.pyramids, true, &mut mesh);
    for (edge, line) in &sections.ridges {
        let place = edge.checked_sub(1);
        let crease = place.and_then(|index| sections.edges.get(index));
        let crease = crease.ok_or_else(|| {
            Error::new(format!(
                "expected the edge of a ridge, 1 to {}, found \"{edge}\"",
                sections.edges.len()
            ))
            .at_line(*line)
        })?;
        mesh.features.creases.push(*crease);
    }
    if mesh.cells.is_empty() {
        return Err(Error::new("the mesh has no tetrahedra")
            .advise("a cage is a mesh of the volume, not of its surface"));
    }
    mesh.features.normalise();
    mesh.labels.drop_if_zero();
    let mut ignored: Vec<String> = sections
        .ignored
        .into_iter()
        .filter(|(number, ..)| *number > 0)
        .map(|(number, singular, plural)| count(number, singular, plural))
        .collect();
    let smooth = sections.edges.len() - mesh.features.creases.len().min(sections.edges.len());
    if smooth > 0 {
        ignored.push(format!(
            "{} that no ridge names",
            count(smooth, "edge", "edges")
        ));
    }
    if !ignored.is_empty() {
        mesh.notes.push(format!("left out: {}", ignored.join(", ")));
    }
    Ok(mesh)
}
