//! The crate's rig against the independent reference, bit for bit, on random rigs and angles up to the
//! ends of the coordinate range, and its invariances.
//!
//! `OCTRUSS_CASES` sets how many cases; the default keeps the suite quick.

use num_bigint::BigInt;
use octruss::control::rig::{Frame, Influence, Joint, NO_PARENT, Rig, RigParts, turn};
use octruss_host_tests::random_rig::RigCase;
use octruss_host_tests::reference_rig::{RigData, Turns};
use rand::RngExt as _;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng as _;

/// What guards a buffer's end.
const GUARD: [i32; 3] = [0x5afe_5afe; 3];

fn case_count() -> u64 {
    let wanted = std::env::var("OCTRUSS_CASES").ok();
    wanted.and_then(|count| count.parse().ok()).unwrap_or(400)
}

/// A rig's parts, owned, in the layout that the crate takes.
struct Layout {
    joints: Vec<Joint>,
    starts: Vec<u32>,
    influences: Vec<Influence>,
}

impl Layout {
    fn new(rig: &RigData) -> Self {
        let joints = rig.joints.iter().map(|joint| Joint {
            parent: joint.parent.map_or(NO_PARENT, |parent| parent as u32),
            pivot: joint.pivot,
            axis: joint.axis,
        });
        let mut layout = Self {
            joints: joints.collect(),
            starts: vec![0],
            influences: Vec::new(),
        };
        for influences in &rig.influences {
            let own = influences.iter();
            let own = own.map(|&(joint, weight)| Influence { joint, weight });
            layout.influences.extend(own);
            layout.starts.push(layout.influences.len() as u32);
        }
        layout
    }

    fn parts<'a>(&'a self, rig: &'a RigData) -> RigParts<'a> {
        RigParts {
            joints: &self.joints,
            rest: &rig.rest,
            starts: &self.starts,
            influences: &self.influences,
        }
    }
}

/// What the crate makes of a case, with guards behind the pose.
fn run(case: &RigCase) -> (Vec<Frame>, Vec<[i32; 3]>, u32) {
    let layout = Layout::new(&case.rig);
    let rig = Rig::new_checked(layout.parts(&case.rig)).unwrap();
    let mut frames = vec![Frame::default(); rig.joints()];
    let mut pose = case.pose.clone();
    pose.push(GUARD);
    let length = case.pose.len();
    let saturated = rig.carry(&case.angles, case.base, &mut frames, &mut pose[..length]);
    assert_eq!(pose.pop(), Some(GUARD));
    (frames, pose, saturated.unwrap())
}

#[test]
fn frames_and_points_equal_the_reference() {
    let turns = Turns::new();
    let (mut points, mut clamped) = (0, 0);
    for seed in 0..case_count() {
        let case = RigCase::new(seed, 40, 60);
        let (frames, pose, saturated) = run(&case);
        let placed = case.rig.frames(&turns, &case.angles, case.base);
        for (joint, (frame, want)) in frames.iter().zip(&placed).enumerate() {
            let rotation = frame.rotation.map(|row| row.map(BigInt::from));
            assert_eq!(rotation, want.rotation, "seed {seed}, joint {joint}");
            assert_eq!(
                frame.pivot.map(BigInt::from),
                want.pivot,
                "seed {seed}, joint {joint}"
            );
        }
        let (want, want_clamped) = case.rig.carry(&placed, &case.pose);
        assert_eq!(pose, want, "seed {seed}");
        assert_eq!(saturated, want_clamped, "seed {seed}");
        points += pose.len();
        clamped += saturated;
    }
    println!(
        "{} cases, {points} control points, {clamped} coordinates clamped, 0 mismatches",
        case_count()
    );
    assert!(clamped > 0);
}

#[test]
fn sines_and_cosines_equal_the_reference() {
    let turns = Turns::new();
    let mut rng = ChaCha8Rng::seed_from_u64(40);
    let edges = (-16..16_i32)
        .flat_map(|eighth| (-3..=3).map(move |near| (eighth << 28).wrapping_add(near)));
    let random = (0..20 * case_count()).map(|_| rng.random());
    for angle in edges.chain(random) {
        let (sine, cosine) = turn(angle);
        assert_eq!(
            [sine, cosine].map(BigInt::from),
            turns.of(angle),
            "angle {angle}"
        );
    }
}

/// Moving the base, or the whole rig at rest, moves every carried point by as much, to the bit.
#[test]
fn translations_are_exact() {
    let mut rng = ChaCha8Rng::seed_from_u64(41);
    let mut moved = 0;
    for seed in 0..case_count() {
        let mut case = RigCase::new(seed, 12, 20);
        let small = |point: &mut [i32; 3]| *point = point.map(|value| value / 4096);
        case.rig.rest.iter_mut().for_each(small);
        case.rig
            .joints
            .iter_mut()
            .for_each(|joint| small(&mut joint.pivot));
        small(&mut case.base);
        let (_, still, saturated) = run(&case);
        assert_eq!(saturated, 0);
        let shift = [0; 3].map(|_: i32| rng.random_range(-(1 << 28)..1 << 28));
        let shifted = |point: [i32; 3]| [0, 1, 2].map(|axis| point[axis] + shift[axis]);
        let mut by_base = case.clone();
        by_base.base = shifted(case.base);
        let mut by_rest = case.clone();
        by_rest
            .rig
            .rest
            .iter_mut()
            .for_each(|point| *point = shifted(*point));
        by_rest
            .rig
            .joints
            .iter_mut()
            .for_each(|joint| joint.pivot = shifted(joint.pivot));
        let carried = case
            .rig
            .influences
            .iter()
            .map(|influences| !influences.is_empty());
        let want: Vec<[i32; 3]> = still
            .iter()
            .zip(carried)
            .map(|(&point, carried)| if carried { shifted(point) } else { point })
            .collect();
        assert_eq!(run(&by_base).1, want, "seed {seed}");
        assert_eq!(run(&by_rest).1, want, "seed {seed}");
        moved += want.len();
    }
    assert!(moved > 0);
}

/// However often the angles change, the same angles give the same bits: nothing is carried over.
#[test]
fn nothing_drifts() {
    let case = RigCase::new(7, 31, 204);
    let layout = Layout::new(&case.rig);
    let rig = Rig::new_checked(layout.parts(&case.rig)).unwrap();
    let mut frames = vec![Frame::default(); rig.joints()];
    let mut pose = case.pose.clone();
    rig.carry(&case.angles, case.base, &mut frames, &mut pose)
        .unwrap();
    let first = (frames.clone(), pose.clone());
    let mut rng = ChaCha8Rng::seed_from_u64(42);
    let mut angles = case.angles.clone();
    for _ in 0..2000 {
        angles.iter_mut().for_each(|angle| *angle = rng.random());
        rig.carry(&angles, [0; 3], &mut frames, &mut pose).unwrap();
    }
    rig.carry(&case.angles, case.base, &mut frames, &mut pose)
        .unwrap();
    assert_eq!((&frames, &pose), (&first.0, &first.1));
    // Angles of zero are the rest cage.
    angles.fill(0);
    rig.carry(&angles, [0; 3], &mut frames, &mut pose).unwrap();
    let carried = case
        .rig
        .influences
        .iter()
        .zip(case.rig.rest.iter().zip(&pose));
    for (influences, (rest, point)) in carried {
        assert!(influences.is_empty() || rest == point);
    }
}
