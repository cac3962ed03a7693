//! Every figure of paper 2 (Chang, Qin: "Spline-based Solid Subdivision Schemes over Arbitrary
//! Tetrahedral Meshes") that the readings call expected, against core's own exact masks.

mod diagonals;
mod inheritance;
mod matrices;
mod printed;
mod regular;
mod stars;
mod tables;
