//! Files that cannot be read, and files of another kind than their name says.

use crate::common::TWO_TETRAHEDRA_4;
use crate::sound::{self, ELE, MEDIT, NODE, OFF, PLY};
use crate::table::{BAKE, cage, changed, check, command, model, row, with};

#[test]
fn unreadable_files() {
    let mut rows = Vec::new();
    let missing = "cannot be read: No such file or directory";
    for extension in ["msh", "vtu", "vtk", "mesh", "node"] {
        rows.push(command(
            "no such cage",
            &format!("refine @none.{extension} -o @out.vtu"),
            &format!("none.{extension}: {missing}"),
        ));
    }
    rows.push(row(
        "a .node without its .ele",
        "info @cage.node",
        "cage.node",
        NODE,
        &format!("cage.ele: {missing}"),
    ));
    rows.push(row(
        "an .ele without its .node",
        "info @cage.ele",
        "cage.ele",
        ELE,
        &format!("cage.node: {missing}"),
    ));
    for extension in ["obj", "ply", "stl", "off"] {
        rows.push(command(
            "no such model",
            &format!("{BAKE} @none.{extension}"),
            &format!("none.{extension}: {missing}"),
        ));
        rows.push(command(
            "no such control mesh",
            &format!("refine @none.{extension} --scheme loop -o @out.obj"),
            &format!("none.{extension}: {missing}"),
        ));
    }
    for (what, words) in [
        ("features", "info @sound.msh --features @none.txt"),
        (
            "diagonals",
            "info @sound.msh --scheme box-spline --diagonals @none.txt",
        ),
        (
            "values",
            "slice @sound.msh --plane 0,0,1,0 --channel @none.txt -o @out.png",
        ),
        ("points", "locate @sound.msh --points @none.csv"),
        (
            "bundle",
            "deform @none.oct --pose @sound.msh --model @sound.obj -o @out.obj",
        ),
        (
            "pose",
            "deform @sound.oct --pose @none.msh --model @sound.obj -o @out.obj",
        ),
        (
            "motion",
            "poses @sound.msh --motion @none.csv --bundle @sound.oct -o @out.poses",
        ),
    ] {
        let name = words
            .split('@')
            .find(|word| word.starts_with("none"))
            .unwrap();
        let name = name.split(' ').next().unwrap();
        rows.push(command(what, words, &format!("{name}: {missing}")));
    }
    rows.push(command("a folder as a cage", "info @.", ".: the name has no extension, which tells the format of solid meshes\n  help: solid meshes are read from Gmsh .msh (2.2 and 4.1), VTK .vtu and .vtk, Medit .mesh and TetGen .node with .ele"));
    rows.push(row(
        "a folder as a cage",
        "info @folder.msh",
        "folder.msh/x",
        "",
        "folder.msh: cannot be read: Is a directory",
    ));
    rows.push(row(
        "a folder as a model",
        &format!("{BAKE} @folder.obj"),
        "folder.obj/x",
        "",
        "folder.obj: cannot be read: Is a directory",
    ));
    rows.push(row(
        "a file as a folder",
        "info @sound.obj/cage.msh",
        "x",
        "",
        "sound.obj/cage.msh: cannot be read: Not a directory",
    ));
    check(&sound::files(), &rows);
}

/// Files of another kind under a known name, and of unknown kinds.
#[test]
fn unknown_files() {
    let png = b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR";
    let mut rows = vec![
        cage("an extension of no cage", "cage.stp", "x", "cage.stp: no reader of solid meshes for \".stp\" files\n  help: solid meshes are read from Gmsh .msh (2.2 and 4.1), VTK .vtu and .vtk, Medit .mesh and TetGen .node with .ele"),
        cage("no extension", "cage", "x", "cage: the name has no extension, which tells the format of solid meshes\n  help: solid meshes are read from Gmsh .msh (2.2 and 4.1), VTK .vtu and .vtk, Medit .mesh and TetGen .node with .ele"),
        model("an extension of no model", "skin.fbx", "x", "skin.fbx: no reader of models for \".fbx\" files\n  help: models are read from .obj, .ply, .stl and .off"),
        row(
            "an extension of no control mesh",
            "refine @cup.stp --scheme loop -o @out.obj",
            "cup.stp",
            "x",
            "cup.stp: no reader of control meshes for \".stp\" files\n  help: control meshes of surfaces are read from .obj, .ply, .stl and .off; for a cage of cells choose a scheme of solids",
        ),
        row(
            "an extension of no points",
            "locate @sound.msh --points @p.txt",
            "p.txt",
            "x",
            "p.txt: no reader of points for \".txt\" files\n  help: points are read from .csv (columns x, y, z), .obj, .ply, .stl and .off",
        ),
        command(
            "an extension of no solid",
            "refine @sound.msh -o @out.stl",
            "out.stl: no writer for \".stl\" files\n  help: a refined solid is written as .vtu or .vtk, its boundary as .obj, .ply or .off",
        ),
        command(
            "an extension of no surface",
            "refine @cup.obj --scheme catmull-clark -o @out.vtu",
            "out.vtu: no writer for \".vtu\" files\n  help: a refined surface is written as .obj, .ply or .off",
        ),
        command(
            "another extension than the model's",
            "deform @sound.oct --pose @sound.msh --model @sound.obj -o @out.ply",
            "out.ply: expected a name that ends in .obj, as the model's does",
        ),
        command(
            "an extension of no skin",
            "bake @cup.obj --scheme catmull-clark -o @out.oct --skin @out.stl",
            "out.stl: no writer for \".stl\" files\n  help: a refined surface is written as .obj, .ply or .off",
        ),
        command(
            "an extension of no motion",
            "poses @sound.msh --motion @sound.obj --bundle @sound.oct -o @out.poses",
            "sound.obj: a motion is a directory of numbered poses or a .csv file\n  help: the columns of a .csv are frame, point, x, y, z",
        ),
        cage(
            "MSH 4.0",
            "cage.msh",
            with(TWO_TETRAHEDRA_4, "4.1 0 8", "4.0 0 8"),
            "cage.msh, line 2: expected MSH version 2.2 or 4.1, found \"4.0\"\n  help: save it again: `gmsh MESH -save -format msh41 -o NEW.msh`",
        ),
        cage("MSH 1.0", "cage.msh", "$NOD\n1\n1 0 0 0\n$ENDNOD\n", "cage.msh, line 1: expected $MeshFormat, found \"$NOD\"\n  help: this is no Gmsh mesh of version 2 or 4; save it as \"Version 4.1 ASCII\""),
        cage(
            "single precision",
            "cage.msh",
            with(TWO_TETRAHEDRA_4, "4.1 0 8", "4.1 1 4"),
            "cage.msh, line 2: expected binary numbers of 8 bytes, found \"4\"",
        ),
        cage(
            "a damaged mark of the byte order",
            "cage.msh",
            changed(&sound::sample("gmsh-41-binary.msh"), 20, 7),
            "cage.msh, byte 20: expected the number 1 in four bytes, which shows the byte order, found [7, 0, 0, 0]\n  help: the file is damaged, or its line ends were changed; write it again",
        ),
        cage(
            "a partitioned mesh",
            "cage.msh",
            with(
                TWO_TETRAHEDRA_4,
                "$Nodes",
                "$PartitionedEntities\n0\n$EndPartitionedEntities\n$Nodes",
            ),
            "cage.msh, line 18: the mesh is partitioned\n  help: join the parts before saving: Mesh > Unpartition in Gmsh",
        ),
        cage(
            "another VTK file",
            "cage.vtu",
            with(
                &sound::written("vtu"),
                "\"UnstructuredGrid\"",
                "\"PolyData\"",
            ),
            "cage.vtu, line 2: expected type=\"UnstructuredGrid\", found \"PolyData\"\n  help: save the mesh as an unstructured grid (.vtu)",
        ),
        cage("XML of another kind", "cage.vtu", "<svg/>", "cage.vtu, line 1: expected the element VTKFile, found svg"),
        cage(
            "another compressor",
            "cage.vtu",
            with(
                &sound::written("vtu"),
                "byte_order",
                "compressor=\"vtkLZMADataCompressor\" byte_order",
            ),
            "cage.vtu, line 2: the compressor \"vtkLZMADataCompressor\" is not read\n  help: save the file with zlib compression or with none",
        ),
        cage(
            "legacy VTK of another kind",
            "cage.vtk",
            with(&sound::written("vtk"), "UNSTRUCTURED_GRID", "POLYDATA"),
            "cage.vtk, line 4: expected DATASET UNSTRUCTURED_GRID, found \"DATASET POLYDATA\"\n  help: save the mesh as an unstructured grid",
        ),
        cage("a vtu named vtk", "cage.vtk", sound::written("vtu"), "cage.vtk, line 1: expected \"# vtk DataFile Version\" and a number, found \"<?xml version=\\\"1.0\\\"?>\"\n  help: this is no legacy VTK file; files of VTK's XML formats are named .vtu"),
        cage("a vtk named vtu", "cage.vtu", sound::written("vtk"), "cage.vtu, line 1: expected XML, found a legacy VTK file\n  help: files of the legacy format are named .vtk"),
        cage(
            "an MFEM mesh",
            "cage.mesh",
            "MFEM mesh v1.0\n\ndimension\n3\n",
            "cage.mesh, line 1: this is an MFEM mesh, which is another format with the same extension\n  help: convert it: MFEM's tool `convert-dc` writes VTK",
        ),
        cage(
            "a mesh in the plane",
            "cage.mesh",
            with(MEDIT, "Dimension 3", "Dimension 2"),
            "cage.mesh, line 2: expected Dimension 3, found \"Dimension 2\"\n  help: a cage is a mesh of tetrahedra in space",
        ),
        cage(
            "nodes in the plane",
            "cage.node",
            with(NODE, "5 3 1 0", "5 2 1 0"),
            "cage.node, line 1: expected the dimension, 3, found \"2\"\n  help: a cage is a mesh of tetrahedra in space",
        )
        .and("cage.ele", ELE),
        model(
            "a binary OFF",
            "skin.off",
            with(OFF, "OFF\n", "OFF BINARY\n"),
            "skin.off, line 1: the model is binary; ASCII is read",
        ),
        model(
            "a PLY of an unknown type",
            "skin.ply",
            with(PLY, "double z", "quad z"),
            "skin.ply, line 6: expected a type of numbers, such as float, found \"quad\"",
        ),
        model("an OBJ of lines alone", "skin.obj", "l 1 2\n", "skin.obj: the model has no vertices (lines that start with \"v\")\n  help: a model is a Wavefront .obj file"),
    ];
    for (file, message) in [
        (
            "cage.msh",
            "cage.msh, line 1: found bytes that are not text\n  help: the file may be damaged, or a binary file under a name that says text",
        ),
        (
            "cage.vtu",
            "cage.vtu, byte 0: found bytes that are not text\n  help: the file is damaged, or it is no VTK XML file",
        ),
        (
            "cage.vtk",
            "cage.vtk, line 1: found bytes that are not text",
        ),
        (
            "cage.mesh",
            "cage.mesh, line 1: found bytes that are not text\n  help: the file may be damaged, or a binary file under a name that says text",
        ),
    ] {
        rows.push(cage("a picture", file, png, message));
    }
    rows.push(
        cage(
            "a picture",
            "cage.node",
            png,
            "cage.node, byte 0: found bytes that are not text",
        )
        .and("cage.ele", ELE),
    );
    rows.push(
        cage(
            "a picture",
            "cage.ele",
            png,
            "cage.ele, byte 0: found bytes that are not text",
        )
        .and("cage.node", NODE),
    );
    for (file, message) in [
        (
            "skin.obj",
            "skin.obj: the model has no vertices (lines that start with \"v\")\n  help: a model is a Wavefront .obj file",
        ),
        (
            "skin.ply",
            "skin.ply, line 1: found bytes that are not text",
        ),
        (
            "skin.stl",
            "skin.stl, byte 16: expected \"solid\" or 84 bytes and more, found 16 bytes\n  help: the file seems to be cut off, or it is no STL file",
        ),
        (
            "skin.off",
            "skin.off, line 1: expected OFF and the numbers of vertices, faces and edges, found \"�PNG\"\n  help: this is no .off file of points in space",
        ),
    ] {
        rows.push(model("a picture", file, png, message));
    }
    for (words, message) in [
        (
            "info @sound.msh --features @picture",
            "picture, byte 0: found bytes that are not text",
        ),
        (
            "info @sound.msh --scheme box-spline --diagonals @picture",
            "picture, byte 0: found bytes that are not text",
        ),
        (
            "slice @sound.msh --plane 0,0,1,0 --channel @picture -o @out.png",
            "picture, byte 0: found bytes that are not text",
        ),
        (
            "deform @picture --pose @sound.msh --model @sound.obj -o @out.obj",
            "picture: the bundle is cut short: 16 bytes of 128\n  help: bundles are written by `octruss bake`; bake it again",
        ),
    ] {
        rows.push(row("a picture", words, "picture", png, message));
    }
    check(&sound::files(), &rows);
}
