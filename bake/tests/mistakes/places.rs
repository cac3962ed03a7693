//! Places that cannot be written to.

use crate::common;
use crate::common::{Folder, TWO_TETRAHEDRA_2, octruss};
use crate::sound::{self, OBJ, motion};
use crate::table::{check, command, row};

/// Folders in which nothing can be made, for any user.
#[test]
fn unwritable_places() {
    let mut rows = Vec::new();
    for (what, place, message) in [
        (
            "a folder that is not there",
            "@none/",
            "cannot be written: No such file or directory",
        ),
        (
            "a file as a folder",
            "@sound.obj/",
            "cannot be written: Not a directory",
        ),
    ] {
        for (words, name) in [
            (
                "bake @sound.msh --model @sound.obj --levels 1 -o",
                "out.oct",
            ),
            ("refine @sound.msh -o", "out.vtu"),
            ("refine @sound.msh -o", "out.vtk"),
            ("refine @sound.msh -o", "out.obj"),
            ("refine @sound.msh -o", "out.ply"),
            ("refine @sound.msh -o", "out.off"),
            (
                "deform @sound.oct --pose @sound.msh --model @sound.obj -o",
                "out.obj",
            ),
            (
                "deform @sound.oct --pose @sound.msh --model @sound.obj --picture",
                "out.png",
            ),
            (
                "poses @sound.msh --motion @sound.csv --bundle @sound.oct -o",
                "out.poses",
            ),
            (
                "info @sound.msh --scheme box-spline --write-diagonals",
                "out.txt",
            ),
            (
                "slice @sound.msh --plane 0,0,1,-0.25 --basis 0 --levels 1 --size 200 -o",
                "out.png",
            ),
        ] {
            let file = format!("{}{name}", place.replace('@', ""));
            rows.push(command(
                what,
                &format!("{words} {place}{name}"),
                &format!("{file}: {message}"),
            ));
        }
        // Nothing appears where all could not.
        let bake = "bake @sound.msh --model @sound.obj --levels 1 -o @out.oct --rust @out.rs";
        let file = format!("{}out.c", place.replace('@', ""));
        rows.push(command(
            what,
            &format!("{bake} --c {place}out.c"),
            &format!("{file}: {message}"),
        ));
    }
    rows.push(row(
        "a folder in the file's place",
        "refine @sound.msh -o @out.vtu",
        "out.vtu/x",
        "",
        "out.vtu: cannot be written: it is a folder",
    ));
    rows.push(command(
        "a folder for frames that cannot be made",
        "deform @sound.oct --pose @sound.csv --model @sound.obj -o @sound.obj/frames",
        "sound.obj/frames: cannot be made: Not a directory",
    ));
    if cfg!(target_os = "linux") {
        for place in ["/proc", "/sys"] {
            rows.push(command(
                "the kernel's own files",
                &format!("refine @sound.msh -o {place}/out.vtu"),
                &format!("{place}/out.vtu: cannot be written: "),
            ));
        }
    }
    let mut files = sound::files();
    files.insert("sound.csv", motion(&["1", "2"]).into());
    check(&files, &rows);
}

/// A device that takes not one byte, behind a link with a name that the command accepts.
#[cfg(target_os = "linux")]
#[test]
fn full_devices() {
    const FULL: &str = "/dev/full";
    let message = "cannot be written: No space left on device";
    let mut rows = Vec::new();
    for (words, name) in [
        (
            "bake @sound.msh --model @sound.obj --levels 1 -o",
            "full.oct",
        ),
        ("refine @sound.msh -o", "full.vtu"),
        ("refine @sound.msh -o", "full.vtk"),
        ("refine @sound.msh -o", "full.obj"),
        ("refine @sound.msh -o", "full.ply"),
        ("refine @sound.msh -o", "full.off"),
        (
            "deform @sound.oct --pose @sound.msh --model @sound.obj -o",
            "full.obj",
        ),
        (
            "deform @sound.oct --pose @sound.msh --model @sound.obj --picture",
            "full.png",
        ),
        (
            "poses @sound.msh --motion @sound.csv --bundle @sound.oct -o",
            "full.poses",
        ),
        (
            "info @sound.msh --scheme box-spline --write-diagonals",
            "full.txt",
        ),
        (
            "slice @sound.msh --plane 0,0,1,-0.25 --basis 0 --levels 1 --size 200 -o",
            "full.png",
        ),
        (
            "bake @sound.msh --model @sound.obj --levels 1 -o @out.oct --rust",
            "full.rs",
        ),
        (
            "bake @sound.msh --model @sound.obj --levels 1 -o @out.oct --rust @out.rs --c",
            "full.c",
        ),
    ] {
        let row = command(
            "a full disk",
            &format!("{words} @{name}"),
            &format!("{name}: {message}"),
        );
        rows.push(row.link(name, FULL));
    }
    let mut files = sound::files();
    files.insert("sound.csv", motion(&["1", "2"]).into());
    check(&files, &rows);
    use std::os::unix::fs::FileTypeExt;
    assert!(
        std::fs::metadata(FULL)
            .unwrap()
            .file_type()
            .is_char_device()
    );
}

/// Standard output on a full disk: figures that nobody can read are no success.
#[cfg(target_os = "linux")]
#[test]
fn full_standard_output() {
    let folder = Folder::new();
    let mesh = folder.write("sound.msh", TWO_TETRAHEDRA_2);
    let points = folder.write("sound.obj", OBJ);
    for words in [
        "info @mesh",
        "info @mesh --json",
        "locate @mesh --points @points",
        "forms --scheme loop --valence 5",
    ] {
        let word = |word: &str| match word {
            "@mesh" => mesh.display().to_string(),
            "@points" => points.display().to_string(),
            other => other.to_owned(),
        };
        let output = std::process::Command::new(octruss().get_program())
            .args(words.split(' ').map(word))
            .stdout(
                std::fs::File::options()
                    .write(true)
                    .open("/dev/full")
                    .unwrap(),
            )
            .output()
            .unwrap();
        let text = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(1), "{words}: {text}");
        assert!(
            text.contains("error: cannot write to standard output: No space left on device"),
            "{words}: {text}"
        );
    }
}

/// A disk that fills up on the way: the system lets files grow to 1024 bytes and no further.
#[cfg(target_os = "linux")]
#[test]
fn disks_that_fill_up() {
    let finger = common::model("finger.msh").display().to_string();
    let skin = common::model("finger.obj").display().to_string();
    for (words, name) in [
        (vec!["refine", &finger, "-o"], "out.vtu"),
        (vec!["refine", &finger, "-o"], "out.vtk"),
        (vec!["refine", &finger, "-o"], "out.obj"),
        (vec!["refine", &finger, "-o"], "out.ply"),
        (vec!["refine", &finger, "-o"], "out.off"),
        (
            vec![
                "bake",
                &finger,
                "--model",
                &skin,
                "--levels",
                "1",
                "--random-poses",
                "0",
                "-o",
            ],
            "out.oct",
        ),
    ] {
        for has_old in [true, false] {
            let folder = Folder::new();
            if has_old {
                folder.write(name, "what was there before");
            }
            // Without the trap the system ends the program at the first byte too many.
            let output = std::process::Command::new("sh")
                .args(["-c", "trap '' XFSZ; ulimit -f 2; exec \"$@\"", "sh"])
                .arg(octruss().get_program())
                .args(&words)
                .arg(folder.path(name))
                .output()
                .unwrap();
            let text = String::from_utf8(output.stderr).unwrap();
            assert_eq!(output.status.code(), Some(1), "{words:?}: {text}");
            assert!(
                text.contains(&format!("{name}: cannot be written: File too large")),
                "{text}"
            );
            assert!(
                !text.contains("panicked") && output.stdout.is_empty(),
                "{text}"
            );
            let expected: &[&str] = if has_old { &[name] } else { &[] };
            assert_eq!(folder.names(), expected);
            if has_old {
                assert_eq!(folder.read(name), b"what was there before");
            }
        }
    }
}
