//! One cage in every format and every variant of it.
//!
//! Written here from the formats' own descriptions, so that readers are held to more than the
//! project's writers.

use crate::bytes::{Bytes, Numbers};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use flate2::Compression;
use flate2::write::ZlibEncoder;
use octruss::mesh::OCTAHEDRON_FACES;
use octruss_bake::mesh::SolidMesh;
use std::io::Write;

/// A cage as files: the first is the one to be named.
pub struct Cage {
    pub name: String,
    pub files: Vec<(String, Vec<u8>)>,
    /// What the format cannot hold, as a feature file.
    pub features: String,
}

fn cage(name: &str, extension: &str, content: Vec<u8>, features: String) -> Cage {
    Cage {
        name: name.to_owned(),
        files: vec![(format!("{name}.{extension}"), content)],
        features,
    }
}

/// The cage in every format of tetrahedra.
pub fn tetrahedra(mesh: &SolidMesh) -> Vec<Cage> {
    let mut cages = Vec::new();
    for (name, numbers) in [
        ("ascii", Numbers::Ascii),
        ("little-endian", Numbers::Little),
        ("big-endian", Numbers::Big),
    ] {
        cages.push(cage(
            &format!("msh-22-{name}"),
            "msh",
            gmsh_2(mesh, numbers),
            String::new(),
        ));
        cages.push(cage(
            &format!("msh-41-{name}"),
            "msh",
            gmsh_4(mesh, numbers),
            String::new(),
        ));
    }
    cages.push(cage("medit", "mesh", medit(mesh), faces(mesh)));
    for first in [0, 1] {
        let name = format!("tetgen-from-{first}");
        let [node, ele] = tetgen(mesh, first);
        let mut files = vec![(format!("{name}.node"), node), (format!("{name}.ele"), ele)];
        if first == 1 {
            files.reverse();
        }
        cages.push(Cage {
            name,
            files,
            features: features(mesh),
        });
    }
    cages.extend(grids(mesh));
    cages
}

/// The cage in every format that holds octahedra too.
pub fn grids(mesh: &SolidMesh) -> Vec<Cage> {
    let mut cages = Vec::new();
    for (extension, written) in [("vtu", "vtu-written"), ("vtk", "vtk-written")] {
        let mut bytes = Vec::new();
        octruss_bake::write::solid(extension, mesh, &mut bytes).unwrap();
        cages.push(cage(written, extension, bytes, features(mesh)));
    }
    for wide in [false, true] {
        for zlib in [false, true] {
            for big in [false, true] {
                for place in [Place::Inline, Place::Raw, Place::Base64] {
                    let style = Style {
                        wide,
                        zlib,
                        big,
                        place,
                    };
                    let name = format!(
                        "vtu-{}-{}-{}-{place:?}",
                        if wide { 64 } else { 32 },
                        if zlib { "zlib" } else { "plain" },
                        if big { "big" } else { "little" }
                    );
                    cages.push(cage(
                        &name.to_lowercase(),
                        "vtu",
                        vtu(mesh, style),
                        features(mesh),
                    ));
                }
            }
        }
    }
    for (name, numbers) in [("ascii", Numbers::Ascii), ("binary", Numbers::Big)] {
        cages.push(cage(
            &format!("vtk-30-{name}"),
            "vtk",
            vtk(mesh, numbers, false),
            features(mesh),
        ));
        cages.push(cage(
            &format!("vtk-51-{name}"),
            "vtk",
            vtk(mesh, numbers, true),
            features(mesh),
        ));
    }
    cages
}

fn faces(mesh: &SolidMesh) -> String {
    let line = |[a, b, c]: &[u32; 3]| format!("crease-face {a} {b} {c}\n");
    mesh.features.faces.iter().map(line).collect()
}

fn features(mesh: &SolidMesh) -> String {
    let mut text = faces(mesh);
    for [a, b] in &mesh.features.creases {
        text += &format!("crease {a} {b}\n");
    }
    for corner in &mesh.features.corners {
        text += &format!("corner {corner}\n");
    }
    text
}

/// Gmsh's number of an element type, the number of its physical group, its nodes counted from 1.
fn elements(mesh: &SolidMesh) -> Vec<(i32, i32, Vec<i32>)> {
    let from_1 = |vertices: &[u32]| vertices.iter().map(|vertex| *vertex as i32 + 1).collect();
    let mut list = Vec::new();
    for corner in &mesh.features.corners {
        list.push((15, 7, from_1(&[*corner])));
    }
    for edge in &mesh.features.creases {
        list.push((1, 8, from_1(edge)));
    }
    for face in &mesh.features.faces {
        list.push((2, 9, from_1(face)));
    }
    for (cell, label) in mesh.cells.tetrahedra.iter().zip(mesh.labels.iter()) {
        list.push((4, label, from_1(cell)));
    }
    list
}

const GROUPS: &str = "$PhysicalNames\n5\n0 7 \"corner top\"\n1 8 \"crease rim\"\n2 9 \"Crease between\"\n3 1 \"left\"\n3 2 \"right\"\n$EndPhysicalNames\n";

fn gmsh_header(version: &str, numbers: Numbers) -> Bytes {
    let mut out = Bytes::new(numbers);
    out.text(&format!(
        "$MeshFormat\n{version} {} 8\n",
        i32::from(!out.is_text())
    ));
    if !out.is_text() {
        out.int(1);
        out.text("\n");
    }
    out.text("$EndMeshFormat\n");
    out.text(GROUPS);
    out
}

/// MSH 2.2. A binary file holds blocks of elements of one type.
fn gmsh_2(mesh: &SolidMesh, numbers: Numbers) -> Vec<u8> {
    let mut out = gmsh_header("2.2", numbers);
    out.text(&format!("$Nodes\n{}\n", mesh.points.len()));
    for (tag, point) in (1..).zip(&mesh.points) {
        out.int(tag);
        out.reals(point);
        out.end_line();
    }
    let elements = elements(mesh);
    out.text(&format!("$EndNodes\n$Elements\n{}\n", elements.len()));
    for (tag, (kind, group, nodes)) in (1..).zip(&elements) {
        if out.is_text() {
            out.ints(&[tag, *kind, 2, *group, 1]);
        } else {
            out.ints(&[*kind, 1, 2, tag, *group, 1]);
        }
        out.ints(nodes);
        out.end_line();
    }
    out.text("$EndElements\n");
    out.finish()
}

/// MSH 4.1. Each group is an entity of its own, all nodes are the last volume's.
fn gmsh_4(mesh: &SolidMesh, numbers: Numbers) -> Vec<u8> {
    let mut out = gmsh_header("4.1", numbers);
    out.text("$Entities\n");
    out.sizes(&[1, 1, 1, 2]);
    out.end_line();
    for (extent, tag, group) in [(3, 1, 7), (6, 1, 8), (6, 1, 9), (6, 1, 1), (6, 2, 2)] {
        out.int(tag);
        out.reals(&vec![0.5; extent]);
        out.sizes(&[1]);
        out.int(group);
        if extent > 3 {
            out.sizes(&[0]);
        }
        out.end_line();
    }
    let nodes = mesh.points.len() as u64;
    out.text("$EndEntities\n$Nodes\n");
    out.sizes(&[1, nodes, 1, nodes]);
    out.end_line();
    out.ints(&[3, 2, 0]);
    out.sizes(&[nodes]);
    out.end_line();
    for tag in 1..=nodes {
        out.sizes(&[tag]);
        out.end_line();
    }
    for point in &mesh.points {
        out.reals(point);
        out.end_line();
    }
    let elements = elements(mesh);
    let number = elements.len() as u64;
    out.text("$EndNodes\n$Elements\n");
    // A block for each run of one group.
    let blocks: Vec<_> = elements.chunk_by(|a, b| a.1 == b.1).collect();
    out.sizes(&[blocks.len() as u64, number, 1, number]);
    out.end_line();
    let mut tag = 0;
    for block in blocks {
        let (kind, group, _) = block[0];
        let (dimension, entity) = match kind {
            15 => (0, 1),
            1 => (1, 1),
            2 => (2, 1),
            _ => (3, group),
        };
        out.ints(&[dimension, entity, kind]);
        out.sizes(&[block.len() as u64]);
        out.end_line();
        for (.., nodes) in block {
            tag += 1;
            out.sizes(&[tag]);
            out.sizes(&nodes.iter().map(|node| *node as u64).collect::<Vec<_>>());
            out.end_line();
        }
    }
    out.text("$EndElements\n");
    out.finish()
}

fn medit(mesh: &SolidMesh) -> Vec<u8> {
    let mut text = format!(
        "MeshVersionFormatted 2\nDimension 3\n\nVertices\n{}\n",
        mesh.points.len()
    );
    for [x, y, z] in &mesh.points {
        text += &format!("{x} {y} {z} 0\n");
    }
    let creases = &mesh.features.creases;
    text += &format!("\nEdges\n{}\n", creases.len());
    for [a, b] in creases {
        text += &format!("{} {} 0\n", a + 1, b + 1);
    }
    text += &format!("\nRidges\n{}\n", creases.len());
    for edge in 1..=creases.len() {
        text += &format!("{edge}\n");
    }
    text += &format!("\nCorners\n{}\n", mesh.features.corners.len());
    for corner in &mesh.features.corners {
        text += &format!("{}\n", corner + 1);
    }
    text += &format!("\nTetrahedra\n{}\n", mesh.cells.tetrahedra.len());
    for (cell, label) in mesh.cells.tetrahedra.iter().zip(mesh.labels.iter()) {
        let [a, b, c, d] = cell.map(|vertex| vertex + 1);
        text += &format!("{a} {b} {c} {d} {label}\n");
    }
    (text + "\nEnd\n").into_bytes()
}

fn tetgen(mesh: &SolidMesh, first: u32) -> [Vec<u8>; 2] {
    let mut node = format!("# by hand\n{} 3 0 1\n", mesh.points.len());
    for (index, [x, y, z]) in (first..).zip(&mesh.points) {
        node += &format!("{index} {x} {y} {z} 1\n");
    }
    let mut ele = format!("{} 4 1\n", mesh.cells.tetrahedra.len());
    let cells = mesh.cells.tetrahedra.iter().zip(mesh.labels.iter());
    for (index, (cell, label)) in (first..).zip(cells) {
        let [a, b, c, d] = cell.map(|vertex| vertex + first);
        ele += &format!("{index} {a} {b} {c} {d} {label}\n");
    }
    [node.into_bytes(), ele.into_bytes()]
}

/// The faces of an octahedron; the second first, so that corners turn up in a reader's order.
fn octahedron_faces(octahedron: &[u32; 6]) -> Vec<[u32; 3]> {
    let from_second = OCTAHEDRON_FACES.iter().cycle().skip(1).take(8);
    from_second
        .map(|face| face.map(|corner| octahedron[corner]))
        .collect()
}

/// What CELLS lists for each cell.
fn entries(mesh: &SolidMesh) -> Vec<Vec<u32>> {
    let tetrahedra = mesh.cells.tetrahedra.iter().map(|cell| cell.to_vec());
    let octahedra = mesh.cells.octahedra.iter().map(|octahedron| {
        let mut entry = vec![8];
        for [a, b, c] in octahedron_faces(octahedron) {
            entry.extend([3, a, b, c]);
        }
        entry
    });
    tetrahedra.chain(octahedra).collect()
}

fn vtk(mesh: &SolidMesh, numbers: Numbers, is_version_5: bool) -> Vec<u8> {
    let mut out = Bytes::new(numbers);
    let (version, mode) = (
        if is_version_5 { "5.1" } else { "3.0" },
        if out.is_text() { "ASCII" } else { "BINARY" },
    );
    out.text(&format!("# vtk DataFile Version {version}\na cage\n{mode}\nDATASET UNSTRUCTURED_GRID\nPOINTS {} float\n", mesh.points.len()));
    for point in &mesh.points {
        out.singles(point);
        out.end_line();
    }
    let entries = entries(mesh);
    let length: usize = entries.iter().map(Vec::len).sum();
    if is_version_5 {
        out.text(&format!(
            "\nCELLS {} {length}\nOFFSETS vtktypeint64\n",
            entries.len() + 1
        ));
        let mut end = 0;
        out.sizes(&[0]);
        for entry in &entries {
            end += entry.len() as u64;
            out.sizes(&[end]);
        }
        out.text("\nCONNECTIVITY vtktypeint64\n");
        for vertex in entries.iter().flatten() {
            out.sizes(&[u64::from(*vertex)]);
        }
    } else {
        out.text(&format!(
            "\nCELLS {} {}\n",
            entries.len(),
            length + entries.len()
        ));
        for entry in &entries {
            out.int(entry.len() as i32);
            out.ints(
                &entry
                    .iter()
                    .map(|vertex| *vertex as i32)
                    .collect::<Vec<_>>(),
            );
            out.end_line();
        }
    }
    out.text(&format!("\nCELL_TYPES {}\n", entries.len()));
    for cell in mesh.cells.corners() {
        out.int(if cell.len() == 4 { 10 } else { 42 });
    }
    out.text(&format!(
        "\nCELL_DATA {}\nFIELD FieldData 1\nMaterial 1 {} int\n",
        entries.len(),
        entries.len()
    ));
    out.ints(&mesh.labels.iter().collect::<Vec<_>>());
    out.text("\n");
    out.finish()
}

/// Where the numbers of a `.vtu` stand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Place {
    Inline,
    Raw,
    Base64,
}

#[derive(Clone, Copy)]
struct Style {
    wide: bool,
    zlib: bool,
    big: bool,
    place: Place,
}

impl Style {
    fn header(self, number: usize) -> Vec<u8> {
        let bytes = (number as u64).to_le_bytes();
        let mut bytes = bytes[..if self.wide { 8 } else { 4 }].to_vec();
        if self.big {
            bytes.reverse();
        }
        bytes
    }

    /// A block of numbers with its header.
    fn block(self, content: &[u8]) -> Vec<u8> {
        let mut pieces = vec![self.header(content.len())];
        let mut data = content.to_vec();
        if self.zlib {
            let mut encoder = ZlibEncoder::new(Vec::new(), Compression::default());
            encoder.write_all(content).unwrap();
            data = encoder.finish().unwrap();
            // One full block, of which nothing is left over.
            pieces = [1, content.len(), 0, data.len()]
                .map(|number| self.header(number))
                .to_vec();
        }
        let header = pieces.concat();
        match self.place {
            Place::Raw => [header, data].concat(),
            // Header and blocks are encoded each for itself where they are compressed.
            _ if self.zlib => (STANDARD.encode(header) + &STANDARD.encode(data)).into_bytes(),
            _ => STANDARD.encode([header, data].concat()).into_bytes(),
        }
    }

    fn numbers(self) -> Numbers {
        if self.big {
            Numbers::Big
        } else {
            Numbers::Little
        }
    }
}

fn vtu(mesh: &SolidMesh, style: Style) -> Vec<u8> {
    let mut appended = Vec::new();
    let mut array = |attributes: &str, content: Bytes| {
        let block = style.block(&content.finish());
        if style.place == Place::Inline {
            let text = String::from_utf8(block).unwrap();
            return format!("<DataArray {attributes} format=\"binary\">{text}</DataArray>\n");
        }
        let offset = appended.len();
        appended.extend(block);
        format!("<DataArray {attributes} format=\"appended\" offset=\"{offset}\"/>\n")
    };
    let ints = |values: &[i32]| {
        let mut out = Bytes::new(style.numbers());
        out.ints(values);
        out
    };
    let mut points = Bytes::new(style.numbers());
    for point in &mesh.points {
        points.reals(point);
    }
    let cells: Vec<&[u32]> = mesh.cells.corners().collect();
    let corners: Vec<i32> = cells
        .iter()
        .copied()
        .flatten()
        .map(|vertex| *vertex as i32)
        .collect();
    let running = |end: &mut i32, length: usize| {
        *end += length as i32;
        Some(*end)
    };
    let ends: Vec<i32> = cells
        .iter()
        .scan(0, |end, cell| running(end, cell.len()))
        .collect();
    let types: Vec<i32> = cells
        .iter()
        .map(|cell| if cell.len() == 4 { 10 } else { 42 })
        .collect();
    let mut body = format!(
        "<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n<CellData>\n",
        mesh.points.len(),
        cells.len()
    );
    body += &array(
        "type=\"Int32\" Name=\"MaterialIds\"",
        ints(&mesh.labels.iter().collect::<Vec<_>>()),
    );
    body += "</CellData>\n<Points>\n";
    body += &array(
        "type=\"Float64\" Name=\"Points\" NumberOfComponents=\"3\"",
        points,
    );
    body += "</Points>\n<Cells>\n";
    body += &array("type=\"Int32\" Name=\"connectivity\"", ints(&corners));
    body += &array("type=\"Int32\" Name=\"offsets\"", ints(&ends));
    body += &array("type=\"Int32\" Name=\"types\"", ints(&types));
    if !mesh.cells.octahedra.is_empty() {
        let entries = entries(mesh);
        let polyhedra = &entries[mesh.cells.tetrahedra.len()..];
        let stream: Vec<i32> = polyhedra
            .iter()
            .flatten()
            .map(|entry| *entry as i32)
            .collect();
        let ends = polyhedra
            .iter()
            .scan(0, |end, entry| running(end, entry.len()));
        let ends: Vec<i32> = mesh
            .cells
            .tetrahedra
            .iter()
            .map(|_| -1)
            .chain(ends)
            .collect();
        body += &array("type=\"Int32\" Name=\"faces\"", ints(&stream));
        body += &array("type=\"Int32\" Name=\"faceoffsets\"", ints(&ends));
    }
    body += "</Cells>\n</Piece>\n";
    let compressor = if style.zlib {
        " compressor=\"vtkZLibDataCompressor\""
    } else {
        ""
    };
    let mut file = format!(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"{}\" header_type=\"{}\"{compressor}>\n<UnstructuredGrid>\n{body}</UnstructuredGrid>\n",
        if style.big { "BigEndian" } else { "LittleEndian" },
        if style.wide { "UInt64" } else { "UInt32" },
    )
    .into_bytes();
    if style.place != Place::Inline {
        let encoding = if style.place == Place::Raw {
            "raw"
        } else {
            "base64"
        };
        file.extend(format!("<AppendedData encoding=\"{encoding}\">\n_").bytes());
        file.extend(appended);
        file.extend(b"\n</AppendedData>\n");
    }
    file.extend(b"</VTKFile>\n");
    file
}
