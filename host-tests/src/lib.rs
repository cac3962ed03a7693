//! The independent f64 reference of octruss and what holds host, devices and
//! reference against one another.
//!
//! - [`reference_surface`] is the surface schemes written again, in double precision that is exact
//!   by construction; [`random_surface`] draws control meshes from a seed, and
//!   [`surface_subject`] drives the crate under test on them.

pub mod random_surface;
pub mod reference_surface;
pub mod surface_subject;
