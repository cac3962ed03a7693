//! Smooth subdivision of tetrahedra, octahedra, triangular prisms and hexahedra together
//! (Hakenberg: "Smooth Subdivision for Mixed Volumetric Meshes").
//!
//! One level has three steps:
//!
//! 1. *Unzip* (section 5.2): every vertex gets three clones, for tetrahedra and octahedra, for
//!    prisms, and for hexahedra. A clone is the vertex itself, moved a little where cells of
//!    different classes touch, by five distortions, one for each pair of faces that can touch: this
//!    is what makes the limit smooth across the face between them. At a vertex whose cells are of
//!    one class all clones are the vertex.
//! 2. *Linear split* (section 5.3) of every cell, from the clones of its class.
//! 3. *Averaging and collapse* (5.3.2): every new cell moves its vertices by its shape's
//!    characteristic matrix, and what the cells at a vertex say is averaged with the weights 1/14
//!    (tetrahedra and octahedra), 1/12 (prisms) and 1/8 (hexahedra).
//!
//! Meshes of tetrahedra and octahedra alone refine as with [`tet_oct`](super::tet_oct) and
//! `LoopWeights::TriQuad` on the boundary, to the bit; hexahedra alone, regular, as tricubic
//! B-splines; prisms alone, regular, as Loop's scheme times cubic B-splines.
//!
//! The limit is smooth everywhere but at extraordinary edges and vertices, and where the triangle of
//! a prism lies on a quadrilateral of a prism.
//!
//! # Which rule a vertex follows
//!
//! An old vertex, by the first that applies:
//!
//! 1. a corner (tagged, or where more than two crease edges meet) stays;
//! 2. on a surface that is [`Boundary::Fixed`] it stays;
//! 3. where exactly two crease edges meet, the cubic B-spline `1/8 6/8 1/8` along the crease;
//! 4. on a surface with a rule ([`Boundary::TriQuad`]) the triangle/quadrilateral scheme, with an
//!    unzip of its own. At a vertex that has surface triangles only every neighbour counts once,
//!    however many triangles share the edge to it (the same on a surface without branches);
//! 5. the interior rule above.
//!
//! The middle of an edge: on a crease `1/2 1/2`; on a fixed surface `1/2 1/2`; then as above. The
//! middle of a quadrilateral: on a fixed surface the mean of its corners. Centroids of octahedra and
//! hexahedra follow the interior rule. Vertices on the boundary are unzipped too, since their clones
//! enter interior vertices.
//!
//! # Numbers
//!
//! Clones are rounded to 8 bits below the last place and are the only intermediate that is rounded;
//! a clone without distortion is exact. Everything after them is one exact sum, rounded once.

mod arena;
mod classify;
mod gather;
mod masks;
mod points;
mod scratch;
mod split;
mod unzip;

pub use arena::MixedArena;
pub use classify::VertexState;
pub use points::{PointBuffers, refine_points};
pub use scratch::{NumberingScratch, PointScratch};
pub use split::{MixedBuffers, MixedCounts, split, split_counts};
pub use unzip::{VertexDistortion, unzip};

/// What the surface of a mixed solid follows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Boundary {
    /// The triangle/quadrilateral scheme of Schaefer and Warren, so that the skin depends on its
    /// own control points alone.
    #[default]
    TriQuad,
    /// No rule of its own: the interior rule everywhere. The boundary shrinks.
    Interior,
    /// Surface vertices stay, surface edges are halved and surface quadrilaterals are quartered:
    /// the polyhedron stays as it is.
    Fixed,
}
