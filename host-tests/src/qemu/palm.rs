//! A palm in the wind: the same minute on the host, by the reference and on emulated boards, and a picture of it.

use std::fs;
use std::path::Path;
use std::time::Duration;

use octruss::bundle::Bundle;
use octruss::control::springs::{Obstacle, PointState, Shape};
use octruss_bake::bundle::BundleBytes;
use octruss_bake::deform::format_of;
use octruss_bake::mesh::Point;
use octruss_bake::picture::{Frame, Scene, Sheet, View, contact_sheet, edges_of};
use octruss_bake::read;
use octruss_bake::refine::Level;
use octruss_firmware::checksum;
use octruss_firmware::exit::parse_figure;
use octruss_firmware::palm::{Palm, PalmMemory, SECONDS, TICKS_A_SECOND};
use octruss_firmware::player::ROWS_A_PIECE;

use super::demo::Failure;
use super::{Machine, Run};
use crate::reference_springs::{Moving, ObstacleData, SpringData, SpringsData};

/// 8 ns an instruction.
const SHIFT: u8 = 3;
/// The ticks that are drawn: two gusts, and the ball among the leaves.
const DRAWN: [u32; 8] = [0, 40, 75, 110, 160, 375, 400, 675];

/// A minute as the host has it.
pub struct Minute {
    /// Checksums of each second's end: of the springs' state and of the model.
    pub seconds: Vec<[u32; 2]>,
    /// Coordinates that were clamped.
    pub clamped: u32,
    /// Seconds that were held against the reference.
    pub reference_seconds: u32,
    /// Those whose state is another there.
    pub not_reference: u32,
}

/// What a board made of the minute.
pub struct Blown {
    /// Checksums that were compared.
    pub hashes: usize,
    /// Checksums that are not the host's.
    pub differing: usize,
    /// Ticks that the board missed.
    pub missed: u64,
    /// Coordinates that it clamped.
    pub clamped: u64,
    /// The longest tick.
    pub busy_us: u64,
}

/// Memory of a palm.
struct Memory {
    state: Vec<PointState>,
    pose: Vec<[i32; 3]>,
    pushes: Vec<[i32; 3]>,
}

impl Memory {
    fn of(bundle: &Bundle<'_>) -> Self {
        let points = bundle.rest_cage().len();
        Memory {
            state: vec![PointState::default(); points],
            pose: vec![[0; 3]; points],
            pushes: vec![[0; 3]; points],
        }
    }

    fn lend(&mut self) -> PalmMemory<'_> {
        PalmMemory {
            state: &mut self.state,
            pose: &mut self.pose,
            pushes: &mut self.pushes,
        }
    }
}

/// Plays the minute here, and its first seconds by the reference.
///
/// # Errors
/// If `palm.oct` cannot be read or holds no palm.
pub fn minute(directory: &Path, reference_seconds: u32) -> Result<Minute, Failure> {
    let bytes = BundleBytes::read(&directory.join("palm.oct"))?;
    let bundle = bytes.open()?;
    let palm = Palm::open(&bundle)?;
    let mut memory = Memory::of(&bundle);
    let mut lent = memory.lend();
    palm.start(&mut lent)?;
    let mut piece = [[0; 3]; ROWS_A_PIECE];
    let mut minute = Minute {
        seconds: Vec::new(),
        clamped: 0,
        reference_seconds: reference_seconds.min(SECONDS),
        not_reference: 0,
    };
    let data = springs_of(&bundle)?;
    let rest = bundle.rest_cage();
    let mut state: Vec<Moving> = rest.iter().map(|place| Moving::at(*place)).collect();
    for tick in 0..SECONDS * TICKS_A_SECOND {
        minute.clamped += palm.tick(tick, &mut lent)?;
        let is_judged = tick < minute.reference_seconds * TICKS_A_SECOND;
        if is_judged {
            let obstacles = [ball(&palm.ball(tick))];
            minute.clamped += data.tick(rest, lent.pushes, &obstacles, &mut state);
        }
        if tick % TICKS_A_SECOND == TICKS_A_SECOND - 1 {
            let (model, clamped) = checksum::of_model(&palm.table, lent.pose, &mut piece)?;
            minute.clamped += clamped;
            minute.seconds.push([Palm::state_hash(&lent), model]);
            let same = |(own, other): (&PointState, &Moving)| {
                *other == Moving::new(own.position(), own.velocity())
            };
            if is_judged && !lent.state.iter().zip(&state).all(same) {
                minute.not_reference += 1;
            }
        }
    }
    Ok(minute)
}

/// The springs as the reference wants them.
fn springs_of(bundle: &Bundle<'_>) -> Result<SpringsData, Failure> {
    let springs = bundle.springs::<i32>()?.ok_or("there are no springs")?;
    let parts = springs.parts();
    let points = parts.points.iter();
    let spring = |own: &octruss::control::springs::Spring| SpringData {
        ends: own.points.map(usize::from),
        length: own.length,
        shift: own.length_shift,
        factors: [own.share, own.stretch, own.shape],
    };
    Ok(SpringsData {
        points: points.map(|own| [own.mobility, own.anchor]).collect(),
        springs: parts.springs.iter().map(spring).collect(),
        substeps: parts.substeps,
        drag: parts.drag,
        damping: parts.damping,
        push_shift: parts.push_shift,
        gravity: parts.gravity,
    })
}

fn ball(obstacle: &Obstacle<i32>) -> ObstacleData {
    let grip = obstacle.grip;
    match obstacle.shape {
        Shape::Plane { point, normal } => ObstacleData::Plane(point, normal, grip),
        Shape::Sphere { centre, radius } => ObstacleData::Sphere(centre, radius, grip),
        Shape::Capsule { ends, radius } => ObstacleData::Capsule(ends, radius, grip),
    }
}

/// Plays the minute on a board.
///
/// # Errors
/// If the image does not run to its end.
pub fn play(machine: Machine, directory: &Path, minute: &Minute) -> Result<Blown, Failure> {
    let outcome = Run::new(machine, machine.image("palm"))
        .directory(directory)
        .instruction_shift(SHIFT)
        .time_limit(Duration::from_secs(300))
        .run()?;
    let figures: Vec<(&str, u64)> = outcome
        .log
        .messages
        .iter()
        .filter_map(|message| parse_figure(&message.text))
        .collect();
    let figure = |name: &str| {
        let found = figures.iter().find(|(own, _)| *own == name);
        found.map(|(_, value)| *value)
    };
    let mut differing = 0;
    for (second, expected) in minute.seconds.iter().enumerate() {
        for (what, expected) in ["state", "model"].iter().zip(expected) {
            let found = figure(&format!("second {second} {what}"));
            differing += usize::from(found != Some(u64::from(*expected)));
        }
    }
    let told = |name: &str| figure(name).ok_or("the image has not told all its figures");
    Ok(Blown {
        hashes: 2 * minute.seconds.len(),
        differing,
        missed: told("missed ticks")?,
        clamped: told("clamped coordinates")?,
        busy_us: told("busy us")?,
    })
}

/// Draws moments of the minute.
///
/// # Errors
/// If a file cannot be read or written.
pub fn draw(directory: &Path, cage: &Path, model: &Path, picture: &Path) -> Result<(), Failure> {
    let bytes = BundleBytes::read(&directory.join("palm.oct"))?;
    let bundle = bytes.open()?;
    let palm = Palm::open(&bundle)?;
    let triangles = read::model(model)?.triangles();
    let edges = edges_of(&Level::new(&read::solid(cage)?)?.skin());
    let mut memory = Memory::of(&bundle);
    let mut lent = memory.lend();
    palm.start(&mut lent)?;
    let format = format_of(&bundle);
    let mut tiles = Vec::new();
    for tick in 0..=DRAWN.into_iter().max().unwrap_or(0) {
        palm.tick(tick, &mut lent)?;
        if !DRAWN.contains(&tick) {
            continue;
        }
        let mut rows = vec![[0; 3]; palm.table.rows()];
        palm.table.apply(0..rows.len(), lent.pose, &mut rows)?;
        let mut points: Vec<Point> = vec![[0.0; 3]; rows.len()];
        let places = bundle.model_points().iter();
        for (point, place) in places.zip(format.points_of(&rows)) {
            points[point] = place;
        }
        let tenths = 10 * tick / TICKS_A_SECOND;
        tiles.push(Frame {
            caption: format!("{}.{} s", tenths / 10, tenths % 10),
            model: points,
            cage: format.points_of(lent.pose),
        });
    }
    let scene = Scene {
        triangles: &triangles,
        cage_edges: &edges,
    };
    let sheet = Sheet {
        view: View {
            toward_viewer: [0.2, -1.0, 0.25],
            ..View::default()
        },
        tile: [300, 300],
        columns: Some(4),
    };
    fs::write(picture, contact_sheet(&scene, &tiles, &sheet)?)?;
    Ok(())
}
