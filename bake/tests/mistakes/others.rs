//! Poses, models and bundles that do not belong together, or are damaged.

use crate::sound::{self, MEDIT, OBJ, motion};
use crate::table::{changed, check, command, cut, row, with};

/// Files that are sound and belong to something else.
#[test]
fn other_poses_and_models() {
    let deform = "deform @sound.oct --model @sound.obj -o @out.obj --pose";
    let short = OBJ.replace("v 0.5 0.5 -0.5\nf 1 2 3\n", "");
    let rows = [
        row(
            "a pose of other cells",
            &format!("{deform} @pose.mesh"),
            "pose.mesh",
            with(MEDIT, "1 3 2 5 2", "1 3 2 4 2"),
            "pose.mesh: the mesh (5 vertices, 2 cells) has not the connectivity of the cage that the bundle was baked from (5 vertices): its cells are others, or in another order\n  help: a pose is the cage itself with its vertices moved: same vertices, same cells, same order",
        ),
        row(
            "a pose of a vertex more",
            &format!("{deform} @pose.mesh"),
            "pose.mesh",
            with(
                &with(MEDIT, "Vertices\n5", "Vertices\n6"),
                "Edges",
                "9 9 9 0\nEdges",
            ),
            "pose.mesh: the mesh (6 vertices, 2 cells) has not the connectivity of the cage that the bundle was baked from (5 vertices)\n  help: a pose is the cage itself with its vertices moved: same vertices, same cells, same order",
        ),
        row(
            "a pose of a cell less",
            &format!("{deform} @pose.mesh"),
            "pose.mesh",
            with(
                &with(MEDIT, "Tetrahedra\n2", "Tetrahedra\n1"),
                "1 3 2 5 2\n",
                "",
            ),
            "pose.mesh: the mesh (5 vertices, 1 cell) has not the connectivity of the cage that the bundle was baked from (5 vertices): its cells are others, or in another order\n  help: a pose is the cage itself with its vertices moved: same vertices, same cells, same order",
        ),
        row(
            "a pose of cells in another order",
            &format!("{deform} @pose.mesh"),
            "pose.mesh",
            with(MEDIT, "1 2 3 4 1\n1 3 2 5 2", "1 3 2 5 2\n1 2 3 4 1"),
            "pose.mesh: the mesh (5 vertices, 2 cells) has not the connectivity of the cage that the bundle was baked from (5 vertices): its cells are others, or in another order\n  help: a pose is the cage itself with its vertices moved: same vertices, same cells, same order",
        ),
        row(
            "one pose of a motion",
            "deform @sound.oct --pose @poses --model @sound.obj -o @out-%d.obj",
            "poses/pose-0.mesh",
            MEDIT,
            "poses/pose-1.mesh: the mesh (5 vertices, 2 cells) has not the connectivity of the cage that the bundle was baked from (5 vertices): its cells are others, or in another order\n  help: a pose is the cage itself with its vertices moved: same vertices, same cells, same order",
        )
        .and("poses/pose-1.mesh", with(MEDIT, "1 3 2 5 2", "1 3 2 4 2")),
        row(
            "two poses of one number",
            "deform @sound.oct --pose @poses --model @sound.obj -o @out-%d.obj",
            "poses/pose-1.mesh",
            MEDIT,
            "poses: two poses have the number 1: poses/pose-01.mesh and poses/pose-1.mesh",
        )
        .and("poses/pose-01.mesh", MEDIT),
        row(
            "a folder without poses",
            "deform @sound.oct --pose @poses --model @sound.obj -o @out-%d.obj",
            "poses/notes.txt",
            "",
            "poses: the directory has no numbered poses\n  help: name them like pose-0001.vtu, pose-0002.vtu",
        ),
        row(
            "a motion without a point",
            &format!("{deform} @m.csv").replace("out.obj", "out-%d.obj"),
            "m.csv",
            cut(&motion(&["1"]), "0,4"),
            "m.csv: frame 0 lists 4 of 5 points; the first one missing is point 4\n  help: every frame lists the position of every control point",
        ),
        row(
            "a motion with a point twice",
            &format!("{deform} @m.csv").replace("out.obj", "out-%d.obj"),
            "m.csv",
            motion(&["1"]) + "0,4,0,0,1\n",
            "m.csv, line 6: point 4 of frame 0 is listed twice",
        ),
        row(
            "another cage for raw poses",
            "poses @other.mesh --motion @m.csv --bundle @sound.oct -o @out.poses",
            "other.mesh",
            with(MEDIT, "1 3 2 5 2", "1 3 2 4 2"),
            "other.mesh: the mesh (5 vertices, 2 cells) has not the connectivity of the cage that the bundle was baked from (5 vertices): its cells are others, or in another order\n  help: a pose is the cage itself with its vertices moved: same vertices, same cells, same order",
        )
        .and("m.csv", motion(&["1"])),
        row(
            "a model that stands elsewhere",
            "deform @sound.oct --pose @sound.msh --model @moved.obj -o @out.obj",
            "moved.obj",
            with(OBJ, "0.75", "0.76"),
            "moved.obj: this is not the model that the bundle was baked for: its 3 vertices stand elsewhere\n  help: give the model that was baked, at rest, or bake again",
        ),
        row(
            "a model of another size",
            "deform @sound.oct --pose @sound.msh --model @short.obj -o @out.obj",
            "short.obj",
            short,
            "short.obj: this is not the model that the bundle was baked for: it has 2 vertices, the bundle has 3 rows\n  help: give the model that was baked, at rest, or bake again",
        ),
        row(
            "a model of another order",
            "deform @sound.oct --pose @sound.msh --model @other.obj -o @out.obj",
            "other.obj",
            with(
                &with(OBJ, "v 0.625 0.5 0.25\n", ""),
                "f 1",
                "v 0.625 0.5 0.25\nf 1",
            ),
            "other.obj: this is not the model that the bundle was baked for: its 3 vertices stand elsewhere\n  help: give the model that was baked, at rest, or bake again",
        ),
        command(
            "a motion into one file",
            "deform @sound.oct --pose @sound.csv --model @sound.obj -o @out.obj",
            "out.obj: a motion has many frames, but this names one file\n  help: name a directory, or a pattern such as out/frame-%04d.obj",
        ),
    ];
    let mut files = sound::files();
    files.insert("sound.csv", motion(&["1", "2"]).into());
    check(&files, &rows);
}

#[test]
fn damaged_bundles() {
    let files = sound::files();
    let bundle = &files["sound.oct"];
    let deform = "deform @bad.oct --pose @sound.msh --model @sound.obj -o @out.obj";
    let bad =
        |what: &str, content: &[u8], message: &str| row(what, deform, "bad.oct", content, message);
    let mut rows = vec![
        bad("nothing at all", &[], "bad.oct: the bundle is cut short: 0 bytes of 128\n  help: bundles are written by `octruss bake`; bake it again"),
        bad("half a header", &bundle[..64], "bad.oct: the bundle is cut short: 64 bytes of 128\n  help: bundles are written by `octruss bake`; bake it again"),
        bad("a byte short", &bundle[..bundle.len() - 1], "bad.oct: the bundle is cut short: 447 bytes of 448\n  help: bundles are written by `octruss bake`; bake it again"),
        bad("a byte too long", &[bundle, &b"\0"[..]].concat(), "bad.oct: 449 bytes were given, but the bundle ends after 448\n  help: bundles are written by `octruss bake`; bake it again"),
        // The version follows the eight bytes of the name.
        bad("a later version", &changed(bundle, 8, 2), "bad.oct: the bundle has version 2, this library reads version 1: bake it again\n  help: bundles are written by `octruss bake`; bake it again"),
        bad("another file", OBJ.repeat(20).as_bytes(), "bad.oct: these bytes are no octruss bundle\n  help: bundles are written by `octruss bake`; bake it again"),
        row(
            "a damaged bundle for raw poses",
            "poses @sound.msh --motion @m.csv --bundle @bad.oct -o @out.poses",
            "bad.oct",
            changed(bundle, 300, !bundle[300]),
            "bad.oct: the bundle is damaged: its checksum is 9082c8a9, its bytes give 44e2e3a2\n  help: bundles are written by `octruss bake`; bake it again",
        )
        .and("m.csv", motion(&["1"])),
    ];
    for eighth in 1..8 {
        let place = bundle.len() * eighth / 8;
        let flipped = changed(bundle, place, bundle[place] ^ (1 << eighth));
        rows.push(bad(
            "a bit flipped",
            &flipped,
            "bad.oct: the bundle is damaged: its checksum is ",
        ));
    }
    check(&files, &rows);
}

/// A file cannot be unaligned; bytes in a device's flash can.
#[test]
fn an_unaligned_bundle() {
    let bundle = &sound::files()["sound.oct"];
    let mut words = vec![0_u64; bundle.len() / 8 + 2];
    let bytes = zerocopy::IntoBytes::as_mut_bytes(words.as_mut_slice());
    for offset in 0..8 {
        let place = offset..offset + bundle.len();
        bytes[place.clone()].copy_from_slice(bundle);
        let opened = octruss::bundle::Bundle::new_checked(&bytes[place]);
        match opened {
            Ok(_) => assert_eq!(offset, 0),
            Err(error) => assert_eq!(
                error.to_string(),
                "the bundle does not start on a multiple of 8 bytes: include it with include_bundle!"
            ),
        }
    }
}
