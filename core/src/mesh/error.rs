//! What can be wrong with a mesh or with the arenas that it is to fill.

use core::fmt;

/// A list of a [`Solid`](super::Solid).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Part {
    /// Tetrahedra.
    Tetrahedron,
    /// Octahedra.
    Octahedron,
    /// Triangular prisms.
    Prism,
    /// Hexahedra.
    Hexahedron,
    /// Surface triangles.
    SurfaceTriangle,
    /// Surface quadrilaterals.
    SurfaceQuad,
    /// Crease edges.
    Crease,
    /// Corners.
    Corner,
}

/// Memory that a caller lends.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Arena {
    /// Faces while the boundary is looked for.
    Faces,
    /// Edges while vertices are numbered.
    Edges,
    /// The order of the octahedra.
    OctahedronOrder,
    /// Tetrahedra of the refined mesh.
    Tetrahedra,
    /// Octahedra of the refined mesh.
    Octahedra,
    /// Surface triangles.
    SurfaceTriangles,
    /// Crease edges.
    Creases,
    /// Corners.
    Corners,
    /// Values of the mesh that is refined.
    InputPoints,
    /// Values of the refined mesh.
    OutputPoints,
    /// Sums of the refined vertices.
    Sums,
    /// States of the refined vertices.
    States,
}

/// Why a mesh cannot be refined as it is, or where it is to go.
///
/// Whatever the error, nothing of the input is lost and no output was promised: arenas may hold
/// intermediate data.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum MeshError {
    /// An arena is too small.
    ArenaTooSmall {
        /// Which one.
        arena: Arena,
        /// Elements needed.
        needed: usize,
        /// Elements given.
        given: usize,
    },
    /// An index points past the last vertex.
    VertexOutOfRange {
        /// The list that holds it.
        part: Part,
        /// The element in that list.
        index: usize,
        /// The vertex that does not exist.
        vertex: u32,
    },
    /// An element names the same vertex twice.
    RepeatedVertex {
        /// The list that holds it.
        part: Part,
        /// The element in that list.
        index: usize,
        /// The vertex that is named twice.
        vertex: u32,
    },
    /// A crease runs along a pair of vertices that is no edge of a cell or of a surface triangle.
    NotAnEdge {
        /// The list that holds it.
        part: Part,
        /// The element in that list.
        index: usize,
        /// The two vertices.
        edge: [u32; 2],
    },
    /// The solid has an element that this scheme does not refine.
    UnsupportedPart {
        /// The list that is not empty.
        part: Part,
    },
    /// The numbering was made for another solid.
    OtherNumbering,
    /// The refined mesh would need more than 2^32 - 1 vertices, or a list longer than memory.
    TooLarge,
}

impl fmt::Display for Part {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Tetrahedron => "tetrahedron",
            Self::Octahedron => "octahedron",
            Self::Prism => "prism",
            Self::Hexahedron => "hexahedron",
            Self::SurfaceTriangle => "surface triangle",
            Self::SurfaceQuad => "surface quadrilateral",
            Self::Crease => "crease",
            Self::Corner => "corner",
        })
    }
}

impl fmt::Display for Arena {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Faces => "faces",
            Self::Edges => "edges",
            Self::OctahedronOrder => "octahedron order",
            Self::Tetrahedra => "tetrahedra",
            Self::Octahedra => "octahedra",
            Self::SurfaceTriangles => "surface triangles",
            Self::Creases => "creases",
            Self::Corners => "corners",
            Self::InputPoints => "input points",
            Self::OutputPoints => "output points",
            Self::Sums => "sums",
            Self::States => "vertex states",
        })
    }
}

impl fmt::Display for MeshError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::ArenaTooSmall {
                arena,
                needed,
                given,
            } => {
                write!(
                    f,
                    "the arena for {arena} holds {given}, but {needed} are needed"
                )
            }
            Self::VertexOutOfRange {
                part,
                index,
                vertex,
            } => {
                write!(
                    f,
                    "{part} {index} names vertex {vertex}, which does not exist"
                )
            }
            Self::RepeatedVertex {
                part,
                index,
                vertex,
            } => {
                write!(f, "{part} {index} names vertex {vertex} twice")
            }
            Self::NotAnEdge {
                part,
                index,
                edge: [a, b],
            } => {
                write!(
                    f,
                    "{part} {index} runs from vertex {a} to {b}, which is no edge of a cell or of a \
                     surface triangle"
                )
            }
            Self::UnsupportedPart { part } => {
                write!(
                    f,
                    "the mesh has a {part}, which this scheme does not refine; "
                )?;
                f.write_str("the mixed scheme does")
            }
            Self::OtherNumbering => f.write_str("the numbering belongs to another solid"),
            Self::TooLarge => f.write_str("the refined mesh needs more than 2^32 - 1 vertices"),
        }
    }
}

impl core::error::Error for MeshError {}
