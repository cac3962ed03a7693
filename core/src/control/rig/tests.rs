//! Figures by hand and by double precision; the reference of the host's tests takes every bit.

#![expect(
    clippy::as_conversions,
    clippy::indexing_slicing,
    clippy::unwrap_used,
    reason = "tests may stop, and compare with real numbers"
)]

use super::*;

const ONE_POINT: Influence = Influence {
    joint: 0,
    weight: WEIGHT_ONE,
};

fn joint(parent: u32, pivot: [i32; 3], axis: [i32; 3]) -> Joint {
    Joint {
        parent,
        pivot,
        axis,
    }
}

/// The bound of the documentation against double precision, whose error is a millionth of it.
#[test]
fn sine_and_cosine_are_within_a_unit() {
    let mut worst = 0.0_f64;
    for step in 0..400_000_u32 {
        let angle = step.wrapping_mul(0x9e37_79b9).cast_signed();
        let (sine, cosine) = turn(angle);
        let real = f64::from(angle) * core::f64::consts::TAU / 4_294_967_296.0;
        for (got, want) in [(sine, libm::sin(real)), (cosine, libm::cos(real))] {
            worst = worst.max((f64::from(got) - want * 1_073_741_824.0).abs());
        }
    }
    assert!(worst <= 1.0, "{worst}");
}

#[test]
fn quarter_turns_are_exact() {
    let quarters = [(0, ONE), (ONE, 0), (0, -ONE), (-ONE, 0)];
    for (quarter, want) in (0..4_i32).zip(quarters) {
        assert_eq!(turn(quarter.wrapping_shl(30)), want);
    }
}

/// An arm along x: shoulder at the origin, elbow at 100, both turning about z, the hand at 150.
#[test]
fn an_arm_by_hand() {
    let joints = [
        joint(NO_PARENT, [0; 3], [0, 0, ONE]),
        joint(0, [100, 0, 0], [0, 0, ONE]),
    ];
    let rest = [[50, 0, 0], [150, 0, 7], [100, 0, 0], [9, 9, 9]];
    let half = WEIGHT_ONE / 2;
    let influences = [
        ONE_POINT,
        Influence {
            joint: 1,
            weight: WEIGHT_ONE,
        },
        Influence {
            joint: 0,
            weight: half,
        },
        Influence {
            joint: 1,
            weight: half,
        },
    ];
    let parts = RigParts {
        joints: &joints,
        rest: &rest,
        starts: &[0, 1, 2, 4, 4],
        influences: &influences,
    };
    let rig = Rig::new_checked(parts).unwrap();
    let mut frames = [Frame::default(); 2];
    let mut pose = [[-1; 3]; 4];
    let mut carry = |angles: [i32; 2], base: [i32; 3]| {
        assert_eq!(rig.carry(&angles, base, &mut frames, &mut pose), Ok(0));
        pose
    };
    let untouched = [-1; 3];
    assert_eq!(
        carry([0, 0], [0; 3]),
        [rest[0], rest[1], rest[2], untouched]
    );
    let raised = [[0, 50, 0], [0, 150, 7], [0, 100, 0], untouched];
    assert_eq!(carry([QUARTER_TURN, 0], [0; 3]), raised);
    let bent = [[1, 52, 3], [51, 102, 10], [1, 102, 3], untouched];
    assert_eq!(carry([QUARTER_TURN, -QUARTER_TURN], [1, 2, 3]), bent);
    // A full turn is none.
    assert_eq!(carry([i32::MIN, i32::MIN], [0; 3])[0], [-50, 0, 0]);
}

#[test]
fn the_longest_chain_of_the_longest_bones_fits() {
    // Every bone crosses the whole range, and all are stretched out in one line by half turns.
    let ends = [[i32::MIN; 3], [i32::MAX; 3]];
    // A unit vector at right angles to the diagonal: (1, -1, 0) / sqrt 2.
    let axis = [759_250_125, -759_250_125, 0];
    let joints: [Joint; JOINTS_AT_MOST] = core::array::from_fn(|place| {
        let parent = place
            .checked_sub(1)
            .map_or(NO_PARENT, |parent| parent as u32);
        joint(parent, ends[place % 2], axis)
    });
    let rest = [[i32::MAX; 3]; 1];
    let last = [Influence {
        joint: 254,
        weight: WEIGHT_ONE,
    }];
    let parts = RigParts {
        joints: &joints,
        rest: &rest,
        starts: &[0, 1],
        influences: &last,
    };
    let rig = Rig::new_checked(parts).unwrap();
    let mut frames = [Frame::default(); JOINTS_AT_MOST];
    let mut pose = [[0; 3]; 1];
    let saturated = rig
        .carry(
            &[i32::MIN; JOINTS_AT_MOST],
            [i32::MIN; 3],
            &mut frames,
            &mut pose,
        )
        .unwrap();
    assert_eq!((saturated, pose[0]), (3, [i32::MIN; 3]));
    // 254 bones of 2^32, and as much from the pivot and the base, within what 254 roundings can do.
    let reach = frames[254].pivot[0] as f64;
    let straight = 255.0 * 4_294_967_295.0 * 256.0;
    assert!(
        (reach + straight).abs() < straight * 1e-5,
        "{reach} {straight}"
    );
}

#[test]
fn what_is_unsound_is_refused() {
    let joints = [joint(NO_PARENT, [0; 3], [0, 0, ONE])];
    let sound = RigParts {
        joints: &joints,
        rest: &[[0; 3]],
        starts: &[0, 1],
        influences: &[ONE_POINT],
    };
    let check = |parts| Rig::new_checked(parts).map(|_| ());
    assert_eq!(check(sound), Ok(()));
    let parent = [joint(0, [0; 3], [0; 3])];
    let axis = [joint(NO_PARENT, [0; 3], [0, 0, ONE - 2])];
    let short = [Influence {
        joint: 0,
        weight: WEIGHT_ONE - 1,
    }];
    let missing = [Influence {
        joint: 1,
        weight: WEIGHT_ONE,
    }];
    let cases = [
        (
            RigParts {
                joints: &[],
                ..sound
            },
            RigError::Joints,
        ),
        (
            RigParts {
                joints: &parent,
                ..sound
            },
            RigError::Parent { joint: 0 },
        ),
        (
            RigParts {
                joints: &axis,
                ..sound
            },
            RigError::Axis { joint: 0 },
        ),
        (
            RigParts {
                starts: &[0],
                ..sound
            },
            RigError::Layout,
        ),
        (
            RigParts {
                starts: &[0, 2],
                ..sound
            },
            RigError::Layout,
        ),
        (
            RigParts {
                influences: &short,
                ..sound
            },
            RigError::Weights { point: 0 },
        ),
        (
            RigParts {
                influences: &missing,
                ..sound
            },
            RigError::Influence { point: 0 },
        ),
    ];
    for (parts, error) in cases {
        assert_eq!(check(parts), Err(error));
    }
    let rig = Rig::new_checked(sound).unwrap();
    let error = rig.carry(&[0], [0; 3], &mut [], &mut [[0; 3]]);
    assert_eq!(
        error,
        Err(RigError::Length {
            needed: 1,
            given: 0
        })
    );
}
