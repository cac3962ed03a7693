//! The proved error of every format is at least the error: on the finger, and on tables of random cages,
//! models, fraction bits and displacements. The error is found here in integers of 128 bits from the real
//! rows, over random poses and over poses whose every control point stands where a row's own weights do
//! most harm.

mod common;

use octruss_bake::bundle::BundleBytes;
use octruss_bake::deform::{Form, deform};
use octruss_bake::mesh::{Cells, Point, SolidMesh};
use octruss_bake::progress::Silent;
use octruss_bake::read;
use octruss_bake::refine::BoundaryRule;
use octruss_bake::table::{Baked, Input, Options, Outside, TableFormat, bake};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use std::path::Path;

/// Random tables; `cargo xtask verify` asks for more.
fn case_count() -> u64 {
    let asked = std::env::var("OCTRUSS_CASES").ok();
    let asked: Option<u64> = asked.and_then(|count| count.parse().ok());
    asked.map_or(12, |count| count / 20)
}

/// A block of two by two by one cubes of six tetrahedra each, every vertex moved a little.
fn random_cage(rng: &mut ChaCha8Rng, size: f64) -> SolidMesh {
    const SIZES: [u32; 3] = [3, 3, 2];
    let at = |x: u32, y: u32, z: u32| (z * SIZES[1] + y) * SIZES[0] + x;
    let mut points: Vec<Point> = Vec::new();
    for z in 0..SIZES[2] {
        for y in 0..SIZES[1] {
            for x in 0..SIZES[0] {
                points
                    .push([x, y, z].map(|c| size * (f64::from(c) + rng.random_range(-0.15..0.15))));
            }
        }
    }
    let mut tetrahedra = Vec::new();
    // The six ways along the edges of a cube from one end of a diagonal to the other.
    const WAYS: [[usize; 3]; 6] = [
        [0, 1, 2],
        [1, 2, 0],
        [2, 0, 1],
        [0, 2, 1],
        [2, 1, 0],
        [1, 0, 2],
    ];
    for y in 0..2 {
        for x in 0..2 {
            for (number, way) in WAYS.iter().enumerate() {
                let mut corner = [x, y, 0];
                let mut cell = vec![at(corner[0], corner[1], corner[2])];
                for &axis in way {
                    corner[axis] += 1;
                    cell.push(at(corner[0], corner[1], corner[2]));
                }
                // Odd ways turn the other way round.
                if number >= 3 {
                    cell.swap(1, 2);
                }
                tetrahedra.push([cell[0], cell[1], cell[2], cell[3]]);
            }
        }
    }
    SolidMesh {
        points,
        cells: Cells {
            tetrahedra,
            ..Cells::default()
        },
        ..SolidMesh::default()
    }
}

/// What the poses of a case are made of.
struct Poses<'a> {
    rest: &'a [[i32; 3]],
    reach: i32,
}

impl Poses<'_> {
    fn random(&self, rng: &mut ChaCha8Rng, only_ends: bool) -> Vec<[i32; 3]> {
        let moved = |bits: i32, rng: &mut ChaCha8Rng| match only_ends {
            true if rng.random() => bits + self.reach,
            true => bits - self.reach,
            false => bits + rng.random_range(-self.reach..=self.reach),
        };
        let points = self.rest.iter();
        points
            .map(|point| point.map(|bits| moved(bits, rng)))
            .collect()
    }

    /// Every control point at the end of its range that the error of its weight in a row favours.
    fn worst(&self, real: &[(u32, f64)], kept: &[(usize, i32)], weight_bits: u32) -> Vec<[i32; 3]> {
        let mut pose = self.rest.to_vec();
        for &(column, weight) in real {
            let found = kept.iter().find(|(point, _)| *point == column as usize);
            let kept = found.map_or(0.0, |(_, weight)| f64::from(*weight));
            let is_more = kept > weight * f64::from(1_u32 << weight_bits);
            let way = if is_more { self.reach } else { -self.reach };
            pose[column as usize] = pose[column as usize].map(|bits| bits + way);
        }
        pose
    }
}

/// The greatest error of a bundle over poses, in units in the last place.
fn greatest_error(baked: &Baked, rest_model: &[[i32; 3]], poses: &[Vec<[i32; 3]>]) -> f64 {
    const REAL_BITS: i32 = 80;
    let scale = 2.0_f64.powi(REAL_BITS);
    let bytes = BundleBytes::new(&baked.bundle);
    let bundle = bytes.open().unwrap();
    let rest = bundle.rest_cage();
    let mut worst = 0.0_f64;
    for pose in poses {
        let points = deform(&bundle, pose, Form::Displacement).unwrap().bits;
        for ((row, rest_point), point) in baked.rows.iter().zip(rest_model).zip(points) {
            for axis in 0..3 {
                let way = |column: u32| {
                    let column = column as usize;
                    i128::from(pose[column][axis]) - i128::from(rest[column][axis])
                };
                let real: i128 = row.iter().map(|&(c, w)| (w * scale) as i128 * way(c)).sum();
                let got = i128::from(point[axis]) - i128::from(rest_point[axis]);
                worst = worst.max(((got << REAL_BITS) - real).abs() as f64 / scale);
            }
        }
    }
    worst
}

/// Bakes a model in every format and holds each proved error against the error.
fn check(cage: &SolidMesh, model: &[Point], options: &Options, reach: f64, seed: u64) -> [f64; 2] {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let mut closest = [0.0_f64; 2];
    let mut poses = Vec::new();
    for format in [
        TableFormat::Q14,
        TableFormat::Q30,
        TableFormat::Compact,
        TableFormat::Q14Factored,
        TableFormat::Q30Factored,
        TableFormat::CompactFactored,
    ] {
        let mut options = options.clone();
        options.request.format = Some(format);
        options.request.max_displacement = Some(reach);
        let input = Input {
            cage,
            cage_file: Path::new("cage"),
            model,
            model_file: Path::new("model"),
        };
        let baked = bake(input, &options, &mut Silent).unwrap();
        let report = baked.report.formats[0];
        assert_eq!(report.format, format);
        assert!(report.proved >= report.measured, "seed {seed}: {report:?}");
        let bytes = BundleBytes::new(&baked.bundle);
        let bundle = bytes.open().unwrap();
        let unit = 2.0_f64.powi(baked.report.fraction_bits as i32);
        let made = Poses {
            rest: bundle.rest_cage(),
            reach: (reach * unit) as i32,
        };
        if poses.is_empty() {
            poses = vec![made.random(&mut rng, false), made.random(&mut rng, true)];
        }
        if let Ok(table) = bundle.table::<i32>() {
            // The rows that rounding changed most are not known: take some.
            let order: Vec<usize> = bundle.model_points().iter().collect();
            for row in (0..table.rows()).step_by(table.rows() / 5 + 1) {
                let kept: Vec<(usize, i32)> = table.row(row).unwrap().collect();
                poses.push(made.worst(&baked.rows[order[row]], &kept, table.weight_bits()));
            }
        }
        // At rest every format gives the rest model to the bit, which other tests hold.
        let rest = deform(&bundle, bundle.rest_cage(), Form::Displacement).unwrap();
        let error = greatest_error(&baked, &rest.bits, &poses);
        assert!(
            report.proved >= error,
            "seed {seed}: {error} units, but proved {report:?}"
        );
        let place = usize::from(report.refined_level.is_some());
        closest[place] = closest[place].max(error / report.proved);
    }
    closest
}

#[test]
fn random_tables_stay_within_what_was_proved() {
    let mut closest = [0.0_f64; 2];
    for seed in 0..case_count() {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let size = [0.01, 1.0, 30.0][rng.random_range(0..3)];
        let cage = random_cage(&mut rng, size);
        let count = rng.random_range(4..40);
        let model: Vec<Point> = (0..count)
            .map(|_| [2.0, 2.0, 1.0].map(|most| size * most * rng.random_range(0.2..0.8)))
            .collect();
        let rules = [
            BoundaryRule::Loop,
            BoundaryRule::TriQuad,
            BoundaryRule::Interior,
            BoundaryRule::Fixed,
        ];
        let options = Options {
            boundary: rules[rng.random_range(0..rules.len())],
            levels: rng.random_range(1..3),
            outside: Outside::Extrapolate,
            fraction_bits: (size == 1.0).then(|| rng.random_range(4..28)),
            seed,
            ..Options::default()
        };
        let reach = size * rng.random_range(0.05..1.5);
        let [direct, factored] = check(&cage, &model, &options, reach, seed);
        closest = [closest[0].max(direct), closest[1].max(factored)];
    }
    println!("errors reach {closest:?} of what is proved, direct and factored");
    // A bound that is never approached would hold anything.
    assert!(closest[0] > 0.5, "{closest:?}");
}

#[test]
fn the_finger_stays_within_what_was_proved() {
    let cage = read::solid_with_features(&common::model("finger.msh"), None).unwrap();
    let model = read::model(&common::model("finger.obj")).unwrap();
    // Every seventh point has rows of all kinds.
    let points: Vec<Point> = model.points.iter().copied().step_by(7).collect();
    let [direct, factored] = check(&cage, &points, &Options::default(), 20.0, 7);
    println!("errors reach {direct} and {factored} of what is proved");
    assert!(direct > 0.3, "{direct}");
}
