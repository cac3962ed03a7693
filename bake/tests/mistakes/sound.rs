//! Sound files of every format, which the rows break.

use crate::common::{Folder, TWO_TETRAHEDRA_2, TWO_TETRAHEDRA_4, data, octruss};
use octruss_bake::read;
use octruss_bake::write;
use std::collections::BTreeMap;

pub const MEDIT: &str = "MeshVersionFormatted 2
Dimension 3
Vertices
5
0 0 0 0
2 0 0 0
0 2 0 0
0.5 0.25 2 0
0.5 0.5 -2 0
Edges
1
1 2 0
Ridges
1
1
Corners
1
4
Tetrahedra
2
1 2 3 4 1
1 3 2 5 2
End
";

pub const NODE: &str = "5 3 1 0
1 0 0 0 20
2 2 0 0 30
3 0 2 0 20
4 0.5 0.25 2 20
5 0.5 0.5 -2 25
";

pub const ELE: &str = "2 4 1
1 1 2 3 4 1
2 1 3 2 5 2
";

pub const OBJ: &str = "# three points inside
v 0.625 0.5 0.25
v 0.75 0.25 0.25
v 0.5 0.5 -0.5
f 1 2 3
";

pub const PLY: &str = "ply
format ascii 1.0
element vertex 3
property double x
property double y
property double z
element face 1
property list uchar int vertex_indices
end_header
0.625 0.5 0.25
0.75 0.25 0.25
0.5 0.5 -0.5
3 0 1 2
";

pub const STL: &str = "solid skin
facet normal 0 0 1
outer loop
vertex 0.625 0.5 0.25
vertex 0.75 0.25 0.25
vertex 0.5 0.5 -0.5
endloop
endfacet
endsolid
";

pub const OFF: &str = "OFF
3 1 0
0.625 0.5 0.25
0.75 0.25 0.25
0.5 0.5 -0.5
3 0 1 2
";

/// A cube as a control mesh, open on top.
pub const CUP: &str = "v 0 0 0
v 1 0 0
v 1 1 0
v 0 1 0
v 0 0 1
v 1 0 1
v 1 1 1
v 0 1 1
f 1 4 3 2
f 1 2 6 5
f 2 3 7 6
f 3 4 8 7
f 4 1 5 8
t crease 2/1/0 0 1 10
";

/// The binary form of [`PLY`], least significant byte first.
pub fn binary_ply() -> Vec<u8> {
    let mut bytes = PLY[..PLY.find("0.625 0.5").unwrap()]
        .replace("ascii", "binary_little_endian")
        .into_bytes();
    for coordinate in [0.625, 0.5, 0.25, 0.75, 0.25, 0.25, 0.5, 0.5, -0.5_f64] {
        bytes.extend(coordinate.to_le_bytes());
    }
    bytes.push(3);
    for corner in 0..3_i32 {
        bytes.extend(corner.to_le_bytes());
    }
    bytes
}

/// The binary form of [`STL`].
pub fn binary_stl() -> Vec<u8> {
    let mut bytes = vec![0; 80];
    bytes.extend(1_u32.to_le_bytes());
    bytes.extend([0; 12]);
    for coordinate in [0.625, 0.5, 0.25, 0.75, 0.25, 0.25, 0.5, 0.5, -0.5_f32] {
        bytes.extend(coordinate.to_le_bytes());
    }
    bytes.extend([0; 2]);
    bytes
}

/// The cage as a file of that extension, `vtu` or `vtk`.
pub fn written(extension: &str) -> String {
    let mesh = read::gmsh::read(TWO_TETRAHEDRA_4.as_bytes()).unwrap();
    let mut bytes = Vec::new();
    write::solid(extension, &mesh, &mut bytes).unwrap();
    String::from_utf8(bytes).unwrap()
}

/// What stands in every row's folder: files without fault, and a bundle of them.
pub fn files() -> BTreeMap<&'static str, Vec<u8>> {
    let folder = Folder::new();
    folder.write("sound.msh", TWO_TETRAHEDRA_2);
    folder.write("sound.obj", OBJ);
    octruss()
        .args(["bake", "--levels", "1", "--random-poses", "0", "-o"])
        .arg(folder.path("sound.oct"))
        .arg("--model")
        .arg(folder.path("sound.obj"))
        .arg(folder.path("sound.msh"))
        .assert()
        .success();
    BTreeMap::from([
        ("sound.msh", TWO_TETRAHEDRA_2.into()),
        ("sound.obj", OBJ.into()),
        ("sound.oct", folder.read("sound.oct")),
        ("cup.obj", CUP.into()),
    ])
}

/// A file of the test data.
pub fn sample(name: &str) -> Vec<u8> {
    std::fs::read(data(name)).unwrap()
}

/// A motion in which the last point's z is one of these.
pub fn motion(heights: &[&str]) -> String {
    let mut text = String::new();
    for (frame, height) in heights.iter().enumerate() {
        for point in 0..5 {
            let z = if point == 4 { height } else { "0" };
            text += &format!("{frame},{point},0,0,{z}\n");
        }
    }
    text
}
