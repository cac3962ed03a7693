//! The bundle: what a baker writes, opened in place from flash.
//!
//! A bundle is one block of bytes that holds a deformation table (see [`crate::deform`]), the
//! rest cage, and what is needed to know that it fits: the coordinate format and its unit, the
//! scheme that made it, checksums of the cage's connectivity and of the model.
//! [`Bundle::new_checked`] proves everything that the accessors and
//! [`Table::apply`](crate::deform::Table::apply) rely on, so that nothing has to be checked, and
//! nothing can fail, on a tick.
//!
//! # Layout, version 0
//!
//! Version 0 carries no promise: its layout may change. All numbers are little-endian; the first
//! byte lies on an address that is a multiple of [`ALIGNMENT`].
//!
//! | section | elements | type |
//! | --- | --- | --- |
//! | [`Header`] | 1 | 128 bytes |
//! | residuals | rows x 3 | `i64`, in units of 2^-30 of a coordinate's last place |
//! | rest cage | control points x 3 | `i32`, coordinate bits |
//! | row starts | rows + 1 | `u32`, first tap of each row, then the number of taps |
//! | weights | taps | `i32`, in units of 2^-30 |
//! | control points of the taps | taps | `u16` |
//! | padding | to a multiple of 8 | zero bytes |
//!
//! The weights of a row add up to exactly 2^30, their magnitudes to at most 2^31. The residual of
//! a row and a coordinate is `rest * 2^30 - sum(weight * rest cage)`, of magnitude at most
//! [`RESIDUAL_LIMIT`], where `rest` are the bits of the model point at rest; [`crate::deform`]
//! says what it is for.
//!
//! The checksums are CRC-32 (the polynomial of ISO 3309, as in zip and Ethernet).

mod error;
mod header;
mod layout;
mod view;

pub use error::BundleError;
pub use header::{
    BOUNDARY_FIXED, BOUNDARY_INTERIOR, BOUNDARY_LOOP, BOUNDARY_LOOP_WARREN, BOUNDARY_TRI_QUAD,
    Header, MAGIC, SCHEME_BOX_SPLINE, SCHEME_BOX_SPLINE_AVERAGED, SCHEME_TET_OCT, VERSION,
};
pub use layout::{ALIGNMENT, RESIDUAL_LIMIT, Sections, checksum, checksum_of};
pub use view::Bundle;

/// Includes a bundle's bytes at the alignment that [`Bundle::new_checked`] asks for.
///
/// Takes a path as `include_bytes!` does, and gives a `&'static [u8]`.
#[macro_export]
macro_rules! include_bundle {
    ($path:expr $(,)?) => {{
        #[repr(C, align(8))]
        struct Aligned<Bytes: ?Sized>(Bytes);
        static ALIGNED: &Aligned<[u8]> = &Aligned(*include_bytes!($path));
        &ALIGNED.0
    }};
}
