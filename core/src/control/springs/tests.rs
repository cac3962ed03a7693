//! Figures by hand; the reference of the host's tests takes every bit.

#![expect(clippy::unwrap_used, reason = "tests may stop")]

use super::*;

const FREE: PointData = PointData {
    mobility: FACTOR_ONE,
    anchor: 0,
};
const PINNED: PointData = PointData {
    mobility: 0,
    anchor: 0,
};

/// A spring from point 0 to point 1, of this length in coordinates' last places.
fn spring(length: u32, share: u32, stretch: u32, shape: u32) -> Spring {
    Spring {
        points: [0, 1],
        length: length << STATE_BITS,
        length_shift: 0,
        share,
        stretch,
        shape,
    }
}

fn parts<'a>(points: &'a [PointData], springs: &'a [Spring]) -> SpringsParts<'a> {
    SpringsParts {
        points,
        springs,
        substeps: 1,
        drag: 0,
        damping: 0,
        push_shift: STATE_BITS,
        gravity: [0; 3],
    }
}

fn tick(
    parts: SpringsParts<'_>,
    drive: &Drive<'_, i32>,
    state: &mut [PointState; 2],
) -> [[i32; 3]; 2] {
    let springs = Springs::new_checked(parts).unwrap();
    let mut pose = [[0; 3]; 2];
    springs.tick(drive, state, &mut pose).unwrap();
    pose
}

/// A hanging pair: 3-4-5, stretched to twice its length, both ends equally heavy.
#[test]
fn a_stretched_spring_by_hand() {
    let points = [FREE; 2];
    let goals = [[0, 0, 0], [3000, 4000, 0]];
    let drive = Drive {
        goals: &goals,
        pushes: &[],
        obstacles: &[],
    };
    let springs = [spring(5000, FACTOR_ONE / 2, FACTOR_ONE, 0)];
    let far = [PointState::at([0; 3]), PointState::at([6000, 8000, 0])];
    // All of what it is too long by, half to each end; the velocity goes on in the next tick.
    let mut state = far;
    let pose = tick(parts(&points, &springs), &drive, &mut state);
    assert_eq!(pose, [[1500, 2000, 0], [4500, 6000, 0]]);
    assert_eq!(state[0].velocity(), [1500 << 12, 2000 << 12, 0]);
    // A quarter of it, and all of that to the second end: the first is pinned.
    let points = [PINNED, FREE];
    let springs = [spring(5000, 0, FACTOR_ONE / 4, 0)];
    let pose = tick(parts(&points, &springs), &drive, &mut far.clone());
    assert_eq!(pose, [[0; 3], [5250, 7000, 0]]);
    // A spring of shape alone takes the direction back too.
    let springs = [spring(5000, 0, 0, FACTOR_ONE / 2)];
    let mut turned = [PointState::at([0; 3]), PointState::at([0, 0, 5000])];
    let pose = tick(parts(&points, &springs), &drive, &mut turned);
    assert_eq!(pose, [[0; 3], [1500, 2000, 2500]]);
    // Two ends in one place leave along the goal.
    let springs = [spring(5000, 0, FACTOR_ONE, 0)];
    let mut fallen = [PointState::at([0; 3]); 2];
    let pose = tick(parts(&points, &springs), &drive, &mut fallen);
    assert_eq!(pose, [[0; 3], [3000, 4000, 0]]);
}

#[test]
fn pushes_gravity_and_drag_by_hand() {
    let points = [FREE, PINNED];
    let mut parts = parts(&points, &[]);
    parts.drag = FACTOR_ONE / 4;
    parts.gravity = [0, 0, -(8 << 12)];
    let goals = [[0, 0, 100], [5, 0, 0]];
    let mut drive = Drive {
        goals: &goals,
        pushes: &[[16, 0, 0], [16, 0, 0]],
        obstacles: &[],
    };
    let mut state = goals.map(PointState::at);
    assert_eq!(tick(parts, &drive, &mut state), [[16, 0, 92], [5, 0, 0]]);
    drive.pushes = &[];
    // A quarter of 16 and of -8 is lost, then gravity acts.
    assert_eq!(tick(parts, &drive, &mut state), [[28, 0, 78], [5, 0, 0]]);
    // A plane at 77 with all the grip there is.
    let plane = Shape::Plane {
        point: [9, 9, 77],
        normal: [0, 0, 1 << 16],
    };
    let obstacles = [Obstacle {
        shape: plane,
        grip: FACTOR_ONE,
    }];
    drive.obstacles = &obstacles;
    assert_eq!(tick(parts, &drive, &mut state), [[28, 0, 77], [5, 0, 0]]);
}

#[test]
fn balls_and_capsules_by_hand() {
    let points = [FREE; 2];
    let parts = parts(&points, &[]);
    let goals = [[0; 3]; 2];
    let contact = |shape: Shape<i32>, places: [[i32; 3]; 2]| {
        let obstacles = [Obstacle { shape, grip: 0 }];
        let drive = Drive {
            goals: &goals,
            pushes: &[],
            obstacles: &obstacles,
        };
        tick(parts, &drive, &mut places.map(PointState::at))
    };
    let ball = Shape::Sphere {
        centre: [10, 0, 0],
        radius: 500,
    };
    let pose = contact(ball, [[310, 0, 0], [10, 0, 0]]);
    assert_eq!(pose, [[510, 0, 0], [10, 0, 500]]);
    let outside = [[510, 0, 0], [-490, 0, 0]];
    assert_eq!(contact(ball, outside), outside);
    let capsule = Shape::Capsule {
        ends: [[0, 0, 0], [1000, 0, 0]],
        radius: 100,
    };
    let pose = contact(capsule, [[250, 0, 50], [1050, 0, 0]]);
    assert_eq!(pose, [[250, 0, 100], [1100, 0, 0]]);
    let pose = contact(capsule, [[-30, -40, 0], [250, 101, 0]]);
    assert_eq!(pose, [[-60, -80, 0], [250, 101, 0]]);
}

#[test]
fn a_motion_that_nothing_drives_ends() {
    let points = [FREE; 2];
    let goals = [[0; 3]; 2];
    let drive = Drive {
        goals: &goals,
        pushes: &[],
        obstacles: &[],
    };
    let mut state = [PointState::new([0; 3], [3, -2, 1000]); 2];
    for _ in 0..1000 {
        tick(parts(&points, &[]), &drive, &mut state);
    }
    assert_eq!(state[0].velocity(), [0; 3]);
    // 2 + 1, 1, and 999 + 998 + ... + 1.
    assert_eq!(state[0].position(), [3, -1, 499_500]);
}

#[test]
fn lengths_by_hand() {
    let of = |vector| {
        let length = length(vector);
        (length.shift, length.length)
    };
    assert_eq!(of([0; 3]), (0, 0));
    assert_eq!(of([3, -4, 0]), (0, 5));
    // The square root of 3 is 1.73, of 2 is 1.41.
    assert_eq!(of([1, 1, 1]), (0, 2));
    assert_eq!(of([1, 0, -1]), (0, 1));
    assert_eq!(of([1 << 30, 0, 0]), (1, 1 << 29));
    assert_eq!(of([(1 << 30) - 1, 0, 0]), (0, (1 << 30) - 1));
    assert_eq!(of([(1 << 31) - 1, 0, 0]), (1, 1 << 30));
}

#[test]
fn what_is_unsound_is_refused() {
    let points = [FREE, PINNED, PINNED];
    let sound = spring(5, FACTOR_ONE, 1, 1);
    fn check(parts: SpringsParts<'_>) -> Result<(), SpringsError> {
        Springs::new_checked(parts).map(|_| ())
    }
    assert_eq!(check(parts(&points, &[sound])), Ok(()));
    let unsound = [
        Spring {
            points: [0, 3],
            ..sound
        },
        Spring {
            points: [0, 0],
            ..sound
        },
        Spring {
            points: [1, 2],
            ..sound
        },
        Spring { share: 1, ..sound },
        Spring {
            stretch: FACTOR_ONE,
            ..sound
        },
        Spring {
            length_shift: 16,
            ..sound
        },
        Spring {
            length: (1 << 31) + 1,
            ..sound
        },
    ];
    for spring in unsound {
        let springs = [sound, spring];
        let error = Err(SpringsError::Spring { spring: 1 });
        assert_eq!(check(parts(&points, &springs)), error, "{spring:?}");
    }
    let heavy = [
        FREE,
        PointData {
            mobility: FACTOR_ONE + 1,
            anchor: 0,
        },
    ];
    assert_eq!(
        check(parts(&heavy, &[])),
        Err(SpringsError::Point { point: 1 })
    );
    let mut settings = parts(&points, &[]);
    settings.substeps = 0;
    assert_eq!(check(settings), Err(SpringsError::Settings));
    settings.substeps = 1;
    settings.gravity = [0, 0, i64::MIN];
    assert_eq!(check(settings), Err(SpringsError::Settings));
    let springs = Springs::new_checked(parts(&points, &[])).unwrap();
    let goals = [[0; 3]; 3];
    let mut drive = Drive {
        goals: &goals,
        pushes: &[[0; 3]],
        obstacles: &[],
    };
    let mut state = [PointState::default(); 3];
    let error = springs.tick(&drive, &mut state, &mut [[0_i32; 3]; 3]);
    assert_eq!(
        error,
        Err(SpringsError::Length {
            needed: 3,
            given: 1
        })
    );
    let long = Shape::Plane {
        point: [0; 3],
        normal: [1 << 16, 1 << 9, 0],
    };
    let obstacles = [Obstacle {
        shape: long,
        grip: 0,
    }];
    (drive.pushes, drive.obstacles) = (&[], &obstacles);
    let error = springs.tick(&drive, &mut state, &mut [[0_i32; 3]; 3]);
    assert_eq!(error, Err(SpringsError::Obstacle { obstacle: 0 }));
}
