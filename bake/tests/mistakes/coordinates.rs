//! Coordinates that are no numbers or that the device cannot hold.

use crate::common::{TWO_TETRAHEDRA_2, TWO_TETRAHEDRA_4};
use crate::sound::{self, ELE, MEDIT, NODE, OBJ, OFF, PLY, STL, motion};
use crate::table::{cage, check, command, model, row, with};

/// Coordinates that are no numbers, and numbers that the device cannot hold.
#[test]
fn impossible_coordinates() {
    let (vtu, vtk) = (sound::written("vtu"), sound::written("vtk"));
    let mut single = sound::binary_stl();
    single[100..104].copy_from_slice(&f32::NAN.to_le_bytes());
    let mut double = sound::binary_ply();
    let place = double.len() - 13 - 8;
    double[place..place + 8].copy_from_slice(&f64::INFINITY.to_le_bytes());
    let mut legacy = sound::sample("gmsh-binary.vtk");
    let start = legacy
        .windows(6)
        .position(|window| window == b"double")
        .unwrap()
        + 7;
    legacy[start..start + 8].copy_from_slice(&f64::NAN.to_be_bytes());
    let rows = [
        cage(
            "NaN",
            "cage.msh",
            with(TWO_TETRAHEDRA_2, "0.25 2", "NaN 2"),
            "cage.msh, line 18: expected the y coordinate of a node, found NaN, which is no finite number",
        ),
        cage(
            "an infinity",
            "cage.msh",
            with(TWO_TETRAHEDRA_4, "0.5 0.25 2\n0.5", "0.5 -inf 2\n0.5"),
            "cage.msh, line 30: expected the y coordinate of a node, found -inf, which is no finite number",
        ),
        cage(
            "NaN",
            "cage.vtu",
            with(&vtu, "0.5 0.25 2", "0.5 nan 2"),
            "cage.vtu, line 12: point 3 (counted from 0) has a coordinate that is no finite number",
        ),
        cage(
            "an infinity",
            "cage.vtk",
            with(&vtk, "0.5 0.25 2", "0.5 inf 2"),
            "cage.vtk, line 10: point 3 (counted from 0) has a coordinate that is no finite number",
        ),
        cage("NaN in a binary file", "cage.vtk", legacy, "cage.vtk, byte 102: point 0 (counted from 0) has a coordinate that is no finite number"),
        cage(
            "NaN",
            "cage.mesh",
            with(MEDIT, "0.5 0.25 2 0", "0.5 nan 2 0"),
            "cage.mesh, line 8: expected the y coordinate of a vertex, found NaN, which is no finite number",
        ),
        cage(
            "an infinity",
            "cage.node",
            with(NODE, "0.25 2 20", "1e999 2 20"),
            "cage.node, line 5: expected the y coordinate of a vertex, found inf, which is no finite number",
        )
        .and("cage.ele", ELE),
        cage(
            "an attribute that is no number",
            "cage.node",
            with(NODE, "2 20\n5", "2 nan\n5"),
            "cage.node, line 5: expected an attribute of a vertex, found NaN, which is no finite number",
        )
        .and("cage.ele", ELE),
        model("NaN", "skin.obj", with(OBJ, "0.75", "nan"), "skin.obj, line 3: expected a finite coordinate, found \"nan\""),
        model("an infinity", "skin.ply", with(PLY, "0.75", "inf"), "skin.ply, line 11: vertex 1 (counted from 0) has a coordinate that is no finite number"),
        model("an infinity in a binary file", "skin.ply", double, "skin.ply, byte 236: vertex 2 (counted from 0) has a coordinate that is no finite number"),
        model("NaN", "skin.stl", with(STL, "0.75", "nan"), "skin.stl, line 5: expected a coordinate of a corner, found NaN, which is no finite number"),
        model("NaN in a binary file", "skin.stl", single, "skin.stl, byte 96: triangle 0 (counted from 0) has a coordinate that is no finite number"),
        model("an infinity", "skin.off", with(OFF, "0.75", "1e400"), "skin.off, line 4: expected a finite coordinate, found \"1e400\""),
        row(
            "NaN among values",
            "slice @sound.msh --plane 0,0,1,0 --channel @v.txt -o @out.png",
            "v.txt",
            "0 1 nan 3 4\n",
            "v.txt, line 1: expected a finite number, found \"nan\"",
        ),
        row(
            "an infinity among points",
            "locate @sound.msh --points @p.csv",
            "p.csv",
            "0,0,inf\n",
            "p.csv, line 1: expected a finite number as z, found \"inf\"",
        ),
        row(
            "NaN in a motion",
            "poses @sound.msh --motion @m.csv --bundle @sound.oct -o @out.poses",
            "m.csv",
            "0,0,0,nan,0\n",
            "m.csv, line 1: expected a number as y, found \"nan\"",
        ),
        command(
            "more fraction bits than the cage allows",
            "bake @sound.msh --model @sound.obj --fraction-bits 31 -o @out.oct",
            "sound.msh: vertex 1 (counted from 0) has x = 2, but with 31 fraction bits coordinates lie between -1 and 1\n  help: bake with fewer --fraction-bits, or take a larger unit",
        ),
        command(
            "more fraction bits than there are",
            "refine @sound.msh --numeric fixed --fraction-bits 32 -o @out.vtu",
            "sound.msh: vertex 1 (counted from 0) has x = 2, but with 32 fraction bits coordinates lie between -0.5 and 0.5\n  help: bake with fewer --fraction-bits, or take a larger unit",
        ),
        cage(
            "a cage beyond 32 bits",
            "cage.msh",
            with(TWO_TETRAHEDRA_2, "0.5 0.25 2", "0.5 0.25 1e12"),
            "cage.msh: vertex 3 (counted from 0) has z = 1000000000000, but with 0 fraction bits coordinates lie between -2147483648 and 2147483648\n  help: bake with fewer --fraction-bits, or take a larger unit",
        ),
        cage(
            "a cage below the last bit",
            "cage.msh",
            [
                ("20 2 0 0", "20 2e-12 0 0"),
                ("30 0 2 0", "30 0 2e-12 0"),
                ("0.5 0.25 2", "5e-13 3e-13 2e-12"),
                ("0.5 0.5 -2", "5e-13 5e-13 -2e-12"),
            ]
            .iter()
            .fold(TWO_TETRAHEDRA_2.to_owned(), |text, (from, to)| {
                with(&text, from, to)
            }),
            "cage.msh: all control points fall on one place: with 29 fraction bits coordinates are multiples of 1.862645149230957e-9\n  help: take a smaller unit, so that coordinates are larger numbers, or more --fraction-bits",
        ),
        model(
            "a model beyond 32 bits",
            "skin.obj",
            with(OBJ, "0.75", "-7e11"),
            "skin.obj: vertex 1 (counted from 0) has x = -700000000000, but with 0 fraction bits coordinates lie between -2147483648 and 2147483648\n  help: bake with fewer --fraction-bits, or take a larger unit",
        ),
        row(
            "a pose beyond its format",
            "deform @sound.oct --pose @pose.msh --model @sound.obj -o @out.obj",
            "pose.msh",
            with(TWO_TETRAHEDRA_2, "0.5 0.25 2", "0.5 0.25 1e5"),
            "pose.msh: frame 0: point 3 (counted from 0) has z = 100000, but with 28 fraction bits coordinates lie between -8 and 8\n  help: bake with fewer --fraction-bits, or take a larger unit",
        ),
        row(
            "a motion beyond its format, in its second frame",
            "deform @sound.oct --pose @m.csv --model @sound.obj -o @frame-%d.obj",
            "m.csv",
            motion(&["1", "-1e9"]),
            "m.csv: frame 1: point 4 (counted from 0) has z = -1000000000, but with 28 fraction bits coordinates lie between -8 and 8\n  help: bake with fewer --fraction-bits, or take a larger unit",
        ),
        model(
            "a model outside the cage",
            "skin.obj",
            with(OBJ, "0.75", "7.5"),
            "skin.obj: 1 of 3 points lie outside the refined cage; the farthest, point 1 (counted from 0), by 6.353119719090779\n  help: the smooth scheme pulls the boundary inward: enlarge the cage, or take --boundary fixed, or choose --outside nearest or --outside extrapolate",
        ),
    ];
    check(&sound::files(), &rows);
}
