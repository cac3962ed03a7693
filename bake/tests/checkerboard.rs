//! `octruss checkerboard` end to end.

mod common;

use common::{Folder, model, octruss};
use predicates::str::{contains, is_empty};
use std::path::Path;

const SQUARE: f64 = 0.25;

fn draw(folder: &Folder, pose: &Path) -> assert_cmd::Command {
    let mut command = octruss();
    command
        .args(["checkerboard", "--scheme", "mixed", "--levels", "1"])
        .args(["--size", "200", "--plane", "0,1,0,1.01"])
        .args(["--square", &SQUARE.to_string(), "--json", "-o"])
        .arg(folder.path("out.png"))
        .arg("--features")
        .arg(model("slices/block-features.txt"))
        .arg("--pose")
        .arg(pose)
        .arg(model("slices/block.msh"));
    command
}

/// The block with its vertices moved: Gmsh 2.2 lists a vertex a line, number and coordinates.
fn posed(folder: &Folder, map: impl Fn([f64; 3]) -> [f64; 3]) -> std::path::PathBuf {
    let text = std::fs::read_to_string(model("slices/block.msh")).unwrap();
    let lines = text.lines().map(|line| {
        let words: Vec<&str> = line.split(' ').collect();
        match words.as_slice() {
            [number, x, y, z] => {
                let [x, y, z] = map([x, y, z].map(|word| word.parse().unwrap()));
                format!("{number} {x} {y} {z}\n")
            }
            _ => format!("{line}\n"),
        }
    });
    folder.write("posed.msh", lines.collect::<String>())
}

/// The pixels of the picture's two halves.
fn halves(folder: &Folder) -> [Vec<[u8; 3]>; 2] {
    let picture = tiny_skia::Pixmap::decode_png(&folder.read("out.png")).unwrap();
    let width = picture.width() as usize;
    [0, 1].map(|half| {
        let rows = picture.pixels().chunks_exact(width);
        let pixels = rows.flat_map(|row| &row[half * width / 2..(half + 1) * width / 2]);
        pixels
            .map(|pixel| [pixel.red(), pixel.green(), pixel.blue()])
            .collect()
    })
}

/// The colours of columns.
const DARK: [u8; 3] = [36, 62, 99];
const LIGHT: [u8; 3] = [240, 206, 160];

/// Every scheme here keeps affine maps, and creases and corners keep the block's outline: the smooth and
/// the linear half show the same, whatever the affine pose.
#[test]
fn an_affine_pose_is_the_same_in_both_halves() {
    let folder = Folder::new();
    let pose = posed(&folder, |[x, y, z]| {
        [
            x + 0.25 * z,
            y + 0.125 * x - 0.125 * z,
            1.5 * z - 0.25 * x + 3.0,
        ]
    });
    let output = draw(&folder, &pose).output().unwrap();
    let figures: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    let inside = |half: &str| figures[half].as_u64().unwrap();
    let (smooth, linear) = (
        inside("smooth_places_inside"),
        inside("linear_places_inside"),
    );
    // The window is a square 1.04 times the larger side of the cut; what is inside is a parallelogram.
    assert!(smooth > 15_000 && linear > 15_000, "{smooth} {linear}");
    // Places on the outline fall to either side by rounding.
    assert!(smooth.abs_diff(linear) <= 800, "{smooth} {linear}");
    let is_board = |pixel: &[u8; 3]| *pixel == DARK || *pixel == LIGHT;
    let [smooth, linear] = halves(&folder);
    let both = smooth.iter().zip(&linear);
    let boards = both.filter(|(one, other)| is_board(one) && is_board(other));
    let (mut compared, mut different) = (0, 0);
    for (one, other) in boards {
        compared += 1;
        different += usize::from(one != other);
    }
    // So do places on the edges of columns.
    assert!(
        compared > 6_000 && different * 100 < compared,
        "{different} of {compared}"
    );
}

/// The pose that is drawn in the documentation bends the columns of one half only.
#[test]
fn a_turned_middle_differs() {
    let folder = Folder::new();
    draw(&folder, &model("slices/block-turned.msh"))
        .assert()
        .success();
    let [smooth, linear] = halves(&folder);
    let different = smooth.iter().zip(&linear).filter(|(a, b)| a != b).count();
    assert!(different > 5_000, "{different}");
}

#[test]
fn bad_input_is_told_and_nothing_is_written() {
    let folder = Folder::new();
    let turned = model("slices/block-turned.msh");
    let refused = |command: &mut assert_cmd::Command, words: &str| {
        command
            .assert()
            .failure()
            .stdout(is_empty())
            .stderr(contains(words));
    };
    let another = model("slices/two.msh");
    refused(
        &mut draw(&folder, &another),
        "has not the connectivity of the cage",
    );
    let far = posed(&folder, |[x, y, z]| [x, y + 10.0, z]);
    refused(
        &mut draw(&folder, &far),
        "the plane misses the deformed solid",
    );
    let mut zero = octruss();
    zero.args(["checkerboard", "--plane", "0,1,0,1", "--square", "0", "-o"])
        .arg(folder.path("out.png"))
        .arg("--pose")
        .arg(&turned)
        .args(["--scheme", "mixed"])
        .arg(model("slices/block.msh"));
    refused(&mut zero, "the length of a square is above zero");
    let mut text = octruss();
    text.args(["checkerboard", "--plane", "0,1,0,1", "-o"])
        .arg(folder.path("out.txt"))
        .arg("--pose")
        .arg(&turned)
        .arg(model("slices/block.msh"));
    refused(&mut text, "a cross-section is drawn as .png");
    let mut motion = octruss();
    motion
        .args(["checkerboard", "--plane", "1,0,0,0.4", "--frame", "99"])
        .args(["--scheme", "mixed", "-o"])
        .arg(folder.path("out.png"))
        .arg("--motion")
        .arg(model("finger-motion.csv"))
        .arg(model("finger-mixed.msh"));
    refused(&mut motion, "the motion has no frame 99");
    assert_eq!(folder.names(), ["posed.msh"]);
}
