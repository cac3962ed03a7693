//! Every figure that paper 1 ("Smooth Subdivision of Tetrahedral Meshes") prints or implies and
//! that READINGS.md, part P1, records as expected.
//!
//! The masks under test are core's own: core refines sparse rows of rational numbers instead of
//! coordinates. The same checks run over the independent reference.

mod edge;
mod face;
mod fans;
mod uniform;
