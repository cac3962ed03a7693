//! Rules of surface subdivision schemes.
//!
//! A solid's boundary follows a surface scheme of its own, so that the skin of a refined solid
//! depends on the boundary's control points alone. [`loop_weights`] holds the weight families of
//! Loop's scheme.

pub mod loop_weights;

pub use loop_weights::LoopWeights;
