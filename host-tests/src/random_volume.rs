//! Random volume forms and poses, from a seed.

use std::collections::BTreeMap;

use rand::RngExt as _;
use rand::seq::SliceRandom as _;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng as _;

use crate::reference_volume::VolumeTable;

/// The magnitudes of all weights add up to at most this.
const WEIGHT_LIMIT: i64 = (1 << 31) - 1;

/// One random case of the enclosed volume.
#[derive(Clone, Debug)]
pub struct VolumeCase {
    /// The form.
    pub table: VolumeTable,
    /// Positions of all control points.
    pub pose: Vec<[i32; 3]>,
}

impl VolumeCase {
    /// The case of a seed, with at most `points` control points in the region, of some more.
    pub fn new(seed: u64, points: u16) -> Self {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let region = rng.random_range(1..=points);
        let control_points = rng.random_range(region..=region + 5);
        let mut names = (0..control_points).collect::<Vec<u16>>();
        names.shuffle(&mut rng);
        names.truncate(usize::from(region));
        let mut table = VolumeTable {
            points: names,
            difference_shift: rng.random_range(2..=8),
            volume_shift: rng.random_range(1..=90),
            gradient_bits: rng.random_range(0..=24),
            ..VolumeTable::default()
        };
        push_taps(&mut rng, &mut table, region - 1);
        let pose = random_pose(&mut rng, control_points);
        Self { table, pose }
    }
}

/// One random case of a volume as a polynomial in modes.
#[derive(Clone, Debug)]
pub struct ModesCase {
    /// Coefficients of the polynomial.
    pub coefficients: Vec<i32>,
    /// An amplitude for each mode.
    pub amplitudes: Vec<i32>,
}

impl ModesCase {
    /// The case of a seed, with up to 20 modes, more than there is straight code for; amplitudes are anywhere, at the ends of their range,
    /// or at most one.
    pub fn new(seed: u64) -> Self {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let modes = rng.random_range(0..=20_usize);
        let count = (modes + 1) * (modes + 2) * (modes + 3) / 6;
        let mut left = (1_i64 << 30) - 1;
        let mut coefficients = vec![0; count];
        for coefficient in &mut coefficients {
            let portion = match rng.random_range(0..100) {
                0 => left,
                _ => rng.random_range(0..=left / 32),
            };
            left -= portion;
            let sign = if rng.random_bool(0.5) { 1 } else { -1 };
            *coefficient = i32::try_from(sign * portion).unwrap_or(i32::MIN);
        }
        let amplitude = |rng: &mut ChaCha8Rng| match seed % 3 {
            0 => rng.random(),
            1 => [i32::MIN, i32::MAX, 0][rng.random_range(0..3)],
            _ => rng.random_range(-(1 << 30)..=1 << 30),
        };
        let amplitudes = (0..modes).map(|_| amplitude(&mut rng)).collect();
        Self {
            coefficients,
            amplitudes,
        }
    }
}

/// One random case of a centroid by modes.
#[derive(Clone, Debug)]
pub struct CentroidCase {
    /// Coefficients of the moments of x, y and z, one after the other.
    pub coefficients: Vec<i32>,
    /// An amplitude for each mode.
    pub amplitudes: Vec<i32>,
    /// The volume; not above zero in one of sixteen cases.
    pub volume: i64,
    /// The shift of a moment.
    pub shift: i32,
}

impl CentroidCase {
    /// The case of a seed, with up to 8 modes, which an image has room for; volumes and shifts are anywhere, at the ends of their
    /// range, or such that the quotient is about as large as a coordinate.
    pub fn new(seed: u64) -> Self {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let modes = rng.random_range(0..=8_usize);
        let count = (modes + 1) * (modes + 2) * (modes + 3) * (modes + 4) / 24;
        let mut coefficients = Vec::new();
        for _ in 0..3 {
            let mut left = (1_i64 << 30) - 1;
            coefficients.extend((0..count).map(|_| {
                let portion = match rng.random_range(0..100) {
                    0 => left,
                    _ => rng.random_range(0..=left / 32),
                };
                left -= portion;
                let sign = if rng.random_bool(0.5) { 1 } else { -1 };
                i32::try_from(sign * portion).unwrap_or(i32::MIN)
            }));
        }
        let amplitude = |rng: &mut ChaCha8Rng| match seed % 3 {
            0 => rng.random(),
            1 => [i32::MIN, i32::MAX, 0][rng.random_range(0..3)],
            _ => rng.random_range(-(1 << 30)..=1 << 30),
        };
        let amplitudes = (0..modes).map(|_| amplitude(&mut rng)).collect();
        let volume = match rng.random_range(0..16) {
            0 => [0, -1, i64::MIN][rng.random_range(0..3)],
            1 => [1, i64::MAX][rng.random_range(0..2)],
            2..6 => rng.random_range(1..=i64::MAX),
            _ => rng.random_range(1_i64 << 55..1 << 61),
        };
        let shift = match rng.random_range(0..8) {
            0 => [-60, 0, 60][rng.random_range(0..3)],
            1 => rng.random_range(-60..=60),
            _ => rng.random_range(14..=34),
        };
        Self {
            coefficients,
            amplitudes,
            volume,
            shift,
        }
    }
}

fn push_taps(rng: &mut ChaCha8Rng, table: &mut VolumeTable, others: u16) {
    let mut taps = BTreeMap::new();
    if others >= 3 {
        for _ in 0..rng.random_range(0..200) {
            let mut triple = [0; 3].map(|_: i32| rng.random_range(0..others));
            triple.sort_unstable();
            let [i, j, k] = triple;
            if i < j && j < k {
                taps.insert(triple, 0_i32);
            }
        }
    }
    // The whole allowance goes out in random portions, or a part of it.
    let mut left = WEIGHT_LIMIT >> rng.random_range(0..8);
    for (triple, _) in taps {
        let portion = match rng.random_range(0..20) {
            0 => left,
            _ => rng.random_range(0..=left / 16),
        };
        left -= portion;
        let sign = if rng.random_bool(0.5) { 1 } else { -1 };
        table
            .taps
            .push((triple, i32::try_from(sign * portion).unwrap_or(i32::MIN)));
    }
    let mut sums: BTreeMap<[u16; 2], i64> = BTreeMap::new();
    for ([i, j, _], weight) in &table.taps {
        *sums.entry([*i, *j]).or_default() += i64::from(weight.unsigned_abs());
    }
    let greatest = sums.values().max().copied().unwrap_or_default();
    let least_bits = (0..=31).find(|&bits| greatest <= 1 << bits).unwrap_or(31);
    table.pair_bits = rng.random_range(least_bits..=31);
    if others >= 2 && table.taps.is_empty() {
        table.empty_pairs.push([0, 1]);
    }
}

/// Points at the ends of the range, anywhere, or close together somewhere.
fn random_pose(rng: &mut ChaCha8Rng, count: u16) -> Vec<[i32; 3]> {
    let style = rng.random_range(0..4);
    let spread = rng.random_range(0..28);
    let centre = [0; 3].map(|_: i32| rng.random::<i32>() / 2);
    let coordinate = |rng: &mut ChaCha8Rng, axis: usize| match style {
        0 => [i32::MIN, i32::MAX][usize::from(rng.random_bool(0.5))],
        1 => rng.random(),
        2 => [i32::MIN, i32::MIN + 1, -1, 0, 1, i32::MAX - 1, i32::MAX][rng.random_range(0..7)],
        _ => centre[axis] + rng.random_range(-(1 << spread)..=1 << spread),
    };
    let point = |rng: &mut ChaCha8Rng| [0, 1, 2].map(|axis| coordinate(rng, axis));
    (0..count).map(|_| point(rng)).collect()
}
