//! The crate's springs against the independent reference, bit for bit, on random springs, states, pushes
//! and obstacles up to the ends of every range, and what must hold of them: rest is a fixed point,
//! nothing runs away, and a shaken mesh comes back to the very bits of rest.
//!
//! `OCTRUSS_CASES` sets how many cases; the default keeps the suite quick. An hour of simulated time is
//! `--ignored`: `cargo xtask verify` runs it.

use octruss::control::springs::{
    Drive, Obstacle, PointData, PointState, Shape, Spring, Springs, SpringsParts,
};
use octruss_host_tests::qemu::conformance::on_host;
use octruss_host_tests::qemu::judge::{Subject, Verdict};
use octruss_host_tests::random_springs::SpringsCase;
use octruss_host_tests::reference_springs::{ObstacleData, rest_length};
use octruss_host_tests::shaken_block::{SECOND, SECONDS_A_SHAKE, block, shakes};
use rand::RngExt as _;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng as _;

fn case_count() -> u32 {
    let wanted = std::env::var("OCTRUSS_CASES").ok();
    wanted.and_then(|count| count.parse().ok()).unwrap_or(300)
}

/// Core on this machine by the very function that runs on the devices.
fn judge(subject: Subject, cases: u32) {
    let cases: Vec<_> = (0..cases).map(|seed| subject.case(seed)).collect();
    let sent: Vec<_> = cases.iter().map(|judged| judged.case.clone()).collect();
    let verdict = Verdict::of(&cases, &on_host(&sent), None);
    println!("{subject}: {verdict}");
    assert!(verdict.mismatches.is_empty(), "{verdict}");
    assert!(verdict.coordinates > 0);
}

#[test]
fn ticks_equal_the_reference() {
    judge(Subject::Springs, case_count());
}

#[test]
fn shakes_equal_the_reference() {
    judge(Subject::Shakes, case_count() / 10);
}

/// Core's springs over a case's data.
struct Core {
    points: Vec<PointData>,
    springs: Vec<Spring>,
    case: SpringsCase,
    state: Vec<PointState>,
    pose: Vec<[i32; 3]>,
}

impl Core {
    fn new(case: SpringsCase) -> Self {
        let points = case.data.points.iter();
        let points = points.map(|&[mobility, anchor]| PointData { mobility, anchor });
        let springs = case.data.springs.iter().map(|spring| Spring {
            points: spring.ends.map(|end| u16::try_from(end).unwrap()),
            length: spring.length,
            length_shift: spring.shift,
            share: spring.factors[0],
            stretch: spring.factors[1],
            shape: spring.factors[2],
        });
        let state = case.state.iter();
        Self {
            points: points.collect(),
            springs: springs.collect(),
            state: state
                .map(|&[place, velocity]| PointState::new(place, velocity))
                .collect(),
            pose: case.goals.clone(),
            case,
        }
    }

    fn tick(&mut self, pushes: &[[i32; 3]]) -> u32 {
        let data = &self.case.data;
        let springs = Springs::new_checked(SpringsParts {
            points: &self.points,
            springs: &self.springs,
            substeps: data.substeps,
            drag: data.drag,
            damping: data.damping,
            push_shift: data.push_shift,
            gravity: data.gravity,
        });
        let obstacles: Vec<Obstacle<i32>> = self.case.obstacles.iter().map(obstacle).collect();
        let drive = Drive {
            goals: &self.case.goals,
            pushes,
            obstacles: &obstacles,
        };
        springs
            .unwrap()
            .tick(&drive, &mut self.state, &mut self.pose)
            .unwrap()
    }
}

fn obstacle(data: &ObstacleData) -> Obstacle<i32> {
    let (shape, grip) = match *data {
        ObstacleData::Plane(point, normal, grip) => (Shape::Plane { point, normal }, grip),
        ObstacleData::Sphere(centre, radius, grip) => (Shape::Sphere { centre, radius }, grip),
        ObstacleData::Capsule(ends, radius, grip) => (Shape::Capsule { ends, radius }, grip),
    };
    Obstacle { shape, grip }
}

/// Shakes a block for so long. After every shake it must come back to the bits of rest,
/// without a coordinate at the end of its range. Prints how far it went and how long it took.
fn shaken_block(counts: [i32; 3], seconds: u32) {
    let mut core = Core::new(block(counts));
    let rest = core.case.goals.clone();
    let mut shakes = shakes(seconds);
    let mut pushes = vec![[0; 3]; rest.len()];
    let (mut farthest, mut slowest, mut returns, mut restless) = (0, 0, 0, 0);
    let mut back = 0;
    for tick in 0..shakes.ticks {
        shakes.shake(tick, &mut pushes);
        assert_eq!(
            core.tick(&pushes),
            0,
            "a coordinate was clamped at tick {tick}"
        );
        let within = tick % shakes.period;
        let away = core.pose.as_flattened().iter().zip(rest.as_flattened());
        farthest = farthest.max(away.map(|(a, b)| a.abs_diff(*b)).max().unwrap());
        if core.pose != rest {
            back = within + 1;
        }
        if within == shakes.period - 1 {
            assert_eq!(core.pose, rest, "not back at tick {tick}");
            let velocities = core.state.iter().flat_map(PointState::velocity);
            restless = restless.max(velocities.map(i64::abs).max().unwrap());
            slowest = slowest.max(back - shakes.shaken);
            returns += 1;
        }
    }
    println!(
        "{} points, {} springs, {seconds} s: {returns} shakes of up to {:.1} mm, back to the bits of rest \
         after at most {:.2} s and then no faster than {:.3} units in the last place a substep, 0 \
         coordinates clamped",
        rest.len(),
        core.springs.len(),
        f64::from(farthest) / 4_194_304.0,
        f64::from(slowest) / f64::from(SECOND),
        restless as f64 / 4096.0,
    );
    // Calm below a unit in the last place: what is left cannot be seen in any pose.
    assert!(restless < 4096, "{restless}");
    assert_eq!(returns, seconds / SECONDS_A_SHAKE);
}

#[test]
fn two_minutes_of_shakes() {
    shaken_block([3, 3, 4], 120);
}

#[test]
#[ignore = "an hour of simulated time: cargo xtask verify"]
fn an_hour_of_shakes() {
    shaken_block([3, 3, 4], 3600);
}

/// Wherever the points are, turned inside out, flat or at the ends of the range, with whatever velocity:
/// they come back to rest. The springs' shape is two fifths of their stretch here; at a tenth, one of a hundred
/// of these states stayed folded.
#[test]
fn nothing_is_stuck() {
    let mut rng = ChaCha8Rng::seed_from_u64(43);
    for round in 0..case_count() / 10 {
        let mut case = block([3, 2, 3]);
        case.obstacles.clear();
        for spring in &mut case.data.springs {
            spring.factors[2] = 13_107;
        }
        let reach = i64::MAX >> rng.random_range(20..40);
        for state in &mut case.state {
            *state = match round % 4 {
                0 => [[0; 3], [0; 3]],
                1 => [state[0].map(|value| -value), [0; 3]],
                _ => [[0; 3]; 2]
                    .map(|three: [i64; 3]| three.map(|_| rng.random_range(-reach..=reach))),
            };
        }
        let mut core = Core::new(case);
        let calm = vec![[0; 3]; core.pose.len()];
        let rest = core.case.goals.clone();
        let back = (0..4000).find(|_| {
            core.tick(&calm);
            core.pose == rest
        });
        assert!(back.is_some(), "round {round}: still away after 80 s");
    }
}

/// At rest nothing moves, to the last bit of the state.
#[test]
fn rest_is_a_fixed_point() {
    for seed in 0..case_count() {
        let mut case = SpringsCase::new(u64::from(seed), 16, 1);
        case.obstacles.clear();
        case.data.gravity = [0; 3];
        let wide = |place: [i32; 3]| place.map(|value| i64::from(value) << 12);
        case.state = case
            .goals
            .iter()
            .map(|&goal| [wide(goal), [0; 3]])
            .collect();
        for spring in &mut case.data.springs {
            let [a, b] = spring.ends.map(|end| case.goals[end]);
            (spring.length, spring.shift) = rest_length(a, b);
        }
        let mut core = Core::new(case);
        let before = core.state.clone();
        assert_eq!(core.tick(&[]), 0);
        assert_eq!(core.state, before, "seed {seed}");
        assert_eq!(core.pose, core.case.goals, "seed {seed}");
    }
}
