//! Expected figures are worked out by hand from `rest + floor(sum / 2^30 + 1/2)`.

#![allow(
    clippy::indexing_slicing,
    clippy::unwrap_used,
    reason = "tests may stop"
)]

use super::{Actuation, ActuationError, ActuationParts};

const ONE: i32 = 1 << 30;
const REST: [[i32; 3]; 2] = [[10, -20, 30], [i32::MAX - 1, i32::MIN, 0]];
/// Two actuators: x of both, y of both, z of both, for each point.
const DISPLACEMENTS: [i32; 12] = [4, 1, 0, -3, 7, 0, 2, 0, -1, 0, 0, i32::MIN];

fn parts(rows: &[u32]) -> ActuationParts<'_> {
    ActuationParts {
        actuators: 2,
        displacements: &DISPLACEMENTS,
        effector_rows: rows,
    }
}

#[test]
fn a_pose_is_rounded_once_and_clamped() {
    let own = Actuation::new_checked(parts(&[4]), &REST, 5).unwrap();
    let mut pose = [[0; 3]; 2];
    // Halves go toward plus infinity: 4 - 1/2 = 3.5 -> 4; 3/2 -> 2; 7.
    assert_eq!(own.pose(&[ONE, -ONE / 2], &mut pose), Ok(2));
    assert_eq!(pose[0], [14, -18, 37]);
    // The second point's x and y do not fit; z is 2^30.
    assert_eq!(pose[1], [i32::MAX, i32::MIN, 1 << 30]);
    assert_eq!(own.pose(&[0, 0, 5], &mut pose), Ok(0));
    assert_eq!(pose, REST);
    // The ends of the range: 4 * -2 + 1 * (2 - 2^-30) = -6 rounded; 3 * -(2 - 2^-30) = -6 + 3 * 2^-30.
    assert_eq!(own.pose(&[i32::MIN, i32::MAX], &mut pose), Ok(1));
    assert_eq!(pose[0], [4, -26, 16]);
    assert_eq!(pose[1][2], i32::MIN);
}

#[test]
fn slices_of_other_lengths_are_refused_and_nothing_is_written() {
    let own = Actuation::new_checked(parts(&[]), &REST, 0).unwrap();
    let mut pose = [[7; 3]; 2];
    let length = |needed, given| Err(ActuationError::Length { needed, given });
    assert_eq!(own.pose(&[ONE], &mut pose), length(2, 1));
    assert_eq!(own.pose(&[ONE; 2], &mut pose[..1]), length(2, 1));
    assert_eq!(pose, [[7; 3]; 2]);
}

#[test]
fn what_is_unsound_is_named() {
    let check = |parts| Actuation::new_checked(parts, &REST, 5).map(|_| ());
    let none = ActuationParts {
        actuators: 0,
        ..parts(&[])
    };
    assert_eq!(check(none), Err(ActuationError::Counts));
    assert_eq!(check(parts(&[0; 33])), Err(ActuationError::Counts));
    let short = ActuationParts {
        displacements: &DISPLACEMENTS[..10],
        ..parts(&[])
    };
    assert_eq!(check(short), Err(ActuationError::Layout));
    let mut far = DISPLACEMENTS;
    far[10] = 1;
    let far = ActuationParts {
        displacements: &far,
        ..parts(&[])
    };
    assert_eq!(check(far), Err(ActuationError::Displacement { point: 1 }));
    let row = Err(ActuationError::Row { effector: 1 });
    assert_eq!(check(parts(&[4, 5])), row);
}
