//! The bundle: what a baker writes, opened in place from flash.
//!
//! A bundle is one block of bytes that holds a deformation table (see [`crate::deform`]), the
//! rest cage, and what is needed to know that it fits: the coordinate format and its unit, the
//! scheme that made it, checksums of the cage's connectivity and of the model.
//! [`Bundle::new_checked`] proves everything that the accessors and
//! [`Table::apply`](crate::deform::Table::apply) rely on, so that nothing has to be checked, and
//! nothing can fail, on a tick.
//!
//! # Layout
//!
//! The format is version 1; `docs/bundle.md` has it in full, with the promise that bundles of this version
//! stay readable. A [`Header`] is followed by a table of [`Section`]s; readers skip sections of a kind that
//! they do not know. All numbers are little-endian; the first byte lies on an address that is a multiple of
//! [`ALIGNMENT`], and so does every section.
//!
//! A table has one [`Stage`], whose rows are sums over the control points, or two, of which the second has
//! the rows of the first for inputs. Rows come in groups that share their inputs.
//!
//! The checksums are CRC-32 (the polynomial of ISO 3309, as in zip and Ethernet).

mod error;
mod header;
mod layout;
mod stage;
mod view;

pub use error::BundleError;
pub use header::{
    BOUNDARY_FIXED, BOUNDARY_INTERIOR, BOUNDARY_LOOP, BOUNDARY_LOOP_WARREN, BOUNDARY_TRI_QUAD,
    FORMAT_COMPACT, FORMAT_Q14, FORMAT_Q30, Header, MAGIC, NormalsRecord, RIM_FIXED, RIM_SPLINE,
    RIM_SPLINE_WITH_CORNERS, SCHEME_BOX_SPLINE, SCHEME_BOX_SPLINE_AVERAGED, SCHEME_BUTTERFLY,
    SCHEME_BUTTERFLY_MODIFIED, SCHEME_CATMULL_CLARK, SCHEME_DOO_SABIN, SCHEME_LOOP,
    SCHEME_LOOP_WARREN, SCHEME_MIXED, SCHEME_SQRT3, SCHEME_TET_OCT, SCHEME_TRI_QUAD,
    SECTION_ACTUATION, SECTION_CELLS, SECTION_CENTROID_MODES, SECTION_GROUPS, SECTION_INDICES,
    SECTION_INVERSE, SECTION_LIMITS, SECTION_MODEL_POINTS, SECTION_NORMALS, SECTION_REST_CAGE,
    SECTION_RIG, SECTION_SPRINGS, SECTION_STAGE, SECTION_STARTS, SECTION_VOLUME,
    SECTION_VOLUME_MODES, SECTION_WEIGHTS, STARTS_NARROW, STARTS_NONE, STARTS_REST, STARTS_WIDE,
    Section, Stage, VERSION,
};
pub use layout::{ALIGNMENT, START_LIMIT, checksum, checksum_of};
pub use view::{Bundle, ModelPoints};

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
