//! Runs the demo on an emulated board, holds every coordinate that it streams against the
//! reference, and draws what the device returned.

use std::fmt;
use std::path::{Path, PathBuf};
use std::time::Duration;

use octruss_bake::animation::{self, Animation};
use octruss_bake::bundle::BundleBytes;
use octruss_bake::deform::format_of;
use octruss_bake::mesh::Point;
use octruss_bake::picture::{Frame as Tile, Scene, Sheet, View, contact_sheet, edges_of};
use octruss_bake::read;
use octruss_bake::refine::Level;
use octruss_firmware::frame::FrameReader;

use super::{Machine, Message, Run};
use crate::reference::{Table, apply_displacement};

/// Why the demo cannot be judged.
pub type Failure = Box<dyn std::error::Error>;

/// The shift of the instruction clock at which the demo runs: 125 instructions a microsecond,
/// about what the processors of this class do.
pub const SHIFT: u8 = 3;

/// The memory of the part that the demo is to fit, an STM32F405: flash.
const FLASH_BYTES: u64 = 1 << 20;
/// Its RAM.
const RAM_BYTES: u64 = 128 << 10;

/// Tiles of the picture.
const TILES: usize = 12;

/// The example as the host sees it: what the image was built with, read again from the files.
pub struct Example {
    bundle: BundleBytes,
    poses: Vec<Vec<[i32; 3]>>,
    table: Table,
    rest_cage: Vec<[i32; 3]>,
    rest_model: Vec<[i32; 3]>,
    /// The model's point that each row is.
    model_points: Vec<usize>,
}

impl Example {
    /// Reads `finger.oct` and `finger.poses` from a directory.
    ///
    /// # Errors
    ///
    /// If a file cannot be read or the two do not belong together.
    pub fn read(directory: &Path) -> Result<Self, Failure> {
        let bytes = BundleBytes::read(&directory.join("finger.oct"))?;
        let bundle = bytes.open()?;
        let rest_cage = bundle.rest_cage().to_vec();
        let rows = bundle.table::<i32>()?;
        let table = reference_table(&rows)?;
        table.check(rest_cage.len())?;
        let rest_model = rest_model(&rows, &rest_cage)?;
        let poses = poses(&directory.join("finger.poses"), rest_cage.len())?;
        let model_points = bundle.model_points().iter().collect();
        Ok(Example {
            bundle: bytes,
            poses,
            table,
            rest_cage,
            rest_model,
            model_points,
        })
    }
}

impl Example {
    /// Weights of the table that are not zero.
    #[must_use]
    pub fn taps(&self) -> usize {
        self.table.weights.len()
    }
}

/// The rows of a bundle as the reference wants them, weights in 30 fraction bits.
pub(crate) fn reference_table(rows: &octruss::deform::Table<'_, i32>) -> Result<Table, Failure> {
    let shift = 30 - rows.weight_bits();
    let mut table = Table {
        offsets: vec![0],
        ..Table::default()
    };
    for row in 0..rows.rows() {
        for (point, weight) in rows.row(row).into_iter().flatten() {
            table.indices.push(u16::try_from(point)?);
            table.weights.push(weight << shift);
        }
        table.offsets.push(u32::try_from(table.indices.len())?);
    }
    Ok(table)
}

/// The rows at rest, out of what their sums start from:
/// `rest * 2^q + 2^(q - 1) = start + sum of weight * rest cage`.
pub(crate) fn rest_model(
    rows: &octruss::deform::Table<'_, i32>,
    rest_cage: &[[i32; 3]],
) -> Result<Vec<[i32; 3]>, Failure> {
    let one = 1_i128 << rows.weight_bits();
    let row = |row: usize| -> Result<[i32; 3], Failure> {
        let start = rows.start(row).ok_or("the bundle has no rest positions")?;
        let mut rest = [0; 3];
        for (axis, rest) in rest.iter_mut().enumerate() {
            let taps = rows.row(row).into_iter().flatten();
            let weighted =
                taps.map(|(point, weight)| i128::from(weight) * i128::from(rest_cage[point][axis]));
            let sum = i128::from(start[axis]) - one / 2 + weighted.sum::<i128>();
            if sum % one != 0 {
                return Err(format!("the start of row {row} belongs to no rest point").into());
            }
            *rest = i32::try_from(sum / one)?;
        }
        Ok(rest)
    };
    (0..rows.rows()).map(row).collect()
}

/// The frames of a motion in raw bits.
fn poses(file: &Path, control_points: usize) -> Result<Vec<Vec<[i32; 3]>>, Failure> {
    let bytes = read::bytes(file)?;
    let (words, rest) = bytes.as_chunks::<4>();
    let bits: Vec<i32> = words.iter().map(|word| i32::from_le_bytes(*word)).collect();
    let (points, more) = bits.as_chunks::<3>();
    let frames = points.chunks_exact(control_points.max(1));
    if !rest.is_empty() || !more.is_empty() || !frames.remainder().is_empty() {
        let file = file.display();
        return Err(format!("{file} holds no whole number of frames of this cage").into());
    }
    Ok(frames.map(<[[i32; 3]]>::to_vec).collect())
}

/// What a run of the demo has shown.
pub struct Played {
    /// The board.
    pub machine: Machine,
    /// The frames as the device sent them, rows in the bundle's order.
    pub frames: Vec<Vec<[i32; 3]>>,
    /// Coordinates held against the reference.
    pub coordinates: usize,
    /// Coordinates, counts and frames that are not the reference's.
    pub mismatches: usize,
    /// The first mismatches, for people.
    pub sentences: Vec<String>,
    /// The image's figures by name.
    pub figures: Vec<(String, u64)>,
}

impl Played {
    /// A figure of the image.
    #[must_use]
    pub fn figure(&self, name: &str) -> Option<u64> {
        let found = self.figures.iter().find(|(found, _)| found == name);
        found.map(|(_, value)| *value)
    }

    fn mismatch(&mut self, sentence: String) {
        const SHOWN: usize = 10;
        self.mismatches += 1;
        if self.sentences.len() < SHOWN {
            self.sentences.push(sentence);
        }
    }
}

/// Runs the demo on a board. `directory` is for files of the run.
///
/// # Errors
///
/// Those of the runner; coordinates that are not the reference's are counted instead.
pub fn play(
    example: &Example,
    machine: Machine,
    image: &Path,
    directory: &Path,
    on_message: impl FnMut(&Message),
) -> Result<Played, Failure> {
    let directory = directory.join(machine.name());
    std::fs::create_dir_all(&directory)?;
    let outcome = Run::new(machine, image)
        .directory(&directory)
        .instruction_shift(SHIFT)
        .time_limit(Duration::from_secs(180))
        .capture_serial()
        .on_message(on_message)
        .run()?;
    let figures = outcome.log.messages.iter().filter_map(|message| {
        octruss_firmware::exit::parse_figure(&message.text)
            .map(|(name, value)| (name.to_owned(), value))
    });
    let mut played = Played {
        machine,
        frames: Vec::new(),
        coordinates: 0,
        mismatches: 0,
        sentences: Vec::new(),
        figures: figures.collect(),
    };
    let mut poses = example.poses.iter().enumerate();
    for frame in FrameReader::new(&outcome.serial) {
        let frame = frame?;
        let rows: Vec<[i32; 3]> = frame.rows().collect();
        match poses.next() {
            Some((number, pose)) => {
                if frame.number as usize != number {
                    played.mismatch(format!("frame {number} arrives as {}", frame.number));
                }
                compare(example, &mut played, number, pose, &rows, frame.saturated)?;
            }
            None => played.mismatch(format!("frame {} is one too many", frame.number)),
        }
        played.frames.push(rows);
    }
    for (number, _) in poses {
        played.mismatch(format!("frame {number} is missing"));
    }
    Ok(played)
}

/// Holds one frame against the reference.
fn compare(
    example: &Example,
    played: &mut Played,
    number: usize,
    pose: &[[i32; 3]],
    rows: &[[i32; 3]],
    saturated: u32,
) -> Result<(), Failure> {
    let Example {
        table,
        rest_cage,
        rest_model,
        ..
    } = example;
    let expected = apply_displacement(table, pose, rest_cage, rest_model)?;
    if rows.len() != expected.points.len() {
        let (got, want) = (rows.len(), expected.points.len());
        played.mismatch(format!("frame {number}: {got} rows, not {want}"));
    }
    if saturated as usize != expected.saturated {
        let want = expected.saturated;
        played.mismatch(format!("frame {number}: {saturated} saturated, not {want}"));
    }
    for (row, (got, want)) in rows.iter().zip(&expected.points).enumerate() {
        for (axis, (got, want)) in ["x", "y", "z"].iter().zip(got.iter().zip(want)) {
            played.coordinates += 1;
            if got != want {
                played.mismatch(format!(
                    "frame {number}, row {row}, {axis}: {got}, not {want}"
                ));
            }
        }
    }
    Ok(())
}

impl Example {
    /// Points in the unit of the files.
    fn real(&self, bits: &[[i32; 3]]) -> Result<Vec<Point>, Failure> {
        Ok(format_of(&self.bundle.open()?).points_of(bits))
    }

    /// The rows of a frame as the model's points, in the model's order.
    fn model(&self, rows: &[[i32; 3]]) -> Result<Vec<Point>, Failure> {
        let mut points = vec![[0.0; 3]; rows.len()];
        for (point, row) in self.model_points.iter().zip(self.real(rows)?) {
            points[*point] = row;
        }
        Ok(points)
    }
}

/// Writes the frames that the device returned as animations of the model: each of `files` in the format
/// that its extension names.
///
/// # Errors
///
/// If a file cannot be read or written.
pub fn animate(
    example: &Example,
    played: &Played,
    model: &Path,
    files: &[PathBuf],
) -> Result<(), Failure> {
    const MICROSECONDS: f64 = 1e6;
    let bundle = example.bundle.open()?;
    let name = model.file_stem().unwrap_or_default().to_string_lossy();
    let model = read::model(model)?;
    let points = played.frames.iter().map(|rows| example.model(rows));
    let points: Vec<Vec<Point>> = points.collect::<Result<_, _>>()?;
    let frames: Vec<animation::Frame<'_>> = (0..)
        .zip(&points)
        .map(|(number, points)| animation::Frame { number, points })
        .collect();
    let period = played.figure("period us").filter(|period| *period != 0);
    let animation = Animation {
        name: &name,
        rest: &model.points,
        faces: &model.faces,
        frames: &frames,
        frame_rate: MICROSECONDS
            / period.ok_or("the image does not say how long a tick is")? as f64,
        unit: bundle.unit(),
        up: View::default().up,
    };
    for file in files {
        animation::write(&animation, file)?;
    }
    Ok(())
}

/// Draws some of the frames that the device returned, the cage over them, and writes the picture.
///
/// # Errors
///
/// If a file cannot be read or written.
pub fn draw(
    example: &Example,
    played: &Played,
    cage: &Path,
    model: &Path,
    picture: &Path,
) -> Result<(), Failure> {
    let triangles = read::model(model)?.triangles();
    let cage_edges = edges_of(&Level::new(&read::solid(cage)?)?.skin());
    let count = played.frames.len().min(example.poses.len());
    let tile = |number: usize| -> Result<Tile, Failure> {
        Ok(Tile {
            caption: format!("frame {number}"),
            model: example.model(&played.frames[number])?,
            cage: example.real(&example.poses[number])?,
        })
    };
    let tiles: Vec<Tile> = chosen(count).map(tile).collect::<Result<_, _>>()?;
    let scene = Scene {
        triangles: &triangles,
        cage_edges: &cage_edges,
    };
    let png = contact_sheet(&scene, &tiles, &Sheet::default())?;
    octruss_bake::write::atomically(picture, |out| {
        out.write_all(&png)
            .map_err(|error| octruss_bake::error::Error::new(error.to_string()))
    })?;
    Ok(())
}

/// The numbers of the frames in the picture: the first, the last, and some between.
fn chosen(count: usize) -> impl Iterator<Item = usize> {
    let tiles = count.min(TILES);
    (0..tiles).map(move |tile| match tiles {
        0 | 1 => 0,
        _ => tile * (count - 1) / (tiles - 1),
    })
}

/// The demo's last words.
pub struct Summary<'a> {
    /// Cells of the cage.
    pub cells: usize,
    /// Weights of the table that are not zero.
    pub taps: usize,
    /// The runs, the one with the figures first.
    pub played: &'a [Played],
    /// Where the picture is.
    pub picture: PathBuf,
    /// Where the animations are.
    pub animations: Vec<PathBuf>,
}

impl Summary<'_> {
    /// Mismatches of all runs.
    #[must_use]
    pub fn mismatches(&self) -> usize {
        self.played.iter().map(|played| played.mismatches).sum()
    }
}

/// Reads how many cells a cage has.
///
/// # Errors
///
/// If the file cannot be read.
pub fn cells(cage: &Path) -> Result<usize, Failure> {
    Ok(read::solid(cage)?.cells.len())
}

impl fmt::Display for Summary<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (name, value) in self.figures() {
            writeln!(f, "  {name:24} {value}")?;
        }
        for played in self.played {
            let name = played.machine.name();
            let processor = format!("{} ({name})", played.machine.processor());
            let (frames, coordinates) = (played.frames.len(), grouped(played.coordinates as u64));
            writeln!(
                f,
                "  {processor:24} {frames} frames, {coordinates} coordinates compared"
            )?;
            for sentence in &played.sentences {
                writeln!(f, "    {sentence}")?;
            }
        }
        write!(f, "{} mismatches", self.mismatches())
    }
}

impl Summary<'_> {
    /// The figures of the first run, each with its name.
    fn figures(&self) -> Vec<(&'static str, String)> {
        let figure = |name: &str| self.played.first().and_then(|first| first.figure(name));
        let number = |name: &str| figure(name).map_or_else(|| "unknown".to_owned(), grouped);
        let bytes = |name: &str| format!("{} bytes", number(name));
        let within = |name: &str, bound: &str| match figure(bound) {
            Some(0) => number(name),
            _ => format!("{} (within {})", number(name), number(bound)),
        };
        let period_ms = figure("period us").unwrap_or(0) as f64 / 1000.0;
        let apply = within("apply instructions a frame", "apply error bound");
        let whole = within("whole tick instructions", "whole tick error bound");
        vec![
            ("cells of the cage", grouped(self.cells as u64)),
            ("control points", number("control points")),
            ("model points", number("rows")),
            (
                "taps",
                format!(
                    "{}, {} stored",
                    grouped(self.taps as u64),
                    number("stored weights")
                ),
            ),
            ("bundle", bytes("bundle bytes")),
            (
                "instructions a frame",
                format!("at most {apply} to apply the table"),
            ),
            ("", format!("at most {whole} for the whole tick")),
            (
                "control loop",
                format!("{period_ms} ms a tick, {} missed", number("missed ticks")),
            ),
            ("flash", self.used(FLASH_BYTES, &["flash bytes"])),
            (
                "RAM, statics and stack",
                self.used(RAM_BYTES, &["static RAM bytes", "stack bytes"]),
            ),
            ("", format!("{} of statics", bytes("static RAM bytes"))),
            ("", format!("{} of stack at most", bytes("stack bytes"))),
            ("picture", self.picture.display().to_string()),
        ]
        .into_iter()
        .chain(
            self.animations
                .iter()
                .map(|file| ("animation", file.display().to_string())),
        )
        .collect()
    }

    /// What the demo takes of a memory, on the board where it takes most, and what is left.
    fn used(&self, memory: u64, names: &[&str]) -> String {
        let used = |played: &Played| -> Option<u64> {
            let figures = names.iter().map(|name| played.figure(name));
            figures.sum()
        };
        match self.played.iter().filter_map(used).max() {
            Some(used) => format!(
                "{} of {} bytes, {} % left",
                grouped(used),
                grouped(memory),
                100 * memory.saturating_sub(used) / memory
            ),
            None => "unknown".to_owned(),
        }
    }
}

/// A number with a thin gap after every three digits.
fn grouped(number: u64) -> String {
    let digits = number.to_string();
    let mut text = String::new();
    for (place, digit) in digits.chars().enumerate() {
        if place > 0 && (digits.len() - place).is_multiple_of(3) {
            text.push(' ');
        }
        text.push(digit);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::{chosen, grouped};

    #[test]
    fn the_picture_has_the_first_and_the_last_frame() {
        assert_eq!(chosen(0).count(), 0);
        assert!(chosen(1).eq([0]));
        assert!(chosen(3).eq([0, 1, 2]));
        let of_many: Vec<usize> = chosen(32).collect();
        assert_eq!((of_many.len(), of_many[0], of_many[11]), (12, 0, 31));
    }

    #[test]
    fn digits_come_in_threes() {
        assert_eq!(grouped(7), "7");
        assert_eq!(grouped(1_234), "1 234");
        assert_eq!(grouped(1_234_567), "1 234 567");
    }
}
