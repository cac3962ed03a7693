//! Files that are cut off.

use crate::common::{TWO_TETRAHEDRA_2, TWO_TETRAHEDRA_4};
use crate::sound::{self, ELE, MEDIT, NODE, OBJ, OFF, PLY, STL};
use crate::table::{cage, check, cut, model, row};

/// Every format is cut where it hurts: the error says where, and what was expected there.
#[test]
fn truncated_files() {
    let vtu = sound::written("vtu");
    let vtk = sound::written("vtk");
    let rows = [
        cage("nothing at all", "cage.msh", "", "cage.msh, line 1: expected $MeshFormat, found the end of the file\n  help: the file seems to be cut off; write it again"),
        cage(
            "nodes cut off",
            "cage.msh",
            cut(TWO_TETRAHEDRA_2, "40 0.5"),
            "cage.msh, line 18: expected the tag of a node, found the end of the file\n  help: the file seems to be cut off; write it again",
        ),
        cage(
            "a number cut off",
            "cage.msh",
            cut(TWO_TETRAHEDRA_2, ".25 2"),
            "cage.msh, line 18: expected the z coordinate of a node, found the end of the file\n  help: the file seems to be cut off; write it again",
        ),
        cage(
            "elements cut off",
            "cage.msh",
            cut(TWO_TETRAHEDRA_2, "30 20 50"),
            "cage.msh, line 28: expected the tag of an element's node, found the end of the file\n  help: the file seems to be cut off; write it again",
        ),
        cage(
            "the last section's end cut off",
            "cage.msh",
            cut(TWO_TETRAHEDRA_2, "$EndElements"),
            "cage.msh, line 29: expected $EndElements, found the end of the file\n  help: the file seems to be cut off; write it again",
        ),
        cage(
            "a whole section cut off",
            "cage.msh",
            cut(TWO_TETRAHEDRA_2, "$Elements"),
            "cage.msh: the file has no section $Elements\n  help: the file seems to be cut off, or the geometry was saved without a mesh: run `gmsh -3` first",
        ),
        cage(
            "entities of 4.1 cut off",
            "cage.msh",
            cut(TWO_TETRAHEDRA_4, "2 0 0 0 2 2 0"),
            "cage.msh, line 14: expected the tag of an entity, found the end of the file\n  help: the file seems to be cut off; write it again",
        ),
        cage(
            "elements of 4.1 cut off",
            "cage.msh",
            cut(TWO_TETRAHEDRA_4, "20 50"),
            "cage.msh, line 45: expected the tag of an element's node, found the end of the file\n  help: the file seems to be cut off; write it again",
        ),
        cage(
            "binary 2.2 cut off",
            "cage.msh",
            &sound::sample("gmsh-22-binary.msh")[..300],
            "cage.msh, byte 295: expected the z coordinate of a node, found the end of the file\n  help: the file seems to be cut off; write it again",
        ),
        cage(
            "binary 4.1 cut off",
            "cage.msh",
            &sound::sample("gmsh-41-binary.msh")[..900],
            "cage.msh, byte 898: expected the type of a block's elements, found the end of the file\n  help: the file seems to be cut off; write it again",
        ),
        cage(
            "an XML element open",
            "cage.vtu",
            cut(&vtu, "</Cells>"),
            "cage.vtu, line 32: the file is no valid XML: the root node was opened but never closed\n  help: the file seems to be cut off or damaged; write it again",
        ),
        cage(
            "appended data cut off",
            "cage.vtu",
            &sound::sample("raw-plain-64-little.vtu")[..2600],
            "cage.vtu, byte 2033: the appended data are cut off\n  help: write the file again",
        ),
        cage(
            "compressed data cut off",
            "cage.vtu",
            &sound::sample("raw-zlib-32-big.vtu")[..2400],
            "cage.vtu, byte 2065: the appended data are cut off\n  help: write the file again",
        ),
        cage("points cut off", "cage.vtk", cut(&vtk, "2 0 0"), "cage.vtk, line 7: expected a coordinate of a point, found the end of the file\n  help: the file seems to be cut off; write it again"),
        cage("types cut off", "cage.vtk", cut(&vtk, "CELL_TYPES"), "cage.vtk: the file has no section CELL_TYPES\n  help: the file seems to be cut off; write it again"),
        cage(
            "binary points cut off",
            "cage.vtk",
            &sound::sample("gmsh-binary.vtk")[..140],
            "cage.vtk, byte 102: expected 15 numbers (a coordinate of a point), found the end of the file\n  help: the file seems to be cut off; write it again",
        ),
        cage(
            "version 5.1 cut off",
            "cage.vtk",
            &sound::sample("legacy-51-binary.vtk")[..500],
            "cage.vtk, byte 444: expected 52 numbers (an entry of CONNECTIVITY), found the end of the file\n  help: the file seems to be cut off; write it again",
        ),
        cage("vertices cut off", "cage.mesh", cut(MEDIT, "0.25 2"), "cage.mesh, line 8: expected the y coordinate of a vertex, found the end of the file\n  help: the file seems to be cut off; write it again"),
        cage("no End", "cage.mesh", cut(MEDIT, "End"), "cage.mesh, line 23: expected a section or End, found the end of the file\n  help: the file seems to be cut off; write it again"),
        cage("vertices cut off", "cage.node", cut(NODE, "4 0.5"), "cage.node, line 4: expected vertex 3 (counted from 0) of 5, found the end of the file\n  help: the file seems to be cut off; write it again").and("cage.ele", ELE),
        cage("a line cut off", "cage.node", cut(NODE, " -2 25"), "cage.node, line 6: expected the z coordinate of a vertex, found the end of the line").and("cage.ele", ELE),
        cage("tetrahedra cut off", "cage.ele", cut(ELE, "2 1 3"), "cage.ele, line 2: expected tetrahedron 1 (counted from 0) of 2, found the end of the file\n  help: the file seems to be cut off; write it again").and("cage.node", NODE),
        cage("a line cut off", "cage.ele", cut(ELE, " 5 2"), "cage.ele, line 3: expected a vertex of a tetrahedron, found the end of the line").and("cage.node", NODE),
        model("nothing at all", "skin.obj", "", "skin.obj: the model has no vertices (lines that start with \"v\")\n  help: a model is a Wavefront .obj file"),
        model("a vertex cut off", "skin.obj", cut(OBJ, " -0.5\n"), "skin.obj, line 4: expected three coordinates of a vertex, found 2"),
        model("a face cut off", "skin.obj", cut(OBJ, " 3\n"), "skin.obj, line 5: expected at least three corners of a face, found 2"),
        model(
            "the header cut off",
            "skin.ply",
            cut(PLY, "end_header"),
            "skin.ply, line 9: expected a line of the header, found the end of the file\n  help: the file seems to be cut off; write it again",
        ),
        model("vertices cut off", "skin.ply", cut(PLY, "0.5 -0.5"), "skin.ply, line 12: expected a value of the property y, found the end of the file\n  help: the file seems to be cut off; write it again"),
        model("a face cut off", "skin.ply", cut(PLY, " 2\n"), "skin.ply, line 13: expected a value of the property vertex_indices, found the end of the file\n  help: the file seems to be cut off; write it again"),
        model(
            "binary vertices cut off",
            "skin.ply",
            &sound::binary_ply()[..240],
            "skin.ply, byte 236: expected a value of the property z, found the end of the file\n  help: the file seems to be cut off; write it again",
        ),
        model("a facet cut off", "skin.stl", cut(STL, "0.25 0.25"), "skin.stl, line 5: expected a coordinate of a corner, found the end of the file\n  help: the file seems to be cut off; write it again"),
        model("no endsolid", "skin.stl", cut(STL, "endsolid"), "skin.stl, line 9: expected facet or endsolid, found the end of the file\n  help: the file seems to be cut off; write it again"),
        model(
            "binary triangles cut off",
            "skin.stl",
            &sound::binary_stl()[..130],
            "skin.stl, byte 80: expected 134 bytes, as the number of triangles says, found 130\n  help: the file seems to be cut off, or it is no STL file",
        ),
        model(
            "the header of a binary file cut off",
            "skin.stl",
            &sound::binary_stl()[..50],
            "skin.stl, byte 50: expected \"solid\" or 84 bytes and more, found 50 bytes\n  help: the file seems to be cut off, or it is no STL file",
        ),
        model(
            "vertices cut off",
            "skin.off",
            cut(OFF, "0.5 0.5 -0.5"),
            "skin.off, line 4: expected vertex 2 (counted from 0) of 3, found the end of the file\n  help: the file seems to be cut off; write it again",
        ),
        model("faces cut off", "skin.off", cut(OFF, "3 0 1 2"), "skin.off, line 5: expected face 0 (counted from 0) of 1, found the end of the file\n  help: the file seems to be cut off; write it again"),
        model("a face cut off", "skin.off", cut(OFF, " 2\n"), "skin.off, line 6: expected 3 corners of a face, found 2"),
        row(
            "a feature cut off",
            "info @sound.msh --features @f.txt",
            "f.txt",
            "crease 0 1\ncrease 2\n",
            "f.txt, line 2: expected `crease A B`, `crease-face A B C`, `sheet A B C` or `corner A`, found \"crease\" with 1 word after it",
        ),
        row(
            "diagonals cut off",
            "info @sound.msh --scheme box-spline --diagonals @d.txt",
            "d.txt",
            "0\n",
            "d.txt: expected a major diagonal for each of 2 tetrahedra and 0 octahedra, found 1\n  help: give one number for each cell, tetrahedra first",
        ),
        row(
            "values cut off",
            "slice @sound.msh --plane 0,0,1,0 --channel @v.txt -o @out.png",
            "v.txt",
            "0 1 2\n",
            "v.txt: expected a value for each of 5 vertices, found 3\n  help: give one number for each vertex, in the order of the mesh file",
        ),
        row(
            "points cut off",
            "locate @sound.msh --points @p.csv",
            "p.csv",
            "0,0,0\n0,0\n",
            "p.csv, line 2: expected the columns x, y, z, found 2 columns",
        ),
        row(
            "a motion cut off",
            "poses @sound.msh --motion @m.csv --bundle @sound.oct -o @out.poses",
            "m.csv",
            "0,0,0,0,0\n0,1,2,0,0\n",
            "m.csv: frame 0 lists 2 of 5 points; the first one missing is point 2\n  help: every frame lists the position of every control point",
        ),
    ];
    check(&sound::files(), &rows);
}
