//! How baking grows with the model: seconds, microseconds a point and memory for models of 10^3 to 10^6
//! vertices in a cage of 1000 tetrahedra that is refined three times.
//!
//! ```sh
//! cargo xtask bench-bake
//! ```
//!
//! Each size is baked in a process of its own, so that the greatest memory is its own too.

use octruss_bake::mesh::{Cells, Point, SolidMesh};
use octruss_bake::progress::Progress;
use octruss_bake::table::{Baked, Input, Options, Outside, Request, bake};
use std::path::Path;
use std::process::{Command, ExitCode};
use std::time::Instant;

/// Sizes of the models.
const SIZES: [usize; 7] = [1_000, 3_000, 10_000, 30_000, 100_000, 300_000, 1_000_000];

/// Cubes of the cage along each axis, five tetrahedra each: 1000 in all.
const CUBES: [u32; 3] = [5, 5, 8];

const LEVELS: u32 = 3;

fn main() -> ExitCode {
    let asked = std::env::args().nth(1);
    match asked.map(|count| count.parse()) {
        None => all_sizes(),
        Some(Ok(count)) => one_size(count),
        Some(Err(_)) => {
            eprintln!("error: expected a number of model points");
            ExitCode::FAILURE
        }
    }
}

fn all_sizes() -> ExitCode {
    println!(
        "| model points | seconds | processor seconds | processor \u{b5}s a point | peak memory, MiB | bundle, bytes |"
    );
    println!("| ---: | ---: | ---: | ---: | ---: | ---: |");
    let program = std::env::current_exe().unwrap_or_default();
    for size in SIZES {
        let baked = Command::new(&program).arg(size.to_string()).status();
        if !baked.is_ok_and(|status| status.success()) {
            eprintln!("error: a model of {size} points could not be baked");
            return ExitCode::FAILURE;
        }
    }
    ExitCode::SUCCESS
}

fn one_size(count: usize) -> ExitCode {
    let (cage, model) = (cage(), model(count));
    let mut stages = Stages::default();
    let started = Instant::now();
    let baked = match bake_all(&cage, &model, &mut stages) {
        Ok(baked) => baked,
        Err(error) => {
            eprintln!("error: {error}");
            return ExitCode::FAILURE;
        }
    };
    let seconds = started.elapsed().as_secs_f64();
    let memory = peak_memory().map_or_else(
        || "unknown".to_owned(),
        |bytes| format!("{:.0}", bytes as f64 / f64::from(1 << 20)),
    );
    let (busy, each) = processor_seconds().map_or_else(
        || ("unknown".to_owned(), "unknown".to_owned()),
        |busy| {
            let each = busy * 1e6 / count as f64;
            (format!("{busy:.2}"), format!("{each:.1}"))
        },
    );
    println!(
        "| {count} | {seconds:.2} | {busy} | {each} | {memory} | {} |",
        baked.bundle.len()
    );
    if std::env::var_os("OCTRUSS_STAGES").is_some() {
        stages.print();
    }
    ExitCode::SUCCESS
}

/// As `octruss bake` does it unless it is asked for something else.
fn bake_all(
    cage: &SolidMesh,
    model: &[Point],
    stages: &mut Stages,
) -> octruss_bake::error::Result<Baked> {
    let options = Options {
        levels: LEVELS,
        outside: Outside::Error,
        request: Request {
            survey: true,
            ..Request::default()
        },
        ..Options::default()
    };
    let input = Input {
        cage,
        cage_file: Path::new("cage"),
        model,
        model_file: Path::new("model"),
    };
    bake(input, &options, stages)
}

/// A block of cubes, each cut into five tetrahedra, with the vertices moved off the grid.
fn cage() -> SolidMesh {
    let [nx, ny, nz] = CUBES;
    let index = |x: u32, y: u32, z: u32| (z * (ny + 1) + y) * (nx + 1) + x;
    let mut mesh = SolidMesh::default();
    for z in 0..=nz {
        for y in 0..=ny {
            for x in 0..=nx {
                mesh.points.push(moved([x, y, z]));
            }
        }
    }
    let mut cells = Cells::default();
    for z in 0..nz {
        for y in 0..ny {
            for x in 0..nx {
                let corner =
                    |place: u32| index(x + (place & 1), y + (place >> 1 & 1), z + (place >> 2));
                // Diagonals of neighbours meet, so cubes take turns.
                let cut = match (x + y + z) % 2 {
                    0 => [
                        [1, 2, 4, 7],
                        [0, 1, 2, 4],
                        [3, 2, 1, 7],
                        [5, 1, 4, 7],
                        [6, 4, 2, 7],
                    ],
                    _ => [
                        [0, 3, 6, 5],
                        [1, 0, 5, 3],
                        [2, 0, 3, 6],
                        [4, 0, 6, 5],
                        [7, 3, 5, 6],
                    ],
                };
                cells.tetrahedra.extend(cut.map(|cell| cell.map(corner)));
            }
        }
    }
    for cell in &mut cells.tetrahedra {
        let positions = cell.map(|corner| mesh.points[corner as usize]);
        if octruss_bake::geometry::tetrahedron_volume_6(positions) < 0.0 {
            cell.swap(2, 3);
        }
    }
    mesh.cells = cells;
    mesh
}

/// A place of the grid, ten millimetres apart, moved by up to one.
fn moved(place: [u32; 3]) -> Point {
    let seed = place[0] * 7 + place[1] * 31 + place[2] * 101;
    std::array::from_fn(|axis| {
        let turn = f64::from(seed + 13 * axis as u32);
        10.0 * f64::from(place[axis]) + turn.sin()
    })
}

/// An egg with waves on it, well inside the cage, its vertices in rings from bottom to top.
fn model(count: usize) -> Vec<Point> {
    // Twice as many around as there are rings.
    let rings = ((count as f64 / 2.0).sqrt() as usize).max(1);
    let around = count.div_ceil(rings);
    let middle: Point = CUBES.map(|cubes| 5.0 * f64::from(cubes));
    let vertex = |number: usize| -> Point {
        let latitude = std::f64::consts::PI * ((number / around) as f64 + 0.5) / rings as f64;
        let longitude = std::f64::consts::TAU * (number % around) as f64 / around as f64;
        let wave = 0.6 + 0.05 * (9.0 * longitude).sin() * (11.0 * latitude).sin();
        let (sin, cos) = latitude.sin_cos();
        let way = [sin * longitude.cos(), sin * longitude.sin(), -cos];
        std::array::from_fn(|axis| middle[axis] * (1.0 + wave * way[axis]))
    };
    (0..count).map(vertex).collect()
}

/// The most memory that this process has taken, where the system tells.
fn peak_memory() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with("VmHWM:"))?;
    let kibibytes: u64 = line.split_ascii_whitespace().nth(1)?.parse().ok()?;
    Some(kibibytes << 10)
}

/// What this process has taken of all processors, where the system tells: other work on the machine
/// does not count.
fn processor_seconds() -> Option<f64> {
    // The unit in which Linux tells it to programs.
    const TICKS_A_SECOND: f64 = 100.0;
    let status = std::fs::read_to_string("/proc/self/stat").ok()?;
    // Behind the name in parentheses; the twelfth and thirteenth fields there.
    let (_, fields) = status.rsplit_once(')')?;
    let mut fields = fields.split_ascii_whitespace().skip(11);
    let user: f64 = fields.next()?.parse().ok()?;
    let system: f64 = fields.next()?.parse().ok()?;
    Some((user + system) / TICKS_A_SECOND)
}

/// When each stage of baking began.
#[derive(Default)]
struct Stages(Vec<(String, Instant)>);

impl Stages {
    fn print(&self) {
        for pair in self.0.windows(2) {
            let seconds = pair[1].1.duration_since(pair[0].1).as_secs_f64();
            println!("    {seconds:8.3} s  {}", pair[0].0);
        }
    }
}

impl Progress for Stages {
    fn stage(&mut self, name: &str, _steps: usize) {
        self.0.push((name.to_owned(), Instant::now()));
    }

    fn step(&mut self) {}

    fn finish(&mut self) {
        self.0.push(("end".to_owned(), Instant::now()));
    }
}
