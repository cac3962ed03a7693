//! Every mistake that users come with, a row each, and the sentence that answers it.
//!
//! The rows drive the program. What they have in common is held in [`table::check`]: the exit status,
//! no panic, no result, and that all files are as they were.

mod cells;
#[path = "../common/mod.rs"]
mod common;
mod coordinates;
mod lying;
mod others;
mod places;
mod sound;
mod sweep;
mod table;
mod truncated;
mod unknown;
