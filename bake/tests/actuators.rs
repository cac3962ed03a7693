//! Actuators and effectors from text files through the command line to core: what the baked solver moves is what the
//! baked table moves.

mod common;

use common::{Folder, model, octruss};
use octruss::control::inverse::{GaveUp, InverseState, VolumeGoal};
use octruss_bake::bundle::BundleBytes;
use octruss_bake::read::{control, motion};

const ONE: f64 = 1_073_741_824.0;
const VERTICES: usize = 72;

/// The finger's modes as displacements, in the bundle's units.
fn modes(rest: &[[i32; 3]], scale: f64) -> Vec<Vec<[f64; 3]>> {
    let frames = motion::read(&model("finger-modes.csv"), VERTICES, &|_| Ok(())).unwrap();
    let displacement = |(own, rest): (&[f64; 3], &[i32; 3])| {
        [0, 1, 2].map(|axis| own[axis] * scale - f64::from(rest[axis]))
    };
    frames
        .iter()
        .map(|frame| frame.points.iter().zip(rest).map(displacement).collect())
        .collect()
}

/// Amplitudes within the bounds make a pose whose effectors, by the table, are the goals; the solver, which has neither
/// the modes nor the table, must find its way there. Expected figures are the goals themselves.
#[test]
fn the_solver_finds_the_amplitudes_that_the_table_was_moved_by() {
    let folder = Folder::new();
    let file = folder.path("finger.oct");
    octruss()
        .args([
            "bake",
            "--unit",
            "mm",
            "--volume",
            "--damping",
            "0",
            "--modes",
        ])
        .arg(model("finger-modes.csv"))
        .arg("--actuators")
        .arg(model("finger-actuators.csv"))
        .arg("--effectors")
        .arg(model("finger-effectors.csv"))
        .arg("--model")
        .arg(model("finger.obj"))
        .arg(model("finger.msh"))
        .arg("-o")
        .arg(&file)
        .assert()
        .success();
    let bytes = BundleBytes::read(&file).unwrap();
    let bundle = bytes.open().unwrap();
    let solver = bundle.inverse::<i32>().unwrap().unwrap();
    let volume = bundle.volume_modes::<i32>(0).unwrap().unwrap();
    let table = bundle.table::<i32>().unwrap();
    let scale = f64::from(bundle.header().fraction_bits.get()).exp2();
    let rest = bundle.rest_cage();
    let modes = modes(rest, scale);
    assert_eq!((solver.actuators(), solver.effectors()), (16, 32));

    let points = octruss_bake::read::model(&model("finger.obj"))
        .unwrap()
        .points
        .len();
    let effectors = control::effectors(&model("finger-effectors.csv"), points).unwrap();
    let mut row_of = vec![0; points];
    for (row, point) in bundle.model_points().iter().enumerate() {
        row_of[point] = row;
    }
    let moved = |amplitudes: &[f64]| -> Vec<[i32; 3]> {
        let mut pose = rest.to_vec();
        for (point, own) in pose.iter_mut().enumerate() {
            for (axis, coordinate) in own.iter_mut().enumerate() {
                let terms = modes.iter().zip(amplitudes);
                let way: f64 = terms.map(|(mode, part)| mode[point][axis] * part).sum();
                *coordinate += way.round() as i32;
            }
        }
        let mut out = vec![[0; 3]; table.rows()];
        table.apply(0..table.rows(), &pose, &mut out).unwrap();
        effectors.iter().map(|own| out[row_of[own.point]]).collect()
    };

    // Some of everything, all within the bounds of the file.
    let wanted: Vec<f64> = (0..16)
        .map(|mode| f64::from(mode * 7 % 16 - 8) / 20.0)
        .collect();
    let goals = moved(&wanted);
    let fixed: Vec<i32> = wanted.iter().map(|own| (own * ONE) as i32).collect();
    // The baked displacements: the pose, and the effectors in the table's rows, are the ones made of the file's modes.
    let actuation = bundle.actuation::<i32>().unwrap().unwrap();
    let mut pose = vec![[0; 3]; VERTICES];
    assert_eq!(actuation.pose(&fixed, &mut pose), Ok(0));
    let mut out = vec![[0; 3]; table.rows()];
    table.apply(0..table.rows(), &pose, &mut out).unwrap();
    assert_eq!(actuation.effector_rows().len(), 32);
    for (&row, goal) in actuation.effector_rows().iter().zip(&goals) {
        for (own, other) in out[row as usize].iter().zip(goal) {
            // Sixteen displacements, each rounded by half a unit, of at most 0.4 of them; rest and weights beside.
            assert!(own.abs_diff(*other) <= 6, "{own} {other}");
        }
    }
    let hold = VolumeGoal::Hold(volume.volume(&fixed).unwrap());
    for hold in [None, Some((&volume, hold))] {
        let mut state = InverseState::new(&solver);
        for _ in 0..400 {
            let report = solver.tick(&goals, hold, &mut state).unwrap();
            assert!(!report.gave_up.contains(GaveUp::VOLUME_MISSED));
        }
        let found: Vec<f64> = state.amplitudes().map(|own| f64::from(own) / ONE).to_vec();
        // Poses and rows are rounded to units of 2e-7 mm, amplitudes to a billionth; what is left is the last of the
        // descent along modes that the effectors hardly tell apart.
        let reached = moved(&found);
        let pairs = reached.as_flattened().iter().zip(goals.as_flattened());
        let furthest = pairs.map(|(a, b)| a.abs_diff(*b)).max().unwrap();
        assert!(f64::from(furthest) / scale < 1e-5, "{furthest}");
        let off = found.iter().zip(&wanted).map(|(a, b)| (a - b).abs());
        assert!(off.fold(0.0, f64::max) < 1e-4, "{found:?}");
    }
}
