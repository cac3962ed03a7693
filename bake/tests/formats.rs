//! Every format of cages and models: the same content from each, and what each refuses, in words.

mod common;

use common::{Folder, data, model};
use octruss_bake::check;
use octruss_bake::error::Result;
use octruss_bake::geometry::tetrahedron_volume_6;
use octruss_bake::mesh::{Cells, Channel, Features, Labels, SolidMesh};
use octruss_bake::read::{self, gmsh, medit, obj, off, ply, stl, tetgen, vtk, vtu};
use octruss_bake::write;
use std::path::Path;

/// What `data/make_gmsh_samples.py` says.
fn two_tetrahedra() -> SolidMesh {
    SolidMesh {
        points: vec![
            [0.0, 0.0, 0.0],
            [2.0, 0.0, 0.0],
            [0.0, 2.0, 0.0],
            [0.5, 0.25, 2.0],
            [0.5, 0.5, -2.0],
        ],
        cells: Cells {
            tetrahedra: vec![[0, 1, 2, 3], [0, 2, 1, 4]],
            octahedra: vec![],
            ..Cells::default()
        },
        labels: Labels {
            tetrahedra: vec![1, 2],
            octahedra: vec![],
            ..Labels::default()
        },
        ..SolidMesh::default()
    }
}

/// Files that Gmsh wrote; the order of corners is judged by the sign of the volumes.
#[test]
fn files_of_gmsh_in_every_format() {
    for name in [
        "gmsh-22-ascii.msh",
        "gmsh-22-binary.msh",
        "gmsh-41-ascii.msh",
        "gmsh-41-binary.msh",
    ] {
        let mesh = read::solid(&data(name)).unwrap();
        let expected = SolidMesh {
            features: Features {
                creases: vec![[0, 1]],
                corners: vec![3],
                faces: vec![[0, 1, 2]],
                ..Features::default()
            },
            ..two_tetrahedra()
        };
        assert_eq!(mesh, expected, "{name}");
        check::require_positive_volumes(&mesh).unwrap();
    }
    for (name, note) in [
        (
            "gmsh-ascii.vtk",
            "left out, for want of volume: 1 vertex cell, 1 line, 1 triangle",
        ),
        (
            "gmsh-binary.vtk",
            "left out, for want of volume: 1 vertex cell, 1 line, 1 triangle",
        ),
        (
            "gmsh.mesh",
            "left out: 1 triangle, 1 edge that no ridge names",
        ),
    ] {
        let mesh = read::solid(&data(name)).unwrap();
        let expected = SolidMesh {
            notes: vec![note.to_owned()],
            ..two_tetrahedra()
        };
        assert_eq!(mesh, expected, "{name}");
        check::require_positive_volumes(&mesh).unwrap();
    }
}

const MEDIT: &str = "MeshVersionFormatted 2
# by hand
Dimension 3
Vertices
5
0 0 0 0
2 0 0 0
0 2 0 0
0.5 0.25 2 0
0.5 0.5 -2 0
Edges
2
2 1 5
2 3 5
Ridges
1
1
RequiredVertices
1
2
Corners
1
4
Triangles
1
1 2 3 0
Tetrahedra
2
1 2 3 4 1
1 3 2 5 2
End
";

#[test]
fn medit_ridges_and_corners_are_creases_and_corners() {
    let expected = SolidMesh {
        features: Features {
            creases: vec![[0, 1]],
            corners: vec![3],
            ..Features::default()
        },
        notes: vec!["left out: 1 triangle, 1 edge that no ridge names".to_owned()],
        ..two_tetrahedra()
    };
    assert_eq!(medit::read(MEDIT.as_bytes()).unwrap(), expected);
}

const NODE: &str = "# by hand\n5 3 2 1\n1 0 0 0 20 0.5 0\n2 2 0 0 30 0.25 1\n3 0 2 0 20 0.5 1\n\n4 0.5 0.25 2 20 1e-3 1 # top\n5 0.5 0.5 -2 25 -7 1\n";
const ELE: &str = "2 4 1\n1 1 2 3 4 1\n2 1 3 2 5 2\n";

fn read_tetgen(node: &str, ele: &str) -> Result<SolidMesh> {
    tetgen::read(
        (Path::new("cage.node"), node.as_bytes()),
        (Path::new("cage.ele"), ele.as_bytes()),
    )
}

#[test]
fn tetgen_attributes_are_channels_and_labels() {
    let expected = SolidMesh {
        channels: vec![
            Channel {
                name: "attribute 0".to_owned(),
                values: vec![20.0, 30.0, 20.0, 20.0, 25.0],
            },
            Channel {
                name: "attribute 1".to_owned(),
                values: vec![0.5, 0.25, 0.5, 1e-3, -7.0],
            },
        ],
        ..two_tetrahedra()
    };
    assert_eq!(read_tetgen(NODE, ELE).unwrap(), expected);
    let from_0 = (
        "5 3\n0 0 0 0\n1 2 0 0\n2 0 2 0\n3 0.5 0.25 2\n4 0.5 0.5 -2\n",
        "2 4\n0 0 1 2 3\n1 0 2 1 4\n",
    );
    let expected = SolidMesh {
        labels: Labels::default(),
        ..two_tetrahedra()
    };
    assert_eq!(read_tetgen(from_0.0, from_0.1).unwrap(), expected);
}

/// TetGen's own files (see `data/tetgen.poly`): a unit cube, whose tetrahedra are all positive and
/// fill it.
#[test]
fn files_of_tetgen() {
    let mesh = read::solid(&data("tetgen.ele")).unwrap();
    assert_eq!(mesh, read::solid(&data("tetgen.node")).unwrap());
    assert_eq!(mesh.points[6], [1.0; 3]);
    assert_eq!(mesh.labels.tetrahedra, [7; 6]);
    check::require_positive_volumes(&mesh).unwrap();
    let volume_6 =
        |cell: &[u32; 4]| tetrahedron_volume_6(cell.map(|corner| mesh.points[corner as usize]));
    let sum: f64 = mesh.cells.tetrahedra.iter().map(volume_6).sum();
    assert_eq!(sum, 6.0);
}

/// A solid with an octahedron, labels and channels.
fn mixed() -> SolidMesh {
    SolidMesh {
        points: vec![
            [0.1, 0.0, 0.0],
            [1.0, 0.0, 1e-17],
            [0.0, 1.0, -0.0],
            [1.0, 1.0, 1.0],
            [0.0, 1.0, 1.0 / 3.0],
            [1.0, 0.0, 1.0],
            [2.0, 2.0, 2.0],
        ],
        cells: Cells {
            tetrahedra: vec![[3, 4, 5, 6]],
            octahedra: vec![[5, 0, 1, 3, 2, 4], [0, 1, 2, 3, 4, 5]],
            ..Cells::default()
        },
        labels: Labels {
            tetrahedra: vec![-4],
            octahedra: vec![7, 0],
            ..Labels::default()
        },
        channels: vec![Channel {
            name: "temperature".to_owned(),
            values: vec![1.0, 0.1, -3.0, 1e300, 0.0, 5.0, 6.0],
        }],
        ..SolidMesh::default()
    }
}

/// What is written comes back: positions to the last digit, corners in their order, labels, channels.
#[test]
fn solids_come_back_as_they_were_written() {
    for (extension, read) in [("vtu", vtu::read as Reader), ("vtk", vtk::read)] {
        let mut bytes = Vec::new();
        write::solid(extension, &mixed(), &mut bytes).unwrap();
        assert_eq!(read(&bytes).unwrap(), mixed(), "{extension}");
    }
}

type Reader = fn(&[u8]) -> Result<SolidMesh>;

/// The form of VTK 5.x: offsets and connectivity, an octahedron as a list of faces, metadata, a
/// field of data.
#[test]
fn vtk_of_version_5() {
    let text = "# vtk DataFile Version 5.1\ntitle\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 5 float\n0 0 0 2 0 0 0 2 0\n0.5 0.25 2 0.5 0.5 -2\nMETADATA\nINFORMATION 0\n\nCELLS 3 8\nOFFSETS vtktypeint64\n0 4 8\nCONNECTIVITY vtktypeint64\n0 1 2 3 0 2 1 4\nCELL_TYPES 2\n10 10\nCELL_DATA 2\nFIELD FieldData 1\nlabel 1 2 int\n1 2\nPOINT_DATA 5\nVECTORS speed double\n0 0 0 0 0 0 0 0 0 0 0 0 0 0 0\n";
    let expected = SolidMesh {
        notes: vec!["left out of the data on points: \"speed\" (one integer a cell is a label, one real number a point a channel)".to_owned()],
        ..two_tetrahedra()
    };
    assert_eq!(vtk::read(text.as_bytes()).unwrap(), expected);
}

/// The message when one piece of a sound text is replaced.
fn broken<T: std::fmt::Debug>(
    read: impl Fn(&[u8]) -> Result<T>,
    text: &str,
    from: &str,
    to: &str,
) -> String {
    assert!(text.contains(from), "{from}");
    let broken = text.replacen(from, to, 1);
    read(broken.as_bytes()).unwrap_err().to_string()
}

#[test]
fn medit_errors() {
    for (from, to, message) in [
        (
            "MeshVersionFormatted 2",
            "MFEM mesh v1.0",
            "line 1: this is an MFEM mesh, which is another format with the same extension\n  help: convert it: MFEM's tool `convert-dc` writes VTK",
        ),
        (
            "MeshVersionFormatted",
            "$MeshFormat",
            "line 1: expected MeshVersionFormatted, found \"$MeshFormat\"\n  help: this is no Medit mesh",
        ),
        (
            "MeshVersionFormatted 2\n# by hand\nDimension 3",
            "MeshVersionFormatted 2\nDimension 2",
            "line 2: expected Dimension 3, found \"Dimension 2\"\n  help: a cage is a mesh of tetrahedra in space",
        ),
        (
            "Vertices\n5",
            "Vertices\n6",
            "line 11: expected the x coordinate of a vertex, found \"Edges\"",
        ),
        (
            "Vertices\n5",
            "Vertices\n4",
            "line 10: expected a section, found \"0.5\"\n  help: the number at the start of the section before may be wrong",
        ),
        (
            "0.5 0.25 2 0",
            "0.5 inf 2 0",
            "line 9: expected the y coordinate of a vertex, found inf, which is no finite number",
        ),
        (
            "1 3 2 5 2",
            "1 3 2 6 2",
            "line 30: expected a vertex of a tetrahedron, 1 to 5, found \"6\"\n  help: the section Vertices must come first and hold all vertices",
        ),
        (
            "Ridges\n1\n1",
            "Ridges\n1\n3",
            "line 17: expected the edge of a ridge, 1 to 2, found \"3\"",
        ),
        (
            "Tetrahedra\n2",
            "TetrahedraP2\n2",
            "line 28: the mesh has 2 elements of second or higher order (TetrahedraP2); a cage consists of tetrahedra, octahedra, prisms and hexahedra with straight edges\n  help: write the mesh at first order",
        ),
        (
            "Tetrahedra\n2",
            "Hexahedra\n2",
            "line 31: expected a vertex of a hexahedron, found \"End\"",
        ),
        (
            "End\n",
            "",
            "line 31: expected a section or End, found the end of the file\n  help: the file seems to be cut off; write it again",
        ),
        (
            "Tetrahedra\n2\n1 2 3 4 1\n1 3 2 5 2\n",
            "",
            "the mesh has no tetrahedra\n  help: a cage is a mesh of the volume, not of its surface",
        ),
    ] {
        let text = if from.contains("by hand") {
            MEDIT.to_owned()
        } else {
            MEDIT.replace(
                "MeshVersionFormatted 2\n# by hand\nDimension 3",
                "MeshVersionFormatted 2\n\nDimension 3",
            )
        };
        assert_eq!(broken(medit::read, &text, from, to), message);
    }
}

#[test]
fn tetgen_errors_name_the_file() {
    for (from, to, message) in [
        (
            "5 3 2 1",
            "5 2 2 1",
            "cage.node, line 2: expected the dimension, 3, found \"2\"\n  help: a cage is a mesh of tetrahedra in space",
        ),
        (
            "5 3 2 1",
            "6 3 2 1",
            "cage.node, line 8: expected vertex 5 (counted from 0) of 6, found the end of the file\n  help: the file seems to be cut off; write it again",
        ),
        (
            "3 0 2 0",
            "4 0 2 0",
            "cage.node, line 5: expected the index of a vertex, found \"4\"\n  help: vertices are counted from 0 or 1 without gaps",
        ),
        (
            "2 2 0 0 30",
            "2 2 0 nan 30",
            "cage.node, line 4: expected the z coordinate of a vertex, found NaN, which is no finite number",
        ),
        (
            "25 -7 1",
            "25",
            "cage.node, line 8: expected an attribute of a vertex, found the end of the line",
        ),
    ] {
        let error = broken(
            |node| read_tetgen(std::str::from_utf8(node).unwrap(), ELE),
            NODE,
            from,
            to,
        );
        assert_eq!(error, message);
    }
    for (from, to, message) in [
        (
            "2 4 1",
            "2 10 1",
            "cage.ele, line 1: the mesh has 2 tetrahedra of second order (10 vertices each); a cage consists of tetrahedra, octahedra, prisms and hexahedra with straight edges\n  help: run TetGen without -o2",
        ),
        (
            "2 4 1",
            "0 4 1",
            "cage.ele, line 1: the mesh has no tetrahedra",
        ),
        (
            "2 4 1",
            "3 4 1",
            "cage.ele, line 3: expected tetrahedron 2 (counted from 0) of 3, found the end of the file\n  help: the file seems to be cut off; write it again",
        ),
        (
            "3 2 5 2",
            "3 2 6 2",
            "cage.ele, line 3: names vertex 6, but the .node file has 5 vertices counted from 1",
        ),
        (
            "2 1 3 2 5 2",
            "2 1 3 2 5 2.5",
            "cage.ele, line 3: expected a whole number of 32 bits as the attribute of a tetrahedron, found 2.5",
        ),
    ] {
        let error = broken(
            |ele| read_tetgen(NODE, std::str::from_utf8(ele).unwrap()),
            ELE,
            from,
            to,
        );
        assert_eq!(error, message);
    }
}

#[test]
fn vtk_errors() {
    let mut bytes = Vec::new();
    write::vtk::write(&mixed(), &mut bytes).unwrap();
    let text = String::from_utf8(bytes).unwrap();
    for (from, to, message) in [
        (
            "# vtk DataFile Version 3.0",
            "<?xml version=\"1.0\"?>",
            "line 1: expected \"# vtk DataFile Version\" and a number, found \"<?xml version=\\\"1.0\\\"?>\"\n  help: this is no legacy VTK file; files of VTK's XML formats are named .vtu",
        ),
        (
            "ASCII",
            "TEXT",
            "line 3: expected ASCII or BINARY, found \"TEXT\"",
        ),
        (
            "UNSTRUCTURED_GRID",
            "POLYDATA",
            "line 4: expected DATASET UNSTRUCTURED_GRID, found \"DATASET POLYDATA\"\n  help: save the mesh as an unstructured grid",
        ),
        (
            "double",
            "real",
            "line 5: expected a type of numbers, such as double, found \"real\"",
        ),
        (
            "POINTS 7",
            "POINTS 8",
            "line 13: expected a coordinate of a point, found \"CELLS\"",
        ),
        (
            "2 2 2\n",
            "2 2 nan\n",
            "line 12: point 6 (counted from 0) has a coordinate that is no finite number",
        ),
        (
            "CELLS 3 73",
            "CELLS 4 73",
            "line 16: cell 3 (counted from 0) has entries beyond the 73 integers of CELLS\n  help: the counts behind CELLS may be wrong",
        ),
        (
            "CELLS 3 73",
            "CELLS 2 73",
            "line 16: 34 of the 73 integers of CELLS are left over\n  help: the counts behind CELLS may be wrong",
        ),
        (
            "CELL_TYPES 3",
            "CELL_TYPES 2",
            "line 17: expected a type for each of 3 cells, found 2",
        ),
        (
            "10\n42",
            "12\n42",
            "line 17: cell 0 (counted from 0) is a hexahedron with 4 corners",
        ),
        (
            "4 3 4 5 6",
            "4 3 4 5 9",
            "line 17: cell 0 (counted from 0) names vertex 9, but there are 7 vertices",
        ),
        (
            "label int",
            "label float",
            "line 26: expected a value of the data, found \"POINT_DATA\"",
        ),
        (
            "0.1\n-3",
            "inf\n-3",
            "the array \"temperature\" has a value at point 1 (counted from 0) that is no finite number\n  help: remove the array, or give every point a value",
        ),
    ] {
        let from_text = if from == "label int" {
            text.replace("\n0\nPOINT", "\nPOINT")
        } else {
            text.clone()
        };
        assert_eq!(broken(vtk::read, &from_text, from, to), message);
    }
}

/// The finger's cage and skin, which have coordinates of many digits, through every format that is
/// written or has words: what is read is the same to the last bit. (The same bundle from every pair
/// of formats: `same_bundle`.)
#[test]
fn the_finger_comes_back_from_every_format() {
    let folder = Folder::new();
    let cage = read::solid(&model("finger.msh")).unwrap();
    let skin = read::model(&model("finger.obj")).unwrap();
    let faces: Vec<&[u32]> = skin.faces.iter().map(Vec::as_slice).collect();
    for extension in write::SOLID_EXTENSIONS {
        let mut bytes = Vec::new();
        write::solid(extension, &cage, &mut bytes).unwrap();
        folder.write(&format!("cage.{extension}"), bytes);
    }
    folder.write("cage.mesh", medit_text(&cage));
    let (node, ele) = tetgen_texts(&cage);
    folder.write("cage.node", node);
    folder.write("cage.ele", ele);
    for name in ["cage.vtu", "cage.vtk", "cage.mesh", "cage.ele", "cage.node"] {
        let read = read::solid(&folder.path(name)).unwrap();
        assert!(
            read.points == cage.points && read.cells == cage.cells,
            "{name}"
        );
    }
    for extension in write::SURFACE_EXTENSIONS {
        let mut bytes = Vec::new();
        write::surface(extension, &skin.points, &faces, &mut bytes).unwrap();
        let file = folder.write(&format!("skin.{extension}"), bytes);
        let read = read::model(&file).unwrap();
        assert!(
            read.points == skin.points && read.faces == skin.faces,
            "{extension}"
        );
    }
}

fn medit_text(mesh: &SolidMesh) -> String {
    let mut text = format!(
        "MeshVersionFormatted 2\nDimension 3\nVertices\n{}\n",
        mesh.points.len()
    );
    for [x, y, z] in &mesh.points {
        text += &format!("{x} {y} {z} 0\n");
    }
    text += &format!("Tetrahedra\n{}\n", mesh.cells.tetrahedra.len());
    for cell in &mesh.cells.tetrahedra {
        let [a, b, c, d] = cell.map(|vertex| vertex + 1);
        text += &format!("{a} {b} {c} {d} 0\n");
    }
    text + "End\n"
}

fn tetgen_texts(mesh: &SolidMesh) -> (String, String) {
    let mut node = format!("{} 3 0 0\n", mesh.points.len());
    for (index, [x, y, z]) in mesh.points.iter().enumerate() {
        node += &format!("{index} {x} {y} {z}\n");
    }
    let mut ele = format!("{} 4 0\n", mesh.cells.tetrahedra.len());
    for (index, [a, b, c, d]) in mesh.cells.tetrahedra.iter().enumerate() {
        ele += &format!("{index} {a} {b} {c} {d}\n");
    }
    (node, ele)
}

const PLY: &str = "ply\nformat ascii 1.0\ncomment by hand\nelement vertex 3\nproperty float x\nproperty uchar red\nproperty double y\nproperty float z\nelement face 1\nproperty list uchar int vertex_indices\nproperty float weight\nend_header\n0 255 0.5 1e0\n1 0 0 2\n0 0 1 0\n3 0 1 2 0.5\n";

const MOVED: [[f64; 3]; 3] = [[0.1, 2.0, -3.0], [1e-7, 0.0, 1.0], [4.0, 5.0, 6.0]];

fn written(model: &read::models::Model) -> Vec<u8> {
    let mut out = Vec::new();
    model.write_with(&MOVED, &mut out).unwrap();
    out
}

#[test]
fn ply_keeps_everything_but_coordinates() {
    let model = ply::read(PLY.as_bytes()).unwrap();
    assert_eq!(
        model.points,
        [[0.0, 0.5, 1.0], [1.0, 0.0, 2.0], [0.0, 1.0, 0.0]]
    );
    assert_eq!(model.faces, [[0, 1, 2]]);
    let text = String::from_utf8(written(&model)).unwrap();
    assert_eq!(
        text,
        PLY.replace("float x", "double x")
            .replace("float z", "double z")
            .replace(
                "0 255 0.5 1e0\n1 0 0 2\n0 0 1 0\n",
                "0.1 255 2 -3\n0.0000001 0 0 1\n4 0 5 6\n"
            )
    );
    for big in [false, true] {
        let name = if big {
            "binary_big_endian"
        } else {
            "binary_little_endian"
        };
        let mut bytes = PLY[..PLY.find("0 255").unwrap()]
            .replace("ascii", name)
            .into_bytes();
        let mut put = |little: &[u8]| {
            let mut word = little.to_vec();
            if big {
                word.reverse();
            }
            bytes.extend(word);
        };
        for (x, red, y, z) in [
            (0.0_f32, 255, 0.5_f64, 1.0_f32),
            (1.0, 0, 0.0, 2.0),
            (0.0, 0, 1.0, 0.0),
        ] {
            put(&x.to_le_bytes());
            put(&[red]);
            put(&y.to_le_bytes());
            put(&z.to_le_bytes());
        }
        put(&[3]);
        for corner in 0..3_i32 {
            put(&corner.to_le_bytes());
        }
        put(&0.5_f32.to_le_bytes());
        let binary = ply::read(&bytes).unwrap();
        assert_eq!(
            (&binary.points, &binary.faces),
            (&model.points, &model.faces)
        );
        let again = ply::read(&written(&binary)).unwrap();
        assert_eq!(
            (again.points.as_slice(), &again.faces),
            (&MOVED[..], &model.faces)
        );
    }
}

#[test]
fn ply_errors() {
    for (from, to, message) in [
        (
            "ply\n",
            "PLY\n",
            "line 1: expected \"ply\" on the first line\n  help: this is no PLY file",
        ),
        (
            "ascii",
            "text",
            "line 2: expected ascii, binary_little_endian or binary_big_endian, found \"text\"",
        ),
        (
            "property float x",
            "property half x",
            "line 5: expected a type of numbers, such as float, found \"half\"",
        ),
        (
            "property float x",
            "property float u",
            "expected one property named x of the element vertex",
        ),
        (
            "element vertex",
            "element point",
            "expected one element named vertex in the header",
        ),
        (
            "vertex 3",
            "vertex 2",
            "line 15: expected at least three corners of a face, found 0",
        ),
        (
            "vertex 3",
            "vertex 99",
            "line 17: expected a value of the property red, found the end of the file\n  help: the file seems to be cut off; write it again",
        ),
        (
            "1e0",
            "nan",
            "line 13: vertex 0 (counted from 0) has a coordinate that is no finite number",
        ),
        (
            "3 0 1 2",
            "3 0 1 3",
            "line 16: expected a vertex of a face, 0 to 2, found 3",
        ),
        (
            "3 0 1 2",
            "3 0 -1 2",
            "line 16: expected a vertex of a face, 0 to 2, found -1",
        ),
        (
            "end_header",
            "end",
            "line 12: expected a line of the header, such as element or property, found \"end\"",
        ),
    ] {
        assert_eq!(broken(ply::read, PLY, from, to), message);
    }
}

const STL: &str = "solid two triangles\n facet normal 0 0 1\n  outer loop\n   vertex 0 0 0\n   vertex 1 0 0\n   vertex 0 1 0\n  endloop\n endfacet\n facet normal 0 0 1\n  outer loop\n   vertex 1 0 0\n   vertex 0 -0 0\n   vertex 0 1 0\n  endloop\n endfacet\nendsolid\n";

#[test]
fn stl_corners_at_one_place_are_one_vertex() {
    let text = stl::read(STL.as_bytes()).unwrap();
    assert_eq!(text.points, [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
    assert_eq!(text.faces, [[0, 1, 2], [1, 0, 2]]);
    let mut binary = vec![b's'; 80];
    binary.extend(2_u32.to_le_bytes());
    for face in &text.faces {
        binary.extend([0; 12]);
        for corner in face {
            for coordinate in text.points[*corner as usize] {
                binary.extend((coordinate as f32).to_le_bytes());
            }
        }
        binary.extend([7, 9]);
    }
    let model = stl::read(&binary).unwrap();
    assert_eq!((&model.points, &model.faces), (&text.points, &text.faces));
    // Turned into the plane x = 0: the normals of both triangles follow.
    let turned = [[0.0; 3], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let mut out = Vec::new();
    text.write_with(&turned, &mut out).unwrap();
    assert_eq!(
        String::from_utf8(out).unwrap(),
        STL.replacen("normal 0 0 1", "normal 1 0 0", 1)
            .replacen("normal 0 0 1", "normal -1 0 0", 1)
            .replace("vertex 0 1 0", "vertex 0 0 1")
            .replace("vertex 1 0 0", "vertex 0 1 0")
            .replace("-0 0", "0 0")
    );
    let mut out = Vec::new();
    model.write_with(&turned, &mut out).unwrap();
    assert_eq!(out.len(), binary.len());
    assert_eq!(out[84..88], 1.0_f32.to_le_bytes());
    assert_eq!(out[132..134], [7, 9]);
    assert_eq!(stl::read(&out).unwrap().points, turned);
}

#[test]
fn stl_errors() {
    for (from, to, message) in [
        (
            "vertex 1 0 0",
            "vertex 1 inf 0",
            "line 5: expected a coordinate of a corner, found inf, which is no finite number",
        ),
        (
            "endloop",
            "endlop",
            "line 7: expected endloop, found \"endlop\"",
        ),
        (
            "endsolid\n",
            "",
            "line 16: expected facet or endsolid, found the end of the file\n  help: the file seems to be cut off; write it again",
        ),
        (
            "solid two triangles",
            "so two triangles",
            "byte 80: expected ",
        ),
    ] {
        let error = broken(stl::read, STL, from, to);
        assert!(error.starts_with(message), "{error}");
    }
    let cut_off = [&[0; 80][..], &2_u32.to_le_bytes(), &[0; 99]].concat();
    assert_eq!(
        stl::read(&cut_off).unwrap_err().to_string(),
        "byte 80: expected 184 bytes, as the number of triangles says, found 183\n  help: the file seems to be cut off, or it is no STL file"
    );
    assert_eq!(
        stl::read(b"solid\nendsolid\n").unwrap_err().to_string(),
        "the model has no triangles"
    );
}

const OFF: &str = "OFF # by hand\n3 1 0\n\n0 0 0 0.5\n1 0 0\n0 1 0 # last\n3 0 1 2 255 0 0\n";

#[test]
fn off_keeps_everything_but_coordinates() {
    let model = off::read(OFF.as_bytes()).unwrap();
    assert_eq!(model.points, [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
    assert_eq!(model.faces, [[0, 1, 2]]);
    assert_eq!(
        String::from_utf8(written(&model)).unwrap(),
        "OFF # by hand\n3 1 0\n\n0.1 2 -3 0.5\n0.0000001 0 1\n4 5 6 # last\n3 0 1 2 255 0 0\n"
    );
    for (from, to, message) in [
        (
            "OFF",
            "4OFF",
            "line 1: expected OFF and the numbers of vertices, faces and edges, found \"4OFF\"\n  help: this is no .off file of points in space",
        ),
        (
            "OFF",
            "OFF BINARY",
            "line 1: the model is binary; ASCII is read",
        ),
        ("3 1 0", "4 1 0", "line 7: expected vertex"),
        (
            "1 0 0\n",
            "1 0\n",
            "line 5: expected three coordinates of a vertex, found 2",
        ),
        (
            "1 0 0\n",
            "1 x 0\n",
            "line 5: expected a finite coordinate, found \"x\"",
        ),
        (
            "3 0 1 2 255",
            "3 0 1 3 255",
            "line 7: expected a vertex from 0 to 2, found \"3\"",
        ),
        (
            "3 0 1 2 255 0 0",
            "9 0 1 2",
            "line 7: expected 9 corners of a face, found 3",
        ),
        (
            "3 0 1 2 255 0 0",
            "2 0 1",
            "line 7: expected at least three corners of a face, found 2",
        ),
    ] {
        let error = if message.contains("expected vertex") {
            // The face is taken for the fourth vertex, and then the face is missing.
            let error = broken(off::read, OFF, from, to);
            assert_eq!(
                error,
                "line 7: expected face 0 (counted from 0) of 1, found the end of the file\n  help: the file seems to be cut off; write it again"
            );
            continue;
        } else {
            broken(off::read, OFF, from, to)
        };
        assert_eq!(error, message);
    }
}

/// Every reader on every beginning of a sound file, and with every byte changed in turn: an answer
/// or an error, never a panic.
/// Reads bytes and says whether they were sound.
type Read = Box<dyn Fn(&[u8]) -> bool>;

#[test]
fn nothing_makes_a_reader_panic() {
    let solid = |read: Reader| move |bytes: &[u8]| read(bytes).is_ok();
    let model = |read: fn(&[u8]) -> Result<obj::Model>| move |bytes: &[u8]| read(bytes).is_ok();
    let file = |name: &str| std::fs::read(data(name)).unwrap();
    let mut written = Vec::new();
    write::vtk::write(&mixed(), &mut written).unwrap();
    let files: Vec<(Vec<u8>, Read)> = vec![
        (file("gmsh-22-binary.msh"), Box::new(solid(gmsh::read))),
        (file("gmsh-41-binary.msh"), Box::new(solid(gmsh::read))),
        (file("gmsh-binary.vtk"), Box::new(solid(vtk::read))),
        (written, Box::new(solid(vtk::read))),
        (MEDIT.into(), Box::new(solid(medit::read))),
        (PLY.into(), Box::new(model(ply::read))),
        (STL.into(), Box::new(model(stl::read))),
        (OFF.into(), Box::new(model(off::read))),
    ];
    for (bytes, read) in files {
        assert!(read(&bytes));
        for end in 0..bytes.len() {
            read(&bytes[..end]);
        }
        let mut changed = bytes.clone();
        for place in 0..bytes.len() {
            for value in [0, b' ', b'-', b'9', b'\n', 0xff, bytes[place] ^ 1] {
                changed[place] = value;
                read(&changed);
            }
            changed[place] = bytes[place];
        }
    }
}
