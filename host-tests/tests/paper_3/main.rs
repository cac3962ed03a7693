//! The figures of Hakenberg's thesis, from the crate's own exact masks.
//!
//! Figures are those printed in the thesis (chapter, example and equation numbers are named), with
//! the errata of docs/readings.md.

mod example_5_1;
mod grids;
mod masks;
mod precision;
mod reductions;
mod smoothness;
mod spectrum;
mod surface;
