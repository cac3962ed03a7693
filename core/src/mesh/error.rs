//! What can be wrong with a mesh or with the arenas that it is to fill.

use core::fmt;

/// A list of a [`Solid`](super::Solid) or a [`ControlMesh`](super::ControlMesh).
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
    /// Faces of a control mesh.
    Face,
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
    /// Sides of a control mesh's faces.
    Sides,
    /// The order of a control mesh's faces.
    FaceOrder,
    /// Starts of the refined faces.
    FaceOffsets,
    /// Corners of the refined faces.
    FaceCorners,
    /// New vertices on edges.
    EdgeVertices,
    /// New vertices in faces.
    FaceVertices,
    /// Triangles of an adaptive mesh.
    AdaptiveTriangles,
    /// Vertices of an adaptive mesh.
    AdaptiveVertices,
    /// Ring values of an adaptive mesh.
    AdaptiveRings,
    /// Levels of an adaptive mesh.
    AdaptiveLevels,
    /// Major diagonals.
    Diagonals,
    /// Cells that wait for a major diagonal.
    CellQueue,
    /// Triples that say who is whose neighbour.
    Neighbours,
    /// Where the faces around each vertex start.
    FanStarts,
    /// The order of the hexahedra.
    HexahedronOrder,
    /// Quadrilateral faces.
    QuadFaces,
    /// Diagonals of quadrilateral faces.
    QuadDiagonals,
    /// Triangles of prisms.
    PrismTriangles,
    /// Prisms of the refined mesh.
    Prisms,
    /// Hexahedra of the refined mesh.
    Hexahedra,
    /// Surface quadrilaterals.
    SurfaceQuads,
    /// Distortions of the old vertices.
    Distortions,
    /// Labels of refined cells.
    Labels,
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
    /// A crease runs along a pair of vertices that is no edge of a cell or of a face.
    NotAnEdge {
        /// The list that holds it.
        part: Part,
        /// The element in that list.
        index: usize,
        /// The two vertices.
        edge: [u32; 2],
    },
    /// Triangles of cells lie on a quadrilateral face along both of its diagonals.
    CrossedDiagonals {
        /// The face's corners in cyclic order.
        corners: [u32; 4],
    },
    /// The solid has an element that this scheme does not refine.
    UnsupportedPart {
        /// The list that is not empty.
        part: Part,
    },
    /// There is not one major diagonal for each cell.
    DiagonalCount {
        /// The kind of cell.
        part: Part,
        /// Cells of that kind.
        needed: usize,
        /// Major diagonals given.
        given: usize,
    },
    /// A major diagonal is none of 0, 1 and 2.
    DiagonalOutOfRange {
        /// The kind of cell.
        part: Part,
        /// The cell in its list.
        index: usize,
        /// The number given.
        value: u8,
    },
    /// The numbering was made for another mesh.
    OtherNumbering,
    /// The offsets of a control mesh do not start at 0, do not ascend, or do not end at the number
    /// of its indices.
    Offsets {
        /// The face whose offsets are wrong.
        face: usize,
    },
    /// A face has fewer than three corners.
    FaceTooShort {
        /// The face.
        face: usize,
        /// Its corners.
        corners: usize,
    },
    /// A scheme for triangles was given another face.
    NotATriangle {
        /// The face.
        face: usize,
        /// Its corners.
        corners: usize,
    },
    /// A limit mask for quads was given another face.
    NotAQuad {
        /// The face.
        face: usize,
        /// Its corners.
        corners: usize,
    },
    /// A scheme of triangles and quads was given another face.
    NotATriangleOrQuad {
        /// The face.
        face: usize,
        /// Its corners.
        corners: usize,
    },
    /// Two faces run along an edge in the same direction, so that they cannot both be
    /// counter-clockwise.
    Orientation {
        /// The edge's ends.
        edge: [u32; 2],
    },
    /// A crease or boundary edge cannot be cut in three, because its end is a corner, or the end or
    /// a crossing of such lines.
    NotTrisectable {
        /// The end.
        vertex: u32,
    },
    /// A triangle with two crease or boundary edges where an odd number of square-root-3 steps is
    /// claimed.
    TwoSharpEdges {
        /// The face.
        face: usize,
    },
    /// A mesh with a boundary or creases after an odd number of square-root-3 steps, where an even
    /// one is needed.
    OddBoundary,
    /// Adaptive refinement is not defined for meshes with a boundary or creases.
    Open {
        /// The ends of a boundary or crease edge.
        edge: [u32; 2],
    },
    /// A vertex does not have a single ring of three faces or more around it, or is a corner.
    NotManifold {
        /// The vertex.
        vertex: u32,
    },
    /// The exact mask of a vertex or of an edge has a denominator above 2^30.
    MaskTooLarge {
        /// The vertex of the mesh that is refined; for an edge its end with the lesser index.
        vertex: u32,
    },
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
            Self::Face => "face",
        })
    }
}

impl fmt::Display for Arena {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Faces => "faces",
            Self::Edges => "edges",
            Self::OctahedronOrder => "octahedron order",
            Self::HexahedronOrder => "hexahedron order",
            Self::QuadFaces => "quadrilateral faces",
            Self::QuadDiagonals => "diagonals of faces",
            Self::PrismTriangles => "triangles of prisms",
            Self::Tetrahedra => "tetrahedra",
            Self::Octahedra => "octahedra",
            Self::Prisms => "prisms",
            Self::Hexahedra => "hexahedra",
            Self::SurfaceTriangles => "surface triangles",
            Self::SurfaceQuads => "surface quadrilaterals",
            Self::Creases => "creases",
            Self::Corners => "corners",
            Self::InputPoints => "input points",
            Self::OutputPoints => "output points",
            Self::Sums => "sums",
            Self::States => "vertex states",
            Self::Sides => "sides of faces",
            Self::FaceOrder => "face order",
            Self::FaceOffsets => "face offsets",
            Self::FaceCorners => "face corners",
            Self::EdgeVertices => "new vertices on edges",
            Self::FaceVertices => "new vertices in faces",
            Self::AdaptiveTriangles => "adaptive triangles",
            Self::AdaptiveVertices => "adaptive vertices",
            Self::AdaptiveRings => "rings of adaptive vertices",
            Self::AdaptiveLevels => "adaptive levels",
            Self::Diagonals => "major diagonals",
            Self::CellQueue => "cells in the queue",
            Self::Neighbours => "neighbours",
            Self::FanStarts => "fan starts",
            Self::Distortions => "distortions",
            Self::Labels => "labels",
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
                     face"
                )
            }
            Self::CrossedDiagonals {
                corners: [a, b, c, d],
            } => {
                write!(
                    f,
                    "triangles of cells lie on the quadrilateral {a} {b} {c} {d} along both diagonals"
                )
            }
            Self::UnsupportedPart { part } => {
                write!(f, "the mesh has a {part}, which this scheme does not refine")?;
                match part {
                    Part::Crease | Part::Corner => f.write_str(": remove it"),
                    _ => f.write_str("; the mixed scheme does"),
                }
            }
            Self::OtherNumbering => f.write_str("the numbering belongs to another mesh"),
            Self::Offsets { face } => write!(
                f,
                "the offsets of face {face} do not ascend from 0 to the number of indices"
            ),
            Self::FaceTooShort { face, corners } => {
                write!(f, "face {face} has {corners} corners, but needs 3 or more")
            }
            Self::NotATriangle { face, corners } => write!(
                f,
                "face {face} has {corners} corners, but the scheme is for triangles: triangulate the mesh"
            ),
            Self::NotAQuad { face, corners } => write!(
                f,
                "face {face} has {corners} corners, but the limit mask is for quads: refine once first"
            ),
            Self::NotATriangleOrQuad { face, corners } => write!(
                f,
                "face {face} has {corners} corners, but the scheme is for triangles and quads: cut the \
                 polygon into such, or take a scheme for any polygons"
            ),
            Self::Orientation { edge: [a, b] } => write!(
                f,
                "two faces run along the edge between vertices {a} and {b} in the same direction: \
                 orient the mesh consistently"
            ),
            Self::NotTrisectable { vertex } => write!(
                f,
                "a crease or boundary ends, crosses another or has a corner at vertex {vertex}, beside \
                 which square-root-3 subdivision cannot cut it in three: take an odd number of steps, \
                 or remove the feature"
            ),
            Self::TwoSharpEdges { face } => write!(
                f,
                "face {face} has two crease or boundary edges, so the mesh is not an odd number of \
                 square-root-3 steps on"
            ),
            Self::OddBoundary => f.write_str(
                "the mesh has a boundary or creases and is an odd number of square-root-3 steps on: \
                 refine once more",
            ),
            Self::Open { edge: [a, b] } => write!(
                f,
                "the edge between vertices {a} and {b} is a boundary or a crease, where adaptive \
                 square-root-3 refinement is not defined: close the mesh or refine it uniformly"
            ),
            Self::NotManifold { vertex } => write!(
                f,
                "vertex {vertex} does not have a single closed ring of three faces or more around it, \
                 or is tagged as a corner"
            ),
            Self::MaskTooLarge { vertex } => write!(
                f,
                "the exact mask at vertex {vertex} has a denominator above 2^30: too many faces, or \
                 faces with too many different numbers of corners, meet there"
            ),
            Self::DiagonalCount {
                part,
                needed,
                given,
            } => {
                write!(
                    f,
                    "{given} major diagonals are given for cells of the kind {part}, of which \
                     there are {needed}"
                )
            }
            Self::DiagonalOutOfRange { part, index, value } => {
                write!(
                    f,
                    "the major diagonal of {part} {index} is {value}; it must be 0, 1 or 2"
                )
            }
            Self::TooLarge => f.write_str("the refined mesh needs more than 2^32 - 1 vertices"),
        }
    }
}

impl core::error::Error for MeshError {}
