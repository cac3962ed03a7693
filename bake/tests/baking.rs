//! Baking: the weights against masks worked out by hand, linear precision, the rest pose to the
//! bit, and the proved bounds.

mod common;

use common::model;
use octruss_bake::bundle::BundleBytes;
use octruss_bake::deform::{Form, deform, format_of, pose_bits};
use octruss_bake::error::Result;
use octruss_bake::mesh::{Cells, Point, SolidMesh};
use octruss_bake::progress::Silent;
use octruss_bake::read;
use octruss_bake::refine::{BoundaryRule, Level, Refinement};
use octruss_bake::table::{Baked, Input, Options, Outside, TableFormat, bake};
use std::path::Path;

/// A tetrahedron whose refined vertices have integer coordinates: 288 and 96 divide everything.
const CORNERS: [Point; 4] = [
    [0.0, 0.0, 0.0],
    [288.0, 0.0, 0.0],
    [0.0, 576.0, 0.0],
    [0.0, 0.0, 864.0],
];

fn tetrahedron() -> SolidMesh {
    SolidMesh {
        points: CORNERS.to_vec(),
        cells: Cells {
            tetrahedra: vec![[0, 1, 2, 3]],
            octahedra: vec![],
            ..Cells::default()
        },
        ..SolidMesh::default()
    }
}

fn bake_points(cage: &SolidMesh, points: &[Point], options: &Options) -> Result<Baked> {
    let input = Input {
        cage,
        cage_file: Path::new("cage.msh"),
        model: points,
        model_file: Path::new("model.obj"),
    };
    bake(input, options, &mut Silent)
}

fn finger() -> (SolidMesh, Vec<Point>) {
    let cage = read::solid(&model("finger.msh")).unwrap();
    (cage, read::model(&model("finger.obj")).unwrap().points)
}

/// Weights of a corner and of an edge midpoint of one refined tetrahedron, own corner or both ends
/// first, over a common denominator.
struct Masks {
    boundary: BoundaryRule,
    corner: [i64; 2],
    midpoint: [i64; 2],
    denominator: i64,
}

/// Worked out by hand.
///
/// `interior`: one tetrahedron and its split, with the smoothing of figure 4. Corner 0 lies in one
/// child: -1/16 v0 + 17/48 (m01 + m02 + m03) = 15/32 v0 + 17/96 (v1 + v2 + v3). The midpoint m01
/// lies in two tetrahedra and the octahedron: the mean of -1/16 m01 + 17/48 (v0 + m02 + m03), the
/// same at v1, and 3/8 m01 + 7/24 m23 + 1/12 (m02 + m03 + m13 + m12), which is 11/36 (v0 + v1) +
/// 7/36 (v2 + v3).
///
/// Surface rules: every vertex has three neighbours, so beta is 3/16 (Loop and Warren) or 1/8
/// (3/(8n)); edges 3/8 3/8 1/8 1/8.
const ONE_LEVEL: [Masks; 5] = [
    Masks {
        boundary: BoundaryRule::Interior,
        corner: [135, 51],
        midpoint: [88, 56],
        denominator: 288,
    },
    Masks {
        boundary: BoundaryRule::Loop,
        corner: [7, 3],
        midpoint: [6, 2],
        denominator: 16,
    },
    Masks {
        boundary: BoundaryRule::LoopWarren,
        corner: [7, 3],
        midpoint: [6, 2],
        denominator: 16,
    },
    Masks {
        boundary: BoundaryRule::TriQuad,
        corner: [5, 1],
        midpoint: [3, 1],
        denominator: 8,
    },
    Masks {
        boundary: BoundaryRule::Fixed,
        corner: [2, 0],
        midpoint: [1, 0],
        denominator: 2,
    },
];

const EDGES: [[usize; 2]; 6] = [[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]];

impl Masks {
    /// The weights of the ten refined vertices in their order.
    fn rows(&self) -> Vec<[i64; 4]> {
        let corners =
            (0..4).map(|own| std::array::from_fn(|corner| self.corner[usize::from(corner != own)]));
        let midpoints = EDGES.iter().map(|ends| {
            std::array::from_fn(|corner| self.midpoint[usize::from(!ends.contains(&corner))])
        });
        corners.chain(midpoints).collect()
    }

    fn points(&self) -> Vec<Point> {
        let point = |weights: &[i64; 4]| {
            std::array::from_fn(|axis| {
                let weighted = (0..4).map(|corner| weights[corner] as f64 * CORNERS[corner][axis]);
                weighted.sum::<f64>() / self.denominator as f64
            })
        };
        self.rows().iter().map(point).collect()
    }
}

#[test]
fn one_refined_tetrahedron_is_that_of_the_paper() {
    for masks in ONE_LEVEL {
        let level = Level::new(&tetrahedron()).unwrap();
        let mut step = Refinement::new(&level, masks.boundary.to_core()).unwrap();
        // All values are integers below 2^53, so double precision gives them exactly.
        assert_eq!(
            step.points(&CORNERS).unwrap(),
            masks.points(),
            "{:?}",
            masks.boundary
        );
        let bits: Vec<[i32; 3]> = CORNERS.iter().map(|p| p.map(|c| c as i32)).collect();
        let mut saturated = 0;
        let fixed: Vec<Point> = step
            .bits(&bits, &mut saturated)
            .unwrap()
            .iter()
            .map(|p| p.map(f64::from))
            .collect();
        assert_eq!((fixed, saturated), (masks.points(), 0));
    }
}

/// Model points at the refined vertices: their rows are the masks, rounded to 2^-30.
#[test]
fn rows_at_refined_vertices_are_the_masks() {
    for masks in ONE_LEVEL {
        let options = Options {
            levels: 1,
            boundary: masks.boundary,
            ..Options::default()
        };
        let baked = bake_points(&tetrahedron(), &masks.points(), &options).unwrap();
        let bytes = BundleBytes::new(&baked.bundle);
        let bundle = bytes.open().unwrap();
        let table = bundle.table::<i32>().unwrap();
        for (row, point) in bundle.model_points().iter().enumerate() {
            let expected = masks.rows()[point];
            let mut weights = [0_i64; 4];
            for (control_point, weight) in table.row(row).unwrap() {
                weights[control_point] = weight.into();
            }
            for (weight, expected) in weights.iter().zip(expected) {
                // Nearest, or one unit beside it where the row had to sum to one; the last places
                // of double precision may leave a unit of noise on a point that is not exact.
                let difference = weight * masks.denominator - expected * (1 << 30);
                assert!(
                    difference.abs() <= 2 * masks.denominator,
                    "{:?} {row}",
                    masks.boundary
                );
            }
            assert_eq!(weights.iter().sum::<i64>(), 1 << 30);
        }
    }
}

#[test]
fn without_levels_the_weights_are_affine_coordinates() {
    let point = [72.0, 144.0, 216.0];
    let options = Options {
        levels: 0,
        fraction_bits: Some(8),
        unit: "mm".into(),
        ..Options::default()
    };
    let baked = bake_points(&tetrahedron(), &[point], &options).unwrap();
    let bytes = BundleBytes::new(&baked.bundle);
    let bundle = bytes.open().unwrap();
    // A quarter of each of the three far corners and of the origin.
    let table = bundle.table::<i32>().unwrap();
    let taps: Vec<(usize, i32)> = table.row(0).unwrap().collect();
    assert_eq!(taps, [0, 1, 2, 3].map(|point| (point, 1 << 28)));
    // No residual; the half of the rounding rule.
    assert_eq!(table.start(0), Some([1 << 29; 3]));
    assert_eq!(bundle.rest_cage()[3], [0, 0, 864 << 8]);
    assert_eq!(
        (bundle.unit(), bundle.header().fraction_bits.get()),
        ("mm", 8)
    );
    assert_eq!(
        (bundle.header().levels.get(), bundle.header().boundary.get()),
        (0, 1)
    );
}

/// A crease along the edges 0-1-2 and a corner at 3, against the rules that docs/readings.md gives:
/// 1/8 6/8 1/8 where two crease edges meet, 1/2 1/2 on a crease,
/// Loop's rule at a crease's ends and everywhere else.
#[test]
fn creases_and_corners_reach_the_rows() {
    let mut cage = tetrahedron();
    cage.features.creases = vec![[0, 1], [1, 2]];
    cage.features.corners = vec![3];
    // Over 16.
    let expected = [
        [7, 3, 3, 3],
        [2, 12, 2, 0],
        [3, 3, 7, 3],
        [0, 0, 0, 16],
        [8, 8, 0, 0],
        [6, 2, 6, 2],
        [6, 2, 2, 6],
        [0, 8, 8, 0],
        [2, 6, 2, 6],
        [2, 2, 6, 6],
    ];
    let point = |weights: &[i32; 4]| -> Point {
        std::array::from_fn(|axis| {
            (0..4)
                .map(|c| f64::from(weights[c]) * CORNERS[c][axis])
                .sum::<f64>()
                / 16.0
        })
    };
    let points: Vec<Point> = expected.iter().map(point).collect();
    let baked = bake_points(
        &cage,
        &points,
        &Options {
            levels: 1,
            ..Options::default()
        },
    )
    .unwrap();
    for (row, expected) in baked.rows.iter().zip(expected) {
        let mut weights = [0.0; 4];
        for (control, weight) in row {
            weights[*control as usize] = *weight;
        }
        for (weight, expected) in weights.into_iter().zip(expected) {
            assert!(
                (weight - f64::from(expected) / 16.0).abs() <= 1e-15,
                "{weights:?}"
            );
        }
    }
}

/// An affinely moved cage moves the model affinely: exactly for the real weights, within the proved
/// bound for the table.
#[test]
fn affine_maps_are_reproduced() {
    let (cage, points) = finger();
    for (boundary, levels) in [
        (BoundaryRule::Loop, 2),
        (BoundaryRule::Fixed, 1),
        (BoundaryRule::Interior, 1),
    ] {
        let options = Options {
            boundary,
            levels,
            outside: Outside::Extrapolate,
            ..Options::default()
        };
        let baked = bake_points(&cage, &points, &options).unwrap();
        // Integer entries keep the pose's bits exact: the cage's coordinates have two binary
        // places.
        let affine = |[x, y, z]: Point| [x + 2.0 * y - 3.0, y - z + 0.25, z - x];
        let pose: Vec<Point> = cage.points.iter().map(|point| affine(*point)).collect();

        let scale = 256.0; // no coordinate of the moved finger is larger
        for (row, point) in baked.rows.iter().zip(&points) {
            let mut moved = [0.0; 3];
            for (control, weight) in row {
                for axis in 0..3 {
                    moved[axis] += weight * pose[*control as usize][axis];
                }
            }
            let sum: f64 = row.iter().map(|(_, weight)| weight).sum();
            assert!((sum - 1.0).abs() <= baked.report.precision.composition);
            for (moved, expected) in moved.iter().zip(affine(*point)) {
                let bound = 64.0 * f64::EPSILON * scale;
                assert!((moved - expected).abs() <= bound, "{moved} {expected}");
            }
        }

        let bytes = BundleBytes::new(&baked.bundle);
        let bundle = bytes.open().unwrap();
        let format = format_of(&bundle);
        let bits = pose_bits(&bundle, &pose).unwrap();
        assert_eq!(format.points_of(&bits), pose);
        let absolute = deform(&bundle, &bits, Form::Absolute).unwrap();
        assert_eq!(absolute.saturated, 0);
        // The bound for coordinates within `scale` of zero, from that for the whole range.
        let weight_error =
            (baked.report.precision.absolute.proved_any_pose - 0.5) / 2.0_f64.powi(31);
        let bound = weight_error * scale / format.unit() + 0.5 + 1e-3;
        for (bits, point) in absolute.bits.iter().zip(&points) {
            for (bits, expected) in bits.iter().zip(affine(*point)) {
                let error = f64::from(*bits) - expected / format.unit();
                assert!(error.abs() <= bound, "{error} against {bound}");
            }
        }
    }
}

#[test]
fn the_displacement_form_gives_the_rest_model_to_the_bit() {
    let (cage, points) = finger();
    let baked = bake_points(&cage, &points, &Options::default()).unwrap();
    let bytes = BundleBytes::new(&baked.bundle);
    let bundle = bytes.open().unwrap();
    let rest = deform(&bundle, bundle.rest_cage(), Form::Displacement).unwrap();
    // The rest model by another way: the decimal places times 2^F, rounded to nearest, ties up.
    let unit = 2.0_f64.powi(-(bundle.header().fraction_bits.get() as i32));
    let expected: Vec<[i32; 3]> = points
        .iter()
        .map(|point| point.map(|c| (c / unit + 0.5).floor() as i32))
        .collect();
    assert_eq!((rest.bits, rest.saturated), (expected, 0));
}

#[test]
fn whole_units_translate_every_result_to_the_bit() {
    let (cage, points) = finger();
    let baked = bake_points(&cage, &points[..500], &Options::default()).unwrap();
    let bytes = BundleBytes::new(&baked.bundle);
    let bundle = bytes.open().unwrap();
    let mut state = 1_u32;
    let mut random = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (state >> 4) as i32 - (1 << 27)
    };
    let pose: Vec<[i32; 3]> = bundle
        .rest_cage()
        .iter()
        .map(|_| [random(), random(), random()])
        .collect();
    for form in [Form::Displacement, Form::Absolute] {
        let base = deform(&bundle, &pose, form).unwrap();
        for shift in [[1, -1, 12_345], [-987_654_321, 123_456_789, 1_000_000_007]] {
            let add = |point: &[i32; 3]| std::array::from_fn(|axis| point[axis] + shift[axis]);
            let moved = deform(&bundle, &pose.iter().map(add).collect::<Vec<_>>(), form).unwrap();
            assert_eq!(moved.bits, base.bits.iter().map(add).collect::<Vec<_>>());
        }
    }
}

#[test]
fn measured_errors_stay_within_the_proved_bounds_and_come_near_them() {
    let (cage, points) = finger();
    let baked = bake_points(&cage, &points[..1000], &Options::default()).unwrap();
    for form in [
        baked.report.precision.absolute,
        baked.report.precision.displacement,
    ] {
        assert!(form.measured <= form.proved_any_pose, "{form:?}");
        // The worst pose of the worst row drives every weight's error the same way; only the final
        // rounding, and for displacements the place of the rest pose, may help it.
        assert!(
            form.measured >= form.proved_any_pose * 0.8 - 1.0,
            "{form:?}"
        );
        assert!(form.proved_rest_size < form.proved_any_pose);
    }
    // 2^-40: far below the 2^-31 that quantisation may take from a weight.
    assert!(baked.report.precision.composition < 2.0_f64.powi(-40));
}

#[test]
fn report_counts_what_the_bundle_holds() {
    let (cage, points) = finger();
    let baked = bake_points(&cage, &points, &Options::default()).unwrap();
    let bytes = BundleBytes::new(&baked.bundle);
    let bundle = bytes.open().unwrap();
    let report = &baked.report;
    assert_eq!(
        (report.rows, report.control_points, report.cells),
        (5522, 72, 168)
    );
    let table = bundle.table::<i32>().unwrap();
    let rows: Vec<Vec<i32>> = (0..table.rows())
        .map(|row| table.row(row).unwrap().map(|(_, weight)| weight).collect())
        .collect();
    let taps: usize = rows.iter().map(Vec::len).sum();
    assert_eq!(
        (report.taps.total, report.bytes),
        (taps, baked.bundle.len())
    );
    assert_eq!(rows.iter().map(Vec::len).max(), Some(report.taps.longest));
    let one = f64::from(1 << 30);
    let real = |weight: &i32| f64::from(*weight) / one;
    let least = rows.iter().flatten().min().map(real);
    let greatest = rows.iter().flatten().max().map(real);
    assert_eq!(
        (least, greatest),
        (Some(report.weights.least), Some(report.weights.greatest))
    );
    assert_eq!(
        (report.outside.count, report.refined_cells_without_volume),
        (0, 0)
    );
    // 168 tetrahedra: 4 and 1 octahedron each, then 4 and 1, and 8 and 6, of those.
    assert_eq!(report.refined_cells, 168 * (4 * 5 + 14));
}

/// Baking at level 2 and refining at level 2 are the same map: core's refinement of a posed cage,
/// looked up at refined vertices, gives what the rows give.
#[test]
fn rows_are_the_refinement_of_any_pose() {
    let (cage, _) = finger();
    let boundary = BoundaryRule::Loop;
    let refine = |points: &[Point]| {
        let (mut level, mut points) = (Level::new(&cage).unwrap(), points.to_vec());
        for _ in 0..2 {
            let mut step = Refinement::new(&level, boundary.to_core()).unwrap();
            points = step.points(&points).unwrap();
            level = step.split().unwrap();
        }
        points
    };
    let rest = refine(&cage.points);
    let baked = bake_points(
        &cage,
        &rest,
        &Options {
            levels: 2,
            boundary,
            ..Options::default()
        },
    )
    .unwrap();
    let pose: Vec<Point> = cage
        .points
        .iter()
        .map(|[x, y, z]| {
            [
                x + (z / 9.0).sin() * 6.0,
                y * (1.0 + z / 300.0),
                z - x * y / 40.0,
            ]
        })
        .collect();
    for ((row, moved), rest) in baked.rows.iter().zip(refine(&pose)).zip(rest) {
        for axis in 0..3 {
            let sum: f64 = row
                .iter()
                .map(|(control, weight)| weight * pose[*control as usize][axis])
                .sum();
            assert!(
                (sum - moved[axis]).abs() <= 1e-11,
                "{sum} {} at {rest:?}",
                moved[axis]
            );
        }
    }
}

#[test]
fn points_outside_are_refused_projected_or_extrapolated() {
    let inside = [72.0, 144.0, 216.0];
    let outside = [[-3.0, 30.0, 40.0], [20.0, 20.0, -1.5]];
    let points = [inside, outside[0], outside[1]];
    let options = |outside| Options {
        levels: 0,
        outside,
        fraction_bits: Some(8),
        ..Options::default()
    };

    let error = bake_points(&tetrahedron(), &points, &options(Outside::Error)).unwrap_err();
    assert_eq!(
        error.to_string(),
        "model.obj: 2 of 3 points lie outside the refined cage; the farthest, point 1 (counted from 0), by 3\n  help: the smooth scheme pulls the boundary inward: enlarge the cage, or take --boundary fixed, or choose --outside nearest or --outside extrapolate"
    );

    let at = |baked: &Baked, row: usize| {
        let mut point = [0.0; 3];
        for (control, weight) in &baked.rows[row] {
            for axis in 0..3 {
                point[axis] += weight * CORNERS[*control as usize][axis];
            }
        }
        point
    };
    let nearest = bake_points(&tetrahedron(), &points, &options(Outside::Nearest)).unwrap();
    assert_eq!(
        [at(&nearest, 1), at(&nearest, 2)],
        [[0.0, 30.0, 40.0], [20.0, 20.0, 0.0]]
    );
    assert_eq!(
        (
            nearest.report.outside.count,
            nearest.report.outside.farthest
        ),
        (2, Some(1))
    );
    let extrapolated =
        bake_points(&tetrahedron(), &points, &options(Outside::Extrapolate)).unwrap();
    for (row, point) in outside.into_iter().enumerate() {
        let again = at(&extrapolated, row + 1);
        assert!(
            (0..3).all(|axis| (again[axis] - point[axis]).abs() <= 1e-12),
            "{again:?}"
        );
    }

    // Less than one unit in the last place outside counts as on the boundary.
    let grazing = [[-1.0 / 512.0, 30.0, 40.0]];
    let baked = bake_points(&tetrahedron(), &grazing, &options(Outside::Error)).unwrap();
    assert_eq!(
        (baked.report.outside.count, baked.report.outside.on_boundary),
        (0, 1)
    );

    // So far outside that the weights' magnitudes exceed two.
    let far = [[-400.0, 0.0, 0.0]];
    let error = bake_points(&tetrahedron(), &far, &options(Outside::Extrapolate)).unwrap_err();
    assert_eq!(
        error.message(),
        "point 0 (counted from 0) cannot be baked: the magnitudes of its weights add up to 3.778, more than two"
    );
}

#[test]
fn unsound_cages_are_refused_in_words() {
    let cage = |tetrahedra: &[[u32; 4]], more: &[Point]| SolidMesh {
        points: CORNERS.iter().chain(more).copied().collect(),
        cells: Cells {
            tetrahedra: tetrahedra.to_vec(),
            octahedra: vec![],
            ..Cells::default()
        },
        ..SolidMesh::default()
    };
    let flat = [[100.0, 100.0, 0.0]];
    let beside = [[-9.0; 3], [1.0, 1.0, 900.0]];
    for (cage, message) in [
        (
            cage(&[[0, 2, 1, 3]], &[]),
            "cage.msh: 1 of 1 cell is of negative volume, first tetrahedron 0 (counted from 0 in file order)\n  help: every cell is: the mesh is mirrored",
        ),
        (
            cage(&[[0, 1, 2, 3], [0, 1, 2, 4]], &beside),
            "cage.msh: 1 of 2 cells are of negative volume, first tetrahedron 1 (counted from 0 in file order)\n  help: mend the mesh",
        ),
        (
            cage(&[[0, 1, 2, 3], [0, 1, 2, 4]], &flat),
            "cage.msh: 1 of 2 cells are without volume, first tetrahedron 1",
        ),
        (
            cage(&[[0, 1, 2, 3], [1, 2, 3, 0]], &[]),
            "cage.msh: tetrahedron 0 and tetrahedron 1 (counted from 0 in file order) have the same corners",
        ),
        (
            cage(&[[0, 1, 2, 1]], &[]),
            "cage.msh: tetrahedron 0 (counted from 0 in file order) names vertex 1 twice",
        ),
        (
            cage(&[[0, 1, 2, 3], [0, 2, 1, 4], [0, 1, 2, 5]], &beside),
            "cage.msh: 3 cells share the face of vertices 0, 1 and 2 (counted from 0)",
        ),
    ] {
        let error = bake_points(&cage, &[[1.0; 3]], &Options::default())
            .unwrap_err()
            .to_string();
        assert!(
            error.starts_with(message),
            "{error}\nshould start with\n{message}"
        );
    }
    let mut creased = tetrahedron();
    creased.points.push([9.0; 3]);
    creased.features.creases = vec![[0, 4]];
    let error = bake_points(&creased, &[[1.0; 3]], &Options::default()).unwrap_err();
    assert_eq!(
        error.to_string(),
        "cage.msh: the crease from vertex 0 to vertex 4 (counted from 0) is no edge of a cell\n  help: a crease runs along edges of the mesh; mesh the curve together with the volume"
    );
}

#[test]
fn formats_that_do_not_fit_are_refused() {
    let points = [[72.0, 144.0, 216.0]];
    let options = Options {
        fraction_bits: Some(22),
        ..Options::default()
    };
    let error = bake_points(&tetrahedron(), &points, &options).unwrap_err();
    assert_eq!(
        error.to_string(),
        "cage.msh: vertex 2 (counted from 0) has y = 576, but with 22 fraction bits coordinates lie between -512 and 512\n  help: bake with fewer --fraction-bits, or take a larger unit"
    );
    // 864 * 2^19 is below a quarter of 2^31, 864 * 2^20 is not.
    let baked = bake_points(&tetrahedron(), &points, &Options::default()).unwrap();
    assert_eq!(baked.report.fraction_bits, 19);
    let options = Options {
        unit: "seventeen bytes..".into(),
        ..Options::default()
    };
    assert!(bake_points(&tetrahedron(), &points, &options).is_err());
}

/// Every format of the finger: errors proved and measured, opened by the call that its name promises, the
/// rest model at rest to the bit.
#[test]
fn every_format_is_within_its_proved_error() {
    use clap::ValueEnum as _;
    let (cage, points) = finger();
    let points = &points[..500];
    let exact = bake_points(&cage, points, &Options::default()).unwrap();
    for format in TableFormat::value_variants() {
        let mut options = Options::default();
        options.request.format = Some(*format);
        let baked = bake_points(&cage, points, &options).unwrap();
        let [report] = baked.report.formats[..] else {
            panic!("one format was asked for");
        };
        assert_eq!(report.format, *format);
        assert!(
            report.measured <= report.proved,
            "{format:?}: {} measured, {} proved",
            report.measured,
            report.proved
        );
        let bytes = BundleBytes::new(&baked.bundle);
        let bundle = bytes.open().unwrap();
        let rest = deform(&bundle, bundle.rest_cage(), Form::Displacement).unwrap();
        let other = BundleBytes::new(&exact.bundle);
        let other = other.open().unwrap();
        let expected = deform(&other, other.rest_cage(), Form::Displacement).unwrap();
        assert_eq!(rest, expected, "{format:?}");
        let opens = [
            bundle.table::<i32>().is_ok(),
            bundle.compact_table::<i32>().is_ok(),
            bundle.factored_table::<i32>().is_ok(),
            bundle.compact_factored_table::<i32>().is_ok(),
        ];
        let number = match format {
            TableFormat::Q30 | TableFormat::Q14 => 0,
            TableFormat::Compact => 1,
            TableFormat::Q30Factored | TableFormat::Q14Factored => 2,
            TableFormat::CompactFactored => 3,
        };
        assert_eq!(opens, std::array::from_fn(|place| place == number));
    }
}

#[test]
fn the_cheapest_format_that_is_exact_enough_is_taken() {
    let (cage, points) = finger();
    let points = &points[..200];
    let mut options = Options::default();
    options.request.survey = true;
    let surveyed = bake_points(&cage, points, &options).unwrap().report;
    let reports = &surveyed.formats;
    let unit = 2.0_f64.powi(-(surveyed.fraction_bits as i32));
    assert_eq!(reports.len(), TableFormat::ALL.len());
    for bound in reports {
        let most = bound.proved * unit;
        options.request.max_error = Some(most);
        let baked = bake_points(&cage, points, &options).unwrap();
        let taken = baked.report.formats[0];
        assert!(taken.proved * unit <= most);
        let cheaper = reports
            .iter()
            .filter(|other| other.instructions < taken.instructions);
        assert!(cheaper.clone().all(|other| other.proved > bound.proved));
    }
    options.request.max_error = Some(1e-12);
    let error = bake_points(&cage, points, &options).unwrap_err();
    assert!(
        error.message().starts_with("no format is as exact"),
        "{error}"
    );
}
