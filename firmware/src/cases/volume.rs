//! The kinds [`VOLUME`](super::VOLUME), [`VOLUME_MODES`](super::VOLUME_MODES) and
//! [`CENTROID_MODES`](super::CENTROID_MODES): the enclosed volume, its gradient, and the centroid.
//!
//! # A form over the control points
//!
//! | words | what |
//! | --- | --- |
//! | 1 | number of points of the pose |
//! | 1 | bytes of the form's section, as it lies in a bundle |
//! | | the section, filled up with zeros to a multiple of 4 bytes |
//! | 3 each | the pose, raw bits, signed |
//!
//! The result is the volume alone with its count of clamped results, then volume and gradient with
//! theirs.
//!
//! # A polynomial in modes
//!
//! | words | what |
//! | --- | --- |
//! | 1 | number of modes |
//! | 1 | number of coefficients |
//! | 1 each | coefficients, signed |
//! | 1 each | amplitudes, signed |
//!
//! The result is the volume alone, then volume and derivatives.
//!
//! # A centroid
//!
//! | words | what |
//! | --- | --- |
//! | 1 | number of modes |
//! | 1 | number of coefficients |
//! | 1 | the shift, signed |
//! | 2 | the volume, signed, the low word first |
//! | 1 each | coefficients, signed |
//! | 1 each | amplitudes, signed |
//!
//! The result is the offset, then how many of its coordinates were clamped.

use octruss::enclosed::{CentroidModes, VolumeForm, VolumeModes};
use octruss::mesh::Arena;
use zerocopy::IntoBytes;

use super::results::{Results, Sink, Status};
use super::space::Space;
use super::{SECTION_VOLUME, Words};

/// Words of a number of 64 bits.
const WIDE: usize = 2;

/// Runs a case of a form.
pub(super) fn run<S: Sink>(
    words: &[u32],
    mut space: Space<'_>,
    results: &mut Results<'_, S>,
) -> Result<(), Status> {
    let mut words = Words(words);
    let pose_length = words.length()?;
    let section_bytes = words.length()?;
    let section = words.elements::<1>(section_bytes.div_ceil(4))?.as_bytes();
    let section = section.get(..section_bytes).ok_or(Status::Malformed)?;
    let pose = words.points(pose_length)?;
    words.finish()?;

    let form = VolumeForm::from_section(section, pose_length).map_err(Status::Enclosed)?;
    let workspace = space.slice(Arena::InputPoints, form.workspace_length(), [0; 3])?;
    let gradient = space.slice(Arena::OutputPoints, form.points().len(), [0_i64; 3])?;
    let alone = form.volume(pose, workspace).map_err(Status::Enclosed)?;
    let both = form
        .volume_and_gradient(pose, workspace, gradient)
        .map_err(Status::Enclosed)?;
    space.check()?;
    let coordinates = gradient.as_flattened();
    let length = coordinates.len().saturating_mul(WIDE);
    results.begin_section(SECTION_VOLUME, length.saturating_add(2 * WIDE + 2));
    for enclosed in [alone, both] {
        write_wide(enclosed.volume, results);
        results.words(&[enclosed.saturated]);
    }
    for &coordinate in coordinates {
        write_wide(coordinate, results);
    }
    Ok(())
}

/// Runs a case of modes.
pub(super) fn run_modes<S: Sink>(
    words: &[u32],
    mut space: Space<'_>,
    results: &mut Results<'_, S>,
) -> Result<(), Status> {
    let mut words = Words(words);
    let modes = words.length()?;
    let coefficients = words.length()?;
    let coefficients = words.numbers(coefficients)?;
    let amplitudes = words.numbers(modes)?;
    words.finish()?;

    let count = u16::try_from(modes).map_err(|_| Status::Malformed)?;
    let form = VolumeModes::new_checked(count, coefficients).map_err(Status::Enclosed)?;
    let derivatives = space.slice(Arena::OutputPoints, modes, 0_i64)?;
    let alone = form.volume(amplitudes).map_err(Status::Enclosed)?;
    let both = form
        .volume_and_gradient(amplitudes, derivatives)
        .map_err(Status::Enclosed)?;
    space.check()?;
    let length = derivatives.len().saturating_add(2).saturating_mul(WIDE);
    results.begin_section(SECTION_VOLUME, length);
    for number in [alone, both].iter().chain(&*derivatives) {
        write_wide(*number, results);
    }
    Ok(())
}

/// Runs a case of a centroid.
pub(super) fn run_centroid<S: Sink>(
    words: &[u32],
    space: Space<'_>,
    results: &mut Results<'_, S>,
) -> Result<(), Status> {
    let mut words = Words(words);
    let modes = words.length()?;
    let coefficients = words.length()?;
    let [shift, low, high] = [words.word()?, words.word()?, words.word()?];
    let coefficients = words.numbers(coefficients)?;
    let amplitudes = words.numbers(modes)?;
    words.finish()?;

    let count = u16::try_from(modes).map_err(|_| Status::Malformed)?;
    let form = CentroidModes::new_checked(count, 0, shift.cast_signed(), coefficients)
        .map_err(Status::Enclosed)?;
    let volume = u64::from(high).wrapping_shl(32) | u64::from(low);
    let centroid = form.offset(amplitudes, volume.cast_signed());
    let centroid = centroid.map_err(Status::Enclosed)?;
    space.check()?;
    results.begin_section(SECTION_VOLUME, 4);
    results.words(&centroid.offset.map(i32::cast_unsigned));
    results.words(&[centroid.saturated]);
    Ok(())
}

/// Writes a number of 64 bits, the low word first.
fn write_wide<S: Sink>(number: i64, results: &mut Results<'_, S>) {
    let [low, high] = wide(number);
    results.words(&[low, high]);
}

/// The words of a number of 64 bits, the low one first.
#[must_use]
pub fn wide(number: i64) -> [u32; WIDE] {
    let bits = number.cast_unsigned().to_le_bytes();
    let [a, b, c, d, e, f, g, h] = bits;
    [
        u32::from_le_bytes([a, b, c, d]),
        u32::from_le_bytes([e, f, g, h]),
    ]
}
