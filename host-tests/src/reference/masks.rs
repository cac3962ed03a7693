//! The exact masks that the reference's own arithmetic applies, as fractions of integers.
//!
//! They come out of the very sums that [`super::refine`] rounds, by putting one at a single
//! vertex and nothing elsewhere: the mask entry is the sum before rounding.

use super::arithmetic::Fraction;
use super::classify::classify;
use super::refine::evaluate;
use super::solid::{Boundary, Solid, SolidError};
use super::split::split;

/// One weight: the vertex of the level before that it multiplies, numerator, denominator.
pub type MaskEntry = (u32, i64, i64);

/// The refined solid, and for each of its vertices the non-zero weights that one level gives to
/// the vertices of `solid`, in ascending order of these.
///
/// # Errors
/// If the solid is not sound.
pub fn level_masks(
    solid: &Solid,
    boundary: Boundary,
) -> Result<(Solid, Vec<Vec<MaskEntry>>), SolidError> {
    solid.check()?;
    let linear = split(solid);
    let rules = classify(solid, &linear, boundary);
    let mut masks = vec![Vec::new(); linear.solid.vertex_count];
    let mut unit = vec![[0.0]; solid.vertex_count];
    for (place, vertex) in (0..).take(solid.vertex_count).enumerate() {
        unit[place] = [1.0];
        let column = evaluate(&linear, &rules, &unit, &mut Fraction);
        unit[place] = [0.0];
        for (mask, [(numerator, denominator)]) in masks.iter_mut().zip(column) {
            if numerator != 0.0 {
                mask.push((vertex, numerator as i64, denominator as i64));
            }
        }
    }
    Ok((linear.solid, masks))
}

/// The masks of the linear split alone, in the same form.
///
/// # Errors
/// If the solid is not sound.
pub fn linear_masks(solid: &Solid) -> Result<(Solid, Vec<Vec<MaskEntry>>), SolidError> {
    solid.check()?;
    let linear = split(solid);
    let mut masks: Vec<Vec<MaskEntry>> = (0..)
        .take(solid.vertex_count)
        .map(|vertex| vec![(vertex, 1, 1)])
        .collect();
    masks.extend(
        linear
            .edges
            .iter()
            .map(|parents| parents.map(|parent| (parent, 1, 2)).to_vec()),
    );
    masks.extend(
        linear
            .octahedra
            .iter()
            .map(|(parents, _)| parents.map(|parent| (parent, 1, 6)).to_vec()),
    );
    Ok((linear.solid, masks))
}
