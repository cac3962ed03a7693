//! Why a volume or a form cannot be computed.

use super::MAX_VALENCE;
use std::fmt;

/// Why a volume or a form cannot be computed. Vertices and faces are counted from 0.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum FormError {
    /// The surface is open: an edge belongs to one face only.
    Open {
        /// The edge's vertices.
        edge: [usize; 2],
    },
    /// An edge belongs to more than two faces.
    NonManifold {
        /// The edge's vertices.
        edge: [usize; 2],
    },
    /// Two faces run along an edge in the same direction.
    Orientation {
        /// The edge's vertices.
        edge: [usize; 2],
    },
    /// Two fans of faces touch in a vertex only.
    VertexFans {
        /// The vertex.
        vertex: usize,
        /// An edge of the one fan.
        edge: [usize; 2],
    },
    /// A vertex belongs to no face.
    LoneVertex {
        /// The vertex.
        vertex: usize,
    },
    /// A face has fewer than three corners, a corner twice, or a vertex that does not exist.
    Face {
        /// The face.
        face: usize,
    },
    /// The scheme takes triangles only.
    NotTriangles {
        /// A face that is no triangle.
        face: usize,
    },
    /// The scheme takes triangles and quadrilaterals only.
    NotTrianglesAndQuads {
        /// A face that is neither.
        face: usize,
    },
    /// The scheme's own refinement refuses the mesh.
    Refused {
        /// Why.
        reason: String,
    },
    /// The scheme's facets have forms of the volume, but none of the moments.
    NoMoments,
    /// The number of points is not the number of vertices.
    Points {
        /// Vertices of the mesh.
        vertices: usize,
        /// Points given.
        given: usize,
    },
    /// The weights lie in no quadratic field over the rational numbers.
    NotExact {
        /// A valence, or a number of corners, whose weights do not fit.
        valence: usize,
    },
    /// The scheme has no form of this valence.
    Valence {
        /// The valence.
        valence: usize,
    },
    /// The volume depends on more control points than a form is made over.
    TooManyPoints {
        /// How many.
        points: usize,
    },
    /// No control mesh near this one encloses the volume.
    Target {
        /// The volume of the best attempt, as text.
        reached: String,
    },
}

impl FormError {
    /// The same with other names for the vertices.
    #[must_use]
    pub fn named(self, name: impl Fn(usize) -> usize) -> Self {
        let both = |edge: [usize; 2]| edge.map(&name);
        match self {
            Self::Open { edge } => Self::Open { edge: both(edge) },
            Self::NonManifold { edge } => Self::NonManifold { edge: both(edge) },
            Self::Orientation { edge } => Self::Orientation { edge: both(edge) },
            Self::VertexFans { vertex, edge } => Self::VertexFans {
                vertex: name(vertex),
                edge: both(edge),
            },
            Self::LoneVertex { vertex } => Self::LoneVertex {
                vertex: name(vertex),
            },
            other => other,
        }
    }
}

impl fmt::Display for FormError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Open { edge: [a, b] } => write!(
                f,
                "the surface is open: the edge of vertices {a} and {b} belongs to one face only; \
                 close the hole"
            ),
            Self::NonManifold { edge: [a, b] } => write!(
                f,
                "the surface is not a manifold: the edge of vertices {a} and {b} belongs to more \
                 than two faces; split the surface there"
            ),
            Self::Orientation { edge: [a, b] } => write!(
                f,
                "the surface is not consistently oriented: two faces run along the edge of \
                 vertices {a} and {b} in the same direction; turn one of them round"
            ),
            Self::VertexFans {
                vertex,
                edge: [a, b],
            } => write!(
                f,
                "the surface is not a manifold: several fans of faces touch in vertex {vertex} \
                 only, one of them with the edge of vertices {a} and {b}; give each its own vertex"
            ),
            Self::LoneVertex { vertex } => {
                write!(f, "vertex {vertex} belongs to no face; remove it")
            }
            Self::Face { face } => write!(
                f,
                "face {face} has fewer than three corners, a corner twice, or a vertex that does \
                 not exist"
            ),
            Self::NotTriangles { face } => write!(
                f,
                "face {face} is no triangle, and the scheme takes triangles only; triangulate \
                 the mesh or choose a scheme for polygons"
            ),
            Self::NotTrianglesAndQuads { face } => write!(
                f,
                "face {face} is neither a triangle nor a quadrilateral, and the scheme takes these \
                 only; cut it into such or choose a scheme for polygons"
            ),
            Self::Refused { reason } => f.write_str(reason),
            Self::NoMoments => write!(
                f,
                "facets of this scheme are not polynomials of finitely many pieces, so their moments \
                 have no exact rule; take those of refined polyhedra, extrapolated"
            ),
            Self::Points { vertices, given } => {
                write!(
                    f,
                    "the mesh has {vertices} vertices, but {given} points were given"
                )
            }
            Self::NotExact { valence } => write!(
                f,
                "the weights of valence {valence} do not lie in the quadratic field of the \
                 others; use double precision"
            ),
            Self::Valence { valence } => {
                write!(
                    f,
                    "there is no form of valence {valence}: it must be from 3 to {MAX_VALENCE}"
                )
            }
            Self::TooManyPoints { points } => write!(
                f,
                "the volume depends on {points} control points, too many for one form; use a \
                 coarser cage"
            ),
            Self::Target { reached } => write!(
                f,
                "no control mesh near this one encloses that volume; the nearest attempt \
                 encloses {reached}"
            ),
        }
    }
}

impl std::error::Error for FormError {}
