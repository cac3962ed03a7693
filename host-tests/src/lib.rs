//! The independent f64 reference of octruss and what holds host, devices and
//! reference against one another.
//!
//! - [`mod@reference`] is paper 1 written again, in double precision that is exact by
//!   construction. It shares nothing with the crate that it judges.
//! - [`meshes`] builds the named meshes that the papers' figures belong to.
//! - [`rational`] and [`subject`] drive the crate under test on the host: in raw bits between
//!   guard words, and over rows of rational numbers, so that it hands out its exact masks.
//! - [`local`] and [`spectrum`] make subdivision matrices of neighbourhoods and analyse them.
//! - [`performance`] measures the apply beside what one would write instead.
//! - [`random_bundle`] packs random tables in every format.
//! - [`random_update`] does so for tables that are updated in part, factored tables and normals.
//! - [`random_mesh`] and [`random_table`] draw the random cases, from a seed alone.
//! - [`random_data`] draws solids of several materials: labels, crease surfaces, scalar channels.
//! - [`equality`] runs core against the reference, [`compare`] says what differs, [`distance`]
//!   measures how far both are from real numbers, [`snapshot`] keeps printed figures.
//! - [`reference_box_spline`] is paper 2 written again in the same way; [`box_spline`] and
//!   [`box_spline_cases`] drive the crate under test on it.
//! - [`reference_surface`] is the surface schemes written again, in double precision that is exact
//!   by construction; [`random_surface`] draws control meshes from a seed, and
//!   [`surface_subject`] and [`surface_rows`] drive the crate under test on them.
//! - [`reference_volume`] is the enclosed volume written again, in integers of any length;
//!   [`random_volume`] draws its forms and poses.
//! - [`reference_rig`] is the rig written again, in integers of any length; [`random_rig`] draws rigs and
//!   commands.
//! - [`reference_springs`] is the springs written again in the same way; [`random_springs`] draws springs,
//!   states, pushes and obstacles, [`shaken_block`] what is shaken for hours.
//! - [`reference_control`] is the goals' solver written again, in integers of 128 bits;
//!   [`random_inverse`] draws solvers, goals and volumes to hold.
//! - [`reference_health`] is the health of poses written again; [`random_health`] draws its cases.
//! - [`reference_project`] is the projection of poses written again; [`random_project`] draws its problems, and
//!   [`sections`] lays forms and limits out as in a bundle.
//! - [`adaptive_count`] counts the triangles of adaptive square-root-3 and Loop meshes over tolerances.
//! - [`qemu`] runs the firmware's images on emulated processors and reads what they return.
//! - [`reference_mixed`] is Hakenberg's scheme for mixed solids written again in the same way;
//!   [`random_mixed`] draws mixed solids, and [`mixed_subject`] drives the crate under test on
//!   them, over bits and over exact rows ([`blend_f64`]: over rows of doubles).

pub mod adaptive_count;
pub mod blend_f64;
pub mod box_spline;
pub mod box_spline_cases;
pub mod bundle_bytes;
pub mod compare;
pub mod distance;
pub mod equality;
pub mod local;
pub mod meshes;
pub mod mixed_subject;
pub mod performance;
pub mod qemu;
pub mod random_bundle;
pub mod random_data;
pub mod random_health;
pub mod random_inverse;
pub mod random_mesh;
pub mod random_mixed;
pub mod random_project;
pub mod random_rig;
pub mod random_springs;
pub mod random_surface;
pub mod random_table;
pub mod random_update;
pub mod random_volume;
pub mod rational;
pub mod reference;
pub mod reference_box_spline;
pub mod reference_control;
pub mod reference_health;
pub mod reference_mixed;
pub mod reference_motion;
pub mod reference_project;
pub mod reference_rig;
pub mod reference_springs;
pub mod reference_surface;
pub mod reference_volume;
pub mod sections;
pub mod shaken_block;
pub mod snapshot;
pub mod spectrum;
pub mod subject;
pub mod surface_rows;
pub mod surface_subject;
