//! Cells that no map can be built on.

use crate::common::{Folder, TWO_TETRAHEDRA_2, octruss};
use crate::sound::{self, ELE, MEDIT, NODE, OBJ};
use crate::table::{cage, check, command, row, with};

/// Elements that a cage cannot hold: which, and how many.
#[test]
fn wrong_element_types() {
    let (vtu, vtk) = (sound::written("vtu"), sound::written("vtk"));
    let rows = [
        cage(
            "prisms and a hexahedron",
            "cage.msh",
            with(
                TWO_TETRAHEDRA_2,
                "6\n1 15 2 7 4 40\n",
                "9\n1 15 2 7 4 40\n7 6 0 1 2 3 4 5 6\n8 5 0 1 2 3 4 5 6 7 8\n9 6 0 1 2 3 4 5 6\n",
            ),
            "cage.msh, line 24: an element names node 1, which the file does not list\n  help: the mesh is incomplete; write it again",
        ),
        cage(
            "second order",
            "cage.msh",
            with(
                TWO_TETRAHEDRA_2,
                "6 4 2 9 1 10 30 20 50",
                "6 11 2 9 1 1 2 3 4 5 6 7 8 9 10",
            ),
            "cage.msh, line 28: the mesh has 1 element of second or higher order (type 11); a cage consists of tetrahedra, octahedra, prisms and hexahedra with straight edges\n  help: mesh at first order: Mesh.ElementOrder = 1 in Gmsh, or `gmsh -order 1`",
        ),
        cage(
            "a surface alone",
            "cage.msh",
            with(
                &with(
                    TWO_TETRAHEDRA_2,
                    "5 4 2 9 1 10 20 30 40\n6 4 2 9 1 10 30 20 50\n",
                    "",
                ),
                "6\n1 15",
                "4\n1 15",
            ),
            "cage.msh: the mesh has no tetrahedra\n  help: mesh in three dimensions (`gmsh -3`), and if there are physical groups, put the volume into one: Gmsh then saves only what is in a group",
        ),
        cage(
            "hexahedra",
            "cage.vtu",
            with(&vtu, "10\n10\n", "12\n12\n"),
            "cage.vtu, line 20: cell 0 (counted from 0) is a hexahedron with 4 corners",
        ),
        cage(
            "second order",
            "cage.vtu",
            with(&vtu, "10\n10\n", "10\n24\n"),
            "cage.vtu, line 20: the grid has 1 cell of second or higher order (type 24), first cell 1 (counted from 0); a cage consists of tetrahedra, octahedra, prisms and hexahedra with straight edges\n  help: write the mesh at first order",
        ),
        cage(
            "an unknown type",
            "cage.vtu",
            with(&vtu, "10\n10\n", "10\n99\n"),
            "cage.vtu, line 20: the grid has 1 cell of an unknown type (type 99), first cell 1 (counted from 0); a cage consists of tetrahedra, octahedra, prisms and hexahedra with straight edges\n  help: a cage consists of tetrahedra (type 10), wedges (13), hexahedra (12), pyramids (14) and octahedra (polyhedra, type 42)",
        ),
        cage(
            "triangles alone",
            "cage.vtu",
            with(&vtu, "10\n10\n", "5\n5\n"),
            "cage.vtu, line 20: the grid has no tetrahedra and no octahedra",
        ),
        cage(
            "wedges",
            "cage.vtk",
            with(&vtk, "10\n10\n", "13\n13\n"),
            "cage.vtk, line 14: cell 0 (counted from 0) is a wedge with 4 corners",
        ),
        cage(
            "a voxel and a pyramid",
            "cage.vtk",
            with(&vtk, "10\n10\n", "11\n14\n"),
            "cage.vtk, line 14: cell 0 (counted from 0) is a voxel with 4 corners",
        ),
        cage(
            "hexahedra",
            "cage.mesh",
            with(
                MEDIT,
                "Tetrahedra",
                "Hexahedra\n1\n1 2 3 4 5 1 2 3 0\nTetrahedra",
            ),
            "cage.mesh: hexahedron 0 (counted from 0 in file order) names vertex 0 twice\n  help: remove the degenerate cell",
        ),
        cage(
            "a prism",
            "cage.mesh",
            with(
                MEDIT,
                "Tetrahedra",
                "Prisms\n1\n1 2 3 4 5 1 0\nTetrahedra",
            ),
            "cage.mesh: prism 0 (counted from 0 in file order) names vertex 0 twice\n  help: remove the degenerate cell",
        ),
        cage(
            "second order",
            "cage.mesh",
            with(MEDIT, "Tetrahedra\n2", "TetrahedraP2\n2"),
            "cage.mesh, line 20: the mesh has 2 elements of second or higher order (TetrahedraP2); a cage consists of tetrahedra, octahedra, prisms and hexahedra with straight edges\n  help: write the mesh at first order",
        ),
        cage(
            "no tetrahedra",
            "cage.mesh",
            with(MEDIT, "Tetrahedra\n2\n1 2 3 4 1\n1 3 2 5 2\n", ""),
            "cage.mesh: the mesh has no tetrahedra\n  help: a cage is a mesh of the volume, not of its surface",
        ),
        cage(
            "second order",
            "cage.ele",
            with(ELE, "2 4 1", "2 10 1"),
            "cage.ele, line 1: the mesh has 2 tetrahedra of second order (10 vertices each); a cage consists of tetrahedra, octahedra, prisms and hexahedra with straight edges\n  help: run TetGen without -o2",
        )
        .and("cage.node", NODE),
        cage("no tetrahedra", "cage.ele", "0 4 0\n", "cage.ele, line 1: the mesh has no tetrahedra").and("cage.node", NODE),
        row(
            "a polyhedron that is no octahedron",
            "info @cage.vtu",
            "cage.vtu",
            tetrahedron_as_polyhedron(),
            "cage.vtu, line 20: cell 1 (counted from 0) is a polyhedron with 4 corners and 4 faces; of polyhedra only octahedra (6 corners, 8 triangles) are read\n  help: a cage consists of tetrahedra (type 10), wedges (13), hexahedra (12), pyramids (14) and octahedra (polyhedra, type 42)",
        ),
        command(
            "a control mesh for a scheme of solids",
            "refine @cup.obj -o @out.vtu",
            "cup.obj: no reader of solid meshes for \".obj\" files\n  help: solid meshes are read from Gmsh .msh (2.2 and 4.1), VTK .vtu and .vtk, Medit .mesh and TetGen .node with .ele",
        ),
        command(
            "a cage for a scheme of surfaces",
            "refine @sound.msh --scheme loop -o @out.obj",
            "sound.msh: no reader of control meshes for \".msh\" files\n  help: control meshes of surfaces are read from .obj, .ply, .stl and .off; for a cage of cells choose a scheme of solids",
        ),
        command(
            "quads for a scheme of triangles",
            "refine @cup.obj --scheme loop -o @out.obj",
            "cup.obj: face 0 has 4 corners, but the scheme is for triangles (counted from 0)\n  help: triangulate the mesh",
        ),
        row(
            "a face of two corners",
            "refine @two.obj --scheme catmull-clark -o @out.obj",
            "two.obj",
            "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2\n",
            "two.obj, line 4: expected at least three corners of a face, found 2",
        ),
    ];
    check(&sound::files(), &rows);
}

/// The second tetrahedron as a list of faces.
fn tetrahedron_as_polyhedron() -> String {
    let text = with(&sound::written("vtu"), "10\n10\n", "10\n42\n");
    with(
        &text,
        "</Cells>",
        "<DataArray type=\"Int64\" Name=\"faces\" format=\"ascii\">\n4 3 0 2 1 3 0 2 4 3 0 1 4 3 2 1 4\n</DataArray>\n<DataArray type=\"Int64\" Name=\"faceoffsets\" format=\"ascii\">\n-1 17\n</DataArray>\n</Cells>",
    )
}

/// A cage of tetrahedra with these points, as a Medit file.
fn medit(points: &[[f64; 3]], cells: &[[u32; 4]]) -> String {
    let mut text = format!(
        "MeshVersionFormatted 2\nDimension 3\nVertices {}\n",
        points.len()
    );
    for [x, y, z] in points {
        text += &format!("{x} {y} {z} 0\n");
    }
    text += &format!("Tetrahedra {}\n", cells.len());
    for cell in cells {
        let [a, b, c, d] = cell.map(|vertex| vertex + 1);
        text += &format!("{a} {b} {c} {d} 0\n");
    }
    text + "End\n"
}

/// Files that can be read and hold no sound solid.
#[test]
fn unsound_cells() {
    const POINTS: [[f64; 3]; 6] = [
        [0.0, 0.0, 0.0],
        [2.0, 0.0, 0.0],
        [0.0, 2.0, 0.0],
        [0.5, 0.25, 2.0],
        [0.5, 0.5, -2.0],
        [0.5, 0.5, 1.0],
    ];
    let flat = [POINTS[0], POINTS[1], POINTS[2], [1.0, 1.0, 0.0]];
    let rows = [
        cage(
            "all inverted",
            "cage.mesh",
            medit(&POINTS, &[[1, 0, 2, 3], [2, 0, 1, 4]]),
            "cage.mesh: 2 of 2 cells are of negative volume, first tetrahedron 0 (counted from 0 in file order)\n  help: every cell is: the mesh is mirrored, or written by a program that lists corners in the other order; exchange the first two corners of every cell, or mirror the mesh",
        ),
        cage(
            "one inverted",
            "cage.mesh",
            medit(&POINTS, &[[0, 1, 2, 3], [2, 0, 1, 4]]),
            "cage.mesh: 1 of 2 cells are of negative volume, first tetrahedron 1 (counted from 0 in file order)\n  help: mend the mesh so that no cell is turned inside out, or exchange two corners of those that are only listed in the other order",
        ),
        cage(
            "flat",
            "cage.mesh",
            medit(&flat, &[[0, 1, 2, 3]]),
            "cage.mesh: 1 of 1 cell is without volume, first tetrahedron 0 (counted from 0 in file order)\n  help: remove the flat cells, for example with Gmsh's Mesh.Optimize",
        ),
        cage(
            "a vertex twice in a cell",
            "cage.mesh",
            medit(&POINTS, &[[0, 1, 2, 2]]),
            "cage.mesh: tetrahedron 0 (counted from 0 in file order) names vertex 2 twice\n  help: remove the degenerate cell",
        ),
        cage(
            "two vertices at one place",
            "cage.mesh",
            medit(
                &[POINTS[0], POINTS[1], POINTS[2], POINTS[2]],
                &[[0, 1, 2, 3]],
            ),
            "cage.mesh: 1 of 1 cell is without volume, first tetrahedron 0 (counted from 0 in file order)\n  help: remove the flat cells, for example with Gmsh's Mesh.Optimize",
        ),
        cage(
            "a cell twice",
            "cage.mesh",
            medit(&POINTS, &[[0, 1, 2, 3], [1, 2, 0, 3]]),
            "cage.mesh: tetrahedron 0 and tetrahedron 1 (counted from 0 in file order) have the same corners\n  help: remove one; Gmsh's MSH 2.2 lists a cell once for each physical group that holds it",
        ),
        cage(
            "three cells at a face",
            "cage.mesh",
            medit(&POINTS, &[[0, 1, 2, 3], [0, 2, 1, 4], [0, 1, 2, 5]]),
            "cage.mesh: 3 cells share the face of vertices 0, 1 and 2 (counted from 0)\n  help: cells overlap there; a face belongs to one cell on the boundary and to two inside",
        ),
        cage(
            "two cells on one side of a face",
            "cage.mesh",
            medit(&POINTS, &[[0, 1, 2, 3], [0, 1, 2, 5]]),
            "cage.mesh: 1 pair of cells shares space, first tetrahedron 0 and tetrahedron 1 (counted from 0 in file order)\n  help: a point there would belong to both cells: remove one of them, or move their vertices apart",
        ),
        cage(
            "the same place twice",
            "cage.mesh",
            medit(
                &[
                    POINTS[0], POINTS[1], POINTS[2], POINTS[3], POINTS[0], POINTS[1], POINTS[2],
                    POINTS[3],
                ],
                &[[0, 1, 2, 3], [4, 5, 6, 7]],
            ),
            "cage.mesh: 1 pair of cells shares space, first tetrahedron 0 and tetrahedron 1 (counted from 0 in file order)\n  help: a point there would belong to both cells: remove one of them, or move their vertices apart",
        ),
        row(
            "overlapping cells to locate in",
            "locate @cage.mesh --points @sound.obj",
            "cage.mesh",
            medit(&POINTS, &[[0, 1, 2, 3], [0, 1, 2, 5]]),
            "cage.mesh: 1 pair of cells shares space, first tetrahedron 0 and tetrahedron 1 (counted from 0 in file order)\n  help: a point there would belong to both cells: remove one of them, or move their vertices apart",
        ),
        row(
            "three cells at a face to refine",
            "refine @cage.mesh -o @out.vtu",
            "cage.mesh",
            medit(&POINTS, &[[0, 1, 2, 3], [0, 2, 1, 4], [0, 1, 2, 5]]),
            "cage.mesh: 3 cells share the face of vertices 0, 1 and 2 (counted from 0)\n  help: cells overlap there; a face belongs to one cell on the boundary and to two inside",
        ),
        row(
            "three cells at a face to look at",
            "info @cage.mesh",
            "cage.mesh",
            medit(&POINTS, &[[0, 1, 2, 3], [0, 2, 1, 4], [0, 1, 2, 5]]),
            "cage.mesh: 3 cells share the face of vertices 0, 1 and 2 (counted from 0)\n  help: cells overlap there; a face belongs to one cell on the boundary and to two inside",
        ),
    ];
    check(&sound::files(), &rows);
}

/// What a map can be built on, but had better not: the command succeeds and says so.
#[test]
fn doubtful_cells() {
    const POINTS: [[f64; 3]; 7] = [
        [0.0, 0.0, 0.0],
        [2.0, 0.0, 0.0],
        [0.0, 2.0, 0.0],
        [0.5, 0.25, 2.0],
        [0.0, -2.0, 0.0],
        [0.5, -0.5, -2.0],
        [9.0, 9.0, 9.0],
    ];
    for (what, cells, message) in [
        (
            "an unused vertex",
            vec![[0, 1, 2, 3], [4, 0, 1, 5]],
            "warning: 1 vertex of the cage in no cell, which moves nothing, first vertex 6\n",
        ),
        (
            "cells that share an edge alone",
            vec![[0, 1, 2, 3], [4, 0, 1, 5]],
            "warning: the boundary touches itself at 1 edge, first from vertex 0 to vertex 1 (counted from 0): other than two boundary faces meet there\n",
        ),
    ] {
        let folder = Folder::new();
        let cage = folder.write("cage.mesh", medit(&POINTS, &cells));
        let skin = folder.write("skin.obj", OBJ.replace("v 0.5 0.5 -0.5", "v 0.5 0.5 0.5"));
        let output = octruss()
            .arg("bake")
            .arg(&cage)
            .args([
                "--levels",
                "1",
                "--boundary",
                "fixed",
                "--random-poses",
                "0",
                "--model",
            ])
            .arg(&skin)
            .arg("-o")
            .arg(folder.path("out.oct"))
            .output()
            .unwrap();
        let text = String::from_utf8(output.stderr).unwrap();
        assert!(
            output.status.success() && text.contains(message),
            "{what}: {text}"
        );
    }
}
