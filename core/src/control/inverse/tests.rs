//! Small problems whose answers follow from a line of arithmetic.

#![allow(
    clippy::unwrap_used,
    clippy::indexing_slicing,
    clippy::arithmetic_side_effects,
    reason = "tests"
)]

use super::*;
use crate::enclosed::VolumeModes;

/// An amplitude of one.
const ONE: i32 = 1 << 30;
/// What a coordinate of 20 fraction bits calls one.
const UNIT: i32 = 1 << 20;

/// Two actuators that push one effector along x and y by one unit, alone or by a part of one another.
///
/// `H` is `2^28 [[1, c], [c, 1]]` for a coupling of `c / 4`, gains are `2^28` for a unit: forces of goals in units are
/// `2^28 2^20`, those of amplitudes `2^28 2^30`, so that the gain shift is 10.
struct Two {
    hessian: [i32; 4],
    gains: [i32; 6],
    lower: [i32; 2],
    upper: [i32; 2],
    rates: [i32; 2],
}

impl Two {
    fn new() -> Self {
        let own = 1 << 28;
        Self {
            hessian: [own, 0, 0, own],
            gains: [own, 0, 0, 0, own, 0],
            lower: [-ONE; 2],
            upper: [ONE; 2],
            rates: [i32::MAX; 2],
        }
    }

    /// Both push along x.
    fn dependent() -> Self {
        let own = 1 << 28;
        Self {
            hessian: [own; 4],
            gains: [own, 0, 0, own, 0, 0],
            ..Self::new()
        }
    }

    fn parts(&self) -> InverseParts<'_> {
        InverseParts {
            hessian: &self.hessian,
            reciprocals: &[1 << 30; 2],
            gains: &self.gains,
            rest: &[[0; 3]],
            lower: &self.lower,
            upper: &self.upper,
            rates: &self.rates,
            difference_shift: 0,
            gain_shift: 10,
        }
    }

    fn solver(&self) -> Inverse<'_> {
        Inverse::new_checked(self.parts()).unwrap()
    }
}

fn refused(parts: InverseParts<'_>) -> Result<(), InverseError> {
    Inverse::new_checked(parts).map(|_| ())
}

fn goal(x: i32, y: i32) -> [[i32; 3]; 1] {
    [[x, y, 0]]
}

#[test]
fn a_goal_within_reach_is_met_to_the_last_places() {
    let two = Two::new();
    let solver = two.solver();
    let mut state = InverseState::new(&solver);
    let report = solver
        .tick(&goal(UNIT / 2, -UNIT / 4), None, &mut state)
        .unwrap();
    assert_eq!(state.amplitudes()[..2], [ONE / 2, -ONE / 4]);
    assert_eq!(report.gave_up, GaveUp::NOTHING);
}

#[test]
fn a_goal_beyond_reach_ends_at_the_bound_and_says_so() {
    let two = Two::new();
    let solver = two.solver();
    let mut state = InverseState::new(&solver);
    let report = solver.tick(&goal(3 * UNIT, 0), None, &mut state).unwrap();
    assert_eq!(state.amplitudes()[..2], [ONE, 0]);
    assert!(report.gave_up.contains(GaveUp::HELD_BACK));
    assert_eq!(report.held_back, 1);
    // 2^31 - 1 units of 2^-20 are beyond the 2^30 that differences are cut to.
    let report = solver.tick(&goal(i32::MAX, 0), None, &mut state).unwrap();
    assert!(report.gave_up.contains(GaveUp::GOAL_OUT_OF_RANGE));
    assert_eq!(state.amplitudes()[..2], [ONE, 0]);
}

#[test]
fn a_goal_that_jumps_is_followed_at_the_rate() {
    let two = Two {
        rates: [ONE / 8, ONE / 16],
        ..Two::new()
    };
    let solver = two.solver();
    let mut state = InverseState::new(&solver);
    for tick in 1..=8 {
        solver.tick(&goal(UNIT, UNIT), None, &mut state).unwrap();
        assert_eq!(
            state.amplitudes()[..2],
            [tick * (ONE / 8), tick * (ONE / 16)]
        );
    }
}

#[test]
fn outside_its_bounds_an_actuator_returns_at_its_rate() {
    let two = Two {
        rates: [ONE / 8; 2],
        upper: [ONE / 2; 2],
        ..Two::new()
    };
    let solver = two.solver();
    let mut state = InverseState::new(&solver);
    state.set_amplitudes(&[ONE, 0]);
    let report = solver.tick(&goal(UNIT, 0), None, &mut state).unwrap();
    assert_eq!(state.amplitudes()[0], ONE - ONE / 8);
    assert!(report.gave_up.contains(GaveUp::OUTSIDE_BOUNDS));
}

#[test]
fn dependent_modes_share_one_goal() {
    let two = Two::dependent();
    let solver = two.solver();
    let mut state = InverseState::new(&solver);
    let report = solver
        .tick(&goal(3 * UNIT / 2, 0), None, &mut state)
        .unwrap();
    // Every pair that adds up to 3/2 is best; coordinate descent fills the first.
    assert_eq!(state.amplitudes()[..2], [ONE, ONE / 2]);
    assert!(!report.gave_up.contains(GaveUp::UNSETTLED));
}

/// A volume of `1 + q_1 + q_2` over 16: `k_000`, `k_001`, `k_002` of ten coefficients.
const LINEAR: [i32; 10] = [1 << 26, 1 << 26, 1 << 26, 0, 0, 0, 0, 0, 0, 0];
/// What [`LINEAR`] encloses at rest, in units of `2^-28`.
const REST: i64 = 1 << 54;

#[test]
fn a_held_volume_splits_the_goal() {
    let two = Two::new();
    let solver = two.solver();
    let modes = VolumeModes::new_checked(2, &LINEAR).unwrap();
    let mut state = InverseState::new(&solver);
    let hold = Some((&modes, VolumeGoal::Hold(REST)));
    let report = solver.tick(&goal(UNIT / 2, 0), hold, &mut state).unwrap();
    // The nearest point to (1/2, 0) with q_1 + q_2 = 0.
    let [x, y] = [state.amplitudes()[0], state.amplitudes()[1]];
    assert!(
        (x - ONE / 4).abs() < 64 && (y + ONE / 4).abs() < 64,
        "{x} {y}"
    );
    assert!((report.volume - REST).unsigned_abs() <= (REST >> 22).unsigned_abs());
    assert!(!report.gave_up.contains(GaveUp::VOLUME_MISSED));
}

#[test]
fn a_band_pushes_only_at_its_edge() {
    let two = Two::new();
    let solver = two.solver();
    let modes = VolumeModes::new_checked(2, &LINEAR).unwrap();
    let mut state = InverseState::new(&solver);
    let band = Some((&modes, VolumeGoal::Band(REST / 2, REST * 2)));
    solver.tick(&goal(UNIT / 2, 0), band, &mut state).unwrap();
    assert_eq!(state.amplitudes()[..2], [ONE / 2, 0]);
    // q_1 + q_2 may be at most 1/4 now.
    let band = Some((&modes, VolumeGoal::Band(REST / 2, REST * 5 / 4)));
    solver.tick(&goal(UNIT / 2, 0), band, &mut state).unwrap();
    let [x, y] = [state.amplitudes()[0], state.amplitudes()[1]];
    let [want_x, want_y] = [ONE / 8 * 3, -ONE / 8];
    assert!(
        (x - want_x).abs() < 64 && (y - want_y).abs() < 64,
        "{x} {y}"
    );
}

#[test]
fn a_volume_out_of_reach_is_approached_and_said() {
    let two = Two::new();
    let solver = two.solver();
    let modes = VolumeModes::new_checked(2, &LINEAR).unwrap();
    let mut state = InverseState::new(&solver);
    let hold = Some((&modes, VolumeGoal::Hold(REST * 5)));
    for _ in 0..8 {
        let report = solver.tick(&goal(-UNIT, -UNIT), hold, &mut state).unwrap();
        assert!(report.gave_up.contains(GaveUp::VOLUME_MISSED));
    }
    assert_eq!(state.amplitudes()[..2], [ONE, ONE]);
    // A target that can be reached again is reached again.
    let hold = Some((&modes, VolumeGoal::Hold(REST)));
    for _ in 0..8 {
        solver.tick(&goal(UNIT / 2, 0), hold, &mut state).unwrap();
    }
    let x = state.amplitudes()[0];
    assert!((x - ONE / 4).abs() < 64, "{x}");
}

#[test]
fn without_a_gradient_the_volume_is_left_out() {
    let two = Two::new();
    let solver = two.solver();
    let nothing = [0; 10];
    let modes = VolumeModes::new_checked(2, &nothing).unwrap();
    let mut state = InverseState::new(&solver);
    let hold = Some((&modes, VolumeGoal::Hold(REST)));
    let report = solver.tick(&goal(UNIT / 2, 0), hold, &mut state).unwrap();
    assert!(
        report
            .gave_up
            .contains(GaveUp::ZERO_GRADIENT | GaveUp::VOLUME_MISSED)
    );
    assert_eq!(state.amplitudes()[..2], [ONE / 2, 0]);
}

#[test]
fn an_empty_band_is_said_and_its_middle_aimed_at() {
    let two = Two::new();
    let solver = two.solver();
    let modes = VolumeModes::new_checked(2, &LINEAR).unwrap();
    let mut state = InverseState::new(&solver);
    let band = Some((&modes, VolumeGoal::Band(REST + REST / 4, REST - REST / 4)));
    let report = solver.tick(&goal(UNIT / 2, 0), band, &mut state).unwrap();
    assert!(report.gave_up.contains(GaveUp::BAND_EMPTY));
    let x = state.amplitudes()[0];
    assert!((x - ONE / 4).abs() < 64, "{x}");
}

#[test]
fn a_step_that_would_lose_the_volume_is_refused_and_made_smaller() {
    // The volume is 1/16 + q_1^3 / 4: its slope at rest is zero but for 2^-24, and far off it is steep.
    let mut cubic = [0; 10];
    cubic[0] = 1 << 26;
    cubic[1] = 1 << 6;
    cubic[6] = 1 << 28;
    let two = Two::new();
    let solver = two.solver();
    let modes = VolumeModes::new_checked(2, &cubic).unwrap();
    let mut state = InverseState::new(&solver);
    state.set_amplitudes(&[ONE / 64, 0]);
    let held = modes.volume(&state.amplitudes()[..2]).unwrap();
    for _ in 0..16 {
        let hold = Some((&modes, VolumeGoal::Hold(held)));
        let report = solver
            .tick(&goal(UNIT, UNIT / 2), hold, &mut state)
            .unwrap();
        let off = (report.volume - held).unsigned_abs();
        assert!(off <= held.unsigned_abs() >> TOLERANCE_BITS);
        let volume = modes.volume(&state.amplitudes()[..2]).unwrap();
        assert_eq!(report.volume, volume);
    }
    let y = state.amplitudes()[1];
    assert!((y - ONE / 2).abs() < 64, "{y}");
}

#[test]
fn what_does_not_fit_is_an_error_and_changes_nothing() {
    let two = Two::new();
    let solver = two.solver();
    let mut state = InverseState::new(&solver);
    let before = state;
    let none: [[i32; 3]; 0] = [];
    let length = InverseError::Length {
        needed: 1,
        given: 0,
    };
    assert_eq!(solver.tick(&none, None, &mut state), Err(length));
    let three = VolumeModes::new_checked(1, &[0; 4]).unwrap();
    let modes = InverseError::Modes {
        needed: 2,
        given: 1,
    };
    let hold = Some((&three, VolumeGoal::Hold(0)));
    assert_eq!(solver.tick(&goal(0, 0), hold, &mut state), Err(modes));
    assert_eq!(state, before);
}

#[test]
fn unsound_parts_are_refused_by_name() {
    let two = Two::new();
    let sound = two.parts();
    assert_eq!(refused(sound), Ok(()));
    let lower: [i32; 0] = [];
    let parts = InverseParts {
        lower: &lower,
        ..sound
    };
    assert_eq!(refused(parts), Err(InverseError::Counts));
    let parts = InverseParts {
        upper: &[0],
        ..sound
    };
    assert_eq!(refused(parts), Err(InverseError::Layout));
    let parts = InverseParts {
        gain_shift: 32,
        ..sound
    };
    assert_eq!(refused(parts), Err(InverseError::Shift));
    let own = 1 << 28;
    for hessian in [
        [own, 1, 0, own],
        [own, own, own, 255],
        [own, 1 << 30, 1 << 30, own],
    ] {
        let parts = InverseParts {
            hessian: &hessian,
            ..sound
        };
        let refused = refused(parts);
        assert!(
            matches!(refused, Err(InverseError::Hessian { .. })),
            "{refused:?}"
        );
    }
    let parts = InverseParts {
        reciprocals: &[1 << 30, (1 << 30) - 1],
        ..sound
    };
    assert_eq!(
        refused(parts),
        Err(InverseError::Reciprocal { actuator: 1 })
    );
    let gains = [i32::MIN, 1, 0, 0, 0, 0];
    let parts = InverseParts {
        gains: &gains,
        ..sound
    };
    assert_eq!(refused(parts), Err(InverseError::Gains { actuator: 0 }));
    for (lower, rates) in [
        ([0, i32::MIN], [0; 2]),
        ([0, ONE + 1], [0; 2]),
        ([0; 2], [0, -1]),
    ] {
        let parts = InverseParts {
            lower: &lower,
            rates: &rates,
            ..sound
        };
        assert_eq!(refused(parts), Err(InverseError::Bounds { actuator: 1 }));
    }
}

#[test]
fn reciprocals_are_rounded_quotients() {
    // 2^(e+30) / h with 2^e <= h: 2^31 / 3 = 715827882.67, 2^32 / 5 = 858993459.2.
    assert_eq!(reciprocal(3), 715_827_883);
    assert_eq!(reciprocal(5), 858_993_459);
    assert_eq!(reciprocal(1 << 20), 1 << 30);
    // 2^60 / (2^31 - 1) is 2^29 and a quarter.
    assert_eq!(reciprocal(i32::MAX), 1 << 29);
    assert_eq!(reciprocal(0), 0);
}

/// Both ends of the band are cut to `2^62`: their sum has 64 bits, the middle has not.
#[test]
fn the_middle_of_an_empty_band_beyond_the_range_is_the_ranges_end() {
    let band = super::hold::Band::new(VolumeGoal::Band(i64::MAX, (1 << 62) + 5));
    assert!(band.is_empty);
    assert_eq!((band.low, band.high), (1 << 62, 1 << 62));
    let band = super::hold::Band::new(VolumeGoal::Band(7, i64::MIN));
    assert_eq!(band.low, (7 - (1 << 62)) >> 1);
}
