//! The volume that a smooth boundary encloses, and its gradient, in fixed point.
//!
//! The limit surface of a closed boundary encloses a volume that is an alternating trilinear form of
//! the control points: a sum of determinants `w_ijk det(p_i, p_j, p_k)` (Hakenberg, Reif,
//! Schaefer, Warren 2014). A baker makes the weights once; a controller evaluates the sum.
//!
//! * [`VolumeForm`]: the volume of a region from any pose, and its derivative by each control point.
//! * [`VolumeModes`]: the same volume for poses that are combinations of a few actuation modes: a
//!   cubic polynomial in their amplitudes.
//! * [`CentroidModes`]: the centroid for such poses, from quartic polynomials and that volume.
//!
//! # Why moving everything changes nothing
//!
//! A closed surface encloses the same volume wherever it stands, so coordinates enter as
//! differences to the region's first control point, its *base*, and triples with the base are
//! left out. Differences of integers are exact: moving the whole pose by whole units changes no
//! bit of the volume or the gradient. The gradient by the base is minus the sum of the others, so
//! that all gradients add up to zero, to the bit.
//!
//! # The number format
//!
//! 1. A difference to the base has 33 bits. It is rounded by `2^difference_shift`, at least 4, to
//!    at most `2^30` in magnitude.
//! 2. All differences of the pose are then doubled, exactly, as often as the greatest stays below
//!    `2^30`: `n` times. So a small region has as many digits as a large one.
//! 3. The volume is the exact sum of all `weight * det`, divided by `2^(3n)` (exactly) and by
//!    `2^volume_shift` with one rounding.
//! 4. The gradient is summed from cross products and weighted sums that were each rounded to 31 bits, and
//!    is then brought from `n` doublings to its fixed unit with one more rounding.

mod centroid;
mod check;
mod error;
mod evaluate;
mod form;
mod modes;
mod section;

pub use centroid::{Centroid, CentroidModes};
pub use error::EnclosedError;
pub use form::{Enclosed, GRADIENT_LIMIT, VolumeForm, VolumeFormParts, WEIGHT_LIMIT};
pub use modes::{MODE_WEIGHT_LIMIT, VolumeModes};
pub use section::{CentroidModesRecord, VolumeModesRecord, VolumeRecord};
