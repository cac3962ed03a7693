//! The goals' solver written again from its description, in 128-bit integers that hold every
//! intermediate value, without a bit of the crate that is judged.
//!
//! The description: the documentation of `octruss::control::inverse` and `docs/numerics.md`. Every rounding
//! here is `floor(x + 1/2)` of an exact number; every cut is one that the description names.

use num_traits::ToPrimitive as _;

use crate::reference_volume;

/// A solver as its baker sees it.
#[derive(Clone, Debug, Default)]
pub struct InverseTable {
    /// Number of actuators.
    pub actuators: usize,
    /// `H`, row by row.
    pub hessian: Vec<i32>,
    /// For each actuator, x, y and z of each effector.
    pub gains: Vec<i32>,
    /// Effectors at rest.
    pub rest: Vec<[i32; 3]>,
    /// Least amplitudes.
    pub lower: Vec<i32>,
    /// Greatest amplitudes.
    pub upper: Vec<i32>,
    /// How far amplitudes move in a tick.
    pub rates: Vec<i32>,
    /// Bits by which differences of goals are rounded.
    pub difference_shift: u32,
    /// Bits by which sums of gains and differences are widened.
    pub gain_shift: i32,
}

/// A volume that is asked for: the polynomial and the band, lowest first unless it is empty.
#[derive(Clone, Debug)]
pub struct VolumeWanted {
    /// The polynomial's coefficients.
    pub coefficients: Vec<i32>,
    /// From here.
    pub low: i64,
    /// To here.
    pub high: i64,
}

/// What is kept from tick to tick.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Memory {
    /// The amplitudes.
    pub amplitudes: Vec<i128>,
    answer: Vec<i128>,
    multiplier: i128,
    shift: i32,
    /// In 65536ths.
    pace: i128,
}

/// What a tick says.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Said {
    /// Reasons, by their number.
    pub gave_up: u32,
    /// Actuators that the box holds back.
    pub held: u32,
    /// Sweeps.
    pub sweeps: u32,
    /// Evaluations of the volume.
    pub evaluations: u32,
    /// The volume.
    pub volume: i64,
}

impl Memory {
    /// Starts from measured amplitudes.
    pub fn start_from(&mut self, amplitudes: &[i32]) {
        let measured = amplitudes.iter().map(|own| i128::from(*own).max(-MOST));
        self.amplitudes
            .iter_mut()
            .zip(measured)
            .for_each(|(own, new)| *own = new);
        self.pace = WHOLE;
    }
}

const MOST: i128 = (1 << 31) - 1;
const FORCE: i128 = 1 << 61;
const WHOLE: i128 = 65536;
const LEAST: i128 = 16;

/// `floor(value 2^-places + 1/2)`; a negative number of places widens.
fn round(value: i128, places: i32) -> i128 {
    if places <= 0 {
        return value << -places;
    }
    (value + (1 << (places - 1))) >> places
}

/// `floor(a / b + 1/2)` for a `b` that is not zero.
fn quotient(a: i128, b: i128) -> i128 {
    let (a, b) = if b < 0 { (-a, -b) } else { (a, b) };
    (2 * a + b).div_euclid(2 * b)
}

/// The number of binary digits of a magnitude.
fn digits(value: i128) -> i32 {
    let mut digits = 0;
    let mut left = value.abs();
    while left > 0 {
        left /= 2;
        digits += 1;
    }
    digits
}

/// A product with a power of two, cut to what forces may be. Bits are dropped in one rounding.
fn force_of(value: i128, places: i32) -> i128 {
    let value = if places > 0 {
        let limit = FORCE >> places;
        value.clamp(-limit, limit)
    } else {
        value.clamp(-2 * FORCE, 2 * FORCE)
    };
    round(value, -places).clamp(-FORCE, FORCE)
}

fn dot(a: &[i32], b: &[i128]) -> i128 {
    a.iter().zip(b).map(|(a, b)| i128::from(*a) * b).sum()
}

/// A force over a diagonal element, in the description's two roundings.
fn divided(force: i128, diagonal: i32) -> i128 {
    let exponent = digits(i128::from(diagonal)) - 1;
    let limit = 1 << (exponent + 32);
    let reciprocal = quotient(1 << (exponent + 30), i128::from(diagonal));
    let short = round(force.clamp(-limit, limit), exponent + 2);
    round(short * reciprocal, 28)
}

/// A tick's problem.
struct Tick<'a> {
    table: &'a InverseTable,
    forces: Vec<i128>,
    limits: Vec<[i128; 2]>,
    slope: Vec<i128>,
    /// How much the linear volume must grow.
    need: Option<[i128; 2]>,
    start: Vec<i128>,
}

impl InverseTable {
    /// At rest.
    pub fn memory(&self) -> Memory {
        let bounds = self.lower.iter().zip(&self.upper);
        let nearest = |(&low, &high): (&i32, &i32)| i128::from(0.clamp(low, high));
        Memory {
            amplitudes: bounds.map(nearest).collect(),
            answer: vec![0; self.actuators],
            multiplier: 0,
            shift: 0,
            pace: WHOLE,
        }
    }

    /// One tick.
    pub fn tick(
        &self,
        goals: &[[i32; 3]],
        wanted: Option<&VolumeWanted>,
        memory: &mut Memory,
    ) -> Said {
        let mut said = Said::default();
        let mut tick = Tick {
            table: self,
            forces: self.forces(goals, &mut said),
            limits: self.limits(memory, &mut said),
            slope: vec![0; self.actuators],
            need: None,
            start: memory.amplitudes.clone(),
        };
        match wanted {
            None => {
                tick.descend(memory, &mut said);
            }
            Some(wanted) => tick.hold(wanted, memory, &mut said),
        }
        if said.held != 0 {
            said.gave_up |= 2;
        }
        said
    }

    fn forces(&self, goals: &[[i32; 3]], said: &mut Said) -> Vec<i128> {
        let limit = 1 << 30;
        let mut differences = Vec::new();
        for (goal, rest) in goals.as_flattened().iter().zip(self.rest.as_flattened()) {
            let difference = i128::from(*goal) - i128::from(*rest);
            let rounded = round(difference, self.difference_shift as i32);
            differences.push(rounded.clamp(-limit, limit));
            if rounded.abs() > limit {
                said.gave_up |= 1;
            }
        }
        let rows = self.gains.chunks(differences.len());
        rows.map(|row| force_of(dot(row, &differences), self.gain_shift))
            .collect()
    }

    fn limits(&self, memory: &Memory, said: &mut Said) -> Vec<[i128; 2]> {
        let mut limits = Vec::new();
        for (place, &before) in memory.amplitudes.iter().enumerate() {
            let number = |list: &[i32]| i128::from(list[place]);
            let (lower, upper) = (number(&self.lower), number(&self.upper));
            let step = number(&self.rates);
            let (down, up) = (before - step, before + step);
            if up < lower {
                said.gave_up |= 4;
                limits.push([up, up]);
            } else if down > upper {
                said.gave_up |= 4;
                limits.push([down, down]);
            } else {
                limits.push([down.max(lower), up.min(upper)]);
            }
        }
        limits
    }

    fn row(&self, actuator: usize) -> &[i32] {
        &self.hessian[actuator * self.actuators..][..self.actuators]
    }
}

impl Tick<'_> {
    /// At most eight sweeps, each with a step of the multiplier, or 24 where there is none.
    fn descend(&self, memory: &mut Memory, said: &mut Said) {
        let mut unsettled = true;
        let most = if self.need.is_some() { 8 } else { 24 };
        while unsettled && said.sweeps < most {
            said.sweeps += 1;
            said.held = 0;
            let mut greatest = 0;
            for place in 0..self.table.actuators {
                let change = self.one(place, memory, said);
                greatest = greatest.max(change);
            }
            if let Some(need) = self.need {
                let before = memory.amplitudes.clone();
                self.steer(need, memory);
                for (old, new) in before.iter().zip(&memory.amplitudes) {
                    greatest = greatest.max((new - old).abs());
                }
            }
            unsettled = greatest > 64;
        }
        if unsettled {
            said.gave_up |= 1 << 6;
        }
    }

    /// One actuator goes to the minimum of its parabola.
    fn one(&self, place: usize, memory: &mut Memory, said: &mut Said) -> i128 {
        let row = self.table.row(place);
        let (own, [low, high]) = (memory.amplitudes[place], self.limits[place]);
        let push = memory.multiplier * self.slope[place];
        let force = self.forces[place] + push - dot(row, &memory.amplitudes);
        let wanted = own + divided(force, row[place]);
        let new = wanted.clamp(low, high);
        let free = wanted > low && wanted < high;
        let force = (self.slope[place] << 20) - dot(row, &memory.answer);
        let answer = memory.answer[place] + divided(force, row[place]);
        memory.amplitudes[place] = new;
        memory.answer[place] = if free && self.need.is_some() {
            answer.clamp(-MOST, MOST)
        } else {
            0
        };
        if !free {
            said.held |= 1 << place;
        }
        (new - own).abs()
    }

    fn steer(&self, [low, high]: [i128; 2], memory: &mut Memory) {
        let mut rise = self.rise(&memory.answer);
        if rise <= 0 {
            rise = self.rise(&self.alone());
        }
        if rise <= 0 {
            return;
        }
        let pairs = memory.amplitudes.iter().zip(&self.start).zip(&self.slope);
        let grown: i128 = pairs
            .map(|((now, start), slope)| (now - start) * slope)
            .sum();
        let [to_low, to_high] =
            [low, high].map(|edge| memory.multiplier + quotient(edge - grown, rise));
        let target = if to_low > 0 {
            to_low
        } else if to_high < 0 {
            to_high
        } else {
            0
        };
        let target = target.clamp(-(1 << 35), 1 << 35);
        let step = (target - memory.multiplier).clamp(-MOST, MOST);
        memory.multiplier += step;
        memory.amplitudes = self.along(&memory.amplitudes, &memory.answer, step);
    }

    /// What a direction adds to the linear volume.
    fn rise(&self, direction: &[i128]) -> i128 {
        let pairs = self.slope.iter().zip(direction);
        round(pairs.map(|(a, b)| a * b).sum(), 20)
    }

    /// What each actuator would answer if there were no others.
    fn alone(&self) -> Vec<i128> {
        let answer = |place: usize| {
            let answer = divided(self.slope[place] << 20, self.table.row(place)[place]);
            answer.clamp(-MOST, MOST)
        };
        (0..self.table.actuators).map(answer).collect()
    }

    fn along(&self, from: &[i128], direction: &[i128], step: i128) -> Vec<i128> {
        let places = from.iter().zip(direction).zip(&self.limits);
        places
            .map(|((from, answer), &[low, high])| {
                (from + round(step * answer, 20)).clamp(low, high)
            })
            .collect()
    }

    fn hold(&mut self, wanted: &VolumeWanted, memory: &mut Memory, said: &mut Said) {
        let cut = |edge: i64| i128::from(edge).clamp(-(1 << 62), 1 << 62);
        let [mut low, mut high] = [wanted.low, wanted.high].map(cut);
        if wanted.low > wanted.high {
            said.gave_up |= 1 << 5;
            low = (low + high).div_euclid(2);
            high = low;
        }
        let volume_of = |amplitudes: &[i128]| volume(&wanted.coefficients, amplitudes);
        let error_of = |volume: i128| (volume - volume.clamp(low, high)).clamp(-FORCE, FORCE);
        let tolerance = low.abs().min(high.abs()) >> 14;
        let (volume_before, gradient) = volume_of(&self.start);
        let greatest = gradient.iter().map(|slope| slope.abs()).max().unwrap_or(0);
        let shift = digits(greatest) - 26;
        self.slope = gradient.iter().map(|&own| force_of(own, -shift)).collect();
        if greatest == 0 {
            said.gave_up |= 1 << 4;
        } else {
            self.need = Some([low, high].map(|edge| force_of(edge - volume_before, 31 - shift)));
            rescale(memory, shift);
        }
        self.descend(memory, said);

        let inside = self.start.iter().zip(&self.limits);
        let may_stay = inside
            .clone()
            .all(|(own, [low, high])| low <= own && own <= high);
        if !may_stay {
            memory.pace = WHOLE;
        }
        let pairs = self.start.iter().zip(&memory.amplitudes);
        let longest = pairs.clone().map(|(a, b)| (b - a).abs()).max();
        let swept: Vec<i128> = pairs
            .map(|(before, own)| before + round((own - before) * memory.pace, 16))
            .collect();
        let mut best = (swept.clone(), volume_of(&swept).0);
        said.evaluations = 1;
        let close = tolerance >> 8;
        let mut direction = memory.answer.clone();
        if self.rise(&direction) <= 0 {
            direction = self.alone();
        }
        let rise = self.rise(&direction);
        if self.need.is_some() && rise > 0 {
            let mut here = (0, error_of(best.1));
            let mut step = quotient(force_of(-here.1, 31 - shift), rise).clamp(-MOST, MOST);
            while error_of(best.1).abs() > close && said.evaluations < 4 {
                said.evaluations += 1;
                let place = self.along(&swept, &direction, step);
                let found = volume_of(&place).0;
                if error_of(found).abs() < error_of(best.1).abs() {
                    best = (place, found);
                }
                let next = (step, error_of(found));
                let Some(change) = chord(here, next) else {
                    break;
                };
                here = next;
                step = (step + change).clamp(-MOST, MOST);
            }
        }
        let allowed = error_of(volume_before).abs().max(tolerance);
        if may_stay && error_of(best.1).abs() > allowed {
            said.gave_up |= 1 << 7;
            memory.pace = (memory.pace / 4).max(LEAST);
            best = (self.start.clone(), volume_before);
        } else if longest.unwrap_or(0) >= 1 << 17 {
            let grown = force_of(best.1 - volume_before, 31 - shift);
            let asked = self.asked(&best.0, grown, memory.multiplier);
            let least = (memory.pace / 2).max(LEAST);
            memory.pace = asked.clamp(least, (2 * memory.pace).min(WHOLE));
        }
        if error_of(best.1).abs() > tolerance {
            said.gave_up |= 1 << 3;
        }
        memory.amplitudes = best.0;
        said.volume = best.1.to_i64().expect("volumes fit");
    }
}

impl Tick<'_> {
    /// The part of a step that would have reached the least of a parabola with the objective's curvature and the
    /// volume's, in 65536ths.
    fn asked(&self, place: &[i128], grown: i128, multiplier: i128) -> i128 {
        let step: Vec<i128> = place.iter().zip(&self.start).map(|(a, b)| a - b).collect();
        if step.iter().all(|own| own.abs() < 1 << 17) {
            return WHOLE;
        }
        let forces = (0..step.len()).map(|own| dot(self.table.row(own), &step));
        let objective: i128 = forces.zip(&step).map(|(a, b)| a * b).sum();
        let told: i128 = step.iter().zip(&self.slope).map(|(a, b)| a * b).sum();
        let lagrangian = objective - 2 * multiplier * (grown - told);
        if objective <= 0 || lagrangian <= objective {
            return WHOLE;
        }
        // 46 digits of both.
        let lost = (digits(lagrangian) - 46).max(0);
        quotient((objective >> lost) << 16, lagrangian >> lost)
    }
}

/// The step from the second place to the zero of the line through both.
fn chord((x0, e0): (i128, i128), (x1, e1): (i128, i128)) -> Option<i128> {
    let longest = digits(e1).max(digits(e1 - e0));
    let places = (longest - 30).max(0);
    let (error, rise) = (round(e1, places), round(e1 - e0, places));
    if rise == 0 {
        return None;
    }
    Some(quotient(error * (x0 - x1), rise))
}

fn rescale(memory: &mut Memory, shift: i32) {
    let change = shift - memory.shift;
    memory.shift = shift;
    if change != 0 {
        let multiplier = force_of(memory.multiplier, change);
        memory.multiplier = multiplier.clamp(-(1 << 35), 1 << 35);
        for answer in &mut memory.answer {
            *answer = force_of(*answer, -change).clamp(-MOST, MOST);
        }
    }
}

/// The polynomial's value and derivatives.
fn volume(coefficients: &[i32], amplitudes: &[i128]) -> (i128, Vec<i128>) {
    let narrow = |own: &i128| own.to_i32().expect("amplitudes fit");
    let amplitudes = amplitudes.iter().map(narrow).collect::<Vec<_>>();
    let (volume, gradient) = reference_volume::modes(amplitudes.len(), coefficients, &amplitudes);
    let gradient = gradient.into_iter().map(i128::from).collect();
    (i128::from(volume), gradient)
}
