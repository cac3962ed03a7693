//! Random solvers for goals, with a volume to hold, from a seed.

use octruss::control::inverse::{HESSIAN_LIMIT, InverseParts, LEAST_CURVATURE, reciprocal};
use rand::RngExt as _;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng as _;

use crate::random_volume::ModesCase;
use crate::reference_control::{InverseTable, VolumeWanted};

/// An amplitude of one.
const ONE: f64 = 1_073_741_824.0;
/// What a coordinate calls one.
const UNIT: f64 = 1_048_576.0;

/// A random solver with goals for some ticks.
#[derive(Clone, Debug)]
pub struct InverseCase {
    /// The solver.
    pub table: InverseTable,
    /// The volume that is asked for.
    pub wanted: Option<VolumeWanted>,
    /// The amplitudes to start from; none is rest.
    pub start: Option<Vec<i32>>,
    /// The goals of each tick.
    pub goals: Vec<Vec<[i32; 3]>>,
}

/// What a plausible solver shall be like.
#[derive(Clone, Copy, Debug)]
pub struct Likeness {
    /// Number of actuators.
    pub actuators: usize,
    /// Number of effectors.
    pub effectors: usize,
    /// How much all actuators do the same: 0 not at all.
    pub likeness: f64,
    /// Whether a volume is held.
    pub volume: bool,
}

impl InverseCase {
    /// A solver as a baker makes them: `H = J'WJ` with some damping, goals in and beyond reach, no rates.
    pub fn plausible(seed: u64, likeness: Likeness) -> Self {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let table = plausible_table(&mut rng, likeness);
        let amplitudes: Vec<f64> = (0..likeness.actuators)
            .map(|_| rng.random_range(-1.3..1.3))
            .collect();
        let goals = table.1.goals(&mut rng, &table.0.rest, &amplitudes);
        let wanted = likeness
            .volume
            .then(|| plausible_volume(&mut rng, &table.0));
        Self {
            table: table.0,
            wanted,
            start: None,
            goals: vec![goals],
        }
    }

    /// Any solver that can be opened, up to the ends of all ranges, with goals for up to four ticks.
    pub fn any(seed: u64, with_volume: bool) -> Self {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let actuators = rng.random_range(1..=12);
        let effectors = rng.random_range(1..=16);
        let ticks = rng.random_range(1..=3);
        if seed.is_multiple_of(3) {
            let likeness = Likeness {
                actuators,
                effectors,
                likeness: rng.random_range(0.0..3.0),
                volume: with_volume,
            };
            let mut case = Self::plausible(seed, likeness);
            let rate = [i32::MAX, 1 << 28, 1 << 20][rng.random_range(0..3)];
            case.table.rates.fill(rate);
            let goals = case.goals[0].clone();
            case.goals.resize(ticks, goals);
            return case;
        }
        let table = extreme_table(&mut rng, actuators, effectors);
        let any = |rng: &mut ChaCha8Rng| match rng.random_range(0..4) {
            0 => i32::MIN,
            1 => i32::MAX,
            2 => rng.random_range(-1000..1000),
            _ => rng.random(),
        };
        let point = |rng: &mut ChaCha8Rng| [0; 3].map(|_: i32| any(rng));
        let goals = (0..ticks)
            .map(|_| (0..effectors).map(|_| point(&mut rng)).collect())
            .collect();
        let start = rng
            .random_bool(0.5)
            .then(|| (0..actuators).map(|_| any(&mut rng)).collect());
        let wanted = with_volume.then(|| extreme_volume(&mut rng, actuators));
        Self {
            table,
            wanted,
            start,
            goals,
        }
    }

    /// Reciprocals of the diagonal, as a baker adds them.
    pub fn reciprocals(&self) -> Vec<i32> {
        let step = self.table.actuators + 1;
        let diagonal = self.table.hessian.iter().step_by(step);
        diagonal.map(|&own| reciprocal(own)).collect()
    }

    /// The parts that core is made of.
    pub fn parts<'a>(&'a self, reciprocals: &'a [i32]) -> InverseParts<'a> {
        InverseParts {
            hessian: &self.table.hessian,
            reciprocals,
            gains: &self.table.gains,
            rest: &self.table.rest,
            lower: &self.table.lower,
            upper: &self.table.upper,
            rates: &self.table.rates,
            difference_shift: self.table.difference_shift,
            gain_shift: self.table.gain_shift,
        }
    }

    /// The solver's section of a bundle.
    pub fn section(&self) -> Vec<u8> {
        let table = &self.table;
        let record = [
            u32::try_from(table.actuators).unwrap_or(u32::MAX),
            u32::try_from(table.rest.len()).unwrap_or(u32::MAX),
            table.difference_shift,
            table.gain_shift.cast_unsigned(),
        ];
        let reciprocals = self.reciprocals();
        let lists: [&[i32]; 7] = [
            &table.hessian,
            &reciprocals,
            &table.gains,
            table.rest.as_flattened(),
            &table.lower,
            &table.upper,
            &table.rates,
        ];
        let numbers = lists.concat().into_iter().map(i32::cast_unsigned);
        record
            .into_iter()
            .chain(numbers)
            .flat_map(u32::to_le_bytes)
            .collect()
    }
}

/// The displacement of every effector axis by every actuator, in units.
struct Displacements(Vec<Vec<f64>>);

impl Displacements {
    fn goals(&self, rng: &mut ChaCha8Rng, rest: &[[i32; 3]], amplitudes: &[f64]) -> Vec<[i32; 3]> {
        let mut goals = rest.to_vec();
        for (axis, goal) in goals.as_flattened_mut().iter_mut().enumerate() {
            let pairs = self.0.iter().zip(amplitudes);
            let moved: f64 = pairs
                .map(|(column, amplitude)| column[axis] * amplitude)
                .sum();
            *goal += ((moved + rng.random_range(-0.1..0.1)) * UNIT) as i32;
        }
        goals
    }
}

fn plausible_table(rng: &mut ChaCha8Rng, likeness: Likeness) -> (InverseTable, Displacements) {
    let Likeness {
        actuators,
        effectors,
        likeness,
        ..
    } = likeness;
    let axes = 3 * effectors;
    let common: Vec<f64> = (0..axes).map(|_| rng.random_range(-1.0..1.0)).collect();
    let columns: Vec<Vec<f64>> = (0..actuators)
        .map(|_| {
            common
                .iter()
                .map(|common| likeness * common + rng.random_range(-1.0..1.0))
                .collect()
        })
        .collect();
    let weights: Vec<f64> = (0..effectors)
        .map(|_| rng.random_range(0.25..4.0))
        .collect();
    let product = |a: &[f64], b: &[f64]| -> f64 {
        let terms = a.iter().zip(b).enumerate();
        terms.map(|(axis, (a, b))| weights[axis / 3] * a * b).sum()
    };
    let mut hessian: Vec<Vec<f64>> = columns
        .iter()
        .map(|a| columns.iter().map(|b| product(a, b)).collect())
        .collect();
    let greatest = (0..actuators)
        .map(|own| hessian[own][own])
        .fold(0.0, f64::max);
    for (place, row) in hessian.iter_mut().enumerate() {
        row[place] += greatest / 4096.0;
    }
    let sums = hessian
        .iter()
        .map(|row| row.iter().map(|own| own.abs()).sum::<f64>());
    let scale = (HESSIAN_LIMIT as f64 - 16.0) / sums.fold(0.0, f64::max);
    let difference_shift = rng.random_range(0..=3);
    // A force is H times an amplitude; a difference has 20 - difference_shift fraction bits.
    let gains: Vec<f64> = columns
        .iter()
        .flat_map(|column| column.iter().enumerate())
        .map(|(axis, own)| {
            weights[axis / 3] * own * scale * ONE / UNIT * f64::from(1 << difference_shift)
        })
        .collect();
    let sums = gains
        .chunks(axes)
        .map(|row| row.iter().map(|own| own.abs()).sum::<f64>());
    let gain_shift = (sums.fold(0.0, f64::max) / 2_147_483_000.0).log2().ceil() as i32;
    let gains = gains
        .iter()
        .map(|own| (own * 2.0_f64.powi(-gain_shift)).round() as i32);
    let table = InverseTable {
        actuators,
        hessian: hessian
            .iter()
            .flatten()
            .map(|own| (own * scale).round() as i32)
            .collect(),
        gains: gains.collect(),
        rest: (0..effectors)
            .map(|_| [0; 3].map(|_: i32| rng.random_range(-(1 << 24)..1 << 24)))
            .collect(),
        lower: (0..actuators)
            .map(|_| (rng.random_range(-1.0..-0.1) * ONE) as i32)
            .collect(),
        upper: (0..actuators)
            .map(|_| (rng.random_range(0.1..1.0) * ONE) as i32)
            .collect(),
        rates: vec![i32::MAX; actuators],
        difference_shift,
        gain_shift,
    };
    (table, Displacements(columns))
}

/// A volume of one at rest that the actuators change by tenths, and a target within reach.
fn plausible_volume(rng: &mut ChaCha8Rng, table: &InverseTable) -> VolumeWanted {
    let actuators = table.actuators;
    let mut coefficients = Vec::new();
    for a in 0..=actuators {
        for b in a..=actuators {
            for c in b..=actuators {
                let reach = match [a, b, c] {
                    [0, 0, 0] => {
                        coefficients.push(1.0);
                        continue;
                    }
                    [0, 0, _] => 0.2,
                    [0, _, _] => 0.05,
                    _ => 0.01,
                };
                coefficients.push(rng.random_range(-reach..reach));
            }
        }
    }
    let total: f64 = coefficients.iter().map(|own: &f64| own.abs()).sum();
    let scale = 1.0e9 / total;
    let coefficients: Vec<i32> = coefficients
        .iter()
        .map(|own| (own * scale).round() as i32)
        .collect();
    // What some place within the bounds encloses can be reached.
    let bounds = table.lower.iter().zip(&table.upper);
    let place: Vec<i32> = bounds
        .map(|(&lower, &upper)| rng.random_range(lower / 2..=upper / 2))
        .collect();
    let (volume, _) = crate::reference_volume::modes(actuators, &coefficients, &place);
    VolumeWanted {
        coefficients,
        low: volume,
        high: volume,
    }
}

fn extreme_table(rng: &mut ChaCha8Rng, actuators: usize, effectors: usize) -> InverseTable {
    let mut hessian = vec![0_i32; actuators * actuators];
    let most = HESSIAN_LIMIT / actuators as i64;
    for a in 0..actuators {
        for b in a..actuators {
            let bits = rng.random_range(0..31);
            let own = rng.random_range(-most..=most) >> bits;
            let own = if a == b {
                own.abs().max(i64::from(LEAST_CURVATURE))
            } else {
                own
            };
            let own = if rng.random_range(0..20) == 0 {
                most
            } else {
                own
            };
            hessian[a * actuators + b] = own as i32;
            hessian[b * actuators + a] = own as i32;
        }
    }
    let axes = 3 * effectors;
    let mut gains = Vec::new();
    for _ in 0..actuators {
        let mut left = (1_i64 << 31) >> rng.random_range(0..8);
        for _ in 0..axes {
            let portion = rng.random_range(0..=left.min(i64::from(i32::MAX)));
            left -= portion;
            gains.push((portion * [-1, 1][rng.random_range(0..2)]) as i32);
        }
    }
    let mut lower = Vec::new();
    let mut upper = Vec::new();
    for _ in 0..actuators {
        let mut ends = [0; 2].map(|_: i32| rng.random::<i32>().max(-i32::MAX));
        if rng.random_range(0..4) == 0 {
            ends = [-i32::MAX, i32::MAX];
        }
        ends.sort_unstable();
        lower.push(ends[0]);
        upper.push(ends[1]);
    }
    InverseTable {
        actuators,
        hessian,
        gains,
        rest: (0..effectors)
            .map(|_| [0; 3].map(|_: i32| rng.random()))
            .collect(),
        lower,
        upper,
        rates: (0..actuators)
            .map(|_| [0, 1 << 20, 1 << 29, i32::MAX][rng.random_range(0..4)])
            .collect(),
        difference_shift: rng.random_range(0..=31),
        gain_shift: rng.random_range(-31..=31),
    }
}

fn extreme_volume(rng: &mut ChaCha8Rng, actuators: usize) -> VolumeWanted {
    let mut seed = rng.random_range(0..1_u64 << 40);
    let mut case = ModesCase::new(seed);
    while case.amplitudes.len() != actuators {
        seed += 1;
        case = ModesCase::new(seed);
    }
    let coefficients = match rng.random_range(0..8) {
        0 => vec![0; case.coefficients.len()],
        _ => case.coefficients,
    };
    let edge = |rng: &mut ChaCha8Rng| match rng.random_range(0..4) {
        0 => rng.random(),
        1 => [i64::MIN, i64::MAX, 0][rng.random_range(0..3)],
        _ => rng.random::<i64>() >> rng.random_range(2..12),
    };
    let low = edge(rng);
    let high = if rng.random_bool(0.5) { low } else { edge(rng) };
    VolumeWanted {
        coefficients,
        low,
        high,
    }
}
