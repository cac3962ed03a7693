//! The steps of a projection.

use super::MOST_REGIONS;
use super::error::ProjectError;
use super::limits::LimitsParts;
use super::report::{GaveUp, ProjectReport, RegionGoal};
use super::scratch::{ProjectScratch, ScratchLengths};
use super::search::{MULTIPLIER_LIMIT, Problem, Slope};
use crate::coord::{floor_shift, round_div_wide, round_shift};

/// Steps of a projection at most.
pub const STEPS: u32 = 12;

/// How often the multipliers of all regions are searched in a step at most.
pub const SWEEPS: u32 = 12;

/// How often a step is halved at most.
pub const HALVINGS: u32 = 4;

/// A volume is met within its target divided by `2^14`, or one unit: 6.1e-5.
pub const TOLERANCE_BITS: u32 = 14;

/// The greatest change that is asked of a linear volume.
const CHANGE_LIMIT: i64 = 1 << 61;

/// A region while a projection runs.
#[derive(Clone, Copy, Default)]
struct Held {
    least: i64,
    greatest: i64,
    /// How far off the volume may be.
    tolerance: u64,
    volume: i64,
    /// A reduced gradient is the form's divided by `2^` this.
    shift: i64,
    multiplier: i64,
    /// What the linear volume shall change by, in units of the reduced gradient.
    least_change: i64,
    greatest_change: i64,
}

impl Held {
    fn new(region: &RegionGoal<'_>, gave_up: &mut GaveUp) -> Self {
        let (mut least, mut greatest) = (region.least, region.greatest);
        if least > greatest {
            *gave_up = *gave_up | GaveUp::BAND_EMPTY;
            let sum = i128::from(least).wrapping_add(i128::from(greatest));
            least = i64::try_from(sum.wrapping_shr(1)).unwrap_or_default();
            greatest = least;
        }
        let size = least.unsigned_abs().max(greatest.unsigned_abs());
        Self {
            least,
            greatest,
            tolerance: size.wrapping_shr(TOLERANCE_BITS).max(1),
            ..Self::default()
        }
    }

    /// How many whole tolerances a volume is off, beyond the first: 0 if it is met.
    fn excess(&self, volume: i64) -> u64 {
        let off = if volume < self.least {
            self.least.abs_diff(volume)
        } else if volume > self.greatest {
            volume.abs_diff(self.greatest)
        } else {
            0
        };
        let beyond = off.saturating_sub(1);
        beyond.checked_div(self.tolerance).unwrap_or_default()
    }
}

/// A projection that runs.
struct Run<'a> {
    limits: &'a LimitsParts<'a>,
    goal: &'a [[i32; 3]],
    regions: &'a [RegionGoal<'a>],
    scratch: ProjectScratch<'a>,
    held: [Held; MOST_REGIONS],
    bits: u32,
    gave_up: GaveUp,
}

pub(super) fn project(
    limits: &LimitsParts<'_>,
    goal: &[[i32; 3]],
    regions: &[RegionGoal<'_>],
    scratch: ProjectScratch<'_>,
    pose: &mut [[i32; 3]],
) -> Result<ProjectReport, ProjectError> {
    let needed = limits.lower.len();
    for given in [goal.len(), pose.len()] {
        if given != needed {
            return Err(ProjectError::Length { needed, given });
        }
    }
    if regions.len() > MOST_REGIONS {
        let given = regions.len();
        return Err(ProjectError::Regions { given });
    }
    let lengths = ScratchLengths::of(regions);
    let mut run = Run {
        limits,
        goal,
        regions,
        scratch: scratch.cut(needed, lengths)?,
        held: [Held::default(); MOST_REGIONS],
        bits: gradient_bits(lengths.form),
        gave_up: GaveUp::NOTHING,
    };
    run.require_distinct_points()?;
    for (held, region) in run.held.iter_mut().zip(regions) {
        *held = Held::new(region, &mut run.gave_up);
    }
    run.cut_boxes(pose);
    let steps = run.steps()?;
    pose.copy_from_slice(run.scratch.current);
    Ok(run.report(steps))
}

/// Bits of a reduced gradient, so that sums over the coordinates of a region fit.
fn gradient_bits(points: usize) -> u32 {
    let coordinates = points.saturating_mul(3);
    let bits = usize::BITS.wrapping_sub(coordinates.leading_zeros());
    30_u32.saturating_sub(bits).clamp(1, 22)
}

impl<'a> Run<'a> {
    fn give_up(&mut self, reason: GaveUp) {
        self.gave_up = self.gave_up | reason;
    }

    /// Marks the points of every region in the forces.
    fn require_distinct_points(&mut self) -> Result<(), ProjectError> {
        self.scratch.forces.fill([0; 3]);
        for (region, mark) in self.regions.iter().zip(1_i64..) {
            for &point in region.form.points() {
                // A point beyond the pose is refused with the form.
                if let Some([seen, ..]) = self.scratch.forces.get_mut(usize::from(point)) {
                    if *seen == mark {
                        let point = u32::from(point);
                        return Err(ProjectError::RepeatedPoint { point });
                    }
                    *seen = mark;
                }
            }
        }
        Ok(())
    }

    /// The boxes of this call: those of the limits, cut with what the rates reach from the pose before. The
    /// goal, clamped to them, is where the steps begin.
    fn cut_boxes(&mut self, before: &[[i32; 3]]) {
        let limits = self.limits.lower.iter().zip(self.limits.upper);
        let limits = limits.zip(self.limits.rates).zip(before);
        let lower = self.scratch.lower.iter_mut();
        let boxes = lower.zip(self.scratch.upper.iter_mut());
        let cut = boxes.zip(self.scratch.current.iter_mut()).zip(self.goal);
        let (mut outside, mut is_cut) = (false, false);
        for ((((low, high), &rate), before), (((lower, upper), current), goal)) in limits.zip(cut) {
            let axes = low.iter().zip(high).zip(before).zip(goal);
            let out = lower.iter_mut().zip(upper.iter_mut()).zip(current);
            for ((((&low, &high), &before), &goal), ((lower, upper), current)) in axes.zip(out) {
                let [reach_low, reach_high] = reach(before, rate);
                *lower = low.clamp(reach_low, reach_high);
                *upper = high.clamp(reach_low, reach_high);
                outside |= *lower < low || *upper > high;
                *current = goal.clamp(*lower, *upper);
                is_cut |= *current != goal;
            }
        }
        if outside {
            self.give_up(GaveUp::OUTSIDE_BOX);
        }
        if is_cut {
            self.give_up(GaveUp::GOAL_CUT);
        }
    }

    /// Steps until the pose has settled, and how many they were.
    fn steps(&mut self) -> Result<u32, ProjectError> {
        self.scratch.forces.fill([0; 3]);
        self.volumes_of_current()?;
        if self.regions.is_empty() {
            return Ok(0);
        }
        for step in 1..=STEPS {
            self.linearise()?;
            self.search();
            self.move_candidate();
            let moved = self.accept()?;
            let Some(moved) = moved else {
                // Not even a small part of the step is better.
                self.give_up(GaveUp::NOT_SETTLED);
                return Ok(step);
            };
            let is_met = self.excess() == 0;
            if moved == 0 || (is_met && moved <= self.limits.settled) {
                return Ok(step);
            }
        }
        self.give_up(GaveUp::NOT_SETTLED);
        Ok(STEPS)
    }

    fn volumes_of_current(&mut self) -> Result<(), ProjectError> {
        for (held, region) in self.held.iter_mut().zip(self.regions) {
            let workspace = cut(self.scratch.form_workspace, region.form.workspace_length())?;
            let enclosed = region
                .form
                .volume(self.scratch.current, workspace)
                .map_err(ProjectError::Enclosed)?;
            held.volume = enclosed.volume;
            if enclosed.saturated > 0 {
                self.gave_up = self.gave_up | GaveUp::SATURATED;
            }
        }
        Ok(())
    }

    /// How far off all volumes are, in whole tolerances of the worst.
    fn excess(&self) -> u64 {
        let held = self.held.iter().zip(self.regions);
        held.map(|(held, _)| held.excess(held.volume))
            .max()
            .unwrap_or_default()
    }

    /// Reduced gradients at the pose so far, and what the linear volumes shall change by.
    fn linearise(&mut self) -> Result<(), ProjectError> {
        let mut gradients = &mut *self.scratch.gradients;
        for (held, region) in self.held.iter_mut().zip(self.regions) {
            let form = region.form;
            let workspace = cut(self.scratch.form_workspace, form.workspace_length())?;
            let gradient = cut(self.scratch.form_gradient, form.points().len())?;
            let enclosed = form
                .volume_and_gradient(self.scratch.current, workspace, gradient)
                .map_err(ProjectError::Enclosed)?;
            if enclosed.saturated > 0 {
                self.gave_up = self.gave_up | GaveUp::SATURATED;
            }
            let (own, rest) = core::mem::take(&mut gradients)
                .split_at_mut_checked(form.points().len())
                .ok_or(ProjectError::Layout)?;
            gradients = rest;
            let is_free = Free {
                limits: self.limits,
                lower: self.scratch.lower,
                upper: self.scratch.upper,
            };
            let shift = is_free.reduce(form.points(), gradient, self.bits, own);
            let Some(shift) = shift else {
                if held.excess(held.volume) > 0 {
                    self.gave_up = self.gave_up | GaveUp::ZERO_GRADIENT;
                }
                *held = Held {
                    multiplier: 0,
                    least_change: CHANGE_LIMIT.wrapping_neg(),
                    greatest_change: CHANGE_LIMIT,
                    ..*held
                };
                continue;
            };
            let exponent = form
                .volume_exponent()
                .wrapping_sub(form.gradient_exponent())
                .wrapping_sub(shift);
            let change = |target: i64| {
                let change = i128::from(target).wrapping_sub(i128::from(held.volume));
                scale(change, exponent, CHANGE_LIMIT)
            };
            let by = shift.wrapping_sub(held.shift);
            *held = Held {
                shift,
                // The same step in the new unit.
                multiplier: scale(i128::from(held.multiplier), by, MULTIPLIER_LIMIT),
                least_change: change(held.least),
                greatest_change: change(held.greatest),
                ..*held
            };
        }
        Ok(())
    }

    /// Searches the multipliers of all regions in turn, until none changes.
    fn search(&mut self) {
        let problem = Problem {
            limits: self.limits,
            goal: self.goal,
            lower: self.scratch.lower,
            upper: self.scratch.upper,
            current: self.scratch.current,
            bits: self.bits,
        };
        let forces = &mut *self.scratch.forces;
        forces.fill([0; 3]);
        let mut slopes = [const { None }; MOST_REGIONS];
        let mut gradients = &*self.scratch.gradients;
        for ((slope, held), region) in slopes.iter_mut().zip(&self.held).zip(self.regions) {
            let points = region.form.points();
            let Some((gradient, rest)) = gradients.split_at_checked(points.len()) else {
                break;
            };
            gradients = rest;
            let own = Slope {
                points,
                gradient,
                least: held.least_change,
                greatest: held.greatest_change,
            };
            problem.push(&own, held.multiplier, forces);
            *slope = Some(own);
        }
        let sweeps = if self.regions.len() > 1 { SWEEPS } else { 1 };
        for _ in 0..sweeps {
            let mut changed = false;
            for (slope, held) in slopes.iter().flatten().zip(&mut self.held) {
                let multiplier = problem.multiplier(slope, held.multiplier, forces);
                let change = multiplier.wrapping_sub(held.multiplier);
                if change != 0 {
                    problem.push(slope, change, forces);
                    held.multiplier = multiplier;
                    changed = true;
                }
            }
            if !changed {
                break;
            }
        }
    }

    /// The pose that the forces give.
    fn move_candidate(&mut self) {
        let problem = Problem {
            limits: self.limits,
            goal: self.goal,
            lower: self.scratch.lower,
            upper: self.scratch.upper,
            current: self.scratch.current,
            bits: self.bits,
        };
        let boxes = problem.lower.iter().zip(problem.upper).zip(problem.goal);
        let moved = self.scratch.candidate.iter_mut().zip(&*self.scratch.forces);
        for (((lower, upper), goal), (candidate, force)) in boxes.zip(moved) {
            let axes = lower.iter().zip(upper).zip(goal).zip(force);
            for ((((&lower, &upper), &goal), &force), candidate) in axes.zip(candidate) {
                let free = problem.moved(goal, force);
                let inside = free.min(i64::from(upper)).max(i64::from(lower));
                // Between two numbers of 32 bits.
                *candidate = i32::try_from(inside).unwrap_or(goal);
            }
        }
    }

    /// Takes the candidate, or the pose half way to it, as often as is allowed. The greatest change of a
    /// coordinate, or nothing if no such pose is at least as good.
    fn accept(&mut self) -> Result<Option<u32>, ProjectError> {
        let before = self.excess();
        for _ in 0..=HALVINGS {
            let mut volumes = [0; MOST_REGIONS];
            let mut excess = 0;
            let mut is_clamped = false;
            for ((held, region), volume) in self.held.iter().zip(self.regions).zip(&mut volumes) {
                let workspace = cut(self.scratch.form_workspace, region.form.workspace_length())?;
                let enclosed = region
                    .form
                    .volume(self.scratch.candidate, workspace)
                    .map_err(ProjectError::Enclosed)?;
                *volume = enclosed.volume;
                is_clamped |= enclosed.saturated > 0;
                excess = held.excess(enclosed.volume).max(excess);
            }
            if excess <= before {
                if is_clamped {
                    self.give_up(GaveUp::SATURATED);
                }
                let moved = greatest_change(self.scratch.current, self.scratch.candidate);
                self.scratch.current.copy_from_slice(self.scratch.candidate);
                for (held, volume) in self.held.iter_mut().zip(volumes) {
                    held.volume = volume;
                }
                return Ok(Some(moved));
            }
            halve(self.scratch.current, self.scratch.candidate);
        }
        Ok(None)
    }

    fn report(mut self, steps: u32) -> ProjectReport {
        let mut report = ProjectReport {
            steps,
            ..ProjectReport::default()
        };
        let held = self.held.iter().zip(self.regions);
        for ((held, _), (volume, bit)) in held.zip(report.volumes.iter_mut().zip(0_u32..)) {
            *volume = held.volume;
            if held.excess(held.volume) > 0 {
                report.missed |= 1_u32.wrapping_shl(bit);
            }
        }
        if report.missed != 0 {
            self.give_up(GaveUp::VOLUME_MISSED);
        }
        report.gave_up = self.gave_up;
        report
    }
}

/// Which coordinates a volume may move.
struct Free<'a> {
    limits: &'a LimitsParts<'a>,
    lower: &'a [[i32; 3]],
    upper: &'a [[i32; 3]],
}

impl Free<'_> {
    fn is_free(&self, point: u16) -> [bool; 3] {
        let point = usize::from(point);
        let (Some(lower), Some(upper), Some(&mobility)) = (
            self.lower.get(point),
            self.upper.get(point),
            self.limits.mobilities.get(point),
        ) else {
            return [false; 3];
        };
        let mut free = [false; 3];
        for ((free, lower), upper) in free.iter_mut().zip(lower).zip(upper) {
            *free = lower < upper && mobility > 0;
        }
        free
    }

    /// Writes the gradient over free coordinates, divided by a power of two so that the greatest has `bits` bits, and
    /// returns the power; zeros elsewhere. Nothing if all are zero.
    fn reduce(
        &self,
        points: &[u16],
        gradient: &[[i64; 3]],
        bits: u32,
        out: &mut [[i32; 3]],
    ) -> Option<i64> {
        let mut occupied = 0_u64;
        for (&point, gradient) in points.iter().zip(gradient) {
            for (gradient, free) in gradient.iter().zip(self.is_free(point)) {
                if free {
                    occupied |= gradient.unsigned_abs();
                }
            }
        }
        let length = u64::BITS.wrapping_sub(occupied.leading_zeros());
        for ((&point, gradient), out) in points.iter().zip(gradient).zip(out) {
            let axes = gradient.iter().zip(self.is_free(point));
            for ((&gradient, free), out) in axes.zip(out) {
                let reduced = match length.checked_sub(bits) {
                    Some(0) => gradient,
                    // The first floor changes no rounding, and keeps the half from leaving 64 bits.
                    Some(shift) => round_shift(floor_shift(gradient, shift.wrapping_sub(1)), 1),
                    None => gradient.wrapping_shl(bits.wrapping_sub(length)),
                };
                *out = match free {
                    // At most 2^22.
                    true => i32::try_from(reduced).unwrap_or_default(),
                    false => 0,
                };
            }
        }
        (length > 0).then(|| i64::from(length).wrapping_sub(i64::from(bits)))
    }
}

/// The coordinates that a rate reaches.
fn reach(before: i32, rate: u32) -> [i32; 2] {
    [
        before.saturating_sub_unsigned(rate),
        before.saturating_add_unsigned(rate),
    ]
}

/// `round(value * 2^exponent)`, at most `limit` in magnitude.
fn scale(value: i128, exponent: i64, limit: i64) -> i64 {
    let bound = if value < 0 {
        limit.wrapping_neg()
    } else {
        limit
    };
    let scaled = match u32::try_from(exponent.unsigned_abs()).unwrap_or(u32::MAX) {
        _ if value == 0 => 0,
        // The value has at most 65 bits.
        shift if exponent >= 0 => {
            if shift > 61 {
                return bound;
            }
            value.wrapping_shl(shift)
        }
        shift if shift > 100 => 0,
        shift => round_div_wide(value, 1_i128.wrapping_shl(shift)),
    };
    match i64::try_from(scaled) {
        Ok(scaled) => scaled.clamp(limit.wrapping_neg(), limit),
        Err(_) => bound,
    }
}

fn greatest_change(before: &[[i32; 3]], after: &[[i32; 3]]) -> u32 {
    let before = before.iter().flatten();
    let changes = before.zip(after.iter().flatten());
    let changes = changes.map(|(before, after)| before.abs_diff(*after));
    changes.max().unwrap_or_default()
}

/// Moves the candidate half way back.
fn halve(current: &[[i32; 3]], candidate: &mut [[i32; 3]]) {
    let current = current.iter().flatten();
    for (&current, candidate) in current.zip(candidate.iter_mut().flatten()) {
        let sum = i64::from(current).wrapping_add(i64::from(*candidate));
        // Between the two.
        *candidate = i32::try_from(round_shift(sum, 1)).unwrap_or(current);
    }
}

/// The part of a scratch that a region needs.
fn cut<T>(scratch: &mut [T], needed: usize) -> Result<&mut [T], ProjectError> {
    let given = scratch.len();
    scratch
        .get_mut(..needed)
        .ok_or(ProjectError::Length { needed, given })
}
