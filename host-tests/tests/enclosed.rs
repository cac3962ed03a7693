//! The crate's enclosed volume against the independent reference, bit for bit, on random forms and
//! poses up to the ends of the coordinate range, and its invariances.
//!
//! `OCTRUSS_CASES` sets how many cases; the default keeps the suite quick.

use octruss::enclosed::{
    Centroid, CentroidModes, Enclosed, EnclosedError, VolumeForm, VolumeFormParts, VolumeModes,
    WEIGHT_LIMIT,
};
use octruss_host_tests::random_volume::{CentroidCase, ModesCase, VolumeCase};
use octruss_host_tests::reference_volume::{self, VolumeTable};
use rand::RngExt as _;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng as _;

/// What guards a buffer's end.
const GUARD: i32 = 0x5afe_5afe;

fn case_count() -> u64 {
    let wanted = std::env::var("OCTRUSS_CASES").ok();
    wanted.and_then(|count| count.parse().ok()).unwrap_or(2000)
}

/// The form's parts, owned, in the layout that the crate takes.
struct Layout {
    pairs: Vec<[u16; 2]>,
    pair_starts: Vec<u32>,
    thirds: Vec<u16>,
    weights: Vec<i32>,
}

impl Layout {
    fn new(table: &VolumeTable) -> Self {
        let mut layout = Self {
            pairs: table.empty_pairs.clone(),
            pair_starts: vec![0; table.empty_pairs.len()],
            thirds: Vec::new(),
            weights: Vec::new(),
        };
        for ([i, j, k], weight) in &table.taps {
            if layout.pairs.last() != Some(&[*i, *j]) {
                layout.pairs.push([*i, *j]);
                layout
                    .pair_starts
                    .push(u32::try_from(layout.thirds.len()).unwrap());
            }
            layout.thirds.push(*k);
            layout.weights.push(*weight);
        }
        layout
            .pair_starts
            .push(u32::try_from(layout.thirds.len()).unwrap());
        layout
    }

    fn parts<'a>(&'a self, table: &'a VolumeTable) -> VolumeFormParts<'a> {
        VolumeFormParts {
            points: &table.points,
            pairs: &self.pairs,
            pair_starts: &self.pair_starts,
            thirds: &self.thirds,
            weights: &self.weights,
            difference_shift: table.difference_shift,
            pair_bits: table.pair_bits,
            volume_shift: table.volume_shift,
            gradient_bits: table.gradient_bits,
            weight_bits: 0,
        }
    }
}

/// Volume alone, then volume and gradient, with guard words behind the buffers.
fn run(form: &VolumeForm<'_>, pose: &[[i32; 3]]) -> (Enclosed, Enclosed, Vec<[i64; 3]>) {
    let length = form.workspace_length();
    let mut workspace = vec![[GUARD; 3]; length + 1];
    let mut gradient = vec![[i64::from(GUARD); 3]; length + 2];
    let alone = form.volume(pose, &mut workspace[..length]).unwrap();
    let both = form
        .volume_and_gradient(pose, &mut workspace[..length], &mut gradient[..=length])
        .unwrap();
    assert_eq!(workspace[length], [GUARD; 3]);
    assert_eq!(gradient.pop(), Some([i64::from(GUARD); 3]));
    (alone, both, gradient)
}

#[test]
fn volume_and_gradient_equal_the_reference() {
    let mut clamped = 0;
    for seed in 0..case_count() {
        let VolumeCase { table, pose } = VolumeCase::new(seed, 24);
        let layout = Layout::new(&table);
        let form = VolumeForm::new_checked(layout.parts(&table), pose.len())
            .unwrap_or_else(|error| panic!("seed {seed}: {error}"));
        let want = table.evaluate(&pose);
        let (alone, both, gradient) = run(&form, &pose);
        assert_eq!(alone.volume, want.volume, "seed {seed}");
        assert_eq!(alone.saturated, want.volume_saturated, "seed {seed}");
        assert_eq!(both.volume, want.volume, "seed {seed}");
        assert_eq!(gradient, want.gradient, "seed {seed}");
        assert_eq!(both.saturated, want.saturated, "seed {seed}");
        clamped += u32::from(want.saturated > 0);
    }
    println!(
        "{} cases, {clamped} with clamped results, 0 mismatches",
        case_count()
    );
    assert!(clamped > 0);
}

#[test]
fn moving_everything_changes_no_bit_and_gradients_add_up_to_zero() {
    let mut rng = ChaCha8Rng::seed_from_u64(5);
    for seed in 0..case_count() {
        let VolumeCase { table, mut pose } = VolumeCase::new(seed, 24);
        for point in &mut pose {
            *point = point.map(|coordinate| coordinate / 4);
        }
        let layout = Layout::new(&table);
        let form = VolumeForm::new_checked(layout.parts(&table), pose.len()).unwrap();
        let still = run(&form, &pose);
        let shift = [0; 3].map(|_: i32| rng.random_range(-1_610_612_736..=1_610_612_735));
        for point in &mut pose {
            *point = [0, 1, 2].map(|axis| point[axis] + shift[axis]);
        }
        assert_eq!(run(&form, &pose), still, "seed {seed}");
        for axis in 0..3 {
            assert_eq!(still.2.iter().map(|vector| vector[axis]).sum::<i64>(), 0);
        }
    }
}

/// The greatest sums that any sound form and pose can make: nothing wraps.
#[test]
fn the_extremes_fit() {
    let ends = [i32::MIN, i32::MAX];
    let weight = i32::try_from(WEIGHT_LIMIT).unwrap();
    for corner in 0..4096_usize {
        let table = VolumeTable {
            points: vec![0, 1, 2, 3],
            taps: vec![([0, 1, 2], if corner % 2 == 0 { weight } else { -weight })],
            difference_shift: 2,
            pair_bits: 31,
            volume_shift: 64,
            gradient_bits: 0,
            ..VolumeTable::default()
        };
        let pose =
            [0, 1, 2, 3].map(|point| [0, 1, 2].map(|axis| ends[corner >> (3 * point + axis) & 1]));
        let want = table.evaluate(&pose);
        let layout = Layout::new(&table);
        let form = VolumeForm::new_checked(layout.parts(&table), 4).unwrap();
        let (alone, both, gradient) = run(&form, &pose);
        assert_eq!((alone.volume, both.volume), (want.volume, want.volume));
        assert_eq!(gradient, want.gradient);
    }
}

#[test]
fn modes_equal_the_reference() {
    for seed in 0..case_count() {
        let ModesCase {
            coefficients,
            amplitudes,
        } = ModesCase::new(seed);
        let modes = amplitudes.len();
        let (volume, derivatives) = reference_volume::modes(modes, &coefficients, &amplitudes);
        let form = VolumeModes::new_checked(u16::try_from(modes).unwrap(), &coefficients).unwrap();
        assert_eq!(form.volume(&amplitudes), Ok(volume), "seed {seed}");
        let mut gradient = vec![0; modes];
        let both = form.volume_and_gradient(&amplitudes, &mut gradient);
        assert_eq!(both, Ok(volume), "seed {seed}");
        assert_eq!(gradient, derivatives, "seed {seed}");
    }
    // 16 modes have 969 coefficients.
    assert!(VolumeModes::new_checked(16, &[0; 969]).is_ok());
    let short = VolumeModes::new_checked(16, &[0; 968]).map(|_| ());
    assert_eq!(
        short,
        Err(EnclosedError::Length {
            needed: 969,
            given: 968
        })
    );
    let heavy = VolumeModes::new_checked(0, &[1 << 30]).map(|_| ());
    assert_eq!(heavy, Err(EnclosedError::Weights { place: 0 }));
}

#[test]
fn centroids_equal_the_reference() {
    let mut refused = 0;
    for seed in 0..case_count() {
        let case = CentroidCase::new(seed);
        let modes = u16::try_from(case.amplitudes.len()).unwrap();
        let form = CentroidModes::new_checked(modes, 7, case.shift, &case.coefficients).unwrap();
        assert_eq!(form.base(), 7);
        let got = form.offset(&case.amplitudes, case.volume);
        if case.volume <= 0 {
            refused += 1;
            assert_eq!(got, Err(EnclosedError::Volume), "seed {seed}");
            continue;
        }
        let (offset, saturated) = reference_volume::centroid(
            &case.coefficients,
            &case.amplitudes,
            case.volume,
            case.shift,
        );
        assert_eq!(got, Ok(Centroid { offset, saturated }), "seed {seed}");
    }
    assert!(refused > 0);
    // 16 modes have (20 choose 4) = 4845 coefficients for each axis.
    assert!(CentroidModes::new_checked(16, 0, 0, &[0; 3 * 4845]).is_ok());
    let of = |coefficients: &[i32], shift| {
        CentroidModes::new_checked(0, 0, shift, coefficients).map(|_| ())
    };
    let (needed, given) = (3, 2);
    let short = Err(EnclosedError::Length { needed, given });
    assert_eq!(of(&[0; 2], 0), short);
    assert_eq!(of(&[0; 3], 61), Err(EnclosedError::Shift));
    assert_eq!(of(&[0; 3], -61), Err(EnclosedError::Shift));
    let heavy = Err(EnclosedError::Weights { place: 1 });
    assert_eq!(of(&[0, 1 << 30, 0], 0), heavy);
    let form = CentroidModes::new_checked(0, 0, 0, &[0; 3]).unwrap();
    let (needed, given) = (0, 1);
    let long = Err(EnclosedError::Length { needed, given });
    assert_eq!(form.offset(&[0], 1), long);
}

/// What would break a proof is refused.
#[test]
fn unsound_forms_are_refused() {
    let points = [3, 1, 2, 0, 4];
    let sound = VolumeFormParts {
        points: &points,
        pairs: &[[0, 1], [1, 2]],
        pair_starts: &[0, 2, 3],
        thirds: &[2, 3, 3],
        weights: &[1 << 20, -(1 << 20), 5],
        difference_shift: 2,
        pair_bits: 21,
        volume_shift: 40,
        gradient_bits: 0,
        weight_bits: 0,
    };
    let check = |parts| VolumeForm::new_checked(parts, 5).map(|_| ());
    assert_eq!(check(sound), Ok(()));
    let shift = |change: fn(&mut VolumeFormParts<'_>)| {
        let mut parts = sound;
        change(&mut parts);
        check(parts)
    };
    let layout = |place| Err(EnclosedError::Layout { place });
    let weights = |place| Err(EnclosedError::Weights { place });
    assert_eq!(shift(|p| p.difference_shift = 1), Err(EnclosedError::Shift));
    assert_eq!(
        shift(|p| p.difference_shift = 32),
        Err(EnclosedError::Shift)
    );
    assert_eq!(shift(|p| p.pair_bits = 32), Err(EnclosedError::Shift));
    assert_eq!(shift(|p| p.volume_shift = 0), Err(EnclosedError::Shift));
    assert_eq!(shift(|p| p.volume_shift = 123), Err(EnclosedError::Shift));
    assert_eq!(shift(|p| p.gradient_bits = 61), Err(EnclosedError::Shift));
    assert_eq!(shift(|p| p.points = &[]), Err(EnclosedError::Points));
    assert_eq!(
        shift(|p| p.points = &[3, 1, 2, 0, 5]),
        Err(EnclosedError::Points)
    );
    assert_eq!(shift(|p| p.points = &[3, 1, 2, 0]), layout(0));
    assert_eq!(shift(|p| p.pairs = &[[0, 1], [0, 1]]), layout(1));
    assert_eq!(shift(|p| p.pairs = &[[1, 0], [1, 2]]), layout(0));
    assert_eq!(shift(|p| p.pairs = &[[0, 1]]), layout(1));
    assert_eq!(shift(|p| p.pair_starts = &[0, 3, 2]), layout(2));
    assert_eq!(shift(|p| p.pair_starts = &[1, 2, 3]), layout(2));
    assert_eq!(shift(|p| p.thirds = &[2, 2, 3]), layout(0));
    assert_eq!(shift(|p| p.thirds = &[1, 3, 3]), layout(0));
    assert_eq!(shift(|p| p.thirds = &[2, 3]), layout(2));
    assert_eq!(shift(|p| p.pair_bits = 20), weights(0));
    let heavy = [i32::MAX, 1, 0];
    let mut parts = VolumeFormParts {
        weights: &heavy,
        pair_bits: 31,
        ..sound
    };
    assert_eq!(check(parts), weights(2));
    parts.weights = &[i32::MAX, 0, 0];
    assert_eq!(check(parts), Ok(()));
    let form = VolumeForm::new_checked(sound, 5).unwrap();
    let short = form.volume(&[[0_i32; 3]; 4], &mut [[0; 3]; 4]);
    assert_eq!(
        short,
        Err(EnclosedError::Length {
            needed: 5,
            given: 4
        })
    );
}
