//! What the formats of VTK share (cells, data on cells and points), and legacy VTK files (`.vtk`).
//!
//! Legacy files are read as ASCII and binary (most significant byte first), with cells as versions
//! up to 4 list them and as 5.x does. Octahedra are polyhedra, type 42, whose entry is a list of
//! faces; their corners get octruss's order from the faces. Vertices, lines, triangles and quadrangles are
//! counted and left out; other volume cells and cells of second order are errors.

pub mod cell;
pub mod data;
mod legacy;
mod numbers;
mod octahedron;

pub use legacy::read;
