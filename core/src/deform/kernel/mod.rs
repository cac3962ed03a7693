//! The hot loops: rows of one group over control points that were gathered for it.
//!
//! [`portable`] says what a kernel does, in plain Rust. Where the target has Arm's DSP extension,
//! `cortex_m` does the same to the bit in fewer instructions.

#[cfg(octruss_dsp)]
#[expect(unsafe_code, reason = "instructions that the compiler does not give")]
mod cortex_m;
#[cfg_attr(
    octruss_dsp,
    allow(dead_code, reason = "the test of `cortex_m` needs them")
)]
mod portable;

#[cfg(octruss_dsp)]
pub(super) use cortex_m::{narrow_pairs, wide_q14, wide_q30};
pub(super) use portable::narrow_single;
#[cfg(not(octruss_dsp))]
pub(super) use portable::{narrow_pairs, wide_q14, wide_q30};

use crate::coord::round_shift;

/// The most taps of a row that the kernels take; longer rows take a slower way.
pub(super) const MOST_TAPS: usize = 64;

/// Taps that one multiplication of the 16-bit kernel takes.
pub(super) const TAPS_A_STEP: usize = 2;

/// The greatest shift of 16-bit displacements: one unit of a displacement is `2^16` units of a coordinate,
/// so that a displacement spans the whole range.
pub(crate) const MOST_DISPLACEMENT_SHIFT: u32 = 16;

/// The one shift between 0 and [`MOST_DISPLACEMENT_SHIFT`] that the kernels leave out.
pub(crate) const EXCLUDED_DISPLACEMENT_SHIFT: u32 = 13;

/// Two 16-bit displacements along one axis: the first in the lower half.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(transparent)]
pub(super) struct Pair(pub u32);

impl Pair {
    /// The two halves.
    #[expect(
        clippy::as_conversions,
        reason = "truncation to a half is what is meant"
    )]
    fn halves(self) -> (i16, i16) {
        (self.0 as i16, (self.0 >> 16) as i16)
    }
}

/// How the sums of rows start. The numbers are those that the assembly compares with.
#[cfg(octruss_dsp)]
#[derive(Clone, Copy, Debug)]
#[repr(u32)]
pub(super) enum StartKind {
    /// From three 32-bit numbers a row.
    Narrow = 0,
    /// From three 64-bit numbers a row.
    Wide = 1,
    /// All from the same three 64-bit numbers.
    Same = 2,
}

/// The start value of a row's sums.
pub(super) trait Start: Copy + 'static {
    /// How the sums start.
    #[cfg(octruss_dsp)]
    const KIND: StartKind;

    /// The start value, with the half of the rounding rule in it.
    fn sums(&self) -> [i64; 3];

    /// Where the first start value lies.
    #[cfg(octruss_dsp)]
    fn first(starts: &[Self]) -> *const () {
        starts.as_ptr().cast()
    }
}

impl Start for [i32; 3] {
    #[cfg(octruss_dsp)]
    const KIND: StartKind = StartKind::Narrow;

    fn sums(&self) -> [i64; 3] {
        self.map(i64::from)
    }
}

impl Start for [i64; 3] {
    #[cfg(octruss_dsp)]
    const KIND: StartKind = StartKind::Wide;

    fn sums(&self) -> [i64; 3] {
        *self
    }
}

/// All rows start from the half of `2^BITS`: the absolute form.
#[derive(Clone, Copy, Debug)]
pub(super) struct Half<const BITS: u32>;

impl<const BITS: u32> Half<BITS> {
    const SUMS: [i64; 3] = [crate::coord::rounding_start(BITS); 3];
}

impl<const BITS: u32> Start for Half<BITS> {
    #[cfg(octruss_dsp)]
    const KIND: StartKind = StartKind::Same;

    fn sums(&self) -> [i64; 3] {
        Self::SUMS
    }

    #[cfg(octruss_dsp)]
    fn first(_: &[Self]) -> *const () {
        core::ptr::from_ref(&Self::SUMS).cast()
    }
}

/// A sum of 16-bit products as a displacement in units of a coordinate:
/// `floor(sum * 2^shift / 2^14 + 1/2)`.
///
/// # Scaling and overflow
///
/// The sum is at most `2^30` and the shift at most 16, so everything fits 64 bits.
pub(super) fn scaled(sum: i32, displacement_shift: u32) -> i64 {
    round_shift(i64::from(sum).wrapping_shl(displacement_shift), 14)
}
