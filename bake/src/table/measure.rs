//! The error of a packed table, measured with the device's own code.

use super::choice::{Material, Packed};
use crate::bundle::BundleBytes;
use crate::deform::{Form, deform};
use crate::pack::writer;
use octruss::bundle::{BOUNDARY_LOOP, Header, SCHEME_TET_OCT};
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// The greatest difference, in units in the last place, between what a device computes and the real
/// map, over random poses whose control points move by at most `displacement` along each axis; and
/// over a pose whose control points all stand at the end of that range that the sign of a pseudorandom
/// number says. Coordinates that saturate do not count.
pub(super) fn measure(material: &Material<'_>, packed: &Packed, displacement: f64) -> f64 {
    let header = Header {
        magic: [0; 8],
        version: 0.into(),
        total_bytes: 0.into(),
        checksum: 0.into(),
        fraction_bits: material.format.fraction_bits.into(),
        unit: [0; 16],
        scheme: SCHEME_TET_OCT.into(),
        boundary: BOUNDARY_LOOP.into(),
        levels: 0.into(),
        control_points: (material.rest_cage.len() as u32).into(),
        rows: (material.rest_model.len() as u32).into(),
        sections: 0.into(),
        cage_checksum: 0.into(),
        model_checksum: 0.into(),
        reserved: [0; 56],
    };
    let bytes = writer::bundle(header, &packed.sections).unwrap_or_default();
    let bytes = BundleBytes::new(&bytes);
    let Ok(bundle) = bytes.open() else {
        return f64::INFINITY;
    };
    let mut random = ChaCha8Rng::seed_from_u64(material.seed);
    let mut worst = 0.0_f64;
    for number in 0..material.random_poses {
        let at_the_ends = number % 2 == 1;
        let pose: Vec<[i32; 3]> = material
            .rest_cage
            .iter()
            .map(|rest| rest.map(|rest| moved(rest, displacement, at_the_ends, &mut random)))
            .collect();
        let Ok(deformed) = deform(&bundle, &pose, Form::Displacement) else {
            return f64::INFINITY;
        };
        worst = worst.max(greatest_error(material, &pose, &deformed.bits));
    }
    worst
}

fn moved(rest: i32, displacement: f64, at_the_ends: bool, random: &mut ChaCha8Rng) -> i32 {
    let unit = f64::from(random.next_u32().cast_signed()) / 2.0_f64.powi(31);
    let part = if at_the_ends { unit.signum() } else { unit };
    // A conversion to integers clamps.
    (f64::from(rest) + (part * displacement).trunc()) as i32
}

/// Over all rows of one pose, in 128-bit integers.
fn greatest_error(material: &Material<'_>, pose: &[[i32; 3]], points: &[[i32; 3]]) -> f64 {
    // Doubles as multiples of 2^-80: with 33-bit displacements and magnitudes of at most two all stays far
    // below 2^127, and what is cut off is below 2^-40 units.
    const REAL_BITS: i32 = 80;
    let scale = 2.0_f64.powi(REAL_BITS);
    let mut worst = 0.0_f64;
    for ((row, rest), point) in material.rows.iter().zip(material.rest_model).zip(points) {
        for axis in [0, 1, 2] {
            if point[axis] == i32::MAX || point[axis] == i32::MIN {
                continue;
            }
            let way = |column: u32| {
                let now = i128::from(pose[column as usize][axis]);
                now - i128::from(material.rest_cage[column as usize][axis])
            };
            let real: i128 = row.iter().map(|&(c, w)| (w * scale) as i128 * way(c)).sum();
            let result = i128::from(point[axis]) - i128::from(rest[axis]);
            worst = worst.max(((result << REAL_BITS) - real).abs() as f64 / scale);
        }
    }
    worst
}
