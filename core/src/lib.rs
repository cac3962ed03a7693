#![no_std]
//! Smooth deformation of solids on microcontrollers, exact to the last bit.
//!
//! A person (or a controller) moves a few control points; every point inside follows a smooth
//! map. The arithmetic is fixed point with one rounding rule, nothing allocates, and the time
//! is bounded, so that a Cortex-M, a desktop and the reference of the test suite agree in every
//! bit.
//!
//! # The house
//!
//! Two wings on one ground. Data goes down the left wing when a mesh is refined, and down the
//! right wing when a device moves.
//!
//! * **Ground**: [`coord`] (coordinate formats, the one rounding rule, saturation) and
//!   [`blend`] (weighted sums over any value type: fixed-point coordinates on a device, sparse
//!   rows in a baker, rationals in a test).
//! * **Left wing, refine**: [`mesh`] (what a solid is, its boundary, the numbering of new
//!   vertices), [`surface`] (weights of surface schemes) and [`solid`] (subdivision of solids:
//!   [`solid::tet_oct`], [`solid::box_spline`], [`solid::mixed`]).
//! * **Right wing, run**: [`bundle`] (a validated view of the baked bytes in flash) and
//!   [`deform`] (the table and its apply kernel), [`enclosed`] (the volume inside a smooth
//!   boundary, and its gradient), and [`control`] (from goals to a pose under constraints).
//!
//! All logic works on slices and views that the caller owns. Types with const generics, built on
//! `heapless`, exist for convenience only: [`mesh::SolidArena`], [`solid::tet_oct::Scratch`].
//!
//! # From flash to a deformed model
//!
//! ```
//! use fixed::types::I12F20;
//! use octruss::bundle::Bundle;
//!
//! # fn main() { let _ = deform; }
//! /// Moves every control point and deforms the first 256 rows of the model.
//! fn deform(flash: &[u8], pose: &[[I12F20; 3]]) -> Option<[[I12F20; 3]; 256]> {
//!     let bundle = Bundle::new_checked(flash).ok()?; // proves all that `apply` relies on
//!     let table = bundle.table::<I12F20>().ok()?; // another format is an error
//!     let mut points = [[I12F20::ZERO; 3]; 256];
//!     let saturated = table.apply(0..256, pose, &mut points).ok()?;
//!     (saturated == 0).then_some(points)
//! }
//! ```

pub mod blend;
pub mod bundle;
pub mod control;
pub mod coord;
pub mod deform;
pub mod enclosed;
pub mod mesh;
pub mod solid;
pub mod surface;

/// The README's example is compiled with the documentation's.
#[cfg(doctest)]
#[doc = include_str!("../../README.md")]
struct Readme;
