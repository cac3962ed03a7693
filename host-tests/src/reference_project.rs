//! The projection of poses written again from its written contract, in integers of 128 bits and any length.
//!
//! Vectors that grow, no scratch and no order of sums in common with the crate that is judged; volumes come from
//! [`reference_volume`](crate::reference_volume). Every rounding is a floor division of the exact number.

use num_bigint::BigInt;
use num_traits::ToPrimitive as _;

use crate::reference_volume::VolumeTable;

/// The limits of a cage.
#[derive(Clone, Debug, Default)]
pub struct LimitsTable {
    /// Lower ends of the boxes.
    pub lower: Vec<[i32; 3]>,
    /// Upper ends.
    pub upper: Vec<[i32; 3]>,
    /// How far coordinates move in a call.
    pub rates: Vec<u32>,
    /// How cheap points are to move, of 32768.
    pub mobilities: Vec<u16>,
    /// A step that moves no coordinate further has settled.
    pub settled: u32,
}

/// A region, and the volume that it shall enclose.
#[derive(Clone, Debug)]
pub struct RegionTable {
    /// The form.
    pub form: VolumeTable,
    /// The least volume.
    pub least: i64,
    /// The greatest.
    pub greatest: i64,
}

/// What a projection says.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Projected {
    /// The new pose.
    pub pose: Vec<[i32; 3]>,
    /// Its volumes.
    pub volumes: Vec<i64>,
    /// A bit for each region that was missed.
    pub missed: u32,
    /// Steps taken.
    pub steps: u32,
    /// Goal cut, outside a box, volume missed, no gradient, band empty, not settled, saturated.
    pub gave_up: [bool; 7],
}

/// One region with what changes from step to step.
struct Region<'a> {
    table: &'a RegionTable,
    least: i128,
    greatest: i128,
    volume: i128,
    /// `log2` of the reduced gradient's unit.
    unit: i64,
    multiplier: i128,
    /// Reduced gradient by coordinate of the whole pose.
    gradient: Vec<i128>,
    /// Range of the change of the linear volume.
    change: [i128; 2],
}

/// `floor(value / 2^shift + 1/2)`.
fn round(value: i128, shift: i64) -> i128 {
    // Forces are below 2^62, and shifts below 31.
    assert!(value.abs() < 1 << 120 && (1..=60).contains(&shift));
    (2 * value + (1 << shift)) >> (shift + 1)
}

/// `floor(value * 2^exponent + 1/2)`, clamped.
fn scaled(value: i128, exponent: i64, limit: i128) -> i128 {
    let exact = if exponent >= 0 {
        BigInt::from(value) << exponent.min(200)
    } else {
        let shift = -exponent;
        ((BigInt::from(value) * 2) + (BigInt::from(1) << shift)) >> (shift + 1)
    };
    let limit = BigInt::from(limit);
    exact.clamp(-&limit, limit).to_i128().expect("clamped")
}

/// Everything that stays during a call, by coordinate.
struct Problem {
    goal: Vec<i128>,
    lower: Vec<i128>,
    upper: Vec<i128>,
    mobility: Vec<i128>,
    bits: i64,
}

impl Problem {
    fn direction(&self, region: &Region<'_>, place: usize) -> i128 {
        round(self.mobility[place] * region.gradient[place], 15)
    }

    /// Where a coordinate goes before it is clamped.
    fn free(&self, regions: &[Region<'_>], place: usize) -> i128 {
        let force: i128 = regions
            .iter()
            .map(|region| region.multiplier * self.direction(region, place))
            .sum();
        self.goal[place] + round(force, self.bits + 8)
    }

    fn clamp(&self, place: usize, value: i128) -> i128 {
        value.min(self.upper[place]).max(self.lower[place])
    }

    /// Change of a region's linear volume, and its slope.
    fn change(&self, regions: &[Region<'_>], own: usize, current: &[i128]) -> (i128, i128) {
        let (mut value, mut slope) = (0, 0);
        for (place, now) in current.iter().enumerate() {
            let gradient = regions[own].gradient[place];
            if gradient == 0 {
                continue;
            }
            let free = self.free(regions, place);
            value += gradient * (self.clamp(place, free) - now);
            if self.lower[place] < free && free < self.upper[place] {
                slope += gradient * self.direction(&regions[own], place);
            }
        }
        (value, slope)
    }

    /// The multiplier of a region while the others stay.
    fn search(&self, regions: &mut [Region<'_>], own: usize, current: &[i128]) -> i128 {
        let before = regions[own].multiplier;
        let mut at = |multiplier: i128| {
            regions[own].multiplier = multiplier;
            self.change(regions, own, current)
        };
        let (without, slope) = at(0);
        regions[own].multiplier = before;
        let [least, greatest] = regions[own].change;
        let limit = 1_i128 << 38;
        let (target, mut bounds) = if without < least {
            (least, [0, limit])
        } else if without > greatest {
            (greatest, [-limit, 0])
        } else {
            return 0;
        };
        let newton = |from: i128, residual: i128, slope: i128| {
            let quotient = (2 * (residual << (self.bits + 8)) + slope).div_euclid(2 * slope);
            from + quotient
        };
        let inside = |bounds: [i128; 2], value: i128| bounds[0] < value && value < bounds[1];
        let mut best = (target - without, 0);
        let mut next = if inside(bounds, before) {
            Some(before)
        } else {
            (slope > 0).then(|| newton(0, target - without, slope))
        };
        for trial in 1..=24 {
            let wanted = next.filter(|&next| inside(bounds, next) && trial % 4 != 0);
            let trying = wanted.unwrap_or_else(|| between(bounds));
            if !inside(bounds, trying) {
                break;
            }
            regions[own].multiplier = trying;
            let (value, slope) = self.change(regions, own, current);
            let residual = target - value;
            if residual.abs() < best.0.abs() {
                best = (residual, trying);
            }
            if residual == 0 {
                break;
            }
            bounds[usize::from(residual < 0)] = trying;
            next = (slope > 0).then(|| newton(trying, residual, slope));
            if next == Some(trying) {
                break;
            }
        }
        regions[own].multiplier = before;
        best.1
    }
}

/// A number between two of one sign.
fn between([low, high]: [i128; 2]) -> i128 {
    let digits = |value: i128| i128::BITS - value.unsigned_abs().leading_zeros();
    let [near, far] = [digits(low).min(digits(high)), digits(low).max(digits(high))];
    if far > near + 2 {
        let power = 1_i128 << ((near + far) / 2);
        if high > 0 { power } else { -power }
    } else {
        (low + high).div_euclid(2)
    }
}

impl Region<'_> {
    fn excess(&self, volume: i128) -> i128 {
        let tolerance = (self.least.abs().max(self.greatest.abs()) >> 14).max(1);
        let off = (self.least - volume).max(volume - self.greatest).max(0);
        (off - 1).max(0) / tolerance
    }

    /// Reduces the gradient at a pose; whether it is not zero.
    fn linearise(&mut self, problem: &Problem, gradient: &[[i64; 3]]) -> bool {
        let mut whole = vec![0_i128; problem.goal.len()];
        for (&point, vector) in self.table.form.points.iter().zip(gradient) {
            for (axis, &value) in vector.iter().enumerate() {
                let place = 3 * usize::from(point) + axis;
                if problem.lower[place] < problem.upper[place] && problem.mobility[place] > 0 {
                    whole[place] = i128::from(value);
                }
            }
        }
        let together = whole
            .iter()
            .fold(0, |bits, value| bits | value.unsigned_abs());
        let length = i64::from(i128::BITS - together.leading_zeros());
        let unit = length - problem.bits;
        self.gradient = whole
            .iter()
            .map(|&value| scaled(value, -unit, i128::from(i64::MAX)))
            .collect();
        if length == 0 {
            self.multiplier = 0;
            self.change = [-(1 << 61), 1 << 61];
            return false;
        }
        let form = &self.table.form;
        let volume_unit = i64::from(form.volume_shift) + 3 * i64::from(form.difference_shift);
        let gradient_unit =
            31 + 2 * i64::from(form.difference_shift) - i64::from(form.gradient_bits);
        let exponent = volume_unit - gradient_unit - unit;
        self.change = [self.least, self.greatest]
            .map(|target| scaled(target - self.volume, exponent, 1 << 61));
        self.multiplier = scaled(self.multiplier, unit - self.unit, 1 << 38);
        self.unit = unit;
        true
    }
}

fn pose_of(places: &[i128]) -> Vec<[i32; 3]> {
    let (points, _) = places.as_chunks::<3>();
    let narrow = |value: i128| i32::try_from(value).expect("within a box");
    points.iter().map(|point| point.map(narrow)).collect()
}

fn by_coordinate(points: &[[i32; 3]]) -> Vec<i128> {
    points
        .iter()
        .flatten()
        .map(|&value| i128::from(value))
        .collect()
}

/// The nearest pose to a goal from the one before.
pub fn project(
    limits: &LimitsTable,
    regions: &[RegionTable],
    goal: &[[i32; 3]],
    before: &[[i32; 3]],
) -> Projected {
    let mut result = Projected::default();
    let largest = regions.iter().map(|region| region.form.points.len()).max();
    let coordinates = 3 * largest.unwrap_or_default();
    let digits = i64::from(usize::BITS - coordinates.leading_zeros());
    let mut problem = Problem {
        goal: by_coordinate(goal),
        lower: by_coordinate(&limits.lower),
        upper: by_coordinate(&limits.upper),
        mobility: Vec::new(),
        bits: (30 - digits).clamp(1, 22),
    };
    for (place, before) in by_coordinate(before).into_iter().enumerate() {
        let rate = i128::from(limits.rates[place / 3]);
        problem
            .mobility
            .push(i128::from(limits.mobilities[place / 3]));
        let (low, high) = (problem.lower[place], problem.upper[place]);
        problem.lower[place] = low.max(before - rate).min(before + rate);
        problem.upper[place] = high.min(before + rate).max(before - rate);
        result.gave_up[1] |= problem.lower[place] < low || problem.upper[place] > high;
    }
    let mut current: Vec<i128> = (0..problem.goal.len())
        .map(|place| problem.clamp(place, problem.goal[place]))
        .collect();
    result.gave_up[0] = current != problem.goal;
    let mut held: Vec<Region<'_>> = regions
        .iter()
        .map(|table| held(table, &mut result))
        .collect();
    for region in &mut held {
        let enclosed = region.table.form.evaluate(&pose_of(&current));
        result.gave_up[6] |= enclosed.volume_saturated > 0;
        region.volume = i128::from(enclosed.volume);
    }
    if !held.is_empty() {
        result.gave_up[5] = !steps(
            &problem,
            &mut held,
            limits.settled,
            &mut current,
            &mut result,
        );
    }
    for (place, region) in held.iter().enumerate() {
        result.missed |= u32::from(region.excess(region.volume) > 0) << place;
        let volume = i64::try_from(region.volume).expect("a volume has 64 bits");
        result.volumes.push(volume);
    }
    result.gave_up[2] = result.missed != 0;
    result.pose = pose_of(&current);
    result
}

fn held<'a>(table: &'a RegionTable, result: &mut Projected) -> Region<'a> {
    let (mut least, mut greatest) = (i128::from(table.least), i128::from(table.greatest));
    if least > greatest {
        result.gave_up[4] = true;
        let middle = (least + greatest).div_euclid(2);
        (least, greatest) = (middle, middle);
    }
    Region {
        table,
        least,
        greatest,
        volume: 0,
        unit: 0,
        multiplier: 0,
        gradient: Vec::new(),
        change: [0; 2],
    }
}

/// Whether the pose has settled.
fn steps(
    problem: &Problem,
    held: &mut [Region<'_>],
    settled: u32,
    current: &mut Vec<i128>,
    result: &mut Projected,
) -> bool {
    let worst = |held: &[Region<'_>]| held.iter().map(|region| region.excess(region.volume)).max();
    for step in 1..=12 {
        result.steps = step;
        let pose = pose_of(current);
        for region in held.iter_mut() {
            let enclosed = region.table.form.evaluate(&pose);
            result.gave_up[6] |= enclosed.saturated > 0;
            if !region.linearise(problem, &enclosed.gradient) {
                result.gave_up[3] |= region.excess(region.volume) > 0;
            }
        }
        for _ in 0..if held.len() > 1 { 12 } else { 1 } {
            let mut changed = false;
            for own in 0..held.len() {
                let multiplier = problem.search(held, own, current);
                changed |= multiplier != held[own].multiplier;
                held[own].multiplier = multiplier;
            }
            if !changed {
                break;
            }
        }
        let mut candidate: Vec<i128> = (0..current.len())
            .map(|place| problem.clamp(place, problem.free(held, place)))
            .collect();
        let before = worst(held);
        let mut taken = None;
        for _ in 0..5 {
            let pose = pose_of(&candidate);
            let enclosed: Vec<_> = held
                .iter()
                .map(|region| region.table.form.evaluate(&pose))
                .collect();
            let volumes: Vec<i128> = enclosed.iter().map(|own| i128::from(own.volume)).collect();
            let after = held
                .iter()
                .zip(&volumes)
                .map(|(region, &volume)| region.excess(volume));
            if after.max() <= before {
                result.gave_up[6] |= enclosed.iter().any(|own| own.volume_saturated > 0);
                taken = Some(volumes);
                break;
            }
            for (candidate, current) in candidate.iter_mut().zip(&*current) {
                *candidate = round(*candidate + current, 1);
            }
        }
        let Some(volumes) = taken else {
            return false;
        };
        let moved = candidate
            .iter()
            .zip(&*current)
            .map(|(new, old)| (new - old).abs())
            .max();
        *current = candidate;
        for (region, volume) in held.iter_mut().zip(volumes) {
            region.volume = volume;
        }
        let moved = moved.unwrap_or_default();
        if moved == 0 || (worst(held) == Some(0) && moved <= i128::from(settled)) {
            return true;
        }
    }
    false
}
