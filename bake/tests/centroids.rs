//! `octruss bake --centroid`: centroids by modes, as a device finds them.

mod common;

use common::{Folder, model, octruss};
use octruss_bake::bundle::BundleBytes;
use octruss_bake::forms::solid::Enclosure;
use octruss_bake::forms::{LimitSurface, Scheme};
use octruss_bake::read;
use predicates::str::contains;
use std::path::Path;

/// One in amplitudes' unit.
const ONE: i32 = 1 << 30;

/// Poses as a motion: a frame for each.
fn motion(folder: &Folder, poses: &[Vec<[f64; 3]>]) -> std::path::PathBuf {
    let mut text = String::from("frame,point,x,y,z\n");
    for (frame, pose) in poses.iter().enumerate() {
        for (point, [x, y, z]) in pose.iter().enumerate() {
            text += &format!("{frame},{point},{x},{y},{z}\n");
        }
    }
    folder.write("modes.csv", text)
}

struct Device {
    bytes: BundleBytes,
    report: serde_json::Value,
}

impl Device {
    fn bake(folder: &Folder, arguments: &[&str], files: &[(&str, &Path)], cage: &Path) -> Self {
        let bundle = folder.path("out.oct");
        let mut command = octruss();
        command.arg("bake").args(arguments);
        for (option, file) in files {
            command.arg(option).arg(file);
        }
        command.arg(cage).arg("-o").arg(&bundle);
        let output = command.assert().success().get_output().stdout.clone();
        Self {
            bytes: BundleBytes::read(&bundle).unwrap(),
            report: serde_json::from_slice(&output).unwrap(),
        }
    }

    fn centroid(&self) -> &serde_json::Value {
        &self.report["volumes"][0]["modes"]["centroid"]
    }

    /// The offset from the base in the unit, and its bits.
    fn offset(&self, amplitudes: &[i32]) -> ([f64; 3], [i32; 3]) {
        let bundle = self.bytes.open().unwrap();
        let modes = bundle.volume_modes::<i32>(0).unwrap().unwrap();
        let centroid = bundle.centroid_modes::<i32>(0).unwrap().unwrap();
        assert_eq!(
            centroid.base() as u64,
            self.centroid()["base"].as_u64().unwrap()
        );
        let volume = modes.volume(amplitudes).unwrap();
        let found = centroid.offset(amplitudes, volume).unwrap();
        assert_eq!(found.saturated, 0);
        let place = 0.5_f64.powi(bundle.header().fraction_bits.get() as i32);
        (
            found.offset.map(|bits| f64::from(bits) * place),
            found.offset,
        )
    }
}

fn close(got: [f64; 3], want: [f64; 3], bound: f64) {
    for (got, want) in got.iter().zip(want) {
        assert!((got - want).abs() <= bound, "{got}, not {want}");
    }
}

/// A box of 4 by 2 by 6, of eight hexahedra, with a file of its twelve sharp edges and eight corners.
fn sharp_box(folder: &Folder) -> [std::path::PathBuf; 2] {
    let size = [2_usize, 1, 4];
    let number = |[x, y, z]: [usize; 3]| (z * (size[1] + 1) + y) * (size[0] + 1) + x;
    let grid = |extra: usize| {
        let all = (0..size[2] + extra).flat_map(move |z| {
            (0..size[1] + extra).flat_map(move |y| (0..size[0] + extra).map(move |x| [x, y, z]))
        });
        all.collect::<Vec<_>>()
    };
    let mut text = String::from("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n30\n");
    let mut features = String::new();
    for place @ [x, y, z] in grid(1) {
        let own = number(place);
        let [px, py, pz] = [2 * x, 2 * y, 3 * z / 2];
        let half = if z % 2 == 1 { ".5" } else { "" };
        text += &format!("{} {px} {py} {pz}{half}\n", own + 1);
        let ends = (0..3).map(|k| usize::from(place[k] == 0 || place[k] == size[k]));
        if ends.clone().sum::<usize>() == 3 {
            features += &format!("corner {own}\n");
        }
        for axis in 0..3 {
            let others = ends.clone().enumerate().filter(|(k, _)| *k != axis);
            let mut next = place;
            next[axis] += 1;
            if next[axis] <= size[axis] && others.map(|(_, end)| end).sum::<usize>() == 2 {
                features += &format!("crease {own} {}\n", number(next));
            }
        }
    }
    text += "$EndNodes\n$Elements\n8\n";
    for (place, [x, y, z]) in grid(0).into_iter().enumerate() {
        let ring = [[0, 0], [1, 0], [1, 1], [0, 1]];
        let corners = (0..8).map(|k| {
            let [i, j] = ring[k % 4];
            format!(" {}", number([x + i, y + j, z + k / 4]) + 1)
        });
        text += &format!("{} 5 2 1 1{}\n", place + 1, corners.collect::<String>());
    }
    text += "$EndElements\n";
    [
        folder.write("box.msh", text),
        folder.write("box.txt", features),
    ]
}

/// The box keeps its edges, and its faces stay flat: its limit is the box itself, whose centroid is its middle.
/// A mode that moves everything moves the base too, and no bit of the offset; affine ones take the middle
/// with them.
#[test]
fn a_box_has_its_middle() {
    let folder = Folder::new();
    let [cage, features] = sharp_box(&folder);
    let rest = read::solid(&cage).unwrap().points;
    let map = |map: fn([f64; 3]) -> [f64; 3]| rest.iter().map(|&point| map(point)).collect();
    let poses: [Vec<_>; 3] = [
        map(|[x, y, z]| [x + 0.75, y - 2.0, z + 1.25]),
        map(|[x, y, z]| [1.5 * x, y, z]),
        map(|[x, y, z]| [x + 0.5 * y, y, z - 0.25 * x]),
    ];
    let modes = motion(&folder, &poses);
    let point = folder.write("point.obj", "v 2 1 3\n");
    let arguments = [
        "--scheme",
        "mixed",
        "--levels",
        "1",
        "--volume",
        "--centroid",
        "--json",
    ];
    let files = [
        ("--features", features.as_path()),
        ("--modes", &modes),
        ("--model", &point),
    ];
    let device = Device::bake(&folder, &arguments, &files, &cage);
    let volume = device.report["volumes"][0]["volume"].as_f64().unwrap();
    assert!((volume - 48.0).abs() < 1e-9, "{volume}");
    let number = |value: &serde_json::Value| value.as_f64().unwrap();
    let at_rest = device.centroid()["at_rest"].as_array().unwrap();
    let at_rest: Vec<f64> = at_rest.iter().map(number).collect();
    close(at_rest.try_into().unwrap(), [2.0, 1.0, 3.0], 1e-9);
    assert_eq!(device.centroid()["base"], 0);
    // (3 + 4 choose 4) coefficients for each axis, and the record.
    assert_eq!(device.centroid()["coefficients"], 3 * 35);
    assert_eq!(device.centroid()["bytes"], 3 * 35 * 4 + 16);

    let bound = number(&device.centroid()["error_bound"]);
    assert!(bound < 1e-7, "{bound}");
    let (offset, bits) = device.offset(&[0; 3]);
    close(offset, [2.0, 1.0, 3.0], bound + 1e-9);
    assert_eq!(device.offset(&[ONE, 0, 0]).1, bits);
    assert_eq!(device.offset(&[-ONE, 0, 0]).1, bits);
    // x is 1.5 times as long, so what rounds the moments weighs no more than 16 times as much, and the
    // volume grew.
    close(
        device.offset(&[0, ONE, 0]).0,
        [3.0, 1.0, 3.0],
        100.0 * bound,
    );
    // The middle (2, 1, 3) under the shear, at half the amplitude.
    close(
        device.offset(&[0, 0, ONE / 2]).0,
        [2.25, 1.0, 2.75],
        100.0 * bound,
    );
}

/// A smooth surface: the device against the moments of the posed mesh by Gauss points, which are not
/// polarised, at amplitudes that no pose has.
#[test]
fn a_surface_agrees_with_its_moments() {
    let folder = Folder::new();
    let cage = folder.write(
        "cube.obj",
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n\
         f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n",
    );
    let mesh = read::surface(&cage).unwrap();
    let mut pulled = mesh.points.clone();
    pulled[6] = [1.5, 1.25, 1.75];
    pulled[0][2] -= 0.5;
    let mut twisted = mesh.points.clone();
    for point in &mut twisted[4..] {
        *point = [1.0 - point[1], point[0], 1.25];
    }
    let modes = motion(&folder, &[pulled.clone(), twisted.clone()]);
    for (name, scheme) in [
        ("catmull-clark", Scheme::CatmullClark),
        ("doo-sabin", Scheme::DooSabin),
    ] {
        let arguments = [
            "--scheme",
            name,
            "--levels",
            "1",
            "--volume",
            "--centroid",
            "--json",
        ];
        let device = Device::bake(&folder, &arguments, &[("--modes", &modes)], &cage);
        let enclosure = Enclosure::new(&mesh.faces, &mesh.features).unwrap();
        let surface = LimitSurface::<f64>::new(scheme, &enclosure.mesh).unwrap();
        for [a, b] in [[0.0, 0.0], [0.75, 0.0], [-0.25, 0.5], [0.5, -0.125]] {
            let posed: Vec<[f64; 3]> = (0..8)
                .map(|k| {
                    [0, 1, 2].map(|axis| {
                        let rest = mesh.points[k][axis];
                        rest + a * (pulled[k][axis] - rest) + b * (twisted[k][axis] - rest)
                    })
                })
                .collect();
            let want = surface.moments(&posed).unwrap().centroid;
            let base = posed[device.centroid()["base"].as_u64().unwrap() as usize];
            let want = [0, 1, 2].map(|axis| want[axis] - base[axis]);
            let amplitudes = [a, b].map(|amplitude| (amplitude * f64::from(ONE)) as i32);
            let bound = device.centroid()["error_bound"].as_f64().unwrap();
            assert!(bound < 1e-7, "{bound}");
            // With s = 1 + 2 * 0.75 the moments' bound at rest grows by less than s^4, to 40 times.
            close(device.offset(&amplitudes).0, want, 100.0 * bound);
        }
    }
}

#[test]
fn bad_input_is_told() {
    let folder = Folder::new();
    let refused = |arguments: &[&str], words: &str| {
        let mut command = octruss();
        command.args(["bake", "--scheme", "mixed"]).args(arguments);
        command.arg("-o").arg(folder.path("none.oct"));
        command
            .arg("--model")
            .arg(folder.write("point.obj", "v 2 1 2\n"));
        let refused = command.arg(model("slices/block.msh")).assert().failure();
        refused.stderr(contains(words));
    };
    refused(&["--volume", "--centroid"], "--modes <MODES>");
    let cage = read::solid(&model("slices/block.msh")).unwrap().points;
    let many = motion(&folder, &vec![cage; 17]);
    let many = many.to_str().unwrap();
    refused(
        &["--volume", "--centroid", "--modes", many],
        "a centroid is baked for at most 16",
    );
    assert!(!folder.path("none.oct").exists());
}
