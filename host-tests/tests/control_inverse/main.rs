//! The goals' solver against the independent reference, bit for bit; against Clarabel, a desktop solver of quadratic
//! programs; and, with the volume held, against sequential quadratic programming with Clarabel inside.
//!
//! `OCTRUSS_CASES` sets how many cases; the default keeps the suite quick.

mod desktop;

use desktop::Program;
use octruss::control::inverse::{Inverse, InverseReport, InverseState, VolumeGoal};
use octruss::enclosed::VolumeModes;
use octruss_host_tests::random_inverse::{InverseCase, Likeness};
use octruss_host_tests::reference_control::Said;
use rand::RngExt as _;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng as _;

fn case_count(default: u64) -> u64 {
    let wanted = std::env::var("OCTRUSS_CASES").ok();
    wanted
        .and_then(|count| count.parse().ok())
        .unwrap_or(default)
}

fn said(report: &InverseReport) -> Said {
    Said {
        gave_up: report.gave_up.bits(),
        held: u32::from(report.held_back),
        sweeps: report.sweeps,
        evaluations: report.evaluations,
        volume: report.volume,
    }
}

#[test]
fn every_tick_has_the_bits_of_the_reference() {
    let mut reasons = 0;
    for seed in 0..case_count(600) {
        let case = InverseCase::any(seed, seed % 2 == 0);
        let reciprocals = case.reciprocals();
        let solver = Inverse::new_checked(case.parts(&reciprocals)).unwrap();
        let mut state = InverseState::new(&solver);
        let mut memory = case.table.memory();
        if let Some(start) = &case.start {
            state.set_amplitudes(start);
            memory.start_from(start);
        }
        let actuators = u16::try_from(case.table.actuators).unwrap();
        let modes = case.wanted.as_ref().map(|wanted| {
            let modes = VolumeModes::new_checked(actuators, &wanted.coefficients).unwrap();
            (modes, goal(wanted.low, wanted.high))
        });
        for (tick, goals) in case.goals.iter().enumerate() {
            let volume = modes.as_ref().map(|(modes, goal)| (modes, *goal));
            let report = solver.tick(goals, volume, &mut state).unwrap();
            let want = case.table.tick(goals, case.wanted.as_ref(), &mut memory);
            assert_eq!(said(&report), want, "seed {seed}, tick {tick}");
            let got: Vec<i128> = state.amplitudes().map(i128::from).to_vec();
            let (used, unused) = got.split_at(memory.amplitudes.len());
            assert_eq!(used, memory.amplitudes, "seed {seed}, tick {tick}");
            assert!(unused.iter().all(|own| *own == 0));
            reasons |= want.gave_up;
        }
    }
    // Every reason to give something up has been met.
    assert_eq!(reasons, 0xff);
}

fn goal(low: i64, high: i64) -> VolumeGoal {
    if low == high {
        VolumeGoal::Hold(low)
    } else {
        VolumeGoal::Band(low, high)
    }
}

/// Random problems without a volume: what the objective lacks of Clarabel's after some ticks, as a part of what the
/// best amplitudes gain over rest, is at most this.
const GAPS: [(u32, f64); 3] = [(1, 2e-2), (4, 1e-3), (32, 2e-4)];

#[test]
fn without_a_volume_it_reaches_the_objective_of_clarabel() {
    let count = case_count(1000);
    let mut worst = [0.0_f64; GAPS.len()];
    let mut sums = [0.0_f64; GAPS.len()];
    for seed in 0..count {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let likeness = Likeness {
            actuators: rng.random_range(1..=16),
            effectors: rng.random_range(1..=32),
            likeness: [0.0, 0.5, 1.0][rng.random_range(0..3)],
            volume: false,
        };
        let case = InverseCase::plausible(seed, likeness);
        let program = Program::new(&case);
        let rest = program.objective(&program.rest());
        let best = program.solve();
        let gain = rest - program.objective(&best);
        assert!(gain >= 0.0);
        let reciprocals = case.reciprocals();
        let solver = Inverse::new_checked(case.parts(&reciprocals)).unwrap();
        let mut state = InverseState::new(&solver);
        let mut ticks = 0;
        for (place, (wanted, _)) in GAPS.iter().enumerate() {
            while ticks < *wanted {
                solver.tick(&case.goals[0], None, &mut state).unwrap();
                ticks += 1;
            }
            assert!(program.is_inside(state.amplitudes()), "seed {seed}");
            let found = program.real(state.amplitudes());
            let gap = (program.objective(&found) - program.objective(&best)) / gain.max(1e-9);
            worst[place] = worst[place].max(gap);
            sums[place] += gap;
        }
    }
    for (((ticks, bound), worst), sum) in GAPS.iter().zip(worst).zip(sums) {
        let mean = sum / count as f64;
        println!("{count} problems, {ticks} ticks: gap {worst:.1e} at most, {mean:.1e} on average");
        assert!(worst <= *bound, "after {ticks} ticks {worst:e}");
    }
}

#[test]
fn with_a_volume_it_reaches_the_objective_of_sequential_programming() {
    // Among the first thirty are some whose volume curves more than their objective.
    let count = case_count(60).min(1000);
    let (mut worst_gap, mut worst_volume, mut worst_residual) = (0.0_f64, 0.0_f64, 0.0_f64);
    let (mut feasible, mut better, mut elsewhere) = (0, 0, 0);
    for seed in 0..count {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let likeness = Likeness {
            actuators: rng.random_range(2..=16),
            effectors: rng.random_range(2..=32),
            likeness: [0.0, 0.5][rng.random_range(0..2)],
            volume: true,
        };
        let case = InverseCase::plausible(seed, likeness);
        let wanted = case.wanted.as_ref().unwrap();
        let program = Program::new(&case);
        let found = (0..10).filter_map(|_| program.solve_with_volume(&mut rng));
        let best = found.min_by(|a, b| program.objective(a).total_cmp(&program.objective(b)));
        let Some(best) = best else {
            continue;
        };
        feasible += 1;
        let reciprocals = case.reciprocals();
        let solver = Inverse::new_checked(case.parts(&reciprocals)).unwrap();
        let actuators = u16::try_from(case.table.actuators).unwrap();
        let modes = VolumeModes::new_checked(actuators, &wanted.coefficients).unwrap();
        let mut state = InverseState::new(&solver);
        for _ in 0..64 {
            let hold = Some((&modes, VolumeGoal::Hold(wanted.low)));
            solver.tick(&case.goals[0], hold, &mut state).unwrap();
            assert!(program.is_inside(state.amplitudes()), "seed {seed}");
        }
        let own = program.real(state.amplitudes());
        let gain = program.objective(&program.rest()) - program.objective(&best);
        let gap = (program.objective(&own) - program.objective(&best)) / gain.abs().max(1e-9);
        let volume = (program.volume(&own) / program.target() - 1.0).abs();
        let residual = program.residual(&own);
        println!(
            "seed {seed}: {} actuators, gap {gap:.1e}, volume off by {volume:.1e}, residual {residual:.1e}",
            case.table.actuators
        );
        // The problem is not convex: another place that satisfies the optimality conditions is an answer too.
        if gap > 1e-4 && residual < 1e-6 {
            elsewhere += 1;
        } else {
            worst_gap = worst_gap.max(gap);
        }
        worst_volume = worst_volume.max(volume);
        worst_residual = worst_residual.max(residual);
        better += u32::from(gap < -1e-6);
    }
    println!(
        "{feasible} of {count} problems have a feasible point by ten starts; {better} better than the best of them, \
         {elsewhere} at another local minimum; worst: gap {worst_gap:.1e}, volume {worst_volume:.1e}, residual {worst_residual:.1e}"
    );
    assert!(feasible > 0);
    assert!(elsewhere * 200 <= feasible);
    assert!(worst_volume <= 1e-4);
    assert!(worst_gap <= 1e-4);
    assert!(worst_residual <= 2.5e-4);
}
