//! Files whose counts and references are wrong.

use crate::common::{TWO_TETRAHEDRA_2, TWO_TETRAHEDRA_4};
use crate::sound::{self, CUP, ELE, MEDIT, NODE, OBJ, OFF, PLY, STL};
use crate::table::{cage, changed, check, model, row, with};

/// Counts and references that are not what the file holds.
#[test]
fn lying_files() {
    let (vtu, vtk) = (sound::written("vtu"), sound::written("vtk"));
    // The last byte of a piece of a sample, changed.
    let binary = |name: &str, piece: &[u8], value: u8| {
        let bytes = sound::sample(name);
        let place = bytes
            .windows(piece.len())
            .position(|window| window == piece);
        changed(&bytes, place.unwrap() + piece.len() - 1, value)
    };
    let rows = [
        cage(
            "more nodes announced",
            "cage.msh",
            with(TWO_TETRAHEDRA_2, "5\n10", "6\n10"),
            "cage.msh, line 20: expected the tag of a node, found \"$EndNodes\"",
        ),
        cage(
            "fewer nodes announced",
            "cage.msh",
            with(TWO_TETRAHEDRA_2, "5\n10", "4\n10"),
            "cage.msh, line 19: expected $EndNodes, found \"50\"\n  help: a count at the start of the section may be wrong",
        ),
        cage(
            "more elements announced",
            "cage.msh",
            with(TWO_TETRAHEDRA_2, "6\n1 15", "7\n1 15"),
            "cage.msh, line 29: expected the tag of an element, found \"$EndElements\"",
        ),
        cage(
            "a count beyond all bounds",
            "cage.msh",
            with(TWO_TETRAHEDRA_2, "6\n1 15", "99999999999999999999\n1 15"),
            "cage.msh, line 22: expected the number of elements, found \"99999999999999999999\"",
        ),
        cage(
            "a node that is not listed",
            "cage.msh",
            with(TWO_TETRAHEDRA_2, "30 20 50\n", "30 20 60\n"),
            "cage.msh, line 28: an element names node 60, which the file does not list\n  help: the mesh is incomplete; write it again",
        ),
        cage(
            "a node listed twice",
            "cage.msh",
            with(TWO_TETRAHEDRA_2, "50 0.5", "40 0.5"),
            "cage.msh, line 19: node 40 is listed twice\n  help: give every node a tag of its own",
        ),
        cage(
            "an unknown element type",
            "cage.msh",
            with(TWO_TETRAHEDRA_2, "6 4 2 9", "6 77 2 9"),
            "cage.msh, line 28: element type 77 is not known\n  help: a cage consists of tetrahedra (Gmsh element type 4)",
        ),
        cage(
            "more blocks in 4.1",
            "cage.msh",
            with(TWO_TETRAHEDRA_4, "5 6 1 6", "6 6 1 6"),
            "cage.msh, line 46: expected the dimension of an element block's entity, found \"$EndElements\"",
        ),
        cage(
            "a word for a number",
            "cage.msh",
            with(TWO_TETRAHEDRA_4, "0.5 0.25 2\n0.5", "0.5 0,25 2\n0.5"),
            "cage.msh, line 30: expected the y coordinate of a node, found \"0,25\"",
        ),
        cage(
            "more nodes in a binary file",
            "cage.msh",
            binary("gmsh-22-binary.msh", b"$Nodes\n5", b'6'),
            "cage.msh, byte 331: expected $EndNodes, found \"\\0\\0\\0\\u{2}\\0\\0\\0\\u{1}\\0\\0\\0\\u{7}\\0\\0\\0\\u{1}\\0\\0\\0\\u{4}\\0\\0\\0\\u{1}\\0\\0\\0\\u{1}\\0\\0\\0\\u{2}\\0\\0\\0\\u{2}\\0\\0\\0\\u{8}...\"\n  help: a count at the start of the section may be wrong",
        ),
        cage(
            "more blocks in a binary file",
            "cage.msh",
            binary("gmsh-41-binary.msh", b"$Elements\n\x05", 6),
            "cage.msh, byte 1150: element type 1953391981 is not known\n  help: a cage consists of tetrahedra (Gmsh element type 4)",
        ),
        cage(
            "more points announced",
            "cage.vtu",
            with(&vtu, "NumberOfPoints=\"5\"", "NumberOfPoints=\"6\""),
            "cage.vtu, line 12: expected 6 points of 3 coordinates, found 15 numbers",
        ),
        cage(
            "more cells announced",
            "cage.vtu",
            with(&vtu, "NumberOfCells=\"2\"", "NumberOfCells=\"3\""),
            "cage.vtu, line 20: expected 3 offsets and 3 types, found 2 and 2",
        ),
        cage(
            "a corner that is not there",
            "cage.vtu",
            with(&vtu, "0 2 1 4", "0 2 1 5"),
            "cage.vtu, line 20: cell 1 (counted from 0) names vertex 5, but there are 5 vertices",
        ),
        cage(
            "offsets beyond the corners",
            "cage.vtu",
            with(&vtu, "4\n8\n", "4\n9\n"),
            "cage.vtu, line 20: cell 1 (counted from 0) has offsets beyond the connectivity",
        ),
        cage(
            "one face of an octahedron again and again",
            "cage.vtu",
            with(
                &String::from_utf8(sound::sample("ascii.vtu")).unwrap(),
                "0 1 2 3 4 5\n          6 7",
                "0 0 0 0 0 0\n          0 0",
            ),
            "cage.vtu, line 25: cell 4 (counted from 0) has 6 corners and 8 triangles, but not as an octahedron has them: every corner shares triangles with all others but one",
        ),
        cage(
            "a length in base64",
            "cage.vtu",
            with(
                &String::from_utf8(sound::sample("inline-plain-32-little.vtu")).unwrap(),
                " yAAAAA",
                " zAAAAA",
            ),
            "cage.vtu, line 23: the array's data are shorter than its header says",
        ),
        cage(
            "more points announced",
            "cage.vtk",
            with(&vtk, "POINTS 5", "POINTS 6"),
            "cage.vtk, line 11: expected a coordinate of a point, found \"CELLS\"",
        ),
        cage(
            "fewer integers announced",
            "cage.vtk",
            with(&vtk, "CELLS 2 10", "CELLS 2 9"),
            "cage.vtk, line 13: cell 1 (counted from 0) has entries beyond the 9 integers of CELLS\n  help: the counts behind CELLS may be wrong",
        ),
        cage(
            "a type too few",
            "cage.vtk",
            with(&vtk, "CELL_TYPES 2", "CELL_TYPES 1"),
            "cage.vtk, line 14: expected a type for each of 2 cells, found 1",
        ),
        cage(
            "a corner that is not there",
            "cage.vtk",
            with(&vtk, "4 0 2 1 4", "4 0 2 1 5"),
            "cage.vtk, line 14: cell 1 (counted from 0) names vertex 5, but there are 5 vertices",
        ),
        cage(
            "a corner too many",
            "cage.vtk",
            with(
                &with(&vtk, "4 0 2 1 4", "5 0 2 1 4 3"),
                "CELLS 2 10",
                "CELLS 2 11",
            ),
            "cage.vtk, line 14: cell 1 (counted from 0) is a tetrahedron with 5 corners",
        ),
        cage(
            "more vertices announced",
            "cage.mesh",
            with(MEDIT, "Vertices\n5", "Vertices\n6"),
            "cage.mesh, line 10: expected the x coordinate of a vertex, found \"Edges\"",
        ),
        cage(
            "fewer tetrahedra announced",
            "cage.mesh",
            with(MEDIT, "Tetrahedra\n2", "Tetrahedra\n1"),
            "cage.mesh, line 22: expected a section, found \"1\"\n  help: the number at the start of the section before may be wrong",
        ),
        cage(
            "a vertex that is not there",
            "cage.mesh",
            with(MEDIT, "1 3 2 5 2", "1 3 2 6 2"),
            "cage.mesh, line 22: expected a vertex of a tetrahedron, 1 to 5, found \"6\"\n  help: the section Vertices must come first and hold all vertices",
        ),
        cage(
            "a ridge that is not there",
            "cage.mesh",
            with(MEDIT, "Ridges\n1\n1", "Ridges\n1\n2"),
            "cage.mesh, line 15: expected the edge of a ridge, 1 to 1, found \"2\"",
        ),
        cage(
            "more vertices announced",
            "cage.node",
            with(NODE, "5 3", "6 3"),
            "cage.node, line 6: expected vertex 5 (counted from 0) of 6, found the end of the file\n  help: the file seems to be cut off; write it again",
        )
        .and("cage.ele", ELE),
        cage(
            "a gap in the numbers",
            "cage.node",
            with(NODE, "3 0 2", "4 0 2"),
            "cage.node, line 4: expected the index of a vertex, found \"4\"\n  help: vertices are counted from 0 or 1 without gaps",
        )
        .and("cage.ele", ELE),
        cage(
            "more tetrahedra announced",
            "cage.ele",
            with(ELE, "2 4 1", "3 4 1"),
            "cage.ele, line 3: expected tetrahedron 2 (counted from 0) of 3, found the end of the file\n  help: the file seems to be cut off; write it again",
        )
        .and("cage.node", NODE),
        cage(
            "a vertex that is not there",
            "cage.ele",
            with(ELE, "3 2 5 2", "3 2 6 2"),
            "cage.ele, line 3: names vertex 6, but the .node file has 5 vertices counted from 1",
        )
        .and("cage.node", NODE),
        model(
            "a corner that is not there",
            "skin.obj",
            with(OBJ, "f 1 2 3", "f 1 2 4"),
            "skin.obj, line 5: expected a vertex from 1 to 3 (those listed so far), found \"4\"",
        ),
        model(
            "corners counted from 0",
            "skin.obj",
            with(OBJ, "f 1 2 3", "f 0 1 2"),
            "skin.obj, line 5: expected a vertex from 1 to 3 (those listed so far), found \"0\"",
        ),
        model(
            "a word for a number",
            "skin.obj",
            with(OBJ, "0.75", "O.75"),
            "skin.obj, line 3: expected a finite coordinate, found \"O.75\"",
        ),
        model(
            "more vertices announced",
            "skin.ply",
            with(PLY, "vertex 3", "vertex 4"),
            "skin.ply, line 14: expected a value of the property vertex_indices, found the end of the file\n  help: the file seems to be cut off; write it again",
        ),
        model(
            "a corner that is not there",
            "skin.ply",
            with(PLY, "3 0 1 2", "3 0 1 3"),
            "skin.ply, line 13: expected a vertex of a face, 0 to 2, found 3",
        ),
        model(
            "a list of a negative length",
            "skin.ply",
            with(PLY, "3 0 1 2", "-3 0 1 2"),
            "skin.ply, line 13: expected the length of a list, found -3",
        ),
        model(
            "more faces in a binary file",
            "skin.ply",
            {
                let text = sound::binary_ply();
                let place = text
                    .windows(6)
                    .position(|window| window == b"face 1")
                    .unwrap()
                    + 5;
                changed(&text, place, b'2')
            },
            "skin.ply, byte 257: expected the length of a list, found the end of the file\n  help: the file seems to be cut off; write it again",
        ),
        model(
            "more triangles in a binary file",
            "skin.stl",
            changed(&sound::binary_stl(), 80, 2),
            "skin.stl, byte 80: expected 184 bytes, as the number of triangles says, found 134\n  help: the file seems to be cut off, or it is no STL file",
        ),
        model(
            "a fourth corner",
            "skin.stl",
            with(STL, "endloop", "vertex 0 0 0\nendloop"),
            "skin.stl, line 7: expected endloop, found \"vertex\"",
        ),
        model(
            "more vertices announced",
            "skin.off",
            with(OFF, "3 1 0", "4 1 0"),
            "skin.off, line 6: expected face 0 (counted from 0) of 1, found the end of the file\n  help: the file seems to be cut off; write it again",
        ),
        model(
            "more faces announced",
            "skin.off",
            with(OFF, "3 1 0", "3 2 0"),
            "skin.off, line 6: expected face 1 (counted from 0) of 2, found the end of the file\n  help: the file seems to be cut off; write it again",
        ),
        model(
            "a corner that is not there",
            "skin.off",
            with(OFF, "3 0 1 2", "3 0 1 3"),
            "skin.off, line 6: expected a vertex from 0 to 2, found \"3\"",
        ),
        row(
            "a vertex that is not there",
            "info @sound.msh --features @f.txt",
            "f.txt",
            "corner 5\n",
            "f.txt, line 1: there is no vertex 5; the mesh has 5\n  help: vertices are counted from 0 in the order of the mesh file",
        ),
        row(
            "a crease that is no edge",
            "info @sound.msh --features @f.txt",
            "f.txt",
            "crease 3 4\n",
            "sound.msh: the crease from vertex 3 to vertex 4 (counted from 0) is no edge of a cell\n  help: a crease runs along edges of the mesh; mesh the curve together with the volume",
        ),
        row(
            "a crease face that is no face",
            "info @sound.msh --features @f.txt",
            "f.txt",
            "crease-face 1 3 4\n",
            "sound.msh: the crease face of vertices 1, 3 and 4 (counted from 0) is no face of a cell\n  help: a crease surface runs along faces of the mesh; mesh the surface together with the volume",
        ),
        row(
            "a diagonal beyond 2",
            "info @sound.msh --scheme box-spline --diagonals @d.txt",
            "d.txt",
            "0 3\n",
            "d.txt, line 1: expected a major diagonal, found \"3\"\n  help: a major diagonal is 0, 1 or 2",
        ),
        row(
            "a value too many",
            "slice @sound.msh --plane 0,0,1,0 --channel @v.txt -o @out.png",
            "v.txt",
            "0 1 2 3 4 5\n",
            "v.txt: expected a value for each of 5 vertices, found 6\n  help: give one number for each vertex, in the order of the mesh file",
        ),
        row(
            "a point that is not there",
            "poses @sound.msh --motion @m.csv --bundle @sound.oct -o @out.poses",
            "m.csv",
            "0,5,0,0,0\n",
            "m.csv, line 1: there is no point 5; the cage has 5\n  help: points are counted from 0 in the order of the cage's file",
        ),
        row(
            "a tag of too few arguments",
            "refine @tag.obj --scheme catmull-clark -o @out.obj",
            "tag.obj",
            with(CUP, "2/1/0 0 1 10", "3/1/0 0 1 10"),
            "tag.obj, line 14: expected as many arguments as announced of a tag, found \"3/1/0\"",
        ),
        row(
            "a tag of a vertex that is not there",
            "refine @tag.obj --scheme catmull-clark -o @out.obj",
            "tag.obj",
            with(CUP, "0 1 10", "0 8 10"),
            "tag.obj, line 14: expected a vertex, counted from 0, of a tag, found \"8\"",
        ),
    ];
    check(&sound::files(), &rows);
}
