//! octruss host tools
pub mod error;
pub mod mesh;
pub mod read;
pub mod write;
