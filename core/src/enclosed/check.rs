//! Proves once what the evaluation relies on at every tick.

use super::error::EnclosedError;
use super::form::{VolumeFormParts, WEIGHT_LIMIT};

pub(super) fn check(
    parts: &VolumeFormParts<'_>,
    control_points: usize,
) -> Result<(), EnclosedError> {
    let shifts = (2..=31).contains(&parts.difference_shift)
        && parts.pair_bits <= 31
        && (1..=122).contains(&parts.volume_shift)
        && parts.gradient_bits <= 60;
    if !shifts {
        return Err(EnclosedError::Shift);
    }
    let exists = |&point: &u16| usize::from(point) < control_points;
    let count = u16::try_from(parts.points.len()).map_err(|_| EnclosedError::Points)?;
    if count == 0 || !parts.points.iter().all(exists) {
        return Err(EnclosedError::Points);
    }
    check_pairs(parts, count.wrapping_sub(1))
}

/// `others` is the number of the region's points without its base.
fn check_pairs(parts: &VolumeFormParts<'_>, others: u16) -> Result<(), EnclosedError> {
    let pairs = u32::try_from(parts.pairs.len()).map_err(|_| EnclosedError::Points)?;
    let last = EnclosedError::Layout { place: pairs };
    let taps = u32::try_from(parts.weights.len()).map_err(|_| last)?;
    let (first_start, last_start) = (parts.pair_starts.first(), parts.pair_starts.last());
    let lengths = parts.pair_starts.len() == parts.pairs.len().wrapping_add(1)
        && parts.thirds.len() == parts.weights.len()
        && first_start == Some(&0)
        && last_start == Some(&taps);
    if !lengths {
        return Err(last);
    }
    let mut before: Option<[u16; 2]> = None;
    let mut total = 0_i64;
    let ranges = parts.pair_starts.windows(2);
    for ((pair, range), place) in parts.pairs.iter().zip(ranges).zip(0_u32..) {
        let layout = EnclosedError::Layout { place };
        let (&[i, j], &[start, end]) = (pair, range) else {
            return Err(layout);
        };
        if i >= j || before.is_some_and(|before| before >= [i, j]) {
            return Err(layout);
        }
        before = Some([i, j]);
        let (Ok(start), Ok(end)) = (usize::try_from(start), usize::try_from(end)) else {
            return Err(layout);
        };
        let thirds = parts.thirds.get(start..end).ok_or(layout)?;
        let weights = parts.weights.get(start..end).ok_or(layout)?;
        let mut above = j;
        for &third in thirds {
            if third <= above || third >= others {
                return Err(layout);
            }
            above = third;
        }
        let magnitude = magnitudes(weights);
        if magnitude > 1_i64.wrapping_shl(parts.pair_bits) {
            return Err(EnclosedError::Weights { place });
        }
        // A pair without taps may name points that the thirds did not bound.
        if j >= others {
            return Err(layout);
        }
        total = total.saturating_add(magnitude);
    }
    if total > WEIGHT_LIMIT {
        return Err(EnclosedError::Weights { place: pairs });
    }
    Ok(())
}

/// The sum of magnitudes: fewer than `2^16` weights of at most `2^31`.
fn magnitudes(weights: &[i32]) -> i64 {
    let magnitude = |&weight: &i32| i64::from(weight.unsigned_abs());
    weights.iter().map(magnitude).fold(0, i64::saturating_add)
}
