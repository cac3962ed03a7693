//! What `cargo xtask bench` measures: bytes, instructions and estimated cycles of the apply, beside what one
//! would write instead, on the same rows.
//!
//! [`input`] makes the files that the image `rivals` reads, [`cycles`] asks `llvm-mca` about the hot loops,
//! [`page`] writes the tables; [`volume`] does all of it for the enclosed volume, [`skin`] for a surface
//! beside the same surface refined on the device, [`inverse`] for the goals' solver, [`projection`] for
//! limits of whole poses and their health.

pub mod cycles;
pub mod input;
pub mod inverse;
pub mod page;
pub mod projection;
pub mod skin;
pub mod volume;
