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
//! * A prism `(v0, ..., v5)` has the triangles `(0, 1, 2)` and `(3, 4, 5)`, joined by the edges
//!   `(0, 3) (1, 4) (2, 5)`, as in Gmsh; it is positive if `det(v1 - v0, v2 - v0, v3 - v0) > 0`.
//!   (A wedge of VTK has its triangles turned.)
//! * A hexahedron `(v0, ..., v7)` has the quadrilaterals `(0, 1, 2, 3)` and `(4, 5, 6, 7)`, joined
//!   by the edges `(0, 4) (1, 5) (2, 6) (3, 7)`, as in Gmsh and VTK; it is positive if
//!   `det(v1 - v0, v3 - v0, v4 - v0) > 0`.
//! * Surface triangles and quadrilaterals are counter-clockwise from outside.
//!
//! # Numbering
//!
//! The order of refined vertices depends on connectivity alone: old vertices first, then edge
//! midpoints by ascending pair of their ends, then octahedron centroids by ascending sorted
//! corners ([`Numbering`]). On a control mesh: old vertices, edge midpoints in the same order
//! ([`SurfaceEdges`]), then face points by ascending sorted corners ([`FaceOrder`]). So a rest cage
//! and a posed cage refine to the same order on every machine.
//! Solids with prisms and hexahedra have middles of quadrilateral faces between edge midpoints and
//! octahedron centroids, and centroids of hexahedra at the end ([`MixedNumbering`]).
//!
//! # Triangles on quadrilaterals
//!
//! A triangle of a cell may lie on half of a quadrilateral face of another. The face is then
//! covered along one of its diagonals, and the midpoint of that diagonal and the middle of the face
//! are one vertex. If the other half is free it belongs to the boundary as a triangle.

mod arena;
mod boundary;
mod control_mesh;
mod counts;
mod error;
mod face_order;
mod fans;
mod mixed_boundary;
mod mixed_numbering;
mod numbering;
mod quad_faces;
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
pub use mixed_boundary::{BoundaryFaces, BoundarySizes, MixedBoundaryBuffers, boundary_faces};
pub use mixed_numbering::{MixedNumbering, MixedNumberingBuffers, MixedNumberingSizes};
pub(crate) use numbering::require;
pub use numbering::{Numbering, edge_capacity};
pub use quad_faces::{QuadDiagonal, QuadFace};
pub(crate) use quad_faces::{QuadKind, prism_triangles, tetrahedral_triangles};
pub(crate) use surface_edges::start as start_of_side;
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

/// Corner indices of a prism's triangles, counter-clockwise from outside.
pub const PRISM_TRIANGLES: [[usize; 3]; 2] = [[0, 2, 1], [3, 4, 5]];

/// Corner indices of a prism's quadrilaterals, counter-clockwise from outside, each starting with
/// an edge of a triangle.
pub const PRISM_QUADS: [[usize; 4]; 3] = [[0, 1, 4, 3], [1, 2, 5, 4], [2, 0, 3, 5]];

/// Corner indices of a prism's edges.
pub const PRISM_EDGES: [[usize; 2]; 9] = [
    [0, 1],
    [0, 2],
    [0, 3],
    [1, 2],
    [1, 4],
    [2, 5],
    [3, 4],
    [3, 5],
    [4, 5],
];

/// Corner indices of a hexahedron's quadrilaterals, counter-clockwise from outside.
pub const HEXAHEDRON_QUADS: [[usize; 4]; 6] = [
    [0, 3, 2, 1],
    [4, 5, 6, 7],
    [0, 1, 5, 4],
    [1, 2, 6, 5],
    [2, 3, 7, 6],
    [3, 0, 4, 7],
];

/// Corner indices of a hexahedron's edges.
pub const HEXAHEDRON_EDGES: [[usize; 2]; 12] = [
    [0, 1],
    [0, 3],
    [0, 4],
    [1, 2],
    [1, 5],
    [2, 3],
    [2, 6],
    [3, 7],
    [4, 5],
    [4, 7],
    [5, 6],
    [6, 7],
];

/// Corner indices of a triangle's edges.
pub(crate) const TRIANGLE_EDGES: [[usize; 2]; 3] = [[0, 1], [1, 2], [2, 0]];

/// Corner indices of a quadrilateral's edges.
pub(crate) const QUAD_EDGES: [[usize; 2]; 4] = [[0, 1], [1, 2], [2, 3], [3, 0]];

/// The parts of a cell at these corner indices.
pub(crate) fn corners_of<const CORNERS: usize, const PART: usize>(
    cell: &[u32; CORNERS],
    parts: &'static [[usize; PART]],
) -> impl Iterator<Item = [u32; PART]> {
    let corner = |place: usize| cell.get(place).copied().unwrap_or_default();
    parts.iter().map(move |part| part.map(corner))
}
