//! Meshes: what a solid and a surface are, a solid's boundary, and the numbering of the vertices
//! that a split adds.
//!
//! A [`Solid`] and a [`ControlMesh`] (polygons of a surface) are views of index lists that somebody
//! else owns. Everything here is about connectivity; values (coordinates, channels) live in slices
//! beside it.
//!
//! # Conventions
//!
//! * A tetrahedron `(v0, v1, v2, v3)` is positive if `det(v1 - v0, v2 - v0, v3 - v0) > 0`.
//! * An octahedron's corners come in opposite pairs `(0, 3) (1, 4) (2, 5)`; it is positive if it
//!   lies like the middle octahedron of a positive tetrahedron. Its faces are listed in
//!   [`OCTAHEDRON_FACES`].
//! * Surface triangles are counter-clockwise from outside.
//!
//! # Numbering
//!
//! The order of refined vertices depends on connectivity alone: old vertices first, then edge
//! midpoints by ascending pair of their ends, then octahedron centroids by ascending sorted
//! corners ([`Numbering`]). On a control mesh: old vertices, edge midpoints in the same order
//! ([`SurfaceEdges`]), then face points by ascending sorted corners ([`FaceOrder`]). So a rest cage
//! and a posed cage refine to the same order on every machine.

mod arena;
mod boundary;
mod control_mesh;
mod counts;
mod error;
mod face_order;
mod fans;
mod numbering;
mod surface_edges;
mod view;

pub use arena::SolidArena;
pub use boundary::{boundary_triangles, face_capacity};
pub use control_mesh::{ControlMesh, ControlMeshBuffers};
pub(crate) use control_mesh::{index, length};
pub use counts::Counts;
pub use error::{Arena, MeshError, Part};
pub use face_order::FaceOrder;
pub use fans::Fans;
pub(crate) use numbering::require;
pub use numbering::{Numbering, edge_capacity};
pub use surface_edges::{Side, SurfaceEdges};
pub use view::{Solid, SolidBuffers};

/// Corner indices of a tetrahedron's faces, counter-clockwise from outside; face `i` lies
/// opposite corner `i`.
pub const TETRAHEDRON_FACES: [[usize; 3]; 4] = [[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]];

/// Corner indices of an octahedron's faces, counter-clockwise from outside.
pub const OCTAHEDRON_FACES: [[usize; 3]; 8] = [
    [0, 2, 1],
    [0, 1, 5],
    [0, 4, 2],
    [0, 5, 4],
    [3, 1, 2],
    [3, 5, 1],
    [3, 2, 4],
    [3, 4, 5],
];

/// Corner indices of a tetrahedron's edges.
pub const TETRAHEDRON_EDGES: [[usize; 2]; 6] = [[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]];

/// Corner indices of an octahedron's edges: all pairs but the opposite ones.
pub const OCTAHEDRON_EDGES: [[usize; 2]; 12] = [
    [0, 1],
    [0, 2],
    [0, 4],
    [0, 5],
    [1, 2],
    [1, 3],
    [1, 5],
    [2, 3],
    [2, 4],
    [3, 4],
    [3, 5],
    [4, 5],
];
