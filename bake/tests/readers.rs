//! Readers: what they read, what they refuse and in which words, and that nothing makes them panic.

mod common;

use common::{TWO_TETRAHEDRA_2, TWO_TETRAHEDRA_4, data};
use octruss_bake::check;
use octruss_bake::mesh::{Cells, Features, Labels, SolidMesh};
use octruss_bake::read::{features, gmsh, motion, obj, vtk, vtu};
use octruss_bake::write;

/// The corners of `data/make_vtk_samples.py`.
const CORNERS: [[f64; 3]; 4] = [
    [0.1, 0.2, -0.3],
    [1.7, 0.0, 0.1],
    [-0.2, 2.3, 0.4],
    [0.3, 0.1, 1.9],
];

/// What that script writes: edge midpoints in the order 01 02 03 12 13 23, cells as in the brief
/// description of the split.
fn split_tetrahedron() -> SolidMesh {
    let mut points = CORNERS.to_vec();
    for [a, b] in [[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]] {
        points.push(std::array::from_fn(|axis| {
            (CORNERS[a][axis] + CORNERS[b][axis]) / 2.0
        }));
    }
    SolidMesh {
        points,
        cells: Cells {
            tetrahedra: vec![[0, 4, 5, 6], [4, 1, 7, 8], [5, 7, 2, 9], [6, 8, 9, 3]],
            octahedra: vec![[4, 5, 6, 9, 8, 7]],
            ..Cells::default()
        },
        ..SolidMesh::default()
    }
}

fn vtu_text(mesh: &SolidMesh) -> String {
    let mut bytes = Vec::new();
    write::vtu::write(mesh, &mut bytes).unwrap();
    String::from_utf8(bytes).unwrap()
}

#[test]
fn gmsh_2_and_4_give_the_same_mesh() {
    let expected = SolidMesh {
        points: vec![
            [0.0, 0.0, 0.0],
            [2.0, 0.0, 0.0],
            [0.0, 2.0, 0.0],
            [0.5, 0.25, 2.0],
            [0.5, 0.5, -2.0],
        ],
        cells: Cells { tetrahedra: vec![[0, 1, 2, 3], [0, 2, 1, 4]], octahedra: vec![], ..Cells::default() },
        features: Features { creases: vec![[0, 1]], corners: vec![3], faces: vec![], sheets: vec![], quads: vec![] },
        labels: Labels { tetrahedra: vec![9, 9], octahedra: vec![], ..Labels::default() },
        channels: vec![],
        notes: vec![
            "left out: 1 line, 1 triangle (in no physical group whose name starts with \"crease\" for curves and surfaces, \"sheet\" for surfaces or \"corner\" for points)".to_owned(),
        ],
    };
    assert_eq!(gmsh::read(TWO_TETRAHEDRA_2.as_bytes()).unwrap(), expected);
    assert_eq!(gmsh::read(TWO_TETRAHEDRA_4.as_bytes()).unwrap(), expected);
    let windows = TWO_TETRAHEDRA_4.replace('\n', "\r\n");
    assert_eq!(gmsh::read(windows.as_bytes()).unwrap(), expected);
}

/// The error that a reader gives when a piece of a sound file is replaced.
fn broken<T: std::fmt::Debug>(
    read: fn(&[u8]) -> octruss_bake::error::Result<T>,
    text: &str,
    from: &str,
    to: &str,
) -> String {
    assert!(text.contains(from), "{from}");
    read(text.replacen(from, to, 1).as_bytes())
        .unwrap_err()
        .to_string()
}

#[test]
fn gmsh_errors_name_the_line_and_what_to_do() {
    for (text, from, to, message) in [
        (
            TWO_TETRAHEDRA_2,
            "2.2 0 8",
            "2.2 1 8",
            "byte 20: expected the number 1 in four bytes, which shows the byte order, found [36, 69, 110, 100]\n  help: the file is damaged, or its line ends were changed; write it again",
        ),
        (
            TWO_TETRAHEDRA_2,
            "2.2 0 8",
            "4 0 8",
            "line 2: expected MSH version 2.2 or 4.1, found \"4\"\n  help: save it again: `gmsh MESH -save -format msh41 -o NEW.msh`",
        ),
        (
            TWO_TETRAHEDRA_2,
            "$MeshFormat",
            "MeshVersionFormatted 2",
            "line 1: expected $MeshFormat, found \"MeshVersionFormatted\"\n  help: this is no Gmsh mesh of version 2 or 4; save it as \"Version 4.1 ASCII\"",
        ),
        (
            TWO_TETRAHEDRA_2,
            "20 2 0 0",
            "20 2 zero 0",
            "line 16: expected the y coordinate of a node, found \"zero\"",
        ),
        (
            TWO_TETRAHEDRA_2,
            "20 2 0 0",
            "20 2 nan 0",
            "line 16: expected the y coordinate of a node, found NaN, which is no finite number",
        ),
        (
            TWO_TETRAHEDRA_2,
            "20 2 0 0",
            "10 2 0 0",
            "line 16: node 10 is listed twice\n  help: give every node a tag of its own",
        ),
        (
            TWO_TETRAHEDRA_2,
            "5\n10",
            "6\n10",
            "line 20: expected the tag of a node, found \"$EndNodes\"",
        ),
        (
            TWO_TETRAHEDRA_2,
            "5\n10",
            "4\n10",
            "line 19: expected $EndNodes, found \"50\"\n  help: a count at the start of the section may be wrong",
        ),
        (
            TWO_TETRAHEDRA_2,
            "10 30 20 50",
            "10 30 20 51",
            "line 28: an element names node 51, which the file does not list\n  help: the mesh is incomplete; write it again",
        ),
        (
            TWO_TETRAHEDRA_2,
            "6 4 2 9 1 10 30 20 50",
            "6 11 2 9 1 1 2 3 4 5 6 7 8 9 10",
            "line 28: the mesh has 1 element of second or higher order (type 11); a cage consists of tetrahedra, octahedra, prisms and hexahedra with straight edges\n  help: mesh at first order: Mesh.ElementOrder = 1 in Gmsh, or `gmsh -order 1`",
        ),
        (
            TWO_TETRAHEDRA_2,
            "6 4 2 9 1 10 30 20 50",
            "6 77 2 9 1 1 2 3 4",
            "line 28: element type 77 is not known\n  help: a cage consists of tetrahedra (Gmsh element type 4)",
        ),
        (
            TWO_TETRAHEDRA_2,
            "6\n1 15 2 7 4 40\n",
            "9\n1 15 2 7 4 40\n7 6 0 1 2 3 4 5 6\n8 5 0 1 2 3 4 5 6 7 8\n9 6 0 1 2 3 4 5 6\n",
            "line 24: an element names node 1, which the file does not list\n  help: the mesh is incomplete; write it again",
        ),
        (
            TWO_TETRAHEDRA_2,
            "0 7 \"Corner top\"",
            "2 7 \"sheet skin\"",
            "line 26: a physical surface whose name starts with \"sheet\" holds this quadrangle; sheets consist of triangles\n  help: mesh the surface with triangles, or rename the group",
        ),
        (
            TWO_TETRAHEDRA_2,
            "$EndElements\n",
            "",
            "line 29: expected $EndElements, found the end of the file\n  help: the file seems to be cut off; write it again",
        ),
        (
            TWO_TETRAHEDRA_2,
            "$Comments",
            "$Comment",
            "the section $Comment has no $EndComment",
        ),
        (
            TWO_TETRAHEDRA_4,
            "$Entities\n1 2 1 1",
            "$Entities\n1 2 1 x",
            "line 11: expected the number of points, curves, surfaces or volumes, found \"x\"",
        ),
        (
            TWO_TETRAHEDRA_4,
            "3 1 0 4\n20",
            "3 1 0 5\n20",
            "line 32: expected the z coordinate of a node, found \"$EndNodes\"",
        ),
        (
            TWO_TETRAHEDRA_4,
            "3 1 4 2",
            "3 1 4 3",
            "line 46: expected the tag of an element, found \"$EndElements\"",
        ),
        (
            TWO_TETRAHEDRA_4,
            "$Nodes",
            "$PartitionedEntities\n",
            "line 18: the mesh is partitioned\n  help: join the parts before saving: Mesh > Unpartition in Gmsh",
        ),
    ] {
        let text = if to.contains("sheet skin") {
            text.replace("4 2 2 0 1 10 20 30", "4 3 2 7 1 10 20 30 40")
        } else {
            text.to_owned()
        };
        let error = broken(gmsh::read, &text, from, to);
        assert!(
            error.contains(message),
            "{error}\nshould contain\n{message}"
        );
    }
}

#[test]
fn gmsh_without_cells_or_sections() {
    let error = gmsh::read(b"$MeshFormat\n4.1 0 8\n$EndMeshFormat\n").unwrap_err();
    assert!(
        error
            .to_string()
            .starts_with("the file has no section $Nodes\n  help: "),
        "{error}"
    );
    let only_skin = TWO_TETRAHEDRA_2
        .replace("6\n1 15", "4\n1 15")
        .replace("5 4 2 9 1 10 20 30 40\n6 4 2 9 1 10 30 20 50\n", "");
    let error = gmsh::read(only_skin.as_bytes()).unwrap_err();
    assert_eq!(error.message(), "the mesh has no tetrahedra");
}

#[test]
fn a_line_with_a_count_beyond_all_bounds_is_an_error() {
    for count in ["18446744073709551615", "99999999999999999999", "-1"] {
        for (text, from) in [(TWO_TETRAHEDRA_2, "5\n10"), (TWO_TETRAHEDRA_2, "6\n1 15")] {
            let to = from.replacen(['5', '6'], count, 1);
            broken(gmsh::read, text, from, &to);
        }
    }
}

/// Samples that VTK itself wrote; see `data/make_vtk_samples.py`.
#[test]
fn vtu_in_every_encoding() {
    let mut expected = split_tetrahedron();
    expected.notes = vec!["left out, for want of volume: 1 triangle".to_owned()];
    for name in [
        "ascii",
        "inline-plain-32-little",
        "inline-zlib-64-big",
        "raw-plain-64-little",
        "raw-zlib-32-big",
        "base64-plain-32-big",
        "base64-zlib-64-little",
    ] {
        let bytes = std::fs::read(data(&format!("{name}.vtu"))).unwrap();
        assert_eq!(vtu::read(&bytes).unwrap(), expected, "{name}");
    }
}

/// Legacy files that VTK itself wrote. They list an octahedron's faces, so that its corners may come
/// in another order, with the same opposite pairs. The ASCII file has fewer digits than the numbers.
#[test]
fn legacy_vtk_of_vtk_itself() {
    let expected = split_tetrahedron();
    for name in ["legacy-42-binary", "legacy-51-binary", "legacy-51-ascii"] {
        let mesh = vtk::read(&std::fs::read(data(&format!("{name}.vtk"))).unwrap()).unwrap();
        if name.ends_with("binary") {
            assert_eq!(mesh.points, expected.points, "{name}");
        }
        assert_eq!(mesh.cells.tetrahedra, expected.cells.tetrahedra, "{name}");
        assert_eq!(mesh.cells.octahedra.len(), 1, "{name}");
        assert_eq!(
            opposite_pairs(mesh.cells.octahedra[0]),
            [[4, 9], [5, 8], [6, 7]]
        );
        check::require_positive_volumes(&mesh).unwrap();
        assert_eq!(mesh.notes, ["left out, for want of volume: 1 triangle"]);
    }
}

/// The opposite corners of an octahedron.
fn opposite_pairs([a, b, c, d, e, f]: [u32; 6]) -> [[u32; 2]; 3] {
    let mut pairs = [[a, d], [b, e], [c, f]].map(|[p, q]| [p.min(q), p.max(q)]);
    pairs.sort_unstable();
    pairs
}

#[test]
fn vtu_comes_back_as_it_was_written() {
    let mut mesh = split_tetrahedron();
    assert_eq!(vtu::read(vtu_text(&mesh).as_bytes()).unwrap(), mesh);
    // Digits that only the shortest round trip keeps, and an octahedron that is inside out.
    mesh.points[3] = [1.0 / 3.0, -0.0, f64::MIN_POSITIVE];
    mesh.points[2] = [1e300, f64::EPSILON, -7.000_000_000_000_001];
    mesh.cells.octahedra = vec![[4, 6, 5, 9, 7, 8]];
    let again = vtu::read(vtu_text(&mesh).as_bytes()).unwrap();
    assert_eq!(again, mesh);
    assert!(again.points[3][1].is_sign_negative());
}

/// VTK lists a polyhedron's corners as it likes: the order then comes from the faces.
#[test]
fn vtu_octahedron_with_corners_in_any_order() {
    let text = vtu_text(&split_tetrahedron());
    for listed in ["4 5 6 7 8 9", "9 8 7 6 5 4", "7 4 5 9 6 8"] {
        let mesh = vtu::read(
            text.replace("\n4 5 6 9 8 7\n", &format!("\n{listed}\n"))
                .as_bytes(),
        );
        let [a, b, c, d, e, f] = mesh.unwrap().cells.octahedra[0];
        assert_eq!(opposite_pairs([a, b, c, d, e, f]), [[4, 9], [5, 8], [6, 7]]);
        let position = |vertex: u32| split_tetrahedron().points[vertex as usize];
        let shape =
            octruss_bake::locate::octahedron::Octahedron::new([a, b, c, d, e, f].map(position));
        assert!(shape.is_sound(), "{listed}");
    }
}

#[test]
fn vtu_errors_name_the_line_and_what_to_do() {
    let text = vtu_text(&split_tetrahedron());
    for (from, to, message) in [
        (
            "UnstructuredGrid\" version",
            "PolyData\" version",
            "line 2: expected type=\"UnstructuredGrid\", found \"PolyData\"\n  help: save the mesh as an unstructured grid (.vtu)",
        ),
        (
            "byte_order=\"LittleEndian\"",
            "byte_order=\"LittleEndian\" compressor=\"vtkLZ4DataCompressor\"",
            "line 2: the compressor \"vtkLZ4DataCompressor\" is not read\n  help: save the file with zlib compression or with none",
        ),
        (
            "10\n10\n10\n10\n42",
            "10\n10\n10\n12\n42",
            "line 19: cell 3 (counted from 0) is a hexahedron with 4 corners",
        ),
        (
            "10\n10\n10\n10\n42",
            "14\n12\n10\n14\n42",
            "line 19: cell 0 (counted from 0) is a pyramid with 4 corners",
        ),
        (
            "10\n10\n10\n10\n42",
            "10\n10\n10\n24\n42",
            "the grid has 1 cell of second or higher order (type 24), first cell 3 (counted from 0); a cage consists of tetrahedra, octahedra, prisms and hexahedra with straight edges\n  help: write the mesh at first order",
        ),
        (
            "10\n10\n10\n10\n42",
            "10\n10\n10\n99\n42",
            "the grid has 1 cell of an unknown type (type 99), first cell 3 (counted from 0); a cage consists of tetrahedra, octahedra, prisms and hexahedra with straight edges",
        ),
        (
            "10\n10\n10\n10\n42",
            "10\n10\n10\n10",
            "expected 5 offsets and 5 types, found 5 and 4",
        ),
        (
            "\n0 4 5 6\n",
            "\n0 4 5 16\n",
            "cell 0 (counted from 0) names vertex 16, but there are 10 vertices",
        ),
        (
            "\n0 4 5 6\n",
            "\n0 4 5 -6\n",
            "cell 0 (counted from 0) names vertex -6, but there are 10 vertices",
        ),
        (
            "\n4\n8\n",
            "\n5\n8\n",
            "cell 0 (counted from 0) is a tetrahedron with 5 corners",
        ),
        (
            "\n4\n8\n",
            "\n4\n800\n",
            "cell 1 (counted from 0) has offsets beyond the connectivity",
        ),
        (
            "Name=\"faces\"",
            "Name=\"sides\"",
            "there are polyhedra, but no array named faces",
        ),
        (
            "8 3 4 6 5",
            "9 3 4 6 5",
            "cell 4 (counted from 0) has an incomplete list of faces",
        ),
        (
            "8 3 4 6 5",
            "8 3 4 5 6",
            "cell 4 (counted from 0) is an octahedron whose faces do not all turn the same way",
        ),
        (
            "NumberOfPoints=\"10\"",
            "NumberOfPoints=\"11\"",
            "line 6: expected 11 points of 3 coordinates, found 30 numbers",
        ),
        (
            "\n0.1 0.2 -0.3\n",
            "\n0.1 inf -0.3\n",
            "line 6: point 0 (counted from 0) has a coordinate that is no finite number",
        ),
        (
            "\n0.1 0.2 -0.3\n",
            "\n0.1 ? -0.3\n",
            "line 6: expected a number, found \"?\"",
        ),
        (
            "format=\"ascii\"",
            "format=\"appended\" offset=\"0\"",
            "line 6: the array is appended, but the file has no appended data",
        ),
        ("</VTKFile>", "", "line 54: the file is no valid XML"),
        (
            "Float64",
            "Float16",
            "line 6: expected a number type such as Float64, found \"Float16\"",
        ),
        (
            "<Piece",
            "<Piece NumberOfPoints=\"0\" NumberOfCells=\"0\"/><Piece",
            "line 4: the grid has more than one piece",
        ),
    ] {
        let error = broken(vtu::read, &text, from, to);
        assert!(
            error.contains(message),
            "{error}\nshould contain\n{message}"
        );
    }
}

#[test]
fn features_are_read_line_by_line() {
    let text = "# rim\ncrease 3 1\n\n  corner 2 # tip\ncrease 1 3\ncorner 0\ncrease-face 3 1 2\nsheet 3 0 1\nsheet 1 0 3\n";
    let features = features::read(text.as_bytes(), 4).unwrap();
    assert_eq!(
        features,
        Features {
            creases: vec![[1, 3]],
            corners: vec![0, 2],
            faces: vec![[1, 2, 3]],
            sheets: vec![[3, 0, 1]],
            quads: vec![],
        }
    );
    for (text, message) in [
        (
            "crease 0 4",
            "line 1: there is no vertex 4; the mesh has 4\n  help: vertices are counted from 0 in the order of the mesh file",
        ),
        (
            "\ncrease 1 1",
            "line 2: both ends of the crease are vertex 1",
        ),
        ("corner x", "line 1: expected a vertex, found \"x\""),
        (
            "corner 1 2",
            "line 1: expected `crease A B`, `crease-face A B C`, `sheet A B C` or `corner A`, found \"corner\" with 2 words after it",
        ),
        (
            "crease-face 0 1 0",
            "line 1: the crease face names a vertex twice",
        ),
        (
            "crease-face 0 1 2 1",
            "line 1: the crease face names a vertex twice",
        ),
    ] {
        assert_eq!(
            features::read(text.as_bytes(), 4).unwrap_err().to_string(),
            message
        );
    }
}

/// Every reader on every beginning of a sound file, and with every byte changed in turn: an answer
/// or an error, never a panic.
#[test]
fn nothing_makes_a_reader_panic() {
    type Reader = fn(&[u8]) -> bool;
    let files: [(Vec<u8>, Reader); 9] = [
        (TWO_TETRAHEDRA_2.into(), |bytes| gmsh::read(bytes).is_ok()),
        (TWO_TETRAHEDRA_4.into(), |bytes| gmsh::read(bytes).is_ok()),
        (vtu_text(&split_tetrahedron()).into(), |bytes| {
            vtu::read(bytes).is_ok()
        }),
        (
            std::fs::read(data("raw-zlib-32-big.vtu")).unwrap(),
            |bytes| vtu::read(bytes).is_ok(),
        ),
        (
            std::fs::read(data("base64-zlib-64-little.vtu")).unwrap(),
            |bytes| vtu::read(bytes).is_ok(),
        ),
        (
            std::fs::read(data("inline-plain-32-little.vtu")).unwrap(),
            |bytes| vtu::read(bytes).is_ok(),
        ),
        (
            "v 1 2 3\nv 4 5 6 \\\n\nv 7 8 9\nf 1/1 2//2 -1 # end\n".into(),
            |bytes| obj::read(bytes).is_ok(),
        ),
        (
            "frame,point,x,y,z\n0,0,1,2,3\n0,1,\"4\",5,6\n".into(),
            |bytes| motion::read_csv(bytes, 2).is_ok(),
        ),
        ("crease 0 1\ncorner 2\n".into(), |bytes| {
            features::read(bytes, 3).is_ok()
        }),
    ];
    for (bytes, read) in files {
        assert!(read(&bytes));
        for end in 0..bytes.len() {
            read(&bytes[..end]);
        }
        let mut changed = bytes.clone();
        for place in 0..bytes.len() {
            for value in [0, b' ', b'-', b'9', b'"', b'\n', 0xff, bytes[place] ^ 1] {
                changed[place] = value;
                read(&changed);
            }
            changed[place] = bytes[place];
        }
    }
}
