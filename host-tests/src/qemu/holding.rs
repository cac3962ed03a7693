//! The finger follows goals on a device with its volume held, beside the same motion without the constraint.
//!
//! The volume of every frame is taken anew: of the control points, by the form over them, in core's exact integers,
//! which shares nothing with the polynomial of modes that the device holds it by but the baker.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;
use std::time::Duration;

use super::demo::Failure;
use super::{Machine, Run, image};
use crate::performance::inverse::{Sources, bake_solver, goals_of_motion};
use octruss::enclosed::VolumeForm;
use octruss_bake::bundle::BundleBytes;
use octruss_bake::picture::{Frame, Scene, Sheet, View, contact_sheet, plot};
use octruss_bake::read;
use octruss_bake::read::motion;

/// Bytes of a result: sixteen amplitudes, what was given up, the volume.
const RESULT_BYTES: usize = 16 * 4 + 4 + 8;
/// An amplitude of one.
const ONE: f64 = 1_073_741_824.0;
/// Frames in the picture.
const TILES: usize = 8;

/// One frame of one run.
#[derive(Clone, Debug)]
pub struct Held {
    /// The amplitudes.
    pub amplitudes: Vec<f64>,
    /// What was given up, by bits.
    pub gave_up: u32,
    /// The control points.
    pub pose: Vec<[f64; 3]>,
    /// How far the form's volume is from that at rest, as a part of it.
    pub error: f64,
    /// How far the effectors are from their goals: the root of the mean square, in the unit.
    pub distance: f64,
}

/// Runs the image and returns the frames with the volume held and without.
///
/// # Errors
/// If a file cannot be read or written, or the image does not finish.
pub fn play(directory: &Path, sources: &Sources) -> Result<[Vec<Held>; 2], Failure> {
    fs::create_dir_all(directory)?;
    bake_solver(directory, sources)?;
    let goals = goals_of_motion(directory, sources)?;
    let numbers = goals.concat().into_iter().flatten();
    fs::write(
        directory.join("frames.bin"),
        numbers.flat_map(i32::to_le_bytes).collect::<Vec<_>>(),
    )?;
    Run::new(Machine::Mps2An386, image("holding"))
        .directory(directory)
        .time_limit(Duration::from_secs(120))
        .run()?;
    let bytes = fs::read(directory.join("held.bin"))?;
    if bytes.len() != goals.len() * 2 * RESULT_BYTES {
        return Err("the image wrote another number of frames".into());
    }
    let judge = Judge::new(directory, sources)?;
    let mut runs = [Vec::new(), Vec::new()];
    for (place, result) in bytes.chunks(RESULT_BYTES).enumerate() {
        runs[place % 2].push(judge.held(result, &goals[place / 2])?);
    }
    Ok(runs)
}

/// What the host knows of the finger.
struct Judge {
    bundle: BundleBytes,
    modes: Vec<Vec<[f64; 3]>>,
    rest: Vec<[f64; 3]>,
    effectors: Vec<usize>,
    scale: f64,
}

impl Judge {
    fn new(directory: &Path, sources: &Sources) -> Result<Self, Failure> {
        let bundle = BundleBytes::read(&directory.join("inverse.oct"))?;
        let opened = bundle.open()?;
        let scale = f64::from(opened.header().fraction_bits.get()).exp2();
        let rest: Vec<_> = opened
            .rest_cage()
            .iter()
            .map(|bits| bits.map(|own| f64::from(own) / scale))
            .collect();
        let frames = motion::read(
            &sources.folder.join("finger-modes.csv"),
            rest.len(),
            &|_| Ok(()),
        )?;
        let points = opened.header().rows.get() as usize;
        let effectors =
            read::control::effectors(&sources.folder.join("finger-effectors.csv"), points)?;
        Ok(Self {
            modes: frames.into_iter().map(|frame| frame.points).collect(),
            rest,
            effectors: effectors.iter().map(|own| own.point).collect(),
            scale,
            bundle,
        })
    }

    fn held(&self, result: &[u8], goals: &[[i32; 3]]) -> Result<Held, Failure> {
        let (words, _) = result.as_chunks();
        let amplitudes: Vec<f64> = words[..self.modes.len()]
            .iter()
            .map(|bytes| f64::from(i32::from_le_bytes(*bytes)) / ONE)
            .collect();
        let mut pose = self.rest.clone();
        for (amplitude, mode) in amplitudes.iter().zip(&self.modes) {
            for ((own, to), from) in pose.iter_mut().zip(mode).zip(&self.rest) {
                for axis in 0..3 {
                    own[axis] += amplitude * (to[axis] - from[axis]);
                }
            }
        }
        let opened = self.bundle.open()?;
        let form = opened.volume_form::<i32>(0)?.ok_or("no volume was baked")?;
        let at_rest = volume(&form, opened.rest_cage())?;
        let error = volume(&form, &self.bits(&pose))? / at_rest - 1.0;
        let moved = self.deform(&pose)?;
        let squares = self.effectors.iter().zip(goals).map(|(&point, goal)| {
            let pairs = moved[point].iter().zip(goal);
            pairs
                .map(|(own, goal)| (own - f64::from(*goal) / self.scale).powi(2))
                .sum::<f64>()
        });
        let distance = (squares.sum::<f64>() / goals.len() as f64).sqrt();
        Ok(Held {
            amplitudes,
            gave_up: u32::from_le_bytes(words[16]),
            pose,
            error,
            distance,
        })
    }

    fn bits(&self, pose: &[[f64; 3]]) -> Vec<[i32; 3]> {
        let bits = |point: &[f64; 3]| point.map(|own| (own * self.scale).round() as i32);
        pose.iter().map(bits).collect()
    }

    /// The skin in the model's order.
    fn deform(&self, pose: &[[f64; 3]]) -> Result<Vec<[f64; 3]>, Failure> {
        let opened = self.bundle.open()?;
        let table = opened.table::<i32>()?;
        let mut rows = vec![[0; 3]; table.rows()];
        table.apply(0..table.rows(), &self.bits(pose), &mut rows)?;
        let mut points = vec![[0.0; 3]; rows.len()];
        for (row, point) in rows.iter().zip(opened.model_points().iter()) {
            points[point] = row.map(|own| f64::from(own) / self.scale);
        }
        Ok(points)
    }
}

fn volume(form: &VolumeForm<'_>, pose: &[[i32; 3]]) -> Result<f64, Failure> {
    let mut workspace = vec![[0; 3]; form.workspace_length()];
    Ok(form.volume(pose, &mut workspace)?.volume as f64)
}

/// Draws `holding.png`, the skin with the volume held above and without below, and `holding-volume.png`, the volumes
/// over time, and returns a table for people.
///
/// # Errors
/// If a file cannot be read or written.
pub fn draw(directory: &Path, sources: &Sources, runs: &[Vec<Held>; 2]) -> Result<String, Failure> {
    let judge = Judge::new(directory, sources)?;
    let model = read::model(&sources.model)?;
    let mut triangles = Vec::new();
    for face in &model.faces {
        triangles.extend((2..face.len()).map(|k| [face[0], face[k - 1], face[k]]));
    }
    let count = runs[0].len();
    let chosen: Vec<usize> = (0..TILES)
        .map(|tile| (tile * (count - 1) + TILES / 2) / (TILES - 1))
        .map(|own| own.min(count - 1))
        .collect();
    let mut tiles = Vec::new();
    for run in runs {
        for &frame in &chosen {
            let held = &run[frame];
            tiles.push(Frame {
                caption: format!("frame {frame}: volume {:+.4} %", 100.0 * held.error),
                model: judge.deform(&held.pose)?,
                cage: Vec::new(),
            });
        }
    }
    let scene = Scene {
        triangles: &triangles,
        cage_edges: &[],
    };
    let sheet = Sheet {
        view: View {
            toward_viewer: [1.0, -0.25, 0.15],
            ..View::default()
        },
        tile: [190, 300],
        columns: Some(TILES as u32),
    };
    fs::write(
        directory.join("holding.png"),
        contact_sheet(&scene, &tiles, &sheet)?,
    )?;
    let percent = |run: &[Held]| run.iter().map(|held| 100.0 * held.error).collect();
    let curves = [("held", percent(&runs[0])), ("free", percent(&runs[1]))];
    let title = "Volume of the finger along its effectors' goals, percent off its rest";
    fs::write(directory.join("holding-volume.png"), plot(title, &curves)?)?;
    let mut text = String::from(
        "frame  held: volume off by, effectors from goals   free: volume off by, effectors from goals\n",
    );
    for (frame, (held, free)) in runs[0].iter().zip(&runs[1]).enumerate() {
        writeln!(
            text,
            "{frame:5}  {:+.2e}  {:.3}   {:+.2e}  {:.3}",
            held.error, held.distance, free.error, free.distance
        )?;
    }
    Ok(text)
}
