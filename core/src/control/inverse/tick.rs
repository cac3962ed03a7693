//! One tick.

use super::config::{FORCE_LIMIT, Inverse, MOST_ACTUATORS, MOST_EFFECTORS};
use super::descent::{Amplitudes, MULTIPLIER_LIMIT, Point, Problem, Swept, clamp, product, scaled};
use super::error::InverseError;
use super::hold::{Band, Held, Linear, correct};
use super::pace::Pace;
use super::report::{GaveUp, InverseReport, VolumeGoal};
use super::state::InverseState;
use crate::coord::{Coordinate, round_shift};
use crate::enclosed::VolumeModes;

/// Sweeps of a tick with a volume at most.
pub const SWEEPS: u32 = 8;
/// Sweeps of a tick without a volume at most: they take less time, and so does the tick.
pub const SWEEPS_WITHOUT_VOLUME: u32 = 24;
/// Evaluations of the volume in a tick at most, beside the one that also gives its gradient.
pub const EVALUATIONS: u32 = 4;
/// The volume may be off by `2^-` this of its target: less than 1e-4.
pub const TOLERANCE_BITS: u32 = 14;

/// Amplitudes have settled when a sweep changes none by more than this.
const SETTLED: u32 = 1 << 6;
/// Differences of goals are cut to this magnitude.
const DIFFERENCE_LIMIT: i64 = 1 << 30;

/// The volume of a tick.
type Volume<'v, 'b> = Option<(&'v VolumeModes<'b>, VolumeGoal)>;

impl Inverse<'_> {
    /// Moves the amplitudes of `state` towards the goals, one position for each effector, while the volume is held.
    ///
    /// The time is bounded, and the same goals in the same state give the same bits everywhere.
    ///
    /// # Scaling and overflow
    ///
    /// Differences of goals are rounded by `2^difference_shift` and cut to `2^30`; gains add up to at most `2^31`, so
    /// their sum is at most `2^61`, and so are forces once they are shifted and cut. Products of `H` and amplitudes add up
    /// to at most `2^61`, as do those of `H` and `y`. The multiplier is at most `2^35` and the rounded gradient
    /// `2^26`: also `2^61`. The three together stay below `2^63`.
    ///
    /// # Errors
    ///
    /// [`InverseError::Length`] or [`InverseError::Modes`]; `state` is then unchanged.
    pub fn tick<C: Coordinate>(
        &self,
        goals: &[[C; 3]],
        volume: Volume<'_, '_>,
        state: &mut InverseState,
    ) -> Result<InverseReport, InverseError> {
        let (needed, given) = (self.effectors(), goals.len());
        if needed != given {
            return Err(InverseError::Length { needed, given });
        }
        let needed = self.actuators();
        if let Some((modes, _)) = volume
            && modes.modes() != needed
        {
            let given = modes.modes();
            return Err(InverseError::Modes { needed, given });
        }
        let mut report = InverseReport::default();
        let forces = self.forces(C::bits_of(goals), &mut report.gave_up);
        let (low, high) = self.limits(state, &mut report.gave_up);
        let mut problem = Problem {
            inverse: self,
            forces,
            low,
            high,
            slope: [0; MOST_ACTUATORS],
            need: None,
        };
        match volume {
            None => {
                let mut point = state.point();
                problem.descend(&mut point, &mut report);
                state.keep(&point);
            }
            Some((modes, goal)) => {
                let band = Band::new(goal);
                report.gave_up.set(GaveUp::BAND_EMPTY, band.is_empty);
                hold(&mut problem, modes, &band, state, &mut report);
            }
        }
        report.gave_up.set(GaveUp::HELD_BACK, report.held_back != 0);
        Ok(report)
    }

    /// `b = A (goal - rest)`.
    fn forces(&self, goals: &[[i32; 3]], gave_up: &mut GaveUp) -> [i64; MOST_ACTUATORS] {
        let parts = &self.parts;
        let mut differences = [[0_i32; 3]; MOST_EFFECTORS];
        let mut is_cut = false;
        let mut short = |goal: i32, rest: i32| {
            let difference = i64::from(goal).wrapping_sub(i64::from(rest));
            let difference = match parts.difference_shift {
                0 => difference,
                shift => round_shift(difference, shift),
            };
            is_cut |= difference.abs() > DIFFERENCE_LIMIT;
            let cut = difference.clamp(-DIFFERENCE_LIMIT, DIFFERENCE_LIMIT);
            i32::try_from(cut).unwrap_or_default()
        };
        let effectors = goals.iter().zip(parts.rest);
        for (own, (&[x, y, z], &[rest_x, rest_y, rest_z])) in differences.iter_mut().zip(effectors)
        {
            *own = [short(x, rest_x), short(y, rest_y), short(z, rest_z)];
        }
        gave_up.set(GaveUp::GOAL_OUT_OF_RANGE, is_cut);
        let differences = differences.as_flattened();
        let axes = self.effectors().wrapping_mul(3);
        let mut forces = [0; MOST_ACTUATORS];
        for (force, gains) in forces.iter_mut().zip(parts.gains.chunks_exact(axes)) {
            *force = scaled(product(gains, differences), parts.gain_shift);
        }
        forces
    }

    /// The box: bounds, cut with what can be reached in a tick.
    fn limits(&self, state: &InverseState, gave_up: &mut GaveUp) -> (Amplitudes, Amplitudes) {
        let (mut low, mut high) = ([0; MOST_ACTUATORS], [0; MOST_ACTUATORS]);
        let parts = &self.parts;
        let bounds = parts.lower.iter().zip(parts.upper).zip(parts.rates);
        let limits = low.iter_mut().zip(&mut high).zip(&state.amplitudes);
        for (((low, high), &before), ((&lower, &upper), &rate)) in limits.zip(bounds) {
            let step = i64::from(rate);
            let down = i64::from(before).wrapping_sub(step);
            let up = i64::from(before).wrapping_add(step);
            // Where the bounds cannot be reached in this tick both limits are the nearest place that can.
            *low = clamp(down, lower, upper);
            *high = clamp(up, lower, upper);
            if up < i64::from(lower) || down > i64::from(upper) {
                *low = clamp(
                    if up < i64::from(lower) { up } else { down },
                    -i32::MAX,
                    i32::MAX,
                );
                *high = *low;
                gave_up.set(GaveUp::OUTSIDE_BOUNDS, true);
            }
        }
        (low, high)
    }
}

impl Problem<'_, '_> {
    fn descend(&self, point: &mut Point, report: &mut InverseReport) {
        let mut swept = Swept::default();
        let most = match self.need {
            Some(_) => SWEEPS,
            None => SWEEPS_WITHOUT_VOLUME,
        };
        for sweeps in 1..=most {
            swept = self.sweep(point);
            report.sweeps = sweeps;
            if swept.greatest <= SETTLED {
                break;
            }
        }
        report
            .gave_up
            .set(GaveUp::UNSETTLED, swept.greatest > SETTLED);
        report.held_back = swept.held;
    }
}

impl InverseState {
    fn point(&self) -> Point {
        Point {
            amplitudes: self.amplitudes,
            answer: self.answer,
            multiplier: self.multiplier,
        }
    }

    fn keep(&mut self, point: &Point) {
        self.amplitudes = point.amplitudes;
        self.answer = point.answer;
        self.multiplier = point.multiplier;
    }

    /// Brings what was found for a gradient rounded by other bits to these.
    fn rescale(&mut self, shift: i32) {
        let change = shift.wrapping_sub(self.gradient_shift);
        if change != 0 {
            let multiplier = scaled(self.multiplier, change);
            self.multiplier = multiplier.clamp(-MULTIPLIER_LIMIT, MULTIPLIER_LIMIT);
            for answer in &mut self.answer {
                let scaled = scaled(i64::from(*answer), change.wrapping_neg());
                *answer = clamp(scaled, -i32::MAX, i32::MAX);
            }
        }
        self.gradient_shift = shift;
    }
}

/// The tick with a volume.
fn hold(
    problem: &mut Problem<'_, '_>,
    modes: &VolumeModes<'_>,
    band: &Band,
    state: &mut InverseState,
    report: &mut InverseReport,
) {
    let start = state.amplitudes;
    let linear = Linear::new(modes, band, &start);
    problem.slope = linear.slope;
    problem.need = linear.need;
    match linear.need {
        None => report.gave_up.set(GaveUp::ZERO_GRADIENT, true),
        Some(_) => state.rescale(linear.shift),
    }
    let mut point = state.point();
    problem.descend(&mut point, report);
    let limits = problem.low.iter().zip(&problem.high);
    let may_stay = start
        .iter()
        .zip(limits)
        .all(|(before, (low, high))| low <= before && before <= high);
    // From outside the box the way back into it is not shortened.
    let pace = if may_stay { state.pace } else { Pace::WHOLE };
    let longest = pace.shorten(&mut point.amplitudes, &start);
    let held = correct(
        problem,
        modes,
        band,
        linear.shift,
        &point.amplitudes,
        &point.answer,
    );
    report.evaluations = held.evaluations;
    let error_before = band.error(linear.volume);
    let allowed = error_before.unsigned_abs().max(band.tolerance());
    let is_refused = held.error.unsigned_abs() > allowed && may_stay;
    let before = Held {
        amplitudes: start,
        volume: linear.volume,
        error: error_before,
        ..held
    };
    let kept = if is_refused { before } else { held };
    state.pace = if is_refused {
        pace.quarter()
    } else {
        pace.next(problem, &linear, &start, &held, point.multiplier, longest)
    };
    point.amplitudes = kept.amplitudes;
    state.keep(&point);
    let is_missed = kept.error.unsigned_abs() > band.tolerance();
    report.volume = kept.volume;
    report.gave_up.set(GaveUp::STEP_REFUSED, is_refused);
    report.gave_up.set(GaveUp::VOLUME_MISSED, is_missed);
}

const _: () = assert!(FORCE_LIMIT == 1 << 61, "the bounds above rely on it");
