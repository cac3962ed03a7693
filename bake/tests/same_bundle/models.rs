//! One model in every format and every variant of it.

use crate::bytes::{Bytes, Numbers};
use octruss_bake::mesh::Point;

/// A model's file name and content.
pub type Model = (String, Vec<u8>);

pub fn all(points: &[Point], faces: &[[u32; 3]]) -> Vec<Model> {
    let mut models: Vec<Model> = vec![
        ("plain.obj".to_owned(), obj(points, faces, "\n", false)),
        ("windows.obj".to_owned(), obj(points, faces, "\r\n", true)),
        ("plain.off".to_owned(), off(points, faces, "OFF", "", "")),
        (
            "coloured.off".to_owned(),
            off(points, faces, "COFF", " 255 0 0 255", " 0.5 0.5 0.5"),
        ),
        ("ascii.stl".to_owned(), stl(points, faces)),
        ("binary.stl".to_owned(), binary_stl(points, faces)),
    ];
    for (name, numbers) in [
        ("ascii", Numbers::Ascii),
        ("binary_little_endian", Numbers::Little),
        ("binary_big_endian", Numbers::Big),
    ] {
        for kind in ["float", "double"] {
            models.push((
                format!("{name}-{kind}.ply"),
                ply(points, faces, name, numbers, kind),
            ));
        }
    }
    models
}

/// With what tools put beside the coordinates: weights, normals, texture, groups, indices from the end.
fn obj(points: &[Point], faces: &[[u32; 3]], line_end: &str, decorated: bool) -> Vec<u8> {
    let mut lines = vec!["# a skin".to_owned(), "o skin".to_owned()];
    for [x, y, z] in points {
        lines.push(if decorated {
            format!("v {x:e} {y:e} {z:e} 1.0")
        } else {
            format!("v {x} {y} {z}")
        });
    }
    if decorated {
        lines.extend(["vn 0 0 1", "vt 0 0", "usemtl red", "s off"].map(str::to_owned));
    }
    for [a, b, c] in faces {
        let from_end = |vertex: &u32| i64::from(*vertex) - points.len() as i64;
        lines.push(if decorated {
            format!("f {}/1/1 {}//1 {}", from_end(a), from_end(b), from_end(c))
        } else {
            format!("f {} {} {}", a + 1, b + 1, c + 1)
        });
    }
    (lines.join(line_end) + line_end).into_bytes()
}

fn off(
    points: &[Point],
    faces: &[[u32; 3]],
    keyword: &str,
    of_vertex: &str,
    of_face: &str,
) -> Vec<u8> {
    let mut text = format!("{keyword}\n# a skin\n{} {} 0\n", points.len(), faces.len());
    for [x, y, z] in points {
        text += &format!("{x} {y} {z}{of_vertex}\n");
    }
    for [a, b, c] in faces {
        text += &format!("3 {a} {b} {c}{of_face}\n");
    }
    text.into_bytes()
}

fn stl(points: &[Point], faces: &[[u32; 3]]) -> Vec<u8> {
    let mut text = "solid skin\n".to_owned();
    for face in faces {
        text += "  facet normal 0 0 0\n    outer loop\n";
        for vertex in face {
            let [x, y, z] = points[*vertex as usize];
            text += &format!("      vertex {x:e} {y:e} {z:e}\n");
        }
        text += "    endloop\n  endfacet\n";
    }
    (text + "endsolid skin\n").into_bytes()
}

fn binary_stl(points: &[Point], faces: &[[u32; 3]]) -> Vec<u8> {
    let mut out = Bytes::new(Numbers::Little);
    // A header that starts like an ASCII file, as some programs write it.
    out.text(&format!("{:80}", "solid skin"));
    out.int(faces.len() as i32);
    for face in faces {
        out.singles(&[0.0; 3]);
        for vertex in face {
            out.singles(&points[*vertex as usize]);
        }
        out.byte(0);
        out.byte(0);
    }
    out.finish()
}

/// With a colour between the coordinates and a list behind them.
fn ply(
    points: &[Point],
    faces: &[[u32; 3]],
    encoding: &str,
    numbers: Numbers,
    kind: &str,
) -> Vec<u8> {
    let mut out = Bytes::new(numbers);
    out.text(&format!(
        "ply\nformat {encoding} 1.0\ncomment a skin\nelement vertex {}\nproperty {kind} x\nproperty {kind} y\nproperty uchar red\nproperty {kind} z\nelement face {}\nproperty list uchar int vertex_indices\nelement note 1\nproperty list int double values\nend_header\n",
        points.len(),
        faces.len()
    ));
    let coordinate = |out: &mut Bytes, value: f64| match kind {
        "float" => out.singles(&[value]),
        _ => out.reals(&[value]),
    };
    for [x, y, z] in points {
        coordinate(&mut out, *x);
        coordinate(&mut out, *y);
        out.byte(200);
        coordinate(&mut out, *z);
        out.end_line();
    }
    for face in faces {
        out.byte(3);
        out.ints(&face.map(|vertex| vertex as i32));
        out.end_line();
    }
    out.int(2);
    out.reals(&[0.1, -7.0]);
    out.end_line();
    out.finish()
}
