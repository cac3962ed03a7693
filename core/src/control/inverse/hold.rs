//! Holds the volume: its linearisation for the descent, and the correction behind it.

use super::config::MOST_ACTUATORS;
use super::descent::{Amplitudes, Need, Problem, SLOPE_BITS, product, scaled};
use super::report::VolumeGoal;
use super::tick::{EVALUATIONS, TOLERANCE_BITS};
use crate::coord::{round_div, round_shift};
use crate::enclosed::VolumeModes;

/// Volumes are cut to this magnitude, which no polynomial reaches.
const VOLUME_LIMIT: i64 = 1 << 62;
/// Errors of the volume are cut to this magnitude.
const ERROR_LIMIT: i64 = 1 << 61;
/// How many times closer than the tolerance the correction aims.
const FINER_BITS: u32 = 8;
/// Bits to which errors are rounded for the secant.
const SECANT_BITS: u32 = 30;

/// The volume that is asked for.
#[derive(Clone, Copy)]
pub(super) struct Band {
    pub low: i64,
    pub high: i64,
    /// Whether the goal was an empty band.
    pub is_empty: bool,
}

impl Band {
    pub fn new(goal: VolumeGoal) -> Self {
        let cut = |volume: i64| volume.clamp(-VOLUME_LIMIT, VOLUME_LIMIT);
        match goal {
            VolumeGoal::Hold(volume) => Self {
                low: cut(volume),
                high: cut(volume),
                is_empty: false,
            },
            VolumeGoal::Band(low, high) if low <= high => Self {
                low: cut(low),
                high: cut(high),
                is_empty: false,
            },
            VolumeGoal::Band(low, high) => {
                // The sum of both ends may have 64 bits; half of their difference has 63.
                let (low, high) = (cut(low), cut(high));
                let middle = low.wrapping_add(high.wrapping_sub(low).wrapping_shr(1));
                Self {
                    low: middle,
                    high: middle,
                    is_empty: true,
                }
            }
        }
    }

    /// How far a volume lies above the band, or below it.
    pub fn error(&self, volume: i64) -> i64 {
        let nearest = volume.clamp(self.low, self.high);
        volume
            .wrapping_sub(nearest)
            .clamp(-ERROR_LIMIT, ERROR_LIMIT)
    }

    /// The error that is allowed.
    pub fn tolerance(&self) -> u64 {
        let least = self.low.unsigned_abs().min(self.high.unsigned_abs());
        least.wrapping_shr(TOLERANCE_BITS)
    }
}

/// The volume's linearisation at the amplitudes that a tick starts from.
pub(super) struct Linear {
    pub slope: Amplitudes,
    /// Bits by which the gradient was rounded; negative if it was widened.
    pub shift: i32,
    pub need: Option<Need>,
    /// The volume.
    pub volume: i64,
}

impl Linear {
    pub fn new(modes: &VolumeModes<'_>, band: &Band, start: &Amplitudes) -> Self {
        let mut gradient = [0_i64; MOST_ACTUATORS];
        let count = modes.modes().min(MOST_ACTUATORS);
        let (amplitudes, derivatives) = (start.get(..count), gradient.get_mut(..count));
        let volume = match (amplitudes, derivatives) {
            (Some(amplitudes), Some(derivatives)) => modes
                .volume_and_gradient(amplitudes, derivatives)
                .unwrap_or_default(),
            _ => 0,
        };
        let greatest = gradient.iter().map(|slope| slope.unsigned_abs()).max();
        let greatest = greatest.unwrap_or_default();
        let bits = 64_u32.wrapping_sub(greatest.leading_zeros());
        let shift = i32::try_from(bits)
            .unwrap_or_default()
            .wrapping_sub(SLOPE_BITS);
        let mut slope = [0; MOST_ACTUATORS];
        for (slope, &derivative) in slope.iter_mut().zip(&gradient) {
            // At most 2^26.
            *slope = i32::try_from(scaled(derivative, shift.wrapping_neg())).unwrap_or_default();
        }
        let unit = error_shift(shift);
        let need = (greatest > 0).then(|| Need {
            start: product(&slope, start),
            low: scaled(band.low.wrapping_sub(volume), unit),
            high: scaled(band.high.wrapping_sub(volume), unit),
        });
        Self {
            slope,
            shift,
            need,
            volume,
        }
    }
}

/// From volumes, in units of `2^-28`, to products of slope (`2^(shift - 29)`) and amplitude (`2^-30`).
pub(super) fn error_shift(shift: i32) -> i32 {
    31_i32.wrapping_sub(shift)
}

/// Amplitudes with their volume.
#[derive(Clone, Copy)]
pub(super) struct Held {
    pub amplitudes: Amplitudes,
    pub volume: i64,
    pub error: i64,
    pub evaluations: u32,
}

/// Goes along the answer of the free amplitudes, or if there is none of all, until the volume is right, and returns the
/// best of all that was evaluated.
pub(super) fn correct(
    problem: &Problem<'_, '_>,
    modes: &VolumeModes<'_>,
    band: &Band,
    shift: i32,
    from: &Amplitudes,
    answer: &Amplitudes,
) -> Held {
    let evaluate = |amplitudes: &Amplitudes, evaluations: u32| {
        let amplitudes_used = amplitudes.get(..modes.modes()).unwrap_or_default();
        let volume = modes.volume(amplitudes_used).unwrap_or_default();
        Held {
            amplitudes: *amplitudes,
            volume,
            error: band.error(volume),
            evaluations,
        }
    };
    let mut best = evaluate(from, 1);
    let close = band.tolerance().wrapping_shr(FINER_BITS);
    if best.error.unsigned_abs() <= close || problem.need.is_none() {
        return best;
    }
    let mut direction = *answer;
    let mut rise = problem.along(&direction);
    if rise <= 0 {
        direction = problem.steepest();
        rise = problem.along(&direction);
    }
    if rise <= 0 {
        return best;
    }
    let most = i64::from(i32::MAX);
    let cut = |step: i64| step.clamp(most.wrapping_neg(), most);
    let (mut before, mut error) = (0, best.error);
    let mut step = cut(round_div(
        scaled(error.wrapping_neg(), error_shift(shift)),
        rise,
    ));
    for evaluations in 2..=EVALUATIONS {
        let tried = evaluate(&problem.moved(from, &direction, step), evaluations);
        let is_better = tried.error.unsigned_abs() < best.error.unsigned_abs();
        best = if is_better { tried } else { best };
        best.evaluations = evaluations;
        if best.error.unsigned_abs() <= close {
            break;
        }
        let Some(change) = secant([before, step], [error, tried.error]) else {
            break;
        };
        (before, error) = (step, tried.error);
        step = cut(step.wrapping_add(change));
    }
    best
}

/// From two places and their errors the step from the second to where the line through both is zero; `None` if it is
/// level.
///
/// Errors are at most `2^61` and are rounded to 30 bits; places are at most `2^31`, so products stay below `2^62`.
fn secant([before, here]: [i64; 2], [error_before, error]: [i64; 2]) -> Option<i64> {
    let rise = error.wrapping_sub(error_before);
    let greatest = error.unsigned_abs().max(rise.unsigned_abs());
    let bits = 64_u32.wrapping_sub(greatest.leading_zeros());
    let shift = bits.saturating_sub(SECANT_BITS);
    let short = |value: i64| match shift {
        0 => value,
        _ => round_shift(value, shift),
    };
    let (error, rise) = (short(error), short(rise));
    let product = error.wrapping_mul(before.wrapping_sub(here));
    match rise {
        0 => None,
        _ if rise < 0 => Some(round_div(product.wrapping_neg(), rise.wrapping_neg())),
        _ => Some(round_div(product, rise)),
    }
}
