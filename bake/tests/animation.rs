//! Animations: read back with other readers, and held against the frames that `deform` writes one by
//! one.

mod common;

use common::{Folder, TWO_TETRAHEDRA_2, model, octruss};
use gltf::animation::Interpolation;
use gltf::animation::util::ReadOutputs;
use gltf::mesh::Mode;
use octruss_bake::read;
use predicates::str::contains;
use roxmltree::Document;
use std::path::{Path, PathBuf};

/// The greatest relative error of a number rounded to single precision.
const HALF_UNIT: f64 = 1.0 / (1 << 24) as f64;

/// A baked cage with a model and a motion of frames 2, 3 and 7, at rest in the first.
struct Studio {
    folder: Folder,
    model: PathBuf,
}

impl Studio {
    fn new(object: &str) -> Self {
        let folder = Folder::new();
        let cage = folder.write("two.msh", TWO_TETRAHEDRA_2);
        let model = folder.write("skin.obj", object);
        let rest = [
            [0.0, 0.0, 0.0],
            [2.0, 0.0, 0.0],
            [0.0, 2.0, 0.0],
            [0.5, 0.25, 2.0],
            [0.5, 0.5, -2.0],
        ];
        let mut motion = String::from("frame,point,x,y,z\n");
        for (frame, lift) in [(2, 0.0), (3, 0.3), (7, -0.7)] {
            for (point, [x, y, z]) in rest.into_iter().enumerate() {
                motion += &format!(
                    "{frame},{point},{},{y},{}\n",
                    x + lift * y,
                    z + lift * x * x
                );
            }
        }
        folder.write("motion.csv", motion);
        octruss()
            .args([
                "bake",
                "--levels",
                "1",
                "--unit",
                "mm",
                "--outside",
                "nearest",
                "-o",
            ])
            .arg(folder.path("two.oct"))
            .arg(&cage)
            .arg("--model")
            .arg(&model)
            .assert()
            .success();
        Self { folder, model }
    }

    fn deform(&self, pose: &str, out: &Path) -> assert_cmd::assert::Assert {
        octruss()
            .arg("deform")
            .arg(self.folder.path("two.oct"))
            .arg("--motion")
            .arg(self.folder.path(pose))
            .arg("--model")
            .arg(&self.model)
            .arg("-o")
            .arg(out)
            .assert()
    }

    /// The frames as files of the model's own format, all digits.
    fn frames(&self) -> Vec<Vec<[f64; 3]>> {
        self.deform("motion.csv", &self.folder.path("frames"))
            .success();
        let points = |frame: u32| {
            let file = self.folder.path(&format!("frames/skin-{frame:04}.obj"));
            read::model(&file).unwrap().points
        };
        [2, 3, 7].map(points).to_vec()
    }
}

/// A square, a triangle that stands on it, and a vertex of no face.
const SKIN: &str = "v 0.1 0.1 0\nv 0.6 0.1 0\nv 0.6 0.6 0\nv 0.1 0.6 0\nv 0.3 0.3 0.5\nv 0.2 0.2 -0.2\n\
                    f 1 2 3 4\nf 1 2 5\n";

/// The accessor's vectors.
fn vectors(document: &gltf::Gltf, accessor: &gltf::Accessor<'_>) -> Vec<[f32; 3]> {
    let blob = document.blob.as_deref().unwrap();
    gltf::accessor::Iter::<[f32; 3]>::new(accessor.clone(), |_| Some(blob))
        .unwrap()
        .collect()
}

/// The bounds of an accessor are those of its vectors.
fn check_bounds(accessor: &gltf::Accessor<'_>, vectors: &[[f32; 3]]) {
    let bound = |choose: fn(f32, f32) -> f32| -> Vec<f32> {
        let along = |axis: usize| vectors.iter().map(move |vector| vector[axis]);
        (0..3)
            .map(|axis| along(axis).reduce(choose).unwrap())
            .collect()
    };
    let written = |bound: Option<serde_json::Value>| -> Vec<f32> {
        let numbers = bound.unwrap();
        let numbers = numbers.as_array().unwrap().iter();
        numbers
            .map(|number| number.as_f64().unwrap() as f32)
            .collect()
    };
    assert_eq!(written(accessor.min()), bound(f32::min));
    assert_eq!(written(accessor.max()), bound(f32::max));
}

#[test]
fn a_glb_holds_every_frame_in_single_precision() {
    let studio = Studio::new(SKIN);
    let frames = studio.frames();
    let file = studio.folder.path("skin.glb");
    studio.deform("motion.csv", &file).success();
    // `open` checks the document against the format's schema.
    let document = gltf::Gltf::open(&file).unwrap();
    let mesh = document.meshes().next().unwrap();
    assert_eq!(mesh.weights(), Some([1.0, 0.0, 0.0].as_slice()));
    let primitive = mesh.primitives().next().unwrap();
    assert_eq!(primitive.mode(), Mode::Triangles);
    let blob = document.blob.as_deref().unwrap();
    let reader = primitive.reader(|_| Some(blob));
    let indices: Vec<u32> = reader.read_indices().unwrap().into_u32().collect();
    assert_eq!(indices, [0, 1, 2, 0, 2, 3, 0, 1, 4]);

    let position = primitive.get(&gltf::Semantic::Positions).unwrap();
    let rest = vectors(&document, &position);
    check_bounds(&position, &rest);
    let at_rest = read::model(&studio.model).unwrap().points;
    assert_eq!(
        rest,
        at_rest
            .iter()
            .map(|p| p.map(|c| c as f32))
            .collect::<Vec<_>>()
    );

    let targets: Vec<_> = primitive.morph_targets().collect();
    assert_eq!(targets.len(), frames.len());
    for (target, frame) in targets.iter().zip(&frames) {
        let accessor = target.positions().unwrap();
        let ways = vectors(&document, &accessor);
        check_bounds(&accessor, &ways);
        for ((rest, way), point) in rest.iter().zip(&ways).zip(frame) {
            for axis in 0..3 {
                let way = f64::from(way[axis]);
                let shown = f64::from(rest[axis]) + way;
                // Either term has 24 bits, so that their sum in double precision is exact here.
                assert!((shown - point[axis]).abs() <= HALF_UNIT * way.abs());
            }
        }
    }
}

/// Normals by hand: at rest the square's is upward, in each frame that of its plane.
#[test]
fn normals_follow_the_frames() {
    let studio = Studio::new("v 0.1 0.1 0\nv 0.6 0.1 0\nv 0.1 0.6 0\nf 1 2 3\n");
    let frames = studio.frames();
    let file = studio.folder.path("skin.glb");
    studio.deform("motion.csv", &file).success();
    let document = gltf::Gltf::open(&file).unwrap();
    let primitive = document
        .meshes()
        .next()
        .unwrap()
        .primitives()
        .next()
        .unwrap();
    let rest = vectors(&document, &primitive.get(&gltf::Semantic::Normals).unwrap());
    assert_eq!(rest, [[0.0, 0.0, 1.0]; 3]);
    for (target, frame) in primitive.morph_targets().zip(&frames) {
        let changes = vectors(&document, &target.normals().unwrap());
        let side = |corner: usize| -> [f64; 3] {
            std::array::from_fn(|axis| frame[corner][axis] - frame[0][axis])
        };
        let ([ax, ay, az], [bx, by, bz]) = (side(1), side(2));
        let normal = [ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx];
        let length = normal.iter().map(|part| part * part).sum::<f64>().sqrt();
        for (rest, change) in rest.iter().zip(&changes) {
            for axis in 0..3 {
                let shown = f64::from(rest[axis]) + f64::from(change[axis]);
                assert!((shown - normal[axis] / length).abs() < 2.0 * HALF_UNIT);
            }
        }
    }
}

/// Times by the frames' numbers, and at each time its own target alone.
#[test]
fn the_track_of_a_glb_shows_one_frame_after_the_other() {
    let studio = Studio::new(SKIN);
    let file = studio.folder.path("skin.glb");
    studio.deform("motion.csv", &file).success();
    let document = gltf::Gltf::open(&file).unwrap();
    let blob = document.blob.as_deref().unwrap();
    let animation = document.animations().next().unwrap();
    let channel = animation.channels().next().unwrap();
    assert_eq!(channel.sampler().interpolation(), Interpolation::Linear);
    let reader = channel.reader(|_| Some(blob));
    let times: Vec<f32> = reader.read_inputs().unwrap().collect();
    assert_eq!(times, [0.0, 1.0 / 25.0, 5.0 / 25.0]);
    let Some(ReadOutputs::MorphTargetWeights(weights)) = reader.read_outputs() else {
        panic!("no weights");
    };
    let weights: Vec<f32> = weights.into_f32().collect();
    assert_eq!(weights, [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]);
    // Millimetres, and z upward: a quarter turn back about x brings it to the format's y.
    let node = document.nodes().next().unwrap();
    let (_, [x, y, z, w], scale) = node.transform().decomposed();
    assert_eq!(scale, [0.001; 3]);
    let half = std::f32::consts::FRAC_1_SQRT_2;
    assert_eq!(
        ([x, y, z, w], channel.target().node().index()),
        ([-half, 0.0, 0.0, half], 0)
    );
}

/// A model without faces is shown as points, and a single pose stands still.
#[test]
fn points_and_single_poses_are_shown() {
    let studio = Studio::new("v 0.5 0.5 0.25\nv 0.5 0.5 -0.25\n");
    let file = studio.folder.path("still.glb");
    studio.deform("two.msh", &file).success();
    let document = gltf::Gltf::open(&file).unwrap();
    assert_eq!(document.animations().count(), 0);
    let mesh = document.meshes().next().unwrap();
    let primitive = mesh.primitives().next().unwrap();
    assert_eq!(
        (primitive.mode(), mesh.weights()),
        (Mode::Points, Some([1.0].as_slice()))
    );
    assert!(primitive.indices().is_none());
}

/// Numbers of the array with this name.
fn array(document: &Document<'_>, name: &str) -> Vec<f64> {
    let mut arrays = document.descendants();
    let array = arrays
        .find(|node| node.attribute("Name") == Some(name))
        .unwrap();
    let words = array.text().unwrap().split_ascii_whitespace();
    words.map(|word| word.parse().unwrap()).collect()
}

#[test]
fn a_pvd_lists_a_grid_for_each_frame() {
    let studio = Studio::new(SKIN);
    let frames = studio.frames();
    let rest = read::model(&studio.model).unwrap().points;
    studio
        .deform("motion.csv", &studio.folder.path("a & b.pvd"))
        .success();
    let text = String::from_utf8(studio.folder.read("a & b.pvd")).unwrap();
    let list = Document::parse(&text).unwrap();
    let entries: Vec<_> = list
        .descendants()
        .filter(|node| node.has_tag_name("DataSet"))
        .collect();
    let times: Vec<_> = entries
        .iter()
        .map(|entry| entry.attribute("timestep"))
        .collect();
    assert_eq!(times, [Some("0"), Some("0.04"), Some("0.2")]);
    for ((entry, frame), number) in entries.iter().zip(&frames).zip([2, 3, 7]) {
        let name = entry.attribute("file").unwrap();
        assert_eq!(name, format!("a & b/frame-{number:04}.vtu"));
        let text = String::from_utf8(studio.folder.read(name)).unwrap();
        let grid = Document::parse(&text).unwrap();
        assert_eq!(array(&grid, "Points"), frame.as_flattened());
        assert_eq!(
            array(&grid, "connectivity"),
            [0.0, 1.0, 2.0, 3.0, 0.0, 1.0, 4.0]
        );
        assert_eq!(array(&grid, "offsets"), [4.0, 7.0]);
        // VTK's numbers of quadrangles and triangles.
        assert_eq!(array(&grid, "types"), [9.0, 5.0]);
        let pairs = frame.as_flattened().iter().zip(rest.as_flattened());
        let ways: Vec<f64> = pairs.map(|(point, rest)| point - rest).collect();
        assert_eq!(array(&grid, "displacement"), ways);
    }
}

#[test]
fn what_cannot_be_written_is_said_and_leaves_nothing() {
    let studio = Studio::new(SKIN);
    let before = studio.folder.names();
    studio
        .deform("motion.csv", &studio.folder.path("no/such/skin.glb"))
        .code(1)
        .stderr(contains("skin.glb: cannot be written: "));
    // A file is in the way of the frames' folder.
    studio
        .deform("motion.csv", &studio.folder.path("motion.pvd"))
        .success();
    let folder = studio.folder.write("skin", "a file");
    studio
        .deform("motion.csv", &studio.folder.path("skin.pvd"))
        .code(1)
        .stderr(contains("skin: cannot be made: "));
    std::fs::remove_file(folder).unwrap();
    std::fs::remove_file(studio.folder.path("motion.pvd")).unwrap();
    std::fs::remove_dir_all(studio.folder.path("motion")).unwrap();
    assert_eq!(studio.folder.names(), before);
    let rate = |rate: &str| {
        octruss()
            .args([
                "deform", "a.oct", "--pose", "a.msh", "--model", "a.obj", "-o", "a.glb",
            ])
            .args(["--frame-rate", rate])
            .assert()
            .code(2)
            .stderr(contains("expected a positive number"))
    };
    rate("0");
    rate("many");
    // Two frames far from the first, too near each other for single precision.
    let frame = |number: u64| {
        let rest = ["0,0,0", "2,0,0", "0,2,0", "0.5,0.25,2", "0.5,0.5,-2"];
        let row = |(point, position): (usize, &&str)| format!("{number},{point},{position}\n");
        rest.iter().enumerate().map(row).collect::<String>()
    };
    let far = frame(0) + &frame(100_000_000) + &frame(100_000_001);
    studio.folder.write("far.csv", far);
    studio.deform("far.csv", &studio.folder.path("far.glb")).code(1).stderr(contains(
        "far.glb: frames 100000000 and 100000001 come at the same time in single precision\n  help: number the frames with smaller gaps, or take a lower --frame-rate",
    ));
    assert!(!studio.folder.path("far.glb").exists());
}

/// The finger, whole: what viewers are given.
#[test]
fn the_finger_becomes_an_animation() {
    let folder = Folder::new();
    let (bundle, file) = (folder.path("finger.oct"), folder.path("finger.glb"));
    octruss()
        .args(["bake", "--levels", "1", "--unit", "mm"])
        .arg(model("finger.msh"))
        .arg("--model")
        .arg(model("finger.obj"))
        .arg("-o")
        .arg(&bundle)
        .assert()
        .success();
    octruss()
        .arg("deform")
        .arg(&bundle)
        .arg("--motion")
        .arg(model("finger-motion.csv"))
        .arg("--model")
        .arg(model("finger.obj"))
        .arg("-o")
        .arg(&file)
        .assert()
        .success();
    let document = gltf::Gltf::open(&file).unwrap();
    let mesh = document.meshes().next().unwrap();
    let primitive = mesh.primitives().next().unwrap();
    assert_eq!(primitive.indices().unwrap().count(), 5520 * 2 * 3);
    assert_eq!(primitive.morph_targets().count(), 32);
    assert_eq!(document.animations().count(), 1);
}
