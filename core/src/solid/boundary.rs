//! What a solid's boundary follows.

use crate::surface::LoopWeights;

/// What the surface triangles of a solid follow.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Boundary {
    /// Loop's scheme on the surface triangles, so that the skin depends on its own control points
    /// alone.
    Surface(LoopWeights),
    /// No rule of its own: the interior rule everywhere, as the papers' pseudocode has it. The
    /// boundary shrinks.
    Interior,
    /// Surface vertices stay and surface edges are halved: the polyhedron stays as it is.
    Fixed,
}
